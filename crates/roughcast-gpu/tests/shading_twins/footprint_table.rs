//! Masking and the footprint: the functions in WGSL and their Rust twins.

use roughcast::shading::*;

use crate::harness::{Gives, Twin};
use crate::inputs::Inputs;
use crate::table::{covariance, covariance_words, facet, gaussian, ggx, one, v3};

fn part(a: &[f32]) -> PixelPart {
    PixelPart { ratio: a[0], linear_trace: a[1] }
}

fn part_words(part: PixelPart) -> Vec<f32> {
    vec![part.ratio, part.linear_trace]
}

pub fn ratio(a: &[f32]) -> FootprintRatio {
    FootprintRatio {
        moments: part(a),
        variances: part(&a[2..]),
        linear_covariance: covariance(&a[4..]),
        magnified: a[7],
    }
}

fn ratio_words(ratio: FootprintRatio) -> Vec<f32> {
    let FootprintRatio { moments, variances, linear_covariance, magnified } = ratio;
    [part_words(moments), part_words(variances), covariance_words(linear_covariance), vec![magnified]]
        .concat()
}

fn variances_words(FilterVariances { moments, variances }: FilterVariances) -> Vec<f32> {
    [moments, variances].concat()
}

fn pair(a: &[f32]) -> [f32; 2] {
    [a[0], a[1]]
}

fn axes(a: &[f32]) -> FootprintAxes {
    FootprintAxes { squared_lengths: pair(a), along: pair(&a[2..]), across: pair(&a[4..]) }
}

fn axes_words(axes: FootprintAxes) -> Vec<f32> {
    [axes.squared_lengths, axes.along, axes.across].concat()
}

/// The words of a footprint's axes.
fn axes_of(inputs: &mut Inputs) -> Vec<f32> {
    let [ax, ay, bx, by] = inputs.footprint();
    axes_words(footprint_axes([ax, ay], [bx, by]))
}

/// A positive cosine to the normal, and a variance.
fn cosine_and_variance(inputs: &mut Inputs) -> Vec<f32> {
    vec![inputs.direction()[2].abs().max(1e-6), inputs.of_any_size(1e-6, 1.0).abs()]
}

pub fn masking_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "projected_variance",
            gives: Gives::Numbers,
            call: "put(projected_variance(f3(0u), f3(3u)));",
            arguments: |inputs| {
                // The covariance of a valid distribution: for others, almost nothing may be left after cancellation.
                let [xx, yy] = [0; 2].map(|_| inputs.of_any_size(1e-6, 1.0).abs());
                let xy = inputs.between(-0.9, 0.9) * (xx * yy).sqrt();
                [&[xx, yy, xy][..], &inputs.direction()].concat()
            },
            rust: |a, _, _| one(projected_variance(covariance(a), v3(&a[3..]))),
        },
        Twin {
            name: "gaussian_lambda",
            gives: Gives::Numbers,
            call: "put(gaussian_lambda(f(0u), f(1u)));",
            arguments: cosine_and_variance,
            rust: |a, _, _| one(gaussian_lambda(a[0], a[1])),
        },
        Twin {
            name: "visible_part",
            gives: Gives::Numbers,
            call: "put(visible_part(f(0u), f(1u), f(2u)));",
            arguments: |inputs| {
                let lambda = |inputs: &mut Inputs| inputs.of_any_size(1e-6, 1e6).abs();
                vec![inputs.direction()[2].abs().max(1e-6), lambda(inputs), lambda(inputs)]
            },
            rust: |a, _, _| one(visible_part(a[0], a[1], a[2])),
        },
        Twin {
            name: "facet_visible_part",
            gives: Gives::Numbers,
            call: "put(facet_visible_part(facet(0u), f3(4u), f3(7u), o()));",
            arguments: Inputs::facet_lobe,
            rust: |a, o, _| one(facet_visible_part(&facet(a), v3(&a[4..]), v3(&a[7..]), o)),
        },
        Twin {
            name: "gaussian_visible_part",
            gives: Gives::Numbers,
            call: "put(gaussian_visible_part(gaussian(0u), f3(6u), f3(9u), o()));",
            arguments: |inputs| {
                // The lobe calls the function only if both directions are above the surface.
                let mut words = inputs.gaussian_lobe();
                words[8] = words[8].abs().max(1e-6);
                words[11] = words[11].abs().max(1e-6);
                words
            },
            rust: |a, o, _| one(gaussian_visible_part(&gaussian(a), v3(&a[6..]), v3(&a[9..]), o)),
        },
        Twin {
            name: "ggx_lambda",
            gives: Gives::Numbers,
            call: "put(ggx_lambda(ggx(0u), f3(8u), f(11u)));",
            arguments: |inputs| {
                let mut words = inputs.ggx_lobe();
                words[11] = inputs.direction()[2].abs().max(1e-6);
                words.truncate(12);
                words
            },
            rust: |a, _, _| one(ggx_lambda(&ggx(a), v3(&a[8..]), a[11])),
        },
        Twin {
            name: "ggx_visible_part",
            gives: Gives::Numbers,
            call: "put(ggx_visible_part(ggx(0u), f3(8u), f3(11u)));",
            arguments: Inputs::ggx_lobe,
            rust: |a, _, _| one(ggx_visible_part(&ggx(a), v3(&a[8..]), v3(&a[11..]))),
        },
    ]
}

