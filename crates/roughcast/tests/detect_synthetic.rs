//! The detection of `roughcast::detect` on synthetic maps, each with one property of interest.

use roughcast::detect::{GreenVerdict, KindGuess, guess_channels, guess_kind, guess_range, test_green};
use roughcast::{Image, Kind, NormalChannels, NormalRange, Samples};

const SIZE: usize = 96;
const RGB: [&str; 3] = ["R", "G", "B"];
const RGBA: [&str; 4] = ["R", "G", "B", "A"];
const NORMAL: KindGuess = KindGuess::Certain(Kind::Normal);
const HEIGHT: KindGuess = KindGuess::Certain(Kind::Height);

/// A hash of a pixel, as a number in -1 .. 1: noise that is identical on every run.
fn noise(x: usize, y: usize, seed: u64) -> f32 {
    let mut bits = (x as u64) << 40 ^ (y as u64) << 16 ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for _ in 0..3 {
        bits = (bits ^ bits >> 31).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    }
    (bits >> 40) as f32 / (1u64 << 23) as f32 - 1.0
}

/// An image of 8-bit pixels, from values in 0 ..= 1.
fn bytes<const N: usize>(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [f32; N]) -> Image {
    let values = (0..width * height).flat_map(|i| pixel(i % width, i / width));
    let samples = values.map(|value| (value * 255.0).round().clamp(0.0, 255.0) as u8).collect();
    Image::new(width, height, N, Samples::U8(samples)).unwrap()
}

fn floats<const N: usize>(pixel: impl Fn(usize, usize) -> [f32; N]) -> Image {
    let samples = (0..SIZE * SIZE).flat_map(|i| pixel(i % SIZE, i / SIZE)).collect();
    Image::new(SIZE, SIZE, N, Samples::F32(samples)).unwrap()
}

/// Slopes of crossing waves, y up.
fn wave_slope(x: usize, y: usize) -> [f32; 2] {
    let (x, y) = (x as f32, -(y as f32));
    // The height is sin(a) + sin(b); its slope is minus its gradient.
    let (a, b) = (0.3 * x + 0.2 * y, 0.15 * x - 0.35 * y);
    [-(0.3 * a.cos() + 0.15 * b.cos()), -(0.2 * a.cos() - 0.35 * b.cos())]
}

fn wave_normal(x: usize, y: usize) -> [f32; 3] {
    let [bx, by] = wave_slope(x, y);
    let z = 1.0 / (1.0 + bx * bx + by * by).sqrt();
    [bx * z, by * z, z]
}

fn stored(component: f32) -> f32 {
    (component + 1.0) / 2.0
}

fn guess(image: &Image, channels: &[&str]) -> KindGuess {
    guess_kind(image, channels, guess_range(image))
}

/// The reason for a doubtful guess.
fn doubt(image: &Image, channels: &[&str]) -> String {
    match guess(image, channels) {
        KindGuess::Doubtful { reason } => reason,
        certain => panic!("{certain:?}"),
    }
}

#[test]
fn the_number_of_channels_decides_where_it_can() {
    let grey = bytes(SIZE, SIZE, |x, y| [stored(noise(x, y, 1))]);
    assert_eq!(guess(&grey, &["Y"]), HEIGHT);
    let with_alpha = bytes(SIZE, SIZE, |x, y| [stored(noise(x, y, 1)), stored(noise(x, y, 2))]);
    assert_eq!(guess(&with_alpha, &["Y", "A"]), HEIGHT);
    assert_eq!(guess(&with_alpha, &["layer.Y", "layer.A"]), HEIGHT);

    let two = bytes(SIZE, SIZE, |x, y| [0, 1].map(|c| stored(wave_normal(x, y)[c])));
    assert_eq!(guess(&two, &["R", "G"]), NORMAL);
    assert_eq!(guess_channels(&two, &["R", "G"], NormalRange::Unorm), NormalChannels::Xy);
    let bright = bytes(SIZE, SIZE, |x, y| [1.0, stored(noise(x, y, 3))]);
    assert!(doubt(&bright, &["R", "G"]).contains("x^2 + y^2"));

    let six = floats(|x, y| [noise(x, y, 4); 6]);
    assert!(doubt(&six, &["b0_h", "b1_dhds", "b2_dhdt", "b3", "b4", "b5"]).contains("6 channels"));
}

