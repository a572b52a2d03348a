//! The directories of a TIFF: tags and their values, as views of the file's bytes.
//!
//! TIFF 6.0, section 2; BigTIFF (<https://www.awaresystems.be/imaging/tiff/bigtiff.html>). Nothing is allocated for
//! values, so an entry that claims billions of values costs nothing: they lie outside the file, and reading them is an
//! error.

use std::collections::BTreeMap;

use super::FORMAT;
use crate::ReadError;
use crate::read::memory::malformed;

/// Tags by their names in the specification.
pub(super) mod tag {
    pub const NEW_SUBFILE_TYPE: u16 = 254;
    pub const IMAGE_WIDTH: u16 = 256;
    pub const IMAGE_LENGTH: u16 = 257;
    pub const BITS_PER_SAMPLE: u16 = 258;
    pub const COMPRESSION: u16 = 259;
    pub const PHOTOMETRIC_INTERPRETATION: u16 = 262;
    pub const FILL_ORDER: u16 = 266;
    pub const STRIP_OFFSETS: u16 = 273;
    pub const SAMPLES_PER_PIXEL: u16 = 277;
    pub const ROWS_PER_STRIP: u16 = 278;
    pub const STRIP_BYTE_COUNTS: u16 = 279;
    pub const PLANAR_CONFIGURATION: u16 = 284;
    pub const PREDICTOR: u16 = 317;
    pub const COLOR_MAP: u16 = 320;
    pub const TILE_WIDTH: u16 = 322;
    pub const TILE_LENGTH: u16 = 323;
    pub const TILE_OFFSETS: u16 = 324;
    pub const TILE_BYTE_COUNTS: u16 = 325;
    pub const EXTRA_SAMPLES: u16 = 338;
    pub const SAMPLE_FORMAT: u16 = 339;
    pub const MODEL_PIXEL_SCALE: u16 = 33550;
    pub const MODEL_TRANSFORMATION: u16 = 34264;
    pub const GEO_KEY_DIRECTORY: u16 = 34735;
    pub const GDAL_NODATA: u16 = 42113;
}

/// Maximum number of directories read. Files with more exist (one image per frame of a recording), but contain no maps.
const MAX_DIRECTORIES: usize = 1024;

/// Maximum number of entries read over all directories, so that many directories that share bytes cost little time.
const MAX_ENTRIES: u64 = 1 << 20;

/// The bytes of a file, with its byte order and offset size.
#[derive(Clone, Copy)]
pub(super) struct File<'a> {
    pub bytes: &'a [u8],
    pub is_big_endian: bool,
    /// BigTIFF: offsets and counts of 8 bytes instead of 4.
    is_big: bool,
}

/// The tags of one image.
pub(super) struct Directory<'a> {
    file: File<'a>,
    entries: BTreeMap<u16, Entry>,
}

#[derive(Clone, Copy)]
struct Entry {
    field_type: u64,
    count: u64,
    /// Where the values begin.
    start: u64,
}

/// The values of a tag, all of them within the file.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    file: File<'a>,
    field_type: u64,
    bytes: &'a [u8],
}

