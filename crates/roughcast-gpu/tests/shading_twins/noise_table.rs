//! Procedural noise: the functions in WGSL and their Rust twins.

use glam::{DVec2, DVec3};
use roughcast::noise::*;

use crate::harness::{Gives, Twin};
use crate::inputs::Inputs;
use crate::table::one;

/// A whole number that the tolerance computation may have perturbed.
pub fn whole(a: f32) -> i64 {
    (f64::from(a) + 0.5).floor() as i64
}

fn vector(a: &[f32]) -> DVec3 {
    DVec3::new(a[0].into(), a[1].into(), a[2].into())
}

/// Gradient and value.
fn sample_words(sample: NoiseSample) -> Vec<f32> {
    let [x, y, z] = sample.gradient.to_array();
    [x, y, z, sample.value].map(|number| number as f32).to_vec()
}

/// A position within the cells about the origin; one in 16 is beyond the reach of noise.
fn position(inputs: &mut Inputs) -> Vec<f32> {
    let far = inputs.below(16) == 0;
    let coordinate = |inputs: &mut Inputs| {
        let size = inputs.of_any_size(0.1, 16.0);
        if far { size * 1e10 } else { size }
    };
    (0..3).map(|_| coordinate(inputs)).collect()
}

/// A seed that a single float holds, even perturbed.
fn seed(inputs: &mut Inputs) -> f32 {
    inputs.below(1000) as f32
}

/// The words of noise: frequency, amplitude, octaves, kind, seed. Slopes of all octaves together are of the size of one.
fn noise_words(inputs: &mut Inputs) -> Vec<f32> {
    let [frequency, amplitude] = [inputs.of_any_size(0.5, 2.0).abs(), inputs.of_any_size(0.1, 0.4)];
    vec![frequency, amplitude, (1 + inputs.below(5)) as f32, inputs.below(2) as f32, seed(inputs)]
}

fn noise(a: &[f32]) -> Noise {
    Noise::default()
        .with_frequency(a[0].into())
        .with_amplitude(a[1].into())
        .with_octaves(whole(a[2]) as u32)
        .with_kind(NoiseKind::ALL[whole(a[3]) as usize])
        .with_seed(whole(a[4]) as u32)
}

/// The last step of MurmurHash3.
pub fn mixed(key: u32) -> u32 {
    let key = (key ^ key >> 16).wrapping_mul(0x85eb_ca6b);
    let key = (key ^ key >> 13).wrapping_mul(0xc2b2_ae35);
    key ^ key >> 16
}

/// The gradient of the direction with this number, 0 to 11.
fn direction(number: i64) -> DVec3 {
    let sign = |bit: i64| if number >> bit & 1 == 1 { -1.0 } else { 1.0 };
    match number / 4 {
        0 => DVec3::new(sign(0), sign(1), 0.0),
        1 => DVec3::new(sign(0), 0.0, sign(1)),
        _ => DVec3::new(0.0, sign(0), sign(1)),
    }
}

