//! Rays for the laws of shapes, and maps of the test data.
#![allow(dead_code, reason = "each test program uses its part")]

use glam::{DVec2, DVec3};
use roughcast_io::Decoded;
use roughcast_scene::{Hit, Ray, Shape};

/// A small generator of uniformly distributed numbers (splitmix64), identical on every run.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0 .. 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A unit vector.
    pub fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (std::f64::consts::TAU * self.unit()).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z)
    }

    /// A ray from outside that aims at a point within the shape's bounds.
    pub fn ray_at(&mut self, shape: &Shape) -> Ray {
        let bounds = shape.bounds();
        let origin = bounds.centre + self.direction() * bounds.radius * (1.5 + 8.0 * self.unit());
        let target = bounds.centre + self.direction() * bounds.radius * self.unit().cbrt();
        Ray { origin, direction: (target - origin).normalize() }
    }
}

/// Hits of many random rays.
pub fn hits(shape: &Shape, rays: usize) -> Vec<(Ray, Hit<'_>)> {
    let mut numbers = Numbers(7);
    (0..rays)
        .filter_map(|_| {
            let ray = numbers.ray_at(shape);
            shape.hit(&ray).map(|hit| (ray, hit))
        })
        .collect()
}

/// The difference of texture coordinates modulo one, each in -0.5 .. 0.5.
pub fn wrapped(difference: DVec2) -> DVec2 {
    difference - difference.round()
}

/// Largest deviation from orthonormality, as the largest entry of `F F^T - 1`.
pub fn unorthonormality(hit: &Hit<'_>) -> f64 {
    let f = hit.frame;
    let axes = [f.tangent(), f.bitangent(), f.normal()];
    let mut worst = 0.0_f64;
    for i in 0..3 {
        for j in 0..3 {
            worst = worst.max((axes[i].dot(axes[j]) - f64::from(u8::from(i == j))).abs());
        }
    }
    worst
}

/// A picture of the test data.
pub fn picture(name: &str) -> Decoded {
    let path = roughcast_testdata::find(name);
    let decoded = roughcast_io::read_image_file(&path, &roughcast_io::ReadOptions::default());
    decoded.unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}
