//! Layers mixed per pixel, from their filtered slopes.

use super::cross::{cross_of, doubles};
use super::error::check_weights;
use super::{CrossMoments, LayerError, LayerMethod, pair_count, pairs};
use crate::distribution::Distribution;
use crate::moments::{Covariance, Moments};
use crate::roughness::Base;
use crate::slope::Slope;

/// The raw moments of height fields mixed with these weights: `B = Σ tᵢBᵢ`, `M = Σ tᵢ² Mᵢ + Σ tᵢtⱼ Cᵢⱼ` over all pairs, in
/// the order of [`pairs`]. The filtered cross terms give [`LayerMethod::MixingTextures`]; those of the means,
/// [`CrossMoments::of_slopes`], give [`LayerMethod::Approximate`].
///
/// For shading use [`mixed`] or [`approximated`], whose covariances keep their precision.
///
/// Source: LEAN mapping, Eqs. 7 to 9.
///
/// # Errors
/// [`LayerError`] if there are no layers, their weights are not finite or do not sum to one, or the number of cross terms is
/// wrong.
pub fn mixed_moments(layers: &[(f32, Moments)], cross: &[CrossMoments]) -> Result<Moments, LayerError> {
    check(LayerMethod::MixingTextures, layers)?;
    check_pairs(layers.len(), cross.len())?;
    let (mut mean, mut second) = ([0.0; 2], [0.0; 3]);
    for (weight, moments) in layers {
        let t = f64::from(*weight);
        let [x, y] = doubles(moments.mean);
        mean = [mean[0] + t * x, mean[1] + t * y];
        add(&mut second, t * t, [moments.xx, moments.yy, moments.xy]);
    }
    for ((i, j), cross) in pairs(layers.len()).zip(cross) {
        add(&mut second, f64::from(layers[i].0) * f64::from(layers[j].0), [cross.xx, cross.yy, cross.xy]);
    }
    let [xx, yy, xy] = second.map(|value| value as f32);
    Ok(Moments { mean: Slope { x: mean[0] as f32, y: mean[1] as f32 }, xx, yy, xy })
}

fn add(sum: &mut [f64; 3], factor: f64, values: [f32; 3]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * f64::from(value);
    }
}

/// Layers mixed with their cross terms, in the order of [`pairs`]: way (b). One Gaussian; a layer with several counts as a
/// whole. Slopes of weights that vary under the footprint are left out.
///
/// # Errors
/// [`LayerError`] if there are no layers, one contains base roughness, their weights are not finite or do not sum to one,
/// or the number of cross terms is wrong.
pub fn mixed(layers: &[(f32, Distribution)], cross: &[CrossMoments]) -> Result<Distribution, LayerError> {
    check_pairs(layers.len(), cross.len())?;
    let sum = sum_of(LayerMethod::MixingTextures, layers)?;
    let means: Vec<[f64; 2]> = layers.iter().map(|(_, layer)| doubles(layer.whole().mean)).collect();
    let mut in_common = [0.0; 3];
    for ((i, j), cross) in pairs(layers.len()).zip(cross) {
        let factor = f64::from(layers[i].0) * f64::from(layers[j].0);
        let explained = cross_of([means[i], means[j]]);
        for ((sum, cross), explained) in
            in_common.iter_mut().zip([cross.xx, cross.yy, cross.xy]).zip(explained)
        {
            *sum += factor * (f64::from(cross) - explained);
        }
    }
    let [xx, yy, xy] = in_common.map(|value| value as f32);
    Ok(correlated_layers(sum, Covariance { xx, yy, xy }))
}

/// Layers mixed as if they were uncorrelated: way (c). `B = Σ tᵢBᵢ`, `Σ = Σ tᵢ² Σᵢ`, which is what Eqs. 7 to 9 give with the
/// cross terms of the filtered means. Layers may have any resolutions. Of several layers with several Gaussians, the one
/// with most keeps them.
///
/// It is exact at the texel centres of level 0, where every layer is a single slope. Elsewhere it is off by what the
/// layers have in common: an equal mix of a map with itself keeps half of its covariance, and so does a mix with its
/// inverse, which should be flat. Slopes of weights that vary under the footprint are left out.
///
/// # Errors
/// [`LayerError`] if there are no layers, one contains base roughness, or their weights are not finite or do not sum to one.
pub fn approximated(layers: &[(f32, Distribution)]) -> Result<Distribution, LayerError> {
    sum_of(LayerMethod::Approximate, layers)
}

/// Independent bumps on top of each other: the same as [`approximated`], with factors of heights that need not sum to one.
///
/// # Errors
/// [`LayerError`] if there are no layers, one contains base roughness, or a factor is not finite.
pub fn added(layers: &[(f32, Distribution)]) -> Result<Distribution, LayerError> {
    sum_of(LayerMethod::Add, layers)
}

