//! Unpacks the blocks of an EXR into the rows of an image.
//!
//! The offset table contains the position of each block. Every block of level 0 is looked up first, and must lie within
//! the file and identify itself as the expected block; only then is the image allocated, and each block unpacked once.
//! The number of pixels and the file size therefore bound the work and the memory, however damaged the file is.

use exr::block::UncompressedBlock;
use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use half::f16;
use rayon::prelude::*;
use roughcast::SampleType;

use super::super::memory::malformed;
use super::FORMAT;
use super::channels::Selection;
use crate::ReadError;

/// The blocks of level 0 of one part, found in the file.
pub(super) struct Source<'a> {
    meta: &'a MetaData,
    part: usize,
    grid: Grid,
    /// The compressed bytes of each block, row by row of the grid.
    blocks: Vec<&'a [u8]>,
}

/// How level 0 is cut into blocks.
#[derive(Clone, Copy)]
struct Grid {
    width: usize,
    height: usize,
    block_width: usize,
    block_height: usize,
}

impl Grid {
    fn of(header: &Header) -> Self {
        let Vec2(width, height) = header.layer_size;
        let (block_width, block_height) = match header.blocks {
            BlockDescription::ScanLines => (width, header.compression.scan_lines_per_block()),
            BlockDescription::Tiles(tiles) => (tiles.tile_size.width(), tiles.tile_size.height()),
        };
        Self { width, height, block_width, block_height }
    }

    fn columns(&self) -> usize {
        self.width.div_ceil(self.block_width)
    }

    fn rows(&self) -> usize {
        self.height.div_ceil(self.block_height)
    }

    /// Size in pixels of the block in this column and row; blocks at the right and lower edge may be smaller.
    fn size(&self, column: usize, row: usize) -> (usize, usize) {
        (
            self.block_width.min(self.width - column * self.block_width),
            self.block_height.min(self.height - row * self.block_height),
        )
    }
}

impl<'a> Source<'a> {
    /// Finds the blocks. `tables_start` is the position of the offset tables, right after the headers.
    pub(super) fn locate(
        bytes: &'a [u8],
        tables_start: u64,
        meta: &'a MetaData,
        part: usize,
    ) -> Result<Self, ReadError> {
        let header = &meta.headers[part];
        let grid = Grid::of(header);
        let too_short = || malformed(FORMAT, "the file ends within its table of blocks");
        // Level 0 comes first in the table of a part, and the parts' tables follow each other.
        let entries_before = meta.headers[..part].iter().map(|header| header.chunk_count as u64);
        let table_start =
            entries_before.map(|entries| entries.saturating_mul(8)).fold(tables_start, u64::saturating_add);
        let table =
            usize::try_from(table_start).ok().and_then(|start| bytes.get(start..)).ok_or_else(too_short)?;
        let count = grid.columns() * grid.rows();
        let table = count.checked_mul(8).and_then(|len| table.get(..len)).ok_or_else(too_short)?;

        let mut blocks = Vec::with_capacity(count);
        for (i, entry) in table.chunks_exact(8).enumerate() {
            let offset = u64::from_le_bytes(std::array::from_fn(|byte| entry[byte]));
            let place = (i % grid.columns(), i / grid.columns());
            blocks.push(find_block(bytes, offset, meta, part, place)?);
        }
        Ok(Self { meta, part, grid, blocks })
    }

    /// Unpacks the blocks, and puts the selected channels into `samples`, the whole image.
    ///
    /// Each task fills the rows of one row of blocks.
    pub(super) fn read_into<T: Sample>(
        &self,
        selection: &Selection,
        samples: &mut [T],
    ) -> Result<(), ReadError> {
        let band = self.grid.block_height.min(self.grid.height) * self.grid.width * selection.channels.len();
        samples.par_chunks_mut(band).enumerate().try_for_each(|(row, band)| {
            (0..self.grid.columns()).try_for_each(|column| {
                let pixels = self.unpack(column, row)?;
                self.place(&pixels, (column, row), selection, band)
            })
        })
    }

