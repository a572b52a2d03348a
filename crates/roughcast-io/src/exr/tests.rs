//! Tests that write files, read them back, and read damaged ones.

use std::collections::BTreeMap;
use std::io::Cursor;

use half::f16;
use roughcast::texture::{LayerSpec, Layout, Part, Texture, TextureArray, TextureInfo, layers_of};
use roughcast::{Image, SampleType, Samples};

use super::plan::level_sizes;
use super::read::read_layers;
use super::{ExrCompression, ExrOptions, read_textures, write};
use crate::{Limits, ReadError, WriteError};

/// Layers with channels whose order in the file differs from the one in the layers.
const LAYERS: &[&[&[&str]]] = &[
    &[&["M.xx"]],
    &[&["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"]],
    &[&["N.x", "N.y", "N.z", "M.xy"], &["B.x", "B.y", "M.xx", "M.yy"]],
    &[&["c", "a"], &["d"], &["b", "R", "a name of many more than thirty-one bytes"]],
];
const SIZES: &[(usize, usize)] = &[(53, 37), (1, 7), (1, 1), (640, 427), (128, 128)];
const FLOATS: [SampleType; 2] = [SampleType::F16, SampleType::F32];

fn info() -> TextureInfo {
    TextureInfo { base_variance: 1.0 / 3.0, ..TextureInfo::new(Layout::BumpSlopes, Part::Whole) }
}

/// Smooth hills with some noise, so that tiles are neither trivial nor incompressible; different in each channel.
fn sample(x: usize, y: usize, channel: usize, level: usize) -> f32 {
    let (u, v) = (x as f32 * 0.1, y as f32 * 0.13 + channel as f32);
    let noise = (x * 7919 + y * 104_729 + channel * 31 + level) % 97;
    // Part of the picture is constant, as in real maps.
    if (x / 16 + y / 16).is_multiple_of(3) { 0.5 } else { u.sin() * v.cos() * 10.0 + noise as f32 * 1e-3 }
}

fn level(width: usize, height: usize, channels: usize, level: usize, sample_type: SampleType) -> Image {
    let values = (0..width * height * channels).map(|index| {
        let texel = index / channels;
        sample(texel % width, texel / width, index % channels, level)
    });
    let samples = match sample_type {
        SampleType::F16 => Samples::F16(values.map(f16::from_f32).collect()),
        SampleType::F32 => Samples::F32(values.collect()),
        SampleType::U8 => Samples::U8(values.map(|v| v as u8).collect()),
        SampleType::U16 => Samples::U16(values.map(|v| v as u16).collect()),
    };
    Image::new(width, height, channels, samples).expect("the samples fit")
}

fn array(
    width: usize,
    height: usize,
    layers: &[&'static [&'static str]],
    sample_type: SampleType,
) -> TextureArray {
    named(info(), width, height, layers.iter().map(|channels| ("layer", *channels)), sample_type)
}

fn named(
    info: TextureInfo,
    width: usize,
    height: usize,
    layers: impl Iterator<Item = (&'static str, &'static [&'static str])>,
    sample_type: SampleType,
) -> TextureArray {
    let texture = |(name, channels): (_, &'static [&'static str])| {
        let levels = level_sizes(width, height).enumerate();
        let levels = levels.map(|(index, (w, h))| level(w, h, channels.len(), index, sample_type));
        Texture::new(name, channels.to_vec(), levels.collect()).expect("levels that halve")
    };
    TextureArray::new(info, layers.map(texture).collect()).expect("layers of one size")
}

fn written(array: &TextureArray, compression: ExrCompression) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let options = ExrOptions { compression, ..ExrOptions::default() };
    write(array, &options, &mut out).expect("a vector takes everything");
    out.into_inner()
}

fn read_back(bytes: &[u8], layers: &[&'static [&'static str]]) -> Result<TextureArray, ReadError> {
    let spec = |channels: &&'static [&'static str]| LayerSpec { name: "layer", channels };
    read_layers(bytes, &Limits::default(), |_| layers.iter().map(spec).collect())
}

#[test]
fn all_sizes_types_and_layers_read_back_bit_for_bit() {
    for layers in LAYERS {
        for &(width, height) in SIZES {
            for sample_type in FLOATS {
                for compression in [ExrCompression::Zip, ExrCompression::None] {
                    let array = array(width, height, layers, sample_type);
                    let bytes = written(&array, compression);
                    let back = read_back(&bytes, layers).expect("our own file");
                    assert!(back == array, "{width}x{height} {sample_type:?} {compression:?} {layers:?}");
                }
            }
        }
    }
}

