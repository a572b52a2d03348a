//! Images in memory: interleaved samples in the type in which they are stored, owned or borrowed.

use half::f16;

use crate::named::named_enum;

/// The samples of an [`Image`], interleaved, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8-bit unsigned normalised: 0 ..= 255 stands for 0 ..= 1.
    U8(Vec<u8>),
    /// 16-bit unsigned normalised: 0 ..= 65535 stands for 0 ..= 1.
    U16(Vec<u16>),
    /// Half float, stored as is.
    F16(Vec<f16>),
    /// Single float, stored as is.
    F32(Vec<f32>),
}

named_enum! {
    /// The storage type of samples, without the samples. A variant is named by its number of bits if that is
    /// unambiguous.
    pub enum SampleType: "sample type" {
        /// 8-bit unsigned normalised.
        U8 = "8",
        /// 16-bit unsigned normalised.
        U16 = "16",
        /// Half float.
        F16 = "half",
        /// Single float.
        F32 = "float",
    }
}

impl SampleType {
    /// Bytes of one sample.
    pub fn bytes(self) -> usize {
        match self {
            SampleType::U8 => 1,
            SampleType::U16 | SampleType::F16 => 2,
            SampleType::F32 => 4,
        }
    }

    /// Whether the samples are floats, which hold signed values without scale and bias.
    pub fn is_float(self) -> bool {
        matches!(self, SampleType::F16 | SampleType::F32)
    }
}

impl Samples {
    /// `len` samples of zero.
    pub fn zeros(sample_type: SampleType, len: usize) -> Self {
        match sample_type {
            SampleType::U8 => Samples::U8(vec![0; len]),
            SampleType::U16 => Samples::U16(vec![0; len]),
            SampleType::F16 => Samples::F16(vec![f16::ZERO; len]),
            SampleType::F32 => Samples::F32(vec![0.0; len]),
        }
    }

    /// The same samples, borrowed.
    pub fn view(&self) -> SamplesView<'_> {
        match self {
            Samples::U8(v) => SamplesView::U8(v),
            Samples::U16(v) => SamplesView::U16(v),
            Samples::F16(v) => SamplesView::F16(v),
            Samples::F32(v) => SamplesView::F32(v),
        }
    }

    /// The storage type.
    pub fn sample_type(&self) -> SampleType {
        match self {
            Samples::U8(_) => SampleType::U8,
            Samples::U16(_) => SampleType::U16,
            Samples::F16(_) => SampleType::F16,
            Samples::F32(_) => SampleType::F32,
        }
    }

    /// Number of samples (not pixels).
    pub fn len(&self) -> usize {
        match self {
            Samples::U8(v) => v.len(),
            Samples::U16(v) => v.len(),
            Samples::F16(v) => v.len(),
            Samples::F32(v) => v.len(),
        }
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sample `index` as a float: unsigned types as 0 ..= 1, floats as they are.
    pub fn get(&self, index: usize) -> f32 {
        match self {
            Samples::U8(v) => unorm8(v[index]),
            Samples::U16(v) => unorm16(v[index]),
            Samples::F16(v) => v[index].to_f32(),
            Samples::F32(v) => v[index],
        }
    }
}

/// The value of an 8-bit unsigned normalised sample.
#[inline(always)]
pub(crate) fn unorm8(sample: u8) -> f32 {
    f32::from(sample) / 255.0
}

/// The value of a 16-bit unsigned normalised sample.
#[inline(always)]
pub(crate) fn unorm16(sample: u16) -> f32 {
    f32::from(sample) / 65535.0
}

/// An image of `height` rows of `width` pixels of `channels` interleaved samples. Row 0 is the top.
///
/// ```
/// use roughcast::{Image, Samples, SamplesMut};
///
/// let mut image = Image::new(2, 1, 3, Samples::U8(vec![0, 0, 255, 51, 0, 255]))?;
/// assert_eq!(image.get(1, 0, 0), 0.2);
/// if let SamplesMut::U8(samples) = image.samples_mut() {
///     samples[3] = 255;
/// }
/// assert_eq!(image.get(1, 0, 0), 1.0);
/// assert!(Image::new(2, 1, 3, Samples::U8(vec![0; 5])).is_err());
/// # Ok::<(), roughcast::ImageError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    channels: usize,
    samples: Samples,
}

