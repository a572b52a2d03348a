//! The physical form: a microfacet BRDF with Smith's shadowing and masking.

use std::f64::consts::{PI, TAU};

use roughcast::shading::{
    FootprintModel, FootprintRatio, Form, LightSample, Masking, Material, Shading, ShadingOptions, Surface,
    reflect,
};
use roughcast::texture::{Base, Layout, Packing, Part, RoughnessStored, TextureInfo};
use roughcast::{Covariance, Moments, Slope};

use super::oracle;
use super::support::{Frame, Random, Vector, dot, narrow, normalize, scaled, sum, surface_of_texels, wide};

/// Tolerance of G2 with the rational fit of Λ, whose G1 is off by at most 0.0035 (Walter et al., 2007, section 5.2): G2
/// contains two of them.
const FIT: f64 = 0.007;
/// Tolerance for single floats: that of the lobes in [`super::accuracy`], and a few roundings for GGX's Λ.
const ROUNDING: f64 = 2e-4;

/// Models whose lobe is that of microfacets.
const MODELS: [Shading; 4] = [Shading::BlinnPhong, Shading::Beckmann, Shading::OffCentre, Shading::Ggx];

fn options(specular_power: f32) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(specular_power).with_form(Form::Physical)
}

/// Λ of Gaussian slopes with this variance, by its definition: slopes beyond the direction's own hide it. `∫ (t - c)
/// p(t) dt / c` over slopes t beyond the cotangent c of the direction's angle, by Simpson's rule.
fn gaussian_lambda(variance: f64, axis: Vector, direction: Vector) -> f64 {
    const STEPS: u32 = 2000;
    let cosine = dot(axis, direction);
    let tangent = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    if tangent < 1e-9 {
        return 0.0;
    }
    let (start, deviation) = (1.0 / tangent, variance.sqrt());
    let step = 9.0 * deviation / f64::from(STEPS);
    let f = |t: f64| (t - start) * (-0.5 * t * t / variance).exp() / (deviation * TAU.sqrt());
    let simpson = |i: u32| {
        let t = start + f64::from(i) * step;
        (f(t) + 4.0 * f(t + 0.5 * step) + f(t + step)) * step / 6.0
    };
    (0..STEPS).map(simpson).sum::<f64>() / start
}

fn ggx_lambda(alpha: f64, axis: Vector, direction: Vector) -> f64 {
    let cosine = dot(axis, direction);
    let tangent_squared = (1.0 - cosine * cosine) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tangent_squared).sqrt() - 1.0)
}

/// The lobe of a bump in f64, by its definition.
fn expected(shading: Shading, slope: [f64; 2], s: f64, view: Vector, light: Vector) -> f64 {
    let normal = Frame::SURFACE.direction(slope);
    let h = normalize(sum(view, light));
    let alpha = (2.0 / s).sqrt();
    let form = Form::Normalised;
    let (distribution, axis) = match shading {
        Shading::BlinnPhong => (oracle::cosine_lobe(normal, h, s, form), normal),
        Shading::Beckmann => (oracle::beckmann(normal, s, h, form), normal),
        Shading::OffCentre => (oracle::gaussian(slope, [1.0 / s, 1.0 / s, 0.0], h, form), [0.0, 0.0, 1.0]),
        _ => (oracle::ggx(normal, [1.0, 0.0], [alpha; 2], h, form), normal),
    };
    let lambda = |direction| match shading {
        Shading::Ggx => ggx_lambda(alpha, axis, direction),
        _ => gaussian_lambda(1.0 / s, axis, direction),
    };
    distribution / (dot(axis, view) * (1.0 + lambda(view) + lambda(light)))
}

