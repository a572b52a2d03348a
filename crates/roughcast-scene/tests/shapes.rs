//! Laws of the shapes defined by a formula.

mod common;

use common::{Numbers, hits, unorthonormality, wrapped};
use glam::{DVec2, DVec3, Vec3};
use roughcast_scene::{Bounds, Hit, MAX_DETAIL, Plane, Ray, Shape, ShapeError, Sphere, Torus, TriangleMesh};

/// Rounding of positions a few units from the origin, seen from a few tens of units.
const ON_SURFACE: f64 = 1e-12;
/// Rounding of products of unit vectors.
const ORTHONORMAL: f64 = 1e-12;

fn shapes() -> Vec<(&'static str, Shape)> {
    vec![
        ("plane", Shape::Plane(Plane::new(2.5).unwrap())),
        ("sphere", Shape::Sphere(Sphere)),
        ("torus", Shape::Torus(Torus::default())),
        ("thin torus", Shape::Torus(Torus::new(0.02).unwrap())),
        ("fat torus", Shape::Torus(Torus::new(0.98).unwrap())),
    ]
}

/// Distance of a point from the surface.
fn residual(shape: &Shape, p: DVec3) -> f64 {
    match shape {
        Shape::Plane(plane) => {
            p.y.abs().max(p.x.abs() - plane.half_size()).max(p.z.abs() - plane.half_size())
        }
        Shape::Sphere(_) => (p.length() - 1.0).abs(),
        Shape::Torus(torus) => ((p.x.hypot(p.z) - 1.0).hypot(p.y) - torus.minor()).abs(),
        Shape::Mesh(_) => unreachable!(),
    }
}

/// The point of a parametrisation, written independently of the code under test.
fn point(shape: &Shape, uv: DVec2) -> DVec3 {
    let (u, v) = ((uv.x - 0.5) * std::f64::consts::TAU, uv.y * std::f64::consts::PI);
    match shape {
        Shape::Plane(plane) => DVec3::new(uv.x * 2.0 - 1.0, 0.0, uv.y * 2.0 - 1.0) * plane.half_size(),
        Shape::Sphere(_) => DVec3::new(v.sin() * u.sin(), v.cos(), v.sin() * u.cos()),
        Shape::Torus(torus) => {
            // 2 v - pi is the angle below the outer equator.
            let r = 1.0 - torus.minor() * (2.0 * v).cos();
            DVec3::new(r * u.sin(), torus.minor() * (2.0 * v).sin(), r * u.cos())
        }
        Shape::Mesh(_) => unreachable!(),
    }
}

#[test]
fn hits_lie_on_the_surface_and_on_the_ray() {
    for (name, shape) in shapes() {
        let hits = hits(&shape, 20_000);
        assert!(hits.len() > 500, "{name}: {} hits", hits.len());
        for (ray, hit) in hits {
            assert!(residual(&shape, hit.position) < ON_SURFACE, "{name}");
            let on_ray = ray.origin + ray.direction * hit.distance;
            assert!(on_ray.distance(hit.position) < ON_SURFACE, "{name}");
            assert!(hit.distance > 0.0);
            assert!(
                hit.uv(0).min_element() >= 0.0 && hit.uv(0).max_element() <= 1.0,
                "{name}: {}",
                hit.uv(0)
            );
            assert!(point(&shape, hit.uv(0)).distance(hit.position) < ON_SURFACE, "{name}: {}", hit.uv(0));
        }
    }
}

#[test]
fn frames_are_orthonormal_and_face_the_viewer() {
    for (name, shape) in shapes() {
        for (ray, hit) in hits(&shape, 5_000) {
            assert!(unorthonormality(&hit) < ORTHONORMAL, "{name}");
            assert!(hit.geometric_normal.dot(ray.direction) <= 0.0, "{name}");
            // Right, up, out: the tangent points along growing u, the bitangent along falling v. From behind, all are
            // reversed.
            let side = hit.dpdv(0).cross(hit.dpdu(0)).dot(hit.frame.normal()).signum();
            assert!(hit.dpdu(0).dot(hit.frame.tangent()) * side > 0.0, "{name}");
            assert!(hit.dpdv(0).dot(hit.frame.bitangent()) * side < 0.0, "{name}");
        }
    }
}

