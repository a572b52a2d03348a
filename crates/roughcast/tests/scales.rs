//! Scales of unsigned texels: smallest safe, fixed, advised; and the options that are rejected.

mod common;

use common::compare::{EPS, Rounding, compare_levels, compare_rounded, expect};
use common::level::{decoded, eigenvalues, raw_moments};
use common::maps;
use common::{baked, baked_with, options, pyramid_oracle, slope_oracle};
use roughcast::texture::{Base, Layout, RoughnessStored};
use roughcast::{
    Bake, BakeError, BakeOptions, Baked, BaseRoughness, Blocks, Image, MaxSlope, NormalChannels, PbrOptions,
    PyramidFilter, RoughnessMap, SampleType, Samples, ScaleChoice, SourceError, SourceOptions,
};

const UNSIGNED: [SampleType; 2] = [SampleType::U8, SampleType::U16];

/// The scale is a root or a square of a maximum of single floats: a few roundings.
const ROUNDINGS: f64 = 8.0;

/// Largest magnitude of B's components, of M's diagonal and of Σ's, and the larger eigenvalue, over all levels.
struct Needs {
    slope: f64,
    second: f64,
    variance: f64,
    eigenvalue: f64,
}

fn needs(image: &Image, source: &SourceOptions, base: f64) -> Needs {
    let slopes = slope_oracle::slopes(image, source);
    let base = vec![base; slopes.texels.len()];
    let mut needs = Needs { slope: 0.0, second: 0.0, variance: 0.0, eigenvalue: 0.0 };
    for level in pyramid_oracle::moments(&slopes, &base, PyramidFilter::Box, source.wrap) {
        for texel in level.texels() {
            let c = texel.covariance();
            needs.slope = needs.slope.max(texel.b[0].abs()).max(texel.b[1].abs());
            needs.second = needs.second.max(texel.m[0]).max(texel.m[1]);
            needs.variance = needs.variance.max(c[0]).max(c[1]);
            needs.eigenvalue = needs.eigenvalue.max(eigenvalues(c).0);
        }
    }
    needs
}

#[track_caller]
fn close(got: f32, wanted: f64) {
    assert!((f64::from(got) / wanted - 1.0).abs() <= ROUNDINGS * EPS, "{got} instead of {wanted}");
}

/// Nothing saturates, and no smaller scale would be sufficient.
#[test]
fn the_chosen_scale_is_the_smallest_that_holds_every_texel() {
    let maps = [
        maps::plain_normal_map(96, 40, 51),
        maps::plain_normal_map(53, 37, 52),
        maps::slope_map(8, 8, &maps::slopes(8, 8, 53).map_scale(20.0)),
    ];
    for (image, source) in &maps {
        for (folded, variance) in [(Base::None, 0.0), (Base::Baked, 0.04_f32)] {
            let needs = needs(image, source, f64::from(variance));
            for bits in UNSIGNED {
                let report = |layout| {
                    let options = options(layout, bits).with_base(folded);
                    baked_with(image, source, Some(BaseRoughness::Variance(variance)), &options).report
                };
                // Level 0 has the largest values, so the scale must be what some texel reaches.
                for layout in [Layout::Lean, Layout::Clean] {
                    let report = report(layout);
                    close(report.scale, needs.second.sqrt());
                    assert_eq!(report.spread_scale, 1.0);
                }
                for (layout, scale) in
                    [(Layout::Variance, needs.variance), (Layout::Schilling, needs.variance.sqrt())]
                {
                    let report = report(layout);
                    close(report.scale, needs.slope);
                    close(report.spread_scale, scale);
                }
                // The eigenvalue is bounded by the sum of two variances; it is not known beforehand.
                let scale = f64::from(report(Layout::SchillingIsotropic).spread_scale);
                let needed = needs.eigenvalue.sqrt();
                assert!(
                    scale >= needed * (1.0 - ROUNDINGS * EPS)
                        && scale <= needed * 2.0_f64.sqrt() * (1.0 + ROUNDINGS * EPS)
                );
            }
        }
    }
}

