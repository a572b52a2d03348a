//! What the figures share: a map on a shape, rendered by methods and in truth.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::shading::{LobeOptions, Material, Shading};
use roughcast::{Bits, Lobe, Wrap};
use roughcast_scene::pattern::Pattern;
use roughcast_scene::render::{Method, ShadingTextures, Truth, unwatched};
use roughcast_scene::{Camera, Filter, Light, Picture, Reconstruction, Sampler, Scene, Shape, SlopeMap};

use crate::method::{TextureOptions, bake_for};

/// A white light: a white surface that faces it has a radiance of one.
pub const WHITE: [f32; 3] = [std::f32::consts::PI; 3];

/// A dielectric whose highlights stand out: dark, with the reflectance of plastic.
pub const MATERIAL: Material = Material { albedo: [0.05; 3], ambient: [0.2; 3], specular: [0.04; 3] };

/// A map in a scene, and how it is shaded.
pub struct Stage {
    pub map: Pattern,
    pub scene: Scene,
    pub options: LobeOptions,
    /// Bits of the textures of every method.
    pub bits: Bits,
    /// Width and height of the pictures.
    pub size: (u32, u32),
}

/// A scene with one directional light.
pub fn scene(shape: Shape, repeats: f64, camera: Camera, towards_light: DVec3) -> Scene {
    Scene {
        shape: Arc::new(shape),
        camera,
        lights: vec![Light::Directional { towards: towards_light.normalize(), irradiance: WHITE }],
        material: MATERIAL,
        repeats,
        background: [0.0; 3],
    }
}

impl Stage {
    /// The textures that a model samples.
    pub fn textures(&self, shading: Shading) -> Result<ShadingTextures> {
        let options = TextureOptions {
            bits: self.bits,
            lobe: Lobe::Isotropic,
            specular_power: self.options.specular_power,
        };
        let arrays = bake_for(shading, &self.map.heights, &self.map.source_options(), options)?;
        Ok(ShadingTextures::new(shading, &arrays)?)
    }

    /// A picture by a model whose textures are sampled with a filter.
    pub fn method(&self, shading: Shading, filter: Filter) -> Result<Picture> {
        self.sampled(shading, Sampler { filter, ..Sampler::default() })
    }

    /// A picture by a model and a sampler.
    pub fn sampled(&self, shading: Shading, sampler: Sampler) -> Result<Picture> {
        let textures = self.textures(shading)?;
        let method = Method { textures: &textures, sampler, options: self.options };
        Ok(method.render(&self.scene, self.size, &unwatched)?)
    }

    /// The truth of a model's base lobe.
    pub fn truth(&self, shading: Shading, samples: u32) -> Result<Picture> {
        let slopes = SlopeMap::of(&self.map.heights, &self.map.source_options())?;
        let truth = Truth {
            shading,
            slopes: &slopes,
            reconstruction: Reconstruction::Linear,
            wrap: Wrap::Repeat,
            options: self.options,
            samples,
        };
        Ok(truth.render(&self.scene, self.size, &unwatched)?)
    }
}
