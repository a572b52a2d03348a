//! Damaged and hostile files quickly give an error, or an image if they are merely odd, and never cause a panic.

mod shared_data;

use std::time::{Duration, Instant};

use roughcast_io::{Limits, ReadError, ReadOptions, read_image};
use roughcast_testdata::{available, find};
use shared_data::manifest;

/// Odd files that contain a complete image, each with an explanation.
const READABLE: [(&str, &str); 9] = [
    ("go_invalid-palette.png", "indices past the palette, which the format's own library reads as black"),
    ("magnum_openexr_levels-cube-incomplete.exr", "level 0 is whole, lower levels are not"),
    ("oiio_bad.exr", "a broken attribute beside whole pixels"),
    ("oiio_check1.tif", "whole: planar tiles of floats with their predictor, which other readers lack"),
    ("oiio_corrupt-exif.jpg", "damage within the EXIF data"),
    ("oiio_corrupt-exif-recursive-ifd.jpg", "damage within the EXIF data"),
    ("oiio_corrupt-xmp-deep-nesting.jpg", "XMP that a parser of XMP would choke on"),
    ("oiio_exif-deep-ifds.png", "EXIF that a parser of EXIF would choke on"),
    ("oiio_rowsperstrip-zero.exr", "an attribute that only TIFF would use"),
];
/// More of these files; the data has two more copies that differ only in their extension.
const READABLE_XMP: [&str; 2] = ["oiio_xmp-deep-nesting.png", "oiio_xmp-many-attribs.png"];

/// Reasons that the error messages of some files must contain.
const REASONS: [(&str, &str); 15] = [
    ("exr_v1.7.test.interleaved.exr", "its channel names are ambiguous: R, Z"),
    ("oiio_bomb.png", "46340x46340 pixels are more than the limit"),
    ("oiio_bomb.exr", "46340x46340 pixels are more than the limit"),
    ("oiio_bomb-40000.hdr", "40000x40000 pixels are more than the limit"),
    ("oiio_bomb-65500x65500.jpg", "65500x65500 pixels are more than the limit"),
    ("go_invalid-crc32.png", "CRC error"),
    ("go_invalid-zlib.png", "WrongChecksum"),
    ("pillow_truncated_image.png", "the file ends too early"),
    ("pillow_cross_scan_line_truncated.tga", "the file ends too early"),
    ("imgrs_flip-zero-height2.tga", "there is no image type 0"),
    ("oiio_crash1708.tga", "Invalid color map index"),
    ("oiio_corrupt-icc-4552.jpg", "the file ends too early"),
    ("imgrs_TODO_hpredict_cmyk.tiff", "CMYK colour"),
    ("exr_asan_heap-oob_4cb169_978_5f00ce89c3847e739b256efc49f312cf_exr.exr", "points to another block"),
    ("exr_asan_heap-oob_7f4d5072b39d_561_5f5e4ef49a581edaf7bf0858fbfcfdd1_exr.exr", "outside of the file"),
];

/// Time limit for one file. Each takes a few milliseconds, but a slow machine under load may need more.
const PATIENCE: Duration = Duration::from_secs(10);

/// Name, extension and bytes of the broken files in ordinary image formats.
fn broken_images() -> Vec<(String, String, Vec<u8>)> {
    let files = manifest(&["broken"]).into_iter().filter_map(|entry| {
        let name = entry.path.rsplit('/').next().expect("a file name").to_owned();
        let extension = name.rsplit('.').next().expect("an extension").to_owned();
        let is_texture = ["dds", "ktx2", "gltf"].contains(&extension.as_str());
        (!is_texture).then(|| (name, extension, std::fs::read(find(&entry.path)).expect("a readable file")))
    });
    let files: Vec<_> = files.collect();
    assert!(files.len() >= 75, "only {} broken images", files.len());
    files
}

