//! Laws of the surface gradient, in f64.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use roughcast::surface_gradient::*;
use roughcast::{Covariance, Moments, Slope};

/// A few dozen f64 roundings of numbers of the size of one.
const ROUNDING: f64 = 1e-13;

/// Error of central differences with [`STEP`]: its square times third derivatives, and rounding divided by it.
const DIFFERENCE: f64 = 1e-8;
const STEP: f64 = 1e-5;

/// Numbers in -1 ..= 1, the same in every run (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    fn normal(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if (0.1..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }
}

/// A surface with a chart, a normal field, and a height: what Blinn's formula needs.
struct Surface {
    name: &'static str,
    point: fn(DVec2) -> DVec3,
}

const SURFACES: [Surface; 3] = [
    Surface {
        name: "sphere",
        point: |st| DVec3::new(st.y.sin() * st.x.sin(), st.y.cos(), st.y.sin() * st.x.cos()),
    },
    Surface {
        name: "torus",
        point: |st| {
            let ring = 1.0 + 0.3 * st.y.cos();
            DVec3::new(ring * st.x.cos(), 0.3 * st.y.sin(), ring * st.x.sin())
        },
    },
    Surface { name: "cylinder", point: |st| DVec3::new(st.x.cos(), st.y, st.x.sin()) },
];

fn height(st: DVec2) -> f64 {
    0.05 * (3.0 * st.x + st.y).sin() + 0.02 * (5.0 * st.y - 2.0 * st.x).cos()
}

fn by_differences<T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>>(
    of: impl Fn(DVec2) -> T,
    at: DVec2,
) -> [T; 2] {
    let along = |axis: DVec2| (of(at + axis * STEP) - of(at - axis * STEP)) * (0.5 / STEP);
    [along(DVec2::X), along(DVec2::Y)]
}

#[test]
fn it_equals_blinns_formula_on_sphere_torus_and_cylinder() {
    let mut numbers = Numbers(1);
    for Surface { name, point } in SURFACES {
        for _ in 0..100 {
            let st = DVec2::new(numbers.next() * 3.0, 1.5 + numbers.next());
            let [sigma_s, sigma_t] = by_differences(point, st);
            let [height_s, height_t] = by_differences(height, st);
            let normal = sigma_s.cross(sigma_t).normalize();
            let ours =
                perturbed_normal(normal, surface_gradient(sigma_s, sigma_t, normal, height_s, height_t));
            let blinns = blinn_normal(sigma_s, sigma_t, height_s, height_t);
            assert!((ours - blinns).length() < ROUNDING, "{name}: {ours} {blinns}");
            // Blinn drops β n_s, so the surface itself agrees where the height is zero.
            let level = height(st);
            let displaced = |at: DVec2| {
                let [s, t] = by_differences(point, at);
                point(at) + s.cross(t).normalize() * (height(at) - level)
            };
            let [tau_s, tau_t] = by_differences(displaced, st);
            let real = tau_s.cross(tau_t).normalize();
            assert!((ours - real).length() < 1e-4, "{name}: {ours} {real}");
        }
    }
}

#[test]
fn a_mirrored_chart_gives_the_same_normal_and_blinns_formula_another() {
    let (sigma_s, sigma_t) = (DVec3::new(1.0, 0.2, 0.0), DVec3::new(0.3, 1.5, 0.0));
    let ours = |s, t, a, b| perturbed_normal(DVec3::Z, surface_gradient(s, t, DVec3::Z, a, b));
    let (right, mirrored) = (ours(sigma_s, sigma_t, 0.4, -0.3), ours(-sigma_s, sigma_t, -0.4, -0.3));
    assert!((right - mirrored).length() < ROUNDING, "{right} {mirrored}");
    let (right, mirrored) =
        (blinn_normal(sigma_s, sigma_t, 0.4, -0.3), blinn_normal(-sigma_s, sigma_t, -0.4, -0.3));
    assert!(right.z > 0.0 && mirrored.z < 0.0, "{right} {mirrored}");
}

#[test]
fn the_result_does_not_depend_on_the_parametrization() {
    let mut numbers = Numbers(2);
    for _ in 0..1000 {
        let normal = numbers.normal();
        let (sigma_s, sigma_t) = (numbers.vector(), numbers.vector());
        let (height_s, height_t) = (numbers.next(), numbers.next());
        if sigma_s.cross(sigma_t).dot(normal).abs() < 0.05 {
            continue; // nearly edge-on: rounding is amplified
        }
        let gradient = surface_gradient(sigma_s, sigma_t, normal, height_s, height_t);
        // Rotations, scales, shears and mirrors of the screen.
        for [a, b, c, d] in [
            [0.6, -0.8, 0.8, 0.6],
            [3.0, 0.0, 0.0, 0.25],
            [1.0, 2.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0, 1.0],
            [0.0, 1.0, 1.0, 0.0],
        ] {
            let other = surface_gradient(
                sigma_s * a + sigma_t * b,
                sigma_s * c + sigma_t * d,
                normal,
                height_s * a + height_t * b,
                height_s * c + height_t * d,
            );
            assert!(
                (gradient - other).length() < 1e3 * ROUNDING * (1.0 + gradient.length()),
                "{gradient} {other}"
            );
        }
    }
}

