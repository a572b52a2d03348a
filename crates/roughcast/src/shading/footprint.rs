//! Footprint correction: the part of the variance under a texture filter that is under the pixel.
//!
//! A texture filter covers more than the pixel where the texture is magnified, and across the longer axis of a
//! footprint that a trilinear filter treats as a circle. The difference between neighbouring texels then counts as
//! roughness, and highlights become too wide. The area that the filter covers and the rate of change of the mean
//! slope are both known, so the excess can be computed.
//!
//! Along an axis of the footprint with ρ texels of level 0 per pixel, the pixel (a Gaussian with a standard deviation
//! of half a pixel) has the variance `P = (ρ / 2)²` in squared texels. The filter has the variance `K`: at level l,
//! `4^l / 6` for the interpolation between texels and `(4^l - 1) / 12` for the box of texels of level 0 under each. A
//! mean slope that changes linearly by `∂B` per texel has the variance `|∂B|² K` under the filter and `|∂B|² P` under
//! the pixel. Over both axes:
//!
//! - `linear_trace = 1.5 Σ |∂B|² K` is the maximum contribution of a linear change of slope to the trace of the
//!   filtered covariance. Between two texels that differ by Δ, linear interpolation leaves `t (1 - t) Δ²`, whose mean
//!   is `Δ² / 6` and whose maximum is 1.5 times that;
//! - `ratio = Σ |∂B|² min(K, P) / Σ |∂B|² K` is the part of it that is under the pixel;
//! - the covariance is multiplied by `k = 1 - (1 - ratio) min(1, linear_trace / tr Σ)`. Variance that a linear change
//!   cannot cause is detail smaller than the texel, and is kept;
//! - where level 0 itself is magnified there is no such detail: between its texels the slope only changes linearly,
//!   and the covariance under the pixel is `Σ P ∂B ∂Bᵀ` over the axes, whatever the filtered covariance is.
//!   `magnified` blends between the two;
//! - between levels 1 and 2 the correction fades out.
//!
//! If the variance itself is stored ([`super::Shading::Variance`]), interpolation between texels adds none, and K is
//! only the box under each texel.

use super::{FootprintModel, ShadingOptions};
use crate::moments::Covariance;

/// Standard deviation of the pixel filter, a Gaussian, in pixels.
pub const PIXEL_STANDARD_DEVIATION: f32 = 0.5;
/// The ratio of the maximum to the mean variance of linear interpolation between two texels: `1/4` over `1/6`.
const LARGEST_OVER_MEAN: f32 = 1.5;
/// The level at which the correction ends; it fades out from the previous level. On coarser levels a texel's mean
/// varies with everything that the level has averaged, the differences are mostly noise, and nothing is gained: on
/// real maps, mid, far and grazing views are the same with and without the correction.
const LAST_LEVEL: f32 = 2.0;
/// Smaller squared lengths of an axis, in texels, are clamped to this: level 0 is then magnified 10⁶ times.
const LEAST_SQUARED_LENGTH: f32 = 1e-12;

/// The axes of the ellipse that a pixel covers in the texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootprintAxes {
    /// Squared lengths of the longer and the shorter axis, in texels of level 0.
    pub squared_lengths: [f32; 2],
    /// Weights of the derivatives to the right and down that give the derivative along the longer axis, per texel.
    pub along: [f32; 2],
    /// The same for the shorter axis.
    pub across: [f32; 2],
}

