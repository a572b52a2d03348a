//! Cameras, shapes, meshes and lights; the CPU reference renderer, which provides the supersampled ground truth; and
//! image metrics.
//!
//! A [`Scene`] is a [`Shape`] with a camera, lights and a material; a [`View`] makes a standard one. Whatever has bumps
//! is a [`Detail`]: [`BakedTextures`] read through a [`Sampler`], the slopes of a map ([`SlopeDetail`]), or a type of
//! yours. [`render::Method`] shades the distributions of a detail, [`render::Truth`] averages many samples of its exact
//! slopes, and [`metrics`] compares the two pictures.
//!
//! ```
//! use std::sync::Arc;
//!
//! use roughcast::Bake;
//! use roughcast::shading::{Shading, ShadingOptions};
//! use roughcast_scene::metrics::rmse;
//! use roughcast_scene::render::{Method, Truth, unwatched};
//! use roughcast_scene::{BakedTextures, Plane, Sampler, Shape, SlopeDetail, SlopeMap, View, pattern};
//!
//! // Random bumps on a plane, seen from so far away that a pixel covers many of them.
//! let bumps = pattern::random_bumps(64, 0.3, 1);
//! let source = bumps.source_options();
//! let (size, options) = ((32, 24), ShadingOptions::default());
//! let plane = Arc::new(Shape::Plane(Plane::default()));
//! let scene = View::Far.scene(plane, (64, 64), size, Default::default());
//!
//! let baked = Bake::of(&bumps.heights).source(source).run()?;
//! let textures = BakedTextures::of_model(Shading::Lean, &baked.arrays)?;
//! let detail = textures.sampled(Sampler::default());
//! let lean = Method { shading: Shading::Lean, detail: &detail, options }.render(&scene, size, &unwatched)?;
//!
//! let exact = SlopeDetail::new(SlopeMap::of(&bumps.heights, &source)?, source.wrap);
//! let truth = Truth { shading: Shading::Lean, detail: &exact, options, samples: 64 };
//! let truth = truth.render(&scene, size, &unwatched)?;
//! assert!(rmse(&lean, &truth)? < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
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

mod albedo;
mod camera;
mod detail;
#[cfg(feature = "render")]
mod filter;
mod footprint;
mod hit;
mod isosurface;
mod level;
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

pub use albedo::{AlbedoError, AlbedoMap, MAX_ALBEDO};
pub use camera::{Camera, CameraError, PixelRays};
#[cfg(feature = "render")]
pub use detail::{
    BakedTextures, Combined, Curved, Decal, Detail, DetailPoint, HeightDetail, HeightMap, ObjectNormalDetail,
    ObjectNormalMap, Reconstruction, Resolved, SlopeDetail, SlopeMap, Strengthened, TextureDetail, Triplanar,
};
pub use detail::{
    DetailError, HeightDerivative, NoiseDetail, Perturbation, TextureInputs, VolumeDerivative,
    height_texture, model_inputs, object_normal_levels, texture_inputs,
};
#[cfg(feature = "render")]
pub use filter::SummedAreaTable;
pub use hit::{Footprint, Frame, Hit, Ray, Side};
pub use isosurface::isosurface;
pub use level::Level;
pub use light::Light;
pub use mesh::{MAX_TRIANGLES, MAX_VERTICES, Mesh, MeshFault, NormalKind, NormalSource};
#[cfg(feature = "render")]
pub use mipmap::Mipmap;
pub use picture::{Picture, PictureError, luminance};
pub use placement::{Placement, TRIPLANAR_SHARPNESS, TangentSource};
pub use render::MipmapError;
pub use sampler::{Filter, Sampler};
pub use scene::Scene;
pub use sequence::slow_move;
pub use shape::{Bounds, MAX_DETAIL, Plane, Shape, ShapeError, Sphere, Torus, TriangleMesh};
pub use slope_frame::SlopeFrame;
pub use uv_sets::{UvPoint, UvSets};
pub use views::{View, default_light, repeats, repeats_per_length};
