//! Cameras, meshes and lights; the CPU reference renderer, which is the supersampled truth of every comparison; and the
//! measures by which pictures are compared.
//!
//! # Conventions
//!
//! - World space is right-handed, y up; lengths have no unit. Geometry is computed in f64.
//! - Texture coordinates are glTF's: (0, 0) is the top left corner of the image, v grows downwards. The tangent frame is
//!   x right (growing u), y up (falling v), z out of the surface.
//! - Colours are linear radiance.

#![forbid(unsafe_code)]

mod camera;
mod filter;
mod footprint;
mod hit;
mod light;
mod mesh;
pub mod metrics;
mod mipmap;
pub mod pattern;
mod picture;
pub mod render;
mod scene;
mod sequence;
mod shape;
mod slope_frame;
mod slope_map;
mod split_mix;
mod views;

pub use camera::{Camera, CameraError, PixelRays};
pub use filter::{Filter, Sampler, SummedAreaTable};
pub use hit::{Footprint, Frame, Hit, MAX_UV_SETS, Ray, Side, UvPoint, UvSets};
pub use light::Light;
pub use mesh::{MAX_TRIANGLES, MAX_VERTICES, Mesh, MeshFault};
pub use mipmap::{Level, Mipmap, MipmapError};
pub use picture::{Picture, luminance};
pub use scene::Scene;
pub use sequence::slow_move;
pub use shape::{Bounds, MAX_DETAIL, Plane, Shape, ShapeError, Sphere, Torus, TriangleMesh};
pub use slope_frame::SlopeFrame;
pub use slope_map::{Reconstruction, SlopeMap};
pub use views::{View, default_light, repeats};
