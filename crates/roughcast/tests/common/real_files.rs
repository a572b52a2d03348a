//! The real maps of the test data, as listed in their manifests.

use image::DynamicImage;
use roughcast::{Image, Samples};

/// A line of the manifest.
#[derive(Clone, Debug)]
pub struct Entry {
    pub path: String,
    pub kind: String,
    /// "GL (+Y) ..." or "DX (-Y) ...", if known.
    pub convention: String,
    /// Rms slope, if it was measured.
    pub slope_rms: Option<f64>,
}

/// The manifest's entries of a kind whose files this crate's tests can read.
pub fn entries(kind: &str) -> Vec<Entry> {
    let readable = |path: &str| ["png", "jpg", "webp"].iter().any(|end| path.ends_with(&format!(".{end}")));
    let in_scope = |path: &str| path.starts_with("materials/") || path.starts_with("heights/");
    roughcast_testdata::manifest()
        .into_iter()
        .filter(|row| row["kind"] == kind && in_scope(&row["path"]) && readable(&row["path"]))
        .map(|row| Entry {
            path: row["path"].clone(),
            kind: row["kind"].clone(),
            convention: row["convention"].clone(),
            slope_rms: row["slope_rms"].parse().ok(),
        })
        .collect()
}

/// Reads a file of the test data.
pub fn read(path: &str) -> Image {
    let full = roughcast_testdata::find(path);
    let picture = image::open(&full).unwrap_or_else(|error| panic!("{}: {error}", full.display()));
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let channels = usize::from(picture.color().channel_count());
    let samples = match picture {
        DynamicImage::ImageLuma8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageLumaA8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageRgb8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageRgba8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageLuma16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageRgb16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageRgba16(p) => Samples::U16(p.into_raw()),
        other => panic!("{path}: no test reads {:?}", other.color()),
    };
    Image::new(width, height, channels, samples).expect("the decoder gives what it says")
}

/// Reads a file of the test data and keeps at most this many columns and rows from the top left.
pub fn read_part(path: &str, largest_side: usize) -> Image {
    let image = read(path);
    let (width, height) = (image.width().min(largest_side), image.height().min(largest_side));
    let (row_length, kept) = (image.width() * image.channels(), width * image.channels());
    let rows = || (0..height).map(|y| y * row_length..y * row_length + kept);
    let samples = match image.samples() {
        Samples::U8(v) => Samples::U8(rows().flat_map(|row| &v[row]).copied().collect()),
        Samples::U16(v) => Samples::U16(rows().flat_map(|row| &v[row]).copied().collect()),
        other => panic!("{path}: no picture is read as {:?}", other.sample_type()),
    };
    Image::new(width, height, image.channels(), samples).expect("the rows are as long as they are many")
}
