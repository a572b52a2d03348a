//! A filtered normal alone as a distribution: its slope, with no bumps about it. The ordinary way, which loses them.

use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::LEAST_NORMAL_Z;
use crate::slope::{Normal, Slope};
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The filtered normal that LEAN's first texture holds; its length is what averaging has left of it.
#[inline]
pub fn bump_normal(lean1: [f32; 4], packing: &Packing) -> [f32; 3] {
    [unpack(lean1[0], packing.unit), unpack(lean1[1], packing.unit), lean1[2]]
}

/// The slope of a filtered normal of any length, and nothing about it. A normal that is flatter than [`LEAST_NORMAL_Z`] counts as
/// that steep.
#[inline]
pub fn normal_moments(normal: [f32; 3]) -> Distribution {
    let z = normal[2].max(LEAST_NORMAL_Z);
    let slope = Slope { x: normal[0] / z, y: normal[1] / z };
    Distribution::new(Normal::from(normal), slope, Covariance::default())
}
