//! Texture filters of the hardware.

use roughcast::Wrap;
use roughcast_scene::{Filter, Sampler};

use super::shader::LevelOfDetail;
use crate::{GpuError, OnlyOnCpu};

/// Maximum number of taps of anisotropic filtering in WebGPU.
const MAX_TAPS: u16 = 16;
/// The range of biases of WGSL's `textureSampleBias`.
const BIASES: (f64, f64) = (-16.0, 15.99);
/// A level beyond the last one of any texture.
const LAST_LEVEL: f64 = 32.0;

/// A sampler of the CPU renderer, translated to hardware settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sampling {
    /// The source of the level of detail.
    pub level: LevelOfDetail,
    /// The level if it is fixed, otherwise the bias.
    pub value: f32,
    /// Maximum number of taps along the footprint; 0 for nearest sampling.
    pub max_anisotropy: u16,
    filter: Filter,
    wrap: Wrap,
}

impl Sampling {
    pub fn new(sampler: &Sampler) -> Result<Self, GpuError> {
        let Sampler { filter, level, mip_bias, wrap, .. } = *sampler;
        let level = match filter {
            // As on the CPU, nearest sampling ignores the footprint: level 0, or the level nearest to the given one.
            Filter::Nearest => Some(level.unwrap_or(0.0).round()),
            Filter::Trilinear | Filter::Anisotropic => level,
            _ => {
                return Err(OnlyOnCpu::TextureFilter(filter).into());
            }
        };
        let (level, value) = match level {
            // As on the CPU, NaN selects the finest level.
            Some(level) => (LevelOfDetail::Fixed, if level > 0.0 { level.min(LAST_LEVEL) } else { 0.0 }),
            None => (LevelOfDetail::Derivatives, mip_bias.clamp(BIASES.0, BIASES.1)),
        };
        let max_anisotropy = match (filter, level) {
            (Filter::Nearest, _) => 0,
            (Filter::Anisotropic, LevelOfDetail::Derivatives) => MAX_TAPS,
            _ => 1,
        };
        Ok(Self { level, value: value as f32, max_anisotropy, filter, wrap })
    }

    /// Anisotropic samplers need derivatives; at a fixed level they become trilinear, as on the CPU.
    pub fn descriptor(&self) -> wgpu::SamplerDescriptor<'static> {
        let address = match self.wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        };
        let (texels, levels) = match self.filter {
            Filter::Nearest => (wgpu::FilterMode::Nearest, wgpu::MipmapFilterMode::Nearest),
            _ => (wgpu::FilterMode::Linear, wgpu::MipmapFilterMode::Linear),
        };
        wgpu::SamplerDescriptor {
            label: Some("maps"),
            address_mode_u: address,
            address_mode_v: address,
            mag_filter: texels,
            min_filter: texels,
            mipmap_filter: levels,
            anisotropy_clamp: self.max_anisotropy.max(1),
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampling(filter: Filter, level: Option<f64>, mip_bias: f64) -> Sampling {
        let sampler = Sampler::default().with_filter(filter).with_level(level).with_mip_bias(mip_bias);
        Sampling::new(&sampler).expect("the hardware has it")
    }

    #[test]
    fn filters_of_the_cpu_are_refused_by_name() {
        for filter in [Filter::Ewa, Filter::SummedArea] {
            let sampler = Sampler::default().with_filter(filter);
            let line = Sampling::new(&sampler).expect_err("no hardware has it").to_string();
            assert!(line.contains(filter.name()) && line.contains("CPU"), "{line}");
        }
    }

    #[test]
    fn levels_and_biases_are_clamped_to_the_hardware_range() {
        let nearest = sampling(Filter::Nearest, None, 3.0);
        assert_eq!((nearest.level, nearest.value), (LevelOfDetail::Fixed, 0.0));
        assert_eq!(sampling(Filter::Nearest, Some(1.6), 0.0).value, 2.0);
        assert_eq!(sampling(Filter::Trilinear, Some(-1.0), 9.0).value, 0.0);
        assert_eq!(sampling(Filter::Trilinear, Some(f64::NAN), 9.0).value, 0.0);
        let biased = sampling(Filter::Trilinear, None, 1.5);
        assert_eq!((biased.level, biased.value), (LevelOfDetail::Derivatives, 1.5));
        assert_eq!(sampling(Filter::Trilinear, None, 1e9).value, 15.99);
    }

    #[test]
    fn anisotropy_needs_derivatives() {
        assert_eq!(sampling(Filter::Anisotropic, None, 0.0).descriptor().anisotropy_clamp, MAX_TAPS);
        assert_eq!(sampling(Filter::Anisotropic, Some(0.0), 0.0).descriptor().anisotropy_clamp, 1);
        assert_eq!(sampling(Filter::Trilinear, None, 0.0).descriptor().anisotropy_clamp, 1);
    }
}
