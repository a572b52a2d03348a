//! Layers and blends of normals: the functions in WGSL and their Rust twins.

use roughcast::layers::*;
use roughcast::texture::Base;
use roughcast::{Distribution, MAX_GAUSSIANS, Moments, Slope, WeightedGaussian, normal_from_slope};

use crate::distribution_table::{WORDS, distribution, weighted};
use crate::harness::{Gives, Twin};
use crate::inputs::{Inputs, distribution_words, weighted_words};
use crate::table::{covariance, covariance_words, slope, v3};

/// Two mean slopes.
fn means(inputs: &mut Inputs) -> Vec<f32> {
    (0..4).map(|_| inputs.between(-1.0, 1.0)).collect()
}

/// A filtered cross term of layers with these means, in which something besides the means remains.
fn raw_cross(inputs: &mut Inputs, means: &[f32]) -> Vec<f32> {
    let CrossMoments { xx, yy, xy } = CrossMoments::of_slopes(slope(means), slope(&means[2..]));
    [xx, yy, xy].map(|explained| explained + inputs.of_any_size(0.01, 1.0)).to_vec()
}

/// One Gaussian, and a correction that leaves something of its variances.
fn correlated(inputs: &mut Inputs) -> Vec<f32> {
    let [xx, yy] = [(); 2].map(|()| inputs.of_any_size(1e-4, 1.0).abs());
    let limit = (xx * yy).sqrt();
    let [mean_x, mean_y] = inputs.slope();
    let gaussian = WeightedGaussian {
        weight: 1.0,
        mean: Slope { x: mean_x, y: mean_y },
        covariance: covariance(&[xx, yy, limit * inputs.between(0.1, 0.9)]),
    };
    let one = Distribution::mixture(&[gaussian]).expect("one").with_normal(inputs.normal().into());
    let in_common =
        [xx * inputs.between(-0.9, 1.0), yy * inputs.between(-0.9, 1.0), limit * inputs.between(0.1, 0.9)];
    [&distribution_words(&one)[..], &in_common].concat()
}

/// A mask, and moments that are premultiplied by it; without a mask in one case in eight.
fn premultiplied(inputs: &mut Inputs) -> Vec<f32> {
    let mask = if inputs.below(8) == 0 { 0.0 } else { inputs.of_any_size(0.01, 1.0).abs() };
    let mean = Slope { x: inputs.between(-1.0, 1.0), y: inputs.between(-1.0, 1.0) };
    let [xx, yy] = [(); 2].map(|()| inputs.of_any_size(0.01, 1.0).abs());
    let xy = (xx * yy).sqrt() * inputs.between(0.1, 0.9);
    let MaskedMoments { mask, moments } =
        MaskedMoments::of(mask, Moments::from_mean_and_covariance(mean, covariance(&[xx, yy, xy])));
    let Moments { mean, xx, yy, xy } = moments;
    vec![mask, mean.x, mean.y, xx, yy, xy]
}

/// Four masked layers, of which the last may not be seen; one case in sixteen has none.
fn masks(inputs: &mut Inputs) -> Vec<f32> {
    let seen = if inputs.below(16) == 0 { 0 } else { 1 + inputs.below(MAX_GAUSSIANS) };
    let mut layer = |place: usize| {
        let mut words = weighted_words(&inputs.mixture(1).gaussians()[0]);
        words[5] = inputs.of_any_size(0.01, 1.0).abs();
        if place < seen { words } else { [0.0; 6] }
    };
    (0..MAX_GAUSSIANS).flat_map(&mut layer).collect()
}

/// A unit normal in front of the surface: that of a slope below 2.
fn unit(inputs: &mut Inputs) -> [f32; 3] {
    let slope = Slope { x: inputs.between(-1.4, 1.4), y: inputs.between(-1.4, 1.4) };
    normal_from_slope(slope).to_array()
}

fn two_normals(inputs: &mut Inputs) -> Vec<f32> {
    let base = match inputs.below(16) {
        0 => [0.0, 0.0, -1.0],
        1 => [0.0, 0.0, 1.0],
        _ => unit(inputs),
    };
    [base, unit(inputs)].concat()
}

fn blended(blend: NormalBlend, a: &[f32]) -> Vec<f32> {
    blend.blend(v3(a).into(), v3(&a[3..]).into()).to_array().to_vec()
}

pub fn layer_twins() -> Vec<Twin> {
    [mix_twins(), mask_twins(), blend_twins()].into_iter().flatten().collect()
}

