//! OpenEXR: scan lines and tiles, level 0 of mip and rip maps, any flat part of a multi-part file.
//!
//! The `exr` crate reads the header and undoes the compression. This module does the steps between them: it locates
//! each block in the file and places its rows in the image. The crate's own code for this allocates the sizes that the
//! file states before it checks that the bytes exist. See [`blocks`].

mod blocks;
mod channels;
mod dwa;
mod names;
mod window;

use std::collections::BTreeMap;
use std::io::Cursor;

use exr::compression::Compression;
use exr::meta::attribute::{AttributeValue, LevelMode, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData, compute_level_count};
use roughcast::{Image, SampleType, Samples};

use self::channels::Selection;
use self::window::Windows;
use super::memory::{malformed, unsupported, zeros};
use crate::metadata::insert;
use crate::{Decoded, FileInfo, ReadError, ReadOptions, ValueRange};

const FORMAT: &str = "EXR";
/// Compressions numbered 10 and above are newer than those read here.
const FIRST_UNKNOWN_COMPRESSION: u8 = 10;
/// The key that marks a file as written by roughcast.
const LAYOUT_KEY: &str = "roughcast.layout";
const SAVE_AS_ZIP: &str = "save it with ZIP compression";

/// Reads level 0 of an EXR: the pixels of its display window, with the channels chosen by [`channels::select`].
///
/// Halves stay halves unless another chosen channel is a float. Unsigned integers are refused: they are object
/// identifiers, and a float would round them. Text attributes become metadata. `FileInfo::levels` of a rip map counts
/// the levels along its longer side.
pub(super) fn read(bytes: &[u8], options: &ReadOptions) -> Result<Decoded, ReadError> {
    let mut input = Cursor::new(bytes);
    let meta = MetaData::read_from_buffered(&mut input, false).map_err(|e| header_fault(bytes, e))?;
    let tables_start = input.position();
    // All layers of a baked texture are read, whatever their names.
    let is_baked = meta.headers.iter().any(|header| text_pairs(header).contains_key(LAYOUT_KEY));
    let selection = channels::select(&meta, options, is_baked)?;
    let header = &meta.headers[selection.part];
    let windows = Windows::of(header, &options.limits)?;
    channels::check_sampling(header)?;
    if matches!(header.compression, Compression::HTJ2K32 | Compression::HTJ2K256) {
        return Err(unsupported(FORMAT, "HTJ2K compression", SAVE_AS_ZIP));
    }
    let source = blocks::Source::locate(bytes, tables_start, &meta, selection.part)?;

    let channels = selection.channels.len();
    let (columns, rows) = windows.data_size();
    let len = columns * rows * channels;
    let samples = match selection.sample_type {
        SampleType::F16 => {
            let mut samples = zeros(len)?;
            source.read_into(&selection, &mut samples)?;
            Samples::F16(windows.placed(samples, channels)?)
        }
        _ => {
            let mut samples = zeros(len)?;
            source.read_into(&selection, &mut samples)?;
            Samples::F32(windows.placed(samples, channels)?)
        }
    };
    let (width, height) = windows.size();
    let image = Image::new(width, height, channels, samples).map_err(|e| malformed(FORMAT, e))?;
    let left_out =
        selection.left_out.as_ref().map(|others| format!("its other layers are left out: {others}"));
    let warnings = windows.warning().into_iter().chain(left_out).collect();
    let info = FileInfo { warnings, ..file_info(header, &selection, (width, height)) };
    Ok(Decoded { info, image })
}

fn file_info(header: &Header, selection: &Selection, (width, height): (usize, usize)) -> FileInfo {
    let names: Vec<String> = selection.channels.iter().map(|channel| channel.name.clone()).collect();
    let sample = if selection.sample_type == SampleType::F16 { "half" } else { "float" };
    let layer = selection.layer.as_ref().map(|layer| format!(" of layer {layer}")).unwrap_or_default();
    let format = format!("{sample} {}{layer}, {}", names.join(", "), header.compression);
    FileInfo {
        levels: level_count(header),
        range: ValueRange::Float,
        channels: names,
        metadata: text_pairs(header),
        ..FileInfo::of_picture(FORMAT, format, (width, height), &[])
    }
}

fn level_count(header: &Header) -> usize {
    match header.blocks {
        BlockDescription::Tiles(tiles) if tiles.level_mode != LevelMode::Singular => {
            let longer_side = header.layer_size.width().max(header.layer_size.height());
            compute_level_count(tiles.rounding_mode, longer_side)
        }
        _ => 1,
    }
}

/// The text attributes, under their names in the file.
fn text_pairs(header: &Header) -> BTreeMap<String, String> {
    let own = &header.own_attributes;
    let standard: [(&str, &Option<Text>); 8] = [
        ("name", &own.layer_name),
        ("view", &own.view_name),
        ("owner", &own.owner),
        ("comments", &own.comments),
        ("capDate", &own.capture_date),
        ("wrapmodes", &own.wrap_mode_name),
        ("software", &own.software_name),
        ("renderingTransform", &own.rendering_transform_name),
    ];
    let mut pairs = BTreeMap::new();
    for (key, value) in standard {
        if let Some(value) = value {
            insert(&mut pairs, key, &text(value));
        }
    }
    for (key, value) in &own.other {
        if let AttributeValue::Text(value) = value {
            insert(&mut pairs, &text(key), &text(value));
        }
    }
    pairs
}

/// The crate returns each byte as the character with that code; the files contain UTF-8.
fn text(value: &Text) -> String {
    String::from_utf8_lossy(value.as_slice()).into_owned()
}

/// Why the header could not be read. The crate skips an attribute that it does not understand and then reports it as
/// missing: for a compression that is too new, it only says that there is none.
fn header_fault(bytes: &[u8], error: exr::error::Error) -> ReadError {
    const COMPRESSION_ATTRIBUTE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    let end = bytes.windows(COMPRESSION_ATTRIBUTE.len()).position(|window| window == COMPRESSION_ATTRIBUTE);
    let number = end.and_then(|start| bytes.get(start + COMPRESSION_ATTRIBUTE.len()));
    match (number, error) {
        (Some(&number), _) if number >= FIRST_UNKNOWN_COMPRESSION => {
            unsupported(FORMAT, format_args!("the compression of number {number}"), SAVE_AS_ZIP)
        }
        (_, error) => fault(error),
    }
}

fn fault(error: exr::error::Error) -> ReadError {
    use exr::error::Error;
    match error {
        Error::NotSupported(what) => unsupported(FORMAT, what, SAVE_AS_ZIP),
        // The crate's message for reads past the end of the file.
        Error::Invalid(what) if what.contains("reference to missing bytes") => {
            malformed(FORMAT, "it ends too early, or refers to bytes past its end")
        }
        Error::Invalid(what) if what.starts_with("missing or invalid") => malformed(FORMAT, what),
        Error::Invalid(what) => malformed(FORMAT, format_args!("invalid {what}")),
        error => malformed(FORMAT, error),
    }
}
