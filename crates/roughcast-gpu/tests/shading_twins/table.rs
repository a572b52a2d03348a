//! Every function of the WGSL library with its Rust twin.

use roughcast::shading::*;
use roughcast::{Covariance, Slope};

use crate::distribution_table::{distribution_twins, model_twins};
use crate::footprint_table::{footprint_twins, masking_twins};
use crate::harness::{Gives, Twin};
use crate::inputs::{Inputs, gaussian_words};
use crate::layers_table::layer_twins;
use crate::noise_table::noise_twins;
use crate::surface_table::bump_twins;
use crate::texel_table::texel_twins;
use crate::wave_table::wave_twins;

pub fn v3(a: &[f32]) -> [f32; 3] {
    [a[0], a[1], a[2]]
}

pub fn v4(a: &[f32]) -> [f32; 4] {
    [a[0], a[1], a[2], a[3]]
}

pub fn slope(a: &[f32]) -> Slope {
    Slope { x: a[0], y: a[1] }
}

pub fn covariance(a: &[f32]) -> Covariance {
    Covariance { xx: a[0], yy: a[1], xy: a[2] }
}

pub fn covariance_words(Covariance { xx, yy, xy }: Covariance) -> Vec<f32> {
    vec![xx, yy, xy]
}

pub fn facet(a: &[f32]) -> BumpFacet {
    BumpFacet { normal: v3(a), specular_power: a[3] }
}

pub fn facet_words(facet: BumpFacet) -> Vec<f32> {
    [&facet.normal[..], &[facet.specular_power]].concat()
}

pub fn gaussian(a: &[f32]) -> SlopeGaussian {
    SlopeGaussian { mean: slope(a), covariance: covariance(&a[2..]), determinant: a[5] }
}

pub fn ggx(a: &[f32]) -> GgxSurface {
    GgxSurface { normal: v3(a), alpha_along: a[3], tangent: v3(&a[4..]), alpha_across: a[7] }
}

pub fn ggx_words(ggx: GgxSurface) -> Vec<f32> {
    [&ggx.normal[..], &[ggx.alpha_along], &ggx.tangent, &[ggx.alpha_across]].concat()
}

fn normalized(v: [f64; 3]) -> Vec<f32> {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.iter().map(|x| (x / length) as f32).collect()
}

/// A single number that a function returns.
pub fn one(value: f32) -> Vec<f32> {
    vec![value]
}

fn view_and_light(inputs: &mut Inputs) -> Vec<f32> {
    [inputs.direction(), inputs.direction()].concat()
}

fn axis_and_direction(inputs: &mut Inputs) -> Vec<f32> {
    let words = inputs.facet_lobe();
    let exponent = inputs.options.specular_power;
    [&words[..3], &words[4..7], &[exponent]].concat()
}

pub fn normal(inputs: &mut Inputs) -> Vec<f32> {
    inputs.normal().to_vec()
}

fn lobe_and_light(inputs: &mut Inputs) -> Vec<f32> {
    let lobe = inputs.of_any_size(1e-6, 1e6).abs();
    let colours: Vec<f32> = (0..6).map(|_| inputs.unit()).collect();
    [&[lobe][..], &colours[..3], &view_and_light(inputs), &colours[3..]].concat()
}

fn surface_twins() -> Vec<Twin> {
    vec![Twin {
        name: "ggx_facet",
        gives: Gives::Ggx,
        call: "put_ggx(ggx_facet(f3(0u), f2(3u), f(5u), f(6u)));",
        arguments: |inputs| {
            let normal = unit_normal(inputs.normal());
            let direction = inputs.between(-3.2, 3.2).sin_cos();
            [&normal[..], &[direction.1, direction.0], &[inputs.unit(), inputs.unit()]].concat()
        },
        rust: |a, _, _| {
            let n = [a[0], a[1], a[2]].map(f64::from);
            let [x, y] = [a[3], a[4]].map(f64::from);
            let along = n[0] * x + n[1] * y;
            let tangent = normalized([x - along * n[0], y - along * n[1], -along * n[2]]);
            [&a[..3], &[a[5]], &tangent, &[a[6]]].concat()
        },
    }]
}

fn lobe_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "phong_lobe",
            gives: Gives::Numbers,
            call: "put(phong_lobe(facet(0u), f3(4u), f3(7u), o()));",
            arguments: |inputs| {
                let mut words = inputs.facet_lobe();
                // The lobe about the reflected ray has four times the variance of the lobe about the half vector.
                words[3] *= 0.25;
                words
            },
            rust: |a, o, _| one(phong_lobe(&facet(a), v3(&a[4..]), v3(&a[7..]), o)),
        },
        Twin {
            name: "blinn_phong_lobe",
            gives: Gives::Numbers,
            call: "put(blinn_phong_lobe(facet(0u), f3(4u), f3(7u), o()));",
            arguments: Inputs::facet_lobe,
            rust: |a, o, _| one(blinn_phong_lobe(&facet(a), v3(&a[4..]), v3(&a[7..]), o)),
        },
        Twin {
            name: "beckmann_lobe",
            gives: Gives::Numbers,
            call: "put(beckmann_lobe(facet(0u), f3(4u), f3(7u), o()));",
            arguments: Inputs::facet_lobe,
            rust: |a, o, _| one(beckmann_lobe(&facet(a), v3(&a[4..]), v3(&a[7..]), o)),
        },
        Twin {
            name: "gaussian_lobe",
            gives: Gives::Numbers,
            call: "put(gaussian_lobe(gaussian(0u), f3(6u), f3(9u), o()));",
            arguments: Inputs::gaussian_lobe,
            rust: |a, o, _| one(gaussian_lobe(&gaussian(a), v3(&a[6..]), v3(&a[9..]), o)),
        },
        Twin {
            name: "ggx_lobe",
            gives: Gives::Numbers,
            call: "put(ggx_lobe(ggx(0u), f3(8u), f3(11u), o()));",
            arguments: Inputs::ggx_lobe,
            rust: |a, o, _| one(ggx_lobe(&ggx(a), v3(&a[8..]), v3(&a[11..]), o)),
        },
    ]
}

