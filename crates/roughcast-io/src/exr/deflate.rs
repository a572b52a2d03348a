//! A zlib stream (RFC 1950, RFC 1951) that uses only Huffman codes and runs.
//!
//! A general match search finds almost nothing in the differences that ZIP tiles consist of: apart from runs of one
//! byte they are noise. Without the search, this is more than twice as fast as libdeflate's fastest level on maps of
//! slopes, and files are a few per cent larger; only textures with large exact repeats lose more.

use super::bits::{BitWriter, Entry};
use super::code::{Code, END_OF_BLOCK, FIRST_LENGTH_SYMBOL, LENGTH_OF_RUN, LITERALS, MOST_RUN_WORDS, WORD};
use super::huffman::MAX_SYMBOLS;

/// Maximum number of bytes in a stored block, and the overhead of each block.
const STORED_BYTES: usize = 0xffff;
const STORED_OVERHEAD: usize = 5;
const ZLIB_OVERHEAD: usize = 2 + 4;

/// Compresses one block after another, reusing its buffers.
pub(super) struct Deflater {
    stretches: Vec<Stretch>,
    packed: Vec<u8>,
}

impl Deflater {
    pub(super) fn new() -> Self {
        Self { stretches: Vec::new(), packed: Vec::new() }
    }

    /// Compresses `whole` into one zlib stream, with separate codes for the bytes before `split` and for the rest.
    pub(super) fn zlib<'a>(&'a mut self, whole: &[u8], split: usize) -> &'a [u8] {
        let (first, second) = whole.split_at(split);
        self.packed.clear();
        let largest = ZLIB_OVERHEAD + stored_size(first.len()) + stored_size(second.len());
        self.packed.resize(largest + WORD, 0);
        let mut bits = BitWriter::new(&mut self.packed);
        // Deflate with a window of 32 KiB, the fastest kind of compressor (RFC 1950, 2.2).
        bits.put(0x0178, 16);
        put_block(first, Place::Inside, &mut self.stretches, &mut bits);
        put_block(second, Place::Last, &mut self.stretches, &mut bits);
        bits.align();
        bits.bytes(&libdeflater::adler32(whole).to_be_bytes());
        let size = bits.position;
        &self.packed[..size]
    }
}

/// The position of a block in its stream; the number is the value of its BFINAL bit.
#[derive(Clone, Copy)]
enum Place {
    Inside = 0,
    Last = 1,
}

/// Size in bytes of a part that is stored uncompressed.
fn stored_size(len: usize) -> usize {
    len + len.div_ceil(STORED_BYTES).max(1) * STORED_OVERHEAD
}

/// Writes one part with its own code, or stored if that is not longer.
fn put_block(part: &[u8], place: Place, stretches: &mut Vec<Stretch>, bits: &mut BitWriter) {
    let (words, rest) = part.as_chunks::<WORD>();
    let mut counts = find_runs(words, stretches);
    rest.iter().for_each(|literal| counts[usize::from(*literal)] += 1);
    counts[END_OF_BLOCK] = 1;
    let code = Code::new(&counts);
    if code.block_bits(&counts) >= 8 * part.len() {
        put_stored(part, place, bits);
        return;
    }
    bits.put(place as u64 | 0b10 << 1, 3);
    code.put(bits);
    let literals = code.of_literals();
    put_stretches(words, stretches, &literals, &code.of_runs(), bits);
    rest.iter().for_each(|literal| bits.put_entry(literals[usize::from(*literal)]));
    bits.put_entry(code.of_end());
}

/// Literal words, followed by words that repeat the last literal byte. Either count can be zero.
#[derive(Clone, Copy, Default)]
struct Stretch {
    literals: usize,
    run: usize,
}