#[test]
fn files_of_every_layout_are_self_contained() {
    for &layout in Layout::ALL {
        for &part in layout.parts() {
            let info = TextureInfo { scale: 2.5, ..TextureInfo::new(layout, part) };
            let layers = layers_of(&info).iter().map(|spec| (spec.name, spec.channels));
            let array = named(info, 70, 65, layers, SampleType::F16);
            let back = read_textures(&written(&array, ExrCompression::Zip), &Limits::default());
            assert!(back.expect("our own file") == array, "{layout} {part}");
        }
    }
}

/// Every level and channel of the file as read by the `exr` crate: level, name, width, height, samples.
fn by_the_exr_crate(bytes: &[u8]) -> Vec<(usize, String, usize, usize, Vec<f32>)> {
    use exr::math::RoundingMode;
    use exr::prelude::*;
    let image = read()
        .no_deep_data()
        .all_resolution_levels()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .pedantic()
        .from_buffered(Cursor::new(bytes))
        .expect("the exr crate opens it");
    let layer = &image.layer_data;
    let mut found = Vec::new();
    for channel in &layer.channel_data.list {
        let levels = channel.sample_data.levels_as_slice();
        for (level, samples) in levels.iter().enumerate() {
            let size = exr::meta::compute_level_size(RoundingMode::Down, layer.size.width(), level);
            let height = exr::meta::compute_level_size(RoundingMode::Down, layer.size.height(), level);
            let samples = samples.values_as_f32().collect();
            found.push((level, channel.name.to_string(), size, height, samples));
        }
    }
    found
}

#[test]
fn the_exr_crate_reads_the_same_samples() {
    for layers in LAYERS {
        for &(width, height) in SIZES {
            for compression in [ExrCompression::Zip, ExrCompression::None] {
                for sample_type in FLOATS {
                    compare_with_the_exr_crate(&array(width, height, layers, sample_type), compression);
                }
            }
        }
    }
}

fn compare_with_the_exr_crate(array: &TextureArray, compression: ExrCompression) {
    let found = by_the_exr_crate(&written(array, compression));
    let channels: usize = array.layers().iter().map(|texture| texture.channel_names().len()).sum();
    assert_eq!(found.len(), channels * array.level_count());
    for (level, name, width, height, samples) in found {
        let mut layers = array.layers().iter();
        let place =
            layers.find_map(|t| Some((t, t.channel_names().iter().position(|channel| **channel == *name)?)));
        let (texture, index) = place.expect("a channel of ours");
        let image = &texture.levels()[level];
        assert_eq!((width, height), (image.width(), image.height()), "level {level} of {name}");
        for (texel, sample) in samples.iter().enumerate() {
            let ours = image.get(texel % width, texel / width, index);
            assert_eq!(sample.to_bits(), ours.to_bits(), "texel {texel} of level {level} of {name}");
        }
    }
}

#[test]
fn attributes_describe_the_texels() {
    let wrap = BTreeMap::from([("wrapmodes".to_owned(), "periodic,clamp".to_owned())]);
    let options = ExrOptions { attributes: wrap, ..ExrOptions::default() };
    let mut out = Cursor::new(Vec::new());
    write(&array(5, 3, LAYERS[1], SampleType::F16), &options, &mut out).expect("a vector takes everything");
    let meta =
        exr::meta::MetaData::read_from_buffered(Cursor::new(out.get_ref()), true).expect("a good header");
    let own = &meta.headers[0].own_attributes;
    assert_eq!(own.wrap_mode_name.as_ref().map(|text| text.to_string()).as_deref(), Some("periodic,clamp"));
    let software = own.software_name.as_ref().map(|text| text.to_string());
    assert_eq!(software, Some(format!("roughcast {}", env!("CARGO_PKG_VERSION"))));
    let text = |name: &str| match own.other.get(&exr::meta::attribute::Text::new_or_panic(name)) {
        Some(exr::meta::attribute::AttributeValue::Text(text)) => text.to_string(),
        other => panic!("{name}: {other:?}"),
    };
    assert_eq!(text("textureformat"), "Plain Texture");
    for (key, value) in info().to_pairs() {
        assert_eq!(text(&key), value);
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let array = array(1500, 1100, LAYERS[2], SampleType::F16);
    let with_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| written(&array, ExrCompression::Zip))
    };
    let one = with_threads(1);
    assert!(one == with_threads(2) && one == with_threads(5) && one == written(&array, ExrCompression::Zip));
    assert!(read_back(&one, LAYERS[2]).expect("our own file") == array);
}

