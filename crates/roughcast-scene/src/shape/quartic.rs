//! Real roots of a quartic within an interval, found from the roots of its derivatives.
//!
//! A polynomial is monotone between adjacent roots of its derivative, so each such subinterval holds one root if the
//! signs at its ends differ and none if they are the same. Unlike with the closed formulas, no root is lost to
//! cancellation.

/// Maximum number of steps of bisection and Newton's method. Bisection alone reduces an interval to adjacent floats in
/// about 60 steps, and far fewer are needed if Newton's steps converge.
const MAX_STEPS: usize = 128;

/// The real roots of `t^4 + c[2] t^2 + c[1] t + c[0]` in `from ..= to` (`from < to`), in ascending order, computed
/// lazily. Rounding decides whether a root of even order is missing or doubled.
pub(super) fn roots(c: [f64; 3], from: f64, to: f64) -> impl Iterator<Item = f64> {
    let quartic = [c[0], c[1], c[2], 0.0, 1.0];
    let derivative = [c[1], 2.0 * c[2], 0.0, 4.0];
    // The roots of the second derivative, 12 t^2 + 2 c[2]. If there are none, the interval is split in the middle
    // instead; an additional subinterval does no harm.
    let bend = (-c[2] / 6.0).max(0.0).sqrt();
    let bends = [(-bend).clamp(from, to), bend.clamp(from, to)];
    let turns = [(from, bends[0]), (bends[0], bends[1]), (bends[1], to)]
        .map(|(low, high)| root_of_monotone(&derivative, low, high).unwrap_or(high));
    [(from, turns[0]), (turns[0], turns[1]), (turns[1], turns[2]), (turns[2], to)]
        .into_iter()
        .filter_map(move |(low, high)| root_of_monotone(&quartic, low, high))
}

/// The root of a polynomial that is monotone on an interval: Newton's method, safeguarded by bisection.
fn root_of_monotone(c: &[f64], low: f64, high: f64) -> Option<f64> {
    let (at_low, at_high) = (value(c, low).0, value(c, high).0);
    if at_low == 0.0 {
        return Some(low);
    }
    // Also refuses NaN.
    if !(at_low * at_high <= 0.0 && low < high) {
        return None;
    }
    let (mut negative, mut positive) = if at_low < 0.0 { (low, high) } else { (high, low) };
    let mut t = 0.5 * (low + high);
    for _ in 0..MAX_STEPS {
        let (f, slope) = value(c, t);
        if f == 0.0 {
            return Some(t);
        }
        if f < 0.0 {
            negative = t
        } else {
            positive = t
        }
        let newton = t - f / slope;
        let inside = newton > negative.min(positive) && newton < negative.max(positive);
        let next = if inside { newton } else { 0.5 * (negative + positive) };
        let step = (next - t).abs();
        t = next;
        if step <= f64::EPSILON * (high - low) {
            break;
        }
    }
    Some(t)
}

/// The polynomial and its derivative, by Horner's scheme.
fn value(c: &[f64], t: f64) -> (f64, f64) {
    c.iter().rev().fold((0.0, 0.0), |(f, slope), &k| (f * t + k, slope * t + f))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Accuracy to which the roots of these polynomials with rounded coefficients are known, including the close pair.
    const TOLERANCE: f64 = 1e-12;

    /// The coefficients of a quartic whose roots sum to zero, so that it has no cubic term.
    fn expand([a, b, c, d]: [f64; 4]) -> [f64; 3] {
        assert!((a + b + c + d).abs() < TOLERANCE);
        [
            a * b * c * d,
            -(a * b * c + a * b * d + a * c * d + b * c * d),
            a * b + a * c + a * d + b * c + b * d + c * d,
        ]
    }

    #[test]
    fn known_roots_are_found_within_the_interval() {
        for r in
            [[-1.5, -0.2, 0.3, 1.4], [-1.9, 0.0, 0.001, 1.899], [-6.3, 0.1, 0.5, 5.7], [-1.0, -0.1, 0.1, 1.0]]
        {
            let found: Vec<f64> = roots(expand(r), -2.0, 2.0).collect();
            let wanted: Vec<f64> = r.into_iter().filter(|t| t.abs() <= 2.0).collect();
            assert_eq!(found.len(), wanted.len(), "{found:?} {wanted:?}");
            for (f, w) in found.iter().zip(&wanted) {
                assert!((f - w).abs() < TOLERANCE, "{found:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn no_spurious_roots() {
        assert_eq!(roots([1.0, 0.0, 0.0], -2.0, 2.0).count(), 0);
        assert_eq!(roots([1.0, 0.1, 1.0], -2.0, 2.0).count(), 0);
        assert_eq!(roots(expand([-9.0, -4.0, 3.0, 10.0]), -2.0, 2.0).count(), 0);
        assert_eq!(roots([f64::NAN, 0.0, 0.0], -2.0, 2.0).count(), 0);
    }
}
