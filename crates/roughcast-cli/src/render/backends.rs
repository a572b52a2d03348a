//! What renders, with the bumps that it needs, as the arguments choose them.

use std::borrow::Cow;

use anyhow::{Context, Result};
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast::{Kind, Wrap};
use roughcast_pipeline::{Map, bake_for};
use roughcast_scene::{
    BakedTextures, HeightDetail, HeightMap, ObjectNormalDetail, ObjectNormalMap, Placement, Sampler, Scene,
    SlopeDetail, SlopeMap,
};
#[cfg(feature = "gpu")]
use roughcast_scene::{NoiseDetail, height_texture};

use super::{Added, Args, FilterChoice, Subject};
use crate::added::{AddedContent, AddedMap, Place};
use crate::backend::{
    Backend, GroundTruthBackend, MapBumps, MethodBackend, PlacedMap, Projected, SceneBumps,
};
#[cfg(feature = "gpu")]
use crate::backend::{GpuBackend, GpuBumps, GpuMap, PlacedGpuMap};
use crate::bumps::{Bump, FrameChoice};
use crate::usage;

impl Args {
    /// The renderer, with the bumps that it needs.
    pub(super) fn backend(&self, subject: &Subject, added: &[Added<'_>], scene: &Scene) -> Result<Backend> {
        let shading = self.model(subject)?;
        let bump = self.bumps.of_map(self.map.is_some())?;
        let noise = self.bumps.noise(scene.shape.bounds().radius)?;
        #[cfg(feature = "gpu")]
        if self.gpu {
            return self.gpu_backend(subject, scene, shading, bump, (added, noise));
        }
        let mut maps = Vec::new();
        if let Some(map) = self.map_bumps(subject, scene, shading, bump)? {
            let projected = match self.bumps.frame {
                FrameChoice::Triplanar => Projected::Triplanar,
                _ => Projected::No,
            };
            maps.push(PlacedMap { map, projected, strength: self.bumps.strength.unwrap_or(1.0) });
        }
        for (map, content) in added {
            maps.push(self.added_bumps(map, content, scene, shading)?);
        }
        let bumps = SceneBumps { maps, noise, curvature: self.bumps.curvature() };
        let (size, options) = ((self.size.width, self.size.height), self.shading_options.shading_options());
        Ok(match self.samples() {
            Some(samples) => {
                Backend::GroundTruth(GroundTruthBackend { bumps, shading, options, samples, size })
            }
            None => Backend::Method(MethodBackend { shading, bumps, options, size }),
        })
    }

    /// The first map, if there is one.
    fn map_bumps(
        &self,
        subject: &Subject,
        scene: &Scene,
        shading: Shading,
        bump: Option<Bump>,
    ) -> Result<Option<MapBumps>> {
        let sampler = self.sampler(wrap_of(subject));
        let placement = self.bumps.placement(texel_size(subject, scene));
        let named = || self.map_path().display().to_string();
        Ok(Some(match (bump, subject) {
            (None | Some(Bump::Noise(_)), _) | (_, Subject::Nothing) => return Ok(None),
            (Some(Bump::Height(derivative)), _) => {
                let map = self.height_map(subject)?;
                let heights = HeightMap::of(&map.image, &map.options).with_context(named)?;
                MapBumps::Heights(HeightDetail {
                    derivative,
                    sampler,
                    placement,
                    ..HeightDetail::new(heights)
                })
            }
            (Some(Bump::ObjectNormal), subject) => {
                let map = self.object_normals(subject)?;
                let normals = ObjectNormalMap::of(&map.image, map.options.range).with_context(named)?;
                MapBumps::ObjectNormals(ObjectNormalDetail { normals, sampler, uv_set: 0 })
            }
            (Some(Bump::Normal), Subject::Map(map)) if self.samples().is_some() => {
                slopes_of(map, placement).with_context(named)?
            }
            (Some(Bump::Normal), Subject::Baked(_)) if self.samples().is_some() => {
                return Err(usage(self.map_path(), NO_TRUTH));
            }
            (Some(Bump::Normal), _) => {
                let arrays = self.arrays(subject, shading)?;
                let textures = BakedTextures::of_model(shading, &arrays).with_context(named)?;
                MapBumps::Textures { textures, sampler, placement }
            }
        }))
    }

    /// A map of `--add`.
    fn added_bumps(
        &self,
        added: &AddedMap,
        content: &AddedContent,
        scene: &Scene,
        shading: Shading,
    ) -> Result<PlacedMap> {
        let placement = added.placement(content.size().0, scene.repeats);
        let named = || added.path.display().to_string();
        let map = match (content, self.samples()) {
            (AddedContent::Map(map), Some(_)) => slopes_of(map, placement).with_context(named)?,
            (AddedContent::Baked(_), Some(_)) => return Err(usage(&added.path, NO_TRUTH)),
            (content, None) => {
                let arrays = content.arrays(self.shading_options.texture_options(), added)?;
                let textures = BakedTextures::new(shading.wanted(), &arrays).with_context(named)?;
                MapBumps::Textures { textures, sampler: self.sampler(content.wrap()), placement }
            }
        };
        let projected = match added.place {
            Place::Frame(FrameChoice::Triplanar, _) => Projected::Triplanar,
            Place::Frame(..) => Projected::No,
            Place::Box(decal) => Projected::Box(decal.box_from_world()),
        };
        Ok(PlacedMap { map, projected, strength: added.strength })
    }

    /// The renderer on the GPU.
    #[cfg(feature = "gpu")]
    fn gpu_backend(
        &self,
        subject: &Subject,
        scene: &Scene,
        shading: Shading,
        bump: Option<Bump>,
        (added, noise): (&[Added<'_>], Option<NoiseDetail>),
    ) -> Result<Backend> {
        use roughcast_gpu::render::{DrawOptions, GpuPlacement, MAX_SOURCES};

        let wrap = match (subject, added.first()) {
            (Subject::Nothing, Some((_, first))) => first.wrap(),
            _ => wrap_of(subject),
        };
        if let Some((other, _)) = added.iter().find(|(_, content)| content.wrap() != wrap) {
            let line = format!(
                "--gpu samples all maps alike, and the first one is sampled with --wrap {wrap}: leave --gpu out"
            );
            return Err(usage(&other.path, &line));
        }
        let draw_options = DrawOptions::default()
            .with_sampler(self.sampler(wrap))
            .with_shading_options(self.shading_options.shading_options())
            .with_curvature(self.bumps.curvature());
        let arrays;
        let first = match (bump, subject) {
            (None | Some(Bump::Noise(_)), _) | (_, Subject::Nothing) => None,
            (Some(Bump::Height(derivative)), _) => {
                let map = self.height_map(subject)?;
                let heights = height_texture(&map.image, &map.options);
                let heights = heights.with_context(|| self.map_path().display().to_string())?;
                Some(GpuMap::Heights(heights, derivative))
            }
            (Some(Bump::ObjectNormal), subject) => {
                let map = self.object_normals(subject)?;
                Some(GpuMap::ObjectNormals(&map.image, map.options.range))
            }
            (Some(Bump::Normal), _) => {
                arrays = self.arrays(subject, shading)?;
                Some(GpuMap::Model(&arrays))
            }
        };
        let mut maps = Vec::new();
        if let Some(map) = first {
            let placement = GpuPlacement::from(self.bumps.placement(texel_size(subject, scene)));
            let placement = match self.bumps.frame {
                FrameChoice::Triplanar => placement.triplanar(),
                _ => placement,
            };
            maps.push(PlacedGpuMap { map, placement, strength: self.bumps.strength.unwrap_or(1.0) });
        }
        for (map, content) in added {
            let placement = GpuPlacement::from(map.placement(content.size().0, scene.repeats));
            let placement = match map.place {
                Place::Frame(FrameChoice::Triplanar, _) => placement.triplanar(),
                Place::Frame(..) => placement,
                Place::Box(decal) => placement.decal(decal.box_from_world()),
            };
            let arrays = content.arrays(self.shading_options.texture_options(), map)?;
            maps.push(PlacedGpuMap { map: GpuMap::Textures(arrays), placement, strength: map.strength });
        }
        let sources = maps.len() + usize::from(noise.is_some());
        if sources > MAX_SOURCES {
            let line = format!(
                "--gpu combines up to {MAX_SOURCES} sources of bumps, not {sources}: leave --gpu out"
            );
            return Err(crate::UsageError(line).into());
        }
        let bumps = GpuBumps { maps, noise, uv_sets: self.uploaded_sets(scene)? };
        let size = (self.size.width, self.size.height);
        Ok(Backend::Gpu(Box::new(GpuBackend::new(shading, &bumps, &draw_options, scene, size)?)))
    }

    /// The two sets of texture coordinates that the GPU gets. A map of colours uses the first of them.
    #[cfg(feature = "gpu")]
    fn uploaded_sets(&self, scene: &Scene) -> Result<[usize; 2]> {
        let mut sets: Vec<usize> = scene.albedo.iter().map(|_| 0).collect();
        for set in self.bumps.uv_sets(self.map.is_some()) {
            if !sets.contains(&set) {
                sets.push(set);
            }
        }
        match sets[..] {
            [] => Ok([0, 1]),
            [only] => Ok([only, only]),
            [first, second] => Ok([first, second]),
            _ => {
                let line = "--gpu draws two sets of texture coordinates: leave --gpu out, or place maps by fewer sets";
                Err(crate::UsageError(line.to_owned()).into())
            }
        }
    }

    /// Samples per pixel of the ground truth, if it is rendered.
    fn samples(&self) -> Option<u32> {
        match self.filter {
            FilterChoice::Truth(samples) => Some(samples),
            FilterChoice::Textures(_) => None,
        }
    }

    /// How textures are sampled.
    fn sampler(&self, wrap: Wrap) -> Sampler {
        let sampler = match self.filter {
            FilterChoice::Textures(filter) => Sampler::default().with_filter(filter),
            FilterChoice::Truth(_) => Sampler::default(),
        };
        sampler.with_level(self.level).with_mip_bias(self.mip_bias).with_wrap(wrap)
    }

    /// The height map among the subjects.
    fn height_map<'s>(&self, subject: &'s Subject) -> Result<&'s Map> {
        match subject {
            Subject::Map(map) if map.options.kind == Kind::Height => Ok(map),
            _ => Err(usage(
                self.map_path(),
                "--bump height needs a height map: give one, or use --bump normal; if it is one, say --kind height",
            )),
        }
    }

    /// The map of object-space normals among the subjects.
    fn object_normals<'s>(&self, subject: &'s Subject) -> Result<&'s Map> {
        match subject {
            Subject::Map(map) if map.options.kind == Kind::Normal && map.image.channels() < 3 => Err(usage(
                self.map_path(),
                "--bump object-normal needs a map of three channels, x, y and z: give one, or use --bump normal",
            )),
            Subject::Map(map) if map.options.kind == Kind::Normal => Ok(map),
            _ => Err(usage(
                self.map_path(),
                "--bump object-normal needs a normal map in the axes of the mesh: give one; if it is one, add --kind normal",
            )),
        }
    }

    /// The textures of the model.
    fn arrays<'s>(&self, subject: &'s Subject, shading: Shading) -> Result<Cow<'s, [TextureArray]>> {
        match subject {
            Subject::Map(map) => {
                let textures = self.shading_options.texture_options();
                let arrays = bake_for(shading, &map.image, &map.options, textures);
                Ok(Cow::Owned(arrays.with_context(|| self.map_path().display().to_string())?))
            }
            Subject::Baked(arrays) => Ok(Cow::Borrowed(arrays)),
            Subject::Nothing => Ok(Cow::Borrowed(&[])),
        }
    }
}

/// Why a baked file has no ground truth.
const NO_TRUTH: &str = "--filter truth needs the original map, because a baked file contains averages: give the map that it was made \
                        from";

/// The slopes of level 0, for the ground truth.
fn slopes_of(map: &Map, placement: Placement) -> Result<MapBumps> {
    let slopes = SlopeMap::of(&map.image, &map.options)?;
    Ok(MapBumps::Slopes(SlopeDetail::new(slopes, map.options.wrap).placed(placement)))
}

/// What lies beyond the edge of the first map.
fn wrap_of(subject: &Subject) -> Wrap {
    match subject {
        Subject::Map(map) => map.options.wrap,
        Subject::Baked(arrays) => arrays[0].info.wrap,
        Subject::Nothing => Sampler::default().wrap,
    }
}

/// The size of a texel in the scene, where a map repeats per unit of length.
fn texel_size(subject: &Subject, scene: &Scene) -> f64 {
    let (width, _) = subject.texels().unwrap_or((1, 1));
    (width as f64 * scene.repeats).recip()
}
