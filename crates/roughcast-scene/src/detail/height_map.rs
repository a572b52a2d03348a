//! The heights of a map, with its levels.

use glam::DVec2;
use roughcast::{BakeError, ImageView, SourceOptions, Wrap};

use super::height_texture;
use crate::mipmap::{whole_and_rest, wrapped};
use crate::{Level, Mipmap};

/// Heights in texels of level 0, averaged into levels.
#[derive(Clone, Debug)]
pub struct HeightMap {
    levels: Mipmap,
}

impl HeightMap {
    /// The heights of a height map: see [`height_texture`].
    ///
    /// # Errors
    /// [`BakeError`] if the map cannot be read as one.
    pub fn of<'m>(map: impl Into<ImageView<'m>>, options: &SourceOptions) -> Result<Self, BakeError> {
        let texture = height_texture(map, options)?;
        Ok(Self { levels: Mipmap::of(&texture).expect("one channel") })
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        self.levels.size()
    }

    /// The levels, as a sampler reads them: heights in the first channel.
    pub fn levels(&self) -> &Mipmap {
        &self.levels
    }

    /// The change of the height along a unit of each texture coordinate at level 0, interpolated bilinearly. Its derivative
    /// jumps at the centres of texels.
    pub(super) fn bilinear_gradient(&self, uv: DVec2, wrap: Wrap) -> DVec2 {
        let level = &self.levels.levels()[0];
        let size = DVec2::new(level.width() as f64, level.height() as f64);
        let at = uv * size - 0.5;
        let ((left, s), (top, t)) = (whole_and_rest(at.x), whole_and_rest(at.y));
        let [a, b, c, d] = level.square((left, top), wrap).map(|texel| f64::from(texel[0]));
        DVec2::new((b - a) * (1.0 - t) + (d - c) * t, (c - a) * (1.0 - s) + (d - b) * s) * size
    }

    /// The same of a bicubic B-spline through the texels of two levels: smooth everywhere.
    pub(super) fn bicubic_gradient(&self, uv: DVec2, level: f64, wrap: Wrap) -> DVec2 {
        let levels = self.levels.levels();
        let level = if level > 0.0 { level.min((levels.len() - 1) as f64) } else { 0.0 };
        let finer = level as usize;
        let blend = level - finer as f64;
        let fine = bicubic_gradient(&levels[finer], uv, wrap);
        if blend == 0.0 { fine } else { fine.lerp(bicubic_gradient(&levels[finer + 1], uv, wrap), blend) }
    }
}

/// Weights of four texels of a uniform cubic B-spline at a fraction of the way between the middle two.
fn cubic_weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let middle = |t: f64| (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    [s * s * s / 6.0, middle(t), middle(s), t * t * t / 6.0]
}

/// Their derivatives.
fn cubic_derivatives(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let middle = |t: f64| 0.5 * t * (3.0 * t - 4.0);
    [-0.5 * s * s, middle(t), -middle(s), 0.5 * t * t]
}

fn bicubic_gradient(level: &Level, uv: DVec2, wrap: Wrap) -> DVec2 {
    let size = DVec2::new(level.width() as f64, level.height() as f64);
    let at = uv * size - 0.5;
    let ((left, s), (top, t)) = (whole_and_rest(at.x), whole_and_rest(at.y));
    let (of_x, of_y) = (cubic_weights(s), cubic_weights(t));
    let (along_x, along_y) = (cubic_derivatives(s), cubic_derivatives(t));
    let place =
        |first: i64, i: usize, length: usize| wrapped(first.saturating_add(i as i64 - 1), length, wrap);
    let mut gradient = DVec2::ZERO;
    for row in 0..4 {
        let y = place(top, row, level.height());
        for column in 0..4 {
            let height = f64::from(level.texel(place(left, column, level.width()), y)[0]);
            gradient += DVec2::new(along_x[column] * of_y[row], of_x[column] * along_y[row]) * height;
        }
    }
    gradient * size
}

#[cfg(test)]
mod tests {
    use roughcast::{Image, Kind, Samples};

    use super::*;

    /// Rounding of single floats in heights of up to a few texels, times the size of the map.
    const SINGLE: f64 = 1e-4;

    fn wave(size: usize) -> HeightMap {
        let texel = |i: usize| {
            let (x, y) = ((i % size) as f64 + 0.5, (i / size) as f64 + 0.5);
            let phase = std::f64::consts::TAU / size as f64;
            ((2.0 * phase * x).sin() * (phase * y).cos() / size as f64) as f32
        };
        let image = Image::new(size, size, 1, Samples::F32((0..size * size).map(texel).collect())).unwrap();
        let options = SourceOptions::default().with_kind(Kind::Height).with_height_scale(1.0);
        HeightMap::of(&image, &options).unwrap()
    }

    #[test]
    fn heights_are_in_texels_and_levels_are_averages() {
        let map = wave(32);
        let highest = map.levels().levels()[0].row(0).iter().fold(0.0_f32, |a, t| a.max(t[0]));
        assert!((highest - 1.0).abs() < 0.03, "{highest}");
        let last = map.levels().levels().last().unwrap().texel(0, 0)[0];
        assert!(last.abs() < 1e-6, "{last}");
    }

    #[test]
    fn the_spline_sums_to_one_and_reproduces_a_slope() {
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let (weights, derivatives) = (cubic_weights(t), cubic_derivatives(t));
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(derivatives.iter().sum::<f64>().abs() < 1e-15);
            let slope: f64 = derivatives.iter().enumerate().map(|(i, w)| w * i as f64).sum();
            assert!((slope - 1.0).abs() < 1e-15);
            let numeric: Vec<f64> = cubic_weights(t + 1e-6)
                .iter()
                .zip(cubic_weights(t - 1e-6))
                .map(|(a, b)| (a - b) / 2e-6)
                .collect();
            assert!(numeric.iter().zip(derivatives).all(|(a, b)| (a - b).abs() < 1e-9));
        }
    }

    #[test]
    fn gradients_are_those_of_the_wave() {
        // A spline through samples of a wave weakens it: its kernel has sinc^4(f) of the frequency f per texel, here 2/64
        // and 1/64, and the samples are not those of its coefficients.
        let map = wave(64);
        let tau = std::f64::consts::TAU;
        for uv in [DVec2::new(0.13, 0.21), DVec2::new(0.5, 0.77), DVec2::new(0.98, 0.02)] {
            let exact = DVec2::new(
                2.0 * tau * (2.0 * tau * uv.x).cos() * (tau * uv.y).cos(),
                -tau * (2.0 * tau * uv.x).sin() * (tau * uv.y).sin(),
            );
            let cubic = map.bicubic_gradient(uv, 0.0, Wrap::Repeat);
            assert!((cubic - exact).length() < 0.01 * 2.0 * tau, "{cubic} {exact}");
            let linear = map.bilinear_gradient(uv, Wrap::Repeat);
            assert!((linear - exact).length() < 0.12 * 2.0 * tau, "{linear} {exact}");
        }
        // Between two levels.
        let between = map.bicubic_gradient(DVec2::new(0.13, 0.21), 1.5, Wrap::Repeat);
        let (one, two) = (
            map.bicubic_gradient(DVec2::new(0.13, 0.21), 1.0, Wrap::Repeat),
            map.bicubic_gradient(DVec2::new(0.13, 0.21), 2.0, Wrap::Repeat),
        );
        assert!((between - (one + two) * 0.5).length() < SINGLE);
    }
}
