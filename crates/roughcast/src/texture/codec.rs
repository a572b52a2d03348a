//! Code shared by all layouts: the mapping of quantities to stored values, and the interface for encoding a level.

use super::TextureInfo;
use crate::SampleType;
use crate::convention::NormalRange;
use crate::named::named_enum;
use crate::row::{Extra, RowView};

/// Encodes a row of moments into planes of stored values, for all channels of a layout.
pub(crate) trait RowEncoder: Sync {
    /// `planes` has one plane per channel, texture after texture, each as wide as the row.
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

/// A filler of one for layouts with three channels, since graphics hardware has no three-channel textures.
pub(crate) const OPAQUE: &str = "A";

/// The affine map from a quantity to its stored value: `stored = value * mul + add`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Affine {
    pub mul: f32,
    pub add: f32,
}

impl Affine {
    /// Stores the value unchanged.
    pub const IDENTITY: Self = Self { mul: 1.0, add: 0.0 };

    #[inline(always)]
    pub fn store(self, value: f32) -> f32 {
        value * self.mul + self.add
    }

    #[inline(always)]
    pub fn load(self, stored: f32) -> f32 {
        // In f64, so that a scale that is not a power of two loses no precision.
        ((f64::from(stored) - f64::from(self.add)) / f64::from(self.mul)) as f32
    }
}

/// How each kind of quantity is stored in a file: unsigned types need scale and bias, floats hold the values
/// themselves.
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

    /// A signed entry of the factor of a covariance, over -spread_scale ..= spread_scale.
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

    /// Largest number that a texel can hold without scaling.
    pub fn largest(self) -> f32 {
        match self.sample_type {
            SampleType::U8 | SampleType::U16 => 1.0,
            SampleType::F16 => half::f16::MAX.to_f32(),
            SampleType::F32 => f32::MAX,
        }
    }

    /// Largest rounding error of a quantity stored with this map, up to the given magnitude.
    pub fn error(self, affine: Affine, magnitude: f32) -> f32 {
        /// Four f32 roundings in encoding: the square, the sum, the scale and the bias.
        const ARITHMETIC: f32 = 2.0 * f32::EPSILON;
        let step = match self.sample_type {
            SampleType::U8 => 0.5 / 255.0 / affine.mul,
            SampleType::U16 => 0.5 / 65535.0 / affine.mul,
            // Eleven significant bits; below 2^-14 the step stays at 2^-24.
            SampleType::F16 => (magnitude / 2048.0).max(0.5_f32.powi(25)),
            SampleType::F32 => magnitude * f32::EPSILON / 2.0,
        };
        step + ARITHMETIC * magnitude.max(1.0 / affine.mul)
    }
}

/// Error bounds of a layout's textures: maximum absolute errors of a decoded texel relative to what was encoded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounds {
    /// Error of each component of the mean slope.
    pub slope: f32,
    /// Error of the variance along an axis; if the layout stores a single number for both axes, the error of that
    /// number.
    pub variance: f32,
    /// Error of the variance along any direction, mixed term included, and thus of the smaller eigenvalue.
    pub eigenvalue: f32,
}

impl Bounds {
    /// Largest Blinn-Phong exponent that the variance along the axes can represent: `1 / s` must exceed its error.
    pub fn usable_specular_power(&self) -> f32 {
        1.0 / self.variance
    }

    /// The same along every direction.
    pub fn usable_specular_power_any_direction(&self) -> f32 {
        1.0 / self.eigenvalue
    }
}

/// The largest magnitudes of the stored quantities, over all levels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Peaks {
    /// Largest component of a slope.
    pub component: f32,
    /// Largest length of a slope.
    pub slope: f32,
    /// Largest variance along an axis, including the base roughness if it is folded in.
    pub variance: f32,
}

impl Peaks {
    /// Largest second moment along an axis. Averages never exceed the largest texel, and a base adds to all of them.
    pub fn second(&self) -> f32 {
        self.component * self.component + self.variance
    }
}

/// Error of a variance computed by subtraction, `V = M - B^2`: `e_M + 2 |B| e_B + e_B^2`.
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

/// The unit normal, averaged in addition to the slopes.
pub(crate) const NORMAL: [Extra; 3] = [Extra::NormalX, Extra::NormalY, Extra::NormalZ];
