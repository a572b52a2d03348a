//! Every comparator of these tests fails when it should, at the texel that is wrong, and passes just below its
//! tolerance.

mod common;

use common::compare::{
    EPS, Rounding, check_means, check_semidefinite, compare_levels, compare_planes, compare_rounded,
};
use common::level::{Level, NAMES, Plane, raw_moments};
use common::{baked, float_moments, maps, pyramid_oracle, slope_oracle};
use roughcast::{PyramidFilter, Wrap};

fn levels() -> Vec<Level> {
    let (image, source) = maps::slope_map(24, 20, &maps::slopes(24, 20, 71));
    let slopes = slope_oracle::slopes(&image, &source);
    pyramid_oracle::bump_moments(&slopes, PyramidFilter::Box, Wrap::Repeat)
}

/// The levels with one value of one texel changed by this amount.
fn perturbed(levels: &[Level], level: usize, plane: usize, texel: usize, by: f64) -> Vec<Level> {
    let mut levels = levels.to_vec();
    levels[level].planes[plane][texel] += by;
    levels
}

const TOLERANCE: f64 = 1e-3;

#[test]
fn levels_that_differ_in_one_number_are_detected() {
    let levels = levels();
    assert_eq!(compare_levels(&levels, &levels, |_| (TOLERANCE, TOLERANCE)), Ok(0.0));
    for (plane, name) in NAMES.iter().enumerate() {
        for (level, texel) in [(0, 0), (0, 24 * 20 - 1), (2, 7), (4, 0)] {
            let moved = |tolerances: f64| {
                let got = perturbed(&levels, level, plane, texel, tolerances * TOLERANCE);
                compare_levels(&got, &levels, |_| (TOLERANCE, TOLERANCE))
            };
            assert!(moved(0.9).is_ok() && moved(-0.9).is_ok());
            for fault in [moved(2.0), moved(-2.0), moved(f64::NAN), moved(f64::INFINITY)] {
                let fault = fault.expect_err("a moved texel is a fault");
                assert!(fault.contains(&format!("level {level},")) && fault.contains(name), "{fault}");
            }
        }
    }
}

#[test]
fn missing_and_resized_levels_are_detected() {
    let levels = levels();
    let any = |_| (f64::INFINITY, f64::INFINITY);
    assert!(compare_levels(&levels[1..], &levels, any).is_err());
    assert!(compare_levels(&levels, &levels[..levels.len() - 1], any).is_err());
    let mut turned = levels.clone();
    (turned[0].width, turned[0].height) = (turned[0].height, turned[0].width);
    assert!(compare_levels(&turned, &levels, any).is_err());
}

#[test]
fn the_tolerance_allows_only_rounding() {
    let levels = levels();
    let rounding = Rounding { count: 24.0, floor: 0.0 };
    let texel = levels[2].texel(5);
    for (plane, allowed) in [(0, rounding.slope(texel)), (3, rounding.second(texel))] {
        assert!(allowed < 1e-4, "an allowance of {allowed} is no rounding");
        let moved = |by: f64| compare_rounded(&perturbed(&levels, 2, plane, 5, by), &levels, rounding);
        assert!(moved(0.9 * allowed).is_ok());
        assert!(moved(2.0 * allowed).is_err());
    }
}

/// The library against the oracle: a real result in which one texel is off by two tolerances.
#[test]
fn a_wrong_baked_texel_is_detected() {
    let (image, source) = maps::slope_map(24, 20, &maps::slopes(24, 20, 71));
    let got = raw_moments(&baked(&image, &source, &float_moments(PyramidFilter::Box)));
    let wanted = levels();
    let rounding = Rounding { count: 24.0, floor: 0.0 };
    assert!(compare_rounded(&got, &wanted, rounding).is_ok());
    let by = 2.0 * rounding.second(wanted[1].texel(9));
    assert!(compare_rounded(&perturbed(&got, 1, 2, 9, by), &wanted, rounding).is_err());
    // A whole level computed with another filter, wrap mode or gradient is far off.
    let other = pyramid_oracle::bump_moments(
        &slope_oracle::slopes(&image, &source),
        PyramidFilter::Triangle,
        Wrap::Repeat,
    );
    assert!(compare_rounded(&got, &other, rounding).is_err());
    let turned = source.with_green(roughcast::Green::Down);
    let other = slope_oracle::slopes(&image, &turned);
    let other = pyramid_oracle::bump_moments(&other, PyramidFilter::Box, Wrap::Repeat);
    assert!(compare_rounded(&got, &other, rounding).is_err());
}

#[test]
fn differing_planes_are_detected() {
    let plane = Plane { width: 3, height: 2, values: vec![0.5; 6] };
    let wanted = vec![plane.clone(), Plane { width: 1, height: 1, values: vec![0.25] }];
    let compare = |got: &[Plane]| compare_planes(got, &wanted, |_| TOLERANCE);
    assert_eq!(compare(&wanted), Ok(0.0));
    let moved = |by: f64| {
        let mut got = wanted.clone();
        got[0].values[4] += by;
        compare(&got)
    };
    assert!(moved(0.9 * TOLERANCE).is_ok());
    assert!(moved(2.0 * TOLERANCE).expect_err("moved").contains("(1, 1)"));
    assert!(moved(f64::NAN).is_err());
    assert!(compare(&wanted[..1]).is_err());
    assert!(compare(&[plane.clone(), plane]).is_err());
}

#[test]
fn drifting_means_are_detected() {
    let levels = levels();
    let tolerance = (1e-9, 1e-9);
    assert!(check_means(&levels, tolerance).is_ok());
    for (level, texels) in [(1, 12.0 * 10.0), (4, 1.0)] {
        for plane in 0..5 {
            let drifted =
                |mean: f64| check_means(&perturbed(&levels, level, plane, 0, mean * texels), tolerance);
            assert!(drifted(0.5e-9).is_ok());
            assert!(drifted(2e-9).is_err());
            assert!(drifted(f64::NAN).is_err());
        }
    }
}

#[test]
fn invalid_covariances_are_detected() {
    let levels = levels();
    // The covariance of the oracle's own level 0 is only f64 rounding.
    assert!(check_semidefinite(&levels, 1.0).is_ok());
    let texel = levels[0].texel(3);
    let trace = texel.m[0] + texel.m[1];
    for plane in [2, 3, 4] {
        let moved = |by: f64| check_semidefinite(&perturbed(&levels, 0, plane, 3, by), 4.0);
        assert!(moved(-0.9 * 4.0 * EPS * trace).is_ok());
        assert!(moved(-10.0 * 4.0 * EPS * trace).is_err());
        assert!(moved(f64::NAN).is_err());
    }
}
