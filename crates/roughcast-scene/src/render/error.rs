//! Reasons why a picture or a texture is refused.

use super::{MAX_PIXELS, MAX_SAMPLES};
use crate::CameraError;

/// Reasons why nothing was rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No pixels, or too many.
    #[error(
        "a picture of {0}x{1} pixels cannot be rendered; choose at least 1x1 and at most {MAX_PIXELS} pixels"
    )]
    Size(u32, u32),
    /// The camera is invalid.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The number of samples is not a square, or is too large.
    #[error("{0} samples per pixel cannot be stratified; choose a square number from 1 to {MAX_SAMPLES}")]
    Samples(u32),
    /// The caller cancelled the rendering.
    #[error("rendering was stopped")]
    Cancelled,
}

/// Why a texture cannot be sampled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MipmapError {
    /// The texture has more channels than a sampler returns.
    #[error("the texture '{name}' has {channels} channels and a sampler returns four; bake another layout")]
    Channels {
        /// The texture.
        name: String,
        /// Its number of channels.
        channels: usize,
    },
    /// There are no levels, or a level's number of texels does not match its size.
    #[error(
        "level {level} of {width}x{height} has {got} texels; a texture needs at least one level, and every texel of it"
    )]
    Size {
        /// The level.
        level: usize,
        /// Its width.
        width: usize,
        /// Its height.
        height: usize,
        /// Its number of texels.
        got: usize,
    },
}