/// The axes of a footprint, given the change of the texture position from one pixel to the next on the right and to
/// the one below, in texels of level 0: the derivatives of the texture coordinates times the texture's size.
pub fn footprint_axes(texels_dx: [f32; 2], texels_dy: [f32; 2]) -> FootprintAxes {
    let ([ax, ay], [bx, by]) = (texels_dx, texels_dy);
    let (xx, yy, xy) = (ax * ax + bx * bx, ay * ay + by * by, ax * ay + bx * by);
    let (half_difference, half_trace) = (0.5 * (xx - yy), 0.5 * (xx + yy));
    let radius = (half_difference * half_difference + xy * xy).sqrt();
    // The eigenvector of the larger eigenvalue, in the form whose first component is computed without cancellation.
    let raw =
        if half_difference >= 0.0 { [half_difference + radius, xy] } else { [xy, radius - half_difference] };
    let length = (raw[0] * raw[0] + raw[1] * raw[1]).sqrt();
    let [ux, uy] = if length > 0.0 { [raw[0] / length, raw[1] / length] } else { [1.0, 0.0] };
    let major = (half_trace + radius).max(LEAST_SQUARED_LENGTH);
    // The determinant is the product of both lengths, so the shorter axis keeps its precision even if the other is
    // much longer.
    let area = ax * by - ay * bx;
    let minor = (area * area / major).clamp(LEAST_SQUARED_LENGTH, major);
    FootprintAxes {
        squared_lengths: [major, minor],
        along: [(ax * ux + ay * uy) / major, (bx * ux + by * uy) / major],
        across: [(ay * ux - ax * uy) / minor, (by * ux - bx * uy) / minor],
    }
}

/// Variances of a texture filter along the axes of a footprint, in squared texels of level 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterVariances {
    /// For moments: interpolation between texels, plus the area under each texel.
    pub moments: [f32; 2],
    /// For stored variances: only the area under each texel, since a mean of variances does not include the variance
    /// between them.
    pub variances: [f32; 2],
}

impl FilterVariances {
    /// The level of detail of the texels under the filter, derived from the area under each texel, whose variance is
    /// `(4^l - 1) / 12`.
    pub fn level(&self) -> f32 {
        0.5 * (1.0 + 12.0 * self.variances[0]).log2()
    }

    /// Whether the filter's texels are so coarse that nothing is corrected; derivatives of the mean are then not
    /// needed.
    pub fn is_beyond_correction(&self) -> bool {
        self.level() >= LAST_LEVEL
    }
}

/// Variances of trilinear interpolation at a level of detail, 0 or more: the variances of its two levels, blended
/// with the same weights.
pub fn level_variances(level: f32) -> FilterVariances {
    let level = level.max(0.0);
    let finer = level.floor();
    // 4^l / 6 + (4^l - 1) / 12 is 4^l / 4 - 1 / 12; on the coarser level, 4^l is four times as large.
    let power = (2.0 * finer).exp2() * (1.0 + 3.0 * (level - finer));
    let (moments, variances) = (power / 4.0 - 1.0 / 12.0, (power - 1.0) / 12.0);
    FilterVariances { moments: [moments; 2], variances: [variances; 2] }
}

/// Variances of a hardware texture filter: at most `max_anisotropy` taps along the longer axis, 1 for a trilinear
/// filter, on the level at which the shorter axis (for a trilinear filter, the longer axis) is one texel long, plus a
/// bias.
pub fn hardware_variances(axes: &FootprintAxes, max_anisotropy: f32, mip_bias: f32) -> FilterVariances {
    let [long, short] = axes.squared_lengths.map(f32::sqrt);
    let most_taps = max_anisotropy.max(1.0);
    let shorter = short.max(long / most_taps).max(1.0);
    let taps = (long / shorter).ceil().clamp(1.0, most_taps);
    let level = level_variances(shorter.log2() + mip_bias);
    let between_taps = axes.squared_lengths[0] / 12.0 * (1.0 - 1.0 / (taps * taps));
    let [along, across] = level.moments;
    FilterVariances { moments: [along + between_taps, across], variances: level.variances }
}

/// The part of a filtered covariance that belongs to the pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelPart {
    /// The pixel's part of the variance caused by a linear change of the mean slope, 0 to 1.
    pub ratio: f32,
    /// The maximum contribution of a linear change of the mean slope to the trace of the covariance.
    pub linear_trace: f32,
}

impl PixelPart {
    /// The whole covariance.
    pub const WHOLE: Self = Self { ratio: 1.0, linear_trace: 0.0 };

    /// The factor for a covariance of this trace: 0 to 1.
    pub fn factor(&self, trace: f32) -> f32 {
        if trace > 0.0 { 1.0 - (1.0 - self.ratio) * (self.linear_trace / trace).min(1.0) } else { 1.0 }
    }
}