fn corner_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "noise_hash",
            gives: Gives::Numbers,
            call: "put(f32(noise_hash(vec4u(vec4i(floor(f4(0u) + 0.5)))).w >> 8u));",
            arguments: |inputs| (0..4).map(|_| inputs.between(-1e4, 1e4).round()).collect(),
            rust: |a, _, _| one((mixed(whole(a[3]) as u32) >> 8) as f32),
        },
        Twin {
            name: "noise_within_reach",
            gives: Gives::Numbers,
            call: "put(select(0.0, 1.0, noise_within_reach(f3(0u))));",
            arguments: |inputs| (0..3).map(|_| inputs.of_any_size(1.0, 1e10)).collect(),
            rust: |a, _, _| one(f32::from(u8::from(a.iter().all(|x| f64::from(x.abs()) < NOISE_REACH)))),
        },
        Twin {
            name: "noise_corner",
            gives: Gives::Numbers,
            // The first hash whose direction is this one.
            call: "let g = noise_corner(((u32(f(0u) + 0.5) * 65536u + 65535u) / 12u) << 16u, f3(1u)); put3(g.xyz); put(g.w);",
            arguments: |inputs| {
                let number = inputs.below(12) as f32;
                // Both parts of the value have a size of their own, else almost nothing may be left of it.
                vec![number, inputs.between(0.5, 1.0), inputs.between(0.2, 0.4), inputs.between(0.05, 0.15)]
            },
            rust: |a, _, _| {
                let gradient = direction(whole(a[0]));
                sample_words(NoiseSample { value: gradient.dot(vector(&a[1..])), gradient })
            },
        },
        Twin {
            name: "noise_blend",
            gives: Gives::Numbers,
            call: "let n = noise_blend(f4(0u), f4(4u), f(8u), f3(9u)); put3(n.xyz); put(n.w);",
            arguments: |inputs| {
                let numbers = (0..8).map(|_| inputs.between(-1.0, 1.0)).collect::<Vec<_>>();
                [numbers, vec![inputs.unit()], (0..3).map(|_| inputs.between(-2.0, 2.0)).collect()].concat()
            },
            rust: |a, _, _| {
                let rise = f64::from(a[7]) - f64::from(a[3]);
                let mix = |i: usize| {
                    let (from, to) = (f64::from(a[i]), f64::from(a[i + 4]));
                    let change = if i < 3 { f64::from(a[9 + i]) } else { 0.0 };
                    (from + f64::from(a[8]) * (to - from) + rise * change) as f32
                };
                (0..4).map(mix).collect()
            },
        },
        Twin {
            name: "gradient_noise",
            gives: Gives::Noise,
            call: "let n = gradient_noise(f3(0u), u32(f(3u) + 0.5)); put3(n.xyz); put(n.w);",
            arguments: |inputs| [position(inputs), vec![seed(inputs)]].concat(),
            rust: |a, _, _| sample_words(gradient_noise(vector(a), whole(a[3]) as u32)),
        },
    ]
}

fn octave_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "noise_scale",
            gives: Gives::Numbers,
            call: "put(noise_scale(u32(f(0u) + 0.5)));",
            arguments: |inputs| vec![inputs.below(MAX_OCTAVES as usize) as f32],
            rust: |a, _, _| one(2.0_f32.powi(whole(a[0]) as i32)),
        },
        Twin {
            name: "noise_octave",
            gives: Gives::Noise,
            call: "let n = noise_octave(noise(0u), f3(5u), u32(f(8u) + 0.5)); put3(n.xyz); put(n.w);",
            arguments: |inputs| {
                [noise_words(inputs), position(inputs), vec![inputs.below(5) as f32]].concat()
            },
            rust: |a, _, _| {
                let (noise, octave) = (noise(a), whole(a[8]) as u32);
                let scaled = vector(&a[5..]) * f64::from(1 << octave);
                // One octave of unit frequency and amplitude.
                let one = noise.with_frequency(1.0).with_amplitude(1.0).with_octaves(1);
                sample_words(one.with_seed(noise.seed + octave).sample(scaled))
            },
        },
        Twin {
            name: "noise_sample",
            gives: Gives::Noise,
            call: "let n = noise_sample(noise(0u), f3(5u)); put3(n.xyz); put(n.w);",
            arguments: |inputs| [noise_words(inputs), position(inputs)].concat(),
            rust: |a, _, _| sample_words(noise(a).sample(vector(&a[5..]))),
        },
        Twin {
            name: "noise_height",
            gives: Gives::Noise,
            call: "put(noise_height(noise(0u), f3(5u)));",
            arguments: |inputs| [noise_words(inputs), position(inputs)].concat(),
            rust: |a, _, _| one(noise(a).height(vector(&a[5..])) as f32),
        },
    ]
}

/// The words of a footprint: cosine and sine of the double angle, centre and radius of the variances.
fn footprint(dx: DVec2, dy: DVec2) -> [f64; 4] {
    let longest = dx.abs().max(dy.abs()).max_element();
    if longest >= f64::from(1 << 20) {
        return [0.0, 0.0, 1e20, 0.0];
    }
    let (xx, yy) = (dx.x * dx.x + dy.x * dy.x, dx.y * dx.y + dy.y * dy.y);
    let axis = DVec2::new(0.5 * (xx - yy), dx.x * dx.y + dy.x * dy.y);
    let radius = axis.length();
    let unit = if radius > 0.0 { axis / radius } else { DVec2::ZERO };
    [unit.x, unit.y, 0.125 * (xx + yy), 0.25 * radius]
}

fn plane(a: &[f32], i: usize) -> DVec2 {
    DVec2::new(a[i].into(), a[i + 1].into())
}

