//! Distributions and the surfaces of models: the functions in WGSL and their Rust twins.

use roughcast::shading::*;
use roughcast::texture::Base;
use roughcast::{
    Covariance, Distribution, MAX_GAUSSIANS, Slope, SlopeMatrix, WeightedGaussian, normal_from_slope,
};

use crate::footprint_table::ratio;
use crate::harness::{Gives, Twin};
use crate::inputs::{Inputs, distribution_words, gaussian_words, weighted_words};
use crate::table::{covariance, covariance_words, facet_words, ggx_words, one, slope, v3};

/// Words of a distribution.
pub const WORDS: usize = 4 + 6 * MAX_GAUSSIANS;

pub fn weighted(a: &[f32]) -> WeightedGaussian {
    WeightedGaussian { weight: a[5], mean: slope(a), covariance: covariance(&a[2..]) }
}

/// A whole number that the tolerance computation may have perturbed.
fn whole(a: f32) -> usize {
    (a + 0.5) as usize
}

pub fn distribution(a: &[f32]) -> Distribution {
    let mut parts: Vec<_> = (0..MAX_GAUSSIANS).map(|place| weighted(&a[4 + 6 * place..])).collect();
    parts.retain(|part| part.weight > 0.0);
    let mixture = Distribution::mixture(&parts).expect("one to four");
    mixture.with_normal(v3(a).into()).with_base(Base::ALL[whole(a[3])])
}

/// Columns of a matrix.
fn matrix(inputs: &mut Inputs) -> Vec<f32> {
    (0..4).map(|_| inputs.between(-2.0, 2.0)).collect()
}

fn matrix_of(a: &[f32]) -> SlopeMatrix {
    [[a[0], a[2]], [a[1], a[3]]]
}

fn any(inputs: &mut Inputs) -> Vec<f32> {
    distribution_words(&inputs.distribution())
}

fn single(inputs: &mut Inputs) -> Vec<f32> {
    distribution_words(&inputs.mixture(1))
}

fn gaussian_and_base(inputs: &mut Inputs) -> Vec<f32> {
    let one = inputs.mixture(1);
    [&weighted_words(&one.gaussians()[0])[..], &[one.base() as u32 as f32]].concat()
}

fn mixture_words(surface: &MixtureSurface) -> Vec<f32> {
    let parts: Vec<_> = surface.gaussians().collect();
    let weight = |place: usize| parts.get(place).map_or(0.0, |(weight, _)| *weight);
    // Missing Gaussians repeat the first one.
    let part = |place: usize| gaussian_words(parts.get(place).unwrap_or(&parts[0]).1);
    let weights = (0..MAX_GAUSSIANS).map(weight);
    weights.chain((0..MAX_GAUSSIANS).flat_map(part)).collect()
}

