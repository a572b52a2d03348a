//! Shared by the figures: a map on a shape, rendered by the methods and as ground truth.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast::{SampleType, Wrap};
use roughcast_pipeline::{TextureOptions, bake_for};
use roughcast_scene::pattern::Pattern;
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{
    BakedTextures, Camera, Filter, Light, Picture, Sampler, Scene, Shape, SlopeDetail, SlopeMap,
};

/// A dielectric with clearly visible highlights: dark, with the reflectance of plastic.
fn dark_plastic() -> Material {
    Material::default().with_albedo([0.05; 3]).with_ambient([0.2; 3])
}

/// A map in a scene, and how it is shaded.
pub struct Stage {
    pub map: Pattern,
    pub scene: Scene,
    pub options: ShadingOptions,
    /// The sample type of every method.
    pub sample_type: SampleType,
    /// Width and height of the pictures.
    pub size: (u32, u32),
}

/// A scene with one directional light.
pub fn scene(shape: Shape, repeats: f64, camera: Camera, towards_light: DVec3) -> Scene {
    Scene {
        shape: Arc::new(shape),
        camera,
        lights: vec![Light::Directional { towards: towards_light.normalize(), irradiance: Light::WHITE }],
        material: dark_plastic(),
        albedo: None,
        repeats,
        background: [0.0; 3],
    }
}

impl Stage {
    /// A picture by a model whose textures are sampled with a filter.
    pub fn method(&self, shading: Shading, filter: Filter) -> Result<Picture> {
        self.sampled(shading, Sampler::default().with_filter(filter))
    }

    /// A picture by a model and a sampler.
    pub fn sampled(&self, shading: Shading, sampler: Sampler) -> Result<Picture> {
        Ok(self.sampled_frames(shading, sampler, std::slice::from_ref(&self.scene))?.remove(0))
    }

    /// Pictures of several scenes by a model and a sampler.
    pub fn sampled_frames(
        &self,
        shading: Shading,
        sampler: Sampler,
        scenes: &[Scene],
    ) -> Result<Vec<Picture>> {
        let options = TextureOptions::default()
            .with_sample_type(self.sample_type)
            .with_specular_power(self.options.specular_power);
        let arrays = bake_for(shading, &self.map.heights, &self.map.source_options(), options)?;
        let textures = BakedTextures::of_model(shading, &arrays)?;
        let method = Method { shading, detail: &textures.sampled(sampler), options: self.options };
        scenes.iter().map(|scene| Ok(method.render(scene, self.size, &unwatched)?)).collect()
    }

    /// The ground truth of a model's reference.
    pub fn truth(&self, shading: Shading, samples: u32) -> Result<Picture> {
        Ok(self.truth_frames(shading, samples, std::slice::from_ref(&self.scene))?.remove(0))
    }

    /// The ground truths of several scenes.
    pub fn truth_frames(&self, shading: Shading, samples: u32, scenes: &[Scene]) -> Result<Vec<Picture>> {
        let slopes = SlopeMap::of(&self.map.heights, &self.map.source_options())?;
        let truth = Truth {
            shading,
            detail: &SlopeDetail::new(slopes, Wrap::Repeat),
            options: self.options,
            samples,
        };
        scenes.iter().map(|scene| Ok(truth.render(scene, self.size, &unwatched)?)).collect()
    }
}