/// Two changes of the position, mostly of a footprint near the size of a cell.
fn changes(inputs: &mut Inputs) -> [[f32; 2]; 2] {
    let [ax, ay, bx, by] = inputs.footprint();
    let size = inputs.of_any_size(0.02, 0.2).abs();
    [[ax * size, ay * size], [bx * size, by * size]]
}

/// Noise, a position, a tangent plane and a footprint in it, and the filter of the octaves.
fn distribution_words(inputs: &mut Inputs) -> Vec<f32> {
    let (noise, p) = (noise_words(inputs), position(inputs));
    let turn = inputs.between(0.0, 6.3);
    let lift = inputs.between(-1.0, 1.0);
    // A turn about z, then one about the new x.
    let tangent = DVec3::new(turn.cos().into(), turn.sin().into(), 0.0);
    let across = DVec3::new((-turn.sin()).into(), turn.cos().into(), 0.0);
    let bitangent = across * f64::from(lift.cos()) + DVec3::Z * f64::from(lift.sin());
    let moves = changes(inputs).map(|[x, y]| tangent * f64::from(x) + bitangent * f64::from(y));
    let vectors = [tangent, bitangent, moves[0], moves[1]].map(|v| v.as_vec3().to_array()).concat();
    [noise, p, vectors, vec![inputs.below(3) as f32]].concat()
}

fn filter_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "noise_fade",
            gives: Gives::Numbers,
            call: "put(noise_fade(u32(f(0u) + 0.5), f(1u)));",
            arguments: |inputs| {
                vec![
                    inputs.below(2) as f32,
                    [0.0, inputs.of_any_size(1e-6, 1.3).abs()][usize::from(inputs.below(8) > 0)],
                ]
            },
            rust: |a, _, _| one(noise_fade(NoiseKind::ALL[whole(a[0]) as usize], a[1].into()) as f32),
        },
        Twin {
            name: "noise_footprint",
            gives: Gives::Footprint,
            call: "let n = noise_footprint(f2(0u), f2(2u)); put2(n.double_angle); put(n.centre); put(n.radius);",
            arguments: |inputs| changes(inputs).concat(),
            rust: |a, _, _| footprint(plane(a, 0), plane(a, 2)).map(|number| number as f32).to_vec(),
        },
        Twin {
            name: "noise_kept",
            gives: Gives::Noise,
            call: "put2(noise_kept(NoiseFootprint(f2(0u), f(2u), f(3u)), u32(f(4u) + 0.5), f(5u)));",
            arguments: |inputs| {
                let [dx, dy] = changes(inputs).map(|v| DVec2::new(v[0].into(), v[1].into()));
                let words = footprint(dx, dy).map(|number| number as f32);
                let octave = inputs.below(5) as i32;
                [&words[..], &[inputs.below(2) as f32, 4.0_f32.powi(octave)]].concat()
            },
            rust: |a, _, _| {
                let kind = NoiseKind::ALL[whole(a[4]) as usize];
                let [centre, radius, scale] = [a[2], a[3], a[5]].map(f64::from);
                // The mean over directions of what a plane wave along each keeps.
                let degrees = [11.25_f64, 33.75, 56.25, 78.75].map(|d| (2.0 * d.to_radians()).cos());
                let fades = degrees.map(|c| (c, noise_fade(kind, scale * (centre + c * radius).max(0.0))));
                let both = fades.iter().map(|(_, fade)| 0.25 * fade).sum::<f64>();
                let difference = fades.iter().map(|(c, fade)| 0.25 * c * fade).sum::<f64>();
                vec![both as f32, difference as f32]
            },
        },
        Twin {
            name: "noise_distribution",
            gives: Gives::Noise,
            call: "let s = noise_distribution(noise(0u), f3(5u), f3(8u), f3(11u), f3(14u), f3(17u), u32(f(20u) + 0.5)); put2(s.mean); put2(s.variance); put(s.covariance);",
            arguments: distribution_words,
            rust: |a, _, _| {
                let filter = OctaveFilter::ALL[whole(a[20]) as usize];
                let axes = [vector(&a[8..]), vector(&a[11..])];
                let moves = [vector(&a[14..]), vector(&a[17..])];
                let NoiseSlopes { mean, covariance } = noise(a).slopes(vector(&a[5..]), axes, moves, filter);
                [&mean[..], &covariance].concat().iter().map(|number| *number as f32).collect()
            },
        },
    ]
}

pub fn noise_twins() -> Vec<Twin> {
    [corner_twins(), octave_twins(), filter_twins()].into_iter().flatten().collect()
}
