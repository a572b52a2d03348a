//! The CPU renderer: shading methods as a GPU runs them, and the supersampled ground truth that they are compared with.
//!
//! Without the feature `render` it contains only what renderers share: limits and errors.

mod error;
#[cfg(feature = "render")]
mod method;
#[cfg(feature = "render")]
mod normal_quantile;
#[cfg(feature = "render")]
mod rows;
#[cfg(feature = "render")]
mod shade;
#[cfg(feature = "render")]
mod truth;

#[cfg(feature = "render")]
use std::ops::ControlFlow;

pub use error::{MipmapError, RenderError};
#[cfg(feature = "render")]
pub use method::Method;
#[cfg(feature = "render")]
pub(crate) use truth::pixel_filter_quantile;
#[cfg(feature = "render")]
pub use truth::{PIXEL_FILTER_DEVIATION, PIXEL_FILTER_RADIUS, Truth};

#[cfg(feature = "render")]
use rows::{render_rows, render_rows_of_each};

/// The most pixels of a picture; 2 GB.
pub const MAX_PIXELS: u64 = 1 << 26;
/// The most samples per pixel.
pub const MAX_SAMPLES: u32 = 4096;

/// Receives how many rows are done, and of how many; called from any thread, once per row. If it breaks, rendering ends soon
/// with [`RenderError::Cancelled`].
#[cfg(feature = "render")]
pub type Progress<'a> = &'a (dyn Fn(usize, usize) -> ControlFlow<()> + Sync);

/// A [`Progress`] that never stops rendering.
#[cfg(feature = "render")]
pub fn unwatched(_done: usize, _rows: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
