//! The CPU renderer: shading methods as they run on a GPU, and the supersampled ground truth that they are compared
//! with.
//!
//! Without the feature `render` it contains only the limits and errors that renderers share.

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
pub use truth::{PIXEL_FILTER_RADIUS, PIXEL_FILTER_STANDARD_DEVIATION, Truth};

#[cfg(feature = "render")]
use rows::{render_rows, render_rows_of_each};

/// Maximum number of pixels of a picture; they take 2 GB.
pub const MAX_PIXELS: u64 = 1 << 26;
/// Maximum number of samples per pixel.
pub const MAX_SAMPLES: u32 = 4096;

/// Receives the number of completed rows and the total; called from any thread, once per row. If it returns `Break`,
/// rendering soon ends with [`RenderError::Cancelled`].
#[cfg(feature = "render")]
pub type Progress<'a> = &'a (dyn Fn(usize, usize) -> ControlFlow<()> + Sync);

/// A [`Progress`] that never stops rendering.
#[cfg(feature = "render")]
pub fn unwatched(_done: usize, _rows: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