/// The largest relative difference of a model's lobe from its definition, near its peak.
fn difference(shading: Shading, s: f32, options: &ShadingOptions) -> f64 {
    let mut random = Random(5);
    let (mut counted, mut largest) = (0, 0.0_f64);
    let power = f64::from(s);
    for _ in 0..1000 {
        let slope = Slope { x: random.between(-0.5, 0.5) as f32, y: random.between(-0.5, 0.5) as f32 };
        let b = [f64::from(slope.x), f64::from(slope.y)];
        let offset = [0; 2].map(|_| random.between(-2.0, 2.0) / power.sqrt());
        let h = Frame::SURFACE.direction([b[0] + offset[0], b[1] + offset[1]]);
        let view = random.direction_above(0.02);
        let light = sum(scaled(h, 2.0 * dot(h, view)), scaled(view, -1.0));
        let (view, light) = (narrow(view), narrow(light));
        let normal = Frame::SURFACE.direction(b);
        if light[2] < 0.02 || dot(normal, wide(view)) < 0.02 || dot(normal, wide(light)) < 0.02 {
            continue;
        }
        let got = shading.surface_of_slope(slope, options).lobe(view, light, options);
        let expected = expected(shading, b, power, normalize(wide(view)), normalize(wide(light)));
        counted += 1;
        largest = largest.max((f64::from(got) / expected - 1.0).abs());
    }
    assert!(counted > 100, "only {counted} draws count");
    largest
}

#[test]
fn lobes_match_their_definitions_in_f64() {
    for shading in MODELS {
        for s in [4.0_f32, 64.0, 2048.0] {
            let tolerance = if shading == Shading::Ggx { ROUNDING } else { FIT };
            let found = difference(shading, s, &options(s));
            assert!(found < tolerance, "{shading}, s {s}: {found:e}");
            // Without masking, or with the terms of the older forms, they differ.
            let normalised = options(s).with_form(Form::Normalised);
            let found = difference(shading, s, &normalised);
            assert!(found > 10.0 * tolerance, "{shading}, s {s}: {found:e}");
        }
    }
}

fn texels(shading: Shading) -> Vec<[f32; 4]> {
    match shading {
        Shading::Lean => vec![[0.0, 0.0, 1.0, 0.0], [0.0; 4]],
        Shading::Toksvig => vec![[0.0, 0.0, 1.0, 1.0]],
        Shading::Clean | Shading::Variance => vec![[0.0; 4]],
        Shading::Ggx => vec![[0.0, 0.0, 1.0, 1.0], [0.0; 4]],
        _ => vec![[0.0, 0.0, 1.0, 0.0]],
    }
}

#[test]
fn a_flat_map_matches_the_microfacet_brdf_at_any_angle() {
    let s = 100.0_f32;
    let material = Material::default().with_albedo([0.0; 3]).with_ambient([0.0; 3]).with_specular([1.0; 3]);
    for shading in Shading::ALL.iter().copied().filter(|shading| *shading != Shading::Phong) {
        let surface = surface_of_texels(
            shading,
            &texels(shading),
            &FootprintRatio::WHOLE,
            &Packing::IDENTITY,
            &options(s),
        );
        for degrees in [0.0_f64, 30.0, 60.0, 80.0] {
            for offset in [0.0_f64, 3.0] {
                let direction = |degrees: f64, side: f64| {
                    let (sin, cos) = degrees.to_radians().sin_cos();
                    [side * sin, 0.0, cos]
                };
                let (view, light) = (direction(degrees, 1.0), direction(degrees - offset, -1.0));
                let sample = LightSample { direction: narrow(light), irradiance: [1.0; 3] };
                let got = reflect(&surface, &material, narrow(view), &sample, &options(s)).specular[0];
                let base =
                    if shading == Shading::Toksvig { Shading::BlinnPhong } else { shading.reference() };
                // F is one, and F D G2 / (4 n.v n.l) * n.l * E.
                let expected = expected(base, [0.0; 2], f64::from(s), view, light) / 4.0;
                let error = (f64::from(got) / expected - 1.0).abs();
                assert!(error < FIT, "{shading}, {degrees} degrees: {got} {expected}");
                if degrees == 60.0 && offset == 0.0 {
                    let older = options(s).with_form(Form::Normalised);
                    let older = reflect(&surface, &material, narrow(view), &sample, &older).specular[0];
                    assert!(f64::from(older) < 0.3 * expected, "{shading}: {older} {expected}");
                }
            }
        }
    }
}

