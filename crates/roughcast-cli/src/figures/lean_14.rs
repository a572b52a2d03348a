//! LEAN Figure 14: a raised checkerboard that recedes to the horizon.

use anyhow::Result;
use glam::DVec3;
use roughcast::SampleType;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::metrics::{energy_error, flicker, rmse};
use roughcast_scene::pattern::raised_checker;
use roughcast_scene::{Camera, Filter, Plane, Sampler, Shape, slow_move};
use serde_json::{Map, json};

use super::scene::{Stage, scene};
use super::{Figure, Panel, Table};
use crate::display::{exposure_of, shown};

/// The smallest exponent of the claim.
const SPECULAR_POWER: f32 = 2048.0;
/// As in the paper.
const SAMPLES: u32 = 64;
/// The largest allowed error of LEAN relative to conventional bump mapping's.
const ERROR_RATIO: f64 = 1.0 / 3.0;
/// The smallest allowed flicker of conventional bump mapping relative to LEAN's.
const FLICKER_RATIO: f64 = 5.0;
/// Slope of the checker's edges: about twice the width of the lobe, 1 / sqrt(s).
const EDGE_SLOPE: f64 = 0.05;
/// Steeper edges, to which the claim does not apply: flat squares with a sharp highlight and edges that reflect theirs
/// far away form two distributions, and LEAN has one Gaussian.
const STEEPER: [f64; 2] = [0.1, 0.2];
/// Frames of the camera move for measuring flicker.
const FRAMES: u32 = 8;
const SIZE: (u32, u32) = (480, 360);
/// Flicker needs a ground truth for every frame, so it is measured in smaller pictures.
const MOVING_SIZE: (u32, u32) = (240, 180);

/// The four pictures of the paper's figure, and also conventional mip-mapped normals.
const METHODS: [(&str, Shading, Filter); 5] = [
    ("conventional bump mapping", Shading::BlinnPhong, Filter::Nearest),
    ("conventional, trilinear mip maps", Shading::BlinnPhong, Filter::Trilinear),
    ("conventional, anisotropic", Shading::BlinnPhong, Filter::Anisotropic),
    ("LEAN, trilinear", Shading::Lean, Filter::Trilinear),
    ("LEAN, anisotropic", Shading::Lean, Filter::Anisotropic),
];
/// Indices into that list.
const ORDINARY: usize = 0;
const LEAN: usize = 4;

pub fn make() -> Result<Figure> {
    let stage = stage(SIZE, EDGE_SLOPE);
    let truth = stage.truth(Shading::OffCentre, SAMPLES)?;
    let exposure = exposure_of(&truth);
    let mut panels = vec![Panel {
        picture: shown(&truth, exposure),
        caption: format!("ground truth, {SAMPLES} samples per pixel"),
    }];
    let (mut rows, mut errors, mut numbers) = (Vec::new(), Vec::new(), Map::new());
    let flickers = flickers()?;
    for ((name, shading, filter), flicker) in METHODS.into_iter().zip(&flickers) {
        let picture = stage.method(shading, filter)?;
        let (error, energy) = (rmse(&picture, &truth)?, energy_error(&picture, &truth)?);
        panels
            .push(Panel { picture: shown(&picture, exposure), caption: format!("{name}: RMSE {error:.4}") });
        rows.push(vec![
            name.to_owned(),
            format!("{error:.5}"),
            format!("{:+.1} %", 100.0 * energy),
            format!("{flicker:.3e}"),
        ]);
        numbers.insert(format!("RMSE, {name}"), json!(error));
        numbers.insert(format!("flicker, {name}"), json!(flicker));
        errors.push(error);
    }
    let error_ratio = errors[LEAN] / errors[ORDINARY];
    let flicker_ratio = flickers[ORDINARY] / flickers[LEAN].max(f64::MIN_POSITIVE);
    numbers.insert("LEAN anisotropic / ordinary, RMSE".to_owned(), json!(error_ratio));
    numbers.insert("ordinary / LEAN anisotropic, flicker".to_owned(), json!(flicker_ratio));
    for slope in STEEPER {
        let ratio = error_ratio_at(slope)?;
        numbers.insert(
            format!("beyond the claim: the same ratio of RMSE with edges of slope {slope}"),
            json!(ratio),
        );
    }
    Ok(Figure {
        title: "a raised checkerboard",
        claim: format!(
            "against {SAMPLES} samples per pixel, LEAN with anisotropic filtering has at most {ERROR_RATIO:.2} of the error (RMSE) of conventional \
             bump mapping, which flickers at least {FLICKER_RATIO} times as much"
        ),
        numbers,
        holds: error_ratio <= ERROR_RATIO && flicker_ratio >= FLICKER_RATIO,
        making: format!(
            "Raised checker of 512x512 texels with edges of slope {EDGE_SLOPE}, 16-bit textures, s = {SPECULAR_POWER}, off-centre Beckmann as ground truth, in the paper's \
             form; Blinn-Phong times s. {}x{} pixels; flicker over {FRAMES} frames of {}x{}.",
            SIZE.0, SIZE.1, MOVING_SIZE.0, MOVING_SIZE.1
        ),
        panels,
        charts: Vec::new(),
        table: Some(Table { header: vec!["method", "RMSE", "energy of the highlight", "flicker"], rows }),
    })
}

/// The ratio of the claim for other edges.
fn error_ratio_at(edge_slope: f64) -> Result<f64> {
    let stage = stage(MOVING_SIZE, edge_slope);
    let truth = stage.truth(Shading::OffCentre, SAMPLES)?;
    let error = |index: usize| -> Result<f64> {
        let (_, shading, filter) = METHODS[index];
        Ok(rmse(&stage.method(shading, filter)?, &truth)?)
    };
    Ok(error(LEAN)? / error(ORDINARY)?)
}

/// Flicker of every method during a slow camera move.
fn flickers() -> Result<Vec<f64>> {
    let stage = stage(MOVING_SIZE, EDGE_SLOPE);
    let scenes = slow_move(&stage.scene, FRAMES);
    let truth = stage.truth_frames(Shading::OffCentre, SAMPLES, &scenes)?;
    let flicker_of = |(_, shading, filter): (&str, Shading, Filter)| {
        let sampler = Sampler::default().with_filter(filter);
        Ok(flicker(&stage.sampled_frames(shading, sampler, &scenes)?, &truth)?)
    };
    METHODS.into_iter().map(flicker_of).collect()
}

fn stage(size: (u32, u32), edge_slope: f64) -> Stage {
    let camera = Camera {
        eye: DVec3::new(0.0, 0.22, 1.0),
        target: DVec3::new(0.0, 0.0, 0.1),
        up: DVec3::Y,
        vertical_fov: 0.7,
    };
    let shape = Shape::Plane(Plane::default());
    Stage {
        map: raised_checker(512, 16, 4.0, edge_slope),
        scene: scene(shape, 16.0, camera, DVec3::new(0.05, 0.35, -1.0)),
        options: ShadingOptions::published(SPECULAR_POWER),
        sample_type: SampleType::U16,
        size,
    }
}
