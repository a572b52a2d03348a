//! Vectors in f64, random numbers, frames, and how a renderer decodes texels.

use roughcast::Anisotropy;
use roughcast::shading::{FootprintRatio, Shading, ShadingOptions, Surface};
use roughcast::texture::Packing;

/// The surface that a model makes from filtered texels of its layout.
pub fn surface_of_texels(
    shading: Shading,
    texels: &[[f32; 4]],
    ratio: &FootprintRatio,
    packing: &Packing,
    options: &ShadingOptions,
) -> Surface {
    let anisotropy = if texels.len() == 3 { Anisotropy::Anisotropic } else { Anisotropy::Isotropic };
    let reader =
        shading.layout().texel_reader(shading.wanted(), anisotropy).expect("a model samples its layout");
    shading.surface_of(&reader.read_pixel(texels, ratio, packing, options), options)
}

pub type Vector = [f64; 3];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|v| v * factor)
}

pub fn sum(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn normalize(a: Vector) -> Vector {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

pub fn narrow(a: Vector) -> [f32; 3] {
    a.map(|v| v as f32)
}

pub fn wide(a: [f32; 3]) -> Vector {
    a.map(f64::from)
}

/// A right-handed orthonormal frame; the last vector is the normal.
pub struct Frame(pub [Vector; 3]);

impl Frame {
    /// The surface's own frame.
    pub const SURFACE: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// A frame about this normal, with the tangent nearest to x.
    pub fn about(normal: Vector) -> Self {
        let normal = normalize(normal);
        let tangent = normalize(sum([1.0, 0.0, 0.0], scaled(normal, -normal[0])));
        Self([tangent, cross(normal, tangent), normal])
    }

    /// The unit direction of this slope in the frame.
    pub fn direction(&self, slope: [f64; 2]) -> Vector {
        let [tangent, bitangent, normal] = self.0;
        normalize(sum(sum(scaled(tangent, slope[0]), scaled(bitangent, slope[1])), normal))
    }
}

/// SplitMix64, by Sebastiano Vigna: numbers from 0 to 1 that are identical on every run.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A unit direction above the surface, with z at least `z`.
    pub fn direction_above(&mut self, z: f64) -> Vector {
        let z = self.between(z, 1.0);
        let angle = self.between(0.0, std::f64::consts::TAU);
        let radius = (1.0 - z * z).sqrt();
        [radius * angle.cos(), radius * angle.sin(), z]
    }
}
