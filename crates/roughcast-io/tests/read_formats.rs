//! Every ordinary image of the shared data is read as the manifest describes it, or refused for a reason stated here.

mod shared_data;

use roughcast::SampleType;
use roughcast_io::ValueRange;
use roughcast_testdata::{available, is_extended};
use shared_data::{Entry, manifest, must_read, read};

const FOLDERS: [&str; 9] = [
    "materials",
    "heights",
    "hdri",
    "formats/png",
    "formats/tga",
    "formats/tiff",
    "formats/hdr",
    "formats/exr",
    "formats/tiny",
];

/// Files that are refused, each with part of the reason.
const REFUSED: [(&str, &str); 7] = [
    ("formats/exr/openexr_t12.exr", "outside of the display window, 400x100 at (0, -100)"),
    ("formats/exr/exrs_y_ry_by_dwaa.exr", "luminance with chroma is not supported: save it as RGB"),
    ("formats/exr/openexr_Rec709_YC.exr", "luminance with chroma is not supported: save it as RGB"),
    ("formats/exr/magnum_openexr_depth32ui.exr", "the integer channel Z is not supported"),
    ("formats/exr/magnum_openexr_rg32ui.exr", "the integer channel R is not supported"),
    ("formats/tiff/imgrs_cmyk_u8_edge_case.tif", "CMYK colour is not supported"),
    ("formats/tiff/imgrs_ycbcr_lzw_broken.tif", "YCbCr colour is not supported"),
];

/// Files whose channels do not follow from the manifest: transparency in addition to the colours (`P`, `L` with a tRNS
/// chunk), TGA's attribute bit, which is not alpha, and EXR names, here without the layer and in our order.
const CHANNELS: [(&str, &[&str]); 22] = [
    ("formats/png/go_basn3p08-trns.png", &["R", "G", "B", "A"]),
    ("formats/png/go_ftbbn0g01.png", &["Y", "A"]),
    ("formats/png/go_ftbbn0g04.png", &["Y", "A"]),
    ("formats/png/go_ftbbn3p08.png", &["R", "G", "B", "A"]),
    ("formats/png/go_ftbgn3p08.png", &["R", "G", "B", "A"]),
    ("formats/png/go_ftbwn0g16.png", &["Y", "A"]),
    ("formats/png/go_ftbyn3p08.png", &["R", "G", "B", "A"]),
    ("formats/png/go_ftp1n3p08.png", &["R", "G", "B", "A"]),
    ("formats/png/magnum_png_ga-binary-alpha-trns.png", &["Y", "A"]),
    ("formats/png/magnum_png_rgba-binary-alpha-trns.png", &["R", "G", "B", "A"]),
    ("materials/carpaint_flakes/flakes5c.png", &["R", "G", "B", "A"]),
    ("formats/tga/imgrs_b5-attrib.tga", &["R", "G", "B"]),
    ("formats/tga/imgrs_b5-noattrib.tga", &["R", "G", "B"]),
    ("formats/tga/imgrs_utc16.tga", &["R", "G", "B"]),
    ("formats/exr/exrs_rgb_plus_y_dwaa.exr", &["R", "G", "B"]),
    ("formats/exr/magnum_openexr_depth32f-custom-channels.exr", &["height"]),
    ("formats/exr/magnum_openexr_envmap-cube.exr", &["R", "G"]),
    ("formats/exr/magnum_openexr_levels2D-tile1x1.exr", &["R"]),
    ("formats/exr/magnum_openexr_rgba32f-custom-channels.exr", &["X", "Y", "Z"]),
    ("heights/oiio_bumpslope/bump.exr", &["Y"]),
    ("heights/oiio_bumpslope/bumpslope.exr", &SLOPES),
    ("heights/oiio_bumpslope/bumpslope-central.exr", &SLOPES),
];
const SLOPES: [&str; 6] = ["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"];

/// Files whose size is wrong in the manifest, which counts the planes of a planar image as rows.
const SIZES: [(&str, [usize; 2]); 4] = [
    ("formats/tiff/pillow_tiff_strip_planar_16bit_RGB.tiff", [100, 40]),
    ("formats/tiff/pillow_tiff_strip_planar_16bit_RGBa.tiff", [100, 40]),
    ("formats/tiff/pillow_tiff_tiled_planar_16bit_RGB.tiff", [100, 40]),
    ("formats/tiff/pillow_tiff_tiled_planar_16bit_RGBa.tiff", [100, 40]),
];

/// Number of levels of the files that have more than one.
const LEVELS: [(&str, usize); 7] = [
    ("formats/exr/openexr_ColorCodedLevels.exr", 10),
    ("formats/exr/openexr_PeriodicPattern.exr", 10),
    ("formats/exr/openexr_WavyLinesLatLong.exr", 11),
    ("formats/exr/magnum_openexr_levels2D-tile1x1.exr", 3),
    ("formats/exr/magnum_openexr_rgb16f-ripmap.exr", 2),
    ("heights/oiio_bumpslope/bumpslope.exr", 7),
    ("heights/oiio_bumpslope/bumpslope-central.exr", 7),
];

