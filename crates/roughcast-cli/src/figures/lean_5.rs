//! LEAN Figure 5: four models on a bumpy sphere, close enough that nothing is filtered.

use anyhow::Result;
use glam::DVec3;
use roughcast::SampleType;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::metrics::{DEFAULT_PIXELS_PER_DEGREE, hdr_flip};
use roughcast_scene::pattern::random_bumps;
use roughcast_scene::{Camera, Filter, Light, Picture, Sampler, Shape, Sphere};
use serde_json::{Map, json};

use super::scene::{Stage, scene};
use super::{Figure, Panel};
use crate::display::{exposure_of, shown};

const SPECULAR_POWER: f32 = 128.0;
const SIZE: (u32, u32) = (320, 320);
/// FLIP of two pictures that few observers can distinguish side by side; identical pictures have 0, unrelated ones 0.3
/// and more.
const EQUIVALENT: f64 = 0.03;
/// LEAN in 16 bits against the same lobe without moments, as a fraction of the highlight's peak: s times the error of a
/// stored variance, and the same again for the slope.
const SAME: f32 = 0.02;

const MODELS: [(&str, Shading); 4] = [
    ("Blinn-Phong on the bump normal", Shading::BlinnPhong),
    ("Beckmann in the bump's frame", Shading::Beckmann),
    ("off-centre Beckmann in the surface frame", Shading::OffCentre),
    ("LEAN mapping", Shading::Lean),
];

pub fn make() -> Result<Figure> {
    let stage = stage();
    // Every pixel reads one texel of the finest level: nothing is filtered.
    let sampler = Sampler::default().with_filter(Filter::Nearest).with_level(Some(0.0));
    let pictures = MODELS.map(|(_, shading)| stage.sampled(shading, sampler));
    let pictures = pictures.into_iter().collect::<Result<Vec<Picture>>>()?;
    let exposure = exposure_of(&pictures[0]);
    let (mut numbers, mut panels, mut worst) = (Map::new(), Vec::new(), 0.0_f64);
    for ((name, _), picture) in MODELS.iter().zip(&pictures) {
        let flip = hdr_flip(picture, &pictures[0], DEFAULT_PIXELS_PER_DEGREE)?.mean;
        worst = worst.max(flip);
        numbers.insert(format!("FLIP against Blinn-Phong, {name}"), json!(flip));
        panels.push(Panel { picture: shown(picture, exposure), caption: format!("{name}: FLIP {flip:.4}") });
    }
    let difference = largest_difference(&pictures[3], &pictures[2]);
    numbers.insert("largest difference of LEAN and off-centre, of the peak".to_owned(), json!(difference));
    Ok(Figure {
        title: "four models without filtering",
        claim: format!(
            "without filtering, Blinn-Phong, Beckmann in the bump's frame, off-centre Beckmann and LEAN look the same (FLIP at \
             most {EQUIVALENT}), and the last two are the same except for the rounding of 16 bits ({SAME} of the peak)"
        ),
        numbers,
        holds: worst <= EQUIVALENT && difference <= SAME,
        making: format!(
            "Random bumps of 512x512 texels with a root mean square slope of 0.15, 16-bit textures, nearest texel of level 0, s = \
             {SPECULAR_POWER}, a frontal and a glancing light, the paper's form. {}x{} pixels.",
            SIZE.0, SIZE.1
        ),
        panels,
        charts: Vec::new(),
        table: None,
    })
}

/// The largest difference of two highlights, as a fraction of the second one's peak.
fn largest_difference(picture: &Picture, other: &Picture) -> f32 {
    let peak = other.specular().iter().flatten().fold(0.0_f32, |a, b| a.max(*b));
    let pairs = picture.specular().iter().flatten().zip(other.specular().iter().flatten());
    pairs.fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs())) / peak
}

fn stage() -> Stage {
    let camera =
        Camera { eye: DVec3::new(0.0, 0.4, 4.2), target: DVec3::ZERO, up: DVec3::Y, vertical_fov: 0.55 };
    let mut scene = scene(Shape::Sphere(Sphere), 2.0, camera, DVec3::new(-0.3, 0.7, 1.0));
    let glancing = DVec3::new(1.0, 0.15, -0.55).normalize();
    scene.lights.push(Light::Directional { towards: glancing, irradiance: Light::WHITE });
    Stage {
        map: random_bumps(512, 0.15, 5),
        scene,
        options: ShadingOptions::published(SPECULAR_POWER),
        sample_type: SampleType::U16,
        size: SIZE,
    }
}
