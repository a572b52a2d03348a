//! The scale of unsigned texels, and the largest slope if it depends on the map. The caller chooses them, or one more
//! pass over the map finds them on the GPU, where they stay.

use super::bindings::{Access, Bindings};
use super::compute::{Dispatch, compute_pipeline};
use super::{Job, LIBRARY};
use crate::{Gpu, GpuError};

const COMMON: &str = include_str!("wgsl/common.wgsl");
const SCALE: &str = include_str!("wgsl/scale.wgsl");

/// Side length of a workgroup's input, in texels.
const TILE: u32 = 64;

/// Bytes of WGSL's `Survey`: two counts and the bins of a histogram.
const SURVEY_BYTES: u64 = 4 * (2 + SLOPE_BINS);
/// Number of histogram bins, as in limit.wgsl.
const SLOPE_BINS: u64 = 1089;

/// Finds the smallest scale that represents every slope.
pub(super) struct AutoScale {
    survey: wgpu::Buffer,
    look: Dispatch,
    set_scale: Dispatch,
}

impl AutoScale {
    pub async fn new(gpu: &Gpu, job: &Job) -> Result<Self, GpuError> {
        if !gpu.has_compute() {
            let instead = "choose the scale, or store half floats";
            return Err(GpuError::Feature { feature: "compute shaders, which find a scale", instead });
        }
        let descriptor = wgpu::BufferDescriptor {
            label: Some("survey of slopes"),
            size: SURVEY_BYTES,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let survey = gpu.create_buffer("the survey of slopes", &descriptor).await?;
        let (width, height) = job.level_size(0);
        let groups = (width.div_ceil(TILE), height.div_ceil(TILE));
        let look = dispatch(gpu, job, &survey, "look", groups).await?;
        let set_scale = dispatch(gpu, job, &survey, "set_scale", (1, 1)).await?;
        Ok(Self { survey, look, set_scale })
    }

    /// Clears the survey of the previous frame.
    pub fn encode_reset(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.survey, 0, None);
    }

    pub fn encode(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.look.encode(pass);
        self.set_scale.encode(pass);
    }
}

async fn dispatch(
    gpu: &Gpu,
    job: &Job,
    survey: &wgpu::Buffer,
    entry_point: &str,
    groups: (u32, u32),
) -> Result<Dispatch, GpuError> {
    let params = job.params(gpu.device(), 0);
    let mut bindings = Bindings::new(wgpu::ShaderStages::COMPUTE);
    bindings.uniform("params", "Params", &params);
    bindings.storage("survey", "Survey", Access::ReadWrite, survey);
    bindings.storage("packed_stores", "PackedStores", Access::ReadWrite, &job.stores);
    job.bind_map(&mut bindings);
    let map = job.map_wgsl();
    let source = [LIBRARY.as_str(), COMMON, bindings.wgsl(), &map, SCALE].concat();
    let (pipeline, bindings) = gpu
        .checked("the pipeline that finds a scale", |device| {
            let (layout, group) = bindings.make(device);
            (compute_pipeline(device, &layout, &source, entry_point), group)
        })
        .await?;
    Ok(Dispatch { pipeline, bindings, groups })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_survey_has_room_for_the_shaders_histogram() {
        let written = format!("const SLOPE_BINS: u32 = {SLOPE_BINS}u;");
        assert!(
            roughcast::wgsl::module("limit").expect("it exists").source.contains(&written),
            "limit.wgsl lacks '{written}'"
        );
    }
}
