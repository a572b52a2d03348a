//! A shading method as it runs on a GPU: one sample per pixel, at its centre, from filtered detail.

use roughcast::shading::{Shading, ShadingOptions};

use super::shade::{Shaded, material_at};
use super::{Progress, RenderError, render_rows};
use crate::{Detail, DetailPoint, Picture, Scene};

/// A method under test: a model, the source of its bumps, and how it evaluates its lobe.
#[derive(Clone, Copy)]
pub struct Method<'a> {
    /// The model.
    pub shading: Shading,
    /// The source of the bumps.
    pub detail: &'a dyn Detail,
    /// How the lobe is evaluated. Properties that the detail itself specifies, such as an exponent baked into its
    /// textures, take precedence over these options.
    pub options: ShadingOptions,
}

impl Method<'_> {
    /// Renders a picture of `(width, height)` pixels.
    ///
    /// # Errors
    /// [`RenderError::Size`], [`RenderError::Camera`], [`RenderError::Cancelled`].
    pub fn render(
        &self,
        scene: &Scene,
        size: (u32, u32),
        progress: Progress<'_>,
    ) -> Result<Picture, RenderError> {
        let options = self.detail.options(self.options);
        let sampler = self.detail.sampler();
        let rays = scene.camera.pixel_rays(size.0, size.1);
        render_rows(scene, size, progress, |column, row| {
            let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
            let ray = rays.ray(x, y);
            let Some(hit) = scene.shape.hit(&ray) else { return Shaded::background(scene) };
            let (right, below) = (rays.ray(x + 1.0, y), rays.ray(x, y + 1.0));
            let at = DetailPoint::under_pixel(&hit, scene.repeats, (column, row), &right, &below);
            let distribution = self.detail.distribution(&at, &options);
            let surface = self.shading.surface_of(&distribution, &options);
            Shaded::lit(scene, &material_at(scene, &at, &sampler), &ray, &hit, &surface, &options)
        })
    }
}
