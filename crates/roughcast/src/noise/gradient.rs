//! Gradient noise with its derivative.

use glam::DVec3;

/// Positions this many cells or more from the origin along an axis are flat: the coordinates of their cells may not fit
/// into 32 bits. A single float has no fraction left from 2^24 cells on, so the noise is useless long before.
pub const NOISE_REACH: f64 = (1_u32 << 30) as f64;

/// The largest absolute value of [`gradient_noise`], rounded up. No choice of lattice gradients exceeds it.
pub const LARGEST_NOISE: f64 = 1.0364;

/// The variance along any axis of the gradient of [`gradient_noise`], over random positions, without unit.
///
/// It follows exactly from the definition. All lattice gradients `g` are independent, with mean 0 and
/// `E[g gᵀ] = 2/3 I`. The noise is `Σ w_c g_c·d_c` over the corners of a cell, so the variance of its derivative
/// along x is `2/3 Σ |w_c e_x + ∂x w_c d_c|²`, a polynomial, whose mean over a cell is this fraction. It is the same
/// along every direction, since the twelve gradients have the symmetry of the cube.
pub const NOISE_SLOPE_VARIANCE: f64 = 238_536_280.0 / 480_729_249.0;

/// A value of noise and its gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSample {
    /// The value: a height in units of length, or without unit for [`gradient_noise`].
    pub value: f64,
    /// The gradient of the value with respect to the position.
    pub gradient: DVec3,
}

impl NoiseSample {
    /// A flat place at height zero.
    pub const FLAT: Self = Self { value: 0.0, gradient: DVec3::ZERO };

    /// Linear interpolation from `self` to `other`, whose weight has the gradient `change`.
    fn blend(self, other: Self, weight: f64, change: DVec3) -> Self {
        let rise = other.value - self.value;
        Self {
            value: self.value + weight * rise,
            gradient: self.gradient + weight * (other.gradient - self.gradient) + rise * change,
        }
    }
}

/// Gradient noise in three dimensions and its analytic gradient, at a position in cells. Continuous up to the second
/// derivative.
///
/// Every lattice point has one of twelve gradients, the directions from the centre of a cube to its edges, and the value
/// zero. Between them the values of the eight linear functions are blended with the quintic `6t⁵ - 15t⁴ + 10t³`.
///
/// The value is within ±[`LARGEST_NOISE`], with mean 0; the variance of each component of the gradient is
/// [`NOISE_SLOPE_VARIANCE`]. Positions that are not finite or not within [`NOISE_REACH`] are flat.
///
/// The twin in WGSL chooses the same lattice gradients. Its position in single floats, a product with the frequency, is
/// off by up to `|p| 2^-24`, and so the gradient by that times the second derivatives, which are below 11 for a unit
/// direction; its own arithmetic adds a few roundings of numbers near one.
///
/// Source: Perlin, "Improving Noise", 2002. He repeats four of the gradients to have 16. Then the variance of slopes
/// along y would be a fifth larger than that along x and z, so here the twelve are equally likely.
pub fn gradient_noise(p: DVec3, seed: u32) -> NoiseSample {
    if !within_reach(p) {
        return NoiseSample::FLAT;
    }
    let cell = p.floor();
    let t = p - cell;
    let weight = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let change = 30.0 * t * t * (t * (t - 2.0) + 1.0);
    let [x, y, z] = cell.to_array().map(|c| c as i32 as u32);

    let along_x = |y_offset: u32, z_offset: u32| {
        let plane = noise_hash(z.wrapping_add(z_offset).wrapping_add(noise_hash(seed)));
        let row = noise_hash(y.wrapping_add(y_offset).wrapping_add(plane));
        let corner = |x_offset: u32| {
            let offset = [x_offset, y_offset, z_offset].map(f64::from);
            corner_noise(noise_hash(x.wrapping_add(x_offset).wrapping_add(row)), t - DVec3::from_array(offset))
        };
        corner(0).blend(corner(1), weight.x, DVec3::X * change.x)
    };
    let along_y =
        |z_offset: u32| along_x(0, z_offset).blend(along_x(1, z_offset), weight.y, DVec3::Y * change.y);
    along_y(0).blend(along_y(1), weight.z, DVec3::Z * change.z)
}

/// Whether a position has noise; false for NaN.
pub(super) fn within_reach(p: DVec3) -> bool {
    p.abs().cmplt(DVec3::splat(NOISE_REACH)).all()
}

/// Mixes all bits of a word. It is chained over the coordinates, so that no vector of the lattice is a period, as there
/// would be for a sum of multiples of the coordinates.
///
/// Source: the last step of MurmurHash3 for 32 bits, Appleby, in the public domain.
pub(super) fn noise_hash(key: u32) -> u32 {
    let key = (key ^ (key >> 16)).wrapping_mul(0x85eb_ca6b);
    let key = (key ^ (key >> 13)).wrapping_mul(0xc2b2_ae35);
    key ^ (key >> 16)
}

/// The gradient of a lattice point with this hash: two components are 1 or -1, the other is 0.
pub(super) fn lattice_gradient(hash: u32) -> DVec3 {
    let direction = ((hash >> 16) * 12) >> 16;
    let sign = |bit: u32| 1.0 - 2.0 * f64::from((direction >> bit) & 1);
    match direction >> 2 {
        0 => DVec3::new(sign(0), sign(1), 0.0),
        1 => DVec3::new(sign(0), 0.0, sign(1)),
        _ => DVec3::new(0.0, sign(0), sign(1)),
    }
}

/// The linear function of a lattice point with this hash, at an offset from it.
fn corner_noise(hash: u32, offset: DVec3) -> NoiseSample {
    let gradient = lattice_gradient(hash);
    NoiseSample { value: gradient.dot(offset), gradient }
}
