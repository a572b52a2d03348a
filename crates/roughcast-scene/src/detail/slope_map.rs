//! A map's slopes at level 0. The ground truth interpolates between its texels.

use glam::DVec2;
use roughcast::texture::MomentLevel;
use roughcast::{Bake, BakeError, ImageView, Slope, SourceOptions, Wrap};

use crate::mipmap::{square_at, whole_and_rest, wrapped};

roughcast::named_enum! {
    /// The shape of the surface between the texels of its map.
    #[non_exhaustive]
    pub enum Reconstruction: "reconstruction" {
        /// Slopes are interpolated bilinearly, which gives a surface without creases, as seen in a texture viewed from
        /// near. If slopes change from texel to texel, it is a little smoother than the map's own moments indicate.
        Linear = "linear",
        /// One facet per texel. The surface is creased, and its moments over whole texels are exactly the map's.
        Facets = "facets",
    }
}

/// Slopes, row by row from the top, as single floats before any packing.
#[derive(Clone, Debug, PartialEq)]
pub struct SlopeMap {
    width: usize,
    height: usize,
    slopes: Vec<[f32; 2]>,
}

impl SlopeMap {
    /// The slopes of a map, as read by the library.
    ///
    /// # Errors
    /// [`BakeError`] if the map cannot be read.
    pub fn of<'m>(map: impl Into<ImageView<'m>>, options: &SourceOptions) -> Result<Self, BakeError> {
        let levels = Bake::of(map).source(*options).moments()?;
        Ok(Self::of_level(&levels[0]))
    }

    /// The mean slopes of a level.
    pub fn of_level(level: &MomentLevel) -> Self {
        let slopes = level.moments().iter().map(|m| [m.mean.x, m.mean.y]).collect();
        Self { width: level.width(), height: level.height(), slopes }
    }

    /// Width and height, in texels.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The slope at texture coordinates.
    #[inline]
    pub fn at(&self, uv: DVec2, wrap: Wrap, reconstruction: Reconstruction) -> Slope {
        let at = uv * DVec2::new(self.width as f64, self.height as f64);
        match reconstruction {
            Reconstruction::Linear => self.interpolated(at - 0.5, wrap),
            Reconstruction::Facets => {
                let x = wrapped(at.x.floor() as i64, self.width, wrap);
                let y = wrapped(at.y.floor() as i64, self.height, wrap);
                let [x, y] = self.slopes[y * self.width + x];
                Slope { x, y }
            }
        }
    }

    #[inline]
    fn interpolated(&self, at: DVec2, wrap: Wrap) -> Slope {
        let ((left, s), (top, t)) = (whole_and_rest(at.x), whole_and_rest(at.y));
        let (s, t) = (s as f32, t as f32);
        let [a, b, c, d] = square_at((left, top), self.size(), wrap).map(|texel| self.slopes[texel]);
        let mix = |i: usize| (1.0 - t) * ((1.0 - s) * a[i] + s * b[i]) + t * ((1.0 - s) * c[i] + s * d[i]);
        Slope { x: mix(0), y: mix(1) }
    }
}

#[cfg(test)]
mod tests {
    use roughcast::Moments;

    use super::*;

    fn map(width: usize, slopes: &[f32]) -> SlopeMap {
        let moments = slopes.iter().map(|x| Moments::of_slope(Slope { x: *x, y: -x })).collect();
        SlopeMap::of_level(&MomentLevel::new(width, slopes.len() / width, moments).unwrap())
    }

    #[test]
    fn slopes_are_those_of_the_texels_at_their_centres_and_linear_between() {
        let map = map(2, &[0.0, 1.0, 2.0, 3.0]);
        let at = |x: f64, y: f64, how| map.at(DVec2::new(x, y), Wrap::Repeat, how).x;
        assert_eq!(at(0.25, 0.25, Reconstruction::Linear), 0.0);
        assert_eq!(at(0.75, 0.25, Reconstruction::Linear), 1.0);
        assert_eq!(at(0.5, 0.5, Reconstruction::Linear), 1.5);
        assert_eq!(at(0.0, 0.25, Reconstruction::Linear), 0.5);
        assert_eq!(at(0.49, 0.51, Reconstruction::Facets), 2.0);
        assert_eq!(at(-0.01, 1.49, Reconstruction::Facets), 1.0);
        assert_eq!(
            map.at(DVec2::new(0.25, 0.75), Wrap::Repeat, Reconstruction::Linear),
            Slope { x: 2.0, y: -2.0 }
        );
    }

    #[test]
    fn coordinates_without_a_place_give_slopes_of_the_map() {
        let map = map(2, &[1.0, 2.0, 3.0, 4.0]);
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
            for at in [DVec2::new(odd, 0.3), DVec2::new(0.3, odd), DVec2::splat(odd)] {
                for (how, wrap) in
                    Reconstruction::ALL.iter().flat_map(|h| Wrap::ALL.iter().map(move |w| (h, w)))
                {
                    let Slope { x, y } = map.at(at, *wrap, *how);
                    assert!((1.0..=4.0).contains(&x) && y == -x, "{at}, {wrap}, {how}: ({x}, {y})");
                }
            }
        }
    }
}
