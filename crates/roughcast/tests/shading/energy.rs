//! Normalised lobes integrate to one over the projected solid angle of their own axis.

use std::f64::consts::TAU;

use roughcast::Slope;
use roughcast::shading::{
    BaseFrame, FootprintRatio, Form, ModelSurface, Shading, ShadingOptions, Surface, Wanted,
    beckmann_surface, blinn_phong_surface, gaussian_lobe, ggx_surface, mixture_surface, phong_surface,
    slope_gaussian,
};
use roughcast::texture::{
    Base, Layout, Packing, RoughnessStored, TextureInfo, layers_of, normal_moments, pbr_moments,
};
use roughcast::{Anisotropy, Covariance, Distribution, MAX_GAUSSIANS, WeightedGaussian};

use super::oracle::reflected;
use super::support::{Frame, Vector, narrow, surface_of_texels};

/// Tolerance of an integral: the quadrature of GGX's tail, which falls slowest, is accurate to 2e-5, and single floats
/// add as much at s = 16384.
const TOLERANCE: f64 = 1e-4;

/// Rings and spokes of the quadrature.
const RINGS: u32 = 600;
const SPOKES: u32 = 96;

const POWERS: [f32; 6] = [1.0, 8.0, 64.0, 1024.0, 13_777.0, 16_384.0];

/// Integral of `lobe(h) cosθ dω` over all directions `h` of a frame's hemisphere, where θ is the angle to the frame's
/// normal: over slopes it is `lobe cos⁴θ` times the area.
///
/// Integrates over ellipses about `centre` with half axes along `axes`, from zero to infinity: their size is t / (1 -
/// t).
fn integral(frame: &Frame, centre: [f64; 2], axes: [[f64; 2]; 2], lobe: impl Fn(Vector) -> f64) -> f64 {
    let [a, b] = axes;
    let area = (a[0] * b[1] - a[1] * b[0]).abs();
    let mut total = 0.0;
    for ring in 0..RINGS {
        let t = (f64::from(ring) + 0.5) / f64::from(RINGS);
        let size = t / (1.0 - t);
        let weight = area * size / (1.0 - t).powi(2) / f64::from(RINGS) * TAU / f64::from(SPOKES);
        for spoke in 0..SPOKES {
            let (sin, cos) = (TAU * (f64::from(spoke) + 0.5) / f64::from(SPOKES)).sin_cos();
            let slope = [0, 1].map(|i| centre[i] + size * (cos * a[i] + sin * b[i]));
            let cosine_squared = 1.0 / (1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
            total += weight * cosine_squared * cosine_squared * lobe(frame.direction(slope));
        }
    }
    total
}

fn round(width: f64) -> [[f64; 2]; 2] {
    [[width, 0.0], [0.0, width]]
}

/// The lobe if viewer and light are both along the half vector.
fn along(surface: ModelSurface, options: ShadingOptions) -> impl Fn(Vector) -> f64 {
    let surface = Surface { normal: [0.0, 0.0, 1.0], model: surface };
    move |h| f64::from(surface.lobe(narrow(h), narrow(h), &options))
}

fn flat() -> Distribution {
    Distribution::of_slope(Slope::default())
}

fn options(specular_power: f32, form: Form) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(specular_power).with_form(form)
}

fn is_one(integral: f64) -> bool {
    (integral - 1.0).abs() < TOLERANCE
}

/// Half axes of the 1-σ ellipse.
fn axes_of(sigma: Covariance) -> [[f64; 2]; 2] {
    let (large, small) = sigma.eigenvalues();
    let main = sigma.main_direction();
    let (x, y) = (f64::from(main.x), f64::from(main.y));
    let (long, short) = (f64::from(large).sqrt(), f64::from(small).sqrt());
    [[long * x, long * y], [-short * y, short * x]]
}

fn slopes() -> [Slope; 4] {
    [[0.0, 0.0], [0.3, -0.1], [-1.0, 0.4], [2.0, 2.5]].map(|[x, y]| Slope { x, y })
}