#[test]
fn the_gradient_is_tangent_and_gives_the_change_along_any_tangent() {
    let mut numbers = Numbers(3);
    for _ in 0..1000 {
        let normal = numbers.normal();
        let [tangent, bitangent] = any_tangents(normal);
        let in_plane = |x: f64, y: f64| tangent * x + bitangent * y;
        let (sigma_s, sigma_t) =
            (in_plane(numbers.next(), numbers.next()), in_plane(numbers.next(), numbers.next()));
        if sigma_s.cross(sigma_t).length() < 0.05 {
            continue;
        }
        let (height_s, height_t) = (numbers.next(), numbers.next());
        let gradient = surface_gradient(sigma_s, sigma_t, normal, height_s, height_t);
        assert!(gradient.dot(normal).abs() < 1e2 * ROUNDING, "{gradient}");
        let (a, b) = (numbers.next(), numbers.next());
        let along = gradient.dot(sigma_s * a + sigma_t * b);
        assert!((along - (a * height_s + b * height_t)).abs() < 1e2 * ROUNDING, "{along}");
    }
}

#[test]
fn the_gradient_of_a_volume_is_that_of_its_heights_on_the_surface() {
    let volume = |p: DVec3| (2.0 * p.x + p.y).sin() * (1.5 * p.z).cos();
    let mut numbers = Numbers(4);
    for Surface { name, point } in SURFACES {
        for _ in 0..100 {
            let st = DVec2::new(numbers.next() * 3.0, 1.5 + numbers.next());
            let [sigma_s, sigma_t] = by_differences(point, st);
            let normal = sigma_s.cross(sigma_t).normalize();
            let [height_s, height_t] = by_differences(|at| volume(point(at)), st);
            let p = point(st);
            let gradient = DVec3::new(
                2.0 * (2.0 * p.x + p.y).cos() * (1.5 * p.z).cos(),
                (2.0 * p.x + p.y).cos() * (1.5 * p.z).cos(),
                -1.5 * (2.0 * p.x + p.y).sin() * (1.5 * p.z).sin(),
            );
            let on_screen = surface_gradient(sigma_s, sigma_t, normal, height_s, height_t);
            let in_space = surface_gradient_of_volume(normal, gradient);
            assert!((on_screen - in_space).length() < DIFFERENCE, "{name}: {on_screen} {in_space}");
        }
    }
}

#[test]
fn the_surface_gradient_never_turns_the_normal_inward_and_perlins_does() {
    let mut numbers = Numbers(5);
    let mut inward = 0;
    for _ in 0..1000 {
        let (normal, gradient) = (numbers.normal(), numbers.vector() * 20.0);
        let ours = perturbed_normal(normal, surface_gradient_of_volume(normal, gradient));
        assert!(ours.dot(normal) > 0.0, "{ours}");
        inward += u32::from(perlin_normal(normal, gradient).dot(normal) < 0.0);
    }
    assert!(inward > 300, "{inward}");
    // A height that grows along the normal alone is flat on the surface.
    assert_eq!(perturbed_normal(DVec3::Z, surface_gradient_of_volume(DVec3::Z, DVec3::Z * 3.0)), DVec3::Z);
    assert_eq!(perlin_normal(DVec3::Z, DVec3::Z * 3.0), DVec3::NEG_Z);
}

