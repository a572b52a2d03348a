//! Prefix codes of limited length, as deflate requires (RFC 1951, 3.2.2).

/// Size of the largest alphabet: deflate's literals and lengths.
pub(super) const MAX_SYMBOLS: usize = 286;

/// Maximum code length of any deflate alphabet.
const LONGEST: usize = 15;

/// Assigns each symbol that occurs a code length of at most `longest` bits, shorter for more frequent symbols.
///
/// The lengths are those of the Huffman code. If its tree is too deep, leaves are moved by as little as keeps the code
/// complete, since decoders refuse an incomplete code. A symbol that does not occur gets length 0, a single symbol
/// length 1.
///
/// `counts` and `lengths` have one entry per symbol, at most [`MAX_SYMBOLS`]; each count is below 2^23.
pub(super) fn code_lengths(counts: &[u32], longest: usize, lengths: &mut [u8]) {
    const SYMBOL_BITS: u32 = 9;
    debug_assert!(counts.len() <= MAX_SYMBOLS && counts.len() == lengths.len() && longest <= LONGEST);
    lengths.fill(0);
    // Count and symbol in one word: sorting words is faster than sorting pairs, and ties are resolved
    // deterministically.
    let mut leaves = [0_u32; MAX_SYMBOLS];
    let mut used = 0;
    for (symbol, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        debug_assert!(count < 1 << (u32::BITS - SYMBOL_BITS));
        leaves[used] = count << SYMBOL_BITS | symbol as u32;
        used += 1;
    }
    let leaves = &mut leaves[..used];
    leaves.sort_unstable();
    let symbol_of = |leaf: u32| (leaf & ((1 << SYMBOL_BITS) - 1)) as usize;
    if leaves.len() <= 1 {
        leaves.iter().for_each(|&leaf| lengths[symbol_of(leaf)] = 1);
        return;
    }
    let mut of_length = leaves_of_length(leaves.iter().map(|leaf| leaf >> SYMBOL_BITS), longest);
    make_complete(&mut of_length, longest);
    let mut rarest_first = leaves.iter();
    for length in (1..=longest).rev() {
        for &leaf in rarest_first.by_ref().take(of_length[length]) {
            lengths[symbol_of(leaf)] = length as u8;
        }
    }
}

/// The number of leaves at each depth of the Huffman tree; leaves deeper than `longest` count at that depth.
/// `counts` are in ascending order; there are at least two.
fn leaves_of_length(counts: impl ExactSizeIterator<Item = u32>, longest: usize) -> [usize; LONGEST + 1] {
    let leaf_count = counts.len();
    let node_count = 2 * leaf_count - 1;
    let mut weight = [0_u32; 2 * MAX_SYMBOLS];
    weight.iter_mut().zip(counts).for_each(|(weight, count)| *weight = count);
    let mut parent = [0_u16; 2 * MAX_SYMBOLS];
    // Leaves are sorted and inner nodes are created in ascending order, so each of the two lightest nodes is at the
    // head of one of these two queues.
    let (mut leaf, mut inner) = (0, leaf_count);
    for node in leaf_count..node_count {
        for _ in 0..2 {
            let lightest = if inner >= node || (leaf < leaf_count && weight[leaf] <= weight[inner]) {
                leaf += 1;
                leaf - 1
            } else {
                inner += 1;
                inner - 1
            };
            weight[node] += weight[lightest];
            parent[lightest] = node as u16;
        }
    }
    let mut depth = [0_u16; 2 * MAX_SYMBOLS];
    let mut of_length = [0; LONGEST + 1];
    for node in (0..node_count - 1).rev() {
        depth[node] = depth[usize::from(parent[node])] + 1;
        if node < leaf_count {
            of_length[usize::from(depth[node]).min(longest)] += 1;
        }
    }
    of_length
}

