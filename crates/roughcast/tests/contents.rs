//! What each layout's files say, read from their samples by hand: the formulas, channel by channel, in floats.

mod common;

use common::compare::{EPS, Rounding, compare_planes, compare_rounded, expect};
use common::level::{Level, Plane, Texel, channel_of, decoded, eigenvalues, layer, raw_moments, stored};
use common::maps;
use common::{baked, baked_with, float_moments, options, pyramid_oracle, slope_oracle};
use roughcast::texture::{Base, Layout, Part, RoughnessStored, TextureArray};
use roughcast::{
    BakeOptions, BaseRoughness, Bits, Image, Lobe, PyramidFilter, RoughnessMap, RoughnessTexture, SampleType,
    Samples, SourceOptions,
};

const AVERAGING: Rounding = Rounding { count: 24.0, floor: 0.0 };

/// Sizes on and off the fused pass.
const SIZES: [(usize, usize); 3] = [(64, 64), (53, 37), (96, 40)];

/// Slopes gentle enough that no roughness exceeds 1, where the stored forms end.
fn gentle(width: usize, height: usize) -> (Image, SourceOptions) {
    let slopes: Vec<[f64; 2]> =
        maps::slopes(width, height, 31).into_iter().map(|b| b.map(|v| 0.5 * v)).collect();
    maps::slope_map(width, height, &slopes)
}

fn oracle(image: &Image, source: &SourceOptions, base: &[f64]) -> Vec<Level> {
    let slopes = slope_oracle::slopes(image, source);
    pyramid_oracle::moments(&slopes, base, PyramidFilter::Box, source.wrap)
}

/// A quantity of every texel of every level.
fn planes(levels: &[Level], quantity: impl Fn(Texel) -> f64) -> Vec<Plane> {
    let plane = |l: &Level| Plane { width: l.width, height: l.height, values: l.texels().map(&quantity).collect() };
    levels.iter().map(plane).collect()
}

/// The same made of several stored channels.
fn combined<const N: usize>(channels: [Vec<Plane>; N], f: impl Fn([f64; N]) -> f64) -> Vec<Plane> {
    let levels = channels[0].len();
    let value = |level: usize, i: usize| f(std::array::from_fn(|k| channels[k][level].values[i]));
    (0..levels)
        .map(|level| {
            let (width, height) = (channels[0][level].width, channels[0][level].height);
            let values = (0..width * height).map(|i| value(level, i)).collect();
            Plane { width, height, values }
        })
        .collect()
}

fn part(arrays: &[TextureArray], part: Part) -> &TextureArray {
    arrays.iter().find(|array| array.info.part == part).unwrap_or_else(|| panic!("no file is the {part}"))
}

/// A packed material texture: occlusion, perceptual roughness, metalness.
fn material(width: usize, height: usize) -> Image {
    let heights = maps::heights(width, height, 32);
    let values: Vec<f64> = heights.iter().flat_map(|h| [1.0 - 0.5 * h, 0.2 + 0.4 * h, h * h]).collect();
    maps::image(width, height, 3, maps::samples(&values, SampleType::U8))
}

/// Slope variances of a roughness map, by the table of conventions.
fn variances(image: &Image, channel: usize, stored: RoughnessStored) -> Vec<f64> {
    let variance = |r: f64| match stored {
        RoughnessStored::Perceptual => r.powi(4) / 2.0,
        RoughnessStored::Alpha => r * r / 2.0,
        RoughnessStored::AlphaSquared => r / 2.0,
        RoughnessStored::Gloss => (1.0 - r).powi(4) / 2.0,
        RoughnessStored::SpecularPower => 1.0 / r,
    };
    channel_of(image, channel).values.into_iter().map(variance).collect()
}

