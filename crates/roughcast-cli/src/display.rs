//! Converts linear radiance to displayable colours.

use roughcast_io::picture::Srgb8Picture;
use roughcast_scene::Picture;

use crate::tone::Tone;

/// The fraction of a picture's values that automatic exposure keeps below white.
const KEPT: f64 = 0.99;

/// An exposure that puts all but the brightest hundredth of a picture's lit pixels below white; one for a black
/// picture. A highlight is a small part of a picture, so it may be overexposed only where it is much brighter than the
/// rest.
pub fn exposure_of(picture: &Picture) -> f32 {
    let brightest = |[r, g, b]: &[f32; 3]| r.max(*g).max(*b);
    let mut values: Vec<f32> =
        picture.radiance().iter().map(brightest).filter(|value| *value > 0.0).collect();
    values.sort_by(f32::total_cmp);
    match values.get((values.len() as f64 * KEPT) as usize) {
        Some(white) => 1.0 / white,
        None => 1.0,
    }
}

/// The picture at an exposure, in sRGB; values brighter than white are clamped to white. For pictures that are compared,
/// because it changes no other value.
pub fn shown(picture: &Picture, exposure: f32) -> Srgb8Picture {
    toned(picture, exposure, Tone::Linear)
}

/// The picture at an exposure, through a tone curve, in sRGB.
pub fn toned(picture: &Picture, exposure: f32, tone: Tone) -> Srgb8Picture {
    let pixel = |radiance: &[f32; 3]| tone.shown(radiance.map(|value| value * exposure)).map(srgb8);
    let pixels = picture.radiance().iter().flat_map(pixel);
    let (width, height) = (picture.width() as u32, picture.height() as u32);
    Srgb8Picture::new(width, height, pixels.collect()).expect("rendered pictures have pixels")
}

/// Encodes a linear value in sRGB (IEC 61966-2-1). NaN is black.
pub fn srgb8(linear: f32) -> u8 {
    let linear = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_has_its_known_codes() {
        for (linear, code) in [(0.0, 0), (0.214_041, 127), (0.5, 188), (1.0, 255), (7.0, 255), (-1.0, 0)] {
            assert_eq!(srgb8(linear), code, "{linear}");
        }
        assert_eq!(srgb8(f32::NAN), 0);
    }
}
