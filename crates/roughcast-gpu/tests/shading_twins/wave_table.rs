//! Waves and Gabor noise: the functions in WGSL and their Rust twins.

use std::f64::consts::TAU;

use glam::DVec2;
use roughcast::noise::{GaborNoise, GaborSample};
use roughcast::waves::{Wave, WaveSlopes, gerstner_slope};

use crate::harness::{Gives, Twin};
use crate::inputs::Inputs;
use crate::noise_table::{mixed, whole};
use crate::table::one;

fn pair(a: &[f32]) -> DVec2 {
    DVec2::new(a[0].into(), a[1].into())
}

fn wave(a: &[f32]) -> Wave {
    Wave { vector: pair(a), amplitude: a[2].into(), phase: a[3].into() }
}

fn singles(numbers: &[f64]) -> Vec<f32> {
    numbers.iter().map(|number| *number as f32).collect()
}

/// A wave whose slopes are of the size of one, and a position.
fn wave_and_position(inputs: &mut Inputs) -> Vec<f32> {
    let (turn, number) = (inputs.between(0.0, 6.3), inputs.of_any_size(0.2, 8.0).abs());
    let vector = [number * turn.cos(), number * turn.sin()];
    let height = inputs.between(0.1, 1.0) / number.max(1.0);
    let position = [inputs.between(-4.0, 4.0), inputs.between(-4.0, 4.0)];
    [&vector[..], &[height, inputs.between(0.0, std::f32::consts::TAU)], &position].concat()
}

pub fn wave_twins() -> Vec<Twin> {
    [sine_twins(), hash_twins(), gabor_twins()].into_iter().flatten().collect()
}

fn sine_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "sine_of_turns",
            gives: Gives::Noise,
            call: "put(sine_of_turns(f(0u)));",
            arguments: |inputs| vec![inputs.between(-8.0, 8.0)],
            rust: |a, _, _| one((TAU * f64::from(a[0])).sin() as f32),
        },
        Twin {
            name: "cosine_of_turns",
            gives: Gives::Noise,
            call: "put(cosine_of_turns(f(0u)));",
            arguments: |inputs| vec![inputs.between(-8.0, 8.0)],
            rust: |a, _, _| one((TAU * f64::from(a[0])).cos() as f32),
        },
        Twin {
            name: "wave_turns",
            gives: Gives::Noise,
            call: "put(wave_turns(f4(0u), f2(4u)));",
            arguments: wave_and_position,
            rust: |a, _, _| one(((pair(a).dot(pair(&a[4..])) + f64::from(a[3])) / TAU) as f32),
        },
        Twin {
            name: "wave_height",
            gives: Gives::Noise,
            call: "put(wave_height(f4(0u), f2(4u)));",
            arguments: wave_and_position,
            rust: |a, _, _| one(wave(a).height(pair(&a[4..])) as f32),
        },
        Twin {
            name: "wave_slope",
            gives: Gives::Noise,
            call: "put2(wave_slope(f4(0u), f2(4u)));",
            arguments: wave_and_position,
            rust: |a, _, _| singles(&wave(a).slope(pair(&a[4..])).to_array()),
        },
        Twin {
            name: "wave_distribution",
            gives: Gives::Noise,
            call: "let s = wave_distribution(f4(0u), f2(4u), f2(6u), f2(8u)); put2(s.mean); put2(s.variance); put(s.covariance);",
            arguments: |inputs| {
                let [ax, ay, bx, by] = inputs.footprint();
                let size = inputs.of_any_size(0.02, 0.2).abs();
                [wave_and_position(inputs), [ax, ay, bx, by].map(|change| change * size).to_vec()].concat()
            },
            rust: |a, _, _| {
                let footprint = [pair(&a[6..]), pair(&a[8..])];
                let WaveSlopes { mean, covariance } = wave(a).slopes(pair(&a[4..]), footprint);
                singles(&[&mean[..], &covariance].concat())
            },
        },
        Twin {
            name: "gerstner_part",
            gives: Gives::Noise,
            call: "put3(gerstner_part(f4(0u), f2(4u), f(6u)));",
            arguments: |inputs| [wave_and_position(inputs), vec![inputs.unit()]].concat(),
            rust: |a, _, _| {
                let (wave, p) = (wave(a), pair(&a[4..]));
                let DVec2 { x, y } = gerstner_slope(&[wave], p, 0.0);
                singles(&[x, y, f64::from(a[6]) * wave.height(p) * wave.vector.length()])
            },
        },
        Twin {
            name: "gerstner_slope",
            gives: Gives::Numbers,
            call: "put2(gerstner_slope(f3(0u)));",
            arguments: |inputs| (0..3).map(|_| inputs.between(-1.0, 0.9)).collect(),
            rust: |a, _, _| {
                let left = (1.0 - f64::from(a[2])).max(1.0 / 512.0);
                singles(&(pair(a) / left).to_array())
            },
        },
    ]
}

