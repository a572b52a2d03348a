//! The quantile function of the normal distribution.
//!
//! Source: P. J. Acklam, "An algorithm for computing the inverse normal cumulative distribution function", 2003:
//! rational approximations with a relative error below 1.15e-9.

const CENTRE_NUMERATOR: [f64; 6] = [
    -3.969_683_028_665_376e1,
    2.209_460_984_245_205e2,
    -2.759_285_104_469_687e2,
    1.383_577_518_672_69e2,
    -3.066_479_806_614_716e1,
    2.506_628_277_459_239,
];
const CENTRE_DENOMINATOR: [f64; 6] = [
    -5.447_609_879_822_406e1,
    1.615_858_368_580_409e2,
    -1.556_989_798_598_866e2,
    6.680_131_188_771_972e1,
    -1.328_068_155_288_572e1,
    1.0,
];
const TAIL_NUMERATOR: [f64; 6] = [
    -7.784_894_002_430_293e-3,
    -3.223_964_580_411_365e-1,
    -2.400_758_277_161_838,
    -2.549_732_539_343_734,
    4.374_664_141_464_968,
    2.938_163_982_698_783,
];
const TAIL_DENOMINATOR: [f64; 5] =
    [7.784_695_709_041_462e-3, 3.224_671_290_700_398e-1, 2.445_134_137_142_996, 3.754_408_661_907_416, 1.0];
/// Probability where the tails begin.
const TAIL: f64 = 0.024_25;

/// The value that a standard normal variable stays below with this probability (between 0 and 1).
pub(super) fn normal_quantile(probability: f64) -> f64 {
    let tail = |p: f64| {
        let q = (-2.0 * p.ln()).sqrt();
        polynomial(&TAIL_NUMERATOR, q) / polynomial(&TAIL_DENOMINATOR, q)
    };
    if probability < TAIL {
        tail(probability)
    } else if probability > 1.0 - TAIL {
        -tail(1.0 - probability)
    } else {
        let q = probability - 0.5;
        q * polynomial(&CENTRE_NUMERATOR, q * q) / polynomial(&CENTRE_DENOMINATOR, q * q)
    }
}

#[inline]
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantile_inverts_the_integral_of_the_density() {
        /// Tolerance for the approximation error at four standard deviations, and for the error of the sum.
        const TOLERANCE: f64 = 1e-7;
        let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        // Midpoint rule, starting far out in the tail.
        let (steps, start) = (200_000, -9.0);
        let step = -start / f64::from(steps);
        let mut probability = 0.0;
        for i in 0..steps {
            let x = start + (f64::from(i) + 0.5) * step;
            probability += density(x) * step;
            if i % 1000 == 999 && x > -4.5 {
                let edge = x + 0.5 * step;
                assert!((normal_quantile(probability) - edge).abs() < TOLERANCE, "{edge}");
                assert!((normal_quantile(1.0 - probability) + edge).abs() < TOLERANCE);
            }
        }
    }
}
