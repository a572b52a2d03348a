//! Textures in the form in which files store them, texels or compressed blocks, and the error of block compression.

use std::ops::ControlFlow;

use roughcast::texture::{Bounds, DecodeError, Texture, TextureArray, TextureInfo, decode, split_layers};
use roughcast::{Blocks, Moments, SampleType};

use crate::blocks::{BlockArray, BlockFormat, FractionDone, compress_watched, decompress};
use crate::{Payload, WriteError};

/// The textures of one file, as texels or compressed blocks.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stored {
    /// Uncompressed texels.
    Texels(TextureArray),
    /// Compressed blocks.
    Blocks(BlockArray),
}

impl Stored {
    /// The input for the KTX2 and DDS writers.
    pub fn payload(&self) -> Payload<'_> {
        match self {
            Stored::Texels(array) => Payload::Texels(array),
            Stored::Blocks(blocks) => Payload::Blocks(blocks),
        }
    }

    /// The meaning of the texels.
    pub fn info(&self) -> &TextureInfo {
        match self {
            Stored::Texels(array) => &array.info,
            Stored::Blocks(blocks) => &blocks.info,
        }
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Stored::Texels(array) => array.size(),
            Stored::Blocks(blocks) => blocks.size(),
        }
    }

    /// Number of layers.
    pub fn layer_count(&self) -> usize {
        match self {
            Stored::Texels(array) => array.layers().len(),
            Stored::Blocks(blocks) => blocks.layers().len(),
        }
    }

    /// The sample type of the texels; blocks count as 8-bit.
    pub fn sample_type(&self) -> SampleType {
        match self {
            Stored::Texels(array) => array.sample_type(),
            Stored::Blocks(_) => SampleType::U8,
        }
    }

    /// Channels of a texel.
    pub fn channels(&self) -> usize {
        match self {
            Stored::Texels(array) => array.layers()[0].finest().channels(),
            Stored::Blocks(blocks) => blocks.format().channels(),
        }
    }

    /// The format of the texels: `RGBA 16-bit float`, `BC5`.
    pub fn format_name(&self) -> String {
        if let Stored::Blocks(blocks) = self {
            return blocks.format().name().to_owned();
        }
        let channels = ["R", "RG", "RGB", "RGBA"].get(self.channels() - 1).copied().unwrap_or("moments");
        let bits = match self.sample_type() {
            SampleType::U8 => "8-bit unorm",
            SampleType::U16 => "16-bit unorm",
            SampleType::F16 => "16-bit float",
            SampleType::F32 => "32-bit float",
        };
        format!("{channels} {bits}")
    }

    /// Splits the textures into one per layer, each for its own file.
    pub fn split(self) -> Vec<Stored> {
        match self {
            Stored::Texels(array) => split_layers(vec![array]).into_iter().map(Stored::Texels).collect(),
            Stored::Blocks(blocks) => blocks.split_layers().into_iter().map(Stored::Blocks).collect(),
        }
    }
}

/// Why textures could not be compressed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompressError {
    /// The blocks cannot store these texels.
    #[error(transparent)]
    Format(#[from] WriteError),
    /// The error of the blocks cannot be measured, since the textures do not decode.
    #[error(transparent)]
    Decode(#[from] DecodeError),
    /// The caller asked to stop.
    #[error("block compression was stopped")]
    Stopped,
}

/// Compresses each array into blocks, BC4 for one channel, BC5 for two and BC7 for four, and measures the error. With
/// [`Blocks::None`] the texels stay unchanged. `watch` receives the completed fraction, on any thread, and may stop the
/// work.
///
/// # Errors
/// [`CompressError`] if the texels are not 8-bit or have three channels, if the textures do not decode, or if
/// `watch` stops the work.
pub fn stored_of(
    arrays: Vec<TextureArray>,
    blocks: Blocks,
    watch: &FractionDone<'_>,
) -> Result<(Vec<Stored>, Option<CompressionError>), CompressError> {
    if blocks == Blocks::None {
        return Ok((arrays.into_iter().map(Stored::Texels).collect(), None));
    }
    let texels = |array: &TextureArray| -> usize {
        array.layers().iter().flat_map(Texture::levels).map(|level| level.width() * level.height()).sum()
    };
    let all = arrays.iter().map(texels).sum::<usize>().max(1) as f32;
    let mut done = 0.0;
    let mut compressed = Vec::with_capacity(arrays.len());
    for array in &arrays {
        let share = texels(array) as f32 / all;
        let of_array = |fraction: f32| watch(done + share * fraction);
        match compress_watched(array, block_format(array), &of_array)? {
            ControlFlow::Continue(blocks) => compressed.push(blocks),
            ControlFlow::Break(()) => return Err(CompressError::Stopped),
        }
        done += share;
    }
    let seen: Vec<TextureArray> = compressed.iter().map(decompress).collect();
    let error = CompressionError::between(&arrays, &seen)?;
    Ok((compressed.into_iter().map(Stored::Blocks).collect(), Some(error)))
}

/// One channel in BC4, two in BC5, four in BC7.
fn block_format(array: &TextureArray) -> BlockFormat {
    match array.layers()[0].finest().channels() {
        1 => BlockFormat::Bc4,
        2 => BlockFormat::Bc5,
        _ => BlockFormat::Bc7,
    }
}

/// The error that block compression adds to the standard deviation of slopes, `σ = sqrt(tr Σ / 2)`, and to their
/// variance, over all levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompressionError {
    /// Root mean square error of σ.
    pub sigma_rms: f64,
    /// Largest error of σ.
    pub sigma_max: f64,
    /// Largest error of the variance along an axis.
    pub variance: f32,
    /// Largest error of the variance along any direction.
    pub any_direction: f32,
}

