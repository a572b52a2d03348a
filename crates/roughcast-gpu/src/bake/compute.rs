//! The compute path. It makes all levels in two dispatches if all sides stay even and the device can bind enough
//! storage textures.

use roughcast::wgsl::renamed;

use super::bindings::{Access, Bindings, constant};
use super::pipelines::Pipelines;
use super::plan::{Average, Step, steps};
use super::target::level_view;
use super::{Job, LIBRARY, SLOPE_LIMIT};
use crate::{Gpu, GpuError, Span};

const COMMON: &str = include_str!("wgsl/common.wgsl");
const FUSED: &str = include_str!("wgsl/fused.wgsl");
const WEIGHTED: &str = include_str!("wgsl/weighted.wgsl");

/// Size in bytes of a texel's averages in a buffer: two vec4f.
const AVERAGES_BYTES: u64 = 32;

/// Side length of a workgroup's input, in texels of the level that is read.
const FUSED_TILE: u32 = 64;
/// Side length of a workgroup's output, in texels of the level that is written.
const WEIGHTED_TILE: u32 = 8;

/// Pipelines and bindings of every dispatch.
pub(super) struct ComputeBake {
    dispatches: Vec<Dispatch>,
}

/// One dispatch, ready to be encoded.
pub(super) struct Dispatch {
    pub pipeline: wgpu::ComputePipeline,
    pub bindings: wgpu::BindGroup,
    pub groups: (u32, u32),
}

impl Dispatch {
    pub fn encode(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.dispatch_workgroups(self.groups.0, self.groups.1, 1);
    }
}

impl ComputeBake {
    pub async fn new(gpu: &Gpu, job: &Job) -> Result<Self, GpuError> {
        let levels_a_step = gpu.limits().max_storage_textures_per_shader_stage / job.target.layers();
        if !gpu.has_compute() || levels_a_step == 0 {
            let instead = "bake with render passes (BakePath::Raster)";
            return Err(GpuError::Feature { feature: "compute shaders that store to textures", instead });
        }
        let steps = steps(job.size.width, job.size.height, levels_a_step);
        let states = states(gpu, job, &steps).await?;
        let mut pipelines = Pipelines::new();
        let mut dispatches = Vec::new();
        for (index, step) in steps.iter().enumerate() {
            dispatches.push(dispatch(gpu, job, step, index, &states, &mut pipelines).await?);
        }
        Ok(Self { dispatches })
    }

    pub fn encode(&self, pass: &mut wgpu::ComputePass<'_>) {
        for dispatch in &self.dispatches {
            dispatch.encode(pass);
        }
    }

    pub fn dispatch_count(&self) -> usize {
        self.dispatches.len()
    }
}

/// Begins the single pass of the compute path.
pub(super) fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    span: Option<&Span>,
) -> wgpu::ComputePass<'e> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("bake"),
        timestamp_writes: span.map(Span::of_compute_pass),
    })
}

/// The buffers in which each dispatch leaves its last level as floats for the next dispatch. Dispatches alternate
/// between them, starting with the first.
async fn states(gpu: &Gpu, job: &Job, steps: &[Step]) -> Result<[wgpu::Buffer; 2], GpuError> {
    let bytes = |turn: usize| {
        let handed_on = steps.iter().take(steps.len() - 1).enumerate();
        let in_turn = handed_on.filter(|(index, step)| index % 2 == turn && step.last > 0);
        in_turn.map(|(_, step)| job.texels(step.last) * AVERAGES_BYTES).max().unwrap_or(AVERAGES_BYTES)
    };
    let descriptor = |turn| wgpu::BufferDescriptor {
        label: Some("levels as floats"),
        size: bytes(turn),
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    };
    let what = "a level as floats";
    Ok([gpu.create_buffer(what, &descriptor(0)).await?, gpu.create_buffer(what, &descriptor(1)).await?])
}

