//! Hostile bytes for the readers: each target takes any bytes, and must not panic or use excessive time or memory.
//!
//! `cargo run -p roughcast-fuzz --bin short -- --seconds 30` runs all of them on a stable compiler. For a long search
//! guided by coverage there is cargo-fuzz: `cargo fuzz run ktx2 --features libfuzzer`.
//!
//! A new target is a function here and one line in [`TARGETS`]; for cargo-fuzz also a bin like those in `fuzz_targets/`.

#![forbid(unsafe_code)]

pub mod corpus;
pub mod mutate;

use std::io::Cursor;

use roughcast::Moments;
use roughcast::texture::{Part, TextureArray, TextureInfo, layers_of};
use roughcast_io::{Decoded, Limits, Payload, ReadError, ReadOptions, Supercompression};

/// Code that is tested with hostile bytes.
pub struct Target {
    /// Its name, which is also the name of its folder in `corpus/`.
    pub name: &'static str,
    /// Extensions of the broken files from other projects that apply to it.
    pub extensions: &'static [&'static str],
    /// Runs it once; panics if a guarantee is violated.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target { name: "ktx2", extensions: &["ktx2", "ktx"], run: ktx2 },
    Target { name: "dds", extensions: &["dds"], run: dds },
    Target { name: "bc", extensions: &[], run: bc },
    Target { name: "exr_textures", extensions: &["exr"], run: exr_textures },
    Target { name: "image", extensions: IMAGES, run: image },
    Target { name: "tiff", extensions: &["tif", "tiff"], run: tiff },
    Target { name: "info", extensions: &[], run: info },
    Target { name: "decode", extensions: &["ktx2", "dds", "exr"], run: decode },
];

/// Files for the reader of images, and some that it must reject.
const IMAGES: &[&str] =
    &["png", "jpg", "jpeg", "tga", "bmp", "webp", "tif", "tiff", "hdr", "exr", "ktx2", "dds", "gltf"];

/// A small limit, so that a file that claims a large texture shows up as a slow run at worst.
const LIMITS: Limits = Limits::of_pixels(1 << 18);

/// Tests both readers of KTX2. Anything read as textures must survive a round trip.
pub fn ktx2(data: &[u8]) {
    check_image(roughcast_io::ktx2::read_image(data, &LIMITS));
    if let Ok(textures) = roughcast_io::ktx2::read_textures(data, &LIMITS) {
        check_rewritten(&textures);
    }
}

/// Tests both readers of DDS. Anything read as textures must survive a round trip.
pub fn dds(data: &[u8]) {
    check_image(roughcast_io::dds::read_image(data, &LIMITS));
    if let Ok(textures) = roughcast_io::dds::read_textures(data, &LIMITS) {
        check_rewritten(&textures);
    }
}

/// Tests the reader of baked EXR files. Anything it reads must survive a round trip.
pub fn exr_textures(data: &[u8]) {
    match roughcast_io::exr::read_textures(data, &LIMITS) {
        Ok(textures) => {
            let file = exr_file(&textures);
            let again = roughcast_io::exr::read_textures(&file, &LIMITS).expect("it was written");
            assert!(exr_file(&again) == file, "a second writing differs");
        }
        Err(error) => check_error(&error),
    }
}

fn exr_file(textures: &TextureArray) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    roughcast_io::exr::write(textures, &Default::default(), &mut file).expect("it was read");
    file.into_inner()
}

/// Tests the reader of all images: PNG, JPEG, BMP, WebP, TIFF, HDR, EXR, KTX2 and DDS by their first bytes, TGA by
/// extension.
pub fn image(data: &[u8]) {
    for extension in [None, Some("tga")] {
        check_image(roughcast_io::read_image(data, extension, &LIMITS.into()));
    }
}

/// Tests TIFF, whose tags and pixel arrangement are parsed here: the whole file, and with another image or other
/// channels chosen.
pub fn tiff(data: &[u8]) {
    let read = |layer: Option<&str>, channels: &[&str]| {
        let layer = layer.map(str::to_owned);
        let channels = channels.iter().map(|&name| name.to_owned()).collect();
        roughcast_io::read_image(
            data,
            Some("tif"),
            &ReadOptions::default().with_limits(LIMITS).with_layer(layer).with_channels(channels),
        )
    };
    check_image(read(None, &[]));
    check_image(read(Some("2"), &[]));
    check_image(read(None, &["R"]));
    check_image(read(None, &["channel4", "Y"]));
}

/// Tests the meaning of texels, as pairs of text (lines of `key=value`) and as the words of a DDS header. Valid
/// metadata reads back the same.
pub fn info(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let pair = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
    let pairs = text.lines().filter_map(|line| line.split_once('=')).map(pair).collect();
    let mut words = [0; 11];
    for (word, bytes) in words.iter_mut().zip(data.chunks_exact(4)) {
        *word = u32::from_le_bytes(bytes.try_into().expect("four bytes"));
    }
    let both = [TextureInfo::from_pairs(&pairs), TextureInfo::from_words(&words)];
    for info in both.into_iter().flatten() {
        // NaN, which marks a varying base, is not equal to itself, so the words are compared.
        let same = |again: Result<TextureInfo, _>| again.map(|again| words_of(&again)) == Ok(words_of(&info));
        assert!(same(TextureInfo::from_pairs(&info.to_pairs())), "{info:?} in pairs");
        assert!(same(TextureInfo::from_words(&info.to_words())), "{info:?} in words");
        assert!(!layers_of(&info).is_empty());
    }
}

