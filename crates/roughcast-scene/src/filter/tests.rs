//! Invariants that hold for all filters, and a test of each filter against a naive f64 reference.

use std::f64::consts::TAU;

use roughcast::Wrap;

use super::*;
use crate::Level;
use crate::mipmap::wrapped;

/// Rounding error of f64 sums of numbers near one that are stored as f32.
const ROUNDING: f64 = 1e-6;
/// Accuracy to which the constants of [`ewa`] are stated.
const CONSTANT_DIGITS: f64 = 1e-4;
/// Rounding error of the smaller eigenvalue of a covariance: moments up to 4 rounded to f32, `M - B^2` in f64.
const COVARIANCE_ROUNDING: f64 = 2e-6;

/// Pseudo-random numbers from 0 to 1 that are the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A footprint whose axes range from far below a texel to far beyond the texture, in any ratio and direction.
    fn footprint(&mut self) -> Footprint {
        let mut axis = || DVec2::from_angle(self.between(0.0, TAU)) * self.between(-12.0, 4.0).exp2();
        Footprint { dx: axis(), dy: axis() }
    }
}

/// The levels that result from area averages of `top`, for any size.
fn mipmap(width: usize, height: usize, top: impl FnMut(usize) -> [f32; 4]) -> Mipmap {
    let mut levels = vec![Level::new(width, height, (0..width * height).map(top).collect()).unwrap()];
    for (width, height) in roughcast::level_sizes(width, height).into_iter().skip(1) {
        let finer = levels.last().unwrap();
        let footprint = Footprint {
            dx: DVec2::new(finer.width() as f64 / width as f64, 0.0),
            dy: DVec2::new(0.0, finer.height() as f64 / height as f64),
        };
        let table = SummedAreaTable::of(finer);
        let texel = |i: usize| {
            let at = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            table
                .sample(at / DVec2::new(width as f64, height as f64), &footprint, Wrap::Clamp)
                .map(|v| v as f32)
        };
        levels.push(Level::new(width, height, (0..width * height).map(texel).collect()).unwrap());
    }
    Mipmap::new(levels).unwrap()
}

fn noise(width: usize, height: usize, seed: u64) -> Mipmap {
    let mut random = Random(seed);
    mipmap(width, height, |_| [0; 4].map(|_| random.next() as f32))
}

fn samplers() -> impl Iterator<Item = Sampler> {
    Filter::ALL.iter().flat_map(|filter| {
        Wrap::ALL.iter().flat_map(move |wrap| {
            [None, Some(0.0), Some(1.5), Some(40.0)].map(|level| Sampler {
                filter: *filter,
                level,
                mip_bias: 0.0,
                wrap: *wrap,
            })
        })
    })
}

const SIZES: [(usize, usize); 6] = [(1, 1), (7, 1), (16, 16), (13, 5), (64, 8), (33, 47)];

