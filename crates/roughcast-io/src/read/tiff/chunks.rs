//! Strips and tiles: locating them, and decoding them into rows of samples.

use rayon::prelude::*;

use super::FORMAT;
use super::decompress::{Compression, Shape, decompress};
use super::directory::{Directory, File, Values, ends_too_early, tag};
use super::layout::{Layout, Numbers};
use super::predictor::{self, Predictor, RowLayout};
use super::words;
use crate::read::memory::{check_size, malformed, unsupported, zeros};
use crate::{Limits, ReadError};

/// The strips or tiles of an image.
pub(super) struct Chunks<'a> {
    file: File<'a>,
    width: usize,
    height: usize,
    /// Pixels in a row of a strip or tile.
    chunk_width: usize,
    /// Rows of a strip or tile; the last strip may have fewer in the file.
    chunk_height: usize,
    is_tiled: bool,
    /// Number of planes: 1 if the samples of a pixel are interleaved, otherwise one per sample.
    planes: usize,
    offsets: Values<'a>,
    byte_counts: Option<Values<'a>>,
    compression: Compression,
    predictor: Predictor,
    /// Whether the bits of each byte are stored in reverse order.
    is_bit_reversed: bool,
}

/// Buffers reused for each chunk.
#[derive(Default)]
struct Scratch {
    bit_reversed: Vec<u8>,
    unpacked: Vec<u8>,
    sorted: Vec<u8>,
    words: Vec<u64>,
}

impl<'a> Chunks<'a> {
    pub fn of(
        file: File<'a>,
        directory: &Directory<'a>,
        layout: &mut Layout,
        (width, height): (usize, usize),
        limits: &Limits,
    ) -> Result<Self, ReadError> {
        let is_tiled = directory.unsigned(tag::TILE_WIDTH)?.is_some();
        let side = |tag: u16, full: usize| match directory.unsigned(tag)? {
            Some(0) => Err(malformed(FORMAT, "its strips or tiles have no pixels")),
            Some(side) => Ok(side),
            None => Ok(full as u64),
        };
        let (chunk_width, chunk_height) = if is_tiled {
            (side(tag::TILE_WIDTH, width)?, side(tag::TILE_LENGTH, height)?)
        } else {
            // Often 2^32 - 1, for "all rows".
            (width as u64, side(tag::ROWS_PER_STRIP, height)?.min(height as u64))
        };
        let planes = match directory.unsigned_or(tag::PLANAR_CONFIGURATION, 1)? {
            1 => 1,
            2 => layout.samples,
            other => return Err(malformed(FORMAT, format_args!("there is no planar configuration {other}"))),
        };
        // Tiles are decoded whole and may be far larger than the image, so they count against the limit too.
        let padded = |side: usize, chunk: u64| (side as u64).div_ceil(chunk).saturating_mul(chunk);
        let unread = (layout.samples / planes).div_ceil(layout.channels.len()) as u64;
        check_size(
            FORMAT,
            padded(width, chunk_width).saturating_mul(unread),
            padded(height, chunk_height),
            limits,
        )?;

        // Some writers use the strip tags for tiles, others the tile tags for strips.
        let either = |a: u16, b: u16| Ok::<_, ReadError>(directory.values(a)?.or(directory.values(b)?));
        let (offsets, byte_counts) = if is_tiled {
            (
                either(tag::TILE_OFFSETS, tag::STRIP_OFFSETS)?,
                either(tag::TILE_BYTE_COUNTS, tag::STRIP_BYTE_COUNTS)?,
            )
        } else {
            (
                either(tag::STRIP_OFFSETS, tag::TILE_OFFSETS)?,
                either(tag::STRIP_BYTE_COUNTS, tag::TILE_BYTE_COUNTS)?,
            )
        };
        let offsets = offsets.ok_or_else(|| malformed(FORMAT, "it does not state where its pixels are"))?;
        let compression = Compression::of(directory.unsigned_or(tag::COMPRESSION, 1)?)?;
        let chunks = Self {
            file,
            width,
            height,
            chunk_width: chunk_width as usize,
            chunk_height: chunk_height as usize,
            is_tiled,
            planes,
            offsets,
            byte_counts,
            compression,
            predictor: predictor_of(directory, compression, layout)?,
            is_bit_reversed: directory.unsigned_or(tag::FILL_ORDER, 1)? == 2,
        };
        chunks.check(layout)?;
        Ok(chunks)
    }