/// The words of Gabor noise whose slopes are of the size of one: cells, cycles, direction, spread, height of a kernel, least
/// product, period and seed.
fn gabor_words(inputs: &mut Inputs) -> Vec<f32> {
    let cells = inputs.between(0.5, 2.0);
    let directions = [inputs.between(-1.5, 1.5), inputs.between(0.0, 1.5)];
    let height = inputs.between(0.02, 0.05);
    let mean = inputs.between(0.5, 4.0);
    let period = [0, 3, 7][inputs.below(3)] as f32;
    [&[cells, inputs.between(0.1, 1.0)], &directions[..], &[height, (-mean).exp(), period]]
        .concat()
        .into_iter()
        .chain([inputs.below(1000) as f32])
        .collect()
}

fn gabor(a: &[f32]) -> GaborNoise {
    let cells = f64::from(a[0]);
    let noise = GaborNoise::tiling(1, 1.0 / cells)
        .with_period(whole(a[6]) as u32)
        .with_seed(whole(a[7]) as u32)
        .with_frequency(f64::from(a[1]) * cells)
        .with_direction(a[2].into())
        .with_spread(a[3].into())
        .with_impulses(-std::f64::consts::PI * f64::from(a[5]).ln());
    let of_one = f32::from_bits(noise.with_amplitude(1.0).to_words()[4]);
    noise.with_amplitude(f64::from(a[4]) / f64::from(of_one))
}

/// A whole number of this many bits, which a single float holds, as a hash.
fn short_hash(inputs: &mut Inputs) -> f32 {
    inputs.below(1 << 16) as f32
}

fn unit_of(hash: u32) -> f64 {
    f64::from(hash >> 8) / f64::from(1 << 24)
}

fn hash_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "gabor_hash",
            gives: Gives::Numbers,
            call: "put(f32(gabor_hash(u32(f(0u) + 0.5)) >> 8u));",
            arguments: |inputs| vec![short_hash(inputs)],
            rust: |a, _, _| one((mixed(whole(a[0]) as u32) >> 8) as f32),
        },
        Twin {
            name: "gabor_uniform",
            gives: Gives::Numbers,
            call: "put(gabor_uniform(u32(f(0u) + 0.5) * 4096u));",
            arguments: |inputs| vec![short_hash(inputs)],
            rust: |a, _, _| one(unit_of((whole(a[0]) as u32).wrapping_mul(4096)) as f32),
        },
        Twin {
            name: "gabor_cell_hash",
            gives: Gives::Numbers,
            call: "put(f32(gabor_cell_hash(gabor(0u), vec2i(floor(f2(8u) + 0.5))) >> 8u));",
            arguments: |inputs| {
                let cell = [inputs.between(-30.0, 30.0).round(), inputs.between(-30.0, 30.0).round()];
                [gabor_words(inputs), cell.to_vec()].concat()
            },
            rust: |a, _, _| {
                let period = whole(a[6]);
                let inside = |c: f32| if period == 0 { whole(c) } else { whole(c).rem_euclid(period) } as u32;
                let row = mixed(inside(a[9]).wrapping_add(mixed(whole(a[7]) as u32)));
                one((mixed(inside(a[8]).wrapping_add(row)) >> 8) as f32)
            },
        },
        Twin {
            name: "gabor_impulse_count",
            gives: Gives::Numbers,
            call: "put(f32(gabor_impulse_count(gabor(0u), gabor_hash(u32(f(8u) + 0.5)))));",
            arguments: |inputs| [gabor_words(inputs), vec![short_hash(inputs)]].concat(),
            rust: |a, _, _| {
                let hash = mixed(whole(a[8]) as u32);
                let (mut product, mut count) = (unit_of(hash) as f32, 0);
                while product > a[5] && count < 64 {
                    count += 1;
                    product *= unit_of(mixed(hash.wrapping_add(count))) as f32;
                }
                one(count as f32)
            },
        },
    ]
}

