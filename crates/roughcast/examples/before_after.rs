//! A receding plane of shiny rock under a low sun, rendered three times side by side: with mip-mapped normals, with
//! LEAN mapping, and as it should look, by brute force. Writes the picture of the README and prints how far the first two
//! are from the third.
//!
//! ```sh
//! cargo run --release --example before_after [-- OUTPUT.png]
//! ```
//!
//! Everything is in the map's own frame: x to the right of the map, y up the map, z out of the plane. The eye is one unit
//! above the origin. Radiance is the density of facets that mirror the sun into the eye, `D(h)` with h half-way between the two;
//! Fresnel and shadowing are the same for all three pictures and are left out.

use rayon::prelude::*;
use roughcast::texture::{MomentLevel, decode};
use roughcast::{BakeOptions, Image, Moments, Samples, Slope, SourceOptions, bake, normal_from_slope};

/// Pixels of one of the three pictures.
const WIDTH: usize = 320;
const HEIGHT: usize = 320;
/// Slope of the view ray at the top and at the bottom row: the horizon lies just above the picture.
const TOP: f32 = 0.008;
const BOTTOM: f32 = 0.4;
/// Texels of the map to a unit of the plane; at the bottom row a pixel is about a texel.
const TEXELS_PER_UNIT: f32 = 400.0;
/// The way the eye looks, as an angle from the map's y: turned, so that the repeats of the map do not line up.
const HEADING: f32 = 0.55;
/// Tangent of the sun's elevation. It stands straight ahead.
const SUN: f32 = 0.25;
/// Blinn-Phong exponent of the rock itself.
const SHININESS: f32 = 100.0;
/// Exposure of the picture.
const EXPOSURE: f32 = 0.15;
/// Rays through a pixel, each way, for the truth: enough for the pixels below the horizon, which see thousands of texels.
const RAYS: usize = 48;
/// Most taps of a texture along a slanted footprint, as graphics hardware limits its anisotropic filter.
const MAX_TAPS: f32 = 16.0;

type Vec2 = [f32; 2];
type Vec3 = [f32; 3];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let output = std::env::args().nth(1).unwrap_or_else(|| format!("{root}/docs/before_after.png"));
    let map = image::open(format!("{root}/examples/rock_normal.png"))?.into_rgb8();
    let (width, height) = (map.width() as usize, map.height() as usize);
    let map = Image::new(width, height, 3, Samples::U8(map.into_raw()))?;

    // What `roughcast bake rock_normal.png` does, and what a renderer reads back: 16-bit texels.
    let baked = bake(&map, &SourceOptions::default(), None, &BakeOptions::default())?;
    let lean: Vec<Level<5>> = decode(&baked.arrays)?.iter().map(level_of_moments).collect();
    let normals = normal_mips(&lean[0]);

    let before = render(|pixel| {
        let normal: Vec3 = filtered(&normals, &Footprint::of(pixel));
        blinn_phong(normalize(normal), half_vector(pixel))
    });
    let after = render(|pixel| {
        let [x, y, xx, yy, xy] = filtered(&lean, &Footprint::of(pixel));
        lean_lobe(Moments { mean: Slope { x, y }, xx, yy, xy }, half_vector(pixel))
    });
    let truth = render(|pixel| mean_of_rays(&normals[0], pixel));

    println!("{:<8}{:>16}{:>20}{:>26}", "", "mean radiance", "RMSE (radiance)", "RMSE (as shown, of 255)");
    for (name, picture) in [("before", &before), ("after", &after), ("truth", &truth)] {
        let (radiance, seen) = (rmse(picture, &truth, |v| v), 255.0 * rmse(picture, &truth, shown));
        println!("{name:<8}{:>16.3}{radiance:>20.3}{seen:>26.1}", mean(picture));
    }
    save(&output, &[before, after, truth])?;
    Ok(())
}

// ---- shading -------------------------------------------------------------------------------------------------------

/// Density of the microfacets of one bump facet that face `half`, per area of the plane: the normalised Blinn-Phong lobe
/// about the facet's normal, times the facet's area, which is `1 / normal.z`.
fn blinn_phong(normal: Vec3, half: Vec3) -> f32 {
    (SHININESS + 2.0) / std::f32::consts::TAU * dot(normal, half).max(0.0).powf(SHININESS) / normal[2]
}