#[test]
fn a_uniform_base_adds_its_variance_to_every_second_moment() {
    for (width, height) in SIZES {
        let (image, source) = gentle(width, height);
        for power in [13_777.0, 64.0, 3.0_f32] {
            let base = Some(BaseRoughness::Variance(1.0 / power));
            let folded = BakeOptions { base: Base::Baked, ..float_moments(PyramidFilter::Box) };
            let with = baked_with(&image, &source, base, &folded);
            let without = baked(&image, &source, &float_moments(PyramidFilter::Box));
            let added = |t: Texel| Texel { m: [t.m[0] + f64::from(1.0 / power), t.m[1] + f64::from(1.0 / power), t.m[2]], ..t };
            let wanted: Vec<Level> = raw_moments(&without)
                .iter()
                .map(|l| Level::from_texels(l.width, l.height, l.texels().map(added)))
                .collect();
            expect(compare_rounded(&raw_moments(&with), &wanted, AVERAGING), &(width, height, power));
            let info = with.arrays[0].info;
            assert_eq!((info.base, info.base_variance), (Base::Baked, 1.0 / power));
            // Not folded in, it is only written down.
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
        let (image, source) = gentle(width, height);
        let material = material(width, height);
        let powers: Vec<f32> = maps::heights(width, height, 33).iter().map(|h| 2.0 + 500.0 * *h as f32).collect();
        let powers = maps::image(width, height, 1, Samples::F32(powers));
        for (map, channel, stored) in [
            (&material, 1, RoughnessStored::Perceptual),
            (&material, 0, RoughnessStored::Gloss),
            (&material, 2, RoughnessStored::Alpha),
            (&material, 1, RoughnessStored::AlphaSquared),
            (&powers, 0, RoughnessStored::SpecularPower),
        ] {
            let wanted = oracle(&image, &source, &variances(map, channel, stored));
            let base = Some(BaseRoughness::Map(RoughnessMap { image: map, channel, stored }));
            let folded = BakeOptions { base: Base::Baked, ..float_moments(PyramidFilter::Box) };
            let got = baked_with(&image, &source, base, &folded);
            // Gloss is one minus a roughness: that difference's rounding, four times over.
            let rounding = Rounding { floor: 0.1, ..AVERAGING };
            expect(compare_rounded(&raw_moments(&got), &wanted, rounding), &(width, height, stored));
            assert!(got.arrays[0].info.base_variance.is_nan(), "no single number says what varies over the map");
        }
    }
}

#[test]
fn cleans_variance_is_half_of_leans_trace() {
    for (width, height) in SIZES {
        let (image, source) = maps::plain_normal_map(width, height, 34);
        let clean = baked(&image, &source, &options(Layout::Clean, Bits::Float));
        let wanted = oracle(&image, &source, &vec![0.0; width * height]);
        let texture = layer(&clean.arrays[0], "clean");
        let [bx, by, trace] = ["B.x", "B.y", "M.trace"].map(|name| stored(texture, name));
        let variance = combined([bx, by, trace], |[x, y, m]| (m - x * x - y * y) / 2.0);
        let half_trace = planes(&wanted, |t| (t.covariance()[0] + t.covariance()[1]) / 2.0);
        // Differences of second moments up to 2, each rounded a few times.
        expect(compare_planes(&variance, &half_trace, |_| 2.0 * AVERAGING.count * EPS).map(|_| ()), &(width, height));
        for (got, wanted) in decoded(&clean.arrays).iter().zip(&half_trace) {
            for (texel, wanted) in got.texels().zip(&wanted.values) {
                let c = texel.covariance();
                assert!((c[0] - wanted).abs() <= 2.0 * AVERAGING.count * EPS && (c[0] - c[1]).abs() <= 4.0 * EPS);
            }
        }
    }
}

/// `α² = α0² + 2σ²` with `2σ² = tr Σ`, in every way to store it.
#[test]
fn a_materials_roughness_is_that_of_base_and_bumps() {
    /// Up to four roots and powers of a sum, relative; the pyramid's own roundings beside them.
    const ROUNDINGS: f64 = 60.0;
    for (width, height) in SIZES {
        let (image, source) = gentle(width, height);
        let material = material(width, height);
        let map = RoughnessMap { image: &material, channel: 1, stored: RoughnessStored::Perceptual };
        let mapped = variances(&material, 1, map.stored);
        for (base, variance) in [
            (None, vec![0.0; width * height]),
            (Some(BaseRoughness::Variance(0.02)), vec![f64::from(0.02_f32); width * height]),
            (Some(BaseRoughness::Map(map)), mapped),
        ] {
            let wanted = planes(&oracle(&image, &source, &variance), |t| t.covariance()[0] + t.covariance()[1]);
            for form in RoughnessStored::ALL {
                let bake_options =
                    BakeOptions { roughness_stored: *form, ..options(Layout::Pbr, Bits::Float) };
                let arrays = baked_with(&image, &source, base, &bake_options).arrays;
                let file = part(&arrays, Part::Roughness);
                let alpha_squared = combined([stored(&file.layers[0], "Y")], |[r]| match form {
                    RoughnessStored::Perceptual => r.powi(4),
                    RoughnessStored::Alpha => r * r,
                    RoughnessStored::AlphaSquared => r,
                    RoughnessStored::Gloss => (1.0 - r).powi(4),
                    RoughnessStored::SpecularPower => 2.0 / r,
                });
                // Gloss holds one minus the root of the width: its rounding is absolute, and the smallest widths have
                // their fourth power's worth of it.
                let allowed = |a: f64| ROUNDINGS * EPS * (a + a.max(EPS).powf(0.75));
                expect(compare_planes(&alpha_squared, &wanted, allowed).map(|_| ()), &(width, height, form));
                assert_eq!(file.info.base, if base.is_some() { Base::Baked } else { Base::None });
                check_normals(&arrays, &oracle(&image, &source, &variance));
            }
        }
    }
}

/// The normal texture holds the unit normal of the mean slope.
fn check_normals(arrays: &[TextureArray], wanted: &[Level]) {
    let texture = layer(part(arrays, Part::Normal), "normal");
    for (channel, component) in [("R", 0), ("G", 1), ("B", 2), ("A", 3)] {
        let wanted = planes(wanted, |t| {
            let length = (1.0 + t.b[0] * t.b[0] + t.b[1] * t.b[1]).sqrt();
            [t.b[0] / length, t.b[1] / length, 1.0 / length, 1.0][component]
        });
        let result = compare_planes(&stored(texture, channel), &wanted, |_| AVERAGING.count * EPS);
        expect(result.map(|_| ()), &channel);
    }
}

/// Roughness across, strength and direction, by KHR_materials_anisotropy's rule, give Σ back.
#[test]
fn an_anisotropic_material_gives_both_eigenvalues_and_the_direction_back() {
    /// Roots of differences of eigenvalues: roundings of the larger one, and of the slopes' squares.
    const TOLERANCE: f64 = 100.0 * EPS;
    for (width, height) in SIZES {
        let (image, source) = gentle(width, height);
        let base = f64::from(0.01_f32);
        let wanted = oracle(&image, &source, &vec![base; width * height]);
        let bake_options = BakeOptions {
            lobe: Lobe::Anisotropic,
            roughness_stored: RoughnessStored::Alpha,
            ..options(Layout::Pbr, Bits::Float)
        };
        let roughness = Some(BaseRoughness::Variance(base as f32));
        let arrays = baked_with(&image, &source, roughness, &bake_options).arrays;
        let across = stored(&part(&arrays, Part::Roughness).layers[0], "Y");
        let anisotropy = layer(part(&arrays, Part::Anisotropy), "anisotropy");
        let [x, y, strength] = ["R", "G", "B"].map(|name| stored(anisotropy, name));
        let along = combined([across.clone(), strength], |[b, s]| b + (1.0 - b) * s * s);
        let larger = combined([along.clone()], |[a]| a * a / 2.0);
        let smaller = combined([across.clone()], |[a]| a * a / 2.0);
        let by = |f: fn((f64, f64)) -> f64| planes(&wanted, move |t| f(eigenvalues(t.covariance())));
        expect(compare_planes(&larger, &by(|e| e.0), |_| TOLERANCE).map(|_| ()), &"larger");
        expect(compare_planes(&smaller, &by(|e| e.1), |_| TOLERANCE).map(|_| ()), &"smaller");
        // Σ = λ2 I + (λ1 - λ2) d dᵀ: the direction, without its sign and without trouble where both are equal.
        for (k, name) in ["xx", "yy", "xy"].iter().enumerate() {
            let rebuilt = combined([along.clone(), across.clone(), x.clone(), y.clone()], |[a, b, x, y]| {
                let (larger, smaller) = (a * a / 2.0, b * b / 2.0);
                let round = if k < 2 { smaller } else { 0.0 };
                round + (larger - smaller) * [x * x, y * y, x * y][k]
            });
            let covariance = planes(&wanted, |t| t.covariance()[k]);
            expect(compare_planes(&rebuilt, &covariance, |_| TOLERANCE).map(|_| ()), name);
        }
        let length = combined([x, y], |[x, y]| x * x + y * y);
        let one = combined([across], |_| 1.0);
        expect(compare_planes(&length, &one, |_| 8.0 * EPS).map(|_| ()), &"a direction has unit length");
    }
}

#[test]
fn grooves_point_their_direction_across_themselves() {
    for degrees in [0.0_f64, 30.0, 90.0, 135.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Slopes of both signs along one direction.
        let slopes: Vec<[f64; 2]> =
            (0..64).map(|i| if (i % 8 + i / 8) % 2 == 0 { 0.3 } else { -0.3 }).map(|s| [s * cos, s * sin]).collect();
        let (image, source) = maps::slope_map(8, 8, &slopes);
        let bake_options = BakeOptions { lobe: Lobe::Anisotropic, ..options(Layout::Pbr, Bits::Float) };
        let arrays = baked_with(&image, &source, Some(BaseRoughness::Variance(0.001)), &bake_options).arrays;
        let anisotropy = layer(part(&arrays, Part::Anisotropy), "anisotropy");
        let at_the_end = |name: &str| stored(anisotropy, name).last().expect("there are levels").values[0];
        let along = at_the_end("R") * cos + at_the_end("G") * sin;
        assert!((along.abs() - 1.0).abs() < 1e-6, "{degrees}: {along}"); // f32 rounding of a unit vector
        assert!(at_the_end("B") > 0.5, "one direction only is strongly anisotropic");
    }
}

#[test]
fn a_packed_texture_keeps_occlusion_and_metalness() {
    let (image, source) = gentle(53, 37);
    let material = material(53, 37);
    let packed =
        BakeOptions { roughness_texture: RoughnessTexture::Packed, ..options(Layout::Pbr, Bits::Float) };
    let map = |image, channel| BaseRoughness::Map(RoughnessMap { image, channel, stored: RoughnessStored::Perceptual });
    let channels = |base: Option<BaseRoughness<'_>>| {
        let arrays = baked_with(&image, &source, base, &packed).arrays;
        let file = part(&arrays, Part::OcclusionRoughnessMetallic).clone();
        ["R", "G", "B", "A"].map(|name| stored(layer(&file, "orm"), name))
    };
    let alone = baked_with(&image, &source, Some(map(&material, 1)), &options(Layout::Pbr, Bits::Float)).arrays;
    let [occlusion, roughness, metalness, one] = channels(Some(map(&material, 1)));
    assert_eq!(roughness, stored(&part(&alone, Part::Roughness).layers[0], "Y"));
    for (got, channel) in [(occlusion, 0), (metalness, 2)] {
        let wanted = pyramid_oracle::pyramid(channel_of(&material, channel), PyramidFilter::Box, source.wrap);
        expect(compare_planes(&got, &wanted, |_| AVERAGING.count * EPS).map(|_| ()), &channel);
    }
    assert!(one.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)));
    // Where nothing says otherwise nothing is occluded and nothing is metal.
    let grey = maps::image(53, 37, 1, maps::samples(&maps::heights(53, 37, 35), SampleType::U8));
    for base in [None, Some(BaseRoughness::Variance(0.1)), Some(map(&grey, 0)), Some(map(&material, 0))] {
        let [occlusion, _, metalness, _] = channels(base);
        assert!(occlusion.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)), "{base:?}");
        assert!(metalness.iter().all(|plane| plane.values.iter().all(|v| *v == 0.0)), "{base:?}");
    }
}