/// The reason why samples do not form an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A side or the number of channels is zero.
    #[error(
        "an image needs at least one pixel and one channel, not {width}x{height} with {channels} channels"
    )]
    Empty {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Samples in a pixel.
        channels: usize,
    },
    /// The number of samples does not match the size.
    #[error("{width}x{height} pixels of {channels} channels need {expected} samples, not {got}")]
    Length {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Samples in a pixel.
        channels: usize,
        /// `width * height * channels`.
        expected: usize,
        /// Samples given.
        got: usize,
    },
}

impl Image {
    /// Creates an image from samples, in rows from the top.
    ///
    /// # Errors
    /// [`ImageError`] if a side is zero or the number of samples is not `width * height * channels`.
    pub fn new(width: usize, height: usize, channels: usize, samples: Samples) -> Result<Self, ImageError> {
        check_length(width, height, channels, samples.len())?;
        Ok(Self { width, height, channels, samples })
    }

    /// An image of zeros.
    ///
    /// # Panics
    /// If a side or the number of channels is zero.
    pub fn zeros(width: usize, height: usize, channels: usize, sample_type: SampleType) -> Self {
        let samples = Samples::zeros(sample_type, width * height * channels);
        Self::new(width, height, channels, samples).expect("the length is computed from the size")
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Samples in a pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// The samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The same image, borrowed.
    pub fn view(&self) -> ImageView<'_> {
        ImageView {
            width: self.width,
            height: self.height,
            channels: self.channels,
            samples: self.samples.view(),
        }
    }

    /// The samples, for writing. Their number and type cannot change.
    pub fn samples_mut(&mut self) -> SamplesMut<'_> {
        match &mut self.samples {
            Samples::U8(v) => SamplesMut::U8(v),
            Samples::U16(v) => SamplesMut::U16(v),
            Samples::F16(v) => SamplesMut::F16(v),
            Samples::F32(v) => SamplesMut::F32(v),
        }
    }

    /// Consumes the image and returns its samples.
    pub fn into_samples(self) -> Samples {
        self.samples
    }

    /// One sample as a float: unsigned types as 0 ..= 1, floats as they are.
    pub fn get(&self, x: usize, y: usize, channel: usize) -> f32 {
        self.samples.get((y * self.width + x) * self.channels + channel)
    }
}

/// Checks that the number of samples matches the size of the image.
fn check_length(width: usize, height: usize, channels: usize, got: usize) -> Result<(), ImageError> {
    let expected =
        width.checked_mul(height).and_then(|pixels| pixels.checked_mul(channels)).unwrap_or(usize::MAX);
    if expected == 0 {
        return Err(ImageError::Empty { width, height, channels });
    }
    if got != expected {
        return Err(ImageError::Length { width, height, channels, expected, got });
    }
    Ok(())
}

