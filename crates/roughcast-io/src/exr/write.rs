//! Writes textures as EXR.

use std::io::{Seek, SeekFrom, Write};

use rayon::prelude::*;
use roughcast::texture::TextureArray;

use super::plan::{Plan, TilePlace, tile_places};
use super::zip::BlockCompressor;
use super::{ExrCompression, ExrOptions, header};
use crate::WriteError;

/// Tiles that a thread compresses in one go.
const GROUP: usize = 8;
/// Tiles compressed at once, while as many again are being written: about 12 MB each with six half channels.
const BATCH: usize = 256;

/// Writes a texture array with all its levels as one EXR part, from the current position of `out`. Afterwards `out` is
/// positioned after the last byte.
///
/// The channels of all layers become channels of the file, of half or single floats as they are. The bytes do not
/// depend on the number of threads.
///
/// # Errors
/// [`WriteError::Unsupported`] for 8- and 16-bit unsigned samples, for channel names that are not unique over the
/// layers, for layers whose levels or sample types differ or whose levels do not go down to 1x1, and for attributes
/// with a name that OpenEXR keeps for itself; [`WriteError::Io`] if `out` fails.
pub fn write(
    array: &TextureArray,
    options: &ExrOptions,
    out: &mut (impl Write + Seek),
) -> Result<(), WriteError> {
    let plan = Plan::new(array)?;
    let header = header::encode(&plan, &array.info, options)?;
    let (width, height) = plan.size();
    let tiles: Vec<TilePlace> = tile_places(width, height).collect();

    let start = out.stream_position()?;
    out.write_all(&header)?;
    let mut offsets = Vec::with_capacity(tiles.len() * size_of::<u64>());
    // The offsets are known only after the tiles have been written; until then zeros reserve their space.
    out.write_all(&vec![0; offsets.capacity()])?;
    let mut position = (header.len() + offsets.capacity()) as u64;
    write_chunks(&plan, options.compression, &tiles, |group| {
        for size in &group.sizes {
            offsets.extend(position.to_le_bytes());
            position += *size as u64;
        }
        out.write_all(&group.bytes)
    })?;
    out.seek(SeekFrom::Start(start + header.len() as u64))?;
    out.write_all(&offsets)?;
    out.seek(SeekFrom::Start(start + position))?;
    Ok(())
}

/// Chunks in their file format.
struct Group {
    bytes: Vec<u8>,
    sizes: Vec<usize>,
}

/// Compresses a batch of tiles on all threads while this thread writes the previous batch in order.
fn write_chunks(
    plan: &Plan,
    compression: ExrCompression,
    tiles: &[TilePlace],
    mut write: impl FnMut(&Group) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let mut ready: Vec<Group> = Vec::new();
    for batch in tiles.chunks(BATCH) {
        let mut next = Vec::new();
        let mut written = Ok(());
        rayon::in_place_scope(|scope| {
            scope.spawn(|_| next = pack_batch(plan, compression, batch));
            written = ready.iter().try_for_each(&mut write);
        });
        written?;
        ready = next;
    }
    ready.iter().try_for_each(&mut write)
}

fn pack_batch(plan: &Plan, compression: ExrCompression, tiles: &[TilePlace]) -> Vec<Group> {
    let groups = tiles.par_chunks(GROUP);
    groups.map_init(|| Packer::new(compression), |packer, tiles| packer.pack(plan, tiles)).collect()
}

/// Per-thread state for making chunks.
struct Packer {
    raw: Vec<u8>,
    compressor: Option<BlockCompressor>,
}

impl Packer {
    fn new(compression: ExrCompression) -> Self {
        let compressor = match compression {
            ExrCompression::Zip => Some(BlockCompressor::new()),
            ExrCompression::None => None,
        };
        Self { raw: Vec::new(), compressor }
    }

    fn pack(&mut self, plan: &Plan, tiles: &[TilePlace]) -> Group {
        let mut group = Group { bytes: Vec::new(), sizes: Vec::with_capacity(tiles.len()) };
        for tile in tiles {
            self.raw.clear();
            plan.gather(*tile, &mut self.raw);
            let block = match &mut self.compressor {
                Some(compressor) => compressor.compress(&self.raw),
                None => &self.raw,
            };
            let start = group.bytes.len();
            // Column and row of the tile, level in both directions, size of the block.
            for number in [tile.column, tile.row, tile.level, tile.level, block.len()] {
                group.bytes.extend((number as i32).to_le_bytes());
            }
            group.bytes.extend(block);
            group.sizes.push(group.bytes.len() - start);
        }
        group
    }
}