    /// The bytes of one block: row by row, with the samples of each channel of the file contiguous within a row.
    fn unpack(&self, column: usize, row: usize) -> Result<Vec<u8>, ReadError> {
        let header = &self.meta.headers[self.part];
        let (width, height) = self.grid.size(column, row);
        let raw_bytes = width * height * header.channels.bytes_per_pixel;
        let packed = self.blocks[row * self.grid.columns() + column];
        if packed.len() > raw_bytes {
            // A block that would grow under compression is stored uncompressed.
            return Err(malformed(FORMAT, "a block is longer than its pixels"));
        }
        let is_dwa = matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_));
        if is_dwa && packed.len() != raw_bytes {
            super::dwa::check(packed, width, height, header.channels.list.len(), raw_bytes)?;
        }
        let compressed_block = match header.blocks {
            BlockDescription::ScanLines => CompressedBlock::ScanLine(CompressedScanLineBlock {
                y_coordinate: scan_line_y(header, row),
                compressed_pixels_le: packed.to_vec(),
            }),
            BlockDescription::Tiles(_) => CompressedBlock::Tile(CompressedTileBlock {
                coordinates: TileCoordinates { tile_index: Vec2(column, row), level_index: Vec2(0, 0) },
                compressed_pixels_le: packed.to_vec(),
            }),
        };
        let chunk = Chunk { layer_index: self.part, compressed_block };
        let block = UncompressedBlock::decompress_chunk(chunk, self.meta, false).map_err(super::fault)?;
        if block.data.len() != raw_bytes {
            return Err(malformed(FORMAT, "a block does not fill its pixels"));
        }
        Ok(block.data)
    }

    /// Copies the selected channels of one block into its band of the image.
    fn place<T: Sample>(
        &self,
        pixels: &[u8],
        (column, row): (usize, usize),
        selection: &Selection,
        band: &mut [T],
    ) -> Result<(), ReadError> {
        let (width, _) = self.grid.size(column, row);
        let bytes_per_pixel = self.meta.headers[self.part].channels.bytes_per_pixel;
        let channels = selection.channels.len();
        let left = column * self.grid.block_width * channels;
        let stored_rows = pixels.chunks_exact(width * bytes_per_pixel);
        for (line, stored) in band.chunks_exact_mut(self.grid.width * channels).zip(stored_rows) {
            let line = &mut line[left..left + width * channels];
            for (i, channel) in selection.channels.iter().enumerate() {
                let run = &stored[channel.bytes_before * width..][..channel.stored.bytes() * width];
                T::copy_run(channel.stored, run, line[i..].iter_mut().step_by(channels));
            }
        }
        Ok(())
    }
}

/// A sample type of the image.
pub(super) trait Sample: Copy + Send {
    /// Copies a run of samples of one channel, stored as half or float in native byte order.
    fn copy_run<'t>(stored: SampleType, run: &[u8], target: impl Iterator<Item = &'t mut Self>)
    where
        Self: 't;
}

impl Sample for f16 {
    fn copy_run<'t>(_half: SampleType, run: &[u8], target: impl Iterator<Item = &'t mut Self>) {
        for (target, bytes) in target.zip(run.chunks_exact(2)) {
            *target = f16::from_ne_bytes([bytes[0], bytes[1]]);
        }
    }
}

impl Sample for f32 {
    fn copy_run<'t>(stored: SampleType, run: &[u8], target: impl Iterator<Item = &'t mut Self>) {
        if stored == SampleType::F16 {
            for (target, bytes) in target.zip(run.chunks_exact(2)) {
                *target = f16::from_ne_bytes([bytes[0], bytes[1]]).to_f32();
            }
        } else {
            for (target, bytes) in target.zip(run.chunks_exact(4)) {
                *target = f32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            }
        }
    }
}

/// The y coordinate that the file stores for the scan-line block at this row: data windows need not begin at 0.
fn scan_line_y(header: &Header, row: usize) -> i32 {
    let lines = (row * header.compression.scan_lines_per_block()) as i64;
    // The coordinates of the data window fit in 31 bits, so its rows do too.
    (i64::from(header.own_attributes.layer_position.y()) + lines) as i32
}

/// The compressed bytes of the block at `place` (column, row), after its header has been checked against `place`.
fn find_block<'a>(
    bytes: &'a [u8],
    offset: u64,
    meta: &MetaData,
    part: usize,
    (column, row): (usize, usize),
) -> Result<&'a [u8], ReadError> {
    if offset == 0 {
        return Err(malformed(FORMAT, "it was never finished: a block is missing"));
    }
    let outside = || malformed(FORMAT, "a block lies outside of the file");
    let header = &meta.headers[part];
    let mut words = Vec::with_capacity(6);
    if meta.requirements.is_multilayer() {
        words.push(part as i64);
    }
    match header.blocks {
        BlockDescription::ScanLines => words.push(scan_line_y(header, row).into()),
        // Column, row, and the level along each axis.
        BlockDescription::Tiles(_) => words.extend([column as i64, row as i64, 0, 0]),
    }
    let mut rest = usize::try_from(offset).ok().and_then(|offset| bytes.get(offset..)).ok_or_else(outside)?;
    for expected in words {
        if i64::from(take_i32(&mut rest).ok_or_else(outside)?) != expected {
            return Err(malformed(FORMAT, "its table of blocks points to another block"));
        }
    }
    let len = take_i32(&mut rest).ok_or_else(outside)?;
    usize::try_from(len).ok().and_then(|len| rest.get(..len)).ok_or_else(outside)
}

fn take_i32(rest: &mut &[u8]) -> Option<i32> {
    let (word, tail) = rest.split_first_chunk()?;
    *rest = tail;
    Some(i32::from_le_bytes(*word))
}
