//! The contents of each layout's files, checked sample by sample: the formulas, channel by channel, in floats.

mod common;

use common::compare::{EPS, Rounding, compare_planes, compare_rounded, expect};
use common::level::{Level, Plane, Texel, channel_of, combined, decoded, layer, planes, raw_moments, stored};
use common::maps::{self, gentle_map, material_map, variances};
use common::{baked, baked_with, float_moments, options, oracle_of, pyramid_oracle, slope_oracle};
use roughcast::texture::{Base, Layout, RoughnessStored};
use roughcast::{BaseRoughness, Image, PyramidFilter, RoughnessMap, SampleType, Samples, SourceOptions};

/// Averaging alone: about four roundings per level.
const AVERAGING: Rounding = Rounding { count: 24.0, floor: 0.0 };

/// Sizes that use the fused pass, and sizes that do not.
const SIZES: [(usize, usize); 3] = [(64, 64), (53, 37), (96, 40)];

#[test]
fn a_uniform_base_adds_its_variance_to_every_second_moment() {
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        for power in [13_777.0, 64.0, 3.0_f32] {
            let base = Some(BaseRoughness::Variance(1.0 / power));
            let folded = float_moments(PyramidFilter::Box).with_base(Base::Baked);
            let with = baked_with(&image, &source, base, &folded);
            let without = baked(&image, &source, &float_moments(PyramidFilter::Box));
            let added = |t: Texel| Texel {
                m: [t.m[0] + f64::from(1.0 / power), t.m[1] + f64::from(1.0 / power), t.m[2]],
                ..t
            };
            let wanted: Vec<Level> = raw_moments(&without)
                .iter()
                .map(|l| Level::from_texels(l.width, l.height, l.texels().map(added)))
                .collect();
            expect(compare_rounded(&raw_moments(&with), &wanted, AVERAGING), &(width, height, power));
            let info = with.arrays[0].info;
            assert_eq!((info.base, info.base_variance), (Base::Baked, 1.0 / power));
            // The base is not included in the moments, only recorded in the metadata.
            let kept_apart = baked_with(&image, &source, base, &float_moments(PyramidFilter::Box));
            assert!(raw_moments(&kept_apart) == raw_moments(&without));
            let info = kept_apart.arrays[0].info;
            assert_eq!((info.base, info.base_variance), (Base::None, 1.0 / power));
        }
    }
}

#[test]
fn a_mapped_base_adds_the_mean_of_its_variance() {
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        let material = material_map(width, height);
        let powers: Vec<f32> =
            maps::heights(width, height, 33).iter().map(|h| 2.0 + 500.0 * *h as f32).collect();
        let powers = maps::image(width, height, 1, Samples::F32(powers));
        for (map, channel, stored) in [
            (&material, 1, RoughnessStored::Perceptual),
            (&material, 0, RoughnessStored::Gloss),
            (&material, 2, RoughnessStored::Alpha),
            (&material, 1, RoughnessStored::AlphaSquared),
            (&powers, 0, RoughnessStored::SpecularPower),
        ] {
            let wanted = oracle_of(&image, &source, &variances(map, channel, stored));
            let base = Some(BaseRoughness::Map(RoughnessMap { image: map.view(), channel, stored }));
            let folded = float_moments(PyramidFilter::Box).with_base(Base::Baked);
            let got = baked_with(&image, &source, base, &folded);
            // Gloss is one minus a roughness; that difference's rounding is multiplied by four.
            let rounding = Rounding { floor: 0.1, ..AVERAGING };
            expect(compare_rounded(&raw_moments(&got), &wanted, rounding), &(width, height, stored));
            assert!(
                got.arrays[0].info.base_variance.is_nan(),
                "no single number says what varies over the map"
            );
        }
    }
}

#[test]
fn the_variance_of_clean_is_half_the_trace_of_lean() {
    for (width, height) in SIZES {
        let (image, source) = maps::plain_normal_map(width, height, 34);
        let clean = baked(&image, &source, &options(Layout::Clean, SampleType::F32));
        let wanted = oracle_of(&image, &source, &vec![0.0; width * height]);
        let texture = layer(&clean.arrays[0], "clean");
        let [bx, by, trace] = ["B.x", "B.y", "M.trace"].map(|name| stored(texture, name));
        let variance = combined([bx, by, trace], |[x, y, m]| (m - x * x - y * y) / 2.0);
        let half_trace = planes(&wanted, |t| (t.covariance()[0] + t.covariance()[1]) / 2.0);
        // Differences of second moments up to 2, each rounded a few times.
        expect(
            compare_planes(&variance, &half_trace, |_| 2.0 * AVERAGING.count * EPS).map(|_| ()),
            &(width, height),
        );
        for (got, wanted) in decoded(&clean.arrays).iter().zip(&half_trace) {
            for (texel, wanted) in got.texels().zip(&wanted.values) {
                let c = texel.covariance();
                assert!(
                    (c[0] - wanted).abs() <= 2.0 * AVERAGING.count * EPS && (c[0] - c[1]).abs() <= 4.0 * EPS
                );
            }
        }
    }
}