pub fn distribution_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "slope_normal",
            gives: Gives::Numbers,
            call: "put3(slope_normal(f2(0u)));",
            arguments: |inputs| inputs.slope().to_vec(),
            rust: |a, _, _| normal_from_slope(slope(a)).to_array().to_vec(),
        },
        Twin {
            name: "one_gaussian",
            gives: Gives::Numbers,
            call: "put_distribution(one_gaussian(f3(0u), f2(3u), f3(5u), u32(f(8u) + 0.5)));",
            arguments: |inputs| {
                let base = inputs.below(2) as f32;
                [&inputs.normal()[..], &inputs.slope(), &inputs.covariance(), &[base]].concat()
            },
            rust: |a, _, _| {
                let one = Distribution::new(v3(a).into(), slope(&a[3..]), covariance(&a[5..]));
                distribution_words(&one.with_base(Base::ALL[whole(a[8])]))
            },
        },
        Twin {
            name: "distribution_of_slope",
            gives: Gives::Numbers,
            call: "put_distribution(distribution_of_slope(f2(0u)));",
            arguments: |inputs| inputs.slope().to_vec(),
            rust: |a, _, _| distribution_words(&Distribution::of_slope(slope(a))),
        },
        Twin {
            name: "distribution_of_normal",
            gives: Gives::Numbers,
            call: "put_distribution(distribution_of_normal(f3(0u)));",
            arguments: |inputs| inputs.normal().to_vec(),
            rust: |a, _, _| distribution_words(&Distribution::of_normal(v3(a).into())),
        },
        Twin {
            name: "weighted_mean",
            gives: Gives::Numbers,
            call: "put2(weighted_mean(weighted(0u)));",
            arguments: gaussian_and_base,
            rust: |a, _, _| vec![a[5] * a[0], a[5] * a[1]],
        },
        Twin {
            name: "weighted_covariance",
            gives: Gives::Numbers,
            call: "put3(weighted_covariance(weighted(0u), f2(6u)));",
            arguments: |inputs| {
                let gaussian = weighted_words(&inputs.mixture(1).gaussians()[0]);
                [&gaussian[..], &inputs.slope()].concat()
            },
            rust: |a, _, _| {
                let part = weighted(a);
                let Slope { x, y } = part.mean - slope(&a[6..]);
                let between = Covariance { xx: x * x, yy: y * y, xy: x * y };
                covariance_words((part.covariance + between) * part.weight)
            },
        },
        Twin {
            name: "whole_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(whole_gaussian(distribution(0u)));",
            arguments: any,
            rust: |a, _, _| weighted_words(&distribution(a).whole()).to_vec(),
        },
        Twin {
            name: "filtered_slope",
            gives: Gives::Numbers,
            call: "put2(filtered_slope(f3(0u)));",
            arguments: |inputs| inputs.normal().to_vec(),
            rust: |a, _, _| {
                let Slope { x, y } = Distribution::of_normal(v3(a).into()).whole().mean;
                vec![x, y]
            },
        },
        Twin {
            name: "transformed_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(transformed_gaussian(weighted(0u), mat2x2f(f2(6u), f2(8u))));",
            arguments: |inputs| {
                [&weighted_words(&inputs.mixture(1).gaussians()[0])[..], &matrix(inputs)].concat()
            },
            rust: |a, _, _| {
                let WeightedGaussian { weight, mean, covariance } = weighted(a);
                let matrix = matrix_of(&a[6..]);
                let (mean, covariance) = (mean.transformed(matrix), covariance.transformed(matrix));
                weighted_words(&WeightedGaussian { weight, mean, covariance }).to_vec()
            },
        },
        Twin {
            name: "transformed_distribution",
            gives: Gives::Numbers,
            call: "put_distribution(transformed_distribution(distribution(0u), mat2x2f(f2(28u), f2(30u))));",
            arguments: |inputs| [any(inputs), matrix(inputs)].concat(),
            rust: |a, _, _| distribution_words(&distribution(a).transformed(matrix_of(&a[WORDS..]))),
        },
        Twin {
            name: "with_power_of_length",
            gives: Gives::Numbers,
            call: "put_distribution(with_power_of_length(distribution(0u), f(28u)));",
            arguments: |inputs| [any(inputs), vec![2.0 * inputs.unit()]].concat(),
            rust: |a, _, _| distribution_words(&distribution(a).with_power_of_length(a[WORDS])),
        },
        Twin {
            name: "scaled_distribution",
            gives: Gives::Numbers,
            call: "put_distribution(scaled_distribution(distribution(0u), f(28u)));",
            arguments: |inputs| [any(inputs), vec![4.0 * inputs.unit() - 2.0]].concat(),
            rust: |a, _, _| distribution_words(&distribution(a).scaled(a[WORDS])),
        },
        Twin {
            name: "moved_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(moved_gaussian(weighted(0u), f2(6u), f3(8u)));",
            arguments: |inputs| {
                let (one, slope, more) = (inputs.mixture(1), inputs.slope(), inputs.covariance());
                [&weighted_words(&one.gaussians()[0])[..], &slope, &more].concat()
            },
            rust: |a, _, _| {
                let WeightedGaussian { weight, mean, covariance: own } = weighted(a);
                let (mean, covariance) = (mean + slope(&a[6..]), own + covariance(&a[8..]));
                weighted_words(&WeightedGaussian { weight, mean, covariance }).to_vec()
            },
        },
        Twin {
            name: "widened_distribution",
            gives: Gives::Numbers,
            call: "put_distribution(widened_distribution(distribution(0u), f3(28u)));",
            arguments: |inputs| [any(inputs), inputs.covariance().to_vec()].concat(),
            rust: |a, _, _| distribution_words(&distribution(a).widened(covariance(&a[WORDS..]))),
        },
        Twin {
            name: "distribution_sum",
            gives: Gives::Numbers,
            call: "put_distribution(distribution_sum(distribution(0u), distribution(28u)));",
            arguments: |inputs| {
                let fewer = 1 + inputs.below(4);
                let more = fewer + inputs.below(5 - fewer);
                [distribution_words(&inputs.mixture(more)), distribution_words(&inputs.mixture(fewer))]
                    .concat()
            },
            rust: |a, _, _| distribution_words(&distribution(a).plus(distribution(&a[WORDS..]))),
        },
        Twin {
            name: "scaled_bumps",
            gives: Gives::Numbers,
            call: "put_distribution(scaled_bumps(distribution(0u), f(28u), f(29u)));",
            arguments: |inputs| [any(inputs), vec![4.0 * inputs.unit() - 2.0, 0.01 * inputs.unit()]].concat(),
            rust: |a, _, _| distribution_words(&distribution(a).scaled_bumps(a[WORDS], a[WORDS + 1])),
        },
        Twin {
            name: "transformed_bumps",
            gives: Gives::Numbers,
            call: "put_distribution(transformed_bumps(distribution(0u), mat2x2f(f2(28u), f2(30u)), f(32u)));",
            arguments: |inputs| [any(inputs), matrix(inputs), vec![0.01 * inputs.unit()]].concat(),
            rust: |a, _, _| {
                let matrix = matrix_of(&a[WORDS..]);
                distribution_words(&distribution(a).transformed_bumps(matrix, a[WORDS + 4]))
            },
        },
        Twin {
            name: "sum_of_bumps",
            gives: Gives::Numbers,
            call: "put_distribution(sum_of_bumps(distribution(0u), distribution(28u), f(56u)));",
            arguments: |inputs| {
                let fewer = 1 + inputs.below(4);
                let more = fewer + inputs.below(5 - fewer);
                let [one, other] = [more, fewer].map(|count| {
                    let base = if inputs.below(2) == 0 { Base::None } else { Base::Baked };
                    distribution_words(&inputs.mixture(count).with_base(base))
                });
                [&one[..], &other, &[0.01 * inputs.unit()]].concat()
            },
            rust: |a, _, _| {
                let [one, other] = [a, &a[WORDS..]].map(distribution);
                distribution_words(&one.plus_bumps(other, a[2 * WORDS]))
            },
        },
        Twin {
            name: "base_in_map",
            gives: Gives::Numbers,
            call: "put(base_in_map(u32(f(0u) + 0.5), o()));",
            arguments: |inputs| vec![inputs.below(2) as f32],
            rust: |a, o, _| one(base_in_map(Base::ALL[whole(a[0])], o)),
        },
        Twin {
            name: "base_to_add",
            gives: Gives::Numbers,
            call: "put3(base_to_add(f2(0u), u32(f(2u) + 0.5), o()));",
            arguments: |inputs| [&inputs.slope()[..], &[inputs.below(2) as f32]].concat(),
            rust: |a, o, _| covariance_words(base_to_add(slope(a), Base::ALL[whole(a[2])], o)),
        },
        Twin {
            name: "pixel_gaussian",
            gives: Gives::Numbers,
            call: "put_weighted(pixel_gaussian(weighted(0u), ratio(6u), part(8u), f(14u)));",
            arguments: |inputs| {
                let gaussian = weighted_words(&inputs.mixture(1).gaussians()[0]);
                [&gaussian[..], &inputs.ratio(), &[0.1 * inputs.unit()]].concat()
            },
            rust: |a, _, _| {
                let (part, ratio) = (weighted(a), ratio(&a[6..]));
                let covariance = ratio.pixel_covariance(ratio.variances, part.covariance, a[14]);
                weighted_words(&WeightedGaussian { covariance, ..part }).to_vec()
            },
        },
        Twin {
            name: "pixel_distribution",
            gives: Gives::Numbers,
            call: "put_distribution(pixel_distribution(distribution(0u), ratio(28u), part(28u), o()));",
            arguments: |inputs| [single(inputs), inputs.ratio().to_vec()].concat(),
            rust: pixel_words,
        },
        Twin {
            name: "pixel_mixture",
            gives: Gives::Numbers,
            call: "put_distribution(pixel_mixture(distribution(0u), ratio(28u), part(28u), o()));",
            arguments: |inputs| [any(inputs), inputs.ratio().to_vec()].concat(),
            rust: pixel_words,
        },
    ]
}

