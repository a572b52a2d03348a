//! Measures how long passes take on the GPU, by its own clock.

use crate::read_back::read_buffer;
use crate::{Gpu, GpuError};

/// Maximum number of spans, each with a begin and an end, in one query set (WebGPU's limit is 4096 queries).
const MOST_SPANS: u32 = 2048;
const QUERY_BYTES: u64 = 8;

/// Spans of passes, measured as the encoder's commands run.
///
/// ```
/// use roughcast_gpu::{Gpu, GpuOptions, Timestamps, wgpu};
///
/// # pollster::block_on(async {
/// let gpu = Gpu::new(&GpuOptions::default()).await?;
/// let mut timestamps = Timestamps::new(&gpu, 2).await?;
/// let span = timestamps.span("reduce").expect("there is room for two");
/// let mut encoder = gpu.device().create_command_encoder(&Default::default());
/// let timed = wgpu::ComputePassDescriptor { timestamp_writes: Some(span.of_compute_pass()), ..Default::default() };
/// drop(encoder.begin_compute_pass(&timed));
/// timestamps.resolve(&mut encoder); // after the last pass
/// gpu.queue().submit([encoder.finish()]);
/// assert_eq!(timestamps.read(&gpu).await?[0].name, "reduce");
/// # Ok::<(), roughcast_gpu::GpuError>(())
/// # }).unwrap();
/// ```
#[derive(Debug)]
pub struct Timestamps {
    queries: wgpu::QuerySet,
    results: wgpu::Buffer,
    capacity: u32,
    names: Vec<String>,
    nanoseconds_a_tick: f32,
}

/// A measured span.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Its duration. None if the clock could not measure it: it was reset, or is too coarse to separate begin and end.
    pub nanoseconds: Option<f64>,
}

/// The queries for the begin and the end of one span.
#[derive(Clone, Debug)]
pub struct Span {
    queries: wgpu::QuerySet,
    begin: u32,
}

impl Timestamps {
    /// Creates room for `capacity` spans, 1 to 2048.
    ///
    /// # Errors
    /// [`GpuError::Feature`] if the device has no timestamps.
    pub async fn new(gpu: &Gpu, capacity: u32) -> Result<Self, GpuError> {
        if !gpu.has_timestamps() {
            let instead = "measure whole frames with a clock of the CPU instead";
            return Err(GpuError::Feature { feature: "timestamp queries", instead });
        }
        let capacity = capacity.clamp(1, MOST_SPANS);
        let queries = gpu
            .checked("timestamp queries", |device| {
                device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("timestamps"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * capacity,
                })
            })
            .await?;
        let descriptor = wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size: 2 * u64::from(capacity) * QUERY_BYTES,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        };
        let results = gpu.create_buffer("timestamps", &descriptor).await?;
        let nanoseconds_a_tick = gpu.queue().get_timestamp_period();
        Ok(Self { queries, results, capacity, names: Vec::new(), nanoseconds_a_tick })
    }

    /// A new span, or `None` if all are in use.
    pub fn span(&mut self, name: &str) -> Option<Span> {
        let index = self.names.len() as u32;
        if index == self.capacity {
            return None;
        }
        self.names.push(name.to_owned());
        Some(Span { queries: self.queries.clone(), begin: 2 * index })
    }

    /// Encodes the collection of all spans. Call it after the last pass that they measure.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let used = 2 * self.names.len() as u32;
        if used > 0 {
            encoder.resolve_query_set(&self.queries, 0..used, &self.results, 0);
        }
    }

    /// Waits for the submitted commands and returns the spans. All of them are then free for reuse.
    ///
    /// # Errors
    /// [`GpuError::ReadBack`] if the device was lost.
    pub async fn read(&mut self, gpu: &Gpu) -> Result<Vec<Measured>, GpuError> {
        let bytes = read_buffer(gpu, &self.results).await?;
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        let period = f64::from(self.nanoseconds_a_tick);
        let spans = std::mem::take(&mut self.names).into_iter().zip(ticks.chunks_exact(2));
        Ok(spans
            .map(|(name, ticks)| {
                let elapsed = ticks[1].checked_sub(ticks[0]).filter(|ticks| *ticks > 0 && period > 0.0);
                Measured { name, nanoseconds: elapsed.map(|ticks| ticks as f64 * period) }
            })
            .collect())
    }
}

impl Span {
    /// Measures one compute pass.
    pub fn of_compute_pass(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(self.begin),
            end_of_pass_write_index: Some(self.begin + 1),
        }
    }

    /// Measures one render pass.
    pub fn of_render_pass(&self) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(self.begin),
            end_of_pass_write_index: Some(self.begin + 1),
        }
    }

    /// Starts the span at the begin of this render pass; another pass must end it.
    pub fn from_render_pass(&self) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites { end_of_pass_write_index: None, ..self.of_render_pass() }
    }

    /// Ends the span at the end of this render pass; another pass has started it.
    pub fn to_render_pass(&self) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites { beginning_of_pass_write_index: None, ..self.of_render_pass() }
    }

    /// Starts the span outside of a pass, to measure commands such as copies.
    ///
    /// # Errors
    /// [`GpuError::Feature`] if the device does not support this.
    pub fn begin_outside_passes(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.write(gpu, encoder, self.begin)
    }

    /// Ends a span that [`Span::begin_outside_passes`] started.
    ///
    /// # Errors
    /// [`GpuError::Feature`] if the device does not support this.
    pub fn end_outside_passes(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.write(gpu, encoder, self.begin + 1)
    }

    fn write(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, query: u32) -> Result<(), GpuError> {
        if !gpu.features().contains(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS) {
            let instead = "measure a pass instead";
            return Err(GpuError::Feature { feature: "timestamps outside of passes", instead });
        }
        encoder.write_timestamp(&self.queries, query);
        Ok(())
    }
}
