//! The layout of a texture array's texels in an EXR file.

use half::f16;
use roughcast::texture::TextureArray;
use roughcast::{Image, SampleType, Samples};

use super::TILE;
use crate::WriteError;

/// A channel of the file, and the source of its samples.
pub(super) struct Channel<'a> {
    pub(super) name: &'a str,
    layer: usize,
    index: usize,
}

/// The order and the positions of all channels and tiles in the file.
pub(super) struct Plan<'a> {
    array: &'a TextureArray,
    /// Sorted by name, as OpenEXR requires.
    pub(super) channels: Vec<Channel<'a>>,
    /// Of all channels.
    pub(super) sample_type: SampleType,
}

/// Position of a tile: its level, and its column and row among the tiles of that level.
#[derive(Clone, Copy)]
pub(super) struct TilePlace {
    pub(super) level: usize,
    pub(super) column: usize,
    pub(super) row: usize,
}

/// Sizes of all levels from a first level of `width` x `height` down to 1x1, each rounded down.
pub(super) fn level_sizes(width: usize, height: usize) -> impl Iterator<Item = (usize, usize)> {
    let below = |&(width, height): &(usize, usize)| {
        (width > 1 || height > 1).then_some(((width / 2).max(1), (height / 2).max(1)))
    };
    std::iter::successors(Some((width, height)), below)
}

/// The tiles of all levels in the order of the file: level by level, row by row.
pub(super) fn tile_places(width: usize, height: usize) -> impl Iterator<Item = TilePlace> {
    level_sizes(width, height).enumerate().flat_map(|(level, (width, height))| {
        let columns = width.div_ceil(TILE);
        (0..height.div_ceil(TILE))
            .flat_map(move |row| (0..columns).map(move |column| TilePlace { level, column, row }))
    })
}

impl<'a> Plan<'a> {
    /// # Errors
    /// [`WriteError::Unsupported`] if a mip-mapped EXR part cannot hold the array.
    pub(super) fn new(array: &'a TextureArray) -> Result<Self, WriteError> {
        let sample_type = array.sample_type();
        if !sample_type.is_float() {
            let bits = 8 * sample_type.bytes();
            return Err(refusal(format!("{bits}-bit unsigned samples"), "store half or single floats"));
        }
        check_levels(array)?;
        let mut channels = Vec::new();
        for (layer, texture) in array.layers().iter().enumerate() {
            channels.extend(texture.channel_names().iter().enumerate().map(|(index, &name)| Channel {
                name,
                layer,
                index,
            }));
        }
        channels.sort_by_key(|channel| channel.name);
        check_names(&channels)?;
        Ok(Self { array, channels, sample_type })
    }

    /// Width and height of level 0.
    pub(super) fn size(&self) -> (usize, usize) {
        self.array.size()
    }

    /// Appends the bytes of a tile in OpenEXR's order: row by row, and within a row channel by channel.
    pub(super) fn gather(&self, tile: TilePlace, bytes: &mut Vec<u8>) {
        let level = |channel: &Channel| &self.array.layers()[channel.layer].levels()[tile.level];
        let size = level(&self.channels[0]);
        let left = tile.column * TILE;
        let columns = left..size.width().min(left + TILE);
        let top = tile.row * TILE;
        for row in top..size.height().min(top + TILE) {
            for channel in &self.channels {
                let image = level(channel);
                match image.samples() {
                    Samples::F16(samples) => {
                        let row = texels(image, samples, row, columns.clone());
                        append(row, image.channels(), channel.index, f16::to_le_bytes, bytes);
                    }
                    Samples::F32(samples) => {
                        let row = texels(image, samples, row, columns.clone());
                        append(row, image.channels(), channel.index, f32::to_le_bytes, bytes);
                    }
                    Samples::U8(_) | Samples::U16(_) => unreachable!("the plan takes floats alone"),
                }
            }
        }
    }
}

/// The samples of some texels of a row.
fn texels<'a, T>(image: &Image, samples: &'a [T], row: usize, columns: std::ops::Range<usize>) -> &'a [T] {
    let start = row * image.width();
    &samples[(start + columns.start) * image.channels()..(start + columns.end) * image.channels()]
}

/// Appends one of the interleaved channels of `texels`.
fn append<T: Copy, const N: usize>(
    texels: &[T],
    channels: usize,
    channel: usize,
    to_le_bytes: fn(T) -> [u8; N],
    bytes: &mut Vec<u8>,
) {
    let start = bytes.len();
    bytes.resize(start + texels.len() / channels * N, 0);
    let (places, _) = bytes[start..].as_chunks_mut::<N>();
    for (place, texel) in places.iter_mut().zip(texels.chunks_exact(channels)) {
        *place = to_le_bytes(texel[channel]);
    }
}

/// Checks that the levels are those that readers expect from the size.
fn check_levels(array: &TextureArray) -> Result<(), WriteError> {
    let (width, height) = array.size();
    if width.max(height) > i32::MAX as usize {
        return Err(refusal(format!("{width}x{height} texels"), "use a smaller map"));
    }
    let (got, wanted) = (array.level_count(), level_sizes(width, height).count());
    if got != wanted {
        let what = format!("{got} of the {wanted} levels of {width}x{height} texels");
        return Err(refusal(what, "keep every level down to 1x1"));
    }
    Ok(())
}

/// `channels` are sorted by name.
fn check_names(channels: &[Channel]) -> Result<(), WriteError> {
    const LONGEST_NAME: usize = 255;
    let unfit = |name: &str| name.is_empty() || name.len() > LONGEST_NAME || name.contains('\0');
    if let Some(channel) = channels.iter().find(|channel| unfit(channel.name)) {
        return Err(refusal(format!("a channel called {:?}", channel.name), "use a name of 1 to 255 bytes"));
    }
    if let Some(pair) = channels.windows(2).find(|pair| pair[0].name == pair[1].name) {
        return Err(refusal(
            format!("two channels called '{}'", pair[0].name),
            "give each a name of its own",
        ));
    }
    Ok(())
}

pub(super) fn refusal(what: String, remedy: &'static str) -> WriteError {
    WriteError::Unsupported { container: "EXR", what, remedy }
}