/// The words of a meaning, with every NaN replaced by the same one.
fn words_of(info: &TextureInfo) -> [u32; 11] {
    let nan = info.base_variance.is_nan();
    TextureInfo { base_variance: if nan { f32::NAN } else { info.base_variance }, ..*info }.to_words()
}

/// Tests decoding of any baked file to moments: for any texels, the covariance is valid.
pub fn decode(data: &[u8]) {
    let read = [
        roughcast_io::ktx2::read_textures(data, &LIMITS),
        roughcast_io::dds::read_textures(data, &LIMITS),
        roughcast_io::exr::read_textures(data, &LIMITS),
    ];
    for textures in read.into_iter().flatten() {
        // For a layout of several files, the same texels replace the others regardless of their metadata.
        for part in Part::ALL {
            let mut other = textures.clone();
            other.info.part = *part;
            match roughcast::texture::decode(&[textures.clone(), other]) {
                Ok(levels) => levels.iter().flat_map(|level| level.moments()).for_each(check_moments),
                Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
            }
        }
    }
}

/// Checks that no variance is negative. Non-finite texels are exempt.
fn check_moments(moments: &Moments) {
    let covariance = moments.covariance();
    assert!(!(covariance.xx < 0.0 || covariance.yy < 0.0), "{moments:?}");
}

/// The FourCCs of the block codes; BC7 has no FourCC of its own.
const BLOCK_CODES: [(&[u8; 4], usize); 8] = [
    (b"DXT1", 8),
    (b"DXT3", 16),
    (b"DXT5", 16),
    (b"ATI1", 8),
    (b"BC4S", 8),
    (b"ATI2", 16),
    (b"BC5S", 16),
    (b"DX10", 16),
];

/// Tests block decoding, which must succeed for any bytes: the first byte selects the code, the next two the size, the
/// rest are blocks, repeated as often as needed.
pub fn bc(data: &[u8]) {
    let [code, width, height, blocks @ ..] = data else { return };
    if blocks.is_empty() {
        return;
    }
    let (four_cc, block_bytes) = BLOCK_CODES[usize::from(*code) % BLOCK_CODES.len()];
    let (width, height) = (usize::from(*width % 64) + 1, usize::from(*height % 64) + 1);
    let mut file = dds_header(four_cc, width as u32, height as u32);
    let length = width.div_ceil(4) * height.div_ceil(4) * block_bytes;
    file.extend(blocks.iter().cycle().take(length));
    let decoded = roughcast_io::dds::read_image(&file, &LIMITS).expect("blocks of any bits are valid");
    assert_eq!((decoded.image.width(), decoded.image.height()), (width, height));
    assert_finite(&decoded);
}

fn dds_header(four_cc: &[u8; 4], width: u32, height: u32) -> Vec<u8> {
    const DXGI_BC7_UNORM: u32 = 98;
    let mut words = [0; 32];
    words[0] = u32::from_le_bytes(*b"DDS ");
    [words[1], words[3], words[4]] = [124, height, width];
    [words[19], words[20], words[21]] = [32, 0x4, u32::from_le_bytes(*four_cc)];
    let mut header: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    if four_cc == b"DX10" {
        header.extend([DXGI_BC7_UNORM, 3, 0, 1, 0].iter().flat_map(|word| word.to_le_bytes()));
    }
    header
}

/// Blocks cannot store infinities: every decoded value is within -1 ..= 1.
fn assert_finite(decoded: &Decoded) {
    let samples = decoded.image.samples();
    assert!(
        (0..samples.len()).all(|index| (-1.0..=1.0).contains(&samples.get(index))),
        "outside of -1 ..= 1"
    );
}

/// Maximum length of an error message, which must be one clear line. Some quote a name from the file.
const LONGEST_ERROR: usize = 1000;

/// Checks that the information of an image matches its pixels, and that an error is one line.
fn check_image(result: Result<Decoded, ReadError>) {
    match result {
        Ok(Decoded { image, info }) => {
            assert_eq!((image.width(), image.height()), (info.width, info.height));
            assert_eq!(image.channels(), info.channels.len());
            assert!(info.layers > 0 && info.levels > 0);
            assert!((image.width() * image.height()) as u64 <= LIMITS.max_pixels);
        }
        Err(error) => check_error(&error),
    }
}

/// Checks that an error is one line, or becomes one: the program removes control characters.
fn check_error(error: &ReadError) {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < LONGEST_ERROR, "{text}");
}

/// Writes textures, reads them back and writes them again: both files must be identical. (The texels themselves cannot
/// be compared, since NaN is not equal to itself.)
fn check_rewritten(textures: &TextureArray) {
    let ktx2 = |array: &TextureArray| {
        let mut file = Vec::new();
        roughcast_io::ktx2::write(Payload::Texels(array), Supercompression::Zstd, &mut file)
            .expect("it was read");
        file
    };
    let dds = |array: &TextureArray| {
        let mut file = Vec::new();
        roughcast_io::dds::write(Payload::Texels(array), &mut file).expect("it was read");
        file
    };
    let (ktx2_file, dds_file) = (ktx2(textures), dds(textures));
    let of_ktx2 = roughcast_io::ktx2::read_textures(&ktx2_file, &LIMITS).expect("it was written");
    let of_dds = roughcast_io::dds::read_textures(&dds_file, &LIMITS).expect("it was written");
    assert!(ktx2(&of_ktx2) == ktx2_file && dds(&of_dds) == dds_file, "a second writing differs");
    // In the other direction the bits of a NaN in the metadata may differ, because KTX2 writes it as text.
    assert!(ktx2(&of_dds) == ktx2_file, "DDS and KTX2 hold different texels");
}
