//! Small changes that turn a valid file into a hostile one.

/// A random number generator with the same sequence on every machine (Marsaglia's xorshift).
pub struct Random(u64);

impl Random {
    /// The sequence of `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// The next number.
    pub fn number(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }

    /// A number below `end`, which must not be 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.number() % end as u64) as usize
    }
}

/// Numbers that break readers: the limits of every width, and powers of two that overflow when multiplied.
const INTERESTING: [u64; 20] = [
    0,
    1,
    2,
    3,
    4,
    5,
    0x7f,
    0x80,
    0xff,
    0x100,
    0x7fff,
    0xffff,
    0x1_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_fffe,
    0xffff_ffff,
    0x1_0000_0000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];

/// The header of most formats fits into this many bytes.
const HEADER_BYTES: usize = 256;
/// The size to which a file may grow by splicing.
const MAX_BYTES: usize = 128 * 1024;
const MAX_CHANGES: usize = 6;

/// A file of `corpus`, changed in one to six places.
pub fn mutated(corpus: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut file = corpus[random.below(corpus.len())].clone();
    for _ in 0..1 + random.below(MAX_CHANGES) {
        change(&mut file, corpus, random);
    }
    file.truncate(MAX_BYTES);
    file
}

fn change(file: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut Random) {
    if file.is_empty() {
        file.push(random.number() as u8);
        return;
    }
    let at = position(file.len(), random);
    match random.below(9) {
        0 | 1 => file[at] ^= 1 << random.below(8),
        2 => file[at] = random.number() as u8,
        3 | 4 => put_number(file, at & !3, random),
        5 => put_number(file, at, random),
        6 => file.truncate(at),
        7 => splice(file, at, &corpus[random.below(corpus.len())], random),
        _ => repeat(file, at, random),
    }
}

/// A random position; half of the changes go to the header.
fn position(length: usize, random: &mut Random) -> usize {
    let reach = if random.number().is_multiple_of(2) { length.min(HEADER_BYTES) } else { length };
    random.below(reach)
}

/// Overwrites 1, 2, 4 or 8 bytes with an interesting number, or with one close to the existing number.
fn put_number(file: &mut [u8], at: usize, random: &mut Random) {
    let width = (1 << random.below(4)).min(file.len() - at);
    let place = &mut file[at..at + width];
    let mut number = [0; 8];
    if random.number().is_multiple_of(4) {
        number[..width].copy_from_slice(place);
        let near = u64::from_le_bytes(number).wrapping_add(random.below(9) as u64).wrapping_sub(4);
        number = near.to_le_bytes();
    } else {
        number = INTERESTING[random.below(INTERESTING.len())].to_le_bytes();
    }
    place.copy_from_slice(&number[..width]);
}

/// Overwrites the bytes at a position with a piece of another file, or inserts it there.
fn splice(file: &mut Vec<u8>, at: usize, other: &[u8], random: &mut Random) {
    if other.is_empty() {
        return;
    }
    let start = random.below(other.len());
    let length = 1 + random.below((other.len() - start).min(512));
    let piece = &other[start..start + length];
    let replaced = if random.number().is_multiple_of(2) { (at + length).min(file.len()) } else { at };
    file.splice(at..replaced, piece.iter().copied());
}

/// Repeats a piece of the file.
fn repeat(file: &mut Vec<u8>, at: usize, random: &mut Random) {
    let length = 1 + random.below((file.len() - at).min(64));
    let piece = file[at..at + length].to_vec();
    file.splice(at..at, piece);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_files_and_they_differ_from_the_corpus() {
        let corpus = vec![vec![7; 300], (0..=255).collect(), Vec::new()];
        let files = |seed| {
            let mut random = Random::new(seed);
            (0..2000).map(|_| mutated(&corpus, &mut random)).collect::<Vec<_>>()
        };
        assert!(files(1) == files(1));
        assert!(files(1) != files(2));
        let unchanged = files(1).iter().filter(|file| corpus.contains(file)).count();
        assert!(unchanged < 200, "{unchanged} of 2000");
    }
}
