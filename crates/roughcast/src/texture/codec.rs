//! What all layouts share: how quantities become stored values, and what encoding and decoding a level needs.

use super::TextureInfo;
use crate::SampleType;
use crate::convention::NormalRange;
use crate::named::named_enum;
use crate::row::{Extra, RowView};

/// Turns a row of moments into the planes of stored values of all of a layout's channels.
pub(crate) trait RowEncoder: Sync {
    /// `planes` has one plane for each channel, texture after texture, each as wide as the row.
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]);
}

/// One texture of a layout.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LayerSpec {
    /// Its name.
    pub name: &'static str,
    /// The names of its channels.
    pub channels: &'static [&'static str],
}

named_enum! {
    /// Whether textures are shaped for block compression: two channels for what will be BC5, one for BC4.
    #[non_exhaustive]
    pub enum Blocks: "compression" {
        /// Plain texels.
        None = "none",
        /// BC4, BC5 and BC7.
        Bc = "bc",
    }
}

/// A filler of one for layouts with three channels: graphics hardware has no three-channel textures.
pub(crate) const OPAQUE: &str = "A";

/// A quantity's way into a texel: `stored = value * mul + add`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Affine {
    pub mul: f32,
    pub add: f32,
}

impl Affine {
    /// As it is.
    pub const IDENTITY: Self = Self { mul: 1.0, add: 0.0 };

    #[inline(always)]
    pub fn store(self, value: f32) -> f32 {
        value * self.mul + self.add
    }

    #[inline(always)]
    pub fn load(self, stored: f32) -> f32 {
        // In f64, so that a scale that is no power of two costs no digits.
        ((f64::from(stored) - f64::from(self.add)) / f64::from(self.mul)) as f32
    }
}

/// How each kind of quantity is stored in a file: unsigned types need scale and bias, floats hold values as they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    sample_type: SampleType,
    scale: f32,
    spread_scale: f32,
    normal_range: NormalRange,
}

impl Units {
    pub fn new(info: &TextureInfo, sample_type: SampleType) -> Self {
        let TextureInfo { scale, spread_scale, normal_range, .. } = *info;
        Self { sample_type, scale, spread_scale, normal_range }
    }

    fn unsigned(self, full: f32) -> Affine {
        if self.sample_type.is_float() { Affine::IDENTITY } else { Affine { mul: 1.0 / full, add: 0.0 } }
    }

    fn signed(self, full: f32) -> Affine {
        if self.sample_type.is_float() { Affine::IDENTITY } else { Affine { mul: 0.5 / full, add: 0.5 } }
    }

    /// A component of a slope, over -scale ..= scale.
    pub fn slope(self) -> Affine {
        self.signed(self.scale)
    }

    /// `Mxx` or `Myy`, over 0 ..= scale^2.
    pub fn second(self) -> Affine {
        self.unsigned(self.scale * self.scale)
    }

    /// `Mxy`, over -scale^2 ..= scale^2.
    pub fn mixed(self) -> Affine {
        self.signed(self.scale * self.scale)
    }

    /// The trace of M, over 0 ..= 2 scale^2.
    pub fn trace(self) -> Affine {
        self.unsigned(2.0 * self.scale * self.scale)
    }

    /// A variance or a standard deviation, over 0 ..= spread_scale.
    pub fn spread(self) -> Affine {
        self.unsigned(self.spread_scale)
    }

    /// A signed entry of a covariance's factor, over -spread_scale ..= spread_scale.
    pub fn signed_spread(self) -> Affine {
        self.signed(self.spread_scale)
    }

    /// A component of a unit vector.
    pub fn unit(self) -> Affine {
        match self.normal_range {
            NormalRange::Unorm => Affine { mul: 0.5, add: 0.5 },
            NormalRange::Signed => self.signed(1.0),
        }
    }

    /// Largest number that a texel can hold as it is.
    pub fn largest(self) -> f32 {
        match self.sample_type {
            SampleType::U8 | SampleType::U16 => 1.0,
            SampleType::F16 => half::f16::MAX.to_f32(),
            SampleType::F32 => f32::MAX,
        }
    }

    /// Largest rounding error of a quantity with this way of storing, up to the given magnitude.
    pub fn error(self, affine: Affine, magnitude: f32) -> f32 {
        /// Four f32 roundings on the way into a code: the square, the sum, the scale and the bias.
        const ARITHMETIC: f32 = 2.0 * f32::EPSILON;
        let step = match self.sample_type {
            SampleType::U8 => 0.5 / 255.0 / affine.mul,
            SampleType::U16 => 0.5 / 65535.0 / affine.mul,
            // Eleven bits; below 2^-14 the steps stay at 2^-24.
            SampleType::F16 => (magnitude / 2048.0).max(0.5_f32.powi(25)),
            SampleType::F32 => magnitude * f32::EPSILON / 2.0,
        };
        step + ARITHMETIC * magnitude.max(1.0 / affine.mul)
    }
}

/// What a layout's textures can be relied upon to give back. Largest absolute errors of a decoded texel against what
/// was encoded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounds {
    /// Of each component of the mean slope.
    pub slope: f32,
    /// Of the variance along an axis; where the layout keeps only one number for both axes, of the one that it keeps.
    pub variance: f32,
    /// Of the variance along any direction, mixed term included: what the smaller eigenvalue may be off by.
    pub eigenvalue: f32,
}

impl Bounds {
    /// Largest Blinn-Phong exponent that the variance along the axes carries: `1 / s` must stay above its error.
    pub fn usable_specular_power(&self) -> f32 {
        1.0 / self.variance
    }

    /// The same for every direction.
    pub fn usable_specular_power_any_direction(&self) -> f32 {
        1.0 / self.eigenvalue
    }
}

/// The largest magnitudes of what is stored, over all levels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Peaks {
    /// Of a component of the slope.
    pub component: f32,
    /// Of the length of a slope.
    pub slope: f32,
    /// Of a variance along an axis, base roughness included where it is folded in.
    pub variance: f32,
}

impl Peaks {
    /// Largest second moment along an axis. Averages are never larger than the largest texel, and a base adds to all.
    pub fn second(&self) -> f32 {
        self.component * self.component + self.variance
    }
}

/// Errors of a variance that is formed by subtraction, `V = M - B^2`: `e_M + 2 |B| e_B + e_B^2`.
pub(crate) fn subtraction_error(moment_error: f32, slope: f32, slope_error: f32) -> f32 {
    moment_error + 2.0 * slope * slope_error + slope_error * slope_error
}

/// `out[i] = f(a[i])`.
#[inline(always)]
pub(crate) fn map1(out: &mut [f32], a: &[f32], f: impl Fn(f32) -> f32) {
    for (out, a) in out.iter_mut().zip(a) {
        *out = f(*a);
    }
}

/// `out[i] = f(a[i], b[i])`.
#[inline(always)]
pub(crate) fn map2(out: &mut [f32], a: &[f32], b: &[f32], f: impl Fn(f32, f32) -> f32) {
    for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
        *out = f(*a, *b);
    }
}

/// `out[i] = f(a[i], b[i], c[i])`.
#[inline(always)]
pub(crate) fn map3(out: &mut [f32], a: &[f32], b: &[f32], c: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
    for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
        *out = f(*a, *b, *c);
    }
}

/// The unit normal averaged beside the slopes.
pub(crate) const NORMAL: [Extra; 3] = [Extra::NormalX, Extra::NormalY, Extra::NormalZ];
