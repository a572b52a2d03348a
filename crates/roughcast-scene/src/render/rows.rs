//! Fills pictures row by row, on all threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::shade::Shaded;
use super::{MAX_PIXELS, Progress, RenderError};
use crate::{Picture, Scene};

/// Fills a picture. The result is bitwise the same for any number of threads, because pixels do not depend on each
/// other.
pub(super) fn render_rows(
    scene: &Scene,
    size: (u32, u32),
    progress: Progress<'_>,
    pixel: impl Fn(u32, u32) -> Shaded + Sync,
) -> Result<Picture, RenderError> {
    let mut pictures = render_rows_of_each(1, scene, size, progress, |x, y, each| each[0] = pixel(x, y))?;
    Ok(pictures.remove(0))
}

/// Fills `count` pictures at once, like [`render_rows`]; `pixel` gets one slot per picture.
pub(super) fn render_rows_of_each(
    count: usize,
    scene: &Scene,
    (width, height): (u32, u32),
    progress: Progress<'_>,
    pixel: impl Fn(u32, u32, &mut [Shaded]) + Sync,
) -> Result<Vec<Picture>, RenderError> {
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(RenderError::Size(width, height));
    }
    scene.camera.validate()?;
    let mut pictures = vec![Picture::empty(width as usize, height as usize); count];
    let (done, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    rows_of_each(&mut pictures, height as usize).into_par_iter().enumerate().for_each(|(y, mut rows)| {
        if stopped.load(Ordering::Relaxed) {
            return;
        }
        let mut shaded = vec![Shaded::default(); count];
        for x in 0..width as usize {
            pixel(x as u32, y as u32, &mut shaded);
            rows.iter_mut().zip(&shaded).for_each(|(row, shaded)| row.set(x, shaded));
        }
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if progress(done, height as usize).is_break() {
            stopped.store(true, Ordering::Relaxed);
        }
    });
    if stopped.into_inner() { Err(RenderError::Cancelled) } else { Ok(pictures) }
}

/// A row of a picture that is being rendered.
struct Row<'a> {
    radiance: &'a mut [[f32; 3]],
    specular: &'a mut [[f32; 3]],
    coverage: &'a mut [f32],
}

impl Row<'_> {
    fn set(&mut self, x: usize, shaded: &Shaded) {
        (self.radiance[x], self.specular[x], self.coverage[x]) =
            (shaded.radiance, shaded.specular, shaded.coverage);
    }
}

/// For every row index, that row of each picture.
fn rows_of_each(pictures: &mut [Picture], height: usize) -> Vec<Vec<Row<'_>>> {
    let mut rows: Vec<Vec<Row<'_>>> = (0..height).map(|_| Vec::with_capacity(pictures.len())).collect();
    for picture in pictures {
        for (row, (radiance, specular, coverage)) in rows.iter_mut().zip(picture.rows_mut()) {
            row.push(Row { radiance, specular, coverage });
        }
    }
    rows
}
