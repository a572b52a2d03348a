//! Rendered pictures: colours, unlike the textures of the other writers.

use std::io::{Seek, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, LineOrder,
    WritableImage,
};

use crate::WriteError;

/// A picture as a screen shows it: sRGB, 8 bits, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Srgb8Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `3 * width * height` bytes.
    pub pixels: Vec<u8>,
}

impl Srgb8Picture {
    /// A black picture.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![0; 3 * width as usize * height as usize] }
    }

    /// Pictures in a row, their tops aligned, `gap` pixels of this grey between them. None of no pictures.
    pub fn side_by_side<'a>(
        pictures: impl IntoIterator<Item = &'a Self> + Clone,
        gap: u32,
        grey: u8,
    ) -> Option<Self> {
        let sizes = || pictures.clone().into_iter().map(|picture| (picture.width, picture.height));
        let width = sizes().map(|(width, _)| width + gap).sum::<u32>().checked_sub(gap)?;
        let height = sizes().map(|(_, height)| height).max()?;
        let mut row = Self { width, height, pixels: vec![grey; 3 * width as usize * height as usize] };
        let mut x = 0;
        for picture in pictures {
            row.paste(picture, x, 0);
            x += picture.width + gap;
        }
        Some(row)
    }

    /// Copies another picture into this one, its top left corner at `(x, y)`; what lies outside is cut off.
    pub fn paste(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize;
        let rows = other.height.min(self.height.saturating_sub(y));
        for row in 0..rows {
            let from = 3 * (row * other.width) as usize;
            let to = 3 * ((y + row) * self.width + x) as usize;
            self.pixels[to..][..3 * columns].copy_from_slice(&other.pixels[from..][..3 * columns]);
        }
    }
}

/// Writes a picture as PNG, marked as sRGB.
///
/// # Errors
/// [`WriteError::Io`] where `out` fails.
pub fn write_png(picture: &Srgb8Picture, out: impl Write) -> Result<(), WriteError> {
    write_animation(std::slice::from_ref(picture), 1, out)
}