/// The samples of an [`ImageView`], interleaved, row by row from the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplesView<'a> {
    /// 8-bit unsigned normalised: 0 ..= 255 stands for 0 ..= 1.
    U8(&'a [u8]),
    /// 16-bit unsigned normalised: 0 ..= 65535 stands for 0 ..= 1.
    U16(&'a [u16]),
    /// Half float, stored as is.
    F16(&'a [f16]),
    /// Single float, stored as is.
    F32(&'a [f32]),
}

impl SamplesView<'_> {
    /// The storage type.
    pub fn sample_type(self) -> SampleType {
        match self {
            SamplesView::U8(_) => SampleType::U8,
            SamplesView::U16(_) => SampleType::U16,
            SamplesView::F16(_) => SampleType::F16,
            SamplesView::F32(_) => SampleType::F32,
        }
    }

    /// Number of samples (not pixels).
    pub fn len(self) -> usize {
        match self {
            SamplesView::U8(v) => v.len(),
            SamplesView::U16(v) => v.len(),
            SamplesView::F16(v) => v.len(),
            SamplesView::F32(v) => v.len(),
        }
    }

    /// Whether there are no samples.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Sample `index` as a float: unsigned types as 0 ..= 1, floats as they are.
    ///
    /// # Panics
    /// If there is no such sample.
    pub fn get(self, index: usize) -> f32 {
        match self {
            SamplesView::U8(v) => unorm8(v[index]),
            SamplesView::U16(v) => unorm16(v[index]),
            SamplesView::F16(v) => v[index].to_f32(),
            SamplesView::F32(v) => v[index],
        }
    }

    /// A copy that owns its samples.
    pub fn to_samples(self) -> Samples {
        match self {
            SamplesView::U8(v) => Samples::U8(v.to_vec()),
            SamplesView::U16(v) => Samples::U16(v.to_vec()),
            SamplesView::F16(v) => Samples::F16(v.to_vec()),
            SamplesView::F32(v) => Samples::F32(v.to_vec()),
        }
    }
}

/// The samples of an [`Image`], for writing.
#[derive(Debug, PartialEq)]
pub enum SamplesMut<'a> {
    /// 8-bit unsigned normalised: 0 ..= 255 stands for 0 ..= 1.
    U8(&'a mut [u8]),
    /// 16-bit unsigned normalised: 0 ..= 65535 stands for 0 ..= 1.
    U16(&'a mut [u16]),
    /// Half float, stored as is.
    F16(&'a mut [f16]),
    /// Single float, stored as is.
    F32(&'a mut [f32]),
}

impl SamplesMut<'_> {
    /// The storage type.
    pub fn sample_type(&self) -> SampleType {
        match self {
            SamplesMut::U8(_) => SampleType::U8,
            SamplesMut::U16(_) => SampleType::U16,
            SamplesMut::F16(_) => SampleType::F16,
            SamplesMut::F32(_) => SampleType::F32,
        }
    }
}

/// An [`Image`] with borrowed samples: a NumPy array, a browser's memory, another library's picture.
///
/// All functions that read images take views, and `&Image` converts to one by [`Into`]. Rows are contiguous, without
/// gaps.
///
/// ```
/// use roughcast::{Bake, ImageView, SamplesView};
///
/// // Normals that point straight up, in someone else's memory.
/// let pixels: [u8; 12] = [128, 128, 255].repeat(4).try_into().unwrap();
/// let map = ImageView::new(2, 2, 3, SamplesView::U8(&pixels))?;
/// let baked = Bake::of(map).run()?;
/// assert_eq!(baked.report.levels.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageView<'a> {
    width: usize,
    height: usize,
    channels: usize,
    samples: SamplesView<'a>,
}

impl<'a> ImageView<'a> {
    /// Creates a view of samples, in rows from the top.
    ///
    /// # Errors
    /// [`ImageError`] if a side is zero or the number of samples is not `width * height * channels`.
    pub fn new(
        width: usize,
        height: usize,
        channels: usize,
        samples: SamplesView<'a>,
    ) -> Result<Self, ImageError> {
        check_length(width, height, channels, samples.len())?;
        Ok(Self { width, height, channels, samples })
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Samples in a pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// The samples.
    pub fn samples(&self) -> SamplesView<'a> {
        self.samples
    }

    /// One sample as a float: unsigned types as 0 ..= 1, floats as they are.
    ///
    /// # Panics
    /// If there is no such sample.
    pub fn get(&self, x: usize, y: usize, channel: usize) -> f32 {
        self.samples.get((y * self.width + x) * self.channels + channel)
    }

    /// A copy that owns its samples.
    pub fn to_image(&self) -> Image {
        let Self { width, height, channels, samples } = *self;
        Image { width, height, channels, samples: samples.to_samples() }
    }
}

impl<'a> From<&'a Image> for ImageView<'a> {
    fn from(image: &'a Image) -> Self {
        image.view()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_has_the_values_of_its_image_and_copies_nothing() {
        let types = [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32];
        for sample_type in types {
            let mut image = Image::zeros(3, 2, 2, sample_type);
            match image.samples_mut() {
                SamplesMut::U8(v) => v[9] = 51,
                SamplesMut::U16(v) => v[9] = 13107,
                SamplesMut::F16(v) => v[9] = f16::from_f32(0.2),
                SamplesMut::F32(v) => v[9] = 0.2,
            }
            let view = image.view();
            assert_eq!((view.width(), view.height(), view.channels()), (3, 2, 2));
            assert_eq!((view.samples().len(), view.samples().sample_type()), (12, sample_type));
            assert_eq!(view.get(1, 1, 1), image.get(1, 1, 1));
            assert!(view.get(1, 1, 1) > 0.19);
            assert_eq!(view.to_image(), image);
        }
        let image = Image::zeros(3, 2, 2, SampleType::U8);
        let (Samples::U8(owned), SamplesView::U8(seen)) = (image.samples(), image.view().samples()) else {
            panic!("8 bits")
        };
        assert!(std::ptr::eq(owned.as_slice(), seen));
    }

    #[test]
    fn a_wrong_number_of_samples_is_refused() {
        let samples = SamplesView::U8(&[0; 11]);
        let error = ImageView::new(3, 2, 2, samples).expect_err("one is missing");
        assert_eq!(error, ImageError::Length { width: 3, height: 2, channels: 2, expected: 12, got: 11 });
        assert!(matches!(ImageView::new(0, 2, 2, samples), Err(ImageError::Empty { .. })));
        assert!(ImageView::new(usize::MAX, 2, 2, samples).is_err());
    }
}
