//! Functions from filtered texels to distributions, in WGSL and as Rust twins.

use roughcast::texture::*;
use roughcast::{Distribution, variance_from_stored};

use crate::harness::{Gives, Twin};
use crate::inputs::{Inputs, distribution_words};
use crate::table::{normal, one, v3, v4};

fn words(distribution: Distribution) -> Vec<f32> {
    distribution_words(&distribution)
}

/// Toksvig's texel.
fn toksvig(inputs: &mut Inputs) -> Vec<f32> {
    let unit = inputs.packing.unit;
    let mut words: Vec<f32> = inputs.normal().iter().map(|value| Inputs::stored(*value, unit)).collect();
    words.push(inputs.unit());
    words
}

fn clean(inputs: &mut Inputs) -> Vec<f32> {
    let ([x, y], Packing { slope, trace, .. }) = (inputs.slope(), inputs.packing);
    // Some second moments are rounded to below the square of the mean.
    let variance = inputs.of_any_size(1e-6, 1.0).max(-1e-4);
    let stored = [Inputs::stored(x, slope), Inputs::stored(y, slope)];
    [&stored[..], &[Inputs::stored(x * x + y * y + variance, trace), 1.0]].concat()
}

fn variance(inputs: &mut Inputs) -> Vec<f32> {
    let ([x, y], [xx, yy, _]) = (inputs.slope(), inputs.covariance());
    let Packing { slope, spread, .. } = inputs.packing;
    [(x, slope), (y, slope), (xx, spread), (yy, spread)].map(|(v, pair)| Inputs::stored(v, pair)).to_vec()
}

/// Schilling's two texels.
fn schilling(inputs: &mut Inputs) -> Vec<f32> {
    let (normal, [x, y]) = (inputs.normal(), inputs.slope());
    let Packing { slope, spread, signed_spread, unit, .. } = inputs.packing;
    let (d1, d2, d3) = (inputs.unit(), inputs.between(-1.0, 1.0), inputs.unit());
    let stored = Inputs::stored;
    let first = [stored(normal[0], unit), stored(normal[1], unit), normal[2], stored(d2, signed_spread)];
    let second = [stored(x, slope), stored(y, slope), stored(d1, spread), stored(d3, spread)];
    [first, second].concat()
}

pub fn texel_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "bump_normal",
            gives: Gives::Numbers,
            call: "put3(bump_normal(f4(0u), p()));",
            arguments: |inputs| inputs.lean()[..4].to_vec(),
            rust: |a, _, p| bump_normal(v4(a), p).to_vec(),
        },
        Twin {
            name: "normal_moments",
            gives: Gives::Numbers,
            call: "put_distribution(normal_moments(f3(0u)));",
            arguments: normal,
            rust: |a, _, _| words(normal_moments(v3(a))),
        },
        Twin {
            name: "lean_moments",
            gives: Gives::Numbers,
            call: "put_distribution(lean_moments(f4(0u), f4(4u), p()));",
            arguments: Inputs::lean,
            rust: |a, _, p| words(lean_moments(v4(a), v4(&a[4..]), p)),
        },
        Twin {
            name: "clean_moments",
            gives: Gives::Numbers,
            call: "put_distribution(clean_moments(f4(0u), p()));",
            arguments: clean,
            rust: |a, _, p| words(clean_moments(v4(a), p)),
        },
        Twin {
            name: "variance_moments",
            gives: Gives::Numbers,
            call: "put_distribution(variance_moments(f4(0u), p()));",
            arguments: variance,
            rust: |a, _, p| words(variance_moments(v4(a), p)),
        },
        Twin {
            name: "schilling_moments",
            gives: Gives::Numbers,
            call: "put_distribution(schilling_moments(f4(0u), f4(4u), p()));",
            arguments: schilling,
            rust: |a, _, p| words(schilling_moments(v4(a), v4(&a[4..]), p)),
        },
        Twin {
            name: "schilling_isotropic_moments",
            gives: Gives::Numbers,
            call: "put_distribution(schilling_isotropic_moments(f4(0u), p()));",
            arguments: variance,
            rust: |a, _, p| words(schilling_isotropic_moments(v4(a), p)),
        },
        Twin {
            name: "toksvig_normal",
            gives: Gives::Numbers,
            call: "put3(toksvig_normal(f4(0u), p()));",
            arguments: toksvig,
            rust: |a, _, p| toksvig_normal(v4(a), p).to_vec(),
        },
        Twin {
            name: "toksvig_moments",
            gives: Gives::Numbers,
            call: "put_distribution(toksvig_moments(f4(0u), p(), o()));",
            arguments: toksvig,
            rust: |a, o, p| words(toksvig_moments(v4(a), p, o)),
        },
        Twin {
            name: "pbr_normal",
            gives: Gives::Numbers,
            call: "put3(pbr_normal(f4(0u), p()));",
            arguments: Inputs::material,
            rust: |a, _, p| pbr_normal(v4(a), p).to_vec(),
        },
        Twin {
            name: "pbr_moments",
            gives: Gives::Numbers,
            call: "put_distribution(pbr_moments(f4(0u), f(4u), f4(5u), p()));",
            arguments: Inputs::material,
            rust: |a, _, p| words(pbr_moments(v4(a), a[4], v4(&a[5..]), p)),
        },
        Twin {
            name: "variance_from_stored",
            gives: Gives::Numbers,
            call: "put(variance_from_stored(f(0u), p().roughness_stored));",
            arguments: |inputs| vec![inputs.material()[4]],
            rust: |a, _, p| {
                let power = p.roughness_stored == RoughnessStored::SpecularPower;
                let stored = if power { a[0].max(LEAST_STORED_POWER) } else { a[0] };
                one(variance_from_stored(stored, p.roughness_stored))
            },
        },
    ]
}
