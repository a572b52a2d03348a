//! What block compression changes, and what it preserves.

use roughcast::texture::{Layout, Part, Texture, TextureArray, TextureInfo};
use roughcast::{Image, SampleType, Samples};
use roughcast_io::{BlockFormat, WriteError, compress, decompress};

use crate::support::{Random, decoded, noise_array};

fn array_of(image: Image) -> TextureArray {
    let channels = vec!["c"; image.channels()];
    let layer = Texture::new("test", channels, vec![image]).unwrap();
    TextureArray::new(TextureInfo::new(Layout::Variance, Part::Whole), vec![layer]).unwrap()
}

fn through_blocks(image: &Image, format: BlockFormat) -> Image {
    let back = decompress(&compress(&array_of(image.clone()), format).unwrap());
    back.layers()[0].finest().clone()
}

#[test]
fn flat_blocks_keep_their_value() {
    for value in 0..=255 {
        for format in [BlockFormat::Bc4, BlockFormat::Bc5] {
            let channels = format.channels();
            let flat = Image::new(6, 5, channels, Samples::U8(vec![value; 30 * channels])).unwrap();
            let back = through_blocks(&flat, format);
            assert_eq!(
                back.samples(),
                &Samples::U16(vec![u16::from(value) * 257; 30 * channels]),
                "{format:?}"
            );
        }
    }
}

/// BC4 and BC5 place eight values from the minimum to the maximum of a block, so a texel is at most half a step off.
/// The encoder refines its end points to reduce the sum of squared errors, which may move them by one or two 8-bit
/// steps.
const END_POINT_SLACK: f32 = 2.0 / 255.0;

#[test]
fn bc4_and_bc5_are_within_half_a_step_of_the_block() {
    let mut random = Random::new(7);
    for format in [BlockFormat::Bc4, BlockFormat::Bc5] {
        let channels = format.channels();
        for _ in 0..500 {
            let (low, span) = (random.next() % 200, 1 + random.next() % 56);
            let texels = (0..16 * channels).map(|_| (low + random.next() % span) as u8).collect();
            let image = Image::new(4, 4, channels, Samples::U8(texels)).unwrap();
            let back = through_blocks(&image, format);
            for channel in 0..channels {
                let values: Vec<f32> = (0..16).map(|i| image.samples().get(i * channels + channel)).collect();
                let (least, greatest) =
                    values.iter().fold((1.0_f32, 0.0_f32), |(a, b), &v| (a.min(v), b.max(v)));
                let bound = (greatest - least) / 14.0 + END_POINT_SLACK;
                for (i, value) in values.iter().enumerate() {
                    let error = (back.samples().get(i * channels + channel) - value).abs();
                    assert!(error <= bound, "{format:?}: error {error} > {bound} in {values:?}");
                }
            }
        }
    }
}

fn root_mean_square_error(a: &Image, b: &Image) -> f64 {
    let len = a.samples().len();
    let square = |i: usize| f64::from(a.samples().get(i) - b.samples().get(i)).powi(2);
    ((0..len).map(square).sum::<f64>() / len as f64).sqrt()
}

/// Allowed error for a normal map with hard edges. The measured errors are 0.0084 (BC4), 0.0082 (BC5) and 0.0109 (BC7).
const NORMAL_MAP_ERROR: f64 = 0.015;

#[test]
fn a_normal_map_is_nearly_unchanged() {
    let source = decoded("formats/ktx2/khr_s_normal_rgb8_mips_zstd.ktx2").image;
    let Samples::U8(rgb) = source.samples() else { panic!("8 bits") };
    let rgba: Vec<u8> = rgb.as_chunks::<3>().0.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    for format in [BlockFormat::Bc4, BlockFormat::Bc5, BlockFormat::Bc7] {
        let channels = format.channels();
        let kept = rgba.chunks_exact(4).flat_map(|texel| texel[..channels].to_vec()).collect();
        let image = Image::new(source.width(), source.height(), channels, Samples::U8(kept)).unwrap();
        let error = root_mean_square_error(&image, &through_blocks(&image, format));
        println!("{format:?}: {error:.5}");
        assert!(error > 0.0 && error < NORMAL_MAP_ERROR, "{format:?}: {error}");
    }
}

/// BC7 preserves four unrelated channels only roughly. This limit detects a lost or swapped channel, which costs 0.4 or
/// more.
const UNRELATED_CHANNELS_ERROR: f64 = 0.05;

#[test]
fn bc7_keeps_the_fourth_channel_as_data() {
    let ramp = |i: usize| {
        let (x, y) = (i % 64, i / 64);
        [x * 4, y * 4, 255 - x * 4, 255 - y * 4].map(|v| v as u8)
    };
    let image = Image::new(64, 64, 4, Samples::U8((0..4096).flat_map(ramp).collect())).unwrap();
    let error = root_mean_square_error(&image, &through_blocks(&image, BlockFormat::Bc7));
    println!("{error:.5}");
    assert!(error < UNRELATED_CHANNELS_ERROR, "{error}");
}

#[test]
fn the_edge_is_repeated_and_not_mixed_with_black() {
    // 5 texels per row: the second block has one real column. If the rest were zeros, the block would not be flat.
    let image = Image::new(5, 5, 1, Samples::U8(vec![200; 25])).unwrap();
    let blocks = compress(&array_of(image), BlockFormat::Bc4).unwrap();
    let bytes = &blocks.layers()[0].levels()[0];
    assert_eq!(bytes.len(), 4 * 8);
    for block in bytes.chunks_exact(8) {
        assert_eq!(block[..2], [200, 200], "end points of a flat block");
    }
}

#[test]
fn other_samples_and_channels_are_refused() {
    let refused = |array: &TextureArray, format| {
        let error = compress(array, format).unwrap_err();
        assert!(matches!(error, WriteError::Unsupported { .. }));
        error.to_string()
    };
    let wide = noise_array(SampleType::U16, 2, (4, 4), 1);
    assert!(refused(&wide, BlockFormat::Bc5).starts_with("BC5 cannot hold U16 samples: quantise to 8 bits"));
    let four = noise_array(SampleType::U8, 4, (4, 4), 1);
    assert!(refused(&four, BlockFormat::Bc4).starts_with("BC4 cannot hold 4 channels"));
}
