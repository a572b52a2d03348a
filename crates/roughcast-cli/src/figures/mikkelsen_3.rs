//! Mikkelsen Figure 3: derivatives on the screen against the gradient in space, on an isosurface.

use anyhow::Result;
use roughcast::noise::{Noise, NoiseKind};
use roughcast_scene::{NoiseDetail, VolumeDerivative, isosurface};
use serde_json::{Map, json};

use super::bumps::{angles, exact_normal, panels, picture, scene, shaded_normal, shape_of};
use super::{Figure, Table};

const SIZE: (u32, u32) = (360, 360);
const CLOSE_UP: (u32, u32) = (240, 240);
/// Divisions of an edge of the icosahedron.
const DETAIL: u32 = 64;
/// Magnifications of the close-up.
const ZOOMS: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// The largest mean angle between the two methods, in degrees, where pixels are dense.
const SAME: f64 = 2.0;
/// How much the error must fall from the first to the last magnification.
const FALLS: f64 = 8.0;

fn bumps(derivative: VolumeDerivative) -> NoiseDetail {
    let noise = Noise::default()
        .with_kind(NoiseKind::Turbulence)
        .with_octaves(6)
        .with_frequency(2.0)
        .with_amplitude(0.12);
    NoiseDetail { derivative, ..NoiseDetail::new(noise) }
}

pub fn make() -> Result<Figure> {
    let shape = shape_of(isosurface(DETAIL))?;
    let (screen, space) = (bumps(VolumeDerivative::Fine), bumps(VolumeDerivative::Numeric));
    let exact = bumps(VolumeDerivative::Analytic);
    let whole = scene(shape.clone(), 1.0);
    let (mut numbers, mut rows, mut errors) = (Map::new(), Vec::new(), Vec::new());
    for zoom in ZOOMS {
        let scene = scene(shape.clone(), zoom);
        let error = |detail: &NoiseDetail| {
            angles(&scene, CLOSE_UP, |at| [shaded_normal(detail, at), exact_normal(&exact, at)]).mean
        };
        let row = [
            error(&screen),
            error(&bumps(VolumeDerivative::Forward)),
            error(&bumps(VolumeDerivative::Central)),
            error(&space),
        ];
        numbers.insert(format!("mean error of Listing 1, {zoom}x, degrees"), json!(row[0]));
        rows.push([vec![format!("{zoom}x")], row.map(|degrees| format!("{degrees:.3}")).to_vec()].concat());
        errors.push(row[0]);
    }
    let last = errors[errors.len() - 1];
    let falls = errors[0] / last;
    numbers.insert("error at 1x / at the last magnification".to_owned(), json!(falls));
    let monotone = errors.windows(2).all(|pair| pair[1] < pair[0]);
    let close = scene(shape, 8.0);
    let pictures = vec![
        (picture(&whole, &screen, SIZE)?, "Listing 1: derivatives on the screen".to_owned()),
        (picture(&whole, &space, SIZE)?, "Listing 3: central differences in space".to_owned()),
        (picture(&close, &screen, SIZE)?, "Listing 1, 8 times closer".to_owned()),
        (picture(&close, &space, SIZE)?, "Listing 3, 8 times closer".to_owned()),
    ];
    Ok(Figure {
        title: "derivatives on the screen and in space",
        claim: format!(
            "the error of derivatives on the screen falls with every doubling of the pixel density, by at least a factor of {FALLS} from 1x to \
             {}x, to at most {SAME}° on average",
            ZOOMS[ZOOMS.len() - 1]
        ),
        numbers,
        holds: monotone && falls >= FALLS && last <= SAME,
        making: format!(
            "Six octaves of turbulence on a triangulated isosurface of {} triangles; {}x{} pixels. Mean angles to the normal of the analytic \
             gradient; what remains of them is the difference between the triangles and their smooth normals.",
            20 * DETAIL * DETAIL,
            CLOSE_UP.0,
            CLOSE_UP.1
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table {
            header: vec!["magnification", "fine, degrees", "forward", "central", "central in space"],
            rows,
        }),
    })
}