fn pixel_words(a: &[f32], o: &ShadingOptions, _: &roughcast::texture::Packing) -> Vec<f32> {
    let ratio = ratio(&a[WORDS..]);
    distribution_words(&pixel_distribution(distribution(a), &ratio, ratio.moments, o))
}

pub fn model_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "phong_surface",
            gives: Gives::Numbers,
            call: "put_facet(phong_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| facet_words(phong_surface(&distribution(a), o)),
        },
        Twin {
            name: "blinn_phong_surface",
            gives: Gives::Numbers,
            call: "put_facet(blinn_phong_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| facet_words(blinn_phong_surface(&distribution(a), o)),
        },
        Twin {
            name: "beckmann_surface",
            gives: Gives::Numbers,
            call: "put_facet(beckmann_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| facet_words(beckmann_surface(&distribution(a), o)),
        },
        Twin {
            name: "toksvig_surface",
            gives: Gives::Numbers,
            call: "put_facet(toksvig_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| facet_words(toksvig_surface(&distribution(a), o)),
        },
        Twin {
            name: "off_centre_surface",
            gives: Gives::Gaussian,
            call: "put_gaussian(off_centre_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| gaussian_words(&off_centre_surface(&distribution(a), o)).to_vec(),
        },
        Twin {
            name: "shaded_gaussian",
            gives: Gives::Gaussian,
            call: "put_gaussian(shaded_gaussian(weighted(0u), u32(f(6u) + 0.5), o()));",
            arguments: gaussian_and_base,
            rust: |a, o, _| {
                gaussian_words(&shaded_gaussian(&weighted(a), Base::ALL[whole(a[6])], o)).to_vec()
            },
        },
        Twin {
            name: "gaussian_surface",
            gives: Gives::Gaussian,
            call: "put_gaussian(gaussian_surface(distribution(0u), o()));",
            arguments: single,
            rust: |a, o, _| gaussian_words(&gaussian_surface(&distribution(a), o)).to_vec(),
        },
        Twin {
            name: "mixture_surface",
            gives: Gives::Mixture,
            call: "put_mixture(mixture_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| mixture_words(&mixture_surface(&distribution(a), o)),
        },
        Twin {
            name: "mixture_lobe",
            gives: Gives::Numbers,
            call: "put(mixture_lobe(mixture_surface(distribution(0u), o()), f3(28u), f3(31u), o()));",
            arguments: Inputs::mixture_lobe,
            rust: |a, o, _| {
                let surface = mixture_surface(&distribution(a), o);
                one(mixture_lobe(&surface, v3(&a[WORDS..]), v3(&a[WORDS + 3..]), o))
            },
        },
        Twin {
            name: "principal_axes",
            gives: Gives::Numbers,
            call: "let axes = principal_axes(f3(0u)); put2(axes.direction); put(axes.larger); put(axes.smaller);",
            arguments: |inputs| {
                let [xx, yy, xy] = inputs.covariance();
                covariance_words(Covariance { xx, yy, xy }.positive_semidefinite())
            },
            rust: |a, _, _| {
                let PrincipalAxes { direction, larger, smaller } = principal_axes(covariance(a));
                [&direction[..], &[larger, smaller]].concat()
            },
        },
        Twin {
            name: "ggx_surface",
            gives: Gives::Ggx,
            call: "put_ggx(ggx_surface(distribution(0u), o()));",
            arguments: any,
            rust: |a, o, _| ggx_words(ggx_surface(&distribution(a), o)),
        },
    ]
}
