//! Detail: the interface between sources of bumps and renderers.
//!
//! A renderer makes two queries at a point of a surface: the exact slope there, for the ground truth, and the
//! distribution of slopes under a pixel, for everything else. The source may be textures of any layout
//! ([`TextureDetail`]), the slopes of a map ([`SlopeDetail`]), its heights ([`HeightDetail`]), procedural noise
//! ([`NoiseDetail`]), a projection of another source ([`Triplanar`], [`Decal`]), several sources together ([`Combined`]), or
//! anything else that has bumps.
//!
//! Without the feature `render` this module only selects textures; the GPU renderer uses the same selection.

#[cfg(feature = "render")]
mod combined;
#[cfg(feature = "render")]
mod curvature;
#[cfg(feature = "render")]
mod height_map;
mod height_texture;
#[cfg(feature = "render")]
mod heights;
mod inputs;
#[cfg(feature = "render")]
mod noise;
mod noise_bumps;
mod object_normal_levels;
#[cfg(feature = "render")]
mod object_normals;
#[cfg(feature = "render")]
mod point;
#[cfg(feature = "render")]
mod projection;
#[cfg(feature = "render")]
mod slope_map;
#[cfg(feature = "render")]
mod slopes;
#[cfg(feature = "render")]
mod textures;

#[cfg(feature = "render")]
pub use combined::{Combined, Strengthened};
#[cfg(feature = "render")]
pub use curvature::Curved;
#[cfg(feature = "render")]
pub use height_map::HeightMap;
pub use height_texture::{HeightDerivative, height_texture};
#[cfg(feature = "render")]
pub use heights::HeightDetail;
pub use inputs::{DetailError, TextureInputs, model_inputs, texture_inputs};
pub use noise_bumps::{NoiseDetail, Perturbation, VolumeDerivative};
pub use object_normal_levels::object_normal_levels;
#[cfg(feature = "render")]
pub use object_normals::{ObjectNormalDetail, ObjectNormalMap};
#[cfg(feature = "render")]
pub use point::{Detail, DetailPoint, Resolved};
#[cfg(feature = "render")]
pub use projection::{Decal, Triplanar};
#[cfg(feature = "render")]
pub use slope_map::{Reconstruction, SlopeMap};
#[cfg(feature = "render")]
pub use slopes::SlopeDetail;
#[cfg(feature = "render")]
pub use textures::{BakedTextures, TextureDetail};
