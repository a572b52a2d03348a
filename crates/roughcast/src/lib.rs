//! roughcast: bumps in, roughness out.

#![forbid(unsafe_code)]

pub mod detect;
mod image;
mod kind;
mod named;
pub mod texture;

pub use image::{Image, ImageError, SampleType, Samples};
pub use kind::{Kind, NormalComponents, NormalRange};
pub use named::UnknownName;
