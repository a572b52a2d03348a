//! Radiance: the parts of the equation, and the case in which its two forms agree.

use std::f32::consts::PI;

use roughcast::Slope;
use roughcast::shading::{
    Form, LightSample, Material, Shading, ShadingOptions, ambient_radiance, diffuse_radiance, reflect,
    schlick,
};

/// A handful of f32 roundings, relative.
const ROUNDING: f32 = 1e-6;

const UP: [f32; 3] = [0.0, 0.0, 1.0];

fn material() -> Material {
    Material::default()
        .with_albedo([0.5, 0.25, 0.1])
        .with_ambient([0.2, 0.1, 0.0])
        .with_specular([0.04, 0.5, 1.0])
}

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() <= ROUNDING * b.abs()
}

#[test]
fn fresnel_goes_from_its_given_value_to_one() {
    assert_eq!(schlick(0.04, 1.0), 0.04);
    assert!(close(schlick(0.04, 0.0), 1.0));
    assert!(close(schlick(0.0, 0.5), 1.0 / 32.0));
    assert_eq!(schlick(1.0, 0.3), 1.0);
    // A cosine that rounding has made larger than one does not change the result.
    assert_eq!(schlick(0.04, 1.000_000_1), 0.04);
}

#[test]
fn diffuse_light_takes_the_normal_at_its_length() {
    let irradiance = [PI, 2.0 * PI, 0.0];
    let full = diffuse_radiance(UP, [0.5; 3], UP, irradiance);
    assert!(close(full[0], 0.5) && close(full[1], 1.0) && full[2] == 0.0);
    let averaged = diffuse_radiance([0.0, 0.0, 0.8], [0.5; 3], UP, irradiance);
    assert!(close(averaged[0], 0.4));
    // A bump that faces away, and light from below the surface on a bump that faces it.
    assert_eq!(diffuse_radiance([-0.8, 0.0, 0.6], [0.5; 3], [0.8, 0.0, 0.6], irradiance), [0.0; 3]);
    assert_eq!(diffuse_radiance([0.8, 0.0, 0.6], [0.5; 3], [0.8, 0.0, -0.6], irradiance), [0.0; 3]);
    assert_eq!(ambient_radiance([0.5, 0.25, 0.1], [0.2, 0.1, 0.0]), [0.1, 0.025, 0.0]);
}

#[test]
fn the_forms_agree_where_eye_light_and_normal_meet() {
    let light = LightSample { direction: UP, irradiance: [1.0, 2.0, 3.0] };
    for shading in [Shading::Beckmann, Shading::OffCentre, Shading::Ggx] {
        let specular = |form| {
            let options = ShadingOptions::default().with_form(form).with_specular_power(500.0);
            let surface = shading.surface_of_slope(Slope::default(), &options);
            reflect(&surface, &material(), UP, &light, &options).specular
        };
        let normalised = specular(Form::Normalised);
        for form in [Form::Paper, Form::Physical] {
            let other = specular(form);
            for (a, b) in other.into_iter().zip(normalised) {
                assert!(a > 0.0 && close(a, b), "{shading}, {form}: {other:?} {normalised:?}");
            }
        }
    }
}

#[test]
fn specular_light_is_cook_and_torrances_without_masking() {
    let (view, direction) = ([0.6, 0.0, 0.8], [-0.28, 0.0, 0.96]);
    let options = ShadingOptions::default().with_form(Form::Normalised).with_specular_power(20.0);
    let surface = Shading::Beckmann.surface_of_slope(Slope { x: 0.1, y: 0.0 }, &options);
    let lobe = surface.lobe(view, direction, &options);
    let light = LightSample { direction, irradiance: [1.0, 2.0, 3.0] };
    let radiance = reflect(&surface, &material(), view, &light, &options);
    let half = [0.32_f32, 0.0, 1.76];
    let cosine = (0.6 * half[0] + 0.8 * half[2]) / half[0].hypot(half[2]);
    for i in 0..3 {
        let fresnel = schlick(material().specular[i], cosine);
        // F D G / (4 n.l n.v) n.l E, with G = n.l n.v.
        let expected = fresnel * lobe / 4.0 * direction[2] * light.irradiance[i];
        assert!((radiance.specular[i] / expected - 1.0).abs() < 1e-5, "{radiance:?} {expected}");
    }
    assert_eq!(
        radiance.diffuse,
        diffuse_radiance(surface.normal, material().albedo, direction, light.irradiance)
    );
}

#[test]
fn a_white_surface_reflects_no_more_than_it_receives() {
    // The normalised form integrated over all lights, for one viewer: F = 1, no masking, so at most the area that faces
    // the viewer.
    const STEPS: u32 = 400;
    let white = Material::default().with_albedo([0.0; 3]).with_ambient([0.0; 3]).with_specular([1.0; 3]);
    let view = [0.6, 0.0, 0.8];
    let options = ShadingOptions::default().with_form(Form::Normalised).with_specular_power(200.0);
    for shading in [Shading::Beckmann, Shading::OffCentre, Shading::BlinnPhong, Shading::Ggx] {
        let surface = shading.surface_of_slope(Slope::default(), &options);
        let mut total = 0.0_f64;
        for i in 0..STEPS {
            for j in 0..STEPS {
                let z = (i as f32 + 0.5) / STEPS as f32;
                let angle = (j as f32 + 0.5) / STEPS as f32 * std::f32::consts::TAU;
                let radius = (1.0 - z * z).sqrt();
                let direction = [radius * angle.cos(), radius * angle.sin(), z];
                let light = LightSample { direction, irradiance: [1.0; 3] };
                total += f64::from(reflect(&surface, &white, view, &light, &options).specular[0]);
            }
        }
        let albedo = total * std::f64::consts::TAU / f64::from(STEPS * STEPS);
        assert!(albedo < 1.0 && albedo > 0.5, "{shading}: {albedo}");
    }
}