trait MapScale {
    fn map_scale(self, factor: f64) -> Self;
}

impl MapScale for Vec<[f64; 2]> {
    fn map_scale(self, factor: f64) -> Self {
        self.into_iter().map(|b| b.map(|v| factor * v)).collect()
    }
}

/// A flat map needs no range, and still decodes as flat.
#[test]
fn flat_maps_bake_and_stay_flat() {
    let values = vec![128_u8; 12 * 7];
    let heights = maps::image(12, 7, 1, Samples::U8(values));
    let (_, height_source) = maps::height_map(1, 1, SampleType::U8, 0);
    for bits in SampleType::ALL {
        for layout in Layout::ALL {
            if matches!(layout, Layout::Moments | Layout::BumpSlopes) && !bits.is_float() {
                continue;
            }
            let baked = baked_with(
                &heights,
                &height_source,
                Some(BaseRoughness::Variance(0.01)),
                &options(*layout, *bits),
            );
            let report = &baked.report;
            assert!(report.scale > 0.0 && report.spread_scale > 0.0 && report.advice.is_none());
            assert_eq!(report.maximum_slope, 0.0);
            for level in decoded(&baked.arrays) {
                for texel in level.texels() {
                    let c = texel.covariance();
                    // A material's roughness contains the base; everything else is flat.
                    let wanted = if *layout == Layout::Pbr { 0.01 } else { 0.0 };
                    let slope = f64::from(report.bounds.slope);
                    let variance = f64::from(report.bounds.variance) + 4.0 * EPS;
                    assert!(texel.b.iter().all(|b| b.abs() <= slope), "{layout} {bits} {texel:?}");
                    assert!((c[0] - wanted).abs() <= variance, "{layout} {bits} {texel:?}");
                    assert!((c[1] - wanted).abs() <= variance, "{layout} {bits} {texel:?}");
                }
            }
        }
    }
}

/// A fixed scale clamps slopes before they are averaged, and counts them.
#[test]
fn a_fixed_scale_clamps_slopes_and_counts_them() {
    let (image, source) = maps::slope_map(53, 37, &maps::slopes(53, 37, 54));
    let powers: Vec<f32> = (0..53 * 37).map(|i| if i == 700 { 10.0 } else { 400.0 }).collect();
    let powers = maps::image(53, 37, 1, Samples::F32(powers));
    let map = RoughnessMap { image: powers.view(), channel: 0, stored: RoughnessStored::SpecularPower };
    let map_variances: Vec<f64> =
        (0..53 * 37).map(|i| if i == 700 { f64::from(0.1_f32) } else { f64::from(0.0025_f32) }).collect();
    let scale = 0.5_f32;
    for layout in
        [Layout::Lean, Layout::Clean, Layout::Schilling, Layout::Variance, Layout::SchillingIsotropic]
    {
        let holds_squares = matches!(layout, Layout::Lean | Layout::Clean);
        for (base, largest, variances) in [
            (None, 0.0, vec![0.0; 53 * 37]),
            (Some(BaseRoughness::Variance(0.09)), f64::from(0.09_f32), vec![f64::from(0.09_f32); 53 * 37]),
            (Some(BaseRoughness::Map(map)), f64::from(0.1_f32), map_variances.clone()),
        ] {
            // The base takes up part of the range of the second moments.
            let room =
                if holds_squares { f64::from(scale).powi(2) - largest } else { f64::from(scale).powi(2) };
            let limited = source.with_max_slope(MaxSlope::Limit(room.sqrt() as f32));
            let slopes = slope_oracle::slopes(&image, &limited);
            assert!(slopes.counts.clamped > 100);
            let wanted = pyramid_oracle::moments(&slopes, &variances, PyramidFilter::Box, source.wrap);
            let folded = if base.is_some() { Base::Baked } else { Base::None };
            let options =
                options(layout, SampleType::U16).with_scale(ScaleChoice::Fixed(scale)).with_base(folded);
            let got = baked_with(&image, &source, base, &options);
            assert_eq!(got.report.scale, scale);
            assert_eq!(got.report.counts, slopes.counts, "{layout}, base up to {largest}");
            let bound = f64::from(got.report.bounds.slope) + ROUNDINGS * EPS;
            let levels = decoded(&got.arrays);
            // Second moments are compared for the layout that stores all of them.
            let second = |texel: common::level::Texel| match layout {
                Layout::Lean => f64::from(got.report.bounds.eigenvalue) + 2.0 * texel.rms() * bound,
                _ => f64::INFINITY,
            };
            expect(compare_levels(&levels, &wanted, |t| (bound, second(t))).map(|_| ()), &(layout, largest));
        }
    }
}