#[test]
fn broken_files_give_errors_and_odd_ones_images() {
    for (name, extension, bytes) in broken_images() {
        let start = Instant::now();
        let result = read_image(&bytes, Some(&extension), &ReadOptions::default());
        assert!(start.elapsed() < PATIENCE, "{name} took {:?}", start.elapsed());
        let readable = READABLE.iter().any(|(odd, _)| *odd == name) || READABLE_XMP.contains(&name.as_str());
        match result {
            Ok(_) => assert!(readable, "{name} was read"),
            Err(error) => {
                let error = error.to_string();
                assert!(!readable, "{name}: {error}");
                assert!(!error.contains('\n') && error.len() < 400, "{name}: not a short line: {error}");
                if let Some((_, reason)) = REASONS.iter().find(|(broken, _)| *broken == name) {
                    assert!(error.contains(reason), "{name}: '{error}' does not contain '{reason}'");
                }
            }
        }
    }
}

#[test]
fn the_tables_list_existing_files() {
    let files = broken_images();
    let named =
        READABLE.iter().map(|odd| odd.0).chain(REASONS.iter().map(|broken| broken.0)).chain(READABLE_XMP);
    for name in named {
        let there = files.iter().any(|(file, _, _)| file == name);
        assert!(there || available(&format!("broken/{name}")).is_none(), "no broken file is called {name}");
    }
}

/// One intact file for each format and for each compression with its own decoder.
const WHOLE: [&str; 18] = [
    "formats/png/go_basn2c08.png",
    "formats/png/imgrs_basi0g16.png",
    "formats/png/go_basn3p08-trns.png",
    "formats/tiny/astc_ldr.jpg",
    "formats/tiny/astc_ldr.bmp",
    "formats/tga/pillow_200x32_rgb_tl_raw.tga",
    "formats/tga/pillow_la.tga",
    "formats/tiff/pillow_16bit.deflate.tif",
    "formats/tiff/imgrs_hpredict_packbits.tiff",
    "formats/tiff/pillow_tiff_strip_planar_16bit_RGB.tiff",
    "formats/hdr/imgrs_image1.hdr",
    "formats/exr/exrs_f16_zips.exr",
    "formats/exr/exrs_f16_b44.exr",
    "formats/exr/exrs_f16_dwab.exr",
    "formats/exr/exrs_u16_f32_piz.exr",
    "heights/oiio_bumpslope/bumpslope.exr",
    "materials/pmndrs_normals/0000.webp",
    "materials/pmndrs_normals/0024.webp",
];

fn whole_files() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let file = |path: &'static str| {
        let extension = path.rsplit('.').next().expect("an extension");
        (path, extension, std::fs::read(find(path)).unwrap_or_else(|e| panic!("{path}: {e}")))
    };
    WHOLE.map(file).into()
}

/// Percentage of a file that contains all pixels of level 0, for files in which it is below 100. The rest contains
/// lower mip levels, or TIFF tags that are not read.
const PIXELS_END: [(&str, usize); 2] =
    [("heights/oiio_bumpslope/bumpslope.exr", 90), ("formats/tiff/imgrs_hpredict_packbits.tiff", 99)];

#[test]
fn a_file_that_was_cut_is_an_error() {
    for (path, extension, bytes) in whole_files() {
        let pixels_end =
            PIXELS_END.iter().find(|(name, _)| *name == path).map_or(100, |(_, percent)| *percent);
        for percent in [0, 1, 10, 50, 90, 99] {
            let cut = &bytes[..bytes.len() * percent / 100];
            let result = read_image(cut, Some(extension), &ReadOptions::default());
            let is_ok = result.is_ok();
            assert_eq!(
                is_ok,
                percent >= pixels_end,
                "{path} cut to {percent} %: {:?}",
                result.map(|d| d.info)
            );
        }
    }
}

/// Damaged copies of each file: enough to reach every branch of the header parsers within a few seconds.
const DAMAGES: u64 = 400;
/// Limits that keep a damaged size from making the test slow.
const SMALL: Limits = Limits::of_pixels(1 << 18);