async fn dispatch(
    gpu: &Gpu,
    job: &Job,
    step: &Step,
    index: usize,
    states: &[wgpu::Buffer; 2],
    pipelines: &mut Pipelines<wgpu::ComputePipeline>,
) -> Result<Dispatch, GpuError> {
    let params = job.params(gpu.device(), step.input);
    let views: Vec<Vec<wgpu::TextureView>> = step
        .levels()
        .map(|level| job.textures.iter().map(|texture| level_view(texture, level)).collect())
        .collect();
    let mut bindings = Bindings::new(wgpu::ShaderStages::COMPUTE);
    bindings.uniform("params", "Params", &params);
    bindings.uniform("packed_stores", "PackedStores", &job.stores);
    let mut wgsl = if step.input == 0 {
        input_from_map(job, &mut bindings, index == 0)
    } else {
        input_from_state(&mut bindings, &states[(index - 1) % 2])
    };
    let hands_on = step.last > 0 && step.last < job.last_level();
    if hands_on {
        bindings.storage("state_out", "array<vec4f>", Access::ReadWrite, &states[index % 2]);
    }
    for (level, views) in step.levels().zip(&views) {
        for (layer, view) in views.iter().enumerate() {
            bindings.storage_texture(&texture_name(layer, level - step.input), job.target.format, view);
        }
    }
    for halvings in 0..=super::plan::MOST_HALVINGS {
        let written = step.levels().contains(&(step.input + halvings));
        let state = hands_on && step.last == step.input + halvings;
        wgsl += &store(job, halvings, written, state);
    }
    wgsl += job.target.nearest_wgsl();
    let (kernel, entry_point, groups) = kernel(job, step);
    wgsl += &kernel;
    let source = [LIBRARY.as_str(), COMMON, bindings.wgsl(), SLOPE_LIMIT, &wgsl].concat();
    let (pipeline, bindings) = gpu
        .checked("a bake's compute pipeline", |device| {
            let (layout, group) = bindings.make(device);
            (pipelines.of(source, |source| compute_pipeline(device, &layout, source, entry_point)), group)
        })
        .await?;
    Ok(Dispatch { pipeline, bindings, groups })
}

pub(super) fn compute_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    source: &str,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("bake"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("bake"),
        layout: Some(layout),
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// Level 0 is computed from the map. The first dispatch counts the texels it repairs.
fn input_from_map<'a>(job: &'a Job, bindings: &mut Bindings<'a>, counts: bool) -> String {
    job.bind_map(bindings);
    let input = if counts {
        bindings.storage("counts", "array<atomic<u32>, 4>", Access::ReadWrite, &job.counts);
        include_str!("wgsl/input_map_counted.wgsl")
    } else {
        include_str!("wgsl/input_map.wgsl")
    };
    job.map_wgsl() + input
}

/// A later level is read from what the previous dispatch stored.
fn input_from_state<'a>(bindings: &mut Bindings<'a>, state: &'a wgpu::Buffer) -> String {
    bindings.storage("state_in", "array<vec4f>", Access::Read, state);
    include_str!("wgsl/input_buffer.wgsl").to_owned()
}

fn texture_name(layer: usize, halvings: u32) -> String {
    format!("texture_{layer}_{halvings}")
}

/// `store_N`: stores a texel of the level N halvings after the level that is read.
fn store(job: &Job, halvings: u32, written: bool, state: bool) -> String {
    let texels = if written { job.target.store_wgsl() } else { include_str!("wgsl/store_no_texels.wgsl") };
    let state =
        if state { include_str!("wgsl/store_state.wgsl") } else { include_str!("wgsl/store_no_state.wgsl") };
    let numbered = |name: &str| format!("{name}_{halvings}");
    let names = ["store_texels", "store_state", "store", "texture_0", "texture_1", "HALVINGS"];
    let names: Vec<(String, String)> =
        names.iter().map(|name| (format!("{name}_n"), numbered(name))).collect();
    let names: Vec<(&str, &str)> = names.iter().map(|(from, to)| (from.as_str(), to.as_str())).collect();
    let wgsl = [texels, state, include_str!("wgsl/store.wgsl")].concat();
    constant(&numbered("HALVINGS"), format_args!("{halvings}u")) + &renamed(&wgsl, &names)
}

/// The kernel's source, its entry point, and its number of workgroups.
fn kernel(job: &Job, step: &Step) -> (String, &'static str, (u32, u32)) {
    let (width, height) = job.level_size(step.input);
    let quad = match step.average {
        Average::Weighted => {
            let tile = constant("WEIGHTED_TILE", format_args!("{WEIGHTED_TILE}u"));
            let kernel = [&tile, WEIGHTED, include_str!("wgsl/weighted_kernel.wgsl")].concat();
            let (width, height) = job.level_size(step.last);
            return (kernel, "weighted", (width.div_ceil(WEIGHTED_TILE), height.div_ceil(WEIGHTED_TILE)));
        }
        Average::OfFour => include_str!("wgsl/quad_of_four.wgsl"),
        Average::OfFourWeighted => include_str!("wgsl/quad_weighted.wgsl"),
    };
    let halvings = constant("HALVINGS", format_args!("{}u", step.halvings()));
    let kernel = [&halvings, quad, FUSED].concat();
    (kernel, "fused", (width.div_ceil(FUSED_TILE), height.div_ceil(FUSED_TILE)))
}
