//! Every lobe against its formula in f64, on the same single-precision inputs.

use roughcast::shading::{
    BaseFrame, FootprintRatio, Form, Shading, ShadingOptions, Surface, phong_lobe, phong_surface,
};
use roughcast::texture::{Base, ISOTROPIC, Packing, RoughnessStored, normal_moments};
use roughcast::{Covariance, Moments, Slope};

use super::oracle;
use super::support::{Frame, Random, Vector, dot, narrow, normalize, scaled, sum, surface_of_texels, wide};

/// Relative tolerance for a lobe that is above `DEEPEST` of its peak: half vector and bump normal are rounded to 6e-8,
/// which a lobe of s = 16384 amplifies to `s sinθ 6e-8`, at four standard deviations 3e-5; three roundings add up.
const TOLERANCE: f64 = 1e-4;

/// `exp(-8)`: four standard deviations from the peak.
const DEEPEST: f64 = 3e-4;

const POWERS: [f32; 6] = [1.0, 8.0, 64.0, 1024.0, 13_777.0, 16_384.0];
const DRAWS: u32 = 2_000;

/// A view and a light, as single floats, whose half vector is near `peak`, and that half vector.
fn directions(random: &mut Random, peak: Vector, deviation: f64) -> Option<([f32; 3], [f32; 3], Vector)> {
    let offset = [0; 2].map(|_| random.between(-4.0, 4.0) * deviation);
    let h = Frame::about(peak).direction(offset);
    let view = random.direction_above(0.05);
    let light = sum(scaled(h, 2.0 * dot(h, view)), scaled(view, -1.0));
    let (view, light) = (narrow(view), narrow(light));
    let usable = light[2] > 0.01 && dot(h, wide(view)) > 0.05;
    usable.then(|| (view, light, normalize(sum(wide(view), wide(light)))))
}

fn draw_slope(random: &mut Random) -> Slope {
    Slope { x: random.between(-1.5, 1.5) as f32, y: random.between(-1.5, 1.5) as f32 }
}

fn options(specular_power: f32, form: Form) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(specular_power).with_form(form)
}

/// The largest relative difference over many draws in which the lobe is not far below its peak. At least a hundred
/// draws must count.
fn largest_difference(mut draw: impl FnMut(&mut Random) -> Option<(f64, f64, f64)>) -> f64 {
    let mut random = Random(7);
    let (mut counted, mut largest) = (0, 0.0_f64);
    for _ in 0..DRAWS {
        let Some((got, expected, peak)) = draw(&mut random) else { continue };
        if expected > DEEPEST * peak {
            counted += 1;
            largest = largest.max((got / expected - 1.0).abs());
        }
    }
    assert!(counted > 100, "only {counted} draws were near the peak");
    largest
}

/// The difference of a base lobe from an oracle, which is given the slope and the half vector.
fn difference_of(shading: Shading, options: ShadingOptions, oracle: impl Fn([f64; 2], Vector) -> f64) -> f64 {
    largest_difference(|random| {
        let slope = draw_slope(random);
        let b = [f64::from(slope.x), f64::from(slope.y)];
        let peak = Frame::SURFACE.direction(b);
        let deviation = (1.0 / f64::from(options.specular_power)).sqrt();
        let (view, light, h) = directions(random, peak, deviation)?;
        let surface = shading.surface_of_slope(slope, &options);
        let got = surface.lobe(view, light, &options);
        Some((f64::from(got), oracle(b, h), oracle(b, peak)))
    })
}

