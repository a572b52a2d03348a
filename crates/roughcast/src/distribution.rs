//! The distribution of slopes under a footprint: the result of every source of bumps, and the input of every shading
//! model.
//!
//! One Gaussian describes the bumps of LEAN and related methods; a mixture of up to four describes several kinds of
//! bumps under one footprint. The filtered normal is stored in addition: diffuse light needs its length, which the
//! Gaussians do not determine.

use crate::moments::{Covariance, Moments, SlopeMatrix};
use crate::roughness::Base;
use crate::slope::{LEAST_NORMAL_Z, Normal, Slope, normal_from_slope};

/// The maximum number of Gaussians in a distribution.
pub const MAX_GAUSSIANS: usize = 4;

/// One Gaussian of a distribution of slopes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WeightedGaussian {
    /// Weight, 0 to 1.
    pub weight: f32,
    /// Mean slope.
    pub mean: Slope,
    /// Covariance, as a texture stores it: rounding may have made it invalid.
    pub covariance: Covariance,
}

/// A list of one to [`MAX_GAUSSIANS`] weighted Gaussians of slopes and the filtered normal. The weights sum to 1.
///
/// ```
/// use roughcast::{Covariance, Distribution, Slope};
///
/// let bumps = Distribution::gaussian(Slope { x: 0.5, y: 0.0 }, Covariance::isotropic(0.01));
/// assert_eq!(bumps.gaussians().len(), 1);
/// // In a frame that is mirrored along x:
/// let mirrored = bumps.transformed([[-1.0, 0.0], [0.0, 1.0]]);
/// assert_eq!(mirrored.moments().mean.x, -0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Parts", into = "Parts")
)]
pub struct Distribution {
    normal: Normal,
    base: Base,
    count: usize,
    gaussians: [WeightedGaussian; MAX_GAUSSIANS],
}

/// The serialized form of a distribution, without unused Gaussians.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Parts {
    normal: Normal,
    base: Base,
    gaussians: Vec<WeightedGaussian>,
}

