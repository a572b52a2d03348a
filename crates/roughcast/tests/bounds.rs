//! The stated bounds of every layout in every type hold on every texel of every level, and are not too loose.

mod common;

use common::compare::{EPS, check_semidefinite, expect};
use common::level::{Level, Plane, Texel, decoded, eigenvalues, raw_lean, raw_moments};
use common::maps::{self, Random};
use common::{baked_with, options, pyramid_oracle, real_files, slope_oracle};
use roughcast::texture::{Base, Layout, RoughnessStored};
use roughcast::{
    AnisotropyOutput, BakeOptions, BakeReport, Baked, BaseRoughness, Blocks, Image, Kind, PbrOptions,
    PyramidFilter, RoughnessTexture, SampleType, SourceOptions,
};

/// Moments are computed in single floats: this many roundings of a texel's rms are added to a bound.
const AVERAGING: f64 = 24.0;

/// `M = Σ + B Bᵀ` is rounded to single floats when decoded: each of its three components once or twice.
const SEMIDEFINITE: f64 = 4.0;

struct Map {
    name: &'static str,
    image: Image,
    source: SourceOptions,
}

fn maps() -> Vec<Map> {
    let (wavy, wavy_source) = maps::plain_normal_map(96, 40, 41);
    let gentle: Vec<[f64; 2]> = maps::slopes(53, 37, 42).into_iter().map(|b| b.map(|v| 0.06 * v)).collect();
    let (gentle, gentle_source) = maps::slope_map(53, 37, &gentle);
    let mut random = Random(43);
    let steep = |random: &mut Random| [6.0 * random.signed(), 4.0 * random.signed()];
    let steep: Vec<[f64; 2]> = (0..64 * 64).map(|_| steep(&mut random)).collect();
    let (steep, steep_source) = maps::slope_map(64, 64, &steep);
    let (flat, flat_source) = maps::slope_map(16, 12, &[[0.0, 0.0]; 16 * 12]);
    // Brushed metal: hardly any variance across the grooves, where the square root amplifies rounding.
    let mut groove = |x: usize| [if x.is_multiple_of(2) { 0.6 } else { -0.6 }, 0.002 * random.signed()];
    let grooves: Vec<[f64; 2]> = (0..48 * 48).map(|i| groove(i % 48)).collect();
    let (grooves, grooves_source) = maps::slope_map(48, 48, &grooves);
    let (one, one_source) = maps::slope_map(1, 1, &[[0.4, -0.9]]);
    let heights = SourceOptions::default().with_kind(Kind::Height);
    let real = |name, path, source| Map { name, image: real_files::read_part(path, 150), source };
    vec![
        Map { name: "wavy", image: wavy, source: wavy_source },
        Map { name: "gentle", image: gentle, source: gentle_source },
        Map { name: "steep", image: steep, source: steep_source },
        Map { name: "grooves", image: grooves, source: grooves_source },
        Map { name: "flat", image: flat, source: flat_source },
        Map { name: "one texel", image: one, source: one_source },
        real(
            "ocean",
            "materials/surfgrad_ocean16/normals_64crop_16bit_derived.png",
            SourceOptions::default(),
        ),
        real("cube", "materials/parallax_cube/cube_normal.png", SourceOptions::default()),
        real("brick heights", "materials/brickwall_jme/BrickWall_height.jpg", heights),
    ]
}

/// A set of bake options and a base.
#[derive(Clone, Copy, Debug)]
struct Case {
    options: BakeOptions,
    /// Slope variance of the base.
    base: Option<f32>,
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for bits in SampleType::ALL {
        for layout in Layout::ALL {
            let float_only = matches!(layout, Layout::Moments | Layout::BumpSlopes);
            if float_only && !bits.is_float() {
                continue;
            }
            let options = options(*layout, *bits);
            match layout {
                Layout::Toksvig => cases.push(Case { options, base: Some(0.01) }),
                Layout::Pbr => cases.extend(material_cases(options)),
                _ => {
                    let baked = options.with_base(Base::Baked);
                    cases.extend([Case { options, base: None }, Case { options: baked, base: Some(0.01) }]);
                }
            }
        }
    }
    for layout in [Layout::Variance, Layout::Toksvig, Layout::Pbr] {
        let options = options(layout, SampleType::U8).with_blocks(Blocks::Bc);
        cases.push(Case { options, base: (layout != Layout::Variance).then_some(0.01) });
    }
    cases
}

