//! LEAN Figure 4: Blinn-Phong and Beckmann highlights as functions of the angle between normal and half vector.

use serde_json::{Map, json};

use super::{Figure, Table};
use crate::html::{Chart, Curve};

/// The exponents of the curves.
const SHOWN: [f64; 3] = [8.0, 64.0, 512.0];
/// The exponents of the table: 8, 16 … 16384.
const DOUBLINGS: u32 = 12;
/// `cos(θ)^s` exceeds `exp(-s/2 tan²θ)` by `s/4 θ⁴ exp(-s/2 θ²)` to first order, which is largest at `θ² = 4/s`: `4/e²/s`, or
/// 0.54 / s. At small exponents the next term of the expansion shows.
const DIFFERENCE_TIMES_S: f64 = 0.56;

pub fn make() -> Figure {
    let rows: Vec<(f64, f64)> = (0..DOUBLINGS)
        .map(|doubling| 8.0 * f64::from(1 << doubling))
        .map(|s| (s, largest_difference(s)))
        .collect();
    let shrinks = rows.windows(2).all(|pair| pair[1].1 < pair[0].1);
    let worst = rows.iter().map(|(s, difference)| s * difference).fold(0.0, f64::max);
    let mut numbers = Map::new();
    for (s, difference) in &rows {
        numbers.insert(format!("largest difference, s = {s}"), json!(difference));
    }
    numbers.insert("largest difference times s".to_owned(), json!(worst));
    numbers.insert("limit".to_owned(), json!(DIFFERENCE_TIMES_S));
    Figure {
        title: "Blinn-Phong against Beckmann",
        claim: format!(
            "cos^s and exp(-s/2 tan^2) differ by at most {DIFFERENCE_TIMES_S} / s of their peak, so the fit gets better with every \
             doubling of s"
        ),
        numbers,
        holds: shrinks && worst <= DIFFERENCE_TIMES_S,
        making: "By formula, in double precision; no maps.".to_owned(),
        panels: Vec::new(),
        charts: SHOWN.iter().map(|s| chart(*s)).collect(),
        table: Some(Table {
            header: vec!["s", "largest difference", "times s"],
            rows: rows
                .iter()
                .map(|(s, d)| vec![format!("{s}"), format!("{d:.3e}"), format!("{:.4}", d * s)])
                .collect(),
        }),
    }
}

fn chart(s: f64) -> Chart {
    const POINTS: u32 = 160;
    // Four standard deviations of the lobe.
    let widest = (4.0 / s.sqrt()).min(std::f64::consts::FRAC_PI_2);
    let points = |lobe: &dyn Fn(f64) -> f64| {
        (0..=POINTS)
            .map(|i| widest * f64::from(i) / f64::from(POINTS))
            .map(|angle| (angle, lobe(angle)))
            .collect()
    };
    let blinn_phong = points(&|angle: f64| angle.cos().powf(s));
    let beckmann = points(&|angle: f64| (-0.5 * s * angle.tan().powi(2)).exp());
    Chart {
        title: format!("s = {s}"),
        x_axis: "radians",
        curves: vec![
            Curve { colour: "#1769aa", name: "Blinn-Phong".to_owned(), points: blinn_phong },
            Curve { colour: "#c2410c", name: "Beckmann".to_owned(), points: beckmann },
        ],
    }
}

/// The largest difference between `cos^s` and Beckmann's `exp(-s/2 tan²)` over all angles: LEAN mapping, Figure 4.
///
/// For large s it tends to `4 e⁻² / s`, about `0.54 / s`. `specular_power` is s, above zero.
fn largest_difference(specular_power: f64) -> f64 {
    /// The largest u = s/2 tan²: beyond it both lobes are below 1e-17 for s >= 1, except for Blinn-Phong's tail, which
    /// only falls.
    const FARTHEST: f64 = 40.0;
    /// Steps of u: near its maximum the difference is a parabola, so the relative error is below 1e-6.
    const STEPS: u32 = 40_000;
    let difference = |u: f64| {
        let tangent_squared = 2.0 * u / specular_power;
        (-0.5 * specular_power * tangent_squared.ln_1p()).exp() - (-u).exp()
    };
    (1..=STEPS).map(|i| difference(FARTHEST * f64::from(i) / f64::from(STEPS))).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figure 4's claim as a law: the difference is `4 e⁻² / s` up to terms in `1 / s²`.
    #[test]
    fn the_difference_from_beckmann_shrinks_as_one_over_s() {
        let limit = 4.0 * (-2.0_f64).exp();
        let mut last = f64::INFINITY;
        for exponent in 3..=14 {
            let s = f64::from(1 << exponent);
            let found = largest_difference(s);
            assert!(found < 0.53 * last, "s {s}: {found}");
            assert!((found * s / limit - 1.0).abs() < 1.0 / s, "s {s}: {}", found * s);
            last = found;
        }
    }
}