/// Light that a white surface reflects towards a viewer under uniform incident radiance of one.
fn white_furnace(surface: &Surface, degrees: f64, options: &ShadingOptions) -> f64 {
    const STEPS: u32 = 300;
    let white = Material::default().with_albedo([0.0; 3]).with_ambient([0.0; 3]).with_specular([1.0; 3]);
    let (sin, cos) = degrees.to_radians().sin_cos();
    let view = [sin as f32, 0.0, cos as f32];
    let mut total = 0.0;
    for i in 0..STEPS {
        for j in 0..STEPS {
            let z = (f64::from(i) + 0.5) / f64::from(STEPS);
            let (sin, cos) = (TAU * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let light =
                LightSample { direction: narrow([radius * cos, radius * sin, z]), irradiance: [1.0; 3] };
            total += f64::from(reflect(surface, &white, view, &light, options).specular[0]);
        }
    }
    total * TAU / f64::from(STEPS * STEPS)
}

#[test]
fn a_white_surface_reflects_no_more_than_it_receives() {
    /// Tolerance of the quadrature, for a lobe that is 10 cells wide, and of the fit.
    const ERROR: f64 = 0.01;
    let furnace = |surface: &Surface, options: &ShadingOptions, what: &str| {
        for degrees in [0.0, 45.0, 75.0, 88.0] {
            let albedo = white_furnace(surface, degrees, options);
            assert!(albedo < 1.0 + ERROR && albedo > 0.1, "{what}, {degrees} degrees: {albedo}");
        }
    };
    for shading in Shading::ALL.iter().copied() {
        for s in [2.0_f32, 30.0, 500.0] {
            let options = options(s);
            let surface = shading.surface_of_slope(Slope::default(), &options);
            furnace(&surface, &options, &format!("{shading}, s {s}"));
        }
    }
    // With bumps, if both base and bumps mask.
    for sigma in [Covariance::isotropic(0.1), Covariance { xx: 0.4, yy: 0.01, xy: 0.03 }] {
        let options = options(200.0).with_masking(Masking::Full);
        let moments = Moments::from_mean_and_covariance(Slope::default(), sigma);
        let texels = [[0.0, 0.0, 1.0, moments.xy], [0.0, 0.0, moments.xx, moments.yy]];
        let surface =
            surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options);
        furnace(&surface, &options, &format!("{sigma:?}"));
        // If only the base masks, bumps are too bright at grazing angles, as in bump mapping.
        let base = options.with_masking(Masking::Base);
        assert!(white_furnace(&surface, 88.0, &base) > 1.0 + 10.0 * ERROR);
    }
}

#[test]
fn the_brdf_is_reciprocal() {
    let (view, light) = ([0.6_f32, 0.0, 0.8], [-0.1_f32, 0.3, 0.948_683_3]);
    let slope = Slope { x: 0.2, y: 0.05 };
    for shading in Shading::ALL.iter().copied() {
        for masking in Masking::ALL.iter().copied() {
            let options = options(40.0).with_masking(masking);
            let surface = shading.surface_of_slope(slope, &options);
            let axis = match shading.reference() {
                Shading::OffCentre => [0.0, 0.0, 1.0],
                _ => Frame::SURFACE.direction([f64::from(slope.x), f64::from(slope.y)]),
            };
            // The BRDF is the lobe divided by the light's cosine; for Phong it is the lobe.
            let cosines = match shading {
                Shading::Phong => [1.0; 2],
                _ => [view, light].map(|direction| dot(axis, wide(direction))),
            };
            let one = f64::from(surface.lobe(view, light, &options)) / cosines[1];
            let other = f64::from(surface.lobe(light, view, &options)) / cosines[0];
            assert!(one > 0.0 && (one / other - 1.0).abs() < ROUNDING, "{shading}: {one} {other}");
        }
    }
}

