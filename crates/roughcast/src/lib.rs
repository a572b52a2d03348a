//! roughcast: bumps in, roughness out.

#![forbid(unsafe_code)]

mod image;
mod named;
pub mod texture;

pub use image::{Image, ImageError, SampleType, Samples};
pub use named::UnknownName;
