//! Models that must agree because one is a special case, or the limit, of another.

use roughcast::shading::{
    BaseFrame, FootprintRatio, Form, Shading, ShadingOptions, Surface, base_covariance,
};
use roughcast::texture::Packing;
use roughcast::{Covariance, Moments, Slope};

use super::support::{Frame, Random, dot, narrow, surface_of_texels};

/// Single floats: a few roundings of the moments, `2^-23` each, over the smallest variance compared, 1e-4.
const ROUNDING: f32 = 3e-3;

fn options(specular_power: f32) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(specular_power).with_form(Form::Normalised)
}

fn lean_texels(moments: Moments) -> [[f32; 4]; 2] {
    let Moments { mean, xx, yy, xy } = moments;
    [[0.0, 0.0, 1.0, xy], [mean.x, mean.y, xx, yy]]
}

/// The largest relative difference of two surfaces' lobes over directions about the slope where they are above a
/// thousandth of their peak.
fn difference(one: Surface, other: Surface, about: Slope, width: f64, options: &ShadingOptions) -> f32 {
    let centre = [f64::from(about.x), f64::from(about.y)];
    let at = |x: f64, y: f64| {
        let h = narrow(Frame::SURFACE.direction([centre[0] + x * width, centre[1] + y * width]));
        (one.lobe(h, h, options), other.lobe(h, h, options))
    };
    let peak = at(0.0, 0.0).0;
    let steps = || (-12..=12).map(|i| 0.25 * f64::from(i));
    let pairs = steps().flat_map(|x| steps().map(move |y| (x, y))).map(|(x, y)| at(x, y));
    let near = pairs.filter(|(a, _)| *a > 1e-3 * peak).collect::<Vec<_>>();
    assert!(near.len() > 100, "only {} directions are near the peak", near.len());
    near.into_iter().map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f32::max)
}

#[test]
fn lean_at_the_finest_level_is_off_centre_beckmann() {
    let mut random = Random(3);
    for s in [8.0_f32, 256.0, 10_000.0] {
        for base in BaseFrame::ALL.iter().copied() {
            let options = options(s).with_base_frame(base);
            for _ in 0..20 {
                let slope =
                    Slope { x: random.between(-1.0, 1.0) as f32, y: random.between(-1.0, 1.0) as f32 };
                let texels = lean_texels(Moments::of_slope(slope));
                let lean = surface_of_texels(
                    Shading::Lean,
                    &texels,
                    &FootprintRatio::WHOLE,
                    &Packing::IDENTITY,
                    &options,
                );
                let bump = Shading::Lean.surface_of_slope(slope, &options);
                let width = 1.0 / f64::from(s).sqrt();
                let found = difference(lean, bump, slope, width, &options);
                assert!(found < ROUNDING, "s {s}, {slope:?}: {found}");
            }
        }
    }
}

#[test]
fn clean_is_lean_for_isotropic_bumps_and_variance_is_lean_without_mixed_terms() {
    let mean = Slope { x: 0.4, y: -0.3 };
    let options = options(512.0);
    let [round, straight, slanted] = [
        Covariance { xx: 0.02, yy: 0.02, xy: 0.0 },
        Covariance { xx: 0.03, yy: 0.004, xy: 0.0 },
        Covariance { xx: 0.03, yy: 0.02, xy: 0.015 },
    ];
    let lean = |sigma| {
        let texels = lean_texels(Moments::from_mean_and_covariance(mean, sigma));
        surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options)
    };
    let clean = |sigma: Covariance| {
        let trace = sigma.trace() + mean.x * mean.x + mean.y * mean.y;
        surface_of_texels(
            Shading::Clean,
            &[[mean.x, mean.y, trace, 1.0]],
            &FootprintRatio::WHOLE,
            &Packing::IDENTITY,
            &options,
        )
    };
    let variance = |sigma: Covariance| {
        let texel = [mean.x, mean.y, sigma.xx, sigma.yy];
        surface_of_texels(Shading::Variance, &[texel], &FootprintRatio::WHOLE, &Packing::IDENTITY, &options)
    };
    let of = |one, other| difference(one, other, mean, 0.1, &options);
    assert!(of(lean(round), clean(round)) < ROUNDING);
    assert!(of(lean(straight), variance(straight)) < ROUNDING);
    // The terms that each model omits make a difference.
    assert!(of(lean(straight), clean(straight)) > 0.1);
    assert!(of(lean(slanted), variance(slanted)) > 0.1);
}

