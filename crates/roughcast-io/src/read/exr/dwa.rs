//! Checks the counts at the head of a DWA block against the pixels of the block.
//!
//! The `exr` crate allocates by these counts before it looks at the data, so a damaged block could ask for any amount
//! of memory. The layout follows OpenEXR's `internal_dwa_compressor.h`.

use super::super::memory::malformed;
use super::FORMAT;
use crate::ReadError;

/// Number of 64-bit values at the head of a block.
const COUNTS: usize = 11;
/// Side of a cosine-transform block in pixels.
const DCT_SIDE: u64 = 8;

/// Checks that the counts of one block are possible.
///
/// `width` and `height` are the size of the block in pixels, `channels` is the number of channels in the file, and
/// `raw_bytes` is the uncompressed size of the block in bytes.
///
/// # Errors
/// [`ReadError::Malformed`] if the head is truncated or states more than the pixels can need.
pub(super) fn check(
    block: &[u8],
    width: usize,
    height: usize,
    channels: usize,
    raw_bytes: usize,
) -> Result<(), ReadError> {
    let head =
        block.get(..COUNTS * 8).ok_or_else(|| malformed(FORMAT, "a DWA block ends within its head"))?;
    let count = |i: usize| u64::from_le_bytes(std::array::from_fn(|byte| head[i * 8 + byte]));
    let transforms = (width as u64).div_ceil(DCT_SIDE) * (height as u64).div_ceil(DCT_SIDE) * channels as u64;
    let raw_bytes = raw_bytes as u64;
    let unpacked = [
        ("unknown bytes", count(1), raw_bytes),
        // A run of one byte takes two.
        ("packed run lengths", count(6), 2 * raw_bytes),
        ("run lengths", count(7), raw_bytes),
        ("AC coefficients", count(8), transforms * DCT_SIDE * DCT_SIDE),
        ("DC coefficients", count(9), transforms),
    ];
    for (what, stated, most) in unpacked {
        if stated > most {
            let fault = format!("a DWA block of {width}x{height} pixels states {stated} {what}");
            return Err(malformed(FORMAT, fault));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(counts: [u64; COUNTS]) -> Vec<u8> {
        counts.iter().flat_map(|count| count.to_le_bytes()).collect()
    }

    #[test]
    fn counts_above_what_the_pixels_need_are_refused() {
        // 9x8 pixels of 3 half channels: 432 bytes, and two transforms per channel.
        let most = [2, 432, 0, 0, 0, 0, 864, 432, 384, 6, 0];
        check(&head(most), 9, 8, 3, 432).unwrap();
        for i in [1, 6, 7, 8, 9] {
            let mut more = most;
            more[i] += 1;
            assert!(check(&head(more), 9, 8, 3, 432).is_err(), "count {i}");
        }
        assert!(check(&head(most)[1..], 9, 8, 3, 432).is_err());
    }
}
