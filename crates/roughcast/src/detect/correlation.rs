//! Correlations of two quantities over an image, with their standard errors.

/// Number of blocks along each side of the image. Each block is left out once to estimate how much the correlation
/// depends on it. Real maps vary from place to place far more than their number of texels suggests, and the blocks
/// capture this variation.
const SIDE: usize = 6;

/// Sums over one block of the image.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    products: f64,
    first: f64,
    second: f64,
}

impl Sums {
    fn add(&mut self, other: Sums, sign: f64) {
        self.products += sign * other.products;
        self.first += sign * other.first;
        self.second += sign * other.second;
    }

    /// `2 E[ab] / (E[a^2] + E[b^2])`, which is 1 only if a and b are equal, not merely proportional.
    fn agreement(&self) -> f64 {
        2.0 * self.products / (self.first + self.second)
    }

    /// `E[ab] / sqrt(E[a^2] E[b^2])`, which does not depend on the scales of a and b.
    fn cosine(&self) -> f64 {
        self.products / (self.first * self.second).sqrt()
    }
}

/// Accumulates pairs of values by position.
pub(super) struct Blocks {
    sums: [Sums; SIDE * SIDE],
    pairs: usize,
}

impl Blocks {
    pub(super) fn new() -> Self {
        Self { sums: [Sums::default(); SIDE * SIDE], pairs: 0 }
    }

    /// Adds a pair at a position, given as fractions 0 .. 1 of the width and of the height.
    pub(super) fn add(&mut self, [across, down]: [f32; 2], [a, b]: [f32; 2]) {
        let index = |place: f32| ((place * SIDE as f32) as usize).min(SIDE - 1);
        let (a, b) = (f64::from(a), f64::from(b));
        let pair = Sums { products: a * b, first: a * a, second: b * b };
        self.sums[index(down) * SIDE + index(across)].add(pair, 1.0);
        self.pairs += 1;
    }

    /// Measures how close a and b are to being equal; `None` if nothing varies.
    pub(super) fn agreement(&self) -> Option<Correlation> {
        self.correlation(Sums::agreement)
    }

    /// Measures how close a and b are to being proportional; `None` if one of them does not vary.
    pub(super) fn cosine(&self) -> Option<Correlation> {
        self.correlation(Sums::cosine)
    }

    /// The statistic and its standard error, estimated with the jackknife (Efron and Stein, "The jackknife estimate of
    /// variance", 1981) from the changes when each block in turn is left out.
    fn correlation(&self, statistic: impl Fn(&Sums) -> f64) -> Option<Correlation> {
        let mut all = Sums::default();
        self.sums.iter().for_each(|sums| all.add(*sums, 1.0));
        let value = statistic(&all);
        let squares = self.sums.iter().map(|block| {
            let mut rest = all;
            rest.add(*block, -1.0);
            let change = statistic(&rest) - value;
            change * change
        });
        let blocks = (SIDE * SIDE) as f64;
        let standard_error = ((blocks - 1.0) / blocks * squares.sum::<f64>()).sqrt();
        let valid = value.is_finite() && standard_error.is_finite();
        valid.then(|| Correlation {
            value,
            standard_errors: value / standard_error.max(SMALLEST_ERROR),
            pairs: self.pairs,
        })
    }
}

/// Prevents division by zero for a perfect correlation.
const SMALLEST_ERROR: f64 = 1e-9;

/// A correlation over an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Correlation {
    /// -1 ..= 1.
    pub(super) value: f64,
    /// The value in units of its standard error: the confidence in its sign.
    pub(super) standard_errors: f64,
    /// Number of pairs it was computed from.
    pub(super) pairs: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Threshold above which the green test trusts a correlation.
    const UNSURE: f64 = 5.0;

    /// Side of the square of pairs.
    const PLACES: usize = 60;

    fn blocks(pair: impl Fn(usize, usize) -> [f32; 2]) -> Blocks {
        let mut blocks = Blocks::new();
        for y in 0..PLACES {
            for x in 0..PLACES {
                let place = [x, y].map(|at| at as f32 / PLACES as f32);
                blocks.add(place, pair(x, y));
            }
        }
        blocks
    }

    #[test]
    fn equal_values_agree_and_proportional_ones_have_a_cosine_of_one() {
        let wave = |x: usize, y: usize| ((x * 7 + y * 3) as f32).sin();
        let same = blocks(|x, y| [wave(x, y); 2]).agreement().expect("it varies");
        assert!((same.value - 1.0).abs() < 1e-12 && same.standard_errors > 1e6, "{same:?}");
        let tripled = blocks(|x, y| [wave(x, y), -3.0 * wave(x, y)]);
        // 2 · (-3) / (1 + 9).
        assert!((tripled.agreement().expect("it varies").value + 0.6).abs() < 1e-6);
        assert!((tripled.cosine().expect("it varies").value + 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_correlation_from_a_single_block_is_not_significant() {
        // In one of the 36 blocks a and b are equal and large; elsewhere they are unrelated and small.
        let one = blocks(|x, y| {
            let noise = |seed: usize| (((x * 31 + y * 57 + seed) * 2_654_435) % 1000) as f32 / 1000.0 - 0.5;
            if x < 10 && y < 10 { [10.0 * noise(1); 2] } else { [noise(1), noise(500)] }
        });
        let found = one.agreement().expect("it varies");
        // Without that block nothing is left, so the standard error is nearly the value times the square root of 35/36.
        assert!(found.value > 0.5 && found.standard_errors.abs() < UNSURE, "{found:?}");
    }

    #[test]
    fn constant_data_gives_no_correlation() {
        assert_eq!(blocks(|_, _| [0.0; 2]).agreement(), None);
        assert_eq!(blocks(|x, _| [x as f32, 0.0]).cosine(), None);
    }
}
