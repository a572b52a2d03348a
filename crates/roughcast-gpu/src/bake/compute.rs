//! The compute path: all levels in two dispatches where sides stay even and the device binds enough storage textures.

use super::bindings::{Access, Bindings};
use super::pipelines::Pipelines;
use super::plan::{Average, Step, steps};
use super::target::level_view;
use super::{Job, LIBRARY, SLOPE_LIMIT};
use crate::{Gpu, GpuError, Span};

const COMMON: &str = include_str!("common.wgsl");
const FUSED: &str = include_str!("fused.wgsl");
const WEIGHTED: &str = include_str!("weighted.wgsl");

/// A footprint in a buffer: two vec4f.
const FOOTPRINT_BYTES: u64 = 32;

/// Texels of the level that is read, along each side of what a workgroup takes in.
const FUSED_TILE: u32 = 64;
/// Texels of the level that is written, along each side of what a workgroup makes.
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
        let levels_a_step = gpu.limits.max_storage_textures_per_shader_stage / job.target.layers();
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

/// Begins the one pass of the compute path.
pub(super) fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    span: Option<&Span>,
) -> wgpu::ComputePass<'e> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("bake"),
        timestamp_writes: span.map(Span::of_compute_pass),
    })
}

/// Where dispatches leave their last level as floats for the next one, in turn: the first writes into the first.
async fn states(gpu: &Gpu, job: &Job, steps: &[Step]) -> Result<[wgpu::Buffer; 2], GpuError> {
    let bytes = |turn: usize| {
        let handed_on = steps.iter().take(steps.len() - 1).enumerate();
        let in_turn = handed_on.filter(|(index, step)| index % 2 == turn && step.last > 0);
        in_turn.map(|(_, step)| job.texels(step.last) * FOOTPRINT_BYTES).max().unwrap_or(FOOTPRINT_BYTES)
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
    let params = job.params(&gpu.device, step.input);
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

/// Level 0 is computed from the map. The first dispatch counts what it mends.
fn input_from_map<'a>(job: &'a Job, bindings: &mut Bindings<'a>, counts: bool) -> String {
    job.bind_map(bindings);
    let mut note = "";
    if counts {
        bindings.storage("counts", "array<atomic<u32>, 4>", Access::ReadWrite, &job.counts);
        note = "    if mended.fault != FAULT_NONE { atomicAdd(&counts[mended.fault - 1u], 1u); }\n";
    }
    format!(
        "{}fn input_footprint(at: vec2u) -> Footprint {{\n    let mended = map_slope(at);\n{note}    \
         return footprint_of_slope(mended.slope);\n}}\n",
        job.target.footprint_wgsl()
    )
}

/// A later level is read as the dispatch before left it.
fn input_from_state<'a>(bindings: &mut Bindings<'a>, state: &'a wgpu::Buffer) -> String {
    bindings.storage("state_in", "array<vec4f>", Access::Read, state);
    "fn input_footprint(at: vec2u) -> Footprint {\n    \
     let index = 2u * (at.y * params.size.x + at.x);\n    \
     let low = state_in[index];\n    \
     let high = state_in[index + 1u];\n    \
     return Footprint(low.xy, vec3f(low.zw, high.x), high.yzw);\n}\n"
        .to_owned()
}

fn texture_name(layer: usize, halvings: u32) -> String {
    format!("texture_{layer}_{halvings}")
}

/// `store_N`: what becomes of a texel of the level N halvings after the one that is read.
fn store(job: &Job, halvings: u32, written: bool, state: bool) -> String {
    let mut body = String::new();
    if written || state {
        body += &format!("    if any(at >= level_size({halvings}u)) {{ return; }}\n");
    }
    if written {
        body += "    let stores = unpacked_stores(packed_stores);\n";
        for (layer, texel) in job.target.texels_wgsl().iter().take(job.textures.len()).enumerate() {
            let texture = texture_name(layer, halvings);
            body += &format!("    textureStore({texture}, at, nearest({texel}(footprint, stores)));\n");
        }
    }
    if state {
        body += &format!(
            "    let index = 2u * (at.y * level_size({halvings}u).x + at.x);\n    \
             state_out[index] = vec4f(footprint.mean, footprint.covariance.xy);\n    \
             state_out[index + 1u] = vec4f(footprint.covariance.z, footprint.normal);\n"
        );
    }
    format!("fn store_{halvings}(at: vec2u, footprint: Footprint) {{\n{body}}}\n")
}

/// The kernel's text, its entry point, and the workgroups that it takes.
fn kernel(job: &Job, step: &Step) -> (String, &'static str, (u32, u32)) {
    let (width, height) = job.level_size(step.input);
    let average = match step.average {
        Average::Weighted => {
            let entry = format!(
                "{WEIGHTED}\n@compute @workgroup_size({WEIGHTED_TILE}, {WEIGHTED_TILE})\n\
                 fn weighted(@builtin(global_invocation_id) id: vec3u) {{\n    \
                 opaque_zero = params.zero;\n    \
                 if all(id.xy < level_size(1u)) {{ store_1(id.xy, weighted_footprint(id.xy)); }}\n}}\n"
            );
            let (width, height) = job.level_size(step.last);
            return (entry, "weighted", (width.div_ceil(WEIGHTED_TILE), height.div_ceil(WEIGHTED_TILE)));
        }
        Average::OfFour => "average_of_four",
        Average::OfFourWeighted => "weighted_average_of_four",
    };
    let quad = format!(
        "const HALVINGS: u32 = {}u;\n\
         fn average_of_quad(a: Footprint, b: Footprint, c: Footprint, d: Footprint) -> Footprint {{\n    \
         return {average}(a, b, c, d);\n}}\n{FUSED}",
        step.halvings()
    );
    (quad, "fused", (width.div_ceil(FUSED_TILE), height.div_ceil(FUSED_TILE)))
}
