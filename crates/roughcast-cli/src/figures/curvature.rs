//! Geometric specular antialiasing: meshes without any bumps, from near to far. Not a figure of a paper on bumps.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::shading::{GeometricFilter, Shading, ShadingOptions};
use roughcast_scene::metrics::{energy_error, rmse};
use roughcast_scene::render::{Truth, unwatched};
use roughcast_scene::{Combined, Curved, Shape, TriangleMesh};
use serde_json::{Map, json};

use super::bumps::{panels, scene, shaded, shape_of};
use super::given::mesh;
use super::{Args, Figure, Table};

const SIZE: (u32, u32) = (160, 160);
const SAMPLES: u32 = 256;
const SPECULAR_POWER: f32 = 1024.0;
/// How much of the picture's height the mesh fills.
const ZOOMS: [(&str, f64); 3] = [("near", 1.0), ("mid", 0.4), ("far", 0.16)];
/// The name of the finely divided mesh.
const BALL: &str = "rippled ball";
/// The largest allowed error of the ball with antialiasing, relative to that without; a given mesh must only improve.
const ERROR_RATIO: f64 = 0.8;

/// A ball with fine ripples in its geometry: every vertex of a finely divided sphere is displaced.
fn rippled_ball() -> Result<Shape> {
    const DIVISIONS: u32 = 256;
    let mut mesh = Shape::Sphere(roughcast_scene::Sphere).triangles(DIVISIONS);
    for position in &mut mesh.positions {
        let p = DVec3::from(position.map(f64::from));
        let ripple = 0.004 * ((60.0 * p.x).sin() + (60.0 * p.y).sin() + (60.0 * p.z).sin());
        *position = (p * (1.0 + ripple)).as_vec3().into();
    }
    shape_of(TriangleMesh { normals: Vec::new(), tangents: Vec::new(), uv_sets: Vec::new(), ..mesh })
}

fn options() -> ShadingOptions {
    ShadingOptions::default().with_specular_power(SPECULAR_POWER)
}

pub fn make(args: &Args) -> Result<Figure> {
    let mut shapes = vec![(BALL.to_owned(), rippled_ball()?)];
    if let Some((mesh, name)) = mesh(args)? {
        shapes.push((name, Shape::Mesh(Arc::new(mesh))));
    }
    let flat = Combined::new(Vec::new());
    let filtered = Curved { detail: &flat, filter: GeometricFilter::default() };
    let (mut numbers, mut rows, mut pictures, mut holds) = (Map::new(), Vec::new(), Vec::new(), true);
    for (name, shape) in shapes {
        for (distance, zoom) in ZOOMS {
            let scene = scene(shape.clone(), zoom);
            let truth = Truth { shading: Shading::Lean, detail: &flat, options: options(), samples: SAMPLES };
            let truth = truth.render(&scene, SIZE, &unwatched)?;
            let (without, with) =
                (shaded(&scene, &flat, SIZE, options())?, shaded(&scene, &filtered, SIZE, options())?);
            let (error_without, error_with) = (rmse(&without, &truth)?, rmse(&with, &truth)?);
            let ratio = error_with / error_without;
            numbers.insert(format!("RMSE with / without, {name}, {distance}"), json!(ratio));
            for (how, picture, error) in [("without", &without, error_without), ("with", &with, error_with)] {
                rows.push(vec![
                    format!("{name}, {distance}, {how}"),
                    format!("{error:.5}"),
                    format!("{:+.1} %", 100.0 * energy_error(picture, &truth)?),
                ]);
            }
            holds &= ratio <= if name == BALL { ERROR_RATIO } else { 1.0 };
            pictures.push((without, format!("{name}, {distance}, without")));
            pictures.push((with, format!("{name}, {distance}, with: {ratio:.2} of the error")));
            pictures.push((truth, format!("{name}, {distance}, ground truth")));
        }
    }
    Ok(Figure {
        title: "geometric specular antialiasing",
        claim: format!(
            "the variance of interpolated normals under a pixel, added to the roughness, lowers the error (RMSE) against ground truth near, mid and \
             far, on the rippled ball from near to at most {ERROR_RATIO} of it"
        ),
        numbers,
        holds,
        making: format!(
            "Meshes without bumps, the ball of half a million triangles; s = {SPECULAR_POWER}; {}x{} pixels, {SAMPLES} samples per pixel of \
             the ground truth.",
            SIZE.0, SIZE.1
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table { header: vec!["mesh, distance", "RMSE", "energy of the highlight"], rows }),
    })
}
