//! EXR files written by these tests, in layouts that are missing from the shared data: parts, moved data windows, tiles
//! that do not divide the image, rows from the bottom, mixed sample types.

use std::io::Cursor;

use exr::prelude::*;
use roughcast::Samples;
use roughcast_io::{Decoded, ReadError, ReadOptions, read_image};

const WIDTH: usize = 37;
const HEIGHT: usize = 53;

/// A value that differs between pixels and between channels and that a half represents exactly.
fn value(x: usize, y: usize, channel: usize) -> f32 {
    (x * 8 + y * 16 + channel) as f32 / 4.0
}

fn halves(channel: usize) -> FlatSamples {
    FlatSamples::F16(pixels(channel).map(f16::from_f32).collect())
}

fn pixels(channel: usize) -> impl Iterator<Item = f32> {
    (0..HEIGHT).flat_map(move |y| (0..WIDTH).map(move |x| value(x, y, channel)))
}

fn layer(names: &[&str], encoding: Encoding) -> Layer<AnyChannels<FlatSamples>> {
    let channels = names.iter().enumerate().map(|(i, name)| AnyChannel::new(*name, halves(i)));
    let attributes = LayerAttributes::named(Text::new_or_panic(names.join("-")));
    Layer::new((WIDTH, HEIGHT), attributes, encoding, AnyChannels::sort(channels.collect()))
}

fn write(layers: Vec<Layer<AnyChannels<FlatSamples>>>, data_window: Vec2<i32>) -> Vec<u8> {
    let window = IntegerBounds::new(data_window, (WIDTH, HEIGHT));
    let mut image =
        Image::from_layers(ImageAttributes::new(window), layers.into_iter().collect::<Layers<_>>());
    for layer in &mut image.layer_data {
        layer.attributes.layer_position = data_window;
    }
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).expect("the image can be written");
    file.into_inner()
}

fn read(file: &[u8]) -> std::result::Result<Decoded, ReadError> {
    read_image(file, None, &ReadOptions::default())
}

/// Asserts that `decoded` holds the pixels of the first `channels` channels written, in their order.
fn assert_pixels(decoded: &Decoded, channels: usize, what: &str) {
    assert_eq!((decoded.image.width(), decoded.image.height()), (WIDTH, HEIGHT), "{what}");
    assert_eq!(decoded.image.channels(), channels, "{what}");
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            for channel in 0..channels {
                let got = decoded.image.get(x, y, channel);
                assert_eq!(got, value(x, y, channel), "{what}: pixel {x}, {y}, channel {channel}");
            }
        }
    }
}

#[test]
fn every_lossless_layout_gives_the_same_pixels() {
    let compressions = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
    ];
    // Tiles that do not divide the image, small tiles, and one tile larger than the image.
    let blocks = [
        Blocks::ScanLines,
        Blocks::Tiles(Vec2(16, 10)),
        Blocks::Tiles(Vec2(5, 7)),
        Blocks::Tiles(Vec2(64, 64)),
    ];
    for compression in compressions {
        for blocks in blocks {
            for line_order in [LineOrder::Increasing, LineOrder::Decreasing] {
                for data_window in [Vec2(0, 0), Vec2(-7, 13), Vec2(5, -100)] {
                    let encoding = Encoding { compression, blocks, line_order };
                    let file = write(vec![layer(&["R", "G", "B"], encoding)], data_window);
                    let what = format!("{encoding:?} at {data_window:?}");
                    let decoded = read(&file).unwrap_or_else(|error| panic!("{what}: {error}"));
                    assert!(matches!(decoded.image.samples(), Samples::F16(_)), "{what}");
                    assert_pixels(&decoded, 3, &what);
                }
            }
        }
    }
}

#[test]
fn each_of_several_parts_is_read_by_its_name() {
    let tiled = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::Tiles(Vec2(16, 16)),
        line_order: LineOrder::Increasing,
    };
    let first = layer(&["R", "G"], tiled);
    let second = layer(&["X", "Y", "Z"], Encoding::FAST_LOSSLESS);
    let file = write(vec![first, second], Vec2(3, -4));
    for (name, channels) in [("R-G", &["R", "G"][..]), ("X-Y-Z", &["X", "Y", "Z"])] {
        let options = ReadOptions::default().with_layer(Some(name.to_owned()));
        let decoded = read_image(&file, None, &options).unwrap();
        assert_eq!(decoded.info.channels, channels);
        assert_eq!(decoded.info.metadata["name"], name);
        assert_pixels(&decoded, channels.len(), name);
    }
}

#[test]
fn a_half_beside_a_float_is_widened() {
    let float = FlatSamples::F32(pixels(1).collect());
    let channels = [AnyChannel::new("R", halves(0)), AnyChannel::new("G", float)];
    let attributes = LayerAttributes::named("mixed");
    let encoding = Encoding::SMALL_LOSSLESS;
    let layer =
        Layer::new((WIDTH, HEIGHT), attributes, encoding, AnyChannels::sort(channels.into_iter().collect()));
    let decoded = read(&write(vec![layer], Vec2(0, 0))).unwrap();
    assert!(matches!(decoded.image.samples(), Samples::F32(_)));
    assert_pixels(&decoded, 2, "mixed");
}

#[test]
fn an_unfinished_file_is_reported_as_unfinished() {
    let mut file = write(vec![layer(&["R"], Encoding::UNCOMPRESSED)], Vec2(0, 0));
    // The table of blocks ends where the first block begins. A block has y, the length and one row of halves.
    let block = 4 + 4 + WIDTH * 2;
    let table_end = file.len() - HEIGHT * block;
    file[table_end - 8..table_end].fill(0);
    let error = read(&file).unwrap_err().to_string();
    assert!(error.contains("it was never finished"), "{error}");
}

#[test]
fn an_unknown_newer_compression_is_named() {
    let mut file = write(vec![layer(&["R"], Encoding::UNCOMPRESSED)], Vec2(0, 0));
    let attribute = b"compression\0compression\0\x01\0\0\0";
    let at = file.windows(attribute.len()).position(|window| window == attribute).unwrap() + attribute.len();
    file[at] = 12;
    let error = read(&file).unwrap_err().to_string();
    assert_eq!(error, "EXR: the compression of number 12 is not supported: save it with ZIP compression");
    file[at] = 10;
    let error = read(&file).unwrap_err().to_string();
    assert_eq!(error, "EXR: HTJ2K compression is not supported: save it with ZIP compression");
}
