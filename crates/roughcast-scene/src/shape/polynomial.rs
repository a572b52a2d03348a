//! Real roots of a quartic within an interval, by the roots of its derivatives.
//!
//! Between two neighbouring roots of its derivative a polynomial is monotone, so each such stretch holds one root if the
//! signs at its ends differ, and none if they are the same. No root is lost to cancellation, as with the closed formulas.

/// Steps of bisection and Newton's method: bisection alone halves an interval to neighbouring numbers in about 60, and
/// far fewer are taken where Newton's steps hold.
const MAX_STEPS: usize = 128;

/// The real roots of `c[0] + c[1] t + ... + c[4] t^4` in `from ..= to`, in growing order; a root of even order may be
/// missing or there twice, as rounding has it.
pub(super) fn roots(c: [f64; 5], from: f64, to: f64) -> Vec<f64> {
    // The derivatives, from the linear one to the quartic itself; each one's roots part the next into monotone stretches.
    let second = [2.0 * c[2], 6.0 * c[3], 12.0 * c[4]];
    let first = [c[1], second[0], 0.5 * second[1], second[2] / 3.0];
    let third = [second[1], 2.0 * second[2]];
    let mut stops = Vec::with_capacity(4);
    for polynomial in [&third[..], &second, &first, &c] {
        stops = roots_between(polynomial, from, to, &stops);
    }
    stops
}

/// The roots of a polynomial that is monotone between neighbouring `stops`.
fn roots_between(c: &[f64], from: f64, to: f64, stops: &[f64]) -> Vec<f64> {
    let mut found = Vec::with_capacity(4);
    let mut low = from;
    for high in stops.iter().copied().chain([to]) {
        if let Some(root) = root_of_monotone(c, low, high) {
            found.push(root);
        }
        low = high;
    }
    found
}

/// The root of a polynomial that is monotone on an interval: Newton's method, held in a bracket by bisection.
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

    /// Roots of these polynomials, whose coefficients are rounded, are known to about this.
    const TOLERANCE: f64 = 1e-12;

    fn expand(r: [f64; 4]) -> [f64; 5] {
        let mut c = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (k, root) in r.into_iter().enumerate() {
            for i in (0..=k + 1).rev() {
                c[i] = if i > 0 { c[i - 1] } else { 0.0 } - root * c[i];
            }
        }
        c
    }

    #[test]
    fn known_roots_are_found_within_the_interval() {
        for r in [[-1.5, -0.2, 0.3, 1.9], [-0.001, 0.0, 0.001, 1.0], [0.1, 0.5, 0.7, 5.0]] {
            let found = roots(expand(r), -2.0, 2.0);
            let wanted: Vec<f64> = r.into_iter().filter(|t| t.abs() <= 2.0).collect();
            assert_eq!(found.len(), wanted.len(), "{found:?} {wanted:?}");
            for (f, w) in found.iter().zip(&wanted) {
                assert!((f - w).abs() < TOLERANCE, "{found:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn no_root_is_invented() {
        assert!(roots([1.0, 0.0, 0.0, 0.0, 1.0], -2.0, 2.0).is_empty());
        assert!(roots(expand([3.0, 4.0, 5.0, 6.0]), -2.0, 2.0).is_empty());
        assert!(roots([f64::NAN, 0.0, 0.0, 0.0, 1.0], -2.0, 2.0).is_empty());
    }
}