#[test]
fn bumps_facing_away_from_the_viewer_are_not_black() {
    // Seen from 80 degrees, a bump that is tilted away by 20 degrees; the light is behind it.
    let direction = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        narrow([sin, 0.0, cos])
    };
    let (view, light) = (direction(80.0), direction(-60.0));
    for shading in [Shading::BlinnPhong, Shading::Beckmann, Shading::Toksvig, Shading::Ggx] {
        let lobe = |degrees: f64| {
            let slope = Slope { x: degrees.to_radians().tan() as f32, y: 0.0 };
            shading.surface_of_slope(slope, &options(4.0)).lobe(view, light, &options(4.0))
        };
        let (towards, away) = (lobe(-9.0), lobe(-11.0));
        assert!(away > 0.0 && (towards / away - 1.0).abs() < 0.2, "{shading}: {towards} {away}");
    }
}

#[test]
fn all_slopes_mask_more_than_the_base_does() {
    let moments = Moments::from_mean_and_covariance(Slope::default(), Covariance::isotropic(0.1));
    let texels = [[0.0, 0.0, 1.0, moments.xy], [0.0, 0.0, moments.xx, moments.yy]];
    let lobe = |masking, z: f64| {
        let options = options(256.0).with_masking(masking);
        let surface =
            surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options);
        let x = (1.0 - z * z).sqrt();
        surface.lobe(narrow([x, 0.0, z]), narrow([-x, 0.0, z]), &options)
    };
    assert_eq!(lobe(Masking::Base, 1.0), lobe(Masking::Full, 1.0));
    assert!(lobe(Masking::Full, 0.2) < 0.8 * lobe(Masking::Base, 0.2));
}

#[test]
fn phong_reflects_all_light_along_the_reflected_ray() {
    let options = options(50.0);
    let surface = Shading::Phong.surface_of_slope(Slope::default(), &options);
    let lobe = f64::from(surface.lobe([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], &options));
    assert!((lobe / 4.0 * TAU / 51.0 - 1.0).abs() < ROUNDING, "{lobe}");
    let albedo = white_furnace(&surface, 0.0, &options);
    assert!((albedo - 1.0).abs() < 2e-3, "{albedo}");
}

#[test]
fn maps_bring_the_exponent_of_their_base() {
    let default = ShadingOptions::default();
    let baked = |layout, base_variance| TextureInfo {
        base: Base::Baked,
        base_variance,
        ..TextureInfo::new(layout, Part::Whole)
    };
    // Toksvig's factor is baked for one exponent.
    for layout in [Layout::Toksvig, Layout::Lean] {
        let options = default.for_maps(&baked(layout, 1.0 / 32.0));
        assert_eq!(options.specular_power, 32.0);
        assert_eq!((options.masking, options.footprint), (default.masking, default.footprint));
    }
    // For a varying base it is unknown which part of the variance it contributes.
    let varied = default.for_maps(&baked(Layout::Lean, 0.0));
    assert_eq!((varied.masking, varied.footprint), (Masking::Full, FootprintModel::Published));
    let none = default.for_maps(&TextureInfo::new(Layout::Lean, Part::Whole));
    assert_eq!(none, default);
}

#[test]
fn anisotropic_ggx_masks_along_the_viewers_direction() {
    let texel = [1.0, 0.0, 0.9, 1.0];
    let options = options(100.0);
    let packing =
        Packing { base: Base::Baked, roughness_stored: RoughnessStored::Alpha, ..Packing::IDENTITY };
    let texels = [[0.0, 0.0, 1.0, 1.0], [0.1; 4], texel];
    let surface = surface_of_texels(Shading::Ggx, &texels, &FootprintRatio::WHOLE, &packing, &options);
    let widths = [0.1 + 0.9 * 0.81, 0.1_f64];
    for (azimuth, alpha) in [(0.0, widths[0]), (0.5 * PI, widths[1])] {
        let (sin, cos) = 70.0_f64.to_radians().sin_cos();
        let view = [sin * f64::cos(azimuth), sin * f64::sin(azimuth), cos];
        let light = [-view[0], -view[1], cos];
        let up = [0.0, 0.0, 1.0];
        let distribution = 1.0 / (PI * widths[0] * widths[1]);
        let lambda = ggx_lambda(alpha, up, view);
        let expected = distribution / (cos * (1.0 + 2.0 * lambda));
        let got = f64::from(surface.lobe(narrow(view), narrow(light), &options));
        assert!((got / expected - 1.0).abs() < ROUNDING, "{azimuth}: {got} {expected}");
    }
}
