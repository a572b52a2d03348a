//! Every level of every size, by every filter, compared with explicit weights.

mod common;

use common::compare::{Rounding, compare_rounded, expect};
use common::maps::{self, SIZES};
use common::{baked, float_moments, level, pyramid_oracle, slope_oracle};
use roughcast::{PyramidFilter, SampleType, Wrap, level_sizes};

/// Slopes are given directly here, so only averaging rounds: about four times per level, eleven levels.
const AVERAGING: Rounding = Rounding { count: 24.0, floor: 0.0 };

#[test]
fn levels_halve_down_to_one_texel() {
    for (width, height) in SIZES {
        let sizes = level_sizes(width, height);
        assert_eq!(sizes[0], (width, height));
        assert_eq!(sizes[sizes.len() - 1], (1, 1));
        for pair in sizes.windows(2) {
            assert_eq!(pair[1], ((pair[0].0 / 2).max(1), (pair[0].1 / 2).max(1)));
        }
    }
}

/// The oracle's own weights: they must agree with the known closed forms.
#[test]
fn the_weights_of_the_oracle_match_the_textbooks() {
    const EXACT: f64 = 1e-12; // f64 rounding
    let close = |got: &[(usize, f64)], wanted: &[(usize, f64)]| {
        assert_eq!(got.len(), wanted.len(), "{got:?}");
        for (g, w) in got.iter().zip(wanted) {
            assert!(g.0 == w.0 && (g.1 - w.1).abs() < EXACT, "{got:?} {wanted:?}");
        }
    };
    let weights = |from, filter| pyramid_oracle::line_weights(from, filter, Wrap::Repeat);
    close(&weights(3, PyramidFilter::Box)[0], &[(0, 1.0 / 3.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0)]);
    close(&weights(5, PyramidFilter::Box)[1], &[(2, 0.2), (3, 0.4), (4, 0.4)]);
    // The tent over two coarser texels: 1 3 3 1.
    let eighth = 1.0 / 8.0;
    close(
        &weights(16, PyramidFilter::Triangle)[2],
        &[(3, eighth), (4, 3.0 * eighth), (5, 3.0 * eighth), (6, eighth)],
    );
    // The quadratic B-spline, subdivided by two: its integral over half units.
    let forty_eighth = 1.0 / 48.0;
    let row: Vec<(usize, f64)> =
        [1.0, 7.0, 16.0, 16.0, 7.0, 1.0].iter().enumerate().map(|(i, w)| (i + 2, w * forty_eighth)).collect();
    close(&weights(16, PyramidFilter::Gaussian)[2], &row);
}

#[test]
fn every_level_of_every_size_by_every_filter_and_wrap() {
    let mut worst = 0.0_f64;
    for (width, height) in SIZES {
        let slopes = maps::slopes(width, height, 11);
        let (image, options) = maps::slope_map(width, height, &slopes);
        for filter in PyramidFilter::ALL {
            for wrap in Wrap::ALL {
                let options = options.with_wrap(*wrap);
                let oracle = slope_oracle::slopes(&image, &options);
                let wanted = pyramid_oracle::bump_moments(&oracle, *filter, *wrap);
                let got = level::raw_moments(&baked(&image, &options, &float_moments(*filter)));
                let what = (width, height, filter, wrap);
                worst = worst.max(expect(compare_rounded(&got, &wanted, AVERAGING), &what));
            }
        }
    }
    // The tolerance is not too loose: the worst error is within a factor of twenty of it.
    assert!(worst > 0.05, "{worst}");
}

/// Heights with filters wider than the box: the wrap mode applies to both the gradient and the filter.
#[test]
fn heights_by_every_filter_and_wrap() {
    for (width, height) in [(53, 37), (96, 40)] {
        let (image, options) = maps::height_map(width, height, SampleType::U16, 12);
        for filter in PyramidFilter::ALL {
            for wrap in Wrap::ALL {
                let options = options.with_wrap(*wrap);
                let oracle = slope_oracle::slopes(&image, &options);
                let wanted = pyramid_oracle::bump_moments(&oracle, *filter, *wrap);
                let got = level::raw_moments(&baked(&image, &options, &float_moments(*filter)));
                let floor = f64::from(options.height_scale) * width as f64;
                let rounding = Rounding { floor, ..AVERAGING };
                expect(compare_rounded(&got, &wanted, rounding), &(width, height, filter, wrap));
            }
        }
    }
}

#[test]
fn the_levels_of_the_report_match_the_oracle() {
    const ROUNDING: f64 = 1e-5; // sums of squares of differences that f32 rounds, relative
    for (width, height) in [(53, 37), (128, 64), (1088, 192)] {
        let (image, options) = maps::slope_map(width, height, &maps::slopes(width, height, 13));
        let oracle = slope_oracle::slopes(&image, &options);
        let wanted = pyramid_oracle::bump_moments(&oracle, PyramidFilter::Box, options.wrap);
        let report = baked(&image, &options, &float_moments(PyramidFilter::Box)).report;
        assert_eq!(report.levels.len(), wanted.len());
        for ((size, stats), level) in report.levels.iter().zip(&wanted) {
            assert_eq!(*size, (level.width, level.height));
            let texels = (level.width * level.height) as f64;
            let mean = |axis: usize| level.texels().map(|t| t.covariance()[axis]).sum::<f64>() / texels;
            let largest =
                level.texels().flat_map(|t| [t.covariance()[0], t.covariance()[1]]).fold(0.0, f64::max);
            for (got, wanted) in [
                (stats.mean_variance_x, mean(0)),
                (stats.mean_variance_y, mean(1)),
                (f64::from(stats.max_variance), largest),
            ] {
                assert!(
                    (got - wanted).abs() <= ROUNDING * largest + f64::EPSILON,
                    "{size:?}: {got} {wanted}"
                );
            }
        }
    }
}