#[test]
fn derivatives_agree_with_finite_differences() {
    const STEP: f64 = 1e-5;
    // The error of a central difference is about STEP^2 times the third derivative, at most (2 pi)^3 times 2.
    const TOLERANCE: f64 = 1e-7;
    for (name, shape) in shapes() {
        for (_, hit) in hits(&shape, 3_000) {
            let along =
                |d: DVec2| (point(&shape, hit.uv(0) + d) - point(&shape, hit.uv(0) - d)) / (2.0 * STEP);
            assert!((along(DVec2::X * STEP) - hit.dpdu(0)).length() < TOLERANCE, "{name} u");
            assert!((along(DVec2::Y * STEP) - hit.dpdv(0)).length() < TOLERANCE, "{name} v");
        }
    }
}

#[test]
fn the_nearest_hit_is_the_first_where_the_ray_enters() {
    // Ray marching with the signed distance, far slower than the quartic and without its algebra.
    fn marched(torus: &Torus, ray: &Ray) -> Option<f64> {
        let mut t = 0.0;
        for _ in 0..20_000 {
            let p = ray.origin + ray.direction * t;
            let distance = (p.x.hypot(p.z) - 1.0).hypot(p.y) - torus.minor();
            if distance < 1e-10 {
                return Some(t);
            }
            t += distance;
            if t > 40.0 {
                return None;
            }
        }
        None
    }
    for minor in [0.02, 0.4, 0.98] {
        let torus = Torus::new(minor).unwrap();
        let shape = Shape::Torus(torus);
        let mut numbers = Numbers(3);
        let (mut met, mut grazed) = (0, 0);
        for _ in 0..4_000 {
            let ray = numbers.ray_at(&shape);
            match (marched(&torus, &ray), shape.hit(&ray)) {
                (Some(t), Some(hit)) => {
                    let cosine = -hit.geometric_normal.dot(ray.direction);
                    // The march stops 1e-10 above the surface, which is longer along a grazing ray.
                    assert!(
                        (t - hit.distance).abs() < 3e-10 / cosine.max(1e-5),
                        "{minor}: {t} {}",
                        hit.distance
                    );
                    met += 1;
                }
                (None, None) => {}
                _ => grazed += 1,
            }
        }
        assert!(met > 100, "{minor}: {met}");
        // Rays that pass within 1e-10 of the surface, where the march cannot decide, are very rare.
        assert!(grazed <= 1, "{minor}: {grazed}");
    }
}

#[test]
fn grazing_rays_are_accurate() {
    // Rays across the top of the torus, just below and just above it.
    let torus = Shape::Torus(Torus::new(0.4).unwrap());
    for exponent in 1..=14 {
        let depth = 10f64.powi(-exponent);
        let ray = |y: f64| Ray { origin: DVec3::new(1.0, y, 30.0), direction: DVec3::NEG_Z };
        let hit = torus.hit(&ray(0.4 - depth)).unwrap_or_else(|| panic!("depth {depth} is missed"));
        assert!(residual(&torus, hit.position) < ON_SURFACE);
        assert!(hit.geometric_normal.y > 0.0);
        assert!(torus.hit(&ray(0.4 + depth)).is_none(), "height {depth} is hit");
    }
    let sphere = Shape::Sphere(Sphere);
    for exponent in 1..=14 {
        let depth = 10f64.powi(-exponent);
        let ray = |y: f64| Ray { origin: DVec3::new(0.0, y, 30.0), direction: DVec3::NEG_Z };
        assert!(sphere.hit(&ray(1.0 - depth)).is_some() && sphere.hit(&ray(1.0 + depth)).is_none());
    }
}

#[test]
fn distant_eyes_are_accurate() {
    for (name, shape) in shapes().into_iter().take(3) {
        let origin = DVec3::new(1.0, 0.7, 0.9) * 1e6;
        let target = point(&shape, DVec2::new(0.55, 0.4));
        let hit = shape.hit(&Ray { origin, direction: (target - origin).normalize() }).unwrap();
        // Values of 1e6 have an absolute precision of 1e-10.
        assert!(residual(&shape, hit.position) < 1e-9, "{name}");
    }
}