fn material_cases(options: BakeOptions) -> Vec<Case> {
    let mut cases = Vec::new();
    for stored in RoughnessStored::ALL {
        if *stored == RoughnessStored::SpecularPower && !options.sample_type.is_float() {
            continue;
        }
        for anisotropy in [None, Some(AnisotropyOutput::Khr)] {
            for base in [None, Some(0.01)] {
                let pbr = PbrOptions::default().with_roughness_stored(*stored).with_anisotropy(anisotropy);
                let options = options.with_pbr(pbr);
                cases.push(Case { options, base });
            }
        }
    }
    let pbr = PbrOptions::default().with_roughness_texture(RoughnessTexture::Packed);
    let packed = options.with_pbr(pbr);
    cases.push(Case { options: packed, base: None });
    cases
}

/// What a layout guarantees for a texel: its mean slope, then the values that the bound on variances applies to.
struct Promise {
    slope: [f64; 2],
    variances: Vec<f64>,
    /// The full covariance, if the layout stores it.
    covariance: Option<[f64; 3]>,
}

/// Limits a variance to what can be stored. Widths above one do not fit into 0 ..= 1, and the bounds cover only
/// storable values.
fn storable(case: &Case, variance: f64) -> f64 {
    let unlimited = case.options.pbr.roughness_stored == RoughnessStored::SpecularPower;
    if unlimited { variance } else { variance.min(0.5) }
}

fn promised(case: &Case, texel: Texel, normal: [f64; 3]) -> Promise {
    let c = texel.covariance();
    let half_trace = (c[0] + c[1]) / 2.0;
    let plain = |variances, covariance| Promise { slope: texel.b, variances, covariance };
    match case.options.layout {
        Layout::Lean | Layout::Moments | Layout::BumpSlopes | Layout::Schilling => {
            plain(vec![c[0], c[1]], Some(c))
        }
        Layout::Variance => plain(vec![c[0], c[1]], None),
        Layout::Clean => plain(vec![half_trace], None),
        Layout::SchillingIsotropic => plain(vec![eigenvalues(c).0], None),
        Layout::Pbr if case.options.pbr.anisotropy.is_none() => plain(vec![storable(case, half_trace)], None),
        // Strength is a ratio of widths, which are at most one.
        Layout::Pbr if eigenvalues(c).0 <= 0.5 => plain(vec![c[0], c[1]], Some(c)),
        Layout::Pbr => plain(vec![], None),
        Layout::Toksvig => {
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt().min(1.0);
            let slope = [normal[0] / normal[2], normal[1] / normal[2]];
            Promise { slope, variances: vec![(1.0 - length) / length], covariance: None }
        }
        layout => panic!("say what {layout} promises"),
    }
}

/// The same values of a decoded texel.
fn given(case: &Case, texel: Texel, promise: &Promise) -> Vec<f64> {
    let c = texel.covariance();
    match case.options.layout {
        Layout::Clean | Layout::SchillingIsotropic | Layout::Toksvig => vec![c[0]],
        Layout::Pbr if case.options.pbr.anisotropy.is_none() => vec![storable(case, c[0])],
        _ => c[..promise.variances.len()].to_vec(),
    }
}

/// Worst errors, as fractions of the allowed error.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    slope: f64,
    variance: f64,
    eigenvalue: f64,
}

