//! The size of a pixel on the ground: OGC GeoTIFF 1.1 (<https://docs.ogc.org/is/19-008r4/19-008r4.html>).

use super::directory::{Directory, tag};
use crate::{LengthUnit, PixelSize};

/// The key of the type of the coordinates.
const GT_MODEL_TYPE: u64 = 1024;
/// The key of the unit of projected coordinates.
const PROJ_LINEAR_UNITS: u64 = 3076;

/// The pixel width stated in the file; `None` if it is missing or unusable.
pub(super) fn pixel_size(directory: &Directory<'_>) -> Option<PixelSize> {
    let width = width_of(directory)?;
    if !(width.is_finite() && width > 0.0) {
        return None;
    }
    const PROJECTED: u64 = 1;
    const GEOGRAPHIC: u64 = 2;
    let unit = match key(directory, GT_MODEL_TYPE) {
        Some(GEOGRAPHIC) => LengthUnit::Degree,
        Some(PROJECTED) => match key(directory, PROJ_LINEAR_UNITS) {
            Some(9001) => LengthUnit::Metre,
            // International and US survey feet differ by 2 in a million.
            Some(9002 | 9003) => LengthUnit::Foot,
            _ => LengthUnit::Unstated,
        },
        _ => LengthUnit::Unstated,
    };
    Some(PixelSize { width, unit })
}

fn width_of(directory: &Directory<'_>) -> Option<f64> {
    if let Some(scale) = directory.values(tag::MODEL_PIXEL_SCALE).ok()? {
        return scale.double(0);
    }
    // A 4x4 matrix in row-major order: the first column is the step to the next pixel.
    let matrix = directory.values(tag::MODEL_TRANSFORMATION).ok()??;
    Some(matrix.double(0)?.hypot(matrix.double(4)?))
}

/// The value of a key that is stored in the key directory itself.
fn key(directory: &Directory<'_>, wanted: u64) -> Option<u64> {
    let keys = directory.values(tag::GEO_KEY_DIRECTORY).ok()??;
    // Four numbers per key: key, location of the value (0 for "here"), count, value. The first four numbers are a
    // header.
    let entries = (1..keys.len() / 4).map(|entry| [0, 1, 3].map(|field| keys.unsigned(entry * 4 + field)));
    entries.into_iter().find_map(|entry| match entry {
        [Some(key), Some(0), value] if key == wanted => value,
        _ => None,
    })
}