/// A gentle map with this many steep texels per thousand.
fn with_steep_texels(thousandths: f64, direction: [f64; 2]) -> (Image, SourceOptions) {
    steep_texels_among(0.1, thousandths, direction)
}

/// The same for a map with slopes of this size.
fn steep_texels_among(size: f64, thousandths: f64, direction: [f64; 2]) -> (Image, SourceOptions) {
    let (width, height) = (128, 128);
    let mut slopes = maps::slopes(width, height, 55).map_scale(size);
    let count = (thousandths * 1e-3 * slopes.len() as f64) as usize;
    for i in 0..count {
        slopes[i * 97] = direction;
    }
    maps::slope_map(width, height, &slopes)
}

#[test]
fn advice_is_given_if_few_steep_texels_cost_much_and_it_is_correct() {
    /// How accurate the advice is; the quantile itself is known to 1.5 %, its square to 3 %.
    const WITHIN: f32 = 0.1;
    for layout in [Layout::Lean, Layout::Clean] {
        for bits in UNSIGNED {
            let (image, source) = with_steep_texels(0.5, [9.0, 0.0]);
            let source = source.with_max_slope(MaxSlope::Limit(MaxSlope::OF_ANY_MAP));
            let before = baked(&image, &source, &options(layout, bits)).report;
            let advice = before.advice.unwrap_or_else(|| panic!("{layout} {bits}: no advice"));
            assert!(advice.factor > 4.0 && advice.max_slope < 0.2, "{advice:?}");
            let followed = source.with_max_slope(MaxSlope::Limit(advice.max_slope));
            let after = baked(&image, &followed, &options(layout, bits)).report;
            let factor = after.bounds.usable_specular_power() / before.bounds.usable_specular_power();
            assert!(
                (factor / advice.factor - 1.0).abs() < WITHIN,
                "{layout} {bits}: {factor} for {advice:?}"
            );
            // No more texels are clamped than the advice states.
            assert!(after.counts.clamped <= after.texels / 1000 + 1, "{:?}", after.counts);
        }
    }
}

#[test]
fn few_steep_texels_do_not_hide_the_range_of_half_floats() {
    let (image, source) = with_steep_texels(0.5, [120.0, 0.0]);
    let options = BakeOptions::default().with_layout(Layout::Lean).with_sample_type(SampleType::F16);
    let report = baked(&image, &source, &options).report;
    let (worst, most) =
        (report.bounds.usable_specular_power(), report.bounds_of_most.usable_specular_power());
    assert!(worst < 1.0 && most > 1000.0, "{worst} {most}");
    let advice = report.advice.expect("half floats are coarse on steep slopes");
    let followed = source.with_max_slope(MaxSlope::Limit(advice.max_slope));
    let kept = baked(&image, &followed, &options).report.bounds.usable_specular_power();
    assert!((kept / (advice.factor * worst) - 1.0).abs() < 0.05, "{kept} {advice:?} {worst}");
}

