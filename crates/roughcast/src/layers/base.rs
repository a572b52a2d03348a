//! Layers without their base roughness.

use super::LayerError;
use crate::distribution::Distribution;
use crate::moments::Moments;
use crate::roughness::Base;
use crate::texture::{MomentLevel, TextureInfo};

/// The distribution without the base roughness that it contains, whose slope variance per axis is `variance`; for a
/// texture that is [`TextureInfo::base_variance`]. A distribution without base is returned as it is. Rounding of stored moments
/// may leave a covariance that is not valid; shading repairs it.
///
/// # Errors
/// [`LayerError::VaryingBase`] if the variance is not known: NaN for a base that varies over the map.
pub fn without_base(distribution: Distribution, variance: f32) -> Result<Distribution, LayerError> {
    if distribution.base() == Base::None {
        return Ok(distribution);
    }
    if !(variance.is_finite() && variance >= 0.0) {
        return Err(LayerError::VaryingBase);
    }
    Ok(distribution.without_base(variance))
}

/// A decoded level without the base roughness that its texture contains.
///
/// # Errors
/// [`LayerError::VaryingBase`] if the base varies over the map.
pub fn level_without_base(level: MomentLevel, info: &TextureInfo) -> Result<MomentLevel, LayerError> {
    if info.base == Base::None {
        return Ok(level);
    }
    let (width, height) = (level.width(), level.height());
    let texels = level.moments().iter().map(|moments| {
        let whole = Distribution::gaussian(moments.mean, moments.covariance()).with_base(info.base);
        let covariance = without_base(whole, info.base_variance)?.whole().covariance.positive_semidefinite();
        Ok(Moments::from_mean_and_covariance(moments.mean, covariance))
    });
    let moments = texels.collect::<Result<Vec<_>, LayerError>>()?;
    Ok(MomentLevel::new(width, height, moments).expect("as many as before"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::Covariance;
    use crate::slope::Slope;
    use crate::texture::{Layout, Part};

    const VARIANCE: f32 = 0.125;

    fn bumps() -> Distribution {
        Distribution::gaussian(Slope { x: 0.5, y: 0.25 }, Covariance { xx: 0.25, yy: 0.5, xy: 0.0625 })
    }

    #[test]
    fn a_known_base_is_subtracted_once() {
        let baked = bumps().widened(Covariance::isotropic(VARIANCE)).with_base(Base::Baked);
        let alone = without_base(baked, VARIANCE).expect("it is known");
        assert_eq!(alone, bumps());
        assert_eq!(without_base(alone, VARIANCE), Ok(bumps()));
    }

    #[test]
    fn an_unknown_base_is_refused() {
        for odd in [f32::NAN, f32::INFINITY, -0.1] {
            assert_eq!(without_base(bumps().with_base(Base::Baked), odd), Err(LayerError::VaryingBase));
            assert!(without_base(bumps(), odd).is_ok());
        }
    }

    #[test]
    fn levels_lose_the_base_of_their_texture() {
        let own = bumps().whole();
        let level = |covariance| {
            let moments = Moments::from_mean_and_covariance(own.mean, covariance);
            MomentLevel::new(1, 1, vec![moments]).expect("one")
        };
        let mut info = TextureInfo::new(Layout::Lean, Part::Whole);
        let with_base = level(own.covariance + Covariance::isotropic(VARIANCE));
        assert_eq!(level_without_base(with_base.clone(), &info), Ok(with_base.clone()));
        (info.base, info.base_variance) = (Base::Baked, VARIANCE);
        assert_eq!(level_without_base(with_base.clone(), &info), Ok(level(own.covariance)));
        info.base_variance = f32::NAN;
        assert_eq!(level_without_base(with_base, &info), Err(LayerError::VaryingBase));
    }
}