#[test]
fn lobes_turn_with_the_bumps() {
    let (sin, cos) = 0.7_f32.sin_cos();
    let turn = |[x, y]: [f32; 2]| [cos * x - sin * y, sin * x + cos * y];
    let turn3 = |[x, y, z]: [f32; 3]| {
        let [x, y] = turn([x, y]);
        [x, y, z]
    };
    let (view, light) = ([0.28, -0.1, 0.954_777_5], [0.15, 0.1, 0.983_615_8]);
    let options = options(200.0);
    for shading in Shading::ALL {
        let [x, y] = turn([0.2, 0.05]);
        let plain = shading.surface_of_slope(Slope { x: 0.2, y: 0.05 }, &options).lobe(view, light, &options);
        let turned = shading.surface_of_slope(Slope { x, y }, &options);
        let turned = turned.lobe(turn3(view), turn3(light), &options);
        assert!(plain > 0.1 && (plain / turned - 1.0).abs() < ROUNDING, "{shading}: {plain} {turned}");
    }
    // The same for LEAN with bumps: R Σ Rᵀ.
    let sigma = Covariance { xx: 0.03, yy: 0.005, xy: 0.004 };
    let turned_sigma = Covariance {
        xx: cos * cos * sigma.xx - 2.0 * sin * cos * sigma.xy + sin * sin * sigma.yy,
        yy: sin * sin * sigma.xx + 2.0 * sin * cos * sigma.xy + cos * cos * sigma.yy,
        xy: sin * cos * (sigma.xx - sigma.yy) + (cos * cos - sin * sin) * sigma.xy,
    };
    let lean = |[x, y]: [f32; 2], sigma| {
        let texels = lean_texels(Moments::from_mean_and_covariance(Slope { x, y }, sigma));
        surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options)
    };
    let plain = lean([0.2, 0.05], sigma).lobe(view, light, &options);
    let turned = lean(turn([0.2, 0.05]), turned_sigma).lobe(turn3(view), turn3(light), &options);
    assert!((plain / turned - 1.0).abs() < ROUNDING, "{plain} {turned}");
    let unturned_bumps = lean(turn([0.2, 0.05]), sigma).lobe(turn3(view), turn3(light), &options);
    assert!((plain / unturned_bumps - 1.0).abs() > 0.05);
}

#[test]
fn lobes_are_reciprocal() {
    let (view, light) = ([0.28, -0.1, 0.954_777_5], [0.15, 0.1, 0.983_615_8]);
    let options = options(200.0);
    for shading in Shading::ALL {
        let surface = shading.surface_of_slope(Slope { x: 0.2, y: 0.05 }, &options);
        let (one, other) = (surface.lobe(view, light, &options), surface.lobe(light, view, &options));
        assert!((one / other - 1.0).abs() < 1e-4, "{shading}: {one} {other}");
    }
}

/// The Jacobian J of the map from slopes about a facet to slopes of the surface, at the facet: J Jᵀ is the facet's base
/// except for the factor 1 / s.
#[test]
fn the_base_of_a_facet_is_a_rotated_round_lobe() {
    const STEP: f64 = 1e-5;
    for slope in [[0.0, 0.0], [1.0, 0.0], [0.3, -0.8], [2.0, 1.0]] {
        let frame = Frame::about(Frame::SURFACE.direction(slope));
        let surface_slope = |local: [f64; 2]| {
            let [x, y, z] = frame.direction(local);
            [x / z, y / z]
        };
        let column = |step: [f64; 2]| {
            let (ahead, back) = (surface_slope(step), surface_slope(step.map(|v| -v)));
            [0, 1].map(|i| (ahead[i] - back[i]) / (2.0 * STEP))
        };
        let (u, v) = (column([STEP, 0.0]), column([0.0, STEP]));
        let found = [u[0] * u[0] + v[0] * v[0], u[1] * u[1] + v[1] * v[1], u[0] * u[1] + v[0] * v[1]];
        let facet = options(1.0).with_base_frame(BaseFrame::Facet);
        let base = base_covariance(Slope { x: slope[0] as f32, y: slope[1] as f32 }, &facet);
        for (found, base) in found.into_iter().zip([base.xx, base.yy, base.xy]) {
            assert!((found - f64::from(base)).abs() < 1e-4, "{slope:?}: {found} {base}");
        }
        // The variances that the documentation of `BaseFrame` promises: (1 + B²)² along B, (1 + B²) across.
        let squared = slope[0] * slope[0] + slope[1] * slope[1];
        let (along, across) = base.eigenvalues();
        assert!((f64::from(along) / (1.0 + squared).powi(2) - 1.0).abs() < 1e-5);
        assert!((f64::from(across) / (1.0 + squared) - 1.0).abs() < 1e-5);
    }
}

/// The largest difference, within two standard deviations, between the densities over solid angle of an off-centre lobe
/// and of Beckmann's lobe about the bump, relative to the latter.
fn against_the_bumps_own(base: BaseFrame, s: f32) -> f64 {
    let options = options(s).with_base_frame(base);
    let slope = Slope { x: 0.8, y: -0.4 };
    let normal = Frame::SURFACE.direction([0.8_f32.into(), (-0.4_f32).into()]);
    let frame = Frame::about(normal);
    let off_centre = Shading::OffCentre.surface_of_slope(slope, &options);
    let beckmann = Shading::Beckmann.surface_of_slope(slope, &options);
    let mut largest = 0.0_f64;
    for i in 0..200 {
        let angle = f64::from(i) * 2.4;
        let radius = 2.0 * (f64::from(i) / 200.0).sqrt() / f64::from(s).sqrt();
        let h = frame.direction([radius * angle.cos(), radius * angle.sin()]);
        let value = |surface: Surface| f64::from(surface.lobe(narrow(h), narrow(h), &options));
        let ratio = value(off_centre) * h[2] / (value(beckmann) * dot(normal, h));
        largest = largest.max((ratio - 1.0).abs());
    }
    largest
}

#[test]
fn the_base_of_a_facet_converges_to_beckmann_about_the_bump() {
    // They agree to first order: the remainder falls with the lobe's width, 1 / sqrt(s).
    let left = [100.0, 1600.0, 25_600.0].map(|s| against_the_bumps_own(BaseFrame::Facet, s));
    assert!(left[1] < 0.3 * left[0] && left[2] < 0.3 * left[1], "{left:?}");
    // LEAN's own base does not converge: at this slope of 0.9 it stays too narrow.
    let plane = [100.0, 1600.0, 25_600.0].map(|s| against_the_bumps_own(BaseFrame::Plane, s));
    assert!(plane.iter().all(|left| *left > 0.5), "{plane:?}");
}
