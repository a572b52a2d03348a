//! Octaves of noise that are finer than a pixel: kept, dropped, or turned into roughness. Not a figure of a paper.

use anyhow::Result;
use roughcast::noise::{Noise, NoiseKind, OctaveFilter};
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::metrics::{energy_error, rmse};
use roughcast_scene::render::{Truth, unwatched};
use roughcast_scene::{Curved, NoiseDetail, isosurface};
use serde_json::{Map, json};

use super::bumps::{panels, scene, shaded, shape_of};
use super::{Figure, Table};

const SIZE: (u32, u32) = (200, 200);
/// Divisions of an edge of the icosahedron.
const DETAIL: u32 = 48;
const OCTAVES: u32 = 6;
const SAMPLES: u32 = 256;
const SPECULAR_POWER: f32 = 256.0;
/// Cells over a unit of length of the first octave: as seen from this much farther away.
const DISTANCES: [(&str, f64); 3] = [("near", 3.0), ("mid", 12.0), ("far", 48.0)];

fn bumps(frequency: f64, filter: OctaveFilter) -> NoiseDetail {
    let noise = Noise::default()
        .with_kind(NoiseKind::Fbm)
        .with_octaves(OCTAVES)
        .with_frequency(frequency)
        .with_amplitude(0.12 / frequency);
    NoiseDetail { filter, ..NoiseDetail::new(noise) }
}

fn options() -> ShadingOptions {
    ShadingOptions::default().with_specular_power(SPECULAR_POWER)
}

pub fn make() -> Result<Figure> {
    let scene = scene(shape_of(isosurface(DETAIL))?, 1.0);
    let (mut numbers, mut rows, mut pictures, mut holds) = (Map::new(), Vec::new(), Vec::new(), true);
    for (distance, frequency) in DISTANCES {
        let exact = bumps(frequency, OctaveFilter::Fade);
        let truth = Truth { shading: Shading::Lean, detail: &exact, options: options(), samples: SAMPLES };
        let truth = truth.render(&scene, SIZE, &unwatched)?;
        let mut errors = Vec::new();
        for filter in [OctaveFilter::Fade, OctaveFilter::Drop, OctaveFilter::Keep] {
            let detail = bumps(frequency, filter);
            // The surface's own curvature is not what is measured.
            let picture =
                shaded(&scene, &Curved { detail: &detail, filter: Default::default() }, SIZE, options())?;
            let error = rmse(&picture, &truth)?;
            numbers.insert(format!("RMSE, {distance}, {filter}"), json!(error));
            rows.push(vec![
                format!("{distance}, {filter}"),
                format!("{error:.5}"),
                format!("{:+.1} %", 100.0 * energy_error(&picture, &truth)?),
            ]);
            pictures.push((picture, format!("{distance}, {filter}: RMSE {error:.4}")));
            errors.push(error);
        }
        holds &= errors[0] < errors[1] && errors[0] < errors[2];
        pictures.push((truth, format!("{distance}, ground truth, {SAMPLES} samples per pixel")));
    }
    Ok(Figure {
        title: "octaves of noise finer than a pixel (ours)",
        claim: "octaves that fade into roughness are nearer to ground truth (RMSE) than octaves that are dropped and than octaves that \
                are kept, near, mid and far"
            .to_owned(),
        numbers,
        holds,
        making: format!(
            "{OCTAVES} octaves of noise with {} cells of the first one per unit of length, on an isosurface of {} triangles; s = \
             {SPECULAR_POWER}; {}x{} pixels.",
            DISTANCES.map(|(_, frequency)| frequency.to_string()).join(", "),
            20 * DETAIL * DETAIL,
            SIZE.0,
            SIZE.1
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table { header: vec!["distance, octaves", "RMSE", "energy of the highlight"], rows }),
    })
}