/// The images in the folders, without block-compressed textures.
fn images() -> Vec<Entry> {
    let mut entries = manifest(&FOLDERS);
    entries.retain(|entry| !entry.path.ends_with(".dds"));
    entries
}

fn lookup<T: Copy>(table: &[(&str, T)], path: &str) -> Option<T> {
    table.iter().find(|(name, _)| *name == path).map(|(_, value)| *value)
}

fn container(path: &str) -> &'static str {
    match path.rsplit('.').next().expect("a file name") {
        "png" => "PNG",
        "jpg" => "JPEG",
        "tga" => "TGA",
        "bmp" => "BMP",
        "webp" => "WebP",
        "tif" | "tiff" => "TIFF",
        "hdr" => "HDR",
        "exr" => "EXR",
        other => panic!("{path}: no expectation for {other}"),
    }
}

fn sample_type(entry: &Entry) -> SampleType {
    match entry.bit_depth.as_str() {
        "1" | "2" | "4" | "8" | "bool" | "uint8" => SampleType::U8,
        "16" | "uint16" => SampleType::U16,
        "float16" => SampleType::F16,
        "float32" | "rgbe8" | "int16" => SampleType::F32,
        other => panic!("{}: no expectation for the bit depth {other}", entry.path),
    }
}

fn channels(entry: &Entry) -> Vec<&'static str> {
    if let Some(channels) = lookup(&CHANNELS, &entry.path) {
        return channels.to_vec();
    }
    // For EXR the type follows the channels: `RGBA:float16x4`.
    match entry.channels.split(':').next().expect("the words of the channels") {
        "L" | "1" | "Y" => vec!["Y"],
        "LA" => vec!["Y", "A"],
        "RGB" | "RGBE" | "P" | "3" => vec!["R", "G", "B"],
        "RGBA" | "4" => vec!["R", "G", "B", "A"],
        other => panic!("{}: no expectation for the channels {other}", entry.path),
    }
}

fn size(entry: &Entry) -> [usize; 2] {
    lookup(&SIZES, &entry.path).unwrap_or_else(|| {
        let (width, height) = entry.resolution.split_once('x').expect("a resolution");
        [width, height].map(|side| side.parse().expect("a number of pixels"))
    })
}

#[test]
fn every_image_is_read_as_described_or_refused_with_its_reason() {
    let entries = images();
    // The data may grow, but a misread manifest must not pass as an empty one.
    assert!(entries.len() >= if is_extended() { 200 } else { 120 }, "only {} images found", entries.len());
    for entry in &entries {
        if let Some(reason) = lookup(&REFUSED, &entry.path) {
            let error = read(&entry.path).expect_err(&entry.path).to_string();
            assert!(error.contains(reason), "{}: '{error}' does not contain '{reason}'", entry.path);
            continue;
        }
        let decoded = must_read(&entry.path);
        let (image, info) = (&decoded.image, &decoded.info);
        let path = &entry.path;
        assert_eq!([image.width(), image.height()], size(entry), "size of {path}");
        assert_eq!(info.channels, channels(entry), "channels of {path}");
        assert_eq!(image.samples().sample_type(), sample_type(entry), "samples of {path}");
        assert_eq!(info.levels, lookup(&LEVELS, path).unwrap_or(1), "levels of {path}");
        assert_eq!(info.container, container(path), "container of {path}");
        assert_eq!([info.width, info.height], size(entry), "stated size of {path}");
        assert_eq!((info.channels.len(), info.layers), (image.channels(), 1), "layout of {path}");
        let is_float = image.samples().sample_type().is_float();
        assert_eq!(
            info.range,
            if is_float { ValueRange::Float } else { ValueRange::Unorm },
            "range of {path}"
        );
        assert!(!info.format.is_empty(), "format of {path}");
    }
}

#[test]
fn every_exception_names_an_existing_file() {
    let entries = images();
    let there = |path: &&str| entries.iter().any(|entry| entry.path == *path);
    let exceptions = REFUSED.iter().map(|e| e.0).chain(CHANNELS.iter().map(|e| e.0));
    let exceptions = exceptions.chain(SIZES.iter().map(|e| e.0)).chain(LEVELS.iter().map(|e| e.0));
    let missing: Vec<&str> = exceptions.filter(|path| !there(path) && available(path).is_some()).collect();
    assert!(missing.is_empty(), "not in the manifest: {missing:?}");
}

#[test]
fn text_beside_the_pixels_is_kept() {
    let exr = must_read("heights/oiio_bumpslope/bumpslope.exr").info;
    assert_eq!(exr.metadata["wrapmodes"], "black,black", "{:?}", exr.metadata);
    let png = must_read("formats/png/magnum_png_ga-binary-alpha-trns.png").info;
    assert!(png.metadata.contains_key("date:create"), "{:?}", png.metadata);
    let hdr = must_read("formats/hdr/imgrs_image1.hdr").info;
    assert_eq!(hdr.metadata["FORMAT"], "32-bit_rle_rgbe");
}
