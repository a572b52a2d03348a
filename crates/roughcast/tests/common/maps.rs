//! Synthetic maps: slopes and heights in f64, and all ways to store them.

use half::f16;
use roughcast::texture::RoughnessStored;
use roughcast::{
    Green, HeightSense, Image, Kind, NormalChannels, NormalRange, Red, SampleType, Samples, SourceOptions,
};

/// Sizes that exercise every path: single lines, odd and even sizes, one and several tiles and bands of the fused pass,
/// sizes that halve evenly for a few levels and then do not.
pub const SIZES: [(usize, usize); 11] = [
    (1, 1),
    (1, 7),
    (7, 1),
    (53, 37),
    (64, 64),
    (96, 40),
    (128, 64),
    (640, 427),
    (130, 66),
    (1024, 8),
    (1088, 192),
];

/// Pseudo-random numbers (splitmix64), identical on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0 .. 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number in -1 .. 1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}

/// Slopes up to about 1.4, row by row: waves and noise, steeper along x than along y, with a nonzero mean and a
/// correlation, so that all five moments are different.
pub fn slopes(width: usize, height: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random(seed);
    let mut slopes = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = (x as f64, y as f64);
            let wave = (0.37 * u + 0.11 * v).sin();
            let ripple = (0.05 * u - 0.83 * v).cos();
            let bx = 0.15 + 0.7 * wave + 0.35 * random.signed();
            let by = -0.1 + 0.3 * ripple + 0.25 * wave + 0.2 * random.signed();
            slopes.push([bx, by]);
        }
    }
    slopes
}

/// Heights in 0 ..= 1: hills and noise.
pub fn heights(width: usize, height: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let mut heights = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = (x as f64, y as f64);
            let hills = 0.5 + 0.25 * (0.21 * u + 0.4 * v).sin() + 0.15 * (0.6 * u - 0.1 * v).cos();
            heights.push((hills + 0.1 * random.signed()).clamp(0.0, 1.0));
        }
    }
    heights
}

/// Samples of a type; unsigned types represent 0 ..= 1.
pub fn samples(values: &[f64], sample_type: SampleType) -> Samples {
    match sample_type {
        SampleType::U8 => Samples::U8(values.iter().map(|v| (v * 255.0).round() as u8).collect()),
        SampleType::U16 => Samples::U16(values.iter().map(|v| (v * 65535.0).round() as u16).collect()),
        SampleType::F16 => Samples::F16(values.iter().map(|v| f16::from_f64(*v)).collect()),
        SampleType::F32 => Samples::F32(values.iter().map(|v| *v as f32).collect()),
    }
}

pub fn image(width: usize, height: usize, channels: usize, samples: Samples) -> Image {
    Image::new(width, height, channels, samples).expect("the samples fit the size")
}

/// A height map with its options.
pub fn height_map(width: usize, height: usize, sample_type: SampleType, seed: u64) -> (Image, SourceOptions) {
    let values = heights(width, height, seed);
    let options = SourceOptions::default().with_kind(Kind::Height).with_height_sense(HeightSense::WhiteHigh);
    (image(width, height, 1, samples(&values, sample_type)), options)
}

/// Slopes stored as the vectors (b.x, b.y, 1) in signed single floats, which level 0 reads back exactly.
pub fn slope_map(width: usize, height: usize, slopes: &[[f64; 2]]) -> (Image, SourceOptions) {
    let values: Vec<f64> = slopes.iter().flat_map(|[x, y]| [*x, *y, 1.0]).collect();
    let options = SourceOptions::default().with_range(NormalRange::Signed);
    (image(width, height, 3, samples(&values, SampleType::F32)), options)
}

/// Unit normals of slopes, stored as the options specify, in `channels` channels. Unused channels contain junk.
pub fn normal_map(
    size: (usize, usize),
    slopes: &[[f64; 2]],
    sample_type: SampleType,
    options: &SourceOptions,
    channels: usize,
) -> Image {
    /// Junk that would be noticed if it were read.
    const JUNK: f64 = 0.77;
    let mut values = vec![JUNK; slopes.len() * channels];
    for (texel, [x, y]) in values.chunks_exact_mut(channels).zip(slopes) {
        let length = (1.0 + x * x + y * y).sqrt();
        let y = if options.green == Green::Down { -y } else { *y };
        let x = if options.red == Red::Left { -x } else { *x };
        let stored = |component: f64| match options.range {
            NormalRange::Signed => component / length,
            NormalRange::Unorm => 0.5 * component / length + 0.5,
        };
        let (x_at, y_at, z_at) = match options.normal_channels {
            NormalChannels::Xyz => (0, 1, Some(2)),
            NormalChannels::Xy => (0, 1, None),
            NormalChannels::Yx => (1, 0, None),
            NormalChannels::Ag => (3, 1, None),
            NormalChannels::Ra => (0, 3, None),
            other => panic!("say where {other} has its components"),
        };
        texel[x_at] = stored(x);
        texel[y_at] = stored(y);
        if let Some(z_at) = z_at {
            texel[z_at] = stored(1.0);
        }
    }
    image(size.0, size.1, channels, samples(&values, sample_type))
}

/// An 8-bit OpenGL normal map of [`slopes`], the most common kind.
pub fn plain_normal_map(width: usize, height: usize, seed: u64) -> (Image, SourceOptions) {
    let options = SourceOptions::default();
    let map = normal_map((width, height), &slopes(width, height, seed), SampleType::U8, &options, 3);
    (map, options)
}

/// Slopes small enough that no roughness exceeds 1, the largest that the stored forms can represent.
pub fn gentle_map(width: usize, height: usize) -> (Image, SourceOptions) {
    let slopes: Vec<[f64; 2]> = slopes(width, height, 31).into_iter().map(|b| b.map(|v| 0.5 * v)).collect();
    slope_map(width, height, &slopes)
}

/// A packed material texture: occlusion, perceptual roughness, metalness.
pub fn material_map(width: usize, height: usize) -> Image {
    let heights = heights(width, height, 32);
    let values: Vec<f64> = heights.iter().flat_map(|h| [1.0 - 0.5 * h, 0.2 + 0.4 * h, h * h]).collect();
    image(width, height, 3, samples(&values, SampleType::U8))
}

/// Slope variances of a roughness map, computed from the table of conventions.
pub fn variances(image: &Image, channel: usize, stored: RoughnessStored) -> Vec<f64> {
    let variance = |r: f64| match stored {
        RoughnessStored::Perceptual => r.powi(4) / 2.0,
        RoughnessStored::Alpha => r * r / 2.0,
        RoughnessStored::AlphaSquared => r / 2.0,
        RoughnessStored::Gloss => (1.0 - r).powi(4) / 2.0,
        RoughnessStored::SpecularPower => 1.0 / r,
        other => panic!("say what {other} means"),
    };
    super::level::channel_of(image, channel).values.into_iter().map(variance).collect()
}
