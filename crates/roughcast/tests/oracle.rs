//! Level 0: slopes of every kind of map against the oracle, and the counts.

mod common;

use common::compare::{Rounding, compare_rounded, expect};
use common::maps::{self, Random};
use common::{baked, float_moments, level, pyramid_oracle, slope_oracle};
use roughcast::{
    BakeReport, Gradient, Green, HeightSense, Image, MaxSlope, NormalChannels, NormalRange, PyramidFilter,
    Red, SampleType, Samples, SourceCounts, SourceOptions, Wrap,
};

const TYPES: [SampleType; 4] = [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32];

/// Roundings from a pixel to a level of moments: decoding, z, the quotient, and two for each of up to eleven levels.
const ROUNDINGS: f64 = 40.0;

/// A normal's components are rounded at the magnitude of one.
const NORMALS: Rounding = Rounding { count: ROUNDINGS, floor: 1.0 };

/// Bakes a map's moments and compares all levels and the counts with the oracle.
fn check(image: &Image, source: &SourceOptions, rounding: Rounding) -> (f64, BakeReport) {
    let wanted = slope_oracle::slopes(image, source);
    let levels = pyramid_oracle::bump_moments(&wanted, PyramidFilter::Box, source.wrap);
    let got = baked(image, source, &float_moments(PyramidFilter::Box));
    let size = (image.width(), image.height());
    let what = (size, image.samples().sample_type(), source);
    assert_eq!(got.report.counts, wanted.counts, "{what:?}");
    assert_eq!(got.report.texels, wanted.texels.len() as u64, "{what:?}");
    let worst = expect(compare_rounded(&level::raw_moments(&got), &levels, rounding), &what);
    (worst, got.report)
}

/// All ways to store a normal in this type, each with its number of channels.
fn normal_options(sample_type: SampleType) -> Vec<(SourceOptions, usize)> {
    let ranges: &[NormalRange] = if sample_type.is_float() {
        NormalRange::ALL
    } else {
        // Unsigned samples are 0 ..= 1 with either option, and the oracle reads them that way.
        &[NormalRange::Unorm, NormalRange::Signed]
    };
    let channels = [
        (NormalChannels::Xyz, 3),
        (NormalChannels::Xyz, 4),
        (NormalChannels::Xyz, 5),
        (NormalChannels::Xy, 2),
        (NormalChannels::Xy, 3),
        (NormalChannels::Yx, 2),
        (NormalChannels::Ag, 4),
        (NormalChannels::Ra, 4),
    ];
    let mut all = Vec::new();
    for (normal_channels, count) in channels {
        for range in ranges {
            for green in Green::ALL {
                let options = SourceOptions::default()
                    .with_normal_channels(normal_channels)
                    .with_range(*range)
                    .with_green(*green);
                all.push((options, count));
                let turned = options.with_red(Red::Left).with_normal_scale(0.75);
                all.push((turned, count));
            }
        }
    }
    all
}

#[test]
fn normals_of_every_type_range_and_choice_of_channels() {
    let size = (53, 37);
    let slopes = maps::slopes(size.0, size.1, 1);
    for sample_type in TYPES {
        for (options, channels) in normal_options(sample_type) {
            let stored_as =
                if sample_type.is_float() { options } else { options.with_range(NormalRange::Unorm) };
            let image = maps::normal_map(size, &slopes, sample_type, &stored_as, channels);
            let (_, report) = check(&image, &options, NORMALS);
            assert_eq!(report.counts, SourceCounts::default());
        }
    }
}

#[test]
fn the_maximum_and_the_rms_slope_are_reported() {
    const ROUNDING: f64 = 1e-6; // a few f32 roundings, relative
    let (image, options) = maps::plain_normal_map(53, 37, 2);
    let wanted = slope_oracle::slopes(&image, &options);
    let squares: Vec<f64> = wanted.texels.iter().map(|b| b[0] * b[0] + b[1] * b[1]).collect();
    let report = baked(&image, &options, &float_moments(PyramidFilter::Box)).report;
    let steepest = squares.iter().copied().fold(0.0, f64::max).sqrt();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!((f64::from(report.maximum_slope) / steepest - 1.0).abs() < ROUNDING);
    assert!((report.rms_slope / rms - 1.0).abs() < ROUNDING);
}

/// Random bytes: every rule for invalid normals applies somewhere.
#[test]
fn random_pixels_are_repaired_and_counted_by_the_rules() {
    /// Random pixels of two channels lie as close to the rim of the unit disc as 16 bits can represent. There z is the
    /// root of a small difference, and one rounding becomes (1 + b²) roundings of the slope b <= 8.
    const NEAR_THE_RIM: Rounding = Rounding { count: ROUNDINGS, floor: 64.0 };
    let mut random = Random(3);
    let mut total = SourceCounts::default();
    for sample_type in TYPES {
        for (options, channels) in normal_options(sample_type) {
            let options = options.with_max_slope(MaxSlope::Limit(8.0));
            let values: Vec<f64> = (0..61 * 43 * channels).map(|_| random.unit()).collect();
            let image = maps::image(61, 43, channels, maps::samples(&values, sample_type));
            let (_, report) = check(&image, &options, NEAR_THE_RIM);
            total += report.counts;
            assert!(report.maximum_slope <= 8.0 * (1.0 + f32::EPSILON * 2.0), "{}", report.maximum_slope);
        }
    }
    assert!(total.clamped > 0 && total.behind > 0 && total.invalid > 0, "{total:?}");
}