#[test]
fn grey_is_a_height_in_three_channels_too() {
    // Within 3/255 of each other: grey after lossy compression.
    let grey = bytes(SIZE, SIZE, |x, y| {
        [1, 2, 3].map(|seed| 0.5 + 0.4 * noise(x / 8, y / 8, 0) + noise(x, y, seed) * 1.5 / 255.0)
    });
    assert_eq!(guess(&grey, &RGB), HEIGHT);
    // Brown, so dark that its channels are as close to each other as those of a noisy grey.
    let brown = bytes(SIZE, SIZE, |x, y| {
        let shade = 0.06 + 0.03 * noise(x / 4, y / 4, 0);
        [shade, 0.7 * shade, 0.5 * shade]
    });
    assert!(doubt(&brown, &RGB).contains("not grey"));
    // Terrain in metres.
    let metres = floats(|x, y| [1500.0 + 900.0 * noise(x / 8, y / 8, 5); 3]);
    assert_eq!(guess(&metres, &RGB), HEIGHT);
}

#[test]
fn one_colour_all_over_is_judged_by_the_colour() {
    let constant = |r: u8, g: u8, b: u8| bytes(16, 16, |_, _| [r, g, b].map(|v| f32::from(v) / 255.0));
    for (r, g, b) in [(128, 128, 255), (127, 127, 255), (127, 128, 254), (128, 128, 253)] {
        assert_eq!(guess(&constant(r, g, b), &RGB), NORMAL, "{r}, {g}, {b}");
        assert_eq!(guess_channels(&constant(r, g, b), &RGB, NormalRange::Unorm), NormalChannels::Xyz);
    }
    for grey in [0, 1, 127, 128, 255] {
        assert_eq!(guess(&constant(grey, grey, grey), &RGB), HEIGHT, "{grey}");
    }
    for (r, g, b) in [(200, 30, 40), (128, 128, 0), (0, 0, 255), (160, 128, 255), (128, 128, 200)] {
        assert!(doubt(&constant(r, g, b), &RGB).contains("one colour"), "{r}, {g}, {b}");
    }
    assert_eq!(guess(&bytes(1, 1, |_, _| [0.5, 0.5, 1.0]), &RGB), NORMAL);
}

#[test]
fn three_components_are_found_in_each_range() {
    let unorm = bytes(SIZE, SIZE, |x, y| wave_normal(x, y).map(stored));
    assert_eq!(guess(&unorm, &RGB), NORMAL);
    assert_eq!(guess_channels(&unorm, &RGB, NormalRange::Unorm), NormalChannels::Xyz);
    let packed = bytes(SIZE, SIZE, |x, y| {
        let [r, g, b] = wave_normal(x, y).map(stored);
        [r, g, b, stored(noise(x, y, 6))]
    });
    assert_eq!(guess(&packed, &RGBA), NORMAL);

    let signed = floats(wave_normal);
    assert_eq!(guess_range(&signed), NormalRange::Signed);
    assert_eq!(guess(&signed, &RGB), NORMAL);
    assert_eq!(guess_range(&floats(|x, y| wave_normal(x, y).map(stored))), NormalRange::Unorm);
    // Flat: no negative value reveals that the map is signed.
    assert_eq!(guess_range(&floats(|_, _| [0.0, 0.0, 1.0])), NormalRange::Signed);
    assert_eq!(guess_range(&floats(|_, _| [0.5, 0.5, 1.0])), NormalRange::Unorm);
    assert_eq!(guess_range(&floats(|x, y| [wave_normal(x, y)[0], 0.0])), NormalRange::Signed);
    assert_eq!(guess_range(&floats(|x, y| [0, 1].map(|c| stored(wave_normal(x, y)[c])))), NormalRange::Unorm);
}

