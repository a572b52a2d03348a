//! The blends of normals in common use: the variance that they lose.

use roughcast::layers::{NormalBlend, added};
use roughcast::{Covariance, Distribution, Normal, Slope, normal_from_slope};

/// Slopes of a layer under a footprint, and their distribution.
fn footprint(mean: [f64; 2], steps: usize, spread: [f64; 2]) -> (Vec<Slope>, Distribution) {
    // An ellipse of slopes: the covariance is half of the squared half-axes.
    let angle = |k: usize| std::f64::consts::TAU * (k as f64 + 0.5) / steps as f64;
    let slopes: Vec<[f64; 2]> = (0..steps)
        .map(|k| [mean[0] + spread[0] * angle(k).cos(), mean[1] + spread[1] * angle(k).sin()])
        .collect();
    let covariance = covariance_of(&slopes);
    let single = |[x, y]: [f64; 2]| Slope { x: x as f32, y: y as f32 };
    (slopes.iter().copied().map(single).collect(), Distribution::gaussian(single(mean), covariance))
}

fn covariance_of(slopes: &[[f64; 2]]) -> Covariance {
    let count = slopes.len() as f64;
    let mean = [0, 1].map(|k| slopes.iter().map(|b| b[k]).sum::<f64>() / count);
    let central = |i: usize, j: usize| {
        (slopes.iter().map(|b| (b[i] - mean[i]) * (b[j] - mean[j])).sum::<f64>() / count) as f32
    };
    Covariance { xx: central(0, 0), yy: central(1, 1), xy: central(0, 1) }
}

/// The covariance of the slopes of the blends of every slope of one layer with every slope of the other.
fn blended_covariance(blend: NormalBlend, base: &[Slope], detail: &[Slope]) -> Covariance {
    let slope = |a: &Slope, b: &Slope| {
        let Normal { x, y, z } = blend.blend(normal_from_slope(*a), normal_from_slope(*b));
        [f64::from(x) / f64::from(z), f64::from(y) / f64::from(z)]
    };
    let all: Vec<_> = base.iter().flat_map(|a| detail.iter().map(move |b| slope(a, b))).collect();
    covariance_of(&all)
}

#[test]
fn a_blend_of_filtered_normals_loses_the_variance_of_the_blended_slopes() {
    /// Second-order terms: relative to the covariance, a few times the variance of the slopes.
    const SECOND_ORDER: f32 = 0.03;
    let (base, of_base) = footprint([0.5, -0.2], 16, [0.1, 0.05]);
    let (detail, of_detail) = footprint([-0.1, 0.3], 16, [0.04, 0.12]);
    let mut lost = Vec::new();
    for blend in NormalBlend::ALL {
        let (wanted, got) =
            (blended_covariance(*blend, &base, &detail), blend.lost_covariance(&of_base, &of_detail));
        let off = got - wanted;
        let largest = off.xx.abs().max(off.yy.abs()).max(off.xy.abs());
        println!("{blend}: loses {wanted:?}, to first order {got:?}");
        assert!(largest < SECOND_ORDER * wanted.trace(), "{blend}: {got:?} {wanted:?}");
        lost.push(wanted.trace());
    }
    // Adding slopes neither damps nor amplifies them; layers that are added keep exactly this.
    let sum = added(&[(1.0, of_base), (1.0, of_detail)]).expect("valid").whole().covariance;
    let parts: Vec<_> = lost.iter().map(|trace| trace / sum.trace()).collect();
    let wanted = [0.971, 1.119, 0.925, 1.0];
    assert!(parts.iter().zip(wanted).all(|(part, wanted)| (part - wanted).abs() < 1e-3), "{parts:?}");
}

/// On a flat base, UDN turns slopes into sines: at a slope of 1 the variance of the detail is an eighth.
#[test]
fn udn_damps_steep_detail() {
    let flat = Distribution::of_slope(Slope::default());
    let steep = Distribution::gaussian(Slope { x: 1.0, y: 0.0 }, Covariance { xx: 0.01, yy: 0.0, xy: 0.0 });
    let lost = NormalBlend::Udn.lost_covariance(&flat, &steep);
    // The derivative of s / √(1 + s²) is (1 + s²)^(-3/2).
    assert!((lost.xx / 0.01 - 0.125).abs() < 1e-3, "{lost:?}");
    let lost = NormalBlend::PartialDerivatives.lost_covariance(&flat, &steep);
    assert!((lost.xx / 0.01 - 1.0).abs() < 1e-3, "{lost:?}");
}
