//! Textures in memory for sampling: all levels, four channels of floats.

use std::sync::OnceLock;

use rayon::prelude::*;
use roughcast::texture::Texture;
use roughcast::{Image, Wrap};

use crate::filter::SummedAreaTable;
use crate::{Level, MipmapError};

/// A texture with its levels, as stored: integer texels as 0 ..= 1, floats unchanged. Missing channels are 0, or 1 for
/// the fourth, as in graphics hardware.
///
/// Each texel is stored as four floats, 16 bytes. A summed-area table, created on first use, takes 32 more bytes per
/// texel of level 0.
#[derive(Clone, Debug)]
pub struct Mipmap {
    levels: Vec<Level>,
    table: OnceLock<SummedAreaTable>,
}

impl Level {
    fn of(image: &Image) -> Self {
        let (width, channels) = (image.width(), image.channels().min(4));
        let mut texels = vec![[0.0, 0.0, 0.0, 1.0]; width * image.height()];
        texels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, texel) in row.iter_mut().enumerate() {
                for (channel, value) in texel[..channels].iter_mut().enumerate() {
                    *value = image.get(x, y, channel);
                }
            }
        });
        Self::new(width, image.height(), texels).expect("an image has as many texels as its size says")
    }

    /// Four neighbouring texels, row by row. `at` is the column and row of the first, which may lie beyond the edges.
    #[inline]
    pub(crate) fn square(&self, at: (i64, i64), wrap: Wrap) -> [[f32; 4]; 4] {
        square_at(at, (self.width(), self.height()), wrap).map(|texel| self.texels()[texel])
    }
}

impl Mipmap {
    /// Converts a texture for sampling.
    ///
    /// # Errors
    /// [`MipmapError::Channels`] if it has more than four channels.
    pub fn of(texture: &Texture) -> Result<Self, MipmapError> {
        let channels = texture.finest().channels();
        if channels > 4 {
            return Err(MipmapError::Channels { name: texture.name().to_owned(), channels });
        }
        Self::new(texture.levels().iter().map(Level::of).collect())
    }

    /// Creates a texture from these levels, the finest first. Each size need not be half of the previous one.
    ///
    /// # Errors
    /// [`MipmapError::Size`] if there are no levels.
    pub fn new(levels: Vec<Level>) -> Result<Self, MipmapError> {
        if levels.is_empty() {
            return Err(MipmapError::Size { level: 0, width: 0, height: 0, got: 0 });
        }
        Ok(Self { levels, table: OnceLock::new() })
    }

    /// The same texture with another channel in place of the first.
    pub(crate) fn with_first_channel(mut self, channel: usize) -> Self {
        for texel in self.levels.iter_mut().flat_map(Level::texels_mut) {
            texel[0] = texel[channel];
        }
        self.table = OnceLock::new();
        self
    }

    /// The levels, the finest first; at least one.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Width and height of level 0.
    pub fn size(&self) -> (usize, usize) {
        (self.levels[0].width(), self.levels[0].height())
    }

    /// The summed-area table of level 0, computed on first use.
    pub fn table(&self) -> &SummedAreaTable {
        self.table.get_or_init(|| SummedAreaTable::of(&self.levels[0]))
    }
}

/// The index of the texel after wrapping; `index` may lie beyond the edges.
#[inline]
pub(crate) fn wrapped(index: i64, length: usize, wrap: Wrap) -> usize {
    let length = length as i64;
    let inside = match wrap {
        // Most indices are within the range, and a division is slow.
        Wrap::Repeat if (0..length).contains(&index) => index,
        Wrap::Repeat => index.rem_euclid(length),
        Wrap::Clamp => index.clamp(0, length - 1),
        Wrap::Mirror => {
            let index = index.rem_euclid(2 * length);
            index.min(2 * length - 1 - index)
        }
    };
    inside as usize
}