pub fn footprint_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "footprint_axes",
            gives: Gives::Axes,
            call: "put_axes(footprint_axes(f2(0u), f2(2u)));",
            arguments: |inputs| inputs.footprint().to_vec(),
            rust: |a, _, _| axes_words(footprint_axes(pair(a), pair(&a[2..]))),
        },
        Twin {
            name: "level_variances",
            gives: Gives::Numbers,
            call: "put_variances(level_variances(f(0u)));",
            // Between whole levels: at a whole level the variance is continuous, but the level rounded down is not.
            arguments: |inputs| vec![inputs.below(12) as f32 + inputs.between(-0.5, 1.0).clamp(0.01, 0.99)],
            rust: |a, _, _| variances_words(level_variances(a[0])),
        },
        Twin {
            name: "filter_level",
            gives: Gives::Numbers,
            call: "put(filter_level(FilterVariances(f2(0u), f2(2u))));",
            arguments: |inputs| {
                // Near level 0 the logarithm is a small difference.
                let level = inputs.between(0.2, 12.0);
                variances_words(level_variances(level))
            },
            rust: |a, _, _| one(FilterVariances { moments: pair(a), variances: pair(&a[2..]) }.level()),
        },
        Twin {
            name: "hardware_variances",
            gives: Gives::Numbers,
            call: "put_variances(hardware_variances(axes(0u), f(6u), f(7u)));",
            arguments: |inputs| {
                let taps = [1.0, 2.0, 16.0][inputs.below(3)];
                [axes_of(inputs), vec![taps, inputs.between(-1.0, 2.0)]].concat()
            },
            rust: |a, _, _| variances_words(hardware_variances(&axes(a), a[6], a[7])),
        },
        Twin {
            name: "pixel_factor",
            gives: Gives::Numbers,
            call: "put(pixel_factor(part(0u), f(2u)));",
            arguments: |inputs| [&inputs.ratio()[..2], &[inputs.of_any_size(1e-6, 4.0)]].concat(),
            rust: |a, _, _| one(part(a).factor(a[2])),
        },
        Twin {
            name: "pixel_covariance",
            gives: Gives::Numbers,
            call: "put3(pixel_covariance(ratio(0u), part(2u), f3(8u), f(11u)));",
            arguments: |inputs| [&inputs.ratio()[..], &inputs.covariance(), &[0.1 * inputs.unit()]].concat(),
            rust: |a, _, _| {
                let ratio = ratio(a);
                covariance_words(ratio.pixel_covariance(ratio.variances, covariance(&a[8..]), a[11]))
            },
        },
        Twin {
            name: "pixel_part",
            gives: Gives::Numbers,
            call: "put_part(pixel_part(f2(0u), f2(2u), f2(4u)));",
            arguments: |inputs| (0..6).map(|_| inputs.of_any_size(1e-6, 16.0).abs()).collect(),
            rust: |a, _, _| part_words(pixel_part(pair(a), pair(&a[2..]), pair(&a[4..]))),
        },
        Twin {
            name: "whole_footprint",
            gives: Gives::Numbers,
            // The function takes no arguments, but a shader that reads no input would have no binding for it.
            call: "put(f(0u)); put_ratio(whole_footprint());",
            arguments: |inputs| vec![inputs.unit()],
            rust: |a, _, _| [&a[..1], &ratio_words(FootprintRatio::WHOLE)].concat(),
        },
        Twin {
            name: "footprint_ratio",
            gives: Gives::Ratio,
            call: "put_ratio(footprint_ratio(axes(0u), FilterVariances(f2(6u), f2(8u)), f2(10u), f2(12u), o()));",
            arguments: |inputs| {
                let words = axes_of(inputs);
                let filter = hardware_variances(&axes(&words), [1.0, 16.0][inputs.below(2)], 0.0);
                [words, variances_words(filter), inputs.slope().to_vec(), inputs.slope().to_vec()].concat()
            },
            rust: |a, o, _| {
                let filter = FilterVariances { moments: pair(&a[6..]), variances: pair(&a[8..]) };
                ratio_words(footprint_ratio(&axes(a), &filter, pair(&a[10..]), pair(&a[12..]), o))
            },
        },
    ]
}
