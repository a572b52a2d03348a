//! Cameras, shapes, meshes and lights; the CPU reference renderer, which provides the supersampled ground truth; and
//! image metrics.
//!
//! # Features
//!
//! - `render`, on by default: the CPU renderer with its texture filters, the bounding volume hierarchy for meshes, and
//!   the image metrics. Without it the crate only describes scenes, for other renderers.
//!
//! # Conventions
//!
//! - World space is right-handed, y up; lengths have no unit. Geometry is computed in f64.
//! - Texture coordinates are glTF's: (0, 0) is the top left corner of the image, v grows downwards. The tangent frame
//!   is x right (growing u), y up (falling v), z out of the surface.
//! - Colours are linear radiance.

#![forbid(unsafe_code)]

mod camera;
mod detail;
#[cfg(feature = "render")]
mod filter;
mod footprint;
mod hit;
mod light;
mod mesh;
#[cfg(feature = "render")]
pub mod metrics;
#[cfg(feature = "render")]
mod mipmap;
pub mod pattern;
mod picture;
mod placement;
pub mod render;
mod sampler;
mod scene;
mod sequence;
mod shape;
mod slope_frame;
mod split_mix;
mod uv_sets;
mod views;

pub use camera::{Camera, CameraError, PixelRays};
#[cfg(feature = "render")]
pub use detail::{
    BakedTextures, Detail, DetailPoint, Reconstruction, Resolved, SlopeDetail, SlopeMap, TextureDetail,
};
pub use detail::{DetailError, TextureInputs, model_inputs, texture_inputs};
#[cfg(feature = "render")]
pub use filter::SummedAreaTable;
pub use hit::{Footprint, Frame, Hit, Ray, Side};
pub use light::Light;
pub use mesh::{MAX_TRIANGLES, MAX_VERTICES, Mesh, MeshFault};
#[cfg(feature = "render")]
pub use mipmap::{Level, Mipmap};
pub use picture::{Picture, PictureError, luminance};
pub use placement::Placement;
pub use render::MipmapError;
pub use sampler::{Filter, Sampler};
pub use scene::Scene;
pub use sequence::slow_move;
pub use shape::{Bounds, MAX_DETAIL, Plane, Shape, ShapeError, Sphere, Torus, TriangleMesh};
pub use slope_frame::SlopeFrame;
pub use uv_sets::{UvPoint, UvSets};
pub use views::{View, default_light, repeats};
