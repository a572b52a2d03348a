//! Ground truth: many rays per pixel, each shaded with the model's reference at level 0.
//!
//! Source: LEAN mapping, Figure 14: supersampling with a Gaussian pixel filter.

use glam::DVec2;
use roughcast::shading::{PIXEL_STANDARD_DEVIATION, Shading, ShadingOptions};

use super::normal_quantile::normal_quantile;
use super::shade::{Shaded, material_at};
use super::{MAX_SAMPLES, Progress, RenderError, render_rows_of_each};
use crate::split_mix::{GOLDEN_RATIO, scrambled};
use crate::{Detail, DetailPoint, Picture, Ray, Scene};

/// Standard deviation of the pixel filter, in pixels.
pub const PIXEL_FILTER_STANDARD_DEVIATION: f64 = PIXEL_STANDARD_DEVIATION as f64;
/// Radius at which the pixel filter is truncated, in pixels.
pub const PIXEL_FILTER_RADIUS: f64 = 2.0;
/// The fraction of a normal distribution below minus four standard deviations, where the pixel filter is truncated.
const BEYOND: f64 = 3.167_124_183_311_998e-5;

/// The supersampled ground truth of a model's reference, in one form and with one energy.
///
/// Samples are drawn from the pixel filter itself by its quantile function, so that all have the same weight. Their
/// number is a square: one sample in each cell of a square grid of probabilities, jittered by a hash of pixel and
/// sample. The same scene gives bitwise the same result.
#[derive(Clone, Copy)]
pub struct Truth<'a> {
    /// The model under test; its [reference](Shading::reference) is used for shading.
    pub shading: Shading,
    /// The source of the bumps; only its exact slopes are used.
    pub detail: &'a dyn Detail,
    /// How the lobe is evaluated. Roughness in the maps is ignored.
    pub options: ShadingOptions,
    /// Samples per pixel: a square number, 1 ..= [`MAX_SAMPLES`].
    pub samples: u32,
}

impl Truth<'_> {
    /// Renders a picture of `(width, height)` pixels.
    ///
    /// # Errors
    /// [`RenderError::Samples`], [`RenderError::Size`], [`RenderError::Camera`], [`RenderError::Cancelled`].
    pub fn render(
        &self,
        scene: &Scene,
        size: (u32, u32),
        progress: Progress<'_>,
    ) -> Result<Picture, RenderError> {
        Ok(self.render_each(&[self.shading], scene, size, progress)?.remove(0))
    }

    /// The ground truths of several models, in their order, each bitwise equal to the result of [`Truth::render`]. Rays
    /// are traced and slopes are looked up once for all models. [`Truth::shading`] is ignored.
    ///
    /// # Errors
    /// As [`Truth::render`].
    pub fn render_each(
        &self,
        shadings: &[Shading],
        scene: &Scene,
        size: (u32, u32),
        progress: Progress<'_>,
    ) -> Result<Vec<Picture>, RenderError> {
        let side = self.samples.isqrt();
        if side * side != self.samples || !(1..=MAX_SAMPLES).contains(&self.samples) {
            return Err(RenderError::Samples(self.samples));
        }
        let rays = scene.camera.pixel_rays(size.0, size.1);
        render_rows_of_each(shadings.len(), scene, size, progress, |x, y, means| {
            let mut sums = vec![Sum::default(); shadings.len()];
            for at in sample_places((x, y), side) {
                self.add_sample(&mut sums, shadings, scene, &rays.ray(at.x, at.y));
            }
            means.iter_mut().zip(&sums).for_each(|(mean, sum)| *mean = sum.mean(self.samples));
        })
    }

    /// Adds a ray to the sums, shaded with each model.
    #[inline]
    fn add_sample(&self, sums: &mut [Sum], shadings: &[Shading], scene: &Scene, ray: &Ray) {
        let Some(hit) = scene.shape.hit(ray) else {
            let background = Shaded::background(scene);
            return sums.iter_mut().for_each(|sum| sum.add(&background));
        };
        let at = DetailPoint::new(&hit, scene.repeats);
        let slope = self.detail.slope(&at);
        let material = material_at(scene, &at, &self.detail.sampler().finest());
        for (sum, shading) in sums.iter_mut().zip(shadings) {
            let surface = shading.surface_of_slope(slope, &self.options);
            sum.add(&Shaded::lit(scene, &material, ray, &hit, &surface, &self.options));
        }
    }
}

