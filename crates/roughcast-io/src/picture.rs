//! Rendered pictures. They contain colours, unlike the textures of the other writers.

use std::collections::BTreeSet;
use std::io::{Seek, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, LineOrder,
    WritableImage,
};
use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;

use roughcast::{ImageError, ImageView, SamplesView};

use crate::WriteError;

/// A picture as a screen shows it: sRGB, 8 bits, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Srgb8Picture {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Srgb8Picture {
    /// A picture of `height` rows of `width` pixels, each with bytes for red, green and blue.
    ///
    /// # Errors
    /// [`ImageError`] if a side is zero or there are not `3 * width * height` bytes.
    pub fn new(width: u32, height: u32, pixels: Vec<u8>) -> Result<Self, ImageError> {
        ImageView::new(width as usize, height as usize, 3, SamplesView::U8(&pixels))?;
        Ok(Self { width, height, pixels })
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The bytes, `3 * width * height` of them.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// A black picture.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![0; 3 * width as usize * height as usize] }
    }

    /// Places pictures side by side, aligned at the top, with `gap` pixels of this grey between them. `None` if there
    /// are no pictures.
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

    /// Copies another picture into this one with its top left corner at `(x, y)`; parts outside are cropped.
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

/// Writes a picture as PNG of RGB, marked as sRGB.
///
/// # Errors
/// [`WriteError::Io`] if `out` fails.
pub fn write_png(picture: &Srgb8Picture, out: impl Write) -> Result<(), WriteError> {
    encode(picture, out, |encoder| encoder.set_color(png::ColorType::Rgb), &picture.pixels)
}

/// Writes a picture as PNG in fewer bytes if it is grey or has few colours: as grey, or with a palette.
///
/// # Errors
/// [`WriteError::Io`] if `out` fails.
pub fn write_compact_png(picture: &Srgb8Picture, out: impl Write) -> Result<(), WriteError> {
    let (pixels, _) = picture.pixels.as_chunks::<3>();
    if let Some(grey) = grey(pixels) {
        return encode(picture, out, |encoder| encoder.set_color(png::ColorType::Grayscale), &grey);
    }
    let Some(palette) = palette(pixels) else { return write_png(picture, out) };
    let index = |pixel| palette.iter().position(|colour| colour == pixel).expect("the palette has all") as u8;
    let indices: Vec<u8> = pixels.iter().map(index).collect();
    let bits = match palette.len() {
        0..=2 => 1,
        3..=4 => 2,
        5..=16 => 4,
        _ => 8,
    };
    let depth = png::BitDepth::from_u8(bits).expect("a depth of PNG");
    let configure = |encoder: &mut png::Encoder<'_, _>| {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(depth);
        encoder.set_palette(palette.as_flattened().to_vec());
        // 8-bit indices order colours from dark to bright, so neighbours differ little.
        encoder.set_filter(if bits == 8 { png::Filter::Adaptive } else { png::Filter::NoFilter });
    };
    encode(picture, out, configure, &packed(&indices, picture.width as usize, bits))
}

/// Writes a picture as JPEG, as grey if it is grey. `quality` goes from 1 to 100; from 80 on the loss is hardly
/// visible.
///
/// # Errors
/// [`WriteError::Unsupported`] if a side is longer than JPEG's 65535; [`WriteError::Io`] if `out` fails.
pub fn write_jpeg(picture: &Srgb8Picture, quality: u8, out: impl Write) -> Result<(), WriteError> {
    let Srgb8Picture { width, height, pixels } = picture;
    let mut encoder = JpegEncoder::new_with_quality(out, quality);
    let result = match grey(pixels.as_chunks::<3>().0) {
        Some(grey) => encoder.encode(&grey, *width, *height, ExtendedColorType::L8),
        None => encoder.encode(pixels, *width, *height, ExtendedColorType::Rgb8),
    };
    result.map_err(|error| match error {
        image::ImageError::IoError(error) => WriteError::Io(error),
        _ => WriteError::Unsupported {
            container: "JPEG",
            what: format!("a picture of {width}x{height} pixels"),
            remedy: "make it smaller, or write PNG",
        },
    })
}

/// One value per pixel, if all pixels are grey.
fn grey(pixels: &[[u8; 3]]) -> Option<Vec<u8>> {
    pixels.iter().map(|[r, g, b]| (r == g && g == b).then_some(*r)).collect()
}

/// The colours from dark to bright, if one byte can index them.
fn palette(pixels: &[[u8; 3]]) -> Option<Vec<[u8; 3]>> {
    let mut colours = BTreeSet::new();
    for pixel in pixels {
        colours.insert(*pixel);
        if colours.len() > 256 {
            return None;
        }
    }
    let mut colours: Vec<[u8; 3]> = colours.into_iter().collect();
    colours.sort_by_key(|colour| colour.iter().map(|c| u32::from(*c)).sum::<u32>());
    Some(colours)
}

/// Packs indices of this many bits, with rows padded to whole bytes.
fn packed(indices: &[u8], width: usize, bits: u8) -> Vec<u8> {
    let a_byte = usize::from(8 / bits);
    let byte = |indices: &[u8]| {
        let shifted = indices.iter().enumerate().map(|(i, index)| index << (8 - bits as usize * (i + 1)));
        shifted.fold(0, |byte, index| byte | index)
    };
    indices.chunks(width).flat_map(|row| row.chunks(a_byte).map(byte)).collect()
}