    fn check(&self, layout: &Layout) -> Result<(), ReadError> {
        let wanted = self.count();
        if self.offsets.len() < wanted || self.byte_counts.is_some_and(|counts| counts.len() < wanted) {
            let there = self.offsets.len().min(self.byte_counts.map_or(usize::MAX, |counts| counts.len()));
            return Err(malformed(
                FORMAT,
                format_args!("it has {there} strips or tiles, and its size needs {wanted}"),
            ));
        }
        let samples = layout.samples / self.planes;
        match self.compression {
            Compression::CcittGroup4 if (layout.bits, samples) != (1, 1) => {
                Err(malformed(FORMAT, "CCITT compression is for one bit per pixel"))
            }
            Compression::WebP if layout.bits != 8 || !matches!(samples, 3 | 4) => {
                Err(malformed(FORMAT, "WebP compression is for RGB of 8 bits"))
            }
            _ => Ok(()),
        }
    }

    fn across(&self) -> usize {
        self.width.div_ceil(self.chunk_width)
    }

    fn down(&self) -> usize {
        self.height.div_ceil(self.chunk_height)
    }

    fn count(&self) -> usize {
        self.across() * self.down() * self.planes
    }

    /// Number of strips or tiles that the writer left out, as GDAL does for those without data.
    pub fn left_out(&self) -> usize {
        (0..self.count()).filter(|&index| self.is_left_out(index)).count()
    }

    fn is_left_out(&self, index: usize) -> bool {
        self.offsets.unsigned(index) == Some(0)
            && self.byte_counts.is_some_and(|c| c.unsigned(index) == Some(0))
    }

    /// Decodes the selected samples, interleaved. `convert` turns bits into a sample; `nothing` fills strips or tiles
    /// that were left out.
    pub fn decode<T>(
        &self,
        layout: &Layout,
        nothing: T,
        convert: impl Fn(u64) -> T + Sync,
    ) -> Result<Vec<T>, ReadError>
    where
        T: Copy + Send + Sync + bytemuck::Zeroable,
    {
        let row_len = self.width * layout.channels.len();
        // The product may overflow if the caller's limit far exceeds the memory; then the image would not fit either.
        let mut samples = zeros::<T>(row_len.saturating_mul(self.height))?;
        let bands = samples.par_chunks_mut(row_len * self.chunk_height).enumerate();
        let fault = bands
            .map_init(Scratch::default, |scratch, (band, rows)| {
                self.decode_band(layout, band, rows, scratch, nothing, &convert)
            })
            .find_first(Result::is_err);
        fault.unwrap_or(Ok(())).map(|()| samples)
    }

