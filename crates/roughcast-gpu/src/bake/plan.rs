//! Which levels each dispatch makes.
//!
//! A dispatch writes as many levels as the device binds storage textures (four per stage by WebGPU's defaults, many
//! more natively) and workgroup memory allow. Averages are computed in the same order as on the CPU.

use roughcast::{level_sizes, levels_of_four};

/// Maximum number of halvings that one workgroup makes: two in the registers of a thread, four in workgroup memory.
pub(super) const MOST_HALVINGS: u32 = 6;

/// How a level is computed from the previous one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Average {
    /// Equal averages of four texels, rows first, as in the CPU's fused pass.
    OfFour,
    /// Equal averages of four texels, columns first, as in the CPU's weighted pass if both sides are even.
    OfFourWeighted,
    /// Averages weighted by coverage, for levels of any size.
    Weighted,
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Step {
    /// The level that is read. Level 0 is the map itself.
    pub input: u32,
    /// The first level that is written: for the first dispatch the input level itself, otherwise the one after it.
    pub first: u32,
    /// The last level that is written.
    pub last: u32,
    pub average: Average,
}

impl Step {
    /// The levels that the dispatch writes.
    pub fn levels(&self) -> std::ops::RangeInclusive<u32> {
        self.first..=self.last
    }

    /// Number of halvings from the input level to the last level.
    pub fn halvings(&self) -> u32 {
        self.last - self.input
    }
}

/// The dispatches for a map of this size if each may write up to this many levels (at least one).
pub(super) fn steps(width: u32, height: u32, levels_a_step: u32) -> Vec<Step> {
    let sizes = level_sizes(width as usize, height as usize);
    let last = sizes.len() as u32 - 1;
    let of_four = levels_of_four(width as usize, height as usize) as u32;
    // The first dispatch also writes level 0.
    let first_end = of_four.min(levels_a_step - 1).min(MOST_HALVINGS);
    let mut steps = vec![Step { input: 0, first: 0, last: first_end, average: Average::OfFour }];
    let mut made = first_end;
    while made < last {
        let (width, height) = sizes[made as usize];
        let even = width.trailing_zeros().min(height.trailing_zeros());
        let (average, halvings) = if made < of_four {
            (Average::OfFour, of_four - made)
        } else if even > 0 {
            (Average::OfFourWeighted, even)
        } else {
            (Average::Weighted, 1)
        };
        let end = made + halvings.min(levels_a_step).min(MOST_HALVINGS);
        steps.push(Step { input: made, first: made + 1, last: end, average });
        made = end;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_map_takes_two_dispatches() {
        let step = |input, first, last, average| Step { input, first, last, average };
        let expected = [step(0, 0, 6, Average::OfFour), step(6, 7, 12, Average::OfFourWeighted)];
        assert_eq!(steps(4096, 4096, 32), expected);
    }

    #[test]
    fn every_level_is_written_once_for_every_size_and_limit() {
        for (width, height) in [(1, 1), (1, 7), (64, 64), (256, 128), (100, 60), (127, 33), (4096, 2)] {
            for limit in [1, 2, 4, 7, 32] {
                let steps = steps(width, height, limit);
                let written: Vec<u32> = steps.iter().flat_map(Step::levels).collect();
                let levels = level_sizes(width as usize, height as usize).len() as u32;
                assert_eq!(written, (0..levels).collect::<Vec<_>>(), "{width}x{height}, {limit}");
                assert!(steps.iter().all(|step| step.levels().count() as u32 <= limit));
                assert!(steps.windows(2).all(|pair| pair[1].input == pair[0].last));
            }
        }
    }

    #[test]
    fn odd_sizes_are_weighted() {
        let steps = steps(7, 4, 32);
        assert_eq!(steps[1], Step { input: 0, first: 1, last: 1, average: Average::Weighted });
        assert_eq!(steps[2].average, Average::Weighted); // 3x2
    }
}