#[test]
fn moments_are_transported_as_each_of_their_slopes() {
    // The form without any tangents: the mean tilt of the normal and its second moment as a 3x3 matrix.
    let (normal, mut numbers) = (DVec3::new(0.2, 0.9, -0.3).normalize(), Numbers(6));
    let (sigma_s, sigma_t) = (DVec3::new(1.0, -0.3, 0.4), DVec3::new(0.2, 0.1, 1.3));
    let (uv_s, uv_t) = (DVec2::new(0.7, -0.2), DVec2::new(0.4, 1.1));
    let height_per_uv = DVec2::new(0.8, 1.7);
    let gradients = texture_gradients(surface_basis(sigma_s, sigma_t, normal), uv_s, uv_t);
    let slopes: Vec<Slope> =
        (0..50).map(|_| Slope { x: numbers.next() as f32, y: numbers.next() as f32 }).collect();
    let count = slopes.len() as f64;
    let (mut tilt, mut second) = (DVec3::ZERO, DMat3::ZERO);
    for slope in &slopes {
        let (height_u, height_v) =
            (-height_per_uv.x * f64::from(slope.x), height_per_uv.y * f64::from(slope.y));
        let gradient = gradients[0] * height_u + gradients[1] * height_v;
        // The same from derivatives by s and t.
        let chain = |uv: DVec2| height_u * uv.x + height_v * uv.y;
        let by_screen = surface_gradient(sigma_s, sigma_t, normal, chain(uv_s), chain(uv_t));
        assert!((gradient - by_screen).length() < ROUNDING, "{gradient} {by_screen}");
        tilt -= gradient / count;
        second += DMat3::from_cols(gradient * gradient.x, gradient * gradient.y, gradient * gradient.z)
            * (1.0 / count);
    }
    assert!((second * normal).length() < ROUNDING, "the second moment has no part along the normal");
    let [tangent, bitangent] = any_tangents(normal);
    let matrix = slope_matrix(gradients, height_per_uv, tangent, bitangent);
    let mean = slopes.iter().fold(Moments::default(), |sum, slope| sum + Moments::of_slope(*slope))
        * (1.0 / count as f32);
    let moved = mean.transformed(matrix);
    let pairs = [
        (moved.mean.x, tilt.dot(tangent)),
        (moved.mean.y, tilt.dot(bitangent)),
        (moved.xx, tangent.dot(second * tangent)),
        (moved.yy, bitangent.dot(second * bitangent)),
        (moved.xy, tangent.dot(second * bitangent)),
    ];
    /// Moments are single floats.
    const SINGLE: f64 = 1e-6;
    assert!(pairs.iter().all(|(a, b)| (f64::from(*a) - b).abs() < SINGLE), "{pairs:?}");
    assert_ne!(moved.covariance(), Covariance::default());
}

#[test]
fn a_bump_normal_is_the_normal_of_its_gradient() {
    let mut numbers = Numbers(7);
    for _ in 0..1000 {
        let (normal, bump) = (numbers.normal(), numbers.normal());
        let gradient = surface_gradient_of_normal(normal, bump * 3.0);
        if normal.dot(bump) > 0.01 {
            assert!((perturbed_normal(normal, gradient) - bump).length() < ROUNDING, "{normal} {bump}");
        } else if normal.dot(bump) < 0.0 {
            assert_eq!(gradient, DVec3::ZERO);
        }
    }
}

#[test]
fn neighbours_give_the_gradient_of_a_plane_and_outliers_can_be_left_out() {
    let mut numbers = Numbers(8);
    for _ in 0..1000 {
        let (normal, slope) = (numbers.normal(), numbers.vector());
        let gradient = surface_gradient_of_volume(normal, slope);
        let offsets: [DVec3; 4] = std::array::from_fn(|_| numbers.vector());
        // Offsets out of the plane do not count: heights are those of the point below.
        let mut heights = offsets.map(|offset| gradient.dot(offset));
        let all = surface_gradient_of_neighbours(normal, offsets, heights, [1.0; 4]);
        assert!((all - gradient).length() < 1e-9, "{all} {gradient}");
        heights[2] += 100.0;
        let without = surface_gradient_of_neighbours(normal, offsets, heights, [1.0, 0.5, 0.0, 2.0]);
        assert!((without - gradient).length() < 1e-6 * (1.0 + gradient.length()), "{without} {gradient}");
    }
    let line = [DVec3::X, -DVec3::X, DVec3::X * 2.0, DVec3::ZERO];
    assert_eq!(surface_gradient_of_neighbours(DVec3::Z, line, [1.0; 4], [1.0; 4]), DVec3::ZERO);
}

#[test]
fn degenerate_surfaces_and_heights_that_are_not_finite_are_flat() {
    let (s, t, n) = (DVec3::X, DVec3::new(0.3, 2.0, 0.0), DVec3::Z);
    let flat = |gradient: DVec3| assert_eq!(perturbed_normal(n, gradient), n);
    flat(surface_gradient(s, s * 2.0, n, 1.0, 1.0));
    flat(surface_gradient(DVec3::ZERO, t, n, 1.0, 1.0));
    flat(surface_gradient(s, n, n, 1.0, 1.0));
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        flat(surface_gradient(s, t, n, odd, 1.0));
        flat(surface_gradient(s, t, n, 0.0, odd));
        flat(surface_gradient(s * odd, t, n, 1.0, 1.0));
        flat(surface_gradient_of_volume(n, DVec3::new(0.0, odd, 0.0)));
        flat(surface_gradient_of_normal(n, DVec3::new(0.0, odd, 1.0)));
        flat(surface_gradient_of_neighbours(n, [s, t, -s, -t], [odd, 0.0, 0.0, 0.0], [1.0; 4]));
        assert_eq!(perlin_normal(n, DVec3::X * odd), n);
        assert_eq!(displaced_normal(s, t, n, odd, 0.0), n);
        assert_eq!(displaced_normal(t, s, n, odd, 0.0), n, "mirrored");
        assert_eq!(blinn_normal(s, t, odd, 0.0), DVec3::ZERO);
    }
    assert_eq!(face_normal(s, s, n), n);
    assert_eq!(slope_matrix([DVec3::X * 1e300; 2], DVec2::splat(1e300), s, DVec3::Y), [[0.0; 2]; 2]);
}

