//! OpenEXR's ZIP compression of one block: even and odd bytes separated, differences, deflate.
//!
//! Source: OpenEXR's "Technical Introduction" and the layout of `internal_zip.c`. Decompression is here too.

use super::deflate::Deflater;

/// Compresses one block after another, reusing its buffers.
pub(super) struct BlockCompressor {
    sorted: Vec<u8>,
    differences: Vec<u8>,
    deflater: Deflater,
}

impl BlockCompressor {
    pub(super) fn new() -> Self {
        Self { sorted: Vec::new(), differences: Vec::new(), deflater: Deflater::new() }
    }

    /// The stored form of a block's bytes: compressed, or the bytes themselves if compression would not shorten them.
    /// Readers distinguish the two by their size.
    pub(super) fn compress<'a>(&'a mut self, block: &'a [u8]) -> &'a [u8] {
        sort_by_place(block, &mut self.sorted);
        take_differences(&self.sorted, &mut self.differences);
        // The two halves differ: the low bytes of samples are nearly noise, the high ones nearly constant.
        let packed = self.deflater.zlib(&self.differences, block.len() / 2);
        if packed.len() < block.len() { packed } else { block }
    }
}

/// Even bytes first, then the odd ones. Samples have an even number of bytes, so blocks do too.
fn sort_by_place(block: &[u8], sorted: &mut Vec<u8>) {
    sorted.resize(block.len(), 0);
    let (even, odd) = sorted.split_at_mut(block.len() / 2);
    let (pairs, _) = block.as_chunks::<2>();
    // One half after the other, using shifts: the compiler vectorises only this form.
    for (even, pair) in even.iter_mut().zip(pairs) {
        *even = u16::from_le_bytes(*pair) as u8;
    }
    for (odd, pair) in odd.iter_mut().zip(pairs) {
        *odd = (u16::from_le_bytes(*pair) >> 8) as u8;
    }
}

/// Each byte minus the previous one, plus 128.
fn take_differences(bytes: &[u8], differences: &mut Vec<u8>) {
    differences.resize(bytes.len(), 0);
    differences[0] = bytes[0];
    for (difference, pair) in differences[1..].iter_mut().zip(bytes.windows(2)) {
        *difference = pair[1].wrapping_sub(pair[0]).wrapping_add(128);
    }
}

/// The `size` bytes of a block that [`BlockCompressor::compress`] shortened; `None` if `packed` does not contain as
/// many. `size` is even and not zero.
pub(super) fn inflate(
    packed: &[u8],
    size: usize,
    inflater: &mut libdeflater::Decompressor,
) -> Option<Vec<u8>> {
    let mut sorted = vec![0; size];
    let inflated = inflater.zlib_decompress(packed, &mut sorted).ok()?;
    if inflated != size {
        return None;
    }
    let mut before = sorted[0];
    for byte in &mut sorted[1..] {
        before = before.wrapping_add(*byte).wrapping_sub(128);
        *byte = before;
    }
    let (even, odd) = sorted.split_at(size / 2);
    Some(even.iter().zip(odd).flat_map(|(even, odd)| [*even, *odd]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_sorted_and_differenced_as_openexr_does() {
        let (mut sorted, mut differences) = (Vec::new(), Vec::new());
        sort_by_place(&[1, 10, 2, 20, 4, 40], &mut sorted);
        assert_eq!(sorted, [1, 2, 4, 10, 20, 40]);
        take_differences(&sorted, &mut differences);
        assert_eq!(differences, [1, 129, 130, 134, 138, 148]);
    }

    #[test]
    fn blocks_inflate_to_their_input() {
        let block: Vec<u8> = (0..2000_u32).flat_map(|n| (n / 7 * n).to_le_bytes()).collect();
        let mut compressor = BlockCompressor::new();
        let packed = compressor.compress(&block).to_vec();
        assert!(packed.len() < block.len());
        let mut inflater = libdeflater::Decompressor::new();
        assert_eq!(inflate(&packed, block.len(), &mut inflater), Some(block.clone()));
        assert_eq!(inflate(&packed, block.len() - 2, &mut inflater), None);
        assert_eq!(inflate(&packed, block.len() + 2, &mut inflater), None);
        assert_eq!(inflate(&packed[1..], block.len(), &mut inflater), None);
    }

    #[test]
    fn a_block_that_does_not_shrink_is_kept() {
        let mut compressor = BlockCompressor::new();
        assert_eq!(compressor.compress(&[3, 250]), [3, 250]);
        assert!(compressor.compress(&[5; 1000]).len() < 100);
    }
}
