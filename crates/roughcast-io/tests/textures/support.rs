//! Helpers that several of these tests share.

use half::f16;
use roughcast::texture::{Layout, Part, Texture, TextureArray, TextureInfo};
use roughcast::{Image, SampleType, Samples};
use roughcast_io::{Decoded, Limits, Payload, ReadError, Supercompression};
use roughcast_testdata::{files_in, find};

pub fn bytes_of(path: &str) -> Vec<u8> {
    let path = find(path);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Sorted names of the files in a folder of the test data; at least one.
pub fn names_in(folder: &str) -> Vec<String> {
    let name = |path: String| path.rsplit('/').next().expect("a name").to_owned();
    files_in(folder).into_iter().map(name).collect()
}

/// Reads an image in the format that its extension names.
pub fn read_image(path: &str) -> Result<Decoded, ReadError> {
    let bytes = bytes_of(path);
    if path.to_lowercase().ends_with(".dds") {
        roughcast_io::dds::read_image(&bytes, &Limits::default())
    } else {
        roughcast_io::ktx2::read_image(&bytes, &Limits::default())
    }
}

pub fn decoded(path: &str) -> Decoded {
    read_image(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A generator that gives the same numbers on every machine (Marsaglia's xorshift).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }
}

/// Samples of arbitrary bits; floats include NaNs, infinities and subnormals.
fn noise(random: &mut Random, sample_type: SampleType, len: usize) -> Samples {
    let bits = (0..len).map(|_| random.next() as u32);
    match sample_type {
        SampleType::U8 => Samples::U8(bits.map(|b| b as u8).collect()),
        SampleType::U16 => Samples::U16(bits.map(|b| b as u16).collect()),
        SampleType::F16 => Samples::F16(bits.map(|b| f16::from_bits(b as u16)).collect()),
        SampleType::F32 => Samples::F32(bits.map(f32::from_bits).collect()),
    }
}

/// A texture of noise with all levels down to 1 x 1.
pub fn noise_texture(
    random: &mut Random,
    sample_type: SampleType,
    channels: usize,
    (width, height): (usize, usize),
) -> Texture {
    let levels = (0..=width.max(height).ilog2()).map(|level| {
        let (width, height) = ((width >> level).max(1), (height >> level).max(1));
        let samples = noise(random, sample_type, width * height * channels);
        Image::new(width, height, channels, samples).unwrap()
    });
    Texture::new("noise", vec!["c"; channels], levels.collect()).unwrap()
}

pub fn noise_array(
    sample_type: SampleType,
    channels: usize,
    size: (usize, usize),
    layers: usize,
) -> TextureArray {
    let mut random = Random::new((size.0 * 1000 + size.1 * 10 + layers) as u64);
    let info =
        TextureInfo { scale: 1.25, base_variance: 1.0 / 3.0, ..TextureInfo::new(Layout::Lean, Part::Whole) };
    let layers = (0..layers).map(|_| noise_texture(&mut random, sample_type, channels, size));
    TextureArray::new(info, layers.collect()).unwrap()
}

/// The first levels of an array.
pub fn shortened(array: &TextureArray, levels: usize) -> TextureArray {
    let layers = array.layers().iter().map(|layer| {
        Texture::new(layer.name(), layer.channel_names().to_vec(), layer.levels()[..levels].to_vec()).unwrap()
    });
    TextureArray::new(array.info, layers.collect()).unwrap()
}

pub fn ktx2_bytes(payload: Payload<'_>, supercompression: Supercompression) -> Vec<u8> {
    let mut bytes = Vec::new();
    roughcast_io::ktx2::write(payload, supercompression, &mut bytes).unwrap();
    bytes
}

pub fn dds_bytes(payload: Payload<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    roughcast_io::dds::write(payload, &mut bytes).unwrap();
    bytes
}

/// Asserts equal info, sizes and bits. Names are not compared: they come from the layout, and the noise has none.
pub fn assert_same_texels(got: &TextureArray, wanted: &TextureArray, what: &str) {
    assert_eq!(got.info, wanted.info, "{what}");
    assert_eq!(got.layers().len(), wanted.layers().len(), "{what}: layers");
    for (got, wanted) in got.layers().iter().zip(wanted.layers()) {
        assert_eq!(got.channel_names().len(), wanted.channel_names().len(), "{what}: channels");
        assert_eq!(got.levels().len(), wanted.levels().len(), "{what}: levels");
        for (level, (got, wanted)) in got.levels().iter().zip(wanted.levels()).enumerate() {
            let size = |image: &Image| (image.width(), image.height(), image.channels());
            assert_eq!(size(got), size(wanted), "{what}: level {level}");
            assert!(bits(got.samples()) == bits(wanted.samples()), "{what}: level {level} differs");
        }
    }
}

/// The bits of the samples, which compare equal even for NaN.
fn bits(samples: &Samples) -> (SampleType, Vec<u32>) {
    let bits = match samples {
        Samples::U8(v) => v.iter().map(|&s| u32::from(s)).collect(),
        Samples::U16(v) => v.iter().map(|&s| u32::from(s)).collect(),
        Samples::F16(v) => v.iter().map(|s| u32::from(s.to_bits())).collect(),
        Samples::F32(v) => v.iter().map(|s| s.to_bits()).collect(),
    };
    (samples.sample_type(), bits)
}

/// The picture as floats in 0 ..= 1, `channels` per texel.
pub fn floats(image: &Image, channels: usize) -> Vec<f32> {
    let texels = image.width() * image.height();
    let of_texel = |texel: usize| {
        (0..channels).map(move |channel| image.samples().get(texel * image.channels() + channel))
    };
    (0..texels).flat_map(of_texel).collect()
}
