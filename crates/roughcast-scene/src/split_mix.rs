//! Reproducible pseudo-random numbers.

/// Scrambles 64 bits so that adjacent inputs give unrelated outputs; a bijection (the output function of SplitMix64, by
/// S. Vigna).
pub(crate) fn scrambled(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The increment of SplitMix64; counters are multiplied by it before they are scrambled.
pub(crate) const GOLDEN_RATIO: u64 = 0x9e37_79b9_7f4a_7c15;
