//! TIFF files from other writers: their pixels, the meaning of their tags, and the files that are refused.
//!
//! `testdata/generated/tiff/make.py` made most of the files, with the checksums of the pixels that tifffile decodes.

use roughcast::{Image, Samples};
use roughcast_io::{
    Decoded, FileInfo, LengthUnit, Limits, PixelSize, ReadError, ReadOptions, ValueRange, read_image,
};
use roughcast_testdata::{files_in, find};

/// Checksums of the pixels of the cases in the test data, as tifffile 2026.3.3 decodes them (with -9999 as NaN).
const CASES: [&str; 7] = [
    "f1a7507a U8 3 cases/tiff-tiled-lzw/rgb8_127x25_tile16.tif",
    "9b7f3bd4 U8 3 cases/tiff-tiles-with-strip-tags/quad-tile.tif",
    "80673c84 U8 2 cases/tiff-two-channels/rg_oiio.tif",
    "4df84fdd U8 3 cases/missing-tiff-compressions/t_webp.tif",
    "1f7329c6 U16 3 cases/missing-tiff-compressions/t_zstd.tif",
    "1c7bad83 F32 1 cases/missing-height-units-nodata/dem_m.tif",
    "b3cbb077 F32 1 cases/missing-height-units-nodata/dem_nodata.tif",
];

/// Files of `testdata/generated/tiff` that are refused, each with part of the reason and of the advice.
const REFUSED: [(&str, [&str; 2]); 4] = [
    ("refused_lerc.tif", ["LERC compression", "LZW, deflate or ZSTD"]),
    ("refused_lzma.tif", ["LZMA compression", "LZW, deflate or ZSTD"]),
    ("refused_jpeg.tif", ["JPEG compression", "LZW, deflate or ZSTD"]),
    ("refused_complex.tif", ["samples of complex numbers", "of floats"]),
];

/// Width in pixels of the files that `make.py` made.
const WIDTH: usize = 37;

fn bytes_of(name: &str) -> Vec<u8> {
    std::fs::read(find(&format!("generated/tiff/{name}"))).expect("a readable file")
}

fn read(name: &str, options: &ReadOptions) -> Result<Decoded, ReadError> {
    read_image(&bytes_of(name), None, options)
}

