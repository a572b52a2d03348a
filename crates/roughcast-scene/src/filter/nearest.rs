//! Point sampling: the nearest texel of one level.

use glam::DVec2;
use roughcast::Wrap;

use crate::Level;
use crate::mipmap::wrapped;

/// The texel whose area contains `uv`.
pub(super) fn sample(level: &Level, uv: DVec2, wrap: Wrap) -> [f64; 4] {
    let x = wrapped((uv.x * level.width() as f64).floor() as i64, level.width(), wrap);
    let y = wrapped((uv.y * level.height() as f64).floor() as i64, level.height(), wrap);
    level.texel(x, y).map(f64::from)
}