fn sum_of(method: LayerMethod, layers: &[(f32, Distribution)]) -> Result<Distribution, LayerError> {
    check(method, layers)?;
    if let Some(layer) = layers.iter().position(|(_, layer)| layer.base() == Base::Baked) {
        return Err(LayerError::Base { layer });
    }
    let weighted = layers.iter().map(|(weight, layer)| layer.scaled(*weight));
    Ok(weighted.reduce(Distribution::plus).expect("there are layers"))
}

fn check<T>(method: LayerMethod, layers: &[(f32, T)]) -> Result<(), LayerError> {
    check_weights(method, layers.iter().map(|(weight, _)| f64::from(*weight)))
}

pub(super) fn check_pairs(layers: usize, got: usize) -> Result<(), LayerError> {
    let wanted = pair_count(layers);
    if got == wanted { Ok(()) } else { Err(LayerError::PairCount { layers, wanted, got }) }
}

/// A sum of uncorrelated layers, corrected by the sum over all pairs of `tᵢtⱼ Kᵢⱼ`, the [`CrossMoments::covariance`] of the
/// pair times both weights. One Gaussian, whose covariance may not be valid because of rounding.
///
/// The shortening of the filtered normal follows the trace of the covariance; without variance it has unit length.
pub fn correlated_layers(sum: Distribution, in_common: Covariance) -> Distribution {
    let whole = sum.whole();
    let covariance = whole.covariance + in_common;
    let (before, after) = (whole.covariance.trace(), covariance.trace());
    let power = if before > 0.0 { (after / before).max(0.0) } else { 1.0 };
    let one = Distribution::new(sum.normal(), whole.mean, covariance).with_base(sum.base());
    one.with_power_of_length(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slope::Normal;

    fn layer(x: f32, y: f32, xx: f32, yy: f32, xy: f32) -> Distribution {
        let gaussian = Distribution::gaussian(Slope { x, y }, Covariance { xx, yy, xy });
        gaussian.with_normal(Normal { x: 0.1, y: -0.2, z: 0.8 })
    }

    const NONE: CrossMoments = CrossMoments { xx: 0.0, yy: 0.0, xy: 0.0 };

    #[test]
    fn a_weight_of_one_gives_back_the_layer() {
        /// Rounding of a filtered normal.
        const ROUNDING: f32 = 1e-6;
        let layers = [layer(0.3, -0.2, 0.5, 0.2, 0.1), layer(-0.7, 0.4, 0.1, 0.3, -0.05)];
        let cross = CrossMoments { xx: 0.3, yy: -0.4, xy: 0.2 };
        for only in 0..2 {
            let weighted: Vec<_> = (0..2).map(|i| (f32::from(u8::from(i == only)), layers[i])).collect();
            for got in [mixed(&weighted, &[cross]), approximated(&weighted), added(&weighted)] {
                let got = got.expect("valid weights");
                assert_eq!(got.whole(), layers[only].whole());
                let (got, wanted) = (got.normal().to_array(), layers[only].normal().to_array());
                assert!(got.iter().zip(wanted).all(|(g, w)| (g - w).abs() < ROUNDING), "{got:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn bumps_that_cancel_have_a_normal_of_unit_length() {
        let ridges = |sign: f32| layer(0.0, 0.0, 0.5, 0.0, 0.0).transformed([[sign, 0.0], [0.0, sign]]);
        let cross = CrossMoments { xx: -1.0, ..NONE };
        let smooth = mixed(&[(0.5, ridges(1.0)), (0.5, ridges(-1.0))], &[cross]).expect("valid");
        assert_eq!(smooth.whole().covariance, Covariance::default());
        assert!((smooth.normal().length() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn bad_layers_are_refused() {
        let one = layer(0.0, 0.0, 0.1, 0.1, 0.0);
        assert_eq!(mixed(&[], &[]), Err(LayerError::NoLayers));
        assert_eq!(approximated(&[]), Err(LayerError::NoLayers));
        let odd = approximated(&[(f32::INFINITY, one)]);
        assert_eq!(odd, Err(LayerError::Weight { layer: 0, got: f64::INFINITY }));
        assert!(added(&[(1.0, one), (f32::NAN, one)]).is_err());
        let half = [(0.5, one), (0.25, one)];
        let sum = |method| LayerError::WeightSum { method, got: 0.75 };
        assert_eq!(approximated(&half), Err(sum(LayerMethod::Approximate)));
        assert_eq!(mixed(&half, &[NONE]), Err(sum(LayerMethod::MixingTextures)));
        assert!(added(&half).is_ok());
        let two = [(0.5, one), (0.5, one)];
        assert_eq!(mixed(&two, &[]), Err(LayerError::PairCount { layers: 2, wanted: 1, got: 0 }));
        let based = [(0.5, one), (0.5, one.with_base(Base::Baked))];
        for got in [mixed(&based, &[NONE]), approximated(&based), added(&based)] {
            assert_eq!(got, Err(LayerError::Base { layer: 1 }));
        }
    }
}