/// A kernel of the cell whose hash is that of word 8: gradient and value.
fn kernel(a: &[f32], index: u32, at: DVec2) -> [f64; 3] {
    let first = mixed(whole(a[8]) as u32).wrapping_add(65 + 4 * index);
    let word = |i: u32| unit_of(mixed(first.wrapping_add(i)));
    let x = at - DVec2::new(word(0), word(1));
    if x.length_squared() >= 1.0 {
        return [0.0; 3];
    }
    let turn = f64::from(a[2]) + f64::from(a[3]) * (2.0 * word(3) - 1.0);
    let across = DVec2::from_angle(turn);
    // The envelope is 1/20 at a distance of 1.
    let envelope = (2.0 * word(2) - 1.0) * 20.0_f64.powf(-x.length_squared());
    let frequency = TAU * f64::from(a[1]);
    let (sin, cos) = (frequency * x.dot(across)).sin_cos();
    let gradient = -envelope * (2.0 * 20.0_f64.ln() * cos * x + frequency * sin * across);
    [gradient.x, gradient.y, envelope * cos]
}

fn gabor_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "gabor_kernel",
            gives: Gives::Noise,
            call: "put3(gabor_kernel(gabor(0u), gabor_hash(u32(f(8u) + 0.5)), u32(f(9u) + 0.5), f2(10u)) / 8.0);",
            arguments: |inputs| {
                let place = [short_hash(inputs), inputs.below(8) as f32];
                let at = [inputs.between(-0.3, 1.3), inputs.between(-0.3, 1.3)];
                [gabor_words(inputs), place.to_vec(), at.to_vec()].concat()
            },
            rust: |a, _, _| {
                let [x, y, value] = kernel(a, whole(a[9]) as u32, pair(&a[10..]));
                singles(&[x / 8.0, y / 8.0, value / 8.0])
            },
        },
        Twin {
            name: "gabor_kernels",
            gives: Gives::Noise,
            call: "put3(gabor_kernels(gabor(0u), gabor_hash(u32(f(8u) + 0.5)), u32(f(9u) + 0.5), f2(10u)) / 8.0);",
            arguments: |inputs| {
                let place = [short_hash(inputs), inputs.below(8) as f32];
                let at = [inputs.between(-0.3, 1.3), inputs.between(-0.3, 1.3)];
                [gabor_words(inputs), place.to_vec(), at.to_vec()].concat()
            },
            rust: |a, _, _| {
                let sum = (0..whole(a[9]) as u32).fold([0.0; 3], |sum, index| {
                    let one = kernel(a, index, pair(&a[10..]));
                    std::array::from_fn(|i| sum[i] + one[i] / 8.0)
                });
                singles(&sum)
            },
        },
        Twin {
            name: "gabor_sample",
            gives: Gives::Noise,
            call: "put3(gabor_sample(gabor(0u), f2(8u)));",
            arguments: |inputs| {
                let p = [inputs.between(-4.0, 4.0), inputs.between(-4.0, 4.0)];
                [gabor_words(inputs), p.to_vec()].concat()
            },
            rust: |a, _, _| {
                let GaborSample { value, gradient } = gabor(a).sample(pair(&a[8..]));
                singles(&[gradient.x, gradient.y, value])
            },
        },
    ]
}