fn part_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "both_above",
            gives: Gives::Numbers,
            call: "put(select(0.0, 1.0, both_above(f3(0u), f3(3u))));",
            arguments: view_and_light,
            rust: |a, _, _| one(f32::from(u8::from(a[2] > LEAST_HEIGHT && a[5] > LEAST_HEIGHT))),
        },
        Twin {
            name: "unit_normal",
            gives: Gives::Numbers,
            call: "put3(unit_normal(f3(0u)));",
            arguments: normal,
            rust: |a, _, _| unit_normal(v3(a)).to_vec(),
        },
        Twin {
            name: "bump_facet",
            gives: Gives::Numbers,
            call: "put_facet(bump_facet(f3(0u), f(3u)));",
            arguments: |inputs| [&inputs.normal()[..], &[inputs.options.specular_power]].concat(),
            rust: |a, _, _| facet_words(bump_facet(v3(a), a[3])),
        },
        Twin {
            name: "log_one_plus",
            gives: Gives::Numbers,
            call: "put(log_one_plus(f(0u)));",
            arguments: |inputs| vec![inputs.of_any_size(1e-12, 1e12).abs()],
            rust: |a, _, _| one(f64::from(a[0]).ln_1p() as f32),
        },
        Twin {
            name: "cosine_power",
            gives: Gives::Numbers,
            call: "put(cosine_power(f3(0u), f3(3u), f(6u)));",
            arguments: axis_and_direction,
            rust: |a, _, _| one(cosine_power(v3(a), v3(&a[3..]), a[6])),
        },
        Twin {
            name: "cosine_lobe",
            gives: Gives::Numbers,
            call: "put(cosine_lobe(f3(0u), f3(3u), f(6u), o().form));",
            arguments: axis_and_direction,
            rust: |a, o, _| one(cosine_lobe(v3(a), v3(&a[3..]), a[6], o.form)),
        },
        Twin {
            name: "base_covariance",
            gives: Gives::Numbers,
            call: "put3(base_covariance(f2(0u), o()));",
            arguments: |inputs| inputs.slope().to_vec(),
            rust: |a, o, _| covariance_words(base_covariance(slope(a), o)),
        },
        Twin {
            name: "positive_semidefinite",
            gives: Gives::Numbers,
            call: "put3(positive_semidefinite(f3(0u)));",
            arguments: |inputs| inputs.covariance().to_vec(),
            rust: |a, _, _| covariance_words(covariance(a).positive_semidefinite()),
        },
        Twin {
            name: "slope_gaussian",
            gives: Gives::Gaussian,
            call: "put_gaussian(slope_gaussian(f2(0u), f3(2u), o()));",
            arguments: |inputs| [&inputs.slope()[..], &inputs.covariance()].concat(),
            rust: |a, o, _| gaussian_words(&slope_gaussian(slope(a), covariance(&a[2..]), o)).to_vec(),
        },
        Twin {
            name: "squared_deviations",
            gives: Gives::Numbers,
            call: "put(squared_deviations(gaussian(0u), f2(6u)));",
            arguments: Inputs::offset_in_gaussian,
            rust: |a, _, _| one(squared_deviations(covariance(&a[2..]), a[5], [a[6], a[7]])),
        },
        Twin {
            name: "schlick",
            gives: Gives::Numbers,
            call: "put(schlick(f(0u), f(1u)));",
            arguments: |inputs| vec![inputs.unit(), inputs.between(-0.1, 1.1)],
            rust: |a, _, _| one(schlick(a[0], a[1])),
        },
        Twin {
            name: "ambient_radiance",
            gives: Gives::Numbers,
            call: "put3(ambient_radiance(f3(0u), f3(3u)));",
            arguments: |inputs| (0..6).map(|_| inputs.unit()).collect(),
            rust: |a, _, _| ambient_radiance(v3(a), v3(&a[3..])).to_vec(),
        },
        Twin {
            name: "diffuse_radiance",
            gives: Gives::Numbers,
            call: "put3(diffuse_radiance(f3(0u), f3(3u), f3(6u), f3(9u)));",
            arguments: |inputs| {
                let colours: Vec<f32> = (0..6).map(|_| inputs.unit()).collect();
                [&inputs.normal()[..], &colours[..3], &inputs.direction(), &colours[3..]].concat()
            },
            rust: |a, _, _| diffuse_radiance(v3(a), v3(&a[3..]), v3(&a[6..]), v3(&a[9..])).to_vec(),
        },
        Twin {
            name: "specular_radiance",
            gives: Gives::Numbers,
            call: "put3(specular_radiance(f(0u), f3(1u), f3(4u), f3(7u), f3(10u), o()));",
            arguments: lobe_and_light,
            rust: |a, o, _| {
                specular_radiance(a[0], v3(&a[1..]), v3(&a[4..]), v3(&a[7..]), v3(&a[10..]), o).to_vec()
            },
        },
    ]
}

/// All twins.
pub fn twins() -> Vec<Twin> {
    [
        part_twins(),
        masking_twins(),
        footprint_twins(),
        texel_twins(),
        distribution_twins(),
        model_twins(),
        surface_twins(),
        bump_twins(),
        lobe_twins(),
        noise_twins(),
        layer_twins(),
        wave_twins(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