#[test]
fn each_bad_texel_is_counted_once_in_its_category() {
    let good = [0.1, -0.2, 1.0];
    let cases: [([f64; 3], SourceCounts); 9] = [
        (good, SourceCounts::default()),
        ([f64::NAN, 0.0, 1.0], SourceCounts { non_finite: 1, ..Default::default() }),
        ([0.0, 0.0, f64::INFINITY], SourceCounts { non_finite: 1, ..Default::default() }),
        ([0.0, f64::NEG_INFINITY, f64::NAN], SourceCounts { non_finite: 1, ..Default::default() }),
        ([0.6, 0.8, 0.0], SourceCounts { behind: 1, ..Default::default() }),
        ([0.6, 0.0, -0.8], SourceCounts { behind: 1, ..Default::default() }),
        ([0.0, 0.0, 0.0], SourceCounts { invalid: 1, ..Default::default() }),
        ([0.0, 0.0, -1.0], SourceCounts { invalid: 1, ..Default::default() }),
        ([1.0, 1.0, 1e-6], SourceCounts { clamped: 1, ..Default::default() }),
    ];
    for (bad, counts) in cases {
        for at in [0, 7, 34] {
            let texels = (0..35).map(|i| if i == at { bad } else { good });
            let values: Vec<f64> = texels.flatten().collect();
            for sample_type in [SampleType::F16, SampleType::F32] {
                let image = maps::image(7, 5, 3, maps::samples(&values, sample_type));
                let options = SourceOptions::default().with_range(NormalRange::Signed);
                let (_, report) = check(&image, &options, NORMALS);
                assert_eq!(report.counts, counts, "{bad:?} in {sample_type:?}");
            }
        }
    }
}

#[test]
fn invalid_two_channel_normals_are_counted() {
    let cases: [([f32; 2], SourceCounts); 5] = [
        ([f32::NAN, 0.0], SourceCounts { non_finite: 1, ..Default::default() }),
        ([0.0, f32::INFINITY], SourceCounts { non_finite: 1, ..Default::default() }),
        // Just outside the disc: a rounded rim. Far outside: an empty background.
        ([0.8, 0.61], SourceCounts { behind: 1, ..Default::default() }),
        ([-1.0, -1.0], SourceCounts { invalid: 1, ..Default::default() }),
        ([0.0, 0.0], SourceCounts::default()),
    ];
    for (normal, counts) in cases {
        let mut values = vec![0.1_f32; 2 * 12];
        values[10..12].copy_from_slice(&normal);
        let image = maps::image(4, 3, 2, Samples::F32(values));
        let options =
            SourceOptions::default().with_range(NormalRange::Signed).with_normal_channels(NormalChannels::Xy);
        assert_eq!(check(&image, &options, NORMALS).1.counts, counts, "{normal:?}");
    }
}

#[test]
fn heights_by_every_gradient_wrap_sense_and_scale() {
    for size in [(53, 37), (1, 7), (7, 1), (1, 1), (2, 2), (1024, 8), (96, 40)] {
        for sample_type in TYPES {
            for gradient in Gradient::ALL {
                for wrap in Wrap::ALL {
                    for (height_sense, height_scale) in
                        [(HeightSense::WhiteHigh, 0.02), (HeightSense::WhiteDeep, 0.11)]
                    {
                        let (image, options) = maps::height_map(size.0, size.1, sample_type, 4);
                        let options = options
                            .with_gradient(*gradient)
                            .with_wrap(*wrap)
                            .with_height_sense(height_sense)
                            .with_height_scale(height_scale);
                        let floor = f64::from(height_scale) * size.0 as f64;
                        check(&image, &options, Rounding { count: ROUNDINGS, floor });
                    }
                }
            }
        }
    }
}

/// The same at the edges of the fused pass's tiles and bands, and with other channels besides the heights.
#[test]
fn heights_across_tiles_and_beside_other_channels() {
    let (width, height) = (1088, 192);
    let heights = maps::heights(width, height, 5);
    let values: Vec<f64> = heights.iter().flat_map(|h| [*h, 0.3, 0.9]).collect();
    let image = maps::image(width, height, 3, maps::samples(&values, SampleType::U16));
    for gradient in Gradient::ALL {
        let (_, options) = maps::height_map(1, 1, SampleType::U8, 0);
        let options = options.with_gradient(*gradient);
        let floor = f64::from(options.height_scale) * width as f64;
        check(&image, &options, Rounding { count: ROUNDINGS, floor });
    }
}

#[test]
fn holes_and_spikes_in_heights_are_repaired_and_counted() {
    let (width, height) = (16, 12);
    for (bad, gradient, touched) in [
        (f32::NAN, Gradient::Sobel, 9),
        (f32::INFINITY, Gradient::Sobel, 9),
        (f32::NAN, Gradient::Central, 5),
        (f32::NAN, Gradient::Forward, 3),
    ] {
        let mut values: Vec<f32> = maps::heights(width, height, 6).iter().map(|v| *v as f32).collect();
        values[5 * width + 7] = bad;
        let image = maps::image(width, height, 1, Samples::F32(values));
        let (_, options) = maps::height_map(1, 1, SampleType::U8, 0);
        let options = options.with_gradient(gradient);
        let floor = f64::from(options.height_scale) * width as f64;
        let (_, report) = check(&image, &options, Rounding { count: ROUNDINGS, floor });
        assert_eq!(report.counts, SourceCounts { non_finite: touched, ..Default::default() }, "{gradient}");
    }
    let (image, options) = maps::height_map(width, height, SampleType::F32, 6);
    let options = options.with_height_scale(2.0).with_max_slope(MaxSlope::Limit(3.0));
    let (_, report) = check(&image, &options, Rounding { count: ROUNDINGS, floor: 2.0 * width as f64 });
    assert!(
        report.counts.clamped > 0 && report.counts.clamped == report.counts.total(),
        "{:?}",
        report.counts
    );
}