#[test]
fn no_advice_is_given_if_it_would_not_help() {
    let advised = |thousandths, direction, bits, scale| {
        let (image, source) = with_steep_texels(thousandths, direction);
        let options = options(Layout::Lean, bits).with_scale(scale);
        baked(&image, &source, &options).report.advice.is_some()
    };
    let steep = [9.0, 0.0];
    assert!(advised(0.5, steep, SampleType::U16, ScaleChoice::Auto));
    assert!(!advised(0.0, steep, SampleType::U16, ScaleChoice::Auto), "no steep texels");
    assert!(!advised(5.0, steep, SampleType::U16, ScaleChoice::Auto), "too many to be cut");
    assert!(!advised(0.5, [0.2, 0.0], SampleType::U16, ScaleChoice::Auto), "not steep enough to cost much");
    assert!(
        advised(0.5, steep, SampleType::F16, ScaleChoice::Auto),
        "half floats are coarse on steep slopes"
    );
    assert!(!advised(0.5, steep, SampleType::F32, ScaleChoice::Auto), "single floats are fine enough on any");
    assert!(!advised(0.5, steep, SampleType::U16, ScaleChoice::Fixed(10.0)), "the scale was chosen by hand");
}

const UNLIMITED: MaxSlope = MaxSlope::Limit(MaxSlope::OF_ANY_MAP);

/// All layouts with a range that depends on the map.
const RANGED: [Layout; 5] =
    [Layout::Lean, Layout::Clean, Layout::Schilling, Layout::SchillingIsotropic, Layout::Variance];

#[test]
fn the_automatic_limit_is_the_slope_that_few_exceed_with_the_stated_gain() {
    /// The quantile is known to a bin of the histogram, 1.6 % above it.
    const BIN: f64 = 1.017;
    /// What bounds include besides the ranges: the single-float arithmetic, and the error of the mean.
    const WITHIN: f32 = 0.1;
    let (image, source) = steep_texels_among(2.0, 0.5, [40.0, 9.0]);
    let mut lengths: Vec<f64> =
        slope_oracle::slopes(&image, &source).texels.iter().map(|b| b[0].hypot(b[1])).collect();
    lengths.sort_by(f64::total_cmp);
    let exceeded = lengths[lengths.len() - 1 - lengths.len() / 1000];
    assert!(exceeded > 1.0);
    for layout in RANGED {
        for bits in UNSIGNED {
            let got = baked(&image, &source, &options(layout, bits));
            let limit = got.report.limit.unwrap_or_else(|| panic!("{layout} {bits}: no limit"));
            let found = f64::from(limit.max_slope);
            assert!(found >= exceeded && found <= BIN * exceeded, "{layout} {bits}: {found}, not {exceeded}");
            assert_eq!(got.report.max_slope, limit.max_slope);
            // The result is that of an explicit limit, except for the scale, which can hold a slope of that length in
            // any direction.
            let by_hand = source.with_max_slope(MaxSlope::Limit(limit.max_slope));
            let wanted = slope_oracle::slopes(&image, &by_hand);
            assert_eq!((got.report.counts, limit.texels), (wanted.counts, wanted.counts.clamped));
            let whole = baked(&image, &by_hand, &options(layout, bits)).report;
            assert_eq!((whole.whole, whole.limit), (got.report.whole, None), "{layout} {bits}");
            assert!(
                got.report.scale >= whole.scale && got.report.scale <= limit.max_slope,
                "{:?}",
                got.report
            );
            let before = baked(&image, &source.with_max_slope(UNLIMITED), &options(layout, bits));
            let power = |report: &roughcast::BakeReport| report.bounds.usable_specular_power();
            let factor = power(&got.report) / power(&before.report);
            assert!((factor / limit.factor - 1.0).abs() < WITHIN, "{layout} {bits}: {factor} for {limit:?}");
        }
    }
}

