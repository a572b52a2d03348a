//! Laws that the pyramid obeys for every map: conservation, constants, recursion, symmetry, linearity.

mod common;

use common::compare::{EPS, Rounding, check_means, compare_levels, compare_planes, compare_rounded, expect};
use common::level::{Level, Plane, Texel, layer, raw_moments, stored};
use common::maps::{self, SIZES};
use common::pyramid_oracle::composed_weights;
use common::{baked, float_moments, options, slope_oracle};
use roughcast::texture::{Layout, decode};
use roughcast::{
    Gradient, Green, Image, NormalRange, PyramidFilter, SampleType, Samples, SamplesMut, SourceOptions, Wrap,
};

/// Averaging alone: about four roundings per level, eleven levels.
const AVERAGING: Rounding = Rounding { count: 24.0, floor: 0.0 };

#[test]
fn means_of_all_moments_are_the_same_on_every_level() {
    for (width, height) in SIZES {
        let (image, options) = maps::slope_map(width, height, &maps::slopes(width, height, 21));
        for filter in PyramidFilter::ALL {
            for wrap in Wrap::ALL {
                let options = options.with_wrap(*wrap);
                let levels = raw_moments(&baked(&image, &options, &float_moments(*filter)));
                let whole = levels[levels.len() - 1].texel(0);
                let tolerance = (AVERAGING.slope(whole), AVERAGING.second(whole));
                expect(check_means(&levels, tolerance), &(width, height, filter, wrap));
            }
        }
    }
}

