//! Maps of diffuse colours in the GPU's memory.

use std::sync::Arc;

use roughcast::SampleType;
use roughcast_scene::{AlbedoMap, Level};

use super::textures::upload_levels;
use crate::{Gpu, GpuError};

/// Filterable on every device, with enough digits for the dark colours of coarse levels; `Rgba8UnormSrgb` would round
/// those to its 256 codes.
const SAMPLES: SampleType = SampleType::F16;

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
        let what = "the map of diffuse colours";
        let texture = match map {
            None => upload_levels(gpu, what, SAMPLES, &[white()]).await?,
            Some(map) => upload_levels(gpu, what, SAMPLES, map.levels()).await?,
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