fn check(
    map: &Map,
    case: &Case,
    report: &BakeReport,
    got: &[Level],
    wanted: &[Level],
    normals: &[[Plane; 3]],
) -> Worst {
    let mut worst = Worst::default();
    let bounds = report.bounds;
    for (number, (got, wanted)) in got.iter().zip(wanted).enumerate() {
        for (index, (got, wanted)) in got.texels().zip(wanted.texels()).enumerate() {
            let normal = std::array::from_fn(|k| normals[number][k].values[index]);
            let promise = promised(case, wanted, normal);
            let rounding = AVERAGING * EPS * (wanted.rms() + 1.0);
            let what =
                || format!("{} {case:?} level {number} texel {index}: {got:?} for {wanted:?}", map.name);
            let keep = |error: f64, bound: f32, name: &str| {
                // The float pyramid's own rounding. M's rounding is at most twice that of B's slope, times B.
                let allowed = f64::from(bound) + rounding * (1.0 + wanted.rms());
                assert!(error <= allowed, "{name} off by {error:e} > {allowed:e}, {}", what());
                error / allowed
            };
            for (g, w) in got.b.iter().zip(&promise.slope) {
                worst.slope = worst.slope.max(keep((g - w).abs(), bounds.slope, "slope"));
            }
            for (g, w) in given(case, got, &promise).iter().zip(&promise.variances) {
                worst.variance = worst.variance.max(keep((g - w).abs(), bounds.variance, "variance"));
            }
            if let Some(covariance) = promise.covariance {
                let (g, w) = (eigenvalues(got.covariance()), eigenvalues(covariance));
                for error in [g.0 - w.0, g.1 - w.1] {
                    worst.eigenvalue =
                        worst.eigenvalue.max(keep(error.abs(), bounds.eigenvalue, "eigenvalue"));
                }
            }
        }
    }
    worst
}

/// Factors by which bounds may exceed the worst error on a map, each at most twice the measured one.
fn loosest(case: &Case) -> Worst {
    let BakeOptions { sample_type: bits, layout, pbr, .. } = case.options;
    let slope = match bits {
        // Some texel is off by half a code.
        SampleType::U8 => 1.1,
        // The bound also includes roundings of the float pyramid.
        SampleType::U16 => 1.5,
        // A half float's rounding is proportional to the value; the bound assumes the largest value that the scale
        // allows.
        SampleType::F16 | SampleType::F32 => 3.0,
    };
    let variance = match (layout, bits) {
        // The bound on a variance adds the errors of all its inputs; no texel has all of them at once.
        (Layout::Pbr, _) => material_variance(&pbr, bits),
        (_, SampleType::F16 | SampleType::F32) => 4.0,
        _ => 2.5,
    };
    // Both variances and the mixed term are off at once.
    Worst { slope, variance, eigenvalue: 4.0 }
}

/// The bounds of a material assume the roughness between zero and one that has the largest error, which no map here
/// reaches by itself.
fn material_variance(pbr: &PbrOptions, bits: SampleType) -> f64 {
    let half = matches!(bits, SampleType::F16 | SampleType::F32);
    match (pbr.anisotropy, pbr.roughness_stored) {
        // The bound combines a half float's coarsest rounding, near a gloss of one, with the fastest change of the
        // variance, near zero. No gloss has both.
        (None, RoughnessStored::Gloss) if half => 12.0,
        (None, _) => 4.5,
        // The bound assumes the square root of a half float's rounding, an error that only the width of a mirror
        // reaches.
        (Some(_), RoughnessStored::AlphaSquared) if half => 20.0,
        (Some(_), RoughnessStored::SpecularPower) => 12.0,
        (Some(_), _) => 7.0,
    }
}

/// The name of a bound that is too wide for the worst error; `worst` is given as fractions of the bounds.
fn wide_bound(case: &Case, worst: Worst) -> Option<&'static str> {
    let loosest = loosest(case);
    let has_eigenvalues = matches!(case.options.layout, Layout::Lean | Layout::Schilling);
    // Not `<`: that would let NaN pass.
    let is_near = |worst: f64, loosest: f64| worst * loosest >= 1.0;
    match () {
        () if !is_near(worst.slope, loosest.slope) => Some("slope"),
        () if !is_near(worst.variance, loosest.variance) => Some("variance"),
        () if has_eigenvalues && !is_near(worst.eigenvalue, loosest.eigenvalue) => Some("eigenvalue"),
        () => None,
    }
}