/// The same for all facets under a footprint at once: a Gaussian of slopes with the moments' mean and covariance, widened
/// by the rock's own 1/s (LEAN mapping, Eq. 1, 5 and 6; over directions, hence `h.z⁴`).
fn lean_lobe(moments: Moments, half: Vec3) -> f32 {
    let bumps = moments.covariance();
    let (xx, yy, xy) = (bumps.xx + 1.0 / SHININESS, bumps.yy + 1.0 / SHININESS, bumps.xy);
    let determinant = xx * yy - xy * xy;
    let (x, y) = (half[0] / half[2] - moments.mean.x, half[1] / half[2] - moments.mean.y);
    let squared = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
    (-0.5 * squared).exp() / (std::f32::consts::TAU * determinant.sqrt()) / half[2].powi(4)
}

/// The truth: the mean over many rays of what each sees of level 0.
fn mean_of_rays(normals: &Level<3>, pixel: Vec2) -> f32 {
    let mut sum = 0.0;
    for index in 0..RAYS * RAYS {
        let cell = [(index % RAYS) as f32, (index / RAYS) as f32];
        // Each ray at a random place of its cell, so that rays do not beat with the repeating map.
        let [jitter_x, jitter_y] = random(pixel, index);
        let at = [
            pixel[0] - 0.5 + (cell[0] + jitter_x) / RAYS as f32,
            pixel[1] - 0.5 + (cell[1] + jitter_y) / RAYS as f32,
        ];
        let normal = normalize(normals.bilinear(texel_of(at), 1.0));
        sum += blinn_phong(normal, half_vector(at));
    }
    sum / (RAYS * RAYS) as f32
}

// ---- camera and sun ------------------------------------------------------------------------------------------------

/// Slopes of the view ray through a pixel: to the right, and down.
fn ray(pixel: Vec2) -> Vec2 {
    let across = (BOTTOM - TOP) / HEIGHT as f32;
    [(pixel[0] - WIDTH as f32 / 2.0) * across, TOP + pixel[1] * across]
}

/// Where a pixel's ray meets the plane, in texels of the map. Rows of the map grow downwards, against y.
fn texel_of(pixel: Vec2) -> Vec2 {
    let [right, down] = ray(pixel);
    let [x, y] = turned([right / down, 1.0 / down]);
    [TEXELS_PER_UNIT * x, -TEXELS_PER_UNIT * y]
}

fn half_vector(pixel: Vec2) -> Vec3 {
    let [right, down] = ray(pixel);
    let (eye, sun) = (normalize([-right, -1.0, down]), normalize([0.0, 1.0, SUN]));
    let [x, y] = turned([eye[0] + sun[0], eye[1] + sun[1]]);
    normalize([x, y, eye[2] + sun[2]])
}

/// From right and ahead to x and y.
fn turned([right, ahead]: Vec2) -> Vec2 {
    let (sin, cos) = HEADING.sin_cos();
    [cos * right + sin * ahead, cos * ahead - sin * right]
}

fn render(radiance: impl Fn(Vec2) -> f32 + Sync) -> Vec<f32> {
    let pixels = (0..WIDTH * HEIGHT).into_par_iter();
    pixels.map(|i| radiance([(i % WIDTH) as f32 + 0.5, (i / WIDTH) as f32 + 0.5])).collect()
}

// ---- textures ------------------------------------------------------------------------------------------------------

/// One level of a texture with N channels.
struct Level<const N: usize> {
    width: usize,
    height: usize,
    texels: Vec<[f32; N]>,
}

/// The five numbers that a shader reads from LEAN's two textures, beside the normal.
fn level_of_moments(level: &MomentLevel) -> Level<5> {
    let texels = level.moments.iter().map(|m| [m.mean.x, m.mean.y, m.xx, m.yy, m.xy]).collect();
    Level { width: level.width, height: level.height, texels }
}

/// What is usual: each level the average of the normals of the one before, back at unit length.
fn normal_mips(slopes: &Level<5>) -> Vec<Level<3>> {
    let normal = |[x, y, ..]: &[f32; 5]| {
        let n = normal_from_slope(Slope { x: *x, y: *y });
        [n.x, n.y, n.z]
    };
    let texels = slopes.texels.iter().map(normal).collect();
    let mut levels = vec![Level { width: slopes.width, height: slopes.height, texels }];
    while let Some(finer) = levels.last().filter(|level| level.width > 1 && level.height > 1) {
        let (width, height) = (finer.width / 2, finer.height / 2);
        // Half-way between four texels, bilinear interpolation is their average.
        let corner = |i: usize| [2.0 * (i % width) as f32 + 1.0, 2.0 * (i / width) as f32 + 1.0];
        let texels = (0..width * height).map(|i| normalize(finer.bilinear(corner(i), 1.0))).collect();
        levels.push(Level { width, height, texels });
    }
    levels
}

