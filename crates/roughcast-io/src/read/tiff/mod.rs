//! TIFF and BigTIFF: strips and tiles, interleaved and planar, integers and floats.
//!
//! This module reads tags and the arrangement of pixels; other crates unpack the pixels (`weezl`, `libdeflater`,
//! `zstd`, `fax`, and the reader of WebP). The `tiff` crate (0.11) rejects valid LZW tiles and tiles with the tags of
//! strips as broken files, panics on planar tiles, and undoes predictors wrongly if there are extra samples.
//!
//! Follows TIFF 6.0 (<https://www.itu.int/itudoc/itu-t/com16/tiff-fx/docs/tiff6.pdf>). Where real files deviate from
//! it, or it leaves something undefined, this module follows libtiff.

mod chunks;
mod decompress;
mod directory;
mod geo;
mod layout;
mod nodata;
mod palette;
mod predictor;
mod samples;
mod words;

use roughcast::Image;

use super::choice::chosen;
use super::memory::{check_size, malformed};
use crate::{Decoded, FileInfo, Limits, ReadError, ReadOptions};
use chunks::Chunks;
use directory::{Directory, File, tag};
use layout::{Colours, Layout};
use samples::Stored;

const FORMAT: &str = "TIFF";
const SAVE_PLAIN: &str = "save it as grey or RGB of 8 or 16 bits or of floats";

/// Reads an image of a TIFF: the first full-size one, or the one selected by [`ReadOptions::layer`], numbered from 1.
///
/// - Unsigned integers of 1, 2, 4 and 8 bits become 8 bits, those of up to 16 bits become 16 bits, both scaled to the
///   full range.
/// - Unsigned integers of more bits become floats: 0 ..= 1 for colours, and for grey if the largest value needs one of
///   the highest 8 bits; otherwise the values are kept, as heights in some unit.
/// - Signed integers of one channel become floats with the same values, heights in some unit. With more channels they
///   are signed normalised, -1 ..= 1.
/// - 16-bit floats become half floats; 24-, 32- and 64-bit floats become floats.
/// - Where 0 is white (photometric interpretation 0), unsigned integers are inverted. libtiff does so for its RGBA
///   images; OpenImageIO for up to 8 bits; tifffile does not.
/// - Grey with a second sample is grey and alpha only if the file marks that sample as alpha.
/// - Texels with the value of GDAL's "no data" tag, and texels outside GDAL's mask, become NaN.
/// - Palettes become RGB. Orientation, gamma and colour profiles are ignored.
pub(super) fn read(bytes: &[u8], options: &ReadOptions) -> Result<Decoded, ReadError> {
    let file = File::new(bytes)?;
    let directories = file.directories()?;
    let (directory, mut warnings) = choose(&directories, options.layer.as_deref())?;
    let side = |tag: u16| directory.unsigned_or(tag, 0);
    let (width, height) = (side(tag::IMAGE_WIDTH)?, side(tag::IMAGE_LENGTH)?);
    let (width, height) = check_size(FORMAT, width, height, &options.limits)?;
    let mut layout = Layout::of(directory, &options.channels)?;
    let chunks = Chunks::of(file, directory, &mut layout, (width, height), &options.limits)?;
    warnings.append(&mut layout.warnings);
    let mask = read_mask(file, &directories, (width, height), &options.limits)?;
    let Stored { samples, range, warnings: of_samples } = samples::read(directory, &chunks, &layout, mask)?;
    warnings.extend(of_samples);
    if layout.bits == 24 && layout.is_bit_stream() && !file.is_big_endian {
        warnings.push("the byte order of its integers of 24 bits is not defined: the first byte is taken as the highest".to_owned());
    }
    let left_out = chunks.left_out();
    if left_out > 0 {
        warnings.push(format!("the program that wrote it left out {left_out} of its strips or tiles"));
    }

    let channels: Vec<&str> = match layout.colours {
        Colours::Palette => vec!["R", "G", "B"],
        _ => layout.channels.iter().map(|channel| channel.name.as_str()).collect(),
    };
    let image = Image::new(width, height, channels.len(), samples).map_err(|e| malformed(FORMAT, e))?;
    let info = FileInfo {
        range,
        warnings,
        pixel_size: geo::pixel_size(directory),
        ..FileInfo::of_picture(FORMAT, layout.words(), (width, height), &channels)
    };
    let decoded = Decoded { image, info };
    match layout.colours {
        // Its channels are those of its colours, known only at this point.
        Colours::Palette => chosen(decoded, &ReadOptions { layer: None, ..options.clone() }),
        _ => Ok(decoded),
    }
}

/// Bits of the tag NewSubfileType: a smaller version of another image, and a mask of another.
const REDUCED: u64 = 0b001;
const MASK: u64 = 0b100;

fn subfile_type(directory: &Directory<'_>) -> u64 {
    directory.unsigned(tag::NEW_SUBFILE_TYPE).ok().flatten().unwrap_or(0)
}

/// The mask, if any, of a file with one image: 0 for each pixel without data.
fn read_mask(
    file: File<'_>,
    directories: &[Directory<'_>],
    size: (usize, usize),
    limits: &Limits,
) -> Result<Option<Vec<u8>>, ReadError> {
    let images =
        directories.iter().filter(|directory| subfile_type(directory) & (REDUCED | MASK) == 0).count();
    let Some(directory) = directories.iter().find(|directory| subfile_type(directory) == MASK) else {
        return Ok(None);
    };
    let side = |tag: u16| directory.unsigned_or(tag, 0).map(|side| side as usize);
    if images > 1 || (side(tag::IMAGE_WIDTH)?, side(tag::IMAGE_LENGTH)?) != size {
        return Ok(None);
    }
    let Some(mut layout) = Layout::of_mask(directory)? else { return Ok(None) };
    let chunks = Chunks::of(file, directory, &mut layout, size, limits)?;
    chunks.decode(&layout, 0, |word| word as u8).map(Some)
}

/// The directory of the requested image, with a warning if there are others.
fn choose<'d, 'a>(
    directories: &'d [Directory<'a>],
    layer: Option<&str>,
) -> Result<(&'d Directory<'a>, Vec<String>), ReadError> {
    let is_full = |directory: &&Directory<'_>| subfile_type(directory) & (REDUCED | MASK) == 0;
    let mut images: Vec<&Directory<'_>> = directories.iter().filter(is_full).collect();
    if images.is_empty() {
        images.extend(directories.first());
    }
    let count = images.len();
    let Some(name) = layer else {
        let first = images.first().copied().ok_or_else(|| malformed(FORMAT, "it has no image"))?;
        let warning = (count > 1).then(|| {
            format!("it has {count} images, of which the first is read; others are chosen by their number")
        });
        return Ok((first, warning.into_iter().collect()));
    };
    let number = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let image = number.and_then(|index| images.get(index)).copied();
    let contents = || if count == 1 { "1".to_owned() } else { format!("1 to {count}") };
    let image = image.ok_or_else(|| ReadError::NoSuchChannel {
        format: FORMAT,
        wanted: name.to_owned(),
        contents: contents(),
    })?;
    Ok((image, Vec::new()))
}
