//! A zlib stream (RFC 1950, RFC 1951) made of Huffman codes and runs alone.
//!
//! A compressor that looks for repeats everywhere finds next to none in the differences that ZIP tiles consist of: besides
//! runs of one byte they are noise. Leaving the search out makes this more than twice as fast as libdeflate's fastest
//! level on maps of slopes, for files that are about 3 % larger; only textures with large exact repeats lose more.

use super::huffman::{MAX_SYMBOLS, code_lengths, reversed_codes};

/// Literal and length codes are cut at this length, so that four literals always fit in the bit buffer.
const LONGEST_CODE: usize = 12;
/// Code lengths are themselves coded, in at most this many bits (RFC 1951, 3.2.7).
const LONGEST_LENGTH_CODE: usize = 7;
const LITERALS: usize = 256;
const END_OF_BLOCK: usize = 256;
const FIRST_LENGTH_SYMBOL: usize = 257;
/// Bytes are looked at by words of this many: a run is a number of whole words, each byte the same as the one before the
/// first. To find runs at every byte takes twice the time and saves 3 % of the file.
const WORD: usize = 8;
/// Deflate's longest match is 258 bytes.
const MOST_RUN_WORDS: usize = 258 / WORD;
/// Most bytes of a stored block, and what each costs beside its bytes.
const STORED_BYTES: usize = 0xffff;
const STORED_OVERHEAD: usize = 5;
const ZLIB_OVERHEAD: usize = 2 + 4;
/// Where an entry of [`Code::of_runs`] or [`Code::of_literals`] keeps its number of bits.
const COUNT_SHIFT: u32 = 24;

/// Two distances have a code though only the first is used: not every decoder takes a code with a single symbol.
const DISTANCE_LENGTHS: [u8; 2] = [1, 1];
/// The order in which the lengths of the description's own code are stated (RFC 1951, 3.2.7).
const DESCRIPTION_ORDER: [u8; 19] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/// For each length symbol its extra bits and its shortest match (RFC 1951, 3.2.5). The longest match of 258 bytes, which
/// has a symbol of its own, is not a number of whole words.
const LENGTHS: [(u8, usize); 28] = [
    (0, 3),
    (0, 4),
    (0, 5),
    (0, 6),
    (0, 7),
    (0, 8),
    (0, 9),
    (0, 10),
    (1, 11),
    (1, 13),
    (1, 15),
    (1, 17),
    (2, 19),
    (2, 23),
    (2, 27),
    (2, 31),
    (3, 35),
    (3, 43),
    (3, 51),
    (3, 59),
    (4, 67),
    (4, 83),
    (4, 99),
    (4, 115),
    (5, 131),
    (5, 163),
    (5, 195),
    (5, 227),
];

/// Place in [`LENGTHS`] of a run of `words`.
const fn length_of_run(words: usize) -> usize {
    let mut index = LENGTHS.len() - 1;
    while LENGTHS[index].1 > words * WORD {
        index -= 1;
    }
    index
}

/// [`length_of_run`] for one word and more.
const LENGTH_OF_RUN: [usize; MOST_RUN_WORDS] = {
    let mut table = [0; MOST_RUN_WORDS];
    let mut index = 0;
    while index < table.len() {
        table[index] = length_of_run(index + 1);
        index += 1;
    }
    table
};

/// Compresses one block after another, keeping its memory.
pub(super) struct Deflater {
    stretches: Vec<Stretch>,
    packed: Vec<u8>,
}

impl Deflater {
    pub(super) fn new() -> Self {
        Self { stretches: Vec::new(), packed: Vec::new() }
    }

    /// `whole` as one zlib stream, with a code of its own for what comes before `split` and for the rest.
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

/// Where a block stands in its stream; the number is the bit that says so.
#[derive(Clone, Copy)]
enum Place {
    Inside = 0,
    Last = 1,
}

/// Bytes of a part that is stored as it is.
fn stored_size(len: usize) -> usize {
    len + len.div_ceil(STORED_BYTES).max(1) * STORED_OVERHEAD
}

/// Writes one part: with a code made for it, or stored where that is no longer.
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
    bits.put(u64::from(code.codes[END_OF_BLOCK]), u32::from(code.lengths[END_OF_BLOCK]));
}

/// Words as they are, then words that repeat the last byte of them. Either number can be zero.
#[derive(Clone, Copy, Default)]
struct Stretch {
    literals: usize,
    run: usize,
}

