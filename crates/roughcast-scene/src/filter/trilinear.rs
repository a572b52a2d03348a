//! Trilinear interpolation between two levels: L. Williams, "Pyramidal Parametrics", 1983.

use glam::DVec2;
use roughcast::Wrap;

use super::footprint::Ellipse;
use crate::mipmap::{Mipmap, whole_and_rest};
use crate::{Footprint, Level};

/// The level of detail at which a footprint is about one texel wide: the logarithm of its larger extent in texels.
///
/// Hardware uses the longer of the two derivatives. That is at most the ellipse's longer axis and at least that axis
/// divided by the square root of two, so hardware may be up to half a level sharper.
pub(super) fn level_of(texels: &Footprint) -> f64 {
    Ellipse::of(texels).major.max(f64::MIN_POSITIVE).log2()
}

/// Samples the texture at a level of detail, clamped to 0 and the last level.
pub(super) fn sample(mipmap: &Mipmap, uv: DVec2, level: f64, wrap: Wrap) -> [f64; 4] {
    let levels = mipmap.levels();
    let last = levels.len() - 1;
    let level = if level > 0.0 { level.min(last as f64) } else { 0.0 };
    let finer = level as usize;
    let blend = level - finer as f64;
    let a = bilinear(&levels[finer], uv, wrap);
    if blend == 0.0 {
        return a;
    }
    let b = bilinear(&levels[finer + 1], uv, wrap);
    std::array::from_fn(|i| (1.0 - blend) * a[i] + blend * b[i])
}

/// Bilinear interpolation within a level.
pub(super) fn bilinear(level: &Level, uv: DVec2, wrap: Wrap) -> [f64; 4] {
    let at = uv * DVec2::new(level.width() as f64, level.height() as f64) - 0.5;
    let ((left, s), (top, t)) = (whole_and_rest(at.x), whole_and_rest(at.y));
    let [a, b, c, d] = level.square((left, top), wrap);
    let weighted = [(a, (1.0 - s) * (1.0 - t)), (b, s * (1.0 - t)), (c, (1.0 - s) * t), (d, s * t)];
    std::array::from_fn(|i| weighted.iter().map(|(texel, weight)| weight * f64::from(texel[i])).sum())
}