/// Reads arbitrary bytes, as a fuzzer would.
fn fuzz_read_image(bytes: &[u8], extension: &str) {
    match read_image(bytes, Some(extension), &SMALL.into()) {
        Ok(decoded) => {
            let (image, info) = (decoded.image, decoded.info);
            assert_eq!((image.width(), image.height()), (info.width, info.height));
            assert!((info.width * info.height) as u64 <= SMALL.max_pixels);
            assert_eq!(image.channels(), info.channels.len());
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
}

#[test]
fn damaged_bytes_never_panic() {
    let mut random = XorShift(0x9e37_79b9_7f4a_7c15);
    for (path, extension, bytes) in whole_files() {
        let start = Instant::now();
        for _ in 0..DAMAGES {
            let mut damaged = bytes.clone();
            for _ in 0..=random.below(4) {
                random.damage(&mut damaged);
            }
            fuzz_read_image(&damaged, extension);
        }
        assert!(start.elapsed() < 6 * PATIENCE, "{path}: {DAMAGES} damages took {:?}", start.elapsed());
    }
}

#[test]
fn noise_behind_a_signature_never_panics() {
    let mut random = XorShift(0x2545_f491_4f6c_dd1d);
    let signatures: [&[u8]; 9] = [
        b"\x89PNG\r\n\x1a\n",
        b"\xff\xd8\xff",
        b"BM",
        b"II\x2a\0\x08\0\0\0",
        b"MM\0\x2b",
        b"#?RADIANCE\n\n-Y 9 +X 9\n",
        b"\x76\x2f\x31\x01\x02\0\0\0",
        b"RIFF\x40\0\0\0WEBPVP8 ",
        b"\0\0\x0a\0\0\0\0\0\0\0\0\0\x10\0\x10\0\x20\x08",
    ];
    for signature in signatures {
        for _ in 0..200 {
            let mut bytes = signature.to_vec();
            let len = random.below(300);
            bytes.extend((0..len).map(|_| random.next() as u8));
            fuzz_read_image(&bytes, "tga");
        }
    }
}

/// Marsaglia's generator, which gives the same damage in every run.
struct XorShift(u64);

impl XorShift {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// Changes some bytes, most often in the header, which contains the sizes and offsets.
    fn damage(&mut self, bytes: &mut Vec<u8>) {
        const HEADER: usize = 600;
        let reach = if self.below(3) == 0 { bytes.len() } else { bytes.len().min(HEADER) };
        if reach == 0 {
            return;
        }
        let at = self.below(reach);
        match self.below(5) {
            0 => bytes[at] ^= 1 << self.below(8),
            1 => bytes[at] = self.next() as u8,
            2 => bytes.truncate(at),
            3 => {
                let extreme = [0, 1, u32::MAX, i32::MAX as u32, 1 << 31, 1 << 16][self.below(6)];
                let extreme = if self.below(2) == 0 { extreme.to_le_bytes() } else { extreme.to_be_bytes() };
                bytes[at..].iter_mut().zip(extreme).for_each(|(byte, new)| *byte = new);
            }
            _ => drop(bytes.drain(at..(at + 7).min(reach))),
        }
    }
}

#[test]
fn missing_files_and_folders_are_io_errors() {
    let folder = find("broken");
    for path in [folder.join("no-such-file.png"), folder] {
        let result = roughcast_io::read_image_file(&path, &ReadOptions::default());
        assert!(matches!(result, Err(ReadError::Io(_))), "{}: {result:?}", path.display());
    }
    assert!(matches!(read_image(&[], Some("png"), &ReadOptions::default()), Err(ReadError::Empty)));
}

#[test]
fn the_limit_counts_pixels() {
    let bytes = std::fs::read(find("formats/png/go_basn2c08.png")).unwrap();
    assert!(read_image(&bytes, None, &Limits::of_pixels(32 * 32).into()).is_ok());
    let refused = read_image(&bytes, None, &Limits::of_pixels(32 * 32 - 1).into());
    assert!(matches!(refused, Err(ReadError::TooLarge { width: 32, height: 32, .. })), "{refused:?}");
}
