//! LEAN Figure 4: Blinn-Phong and Beckmann highlights over the angle between normal and half vector.

use roughcast::shading::blinn_phong_against_beckmann;
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
        .map(|s| (s, blinn_phong_against_beckmann(s)))
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
    // Four deviations of the lobe.
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
