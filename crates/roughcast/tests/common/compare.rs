//! Comparators. Each reports where it failed and by how much; `comparators.rs` shows that each can fail.

use super::level::{Level, NAMES, Plane, Texel, eigenvalues};

/// Relative error of one single-float rounding.
pub const EPS: f64 = f32::EPSILON as f64;

/// Tolerance for single-float arithmetic in a pyramid.
///
/// A footprint's mean slope is off by some roundings of its rms slope (it is a weighted mean of rounded values) and of
/// `floor`, the size of the values whose differences are slopes. Its second moments are off by the corresponding amount
/// for a square.
#[derive(Clone, Copy, Debug)]
pub struct Rounding {
    /// The number of roundings.
    pub count: f64,
    /// Size of the values that level 0 was computed from: 1 for components of a normal, the largest height for heights,
    /// 0 if slopes were given directly.
    pub floor: f64,
}

impl Rounding {
    pub fn slope(self, wanted: Texel) -> f64 {
        self.count * EPS * (self.floor + wanted.rms()) + f64::from(f32::MIN_POSITIVE)
    }

    pub fn second(self, wanted: Texel) -> f64 {
        let slope = self.slope(wanted);
        2.0 * wanted.rms() * slope + slope * slope
    }
}

/// Compares levels plane by plane; `tolerance` returns the tolerances of B and M. Returns the worst error in
/// tolerances.
pub fn compare_levels(
    got: &[Level],
    wanted: &[Level],
    tolerance: impl Fn(Texel) -> (f64, f64),
) -> Result<f64, String> {
    if got.len() != wanted.len() {
        return Err(format!("{} levels, not {}", got.len(), wanted.len()));
    }
    let mut worst = 0.0_f64;
    for (number, (got, wanted)) in got.iter().zip(wanted).enumerate() {
        if (got.width, got.height) != (wanted.width, wanted.height) {
            let (w, h) = (wanted.width, wanted.height);
            return Err(format!("level {number} is {}x{}, not {w}x{h}", got.width, got.height));
        }
        for index in 0..wanted.width * wanted.height {
            let (slope, second) = tolerance(wanted.texel(index));
            for (plane, name) in NAMES.iter().enumerate() {
                let allowed = if plane < 2 { slope } else { second };
                let (g, w) = (got.planes[plane][index], wanted.planes[plane][index]);
                let error = (g - w).abs();
                // Not `>`: that would let NaN pass.
                let is_within = error <= allowed;
                if !is_within {
                    let (x, y) = (index % wanted.width, index / wanted.width);
                    return Err(format!(
                        "level {number}, texel ({x}, {y}), {name}: {g} instead of {w}, off by {error:e} > {allowed:e}"
                    ));
                }
                worst = worst.max(error / allowed);
            }
        }
    }
    Ok(worst)
}

/// Compares levels that may differ by rounding.
pub fn compare_rounded(got: &[Level], wanted: &[Level], rounding: Rounding) -> Result<f64, String> {
    compare_levels(got, wanted, |texel| (rounding.slope(texel), rounding.second(texel)))
}

/// Compares one quantity on every level, with an absolute tolerance for each expected value.
pub fn compare_planes(
    got: &[Plane],
    wanted: &[Plane],
    tolerance: impl Fn(f64) -> f64,
) -> Result<f64, String> {
    if got.len() != wanted.len() {
        return Err(format!("{} levels, not {}", got.len(), wanted.len()));
    }
    let mut worst = 0.0_f64;
    for (number, (got, wanted)) in got.iter().zip(wanted).enumerate() {
        if (got.width, got.height) != (wanted.width, wanted.height) {
            return Err(format!("level {number} is {}x{}", got.width, got.height));
        }
        for (index, (g, w)) in got.values.iter().zip(&wanted.values).enumerate() {
            let (error, allowed) = ((g - w).abs(), tolerance(*w));
            let is_within = error <= allowed;
            if !is_within {
                let (x, y) = (index % wanted.width, index / wanted.width);
                return Err(format!(
                    "level {number}, texel ({x}, {y}): {g} instead of {w}, off by {error:e} > {allowed:e}"
                ));
            }
            worst = worst.max(error / allowed);
        }
    }
    Ok(worst)
}

/// Checks that the mean of every plane is the same on every level, within `tolerance` of B and of M.
pub fn check_means(levels: &[Level], tolerance: (f64, f64)) -> Result<(), String> {
    for (plane, name) in NAMES.iter().enumerate() {
        let allowed = if plane < 2 { tolerance.0 } else { tolerance.1 };
        let top = levels[0].mean(plane);
        for (number, level) in levels.iter().enumerate() {
            let mean = level.mean(plane);
            let is_within = (mean - top).abs() <= allowed;
            if !is_within {
                return Err(format!(
                    "the mean of {name} is {mean} on level {number} and {top} on level 0: off by {:e} > {allowed:e}",
                    (mean - top).abs()
                ));
            }
        }
    }
    Ok(())
}

/// Checks that `M - B Bᵀ` is positive semidefinite at every texel, within `roundings` of its second moments.
pub fn check_semidefinite(levels: &[Level], roundings: f64) -> Result<(), String> {
    for (number, level) in levels.iter().enumerate() {
        for (index, texel) in level.texels().enumerate() {
            let smaller = eigenvalues(texel.covariance()).1;
            let allowed = roundings * EPS * (texel.m[0] + texel.m[1]);
            let is_within = smaller >= -allowed;
            if !is_within {
                return Err(format!(
                    "level {number}, texel {index}: eigenvalue {smaller:e} < -{allowed:e}, {texel:?}"
                ));
            }
        }
    }
    Ok(())
}

/// Unwraps a comparison; a failure names what was compared.
#[track_caller]
pub fn expect<T>(result: Result<T, String>, what: &dyn std::fmt::Debug) -> T {
    result.unwrap_or_else(|fault| panic!("{what:?}: {fault}"))
}
