//! Height maps of the papers' figures, computed by formula. All tile seamlessly, and their slopes are known.

use std::f64::consts::TAU;

use roughcast::{Image, Kind, Samples, SourceOptions};

use crate::split_mix::{GOLDEN_RATIO, scrambled};

/// A height map and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// One channel of single floats: heights in units of the map's width.
    pub heights: Image,
}

impl Pattern {
    fn of(size: usize, height_in_texels: impl Fn(f64, f64) -> f64) -> Self {
        let texels = (0..size * size).map(|i| {
            let (x, y) = ((i % size) as f64, (i / size) as f64);
            (height_in_texels(x, y) / size as f64) as f32
        });
        let heights = Image::new(size, size, 1, Samples::F32(texels.collect()));
        Self { heights: heights.expect("a square of one channel") }
    }

    /// How the heights are converted to slopes: the default options, with heights in units of the width.
    pub fn source_options(&self) -> SourceOptions {
        SourceOptions::default().with_kind(Kind::Height).with_height_scale(1.0)
    }
}

/// A checkerboard of raised squares with slanted edges (LEAN Figure 14).
///
/// There are `squares` squares along each side, an even number so that the board tiles. The edges rise over `bevel`
/// texels with this `slope`. Most of the surface is flat, so its highlight is as sharp as the base lobe, with a faint
/// cross from the edges.
pub fn raised_checker(size: usize, squares: usize, bevel: f64, slope: f64) -> Pattern {
    let side = size as f64 / squares as f64;
    Pattern::of(size, |x, y| {
        // Texel centres.
        let (x, y) = (x + 0.5, y + 0.5);
        let (column, row) = ((x / side).floor(), (y / side).floor());
        if (column + row) % 2.0 == 0.0 {
            return 0.0;
        }
        let from_edge = |t: f64, cell: f64| (t - cell * side).min((cell + 1.0) * side - t);
        from_edge(x, column).min(from_edge(y, row)).min(bevel) * slope
    })
}

/// Sharp V grooves along y, `grooves` of them over the map. Slopes are `±slope` along x with nothing between, which no
/// single Gaussian can describe (LEAN, section 6).
pub fn v_grooves(size: usize, grooves: usize, slope: f64) -> Pattern {
    let period = size as f64 / grooves as f64;
    Pattern::of(size, |x, _| {
        let t = (x + 0.5).rem_euclid(period);
        t.min(period - t) * slope
    })
}

/// Ridges along y with random heights and widths (LEAN Figure 2 d, 13). Slopes along x are nearly Gaussian with this
/// root mean square.
pub fn random_ridges(size: usize, rms_slope: f64, seed: u64) -> Pattern {
    let waves: Vec<Wave> = (0..RIDGE_WAVES).map(|i| Wave::ridge(i, size, seed)).collect();
    superposition(size, &waves, rms_slope)
}

/// Random bumps without a preferred direction (LEAN Figure 2 a). Slopes are nearly Gaussian with this root mean square
/// length.
pub fn random_bumps(size: usize, rms_slope: f64, seed: u64) -> Pattern {
    let waves: Vec<Wave> = (0..BUMP_WAVES).map(|i| Wave::bump(i, size, seed)).collect();
    superposition(size, &waves, rms_slope)
}

/// Number of waves: the sum of many independent waves has nearly Gaussian slopes.
const RIDGE_WAVES: u64 = 24;
const BUMP_WAVES: u64 = 48;
/// Minimum and maximum wavelength, in texels.
const SHORTEST_WAVE: f64 = 12.0;
const LONGEST_WAVE: f64 = 40.0;

/// A cosine over the map, with an integer number of periods each way.
struct Wave {
    cycles: [f64; 2],
    phase: f64,
}

impl Wave {
    fn ridge(index: u64, size: usize, seed: u64) -> Self {
        let [length, phase, _] = random(seed, index);
        let cycles = size as f64 / (SHORTEST_WAVE + length * (LONGEST_WAVE - SHORTEST_WAVE));
        Self { cycles: [cycles.round().max(1.0), 0.0], phase: phase * TAU }
    }

