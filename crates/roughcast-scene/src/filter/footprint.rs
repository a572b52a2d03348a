//! A pixel's footprint in texels, limited to finite values.

use glam::DVec2;
use roughcast::Wrap;

use crate::Footprint;

/// Footprint size in texels beyond which all footprints are equivalent: any texture is averaged as a whole.
const HUGE: f64 = 1e9;
/// Distance in texture widths beyond which clamped coordinates are equivalent: all give the edge texel.
const FAR: f64 = 1e6;

/// Converts the footprint to texels of level 0. Non-finite values become the largest footprint.
pub(super) fn in_texels(footprint: &Footprint, (width, height): (usize, usize)) -> Footprint {
    let size = DVec2::new(width as f64, height as f64);
    let texels = |axis: DVec2| {
        let axis = axis * size;
        DVec2::new(finite(axis.x, HUGE), finite(axis.y, HUGE)).clamp(DVec2::splat(-HUGE), DVec2::splat(HUGE))
    };
    Footprint { dx: texels(footprint.dx), dy: texels(footprint.dy) }
}

/// Reduces texture coordinates to the period of their wrap mode, to keep their precision. Non-finite values become 0.
pub(super) fn reduced(uv: DVec2, wrap: Wrap) -> DVec2 {
    let reduce = |x: f64| {
        let x = finite(x, 0.0);
        match wrap {
            Wrap::Repeat => x.rem_euclid(1.0),
            Wrap::Mirror => x.rem_euclid(2.0),
            Wrap::Clamp => x.clamp(-FAR, FAR),
        }
    };
    DVec2::new(reduce(uv.x), reduce(uv.y))
}

fn finite(x: f64, otherwise: f64) -> f64 {
    if x.is_finite() { x } else { otherwise }
}

/// The ellipse that is the image of a circle of one pixel's diameter under a footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipse {
    /// Unit vector along the longer axis.
    pub direction: DVec2,
    /// Length of the longer axis, in the footprint's units.
    pub major: f64,
    /// Length of the shorter axis.
    pub minor: f64,
}

impl Ellipse {
    /// The axes are the singular values of the matrix `[dx dy]`.
    pub fn of(footprint: &Footprint) -> Self {
        let (x, y) = (footprint.dx, footprint.dy);
        let (xx, yy, xy) = (x.x * x.x + y.x * y.x, x.y * x.y + y.y * y.y, x.x * x.y + y.x * y.y);
        let squared = 0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy);
        let major = squared.sqrt();
        // The determinant is the product of both lengths, so the shorter length stays precise even if the other is much
        // longer.
        let minor = if major > 0.0 { (x.perp_dot(y).abs() / major).min(major) } else { 0.0 };
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        Self { direction: DVec2::from_angle(angle), major, minor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_a_rotated_ellipse_are_found() {
        const ROUNDING: f64 = 1e-12; // f64, a few operations
        for degrees in [0.0_f64, 10.0, 45.0, 90.0, 133.0] {
            let along = DVec2::from_angle(degrees.to_radians());
            // Rotating the picture does not change the ellipse.
            for turn in [0.0_f64, 0.3, 2.0] {
                let (sin, cos) = turn.sin_cos();
                let (a, b) = (along * 8.0, along.perp() * 0.5);
                let footprint = Footprint { dx: a * cos + b * sin, dy: b * cos - a * sin };
                let ellipse = Ellipse::of(&footprint);
                assert!((ellipse.major - 8.0).abs() < ROUNDING && (ellipse.minor - 0.5).abs() < ROUNDING);
                assert!(ellipse.direction.perp_dot(along).abs() < ROUNDING);
            }
        }
    }

    #[test]
    fn degenerate_footprints_have_finite_axes() {
        for bad in [0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE] {
            for other in [0.0, bad, 1.0] {
                let raw = Footprint { dx: DVec2::new(bad, other), dy: DVec2::new(other, bad) };
                let ellipse = Ellipse::of(&in_texels(&raw, (4096, 1)));
                assert!(ellipse.major.is_finite() && ellipse.minor.is_finite(), "{raw:?}: {ellipse:?}");
                assert!(ellipse.major >= ellipse.minor && ellipse.direction.is_finite());
            }
        }
    }

    #[test]
    fn coordinates_are_reduced_to_a_period() {
        assert_eq!(reduced(DVec2::new(-0.25, 7.5), Wrap::Repeat), DVec2::new(0.75, 0.5));
        assert_eq!(reduced(DVec2::new(-0.25, 7.5), Wrap::Mirror), DVec2::new(1.75, 1.5));
        assert_eq!(reduced(DVec2::new(f64::NAN, f64::INFINITY), Wrap::Clamp), DVec2::ZERO);
    }
}