/// Rare steep texels of a gentle map are not flattened: they stay as steep as 45 degrees.
#[test]
fn the_automatic_limit_is_never_below_one() {
    let (image, source) = with_steep_texels(0.5, [9.0, 0.0]);
    for bits in UNSIGNED {
        let report = baked(&image, &source, &options(Layout::Lean, bits)).report;
        let limit = report.limit.expect("81 times the power");
        assert_eq!((limit.max_slope, limit.texels), (MaxSlope::LEAST_AUTOMATIC, 8));
        assert!((limit.factor / 81.0 - 1.0).abs() < 0.01, "{limit:?}");
        // The remaining gain is reported as advice.
        assert!(report.advice.is_some_and(|advice| advice.max_slope < 0.2));
    }
    let (image, source) = with_steep_texels(0.5, [1.5, 0.0]);
    assert_eq!(baked(&image, &source, &options(Layout::Lean, SampleType::U16)).report.limit, None);
}

#[test]
fn slopes_are_limited_only_if_a_range_requires_it() {
    let limit_of =
        |thousandths, direction, source: fn(SourceOptions) -> SourceOptions, options: BakeOptions| {
            let (image, plain) = steep_texels_among(2.0, thousandths, direction);
            let report = baked(&image, &source(plain), &options).report;
            (report.limit.is_some(), report.max_slope)
        };
    let auto: fn(SourceOptions) -> SourceOptions = |source| source;
    let (steep, lean) = ([40.0, 0.0], options(Layout::Lean, SampleType::U16));
    assert!(limit_of(0.5, steep, auto, lean).0);
    let any = (false, MaxSlope::OF_ANY_MAP);
    assert_eq!(limit_of(0.0, steep, auto, lean), any, "no steep texels");
    assert_eq!(limit_of(5.0, steep, auto, lean), any, "too many to be cut");
    for layout in RANGED {
        for bits in [SampleType::F16, SampleType::F32] {
            assert_eq!(limit_of(0.5, steep, auto, options(layout, bits)), any, "floats have no range");
        }
    }
    for bits in UNSIGNED {
        assert_eq!(limit_of(0.5, steep, auto, options(Layout::Pbr, bits)), any, "normals have no range");
    }
    let fixed = lean.with_scale(ScaleChoice::Fixed(50.0));
    assert_eq!(limit_of(0.5, steep, auto, fixed), (false, 50.0), "the range was chosen by hand");
    let by_hand: fn(SourceOptions) -> SourceOptions = |source| source.with_max_slope(MaxSlope::Limit(60.0));
    assert_eq!(limit_of(0.5, steep, by_hand, lean), (false, 60.0), "the limit was chosen by hand");
}

