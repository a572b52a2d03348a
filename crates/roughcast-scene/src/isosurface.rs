//! A triangulated isosurface without texture coordinates, for bumps that need none.

use glam::DVec3;

use crate::TriangleMesh;

/// Centres and inverse squared radii of the balls whose fields add up.
const BALLS: [(DVec3, f64); 5] = [
    (DVec3::new(0.0, 0.0, 0.0), 2.2),
    (DVec3::new(0.55, 0.25, 0.1), 5.0),
    (DVec3::new(-0.45, 0.35, 0.25), 6.0),
    (DVec3::new(0.1, -0.5, 0.3), 5.5),
    (DVec3::new(-0.15, 0.1, -0.6), 5.0),
];
/// The field on the surface.
const LEVEL: f64 = 0.35;
/// A distance beyond the surface in every direction.
const OUTSIDE: f64 = 3.0;

/// The field and its gradient.
fn field(p: DVec3) -> (f64, DVec3) {
    BALLS.iter().fold((0.0, DVec3::ZERO), |(sum, gradient), (centre, sharpness)| {
        let offset = p - *centre;
        let value = (-sharpness * offset.length_squared()).exp();
        (sum + value, gradient - offset * (2.0 * sharpness * value))
    })
}

/// An isosurface of five overlapping balls around the origin, with exact normals, `20 * detail²` triangles, and no
/// texture coordinates. Every ray from the origin meets it once, so it is found by bisection along the directions of a
/// divided icosahedron. Its radius is about one. `detail` is 1 or more.
pub fn isosurface(detail: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for [a, b, c] in icosahedron() {
        let first = mesh.positions.len() as u32;
        let detail = detail.max(1);
        let row = |i: u32| i * (i + 1) / 2;
        for i in 0..=detail {
            for j in 0..=i {
                // Barycentric coordinates: a is the apex, row i lies i / detail of the way down.
                let (down, across) = (f64::from(i) / f64::from(detail), f64::from(j) / f64::from(detail));
                let direction = a * (1.0 - down) + b * (down - across) + c * across;
                let position = on_surface(direction.normalize());
                let normal = -field(position).1.normalize();
                mesh.positions.push(position.as_vec3().into());
                mesh.normals.push(normal.as_vec3().into());
            }
        }
        for i in 0..detail {
            for j in 0..=i {
                let (above, below) = (first + row(i) + j, first + row(i + 1) + j);
                mesh.indices.extend([above, below, below + 1]);
                if j < i {
                    mesh.indices.extend([above, below + 1, above + 1]);
                }
            }
        }
    }
    mesh
}

/// The point of the surface in a direction from the origin.
fn on_surface(direction: DVec3) -> DVec3 {
    let (mut inside, mut outside) = (0.0, OUTSIDE);
    // Each step halves the interval: 60 of them exhaust an f64.
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if field(direction * middle).0 > LEVEL { inside = middle } else { outside = middle }
    }
    direction * inside
}

/// The twenty faces of an icosahedron, counter-clockwise as seen from outside.
fn icosahedron() -> Vec<[DVec3; 3]> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (one, long) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([DVec3::new(0.0, one, long), DVec3::new(one, long, 0.0), DVec3::new(long, 0.0, one)]);
    }
    // Neighbouring corners are two apart.
    let near = |a: DVec3, b: DVec3| (a.distance_squared(b) - 4.0).abs() < 1e-9;
    let mut faces = Vec::new();
    for i in 0..corners.len() {
        for j in i + 1..corners.len() {
            for k in j + 1..corners.len() {
                let (a, b, c) = (corners[i], corners[j], corners[k]);
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = (b - a).cross(c - a).dot(a + b + c) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::Mesh;

    #[test]
    fn the_mesh_is_closed_counter_clockwise_and_on_the_level() {
        let mesh = isosurface(8);
        assert_eq!(mesh.indices.len(), 3 * 20 * 64);
        let mut volume = 0.0;
        for triangle in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(mesh.positions[triangle[i] as usize]).as_dvec3());
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "{a} {b} {c}");
            volume += a.dot(b.cross(c)) / 6.0;
        }
        // The integral over directions of r³ / 3.
        let directions = icosahedron().into_iter().flatten().map(|corner| on_surface(corner.normalize()));
        let mean = directions.map(|p| p.length().powi(3)).sum::<f64>() / 60.0;
        assert!((volume / (4.0 / 3.0 * std::f64::consts::PI * mean) - 1.0).abs() < 0.2, "{volume}");
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let (value, gradient) = field(Vec3::from(*position).as_dvec3());
            assert!((value - LEVEL).abs() < 1e-5);
            assert!((Vec3::from(*normal).as_dvec3() + gradient.normalize()).length() < 1e-5);
        }
        let mesh = Mesh::new(vec![mesh]).expect("a mesh");
        assert!(!mesh.has_texture_coordinates());
        assert!((0.7..1.5).contains(&mesh.bounds().radius), "{:?}", mesh.bounds());
    }
}