/// Splits words into stretches and counts the symbols they need.
fn find_runs(words: &[[u8; WORD]], stretches: &mut Vec<Stretch>) -> [u32; MAX_SYMBOLS] {
    // Several tables, since counting the same byte twice in a row stalls until the first count has been stored.
    let mut lanes = [[0_u32; LITERALS]; 4];
    let mut counts = [0; MAX_SYMBOLS];
    stretches.clear();
    let mut left = words;
    // No byte precedes the first word: use one that it cannot repeat.
    let mut before = words.first().map_or(0, |word| !word[0]);
    while !left.is_empty() {
        let mut literals = 0;
        while literals < left.len() && left[literals] != [before; WORD] {
            for (index, literal) in left[literals].iter().enumerate() {
                lanes[index % 4][usize::from(*literal)] += 1;
            }
            before = left[literals][WORD - 1];
            literals += 1;
        }
        let repeats = |word: &&[u8; WORD]| **word == [before; WORD];
        let run = left[literals..].iter().take(MOST_RUN_WORDS).take_while(repeats).count();
        if run > 0 {
            counts[FIRST_LENGTH_SYMBOL + LENGTH_OF_RUN[run - 1]] += 1;
        }
        stretches.push(Stretch { literals, run });
        left = &left[literals + run..];
    }
    for lane in &lanes {
        counts.iter_mut().zip(lane).for_each(|(count, more)| *count += more);
    }
    counts
}

fn put_stretches(
    words: &[[u8; WORD]],
    stretches: &[Stretch],
    literals: &[Entry; LITERALS],
    runs: &[Entry; MOST_RUN_WORDS],
    bits: &mut BitWriter,
) {
    let mut left = words;
    for stretch in stretches {
        for word in &left[..stretch.literals] {
            for half in word.as_chunks::<{ WORD / 2 }>().0 {
                half.iter().for_each(|literal| bits.add_entry(literals[usize::from(*literal)]));
                bits.flush();
            }
        }
        if stretch.run > 0 {
            bits.put_entry(runs[stretch.run - 1]);
        }
        left = &left[stretch.literals + stretch.run..];
    }
}

/// Writes a part uncompressed (RFC 1951, 3.2.4).
fn put_stored(part: &[u8], place: Place, bits: &mut BitWriter) {
    let mut left = part;
    loop {
        let (piece, rest) = left.split_at(left.len().min(STORED_BYTES));
        let place = if rest.is_empty() { place } else { Place::Inside };
        bits.put(place as u64, 3);
        bits.align();
        let length = piece.len() as u16;
        bits.bytes(&length.to_le_bytes());
        bits.bytes(&(!length).to_le_bytes());
        bits.bytes(piece);
        left = rest;
        if left.is_empty() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inflated(zlib: &[u8], len: usize) -> Vec<u8> {
        let mut out = vec![0; len];
        let size =
            libdeflater::Decompressor::new().zlib_decompress(zlib, &mut out).expect("a valid zlib stream");
        assert_eq!(size, len);
        out
    }

    fn check(whole: &[u8], split: usize) -> usize {
        let mut deflater = Deflater::new();
        let packed = deflater.zlib(whole, split).to_vec();
        assert_eq!(inflated(&packed, whole.len()), whole);
        packed.len()
    }

    /// A pseudo-random byte generator (xorshift).
    fn noise(len: usize) -> Vec<u8> {
        let mut state = 0x2545_f491_4f6c_dd1d_u64;
        let mut step = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 32) as u8
        };
        (0..len).map(|_| step()).collect()
    }

    #[test]
    fn streams_inflate_to_their_input() {
        let noise = noise(200_000);
        check(&[], 0);
        check(&[7], 0);
        check(&[7], 1);
        check(&noise, 100_000);
        check(&noise[..65_536], 65_536);
        let skewed: Vec<u8> = noise.iter().map(|b| 128 + b.leading_zeros() as u8).collect();
        let mixed: Vec<u8> = skewed.iter().chain(&noise).copied().collect();
        check(&skewed, 77);
        check(&mixed, skewed.len());
        check(&mixed, skewed.len() + 1);
    }

    #[test]
    fn runs_of_every_length_round_trip() {
        for run in 1..600 {
            let mut bytes = vec![1, 2, 3];
            bytes.extend(std::iter::repeat_n(9, run));
            bytes.extend([4, 4, 5]);
            check(&bytes, 2);
            check(&bytes, 3 + run / 2);
        }
    }

    #[test]
    fn incompressible_data_grows_only_by_its_framing() {
        let noise = noise(49_152);
        assert_eq!(check(&noise, 24_576), noise.len() + ZLIB_OVERHEAD + 2 * STORED_OVERHEAD);
    }

    #[test]
    fn constant_data_shrinks_to_almost_nothing() {
        // A run of 256 bytes takes one bit for its length, five extra bits, and one bit for its distance.
        let even = vec![128; 49_152];
        assert!(check(&even, 24_576) < 49_152 / 256 + 64);
    }
}
