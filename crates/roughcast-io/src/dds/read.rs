//! Reads DDS.

use std::collections::BTreeMap;

use roughcast::Image;
use roughcast::texture::{TextureArray, TextureInfo};

use super::format::Format;
use super::header::Header;
use super::{CONTAINER, format, malformed, unsupported};
use crate::payload::{Shape, textures_from};
use crate::texels::{Source, full_chain, rgba_names, swizzled};
use crate::{Decoded, FileInfo, Limits, ReadError};

/// Reads level 0 of layer 0 as an image.
///
/// SNORM formats become floats in -1 ..= 1, BC4 and BC5 UNORM become 16-bit samples, masked formats 8-bit or 16-bit
/// samples. Signed bump formats become floats of two or three channels. The two channels of an `ATI2` file keep their
/// order; if the file specifies which of them is x, [`FileInfo::normal_encoding`] contains it. A DXT5 file is read as
/// RGBA, even if alpha contains the x of normals, but the channels of RXGB and similar formats are moved back to their
/// places.
///
/// # Errors
/// [`ReadError`] if the file is broken, too large for `limits`, or of a kind that is not read (see [`super`]).
pub fn read_image(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let header = Header::parse(bytes)?;
    let (mut shape, format) = shape_of(&header)?;
    // Only level 0 is read, so an impossible level count is not an error.
    shape.levels = shape.levels.min(full_chain(shape.width, shape.height));
    shape.check(CONTAINER, limits)?;
    let texels = shape
        .layer_bytes(0)
        .and_then(|length| bytes.get(header.data_offset..header.data_offset.checked_add(length)?))
        .ok_or_else(|| too_short(&shape))?;
    let mut image = shape.format.decode(texels, shape.width, shape.height);
    let mut channels = shape.format.channel_names();
    if let Some(moved) = &format.moved {
        image = swizzled(&image, moved);
        channels = rgba_names(moved.len());
    }
    if format.may_be_reversed && is_larger_on_average(&image, 0, 2) {
        image = swizzled(&image, &[2, 1, 0].map(Source::Channel));
    }
    let size = (shape.width, shape.height);
    let info = FileInfo {
        layers: shape.layers,
        levels: shape.levels,
        range: shape.format.range(),
        metadata: metadata_of(&header.reserved),
        kind: format.kind,
        normal_encoding: format.normals,
        ..FileInfo::of_picture(CONTAINER, format.name, size, channels)
    };
    Ok(Decoded { image, info })
}

/// Reads a file written by roughcast: all layers with all their levels. Blocks are decompressed: BC4 and BC5 to 16-bit
/// samples, BC7 to 8-bit ones.
///
/// # Errors
/// [`ReadError`] if the file is broken, too large for `limits`, or not written by roughcast ([`ReadError::Info`]).
pub fn read_textures(bytes: &[u8], limits: &Limits) -> Result<TextureArray, ReadError> {
    let header = Header::parse(bytes)?;
    let info = TextureInfo::from_words(&header.reserved)?;
    let (shape, format) = shape_of(&header)?;
    shape.check(CONTAINER, limits)?;
    if !shape.is_of_a_payload() {
        return Err(unsupported(format!("a baked texture in {}", format.name), "bake it again"));
    }
    // Layer by layer, each with all its levels, largest first.
    let lengths: Vec<usize> = (0..shape.levels)
        .map(|level| shape.layer_bytes(level))
        .collect::<Option<_>>()
        .ok_or_else(|| too_short(&shape))?;
    let texels = &bytes[header.data_offset..];
    let chain = lengths.iter().try_fold(0, |sum: usize, &length| sum.checked_add(length));
    let needed = chain.and_then(|chain| chain.checked_mul(shape.layers));
    let Some(chain) = chain.filter(|_| needed.is_some_and(|needed| needed <= texels.len())) else {
        return Err(too_short(&shape));
    };
    textures_from(CONTAINER, info, &shape, |layer, level| {
        let start = layer * chain + lengths[..level].iter().sum::<usize>();
        &texels[start..start + lengths[level]]
    })
}

fn shape_of(header: &Header) -> Result<(Shape, Format), ReadError> {
    let format = format::pixel_format(header)?;
    let shape = Shape {
        width: header.width as usize,
        height: header.height as usize,
        layers: header.layers as usize,
        levels: header.levels as usize,
        format: format.texels.clone(),
    };
    Ok((shape, format))
}

/// Whether the mean of one channel exceeds that of another. The mean of a normal map's z is far above that of x:
/// normals point out of the surface.
fn is_larger_on_average(image: &Image, one: usize, other: usize) -> bool {
    let texels = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
    let difference = |(x, y)| f64::from(image.get(x, y, one)) - f64::from(image.get(x, y, other));
    texels.map(difference).sum::<f64>() > 0.0
}

fn too_short(shape: &Shape) -> ReadError {
    malformed(format!("it is too short for {}x{} texels of its format", shape.width, shape.height))
}

/// The words reserved for the writer: roughcast's as key-value pairs, those of other writers as hexadecimal numbers.
fn metadata_of(words: &[u32; 11]) -> BTreeMap<String, String> {
    if let Ok(info) = TextureInfo::from_words(words) {
        return info.to_pairs();
    }
    if words.iter().all(|&word| word == 0) {
        return BTreeMap::new();
    }
    let text = words.map(|word| format!("{word:08x}")).join(" ");
    BTreeMap::from([("dwReserved1".to_owned(), text)])
}