#[cfg(feature = "serde")]
impl From<Distribution> for Parts {
    fn from(distribution: Distribution) -> Self {
        let gaussians = distribution.gaussians().to_vec();
        Self { normal: distribution.normal, base: distribution.base, gaussians }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Parts> for Distribution {
    type Error = String;

    fn try_from(parts: Parts) -> Result<Self, String> {
        let count = parts.gaussians.len();
        let mixture = Self::mixture(&parts.gaussians)
            .ok_or_else(|| format!("a distribution has 1 to {MAX_GAUSSIANS} Gaussians, not {count}"))?;
        Ok(mixture.with_normal(parts.normal).with_base(parts.base))
    }
}

/// A filtered normal shorter than this counts as this long: its direction means nothing.
const LEAST_LENGTH: f32 = 1e-4;

impl Distribution {
    /// A single slope without unresolved bumps.
    pub fn of_slope(slope: Slope) -> Self {
        Self::gaussian(slope, Covariance::default())
    }

    /// The slope of a filtered normal of any length, without any spread. This is the conventional method, which loses
    /// the bumps. A z below [`LEAST_NORMAL_Z`] is raised to it.
    #[inline]
    pub fn of_normal(normal: Normal) -> Self {
        Self::new(normal, slope_of_filtered(normal), Covariance::default())
    }

    /// One Gaussian; the filtered normal is the unit normal of the mean slope.
    #[inline]
    pub fn gaussian(mean: Slope, covariance: Covariance) -> Self {
        Self::new(normal_from_slope(mean), mean, covariance)
    }

    /// One Gaussian and a filtered normal of any length, without the base roughness.
    #[inline]
    pub fn new(normal: Normal, mean: Slope, covariance: Covariance) -> Self {
        let mut gaussians = [WeightedGaussian::default(); MAX_GAUSSIANS];
        gaussians[0] = WeightedGaussian { weight: 1.0, mean, covariance };
        Self { normal, base: Base::None, count: 1, gaussians }
    }

    /// A mixture with the given weights, which should sum to 1. The filtered normal is the unit normal of the mean
    /// slope. `None` for no Gaussians or more than [`MAX_GAUSSIANS`].
    pub fn mixture(gaussians: &[WeightedGaussian]) -> Option<Self> {
        if !(1..=MAX_GAUSSIANS).contains(&gaussians.len()) {
            return None;
        }
        let mut mixture = Self::of_slope(Slope::default());
        mixture.count = gaussians.len();
        mixture.gaussians[..gaussians.len()].copy_from_slice(gaussians);
        Some(mixture.with_normal(normal_from_slope(mixture.moments().mean)))
    }

    /// Replaces the filtered normal.
    #[must_use]
    pub fn with_normal(self, normal: Normal) -> Self {
        Self { normal, ..self }
    }

    /// Sets where the base roughness is: [`Base::Baked`] if the covariances already contain it.
    #[must_use]
    pub fn with_base(self, base: Base) -> Self {
        Self { base, ..self }
    }

    /// Whether the covariances contain the base roughness.
    pub fn base(&self) -> Base {
        self.base
    }

    /// The filtered normal for diffuse light, with its length after averaging.
    pub fn normal(&self) -> Normal {
        self.normal
    }

    /// The Gaussians, one to [`MAX_GAUSSIANS`].
    #[inline]
    pub fn gaussians(&self) -> &[WeightedGaussian] {
        &self.gaussians[..self.count]
    }

    /// The Gaussians, for modification.
    #[inline]
    pub fn gaussians_mut(&mut self) -> &mut [WeightedGaussian] {
        &mut self.gaussians[..self.count]
    }

    /// A single Gaussian with the mean and the covariance of the whole distribution.
    #[inline]
    pub fn whole(&self) -> WeightedGaussian {
        if self.count == 1 {
            return self.gaussians[0];
        }
        let parts = self.gaussians().iter();
        let mean = parts.clone().fold(Slope::default(), |sum, part| sum + part.mean * part.weight);
        let covariance = parts.fold(Covariance::default(), |sum, part| {
            let Slope { x, y } = part.mean - mean;
            sum + (part.covariance + Covariance { xx: x * x, yy: y * y, xy: x * y }) * part.weight
        });
        WeightedGaussian { weight: 1.0, mean, covariance }
    }

    /// The moments of the whole distribution.
    pub fn moments(&self) -> Moments {
        self.gaussians().iter().fold(Moments::default(), |sum, gaussian| {
            sum + Moments::from_mean_and_covariance(gaussian.mean, gaussian.covariance) * gaussian.weight
        })
    }

    /// The distribution in another frame of the same tangent plane. The filtered normal keeps its length; its direction
    /// becomes that of its transformed slope.
    #[must_use]
    pub fn transformed(mut self, matrix: SlopeMatrix) -> Self {
        for gaussian in &mut self.gaussians[..self.count] {
            gaussian.mean = gaussian.mean.transformed(matrix);
            gaussian.covariance = gaussian.covariance.transformed(matrix);
        }
        let length = self.normal.length();
        let Slope { x, y } = Slope { x: self.normal.x, y: self.normal.y }.transformed(matrix);
        let turned = Normal { x, y, z: self.normal.z };
        let scale = if turned.length() > 0.0 { length / turned.length() } else { 0.0 };
        self.normal = Normal { x: x * scale, y: y * scale, z: turned.z * scale };
        self
    }

    /// The distribution of slopes that are this many times as steep, as of bumps of another height. Covariances grow with
    /// its square, and so does the logarithm of the filtered normal's length: the length of a sum of independent bumps is the
    /// product of theirs, and bumps without height leave a unit normal.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        self.transformed([[factor, 0.0], [0.0, factor]]).with_power_of_length(factor * factor)
    }

    /// As [`Distribution::scaled`], for bumps on a surface with a base roughness: if the covariances contain it, it keeps its slope
    /// variance, `base_variance` per axis.
    #[must_use]
    pub fn scaled_bumps(self, factor: f32, base_variance: f32) -> Self {
        match self.base {
            Base::None => self.scaled(factor),
            Base::Baked => self.without_base(base_variance).scaled(factor).with_base_variance(base_variance),
        }
    }

    /// As [`Distribution::transformed`], for bumps on a surface with a base roughness: if the covariances contain it, it keeps
    /// its slope variance, `base_variance` per axis, in the new frame.
    #[must_use]
    pub fn transformed_bumps(self, matrix: SlopeMatrix, base_variance: f32) -> Self {
        match self.base {
            Base::None => self.transformed(matrix),
            Base::Baked => {
                self.without_base(base_variance).transformed(matrix).with_base_variance(base_variance)
            }
        }
    }

    /// As [`Distribution::plus`], for bumps on one surface: if the covariances of both contain the base roughness, of the slope
    /// variance `base_variance` per axis, it counts once.
    #[must_use]
    pub fn plus_bumps(self, other: Self, base_variance: f32) -> Self {
        match self.base {
            Base::None => self.plus(other),
            Base::Baked => self.plus(other.without_base(base_variance)),
        }
    }

    /// The distribution without the base roughness that its covariances contain, of this slope variance per axis. One that
    /// does not contain it is unchanged. Rounding of stored moments may leave a covariance that is not valid; shading
    /// repairs it.
    #[must_use]
    pub fn without_base(self, variance: f32) -> Self {
        match self.base {
            Base::None => self,
            Base::Baked => self.widened(Covariance::isotropic(-variance)).with_base(Base::None),
        }
    }

    /// The distribution with a base roughness of this slope variance per axis in its covariances.
    #[must_use]
    pub fn with_base_variance(self, variance: f32) -> Self {
        self.widened(Covariance::isotropic(variance)).with_base(Base::Baked)
    }

    /// The distribution with a power of the length of its filtered normal, which falls as variances grow: 0 leaves a unit normal, 2
    /// the normal of two independent sources of the same bumps.
    #[must_use]
    pub fn with_power_of_length(self, power: f32) -> Self {
        let Normal { x, y, z } = self.normal;
        let length = self.normal.length().max(LEAST_LENGTH);
        let scale = length.powf(power) / length;
        self.with_normal(Normal { x: x * scale, y: y * scale, z: z * scale })
    }

    /// The distribution with this covariance added to every Gaussian: that of other, independent bumps of mean zero.
    #[must_use]
    pub fn widened(mut self, covariance: Covariance) -> Self {
        for gaussian in &mut self.gaussians[..self.count] {
            gaussian.covariance = gaussian.covariance + covariance;
        }
        self
    }

    /// The distribution of the sum of two independent slopes: of bumps on top of others. Means and covariances add. Of
    /// two distributions with several Gaussians, the one with fewer, or else `other`, is taken as a whole. The
    /// covariances contain the base roughness if one of the two did.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        if self.count < other.count {
            return other.plus(self);
        }
        let mut sum = self.widened(other.whole().covariance);
        let shift = other.whole().mean;
        for gaussian in &mut sum.gaussians[..sum.count] {
            gaussian.mean = gaussian.mean + shift;
        }
        let slope = slope_of_filtered(self.normal) + slope_of_filtered(other.normal);
        let Normal { x, y, z } = normal_from_slope(slope);
        let length = self.normal.length() * other.normal.length();
        sum.normal = Normal { x: x * length, y: y * length, z: z * length };
        if other.base == Base::Baked {
            sum.base = Base::Baked;
        }
        sum
    }
}