/// A constant stays exactly constant and produces no variance.
#[test]
fn a_constant_slope_stays_exactly_constant() {
    for (width, height) in SIZES {
        for slope in [[0.1, -0.7], [1.0 / 3.0, 1e-5], [-17.3, 40.1]] {
            let (image, options) = maps::slope_map(width, height, &vec![slope; width * height]);
            let (x, y) = (slope[0] as f32, slope[1] as f32);
            for filter in PyramidFilter::ALL {
                for wrap in Wrap::ALL {
                    let options = options.with_wrap(*wrap);
                    let arrays = baked(&image, &options, &float_moments(*filter)).arrays;
                    for level in arrays[0].layers()[0].levels() {
                        let Samples::F32(samples) = level.samples() else { panic!("floats were asked for") };
                        for texel in samples.chunks_exact(5) {
                            assert_eq!(
                                texel,
                                [x, y, x * x, y * y, x * y],
                                "{width}x{height} {filter} {wrap}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Schilling's recursion gives the covariance of the whole footprint, with the weights of all levels combined.
#[test]
fn the_roughness_pyramid_holds_the_covariance_of_the_whole_footprint() {
    /// Roundings of a variance, and of the slopes from whose differences it is computed.
    const ROUNDINGS: f64 = 24.0;
    for (width, height) in [(53, 37), (64, 64), (96, 40), (130, 66), (1, 7)] {
        let slopes = maps::slopes(width, height, 22);
        let (image, source) = maps::slope_map(width, height, &slopes);
        for filter in PyramidFilter::ALL {
            for wrap in Wrap::ALL {
                let source = source.with_wrap(*wrap);
                let bake_options = options(Layout::Schilling, SampleType::F32).with_filter(*filter);
                let got = schilling_levels(&baked(&image, &source, &bake_options));
                let level_0 = slope_oracle::slopes(&image, &source);
                let wanted = footprints(&level_0, got.len(), *filter, *wrap);
                for (number, (got, wanted)) in got.iter().zip(&wanted).enumerate() {
                    for (index, (g, w)) in got.iter().zip(wanted).enumerate() {
                        let trace = w.m[0] + w.m[1];
                        let rms = (trace + w.b[0].powi(2) + w.b[1].powi(2)).sqrt();
                        let tolerance =
                            ROUNDINGS * EPS * (trace + trace.sqrt() * rms) + (ROUNDINGS * EPS * rms).powi(2);
                        for k in 0..3 {
                            let error = (g.m[k] - w.m[k]).abs();
                            assert!(
                                error <= tolerance,
                                "{width}x{height} {filter} {wrap} level {number} texel {index}: {g:?} {w:?}, {error:e} > {tolerance:e}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Mean slope and covariance (in `m`) of each texel, from the stored factor: `K = D Dᵀ`, D upper triangular.
fn schilling_levels(baked: &roughcast::Baked) -> Vec<Vec<Texel>> {
    let (first, second) = (layer(&baked.arrays[0], "schilling1"), layer(&baked.arrays[0], "schilling2"));
    let [d2] = ["D.2"].map(|name| stored(first, name));
    let [bx, by, d1, d3] = ["B.x", "B.y", "D.1", "D.3"].map(|name| stored(second, name));
    (0..d2.len())
        .map(|level| {
            let at = |plane: &[Plane], i: usize| plane[level].values[i];
            (0..d2[level].values.len())
                .map(|i| {
                    let (d1, d2, d3) = (at(&d1, i), at(&d2, i), at(&d3, i));
                    assert!(d1 >= 0.0 && d3 >= 0.0, "standard deviations are not negative");
                    Texel { b: [at(&bx, i), at(&by, i)], m: [d1 * d1 + d2 * d2, d3 * d3, d2 * d3] }
                })
                .collect()
        })
        .collect()
}

/// Mean slope and covariance (in `m`) of each texel of each level, computed directly from level 0.
fn footprints(
    level_0: &slope_oracle::Slopes,
    levels: usize,
    filter: PyramidFilter,
    wrap: Wrap,
) -> Vec<Vec<Texel>> {
    let columns = composed_weights(level_0.width, levels, filter, wrap);
    let rows = composed_weights(level_0.height, levels, filter, wrap);
    let mut all = Vec::new();
    for (rows, columns) in rows.iter().zip(&columns) {
        let mut level = Vec::new();
        for row in rows {
            for column in columns {
                let mut taps = Vec::new();
                for (y, v) in row {
                    taps.extend(column.iter().map(|(x, u)| (u * v, level_0.texels[y * level_0.width + x])));
                }
                let mean = [0, 1].map(|k| taps.iter().map(|(w, b)| w * b[k]).sum::<f64>());
                let central = |i: usize, j: usize| {
                    taps.iter().map(|(w, b)| w * (b[i] - mean[i]) * (b[j] - mean[j])).sum::<f64>()
                };
                level.push(Texel { b: mean, m: [central(0, 0), central(1, 1), central(0, 1)] });
            }
        }
        all.push(level);
    }
    all
}

/// How a symmetry of the map moves its texels and transforms its moments.
struct Symmetry {
    name: &'static str,
    /// The size of the moved map.
    size: fn(usize, usize) -> (usize, usize),
    /// The texel of the original map for a texel of the moved one; arguments are x, y, and the original map's size.
    from: fn(usize, usize, usize, usize) -> (usize, usize),
    turn: fn(Texel) -> Texel,
}

/// A counter-clockwise rotation by 90 degrees, and two mirrors.
const SYMMETRIES: [Symmetry; 3] = [
    Symmetry {
        name: "rotated",
        size: |w, h| (h, w),
        from: |x, y, w, _| (w - 1 - y, x),
        turn: |t| Texel { b: [-t.b[1], t.b[0]], m: [t.m[1], t.m[0], -t.m[2]] },
    },
    Symmetry {
        name: "mirrored left to right",
        size: |w, h| (w, h),
        from: |x, y, w, _| (w - 1 - x, y),
        turn: |t| Texel { b: [-t.b[0], t.b[1]], m: [t.m[0], t.m[1], -t.m[2]] },
    },
    Symmetry {
        name: "turned upside down",
        size: |w, h| (w, h),
        from: |x, y, _, h| (x, h - 1 - y),
        turn: |t| Texel { b: [t.b[0], -t.b[1]], m: [t.m[0], t.m[1], -t.m[2]] },
    },
];

impl Symmetry {
    fn moved<T: Copy>(&self, texels: &[T], width: usize, height: usize) -> Vec<T> {
        let (w, h) = (self.size)(width, height);
        let mut out = Vec::with_capacity(texels.len());
        for y in 0..h {
            for x in 0..w {
                let (from_x, from_y) = (self.from)(x, y, width, height);
                out.push(texels[from_y * width + from_x]);
            }
        }
        out
    }

    fn levels(&self, levels: &[Level]) -> Vec<Level> {
        let one = |level: &Level| {
            let texels: Vec<Texel> = level.texels().collect();
            let (w, h) = (self.size)(level.width, level.height);
            let turned = self.moved(&texels, level.width, level.height).into_iter().map(self.turn);
            Level::from_texels(w, h, turned)
        };
        levels.iter().map(one).collect()
    }
}

#[test]
fn turning_a_normal_map_turns_its_moments() {
    for (width, height) in [(64, 64), (96, 40), (128, 64), (53, 37), (7, 1)] {
        let slopes = maps::slopes(width, height, 23);
        let (image, options) = maps::slope_map(width, height, &slopes);
        for filter in PyramidFilter::ALL {
            let levels = raw_moments(&baked(&image, &options, &float_moments(*filter)));
            for symmetry in &SYMMETRIES {
                let turned: Vec<[f64; 2]> = symmetry
                    .moved(&slopes, width, height)
                    .into_iter()
                    .map(|b| (symmetry.turn)(Texel { b, m: [0.0; 3] }).b)
                    .collect();
                let (w, h) = (symmetry.size)(width, height);
                let (image, options) = maps::slope_map(w, h, &turned);
                let got = raw_moments(&baked(&image, &options, &float_moments(*filter)));
                let result = compare_rounded(&got, &symmetry.levels(&levels), AVERAGING);
                expect(result, &(symmetry.name, width, height, filter));
            }
        }
    }
}

#[test]
fn turning_a_height_map_turns_its_moments() {
    for (width, height) in [(64, 64), (96, 40), (53, 37)] {
        let heights = maps::heights(width, height, 24);
        for gradient in [Gradient::Sobel, Gradient::Central] {
            for wrap in Wrap::ALL {
                let bake_heights = |heights: &[f64], width: usize, height: usize, height_scale: f32| {
                    let image = maps::image(width, height, 1, maps::samples(heights, SampleType::U16));
                    let (_, options) = maps::height_map(1, 1, SampleType::U8, 0);
                    let options =
                        options.with_gradient(gradient).with_wrap(*wrap).with_height_scale(height_scale);
                    raw_moments(&baked(&image, &options, &float_moments(PyramidFilter::Box)))
                };
                let scale = 0.05_f32;
                let levels = bake_heights(&heights, width, height, scale);
                for symmetry in &SYMMETRIES {
                    let (w, h) = (symmetry.size)(width, height);
                    // Heights are fractions of the width, which may differ in the moved map.
                    let got = bake_heights(
                        &symmetry.moved(&heights, width, height),
                        w,
                        h,
                        scale * width as f32 / w as f32,
                    );
                    let rounding = Rounding { floor: f64::from(scale) * width as f64, ..AVERAGING };
                    let result = compare_rounded(&got, &symmetry.levels(&levels), rounding);
                    expect(result, &(symmetry.name, width, height, gradient, wrap));
                }
            }
        }
    }
}

fn with_green_turned(image: &Image, range: NormalRange) -> Image {
    let channels = image.channels();
    let mut turned = image.clone();
    let green = |i: usize| i % channels == 1;
    match turned.samples_mut() {
        SamplesMut::U8(v) => {
            v.iter_mut().enumerate().filter(|(i, _)| green(*i)).for_each(|(_, v)| *v = 255 - *v)
        }
        SamplesMut::U16(v) => {
            v.iter_mut().enumerate().filter(|(i, _)| green(*i)).for_each(|(_, v)| *v = 65535 - *v)
        }
        SamplesMut::F32(v) if range == NormalRange::Signed => {
            v.iter_mut().enumerate().filter(|(i, _)| green(*i)).for_each(|(_, v)| *v = -*v);
        }
        other => panic!("not used here: {:?}", other.sample_type()),
    }
    turned
}

/// A DirectX and an OpenGL version of one map produce identical files.
#[test]
fn green_up_and_green_down_are_the_same_map() {
    for (sample_type, range) in [
        (SampleType::U8, NormalRange::Unorm),
        (SampleType::U16, NormalRange::Unorm),
        (SampleType::F32, NormalRange::Signed),
    ] {
        let up = SourceOptions::default().with_range(range);
        let down = up.with_green(Green::Down);
        let image = maps::normal_map((96, 40), &maps::slopes(96, 40, 25), sample_type, &up, 3);
        let turned = with_green_turned(&image, range);
        for layout in [Layout::Lean, Layout::Pbr, Layout::Schilling] {
            let bake_options = options(layout, SampleType::F32);
            let one = baked(&image, &up, &bake_options);
            assert!(one == baked(&turned, &down, &bake_options), "{sample_type:?} {layout}");
            // The direction of green does matter.
            assert!(one != baked(&image, &down, &bake_options), "{sample_type:?} {layout}");
        }
    }
}

#[test]
fn scaled_heights_have_scaled_slopes() {
    for (k, exact) in [(2.0, true), (0.25, true), (3.0, false), (-1.7, false)] {
        let (image, source) = maps::height_map(53, 37, SampleType::U16, 26);
        let floor = f64::from(source.height_scale) * 53.0 * f64::abs(k);
        let levels = raw_moments(&baked(&image, &source, &float_moments(PyramidFilter::Box)));
        let scaled: Vec<Level> = levels
            .iter()
            .map(|level| {
                let texels =
                    level.texels().map(|t| Texel { b: t.b.map(|v| v * k), m: t.m.map(|v| v * k * k) });
                Level::from_texels(level.width, level.height, texels)
            })
            .collect();
        let source = source.with_height_scale(source.height_scale * k as f32);
        let got = raw_moments(&baked(&image, &source, &float_moments(PyramidFilter::Box)));
        if exact {
            // Multiplying by a power of two is exact.
            expect(compare_levels(&got, &scaled, |_| (0.0, 0.0)).map(|_| ()), &k);
        } else {
            expect(compare_rounded(&got, &scaled, Rounding { floor, ..AVERAGING }), &k);
        }
    }
}

/// Depth maps are inverted height maps: slopes change sign, second moments do not.
#[test]
fn the_sense_of_heights_turns_slopes_and_leaves_second_moments() {
    let (image, up) = maps::height_map(64, 64, SampleType::U8, 27);
    let down = up.with_height_sense(roughcast::HeightSense::WhiteDeep);
    let levels =
        |source: &SourceOptions| raw_moments(&baked(&image, source, &float_moments(PyramidFilter::Box)));
    for (up, down) in levels(&up).iter().zip(&levels(&down)) {
        for (up, down) in up.texels().zip(down.texels()) {
            assert_eq!((down.b, down.m), (up.b.map(|v| -v), up.m));
        }
    }
}

/// The decoder returns what was stored, except for the repair of covariances.
#[test]
fn the_decoder_returns_the_stored_moments() {
    let (image, source) = maps::plain_normal_map(53, 37, 28);
    let baked = baked(&image, &source, &float_moments(PyramidFilter::Box));
    let raw = raw_moments(&baked);
    assert_eq!(decode(&baked.arrays).expect("it was just baked").len(), raw.len());
    let decoded = common::level::decoded(&baked.arrays);
    for (plane, name) in common::level::NAMES.iter().enumerate() {
        let planes = |levels: &[Level]| -> Vec<Plane> {
            let plane =
                |l: &Level| Plane { width: l.width, height: l.height, values: l.planes[plane].clone() };
            levels.iter().map(plane).collect()
        };
        // The repair changes a second moment by its own rounding, at slopes up to 2.
        let result =
            compare_planes(
                &planes(&decoded),
                &planes(&raw),
                |_| if plane < 2 { 0.0 } else { 4.0 * 4.0 * EPS },
            );
        expect(result.map(|_| ()), name);
    }
}
