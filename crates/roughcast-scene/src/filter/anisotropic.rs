//! Anisotropic filtering as in graphics hardware: trilinear taps along the footprint's longer axis.
//!
//! Source: EXT_texture_filter_anisotropic, with the axes of the footprint's ellipse instead of the two derivatives,
//! which are the ellipse's axes only if they are perpendicular.

use glam::DVec2;
use roughcast::Wrap;

use super::footprint::Ellipse;
use super::trilinear;
use crate::Footprint;
use crate::mipmap::Mipmap;

/// Maximum number of taps, and thus the maximum ratio of the axes before the shorter axis is lengthened.
pub(super) const MAX_TAPS: f64 = 16.0;
/// How far rounding may raise the ratio of the axes above an integer without adding a tap.
const RATIO_ROUNDING: f64 = 1e-9;

/// The level of detail of the taps.
pub(super) fn level_of(texels: &Footprint) -> f64 {
    minor_of(&Ellipse::of(texels)).log2()
}

/// The shorter axis in texels. Below one texel, interpolation smooths anyway, so closer taps would add nothing.
fn minor_of(ellipse: &Ellipse) -> f64 {
    ellipse.minor.max(ellipse.major / MAX_TAPS).max(1.0)
}

/// The mean of equally weighted taps over a footprint in texels of level 0. The taps' level is that of the shorter
/// axis, plus a bias.
pub(super) fn sample(mipmap: &Mipmap, uv: DVec2, texels: &Footprint, bias: f64, wrap: Wrap) -> [f64; 4] {
    let ellipse = Ellipse::of(texels);
    let minor = minor_of(&ellipse);
    let taps = (ellipse.major / minor - RATIO_ROUNDING).ceil().clamp(1.0, MAX_TAPS);
    let level = minor.log2() + bias;
    let (width, height) = mipmap.size();
    let axis = ellipse.direction * ellipse.major / DVec2::new(width as f64, height as f64);
    let mut sum = [0.0; 4];
    for tap in 0..taps as usize {
        let along = (tap as f64 + 0.5) / taps - 0.5;
        let texel = trilinear::sample(mipmap, uv + along * axis, level, wrap);
        sum.iter_mut().zip(texel).for_each(|(sum, texel)| *sum += texel / taps);
    }
    sum
}
