//! Detail: the interface between sources of bumps and renderers.
//!
//! A renderer makes two queries at a point of a surface: the exact slope there, for the ground truth, and the
//! distribution of slopes under a pixel, for everything else. The source may be textures of any layout
//! ([`TextureDetail`]), the slopes of a map ([`SlopeDetail`]), or anything else that has bumps.
//!
//! Without the feature `render` this module only selects textures; the GPU renderer uses the same selection.

mod inputs;
#[cfg(feature = "render")]
mod point;
#[cfg(feature = "render")]
mod slope_map;
#[cfg(feature = "render")]
mod slopes;
#[cfg(feature = "render")]
mod textures;

pub use inputs::{DetailError, TextureInputs, model_inputs, texture_inputs};
#[cfg(feature = "render")]
pub use point::{Detail, DetailPoint, Resolved};
#[cfg(feature = "render")]
pub use slope_map::{Reconstruction, SlopeMap};
#[cfg(feature = "render")]
pub use slopes::SlopeDetail;
#[cfg(feature = "render")]
pub use textures::{BakedTextures, TextureDetail};
