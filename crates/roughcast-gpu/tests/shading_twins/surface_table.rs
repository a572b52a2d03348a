//! The surface gradient and geometric specular antialiasing: the functions in WGSL and their Rust twins, which are in f64.

use glam::{DVec2, DVec3};
use roughcast::shading::{GeometricFilter, geometric_covariance};
use roughcast::surface_gradient::*;

use crate::harness::{Gives, Twin};
use crate::inputs::Inputs;
use crate::table::covariance_words;

fn vector(a: &[f32]) -> DVec3 {
    DVec3::new(f64::from(a[0]), f64::from(a[1]), f64::from(a[2]))
}

fn pair(a: &[f32]) -> DVec2 {
    DVec2::new(f64::from(a[0]), f64::from(a[1]))
}

fn words(v: DVec3) -> Vec<f32> {
    v.as_vec3().to_array().to_vec()
}

fn both([a, b]: [DVec3; 2]) -> Vec<f32> {
    [words(a), words(b)].concat()
}

/// A unit vector in any direction.
fn normal(inputs: &mut Inputs) -> [f32; 3] {
    let [x, y, z] = inputs.direction();
    let side = if inputs.below(2) == 0 { 1.0 } else { -1.0 };
    [[x, y, side * z], [z, side * x, y], [side * y, z, x]][inputs.below(3)]
}

/// A vector of a length between a thousandth and a thousand.
fn any_vector(inputs: &mut Inputs) -> [f32; 3] {
    let size = inputs.between(-10.0, 10.0).exp2();
    normal(inputs).map(|x| x * size)
}

/// Derivatives of the position that span at least a few degrees as seen along a normal, and this normal.
fn surface(inputs: &mut Inputs) -> Vec<f32> {
    loop {
        let (s, t, n) = (any_vector(inputs), any_vector(inputs), normal(inputs));
        let (s64, t64, n64) = (vector(&s), vector(&t), vector(&n));
        if s64.cross(t64).dot(n64).abs() > 0.05 * s64.length() * t64.length() {
            return [s, t, n].concat();
        }
    }
}

/// The same with changes of the height that suit the derivatives.
fn surface_with_heights(inputs: &mut Inputs) -> Vec<f32> {
    let mut all = surface(inputs);
    for place in [0, 3] {
        let change = vector(&all[place..]).length() as f32 * inputs.between(-2.0, 2.0);
        all.push(change);
    }
    all
}

/// Two gradients of texture coordinates, within a factor of a hundred of each other.
fn gradients(inputs: &mut Inputs) -> Vec<f32> {
    let size = inputs.between(-10.0, 10.0).exp2();
    let mut gradient = || {
        let stretch = size * inputs.between(-3.0, 3.0).exp2();
        normal(inputs).map(|x| x * stretch)
    };
    [gradient(), gradient()].concat()
}

fn normal_and_vector(inputs: &mut Inputs) -> Vec<f32> {
    [normal(inputs), any_vector(inputs)].concat()
}

/// A normal, and a bump's that is not nearly perpendicular to it, where its slope has no limit.
fn normal_and_bump(inputs: &mut Inputs) -> Vec<f32> {
    loop {
        let (n, bump) = (normal(inputs), any_vector(inputs));
        let along = vector(&n).dot(vector(&bump)) / vector(&bump).length();
        if !(-0.01..0.01).contains(&along) {
            return [n, bump].concat();
        }
    }
}

/// Four neighbours around a point, of which at most one has no weight.
fn neighbours(inputs: &mut Inputs) -> Vec<f32> {
    let n = normal(inputs);
    let [tangent, bitangent] = any_tangents(vector(&n).normalize());
    let mut all = n.to_vec();
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
        let mut near = |x: f64| x + f64::from(inputs.between(-0.3, 0.3));
        let offset = tangent * near(x) + bitangent * near(y) + vector(&n) * near(0.0);
        all.extend(words(offset));
    }
    all.extend((0..4).map(|_| inputs.between(-1.0, 1.0)));
    let skipped = inputs.below(5);
    all.extend((0..4).map(|i| if i == skipped { 0.0 } else { inputs.between(0.2, 1.0) }));
    all
}

