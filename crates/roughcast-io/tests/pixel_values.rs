//! Compares pixels with other decoders and with facts that the files themselves determine.

mod shared_data;

use half::f16;
use roughcast::{Image, Samples};
use roughcast_testdata::{available, find, is_extended, rows_with_files};
use shared_data::{manifest, must_read};

/// CRC-32 of all samples of an image, little-endian, row by row: one line per file, `checksum path`.
/// The header of this list names the decoders that gave the checksums.
const CHECKSUMS: &str = include_str!("pixel_checksums.txt");

fn little_endian_bytes(image: &Image) -> Vec<u8> {
    match image.samples() {
        Samples::U8(samples) => samples.clone(),
        Samples::U16(samples) => samples.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Samples::F16(samples) => samples.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Samples::F32(samples) => samples.iter().flat_map(|v| v.to_le_bytes()).collect(),
    }
}

fn floats(image: &Image) -> Vec<f32> {
    (0..image.samples().len()).map(|i| image.samples().get(i)).collect()
}

fn largest_difference(a: &Image, b: &Image) -> f32 {
    assert_eq!((a.width(), a.height(), a.channels()), (b.width(), b.height(), b.channels()));
    floats(a).iter().zip(floats(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn pixels_match_other_decoders() {
    let lines: Vec<&str> = CHECKSUMS.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(lines.len() >= 100, "only {} checksums", lines.len());
    let rows = lines.into_iter().map(|line| line.split_once(' ').expect("a checksum and a path"));
    let mut wrong = Vec::new();
    for (expected, path) in rows_with_files(rows, |row| row.1) {
        let got = format!("{:08x}", libdeflater::crc32(&little_endian_bytes(&must_read(path).image)));
        if got != expected {
            wrong.push(format!("{path}: {got}, not {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_checksum_sees_a_single_changed_sample() {
    let image = must_read("formats/png/magnum_png_gray16.png").image;
    let mut bytes = little_endian_bytes(&image);
    let before = libdeflater::crc32(&bytes);
    bytes[3] ^= 1;
    assert_ne!(before, libdeflater::crc32(&bytes));
}

#[test]
fn the_same_picture_is_the_same_in_every_file_of_it() {
    let same = [
        ["formats/tga/pillow_1x1_l_tl_raw.tga", "formats/tga/pillow_1x1_l_bl_raw.tga"],
        ["formats/tga/pillow_200x32_l_tl_raw.tga", "formats/tga/pillow_200x32_l_bl_raw.tga"],
        ["formats/tga/pillow_200x32_la_tl_raw.tga", "formats/tga/pillow_200x32_la_bl_raw.tga"],
        ["formats/tga/pillow_200x32_rgb_tl_raw.tga", "formats/tga/pillow_200x32_rgb_bl_raw.tga"],
        ["formats/tga/pillow_200x32_rgba_tl_raw.tga", "formats/tga/pillow_200x32_rgba_bl_raw.tga"],
        ["formats/tga/pillow_200x32_p_tl_raw.tga", "formats/tga/pillow_200x32_p_bl_raw.tga"],
        ["formats/tga/pillow_200x32_p_tl_raw.tga", "formats/tga/pillow_200x32_p_bl_raw_origin.tga"],
        ["formats/tga/imgrs_cbw8.tga", "formats/tga/imgrs_ubw8.tga"],
        ["formats/tiff/pillow_16bit.deflate.tif", "formats/tiff/pillow_16bit.MM.deflate.tif"],
        ["formats/tiff/pillow_hopper.tif", "formats/tiff/pillow_hopper.iccprofile.tif"],
        ["formats/exr/exrs_f16_pxr24.exr", "formats/exr/exrs_f16_decompressed_pxr24.exr"],
        ["formats/exr/exrs_f32_pxr24.exr", "formats/exr/exrs_f32_decompressed_pxr24.exr"],
        ["formats/exr/exrs_f16_b44.exr", "formats/exr/exrs_f16_decompressed_b44.exr"],
        ["formats/exr/exrs_f32_zips.exr", "formats/exr/exrs_f32_uncompressed.exr"],
        ["formats/exr/exrs_u16_f16_zips.exr", "formats/exr/exrs_u16_f16_uncompressed.exr"],
        ["formats/exr/exrs_u16_f32_piz.exr", "formats/exr/exrs_u16_f32_rle.exr"],
    ];
    for [a, b] in same.into_iter().filter(|pair| pair.iter().all(|path| available(path).is_some())) {
        assert!(must_read(a).image == must_read(b).image, "{a} and {b} differ");
    }
}

#[test]
fn a_transparent_grey_of_four_bits_is_compared_at_its_own_scale() {
    // The file's transparent value is 15 of 15, which is 255 of 255 once widened.
    let image = must_read("formats/png/go_ftbbn0g04.png").image;
    let Samples::U8(samples) = image.samples() else { panic!("not 8 bits") };
    let transparent = samples.chunks_exact(2).filter(|pixel| pixel[0] == 255).count();
    assert!(transparent > 0);
    assert!(samples.chunks_exact(2).all(|pixel| (pixel[1] == 0) == (pixel[0] == 255)));
}

#[test]
fn a_half_float_normal_map_is_its_16_bit_source_rounded() {
    // Both files are too large for the small set.
    let Some(_) = available("materials/surfgrad_ocean16/normals.png") else { return };
    let source = must_read("materials/surfgrad_ocean16/normals.png").image;
    let half = must_read("materials/surfgrad_ocean16/normals_half_derived.exr").image;
    let rounded: Vec<f16> = floats(&source).into_iter().map(f16::from_f32).collect();
    assert!(*half.samples() == Samples::F16(rounded));
}

#[test]
fn every_half_float_is_kept() {
    let image = must_read("formats/exr/openexr_AllHalfValues.exr").image;
    let Samples::F16(samples) = image.samples() else { panic!("not halves") };
    let mut seen = vec![false; 1 << 16];
    samples.iter().for_each(|half| seen[usize::from(half.to_bits())] = true);
    // OpenEXR's example contains each bit pattern once, spread over its three channels.
    assert!(
        seen.iter().all(|&seen| seen),
        "{} bit patterns are missing",
        seen.iter().filter(|s| !**s).count()
    );
}

fn distinct_values(image: &Image, channel: usize) -> usize {
    let mut bits: Vec<u32> =
        floats(image).iter().skip(channel).step_by(image.channels()).map(|v| v.to_bits()).collect();
    bits.sort_unstable();
    bits.dedup();
    bits.len()
}

#[test]
fn heights_keep_all_their_levels() {
    // The counts are those in the manifest. Both files are too large for the small set.
    let Some(_) = available("heights/surfgrad_Dump_u16.tif") else { return };
    assert_eq!(distinct_values(&must_read("heights/surfgrad_Dump_u16.tif").image, 0), 32759);
    let heights = must_read("heights/bgfx_heightmap_f32.exr").image;
    assert_eq!(distinct_values(&heights, 0), 14682);
    let equal = floats(&heights).chunks_exact(4).all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]);
    assert!(equal, "red, green and blue hold the same height");
}

#[test]
fn hdr_maxima_match_the_manifest() {
    let entries = manifest(&["formats/hdr", "formats/tiny", "hdri"]);
    let mut checked = 0;
    for entry in entries.iter().filter(|entry| entry.path.ends_with(".hdr")) {
        let stated = entry.details.rsplit_once("max=").expect("a maximum").1;
        let max = floats(&must_read(&entry.path).image).into_iter().fold(0.0, f32::max);
        let stated: f32 = stated.parse().expect("a number");
        // The manifest rounds to three digits.
        assert!((max - stated).abs() <= 0.005 * stated, "{}: {max}, not {stated}", entry.path);
        checked += 1;
    }
    assert!(checked >= if is_extended() { 5 } else { 2 }, "only {checked} HDR files");
}

#[test]
fn lossy_and_lossless_files_of_one_picture_agree() {
    // libjpeg's decoder differs from the source by 2 of 255 here; decoders may differ by one step from each other.
    const JPEG_DIFFERENCE: f32 = 3.5 / 255.0;
    let bmp = must_read("formats/tiny/astc_ldr.bmp").image;
    let jpeg = must_read("formats/tiny/astc_ldr.jpg").image;
    assert!(largest_difference(&bmp, &jpeg) <= JPEG_DIFFERENCE);
}

#[test]
fn content_wins_over_the_name() {
    let bytes = std::fs::read(find("formats/png/go_basn2c08.png")).unwrap();
    let named_jpg =
        roughcast_io::read_image(&bytes, Some("jpg"), &roughcast_io::ReadOptions::default()).unwrap();
    assert_eq!(named_jpg.info.container, "PNG");
}