#[test]
fn gaussians_in_the_surface_frame() {
    for mean in slopes() {
        for s in POWERS {
            let bumps = [(0.0, 0.0, 0.0), (0.2, 0.01, 0.0), (0.05, 0.3, -0.1), (0.01, 0.01, 0.009)];
            for (xx, yy, xy) in bumps {
                let sigma = Covariance { xx: xx + 1.0 / s, yy: yy + 1.0 / s, xy };
                let options = options(s, Form::Normalised);
                let surface = slope_gaussian(mean, sigma, &options);
                let centre = [f64::from(mean.x), f64::from(mean.y)];
                let lobe = |h: Vector| f64::from(gaussian_lobe(&surface, narrow(h), narrow(h), &options));
                let integral = integral(&Frame::SURFACE, centre, axes_of(sigma), lobe);
                assert!(is_one(integral), "B {mean:?}, Σ {sigma:?}: {integral}");
            }
        }
    }
}

#[test]
fn off_centre_lobes_of_both_bases() {
    for base in BaseFrame::ALL {
        for slope in slopes() {
            for s in POWERS {
                let options = options(s, Form::Normalised).with_base_frame(*base);
                let surface = mixture_surface(&Distribution::of_slope(slope), &options);
                let centre = [f64::from(slope.x), f64::from(slope.y)];
                let covariance = surface.gaussians().next().expect("at least one").1.covariance;
                let lobe = along(ModelSurface::Mixture(surface), options);
                let integral = integral(&Frame::SURFACE, centre, axes_of(covariance), lobe);
                assert!(is_one(integral), "{base}, B {slope:?}, s {s}: {integral}");
            }
        }
    }
}