/// The slope of a filtered normal of any length.
fn slope_of_filtered(Normal { x, y, z }: Normal) -> Slope {
    let z = z.max(LEAST_NORMAL_Z);
    Slope { x: x / z, y: y / z }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few f32 rounding errors of numbers near one.
    const ROUNDING: f32 = 1e-6;

    #[test]
    fn the_covariance_of_a_mixture_is_within_plus_between() {
        let part = |weight, x, variance| WeightedGaussian {
            weight,
            mean: Slope { x, y: 0.1 },
            covariance: Covariance::isotropic(variance),
        };
        let mixture =
            Distribution::mixture(&[part(0.25, -0.6, 0.02), part(0.75, 0.2, 0.04)]).expect("two parts");
        let covariance = mixture.whole().covariance;
        let of_moments = mixture.moments().covariance();
        assert!((covariance - of_moments).trace().abs() < ROUNDING, "{covariance:?} and {of_moments:?}");
        // Law of total covariance: 0.25 * 0.02 + 0.75 * 0.04 within, 0.25 * 0.75 * 0.8^2 between.
        assert!((covariance.xx - (0.035 + 0.12)).abs() < ROUNDING, "{covariance:?}");
        assert!((covariance.yy - 0.035).abs() < ROUNDING && covariance.xy.abs() < ROUNDING, "{covariance:?}");
    }

    #[test]
    fn a_mixture_has_one_to_four_parts() {
        let part = WeightedGaussian { weight: 0.2, ..WeightedGaussian::default() };
        for count in 0..=MAX_GAUSSIANS + 1 {
            let mixture = Distribution::mixture(&vec![part; count]);
            assert_eq!(
                mixture.map(|m| m.gaussians().len()),
                (1..=MAX_GAUSSIANS).contains(&count).then_some(count)
            );
        }
    }

    #[test]
    fn moments_of_independent_slopes_add() {
        let part = |weight, x, variance| WeightedGaussian {
            weight,
            mean: Slope { x, y: 0.1 },
            covariance: Covariance::isotropic(variance),
        };
        let two = Distribution::mixture(&[part(0.25, -0.6, 0.02), part(0.75, 0.2, 0.04)]).expect("two parts");
        let one =
            Distribution::gaussian(Slope { x: 0.3, y: -0.2 }, Covariance { xx: 0.03, yy: 0.01, xy: 0.005 });
        for sum in [two.plus(one), one.plus(two)] {
            assert_eq!(sum.gaussians().len(), 2);
            let (whole, a, b) = (sum.whole(), two.whole(), one.whole());
            let mean = whole.mean - (a.mean + b.mean);
            let covariance = whole.covariance - (a.covariance + b.covariance);
            assert!(mean.x.abs().max(mean.y.abs()) < ROUNDING, "{sum:?}");
            assert!(covariance.trace().abs().max(covariance.xy.abs()) < ROUNDING, "{sum:?}");
            let Slope { x, y } = slope_of_filtered(sum.normal());
            assert!((x - whole.mean.x).abs() < ROUNDING && (y - whole.mean.y).abs() < ROUNDING, "{sum:?}");
        }
        assert_eq!(one.plus(one.with_base(Base::Baked)).base(), Base::Baked);
        assert_eq!(one.with_base(Base::Baked).plus(one).base(), Base::Baked);
    }

    #[test]
    fn a_base_roughness_is_neither_scaled_nor_counted_twice() {
        const BASE: f32 = 0.125;
        let bumps =
            Distribution::gaussian(Slope { x: 0.5, y: -0.25 }, Covariance { xx: 0.5, yy: 0.25, xy: 0.125 });
        let rough = bumps.with_base_variance(BASE);
        assert_eq!(rough.without_base(BASE), bumps);
        for factor in [0.0, 0.5, -2.0] {
            assert_eq!(bumps.scaled_bumps(factor, BASE), bumps.scaled(factor));
            assert_eq!(rough.scaled_bumps(factor, BASE), bumps.scaled(factor).with_base_variance(BASE));
            let matrix = [[factor, 0.5], [0.0, 1.0]];
            let moved = bumps.transformed(matrix);
            assert_eq!(bumps.transformed_bumps(matrix, BASE), moved);
            assert_eq!(rough.transformed_bumps(matrix, BASE), moved.with_base_variance(BASE));
        }
        let both = bumps.plus(bumps);
        assert_eq!(bumps.plus_bumps(bumps, BASE), both);
        for sum in
            [rough.plus_bumps(bumps, BASE), bumps.plus_bumps(rough, BASE), rough.plus_bumps(rough, BASE)]
        {
            assert_eq!(sum, both.with_base_variance(BASE));
        }
    }

    #[test]
    fn bumps_without_height_leave_a_unit_normal_and_higher_ones_shorten_it() {
        let covariance = Covariance { xx: 0.09, yy: 0.04, xy: 0.01 };
        let shortened = Normal { x: 0.0, y: 0.0, z: 0.9 };
        let bumps = Distribution::gaussian(Slope { x: 0.1, y: -0.2 }, covariance).with_normal(shortened);
        assert_eq!(bumps.scaled(0.0).normal(), Normal { x: 0.0, y: 0.0, z: 1.0 });
        assert_eq!(bumps.scaled(0.0).whole().covariance, Covariance::default());
        assert!((bumps.scaled(1.0).normal().length() - 0.9).abs() < ROUNDING);
        // As four independent sources of the same bumps; dents shorten as bumps do.
        for factor in [2.0, -2.0] {
            let length = bumps.scaled(factor).normal().length();
            assert!((length - 0.9_f32.powi(4)).abs() < ROUNDING, "{length}");
        }
    }

    #[test]
    fn a_change_of_frame_keeps_the_length_of_the_normal() {
        let normal = Normal { x: 0.3, y: -0.1, z: 0.8 };
        let turned = Distribution::of_slope(Slope::default())
            .with_normal(normal)
            .transformed([[0.5, 0.2], [0.0, -2.0]]);
        assert!((turned.normal().length() - normal.length()).abs() < ROUNDING);
        let slope = Slope { x: 0.3 / 0.8, y: -0.1 / 0.8 }.transformed([[0.5, 0.2], [0.0, -2.0]]);
        let Normal { x, y, z } = turned.normal();
        assert!((x / z - slope.x).abs() < ROUNDING && (y / z - slope.y).abs() < ROUNDING);
    }
}