#[test]
fn constants_stay_constant() {
    for (width, height) in SIZES {
        let constant = mipmap(width, height, |_| [0.25, -3.0, 0.0, 1.0]);
        for sampler in samplers() {
            let mut random = Random(1);
            for _ in 0..20 {
                let uv = DVec2::new(random.between(-2.0, 3.0), random.between(-2.0, 3.0));
                let texel = sampler.sample(&constant, uv, &random.footprint());
                for (got, want) in texel.iter().zip([0.25, -3.0, 0.0, 1.0]) {
                    assert!(
                        (f64::from(*got) - want).abs() < ROUNDING,
                        "{sampler:?} {width}x{height}: {texel:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn weights_are_never_negative() {
    // A single bright texel reveals its own weight, and so does a single dark texel among bright ones.
    for (width, height) in SIZES {
        let mut random = Random(2);
        let lit = (random.next() * (width * height) as f64) as usize;
        let spots =
            mipmap(width, height, |i| if i == lit { [1.0, 0.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0, 0.0] });
        for sampler in samplers() {
            for _ in 0..40 {
                let uv = DVec2::new(random.next(), random.next());
                let [bright, dark, ..] = sampler.sample(&spots, uv, &random.footprint()).map(f64::from);
                assert!(bright >= -ROUNDING && dark >= -ROUNDING, "{sampler:?} {width}x{height}");
                assert!((bright + dark - 1.0).abs() < ROUNDING);
            }
        }
    }
}

#[test]
fn filtered_moments_have_a_covariance() {
    let mut random = Random(3);
    let (width, height) = (24, 18);
    let slopes: Vec<[f64; 2]> =
        (0..width * height).map(|_| [random.between(-2.0, 2.0), random.between(-2.0, 2.0)]).collect();
    let first = mipmap(width, height, |i| {
        let [x, y] = slopes[i];
        [x, y, x * x, y * y].map(|v| v as f32)
    });
    let mixed = mipmap(width, height, |i| [(slopes[i][0] * slopes[i][1]) as f32, 0.0, 0.0, 0.0]);
    let mut spread = 0.0_f64;
    for sampler in samplers() {
        for _ in 0..100 {
            let (uv, footprint) = (DVec2::new(random.next(), random.next()), random.footprint());
            let [x, y, xx, yy] = sampler.sample(&first, uv, &footprint).map(f64::from);
            let xy = f64::from(sampler.sample(&mixed, uv, &footprint)[0]);
            let (a, b, c) = (xx - x * x, xy - x * y, yy - y * y);
            let smaller = 0.5 * (a + c) - (0.5 * (a - c)).hypot(b);
            assert!(smaller > -COVARIANCE_ROUNDING, "{sampler:?} {uv} {footprint:?}: {smaller}");
            spread = spread.max(smaller);
        }
    }
    assert!(spread > 1.0, "no footprint covered many bumps");
}

#[test]
fn results_are_finite_and_within_the_texture_for_any_footprint() {
    let texture = noise(20, 12, 4);
    let odd = [0.0, 1.0, -1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let mut random = Random(5);
    for sampler in samplers() {
        for bias in [0.0, -3.0, 5.0, f64::NAN, f64::INFINITY] {
            let sampler = Sampler { mip_bias: bias, ..sampler };
            for _ in 0..40 {
                let mut pick = || odd[(random.next() * odd.len() as f64) as usize];
                let uv = DVec2::new(pick(), pick());
                let footprint = Footprint { dx: DVec2::new(pick(), pick()), dy: DVec2::new(pick(), pick()) };
                let texel = sampler.sample(&texture, uv, &footprint);
                let good = texel.iter().all(|v| (-ROUNDING..1.0 + ROUNDING).contains(&f64::from(*v)));
                assert!(good, "{sampler:?} {uv} {footprint:?}: {texel:?}");
            }
        }
    }
    let sampler = Sampler { level: Some(f64::NAN), ..Sampler::default() };
    assert!(sampler.sample(&texture, DVec2::ZERO, &Footprint::default())[0].is_finite());
}

#[test]
fn a_huge_footprint_gives_the_mean_of_the_texture() {
    // In the last levels of odd sizes not all texels have the same weight; powers of two avoid this.
    let texture = noise(32, 16, 6);
    let top = &texture.levels()[0];
    let mean = (0..16).flat_map(|y| top.row(y)).map(|t| f64::from(t[0])).sum::<f64>() / 512.0;
    let huge = Footprint { dx: DVec2::new(40.0, 3.0), dy: DVec2::new(-5.0, 50.0) };
    for filter in [Filter::Trilinear, Filter::Anisotropic, Filter::Ewa] {
        let got = Sampler { filter, ..Sampler::default() }.sample(&texture, DVec2::new(0.3, 0.8), &huge)[0];
        assert!((f64::from(got) - mean).abs() < ROUNDING, "{filter}: {got} {mean}");
    }
    // A box of b periods leaves a remainder of at most part of one period, 1 / b of the whole.
    let got = Sampler { filter: Filter::SummedArea, ..Sampler::default() }.sample(
        &texture,
        DVec2::new(0.3, 0.8),
        &huge,
    )[0];
    assert!((f64::from(got) - mean).abs() < 1.0 / 40.0, "{got} {mean}");
}

#[test]
fn magnified_textures_are_interpolated_bilinearly() {
    // The naive reference: every texel of every period nearby, weighted by a tent.
    for (width, height) in SIZES {
        let texture = noise(width, height, 7);
        let mut random = Random(8);
        for wrap in Wrap::ALL.iter().copied() {
            for _ in 0..40 {
                let uv = DVec2::new(random.between(-0.5, 1.5), random.between(-0.5, 1.5));
                let at = uv * DVec2::new(width as f64, height as f64);
                let tent = |centre: f64, i: i64| (1.0 - (centre - i as f64 - 0.5).abs()).max(0.0);
                let (w, h) = (width as i64, height as i64);
                let mut want = 0.0;
                for (x, y) in (-2 * w..3 * w).flat_map(|x| (-2 * h..3 * h).map(move |y| (x, y))) {
                    let texel = texture.levels()[0].texel(wrapped(x, width, wrap), wrapped(y, height, wrap));
                    want += tent(at.x, x) * tent(at.y, y) * f64::from(texel[1]);
                }
                for filter in [Filter::Trilinear, Filter::Anisotropic, Filter::SummedArea] {
                    let sampler = Sampler { filter, wrap, ..Sampler::default() };
                    let got = f64::from(sampler.sample(&texture, uv, &Footprint::default())[1]);
                    assert!(
                        (got - want).abs() < ROUNDING,
                        "{filter} {wrap} {width}x{height} {uv}: {got} {want}"
                    );
                }
            }
        }
    }
}

#[test]
fn nearest_is_the_texel_that_contains_the_point() {
    let texture = noise(5, 3, 9);
    let sampler = Sampler { filter: Filter::Nearest, ..Sampler::default() };
    let huge = Footprint { dx: DVec2::X, dy: DVec2::Y };
    let at = |x: f64, y: f64| sampler.sample(&texture, DVec2::new(x / 5.0, y / 3.0), &huge);
    let texel = |x, y| texture.levels()[0].texel(x, y);
    assert_eq!(at(1.999, 2.001), texel(1, 2));
    assert_eq!(at(-0.001, 3.001), texel(4, 0));
    let coarse = Sampler { level: Some(1.4), ..sampler };
    assert_eq!(coarse.sample(&texture, DVec2::new(0.7, 0.5), &huge), texture.levels()[1].texel(1, 0));
}

#[test]
fn a_fixed_level_is_that_level_and_a_bias_is_added() {
    let texture = noise(32, 32, 10);
    // The centre of a texel of level 3, where interpolation returns that texel itself.
    let uv = DVec2::new(1.5 / 4.0, 2.5 / 4.0);
    let tiny = Footprint { dx: DVec2::new(1.0 / 32.0, 0.0), dy: DVec2::new(0.0, 1.0 / 32.0) };
    for filter in [Filter::Trilinear, Filter::Anisotropic] {
        let fixed = Sampler { filter, level: Some(3.0), ..Sampler::default() };
        assert_eq!(fixed.sample(&texture, uv, &tiny), texture.levels()[3].texel(1, 2));
        let biased = Sampler { filter, mip_bias: 3.0, ..Sampler::default() };
        let (got, want) = (biased.sample(&texture, uv, &tiny)[0], texture.levels()[3].texel(1, 2)[0]);
        assert!(f64::from(got - want).abs() < ROUNDING, "{got} {want}");
    }
    // The box of 8 by 8 texels around the same point is the same average.
    let table = Sampler { filter: Filter::SummedArea, mip_bias: 3.0, ..Sampler::default() };
    let (got, want) = (table.sample(&texture, uv, &tiny)[0], texture.levels()[3].texel(1, 2)[0]);
    assert!(f64::from(got - want).abs() < ROUNDING, "{got} {want}");
}

#[test]
fn summed_areas_are_the_mean_over_the_box() {
    // The naive reference: every texel of every period nearby, weighted by the fraction of it that the box covers.
    for (width, height) in SIZES {
        let texture = noise(width, height, 11);
        let mut random = Random(12);
        for wrap in Wrap::ALL.iter().copied() {
            for _ in 0..20 {
                let (w, h) = (width as f64, height as f64);
                let uv = DVec2::new(random.between(-0.5, 1.5), random.between(-0.5, 1.5));
                let size = DVec2::new(random.between(1.0, 2.0 * w + 1.0), random.between(1.0, 2.0 * h + 1.0));
                let footprint = Footprint {
                    dx: DVec2::new(size.x * 0.25 / w, -size.y * 0.5 / h),
                    dy: DVec2::new(size.x * 0.75 / w, size.y * 0.5 / h),
                };
                let cover = |centre: f64, size: f64, i: i64| {
                    let (low, high) = (centre - 0.5 * size, centre + 0.5 * size);
                    ((i as f64 + 1.0).min(high) - (i as f64).max(low)).max(0.0)
                };
                let at = super::footprint::reduced(uv, wrap) * DVec2::new(w, h);
                let mut want = 0.0;
                let (w, h) = (width as i64, height as i64);
                for (x, y) in (-4 * w..6 * w).flat_map(|x| (-4 * h..6 * h).map(move |y| (x, y))) {
                    let texel = texture.levels()[0].texel(wrapped(x, width, wrap), wrapped(y, height, wrap));
                    want += cover(at.x, size.x, x) * cover(at.y, size.y, y) * f64::from(texel[2]);
                }
                want /= size.x * size.y;
                let sampler = Sampler { filter: Filter::SummedArea, wrap, ..Sampler::default() };
                let got = f64::from(sampler.sample(&texture, uv, &footprint)[2]);
                assert!((got - want).abs() < ROUNDING, "{wrap} {width}x{height} {uv} {size}: {got} {want}");
            }
        }
    }
}

/// A wave with an integer number of periods across the texture, in red.
fn wave(size: usize, periods: DVec2) -> Mipmap {
    mipmap(size, size, |i| {
        let at = DVec2::new((i % size) as f64 + 0.5, (i / size) as f64 + 0.5) / size as f64;
        [(TAU * periods.dot(at)).cos() as f32, 0.0, 0.0, 0.0]
    })
}

#[test]
fn elliptical_weights_are_the_gaussian_of_the_footprint() {
    /// Error for a wave from truncating the Gaussian at 3 standard deviations, with corrected variance, and from
    /// interpolation if a footprint is no wider than a texel.
    const TRUNCATION: f64 = 0.02;
    let size = 256;
    let mut random = Random(13);
    let mut largest = 0.0_f64;
    for _ in 0..300 {
        let periods = DVec2::new(random.between(-20.0, 20.0).round(), random.between(-20.0, 20.0).round());
        // Axes from one texel to 64 texels, with ratios up to 8:1.
        let (minor, ratio) = (random.between(0.0, 3.0).exp2(), random.between(0.0, 3.0).exp2());
        let direction = DVec2::from_angle(random.between(0.0, TAU));
        let footprint = Footprint {
            dx: direction * minor * ratio / size as f64,
            dy: direction.perp() * minor / size as f64,
        };
        let uv = DVec2::new(random.next(), random.next());
        let got = Sampler { filter: Filter::Ewa, ..Sampler::default() }.sample(
            &wave(size, periods),
            uv,
            &footprint,
        )[0];
        // A Gaussian scales a wave by its characteristic function.
        let deviations = 0.5 * TAU * DVec2::new(footprint.dx.dot(periods), footprint.dy.dot(periods));
        let want = (-0.5 * deviations.length_squared()).exp() * (TAU * periods.dot(uv)).cos();
        largest = largest.max((f64::from(got) - want).abs());
    }
    assert!(largest < TRUNCATION, "{largest}");
}

#[test]
fn elliptical_weights_match_a_naive_sum() {
    // Footprints whose shorter axis is below four texels use level 0, so all texels can be summed directly.
    let size = 24_i64;
    let texture = noise(24, 24, 14);
    let mut random = Random(15);
    for _ in 0..60 {
        let (minor, major) = (random.between(2.0, 3.9), random.between(4.0, 12.0));
        let widening = 1.0 / (1.0 - 4.5 / (4.5_f64.exp() - 1.0));
        let direction = DVec2::from_angle(random.between(0.0, TAU));
        let footprint = Footprint { dx: direction * major / 24.0, dy: direction.perp() * minor / 24.0 };
        let uv = DVec2::new(random.next(), random.next());
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, y) in (-size..2 * size).flat_map(|x| (-size..2 * size).map(move |y| (x, y))) {
            let offset = DVec2::new(x as f64, y as f64) + 0.5 - uv * 24.0;
            let squared = ((offset.dot(direction) / (0.5 * major)).powi(2)
                + (offset.perp_dot(direction) / (0.5 * minor)).powi(2))
                / widening;
            if squared <= 3.0 * 3.0 {
                let texel =
                    texture.levels()[0].texel(wrapped(x, 24, Wrap::Repeat), wrapped(y, 24, Wrap::Repeat));
                sum += (-0.5 * squared).exp() * f64::from(texel[3]);
                weights += (-0.5 * squared).exp();
            }
        }
        let got = f64::from(
            Sampler { filter: Filter::Ewa, ..Sampler::default() }.sample(&texture, uv, &footprint)[3],
        );
        assert!((got - sum / weights).abs() < CONSTANT_DIGITS, "{got} {}", sum / weights);
    }
}

#[test]
fn anisotropic_taps_follow_the_footprint() {
    let size = 256;
    // A footprint of 32 by 4 texels along x. It preserves a wave of 16 texels across it and removes one of 16 texels
    // along it.
    let footprint = Footprint { dx: DVec2::new(32.0, 0.0) / 256.0, dy: DVec2::new(0.0, 4.0) / 256.0 };
    let amplitude = |filter, periods: DVec2| {
        let sampler = Sampler { filter, ..Sampler::default() };
        f64::from(sampler.sample(&wave(size, periods), DVec2::ZERO, &footprint)[0])
    };
    let (along, across) = (DVec2::new(16.0, 0.0), DVec2::new(0.0, 16.0));
    for filter in [Filter::Anisotropic, Filter::Ewa, Filter::SummedArea] {
        assert!(amplitude(filter, along).abs() < 0.05, "{filter}: {}", amplitude(filter, along));
        assert!(amplitude(filter, across) > 0.6, "{filter}: {}", amplitude(filter, across));
    }
    assert!(amplitude(Filter::Trilinear, across).abs() < 0.05, "trilinear blurs across as it does along");
    assert_eq!(amplitude(Filter::Nearest, along), amplitude(Filter::Nearest, across));
}

#[test]
fn anisotropic_is_trilinear_for_a_round_footprint() {
    let texture = noise(64, 64, 16);
    let mut random = Random(17);
    for _ in 0..50 {
        let axis = DVec2::from_angle(random.between(0.0, TAU)) * random.between(-7.0, 0.0).exp2();
        let footprint = Footprint { dx: axis, dy: axis.perp() };
        let uv = DVec2::new(random.next(), random.next());
        let sample = |filter| Sampler { filter, ..Sampler::default() }.sample(&texture, uv, &footprint)[0];
        // The ellipse's axes are equal up to rounding, which may add a second tap half an axis away.
        let (got, want) = (sample(Filter::Anisotropic), sample(Filter::Trilinear));
        assert!(f64::from(got - want).abs() < ROUNDING, "{got} {want}");
    }
}