fn mix_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "cross_moments",
            gives: Gives::Numbers,
            call: "put3(cross_moments(f2(0u), f2(2u)));",
            arguments: |inputs| [inputs.slope(), inputs.slope()].concat(),
            rust: |a, _, _| {
                let CrossMoments { xx, yy, xy } = CrossMoments::of_slopes(slope(a), slope(&a[2..]));
                vec![xx, yy, xy]
            },
        },
        Twin {
            name: "cross_covariance",
            gives: Gives::Numbers,
            call: "put3(cross_covariance(f3(4u), f2(0u), f2(2u)));",
            arguments: |inputs| {
                let means = means(inputs);
                [&means[..], &raw_cross(inputs, &means)].concat()
            },
            rust: |a, _, _| {
                let raw = CrossMoments { xx: a[4], yy: a[5], xy: a[6] };
                covariance_words(raw.covariance(slope(a), slope(&a[2..])))
            },
        },
        Twin {
            name: "correlated_layers",
            gives: Gives::Numbers,
            call: "put_distribution(correlated_layers(distribution(0u), f3(28u)));",
            arguments: correlated,
            rust: |a, _, _| distribution_words(&correlated_layers(distribution(a), covariance(&a[WORDS..]))),
        },
        Twin {
            name: "without_base",
            gives: Gives::Numbers,
            call: "put_distribution(without_base(distribution(0u), f(28u)));",
            arguments: |inputs| {
                let variance = inputs.of_any_size(1e-4, 0.1).abs();
                let widened =
                    inputs.distribution().widened(covariance(&[2.0 * variance, 2.0 * variance, 0.0]));
                [distribution_words(&widened), vec![variance]].concat()
            },
            rust: |a, _, _| {
                let bumps = without_base(distribution(a), a[WORDS]).expect("it is known");
                assert_eq!(bumps.base(), Base::None);
                distribution_words(&bumps)
            },
        },
    ]
}

fn mask_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "masked_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(masked_gaussian(f(0u), f2(1u), f3(3u)));",
            arguments: premultiplied,
            rust: |a, _, _| {
                let moments = Moments { mean: slope(&a[1..]), xx: a[3], yy: a[4], xy: a[5] };
                weighted_words(&masked_gaussian(MaskedMoments { mask: a[0], moments })).to_vec()
            },
        },
        Twin {
            name: "reweighted_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(reweighted_gaussian(weighted(0u), f(6u)));",
            arguments: |inputs| {
                let weight = [0.0, inputs.unit()][inputs.below(2)];
                [&weighted_words(&inputs.mixture(1).gaussians()[0])[..], &[weight]].concat()
            },
            rust: |a, _, _| {
                let part = WeightedGaussian { weight: a[6], ..weighted(a) };
                weighted_words(&if a[6] > 0.0 { part } else { WeightedGaussian::default() }).to_vec()
            },
        },
        Twin {
            name: "masked_layers",
            gives: Gives::Numbers,
            call: "put_distribution(masked_layers(weighted(0u), weighted(6u), weighted(12u), weighted(18u)));",
            arguments: masks,
            rust: |a, _, _| {
                let layers = std::array::from_fn(|place| weighted(&a[6 * place..]));
                distribution_words(&masked_layers(layers))
            },
        },
    ]
}

fn blend_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "blended_unit",
            gives: Gives::Numbers,
            call: "put3(blended_unit(f3(0u)));",
            arguments: |inputs| {
                let size = [0.0, inputs.of_any_size(1e-3, 1e3)][usize::from(inputs.below(16) > 0)];
                unit(inputs).map(|component| size * component).to_vec()
            },
            rust: |a, _, _| {
                let length = a.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
                if length == 0.0 {
                    return vec![0.0, 0.0, 1.0];
                }
                a.iter().map(|x| (f64::from(*x) / length) as f32).collect()
            },
        },
        Twin {
            name: "blend_udn",
            gives: Gives::Numbers,
            call: "put3(blend_udn(f3(0u), f3(3u)));",
            arguments: two_normals,
            rust: |a, _, _| blended(NormalBlend::Udn, a),
        },
        Twin {
            name: "blend_whiteout",
            gives: Gives::Numbers,
            call: "put3(blend_whiteout(f3(0u), f3(3u)));",
            arguments: two_normals,
            rust: |a, _, _| blended(NormalBlend::Whiteout, a),
        },
        Twin {
            name: "blend_reoriented",
            gives: Gives::Numbers,
            call: "put3(blend_reoriented(f3(0u), f3(3u)));",
            arguments: two_normals,
            rust: |a, _, _| blended(NormalBlend::Reoriented, a),
        },
        Twin {
            name: "blend_partial_derivatives",
            gives: Gives::Numbers,
            call: "put3(blend_partial_derivatives(f3(0u), f3(3u)));",
            arguments: two_normals,
            rust: |a, _, _| blended(NormalBlend::PartialDerivatives, a),
        },
    ]
}
