//! A perceptual colour scale for error pictures: from black via violet and red to white, with uniformly growing lightness.
//!
//! Source of the colour space: B. Ottosson, "A perceptual color space for image processing" (Oklab), 2020.

use roughcast_io::picture::Srgb8Picture;

use crate::display::srgb8;

/// Hue of the darkest and of the brightest colours, in degrees.
const HUES: (f64, f64) = (290.0, 450.0);
/// Chroma of the middle of the scale: the largest that sRGB has for all its hues.
const CHROMA: f64 = 0.15;

/// The colour of an error from 0 to 1.
pub fn colour(error: f32) -> [u8; 3] {
    let t = f64::from(error.clamp(0.0, 1.0));
    let hue = (HUES.0 + t * (HUES.1 - HUES.0)).to_radians();
    let chroma = CHROMA * 4.0 * t * (1.0 - t);
    linear_from_oklab([t, chroma * hue.cos(), chroma * hue.sin()]).map(|value| srgb8(value as f32))
}

/// Number of colours of an error picture: as many as are distinguishable on the scale, and few enough for a small file.
const STEPS: f32 = 24.0;

/// Errors from 0 to 1, row by row, as a picture of [`STEPS`] colours.
pub fn error_picture(width: usize, errors: &[f32]) -> Srgb8Picture {
    let last = STEPS - 1.0;
    let pixels = errors.iter().flat_map(|error| colour((error * last).round() / last)).collect();
    Srgb8Picture::new(width as u32, (errors.len() / width) as u32, pixels).expect("whole rows of errors")
}

/// The scale itself, from 0 at the left to 1 at the right.
pub fn legend(width: u32, height: u32) -> Srgb8Picture {
    let row = (0..width).map(|x| (x as f32 + 0.5) / width as f32).collect::<Vec<_>>();
    error_picture(width as usize, &row.repeat(height as usize))
}

/// Linear sRGB from Oklab.
fn linear_from_oklab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_goes_from_black_to_white_and_is_nowhere_out_of_range() {
        assert_eq!((colour(0.0), colour(1.0)), ([0; 3], [255; 3]));
        assert_eq!((colour(-1.0), colour(7.0)), ([0; 3], [255; 3]));
        for step in 0..=100 {
            let t = f64::from(step) / 100.0;
            let (hue, chroma) = ((290.0 + 160.0 * t).to_radians(), 4.0 * CHROMA * t * (1.0 - t));
            let linear = linear_from_oklab([t, chroma * hue.cos(), chroma * hue.sin()]);
            // The published matrices are rounded.
            assert!(linear.iter().all(|value| (-2e-3..1.002).contains(value)), "{t}: {linear:?}");
        }
    }

    #[test]
    fn larger_errors_are_brighter() {
        let luminance = |tenths: u8| {
            let [r, g, b] = colour(f32::from(tenths) / 10.0).map(f64::from);
            0.2126 * r.powf(2.2) + 0.7152 * g.powf(2.2) + 0.0722 * b.powf(2.2)
        };
        assert!((0..10).all(|tenths| luminance(tenths) < luminance(tenths + 1)));
    }

    #[test]
    fn pictures_have_a_pixel_for_every_error() {
        let picture = error_picture(3, &[0.0, 0.5, 1.0, 1.0, 0.5, 0.0]);
        assert_eq!((picture.width(), picture.height(), picture.pixels().len()), (3, 2, 18));
        assert_eq!(picture.pixels()[6..12], [255; 6]);
        assert_eq!(legend(8, 2).pixels().len(), 48);
        let colours: std::collections::BTreeSet<[u8; 3]> =
            legend(1024, 1).pixels().as_chunks().0.iter().copied().collect();
        assert_eq!(colours.len(), STEPS as usize);
    }
}