/// Everything that is rejected, with a word of its error.
#[test]
fn contradictory_options_are_refused() {
    let (image, source) = maps::plain_normal_map(8, 6, 56);
    let two_channels = maps::image(8, 6, 2, Samples::U8(vec![9; 96]));
    let three_channels = maps::image(8, 6, 3, Samples::U8(vec![9; 144]));
    let map = |image, channel| {
        Some(BaseRoughness::Map(RoughnessMap { image, channel, stored: RoughnessStored::Alpha }))
    };
    let base = Some(BaseRoughness::Variance(0.01));
    let with = |layout, bits| options(layout, bits);
    let plain = BakeOptions::default();
    let fixed = |scale| plain.with_scale(ScaleChoice::Fixed(scale));
    let blocks = |layout, bits| with(layout, bits).with_blocks(Blocks::Bc);
    let folded = plain.with_base(Base::Baked);
    let powers = PbrOptions::default().with_roughness_stored(RoughnessStored::SpecularPower);
    let power = with(Layout::Pbr, SampleType::U8).with_pbr(powers);
    let limited = |limit| source.with_max_slope(MaxSlope::Limit(limit));
    let steep = limited(300.0);
    type Case<'a> = (&'a str, &'a Image, SourceOptions, Option<BaseRoughness<'a>>, BakeOptions);
    let cases: Vec<Case<'_>> = vec![
        ("holds floats", &image, source, None, with(Layout::Moments, SampleType::U16)),
        ("holds floats", &image, source, None, with(Layout::BumpSlopes, SampleType::U8)),
        ("needs a roughness", &image, source, None, folded),
        ("needs a base roughness", &image, source, None, with(Layout::Toksvig, SampleType::U8)),
        ("specular powers", &image, source, None, power),
        ("no scale to choose", &image, source, None, fixed(1.0).with_sample_type(SampleType::F32)),
        ("above zero", &image, source, None, fixed(0.0)),
        ("above zero", &image, source, None, fixed(-1.0)),
        ("above zero", &image, source, None, fixed(f32::NAN)),
        ("above zero", &image, source, None, fixed(f32::INFINITY)),
        ("8 bits", &image, source, None, blocks(Layout::Variance, SampleType::U16)),
        ("cannot be block-compressed", &image, source, None, blocks(Layout::Lean, SampleType::U8)),
        ("cannot be block-compressed", &image, source, None, blocks(Layout::Clean, SampleType::U8)),
        ("cannot be block-compressed", &image, source, None, blocks(Layout::Schilling, SampleType::U8)),
        ("half float", &image, steep, None, with(Layout::Lean, SampleType::F16)),
        ("half float", &image, steep, None, with(Layout::Moments, SampleType::F16)),
        ("larger scale", &image, source, base, fixed(0.09).with_base(Base::Baked)),
        ("larger scale", &image, source, map(three_channels.view(), 1), fixed(0.02).with_base(Base::Baked)),
        ("finite and not negative", &image, source, Some(BaseRoughness::Variance(-1.0)), plain),
        ("finite and not negative", &image, source, Some(BaseRoughness::Variance(f32::NAN)), plain),
        ("4 channels or more", &image, source, map(three_channels.view(), 3), plain),
        ("3 channels or more", &two_channels, source, None, plain),
        ("4 channels or more", &three_channels, source.with_normal_channels(NormalChannels::Ag), None, plain),
        ("largest slope", &image, limited(0.0), None, plain),
        ("largest slope", &image, limited(f32::INFINITY), None, plain),
        ("largest slope", &image, limited(f32::NAN), None, plain),
        ("largest slope", &image, limited(f32::NAN), None, fixed(1.0)),
        ("largest slope", &image, limited(-1.0), None, plain),
        ("largest slope", &image, limited(1.001e9), None, plain),
        // Its square overflows, so that infinite slopes would pass.
        ("at most 1e9", &image, limited(2e19), None, plain),
        ("height scale", &image, source.with_height_scale(f32::NAN), None, plain),
    ];
    for (word, image, source, base, options) in cases {
        let error = Bake::of(image)
            .source(source)
            .roughness(base)
            .options(options)
            .run()
            .expect_err(word)
            .to_string();
        assert!(error.contains(word) && !error.contains('\n'), "'{error}' does not say '{word}'");
        assert!(!error.contains("--"), "'{error}' names an option of the program");
    }
    let error = Bake::of(&two_channels).source(source).options(plain).run().expect_err("two channels");
    let channels = SourceError::Channels { wanted: "normal map", needed: 3, got: 2 };
    assert_eq!(error, BakeError::Source(channels));
}

/// A half float's range limits slopes exactly as the source's own limit does.
#[test]
fn half_floats_represent_the_largest_slope_that_they_allow() {
    let (image, source) = maps::slope_map(2, 2, &[[255.0, 0.0], [0.0, 255.0], [-255.0, 0.0], [0.0, -300.0]]);
    let source = source.with_max_slope(MaxSlope::Limit(255.0));
    let half: Baked = baked(&image, &source, &options(Layout::Moments, SampleType::F16));
    let float = baked(&image, &source, &options(Layout::Moments, SampleType::F32));
    assert_eq!(half.report.counts.clamped, 1);
    let rounding = Rounding { count: 0.0005 / EPS, floor: 0.0 }; // eleven bits
    expect(compare_rounded(&raw_moments(&half), &raw_moments(&float), rounding).map(|_| ()), &"half");
}
