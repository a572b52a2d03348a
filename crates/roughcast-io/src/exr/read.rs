//! Reads files written by [`super::write()`].
//!
//! The `exr` crate parses the header, but not the tiles: with one tile size, one level mode and one compression,
//! checking them against the header here costs less than passing them to the crate, and libdeflate inflates faster.

use std::collections::BTreeMap;
use std::io::Cursor;

use exr::math::RoundingMode;
use exr::meta::attribute::{AttributeValue, Compression, LevelMode, SampleType as ExrSample};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use half::f16;
use rayon::prelude::*;
use roughcast::texture::{LayerSpec, ShapeFault, Texture, TextureArray, TextureInfo, layers_of};
use roughcast::{Image, SampleType, Samples};

use super::plan::{TilePlace, level_sizes, tile_places};
use super::{TILE, zip};
use crate::{Limits, ReadError};

/// Number of tiles inflated before they are copied into their images.
const BATCH: usize = 256;
/// Column, row, level in both directions, size of the block.
const CHUNK_HEAD: usize = 5 * size_of::<i32>();

/// Reads all channels and all levels of a file that [`super::write()`] wrote.
///
/// # Errors
/// [`ReadError::Malformed`] if the bytes break the rules of OpenEXR or end too early; [`ReadError::Unsupported`] for
/// OpenEXR files with a different structure; [`ReadError::Info`] if roughcast's metadata is missing;
/// [`ReadError::TooLarge`] if level 0 of all layers together has more pixels than `limits` allow.
pub fn read_textures(bytes: &[u8], limits: &Limits) -> Result<TextureArray, ReadError> {
    read_layers(bytes, limits, |info| layers_of(info).to_vec())
}

pub(super) fn read_layers(
    bytes: &[u8],
    limits: &Limits,
    layers_of: impl Fn(&TextureInfo) -> Vec<LayerSpec>,
) -> Result<TextureArray, ReadError> {
    let mut cursor = Cursor::new(bytes);
    let meta =
        MetaData::read_from_buffered(&mut cursor, false).map_err(|error| malformed(error.to_string()))?;
    let [header] = &meta.headers[..] else {
        return Err(unsupported("a file of several parts"));
    };
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    check_structure(header)?;
    let info = TextureInfo::from_pairs(&text_attributes(header))?;
    let specs = layers_of(&info);
    let pixels = (width as u64).saturating_mul(height as u64).saturating_mul(specs.len() as u64);
    if pixels > limits.max_pixels {
        let (width, height) = (width as u64, height as u64);
        return Err(ReadError::TooLarge { width, height, max_pixels: limits.max_pixels });
    }
    let file = File {
        bytes,
        table: cursor.position() as usize,
        compression: header.compression,
        channels: placed_channels(header, &specs)?,
        sample_type: sample_type(header)?,
        sizes: level_sizes(width, height).collect(),
    };
    let tiles: Vec<TilePlace> = file.tiles(width, height)?;
    let mut levels = file.empty_levels(&specs);
    for (index, batch) in tiles.chunks(BATCH).enumerate() {
        let blocks: Vec<Vec<u8>> = (batch.par_iter().enumerate())
            .map_init(libdeflater::Decompressor::new, |inflater, (place, tile)| {
                file.block(index * BATCH + place, *tile, inflater)
            })
            .collect::<Result<_, _>>()?;
        for (tile, block) in batch.iter().zip(&blocks) {
            file.scatter(*tile, block, &mut levels[tile.level]);
        }
    }
    let array = file.textures(levels, specs).and_then(|layers| TextureArray::new(info, layers));
    array.map_err(|fault| malformed(fault.to_string()))
}