/// A bump normal, and the exponents whose lobes about it stay above the surface: what is below is cut off.
fn bumps() -> [(Vector, &'static [f32]); 3] {
    [
        ([0.0, 0.0, 1.0], &POWERS),
        ([0.3, -0.2, 1.0], &[512.0, 4096.0, 16_384.0]),
        ([-0.7, 0.5, 1.0], &[512.0, 4096.0, 16_384.0]),
    ]
}

#[test]
fn lobes_in_the_frame_of_the_bump() {
    for (normal, powers) in bumps() {
        for s in powers {
            let options = options(*s, Form::Normalised);
            let lobes = [
                ModelSurface::BlinnPhong(blinn_phong_surface(&normal_moments(narrow(normal)), &options)),
                ModelSurface::Beckmann(beckmann_surface(&normal_moments(narrow(normal)), &options)),
            ];
            for lobe in lobes {
                let width = (1.0 / f64::from(*s)).sqrt();
                let integral = integral(&Frame::about(normal), [0.0; 2], round(width), along(lobe, options));
                assert!(is_one(integral), "{lobe:?}: {integral}");
            }
        }
    }
}

#[test]
fn phong_about_the_reflected_ray() {
    let view = [0.1, 0.2, 0.974_679_434_480_896_4];
    for (normal, powers) in bumps() {
        for s in powers {
            // Flat bumps can have any exponent only if the reflected ray is the surface normal itself.
            let view = if *s < 512.0 || normal[2] == normal[0] { [0.0, 0.0, 1.0] } else { view };
            let options = options(*s, Form::Normalised);
            let surface = Surface {
                normal: narrow(normal),
                model: ModelSurface::Phong(phong_surface(&normal_moments(narrow(normal)), &options)),
            };
            let frame = Frame::about(reflected(normal, view));
            let lobe = |light| f64::from(surface.lobe(narrow(view), narrow(light), &options));
            let integral = integral(&frame, [0.0; 2], round((1.0 / f64::from(*s)).sqrt()), lobe);
            assert!(is_one(integral), "{normal:?}, s {s}: {integral}");
        }
    }
}

#[test]
fn ggx_isotropic_and_anisotropic() {
    // The tail reaches the horizon whatever its width, so only a flat bump keeps all of it above the surface.
    for s in POWERS {
        let options = options(s, Form::Normalised);
        let lobe = ModelSurface::Ggx(ggx_surface(&flat(), &options));
        let width = (2.0 / f64::from(s)).sqrt();
        let integral = integral(&Frame::SURFACE, [0.0; 2], round(width), along(lobe, options));
        assert!(is_one(integral), "s {s}: {integral}");
    }
    for (alpha, strength) in [(0.05_f32, 0.5_f32), (0.3, 0.9), (0.01, 0.3)] {
        let options = options(100.0, Form::Normalised);
        let packing =
            Packing { base: Base::Baked, roughness_stored: RoughnessStored::Alpha, ..Packing::IDENTITY };
        let texel = [0.6, 0.8, strength, 1.0];
        let surface = ggx_surface(&pbr_moments([0.0, 0.0, 1.0, 1.0], alpha, texel, &packing), &options);
        let (x, y) = (f64::from(surface.alpha_along), f64::from(surface.alpha_across));
        let axes = [[0.6 * x, 0.8 * x], [-0.8 * y, 0.6 * y]];
        let lobe = along(ModelSurface::Ggx(surface), options);
        let integral = integral(&Frame::SURFACE, [0.0; 2], axes, lobe);
        assert!(is_one(integral), "alpha {alpha}, strength {strength}: {integral}");
    }
}

#[test]
fn toksvig_keeps_the_energy_of_its_dulled_exponent() {
    for gloss in [1.0_f32, 0.3, 0.01] {
        let options = options(4096.0, Form::Normalised);
        let surface = surface_of_texels(
            Shading::Toksvig,
            &[[0.0, 0.0, 0.9, gloss]],
            &FootprintRatio::WHOLE,
            &Packing::IDENTITY,
            &options,
        )
        .model;
        let width = (1.0 / (4096.0 * f64::from(gloss))).sqrt();
        let integral = integral(&Frame::SURFACE, [0.0; 2], round(width), along(surface, options));
        assert!(is_one(integral), "{gloss}: {integral}");
    }
}

#[test]
fn the_papers_form_is_the_normalised_one_without_its_constants() {
    /// Single floats: a product, a quotient, and the fourth power of a cosine.
    const ROUNDING: f64 = 1e-6;
    let h = Frame::SURFACE.direction([0.32, -0.13]);
    for shading in Shading::ALL {
        let surface = |form| shading.surface_of_slope(Slope { x: 0.3, y: -0.1 }, &options(300.0, form)).model;
        let value = |form| along(surface(form), options(300.0, form))(h);
        let normal = surface_axis(shading.reference());
        let cosine = normal.iter().zip(h).map(|(n, h)| n * h).sum::<f64>();
        let expected = match shading.reference() {
            Shading::Phong | Shading::BlinnPhong => TAU * 300.0 / 302.0,
            _ => TAU * cosine.powi(4),
        };
        let ratio = value(Form::Paper) / value(Form::Normalised);
        assert!((ratio / expected - 1.0).abs() < ROUNDING, "{shading}: {ratio} against {expected}");
    }
}

/// The axis of a lobe for the slope (0.3, -0.1).
fn surface_axis(reference: Shading) -> Vector {
    match reference {
        Shading::OffCentre => [0.0, 0.0, 1.0],
        _ => Frame::SURFACE.direction([0.3, -0.1]),
    }
}

#[test]
fn the_integral_detects_unnormalised_lobes() {
    let paper = options(1024.0, Form::Paper);
    let surface = ModelSurface::Beckmann(beckmann_surface(&flat(), &paper));
    let width = round(1.0 / 32.0);
    assert!(!is_one(integral(&Frame::SURFACE, [0.0; 2], width, along(surface, paper))));
    // A constant that is off by a thousandth is detected.
    let normalised = options(1024.0, Form::Normalised);
    let lobe = along(surface, normalised);
    assert!(!is_one(integral(&Frame::SURFACE, [0.0; 2], width, |h| 1.001 * lobe(h))));
    // Blinn-Phong with Beckmann's constant is off by 2 / s.
    let surface = ModelSurface::BlinnPhong(blinn_phong_surface(&flat(), &normalised));
    let lobe = along(surface, normalised);
    assert!(!is_one(integral(&Frame::SURFACE, [0.0; 2], width, |h| 1024.0 / 1026.0 * lobe(h))));
}

#[test]
fn every_reader_samples_textures_of_its_layout() {
    let mut readers = 0;
    for layout in Layout::ALL.iter().copied() {
        for (wanted, anisotropy) in [Wanted::Normal, Wanted::Distribution].into_iter().zip(Anisotropy::ALL) {
            let Some(reader) = layout.texel_reader(wanted, *anisotropy) else { continue };
            readers += 1;
            assert!(!reader.inputs.is_empty());
            for input in reader.inputs {
                assert!(layout.parts().contains(&input.part), "{layout}: {input:?}");
                let layers = layers_of(&TextureInfo::new(layout, input.part));
                assert!(layers.iter().any(|layer| layer.name == input.layer), "{layout}: {input:?}");
            }
            assert!(reader.mean_input.is_none_or(|input| input < reader.inputs.len()), "{layout}");
        }
    }
    assert!(readers > 10, "{readers}");
    // Every model can shade the layout that was designed for it.
    for shading in Shading::ALL {
        assert!(
            shading.layout().texel_reader(shading.wanted(), Anisotropy::Isotropic).is_some(),
            "{shading}"
        );
    }
}

/// Gaussians; the first few of them, with new weights, form a mixture.
fn parts(count: usize) -> Vec<WeightedGaussian> {
    let all = [
        (0.5, [0.1, -0.2], [0.02, 0.01, 0.005]),
        (0.2, [-0.5, 0.3], [0.01, 0.03, -0.01]),
        (0.2, [0.6, 0.4], [0.0, 0.0, 0.0]),
        (0.1, [-0.1, -0.7], [0.05, 0.002, 0.0]),
    ];
    let total: f32 = all[..count].iter().map(|(weight, ..)| weight).sum();
    let part = |(weight, [x, y], [xx, yy, xy]): (f32, [f32; 2], [f32; 3])| WeightedGaussian {
        weight: weight / total,
        mean: Slope { x, y },
        covariance: Covariance { xx, yy, xy },
    };
    all[..count].iter().copied().map(part).collect()
}

#[test]
fn mixtures_of_one_to_four_gaussians() {
    let options = options(64.0, Form::Normalised);
    for count in 1..=MAX_GAUSSIANS {
        let mixture = Distribution::mixture(&parts(count)).expect("one to four");
        let whole = mixture.whole();
        let centre = [f64::from(whole.mean.x), f64::from(whole.mean.y)];
        let axes = axes_of(whole.covariance + Covariance::isotropic(1.0 / options.specular_power));
        let lobe = along(Shading::Lean.surface_of(&mixture, &options).model, options);
        let integral = integral(&Frame::SURFACE, centre, axes, lobe);
        assert!(is_one(integral), "{count} Gaussians: {integral}");
    }
}

#[test]
fn the_lobe_of_a_mixture_is_the_weighted_sum_of_its_gaussians() {
    /// Tolerance of the sum: four products and their sum in single floats.
    const ROUNDING: f64 = 1e-6;
    for form in Form::ALL {
        let options = options(64.0, *form);
        let lobe = |distribution: &Distribution, view: Vector, light: Vector| {
            f64::from(Shading::Lean.surface_of(distribution, &options).lobe(
                narrow(view),
                narrow(light),
                &options,
            ))
        };
        for slope in [[0.0, 0.0], [0.3, -0.3], [-0.4, 0.2]] {
            let (view, light) = (Frame::SURFACE.direction(slope), Frame::SURFACE.direction([0.1, 0.4]));
            let parts = parts(MAX_GAUSSIANS);
            let mixture = Distribution::mixture(&parts).expect("four");
            let of_part = |part: &WeightedGaussian| {
                f64::from(part.weight)
                    * lobe(&Distribution::gaussian(part.mean, part.covariance), view, light)
            };
            let sum: f64 = parts.iter().map(of_part).sum();
            let got = lobe(&mixture, view, light);
            assert!(sum > 0.0 && (got - sum).abs() <= ROUNDING * sum, "{form}, {slope:?}: {got} and {sum}");
        }
    }
}