impl<'a> File<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self, ReadError> {
        const BIG_TIFF: u64 = 43;
        let mut file = File { bytes, is_big_endian: bytes.starts_with(b"MM"), is_big: false };
        file.is_big = file.number(2, 2)? == BIG_TIFF;
        Ok(file)
    }

    /// All directories of the file, in order.
    pub fn directories(self) -> Result<Vec<Directory<'a>>, ReadError> {
        let mut next = if self.is_big { self.number(8, 8)? } else { self.number(4, 4)? };
        let mut starts = Vec::new();
        let mut directories = Vec::new();
        let mut entries = 0;
        // A circular chain ends here.
        while next != 0 && !starts.contains(&next) && starts.len() < MAX_DIRECTORIES && entries < MAX_ENTRIES
        {
            starts.push(next);
            match self.directory(next) {
                Ok((directory, count, following)) => {
                    directories.push(directory);
                    entries += count;
                    next = following;
                }
                // The requested image may still be complete.
                Err(_) if !directories.is_empty() => break,
                Err(error) => return Err(error),
            }
        }
        Ok(directories)
    }

    /// The directory at an offset, its number of entries, and the offset of the next directory.
    fn directory(self, start: u64) -> Result<(Directory<'a>, u64, u64), ReadError> {
        let (count_bytes, number_bytes) = if self.is_big { (8, 8) } else { (2, 4) };
        let count = self.number(start, count_bytes)?;
        let entry_bytes = 4 + 2 * number_bytes;
        let first = start + count_bytes;
        let end = count.checked_mul(entry_bytes).and_then(|bytes| bytes.checked_add(first));
        let end = end.filter(|&end| end <= self.bytes.len() as u64).ok_or_else(ends_too_early)?;
        let mut entries = BTreeMap::new();
        for at in (first..end).step_by(entry_bytes as usize) {
            let (tag, field_type) = (self.number(at, 2)?, self.number(at + 2, 2)?);
            let count = self.number(at + 4, number_bytes)?;
            let place = at + 4 + number_bytes;
            let fits = count.saturating_mul(bytes_of_type(field_type)) <= number_bytes;
            let start = if fits { place } else { self.number(place, number_bytes)? };
            // If a tag has two entries, libtiff uses the first.
            entries.entry(tag as u16).or_insert(Entry { field_type, count, start });
        }
        // Some writers leave out the zero after the last directory.
        let next = self.number(end, number_bytes).unwrap_or(0);
        Ok((Directory { file: self, entries }, count, next))
    }

    /// The unsigned integer of this many bytes at an offset.
    fn number(self, start: u64, length: u64) -> Result<u64, ReadError> {
        self.slice(start, length).map(|bytes| number_of(bytes, self.is_big_endian)).ok_or_else(ends_too_early)
    }

    fn slice(self, start: u64, length: u64) -> Option<&'a [u8]> {
        let start = usize::try_from(start).ok()?;
        self.bytes.get(start..start.checked_add(usize::try_from(length).ok()?)?)
    }

    /// Up to `length` bytes from an offset on, fewer if the file ends earlier.
    pub fn slice_up_to(self, start: u64, length: u64) -> &'a [u8] {
        let from = usize::try_from(start).ok().and_then(|start| self.bytes.get(start..)).unwrap_or_default();
        &from[..from.len().min(usize::try_from(length).unwrap_or(usize::MAX))]
    }
}

impl<'a> Directory<'a> {
    /// The values of a tag. `None` if the tag is absent.
    pub fn values(&self, tag: u16) -> Result<Option<Values<'a>>, ReadError> {
        let Some(&Entry { field_type, count, start }) = self.entries.get(&tag) else { return Ok(None) };
        let length = count.saturating_mul(bytes_of_type(field_type));
        let bytes = self.file.slice(start, length);
        let bytes = bytes.ok_or_else(|| {
            malformed(FORMAT, format_args!("the values of its tag {tag} lie outside of the file"))
        })?;
        Ok(Some(Values { file: self.file, field_type, bytes }))
    }

    /// The first value of a tag as an unsigned integer.
    pub fn unsigned(&self, tag: u16) -> Result<Option<u64>, ReadError> {
        let Some(values) = self.values(tag)? else { return Ok(None) };
        let first = values.unsigned(0);
        first
            .map(Some)
            .ok_or_else(|| malformed(FORMAT, format_args!("its tag {tag} is not an unsigned integer")))
    }

    /// The first value of a tag as an unsigned integer, or its default.
    pub fn unsigned_or(&self, tag: u16, default: u64) -> Result<u64, ReadError> {
        Ok(self.unsigned(tag)?.unwrap_or(default))
    }

    /// The text of a tag, up to its zero byte. `None` if the tag is absent or the text lies outside the file.
    pub fn text(&self, tag: u16) -> Option<String> {
        let bytes = self.values(tag).ok()??.bytes;
        let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        Some(String::from_utf8_lossy(text).into_owned())
    }
}