fn must_read(name: &str) -> Decoded {
    read(name, &ReadOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn info(name: &str) -> FileInfo {
    must_read(name).info
}

/// `checksum type channels`, as in `checksums.txt`.
fn checksum(image: &Image) -> String {
    const NAN: u32 = 0x7fc0_0000;
    let (bytes, name): (Vec<u8>, _) = match image.samples() {
        Samples::U8(v) => (v.clone(), "U8"),
        Samples::U16(v) => (v.iter().flat_map(|v| v.to_le_bytes()).collect(), "U16"),
        Samples::F16(v) => (v.iter().flat_map(|v| v.to_le_bytes()).collect(), "F16"),
        Samples::F32(v) => {
            let bits = |v: &f32| if v.is_nan() { NAN } else { v.to_bits() };
            (v.iter().flat_map(|v| bits(v).to_le_bytes()).collect(), "F32")
        }
    };
    format!("{:08x} {name} {}", libdeflater::crc32(&bytes), image.channels())
}

#[test]
fn pixels_match_tifffile() {
    let checksums = std::fs::read_to_string(find("generated/tiff/checksums.txt")).expect("text");
    let lines = checksums.lines().filter(|line| !line.starts_with('#'));
    let expected: Vec<(String, String)> =
        (lines.map(|line| (line, "generated/tiff/")).chain(CASES.map(|line| (line, ""))))
            .map(|(line, folder)| {
                let (checksum, name) = line.rsplit_once(' ').expect("four columns");
                (checksum.to_owned(), format!("{folder}{name}"))
            })
            .collect();
    assert!(expected.len() >= 50, "only {} files", expected.len());
    let mut wrong = Vec::new();
    for (expected, path) in expected {
        let bytes = std::fs::read(find(&path)).expect("a readable file");
        match read_image(&bytes, None, &ReadOptions::default()) {
            Ok(decoded) if checksum(&decoded.image) == expected => {}
            Ok(decoded) => wrong.push(format!("{path}: {}, not {expected}", checksum(&decoded.image))),
            Err(error) => wrong.push(format!("{path}: {error}")),
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_file_is_read_or_refused_with_advice() {
    for path in files_in("generated/tiff").iter().filter(|path| path.ends_with(".tif")) {
        let name = path.strip_prefix("generated/tiff/").expect("a file of the folder");
        let refusal = REFUSED.iter().find(|(refused, _)| *refused == name).map(|(_, words)| words);
        match (read(name, &ReadOptions::default()), refusal) {
            (Ok(_), None) => {}
            (Err(ReadError::OpenChannels { .. }), None) if name == "grey_of_6_samples.tif" => {}
            (Err(ReadError::Unsupported { what, remedy, .. }), Some([reason, advice])) => {
                assert!(what.contains(reason) && remedy.contains(advice), "{name}: {what}: {remedy}");
                assert!(!what.contains("support"), "{name}: {what}");
            }
            (result, _) => panic!("{name}: {:?}", result.map(|decoded| decoded.info)),
        }
    }
}

/// OpenImageIO gives the same names, except to the fourth channel of unstated meaning, which it calls `channel3`.
#[test]
fn only_a_sample_that_is_said_to_be_alpha_makes_grey_and_alpha() {
    for (name, channels) in [
        ("two_channels_unspecified.tif", &["R", "G"][..]),
        ("grey_alpha.tif", &["Y", "A"]),
        ("rgb_unspecified.tif", &["R", "G", "B", "A"]),
        ("webp_lossless_tiles_rgba8.tif", &["R", "G", "B", "A"]),
        ("rgb_of_6_samples.tif", &["R", "G", "B"]),
    ] {
        assert_eq!(info(name).channels, channels, "{name}");
    }
    let warnings = info("rgb_of_6_samples.tif").warnings;
    assert_eq!(warnings, ["of its 6 samples per pixel, channel3 to channel5 are not read"]);
    assert_eq!(info("rgb_unspecified.tif").warnings, [""; 0]);
}

#[test]
fn channels_are_chosen_by_name() {
    let whole =
        picture_of_samples("grey_of_6_samples.tif", &["R", "G", "B", "channel3", "channel4", "channel5"]);
    let chosen = picture_of_samples("grey_of_6_samples.tif", &["CHANNEL4", "g"]);
    assert_eq!(chosen.channels(), 2);
    for y in 0..whole.height() {
        for x in 0..whole.width() {
            assert_eq!([chosen.get(x, y, 0), chosen.get(x, y, 1)], [whole.get(x, y, 4), whole.get(x, y, 1)]);
        }
    }
    // Alpha and the colours of a palette can also be chosen by name.
    for (name, wanted, called) in [("grey_alpha.tif", "a", "alpha"), ("palette_8bit.tif", "g", "G")] {
        let options = ReadOptions::default().with_channels(vec![wanted.to_owned()]);
        let Decoded { image, info } = read(name, &options).expect("a known channel");
        assert_eq!((image.channels(), info.channels), (1, vec![called.to_owned()]));
        let whole = must_read(name).image;
        assert!((0..WIDTH).all(|x| image.get(x, 0, 0) == whole.get(x, 0, 1)), "{name}");
    }
    let options = ReadOptions::default().with_channels(vec!["Z".to_owned()]);
    let error = read("grey_of_6_samples.tif", &options).unwrap_err();
    let ReadError::NoSuchChannel { wanted, contents, .. } = error else { panic!("{error}") };
    assert_eq!((wanted.as_str(), contents.as_str()), ("Z", "R, G, B, channel3, channel4, channel5"));
    let error = read("grey_of_6_samples.tif", &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, ReadError::OpenChannels { .. }), "{error}");
}

fn picture_of_samples(name: &str, channels: &[&str]) -> Image {
    let channels = channels.iter().map(|&name| name.to_owned()).collect();
    read(name, &ReadOptions::default().with_channels(channels)).expect("known channels").image
}

#[test]
fn another_image_of_the_file_is_chosen_by_its_number() {
    assert_eq!(
        info("two_images.tif").warnings,
        ["it has 2 images, of which the first is read; others are chosen by their number"]
    );
    let nth = |layer: &str| {
        let options = ReadOptions::default().with_layer(Some(layer.to_owned()));
        read("two_images.tif", &options)
    };
    let (first, second) = (nth("1").expect("an image").image, nth("2").expect("an image").image);
    // The second image is the negative of the first.
    assert!((0..first.samples().len()).all(|i| first.samples().get(i) + second.samples().get(i) == 1.0));
    for layer in ["0", "3", "diffuse"] {
        let error = nth(layer).unwrap_err();
        let ReadError::NoSuchChannel { wanted, contents, .. } = error else { panic!("{error}") };
        assert_eq!((wanted.as_str(), contents.as_str()), (layer, "1 to 2"));
    }
}

#[test]
fn texels_without_data_are_nan_and_counted() {
    for (name, count, by) in [
        ("nodata_float.tif", 15, "the value -3.4028235e+38"),
        ("nodata_nan.tif", 15, "the value nan"),
        ("nodata_int16_projected.tif", 10, "the value -32768"),
        ("heights_geographic.tif", 10, "the value -32768"),
        ("nodata_uint16.tif", 5, "the value 0"),
        ("nodata_rgb8.tif", 7, "the value 0"),
        ("sparse_tiles_nodata.tif", 16 * 29, "the value 77"),
        ("mask_uint16.tif", 4 * 17, "by its mask"),
    ] {
        let Decoded { image, info } = must_read(name);
        let nan = (0..image.samples().len()).filter(|&i| image.samples().get(i).is_nan()).count();
        assert_eq!(nan, count * image.channels(), "{name}");
        let warning =
            format!("{count} texels have no data ({by}): they and their neighbours are taken as flat");
        assert!(info.warnings.contains(&warning), "{name}: {:?}", info.warnings);
    }
    assert_eq!(info("nodata_elsewhere_uint8.tif").warnings, [""; 0]);
}

#[test]
fn numbers_are_fractions_of_full_scale_or_heights_in_a_unit() {
    for (name, range) in [
        ("grey_12bit.tif", ValueRange::Unorm),
        ("uint32_rgb.tif", ValueRange::Unorm),
        ("uint32_full_range.tif", ValueRange::Unorm),
        ("uint24_full_range.tif", ValueRange::Unorm),
        ("uint32_heights_predictor.tif", ValueRange::Float),
        ("int8_heights.tif", ValueRange::Float),
        ("int16_heights_be.tif", ValueRange::Float),
        ("int32_heights.tif", ValueRange::Float),
        ("int16_rgb.tif", ValueRange::Snorm),
        ("zip_predictor_half_grey.tif", ValueRange::Float),
        ("nodata_uint16.tif", ValueRange::Unorm),
    ] {
        assert_eq!(info(name).range, range, "{name}");
    }
    assert_eq!(info("int16_rgb.tif").warnings, ["its signed integers are read as -1 to 1"]);
}

#[test]
fn the_inversion_that_programs_disagree_on_gets_a_warning() {
    assert_eq!(info("minis_white_8bit.tif").warnings, [""; 0]);
    let warnings = info("minis_white_16bit.tif").warnings;
    assert_eq!(warnings, ["its 0 is white (photometric interpretation 0), so its values are inverted"]);
}

#[test]
fn the_size_of_a_pixel_on_the_ground_is_reported() {
    let metres = PixelSize { width: 30.0, unit: LengthUnit::Metre };
    assert_eq!(info("nodata_int16_projected.tif").pixel_size, Some(metres));
    let degrees = PixelSize { width: 1.0 / 3600.0, unit: LengthUnit::Degree };
    assert_eq!(info("heights_geographic.tif").pixel_size, Some(degrees));
    assert_eq!(info("nodata_float.tif").pixel_size, None);
}

/// Percentages of a file to keep. The last bytes of some files belong to tags that are not read.
const CUTS: [usize; 5] = [1, 10, 40, 70, 90];

#[test]
fn a_file_that_was_cut_is_an_error() {
    for path in files_in("generated/tiff").iter().filter(|path| path.ends_with(".tif")) {
        // The second image of these files is not needed, nor are the tags at the end of others.
        if path.contains("two_images") || path.contains("mask_") {
            continue;
        }
        let bytes = std::fs::read(find(path)).expect("a readable file");
        for percent in CUTS {
            let cut = &bytes[..bytes.len() * percent / 100];
            assert!(read_image(cut, None, &ReadOptions::default()).is_err(), "{path} cut to {percent} %");
        }
    }
}

/// A TIFF with one directory, at the end; each entry is a tag, its type and its value.
fn tiff(data: &[u8], entries: &[(u16, u16, u32)]) -> Vec<u8> {
    let mut file = b"II*\0".to_vec();
    file.extend((8 + data.len() as u32).to_le_bytes());
    file.extend(data);
    file.extend((entries.len() as u16).to_le_bytes());
    for &(tag, field_type, value) in entries {
        file.extend(tag.to_le_bytes());
        file.extend(field_type.to_le_bytes());
        file.extend(1u32.to_le_bytes());
        file.extend(value.to_le_bytes());
    }
    file.extend([0; 4]);
    file
}

const SHORT: u16 = 3;
const LONG: u16 = 4;

/// An 8-bit grey TIFF of 4x2 pixels in one strip, with other values for some tags.
fn small(others: &[(u16, u16, u32)]) -> Vec<u8> {
    let mut entries = vec![
        (256, SHORT, 4),
        (257, SHORT, 2),
        (258, SHORT, 8),
        (259, SHORT, 1),
        (262, SHORT, 1),
        (273, LONG, 8),
        (277, SHORT, 1),
        (278, LONG, u32::MAX),
        (279, LONG, 8),
    ];
    for &other in others {
        entries.retain(|(tag, ..)| *tag != other.0);
        entries.push(other);
    }
    tiff(&[1, 2, 3, 4, 5, 6, 7, 8], &entries)
}

fn error_of(bytes: &[u8]) -> String {
    read_image(bytes, None, &Limits::of_pixels(1 << 20).into()).expect_err("broken").to_string()
}

#[test]
fn the_small_file_that_the_next_tests_break_is_whole() {
    let decoded = read_image(&small(&[]), None, &ReadOptions::default()).expect("a whole file");
    assert_eq!(decoded.image.samples(), &Samples::U8(vec![1, 2, 3, 4, 5, 6, 7, 8]));
}

#[test]
fn sizes_are_checked_before_memory_is_taken() {
    const TILE_WIDTH: u16 = 322;
    const TILE_LENGTH: u16 = 323;
    let is_limit = |error: &str| error.contains("are more than the limit");
    assert!(is_limit(&error_of(&small(&[(256, LONG, u32::MAX), (257, LONG, u32::MAX)]))));
    let error = error_of(&small(&[(TILE_WIDTH, LONG, u32::MAX), (TILE_LENGTH, LONG, u32::MAX)]));
    assert!(is_limit(&error), "{error}");
    // Samples that are decoded but not read also count.
    let error = error_of(&small(&[(256, LONG, 1 << 19), (262, SHORT, 2), (277, SHORT, 1024)]));
    assert!(is_limit(&error), "{error}");
}

#[test]
fn broken_tags_are_named() {
    const TILE_WIDTH: u16 = 322;
    for (others, words) in [
        (&[(257, SHORT, 0)][..], "4x0 pixels"),
        (&[(257, SHORT, 3)], "ends too early"),
        (&[(258, SHORT, 0)], "samples of 0 bits"),
        (&[(258, SHORT, 64)], "unsigned integers of 64 bits is not supported"),
        (&[(277, SHORT, 0)], "0 samples per pixel"),
        (&[(278, LONG, 1)], "it has 1 strips or tiles, and its size needs 2"),
        (&[(278, LONG, 0)], "have no pixels"),
        (&[(TILE_WIDTH, LONG, 0)], "have no pixels"),
        (&[(273, LONG, u32::MAX)], "ends too early"),
        (&[(279, LONG, 7)], "ends too early"),
        (&[(284, SHORT, 3)], "planar configuration 3"),
        (&[(339, SHORT, 9)], "sample format 9"),
        (&[(259, SHORT, 5)], "its LZW data is damaged"),
        (&[(259, SHORT, 8)], "its deflate data is damaged"),
        (&[(259, SHORT, 50000)], "its ZSTD data is damaged"),
        (&[(259, SHORT, 50001)], "WebP compression is for RGB"),
        (&[(259, SHORT, 4)], "CCITT compression is for one bit"),
        (&[(259, SHORT, 12345)], "compression 12345 is not supported"),
        (&[(259, SHORT, 8), (317, SHORT, 3)], "this predictor for samples of 8 bits is not supported"),
        (&[(262, SHORT, 3)], "it has no palette of 256 colours"),
        (&[(262, SHORT, 77)], "the photometric interpretation 77 is not supported"),
    ] {
        let error = error_of(&small(others));
        assert!(error.contains(words), "{others:?}: '{error}' does not contain '{words}'");
    }
}

/// libtiff does not apply a predictor to such files either; tifffile does.
#[test]
fn a_predictor_of_an_uncompressed_file_is_ignored_with_a_warning() {
    let decoded = read_image(&small(&[(317, SHORT, 2)]), None, &ReadOptions::default()).expect("whole");
    assert_eq!(decoded.image.samples(), &Samples::U8(vec![1, 2, 3, 4, 5, 6, 7, 8]));
    assert_eq!(decoded.info.warnings, ["its predictor tag is ignored, since its compression uses none"]);
}
