//! A picture that is stored in several files must read the same from each.

use roughcast::{Image, Samples};
use roughcast_io::{Limits, ValueRange, dds};
use roughcast_testdata::available;

use crate::support::{bytes_of, decoded, floats};

/// Mean and largest difference of the first `channels` channels.
fn difference(a: &Image, b: &Image, channels: usize) -> (f64, f64) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let (a, b) = (floats(a, channels), floats(b, channels));
    let differences = a.iter().zip(&b).map(|(a, b)| f64::from((a - b).abs()));
    let (sum, max) = differences.fold((0.0, 0.0_f64), |(sum, max), d| (sum + d, max.max(d)));
    (sum / a.len() as f64, max)
}

/// Widening 8 bits to 16 is exact; half of an 8-bit step allows for either rounding.
const WIDENED: f64 = 0.5 / 255.0;
/// The block files were transcoded from a Basis Universal file, whose own error is 0.0134 on average. A misplaced
/// channel costs 0.18.
const TRANSCODED_MEAN: f64 = 0.02;
/// The same for the worst texel, which is at the edge of the S and has a measured error of 0.117.
const TRANSCODED_MAX: f64 = 0.15;

#[test]
fn one_normal_map_in_seven_formats() {
    let reference = decoded("formats/ktx2/khr_s_normal_rgb8_mips_zstd.ktx2").image;
    let cases = [
        ("rg16_mips", 2, WIDENED, WIDENED),
        ("rgba8_mips", 3, 0.0, 0.0),
        ("rgba16_mips_zstd", 3, WIDENED, WIDENED),
        ("bc5_mips", 2, TRANSCODED_MEAN, TRANSCODED_MAX),
        ("bc7_mips", 3, TRANSCODED_MEAN, TRANSCODED_MAX),
        ("bc7_mips_zlib", 3, TRANSCODED_MEAN, TRANSCODED_MAX),
    ];
    let path = |name| format!("formats/ktx2/khr_s_normal_{name}.ktx2");
    for (name, channels, mean_allowed, max_allowed) in cases {
        if available(&path(name)).is_none() {
            continue;
        }
        let image = decoded(&path(name)).image;
        let (mean, max) = difference(&reference, &image, channels);
        println!("{name}: mean {mean:.6}, max {max:.6}");
        assert!(mean <= mean_allowed && max <= max_allowed, "{name}: mean {mean}, max {max}");
    }
    let turned = roughcast::Image::new(512, 512, 3, reversed(reference.samples())).unwrap();
    assert!(
        difference(&reference, &turned, 3).0 > TRANSCODED_MEAN,
        "the comparison would notice a turned picture"
    );
}

fn reversed(samples: &Samples) -> Samples {
    let Samples::U8(v) = samples else { panic!("8 bits") };
    Samples::U8(v.chunks_exact(3).rev().flatten().copied().collect())
}

fn png_rgb8(path: &str) -> Image {
    let file = std::fs::File::open(roughcast_testdata::find(path)).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    Image::new(frame.width as usize, frame.height as usize, 3, Samples::U8(pixels)).unwrap()
}

/// Block compression of these files costs 0.7 (BC5) and 0.45 (BC1) 8-bit steps on average.
const SPHERE_MEAN: f64 = 1.0 / 255.0;

#[test]
fn a_bc5_file_is_the_png_with_green_turned_over() {
    let blocks = decoded("crops/spheremat_normal_256.dds").image;
    let png = png_rgb8("crops/spheremat_normal_256.png");
    let Samples::U8(rgb) = png.samples() else { panic!("8 bits") };
    let turned = rgb.chunks_exact(3).flat_map(|t| [t[0], 255 - t[1]]).collect();
    let turned = Image::new(png.width(), png.height(), 2, Samples::U8(turned)).unwrap();
    let (mean, max) = difference(&turned, &blocks, 2);
    println!("mean {mean:.6}, max {max:.6}");
    assert!(mean < SPHERE_MEAN, "mean {mean}");
    assert!(difference(&png, &blocks, 2).0 > 4.0 * SPHERE_MEAN, "without the turn it is another picture");
}

#[test]
fn bc1_is_its_png() {
    let blocks = decoded("crops/spheremat_orm_256.dds").image;
    let png = png_rgb8("crops/spheremat_orm_256.png");
    let (mean, max) = difference(&png, &blocks, 3);
    println!("mean {mean:.6}, max {max:.6}");
    assert!(mean < SPHERE_MEAN, "mean {mean}");
}

/// Mean squared curl of the gradient field that a normal map represents, with y up (`green` = 1) or down (-1). A height
/// field's gradient has no curl, so the correct interpretation of the channels has by far the smallest.
fn curl(image: &Image, [x_channel, y_channel]: [usize; 2], green: f32) -> f64 {
    let slope = |x: usize, y: usize| {
        let [nx, ny] = [x_channel, y_channel].map(|channel| image.get(x, y, channel) * 2.0 - 1.0);
        let nz = (1.0 - nx * nx - ny * ny).max(0.01).sqrt();
        // Rows run downwards, so the derivative of the height along them has the opposite sign to that for y up.
        [f64::from(-nx / nz), f64::from(green * ny / nz)]
    };
    let mut sum = 0.0;
    for y in 1..image.height() - 1 {
        for x in 1..image.width() - 1 {
            let across = slope(x, y + 1)[0] - slope(x, y - 1)[0];
            let down = slope(x + 1, y)[1] - slope(x - 1, y)[1];
            sum += (across - down).powi(2);
        }
    }
    sum
}

/// Minimum ratio of the next best interpretation's curl to that of the correct one; 57 is reported for this file.
const CURL_FACTOR: f64 = 10.0;

#[test]
fn a_real_ati2_file_of_the_older_order_has_y_first() {
    let image = decoded("formats/dds/bgfx_fieldstone-n.dds").image;
    let right = curl(&image, [1, 0], -1.0);
    for (channels, green) in [([1, 0], 1.0), ([0, 1], 1.0), ([0, 1], -1.0)] {
        let wrong = curl(&image, channels, green);
        assert!(wrong > CURL_FACTOR * right, "{channels:?}, {green}: {wrong} against {right}");
    }
}

#[test]
fn ati2_marked_as_xy_is_plain_bc5() {
    const FOUR_CC: std::ops::Range<usize> = 84..88;
    let mut bytes = bytes_of("formats/dds/pillow_ati2.dds");
    let ati2 = dds::read_image(&bytes, &Limits::default()).expect("a whole file").image;
    bytes[FOUR_CC].copy_from_slice(b"BC5U");
    assert_eq!(dds::read_image(&bytes, &Limits::default()).expect("the same blocks").image, ati2);
    // The same blocks in another writer's files.
    for name in ["pillow_bc5u.dds", "pillow_bc5_unorm.dds"] {
        let path = format!("formats/dds/{name}");
        if available(&path).is_some() {
            assert_eq!(decoded(&path).image, ati2, "{name}");
        }
    }
}

#[test]
fn signed_blocks_are_floats_around_zero() {
    let decoded = decoded("formats/dds/pillow_bc5_snorm.dds");
    assert_eq!(decoded.info.range, ValueRange::Snorm);
    let Samples::F32(values) = decoded.image.samples() else { panic!("floats") };
    assert!(values.iter().all(|v| (-1.0..=1.0).contains(v)));
    let (least, greatest) = values.iter().fold((1.0_f32, -1.0_f32), |(a, b), &v| (a.min(v), b.max(v)));
    assert!(least < -0.1 && greatest > 0.1, "{least} .. {greatest}");
}