#[test]
fn too_wide_bounds_are_detected() {
    for case in cases() {
        let Worst { slope, variance, eigenvalue } = loosest(&case);
        let near = Worst { slope: 1.0 / slope, variance: 1.0 / variance, eigenvalue: 1.0 / eigenvalue };
        assert_eq!(wide_bound(&case, Worst { slope: 1.0, variance: 1.0, eigenvalue: 1.0 }), None);
        assert_eq!(wide_bound(&case, Worst { slope: 0.9 * near.slope, ..near }), Some("slope"));
        assert_eq!(
            wide_bound(&case, Worst { slope: 1.0, variance: f64::NAN, eigenvalue: 1.0 }),
            Some("variance")
        );
        // A bound twice as large as the error is detected in types whose error is dominated by half a code.
        let doubled = Worst { slope: 0.5, variance: 0.5, eigenvalue: 0.5 };
        if case.options.sample_type == SampleType::U8 {
            assert_eq!(wide_bound(&case, doubled), Some("slope"), "{case:?}");
        }
    }
}

/// Checks the covariance along every direction, including the mixed term, before the decoder makes it semidefinite.
fn check_before_repair(baked: &Baked, case: &Case, wanted: &[Level]) {
    let raw = match case.options.layout {
        Layout::Lean => raw_lean(baked),
        Layout::Moments => raw_moments(baked),
        _ => return,
    };
    for (got, wanted) in raw.iter().zip(wanted) {
        for (got, wanted) in got.texels().zip(wanted.texels()) {
            let (g, w) = (got.covariance(), wanted.covariance());
            let (most, least) = eigenvalues([g[0] - w[0], g[1] - w[1], g[2] - w[2]]);
            let rounding = AVERAGING * EPS * (1.0 + wanted.rms()).powi(2);
            let allowed = f64::from(baked.report.bounds.eigenvalue) + rounding;
            assert!(most.abs().max(least.abs()) <= allowed, "{case:?}: {got:?} for {wanted:?}");
        }
    }
}

/// Averages of the unit normals of level 0.
fn averaged_normals(slopes: &slope_oracle::Slopes, source: &SourceOptions) -> Vec<[Plane; 3]> {
    let pyramids: [Vec<Plane>; 3] = std::array::from_fn(|component| {
        let unit = |b: &[f64; 2]| [b[0], b[1], 1.0][component] / (1.0 + b[0] * b[0] + b[1] * b[1]).sqrt();
        let values = slopes.texels.iter().map(unit).collect();
        let plane = Plane { width: slopes.width, height: slopes.height, values };
        pyramid_oracle::pyramid(plane, PyramidFilter::Box, source.wrap)
    });
    (0..pyramids[0].len()).map(|level| std::array::from_fn(|k| pyramids[k][level].clone())).collect()
}

#[test]
fn decoded_files_are_within_tight_bounds() {
    let cases = cases();
    let mut worst = vec![Worst::default(); cases.len()];
    for map in maps() {
        let slopes = slope_oracle::slopes(&map.image, &map.source);
        let normals = averaged_normals(&slopes, &map.source);
        let moments = |base: f32| {
            let base = vec![f64::from(base); slopes.texels.len()];
            pyramid_oracle::moments(&slopes, &base, PyramidFilter::Box, map.source.wrap)
        };
        let (bare, based) = (moments(0.0), moments(0.01));
        for (case, worst) in cases.iter().zip(&mut worst) {
            let base = case.base.map(BaseRoughness::Variance);
            let baked = baked_with(&map.image, &map.source, base, &case.options);
            let folded = case.options.base == Base::Baked || case.options.layout == Layout::Pbr;
            let wanted = if folded && base.is_some() { &based } else { &bare };
            let got = decoded(&baked.arrays);
            expect(check_semidefinite(&got, SEMIDEFINITE), &(map.name, case));
            let here = check(&map, case, &baked.report, &got, wanted, &normals);
            check_before_repair(&baked, case, wanted);
            worst.slope = worst.slope.max(here.slope);
            worst.variance = worst.variance.max(here.variance);
            worst.eigenvalue = worst.eigenvalue.max(here.eigenvalue);
        }
    }
    for (case, worst) in cases.iter().zip(&worst).filter(|(case, _)| !case.options.sample_type.is_float()) {
        assert_eq!(wide_bound(case, *worst), None, "{case:?}: {worst:?}");
    }
}