#[test]
fn from_inside_and_from_behind() {
    for shape in [Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let origin = if matches!(shape, Shape::Sphere(_)) { DVec3::ZERO } else { DVec3::Z };
        let ray = Ray { origin, direction: DVec3::Z };
        let hit = shape.hit(&ray).unwrap();
        assert!((hit.geometric_normal + DVec3::Z).length() < ORTHONORMAL);
        assert!((hit.frame.tangent() + DVec3::X).length() < ORTHONORMAL);
        assert!((hit.frame.bitangent() + DVec3::Y).length() < ORTHONORMAL);
    }
    let below = Ray { origin: DVec3::new(0.1, -2.0, 0.2), direction: DVec3::Y };
    let plane = Shape::Plane(Plane::default());
    let hit = plane.hit(&below).unwrap();
    assert_eq!(hit.frame.normal(), DVec3::NEG_Y);
    assert_eq!(hit.dpdu(0), DVec3::X * 2.0);
    let away = Ray { origin: DVec3::new(0.0, 3.0, 0.0), direction: DVec3::Y };
    for (name, shape) in shapes() {
        assert!(shape.hit(&away).is_none(), "{name}");
    }
    let within = Ray { origin: DVec3::new(-3.0, 0.0, 0.0), direction: DVec3::X };
    assert!(Shape::Plane(Plane::default()).hit(&within).is_none());
    let nan = Ray { origin: DVec3::NAN, direction: DVec3::X };
    assert!(shapes().iter().all(|(_, shape)| shape.hit(&nan).is_none()));
}

#[test]
fn maps_are_upright_where_the_camera_stands() {
    // Seen from +z: u grows to the picture's right, v falls towards its top.
    for (name, shape) in shapes().into_iter().skip(1).take(2) {
        let outer = shape.bounds().radius;
        let look = |x: f64, y: f64| {
            shape.hit(&Ray { origin: DVec3::new(x, y, 9.0), direction: DVec3::NEG_Z }).unwrap()
        };
        let middle = look(0.0, 0.0);
        assert!((middle.uv(0) - 0.5).length() < ORTHONORMAL, "{name}");
        assert!((middle.position - DVec3::Z * outer).length() < ON_SURFACE, "{name}");
        assert!(look(0.1, 0.0).uv(0).x > 0.5 && look(0.0, 0.1).uv(0).y < 0.5, "{name}");
    }
    let plane = Shape::Plane(Plane::default());
    let eye = DVec3::new(0.0, 2.0, 3.0);
    let look =
        |target: DVec3| plane.hit(&Ray { origin: eye, direction: (target - eye).normalize() }).unwrap().uv(0);
    assert!(look(DVec3::X * 0.5).x > 0.5);
    // Farther away is higher in the picture, and nearer to the top of the map.
    assert!(look(DVec3::Z * -0.5).y < 0.5);
}

#[test]
fn poles_are_defined() {
    for sign in [1.0, -1.0] {
        let ray = Ray { origin: DVec3::Y * 5.0 * sign, direction: DVec3::NEG_Y * sign };
        let hit = Shape::Sphere(Sphere).hit(&ray).unwrap();
        assert!(unorthonormality(&hit) < ORTHONORMAL);
        let neighbour = Ray { direction: DVec3::new(1e-3, -sign, 1e-3).normalize(), ..ray };
        let footprint = hit.footprint(0, &neighbour, &neighbour);
        assert!(footprint.dx.is_finite() && footprint.dy.is_finite());
    }
}

#[test]
fn bounds_hold_the_shape_tightly() {
    for (name, shape) in shapes() {
        let Bounds { centre, radius } = shape.bounds();
        let farthest = shape
            .triangles(64)
            .positions
            .iter()
            .map(|&p| Vec3::from(p).as_dvec3().distance(centre))
            .fold(0.0, f64::max);
        // f32 positions.
        assert!((farthest / radius - 1.0).abs() < 1e-6, "{name}: {farthest} {radius}");
    }
}

#[test]
fn impossible_shapes_are_refused() {
    for half in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Plane::new(half), Err(ShapeError::HalfSize(_))));
    }
    for minor in [0.0, 1.0, -0.1, f64::NAN] {
        assert!(matches!(Torus::new(minor), Err(ShapeError::MinorRadius(_))));
    }
}

// Footprints