impl Values<'_> {
    pub fn len(&self) -> usize {
        self.bytes.len() / bytes_of_type(self.field_type) as usize
    }

    fn get(&self, index: usize) -> Option<&[u8]> {
        self.bytes.chunks_exact(bytes_of_type(self.field_type) as usize).nth(index)
    }

    /// A value as an unsigned integer; `None` if it is not one, or if there are fewer values.
    pub fn unsigned(&self, index: usize) -> Option<u64> {
        const UNSIGNED: [u64; 6] = [1, 3, 4, 13, 16, 18];
        const SIGNED: [u64; 4] = [6, 8, 9, 17];
        let bytes = self.get(index)?;
        let number = number_of(bytes, self.file.is_big_endian);
        let is_negative = number >> (bytes.len() * 8 - 1) == 1;
        let is_unsigned =
            UNSIGNED.contains(&self.field_type) || (SIGNED.contains(&self.field_type) && !is_negative);
        is_unsigned.then_some(number)
    }

    /// A value as a double; `None` if it is not one, or if there are fewer values.
    pub fn double(&self, index: usize) -> Option<f64> {
        const DOUBLE: u64 = 12;
        let number = number_of(self.get(index)?, self.file.is_big_endian);
        (self.field_type == DOUBLE).then(|| f64::from_bits(number))
    }
}

/// Bytes per value. Unknown types count as bytes, the shortest type.
fn bytes_of_type(field_type: u64) -> u64 {
    match field_type {
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => 1,
    }
}

/// The unsigned integer in at most 8 bytes.
fn number_of(bytes: &[u8], is_big_endian: bool) -> u64 {
    let append = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
    if is_big_endian { bytes.iter().fold(0, append) } else { bytes.iter().rev().fold(0, append) }
}

pub(super) fn ends_too_early() -> ReadError {
    malformed(FORMAT, "the file ends too early")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one directory and one entry: a text of this many characters.
    fn with_text(characters: u32, big_endian: bool) -> Vec<u8> {
        let two = |n: u16| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let four = |n: u32| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let magic = if big_endian { *b"MM" } else { *b"II" };
        let head = [&magic[..], &two(42), &four(8), &two(1)].concat();
        [&head[..], &two(305), &two(2), &four(characters), &four(0x4142_4300), &four(0)].concat()
    }

    fn first(bytes: &[u8]) -> Result<Directory<'_>, ReadError> {
        Ok(File::new(bytes)?.directories()?.remove(0))
    }

    #[test]
    fn values_of_four_bytes_stand_in_the_entry_and_longer_ones_must_lie_within_the_file() {
        for big_endian in [false, true] {
            let file = with_text(4, big_endian);
            let text = if big_endian { "ABC" } else { "" };
            assert_eq!(first(&file).unwrap().text(305).as_deref(), Some(text));
            let file = with_text(1 << 30, big_endian);
            let fault = first(&file).unwrap().values(305).err().expect("outside of the file").to_string();
            assert!(fault.contains("tag 305"), "{fault}");
        }
    }

    #[test]
    fn any_cut_of_a_directory_is_an_error() {
        let whole = with_text(1, false);
        // The last four bytes, the offset of the next directory, may be missing.
        for length in 8..whole.len() - 4 {
            let fault = first(&whole[..length]).err().expect("a cut directory").to_string();
            assert!(fault.contains("ends too early"), "{length}: {fault}");
        }
        assert!(first(&whole[..whole.len() - 4]).is_ok());
        let far = [b"II\x2b\0\x08\0\0\0", &[0xff; 8][..]].concat();
        assert!(first(&far).is_err());
    }

    #[test]
    fn a_circular_chain_ends() {
        let mut file = with_text(1, false);
        let end = file.len() - 4;
        file[end..].copy_from_slice(&8u32.to_le_bytes());
        assert_eq!(File::new(&file).unwrap().directories().unwrap().len(), 1);
    }
}