#[test]
fn toksvigs_factor_follows_from_the_averaged_normal() {
    for (width, height) in SIZES {
        let (image, source) = maps::plain_normal_map(width, height, 36);
        let material = material_map(width, height);
        let map = RoughnessMap { image: material.view(), channel: 1, stored: RoughnessStored::Perceptual };
        let mapped = variances(&material, 1, map.stored);
        for (base, variance) in [
            (BaseRoughness::Variance(0.01), vec![f64::from(0.01_f32); width * height]),
            (BaseRoughness::Map(map), mapped),
        ] {
            let arrays =
                baked_with(&image, &source, Some(base), &options(Layout::Toksvig, SampleType::F32)).arrays;
            let texture = layer(&arrays[0], "toksvig");
            let normals = averaged_normals(&image, &source);
            for (name, wanted) in ["R", "G", "B"].iter().zip(&normals) {
                let result = compare_planes(&stored(texture, name), wanted, |_| AVERAGING.count * EPS);
                expect(result.map(|_| ()), name);
            }
            let base = Plane { width, height, values: variance };
            let base = pyramid_oracle::pyramid(base, PyramidFilter::Box, source.wrap);
            let [nx, ny, nz] = normals;
            let factor = combined([nx, ny, nz, base], |[x, y, z, variance]| {
                let length = (x * x + y * y + z * z).sqrt().min(1.0);
                let s = 1.0 / variance;
                length / (length + s * (1.0 - length))
            });
            // d(factor)/d(length) is at most s, and the length has its own rounding error.
            let smallest = 5e-4; // variance of the smoothest texel of the map: 0.2^4 / 2 = 8e-4
            let result = compare_planes(&stored(texture, "A"), &factor, |_| 8.0 * EPS / smallest);
            expect(result.map(|_| ()), &(width, height));
        }
    }
}

/// The averaged unit normals of level 0, not renormalised.
fn averaged_normals(image: &Image, source: &SourceOptions) -> [Vec<Plane>; 3] {
    let slopes = slope_oracle::slopes(image, source);
    std::array::from_fn(|component| {
        let unit = |b: &[f64; 2]| {
            let length = (1.0 + b[0] * b[0] + b[1] * b[1]).sqrt();
            [b[0] / length, b[1] / length, 1.0 / length][component]
        };
        let values = slopes.texels.iter().map(unit).collect();
        let plane = Plane { width: slopes.width, height: slopes.height, values };
        pyramid_oracle::pyramid(plane, PyramidFilter::Box, source.wrap)
    })
}

#[test]
fn lean_and_schilling_store_the_averaged_normal() {
    let (image, source) = maps::plain_normal_map(53, 37, 37);
    let normals = averaged_normals(&image, &source);
    for (layout, name) in [(Layout::Lean, "lean1"), (Layout::Schilling, "schilling1")] {
        let arrays = baked(&image, &source, &options(layout, SampleType::F32)).arrays;
        for (channel, wanted) in ["N.x", "N.y", "N.z"].iter().zip(&normals) {
            let got = stored(layer(&arrays[0], name), channel);
            expect(compare_planes(&got, wanted, |_| AVERAGING.count * EPS).map(|_| ()), &(layout, channel));
        }
    }
}

/// s grows to the right, t downwards: ∂h/∂s = -B.x, ∂h/∂t = +B.y, and the mixed moment changes its sign.
#[test]
fn bump_slopes_are_derivatives_with_t_downwards() {
    let (heights, height_source) = maps::height_map(53, 37, SampleType::U16, 38);
    let (normals, normal_source) = maps::plain_normal_map(53, 37, 38);
    for (image, source, has_height) in [(&heights, height_source, true), (&normals, normal_source, false)] {
        let moments = baked(image, &source, &float_moments(PyramidFilter::Box));
        let bumps = baked(image, &source, &options(Layout::BumpSlopes, SampleType::F32));
        let texture = layer(&bumps.arrays[0], "bump-slopes");
        let reference = layer(&moments.arrays[0], "moments");
        for (bump, moment, sign) in [
            ("b1_dhds", "B.x", -1.0),
            ("b2_dhdt", "B.y", 1.0),
            ("b3_dhds2", "M.xx", 1.0),
            ("b4_dhdt2", "M.yy", 1.0),
            ("b5_dh2dsdt", "M.xy", -1.0),
        ] {
            assert_eq!(
                stored(texture, bump),
                combined([stored(reference, moment)], |[v]| sign * v),
                "{bump}"
            );
        }
        let level_0 = if has_height { channel_of(image, 0).values } else { vec![-1.0; 53 * 37] };
        let level_0 = Plane { width: 53, height: 37, values: level_0 };
        let wanted = pyramid_oracle::pyramid(level_0, PyramidFilter::Box, source.wrap);
        expect(
            compare_planes(&stored(texture, "b0_h"), &wanted, |_| AVERAGING.count * EPS).map(|_| ()),
            &"b0_h",
        );
    }
    // A ramp that rises to the right and falls downwards, tested away from the map's edges.
    let values = (0..64).map(|i| ((i % 8) as f32) - 2.0 * ((i / 8) as f32)).collect();
    let image = maps::image(8, 8, 1, Samples::F32(values));
    let source = height_source.with_height_scale(1.0 / 8.0);
    let bumps = baked(&image, &source, &options(Layout::BumpSlopes, SampleType::F32));
    let texture = layer(&bumps.arrays[0], "bump-slopes");
    for (channel, wanted) in [("b1_dhds", 1.0), ("b2_dhdt", -2.0), ("b5_dh2dsdt", -2.0)] {
        assert_eq!(stored(texture, channel)[0].values[3 * 8 + 3], wanted, "{channel}");
    }
}