/// A position with a normal, and a ray that meets the plane near the position at no less than a few degrees.
fn plane_and_ray(inputs: &mut Inputs) -> Vec<f32> {
    let (p, n) = (normal(inputs), normal(inputs));
    let [tangent, bitangent] = any_tangents(vector(&n).normalize());
    let mut number = || f64::from(inputs.between(-1.0, 1.0));
    let offset = 0.1 * (tangent * number() + bitangent * number());
    let towards = vector(&n) * (2.0 + number()) + tangent * number() + bitangent * number();
    let ray = both([vector(&p) + towards, offset - towards]);
    [&p[..], &n, &ray].concat()
}

fn frame(inputs: &mut Inputs) -> Vec<f32> {
    both(any_tangents(vector(&normal(inputs)).normalize()))
}

pub fn bump_twins() -> Vec<Twin> {
    [gradient_twins(), normal_twins(), texture_twins()].into_iter().flatten().collect()
}

fn gradient_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "finite_or_flat",
            gives: Gives::Numbers,
            call: "put3(finite_or_flat(f3(0u)));",
            arguments: |inputs| any_vector(inputs).to_vec(),
            rust: |a, _, _| a[..3].to_vec(),
        },
        Twin {
            name: "unit_vector_or",
            gives: Gives::Numbers,
            call: "put3(unit_vector_or(f3(0u), f3(3u)));",
            arguments: normal_and_vector,
            rust: |a, _, _| words(vector(a).normalize_or(vector(&a[3..]))),
        },
        Twin {
            name: "surface_basis",
            gives: Gives::Numbers,
            call: "let basis = surface_basis(f3(0u), f3(3u), f3(6u)); put3(basis[0]); put3(basis[1]);",
            arguments: surface,
            rust: |a, _, _| both(surface_basis(vector(a), vector(&a[3..]), vector(&a[6..]))),
        },
        Twin {
            name: "surface_gradient",
            gives: Gives::Numbers,
            call: "put3(surface_gradient(f3(0u), f3(3u), f3(6u), f(9u), f(10u)));",
            arguments: surface_with_heights,
            rust: |a, _, _| {
                let (s, t, n) = (vector(a), vector(&a[3..]), vector(&a[6..]));
                words(surface_gradient(s, t, n, f64::from(a[9]), f64::from(a[10])))
            },
        },
        Twin {
            name: "surface_gradient_of_volume",
            gives: Gives::Numbers,
            call: "put3(surface_gradient_of_volume(f3(0u), f3(3u)));",
            arguments: normal_and_vector,
            rust: |a, _, _| words(surface_gradient_of_volume(vector(a), vector(&a[3..]))),
        },
        Twin {
            name: "surface_gradient_of_normal",
            gives: Gives::Numbers,
            call: "put3(surface_gradient_of_normal(f3(0u), f3(3u)));",
            arguments: normal_and_bump,
            rust: |a, _, _| words(surface_gradient_of_normal(vector(a), vector(&a[3..]))),
        },
        Twin {
            name: "surface_gradient_of_neighbours",
            gives: Gives::Numbers,
            call: "put3(surface_gradient_of_neighbours(f3(0u), mat4x3f(f3(3u), f3(6u), f3(9u), f3(12u)), f4(15u), f4(19u)));",
            arguments: neighbours,
            rust: |a, _, _| {
                let offsets = std::array::from_fn(|i| vector(&a[3 + 3 * i..]));
                let four = |at: usize| std::array::from_fn(|i| f64::from(a[at + i]));
                words(surface_gradient_of_neighbours(vector(a), offsets, four(15), four(19)))
            },
        },
    ]
}

fn normal_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "perturbed_normal",
            gives: Gives::Numbers,
            call: "put3(perturbed_normal(f3(0u), f3(3u)));",
            arguments: normal_and_bump,
            rust: |a, _, _| words(perturbed_normal(vector(a), vector(&a[3..]))),
        },
        Twin {
            name: "perlin_normal",
            gives: Gives::Numbers,
            call: "put3(perlin_normal(f3(0u), f3(3u)));",
            arguments: normal_and_bump,
            rust: |a, _, _| words(perlin_normal(vector(a), vector(&a[3..]))),
        },
        Twin {
            name: "displaced_normal",
            gives: Gives::Numbers,
            call: "put3(displaced_normal(f3(0u), f3(3u), f3(6u), f(9u), f(10u)));",
            arguments: surface_with_heights,
            rust: |a, _, _| {
                let (s, t, n) = (vector(a), vector(&a[3..]), vector(&a[6..]));
                words(displaced_normal(s, t, n, f64::from(a[9]), f64::from(a[10])))
            },
        },
        Twin {
            name: "position_derivative",
            gives: Gives::Numbers,
            call: "put3(position_derivative(f3(0u), f3(3u), f3(6u), f3(9u)));",
            arguments: plane_and_ray,
            rust: |a, _, _| {
                words(position_derivative(vector(a), vector(&a[3..]), vector(&a[6..]), vector(&a[9..])))
            },
        },
        Twin {
            name: "face_normal",
            gives: Gives::Numbers,
            call: "put3(face_normal(f3(0u), f3(3u), f3(6u)));",
            arguments: surface,
            rust: |a, _, _| words(face_normal(vector(a), vector(&a[3..]), vector(&a[6..]))),
        },
        Twin {
            name: "blinn_normal",
            gives: Gives::Numbers,
            call: "put3(blinn_normal(f3(0u), f3(3u), f(9u), f(10u)));",
            arguments: surface_with_heights,
            rust: |a, _, _| {
                words(blinn_normal(vector(a), vector(&a[3..]), f64::from(a[9]), f64::from(a[10])))
            },
        },
    ]
}

