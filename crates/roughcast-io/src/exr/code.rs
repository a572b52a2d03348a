//! The code of a deflate block (RFC 1951, 3.2.7), built from the symbol frequencies.

use super::bits::{BitWriter, Entry, entry};
use super::huffman::{MAX_SYMBOLS, code_lengths, reversed_codes};

/// Maximum length of literal and length codes, so that four literals always fit in the bit buffer.
const LONGEST_CODE: usize = 12;
/// Code lengths are themselves coded, in at most this many bits (RFC 1951, 3.2.7).
const LONGEST_LENGTH_CODE: usize = 7;
pub(super) const LITERALS: usize = 256;
pub(super) const END_OF_BLOCK: usize = 256;
pub(super) const FIRST_LENGTH_SYMBOL: usize = 257;
/// Bytes per word. Runs are found in whole words: every byte of a run equals the byte before the run. Finding runs at
/// every byte takes twice the time and saves 3 % of the file.
pub(super) const WORD: usize = 8;
/// Deflate's longest match is 258 bytes.
pub(super) const MOST_RUN_WORDS: usize = 258 / WORD;
/// Number of distances with a code. Only the first is used, but not every decoder accepts a code with a single symbol.
const DISTANCE_LENGTHS: [u8; 2] = [1, 1];
/// The order of the code lengths of the code-length code (RFC 1951, 3.2.7).
const DESCRIPTION_ORDER: [u8; 19] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/// Extra bits of each length symbol, and its shortest match (RFC 1951, 3.2.5). The longest match of 258 bytes, which
/// has a symbol of its own, is not a number of whole words.
const EXTRA_BITS: [u8; 28] =
    [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5];
const SHORTEST: [usize; 28] = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195,
    227,
];

/// Index among the length symbols for a run of `words`.
const fn length_of_run(words: usize) -> usize {
    let mut index = SHORTEST.len() - 1;
    while SHORTEST[index] > words * WORD {
        index -= 1;
    }
    index
}

/// [`length_of_run`] for one word and more.
pub(super) const LENGTH_OF_RUN: [usize; MOST_RUN_WORDS] = {
    let mut table = [0; MOST_RUN_WORDS];
    let mut index = 0;
    while index < table.len() {
        table[index] = length_of_run(index + 1);
        index += 1;
    }
    table
};

/// The code of one block: literals and lengths according to their counts, and distances, of which only one is used.
pub(super) struct Code {
    lengths: [u8; MAX_SYMBOLS],
    codes: [u16; MAX_SYMBOLS],
    /// Number of literal and length symbols up to the last one used.
    stated: usize,
    description: Vec<Described>,
    description_lengths: [u8; DESCRIPTION_ORDER.len()],
}

impl Code {
    pub(super) fn new(counts: &[u32; MAX_SYMBOLS]) -> Self {
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

    /// Size in bits of a whole block with these symbol counts.
    pub(super) fn block_bits(&self, counts: &[u32; MAX_SYMBOLS]) -> usize {
        let symbols: usize =
            counts.iter().zip(&self.lengths).map(|(n, l)| *n as usize * usize::from(*l)).sum();
        let run_counts = &counts[FIRST_LENGTH_SYMBOL..];
        let runs: usize =
            run_counts.iter().zip(EXTRA_BITS).map(|(n, extra)| *n as usize * (usize::from(extra) + 1)).sum();
        let description = self.description.iter();
        let described: usize = description
            .map(|d| usize::from(self.description_lengths[usize::from(d.symbol)] + d.extra_bits))
            .sum();
        3 + 5 + 5 + 4 + 3 * self.description_stated() + described + symbols + runs
    }

    /// How many of the lengths in [`DESCRIPTION_ORDER`] are written: up to the last one used, at least four.
    fn description_stated(&self) -> usize {
        let used = |symbol: &u8| self.description_lengths[usize::from(*symbol)] > 0;
        DESCRIPTION_ORDER.iter().rposition(used).map_or(0, |last| last + 1).max(4)
    }

    /// The head of a block with dynamic codes (RFC 1951, 3.2.7).
    pub(super) fn put(&self, bits: &mut BitWriter) {
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

    /// The bits for each literal.
    pub(super) fn of_literals(&self) -> [Entry; LITERALS] {
        std::array::from_fn(|literal| self.of_symbol(literal))
    }

    pub(super) fn of_end(&self) -> Entry {
        self.of_symbol(END_OF_BLOCK)
    }

    fn of_symbol(&self, symbol: usize) -> Entry {
        entry(u32::from(self.codes[symbol]), u32::from(self.lengths[symbol]))
    }

    /// The bits for each run, indexed by the number of words minus one.
    pub(super) fn of_runs(&self) -> [Entry; MOST_RUN_WORDS] {
        std::array::from_fn(|index| {
            let (extra_bits, shortest) = (EXTRA_BITS[LENGTH_OF_RUN[index]], SHORTEST[LENGTH_OF_RUN[index]]);
            let symbol = FIRST_LENGTH_SYMBOL + LENGTH_OF_RUN[index];
            let (code, length) = (u32::from(self.codes[symbol]), u32::from(self.lengths[symbol]));
            let extra = ((index + 1) * WORD - shortest) as u32;
            // The code of distance one is a single zero bit.
            entry(code | extra << length, length + u32::from(extra_bits) + 1)
        })
    }
}

/// One entry of the encoded code lengths: a symbol and the extra bits that follow it.
struct Described {
    symbol: u8,
    extra: u8,
    extra_bits: u8,
}

/// Run-length encodes code lengths (RFC 1951, 3.2.7).
fn describe(lengths: &[u8]) -> Vec<Described> {
    let mut description = Vec::with_capacity(lengths.len());
    for run in lengths.chunk_by(|a, b| a == b) {
        let length = run[0];
        let literal = Described { symbol: length, extra: 0, extra_bits: 0 };
        let mut left = run.len();
        if length > 0 {
            // A repeat refers to the previous length, so the first must be written literally.
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