/// Refuses files that [`super::write()`] does not produce.
fn check_structure(header: &Header) -> Result<(), ReadError> {
    let BlockDescription::Tiles(tiles) = header.blocks else {
        return Err(unsupported("a file without tiles and levels"));
    };
    if tiles.level_mode != LevelMode::MipMap || tiles.rounding_mode != RoundingMode::Down {
        return Err(unsupported("a file without mip levels that are rounded down"));
    }
    if (tiles.tile_size.width(), tiles.tile_size.height()) != (TILE, TILE) {
        return Err(unsupported("a tile size other than 64x64"));
    }
    if header.deep {
        return Err(unsupported("deep data"));
    }
    if !matches!(header.compression, Compression::Uncompressed | Compression::ZIP16) {
        return Err(unsupported("a compression other than zip and none"));
    }
    if header.layer_size.area() == 0 {
        return Err(malformed("it has no texels".to_owned()));
    }
    Ok(())
}

fn text_attributes(header: &Header) -> BTreeMap<String, String> {
    let attributes = header.own_attributes.other.iter();
    let texts = attributes.filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        _ => None,
    });
    texts.collect()
}

/// The type of all channels.
fn sample_type(header: &Header) -> Result<SampleType, ReadError> {
    let channels = &header.channels.list;
    if channels.iter().all(|channel| channel.sample_type == ExrSample::F16) {
        Ok(SampleType::F16)
    } else if channels.iter().all(|channel| channel.sample_type == ExrSample::F32) {
        Ok(SampleType::F32)
    } else {
        Err(unsupported("a mixture of half, float and integer channels"))
    }
}

/// The destination of the samples of a channel of the file.
struct PlacedChannel {
    layer: usize,
    index: usize,
}

/// The destination of each channel, in file order. Each channel of each layer must occur exactly once.
fn placed_channels(header: &Header, specs: &[LayerSpec]) -> Result<Vec<PlacedChannel>, ReadError> {
    let mut wanted: BTreeMap<&str, PlacedChannel> = BTreeMap::new();
    for (layer, spec) in specs.iter().enumerate() {
        wanted.extend(
            (spec.channels.iter().enumerate()).map(|(index, &name)| (name, PlacedChannel { layer, index })),
        );
    }
    let mut placed = Vec::new();
    for channel in &header.channels.list {
        let name = channel.name.to_string();
        let place = wanted.remove(name.as_str());
        placed.push(place.ok_or_else(|| malformed(format!("channel {name:?} is not one of its layout's")))?);
    }
    match wanted.keys().next() {
        None => Ok(placed),
        Some(name) => Err(malformed(format!("channel '{name}' of its layout is missing"))),
    }
}

/// A file whose header is valid.
struct File<'a> {
    bytes: &'a [u8],
    /// Where the table of offsets starts.
    table: usize,
    compression: Compression,
    channels: Vec<PlacedChannel>,
    sample_type: SampleType,
    sizes: Vec<(usize, usize)>,
}

