//! LEAN Figure 13: bumps with a direction on a model that moves away.

use anyhow::Result;
use glam::DVec3;
use roughcast::SampleType;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::metrics::{energy_error, rmse};
use roughcast_scene::pattern::random_ridges;
use roughcast_scene::{Camera, Filter, Shape, Torus};
use serde_json::{Map, json};

use super::scene::{Stage, scene};
use super::{Figure, Panel, Table};
use crate::display::{exposure_of, shown};

/// Within the range of 8 bits.
const SPECULAR_POWER: f32 = 128.0;
const SAMPLES: u32 = 256;
/// Each distance is twice the one before.
const DISTANCES: [f64; 4] = [4.5, 9.0, 18.0, 36.0];
/// The largest allowed relative error of the energy of LEAN's highlight.
const ENERGY: f64 = 0.1;

pub fn make() -> Result<Figure> {
    let (mut panels, mut rows, mut numbers, mut holds) = (Vec::new(), Vec::new(), Map::new(), true);
    for distance in DISTANCES {
        let stage = stage(distance);
        let truth = stage.truth(Shading::OffCentre, SAMPLES)?;
        let exposure = exposure_of(&truth);
        panels.push(Panel { picture: shown(&truth, exposure), caption: format!("truth at {distance}") });
        let mut errors = Vec::new();
        for (name, shading) in [("ordinary", Shading::BlinnPhong), ("LEAN", Shading::Lean)] {
            let picture = stage.method(shading, Filter::Anisotropic)?;
            let (error, energy) = (rmse(&picture, &truth)?, energy_error(&picture, &truth)?);
            let caption = format!("{name} at {distance}: RMSE {error:.4}");
            panels.push(Panel { picture: shown(&picture, exposure), caption });
            numbers.insert(format!("RMSE, {name}, at {distance}"), json!(error));
            numbers.insert(format!("energy error, {name}, at {distance}"), json!(energy));
            let energy_text = format!("{:+.1} %", 100.0 * energy);
            rows.push(vec![format!("{name} at {distance}"), format!("{error:.4}"), energy_text]);
            errors.push((error, energy));
        }
        let [(ordinary, _), (lean, lean_energy)] = errors[..] else { unreachable!("two methods") };
        holds &= lean < ordinary && lean_energy.abs() <= ENERGY;
    }
    Ok(Figure {
        title: "ridges on a model that moves away",
        claim: format!(
            "at every distance LEAN is closer to the ground truth than conventional bump mapping, and its highlight has the ground truth's energy \
             within {:.0} %",
            100.0 * ENERGY
        ),
        numbers,
        holds,
        making: format!(
            "Random ridges of 512x512 texels with a root mean square slope of 0.25 on a torus, 8-bit textures, s = {SPECULAR_POWER}, \
             anisotropic filtering, the paper's form; ground truth of {SAMPLES} samples per pixel. The picture covers the model at every distance."
        ),
        panels,
        charts: Vec::new(),
        table: Some(Table { header: vec!["method", "RMSE", "energy of the highlight"], rows }),
    })
}

/// The angle of view is the same at every distance; the picture is cropped to the model, which gets smaller.
fn stage(distance: f64) -> Stage {
    const NEAREST_PIXELS: f64 = 288.0;
    let part = DISTANCES[0] / distance;
    let pixels = (NEAREST_PIXELS * part) as u32;
    let towards_eye = DVec3::new(0.0, 1.0, 0.8).normalize();
    let camera = Camera {
        eye: towards_eye * distance,
        target: DVec3::ZERO,
        up: DVec3::Y,
        vertical_fov: 2.0 * ((0.3_f64).tan() * part).atan(),
    };
    Stage {
        map: random_ridges(512, 0.25, 13),
        scene: scene(Shape::Torus(Torus::default()), 4.0, camera, DVec3::new(0.5, 1.0, 0.6)),
        options: ShadingOptions::published(SPECULAR_POWER),
        sample_type: SampleType::U8,
        size: (pixels, pixels),
    }
}
