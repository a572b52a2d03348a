//! Palettes: TIFF 6.0, section 5.

use roughcast::Samples;

use super::chunks::Chunks;
use super::directory::{Directory, tag};
use super::layout::{Layout, Numbers};
use super::{FORMAT, SAVE_PLAIN};
use crate::ReadError;
use crate::read::memory::{malformed, unsupported};

/// The factor for an 8-bit colour: 257 maps maximum to maximum; many writers shift by 8 bits instead.
const EIGHT_BITS: [u16; 2] = [257, 256];

/// Converts an image of indices to colours: 8 bits if that is exact, otherwise 16.
pub(super) fn read(
    directory: &Directory<'_>,
    chunks: &Chunks<'_>,
    layout: &Layout,
) -> Result<Samples, ReadError> {
    if layout.numbers != Numbers::Unsigned || layout.bits > 16 {
        return Err(unsupported(FORMAT, format_args!("a palette with {}", layout.words()), SAVE_PLAIN));
    }
    let mut table = table_of(directory, 1 << layout.bits)?;
    // Some writers stored 8-bit colours; as in libtiff, small values identify them.
    if table.iter().flatten().all(|&value| value <= 255) {
        table.iter_mut().flatten().for_each(|value| *value <<= 8);
    }
    // Every index of this many bits has an entry.
    let are_multiples = |factor: &u16| table.iter().flatten().all(|value| value.is_multiple_of(*factor));
    if EIGHT_BITS.iter().any(are_multiples) {
        let table: Vec<[u8; 3]> = table.iter().map(|color| color.map(|value| (value >> 8) as u8)).collect();
        let colors = chunks.decode(layout, [0; 3], |index| table[index as usize])?;
        return Ok(Samples::U8(colors.into_flattened()));
    }
    let colors = chunks.decode(layout, [0; 3], |index| table[index as usize])?;
    Ok(Samples::U16(colors.into_flattened()))
}

/// The colours: all reds come first, then the greens, then the blues.
fn table_of(directory: &Directory<'_>, len: usize) -> Result<Vec<[u16; 3]>, ReadError> {
    let missing = || malformed(FORMAT, format_args!("it has no palette of {len} colours"));
    let values = directory.values(tag::COLOR_MAP)?.ok_or_else(missing)?;
    let value = |index: usize| values.unsigned(index).and_then(|value| u16::try_from(value).ok());
    let color = |index: usize| Some([value(index)?, value(len + index)?, value(2 * len + index)?]);
    (0..len).map(color).collect::<Option<_>>().ok_or_else(missing)
}
