//! Flips an image and moves its channels, as the metadata of a KTX2 file may require.

use half::f16;
use roughcast::{Image, Samples};

/// An axis along which an image is flipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// Swaps left and right.
    Horizontal,
    /// Swaps top and bottom.
    Vertical,
}

/// Where a channel of a swizzled image comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Channel(usize),
    Zero,
    One,
}

/// Flips the image along `axis`.
pub(crate) fn flipped(image: Image, axis: Axis) -> Image {
    let (width, height, channels) = (image.width(), image.height(), image.channels());
    let flip = Flip { row: width * channels, channels, axis };
    let samples = match image.into_samples() {
        Samples::U8(v) => Samples::U8(flip.apply(v)),
        Samples::U16(v) => Samples::U16(flip.apply(v)),
        Samples::F16(v) => Samples::F16(flip.apply(v)),
        Samples::F32(v) => Samples::F32(flip.apply(v)),
    };
    Image::new(width, height, channels, samples).expect("as many samples as before")
}

struct Flip {
    row: usize,
    channels: usize,
    axis: Axis,
}

impl Flip {
    fn apply<T: Copy>(&self, samples: Vec<T>) -> Vec<T> {
        let rows = samples.chunks_exact(self.row);
        match self.axis {
            Axis::Vertical => rows.rev().flatten().copied().collect(),
            Axis::Horizontal => {
                rows.flat_map(|row| row.chunks_exact(self.channels).rev().flatten()).copied().collect()
            }
        }
    }
}

/// Returns an image whose channel k is `sources[k]` of `image`.
pub(crate) fn swizzled(image: &Image, sources: &[Source]) -> Image {
    let channels = image.channels();
    let samples = match image.samples() {
        Samples::U8(v) => Samples::U8(moved(v, channels, sources, u8::MAX)),
        Samples::U16(v) => Samples::U16(moved(v, channels, sources, u16::MAX)),
        Samples::F16(v) => Samples::F16(moved(v, channels, sources, f16::ONE)),
        Samples::F32(v) => Samples::F32(moved(v, channels, sources, 1.0)),
    };
    Image::new(image.width(), image.height(), sources.len(), samples).expect("one sample for each source")
}

fn moved<T: Copy + Default>(samples: &[T], channels: usize, sources: &[Source], one: T) -> Vec<T> {
    let of_texel = |texel: &'_ [T], source: Source| match source {
        Source::Channel(channel) => texel[channel],
        Source::Zero => T::default(),
        Source::One => one,
    };
    let mut out = Vec::with_capacity(samples.len() / channels * sources.len());
    for texel in samples.chunks_exact(channels) {
        out.extend(sources.iter().map(|&source| of_texel(texel, source)));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_by_two() -> Image {
        Image::new(2, 2, 2, Samples::U8(vec![1, 2, 3, 4, 5, 6, 7, 8])).unwrap()
    }

    #[test]
    fn flips_move_texels_and_keep_channels_together() {
        let vertical = flipped(two_by_two(), Axis::Vertical);
        assert_eq!(vertical.samples(), &Samples::U8(vec![5, 6, 7, 8, 1, 2, 3, 4]));
        let horizontal = flipped(two_by_two(), Axis::Horizontal);
        assert_eq!(horizontal.samples(), &Samples::U8(vec![3, 4, 1, 2, 7, 8, 5, 6]));
    }

    #[test]
    fn swizzles_move_channels_and_put_constants() {
        let image = swizzled(&two_by_two(), &[Source::Channel(1), Source::One, Source::Zero]);
        assert_eq!(image.channels(), 3);
        assert_eq!(image.samples(), &Samples::U8(vec![2, 255, 0, 4, 255, 0, 6, 255, 0, 8, 255, 0]));
    }
}