impl CompressionError {
    /// Compares the textures after compression with those before it.
    ///
    /// # Errors
    /// [`DecodeError`] if either set is not complete.
    pub fn between(before: &[TextureArray], after: &[TextureArray]) -> Result<Self, DecodeError> {
        let sigma = |moments: &Moments| f64::from(0.5 * moments.covariance().trace()).sqrt();
        let (mut squares, mut largest, mut texels) = (0.0, 0.0_f64, 0_u64);
        let (mut variance, mut any_direction) = (0.0_f32, 0.0_f32);
        for (before, after) in decode(before)?.iter().zip(&decode(after)?) {
            for (before, after) in before.moments().iter().zip(after.moments()) {
                let error = (sigma(before) - sigma(after)).abs();
                squares += error * error;
                largest = largest.max(error);
                texels += 1;
                let (a, b) = (before.covariance(), after.covariance());
                let off = a - b;
                variance = variance.max(off.xx.abs()).max(off.yy.abs());
                let (large, small) = off.eigenvalues();
                any_direction = any_direction.max(large.abs()).max(small.abs());
            }
        }
        let sigma_rms = (squares / texels.max(1) as f64).sqrt();
        Ok(Self { sigma_rms, sigma_max: largest, variance, any_direction })
    }

    /// The bounds of stored texels with the error of their blocks added.
    pub fn added_to(&self, stored: Bounds) -> Bounds {
        Bounds {
            variance: stored.variance + self.variance,
            eigenvalue: stored.eigenvalue + self.any_direction,
            ..stored
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use roughcast::texture::Layout;
    use roughcast::{Bake, BakeOptions, BaseRoughness, Image, PbrOptions, SampleType, Samples};

    use super::*;

    const SIDE: usize = 32;

    /// The two files of `pbr` for a rough map: its normals, for BC5, and its roughness, for BC4.
    fn pbr() -> Vec<TextureArray> {
        let texels =
            (0..SIDE * SIDE).flat_map(|i| [(i * 37 % 200) as u8 + 28, (i * 91 % 200) as u8 + 28, 255]);
        let map = Image::new(SIDE, SIDE, 3, Samples::U8(texels.collect())).expect("whole rows");
        let options = BakeOptions::default()
            .with_layout(Layout::Pbr)
            .with_sample_type(SampleType::U8)
            .with_blocks(Blocks::Bc)
            .with_pbr(PbrOptions::default().with_roughness_texture(roughcast::RoughnessTexture::Alone));
        Bake::of(&map).roughness(BaseRoughness::Variance(0.01)).options(options).run().expect("a map").arrays
    }

    #[test]
    fn texels_stay_as_they_are_without_compression() {
        let arrays = pbr();
        let (stored, error) =
            stored_of(arrays.clone(), Blocks::None, &|_| ControlFlow::Continue(())).expect("nothing to do");
        assert_eq!(stored, arrays.into_iter().map(Stored::Texels).collect::<Vec<_>>());
        assert_eq!(error, None);
    }

    #[test]
    fn the_channels_choose_the_blocks_and_the_error_is_measured() {
        let fractions = Mutex::new(Vec::new());
        let watch = |fraction: f32| {
            fractions.lock().expect("no panic").push(fraction);
            ControlFlow::Continue(())
        };
        let (stored, error) = stored_of(pbr(), Blocks::Bc, &watch).expect("8 bits");
        let names: Vec<String> = stored.iter().map(Stored::format_name).collect();
        assert_eq!(names, ["BC5", "BC4"]);
        let error = error.expect("it was measured");
        assert!(error.sigma_rms > 0.0 && error.sigma_max >= error.sigma_rms, "{error:?}");
        let fractions = fractions.into_inner().expect("no panic");
        let last = fractions.iter().copied().fold(0.0, f32::max);
        /// Rounding error of the summed single floats.
        const ROUNDING: f32 = 1e-5;
        assert!((last - 1.0).abs() < ROUNDING && fractions.len() > 2 * SIDE / 4, "{fractions:?}");
    }

    #[test]
    fn compression_can_be_stopped_half_way() {
        let watch =
            |fraction: f32| if fraction > 0.3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        assert!(matches!(stored_of(pbr(), Blocks::Bc, &watch), Err(CompressError::Stopped)));
    }
}
