//! Normal maps in the formats of older tools: Direct3D 9's bump formats, A8L8, RXGB and ATI2 in DDS, and Basis
//! Universal in KTX2.
//!
//! The small files contain the surface of `plain.png`. The reference is another program's result for the same file or
//! the same picture.

use roughcast::{Image, Kind, NormalChannels};
use roughcast_io::{Decoded, FileInfo, NormalEncoding, ReadOptions, read_image, read_image_file};
use roughcast_testdata::find;

fn read(path: &str) -> Decoded {
    let decoded = read_image_file(&find(path), &ReadOptions::default());
    decoded.unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn plain() -> Image {
    read("cases/png-grey-rgb-x-in-alpha/plain.png").image
}

/// Largest and mean difference between one channel of each image.
fn difference(
    a: impl Fn(usize, usize) -> f32,
    b: impl Fn(usize, usize) -> f32,
    size: (usize, usize),
) -> (f32, f32) {
    let pixels = (0..size.0 * size.1).map(|i| (i % size.0, i / size.0));
    let differences: Vec<f32> = pixels.map(|(x, y)| (a(x, y) - b(x, y)).abs()).collect();
    let largest = differences.iter().copied().fold(0.0, f32::max);
    (largest, differences.iter().sum::<f32>() / differences.len() as f32)
}

fn stated(info: &FileInfo) -> (Option<Kind>, NormalEncoding) {
    (info.kind, info.normal_encoding)
}

/// Tolerance for the rounding of f32.
const EXACT: f32 = 1e-6;

#[test]
fn luminance_and_alpha_with_the_flag_of_colours_are_two_channels() {
    let file = read("cases/dds-a8l8-rgb-flag/a8l8_rgb_flag.dds");
    assert_eq!(file.info.channels, ["R", "G"]);
    for channel in [0, 1] {
        let (a, b) = (&file.image, plain());
        assert_eq!(difference(|x, y| a.get(x, y, channel), |x, y| b.get(x, y, channel), (64, 48)).0, 0.0);
    }
}

#[test]
fn signed_fields_are_the_components_of_the_surface() {
    // The tolerance is half a step of the field plus half an 8-bit step of plain.png.
    for (name, steps) in [("d_l6v5u5", 15.0), ("d_cxv8u8_117", 127.0)] {
        let file = read(&format!("cases/missing-dds-legacy-normal-formats/{name}.dds"));
        assert_eq!(
            (file.info.kind, &file.info.channels[..]),
            (Some(Kind::Normal), &["R".to_owned(), "G".to_owned()][..])
        );
        for channel in [0, 1] {
            let (a, b) = (&file.image, plain());
            let (largest, _) =
                difference(|x, y| a.get(x, y, channel), |x, y| 2.0 * b.get(x, y, channel) - 1.0, (64, 48));
            assert!(largest <= 0.5 / steps + 1.0 / 255.0 + EXACT, "{name}, channel {channel}: {largest}");
        }
    }
}

/// A DDS file of one row, from its texels and the flags, FourCC, bits and masks of its pixel format.
fn dds(flags: u32, code: u32, bits: u32, masks: [u32; 4], texels: &[u32]) -> Vec<u8> {
    let mut words = vec![u32::from_le_bytes(*b"DDS "), 124, 0x1007, 1, texels.len() as u32, 0, 0, 0];
    words.extend([0; 11]);
    words.extend([32, flags, code, bits]);
    words.extend(masks);
    words.extend([0x1000, 0, 0, 0, 0]);
    let mut bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
    texels.iter().for_each(|texel| bytes.extend(&texel.to_le_bytes()[..bits as usize / 8]));
    bytes
}

/// The stored form of a signed number of this many bits.
fn field(value: f64, bits: u32) -> u32 {
    let full = f64::from((1_u32 << (bits - 1)) - 1);
    (value * full).round() as i32 as u32 & ((1 << bits) - 1)
}

#[test]
fn bump_formats_are_read_by_masks_and_by_number() {
    const BUMP_DUDV: u32 = 0x8_0000;
    const BUMP_LUMINANCE: u32 = 0x4_0000;
    const FOUR_CC: u32 = 0x4;
    let components = [[0.0, 0.0], [1.0, -1.0], [-0.5, 0.25]];
    let texels =
        |bits: u32, above: u32| components.map(|[u, v]| field(u, bits) | field(v, bits) << bits | above);
    let cases = [
        ("V8U8", dds(FOUR_CC, 60, 16, [0; 4], &texels(8, 0)), 127.0),
        ("L6V5U5", dds(BUMP_LUMINANCE, 0, 16, [0x1f, 0x3e0, 0xfc00, 0], &texels(5, 0xfc00)), 15.0),
        ("L6V5U5", dds(FOUR_CC, 61, 16, [0; 4], &texels(5, 0x400)), 15.0),
        ("X8L8V8U8", dds(BUMP_LUMINANCE, 0, 32, [0xff, 0xff00, 0xff_0000, 0], &texels(8, 0x7f_0000)), 127.0),
        ("X8L8V8U8", dds(FOUR_CC, 62, 32, [0; 4], &texels(8, 0)), 127.0),
        ("V16U16", dds(FOUR_CC, 64, 32, [0; 4], &texels(16, 0)), 32767.0),
        (
            "A2W10V10U10",
            dds(BUMP_DUDV, 0, 32, [0x3ff, 0xf_fc00, 0x3ff0_0000, 0xc000_0000], &texels(10, 0x1ff0_0000)),
            511.0,
        ),
        ("A2W10V10U10", dds(FOUR_CC, 67, 32, [0; 4], &texels(10, 0x1ff0_0000)), 511.0),
        ("CxV8U8", dds(FOUR_CC, 117, 16, [0; 4], &texels(8, 0)), 127.0),
        ("Q8W8V8U8", dds(FOUR_CC, 63, 32, [0; 4], &texels(8, 0x7f_0000)), 127.0),
    ];
    for (name, file, full) in cases {
        let decoded = read_image(&file, None, &ReadOptions::default())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(
            decoded.info.format.starts_with(name) && decoded.info.kind == Some(Kind::Normal),
            "{:?}",
            decoded.info
        );
        for (x, uv) in components.into_iter().enumerate() {
            for (channel, value) in uv.into_iter().enumerate() {
                let expected = ((value * full).round() / full) as f32;
                assert!(
                    (decoded.image.get(x, 0, channel) - expected).abs() < EXACT,
                    "{name}: texel {x}, channel {channel}"
                );
            }
        }
        if name == "A2W10V10U10" {
            assert_eq!((decoded.image.channels(), decoded.image.get(0, 0, 2)), (3, 1.0), "w is z");
        }
    }
}

#[test]
fn reversed_masks_of_a2w10v10u10_are_read_as_the_pixels_say() {
    const BUMP_DUDV: u32 = 0x8_0000;
    let masks = [0x3ff0_0000, 0xf_fc00, 0x3ff, 0xc000_0000];
    let normals = [[0.5, -0.25, 0.829], [-0.6, 0.0, 0.8], [0.0, 0.0, 1.0]];
    // First u is in the lowest bits, as Direct3D defines the format, then in the highest, as these masks say.
    for shifts in [[0, 10, 20], [20, 10, 0]] {
        let texel = |normal: [f64; 3]| {
            normal.into_iter().zip(shifts).fold(0, |word, (value, shift)| word | field(value, 10) << shift)
        };
        let file = dds(BUMP_DUDV, 0, 32, masks, &normals.map(texel));
        let decoded = read_image(&file, None, &ReadOptions::default()).expect("a valid file");
        for (x, normal) in normals.into_iter().enumerate() {
            for (channel, value) in normal.into_iter().enumerate() {
                let expected = ((value * 511.0).round() / 511.0) as f32;
                let read = decoded.image.get(x, 0, channel);
                assert!((read - expected).abs() < EXACT, "{shifts:?}: texel {x}, channel {channel}: {read}");
            }
        }
    }
}

/// Allowed mean error of BC3. Its colours have four values of 5 or 6 bits per block, which costs 0.021 on this small
/// map. A wrong channel costs 0.1.
const BC3_MEAN: f32 = 0.03;

#[test]
fn the_components_of_rxgb_are_back_in_their_places() {
    let file = read("cases/missing-dds-legacy-normal-formats/d_rxgb.dds");
    assert_eq!(stated(&file.info), (Some(Kind::Normal), NormalEncoding::Stated(NormalChannels::Xy)));
    for channel in [0, 1] {
        let (a, b) = (&file.image, plain());
        let (_, mean) = difference(|x, y| a.get(x, y, channel), |x, y| b.get(x, y, channel), (64, 48));
        assert!(mean < BC3_MEAN, "channel {channel}: {mean}");
    }
    // NVIDIA's tools compressed the same picture, and texconv compressed it as BC5, which OpenImageIO decoded for the
    // reference.
    let nvidia = read("cases/missing-dds-legacy-normal-formats/nvtt_BC3n_AGBR.dds");
    let reference = read("cases/dds-ati2-x-first/texconv_DX9_BC5_UNORM.reference.png").image;
    for channel in [0, 1] {
        let a = &nvidia.image;
        let (_, mean) =
            difference(|x, y| a.get(x, y, channel), |x, y| reference.get(x, y, channel), (129, 66));
        assert!(mean < BC3_MEAN, "channel {channel}: {mean}");
    }
}

/// Tolerance for OpenImageIO, which rounds the interpolated values to 8 bits.
const ROUNDED: f32 = 0.5 / 255.0 + EXACT;

#[test]
fn the_channels_of_ati2_come_as_they_are_stored() {
    let texconv = read("cases/dds-ati2-x-first/texconv_DX9_BC5_UNORM.dds");
    let reference = read("cases/dds-ati2-x-first/texconv_DX9_BC5_UNORM.reference.png").image;
    assert_eq!(stated(&texconv.info), (Some(Kind::Normal), NormalEncoding::EitherOrder));
    for channel in [0, 1] {
        let a = &texconv.image;
        let (largest, _) =
            difference(|x, y| a.get(x, y, channel), |x, y| reference.get(x, y, channel), (129, 66));
        assert!(largest <= 2.0 * ROUNDED, "channel {channel}: {largest}");
    }
    let (rock, plain) =
        (read("cases/dds-ati2-x-first/rock_ati2_plain.dds"), read("cases/dds-ati2-x-first/rock_bc5u.dds"));
    assert_eq!(rock.image, plain.image);
    assert_eq!(stated(&plain.info), (None, NormalEncoding::Unstated));
}

#[test]
fn a_mark_after_ati2_puts_x_first() {
    let mut bytes = std::fs::read(find("cases/dds-ati2-x-first/rock_ati2_plain.dds")).unwrap();
    bytes[88..92].copy_from_slice(b"A2XY");
    let marked = read_image(&bytes, None, &ReadOptions::default()).unwrap();
    assert_eq!(marked.info.normal_encoding, NormalEncoding::Stated(NormalChannels::Xy));
    bytes[84..88].copy_from_slice(b"A2XY");
    bytes[88..92].fill(0);
    let named = read_image(&bytes, None, &ReadOptions::default()).unwrap();
    assert_eq!((named.info.normal_encoding, named.image), (marked.info.normal_encoding, marked.image));
}

#[test]
fn moved_channels_of_dxt5_are_back_in_their_places() {
    // One block: alpha 200 throughout, colours 5-6-5 of (31, 0, 0), which is (255, 0, 0).
    let block = [200, 200, 0, 0, 0, 0, 0, 0, 0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0];
    let file = |code: &[u8; 4]| {
        let mut bytes = dds(0x4, u32::from_le_bytes(*code), 0, [0; 4], &[0; 4]);
        bytes[12..16].copy_from_slice(&4_u32.to_le_bytes());
        bytes.truncate(128);
        bytes.extend(block);
        read_image(&bytes, None, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
    };
    let texel = |decoded: &Decoded| -> Vec<u8> {
        (0..decoded.image.channels()).map(|c| (decoded.image.get(1, 1, c) * 255.0).round() as u8).collect()
    };
    for (code, expected) in [
        (b"xGBR", vec![200, 0, 0]),
        (b"RxBG", vec![255, 200, 0]),
        (b"RBxG", vec![255, 200, 0]),
        (b"xRBG", vec![0, 200, 0]),
        (b"RGxB", vec![255, 0, 200]),
        (b"xGxR", vec![200, 0]),
    ] {
        assert_eq!(texel(&file(code)), expected, "{}", code.escape_ascii());
    }
}

/// Allowed mean errors of ETC1S and UASTC against their source picture. ETC1S has 0.025 for this file; a misplaced
/// channel costs 0.18. UASTC has 0.0133, the error of the file from which it was transcoded.
const ETC1S_MEAN: f32 = 0.03;
const UASTC_MEAN: f32 = 0.02;

#[test]
fn basis_universal_matches_its_source_picture() {
    let source = read("formats/ktx2/khr_s_normal_rgb8_mips_zstd.ktx2").image;
    for (name, format, mean_allowed) in [
        ("etc1s_basislz_mips", "ETC1S", ETC1S_MEAN),
        ("uastc_xyz_mips", "UASTC", UASTC_MEAN),
        ("uastc_normalmode_mips_zstd", "UASTC", UASTC_MEAN),
    ] {
        let path = format!("formats/ktx2/khr_s_normal_{name}.ktx2");
        if roughcast_testdata::available(&path).is_none() {
            continue;
        }
        let file = read(&path);
        assert_eq!(file.info.format, format);
        for channel in [0, 1] {
            let a = &file.image;
            let (largest, mean) =
                difference(|x, y| a.get(x, y, channel), |x, y| source.get(x, y, channel), (512, 512));
            println!("{name}, channel {channel}: {largest} at most, {mean} on average");
            assert!(mean < mean_allowed, "{name}, channel {channel}: {mean}");
        }
        if name != "uastc_xyz_mips" {
            assert_eq!(
                stated(&file.info),
                (Some(Kind::Normal), NormalEncoding::Stated(NormalChannels::Xy)),
                "{name}"
            );
        }
    }
}

/// Transcoding ETC1S to BC7 costs one or two 8-bit steps.
const TRANSCODED: f32 = 4.0 / 255.0;

#[test]
fn etc1s_matches_another_transcoder() {
    // Made by the reference transcoder, which keeps x in red, green and blue, and y in alpha.
    let reference = read("cases/ktx2-normal-mode/khr_s_normal_etc1s_basislz_mips_as_bc7.ktx2").image;
    let ours = read("formats/ktx2/khr_s_normal_etc1s_basislz_mips.ktx2").image;
    for (channel, theirs) in [(0, 0), (1, 3)] {
        let (largest, mean) =
            difference(|x, y| ours.get(x, y, channel), |x, y| reference.get(x, y, theirs), (512, 512));
        println!("channel {channel}: {largest} at most, {mean} on average");
        assert!(mean < TRANSCODED, "channel {channel}: {mean}");
    }
}

#[test]
fn damaged_basis_universal_is_refused_or_read_but_never_panics() {
    let whole = std::fs::read(find("formats/ktx2/magnum_basis_rgb-pow2.ktx2")).unwrap();
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = |end: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % end as u64) as usize
    };
    let mut refused = 0;
    for _ in 0..2000 {
        let mut damaged = whole.clone();
        for _ in 0..=next(3) {
            let at = next(damaged.len());
            damaged[at] = next(256) as u8;
        }
        if next(4) == 0 {
            damaged.truncate(next(whole.len()));
        }
        refused += usize::from(read_image(&damaged, None, &ReadOptions::default()).is_err());
    }
    assert!(refused > 100, "{refused}");
}