#[test]
fn the_face_and_its_displacement_point_to_the_given_side() {
    let (s, t) = (DVec3::new(1.0, 0.0, 0.2), DVec3::new(0.0, 1.0, -0.1));
    let face = face_normal(s, t, DVec3::Z);
    assert!(face.dot(s).abs() < ROUNDING && face.dot(t).abs() < ROUNDING && face.z > 0.0);
    assert_eq!(face_normal(t, s, DVec3::Z), face);
    assert_eq!(face_normal(s, t, DVec3::NEG_Z), -face);
    // On a flat facet with its own normal, the displaced facet and the surface gradient agree.
    let ours = perturbed_normal(face, surface_gradient(s, t, face, 0.3, 0.5));
    for (s, t, a, b) in [(s, t, 0.3, 0.5), (t, s, 0.5, 0.3)] {
        assert!((displaced_normal(s, t, face, a, b) - ours).length() < ROUNDING);
    }
}

#[test]
fn rays_of_adjacent_pixels_give_the_derivatives_of_a_plane_and_of_its_surface_gradient() {
    let mut numbers = Numbers(12);
    for _ in 0..1000 {
        let (p, n) = (numbers.vector(), numbers.vector().normalize());
        let [s, t] = any_tangents(n).map(|axis| axis * 0.1 * (1.5 + numbers.next()));
        let origin = p + n * (2.0 + numbers.next()) + s - t * 3.0;
        // Whatever the lengths of the ray's direction and of the normal.
        let sigma = |offset: DVec3| position_derivative(p, n * 3.0, origin, (p + offset - origin) * 0.7);
        assert!((sigma(s) - s).length() < ROUNDING && (sigma(t) - t).length() < ROUNDING);
        let gradient = surface_gradient(sigma(s), sigma(t), n, 0.3, -0.2);
        assert!((gradient - surface_gradient(s, t, n, 0.3, -0.2)).length() < 100.0 * ROUNDING);
    }
    assert_eq!(position_derivative(DVec3::X, DVec3::Z, DVec3::Z, DVec3::X), DVec3::ZERO);
    assert_eq!(position_derivative(DVec3::X, DVec3::Z, DVec3::Z, DVec3::NAN), DVec3::ZERO);
}

#[test]
fn the_scale_free_frame_ignores_the_size_of_the_texture_and_keeps_its_shape() {
    let basis = surface_basis(DVec3::X, DVec3::new(0.4, 1.0, 0.0), DVec3::Z);
    let frame = |scale: f64| {
        scale_free_gradients(texture_gradients(
            basis,
            DVec2::new(1.0, 0.2) * scale,
            DVec2::new(0.1, -0.6) * scale,
        ))
    };
    let ([u, v], [u100, v100]) = (frame(1.0), frame(100.0));
    assert!((u - u100).length() < ROUNDING && (v - v100).length() < ROUNDING);
    assert!((u.length().max(v.length()) - 1.0).abs() < ROUNDING && u.length() != v.length());
    assert_eq!(scale_free_gradients([DVec3::ZERO; 2]), [DVec3::ZERO; 2]);
}

#[test]
fn any_tangents_are_orthonormal_and_right_handed() {
    let mut numbers = Numbers(9);
    let exact = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Z, DVec3::new(1e-9, 0.0, -1.0)];
    for normal in (0..100).map(|_| numbers.normal()).chain(exact) {
        let [tangent, bitangent] = any_tangents(normal);
        assert!((tangent.length() - 1.0).abs() < ROUNDING && (bitangent.length() - 1.0).abs() < ROUNDING);
        assert!((tangent.cross(bitangent) - normal).length() < ROUNDING, "{normal}");
    }
}

#[test]
fn on_the_screen_a_circle_of_heights_is_a_cone() {
    // A cone of height -r has the gradient -e_r, whatever the direction of the screen.
    for turn in 0..12 {
        let (sin, cos) = (TAU * f64::from(turn) / 12.0).sin_cos();
        let p = DVec3::new(cos, sin, 0.0) * 2.0;
        let gradient = surface_gradient(
            DVec3::X * 0.01,
            DVec3::Y * -0.01,
            DVec3::Z,
            -0.01 * p.x / 2.0,
            0.01 * p.y / 2.0,
        );
        assert!((gradient + p / 2.0).length() < ROUNDING, "{gradient}");
    }
}
