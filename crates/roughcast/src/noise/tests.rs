//! Random positions for the tests of noise, the same in every run.

use std::f64::consts::TAU;

use glam::DVec3;

/// splitmix64.
pub struct Random(pub u64);

impl Random {
    /// Uniform in 0 .. 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normally distributed, variance 1.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    /// A position in a cube of a thousand cells about the origin.
    pub fn position(&mut self) -> DVec3 {
        (DVec3::new(self.unit(), self.unit(), self.unit()) - 0.5) * 1000.0
    }

    /// Two orthonormal axes of a random plane.
    pub fn axes(&mut self) -> [DVec3; 2] {
        let mut direction = || DVec3::new(self.normal(), self.normal(), self.normal()).normalize();
        let (first, other) = (direction(), direction());
        [first, first.cross(other).normalize()]
    }
}
