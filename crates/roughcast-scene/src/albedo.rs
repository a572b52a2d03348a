//! Diffuse colours that vary over a surface.

use roughcast::{ImageView, SamplesView};

use crate::Level;
#[cfg(feature = "render")]
use crate::{Footprint, Mipmap, Sampler};

/// Maximum value of a colour: that of a half float, the type that GPUs filter everywhere.
pub const MAX_ALBEDO: f32 = 65504.0;

/// A map of diffuse colours with its levels: linear RGB, of any size, one or more texels a side.
///
/// Each level has half the texels of the finer one in each direction, rounded down but at least one. Its texels are the
/// means of the areas that they cover, in linear light; so the mean of the map is the same on all levels.
#[derive(Clone, Debug)]
pub struct AlbedoMap {
    // The CPU renderer's filters read a `Mipmap`.
    #[cfg(feature = "render")]
    levels: Mipmap,
    #[cfg(not(feature = "render"))]
    levels: Vec<Level>,
}

/// Why colours cannot be used as a map of albedos.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlbedoError {
    /// There are no colours, or their number does not match the size.
    #[error("a colour map of {width}x{height} texels has {got} colours; it needs one for every texel")]
    Size {
        /// Texels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// The number of colours.
        got: usize,
    },
    /// A colour is negative, too large, infinite or NaN.
    #[error(
        "the colour in column {column}, row {row} is {red}, {green}, {blue} in linear light; a diffuse colour must be from 0 \
         to {MAX_ALBEDO}: repair the map"
    )]
    Colour {
        /// Its column, from 0.
        column: usize,
        /// Its row, from 0 at the top.
        row: usize,
        /// Its red.
        red: f32,
        /// Its green.
        green: f32,
        /// Its blue.
        blue: f32,
    },
    /// Not one to four channels.
    #[error(
        "an image of {0} channels is not a colour map; it needs 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA)"
    )]
    Channels(usize),
}

impl AlbedoMap {
    /// Creates a map from linear RGB colours, row by row from the top, each component 0 ..= [`MAX_ALBEDO`]. A surface that
    /// scatters no more light than it receives has components up to 1.
    ///
    /// # Errors
    /// [`AlbedoError::Size`], [`AlbedoError::Colour`].
    pub fn new(width: usize, height: usize, colours: &[[f32; 3]]) -> Result<Self, AlbedoError> {
        let wrong = colours.iter().position(|c| c.iter().any(|value| !(0.0..=MAX_ALBEDO).contains(value)));
        let texels = colours.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let finest = Level::new(width, height, texels).map_err(|_| AlbedoError::Size {
            width,
            height,
            got: colours.len(),
        })?;
        if let Some(place) = wrong {
            let [red, green, blue] = colours[place];
            return Err(AlbedoError::Colour { column: place % width, row: place / width, red, green, blue });
        }
        let mut levels = vec![finest];
        while let Some(next) = levels[levels.len() - 1].coarser() {
            levels.push(next);
        }
        #[cfg(feature = "render")]
        let levels = Mipmap::new(levels).expect("there is at least one level");
        Ok(Self { levels })
    }

    /// Creates a map from an image: grey, grey and alpha, RGB, or RGBA. Integers are sRGB (IEC 61966-2-1), floats are
    /// linear. Alpha is ignored.
    ///
    /// # Errors
    /// [`AlbedoError::Channels`], [`AlbedoError::Colour`].
    pub fn of_image<'i>(image: impl Into<ImageView<'i>>) -> Result<Self, AlbedoError> {
        let image = image.into();
        let channels = image.channels();
        let places = match channels {
            1 | 2 => [0; 3],
            3 | 4 => [0, 1, 2],
            _ => return Err(AlbedoError::Channels(channels)),
        };
        fn pixels<T: Copy>(
            samples: &[T],
            channels: usize,
            colour: impl Fn(&[T]) -> [f32; 3],
        ) -> Vec<[f32; 3]> {
            samples.chunks_exact(channels).map(colour).collect()
        }
        let colours = match image.samples() {
            SamplesView::U8(samples) => {
                let linear = linear_of_codes(u8::MAX.into());
                pixels(samples, channels, |p| places.map(|place| linear[usize::from(p[place])]))
            }
            SamplesView::U16(samples) => {
                let linear = linear_of_codes(u16::MAX.into());
                pixels(samples, channels, |p| places.map(|place| linear[usize::from(p[place])]))
            }
            SamplesView::F16(samples) => pixels(samples, channels, |p| places.map(|place| p[place].to_f32())),
            SamplesView::F32(samples) => pixels(samples, channels, |p| places.map(|place| p[place])),
        };
        Self::new(image.width(), image.height(), &colours)
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        let finest = &self.levels()[0];
        (finest.width(), finest.height())
    }

    /// The levels, the finest first, down to 1x1. Texels are linear RGB; their fourth channel is 1.
    pub fn levels(&self) -> &[Level] {
        #[cfg(feature = "render")]
        return self.levels.levels();
        #[cfg(not(feature = "render"))]
        &self.levels
    }

    /// The colour at texture coordinates, averaged over a footprint in units of the map.
    #[cfg(feature = "render")]
    pub(crate) fn sample(&self, uv: glam::DVec2, footprint: &Footprint, sampler: &Sampler) -> [f32; 3] {
        let [r, g, b, _] = sampler.sample(&self.levels, uv, footprint);
        [r, g, b]
    }
}

