//! Maps to bake: synthetic ones with every special case, and real ones.

use half::f16;
use roughcast::{Image, SampleType, Samples};

/// A small generator of uniformly distributed numbers in 0 .. 1 (Knuth's MMIX), the same on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }
}

/// Unit normals over smooth bumps with added noise; a few are bad: horizontal, backwards or zero.
pub fn normals(width: usize, height: usize, channels: usize, sample_type: SampleType) -> Image {
    let mut random = Random((width * 7919 + height) as u64);
    let mut values = Vec::with_capacity(width * height * channels);
    for i in 0..width * height {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        let slope_x = 1.5 * (0.3 * x).sin() + random.next() - 0.5;
        let slope_y = (0.2 * y + 0.1 * x).cos() + random.next() - 0.5;
        let z = 1.0 / (1.0 + slope_x * slope_x + slope_y * slope_y).sqrt();
        let mut normal = [slope_x * z, slope_y * z, z, 1.0];
        match (i.wrapping_mul(2_654_435_761) >> 8) % 97 {
            0 => normal[2] = -normal[2],
            1 => normal[2] = 1e-3,
            2 => normal = [0.0, 0.0, -1.0, 1.0],
            _ => {}
        }
        values.extend((0..channels).map(|c| 0.5 * normal[c] + 0.5));
    }
    image(width, height, channels, sample_type, &values)
}

/// Waves and steps with added noise, 0 ..= 1.
pub fn heights(width: usize, height: usize, sample_type: SampleType) -> Image {
    let mut random = Random((width * 31 + height) as u64);
    let value = |i: usize| {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        let step = if ((i % width) / 9).is_multiple_of(2) { 0.1 } else { 0.0 };
        0.4 + 0.2 * (0.4 * x + 0.1 * y).sin() + 0.1 * (0.3 * y).cos() + step + 0.05 * random.next()
    };
    let values: Vec<f32> = (0..width * height).map(value).collect();
    image(width, height, 1, sample_type, &values)
}

pub fn image(width: usize, height: usize, channels: usize, sample_type: SampleType, values: &[f32]) -> Image {
    let samples = match sample_type {
        SampleType::U8 => Samples::U8(values.iter().map(|v| (v * 255.0).round() as u8).collect()),
        SampleType::U16 => Samples::U16(values.iter().map(|v| (v * 65535.0).round() as u16).collect()),
        SampleType::F16 => Samples::F16(values.iter().map(|v| f16::from_f32(*v)).collect()),
        SampleType::F32 => Samples::F32(values.to_vec()),
    };
    Image::new(width, height, channels, samples).expect("as many values as texels")
}

/// A part of a real map of the test data.
pub fn real(path: &str, width: usize, height: usize) -> Image {
    let full = roughcast_testdata::find(path);
    let bytes = std::fs::read(&full).unwrap_or_else(|error| panic!("{}: {error}", full.display()));
    let extension = full.extension().and_then(|extension| extension.to_str());
    let whole = roughcast_io::read_image(&bytes, extension, &Default::default())
        .unwrap_or_else(|error| panic!("{}: {error}", full.display()))
        .image;
    let (width, height) = (width.min(whole.width()), height.min(whole.height()));
    let channels = whole.channels();
    let row = whole.width() * channels;
    let rows = || (0..height).map(|y| y * row..y * row + width * channels);
    let samples = match whole.samples() {
        Samples::U8(v) => Samples::U8(rows().flat_map(|r| &v[r]).copied().collect()),
        Samples::U16(v) => Samples::U16(rows().flat_map(|r| &v[r]).copied().collect()),
        Samples::F16(v) => Samples::F16(rows().flat_map(|r| &v[r]).copied().collect()),
        Samples::F32(v) => Samples::F32(rows().flat_map(|r| &v[r]).copied().collect()),
    };
    Image::new(width, height, channels, samples).expect("the rows are as long as they are many")
}
