//! Mikkelsen Figure 2: Perlin's perturbation against the surface gradient, with noise of a low frequency.

use anyhow::Result;
use glam::DVec3;
use roughcast::noise::{Noise, NoiseKind};
use roughcast::surface_gradient::{perlin_normal, perturbed_normal, surface_gradient_of_volume};
use roughcast_scene::{NoiseDetail, Perturbation, Shape, Sphere};
use serde_json::{Map, json};

use super::Figure;
use super::bumps::{degrees_between, exact_picture, panels, scene};

const SIZE: (u32, u32) = (360, 360);
/// Points of the sphere at which the normals are compared.
const POINTS: u32 = 20_000;
/// Bumps that are strong enough for Perlin's normals to turn inward.
const AMPLITUDE: f64 = 0.8;
const FREQUENCY: f64 = 2.0;
/// The largest allowed mean error of the surface gradient, in degrees, with the bumps at a thousandth of their height: that
/// of leaving out the term with β.
const EXACT: f64 = 0.01;
/// The smallest fraction of normals that Perlin's perturbation must turn inward.
const INWARD: f64 = 0.005;

fn noise() -> Noise {
    Noise::default()
        .with_kind(NoiseKind::Fbm)
        .with_octaves(1)
        .with_frequency(FREQUENCY)
        .with_amplitude(AMPLITUDE)
}

pub fn make() -> Result<Figure> {
    let (full, weak) = (measured(&noise()), measured(&noise().with_amplitude(AMPLITUDE * 1e-3)));
    let mut numbers = Map::new();
    for (name, value) in [
        ("inward normals, Perlin", full.inward[0]),
        ("inward normals, surface gradient", full.inward[1]),
        ("mean error, Perlin, degrees", full.error[0]),
        ("mean error, surface gradient, degrees", full.error[1]),
        ("mean error of weak bumps, Perlin, degrees", weak.error[0]),
        ("mean error of weak bumps, surface gradient, degrees", weak.error[1]),
    ] {
        numbers.insert(name.to_owned(), json!(value));
    }
    let scene = scene(Shape::Sphere(Sphere), 1.0);
    let bumps = |perturbation| NoiseDetail { perturbation, ..NoiseDetail::new(noise()) };
    let pictures = vec![
        (exact_picture(&scene, &bumps(Perturbation::SurfaceGradient), SIZE)?, "surface gradient".to_owned()),
        (
            exact_picture(&scene, &bumps(Perturbation::Perlin), SIZE)?,
            "Perlin's perturbation, n − g".to_owned(),
        ),
    ];
    Ok(Figure {
        title: "Perlin's perturbation",
        claim: format!(
            "at least {} % of Perlin's normals turn inward and none of the surface gradient's; for weak bumps the surface \
             gradient is the normal of the displaced surface within {EXACT}° on average",
            100.0 * INWARD
        ),
        numbers,
        holds: full.inward[0] >= INWARD && full.inward[1] == 0.0 && weak.error[1] <= EXACT,
        making: format!(
            "One octave of noise of frequency {FREQUENCY} and amplitude {AMPLITUDE} on the unit sphere. Errors are angles to the normal of the \
             surface that is really displaced, by differences in double precision, at {POINTS} points."
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: None,
    })
}

/// Fractions of inward normals and mean errors in degrees, of Perlin's perturbation and of the surface gradient.
struct Measured {
    inward: [f64; 2],
    error: [f64; 2],
}

fn measured(noise: &Noise) -> Measured {
    let mut result = Measured { inward: [0.0; 2], error: [0.0; 2] };
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    for i in 0..POINTS {
        // A spiral that covers the sphere evenly.
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(POINTS);
        let (sin, cos) = (golden_angle * f64::from(i)).sin_cos();
        let normal = DVec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
        let gradient = noise.sample(normal).gradient;
        let real = displaced(noise, normal);
        let perlin = perlin_normal(normal, gradient);
        let ours = perturbed_normal(normal, surface_gradient_of_volume(normal, gradient));
        for (place, got) in [perlin, ours].into_iter().enumerate() {
            result.inward[place] += f64::from(u8::from(got.dot(normal) < 0.0)) / f64::from(POINTS);
            result.error[place] += degrees_between(got, real) / f64::from(POINTS);
        }
    }
    result
}

/// The normal of the sphere displaced by noise, by central differences.
fn displaced(noise: &Noise, normal: DVec3) -> DVec3 {
    const STEP: f64 = 1e-5;
    let point = |direction: DVec3| {
        let on_sphere = direction.normalize();
        on_sphere * (1.0 + noise.height(on_sphere))
    };
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let along = |axis: DVec3| point(normal + axis * STEP) - point(normal - axis * STEP);
    along(tangent).cross(along(bitangent)).normalize()
}
