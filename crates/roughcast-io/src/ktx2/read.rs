//! Reads KTX2.

use roughcast::texture::{TextureArray, TextureInfo};
use roughcast::{Kind, NormalChannels};

use super::header::Container;
use super::{CONTAINER, basis, format, malformed, unsupported};
use crate::payload::{Shape, textures_from};
use crate::texels::{flipped, rgba_names, swizzled};
use crate::{Decoded, FileInfo, Limits, NormalEncoding, ReadError};

/// Reads level 0 of layer 0 as an image.
///
/// Row 0 of the image is the top and column 0 the left, whatever the file's `KTXorientation`, and channels are in the
/// order that `KTXswizzle` specifies. `_SRGB` formats are read as raw numbers. SNORM formats become floats in -1 ..= 1,
/// BC4 and BC5 UNORM become 16-bit samples.
///
/// # Errors
/// [`ReadError`] if the file is broken, too large for `limits`, or of a kind that is not read (see [`super`]).
pub fn read_image(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let file = Container::parse(bytes)?;
    let Decoded { mut image, mut info } = match file.universal {
        Some(universal) => basis::read(bytes, &file, universal, limits)?,
        None => read_texels(&file, limits)?,
    };
    if let Some(sources) = file.swizzle(image.channels())? {
        image = swizzled(&image, &sources);
        info.channels = rgba_names(sources.len()).iter().map(|&name| name.to_owned()).collect();
    }
    for axis in file.flips()? {
        image = flipped(image, axis);
    }
    if info.normal_encoding == NormalEncoding::Unstated && is_normal_mode(&file) && image.channels() == 4 {
        info.kind = Some(Kind::Normal);
        info.normal_encoding = NormalEncoding::Stated(NormalChannels::Ra);
    }
    Ok(Decoded { image, info })
}

/// Whether Khronos' tools stored x in red, green and blue, and y in alpha, according to the options that they record.
fn is_normal_mode(file: &Container<'_>) -> bool {
    let options = file.pairs.get("KTXwriterScParams").map_or("", String::as_str);
    let words: Vec<String> = options.split_whitespace().map(|word| word.replace('_', "-")).collect();
    words.iter().any(|word| word == "--normal-mode")
}

/// Level 0 of layer 0 of a file whose `vkFormat` describes its texels.
fn read_texels(file: &Container<'_>, limits: &Limits) -> Result<Decoded, ReadError> {
    let (shape, format_name) = shape_of(file, limits)?;
    let (layer_bytes, level_bytes) = sizes(&shape, 0)?;
    let texels = file.level(0, level_bytes)?;
    let image = shape.format.decode(&texels[..layer_bytes], shape.width, shape.height);
    let channels = shape.format.channel_names();
    let size = (shape.width, shape.height);
    let info = FileInfo {
        layers: shape.layers,
        levels: shape.levels,
        range: shape.format.range(),
        metadata: file.pairs.clone(),
        ..FileInfo::of_picture(CONTAINER, format_name.to_owned(), size, channels)
    };
    Ok(Decoded { image, info })
}

/// Reads a file written by roughcast: all layers with all their levels. Blocks are decompressed: BC4 and BC5 to 16-bit
/// samples, BC7 to 8-bit ones.
///
/// # Errors
/// [`ReadError`] if the file is broken, too large for `limits`, or not written by roughcast ([`ReadError::Info`]).
pub fn read_textures(bytes: &[u8], limits: &Limits) -> Result<TextureArray, ReadError> {
    let file = Container::parse(bytes)?;
    let info = TextureInfo::from_pairs(&file.pairs)?;
    let (shape, format_name) = shape_of(&file, limits)?;
    if !shape.is_of_a_payload() {
        return Err(unsupported(format!("a baked texture in {format_name}"), "bake it again"));
    }
    if !file.flips()?.is_empty() || file.swizzle(4)?.is_some() {
        return Err(unsupported("a baked texture that was flipped or swizzled", "bake it again"));
    }
    let mut levels = Vec::new();
    for level in 0..shape.levels {
        let (layer_bytes, level_bytes) = sizes(&shape, level)?;
        levels.push((file.level(level, level_bytes)?, layer_bytes));
    }
    textures_from(CONTAINER, info, &shape, |layer, level| {
        let (texels, layer_bytes) = &levels[level];
        &texels[layer * layer_bytes..][..*layer_bytes]
    })
}

fn shape_of(file: &Container<'_>, limits: &Limits) -> Result<(Shape, &'static str), ReadError> {
    let (format, name) = format::texel_format(file.vk_format)?;
    let shape =
        Shape { width: file.width, height: file.height, layers: file.layers, levels: file.levels(), format };
    shape.check(CONTAINER, limits)?;
    Ok((shape, name))
}

/// Bytes of one layer, and of all layers, of a level.
fn sizes(shape: &Shape, level: usize) -> Result<(usize, usize), ReadError> {
    shape
        .layer_bytes(level)
        .zip(shape.level_bytes(level))
        .ok_or_else(|| malformed(format!("level {level} does not fit into memory")))
}