#[test]
fn inward_vectors_are_not_tangent_space_normals() {
    // A sphere's normals over the whole map.
    let object_space = bytes(SIZE, SIZE, |x, y| {
        let (longitude, z) = (x as f32 * 0.13, 1.0 - 2.0 * y as f32 / SIZE as f32);
        let radius = (1.0 - z * z).sqrt();
        [radius * longitude.cos(), radius * longitude.sin(), z].map(stored)
    });
    assert!(doubt(&object_space, &RGB).contains("object-space"));
}

#[test]
fn a_blue_picture_of_about_unit_length_is_doubtful() {
    let sky = bytes(SIZE, SIZE, |x, y| {
        let shade = 0.05 * noise(x / 16, y / 16, 7);
        [0.25 + shade, 0.55 + shade, 0.9 + shade]
    });
    assert!(doubt(&sky, &RGB).contains("not grey"));
}

#[test]
fn x_and_y_are_found_beside_a_constant_blue() {
    for blue in [0.0, 128.0 / 255.0, 1.0] {
        let image = bytes(SIZE, SIZE, |x, y| {
            let [nx, ny, _] = wave_normal(x, y);
            [stored(nx), stored(ny), blue]
        });
        assert_eq!(guess(&image, &RGB), NORMAL, "blue {blue}");
        assert_eq!(guess_channels(&image, &RGB, NormalRange::Unorm), NormalChannels::Xy, "blue {blue}");
        // The same values, but not the slopes of any surface.
        let shuffled =
            bytes(SIZE, SIZE, |x, y| [0.5 + 0.3 * noise(x, y, 8), 0.5 + 0.3 * noise(x, y, 9), blue]);
        assert!(doubt(&shuffled, &RGB).contains("slopes of a surface"), "blue {blue}");
    }
    // Occlusion, roughness and zero metalness.
    let orm =
        bytes(SIZE, SIZE, |x, y| [0.95 + 0.05 * noise(x, y, 10), 0.6 + 0.3 * noise(x / 4, y / 4, 11), 0.0]);
    assert!(doubt(&orm, &RGB).contains("not grey"));
}

#[test]
fn blue_that_is_z_itself_is_found() {
    let image = bytes(SIZE, SIZE, |x, y| {
        let [nx, ny, nz] = wave_normal(x, y);
        [stored(nx), stored(ny), nz]
    });
    assert_eq!(guess(&image, &RGB), NORMAL);
    assert_eq!(guess_channels(&image, &RGB, NormalRange::Unorm), NormalChannels::Xy);
}

#[test]
fn x_in_alpha_is_found() {
    let image = bytes(SIZE, SIZE, |x, y| {
        let [nx, ny, _] = wave_normal(x, y);
        [1.0, stored(ny), 0.0, stored(nx)]
    });
    assert_eq!(guess(&image, &RGBA), NORMAL);
    assert_eq!(guess_channels(&image, &RGBA, NormalRange::Unorm), NormalChannels::Ag);
    let shuffled = bytes(SIZE, SIZE, |x, y| [1.0, stored(noise(x, y, 16)), 0.0, stored(noise(x, y, 17))]);
    assert!(doubt(&shuffled, &RGBA).contains("slopes of a surface"));
}

#[test]
fn non_finite_values_are_ignored() {
    let sparse = floats(|x, y| if x % 7 == 0 { [f32::NAN, f32::INFINITY, 0.0] } else { wave_normal(x, y) });
    assert_eq!(guess(&sparse, &RGB), NORMAL);
    let none = floats(|_, _| [f32::NAN; 3]);
    assert!(doubt(&none, &RGB).contains("finite"));
    assert!(doubt(&floats(|_, _| [f32::NAN; 2]), &["R", "G"]).contains("finite"));
}

#[test]
fn large_and_narrow_maps_are_sampled() {
    for (width, height) in [(2048, 1025), (1, 3_000_000), (3_000_000, 1)] {
        let image = bytes(width, height, |x, y| wave_normal(x, y).map(stored));
        assert_eq!(guess(&image, &RGB), NORMAL, "{width}x{height}");
    }
}

