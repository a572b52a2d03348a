//! Comparators. Each reports where it failed and by how much; `comparators.rs` shows that each can fail.

use super::level::{Level, NAMES, Plane, Texel, eigenvalues};

/// One rounding of a single float, relative.
pub const EPS: f64 = f32::EPSILON as f64;

/// What single floats may cost on the way down a pyramid.
///
/// A footprint's mean slope is off by some roundings of its rms slope (a weighted mean of numbers that are each off by
/// a rounding of themselves), and of `floor`, the size of the numbers of which slopes are differences; its second
/// moments by the square's share of that.
#[derive(Clone, Copy, Debug)]
pub struct Rounding {
    /// How many roundings.
    pub count: f64,
    /// Size of the numbers that level 0 was computed of: 1 for components of a normal, the largest height for heights,
    /// 0 where slopes were given as they are.
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

/// Compares levels plane by plane; `tolerance` is asked for B and for M. Gives the worst error in tolerances.
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

/// Levels that may differ by rounding.
pub fn compare_rounded(got: &[Level], wanted: &[Level], rounding: Rounding) -> Result<f64, String> {
    compare_levels(got, wanted, |texel| (rounding.slope(texel), rounding.second(texel)))
}

/// Compares one quantity on every level, with an absolute tolerance for each wanted value.
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

/// The mean of every plane is the same on every level, within `tolerance` of B and of M.
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

/// `M - B Bᵀ` is positive semidefinite at every texel, but for `roundings` of its second moments.
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

/// Unwraps a comparison, saying what was compared.
#[track_caller]
pub fn expect<T>(result: Result<T, String>, what: &dyn std::fmt::Debug) -> T {
    result.unwrap_or_else(|fault| panic!("{what:?}: {fault}"))
}
