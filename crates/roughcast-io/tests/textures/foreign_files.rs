//! Every available KTX2, KTX1 and DDS file is read with its correct size or refused for the right reason.

use roughcast::Samples;
use roughcast_io::{Limits, ReadError, ReadOptions, ValueRange, ktx2};

use roughcast_testdata::available;

use crate::support::{bytes_of, decoded, names_in, read_image};

enum Expected {
    /// Width, height, layers, levels, format.
    Image(usize, usize, usize, usize, &'static str),
    /// `Unsupported`, with these words in the message.
    Refused(&'static str),
}
use Expected::{Image, Refused};

const CUBE: Expected = Refused("a cube map is not supported: save one face");
const VOLUME: Expected = Refused("a 3-D texture is not supported: save one");
const VERSION_1: Expected = Refused("version 1 of the format is not supported: convert it to KTX2");

const KTX2_FILES: &[(&str, Expected)] = &[
    ("bevy_mars_mie_phase.ktx2", Image(1024, 1, 1, 1, "R32G32B32A32_SFLOAT")),
    ("bevy_sky_skybox.ktx2", CUBE),
    ("khr_s_normal_bc5_mips.ktx2", Image(512, 512, 1, 10, "BC5_UNORM_BLOCK")),
    ("khr_s_normal_bc7_mips.ktx2", Image(512, 512, 1, 10, "BC7_UNORM_BLOCK")),
    ("khr_s_normal_bc7_mips_zlib.ktx2", Image(512, 512, 1, 10, "BC7_UNORM_BLOCK")),
    ("khr_s_normal_etc1s_basislz_mips.ktx2", Image(512, 512, 1, 10, "ETC1S")),
    ("khr_s_normal_rg16_mips.ktx2", Image(512, 512, 1, 10, "R16G16_UNORM")),
    ("khr_s_normal_rgb8_mips_zstd.ktx2", Image(512, 512, 1, 10, "R8G8B8_UNORM")),
    ("khr_s_normal_rgba16_mips_zstd.ktx2", Image(512, 512, 1, 10, "R16G16B16A16_UNORM")),
    ("khr_s_normal_rgba8_mips.ktx2", Image(512, 512, 1, 10, "R8G8B8A8_UNORM")),
    ("khr_s_normal_uastc_normalmode_mips_zstd.ktx2", Image(512, 512, 1, 10, "UASTC")),
    ("khr_s_normal_uastc_xyz_mips.ktx2", Image(512, 512, 1, 10, "UASTC")),
    ("magnum_basis_rgb-linear-pow2.ktx2", Image(64, 32, 1, 1, "ETC1S")),
    ("magnum_basis_rgb-noflip-pow2.ktx2", Image(64, 32, 1, 1, "ETC1S")),
    ("magnum_basis_rgb-pow2.ktx2", Image(64, 32, 1, 1, "ETC1S")),
    ("magnum_basis_rgba-3d-mips.ktx2", Image(63, 27, 3, 3, "ETC1S")),
    ("magnum_basis_rgba-cubemap-array.ktx2", CUBE),
    ("magnum_basis_rgba-noflip-array.ktx2", Image(63, 27, 3, 1, "ETC1S")),
    ("magnum_basis_rgba-uastc.ktx2", Image(63, 27, 1, 1, "UASTC")),
    ("magnum_basis_rgba-video.ktx2", Refused("a video is not supported")),
    ("magnum_basis_rgbaf.ktx2", Refused("ASTC compression (vkFormat 1000066000) is not supported")),
    ("magnum_bcdec_rgb16f.ktx2", Image(2, 3, 1, 1, "R16G16B16_SFLOAT")),
    ("magnum_ktx_1d-compressed-bc1.ktx2", Image(4, 1, 1, 1, "BC1_RGBA_SRGB_BLOCK")),
    (
        "magnum_ktx_1d-compressed-mipmaps.ktx2",
        Refused("ETC2 or EAC compression (vkFormat 148) is not supported"),
    ),
    ("magnum_ktx_1d-mipmaps.ktx2", Image(4, 1, 1, 3, "R8G8B8_SRGB")),
    ("magnum_ktx_2d-compressed-astc.ktx2", Image(9, 10, 1, 1, "ASTC")),
    ("magnum_ktx_2d-compressed-bc2-ru.ktx2", Image(64, 32, 1, 1, "BC2_UNORM_BLOCK")),
    ("magnum_ktx_2d-compressed-bc3.ktx2", Image(8, 8, 1, 1, "BC3_SRGB_BLOCK")),
    ("magnum_ktx_2d-compressed-bc5.ktx2", Image(3, 2, 1, 1, "BC5_SNORM_BLOCK")),
    (
        "magnum_ktx_2d-compressed-layers.ktx2",
        Refused("ETC2 or EAC compression (vkFormat 148) is not supported"),
    ),
    (
        "magnum_ktx_2d-compressed-pvrtc.ktx2",
        Refused("PVRTC compression (vkFormat 1000054005) is not supported"),
    ),
    ("magnum_ktx_2d-d24s8.ktx2", Refused("a depth or stencil format (vkFormat 129) is not supported")),
    ("magnum_ktx_2d-layers.ktx2", Image(4, 3, 3, 1, "R8G8B8_SRGB")),
    ("magnum_ktx_2d-mipmaps.ktx2", Image(4, 3, 1, 3, "R8G8B8_SRGB")),
    (
        "magnum_ktx_2d-rgb32.ktx2",
        Refused("a 32-bit or 64-bit integer or double format (vkFormat 104) is not supported"),
    ),
    ("magnum_ktx_2d-rgbf32.ktx2", Image(4, 3, 1, 1, "R32G32B32_SFLOAT")),
    ("magnum_ktx_3d-compressed-astc3d-ruo.ktx2", VOLUME),
    ("magnum_ktx_3d-compressed-bc1-ruo.ktx2", VOLUME),
    ("magnum_ktx_3d-compressed-bc7.ktx2", VOLUME),
    ("magnum_ktx_3d-compressed-mipmaps.ktx2", VOLUME),
    ("magnum_ktx_3d-mipmaps.ktx2", VOLUME),
    ("magnum_ktx_bgr-swizzle-bgr-16bit.ktx2", Image(4, 3, 1, 1, "R16G16B16_UNORM")),
    ("magnum_ktx_bgr.ktx2", Image(4, 3, 1, 1, "R8G8B8_SRGB")),
    ("magnum_ktx_bgra.ktx2", Image(4, 3, 1, 1, "R8G8B8A8_SRGB")),
    ("magnum_ktx_cubemap-mipmaps.ktx2", CUBE),
    ("magnum_ktx_swizzle-bgr.ktx2", Image(4, 3, 1, 1, "R8G8B8_SRGB")),
    ("magnum_ktx_swizzle-identity.ktx2", Image(4, 3, 1, 1, "R8G8B8_SRGB")),
    ("playcanvas_etc1s_basislz.ktx2", Image(720, 720, 1, 1, "ETC1S")),
];

const KTX1_FILES: &[(&str, Expected)] = &[
    ("astc_hdr-rgb-r16.ktx", VERSION_1),
    ("astc_hdr-rgb-rg16.ktx", VERSION_1),
    ("astc_hdr-rgb-rgb16.ktx", VERSION_1),
    ("astc_hdr-rgba-rgba16.ktx", VERSION_1),
    ("bgfx_texture_compression_bc3.ktx", VERSION_1),
    ("bgfx_texture_compression_bc7.ktx", VERSION_1),
];

const DDS_FILES: &[(&str, Expected)] = &[
    ("astc_ldr-l-00-3.dds", VOLUME),
    ("bgfx_fieldstone-n.dds", Image(512, 512, 1, 10, "ATI2 (BC5_UNORM)")),
    ("bgfx_fieldstone-rgba.dds", Image(512, 512, 1, 10, "DXT3 (BC2_UNORM)")),
    ("dxtk_Atrium_diffuseIBL.dds", CUBE),
    ("dxtk_Helmet_norm.dds", Image(1024, 1024, 1, 11, "BC5_UNORM")),
    ("dxtk_SphereMat_normal.DDS", Image(1024, 1024, 1, 11, "BC5_UNORM")),
    ("dxtk_SphereMat_occlusionRoughnessMetallic.DDS", Image(1024, 1024, 1, 11, "DXT1 (BC1_UNORM)")),
    ("dxtk_ground_norm.dds", Image(32, 32, 1, 6, "BC5_UNORM")),
    (
        "dxtk_io_R8G8B8A8_UNORM_SRGB_SRV_DIMENSION_TEXTURE2DArray_MipOff.DDS",
        Image(32, 128, 6, 1, "R8G8B8A8_UNORM_SRGB"),
    ),
    ("dxtk_normalMap.dds", Image(256, 256, 1, 9, "32-bit RGBA")),
    ("magnum_bcdec_bc6h.dds", Refused("BC6H compression (DXGI format 95) is not supported")),
    ("magnum_dds_bc4snorm.dds", Image(3, 2, 1, 1, "BC4_SNORM")),
    ("magnum_dds_bc5snorm.dds", Image(3, 2, 1, 1, "BC5_SNORM")),
    ("magnum_dds_bgr8unorm-mips.dds", Image(3, 2, 1, 2, "24-bit RGB")),
    ("magnum_dds_bgra8unorm-3d.dds", VOLUME),
    ("magnum_dds_dxt1-3d.dds", VOLUME),
    ("magnum_dds_dxt1.dds", Image(3, 2, 1, 1, "DXT1 (BC1_UNORM)")),
    ("magnum_dds_dxt10-ayuv.dds", Refused("a YUV or palette format (DXGI format 100) is not supported")),
    ("magnum_dds_dxt10-bc7-cube-mips.dds", CUBE),
    ("magnum_dds_dxt10-bgra8unorm-3d.dds", VOLUME),
    (
        "magnum_dds_dxt10-depth32f-stencil8ui.dds",
        Refused("a depth or stencil format (DXGI format 22) is not supported"),
    ),
    ("magnum_dds_dxt10-r32i-mips.dds", Refused("an integer format (DXGI format 43) is not supported")),
    ("magnum_dds_dxt10-rg16f-1d-array-mips.dds", Image(5, 1, 2, 3, "R16G16_FLOAT")),
    ("magnum_dds_dxt10-rg32f.dds", Image(3, 2, 1, 1, "R32G32_FLOAT")),
    ("magnum_dds_dxt10-rgb32i.dds", Refused("an integer format (DXGI format 8) is not supported")),
    ("magnum_dds_dxt10-rgba32ui.dds", Refused("an integer format (DXGI format 3) is not supported")),
    ("magnum_dds_dxt10-rgba8unorm-3d.dds", VOLUME),
    ("magnum_dds_dxt10-rgba8unorm.dds", Image(3, 2, 1, 1, "R8G8B8A8_UNORM")),
    ("magnum_dds_dxt4.dds", Refused("premultiplied alpha (DXT2, DXT4) is not supported")),
    ("magnum_dds_r8unorm.dds", Image(3, 2, 1, 1, "8-bit R")),
    ("magnum_dds_rgb8unorm.dds", Image(3, 2, 1, 1, "24-bit RGB")),
    ("magnum_dds_rgba8unorm-3d.dds", VOLUME),
    ("magnum_dds_rgba8unorm-cube.dds", CUBE),
    ("pillow_DXGI_FORMAT_BC7_UNORM_SRGB.dds", Image(16, 16, 1, 5, "BC7_UNORM_SRGB")),
    ("pillow_argb-32bpp_MipMaps-1.dds", Image(256, 256, 1, 1, "R8G8B8A8_UNORM")),
    ("pillow_ati2.dds", Image(256, 256, 1, 9, "ATI2 (BC5_UNORM), A2XY")),
    ("pillow_bc1_typeless.dds", Image(256, 256, 1, 1, "BC1_TYPELESS")),
    ("pillow_bc4_unorm.dds", Image(64, 64, 1, 7, "BC4_UNORM")),
    ("pillow_bc5_snorm.dds", Image(256, 256, 1, 9, "BC5_SNORM")),
    ("pillow_bc5_unorm.dds", Image(256, 256, 1, 9, "BC5_UNORM")),
    ("pillow_bc5u.dds", Image(256, 256, 1, 9, "BC5_UNORM")),
    ("pillow_bc6h_sf.dds", Refused("BC6H compression (DXGI format 96) is not supported")),
    ("pillow_bgr15.dds", Image(128, 128, 1, 1, "16-bit RGB")),
    ("pillow_dxt3-argb-8bbp-explicitalpha_MipMaps-1.dds", Image(256, 256, 1, 1, "DXT3 (BC2_UNORM)")),
    ("pillow_dxt5-colorblock-alpha-issue-4142.dds", Image(4, 4, 1, 1, "DXT5 (BC3_UNORM)")),
    ("pillow_palette.dds", Refused("a palette is not supported")),
    ("pillow_uncompressed_la.dds", Image(128, 128, 1, 1, "16-bit YA")),
];

/// The tables list every file, so that none is skipped.
fn check_folder(folder: &str, table: &[(&str, Expected)]) {
    let path = |name: &str| format!("{folder}/{name}");
    let table: Vec<_> = table.iter().filter(|row| available(&path(row.0)).is_some()).collect();
    let listed: Vec<&str> = table.iter().map(|row| row.0).collect();
    assert_eq!(names_in(folder), listed, "the table of {folder} lists other files");
    for (name, expected) in table {
        match (read_image(&format!("{folder}/{name}")), expected) {
            (Ok(decoded), &Image(width, height, layers, levels, format)) => {
                let info = &decoded.info;
                assert_eq!(
                    (info.width, info.height, info.layers, info.levels),
                    (width, height, layers, levels),
                    "{name}"
                );
                assert_eq!(info.format, format, "{name}");
                assert_eq!((decoded.image.width(), decoded.image.height()), (width, height), "{name}");
                assert_eq!(decoded.image.channels(), info.channels.len(), "{name}");
                assert_eq!(info.range == ValueRange::Snorm, format.contains("SNORM"), "{name}");
                assert_eq!(info.range == ValueRange::Float, format.contains("FLOAT"), "{name}");
            }
            (Err(error @ ReadError::Unsupported { .. }), Refused(words)) => {
                let line = error.to_string();
                assert!(line.contains(words) && !line.contains('\n'), "{name}: {line}");
            }
            (other, _) => panic!("{name}: {:?}", other.map(|decoded| decoded.info)),
        }
    }
}

#[test]
fn ktx2_files() {
    check_folder("formats/ktx2", KTX2_FILES);
}

#[test]
fn ktx1_files() {
    check_folder("formats/ktx1", KTX1_FILES);
    for name in names_in("formats/ktx1") {
        let found = roughcast_io::read_image(
            &bytes_of(&format!("formats/ktx1/{name}")),
            None,
            &ReadOptions::default(),
        );
        let error = found.unwrap_err().to_string();
        assert!(error.contains("convert it to KTX2"), "found by its first bytes: {error}");
    }
}

#[test]
fn dds_files() {
    check_folder("formats/dds", DDS_FILES);
}

#[test]
fn normals_and_heights_in_dxt5() {
    for (name, side) in [("BrickWall.dds", 512), ("BrickWall_normal_parallax.dds", 256)] {
        if available(&format!("materials/brickwall_jme/{name}")).is_none() {
            continue;
        }
        let decoded = decoded(&format!("materials/brickwall_jme/{name}"));
        assert_eq!((decoded.info.width, decoded.info.format.as_str()), (side, "DXT5 (BC3_UNORM)"));
        assert_eq!(decoded.info.channels, ["R", "G", "B", "A"]);
    }
}

/// Magnum's authors stored the same picture of 4 x 3 texels in many ways, and the files agree.
#[test]
fn swizzles_are_applied() {
    let read = |name: &str| decoded(&format!("formats/ktx2/magnum_ktx_{name}.ktx2")).image;
    // The second file is stored with red and blue swapped, and its swizzle swaps them back.
    assert_eq!(read("swizzle-bgr"), read("bgr"));
    assert_ne!(read("swizzle-identity"), read("bgr"));
    assert_eq!(read("swizzle-identity"), read("2d-layers"));
    // This file is also stored with red and blue swapped, in 16 bits.
    let Samples::U16(wide) = read("bgr-swizzle-bgr-16bit").into_samples() else { panic!("16 bits") };
    let Samples::U8(narrow) = read("swizzle-identity").into_samples() else { panic!("8 bits") };
    assert_eq!(wide, narrow.iter().map(|&v| u16::from(v) * 257).collect::<Vec<_>>());
}

/// Changes the four letters of KTXswizzle in a file with three channels.
fn with_swizzle(letters: &[u8; 4]) -> Result<roughcast_io::Decoded, ReadError> {
    let mut bytes = bytes_of("formats/ktx2/magnum_ktx_swizzle-identity.ktx2");
    let at = bytes.windows(5).position(|window| window == b"rgb1\0").unwrap();
    bytes[at..at + 4].copy_from_slice(letters);
    ktx2::read_image(&bytes, &Limits::default())
}

#[test]
fn swizzles_drop_what_is_trivial_and_keep_the_rest() {
    // First texel: 0, 0, 255; second: 0, 255, 0.
    let first_two = |letters| match with_swizzle(letters).unwrap().image.into_samples() {
        Samples::U8(v) => v,
        other => panic!("8 bits, not {other:?}"),
    };
    assert_eq!(first_two(b"bg01")[..4], [255, 0, 0, 255]);
    assert_eq!(first_two(b"b001")[..2], [255, 0]);
    assert_eq!(first_two(b"bbbg")[..8], [255, 255, 255, 0, 0, 0, 0, 255]);
    assert_eq!(first_two(b"1gb0")[..8], [255, 0, 255, 0, 255, 255, 0, 0]);
    // The alpha of a file without an alpha channel is 1, so it is dropped.
    assert_eq!(first_two(b"rgba")[..6], [0, 0, 255, 0, 255, 0]);
    for invalid in [b"rgbx", b"RGB1", b"rg\0\0"] {
        assert!(matches!(with_swizzle(invalid), Err(ReadError::Malformed { .. })), "{invalid:?}");
    }
}

#[test]
fn rows_from_the_bottom_are_put_the_right_way_up() {
    let image = decoded("formats/ktx2/magnum_bcdec_rgb16f.ktx2").image;
    let row = |y| [0, 1].map(|x| [0, 1, 2].map(|c| image.get(x, y, c)));
    // The file starts with the bottom row.
    assert_eq!(row(2), [[0.0, 0.5, 1.0], [1.5, 2.0, 2.5]]);
    assert_eq!(row(0), [[0.0, 0.5, 1.0], [4.5, 5.0, 5.5]]);
}

#[test]
fn masks_and_numbers_give_the_stored_values() {
    let read = |name: &str| decoded(&format!("formats/dds/magnum_dds_{name}.dds")).image.into_samples();
    let blue_first = [0xde, 0xad, 0xb5, 0xca, 0xfe, 0x77];
    assert_eq!(
        read("bgr8unorm-mips"),
        Samples::U8([[0xde, 0xad, 0xb5], [0xca, 0xfe, 0x77]].concat().repeat(3))
    );
    assert_eq!(read("rgb8unorm"), Samples::U8(blue_first.repeat(3)));
    assert_eq!(read("r8unorm"), Samples::U8([0xde, 0xca].repeat(3)));
    let Samples::F32(floats) = read("dxt10-rg32f") else { panic!("floats") };
    assert_eq!(floats.len(), 12);
    assert_eq!(floats[0], f32::from_le_bytes([0xe0, 0xde, 0x5e, 0x3f]));
    // End points 94 and 74 of 127; the indices of the first two rows are 0 1 0 and 1 0 1.
    let snorm = [94, 74, 94, 74, 94, 74].map(|v| v as f32 / 127.0);
    assert_eq!(read("bc4snorm"), Samples::F32(snorm.to_vec()));
    let la = decoded("formats/dds/pillow_uncompressed_la.dds");
    assert_eq!(la.info.channels, ["Y", "A"]);
}
