//! A filtered normal alone as a distribution: its slope, with no variance. This is the conventional method, which
//! loses the bumps.

use crate::distribution::Distribution;
use crate::slope::Normal;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The filtered normal stored in LEAN's first texture, with the length that averaging has left.
#[inline]
pub fn bump_normal(lean1: [f32; 4], packing: &Packing) -> [f32; 3] {
    [unpack(lean1[0], packing.unit), unpack(lean1[1], packing.unit), lean1[2]]
}

/// The distribution of a filtered normal alone: [`Distribution::of_normal`].
#[inline]
pub fn normal_moments(normal: [f32; 3]) -> Distribution {
    Distribution::of_normal(Normal::from(normal))
}