fn texture_twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "slope_of_gradient",
            gives: Gives::Numbers,
            call: "put2(slope_of_gradient(f3(0u), f3(3u), f3(6u)));",
            arguments: |inputs| [frame(inputs), any_vector(inputs).to_vec()].concat(),
            rust: |a, _, _| {
                let slope = slope_of_gradient(vector(a), vector(&a[3..]), vector(&a[6..]));
                slope.as_vec2().to_array().to_vec()
            },
        },
        Twin {
            name: "texture_gradients",
            gives: Gives::Numbers,
            call: "let of_uv = texture_gradients(mat2x3f(f3(0u), f3(3u)), f2(6u), f2(8u)); put3(of_uv[0]); put3(of_uv[1]);",
            arguments: |inputs| {
                let uv: Vec<f32> = (0..4).map(|_| inputs.between(-2.0, 2.0)).collect();
                [gradients(inputs), uv].concat()
            },
            rust: |a, _, _| {
                both(texture_gradients([vector(a), vector(&a[3..])], pair(&a[6..]), pair(&a[8..])))
            },
        },
        Twin {
            name: "scale_free_gradients",
            gives: Gives::Numbers,
            call: "let unit = scale_free_gradients(mat2x3f(f3(0u), f3(3u))); put3(unit[0]); put3(unit[1]);",
            arguments: gradients,
            rust: |a, _, _| both(scale_free_gradients([vector(a), vector(&a[3..])])),
        },
        Twin {
            name: "slope_matrix",
            gives: Gives::Numbers,
            call: "let matrix = slope_matrix(mat2x3f(f3(0u), f3(3u)), f2(6u), f3(8u), f3(11u)); put2(matrix[0]); put2(matrix[1]);",
            arguments: |inputs| {
                let heights: Vec<f32> = (0..2).map(|_| inputs.between(0.1, 4.0)).collect();
                [gradients(inputs), heights, frame(inputs)].concat()
            },
            rust: |a, _, _| {
                let gradients = [vector(a), vector(&a[3..])];
                let [[xx, xy], [yx, yy]] =
                    slope_matrix(gradients, pair(&a[6..]), vector(&a[8..]), vector(&a[11..]));
                // WGSL's matrices are columns.
                vec![xx, yx, xy, yy]
            },
        },
        Twin {
            name: "any_tangents",
            gives: Gives::Numbers,
            call: "let axes = any_tangents(f3(0u)); put3(axes[0]); put3(axes[1]);",
            arguments: |inputs| normal(inputs).to_vec(),
            rust: |a, _, _| both(any_tangents(vector(a))),
        },
        Twin {
            name: "geometric_covariance",
            gives: Gives::Numbers,
            call: "put3(geometric_covariance(f2(0u), f2(2u), GeometricFilter(f(4u), f(5u))));",
            arguments: |inputs| {
                let size = inputs.between(-10.0, 2.0).exp2();
                let mut all: Vec<f32> = (0..4).map(|_| size * inputs.between(-1.0, 1.0)).collect();
                all.extend([inputs.between(0.1, 0.5), inputs.between(0.05, 0.2)]);
                all
            },
            rust: |a, _, _| {
                let filter = GeometricFilter::default().with_pixel_variance(a[4]).with_largest_variance(a[5]);
                covariance_words(geometric_covariance([a[0], a[1]], [a[2], a[3]], &filter))
            },
        },
    ]
}