/// The pixel's part, given the squared changes of the mean slope per texel along the two axes and the variances of
/// the filter and of the pixel along them.
pub fn pixel_part(changes: [f32; 2], variances: [f32; 2], pixel: [f32; 2]) -> PixelPart {
    let [along, across] = changes;
    let covered = along * variances[0] + across * variances[1];
    if covered <= 0.0 {
        return PixelPart::WHOLE;
    }
    let seen = along * variances[0].min(pixel[0]) + across * variances[1].min(pixel[1]);
    PixelPart { ratio: seen / covered, linear_trace: LARGEST_OVER_MEAN * covered }
}

/// The part of the variance under a texture filter that is under the pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootprintRatio {
    /// For filtered moments: LEAN and CLEAN.
    pub moments: PixelPart,
    /// For a filtered variance.
    pub variances: PixelPart,
    /// The covariance under the pixel due to the linear change of the mean slope.
    pub linear_covariance: Covariance,
    /// The fraction of the covariance that is replaced by this linear covariance, 0 to 1: a magnified level 0 has no
    /// detail between its texels.
    pub magnified: f32,
}

impl FootprintRatio {
    /// The whole variance, as in the papers.
    pub const WHOLE: Self = Self {
        moments: PixelPart::WHOLE,
        variances: PixelPart::WHOLE,
        linear_covariance: Covariance { xx: 0.0, yy: 0.0, xy: 0.0 },
        magnified: 0.0,
    };

    /// The pixel's part of a covariance stored in a map. `part` is this ratio's part for the quantity that the map
    /// stores. The variance `base` along each axis does not belong to the bumps and is not reduced.
    pub fn pixel_covariance(&self, part: PixelPart, stored: Covariance, base: f32) -> Covariance {
        let kept = (1.0 - self.magnified) * part.factor(stored.xx + stored.yy - 2.0 * base);
        // The base is not subtracted and added again, so that the unreduced part keeps its precision.
        let rest = (1.0 - kept) * base;
        let Covariance { xx, yy, xy } = self.linear_covariance;
        Covariance {
            xx: kept * stored.xx + rest + self.magnified * xx,
            yy: kept * stored.yy + rest + self.magnified * yy,
            xy: kept * stored.xy + self.magnified * xy,
        }
    }
}

/// The part of the variance under a filter with these variances that is under the pixel, if the filtered mean slope
/// changes by `mean_dx` to the next pixel on the right and by `mean_dy` to the one below. [`FootprintRatio::WHOLE`]
/// for [`FootprintModel::Published`].
pub fn footprint_ratio(
    axes: &FootprintAxes,
    filter: &FilterVariances,
    mean_dx: [f32; 2],
    mean_dy: [f32; 2],
    options: &ShadingOptions,
) -> FootprintRatio {
    if options.footprint == FootprintModel::Published {
        return FootprintRatio::WHOLE;
    }
    let change = |[dx, dy]: [f32; 2]| [0, 1].map(|i| dx * mean_dx[i] + dy * mean_dy[i]);
    let [along, across] = [change(axes.along), change(axes.across)];
    let changes = [along, across].map(|[x, y]| x * x + y * y);
    let pixel =
        axes.squared_lengths.map(|squared| PIXEL_STANDARD_DEVIATION * PIXEL_STANDARD_DEVIATION * squared);
    let seen = [0, 1].map(|i| pixel[i].min(filter.moments[i]));
    let linear_covariance = Covariance {
        xx: seen[0] * along[0] * along[0] + seen[1] * across[0] * across[0],
        yy: seen[0] * along[1] * along[1] + seen[1] * across[1] * across[1],
        xy: seen[0] * along[0] * along[1] + seen[1] * across[0] * across[1],
    };
    let level = filter.level();
    let reach = (LAST_LEVEL - level).clamp(0.0, 1.0);
    let [moments, variances] = [filter.moments, filter.variances].map(|variances| {
        let part = pixel_part(changes, variances, pixel);
        PixelPart { ratio: 1.0 - reach * (1.0 - part.ratio), ..part }
    });
    let finest = 1.0 - level;
    let near = (2.0 - axes.squared_lengths[0].sqrt()).clamp(0.0, 1.0);
    let magnified = finest.clamp(0.0, 1.0) * near * (1.0 - moments.ratio);
    FootprintRatio { moments, variances, linear_covariance, magnified }
}