    fn bump(index: u64, size: usize, seed: u64) -> Self {
        let [length, phase, turn] = random(seed, index);
        let cycles = size as f64 / (SHORTEST_WAVE + length * (LONGEST_WAVE - SHORTEST_WAVE));
        // Directions are evenly distributed, with some randomness, so that the bumps have no preferred direction.
        let angle = (index as f64 + turn) * TAU / BUMP_WAVES as f64;
        let [x, y] = [(cycles * angle.cos()).round(), (cycles * angle.sin()).round()];
        Self { cycles: if x == 0.0 && y == 0.0 { [1.0, 0.0] } else { [x, y] }, phase: phase * TAU }
    }
}

/// The sum of waves of equal root mean square slope, whose total has the requested one.
fn superposition(size: usize, waves: &[Wave], rms_slope: f64) -> Pattern {
    let frequency = TAU / size as f64;
    // The slope of a cosine of amplitude a and wave number k has mean square (a k)^2 / 2.
    let slope_amplitude = rms_slope * (2.0 / waves.len() as f64).sqrt();
    Pattern::of(size, |x, y| {
        let height = |wave: &Wave| {
            let [kx, ky] = wave.cycles.map(|cycles| cycles * frequency);
            slope_amplitude / kx.hypot(ky) * (kx * x + ky * y + wave.phase).cos()
        };
        waves.iter().map(height).sum()
    })
}

/// Three numbers in 0 .. 1 from a seed and an index (SplitMix64).
fn random(seed: u64, index: u64) -> [f64; 3] {
    std::array::from_fn(|i| {
        let counter = (3 * index + i as u64 + 1).wrapping_mul(GOLDEN_RATIO);
        let bits = scrambled(seed.wrapping_add(counter).wrapping_mul(0xd134_2543_de82_ef95));
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    })
}

#[cfg(test)]
mod tests {
    use roughcast::{Bake, Moments};

    use super::*;

    const SIZE: usize = 256;
    const SLOPE: f64 = 0.25;

    /// The moments of the whole map, computed by the library.
    fn whole(pattern: &Pattern) -> Moments {
        let bake = Bake::of(&pattern.heights).source(pattern.source_options());
        bake.moments().expect("a map").last().expect("a level").moments()[0]
    }

    #[test]
    fn random_patterns_have_the_requested_slopes() {
        // Waves that happen to be equal add up with random phases, and the Sobel filter weakens the shortest waves
        // (sin(k)/k at 12 texels: 5 %).
        const CHANCE: f64 = 0.15;
        let ridges = whole(&random_ridges(SIZE, SLOPE, 1)).covariance();
        assert!((f64::from(ridges.xx).sqrt() / SLOPE - 1.0).abs() < CHANCE, "{ridges:?}");
        assert!(ridges.yy < 1e-9 && ridges.xy.abs() < 1e-6, "{ridges:?}");
        let bumps = whole(&random_bumps(SIZE, SLOPE, 1)).covariance();
        assert!((f64::from(bumps.trace()).sqrt() / SLOPE - 1.0).abs() < CHANCE, "{bumps:?}");
        assert!((f64::from(bumps.xx / bumps.yy) - 1.0).abs() < 2.0 * CHANCE, "{bumps:?}");
        assert!(f64::from(bumps.xy.abs()) < CHANCE * f64::from(bumps.xx), "{bumps:?}");
    }

    #[test]
    fn every_pattern_has_zero_mean_slope_and_repeats_without_a_seam() {
        let patterns = [
            raised_checker(SIZE, 8, 4.0, 0.5),
            v_grooves(SIZE, 16, 0.4),
            random_ridges(SIZE, SLOPE, 2),
            random_bumps(SIZE, SLOPE, 2),
        ];
        for pattern in patterns {
            let mean = whole(&pattern).mean;
            assert!(mean.x.abs() < 1e-5 && mean.y.abs() < 1e-5, "{mean:?}");
        }
    }

    #[test]
    fn grooves_and_edges_have_their_slopes() {
        // Away from the kinks. The three texels around each of the 32 kinks in 256 columns see both sides.
        let grooves = whole(&v_grooves(SIZE, 16, 0.4)).covariance();
        assert!((grooves.xx / 0.16 - 1.0).abs() < 0.2, "{grooves:?}");
        let heights = raised_checker(SIZE, 8, 4.0, 0.5).heights;
        let Samples::F32(heights) = heights.samples() else { panic!("floats") };
        let highest = heights.iter().fold(0.0_f32, |a, b| a.max(*b)) * SIZE as f32;
        assert_eq!(highest, 2.0); // four texels at one half
    }
}
