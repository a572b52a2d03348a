//! The header of a KTX2 file, its level index and its key-value data, with every offset checked.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::basis::Content;
use super::{IDENTIFIER, IDENTIFIER_OF_KTX1, malformed, unsupported};
use crate::texels::{Axis, Source};
use crate::{ReadError, metadata};

/// Compression of the level data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scheme {
    None,
    BasisLz,
    Zstd,
    Zlib,
}

/// A block format that Basis Universal's transcoder reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Universal {
    Etc1s,
    Uastc,
    /// ASTC of low dynamic range.
    Astc,
}

impl Universal {
    pub fn name(self) -> &'static str {
        match self {
            Universal::Etc1s => "ETC1S",
            Universal::Uastc => "UASTC",
            Universal::Astc => "ASTC",
        }
    }
}

/// A file whose header is valid. No memory proportional to the texture's size has been allocated.
pub(super) struct Container<'a> {
    bytes: &'a [u8],
    scheme: Scheme,
    level_index: Vec<LevelEntry>,
    pub vk_format: u32,
    /// Set if Basis Universal's transcoder reads the texels.
    pub universal: Option<Universal>,
    /// The channels of the samples of the data format descriptor.
    descriptor_channels: Vec<u8>,
    pub width: usize,
    pub height: usize,
    pub layers: usize,
    /// Key-value data as text.
    pub pairs: BTreeMap<String, String>,
}

#[derive(Clone, Copy)]
struct LevelEntry {
    offset: u64,
    length: u64,
    uncompressed_length: u64,
}

const HEADER_BYTES: usize = 80;
const LEVEL_ENTRY_BYTES: usize = 24;

