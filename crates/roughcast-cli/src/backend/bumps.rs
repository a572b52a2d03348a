//! The bumps of a scene: maps, noise, and the curvature of the surface, as one source.

use glam::DAffine3;
use roughcast::shading::{GeometricFilter, ShadingOptions};
use roughcast::{Distribution, Slope};
use roughcast_scene::{
    BakedTextures, Combined, Curved, Decal, Detail, DetailPoint, HeightDetail, NoiseDetail,
    ObjectNormalDetail, Placement, Sampler, SlopeDetail, Strengthened, Triplanar,
};

/// A map as a source of bumps.
pub enum MapBumps {
    /// The textures of a model.
    Textures { textures: BakedTextures, sampler: Sampler, placement: Placement },
    /// The slopes of level 0, for the ground truth.
    Slopes(SlopeDetail),
    /// Heights, differentiated on the screen.
    Heights(HeightDetail),
    /// Normals in the axes of the mesh.
    ObjectNormals(ObjectNormalDetail),
}

/// Whether a map is projected onto the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projected {
    /// It is not: it uses texture coordinates.
    No,
    /// Along the three axes.
    Triplanar,
    /// Through a box, which this matrix takes to the cube from -1/2 to 1/2.
    Box(DAffine3),
}

/// A map in its place.
pub struct PlacedMap {
    pub map: MapBumps,
    pub projected: Projected,
    /// Factor of the heights.
    pub strength: f32,
}

impl PlacedMap {
    /// Calls a function with the map alone.
    fn with_map<R>(&self, call: impl FnOnce(&dyn Detail) -> R) -> R {
        match &self.map {
            MapBumps::Textures { textures, sampler, placement } => {
                call(&textures.sampled(*sampler).placed(*placement))
            }
            MapBumps::Slopes(slopes) => call(slopes),
            MapBumps::Heights(heights) => call(heights),
            MapBumps::ObjectNormals(normals) => call(normals),
        }
    }

    /// Calls a function with the map in its place.
    fn with_placed<R>(&self, call: impl FnOnce(&dyn Detail) -> R) -> R {
        self.with_map(|detail| match self.projected {
            Projected::No => call(detail),
            Projected::Triplanar => call(&Triplanar::new(detail)),
            Projected::Box(box_from_world) => call(&Decal { detail, box_from_world }),
        })
    }
}

impl Detail for PlacedMap {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.with_placed(|detail| Strengthened { detail, strength: self.strength }.slope(at))
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        self.with_placed(|detail| Strengthened { detail, strength: self.strength }.distribution(at, options))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.with_map(|map| map.options(options))
    }

    fn sampler(&self) -> Sampler {
        self.with_map(|map| map.sampler())
    }
}

/// All bumps of a scene.
pub struct SceneBumps {
    pub maps: Vec<PlacedMap>,
    pub noise: Option<NoiseDetail>,
    pub curvature: Option<GeometricFilter>,
}

impl SceneBumps {
    /// Calls a function with all bumps together.
    fn with_all<R>(&self, call: impl FnOnce(&dyn Detail) -> R) -> R {
        match (self.maps.as_slice(), &self.noise) {
            // One source is not copied into a list: this is called for every sample.
            ([only], None) => self.with_curvature(only, call),
            ([], Some(only)) => self.with_curvature(only, call),
            (maps, noise) => {
                let maps = maps.iter().map(|map| map as &dyn Detail);
                let all = maps.chain(noise.iter().map(|noise| noise as &dyn Detail));
                let parts = all.map(|detail| Strengthened { detail, strength: 1.0 }).collect();
                self.with_curvature(&Combined::new(parts), call)
            }
        }
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