/// Splits words into stretches, and counts the symbols that they will need.
fn find_runs(words: &[[u8; WORD]], stretches: &mut Vec<Stretch>) -> [u32; MAX_SYMBOLS] {
    // Several tables, since counting the same byte twice in a row waits for the first count to arrive in memory.
    let mut lanes = [[0_u32; LITERALS]; 4];
    let mut counts = [0; MAX_SYMBOLS];
    stretches.clear();
    let mut left = words;
    // Nothing stands before the first word: a byte that it cannot repeat.
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
    literals: &[u32; LITERALS],
    runs: &[u32; MOST_RUN_WORDS],
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

/// The code of one block: for literals and lengths as counted, and for distances, of which only one is used.
struct Code {
    lengths: [u8; MAX_SYMBOLS],
    codes: [u16; MAX_SYMBOLS],
    /// Literal and length symbols up to the last that is used.
    stated: usize,
    description: Vec<Described>,
    description_lengths: [u8; DESCRIPTION_ORDER.len()],
}

impl Code {
    fn new(counts: &[u32; MAX_SYMBOLS]) -> Self {
        let mut lengths = [0; MAX_SYMBOLS];
        code_lengths(counts, LONGEST_CODE, &mut lengths);
        let mut codes = [0; MAX_SYMBOLS];
        reversed_codes(&lengths, &mut codes);
        let stated = lengths
            .iter()
            .rposition(|length| *length > 0)
            .map_or(0, |last| last + 1)
            .max(FIRST_LENGTH_SYMBOL);
        let mut stated_lengths = lengths[..stated].to_vec();
        stated_lengths.extend(DISTANCE_LENGTHS);
        let description = describe(&stated_lengths);
        let mut description_counts = [0; DESCRIPTION_ORDER.len()];
        description.iter().for_each(|described| description_counts[usize::from(described.symbol)] += 1);
        let mut description_lengths = [0; DESCRIPTION_ORDER.len()];
        code_lengths(&description_counts, LONGEST_LENGTH_CODE, &mut description_lengths);
        Self { lengths, codes, stated, description, description_lengths }
    }

    /// Bits of a whole block whose symbols were counted so.
    fn block_bits(&self, counts: &[u32; MAX_SYMBOLS]) -> usize {
        let symbols: usize =
            counts.iter().zip(&self.lengths).map(|(n, l)| *n as usize * usize::from(*l)).sum();
        let run_counts = &counts[FIRST_LENGTH_SYMBOL..];
        let runs: usize = run_counts
            .iter()
            .zip(LENGTHS)
            .map(|(n, (extra, _))| *n as usize * (usize::from(extra) + 1))
            .sum();
        let description = self.description.iter();
        let described: usize = description
            .map(|d| usize::from(self.description_lengths[usize::from(d.symbol)] + d.extra_bits))
            .sum();
        3 + 5 + 5 + 4 + 3 * self.description_stated() + described + symbols + runs
    }

    /// How many of the lengths in [`DESCRIPTION_ORDER`] are stated: up to the last that is used, at least four.
    fn description_stated(&self) -> usize {
        let used = |symbol: &u8| self.description_lengths[usize::from(*symbol)] > 0;
        DESCRIPTION_ORDER.iter().rposition(used).map_or(0, |last| last + 1).max(4)
    }

    /// The head of a block with dynamic codes (RFC 1951, 3.2.7).
    fn put(&self, bits: &mut BitWriter) {
        let description_stated = self.description_stated();
        bits.put((self.stated - FIRST_LENGTH_SYMBOL) as u64, 5);
        bits.put(DISTANCE_LENGTHS.len() as u64 - 1, 5);
        bits.put(description_stated as u64 - 4, 4);
        for symbol in &DESCRIPTION_ORDER[..description_stated] {
            bits.put(u64::from(self.description_lengths[usize::from(*symbol)]), 3);
        }
        let mut codes = [0; DESCRIPTION_ORDER.len()];
        reversed_codes(&self.description_lengths, &mut codes);
        for described in &self.description {
            let symbol = usize::from(described.symbol);
            bits.put(u64::from(codes[symbol]), u32::from(self.description_lengths[symbol]));
            bits.put(u64::from(described.extra), u32::from(described.extra_bits));
        }
    }

    /// What each literal is written as: its bits, and in the highest byte their number.
    fn of_literals(&self) -> [u32; LITERALS] {
        std::array::from_fn(|literal| entry(u32::from(self.codes[literal]), u32::from(self.lengths[literal])))
    }

    /// What a run of each number of words, less one, is written as.
    fn of_runs(&self) -> [u32; MOST_RUN_WORDS] {
        std::array::from_fn(|index| {
            let (extra_bits, shortest) = LENGTHS[LENGTH_OF_RUN[index]];
            let symbol = FIRST_LENGTH_SYMBOL + LENGTH_OF_RUN[index];
            let (code, length) = (u32::from(self.codes[symbol]), u32::from(self.lengths[symbol]));
            let extra = ((index + 1) * WORD - shortest) as u32;
            // The code of distance one is a single zero bit.
            entry(code | extra << length, length + u32::from(extra_bits) + 1)
        })
    }
}

fn entry(bits: u32, count: u32) -> u32 {
    bits | count << COUNT_SHIFT
}

/// A step of the description of code lengths: its symbol and the extra bits that follow it.
struct Described {
    symbol: u8,
    extra: u8,
    extra_bits: u8,
}

/// Code lengths with their repeats written short (RFC 1951, 3.2.7).
fn describe(lengths: &[u8]) -> Vec<Described> {
    let mut description = Vec::with_capacity(lengths.len());
    for run in lengths.chunk_by(|a, b| a == b) {
        let length = run[0];
        let literal = Described { symbol: length, extra: 0, extra_bits: 0 };
        let mut left = run.len();
        if length > 0 {
            // A repeat refers to the length before it, so the first must stand there.
            description.push(literal);
            left -= 1;
        }
        while left > 0 {
            let (step, described) = match (length, left) {
                (0, 11..) => (left.min(138), (18, 11, 7)),
                (0, 3..) => (left, (17, 3, 3)),
                (1.., 3..) => (left.min(6), (16, 3, 2)),
                _ => (1, (length, 1, 0)),
            };
            let (symbol, least, extra_bits) = described;
            description.push(Described { symbol, extra: (step - least) as u8, extra_bits });
            left -= step;
        }
    }
    description
}

/// A part as it is (RFC 1951, 3.2.4).
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

/// Writes bits from the lowest on. The slice must have room for eight bytes more than are written.
struct BitWriter<'a> {
    out: &'a mut [u8],
    position: usize,
    pending: u64,
    count: u32,
}