/// Writes pictures of equal size as an animated PNG that repeats for ever; a single one as a plain PNG.
///
/// # Errors
/// [`WriteError::Unsupported`] where there is no picture or the sizes differ; [`WriteError::Io`] where `out` fails.
pub fn write_animation(
    frames: &[Srgb8Picture],
    frames_per_second: u16,
    out: impl Write,
) -> Result<(), WriteError> {
    let unsupported =
        |what: &str, mend| WriteError::Unsupported { container: "PNG", what: what.to_owned(), mend };
    let first = frames.first().ok_or_else(|| unsupported("no pictures", "give it at least one"))?;
    if frames.iter().any(|frame| (frame.width, frame.height) != (first.width, first.height)) {
        return Err(unsupported("frames of several sizes", "give all the same size"));
    }
    let mut encoder = png::Encoder::new(out, first.width, first.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    if frames.len() > 1 {
        encoder.set_animated(frames.len() as u32, 0).map_err(failure)?;
        encoder.set_frame_delay(1, frames_per_second).map_err(failure)?;
    }
    let mut writer = encoder.write_header().map_err(failure)?;
    for frame in frames {
        writer.write_image_data(&frame.pixels).map_err(failure)?;
    }
    writer.finish().map_err(failure)
}

fn failure(error: png::EncodingError) -> WriteError {
    match error {
        png::EncodingError::IoError(error) => WriteError::Io(error),
        other => WriteError::Io(std::io::Error::other(other)),
    }
}

/// A named plane of an EXR picture, row by row from the top.
pub struct Plane {
    /// The channel's name, `R`, `specular.R` ...
    pub name: &'static str,
    /// Its values.
    pub values: Vec<f32>,
}

/// Writes planes of linear values as an OpenEXR picture of single floats, ZIP-compressed.
///
/// # Errors
/// [`WriteError::Unsupported`] where a plane has not `width * height` values; [`WriteError::Io`] where `out` fails.
pub fn write_exr(
    (width, height): (usize, usize),
    planes: Vec<Plane>,
    out: impl Write + Seek,
) -> Result<(), WriteError> {
    if planes.is_empty() || planes.iter().any(|plane| plane.values.len() != width * height) {
        let what = format!("planes that are not {width}x{height}");
        return Err(WriteError::Unsupported { container: "EXR", what, mend: "give each one value a pixel" });
    }
    let channels =
        planes.into_iter().map(|plane| AnyChannel::new(plane.name, FlatSamples::F32(plane.values)));
    let channels = AnyChannels::sort(channels.collect());
    let encoding = Encoding {
        compression: Compression::ZIP16,
        line_order: LineOrder::Increasing,
        ..Encoding::default()
    };
    let layer = Layer::new((width, height), LayerAttributes::default(), encoding, channels);
    let image = exr::image::Image::from_layer(layer);
    image.write().to_buffered(out).map_err(|error| match error {
        exr::error::Error::Io(error) => WriteError::Io(error),
        other => WriteError::Io(std::io::Error::other(other.to_string())),
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::ReadOptions;

    fn gradient(width: u32, height: u32, offset: u8) -> Srgb8Picture {
        let len = 3 * width as usize * height as usize;
        Srgb8Picture { width, height, pixels: (0..len).map(|i| (i as u8).wrapping_add(offset)).collect() }
    }

    #[test]
    fn a_picture_reads_back_and_says_that_it_is_srgb() {
        let picture = gradient(7, 5, 3);
        let mut bytes = Vec::new();
        write_png(&picture, &mut bytes).expect("memory takes it");
        let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
        assert!(reader.info().srgb.is_some() && reader.info().animation_control.is_none());
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut pixels).expect("a frame");
        assert_eq!(pixels, picture.pixels);
    }

    #[test]
    fn every_frame_of_an_animation_reads_back() {
        let frames = [gradient(4, 4, 0), gradient(4, 4, 90), gradient(4, 4, 200)];
        let mut bytes = Vec::new();
        write_animation(&frames, 12, &mut bytes).expect("memory takes it");
        let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
        assert_eq!(reader.info().animation_control.expect("animated").num_frames, 3);
        for frame in &frames {
            let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
            reader.next_frame(&mut pixels).expect("a frame");
            assert_eq!(pixels, frame.pixels);
        }
    }

    #[test]
    fn frames_that_do_not_fit_together_are_refused() {
        for frames in [vec![], vec![gradient(4, 4, 0), gradient(4, 5, 0)]] {
            let result = write_animation(&frames, 12, Vec::new());
            assert!(matches!(result, Err(WriteError::Unsupported { .. })));
        }
    }

    #[test]
    fn pasting_cuts_off_what_lies_outside() {
        let mut canvas = Srgb8Picture::black(4, 3);
        canvas.paste(&gradient(3, 3, 1), 2, 1);
        assert!(canvas.pixels[..3 * 6].iter().all(|byte| *byte == 0));
        assert_eq!(canvas.pixels[3 * 6..3 * 8], gradient(3, 3, 1).pixels[..6]);
        assert_eq!(canvas.pixels[3 * 10..3 * 12], gradient(3, 3, 1).pixels[9..15]);
    }

    #[test]
    fn pictures_stand_side_by_side_with_a_gap_between() {
        let (left, right) = (gradient(2, 1, 1), gradient(1, 2, 100));
        let row = Srgb8Picture::side_by_side([&left, &right], 1, 9).expect("there are pictures");
        assert_eq!((row.width, row.height), (4, 2));
        assert_eq!(row.pixels[..12], [1, 2, 3, 4, 5, 6, 9, 9, 9, 100, 101, 102]);
        assert_eq!(row.pixels[12..], [9, 9, 9, 9, 9, 9, 9, 9, 9, 103, 104, 105]);
        assert_eq!(Srgb8Picture::side_by_side([], 1, 9), None);
    }

    #[test]
    fn an_exr_picture_reads_back_bit_for_bit() {
        let (width, height) = (5, 3);
        let plane = |name, offset: f32| {
            let values = (0..width * height).map(|i| i as f32 * 0.1 + offset).collect();
            Plane { name, values }
        };
        let mut file = Cursor::new(Vec::new());
        write_exr((width, height), vec![plane("R", 0.0), plane("G", 100.0), plane("B", -3.0)], &mut file)
            .expect("memory takes it");
        let read = crate::read_image(file.get_ref(), Some("exr"), &ReadOptions::default()).expect("an EXR");
        assert_eq!((read.image.width(), read.image.height(), read.image.channels()), (width, height, 3));
        let roughcast::Samples::F32(samples) = read.image.samples() else { panic!("single floats") };
        assert_eq!(samples[..3], [0.0, 100.0, -3.0]);
        assert_eq!(samples[3 * 14..], [14.0 * 0.1, 14.0 * 0.1 + 100.0, 14.0 * 0.1 - 3.0]);
    }

    #[test]
    fn planes_of_another_size_are_refused() {
        let plane = Plane { name: "R", values: vec![0.0; 5] };
        let result = write_exr((2, 2), vec![plane], Cursor::new(Vec::new()));
        assert!(matches!(result, Err(WriteError::Unsupported { .. })));
    }
}
