//! Footprint correction: how much of the variance under a texture filter a pixel sees.

use roughcast::shading::{
    FilterVariances, FootprintModel, FootprintRatio, ModelSurface, PixelPart, Shading, ShadingOptions,
    footprint_axes, footprint_ratio, hardware_variances, level_variances,
};
use roughcast::texture::{Base, Packing};
use roughcast::{Covariance, Moments, Slope};

use super::support::surface_of_texels;

/// Single floats, a few operations.
const ROUNDING: f64 = 1e-5;

fn close(a: f32, b: f64) -> bool {
    (f64::from(a) - b).abs() <= ROUNDING * b.abs().max(1e-3)
}

/// The variance, about a point, of the weights that trilinear interpolation between levels `l` and `l + 1` gives to the
/// texels of level 0, averaged over the point's position: computed by summing weights.
fn variance_of_weights(level: i32, blend: f64) -> f64 {
    const PLACES: u32 = 512;
    let of_level = |level: i32| {
        let side = 2.0_f64.powi(level);
        let mut total = 0.0;
        for place in 0..PLACES {
            // From the centre of one texel of the level to the next centre.
            let t = (f64::from(place) + 0.5) / f64::from(PLACES);
            for (texel, weight) in [(0.0, 1.0 - t), (1.0, t)] {
                for fine in 0..side as u32 {
                    let x = (texel - 0.5) * side + f64::from(fine) + 0.5;
                    let distance = x - t * side;
                    total += weight / side * distance * distance;
                }
            }
        }
        total / f64::from(PLACES)
    };
    (1.0 - blend) * of_level(level) + blend * of_level(level + 1)
}

#[test]
fn variances_of_levels_are_those_of_their_weights() {
    /// The midpoint rule over the positions, for a parabola.
    const QUADRATURE: f64 = 1e-5;
    for level in 0..5 {
        for blend in [0.0, 0.25, 0.7] {
            let found = level_variances(level as f32 + blend as f32).moments[0];
            let wanted = variance_of_weights(level, blend);
            assert!(
                (f64::from(found) / wanted - 1.0).abs() < QUADRATURE,
                "{level} {blend}: {found} {wanted}"
            );
        }
    }
    // Stored variances do not include the variance between texels: 4^l / 6.
    let FilterVariances { moments, variances } = level_variances(3.0);
    assert!(close(moments[0] - variances[0], 64.0 / 6.0) && level_variances(0.0).variances == [0.0; 2]);
    assert_eq!(level_variances(-3.0), level_variances(0.0));
}

#[test]
fn taps_of_an_anisotropic_filter_spread_along_the_longer_axis() {
    let axes = footprint_axes([8.0, 0.0], [0.0, 2.0]);
    let level = level_variances(1.0).moments[0];
    let FilterVariances { moments, .. } = hardware_variances(&axes, 16.0, 0.0);
    // Four taps two texels apart: -3, -1, 1, 3.
    assert!(close(moments[0] - level, 5.0) && moments[1] == level, "{moments:?}");
    // A trilinear filter uses the longer axis in both directions; with at most two taps, a level between.
    let trilinear = hardware_variances(&axes, 1.0, 0.0);
    assert_eq!(trilinear, level_variances(3.0));
    let two = hardware_variances(&axes, 2.0, 0.0).moments;
    assert!(
        close(two[1], f64::from(level_variances(2.0).moments[0])) && close(two[0] - two[1], 4.0),
        "{two:?}"
    );
}

#[test]
fn axes_and_derivatives_along_them_are_found() {
    // Two slopes that change linearly over the texture.
    let gradient = [[0.03_f64, -0.01], [0.02, 0.05]];
    let change = |[x, y]: [f64; 2]| gradient.map(|[gx, gy]| gx * x + gy * y);
    for (long, short, degrees, turn) in [
        (8.0, 0.5, 20.0_f64, 0.0_f64),
        (3.0, 2.9, 100.0, 1.0),
        (40.0, 1.0, 45.0, 2.0),
        (1e-3, 1e-4, -70.0, 0.4),
    ] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (along, across) = ([cos, sin], [-sin, cos]);
        // A rotation of the picture does not change the ellipse.
        let (s, c) = turn.sin_cos();
        let dx = [0, 1].map(|i| c * long * along[i] + s * short * across[i]);
        let dy = [0, 1].map(|i| -s * long * along[i] + c * short * across[i]);
        let axes = footprint_axes(dx.map(|v| v as f32), dy.map(|v| v as f32));
        assert!(close(axes.squared_lengths[0], long * long), "{axes:?}");
        assert!((f64::from(axes.squared_lengths[1]) / (short * short) - 1.0).abs() < 1e-3, "{axes:?}");
        for (weights, direction) in [(axes.along, along), (axes.across, across)] {
            let (mean_dx, mean_dy) = (change(dx), change(dy));
            let found =
                [0, 1].map(|i| f64::from(weights[0]) * mean_dx[i] + f64::from(weights[1]) * mean_dy[i]);
            let wanted = change(direction);
            let squared = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
            assert!((squared(found) / squared(wanted) - 1.0).abs() < 1e-2, "{degrees}: {found:?} {wanted:?}");
        }
    }
}

