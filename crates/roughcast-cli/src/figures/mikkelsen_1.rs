//! Mikkelsen Figure 1: the displaced facet shows the edges of triangles, the surface gradient does not.

use std::collections::HashMap;

use anyhow::Result;
use glam::{DVec3, Vec3};
use roughcast::noise::{Noise, NoiseKind};
use roughcast_scene::{
    DetailPoint, NoiseDetail, Perturbation, Ray, Shape, Sphere, TriangleMesh, VolumeDerivative,
};
use serde_json::{Map, json};

use super::Figure;
use super::bumps::{degrees_between, exact_normal, panels, picture, scene, shape_of};

const SIZE: (u32, u32) = (360, 360);
/// Squares along v of the sphere's mesh: coarse, so that its edges can be seen.
const DETAIL: u32 = 12;
/// The largest angle that may remain between the two sides of an edge: that of interpolated normals a small step apart.
const SMOOTH: f64 = 0.1;
/// The smallest mean angle between the two sides of an edge that counts as hard.
const HARD: f64 = 5.0;
/// Distance of the points beside an edge, as a fraction of the way to the middle of the triangle.
const BESIDE: f64 = 1e-4;

fn bumps(perturbation: Perturbation) -> NoiseDetail {
    let noise =
        Noise::default().with_kind(NoiseKind::Fbm).with_octaves(3).with_frequency(3.0).with_amplitude(0.08);
    let derivative = VolumeDerivative::Forward;
    NoiseDetail { perturbation, derivative, ..NoiseDetail::new(noise) }
}

pub fn make() -> Result<Figure> {
    let mesh = Shape::Sphere(Sphere).triangles(DETAIL);
    let shape = shape_of(mesh.clone())?;
    let (facets, smooth) = (bumps(Perturbation::Facets), bumps(Perturbation::SurfaceGradient));
    let (of_facets, of_gradient) = (jumps(&shape, &mesh, &facets), jumps(&shape, &mesh, &smooth));
    let mut numbers = Map::new();
    for (name, jumps) in [("facets", &of_facets), ("surface gradient", &of_gradient)] {
        numbers.insert(format!("mean angle across an edge, {name}, degrees"), json!(jumps.mean));
        numbers.insert(format!("largest angle across an edge, {name}, degrees"), json!(jumps.largest));
    }
    let scene = scene(shape, 1.0);
    let pictures = vec![
        (picture(&scene, &facets, SIZE)?, "normal of the displaced facet, τs × τt".to_owned()),
        (picture(&scene, &smooth, SIZE)?, "surface gradient, Listing 1".to_owned()),
    ];
    Ok(Figure {
        title: "hard edges",
        claim: format!(
            "the normal jumps by at least {HARD}° on average at the edges of triangles if it is that of the displaced facet, and \
             by at most {SMOOTH}° anywhere with the surface gradient"
        ),
        numbers,
        holds: of_facets.mean >= HARD && of_gradient.largest <= SMOOTH,
        making: format!(
            "A sphere of {} triangles with smooth vertex normals; three octaves of noise by forward differences on the screen. \
             Angles between the normals on both sides of every edge.",
            mesh.indices.len() / 3
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: None,
    })
}

/// Angles between the normals beside the edges of a mesh.
struct Jumps {
    mean: f64,
    largest: f64,
}

fn jumps(shape: &Shape, mesh: &TriangleMesh, detail: &NoiseDetail) -> Jumps {
    let corner = |i: u32| Vec3::from(mesh.positions[i as usize]).as_dvec3();
    let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0);
    let triangles: Vec<[DVec3; 3]> =
        mesh.indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]).collect();
    for ([a, b], [one, other]) in edges(&triangles) {
        let centre = |t: [DVec3; 3]| (t[0] + t[1] + t[2]) / 3.0;
        let middle = 0.5 * (a + b);
        let normals = [one, other].map(|t| normal_at(shape, detail, middle.lerp(centre(t), BESIDE)));
        let [Some(one), Some(other)] = normals else { continue };
        let angle = degrees_between(one, other);
        (sum, largest, count) = (sum + angle, largest.max(angle), count + 1);
    }
    Jumps { mean: sum / f64::from(count.max(1)), largest }
}

/// Every edge that two triangles share, with both of them.
fn edges(triangles: &[[DVec3; 3]]) -> Vec<([DVec3; 2], [[DVec3; 3]; 2])> {
    let mut open = HashMap::new();
    let mut shared = Vec::new();
    for triangle in triangles {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            // Seams repeat positions, not vertices.
            let key = |p: DVec3| p.to_array().map(|x| ((x + 0.0) as f32).to_bits());
            let (a, b) = (triangle[i], triangle[j]);
            match open.remove(&(key(b), key(a))) {
                Some(other) => shared.push(([a, b], [*triangle, other])),
                None => drop(open.insert((key(a), key(b)), *triangle)),
            }
        }
    }
    shared
}

/// The normal of the bumps at a point of the sphere's mesh.
fn normal_at(shape: &Shape, detail: &NoiseDetail, p: DVec3) -> Option<DVec3> {
    let out = p.normalize();
    let hit = shape.hit(&Ray { origin: p + out, direction: -out })?;
    Some(exact_normal(detail, &DetailPoint::new(&hit, 1.0)))
}