impl<const N: usize> Level<N> {
    /// The texture, repeated, at a place in texels of level 0, of which one of this level has `texel_size`.
    fn bilinear(&self, at: Vec2, texel_size: f32) -> [f32; N] {
        let [x, y] = at.map(|v| v / texel_size - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - top);
        let texel = |dx: i64, dy: i64| {
            let column = (left as i64 + dx).rem_euclid(self.width as i64) as usize;
            let row = (top as i64 + dy).rem_euclid(self.height as i64) as usize;
            &self.texels[row * self.width + column]
        };
        let (a, b, c, d) = (texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1));
        std::array::from_fn(|i| (1.0 - t) * ((1.0 - s) * a[i] + s * b[i]) + t * ((1.0 - s) * c[i] + s * d[i]))
    }
}

/// What a pixel sees of the map: an ellipse, in texels of level 0.
struct Footprint {
    centre: Vec2,
    long_axis: Vec2,
    level: f32,
    taps: f32,
}

impl Footprint {
    fn of(pixel: Vec2) -> Self {
        let [x, y] = pixel;
        let centre = texel_of(pixel);
        let step = |at: Vec2, before: Vec2| {
            let (at, before) = (texel_of(at), texel_of(before));
            [at[0] - before[0], at[1] - before[1]]
        };
        let (across, down) = (step([x + 0.5, y], [x - 0.5, y]), step([x, y + 0.5], [x, y - 0.5]));
        let length = |axis: Vec2| axis[0].hypot(axis[1]);
        let (long_axis, short) =
            if length(across) > length(down) { (across, length(down)) } else { (down, length(across)) };
        let taps = (length(long_axis) / short).ceil().clamp(1.0, MAX_TAPS);
        Self { centre, long_axis, level: (length(long_axis) / taps).log2().max(0.0), taps }
    }
}

/// Trilinear look-ups, averaged along the long axis of the footprint: what graphics hardware does.
fn filtered<const N: usize>(levels: &[Level<N>], footprint: &Footprint) -> [f32; N] {
    let last = levels.len() - 1;
    let finer = (footprint.level as usize).min(last);
    let coarser = (finer + 1).min(last);
    let blend = footprint.level.min(last as f32) - finer as f32;
    let mut sum = [0.0; N];
    for tap in 0..footprint.taps as usize {
        let along = (tap as f32 + 0.5) / footprint.taps - 0.5;
        let at = [0, 1].map(|i| footprint.centre[i] + along * footprint.long_axis[i]);
        let (a, b) = (
            levels[finer].bilinear(at, (1 << finer) as f32),
            levels[coarser].bilinear(at, (1 << coarser) as f32),
        );
        for i in 0..N {
            sum[i] += ((1.0 - blend) * a[i] + blend * b[i]) / footprint.taps;
        }
    }
    sum
}

// ---- pictures and small things -------------------------------------------------------------------------------------

/// Radiance as a display shows it, 0 to 1: exposed as by film, so that highlights are not cut off, then sRGB.
fn shown(radiance: f32) -> f32 {
    let v = 1.0 - (-EXPOSURE * radiance).exp();
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

fn save(path: &str, pictures: &[Vec<f32>]) -> image::ImageResult<()> {
    const GAP: usize = 8;
    let width = pictures.len() * (WIDTH + GAP) - GAP;
    let mut all = image::GrayImage::from_pixel(width as u32, HEIGHT as u32, image::Luma([255]));
    for (number, picture) in pictures.iter().enumerate() {
        for (i, radiance) in picture.iter().enumerate() {
            let (x, y) = (number * (WIDTH + GAP) + i % WIDTH, i / WIDTH);
            all[(x as u32, y as u32)].0 = [(255.0 * shown(*radiance)).round() as u8];
        }
    }
    all.save(path)
}

fn mean(picture: &[f32]) -> f32 {
    picture.iter().sum::<f32>() / picture.len() as f32
}

fn rmse(picture: &[f32], truth: &[f32], scale: impl Fn(f32) -> f32) -> f64 {
    let squares = picture.iter().zip(truth).map(|(a, b)| f64::from(scale(*a) - scale(*b)).powi(2));
    (squares.sum::<f64>() / truth.len() as f64).sqrt()
}

/// Two numbers from 0 to 1 that depend on the pixel and the ray alone, so that every run gives the same picture.
fn random(pixel: Vec2, index: usize) -> Vec2 {
    let mut state = (pixel[1] as u64 * WIDTH as u64 + pixel[0] as u64) << 20 | index as u64;
    [0, 1].map(|_| {
        // SplitMix64, by Sebastiano Vigna.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    })
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normalize(v: Vec3) -> Vec3 {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}