impl<'a> Container<'a> {
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        if bytes.starts_with(&IDENTIFIER_OF_KTX1) {
            return Err(unsupported(
                "version 1 of the format",
                "convert it to KTX2, for example with ktx2ktx2",
            ));
        }
        if !bytes.starts_with(&IDENTIFIER) {
            return Err(malformed("the identifier is not that of KTX2"));
        }
        if bytes.len() < HEADER_BYTES {
            return Err(malformed(format!("{} bytes are too short for a header", bytes.len())));
        }
        let field = |index: usize| u32_at(bytes, 12 + 4 * index);
        let [vk_format, width, height, depth] = [field(0), field(2), field(3), field(4)];
        let [layers, faces, levels, scheme] = [field(5), field(6), field(7), field(8)];
        if depth > 0 {
            return Err(unsupported("a 3-D texture", "save one slice as a 2-D texture"));
        }
        if faces != 1 {
            return Err(match faces {
                6 => unsupported("a cube map", "save one face as a 2-D texture"),
                _ => malformed(format!("a texture cannot have {faces} faces")),
            });
        }
        let scheme = scheme_of(scheme)?;
        let universal = universal_of(bytes, vk_format, field(9))?;
        if scheme == Scheme::BasisLz && universal != Some(Universal::Etc1s) {
            return Err(malformed("BasisLZ supercompression of data other than ETC1S"));
        }
        Ok(Self {
            bytes,
            scheme,
            level_index: level_index(bytes, levels)?,
            vk_format,
            universal,
            descriptor_channels: descriptor_channels(bytes, field(9), field(10)),
            width: width as usize,
            // 1-D textures state a height of 0, which means one row.
            height: height.max(1) as usize,
            layers: layers.max(1) as usize,
            pairs: key_value_data(bytes, field(11), field(12))?,
        })
    }

    /// Number of levels in the file.
    pub fn levels(&self) -> usize {
        self.level_index.len()
    }

    /// The texels of all layers of a level, unpacked; `expected` bytes, or an error.
    pub fn level(&self, level: usize, expected: usize) -> Result<Cow<'a, [u8]>, ReadError> {
        let entry = self.level_index[level];
        let data = slice(self.bytes, entry.offset, entry.length)
            .ok_or_else(|| malformed(format!("level {level} lies outside of the file")))?;
        if entry.uncompressed_length != expected as u64 {
            let stated = entry.uncompressed_length;
            return Err(malformed(format!(
                "level {level} states {stated} bytes, but its size needs {expected}"
            )));
        }
        let failed = |why: &str| malformed(format!("level {level} does not unpack: {why}"));
        match self.scheme {
            Scheme::None if data.len() != expected => Err(malformed(format!(
                "level {level} has {} bytes, but its size needs {expected}",
                data.len()
            ))),
            Scheme::BasisLz => Err(failed("it is no plain level")),
            Scheme::None => Ok(Cow::Borrowed(data)),
            Scheme::Zstd => inflate_zstd(data, expected).map(Cow::Owned).map_err(failed),
            Scheme::Zlib => inflate_zlib(data, expected).map(Cow::Owned).map_err(failed),
        }
    }

    /// Checks the stated size of level 0 against what its texels need, before the transcoder allocates it.
    pub fn check_universal_level(&self, universal: Universal) -> Result<(), ReadError> {
        let entry = self.level_index[0];
        let too_short = || malformed("level 0 lies outside of the file");
        let data = slice(self.bytes, entry.offset, entry.length).ok_or_else(too_short)?;
        let blocks = |side: u32| {
            (self.width as u64).div_ceil(side.into()) * (self.height as u64).div_ceil(side.into())
        };
        let layers = self.layers as u64;
        match universal {
            // In a run of equal blocks, each block may take only a fraction of a bit.
            Universal::Etc1s if blocks(4) > (data.len() as u64 + 1) * ETC1S_MAX_BLOCKS_PER_BYTE => {
                Err(too_short())
            }
            Universal::Etc1s => Ok(()),
            Universal::Uastc if entry.uncompressed_length != blocks(4) * 16 * layers => {
                Err(malformed("level 0 states another number of bytes than its size needs"))
            }
            // The largest ASTC block is 12 texels wide.
            Universal::Astc if entry.uncompressed_length < blocks(12) * 16 * layers => Err(too_short()),
            _ if entry.uncompressed_length > (data.len() as u64).saturating_mul(ZSTD_MAX_RATIO as u64) => {
                Err(too_short())
            }
            _ => Ok(()),
        }
    }

    /// The contents of the channels, according to the samples of the data format descriptor.
    pub fn universal_content(&self, universal: Universal) -> Content {
        // Channel numbers as in `khr_df_channels`; 15 is alpha.
        match (universal, &self.descriptor_channels[..]) {
            (Universal::Etc1s, [3]) | (Universal::Uastc, [4]) => Content::Red,
            (Universal::Etc1s, [3, 4]) | (Universal::Uastc, [5]) => Content::RedAndAlpha,
            (Universal::Uastc, [6]) => Content::RedGreen,
            (Universal::Etc1s, [0, 15]) | (Universal::Uastc, [3]) | (Universal::Astc, _) => Content::Rgba,
            _ => Content::Rgb,
        }
    }

    /// The axes along which the image must be flipped so that row 0 is the top and column 0 the left.
    pub fn flips(&self) -> Result<Vec<Axis>, ReadError> {
        let Some(orientation) = self.pairs.get("KTXorientation") else { return Ok(Vec::new()) };
        match orientation.as_str() {
            "rd" | "r" => Ok(Vec::new()),
            "ru" => Ok(vec![Axis::Vertical]),
            "ld" | "l" => Ok(vec![Axis::Horizontal]),
            "lu" => Ok(vec![Axis::Vertical, Axis::Horizontal]),
            _ => Err(malformed(format!("KTXorientation is '{}'", orientation.escape_debug()))),
        }
    }

    /// The source of each channel of the image, if the file specifies it. Trailing channels with the value that an
    /// absent channel has anyway (0, or 1 for alpha) are omitted: `rg01` applied to two channels gives two channels.
    pub fn swizzle(&self, channels: usize) -> Result<Option<Vec<Source>>, ReadError> {
        let Some(swizzle) = self.pairs.get("KTXswizzle") else { return Ok(None) };
        let invalid = || malformed(format!("KTXswizzle is '{}'", swizzle.escape_debug()));
        let absent = |index: usize| if index == 3 { Source::One } else { Source::Zero };
        let source = |letter: char| match letter {
            '0' => Some(Source::Zero),
            '1' => Some(Source::One),
            _ => {
                let index = "rgba".find(letter)?;
                Some(if index < channels { Source::Channel(index) } else { absent(index) })
            }
        };
        let mut sources: Vec<Source> =
            swizzle.chars().map(source).collect::<Option<_>>().ok_or_else(invalid)?;
        if sources.len() != 4 {
            return Err(invalid());
        }
        while sources.len() > 1 && sources.last() == Some(&absent(sources.len() - 1)) {
            sources.pop();
        }
        Ok(Some(sources))
    }
}

/// Requires that the caller has checked the length of the file.
fn u32_at(bytes: &[u8], offset: usize) -> u32 {
    bytes[offset..].first_chunk().map(|&b| u32::from_le_bytes(b)).expect("within the header")
}

fn u64_at(bytes: &[u8], offset: usize) -> u64 {
    bytes[offset..].first_chunk().map(|&b| u64::from_le_bytes(b)).expect("within the header")
}

fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    bytes.get(start..end)
}

fn scheme_of(number: u32) -> Result<Scheme, ReadError> {
    match number {
        0 => Ok(Scheme::None),
        1 => Ok(Scheme::BasisLz),
        2 => Ok(Scheme::Zstd),
        3 => Ok(Scheme::Zlib),
        _ => Err(unsupported(format!("supercompression scheme {number}"), "save it with none, zstd or zlib")),
    }
}

/// Maximum number of ETC1S blocks per byte; far more than the encoder reaches. Bounds the allocation for a short file.
const ETC1S_MAX_BLOCKS_PER_BYTE: u64 = 4096;