impl<'a> BitWriter<'a> {
    fn new(out: &'a mut [u8]) -> Self {
        Self { out, position: 0, pending: 0, count: 0 }
    }

    /// Takes an entry of [`Code::of_literals`], four between two flushes, or one of [`Code::of_runs`].
    fn add_entry(&mut self, entry: u32) {
        self.pending |= u64::from(entry & ((1 << COUNT_SHIFT) - 1)) << self.count;
        self.count += entry >> COUNT_SHIFT;
    }

    fn put_entry(&mut self, entry: u32) {
        self.add_entry(entry);
        self.flush();
    }

    /// Moves whole bytes out; fewer than eight bits stay.
    fn flush(&mut self) {
        self.out[self.position..][..8].copy_from_slice(&self.pending.to_le_bytes());
        self.position += (self.count / 8) as usize;
        self.pending >>= self.count & !7;
        self.count &= 7;
    }

    fn put(&mut self, value: u64, count: u32) {
        self.pending |= value << self.count;
        self.count += count;
        self.flush();
    }

    /// Fills the last byte with zeros.
    fn align(&mut self) {
        self.count = self.count.next_multiple_of(8);
        self.flush();
    }

    fn bytes(&mut self, bytes: &[u8]) {
        debug_assert_eq!(self.count, 0);
        self.out[self.position..][..bytes.len()].copy_from_slice(bytes);
        self.position += bytes.len();
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

    /// A generator of bytes without pattern (xorshift).
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
    fn streams_inflate_to_what_went_in() {
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
    fn runs_of_every_length_survive() {
        for run in 1..600 {
            let mut bytes = vec![1, 2, 3];
            bytes.extend(std::iter::repeat_n(9, run));
            bytes.extend([4, 4, 5]);
            check(&bytes, 2);
            check(&bytes, 3 + run / 2);
        }
    }

    #[test]
    fn what_cannot_shrink_grows_by_its_framing_alone() {
        let noise = noise(49_152);
        assert_eq!(check(&noise, 24_576), noise.len() + ZLIB_OVERHEAD + 2 * STORED_OVERHEAD);
    }

    #[test]
    fn what_is_even_nearly_vanishes() {
        // A run of 256 bytes takes a bit for its length, five extra bits and one for its distance.
        let even = vec![128; 49_152];
        assert!(check(&even, 24_576) < 49_152 / 256 + 64);
    }
}