#[test]
fn degenerate_footprints_give_ratios() {
    let odd = [0.0, 1e-20, 1e-9, 1.0, 1e9, -1e9];
    for ax in odd {
        for by in odd {
            for ay in odd {
                let axes = footprint_axes([ax, ay], [ay, by]);
                for taps in [1.0, 16.0] {
                    let filter = hardware_variances(&axes, taps, 0.0);
                    for mean in [[0.0, 0.0], [0.3, -1e-9], [100.0, 50.0]] {
                        let options = ShadingOptions::default();
                        let ratio = footprint_ratio(&axes, &filter, mean, [mean[1], mean[0]], &options);
                        assert!((0.0..=1.0).contains(&ratio.magnified), "{ax} {ay} {by}: {ratio:?}");
                        for part in [ratio.moments, ratio.variances] {
                            let factor = part.factor(0.3);
                            let fine = (0.0..=1.0).contains(&part.ratio) && (0.0..=1.0).contains(&factor);
                            assert!(fine, "{ax} {ay} {by}: {part:?} {factor}");
                        }
                        let seen = ratio.pixel_covariance(ratio.moments, Covariance::isotropic(0.1), 0.0);
                        let determinant =
                            f64::from(seen.xx) * f64::from(seen.yy) - f64::from(seen.xy).powi(2);
                        let sound = seen.xx >= 0.0 && seen.yy >= 0.0 && determinant >= -1e-6;
                        assert!(sound, "{ax} {ay} {by}: {seen:?} of {ratio:?}");
                    }
                }
            }
        }
    }
}

/// The mean over positions of the corrected trace that LEAN finds in a ramp of slopes at level 0.
fn corrected_trace_of_a_ramp(gradient: [f32; 2], texels: f32, options: &ShadingOptions) -> f64 {
    const PLACES: u32 = 64;
    let axes = footprint_axes([texels, 0.0], [0.0, texels]);
    let mean_dx = gradient.map(|g| g * texels);
    let ratio = footprint_ratio(&axes, &hardware_variances(&axes, 1.0, 0.0), mean_dx, [0.0; 2], options);
    let mut total = 0.0;
    for place in 0..PLACES {
        let t = (place as f32 + 0.5) / PLACES as f32;
        // Between texels whose slopes differ by the gradient, the variance is t (1 - t) times its square.
        let [x, y] = gradient;
        let part = t * (1.0 - t);
        let bumps = Covariance { xx: part * x * x, yy: part * y * y, xy: part * x * y };
        let seen = ratio.pixel_covariance(ratio.moments, bumps, 0.0);
        total += f64::from(seen.xx + seen.yy);
    }
    total / f64::from(PLACES)
}

#[test]
fn a_ramp_keeps_the_variance_of_the_pixel() {
    for texels in [0.125_f32, 0.25, 0.5] {
        for gradient in [[0.1, 0.0], [0.02, -0.3]] {
            let squared = f64::from(gradient[0] * gradient[0] + gradient[1] * gradient[1]);
            // The pixel's Gaussian has a standard deviation of half a pixel.
            let wanted = squared * f64::from(0.5 * texels).powi(2);
            let found = corrected_trace_of_a_ramp(gradient, texels, &ShadingOptions::default());
            assert!((found / wanted - 1.0).abs() < 1e-3, "{texels}: {found} {wanted}");
            let published = ShadingOptions::default().with_footprint(FootprintModel::Published);
            let found = corrected_trace_of_a_ramp(gradient, texels, &published);
            assert!((found / (squared / 6.0) - 1.0).abs() < 1e-3 && found > 2.0 * wanted, "{found} {wanted}");
        }
    }
}

#[test]
fn pixels_that_cover_whole_texels_are_unchanged() {
    for level in 0..6 {
        let texels = 2.0_f32.powi(level);
        let axes = footprint_axes([texels, 0.0], [0.0, texels]);
        let options = ShadingOptions::default();
        let filter = hardware_variances(&axes, 16.0, 0.0);
        let ratio = footprint_ratio(&axes, &filter, [0.2, 0.1], [-0.1, 0.3], &options);
        assert_eq!((ratio.moments.ratio, ratio.variances.ratio), (1.0, 1.0), "level {level}");
    }
}

#[test]
fn the_correction_fades_out_on_coarser_levels() {
    // A footprint of four to one with a trilinear filter, which covers too much across it.
    let ratio = |long: f32| {
        let axes = footprint_axes([long, 0.0], [0.0, 0.25 * long]);
        let filter = hardware_variances(&axes, 1.0, 0.0);
        footprint_ratio(&axes, &filter, [0.2, 0.0], [0.1, 0.2], &ShadingOptions::default()).moments.ratio
    };
    let (level_1, between, level_2) = (ratio(2.0), ratio(3.0), ratio(4.0));
    assert!(level_1 < 0.6 && level_1 < between && between < 1.0, "{level_1} {between}");
    assert_eq!((level_2, ratio(64.0)), (1.0, 1.0));
}

