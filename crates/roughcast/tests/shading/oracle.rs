//! The lobes' densities over slopes in f64, from the papers' formulas, without regard for rounding.

use std::f64::consts::{PI, TAU};

use super::support::{Frame, Vector, cross, dot, normalize, scaled, sum};
use roughcast::shading::Form;

/// `h` in a frame, as a slope, and the cosine of its angle to the frame's normal.
fn slope_in(frame: &Frame, h: Vector) -> ([f64; 2], f64) {
    let [x, y, z] = frame.0.map(|axis| dot(axis, h));
    ([x / z, y / z], z)
}

/// Without the masking of the physical form, which the caller applies.
fn in_form(density: f64, cosine: f64, form: Form) -> f64 {
    match form {
        Form::Paper => TAU * density,
        Form::Normalised | Form::Physical => density / cosine.powi(4),
        other => panic!("say what the form {other} is"),
    }
}

/// A Gaussian with covariance (xx, yy, xy) about a mean slope, in the surface frame.
pub fn gaussian(mean: [f64; 2], [xx, yy, xy]: [f64; 3], h: Vector, form: Form) -> f64 {
    let ([x, y], cosine) = slope_in(&Frame::SURFACE, h);
    let (x, y) = (x - mean[0], y - mean[1]);
    let determinant = xx * yy - xy * xy;
    let distance = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
    in_form((-0.5 * distance).exp() / (TAU * determinant.sqrt()), cosine, form)
}

/// A Gaussian of variance 1 / s about the normal, in its own frame.
pub fn beckmann(normal: Vector, s: f64, h: Vector, form: Form) -> f64 {
    let ([x, y], cosine) = slope_in(&Frame::about(normal), h);
    in_form(s / TAU * (-0.5 * s * (x * x + y * y)).exp(), cosine, form)
}

/// `cos^s` about an axis.
pub fn cosine_lobe(axis: Vector, direction: Vector, s: f64, form: Form) -> f64 {
    let axis = normalize(axis);
    if dot(axis, direction) <= 0.0 {
        return 0.0;
    }
    // Computed from the sine: near one, rounding a cosine in f64 costs s = 16384 four digits of sixteen, which is
    // acceptable.
    let sine = cross(axis, direction);
    let power = (0.5 * s * (-dot(sine, sine)).ln_1p()).exp();
    match form {
        Form::Paper => s * power,
        Form::Normalised | Form::Physical => (s + 2.0) / TAU * power,
        other => panic!("say what the form {other} is"),
    }
}

/// The view reflected about a normal.
pub fn reflected(normal: Vector, view: Vector) -> Vector {
    let normal = normalize(normal);
    sum(scaled(normal, 2.0 * dot(normal, view)), scaled(view, -1.0))
}

/// GGX with one width along a direction of the surface's plane and one across it.
pub fn ggx(normal: Vector, direction: [f64; 2], [ax, ay]: [f64; 2], h: Vector, form: Form) -> f64 {
    let normal = normalize(normal);
    let in_plane = [direction[0], direction[1], 0.0];
    let tangent = normalize(sum(in_plane, scaled(normal, -dot(normal, in_plane))));
    let ([x, y], cosine) = slope_in(&Frame([tangent, cross(normal, tangent), normal]), h);
    let bracket = 1.0 + (x / ax).powi(2) + (y / ay).powi(2);
    in_form(1.0 / (PI * ax * ay * bracket * bracket), cosine, form)
}