/// Planar slopes of a `width` x `height` map.
fn planes(width: usize, height: usize, slope: impl Fn(usize, usize) -> [f32; 2]) -> (Vec<f32>, Vec<f32>) {
    (0..width * height).map(|i| slope(i % width, i / width).into()).unzip()
}

fn correlation(width: usize, height: usize, slope: impl Fn(usize, usize) -> [f32; 2]) -> Option<f64> {
    let (bx, by) = planes(width, height, slope);
    test_green(&bx, &by, width, height).map(|test| test.correlation)
}

fn verdict(width: usize, height: usize, slope: impl Fn(usize, usize) -> [f32; 2]) -> Option<GreenVerdict> {
    let (bx, by) = planes(width, height, slope);
    test_green(&bx, &by, width, height).map(|test| test.verdict())
}

/// Central differences of a sinusoid of frequency w are smaller than its derivative by the factor sin(w)/w, which
/// differs by at most 2 % between the two axes of the waves: their products differ from their energies by at most this.
const WAVE_TOLERANCE: f64 = 1e-2;

#[test]
fn a_surface_without_noise_correlates_fully() {
    let up = correlation(SIZE, SIZE, wave_slope).expect("there is signal");
    assert!((1.0 - WAVE_TOLERANCE..=1.0).contains(&up), "{up}");
    let down = correlation(SIZE, SIZE, |x, y| [wave_slope(x, y)[0], -wave_slope(x, y)[1]]);
    assert_eq!(down, Some(-up), "flipping green changes the sign and nothing else");
    assert_eq!(verdict(3000, 1100, wave_slope), Some(GreenVerdict::Up), "sampled");
}

#[test]
fn outliers_do_not_outvote_a_surface() {
    // One texel in 200 is near the horizon, in various directions; some are broken.
    let spoilt = |x: usize, y: usize| {
        if noise(x, y, 12) > 0.99 {
            [100.0 * noise(x, y, 13), 100.0 * noise(x, y, 14)]
        } else if noise(x, y, 15) > 0.99 {
            [f32::NAN, f32::INFINITY]
        } else {
            wave_slope(x, y).map(|slope| 0.3 * slope)
        }
    };
    assert_eq!(verdict(256, 256, spoilt), Some(GreenVerdict::Up));
    assert_eq!(verdict(256, 256, |x, y| [spoilt(x, y)[0], -spoilt(x, y)[1]]), Some(GreenVerdict::Down));
}

#[test]
fn unrelated_slopes_are_undecided() {
    for (seed, size) in (0..200).zip([16, 24, 64, 200].into_iter().cycle()) {
        let white = |x, y| [noise(x, y, 2 * seed), noise(x, y, 2 * seed + 1)];
        assert_eq!(verdict(size, size, white), Some(GreenVerdict::Undecided), "seed {seed}, size {size}");
        // Smoothed over 3 texels, so that neighbours are not independent.
        let smooth = |x: usize, y: usize| {
            let around = (0..9).map(|i| white(x + i % 3, y + i / 3));
            around.fold([0.0, 0.0], |sum: [f32; 2], slope| [sum[0] + slope[0], sum[1] + slope[1]])
        };
        let wide = size.max(32);
        assert_eq!(
            verdict(wide, wide, smooth),
            Some(GreenVerdict::Undecided),
            "seed {seed}, size {wide}, smooth"
        );
    }
}

#[test]
fn too_little_signal_gives_no_answer() {
    assert_eq!(correlation(SIZE, SIZE, |_, _| [0.0, 0.0]), None, "flat");
    assert_eq!(correlation(SIZE, SIZE, |_, _| [0.3, -0.2]), None, "tilted, but plane");
    assert_eq!(correlation(SIZE, SIZE, |_, _| [f32::NAN, 0.0]), None, "nothing finite");
    for (width, height) in [(1, 1), (1, 500), (500, 1), (2, 500), (500, 2), (8, 8)] {
        assert_eq!(correlation(width, height, wave_slope), None, "{width}x{height}");
    }
}