#[test]
fn toksvigs_factor_follows_from_the_averaged_normal() {
    for (width, height) in SIZES {
        let (image, source) = maps::plain_normal_map(width, height, 36);
        let material = material(width, height);
        let map = RoughnessMap { image: &material, channel: 1, stored: RoughnessStored::Perceptual };
        let mapped = variances(&material, 1, map.stored);
        for (base, variance) in [
            (BaseRoughness::Variance(0.01), vec![f64::from(0.01_f32); width * height]),
            (BaseRoughness::Map(map), mapped),
        ] {
            let arrays = baked_with(&image, &source, Some(base), &options(Layout::Toksvig, Bits::Float)).arrays;
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
            // d(factor)/d(length) is at most s, and the length is off by its own rounding.
            let smallest = 5e-4; // variance of the smoothest texel of the map: 0.2^4 / 2 = 8e-4
            let result = compare_planes(&stored(texture, "A"), &factor, |_| 8.0 * EPS / smallest);
            expect(result.map(|_| ()), &(width, height));
        }
    }
}

/// The unit normals of level 0, averaged and not renormalised.
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
fn lean_and_schilling_hold_the_averaged_normal() {
    let (image, source) = maps::plain_normal_map(53, 37, 37);
    let normals = averaged_normals(&image, &source);
    for (layout, name) in [(Layout::Lean, "lean1"), (Layout::Schilling, "schilling1")] {
        let arrays = baked(&image, &source, &options(layout, Bits::Float)).arrays;
        for (channel, wanted) in ["N.x", "N.y", "N.z"].iter().zip(&normals) {
            let got = stored(layer(&arrays[0], name), channel);
            expect(compare_planes(&got, wanted, |_| AVERAGING.count * EPS).map(|_| ()), &(layout, channel));
        }
    }
}