#[test]
fn writing_starts_at_the_stream_position_and_ends_after_the_file() {
    use std::io::{Seek, SeekFrom, Write};
    let array = array(53, 37, LAYERS[1], SampleType::F16);
    let mut out = Cursor::new(b"before".to_vec());
    out.seek(SeekFrom::End(0)).expect("a vector");
    write(&array, &ExrOptions::default(), &mut out).expect("a vector takes everything");
    out.write_all(b"after").expect("a vector takes everything");
    let expected = [&b"before"[..], &written(&array, ExrCompression::Zip), b"after"].concat();
    assert!(out.into_inner() == expected);
}

fn refusal(array: &TextureArray, options: &ExrOptions) -> String {
    match write(array, options, &mut Cursor::new(Vec::new())) {
        Err(error @ WriteError::Unsupported { .. }) => error.to_string(),
        other => panic!("expected a refusal, got {other:?}"),
    }
}

#[test]
fn unsupported_textures_are_refused_with_advice() {
    let plain = ExrOptions::default();
    for sample_type in [SampleType::U8, SampleType::U16] {
        let message = refusal(&array(4, 4, LAYERS[0], sample_type), &plain);
        assert!(message.contains("half or single floats"), "{message}");
    }
    let twice = array(4, 4, &[&["a", "b"], &["a"]], SampleType::F16);
    assert!(refusal(&twice, &plain).contains("two channels called 'a'"));
    let whole = array(8, 8, LAYERS[0], SampleType::F16);
    let layer = &whole.layers()[0];
    let cut = Texture::new(layer.name(), layer.channel_names().to_vec(), layer.levels()[..2].to_vec());
    let cut = TextureArray::new(whole.info, vec![cut.expect("levels that halve")]).expect("one layer");
    assert!(refusal(&cut, &plain).contains("2 of the 4 levels of 8x8 texels"));
    let reserved = BTreeMap::from([("tiles".to_owned(), "none".to_owned())]);
    let options = ExrOptions { attributes: reserved, ..ExrOptions::default() };
    assert!(refusal(&array(4, 4, LAYERS[0], SampleType::F16), &options).contains("'tiles'"));
}

#[test]
fn too_many_pixels_are_refused_before_they_are_read() {
    let bytes = written(&array(53, 37, LAYERS[1], SampleType::F16), ExrCompression::Zip);
    let limits = Limits::of_pixels(53 * 37 - 1);
    assert!(matches!(read_textures(&bytes, &limits), Err(ReadError::TooLarge { width: 53, height: 37, .. })));
    assert!(read_textures(&bytes, &Limits::of_pixels(53 * 37)).is_ok());
}

/// Sets each byte of a small file in turn to several other values, and truncates the file at every length.
#[test]
fn corrupt_bytes_do_not_panic() {
    let good = written(&array(70, 3, LAYERS[1], SampleType::F16), ExrCompression::Zip);
    let mut refused = 0;
    for index in 0..good.len() {
        refused += usize::from(read_textures(&good[..index], &Limits::default()).is_err());
        let mut bytes = good.clone();
        for value in [0, 1, 0x7f, 0x80, 0xff, good[index] ^ 1, good[index].wrapping_add(1)] {
            bytes[index] = value;
            // Most must be refused; changed samples cannot be detected. None may panic.
            let _ = read_textures(&bytes, &Limits::default());
        }
    }
    assert_eq!(refused, good.len(), "a file that ends too early was taken for whole");
}

#[test]
fn broken_exr_files_of_others_are_refused() {
    let mut files = roughcast_testdata::files_in("broken");
    files.retain(|file| file.ends_with(".exr"));
    assert!(!files.is_empty(), "there are no broken EXR files");
    for file in files {
        let bytes = std::fs::read(roughcast_testdata::find(&file)).expect("a readable file");
        let result = read_textures(&bytes, &Limits::default());
        assert!(result.is_err(), "{file} was taken for a texture written by roughcast");
    }
}
