//! Maps of diffuse colours in the GPU's memory.

use std::sync::Arc;

use half::f16;
use roughcast_scene::{AlbedoMap, Level};

use super::textures::write_texels;
use crate::{Gpu, GpuError};

/// Filterable on every device, with enough digits for the dark colours of coarse levels; `Rgba8UnormSrgb` would round
/// those to its 256 codes.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The source of a surface's diffuse colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Colours {
    /// One colour, in the uniform of the view.
    One,
    /// A map.
    Map,
}

/// The map of a scene, uploaded; or a single white texel that no shader reads, since the layout needs a texture.
#[derive(Clone, Debug)]
pub(super) struct GpuAlbedo {
    /// The map that the texture was made from. Keeping it alive makes comparing its address safe.
    map: Option<Arc<AlbedoMap>>,
    pub view: wgpu::TextureView,
}

impl GpuAlbedo {
    /// Uploads all levels of a map.
    pub async fn new(gpu: &Gpu, map: Option<&Arc<AlbedoMap>>) -> Result<Self, GpuError> {
        let texture = match map {
            None => upload(gpu, &[white()]).await?,
            Some(map) => upload(gpu, map.levels()).await?,
        };
        Ok(Self { map: map.cloned(), view: texture.create_view(&Default::default()) })
    }

    /// Whether it is this very map.
    pub fn is_of(&self, map: Option<&Arc<AlbedoMap>>) -> bool {
        match (&self.map, map) {
            (None, None) => true,
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            _ => false,
        }
    }

    pub fn colours(&self) -> Colours {
        if self.map.is_some() { Colours::Map } else { Colours::One }
    }
}

fn white() -> Level {
    Level::new(1, 1, vec![[1.0; 4]]).expect("one texel")
}

async fn upload(gpu: &Gpu, levels: &[Level]) -> Result<wgpu::Texture, GpuError> {
    let side = |texels: usize| u32::try_from(texels).unwrap_or(u32::MAX);
    let (width, height) = (side(levels[0].width()), side(levels[0].height()));
    let descriptor = wgpu::TextureDescriptor {
        label: Some("albedo"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: side(levels.len()),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let texture = gpu.create_texture("the map of diffuse colours", &descriptor).await?;
    for (place, level) in levels.iter().enumerate() {
        let texels: Vec<f16> =
            level.texels().as_flattened().iter().map(|value| f16::from_f32(*value)).collect();
        let size = (level.width(), level.height());
        write_texels(gpu, &texture, side(place), size, bytemuck::cast_slice(&texels));
    }
    Ok(texture)
}