#[test]
fn detail_below_the_texel_is_kept() {
    let part = PixelPart { ratio: 0.1, linear_trace: 0.02 };
    assert!((part.factor(0.02) - 0.1).abs() < 1e-6 && (part.factor(0.01) - 0.1).abs() < 1e-6);
    // A hundredth of a trace of 2 may come from the ramp.
    assert!((part.factor(2.0) - 0.991).abs() < 1e-6);
    for trace in [0.0, -1.0, f32::NAN] {
        assert_eq!(part.factor(trace), 1.0);
    }
}

#[test]
fn a_magnified_texel_has_only_the_linear_change() {
    // A hundredth of a texel per pixel, and slopes of two directions that change along both axes.
    let (dx, dy) = ([0.01_f32, 0.0], [0.004, 0.008]);
    let gradient = [[0.5_f64, -0.2], [0.1, 0.3]];
    let change = |d: [f32; 2]| gradient.map(|[gx, gy]| (gx * f64::from(d[0]) + gy * f64::from(d[1])) as f32);
    let axes = footprint_axes(dx, dy);
    let options = ShadingOptions::default();
    let ratio = footprint_ratio(&axes, &level_variances(0.0), change(dx), change(dy), &options);
    assert!(ratio.magnified > 0.99, "{ratio:?}");
    // A quarter of `G J Jᵀ Gᵀ`: the pixel's Gaussian in the space of slopes.
    let products = |i: usize, j: usize| {
        f64::from(change(dx)[i]) * f64::from(change(dx)[j])
            + f64::from(change(dy)[i]) * f64::from(change(dy)[j])
    };
    let Covariance { xx, yy, xy } = ratio.linear_covariance;
    for (found, wanted) in [(xx, products(0, 0)), (yy, products(1, 1)), (xy, products(0, 1))] {
        assert!((f64::from(found) / (0.25 * wanted) - 1.0).abs() < 1e-3, "{found} {wanted}");
    }
    // From level 1 on, and if several taps are averaged, there is detail in between.
    for filter in [level_variances(1.0), level_variances(4.0)] {
        assert_eq!(footprint_ratio(&axes, &filter, change(dx), change(dy), &options).magnified, 0.0);
    }
    let long = footprint_axes([3.0, 0.0], [0.0, 0.1]);
    let taps = hardware_variances(&long, 16.0, 0.0);
    assert_eq!(footprint_ratio(&long, &taps, [0.3, 0.0], [0.01, 0.0], &options).magnified, 0.0);
}

/// The covariance that LEAN, CLEAN and stored variances use for shading.
fn shaded(
    shading: Shading,
    sigma: Covariance,
    ratio: &FootprintRatio,
    base: Base,
    options: &ShadingOptions,
) -> Covariance {
    let mean = Slope { x: 0.3, y: -0.2 };
    let moments = Moments::from_mean_and_covariance(mean, sigma);
    let texels = match shading {
        Shading::Lean => vec![[0.0, 0.0, 1.0, moments.xy], [mean.x, mean.y, moments.xx, moments.yy]],
        Shading::Clean => vec![[mean.x, mean.y, moments.xx + moments.yy, 0.0]],
        _ => vec![[mean.x, mean.y, sigma.xx, sigma.yy]],
    };
    match surface_of_texels(shading, &texels, ratio, &Packing { base, ..Packing::IDENTITY }, options).model {
        ModelSurface::Gaussian(gaussian) => gaussian.covariance,
        other => panic!("{other:?} has no covariance"),
    }
}

#[test]
fn models_of_moments_shade_the_part_of_the_pixel_and_the_whole_base() {
    let sigma = Covariance { xx: 0.04, yy: 0.04, xy: 0.0 };
    let part = |ratio| PixelPart { ratio, linear_trace: 1.0 };
    let ratio = FootprintRatio { moments: part(0.25), variances: part(0.5), ..FootprintRatio::WHOLE };
    let (s, base) = (100.0, 0.01);
    for (shading, kept) in [(Shading::Lean, 0.25), (Shading::Clean, 0.25), (Shading::Variance, 0.5)] {
        let options = ShadingOptions::default().with_specular_power(s);
        let found = shaded(shading, sigma, &ratio, Base::None, &options);
        assert!(close(found.xx, kept * 0.04 + base) && close(found.yy, kept * 0.04 + base), "{found:?}");
        let whole = shaded(shading, sigma, &FootprintRatio::WHOLE, Base::None, &options);
        assert!(close(whole.xx, 0.04 + base), "{whole:?}");
        // A base in the map is not excess variance and is kept in full.
        let found = shaded(shading, sigma, &ratio, Base::Baked, &options);
        assert!(close(found.xx, kept * (0.04 - base) + base), "{shading}: {found:?}");
    }
}
