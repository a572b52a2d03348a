//! What renders, with the bumps that it needs, as the arguments choose them.

use std::borrow::Cow;

use anyhow::{Context, Result};
use roughcast::Kind;
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast_pipeline::{Map, bake_for};
use roughcast_scene::{
    BakedTextures, HeightDetail, HeightMap, ObjectNormalDetail, ObjectNormalMap, Sampler, Scene, SlopeDetail,
    SlopeMap,
};

use super::{Args, FilterChoice, Subject};
use crate::backend::{Backend, GroundTruthBackend, MapBumps, MethodBackend, Projected, SceneBumps};
#[cfg(feature = "gpu")]
use crate::backend::{GpuBackend, GpuBumps, GpuMap};
use crate::bumps::{Bump, FrameChoice};
use crate::usage;

impl Args {
    /// The renderer, with the bumps that it needs.
    pub(super) fn backend(&self, subject: &Subject, scene: &Scene) -> Result<Backend> {
        let size = (self.size.width, self.size.height);
        let options = self.shading_options.shading_options();
        let shading = self.model(subject)?;
        let bump = self.bumps.of_map(self.map.is_some())?;
        let sampler = self.sampler(subject);
        #[cfg(feature = "gpu")]
        if self.gpu {
            return self.gpu_backend(subject, scene, shading, bump, sampler);
        }
        let bumps = |map| -> Result<SceneBumps> {
            let projected = match self.bumps.frame {
                FrameChoice::Triplanar => Projected::Triplanar,
                _ => Projected::No,
            };
            let noise = self.bumps.noise(scene.shape.bounds().radius)?;
            Ok(SceneBumps { map, projected, noise, curvature: self.bumps.curvature() })
        };
        let placement = self.bumps.placement(texel_size(subject, scene));
        let named = || self.map_path().display().to_string();
        let map = match (bump, subject) {
            (None | Some(Bump::Noise(_)), _) | (_, Subject::Nothing) => MapBumps::None,
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
                MapBumps::ObjectNormals(ObjectNormalDetail { normals, sampler })
            }
            (Some(Bump::Normal), Subject::Map(map)) if self.samples().is_some() => {
                let slopes = SlopeMap::of(&map.image, &map.options).with_context(named)?;
                MapBumps::Slopes(SlopeDetail::new(slopes, map.options.wrap).placed(placement))
            }
            (Some(Bump::Normal), Subject::Baked(_)) if self.samples().is_some() => {
                let line = "--filter truth needs the original map, because a baked file contains averages: give the map that it was \
                            made from";
                return Err(usage(self.map_path(), line));
            }
            (Some(Bump::Normal), _) => {
                let arrays = self.arrays(subject, shading)?;
                let textures = BakedTextures::of_model(shading, &arrays).with_context(named)?;
                MapBumps::Textures { textures, sampler, placement }
            }
        };
        let bumps = bumps(map)?;
        Ok(match self.samples() {
            Some(samples) => {
                Backend::GroundTruth(GroundTruthBackend { bumps, shading, options, samples, size })
            }
            None => Backend::Method(MethodBackend { shading, bumps, options, size }),
        })
    }

    /// The renderer on the GPU.
    #[cfg(feature = "gpu")]
    fn gpu_backend(
        &self,
        subject: &Subject,
        scene: &Scene,
        shading: Shading,
        bump: Option<Bump>,
        sampler: Sampler,
    ) -> Result<Backend> {
        use roughcast_gpu::render::{DrawOptions, GpuPlacement};
        use roughcast_scene::height_texture;

        let named = || self.map_path().display().to_string();
        let draw_options = DrawOptions::default()
            .with_sampler(sampler)
            .with_shading_options(self.shading_options.shading_options())
            .with_curvature(self.bumps.curvature());
        let (arrays, heights);
        let map = match (bump, subject) {
            (None | Some(Bump::Noise(_)), _) | (_, Subject::Nothing) => GpuMap::None,
            (Some(Bump::Height(derivative)), _) => {
                let map = self.height_map(subject)?;
                heights = height_texture(&map.image, &map.options).with_context(named)?;
                GpuMap::Heights(&heights, derivative)
            }
            (Some(Bump::ObjectNormal), _) => {
                let line = "--gpu has no object-space normals: leave --gpu out";
                return Err(crate::UsageError(line.to_owned()).into());
            }
            (Some(Bump::Normal), _) => {
                arrays = self.arrays(subject, shading)?;
                GpuMap::Textures(&arrays)
            }
        };
        let mut placement = GpuPlacement::from(self.bumps.placement(texel_size(subject, scene)));
        if self.bumps.frame == FrameChoice::Triplanar {
            placement = placement.triplanar();
        }
        let noise = self.bumps.gpu_noise(scene.shape.bounds().radius)?;
        let bumps = GpuBumps { map, placement, uv_set: self.bumps.uv_set, noise };
        let size = (self.size.width, self.size.height);
        Ok(Backend::Gpu(Box::new(GpuBackend::new(shading, &bumps, &draw_options, scene, size)?)))
    }

    /// Samples per pixel of the ground truth, if it is rendered.
    fn samples(&self) -> Option<u32> {
        match self.filter {
            FilterChoice::Truth(samples) => Some(samples),
            FilterChoice::Textures(_) => None,
        }
    }

    /// How textures are sampled.
    fn sampler(&self, subject: &Subject) -> Sampler {
        let wrap = match subject {
            Subject::Map(map) => map.options.wrap,
            Subject::Baked(arrays) => arrays[0].info.wrap,
            Subject::Nothing => Sampler::default().wrap,
        };
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

/// The size of a texel in the scene, where a map repeats per unit of length.
fn texel_size(subject: &Subject, scene: &Scene) -> f64 {
    (subject.texels().0 as f64 * scene.repeats).recip()
}
