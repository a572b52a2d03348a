//! The method of the LEAN paper (section 3), for devices without compute shaders. One render pass turns the map into
//! level 0 of both textures; further render passes make the mip levels.
//!
//! Every level after the first is averaged into single-float textures and rounded from there, so that rounding errors
//! do not accumulate from level to level.

use roughcast::levels_of_four;

use super::bindings::Bindings;
use super::pipelines::Pipelines;
use super::target::level_view;
use super::{Job, LIBRARY, SLOPE_LIMIT};
use crate::{Gpu, GpuError, Span};

const COMMON: &str = include_str!("wgsl/common.wgsl");
const WEIGHTED: &str = include_str!("wgsl/weighted.wgsl");
const RASTER: &str = include_str!("wgsl/raster.wgsl");

const STATE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Pipelines, bindings and targets of every render pass, in order.
pub(super) struct RasterBake {
    passes: Vec<Pass>,
}

struct Pass {
    pipeline: wgpu::RenderPipeline,
    bindings: wgpu::BindGroup,
    targets: Vec<wgpu::TextureView>,
    size: (u32, u32),
}

/// The input of a pass.
#[derive(Clone, Copy)]
enum Input<'a> {
    Map,
    State(&'a [wgpu::TextureView; 2]),
}

/// The output of a pass.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Output {
    /// The texels of the level that is read.
    Texels,
    /// The next level as floats, as equal averages of four texels.
    AverageOfFour,
    /// The next level as floats, weighted by coverage.
    WeightedAverage,
}

impl RasterBake {
    pub async fn new(gpu: &Gpu, job: &Job) -> Result<Self, GpuError> {
        gpu.require_format(STATE_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT)?;
        let mut pipelines = Pipelines::new();
        let mut passes =
            vec![pass(gpu, job, 0, Input::Map, Output::Texels, job.level_views(0), &mut pipelines).await?];
        // Odd levels are stored in the first, even levels in the second, so a pass never reads what it writes.
        let states = [state(gpu, job, 1).await?, state(gpu, job, 2).await?];
        let (width, height) = job.level_size(0);
        let of_four = levels_of_four(width as usize, height as usize) as u32;
        for level in 1..=job.last_level() {
            let average = if level <= of_four { Output::AverageOfFour } else { Output::WeightedAverage };
            let of_level = |level: u32| &states[(level as usize + 1) % 2];
            let input = if level == 1 { Input::Map } else { Input::State(of_level(level - 1)) };
            let floats = of_level(level).to_vec();
            passes.push(pass(gpu, job, level - 1, input, average, floats, &mut pipelines).await?);
            let input = Input::State(of_level(level));
            passes.push(
                pass(gpu, job, level, input, Output::Texels, job.level_views(level), &mut pipelines).await?,
            );
        }
        Ok(Self { passes })
    }

    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, span: Option<&Span>) {
        let last = self.passes.len() - 1;
        for (index, pass) in self.passes.iter().enumerate() {
            let timestamp_writes = span.and_then(|span| match (index == 0, index == last) {
                (true, true) => Some(span.of_render_pass()),
                (true, false) => Some(span.from_render_pass()),
                (false, true) => Some(span.to_render_pass()),
                (false, false) => None,
            });
            pass.encode(encoder, timestamp_writes);
        }
    }
}

impl Pass {
    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let attachment = |view| {
            // Every texel that is read later is drawn first, so earlier contents do not matter.
            let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
            wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
        };
        let attachments = [self.targets.first().map(attachment), self.targets.get(1).map(attachment)];
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("bake"),
            color_attachments: &attachments[..self.targets.len()],
            timestamp_writes,
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_viewport(0.0, 0.0, self.size.0 as f32, self.size.1 as f32, 0.0, 1.0);
        pass.draw(0..3, 0..1);
    }
}

/// Two float textures of the size of a level.
async fn state(gpu: &Gpu, job: &Job, level: u32) -> Result<[wgpu::TextureView; 2], GpuError> {
    let (width, height) = job.level_size(level);
    let descriptor = wgpu::TextureDescriptor {
        label: Some("level as floats"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: STATE_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let what = "a level as floats";
    let (low, high) =
        (gpu.create_texture(what, &descriptor).await?, gpu.create_texture(what, &descriptor).await?);
    Ok([level_view(&low, 0), level_view(&high, 0)])
}

async fn pass(
    gpu: &Gpu,
    job: &Job,
    input_level: u32,
    input: Input<'_>,
    output: Output,
    targets: Vec<wgpu::TextureView>,
    pipelines: &mut Pipelines<wgpu::RenderPipeline>,
) -> Result<Pass, GpuError> {
    let params = job.params(gpu.device(), input_level);
    let mut bindings = Bindings::new(wgpu::ShaderStages::FRAGMENT);
    bindings.uniform("params", "Params", &params);
    bindings.uniform("packed_stores", "PackedStores", &job.stores);
    let wgsl = [input_wgsl(job, input, &mut bindings), output_wgsl(job, output)].concat();
    let source = [LIBRARY.as_str(), COMMON, bindings.wgsl(), SLOPE_LIMIT, &wgsl, RASTER].concat();
    let (size, format) = match output {
        Output::Texels => (job.level_size(input_level), job.target.format),
        Output::AverageOfFour | Output::WeightedAverage => (job.level_size(input_level + 1), STATE_FORMAT),
    };
    let count = targets.len();
    let (pipeline, bindings) = gpu
        .checked("a bake's render pipeline", |device| {
            let (layout, group) = bindings.make(device);
            let formats = vec![Some(format.into()); count];
            (pipelines.of(source, |source| render_pipeline(device, &layout, source, &formats)), group)
        })
        .await?;
    Ok(Pass { pipeline, bindings, targets, size })
}

fn input_wgsl<'a>(job: &'a Job, input: Input<'a>, bindings: &mut Bindings<'a>) -> String {
    match input {
        Input::Map => {
            job.bind_map(bindings);
            job.map_wgsl() + include_str!("wgsl/input_map.wgsl")
        }
        Input::State([low, high]) => {
            bindings.texture("state_low", low);
            bindings.texture("state_high", high);
            include_str!("wgsl/input_textures.wgsl").to_owned()
        }
    }
}

fn output_wgsl(job: &Job, output: Output) -> String {
    const STATE: &str = include_str!("wgsl/output_state.wgsl");
    match output {
        Output::Texels => [job.target.nearest_wgsl(), job.target.output_wgsl()].concat(),
        Output::AverageOfFour => [include_str!("wgsl/next_of_four.wgsl"), STATE].concat(),
        Output::WeightedAverage => [WEIGHTED, include_str!("wgsl/next_weighted.wgsl"), STATE].concat(),
    }
}

fn render_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    source: &str,
    targets: &[Option<wgpu::ColorTargetState>],
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("bake"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("bake"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
