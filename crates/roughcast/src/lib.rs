//! Filtered surface detail: bumps in, roughness out.
//!
//! A shiny, bumpy surface should look duller from far away, because its bumps have become too small to see. Mip-mapped
//! normals discard them. This crate turns normal and height maps into textures of *moments of slopes*, which any
//! filter may average, and from which a shader gets the lost bumps back as roughness with a direction (Olano & Baker,
//! "LEAN Mapping", 2010, and its relatives).
//!
//! # A short tour
//!
//! 1. An [`Image`] has the pixels of a map; an [`ImageView`] sees those that belong to someone else. [`detect`] says what they
//!    are: normals or heights, in which channels, with green up or down.
//! 2. [`SourceOptions`] say how the map is read, [`BakeOptions`] what is made of it, and [`BaseRoughness`] what the material has
//!    already.
//! 3. [`Bake`] makes a layout's textures of it, every level of them, and a [`BakeReport`] of what was found, repaired and lost. It
//!    can be watched and stopped. [`texture::Layout`] lists the layouts.
//! 4. [`texture::decode`] goes back from any layout to [`Moments`], and [`texture::bounds`] says how far off these can be;
//!    [`precision`] says which storage type carries which shininess.
//! 5. A [`texture::TexelReader`] makes a [`Distribution`] of slopes of filtered texels, and [`shading`] has the models that shade
//!    with it. Each has a twin for GPUs in [`wgsl`].
//!
//! # Out of scope
//!
//! Files (see `roughcast-io`), block compression (there, too), the GPU, colour textures, and normal maps in object
//! space: slopes are those of the tangent plane.
//!
//! # Conventions
//!
//! - Row 0 of an image is its top. The tangent frame has x to the right (growing column), y **up** (falling row), z out of
//!   the surface: OpenGL's and glTF's normal maps. Maps with green down are flipped as they are read ([`Green`]).
//! - A [`Slope`] is `(N.x / N.z, N.y / N.z)`, minus the gradient of a height. A height value v means
//!   `v * height_scale * width` texels, so slopes have no unit.
//! - Second moments are in the order xx, yy, xy. Variances are of slopes, per axis: Beckmann's `alpha^2 = 2 sigma^2`,
//!   Blinn-Phong's `sigma^2 = 1 / s`, and by convention GGX's `alpha^2 = alpha0^2 + 2 sigma^2`. alpha is the width of the
//!   lobe, neither its square nor perceptual roughness.
//! - Level k+1 of a texture has `max(1, floor(n / 2))` texels each way. The means of slopes and of second moments are the
//!   same on every level.
//! - The same input gives the same bits, for any number of threads and whatever vector instructions the processor has.
//!
//! # What stays
//!
//! - *Options* ([`SourceOptions`], [`BakeOptions`], [`PbrOptions`], [`shading::ShadingOptions`]) and what files say of themselves
//!   ([`texture::TextureInfo`]) are plain structs of public fields. Write `..Default::default()`, or `..TextureInfo::new(…)`, at their
//!   end, also where all fields are named: a minor version may add a field, whose default changes no byte.
//! - *Reports* are `#[non_exhaustive]`: they are read, not made.
//! - *Enums* that will grow (layouts, parts, models, their options, errors) are `#[non_exhaustive]`. Closed are those that whoever
//!   reads maps or samples textures by other means has to know in full: [`SampleType`], [`Wrap`], [`Gradient`], [`MaxSlope`] and the
//!   conventions of maps.
//! - *Values* ([`Slope`], [`Moments`], [`Covariance`]) have the components that they have in the papers, and no others.
//!
//! # Features
//!
//! The bytes of a bake depend on none of them.
//!
//! - `rayon` (default): work is shared by the threads of the rayon pool in which it is called. Without it the calling thread does all.
//! - `multiversion` (default): inner loops are compiled for several instruction sets, and the best is chosen as the program runs.
//! - `serde`: `Serialize` and `Deserialize` for values, options and reports; named enums by their names. What is left out of options
//!   is the default, what is unknown in them is an error. JSON has no infinity, which the bounds of a report may be.
//!
//! # Example
//!
//! Bakes a washboard of 8x8 texels, whose slopes along x are 1/2 and -1/2 in turn, and reads the last level back: no mean
//! slope is left, and all of the bumps are variance along x.
//!
//! ```
//! use roughcast::texture::decode;
//! use roughcast::{Bake, Image, Samples};
//!
//! // Normals in 8 bits, not of unit length: (±1/2, 0, 1), and 0 ..= 255 stands for -1 ..= 1.
//! let texel = |x: usize| if x % 2 == 0 { [191, 128, 255] } else { [64, 128, 255] };
//! let pixels = (0..64).flat_map(|i| texel(i % 8)).collect();
//! let map = Image::new(8, 8, 3, Samples::U8(pixels))?;
//!
//! // LEAN in 16 bits, of a normal map with green up that repeats: the defaults.
//! let baked = Bake::of(&map).run()?;
//! assert_eq!(baked.arrays[0].layers()[0].name(), "lean1");
//! assert_eq!(baked.report.levels.len(), 4); // 8, 4, 2, 1
//!
//! let levels = decode(&baked.arrays)?;
//! let whole = levels[3].moments()[0];
//! let roughness = whole.covariance();
//! // Eight bits have no code for 0 or 1/2; the nearest are up to 1/255 off.
//! assert!(whole.mean.x.abs() < 0.005 && whole.mean.y.abs() < 0.005);
//! assert!((roughness.xx - 0.25).abs() < 0.005 && roughness.yy < 0.0001);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod bake;
mod convention;
pub mod detect;
mod distribution;
mod image;
mod levels;
mod moments;
mod named;
mod options;
mod parallel;
pub mod precision;
mod progress;
mod pyramid;
mod roughness;
mod row;
mod setters;
pub mod shading;
mod slope;
mod source;
mod survey;
pub mod texture;
mod vectorised;
pub mod wgsl;

#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde as __serde;

pub use bake::{Bake, BakeError, BakePlan, BakeReport, Baked, ScaleAdvice, SlopeLimit};
pub use convention::{Green, HeightSense, Kind, NormalChannels, NormalRange, Red, Wrap};
pub use distribution::{Distribution, MAX_GAUSSIANS, WeightedGaussian};
pub use image::{Image, ImageError, ImageView, SampleType, Samples, SamplesMut, SamplesView};
pub use levels::level_sizes;
pub use moments::{Covariance, Moments, SlopeMatrix};
pub use named::{Named, UnknownName};
pub use options::{BakeOptions, Gradient, MaxSlope, PyramidFilter, ScaleChoice, SourceOptions};
pub use progress::BakeWatch;
pub use pyramid::{LevelStats, levels_of_four};
pub use roughness::{Anisotropy, RoughnessTexture, stored_from_variance, variance_from_stored};
pub use slope::{
    LEAST_NORMAL_Z, Normal, Slope, SourceCounts, normal_from_slope, repaired_slope, slope_from_normal,
};
pub use source::{BaseRoughness, RoughnessMap, SourceError};
pub use survey::survey_stride;
pub use texture::{AnisotropyOutput, Blocks, PbrOptions};