impl File<'_> {
    /// The tiles of all levels, if the file is long enough to contain their offsets.
    fn tiles(&self, width: usize, height: usize) -> Result<Vec<TilePlace>, ReadError> {
        let tiles_of = |&(width, height): &(usize, usize)| width.div_ceil(TILE) * height.div_ceil(TILE);
        let count: usize = self.sizes.iter().map(tiles_of).sum();
        let room = (self.bytes.len() - self.table) / size_of::<u64>();
        if count > room {
            return Err(malformed(format!("it ends inside its table of {count} tiles")));
        }
        Ok(tile_places(width, height).collect())
    }

    /// The samples of tile number `index` in the order of the file, inflated.
    fn block(
        &self,
        index: usize,
        tile: TilePlace,
        inflater: &mut libdeflater::Decompressor,
    ) -> Result<Vec<u8>, ReadError> {
        let missing =
            || malformed(format!("tile {}, {} of level {} is missing", tile.column, tile.row, tile.level));
        let entry = &self.bytes[self.table + index * size_of::<u64>()..];
        let offset = u64::from_le_bytes(*entry.first_chunk().ok_or_else(missing)?);
        let chunk =
            usize::try_from(offset).ok().and_then(|offset| self.bytes.get(offset..)).ok_or_else(missing)?;
        let (head, rest) = chunk.split_at_checked(CHUNK_HEAD).ok_or_else(missing)?;
        let (numbers, _) = head.as_chunks::<4>();
        let numbers: Vec<i64> = numbers.iter().map(|number| i64::from(i32::from_le_bytes(*number))).collect();
        if numbers[..4] != [tile.column, tile.row, tile.level, tile.level].map(|number| number as i64) {
            return Err(missing());
        }
        let data = usize::try_from(numbers[4]).ok().and_then(|size| rest.get(..size)).ok_or_else(missing)?;
        let (width, height) = self.tile_size(tile);
        let size = width * height * self.channels.len() * self.sample_type.bytes();
        let inflated = match self.compression {
            Compression::ZIP16 if data.len() < size => zip::inflate(data, size, inflater),
            _ => (data.len() == size).then(|| data.to_vec()),
        };
        let broken = || format!("tile {}, {} of level {} is broken", tile.column, tile.row, tile.level);
        inflated.ok_or_else(|| malformed(broken()))
    }

    /// Width and height of a tile in texels.
    fn tile_size(&self, tile: TilePlace) -> (usize, usize) {
        let (width, height) = self.sizes[tile.level];
        (TILE.min(width - tile.column * TILE), TILE.min(height - tile.row * TILE))
    }

    /// Zeros for each layer of each level.
    fn empty_levels(&self, specs: &[LayerSpec]) -> Vec<Vec<Samples>> {
        let zeros = |width: usize, height: usize, spec: &LayerSpec| {
            Samples::zeros(self.sample_type, width * height * spec.channels.len())
        };
        let level =
            |&(width, height): &(usize, usize)| specs.iter().map(|spec| zeros(width, height, spec)).collect();
        self.sizes.iter().map(level).collect()
    }

    /// Copies the samples of a tile into the layers of its level.
    fn scatter(&self, tile: TilePlace, block: &[u8], layers: &mut [Samples]) {
        let (level_width, level_height) = self.sizes[tile.level];
        let (width, height) = self.tile_size(tile);
        let mut rows = block.chunks_exact(width * self.sample_type.bytes());
        for row in 0..height {
            let start = (tile.row * TILE + row) * level_width + tile.column * TILE;
            for (channel, bytes) in self.channels.iter().zip(rows.by_ref()) {
                let samples = &mut layers[channel.layer];
                let stride = samples.len() / (level_width * level_height);
                let first = start * stride + channel.index;
                match samples {
                    Samples::F16(samples) => put(&mut samples[first..], stride, bytes, f16::from_le_bytes),
                    Samples::F32(samples) => put(&mut samples[first..], stride, bytes, f32::from_le_bytes),
                    Samples::U8(_) | Samples::U16(_) => unreachable!("the samples of EXR files are floats"),
                }
            }
        }
    }

    /// Builds the textures from the samples of each level and layer.
    fn textures(&self, levels: Vec<Vec<Samples>>, specs: Vec<LayerSpec>) -> Result<Vec<Texture>, ShapeFault> {
        let mut images: Vec<Vec<Image>> = specs.iter().map(|_| Vec::new()).collect();
        for ((width, height), layers) in self.sizes.iter().zip(levels) {
            for ((images, spec), samples) in images.iter_mut().zip(&specs).zip(layers) {
                let image = Image::new(*width, *height, spec.channels.len(), samples);
                images.push(image.expect("the samples were made for this size"));
            }
        }
        let texture =
            |(spec, levels): (LayerSpec, _)| Texture::new(spec.name, spec.channels.to_vec(), levels);
        specs.into_iter().zip(images).map(texture).collect()
    }
}

/// Copies a row of samples to every `stride`th position.
fn put<T, const N: usize>(places: &mut [T], stride: usize, bytes: &[u8], from_le_bytes: fn([u8; N]) -> T) {
    let (samples, _) = bytes.as_chunks::<N>();
    for (place, sample) in places.iter_mut().step_by(stride).zip(samples) {
        *place = from_le_bytes(*sample);
    }
}

fn malformed(fault: String) -> ReadError {
    ReadError::Malformed { format: "EXR", fault }
}

fn unsupported(what: &str) -> ReadError {
    ReadError::Unsupported {
        format: "EXR",
        what: what.to_owned(),
        remedy: "give the file as roughcast wrote it",
    }
}
