//! The levels of an object-space normal map, for both renderers.

use glam::DVec3;
use roughcast::{ImageView, NormalRange};

use crate::{Level, MipmapError};

/// The levels of three textures of an image of object-space normals: their mean, their squares (xx, yy, zz), and their
/// products (xy, xz, yz).
///
/// All three are linear, so that filters may average them; the slopes on a surface follow only where its own normal is known.
/// Normals are normalised; a texel without a direction points nowhere, and the surface's own normal is used there.
///
/// # Errors
/// [`MipmapError::Channels`] if the image has fewer than three channels.
pub fn object_normal_levels<'i>(
    image: impl Into<ImageView<'i>>,
    range: NormalRange,
) -> Result<[Vec<Level>; 3], MipmapError> {
    let image = image.into();
    let (width, height, channels) = (image.width(), image.height(), image.channels());
    if channels < 3 {
        return Err(MipmapError::Channels { name: "object-space normals".to_owned(), channels });
    }
    let normal = |i: usize| {
        let stored = DVec3::from([0, 1, 2].map(|c| f64::from(image.get(i % width, i / width, c))));
        let unit = match range {
            NormalRange::Unorm => stored * 2.0 - 1.0,
            _ => stored,
        };
        if unit.is_finite() { unit.normalize_or_zero() } else { DVec3::ZERO }
    };
    let normals: Vec<DVec3> = (0..width * height).map(normal).collect();
    let levels = |texel: &dyn Fn(&DVec3) -> DVec3| {
        let texels = normals.iter().map(|n| texel(n).as_vec3().extend(1.0).into()).collect();
        let mut levels = vec![Level::new(width, height, texels)?];
        while let Some(next) = levels[levels.len() - 1].coarser() {
            levels.push(next);
        }
        Ok(levels)
    };
    Ok([levels(&|n| *n)?, levels(&|n| *n * *n)?, levels(&|n| DVec3::new(n.x * n.y, n.x * n.z, n.y * n.z))?])
}