/// Linear values of the sRGB codes 0 ..= `largest`.
fn linear_of_codes(largest: u32) -> Vec<f32> {
    let linear = |value: f64| {
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    (0..=largest).map(|code| linear(f64::from(code) / f64::from(largest)) as f32).collect()
}

#[cfg(test)]
mod tests {
    use roughcast::{Image, Samples};

    use super::*;

    /// Rounding of means of a few numbers up to one to single floats, level by level.
    const ROUNDING: f64 = 1e-6;

    fn ramp(width: usize, height: usize) -> AlbedoMap {
        let count = (width * height) as f32;
        let colours: Vec<_> = (0..width * height).map(|i| [i as f32 / count, 0.25, 1.0]).collect();
        AlbedoMap::new(width, height, &colours).expect("it is valid")
    }

    fn mean(level: &Level) -> f64 {
        level.texels().iter().map(|texel| f64::from(texel[0])).sum::<f64>() / level.texels().len() as f64
    }

    #[test]
    fn every_level_of_any_size_has_the_mean_of_the_map() {
        for (width, height) in [(1, 1), (8, 8), (5, 7), (3, 1), (1, 13), (37, 16), (100, 3)] {
            let map = ramp(width, height);
            let wanted = mean(&map.levels()[0]);
            let mut sides = (width, height);
            for level in map.levels() {
                assert_eq!((level.width(), level.height()), sides);
                assert!((mean(level) - wanted).abs() < ROUNDING, "{width}x{height}: {}", mean(level));
                let constant =
                    |texel: &[f32; 4]| f64::from((texel[1] - 0.25).abs()) < ROUNDING && texel[3] == 1.0;
                assert!(level.texels().iter().all(constant), "{width}x{height}");
                sides = ((sides.0 / 2).max(1), (sides.1 / 2).max(1));
            }
            assert_eq!(map.levels().last().map(|level| (level.width(), level.height())), Some((1, 1)));
        }
    }

    #[test]
    fn a_coarse_texel_is_the_mean_of_the_area_that_it_covers() {
        let colours = [0.0, 0.2, 0.4, 0.6, 0.8].map(|grey| [grey; 3]);
        let map = AlbedoMap::new(5, 1, &colours).expect("it is valid");
        // Two and a half texels each.
        let wanted = [(0.0 + 0.2 + 0.5 * 0.4) / 2.5, (0.5 * 0.4 + 0.6 + 0.8) / 2.5];
        for (texel, wanted) in map.levels()[1].texels().iter().zip(wanted) {
            assert!((f64::from(texel[0]) - wanted).abs() < ROUNDING, "{texel:?} and {wanted}");
        }
    }

    #[test]
    fn integers_are_srgb_and_floats_linear_in_every_number_of_channels() {
        /// Linear value of the sRGB code 128 of 8 bits.
        const HALF_GREY: f32 = 0.215_860_5;
        let first = |channels: usize, samples: Samples| {
            let image = Image::new(1, 1, channels, samples).expect("one pixel");
            let map = AlbedoMap::of_image(&image).expect("a colour");
            map.levels()[0].texel(0, 0)
        };
        let close = |got: [f32; 4], wanted: [f32; 3]| {
            assert!(
                got.iter().zip(wanted).all(|(g, w)| f64::from((g - w).abs()) < ROUNDING),
                "{got:?} and {wanted:?}"
            );
        };
        close(first(1, Samples::U8(vec![128])), [HALF_GREY; 3]);
        close(first(2, Samples::U8(vec![128, 7])), [HALF_GREY; 3]);
        close(first(3, Samples::U8(vec![0, 128, 255])), [0.0, HALF_GREY, 1.0]);
        close(first(4, Samples::U16(vec![0, 128 * 257, 65535, 3])), [0.0, HALF_GREY, 1.0]);
        close(first(3, Samples::F32(vec![0.0, 0.5, 3.0])), [0.0, 0.5, 3.0]);
        let five = Image::new(1, 1, 5, Samples::U8(vec![0; 5])).expect("one pixel");
        assert_eq!(AlbedoMap::of_image(&five).err(), Some(AlbedoError::Channels(5)));
    }

    #[test]
    fn invalid_colours_are_refused_with_their_place() {
        for wrong in [-0.1, f32::NAN, f32::INFINITY, 1e5] {
            let colours = [[0.5; 3], [0.5; 3], [0.5; 3], [0.0, wrong, 0.0]];
            let error = AlbedoMap::new(2, 2, &colours).expect_err("it is no colour");
            let line = error.to_string();
            assert!(matches!(error, AlbedoError::Colour { column: 1, row: 1, .. }), "{line}");
            assert!(line.contains("column 1, row 1") && !line.contains('\n'), "{line}");
        }
        for (width, height, count) in [(0, 0, 0), (2, 2, 3), (usize::MAX, 2, 4)] {
            let error = AlbedoMap::new(width, height, &vec![[0.5; 3]; count]).expect_err("no map");
            assert_eq!(error, AlbedoError::Size { width, height, got: count });
        }
    }
}
