//! Object-space normal maps: normals in the axes of the mesh, which need no tangents.

use glam::{DMat3, DVec3};
use roughcast::shading::ShadingOptions;
use roughcast::surface_gradient::surface_gradient_of_normal;
use roughcast::{Covariance, Distribution, ImageView, Normal, NormalRange, Slope};

use super::{Detail, DetailPoint, object_normal_levels};
use crate::{Footprint, Mipmap, MipmapError, Sampler, Side};

/// The unit normals of a map with their levels, and their second moments. They are linear, so that filters may average
/// them; the slopes on a surface follow only where its own normal is known.
#[derive(Clone, Debug)]
pub struct ObjectNormalMap {
    /// Mean normals, and the moments xx, yy, zz, then xy, xz, yz.
    textures: [Mipmap; 3],
}

impl ObjectNormalMap {
    /// The normals of an image of three or more channels, x, y and z in the axes of the mesh. They are normalised; a texel
    /// without a direction points nowhere, and the surface's own normal is used there.
    ///
    /// # Errors
    /// [`MipmapError::Channels`] if the image has fewer than three channels.
    pub fn of<'i>(image: impl Into<ImageView<'i>>, range: NormalRange) -> Result<Self, MipmapError> {
        let [mean, squares, products] = object_normal_levels(image, range)?;
        Ok(Self { textures: [Mipmap::new(mean)?, Mipmap::new(squares)?, Mipmap::new(products)?] })
    }

    /// The mean normal and the covariance of the normals under a footprint.
    fn sampled(&self, sampler: &Sampler, uv: glam::DVec2, footprint: &Footprint) -> (DVec3, DMat3) {
        let [mean, squares, products] = self.textures.each_ref().map(|texture| {
            let [x, y, z, _] = sampler.sample(texture, uv, footprint).map(f64::from);
            DVec3::new(x, y, z)
        });
        let second = DMat3::from_cols(
            DVec3::new(squares.x, products.x, products.y),
            DVec3::new(products.x, squares.y, products.z),
            DVec3::new(products.y, products.z, squares.z),
        );
        (mean, second - DMat3::from_cols(mean * mean.x, mean * mean.y, mean * mean.z))
    }
}

/// An object-space normal map on a surface. The scene's world space is the object's.
#[derive(Clone, Debug)]
pub struct ObjectNormalDetail {
    /// The normals.
    pub normals: ObjectNormalMap,
    /// The texture filter.
    pub sampler: Sampler,
    /// The set of texture coordinates.
    pub uv_set: usize,
}

impl ObjectNormalDetail {
    /// The slope of a normal of the front: that of its surface gradient.
    fn slope_of(at: &DetailPoint<'_>, normal: DVec3) -> Slope {
        let surface = match at.hit().side {
            Side::Front => at.hit().frame.normal(),
            Side::Back => -at.hit().frame.normal(),
        };
        at.slope_of_gradient(surface_gradient_of_normal(surface, normal))
    }
}

impl Detail for ObjectNormalDetail {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let finest = self.sampler.with_filter(crate::Filter::Trilinear).with_level(Some(0.0));
        let (normal, _) = self.normals.sampled(&finest, at.uv(self.uv_set), &Footprint::default());
        Self::slope_of(at, normal)
    }

    /// The slope of the mean normal, and the covariance of the normals seen from it: a slope is `(n·t, n·b) / (n·m)` with
    /// the surface's normal m, which is linearised about the mean.
    fn distribution(&self, at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        let (mean, spread) =
            self.normals.sampled(&self.sampler, at.uv(self.uv_set), &at.footprint(self.uv_set));
        let slope = Self::slope_of(at, mean);
        let hit = at.hit();
        let along = hit.frame.normal().dot(mean).abs();
        let [t, b] = hit.frame.tangent_covectors();
        let [x, y] = [(t, slope.x), (b, slope.y)]
            .map(|(axis, slope)| (axis - hit.frame.normal() * f64::from(slope)) / along);
        let covariance = Covariance {
            xx: x.dot(spread * x) as f32,
            yy: y.dot(spread * y) as f32,
            xy: x.dot(spread * y) as f32,
        };
        let covariance = if covariance.trace().is_finite() {
            covariance.positive_semidefinite()
        } else {
            Covariance::default()
        };
        let shortened = Distribution::gaussian(slope, covariance);
        let Normal { x, y, z } = shortened.normal();
        let length = mean.length() as f32;
        shortened.with_normal(Normal { x: x * length, y: y * length, z: z * length })
    }

    fn sampler(&self) -> Sampler {
        self.sampler
    }
}