/// The sum of a pixel's samples, in f64.
#[derive(Clone, Copy, Default)]
struct Sum {
    radiance: [f64; 3],
    specular: [f64; 3],
    coverage: f64,
}

impl Sum {
    fn add(&mut self, sample: &Shaded) {
        for channel in 0..3 {
            self.radiance[channel] += f64::from(sample.radiance[channel]);
            self.specular[channel] += f64::from(sample.specular[channel]);
        }
        self.coverage += f64::from(sample.coverage);
    }

    fn mean(&self, samples: u32) -> Shaded {
        let mean = |sum: f64| (sum / f64::from(samples)) as f32;
        Shaded {
            radiance: self.radiance.map(mean),
            specular: self.specular.map(mean),
            coverage: mean(self.coverage),
        }
    }
}

/// The positions of a pixel's `side` times `side` samples, in pixels of the picture.
fn sample_places((x, y): (u32, u32), side: u32) -> impl Iterator<Item = DVec2> {
    let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let cells = (0..side).flat_map(move |row| (0..side).map(move |column| (column, row)));
    cells.map(move |(column, row)| {
        let jitter = jitter(x, y, row * side + column);
        let cell = (DVec2::new(f64::from(column), f64::from(row)) + jitter) / f64::from(side);
        centre + DVec2::new(pixel_filter_quantile(cell.x), pixel_filter_quantile(cell.y))
    })
}

/// The quantile function of the pixel filter: the position, in pixels from the centre, below which it has this
/// probability.
pub(crate) fn pixel_filter_quantile(probability: f64) -> f64 {
    PIXEL_FILTER_STANDARD_DEVIATION * normal_quantile(BEYOND + probability * (1.0 - 2.0 * BEYOND))
}

/// Two numbers in 0 .. 1 from a pixel and a sample (SplitMix64, by S. Vigna).
fn jitter(x: u32, y: u32, sample: u32) -> DVec2 {
    const UNIT: f64 = 1.0 / (1_u64 << 32) as f64;
    // Pixels are fewer than 2^26 and samples at most 2^12 = 4096; with 26 bits each for x and y, all indices are
    // distinct.
    let index = (u64::from(y) << 38) ^ (u64::from(x) << 12) ^ u64::from(sample);
    let z = scrambled(index.wrapping_add(1).wrapping_mul(GOLDEN_RATIO));
    DVec2::new((z >> 32) as f64 + 0.5, (z & 0xffff_ffff) as f64 + 0.5) * UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_drawn_from_the_truncated_filter() {
        assert!((pixel_filter_quantile(0.0) + PIXEL_FILTER_RADIUS).abs() < 1e-6);
        assert!((pixel_filter_quantile(1.0) - PIXEL_FILTER_RADIUS).abs() < 1e-6);
        assert_eq!(pixel_filter_quantile(0.5), 0.0);
        let count = 100_000;
        let variance =
            (0..count).map(|i| pixel_filter_quantile((f64::from(i) + 0.5) / f64::from(count)).powi(2));
        let variance = variance.sum::<f64>() / f64::from(count);
        // The part beyond four standard deviations is missing, which is a thousandth of the variance.
        assert!((variance / PIXEL_FILTER_STANDARD_DEVIATION.powi(2) - 1.0).abs() < 2e-3, "{variance}");
    }

    #[test]
    fn jitter_fills_the_unit_square_evenly_and_differs_from_pixel_to_pixel() {
        let count = 64 * 64;
        let all: Vec<DVec2> = (0..64).flat_map(|x| (0..64).map(move |s| jitter(x, 7, s))).collect();
        let mean = all.iter().copied().sum::<DVec2>() / f64::from(count);
        let product = all.iter().map(|j| (j.x - 0.5) * (j.y - 0.5)).sum::<f64>() / f64::from(count);
        // Standard deviations of these means: 1 / sqrt(12 * 4096) = 0.0045, and 1 / 12 / 64 = 0.0013.
        assert!((mean - 0.5).abs().max_element() < 0.02 && product.abs() < 0.005, "{mean} {product}");
        assert!(all.iter().all(|j| j.min_element() > 0.0 && j.max_element() < 1.0));
        assert_ne!(jitter(0, 1, 0), jitter(1, 0, 0));
    }
}