/// Indices, in row-major order, of the texel in this column and row and of its neighbours to the right, below, and
/// below to the right. All of them may lie beyond the edges.
#[inline]
pub(crate) fn square_at((x, y): (i64, i64), (width, height): (usize, usize), wrap: Wrap) -> [usize; 4] {
    // Inside the map all wrap modes agree, and most squares lie there.
    if (0..width as i64 - 1).contains(&x) && (0..height as i64 - 1).contains(&y) {
        let first = y as usize * width + x as usize;
        return [first, first + 1, first + width, first + width + 1];
    }
    let [left, right] = [x, x.saturating_add(1)].map(|x| wrapped(x, width, wrap));
    let [top, bottom] = [y, y.saturating_add(1)].map(|y| wrapped(y, height, wrap) * width);
    [top + left, top + right, bottom + left, bottom + right]
}

/// The floor of a coordinate and the remainder, in 0 ..= 1. Infinite coordinates and NaN give a valid index too. Faster
/// than `floor`, which is a function call unless the compiler may assume SSE 4.1.
#[inline]
#[expect(clippy::manual_clamp, reason = "max turns NaN into zero; clamp would keep it")]
pub(crate) fn whole_and_rest(x: f64) -> (i64, f64) {
    let towards_zero = x as i64;
    let whole = towards_zero.saturating_sub(i64::from(towards_zero as f64 > x));
    (whole, (x - whole as f64).max(0.0).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use roughcast::Samples;

    fn texture(channels: usize, samples: Samples) -> Texture {
        let image = Image::new(2, 1, channels, samples).unwrap();
        Texture::new("t", vec!["c"; channels], vec![image]).unwrap()
    }

    #[test]
    fn integers_are_normalised_and_missing_channels_are_as_in_hardware() {
        let mipmap = Mipmap::of(&texture(1, Samples::U8(vec![0, 255]))).unwrap();
        assert_eq!(mipmap.levels()[0].row(0), [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
        let mipmap = Mipmap::of(&texture(2, Samples::U16(vec![65535, 0, 13107, 65535]))).unwrap();
        assert_eq!(mipmap.levels()[0].row(0), [[1.0, 0.0, 0.0, 1.0], [0.2, 1.0, 0.0, 1.0]]);
        let floats = (0..8).map(|i| i as f32 - 4.0).collect();
        let mipmap = Mipmap::of(&texture(4, Samples::F32(floats))).unwrap();
        assert_eq!(mipmap.levels()[0].texel(1, 0), [0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn textures_with_too_many_channels_or_no_levels_are_refused() {
        let five = texture(5, Samples::F32(vec![0.0; 10]));
        assert!(matches!(Mipmap::of(&five), Err(MipmapError::Channels { channels: 5, .. })));
        assert!(matches!(Mipmap::new(vec![]), Err(MipmapError::Size { .. })));
        assert!(Level::new(2, 2, vec![[0.0; 4]; 3]).is_err());
        assert!(Level::new(0, 0, vec![]).is_err());
    }

    #[test]
    fn squares_are_those_of_wrapped_indices() {
        for size in [(3, 2), (1, 1), (1, 4), (5, 1)] {
            for (wrap, x, y) in
                Wrap::ALL.iter().flat_map(|w| (-7..8).flat_map(move |x| (-7..8).map(move |y| (*w, x, y))))
            {
                let place = |x, y| wrapped(y, size.1, wrap) * size.0 + wrapped(x, size.0, wrap);
                let wanted = [place(x, y), place(x + 1, y), place(x, y + 1), place(x + 1, y + 1)];
                assert_eq!(square_at((x, y), size, wrap), wanted, "{size:?} {wrap} {x} {y}");
            }
        }
    }

    #[test]
    fn whole_numbers_and_rests_are_those_of_floor() {
        for x in
            [0.0, -0.0, 0.25, 1.0, 7.75, -0.25, -1.0, -2.5, 1e9 + 0.5, -1e9 - 0.5, -1e-300, f64::MIN_POSITIVE]
        {
            assert_eq!(whole_and_rest(x), (x.floor() as i64, x - x.floor()), "{x}");
        }
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
            assert!((0.0..=1.0).contains(&whole_and_rest(odd).1), "{odd}");
        }
    }

    #[test]
    fn indices_follow_the_wrap_mode() {
        let indices = [-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6];
        let all = |wrap| indices.map(|i| wrapped(i, 3, wrap));
        assert_eq!(all(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(all(Wrap::Clamp), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(all(Wrap::Mirror), [1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }
}