/// Restores a complete code after the depth limit has made it oversubscribed. Each step makes one of the deepest leaves
/// the sibling of a leaf higher up, which frees exactly one code of the longest length, until Kraft's sum is one.
fn make_complete(of_length: &mut [usize; LONGEST + 1], longest: usize) {
    let claimed: usize = (1..=longest).map(|length| of_length[length] << (longest - length)).sum();
    for _ in (1 << longest)..claimed {
        let higher =
            (1..longest).rev().find(|&length| of_length[length] > 0).expect("a code of two symbols has room");
        of_length[higher] -= 1;
        of_length[higher + 1] += 2;
        of_length[longest] -= 1;
    }
}

/// The canonical codes for `lengths`, each with its bits reversed: deflate writes codes highest bit first, everything
/// else lowest bit first.
pub(super) fn reversed_codes(lengths: &[u8], codes: &mut [u16]) {
    let mut of_length = [0_u16; LONGEST + 1];
    lengths.iter().for_each(|&length| of_length[usize::from(length)] += 1);
    of_length[0] = 0;
    let mut next = [0_u16; LONGEST + 2];
    for length in 1..=LONGEST {
        next[length + 1] = (next[length] + of_length[length]) << 1;
    }
    for (code, &length) in codes.iter_mut().zip(lengths).filter(|(_, length)| **length > 0) {
        let slot = &mut next[usize::from(length)];
        *code = slot.reverse_bits() >> (u16::BITS - u32::from(length));
        *slot += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kraft's sum in units of 2^-longest.
    fn claimed(lengths: &[u8], longest: usize) -> usize {
        lengths.iter().filter(|l| **l > 0).map(|&l| 1 << (longest - usize::from(l))).sum()
    }

    #[test]
    fn codes_are_complete_and_within_the_limit_however_uneven_the_counts() {
        let mut fibonacci = vec![1_u32, 1];
        while fibonacci.len() < 28 {
            fibonacci.push(fibonacci[fibonacci.len() - 1] + fibonacci[fibonacci.len() - 2]);
        }
        let even = vec![7; MAX_SYMBOLS];
        let mut steep = vec![1; MAX_SYMBOLS];
        steep[3] = 1 << 22;
        for (counts, longest) in [(&fibonacci, 12), (&fibonacci, 15), (&even, 12), (&even, 9), (&steep, 12)] {
            let mut lengths = vec![0; counts.len()];
            code_lengths(counts, longest, &mut lengths);
            assert!(lengths.iter().all(|&l| l > 0 && usize::from(l) <= longest), "{lengths:?}");
            assert_eq!(claimed(&lengths, longest), 1 << longest, "{lengths:?}");
        }
    }

    #[test]
    fn the_code_is_huffmans_if_the_limit_is_not_reached() {
        // Computed by hand: ((1+1)+2)+4 against 8.
        let mut lengths = [0; 6];
        code_lengths(&[8, 1, 0, 1, 4, 2], 15, &mut lengths);
        assert_eq!(lengths, [1, 4, 0, 4, 2, 3]);
    }

    #[test]
    fn few_symbols_have_codes_too() {
        let mut lengths = [9; 3];
        code_lengths(&[0, 0, 0], 7, &mut lengths);
        assert_eq!(lengths, [0, 0, 0]);
        code_lengths(&[0, 5, 0], 7, &mut lengths);
        assert_eq!(lengths, [0, 1, 0]);
        code_lengths(&[1, 5, 0], 7, &mut lengths);
        assert_eq!(lengths, [1, 1, 0]);
    }

    /// The example from RFC 1951, 3.2.2.
    #[test]
    fn canonical_codes_follow_the_rfc() {
        let lengths = [3, 3, 3, 3, 3, 2, 4, 4];
        let mut codes = [0; 8];
        reversed_codes(&lengths, &mut codes);
        let expected = [0b010, 0b011, 0b100, 0b101, 0b110, 0b00, 0b1110, 0b1111_u16];
        for ((code, length), expected) in codes.iter().zip(lengths).zip(expected) {
            assert_eq!(code.reverse_bits() >> (16 - u16::from(length)), expected);
        }
    }
}
