//! Geometric specular antialiasing: meshes without any bumps, from near to far. Not a figure of a paper on bumps.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::shading::{GeometricFilter, Shading, ShadingOptions};
use roughcast_scene::metrics::rmse;
use roughcast_scene::render::{Truth, unwatched};
use roughcast_scene::{Combined, Curved, Picture, Scene, Shape, TriangleMesh};
use serde_json::{Map, json};

use super::bumps::{panels, scene, shaded, shape_of};
use super::given::mesh;
use super::{Args, Figure, Table};

const SIZE: (u32, u32) = (160, 160);
const SAMPLES: u32 = 100;
const SPECULAR_POWER: f32 = 1024.0;
/// How much of the picture's height the mesh fills, and in how many positions within a pixel it is measured. From far away a
/// few pixels have all of the highlight: in one position, the energy of a picture without antialiasing is that of one sample.
const VIEWS: [(&str, f64, u32); 3] = [("near", 1.0, 2), ("mid", 0.4, 8), ("far", 0.16, 32)];
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

/// The scene, moved within a pixel to one of `count` positions that are spread evenly. The first one is the scene itself.
fn moved(scene: &Scene, position: u32, count: u32) -> Scene {
    // The fractional parts of the multiples of the golden ratio are spread evenly, whatever their number.
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;
    let across = f64::from(position) / f64::from(count);
    let down = (f64::from(position) * GOLDEN_RATIO).fract();
    let mut moved = scene.clone();
    let camera = &mut moved.camera;
    let view = camera.target - camera.eye;
    let right = view.cross(camera.up).normalize();
    let up = right.cross(view).normalize();
    let pixel = 2.0 * view.length() * (0.5 * camera.vertical_fov).tan() / f64::from(SIZE.1);
    let shift = (right * across - up * down) * pixel;
    camera.eye += shift;
    camera.target += shift;
    moved
}

/// The energy of a picture's highlights: in all pixels, and in those that the mesh covers entirely, here and in another
/// picture.
fn energies(picture: &Picture, other: &Picture) -> [f64; 2] {
    // Weights of samples may add up to a little less than one.
    const COVERED: f32 = 1.0 - 1e-5;
    let [mut all, mut covered] = [0.0; 2];
    let coverages = picture.coverage().iter().zip(other.coverage());
    for (specular, (here, there)) in picture.specular().iter().zip(coverages) {
        let energy: f64 = specular.iter().copied().map(f64::from).sum();
        all += energy;
        if here.min(*there) > COVERED {
            covered += energy;
        }
    }
    [all, covered]
}

/// Pictures of one kind against the ground truth, over all positions.
#[derive(Default)]
struct Measured {
    squared_error: f64,
    /// [`energies`] of the pictures and of the ground truth.
    energy: [f64; 2],
    true_energy: [f64; 2],
    /// Squared relative errors of single pictures' energy.
    squared_change: f64,
    count: u32,
}

impl Measured {
    fn add(&mut self, picture: &Picture, truth: &Picture) -> Result<()> {
        let (energy, wanted) = (energies(picture, truth), energies(truth, picture));
        self.squared_error += rmse(picture, truth)?.powi(2);
        self.squared_change += (energy[0] / wanted[0] - 1.0).powi(2);
        self.energy = [self.energy[0] + energy[0], self.energy[1] + energy[1]];
        self.true_energy = [self.true_energy[0] + wanted[0], self.true_energy[1] + wanted[1]];
        self.count += 1;
        Ok(())
    }

    fn rmse(&self) -> f64 {
        (self.squared_error / f64::from(self.count)).sqrt()
    }

    /// Relative errors of the energy.
    fn changes(&self) -> [f64; 2] {
        [0, 1].map(|which| self.energy[which] / self.true_energy[which] - 1.0)
    }

    fn row(&self, name: String) -> Vec<String> {
        let [all, covered] = self.changes().map(|change| format!("{:+.1} %", 100.0 * change));
        let single = (self.squared_change / f64::from(self.count)).sqrt();
        vec![name, format!("{:.5}", self.rmse()), all, covered, format!("{:.1} %", 100.0 * single)]
    }
}

/// What is seen of a scene in one position: without antialiasing, with it, and the ground truth.
fn seen(scene: &Scene) -> Result<[Picture; 3]> {
    let flat = Combined::new(Vec::new());
    let filtered = Curved { detail: &flat, filter: GeometricFilter::default() };
    let truth = Truth { shading: Shading::Lean, detail: &flat, options: options(), samples: SAMPLES };
    Ok([
        shaded(scene, &flat, SIZE, options())?,
        shaded(scene, &filtered, SIZE, options())?,
        truth.render(scene, SIZE, &unwatched)?,
    ])
}

pub fn make(args: &Args) -> Result<Figure> {
    let mut shapes = vec![(BALL.to_owned(), rippled_ball()?)];
    if let Some((mesh, name)) = mesh(args)? {
        shapes.push((name, Shape::Mesh(Arc::new(mesh))));
    }
    let (mut numbers, mut rows, mut pictures, mut holds) = (Map::new(), Vec::new(), Vec::new(), true);
    for (name, shape) in shapes {
        for (distance, zoom, count) in VIEWS {
            let scene = scene(shape.clone(), zoom);
            let (mut without, mut with) = (Measured::default(), Measured::default());
            for position in 0..count {
                let [plain, widened, truth] = seen(&moved(&scene, position, count))?;
                without.add(&plain, &truth)?;
                with.add(&widened, &truth)?;
            }
            let ratio = with.rmse() / without.rmse();
            holds &= ratio <= if name == BALL { ERROR_RATIO } else { 1.0 };
            numbers.insert(format!("RMSE with / without, {name}, {distance}"), json!(ratio));
            for (how, measured) in [("without", &without), ("with", &with)] {
                numbers.insert(
                    format!("error of the energy {how}, {name}, {distance}"),
                    json!(measured.changes()[0]),
                );
                rows.push(measured.row(format!("{name}, {distance}, {how}")));
            }
            let [plain, widened, truth] = seen(&scene)?;
            pictures.push((plain, format!("{name}, {distance}, without")));
            pictures.push((widened, format!("{name}, {distance}, with: {ratio:.2} of the error")));
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
             the ground truth. Numbers are over several positions within a pixel: {}. Energy is that of the highlight over all of them; \
             the last column is the root mean square of its error in single pictures.",
            SIZE.0,
            SIZE.1,
            VIEWS.map(|(distance, _, count)| format!("{count} {distance}")).join(", ")
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table {
            header: vec![
                "mesh, distance",
                "RMSE",
                "energy of the highlight",
                "in covered pixels",
                "in one picture",
            ],
            rows,
        }),
    })
}