fn encode<W: Write>(
    picture: &Srgb8Picture,
    out: W,
    configure: impl FnOnce(&mut png::Encoder<'_, W>),
    data: &[u8],
) -> Result<(), WriteError> {
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    configure(&mut encoder);
    let mut writer = encoder.write_header().map_err(failure)?;
    writer.write_image_data(data).map_err(failure)?;
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
/// [`WriteError::Unsupported`] if a plane does not have `width * height` values; [`WriteError::Io`] if `out` fails.
pub fn write_exr(
    (width, height): (usize, usize),
    planes: Vec<Plane>,
    out: impl Write + Seek,
) -> Result<(), WriteError> {
    if planes.is_empty() || planes.iter().any(|plane| plane.values.len() != width * height) {
        let what = format!("planes that are not {width}x{height}");
        return Err(WriteError::Unsupported {
            container: "EXR",
            what,
            remedy: "give each one value per pixel",
        });
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
    fn a_picture_reads_back_and_is_marked_as_srgb() {
        let picture = gradient(7, 5, 3);
        let mut bytes = Vec::new();
        write_png(&picture, &mut bytes).expect("memory takes it");
        let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
        assert!(reader.info().srgb.is_some() && reader.info().color_type == png::ColorType::Rgb);
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut pixels).expect("a frame");
        assert_eq!(pixels, picture.pixels);
    }

    /// Pixels of this many colours.
    fn colours(width: u32, height: u32, count: usize, colour: fn(usize) -> [u8; 3]) -> Srgb8Picture {
        let pixels = (0..(width * height) as usize).flat_map(|i| colour(i * 7 % count)).collect();
        Srgb8Picture { width, height, pixels }
    }

    fn compact(picture: &Srgb8Picture) -> (Vec<u8>, png::ColorType, png::BitDepth) {
        let mut bytes = Vec::new();
        write_compact_png(picture, &mut bytes).expect("memory takes it");
        let mut decoder = png::Decoder::new(Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().expect("a PNG");
        assert!(reader.info().srgb.is_some());
        let (colour, depth) = (reader.info().color_type, reader.info().bit_depth);
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut pixels).expect("a frame");
        if colour == png::ColorType::Grayscale {
            pixels = pixels.iter().flat_map(|grey| [*grey; 3]).collect();
        }
        (pixels, colour, depth)
    }

    #[test]
    fn compact_pictures_are_the_same_in_fewer_bytes() {
        use png::{BitDepth, ColorType};
        let coloured = |i: usize| [(i % 256) as u8, (i / 2 % 256) as u8, (i / 256) as u8 + 9];
        for (count, colour, depth) in [
            (2, ColorType::Indexed, BitDepth::One),
            (3, ColorType::Indexed, BitDepth::Two),
            (16, ColorType::Indexed, BitDepth::Four),
            (17, ColorType::Indexed, BitDepth::Eight),
            (256, ColorType::Indexed, BitDepth::Eight),
            (257, ColorType::Rgb, BitDepth::Eight),
        ] {
            // Rows that do not fill their last byte.
            let picture = colours(61, 33, count, coloured);
            assert_eq!(compact(&picture), (picture.pixels.clone(), colour, depth), "{count} colours");
        }
        let grey = colours(61, 33, 256, |i| [i as u8; 3]);
        assert_eq!(compact(&grey), (grey.pixels.clone(), ColorType::Grayscale, BitDepth::Eight));
    }

    #[test]
    fn a_jpeg_is_close_to_the_picture_and_grey_if_that_is() {
        // A smooth picture: quality 90 loses almost nothing.
        let smooth = |tint: usize| {
            let pixels = (0..48 * 32).flat_map(|i| [i % 48 * 4, i % 48 * 4 + tint, i / 48 * 7]);
            Srgb8Picture { width: 48, height: 32, pixels: pixels.map(|c| c as u8).collect() }
        };
        let mut grey = smooth(0);
        grey.pixels.chunks_exact_mut(3).for_each(|pixel| pixel[2] = pixel[0]);
        for (picture, channels) in [(grey, 1), (smooth(20), 3)] {
            let mut bytes = Vec::new();
            write_jpeg(&picture, 90, &mut bytes).expect("memory takes it");
            let mut decoder = jpeg_decoder::Decoder::new(Cursor::new(&bytes));
            let decoded = decoder.decode().expect("a JPEG");
            assert_eq!(decoded.len(), 48 * 32 * channels);
            let wanted = picture.pixels.iter().step_by(3 / channels);
            let largest = decoded.iter().zip(wanted).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(largest <= Some(6), "{channels} channels: {largest:?}");
        }
    }

    #[test]
    fn a_picture_has_three_bytes_per_pixel() {
        assert_eq!(Srgb8Picture::new(2, 1, vec![0; 6]), Ok(Srgb8Picture::black(2, 1)));
        let line = Srgb8Picture::new(2, 1, vec![0; 5]).expect_err("one is missing").to_string();
        assert!(line.contains("2x1 pixels of 3 channels need 6 samples, not 5"), "{line}");
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