#[test]
fn base_lobes() {
    for form in [Form::Paper, Form::Normalised] {
        for s in POWERS {
            let options = options(s, form);
            let s = f64::from(s);
            let normal = |b: [f64; 2]| [b[0], b[1], 1.0];
            let alpha = (2.0 / s).sqrt();
            let differences = [
                (
                    Shading::BlinnPhong,
                    difference_of(Shading::BlinnPhong, options, |b, h| {
                        oracle::cosine_lobe(normal(b), h, s, form)
                    }),
                ),
                (
                    Shading::Beckmann,
                    difference_of(Shading::Beckmann, options, |b, h| oracle::beckmann(normal(b), s, h, form)),
                ),
                (
                    Shading::OffCentre,
                    difference_of(Shading::OffCentre, options, |b, h| {
                        oracle::gaussian(b, [1.0 / s, 1.0 / s, 0.0], h, form)
                    }),
                ),
                (
                    Shading::Ggx,
                    difference_of(Shading::Ggx, options, |b, h| {
                        oracle::ggx(normal(b), [1.0, 0.0], [alpha, alpha], h, form)
                    }),
                ),
            ];
            for (shading, difference) in differences {
                assert!(difference < TOLERANCE, "{shading}, {form}, s {s}: {difference:e}");
            }
        }
    }
}

#[test]
fn the_facets_base() {
    for s in POWERS {
        let options = options(s, Form::Normalised).with_base_frame(BaseFrame::Facet);
        let s = f64::from(s);
        let difference = difference_of(Shading::OffCentre, options, |[x, y], h| {
            let across = (1.0 + x * x + y * y) / s;
            let sigma = [across * (1.0 + x * x), across * (1.0 + y * y), across * x * y];
            oracle::gaussian([x, y], sigma, h, Form::Normalised)
        });
        assert!(difference < TOLERANCE, "s {s}: {difference:e}");
    }
}

#[test]
fn phong() {
    /// The reflected ray turns by twice the normal's angle, and so does its rounding error.
    const REFLECTED: f64 = 2.0;
    for s in POWERS {
        let options = options(s, Form::Normalised);
        let difference = largest_difference(|random| {
            let slope = draw_slope(random);
            let normal = [f64::from(slope.x), f64::from(slope.y), 1.0];
            let deviation = 0.5 / f64::from(s).sqrt();
            let (view, light, _) = directions(random, normalize(normal), deviation)?;
            let got =
                phong_lobe(&phong_surface(&normal_moments(narrow(normal)), &options), view, light, &options);
            let reflected = oracle::reflected(normal, wide(view));
            let of = |light| oracle::cosine_lobe(reflected, normalize(light), f64::from(s), Form::Normalised);
            Some((f64::from(got), of(wide(light)), of(reflected)))
        });
        assert!(difference < REFLECTED * TOLERANCE, "s {s}: {difference:e}");
    }
}

/// A mean slope and a covariance of bumps, whose eigenvalues differ by at most a factor of a hundred.
fn draw_moments(random: &mut Random) -> Moments {
    let angle = random.between(0.0, std::f64::consts::PI);
    let large = 10.0_f64.powf(random.between(-4.0, -0.5));
    let small = large * 10.0_f64.powf(random.between(-2.0, 0.0));
    let (sin, cos) = angle.sin_cos();
    let covariance = Covariance {
        xx: (large * cos * cos + small * sin * sin) as f32,
        yy: (large * sin * sin + small * cos * cos) as f32,
        xy: ((large - small) * sin * cos) as f32,
    };
    Moments::from_mean_and_covariance(draw_slope(random), covariance)
}

/// The texels of a float file of the layout that `shading` samples, and in f64 the covariance that they represent.
fn texels_of(shading: Shading, moments: Moments) -> (Vec<[f32; 4]>, [f64; 3]) {
    let Moments { mean, xx, yy, xy } = moments;
    let (x, y) = (f64::from(mean.x), f64::from(mean.y));
    let [vxx, vyy] = [f64::from(xx) - x * x, f64::from(yy) - y * y];
    let vxy = f64::from(xy) - x * y;
    match shading {
        Shading::Lean => (vec![[0.1, 0.2, 0.9, xy], [mean.x, mean.y, xx, yy]], [vxx, vyy, vxy]),
        Shading::Clean => {
            let trace = xx + yy;
            let variance = 0.5 * (f64::from(trace) - x * x - y * y);
            (vec![[mean.x, mean.y, trace, 1.0]], [variance, variance, 0.0])
        }
        Shading::Variance => {
            let stored = [vxx as f32, vyy as f32];
            let sigma = [f64::from(stored[0]), f64::from(stored[1]), 0.0];
            (vec![[mean.x, mean.y, stored[0], stored[1]]], sigma)
        }
        other => unreachable!("{other} stores no moments"),
    }
}