/// Differences of the texture coordinates of neighbouring hits, for rays a small angle apart.
fn differences(shape: &Shape, ray: &Ray, hit: &Hit<'_>, aside: DVec3) -> Option<(DVec2, DVec2)> {
    let moved = |step: f64| {
        let neighbour = Ray { direction: (ray.direction + aside * step).normalize(), ..*ray };
        shape.hit(&neighbour).map(|h| (neighbour, h))
    };
    const STEP: f64 = 1e-5;
    let ((neighbour, after), (_, before)) = (moved(STEP)?, moved(-STEP)?);
    let measured = wrapped(after.uv(0) - before.uv(0)) / (2.0 * STEP);
    Some((measured, hit.footprint(0, &neighbour, ray).dx / STEP))
}

#[test]
fn footprints_agree_with_neighbouring_hits() {
    for (name, shape) in shapes().into_iter().take(3) {
        let mut numbers = Numbers(11);
        let (mut compared, mut noticed) = (0, 0);
        for (ray, hit) in hits(&shape, 4_000) {
            // Where the ray grazes, or near a pole, the surface leaves its tangent plane within one step.
            let cosine = -hit.geometric_normal.dot(ray.direction);
            if cosine < 0.2 || hit.dpdu(0).length() < 0.5 {
                continue;
            }
            let aside = numbers.direction();
            let error = |hit: &Hit<'_>| {
                differences(&shape, &ray, hit, aside)
                    .map(|(measured, footprint)| (measured - footprint).length() / measured.length().max(0.1))
            };
            let Some(right) = error(&hit) else { continue };
            // First order: a step of 1e-5 times the distance of 10, divided by a radius of curvature of 0.4 and the
            // squared cosine: 6e-3.
            assert!(right < 2e-2, "{name}: {right} at {}", hit.uv(0));
            compared += 1;
            // The comparison can fail: it does with u and v exchanged.
            let exchanged = Hit { dpds: hit.dpdt, dpdt: hit.dpds, ..hit };
            noticed += usize::from(error(&exchanged).is_some_and(|wrong| wrong > 2e-2));
        }
        assert!(compared > 300, "{name}: {compared}");
        assert!(noticed * 10 > compared * 9, "{name}: {noticed} of {compared}");
    }
}

#[test]
fn footprints_end_at_the_horizon() {
    let plane = Shape::Plane(Plane::new(1e4).unwrap());
    let eye = DVec3::new(0.0, 1.0, 0.0);
    let towards = |y: f64| Ray { origin: eye, direction: DVec3::new(0.0, y, -1.0).normalize() };
    let ray = towards(-1e-3);
    let hit = plane.hit(&ray).unwrap();
    let mut last = 0.0;
    for y in [-1e-3, -5e-4, -1e-6, -1e-9, 0.0, 1e-3, 0.5] {
        let footprint = hit.footprint(0, &ray, &towards(y));
        assert!(footprint.dx.length() < 1e-9, "{footprint:?}");
        // Upwards in the picture is farther away: towards -z, with falling v.
        assert!(footprint.dy.is_finite() && -footprint.dy.y >= last * 0.5, "{y}: {footprint:?}");
        last = -footprint.dy.y;
    }
    assert!(last > 10.0, "{last}");
}

#[test]
fn footprints_without_texture_coordinates_are_zero() {
    let plane = Shape::Plane(Plane::default());
    let ray = Ray { origin: DVec3::new(0.1, 1.0, 0.2), direction: DVec3::NEG_Y };
    let aside = Ray { direction: DVec3::new(0.01, -1.0, 0.0).normalize(), ..ray };
    let hit = plane.hit(&ray).unwrap();
    let none = Hit { dpds: DVec3::ZERO, dpdt: DVec3::ZERO, ..hit };
    assert_eq!(none.footprint(0, &aside, &aside).dx, DVec2::ZERO);
    // Only one of the two derivatives is zero: the other one's contribution is kept.
    let one = Hit { dpdt: DVec3::ZERO, ..hit };
    assert!((one.footprint(0, &aside, &ray).dx - DVec2::new(0.005, 0.0)).length() < 1e-12);
    let parallel = Hit { dpdt: hit.dpds, ..hit };
    assert!(parallel.footprint(0, &aside, &ray).dx.is_finite());
}

// Tessellation

fn triangles(mesh: &TriangleMesh) -> impl Iterator<Item = [usize; 3]> {
    mesh.indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
}

