//! A look at a TIFF's first directory before it is decoded.
//!
//! An entry says how many values it has, and a hostile one may claim billions. The `tiff` crate allocates up to 256 MiB for
//! them, and where it refuses a text it prints a line of its own to stderr.

use super::memory::malformed;
use crate::ReadError;

/// Refuses entries whose values would take more bytes than the file has. Whatever else is wrong is left to the decoder.
pub(super) fn check(bytes: &[u8]) -> Result<(), ReadError> {
    let Some(entries) = entries(bytes) else { return Ok(()) };
    for Entry { tag, value_bytes } in entries {
        if value_bytes > bytes.len() as u64 {
            return Err(malformed(
                "TIFF",
                format_args!("the values of its tag {tag} do not fit into the file"),
            ));
        }
    }
    Ok(())
}

struct Entry {
    tag: u64,
    value_bytes: u64,
}

/// The entries of the first directory as far as they lie within the file; `None` where there is no directory.
fn entries(bytes: &[u8]) -> Option<Vec<Entry>> {
    let file = File { bytes, is_big_endian: bytes.starts_with(b"MM") };
    // BigTIFF has version 43 and numbers of 8 bytes.
    let (first, number_bytes, count_bytes) = match file.number(2, 2)? {
        43 => (file.number(8, 8)?, 8, 8),
        _ => (file.number(4, 4)?, 4, 2),
    };
    let first = usize::try_from(first).ok()?;
    let count = file.number(first, count_bytes)?;
    let entry_bytes = 4 + 2 * number_bytes;
    let starts = (0..count).map_while(|index| {
        let offset = usize::try_from(index).ok()?.checked_mul(entry_bytes)?;
        first.checked_add(count_bytes)?.checked_add(offset)
    });
    let read = |start: usize| {
        let values = file.number(start.checked_add(4)?, number_bytes)?;
        let value_bytes = values.saturating_mul(bytes_of_type(file.number(start.checked_add(2)?, 2)?));
        Some(Entry { tag: file.number(start, 2)?, value_bytes })
    };
    Some(starts.map_while(read).collect())
}

/// Bytes of a value. Types that are not known count as one byte, which no value is shorter than.
fn bytes_of_type(number: u64) -> u64 {
    match number {
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => 1,
    }
}

struct File<'a> {
    bytes: &'a [u8],
    is_big_endian: bool,
}

impl File<'_> {
    /// The unsigned number of so many bytes at a place; `None` beyond the end.
    fn number(&self, start: usize, length: usize) -> Option<u64> {
        let bytes = self.bytes.get(start..start.checked_add(length)?)?;
        let append = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        Some(if self.is_big_endian {
            bytes.iter().fold(0, append)
        } else {
            bytes.iter().rev().fold(0, append)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A directory of one entry: a text of so many characters.
    fn with_text(characters: u32, big_endian: bool) -> Vec<u8> {
        let two = |n: u16| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let four = |n: u32| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let magic = if big_endian { *b"MM" } else { *b"II" };
        let head = [&magic[..], &two(42), &four(8), &two(1)].concat();
        [&head[..], &two(305), &two(2), &four(characters), &four(8), &four(0)].concat()
    }

    #[test]
    fn texts_that_are_longer_than_the_file_are_refused() {
        for big_endian in [false, true] {
            assert!(check(&with_text(20, big_endian)).is_ok());
            let fault = check(&with_text(1 << 30, big_endian)).unwrap_err().to_string();
            assert!(fault.contains("tag 305"), "{fault}");
        }
    }

    #[test]
    fn any_cut_of_a_directory_is_left_to_the_decoder() {
        let whole = with_text(1, false);
        assert!((0..whole.len()).all(|length| check(&whole[..length]).is_ok()));
        // A first directory at the end of all addresses.
        let far = [b"II\x2b\0\x08\0\0\0", &[0xff; 8][..]].concat();
        assert!(check(&far).is_ok());
    }
}