#[test]
fn models_with_moments() {
    /// The determinant's error is a rounding of the entries times the ratio of the eigenvalues, here up to a hundred,
    /// in the exponent times eight.
    const CONDITION: f64 = 100.0 * 8.0 * 1.2e-7;
    for shading in [Shading::Lean, Shading::Clean, Shading::Variance] {
        for base_in_maps in Base::ALL.iter().copied() {
            for s in POWERS {
                let options = options(s, Form::Normalised);
                let packing = Packing { base: base_in_maps, ..Packing::IDENTITY };
                let base = if base_in_maps == Base::None { 1.0 / f64::from(s) } else { 0.0 };
                let difference = largest_difference(|random| {
                    let moments = draw_moments(random);
                    let (texels, [xx, yy, xy]) = texels_of(shading, moments);
                    let sigma = [xx + base, yy + base, xy];
                    let mean = [f64::from(moments.mean.x), f64::from(moments.mean.y)];
                    let peak = Frame::SURFACE.direction(mean);
                    let (view, light, h) = directions(random, peak, sigma[0].min(sigma[1]).sqrt())?;
                    let surface =
                        surface_of_texels(shading, &texels, &FootprintRatio::WHOLE, &packing, &options);
                    let of = |h| oracle::gaussian(mean, sigma, h, Form::Normalised);
                    Some((f64::from(surface.lobe(view, light, &options)), of(h), of(peak)))
                });
                assert!(difference < TOLERANCE + CONDITION, "{shading}, s {s}: {difference:e}");
            }
        }
    }
}

#[test]
fn materials_in_every_way_of_storing() {
    for stored in RoughnessStored::ALL.iter().copied() {
        let options = options(8.0, Form::Normalised);
        let packing = Packing { base: Base::Baked, roughness_stored: stored, ..Packing::IDENTITY };
        for alpha in [0.02_f64, 0.1, 0.5] {
            let roughness = match stored {
                RoughnessStored::Perceptual => alpha.sqrt(),
                RoughnessStored::Alpha => alpha,
                RoughnessStored::AlphaSquared => alpha * alpha,
                RoughnessStored::Gloss => 1.0 - alpha.sqrt(),
                RoughnessStored::SpecularPower => 2.0 / (alpha * alpha),
                other => panic!("say what {other} means"),
            } as f32;
            for anisotropy in [ISOTROPIC, [0.8, -0.6, 0.5, 1.0]] {
                let along = alpha + (1.0 - alpha) * f64::from(anisotropy[2]).powi(2);
                let direction = [f64::from(anisotropy[0]), f64::from(anisotropy[1])];
                let difference = largest_difference(|random| {
                    let slope = draw_slope(random);
                    let normal = [f64::from(slope.x), f64::from(slope.y), 1.0];
                    let unit = narrow(normalize(normal));
                    let texels = [[unit[0], unit[1], unit[2], 1.0], [roughness, 0.0, 0.0, 1.0], anisotropy];
                    let (view, light, h) = directions(random, normal, alpha)?;
                    let surface =
                        surface_of_texels(Shading::Ggx, &texels, &FootprintRatio::WHOLE, &packing, &options);
                    let of = |h| oracle::ggx(normal, direction, [along, alpha], h, Form::Normalised);
                    Some((f64::from(surface.lobe(view, light, &options)), of(h), of(normalize(normal))))
                });
                assert!(difference < TOLERANCE, "{stored}, alpha {alpha}: {difference:e}");
            }
        }
    }
}

#[test]
fn a_material_without_its_base_gets_it_added_once() {
    let options = options(50.0, Form::Normalised);
    let maps = |base| Packing { base, roughness_stored: RoughnessStored::AlphaSquared, ..Packing::IDENTITY };
    let h = [0.1, 0.05, 0.993_730_3];
    let value = |alpha_squared: f32, packing: Packing| {
        let texels = [[0.0, 0.0, 1.0, 1.0], [alpha_squared; 4]];
        surface_of_texels(Shading::Ggx, &texels, &FootprintRatio::WHOLE, &packing, &options)
            .lobe(h, h, &options)
    };
    let (without, with) = (value(0.01, maps(Base::None)), value(0.01 + 2.0 / 50.0, maps(Base::Baked)));
    assert!((without / with - 1.0).abs() < 1e-6, "{without} {with}");
    assert!((value(0.01, maps(Base::Baked)) / with - 1.0).abs() > 0.5);
}