/// Largest distance of the triangles' midpoints from the surface, and the triangles' total area.
fn error_and_area(shape: &Shape, mesh: &TriangleMesh) -> (f64, f64) {
    let at = |k: usize| Vec3::from(mesh.positions[k]).as_dvec3();
    triangles(mesh).fold((0.0_f64, 0.0), |(worst, area), [a, b, c]| {
        let (a, b, c) = (at(a), at(b), at(c));
        (worst.max(residual(shape, (a + b + c) / 3.0)), area + 0.5 * (b - a).cross(c - a).length())
    })
}

#[test]
fn tessellations_converge_to_the_shape() {
    for (name, shape) in shapes() {
        let mut errors = Vec::new();
        for detail in [16, 32, 64] {
            let mesh = shape.triangles(detail);
            errors.push(error_and_area(&shape, &mesh).0);
        }
        // Second-order convergence, until f32 positions limit it.
        for pair in errors.windows(2) {
            assert!(pair[1] < 0.3 * pair[0] + 1e-6, "{name}: {errors:?}");
        }
        let area = error_and_area(&shape, &shape.triangles(128)).1;
        let pi = std::f64::consts::PI;
        let wanted = match &shape {
            Shape::Plane(plane) => 4.0 * plane.half_size() * plane.half_size(),
            Shape::Sphere(_) => 4.0 * pi,
            Shape::Torus(torus) => 4.0 * pi * pi * torus.minor(),
            Shape::Mesh(_) => unreachable!(),
        };
        // Chords instead of arcs of 1/128 turn: 1 - cos(pi / 128) = 3e-4.
        assert!((area / wanted - 1.0).abs() < 1e-3, "{name}: {area} {wanted}");
    }
}

#[test]
fn vertices_are_exact_and_fronts_turn_counter_clockwise() {
    // Single floats: half a unit in the last place of values up to 2.5.
    const SINGLE: f64 = 5e-7;
    for (name, shape) in shapes() {
        let mesh = shape.triangles(24);
        for k in 0..mesh.positions.len() {
            let uv = DVec2::new(f64::from(mesh.uv_sets[0][k][0]), f64::from(mesh.uv_sets[0][k][1]));
            let position = Vec3::from(mesh.positions[k]).as_dvec3();
            assert!(point(&shape, uv).distance(position) < 20.0 * SINGLE, "{name}");
            let normal = Vec3::from(mesh.normals[k]);
            let [x, y, z, w] = mesh.tangents[k];
            let tangent = Vec3::new(x, y, z);
            assert!((normal.length() - 1.0).abs() < 1e-6 && (tangent.length() - 1.0).abs() < 1e-6);
            assert!(normal.dot(tangent).abs() < 1e-6 && w == 1.0);
            // The frame of a hit at that vertex, from outside.
            let n = normal.as_dvec3();
            let hit = shape.hit(&Ray { origin: position * (1.0 - 1e-6) + n, direction: -n });
            if let Some(hit) =
                hit.filter(|h| h.dpdu(0).length() > 0.1 && h.position.distance(position) < 1e-4)
            {
                assert!((hit.frame.normal() - n).length() < 1e-4, "{name} normal {}", hit.uv(0));
                assert!(
                    (hit.frame.tangent() - tangent.as_dvec3()).length() < 1e-4,
                    "{name} tangent {}",
                    hit.uv(0)
                );
                let bitangent = w * normal.cross(tangent);
                assert!((hit.frame.bitangent() - bitangent.as_dvec3()).length() < 1e-4, "{name} bitangent");
            }
        }
        for [a, b, c] in triangles(&mesh) {
            let at = |k: usize| Vec3::from(mesh.positions[k]);
            let outwards = (at(b) - at(a)).cross(at(c) - at(a));
            assert!(outwards.dot(Vec3::from(mesh.normals[b])) > 0.0, "{name}");
        }
    }
}

#[test]
fn detail_is_clamped_to_its_range() {
    let sphere = Shape::Sphere(Sphere);
    assert_eq!(sphere.triangles(0), sphere.triangles(1));
    assert_eq!(sphere.triangles(u32::MAX).positions.len() as u32, (2 * MAX_DETAIL + 1) * (MAX_DETAIL + 1));
}
