//! The bumps of a scene: a map's part, noise, and the curvature of the surface, as one source.

use roughcast::shading::{GeometricFilter, ShadingOptions};
use roughcast::{Distribution, Slope};
use roughcast_scene::{
    BakedTextures, Combined, Curved, Detail, DetailPoint, HeightDetail, NoiseDetail, ObjectNormalDetail,
    Placement, Sampler, SlopeDetail, Strengthened, Triplanar,
};

/// A map as a source of bumps.
pub enum MapBumps {
    /// No map.
    None,
    /// The textures of a model.
    Textures { textures: BakedTextures, sampler: Sampler, placement: Placement },
    /// The slopes of level 0, for the ground truth.
    Slopes(SlopeDetail),
    /// Heights, differentiated on the screen.
    Heights(HeightDetail),
    /// Normals in the axes of the mesh.
    ObjectNormals(ObjectNormalDetail),
}

/// Whether the map is projected along the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projected {
    No,
    Triplanar,
}

/// All bumps of a scene.
pub struct SceneBumps {
    pub map: MapBumps,
    pub projected: Projected,
    pub noise: Option<NoiseDetail>,
    pub curvature: Option<GeometricFilter>,
}

impl SceneBumps {
    /// Calls a function with the map alone.
    fn with_map<R>(&self, call: impl FnOnce(Option<&dyn Detail>) -> R) -> R {
        match &self.map {
            MapBumps::None => call(None),
            MapBumps::Textures { textures, sampler, placement } => {
                call(Some(&textures.sampled(*sampler).placed(*placement)))
            }
            MapBumps::Slopes(slopes) => call(Some(slopes)),
            MapBumps::Heights(heights) => call(Some(heights)),
            MapBumps::ObjectNormals(normals) => call(Some(normals)),
        }
    }

    /// Calls a function with all bumps together.
    fn with_all<R>(&self, call: impl FnOnce(&dyn Detail) -> R) -> R {
        self.with_map(|map| {
            let projected = map.map(Triplanar::new);
            let map = match (&projected, self.projected) {
                (Some(projected), Projected::Triplanar) => Some(projected as &dyn Detail),
                _ => map,
            };
            let noise = self.noise.as_ref().map(|noise| noise as &dyn Detail);
            match (map, noise) {
                // One source is not copied into a list: this is called for every sample.
                (Some(only), None) | (None, Some(only)) => self.with_curvature(only, call),
                (map, noise) => {
                    let parts = map.into_iter().chain(noise);
                    let parts = parts.map(|detail| Strengthened { detail, strength: 1.0 }).collect();
                    self.with_curvature(&Combined::new(parts), call)
                }
            }
        })
    }

    fn with_curvature<R>(&self, detail: &dyn Detail, call: impl FnOnce(&dyn Detail) -> R) -> R {
        match self.curvature {
            Some(filter) => call(&Curved { detail, filter }),
            None => call(detail),
        }
    }
}

impl Detail for SceneBumps {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.with_all(|detail| detail.slope(at))
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        self.with_all(|detail| detail.distribution(at, options))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.with_all(|detail| detail.options(options))
    }

    fn sampler(&self) -> Sampler {
        self.with_all(|detail| detail.sampler())
    }
}