#[test]
fn the_comparison_detects_a_slightly_wrong_lobe() {
    let s = 13_777.0;
    let right = options(s as f32, Form::Normalised);
    let wrong = |factor: f64| {
        difference_of(Shading::Beckmann, right, |[x, y], h| {
            oracle::beckmann([x, y, 1.0], factor * s, h, Form::Normalised)
        })
    };
    assert!(wrong(1.0) < TOLERANCE && wrong(1.001) > TOLERANCE);
}

#[test]
fn a_rounded_cosine_is_too_inaccurate() {
    // The reason that the models use a tangent: the plain power in single floats fails the same test.
    let s = 13_777.0_f32;
    let plain = largest_difference(|random| {
        let h = Frame::SURFACE.direction([0; 2].map(|_| random.between(-4.0, 4.0) / f64::from(s).sqrt()));
        let of = |h| oracle::cosine_lobe([0.0, 0.0, 1.0], h, f64::from(s), Form::Paper);
        let cosine = narrow(h)[2];
        Some((f64::from(s * cosine.powf(s)), of(h), f64::from(s)))
    });
    assert!(plain > TOLERANCE, "{plain:e}");
}

#[test]
fn unsigned_texels_shade_like_their_values() {
    /// Two roundings of codes' values over ranges of about one, against a variance of 0.05.
    const ROUNDING: f32 = 1e-4;
    let packing = Packing {
        slope: [2.6, -1.3],
        second: [1.69, 0.0],
        mixed: [3.38, -1.69],
        trace: [3.38, 0.0],
        spread: [0.5, 0.0],
        unit: [2.0, -1.0],
        ..Packing::IDENTITY
    };
    let stored = |value: f32, [scale, offset]: [f32; 2]| (value - offset) / scale;
    let options = options(64.0, Form::Normalised);
    let lobe = |surface: Surface| {
        let h = [0.2, -0.1, 0.974_679_4];
        surface.lobe(h, h, &options)
    };
    let (bx, by, xx, yy, xy) = (0.3_f32, -0.2, 0.14, 0.1, -0.05);
    let cases = [
        (
            Shading::Lean,
            vec![[0.25, -0.2, 0.9, xy], [bx, by, xx, yy]],
            vec![
                [stored(0.25, packing.unit), stored(-0.2, packing.unit), 0.9, stored(xy, packing.mixed)],
                [
                    stored(bx, packing.slope),
                    stored(by, packing.slope),
                    stored(xx, packing.second),
                    stored(yy, packing.second),
                ],
            ],
        ),
        (
            Shading::Clean,
            vec![[bx, by, xx + yy, 1.0]],
            vec![[stored(bx, packing.slope), stored(by, packing.slope), stored(xx + yy, packing.trace), 1.0]],
        ),
        (
            Shading::Variance,
            vec![[bx, by, 0.05, 0.06]],
            vec![[
                stored(bx, packing.slope),
                stored(by, packing.slope),
                stored(0.05, packing.spread),
                stored(0.06, packing.spread),
            ]],
        ),
        (
            Shading::Toksvig,
            vec![[0.2, -0.1, 0.9, 0.4]],
            vec![[stored(0.2, packing.unit), stored(-0.1, packing.unit), stored(0.9, packing.unit), 0.4]],
        ),
    ];
    for (shading, plain, packed) in cases {
        let plain = surface_of_texels(shading, &plain, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options);
        let packed = surface_of_texels(shading, &packed, &FootprintRatio::WHOLE, &packing, &options);
        assert!((lobe(plain) / lobe(packed) - 1.0).abs() < ROUNDING, "{shading}");
        for (a, b) in plain.normal.iter().zip(packed.normal) {
            assert!((a - b).abs() < ROUNDING, "{shading}");
        }
    }
}