/// s grows to the right, t downwards: ∂h/∂s = -B.x, ∂h/∂t = +B.y, and the mixed moment turns its sign.
#[test]
fn bump_slopes_are_derivatives_with_t_downwards() {
    let (heights, height_source) = maps::height_map(53, 37, SampleType::U16, 38);
    let (normals, normal_source) = maps::plain_normal_map(53, 37, 38);
    for (image, source, has_height) in [(&heights, height_source, true), (&normals, normal_source, false)] {
        let moments = baked(image, &source, &float_moments(PyramidFilter::Box));
        let bumps = baked(image, &source, &options(Layout::BumpSlopes, Bits::Float));
        let texture = layer(&bumps.arrays[0], "bump-slopes");
        let reference = layer(&moments.arrays[0], "moments");
        for (bump, moment, sign) in [
            ("b1_dhds", "B.x", -1.0),
            ("b2_dhdt", "B.y", 1.0),
            ("b3_dhds2", "M.xx", 1.0),
            ("b4_dhdt2", "M.yy", 1.0),
            ("b5_dh2dsdt", "M.xy", -1.0),
        ] {
            assert_eq!(stored(texture, bump), combined([stored(reference, moment)], |[v]| sign * v), "{bump}");
        }
        let level_0 = if has_height { channel_of(image, 0).values } else { vec![-1.0; 53 * 37] };
        let level_0 = Plane { width: 53, height: 37, values: level_0 };
        let wanted = pyramid_oracle::pyramid(level_0, PyramidFilter::Box, source.wrap);
        expect(compare_planes(&stored(texture, "b0_h"), &wanted, |_| AVERAGING.count * EPS).map(|_| ()), &"b0_h");
    }
    // A ramp that rises to the right and falls downwards, away from its edges.
    let values = (0..64).map(|i| ((i % 8) as f32) - 2.0 * ((i / 8) as f32)).collect();
    let image = maps::image(8, 8, 1, Samples::F32(values));
    let source = SourceOptions { height_scale: 1.0 / 8.0, ..height_source };
    let bumps = baked(&image, &source, &options(Layout::BumpSlopes, Bits::Float));
    let texture = layer(&bumps.arrays[0], "bump-slopes");
    for (channel, wanted) in [("b1_dhds", 1.0), ("b2_dhdt", -2.0), ("b5_dh2dsdt", -2.0)] {
        assert_eq!(stored(texture, channel)[0].values[3 * 8 + 3], wanted, "{channel}");
    }
}