/// The block format of files for Basis Universal's transcoder; `None` if a `vkFormat` describes the texels.
///
/// Files without a `vkFormat` are described by their data format descriptor.
fn universal_of(
    bytes: &[u8],
    vk_format: u32,
    descriptor_offset: u32,
) -> Result<Option<Universal>, ReadError> {
    const ASTC: std::ops::RangeInclusive<u32> = 157..=184;
    if ASTC.contains(&vk_format) {
        return Ok(Some(Universal::Astc));
    }
    if vk_format != 0 {
        return Ok(None);
    }
    // The colour model follows the total size and two words of the block.
    let model = slice(bytes, u64::from(descriptor_offset) + 12, 1).map(|model| model[0]);
    match model {
        Some(163) => Ok(Some(Universal::Etc1s)),
        Some(166) => Ok(Some(Universal::Uastc)),
        Some(model) => Err(unsupported(
            format!("colour model {model} without a vkFormat"),
            "convert it to BC5 or BC7, for example with `ktx transcode --target bc5`",
        )),
        None => Err(malformed("it has neither a vkFormat nor a data format descriptor")),
    }
}

/// The channel of each sample of the basic data format descriptor; empty if it is truncated.
fn descriptor_channels(bytes: &[u8], offset: u32, length: u32) -> Vec<u8> {
    const BEFORE_SAMPLES: usize = 28;
    const SAMPLE_BYTES: usize = 16;
    let samples = slice(bytes, offset.into(), length.into()).and_then(|block| block.get(BEFORE_SAMPLES..));
    // Bits 24 to 27 of the first word of a sample; the bits above are qualifiers.
    samples.unwrap_or_default().chunks_exact(SAMPLE_BYTES).map(|sample| sample[3] & 15).collect()
}

fn level_index(bytes: &[u8], levels: u32) -> Result<Vec<LevelEntry>, ReadError> {
    // A count of 0 asks the loader to generate the levels; level 0 exists.
    let length = u64::from(levels.max(1)) * LEVEL_ENTRY_BYTES as u64;
    let index = slice(bytes, HEADER_BYTES as u64, length)
        .ok_or_else(|| malformed(format!("the index of {levels} levels reaches beyond the file")))?;
    let entry = |entry: &[u8]| LevelEntry {
        offset: u64_at(entry, 0),
        length: u64_at(entry, 8),
        uncompressed_length: u64_at(entry, 16),
    };
    Ok(index.chunks_exact(LEVEL_ENTRY_BYTES).map(entry).collect())
}

fn key_value_data(bytes: &[u8], offset: u32, length: u32) -> Result<BTreeMap<String, String>, ReadError> {
    let broken = || malformed("the key-value data is broken");
    let mut rest = slice(bytes, offset.into(), length.into()).ok_or_else(broken)?;
    let mut pairs = BTreeMap::new();
    while !rest.is_empty() {
        let (size, after) = rest.split_first_chunk().ok_or_else(broken)?;
        let size = u32::from_le_bytes(*size) as usize;
        let pair = after.get(..size).ok_or_else(broken)?;
        let end_of_key = pair.iter().position(|&byte| byte == 0).ok_or_else(broken)?;
        let key = std::str::from_utf8(&pair[..end_of_key]).map_err(|_| broken())?;
        metadata::insert_bytes(&mut pairs, key, &pair[end_of_key + 1..]);
        // Pairs are padded to 4 bytes; some writers omit the padding of the last one.
        rest = after.get(size.next_multiple_of(4)..).unwrap_or_default();
    }
    Ok(pairs)
}

/// Maximum Zstandard compression ratio: a block of 4 bytes can represent 128 KiB. Checked before the level is
/// allocated, so that a short file cannot request gigabytes.
const ZSTD_MAX_RATIO: usize = 128 * 1024 / 4;

fn inflate_zstd(data: &[u8], expected: usize) -> Result<Vec<u8>, &'static str> {
    if expected > data.len().saturating_mul(ZSTD_MAX_RATIO) {
        return Err("it is too short for its size");
    }
    let mut level = Vec::with_capacity(expected);
    let mut decompressor = zstd::bulk::Decompressor::new().map_err(|_| "no memory for zstd")?;
    decompressor.decompress_to_buffer(data, &mut level).map_err(|_| "broken or too long zstd data")?;
    if level.len() != expected { Err("too few bytes") } else { Ok(level) }
}

/// Maximum deflate compression ratio: at most 258 bytes in 2 bits.
const DEFLATE_MAX_RATIO: usize = 258 * 4;

fn inflate_zlib(data: &[u8], expected: usize) -> Result<Vec<u8>, &'static str> {
    if expected > data.len().saturating_mul(DEFLATE_MAX_RATIO) {
        return Err("it is too short for its size");
    }
    let mut level = vec![0; expected];
    let length = libdeflater::Decompressor::new()
        .zlib_decompress(data, &mut level)
        .map_err(|_| "broken or too long zlib data")?;
    if length != expected { Err("too few bytes") } else { Ok(level) }
}