    /// Decodes a strip, or a row of tiles, of every plane into its rows of the image.
    fn decode_band<T: Copy>(
        &self,
        layout: &Layout,
        band: usize,
        rows: &mut [T],
        scratch: &mut Scratch,
        nothing: T,
        convert: &impl Fn(u64) -> T,
    ) -> Result<(), ReadError> {
        let channels = layout.channels.len();
        let samples = layout.samples / self.planes;
        let row_len = self.width * channels;
        for plane in 0..self.planes {
            // The position of each channel of the image in a pixel of this plane.
            let sources: Vec<(usize, usize)> = (layout.channels.iter().enumerate())
                .filter(|(_, channel)| self.planes == 1 || channel.sample == plane)
                .map(|(index, channel)| (index, if self.planes == 1 { channel.sample } else { 0 }))
                .collect();
            if sources.is_empty() {
                continue;
            }
            for column in 0..self.across() {
                let index = (plane * self.down() + band) * self.across() + column;
                let left = column * self.chunk_width;
                let visible = self.chunk_width.min(self.width - left);
                let targets = rows
                    .chunks_exact_mut(row_len)
                    .map(|row| &mut row[left * channels..][..visible * channels]);
                if self.is_left_out(index) {
                    targets.for_each(|target| {
                        let pixels = target.chunks_exact_mut(channels);
                        pixels.for_each(|pixel| {
                            sources.iter().for_each(|&(channel, _)| pixel[channel] = nothing)
                        });
                    });
                    continue;
                }
                let row_layout = RowLayout {
                    bits: layout.bits,
                    is_bit_stream: layout.is_bit_stream(),
                    samples,
                    is_big_endian: self.file.is_big_endian,
                };
                let row_bytes = self.unpack(index, rows_of(targets.len(), self), row_layout, scratch)?;
                for (target, row) in targets.zip(scratch.unpacked.chunks_exact_mut(row_bytes)) {
                    predictor::undo(self.predictor, row, row_layout, &mut scratch.sorted);
                    words::unpack(row, row_layout, visible * samples, &mut scratch.words);
                    let pixels = target.chunks_exact_mut(channels).zip(scratch.words.chunks_exact(samples));
                    for (pixel, stored) in pixels {
                        sources
                            .iter()
                            .for_each(|&(channel, sample)| pixel[channel] = convert(stored[sample]));
                    }
                }
            }
        }
        Ok(())
    }

    /// Unpacks a strip or tile into the buffer and returns the number of bytes per row.
    fn unpack(
        &self,
        index: usize,
        needed_rows: usize,
        row: RowLayout,
        scratch: &mut Scratch,
    ) -> Result<usize, ReadError> {
        let row_bytes = (self.chunk_width * row.samples * row.bits as usize).div_ceil(8);
        let bytes = row_bytes * self.chunk_height;
        if scratch.unpacked.len() != bytes {
            scratch.unpacked = zeros(bytes)?;
        }
        let offset = self.offsets.unsigned(index).ok_or_else(ends_too_early)?;
        let length = match self.byte_counts {
            Some(counts) => counts.unsigned(index).ok_or_else(ends_too_early)?,
            // Required, but early writers left it out.
            None => u64::MAX,
        };
        let mut packed = self.file.slice_up_to(offset, length);
        if self.is_bit_reversed {
            scratch.bit_reversed.clear();
            scratch.bit_reversed.extend(packed.iter().map(|byte| byte.reverse_bits()));
            packed = &scratch.bit_reversed;
        }
        let shape = Shape { width: self.chunk_width, rows: needed_rows, samples: row.samples, row_bytes };
        decompress(self.compression, packed, &mut scratch.unpacked, shape)?;
        Ok(row_bytes)
    }
}

/// Rows that a strip or tile must have in the file: tiles are always whole; the last strip ends with the image.
fn rows_of(visible: usize, chunks: &Chunks<'_>) -> usize {
    if chunks.is_tiled { chunks.chunk_height } else { visible }
}

fn predictor_of(
    directory: &Directory<'_>,
    compression: Compression,
    layout: &mut Layout,
) -> Result<Predictor, ReadError> {
    let predictor = match directory.unsigned_or(tag::PREDICTOR, 1)? {
        1 => Predictor::None,
        2 => Predictor::Horizontal,
        3 => Predictor::FloatingPoint,
        other => return Err(malformed(FORMAT, format_args!("there is no predictor {other}"))),
    };
    if predictor != Predictor::None && !compression.has_predictor() {
        layout.warnings.push("its predictor tag is ignored, since its compression uses none".to_owned());
        return Ok(Predictor::None);
    }
    let is_float = layout.numbers == Numbers::Float;
    if predictor::is_defined(predictor, layout.bits, is_float) {
        return Ok(predictor);
    }
    let what = format_args!("this predictor for samples of {} bits", layout.bits);
    Err(unsupported(FORMAT, what, "save it without a predictor"))
}
