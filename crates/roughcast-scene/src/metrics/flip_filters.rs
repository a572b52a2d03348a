//! The filters of FLIP: contrast sensitivity of the eye, and detectors of edges and points.
//!
//! Source: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. Fairchild, "FLIP: A Difference
//! Evaluator for Alternating Images", 2020, sections 4.1.1 and 4.2.1.

use std::f32::consts::PI;

use rayon::prelude::*;

/// A plane of numbers, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub width: usize,
    pub values: Vec<f32>,
}

/// A Gaussian term (a, b) of the contrast sensitivity function, `a sqrt(pi / b) exp(-pi^2 x^2 / b)` with x in degrees.
type Term = (f32, f32);

/// Sensitivity to changes of luminance.
pub(super) const ACHROMATIC: &[Term] = &[(1.0, 0.0047)];
/// Sensitivity to changes between red and green.
pub(super) const RED_GREEN: &[Term] = &[(1.0, 0.0053)];
/// Sensitivity to changes between blue and yellow.
pub(super) const BLUE_YELLOW: &[Term] = &[(34.1, 0.04), (13.5, 0.025)];
/// The largest b of all terms; it determines the radius of all kernels.
const WIDEST: f32 = 0.04;
/// Distance from peak to trough of the eye's edge detector, in degrees: twice the Gaussian's standard deviation.
const FEATURE_WIDTH: f32 = 0.082;
/// Number of standard deviations at which kernels are truncated.
const STANDARD_DEVIATIONS: f32 = 3.0;

/// A centred kernel of odd length.
fn kernel(radius: i32, weight: impl Fn(f32) -> f32) -> Vec<f32> {
    (-radius..=radius).map(|i| weight(i as f32)).collect()
}

/// A plane as perceived by the eye: filtered by a contrast sensitivity function that is normalised to a sum of one.
pub(super) fn seen(plane: &Plane, terms: &[Term], pixels_per_degree: f32) -> Plane {
    let radius = (STANDARD_DEVIATIONS * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    // A two-dimensional Gaussian is the product of two along the axes; a sum of two Gaussians is filtered in two parts.
    let parts: Vec<(f32, Vec<f32>)> = terms
        .iter()
        .map(|(a, b)| {
            let weights = kernel(radius, |x| (-(PI * x / pixels_per_degree).powi(2) / b).exp());
            (a * (PI / b).sqrt(), weights)
        })
        .collect();
    let sum_of = |weights: &[f32]| weights.iter().sum::<f32>();
    let total: f32 = parts.iter().map(|(a, weights)| a * sum_of(weights).powi(2)).sum();
    let mut result = Plane { width: plane.width, values: vec![0.0; plane.values.len()] };
    for (a, weights) in &parts {
        let part = separable(plane, weights, weights);
        result.values.par_iter_mut().zip(&part.values).for_each(|(sum, value)| *sum += a / total * value);
    }
    result
}

/// The strength of edges and of points at each pixel of a luminance plane (0 ..= 1).
pub(super) fn features(plane: &Plane, pixels_per_degree: f32) -> [Plane; 2] {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (STANDARD_DEVIATIONS * deviation).ceil() as i32;
    let gauss = |x: f32| (-x * x / (2.0 * deviation * deviation)).exp();
    let smooth = kernel(radius, gauss);
    let total: f32 = smooth.iter().sum();
    let smooth: Vec<f32> = smooth.iter().map(|w| w / total).collect();
    let edge = balanced(kernel(radius, |x| -x * gauss(x)));
    let point = balanced(kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gauss(x)));
    [edge, point].map(|detector| {
        let (along, down) = (separable(plane, &detector, &smooth), separable(plane, &smooth, &detector));
        let length = |(x, y): (&f32, &f32)| x.hypot(*y);
        let values = along.values.par_iter().zip(&down.values).map(length).collect();
        Plane { width: plane.width, values }
    })
}

/// Scales the weights so that the positive ones sum to one and the negative ones to minus one.
fn balanced(mut weights: Vec<f32>) -> Vec<f32> {
    let positive: f32 = weights.iter().filter(|w| **w > 0.0).sum();
    let negative: f32 = -weights.iter().filter(|w| **w < 0.0).sum::<f32>();
    for weight in &mut weights {
        *weight /= if *weight > 0.0 { positive } else { negative };
    }
    weights
}

/// Correlates a plane with a separable kernel, given as one kernel along the rows and one down the columns. Edge pixels
/// are repeated beyond the edges.
fn separable(plane: &Plane, along: &[f32], down: &[f32]) -> Plane {
    let (width, height) = (plane.width, plane.values.len() / plane.width);
    let at =
        |i: usize, tap: usize, taps: usize, length: usize| (i + tap).saturating_sub(taps / 2).min(length - 1);
    let mut rows = vec![0.0; plane.values.len()];
    rows.par_chunks_mut(width).zip(plane.values.par_chunks(width)).for_each(|(out, row)| {
        for (x, out) in out.iter_mut().enumerate() {
            let taps = along.iter().enumerate();
            *out = taps.map(|(tap, weight)| weight * row[at(x, tap, along.len(), width)]).sum();
        }
    });
    let mut values = vec![0.0; plane.values.len()];
    values.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (tap, weight) in down.iter().enumerate() {
            let row = &rows[at(y, tap, down.len(), height) * width..][..width];
            out.iter_mut().zip(row).for_each(|(out, value)| *out += weight * value);
        }
    });
    Plane { width, values }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS_PER_DEGREE: f32 = 67.0;
    const ROUNDING: f32 = 1e-5; // f32 sums over a few hundred products

    #[test]
    fn a_constant_plane_is_unchanged_and_has_no_features() {
        let plane = Plane { width: 9, values: vec![0.7; 45] };
        for terms in [ACHROMATIC, RED_GREEN, BLUE_YELLOW] {
            assert!(seen(&plane, terms, PIXELS_PER_DEGREE).values.iter().all(|v| (v - 0.7).abs() < ROUNDING));
        }
        for feature in features(&plane, PIXELS_PER_DEGREE) {
            assert!(feature.values.iter().all(|v| v.abs() < ROUNDING));
        }
    }

    #[test]
    fn a_step_is_an_edge_and_a_line_is_a_point_in_one_direction() {
        let plane =
            |at: fn(usize) -> f32| Plane { width: 64, values: (0..64 * 64).map(|i| at(i % 64)).collect() };
        let [edges, points] = features(&plane(|x| if x < 32 { 0.0 } else { 1.0 }), PIXELS_PER_DEGREE);
        let middle = 32 * 64 + 32;
        // At a full step, half of the kernel lies on the bright side with nearly all positive weights, so the response
        // is nearly one.
        assert!(edges.values[middle] > 0.9 && edges.values[middle - 20] < ROUNDING);
        let [line_edges, line_points] = features(&plane(|x| f32::from(u8::from(x == 32))), PIXELS_PER_DEGREE);
        assert!(line_points.values[middle] > line_edges.values[middle]);
        assert!(points.values[middle] < edges.values[middle]);
    }

    #[test]
    fn blue_and_yellow_are_seen_less_sharply_than_luminance() {
        let spot =
            Plane { width: 64, values: (0..64 * 64).map(|i| f32::from(u8::from(i == 32 * 65))).collect() };
        let peak = |terms| seen(&spot, terms, PIXELS_PER_DEGREE).values[32 * 65];
        assert!(peak(ACHROMATIC) > peak(RED_GREEN) && peak(RED_GREEN) > 3.0 * peak(BLUE_YELLOW));
    }
}
