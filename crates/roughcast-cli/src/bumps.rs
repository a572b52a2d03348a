//! Arguments for the bumps on a surface: a map's slopes, its heights, noise, and how they are placed.

use clap::Args;
use roughcast::noise::{Noise, NoiseKind, OctaveFilter};
use roughcast::shading::GeometricFilter;
use roughcast_scene::{
    HeightDerivative, NoiseDetail, Perturbation, Placement, TangentSource, VolumeDerivative,
};

use crate::UsageError;
use crate::added::AddedMap;
use crate::args::{finite, one_of, positive};

/// The heading under which the help lists these options.
const BUMPS: &str = "Bumps";

/// A source of bumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bump {
    /// The slopes of the map, in the textures of the model.
    Normal,
    /// The heights of the map, differentiated on the screen.
    Height(HeightDerivative),
    /// The map's normals, in the axes of the mesh.
    ObjectNormal,
    /// Procedural noise.
    Noise(NoiseChoice),
}

/// Noise whose size may follow from the scene's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseChoice {
    kind: NoiseKind,
    octaves: u32,
    frequency: Option<f64>,
    amplitude: Option<f64>,
}

/// Cells of the first octave over the radius of the scene, if no frequency is given.
const CELLS_PER_RADIUS: f64 = 4.0;
/// Height of the first octave in cells, if no amplitude is given: slopes of about a quarter.
const HEIGHT_IN_CELLS: f64 = 0.25;

impl Bump {
    fn parse(text: &str) -> Result<Self, String> {
        let mut parts = text.split(':');
        let rest = |derivative: Option<&str>| match derivative {
            None => Ok(HeightDerivative::Fine),
            Some(name) => name.parse().map_err(|error: roughcast::UnknownName| error.to_string()),
        };
        let bump = match parts.next() {
            Some("normal") => Self::Normal,
            Some("object-normal") => Self::ObjectNormal,
            Some("height") => Self::Height(rest(parts.next())?),
            Some("noise") => Self::Noise(NoiseChoice::parse(&mut parts)?),
            _ => {
                return Err(
                    "it must be normal, height, height:DERIVATIVE, object-normal or noise:KIND:OCTAVES"
                        .to_owned(),
                );
            }
        };
        match parts.next() {
            None => Ok(bump),
            Some(more) => Err(format!("nothing may follow: leave out ':{more}'")),
        }
    }
}

impl NoiseChoice {
    fn parse<'t>(parts: &mut impl Iterator<Item = &'t str>) -> Result<Self, String> {
        let wanted = "noise is KIND:OCTAVES[:FREQUENCY[:AMPLITUDE]], such as turbulence:6 or fbm:8:20:0.01";
        let kind = parts.next().ok_or(wanted)?;
        let kind = kind.parse().map_err(|error: roughcast::UnknownName| error.to_string())?;
        let octaves = parts.next().and_then(|octaves| octaves.parse().ok()).ok_or(wanted)?;
        let mut number = || match parts.next().map(str::parse::<f64>) {
            None => Ok(None),
            Some(Ok(number)) if number.is_finite() => Ok(Some(number)),
            Some(_) => Err(wanted.to_owned()),
        };
        let choice = Self { kind, octaves, frequency: number()?, amplitude: number()? };
        choice.noise(1.0).check().map_err(|error| error.to_string())?;
        Ok(choice)
    }

    /// The noise for a scene of this radius.
    fn noise(&self, radius: f64) -> Noise {
        let frequency = self.frequency.unwrap_or(CELLS_PER_RADIUS / radius);
        Noise::default()
            .with_kind(self.kind)
            .with_octaves(self.octaves)
            .with_frequency(frequency)
            .with_amplitude(self.amplitude.unwrap_or(HEIGHT_IN_CELLS / frequency))
    }
}

roughcast::named_enum! {
    /// The frame in which bumps are placed on a surface.
    pub enum FrameChoice: "frame" {
        /// The tangents of the mesh.
        Mesh = "mesh",
        /// Derivatives on the screen.
        Screen = "screen",
        /// Three projections.
        Triplanar = "triplanar",
    }
}

impl FrameChoice {
    /// Where the tangents of a map on this set of texture coordinates come from: those of a mesh are of its first set.
    pub fn tangent_source(self, uv_set: usize) -> TangentSource {
        match (self, uv_set) {
            (Self::Mesh, 0) => TangentSource::Mesh,
            _ => TangentSource::Derivatives,
        }
    }
}

/// What makes the surface bumpy.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = BUMPS)]
pub struct BumpArgs {
    /// A source of bumps: normal, the slopes of the map, filtered by the model; height[:fine|forward|central|bicubic], the
    /// heights of the map, differentiated on the screen (Mikkelsen); object-normal, normals in the axes of the mesh; or
    /// noise:KIND:OCTAVES[:FREQUENCY[:AMPLITUDE]], without a map: KIND is fbm or turbulence, FREQUENCY the cells per unit of
    /// length. Give it twice to add noise to a map [default: normal]
    #[arg(long = "bump", value_name = "BUMP", value_parser = Bump::parse)]
    pub bumps: Vec<Bump>,

    /// The frame of the map's slopes: mesh, its tangents; screen, derivatives of position and texture coordinates, without
    /// tangents; or triplanar, projected along the three axes, without texture coordinates
    #[arg(long, default_value = "mesh", value_parser = one_of::<FrameChoice>())]
    pub frame: FrameChoice,

    /// Height of one texel of height, in units of the scene: bumps then have a size, and stretching the map makes them
    /// flatter [default: the map's slopes are kept; with triplanar, the size of a texel]
    #[arg(long, value_name = "X", value_parser = positive)]
    pub world_height: Option<f32>,

    /// The set of texture coordinates that the map uses, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub uv_set: usize,

    /// What becomes of octaves of noise that are finer than the pixel: fade turns them into roughness; drop loses them; keep
    /// leaves them, so that they alias
    #[arg(long, default_value = "fade", value_parser = one_of::<OctaveFilter>())]
    pub octaves: OctaveFilter,

    /// How the gradient of noise is found: by formula, by differences in space, or by differences on the screen
    #[arg(long, default_value = "analytic", value_parser = one_of::<VolumeDerivative>())]
    pub noise_derivative: VolumeDerivative,

    /// How noise perturbs the normal: surface-gradient; or, for comparison, perlin, the older way, or facets, which shows the
    /// edges of triangles
    #[arg(long, default_value = "surface-gradient", value_parser = one_of::<Perturbation>())]
    pub perturbation: Perturbation,

    /// Factor of the map's heights: 0.5 makes bumps half as steep, and -1 turns them into dents [default: 1]
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true)]
    pub strength: Option<f32>,

    /// Another map on top: its heights are added. Settings follow its name, separated by commas: strength=X, as --strength;
    /// frame=mesh|screen|triplanar, world-height=X and uv-set=N, as the options of these names; decal=X:Y:Z:SIZE[:AXIS],
    /// projected once through the cube with this centre and side, from x, y, z (default), -x, -y or -z;
    /// kind=normal|height and green=up|down, what the file contains. Example: --add rust.png,frame=triplanar,strength=0.5.
    /// May be given several times
    #[arg(long = "add", value_name = "MAP[,SETTING...]", value_parser = AddedMap::parse)]
    pub added: Vec<AddedMap>,

    /// Geometric specular antialiasing: the curvature of the surface under a pixel also becomes roughness
    #[arg(long)]
    pub geometric_aa: bool,
}

impl BumpArgs {
    /// The map's part of the bumps, given whether there is a map. None for noise alone.
    pub fn of_map(&self, has_map: bool) -> Result<Option<Bump>, UsageError> {
        let maps: Vec<Bump> =
            self.bumps.iter().copied().filter(|bump| !matches!(bump, Bump::Noise(_))).collect();
        let refuse = |line: &str| Err(UsageError(line.to_owned()));
        match (maps.as_slice(), has_map) {
            ([_, _, ..], _) => {
                refuse("--bump takes the map once: give either normal, height or object-normal")
            }
            ([bump], true) => Ok(Some(*bump)),
            ([_], false) => {
                refuse("--bump normal, height and object-normal need a map: give one before the options")
            }
            ([], true) if self.bumps.is_empty() => Ok(Some(Bump::Normal)),
            ([], true) => refuse("the map is not used: leave it out, or add --bump normal or --bump height"),
            ([], false) if self.bumps.is_empty() && self.added.is_empty() => {
                refuse("there is nothing to render: give a map, or --bump noise:fbm:8")
            }
            ([], false) => Ok(None),
        }
    }

    /// Refuses options that would have no effect.
    pub fn check(&self, has_map: bool) -> Result<(), UsageError> {
        let refuse = |line: &str| Err(UsageError(line.to_owned()));
        let places = self.world_height.is_some() || self.uv_set != 0 || self.frame != FrameChoice::Mesh;
        if !has_map && (places || self.strength.is_some()) {
            return refuse(
                "--frame, --world-height, --uv-set and --strength are those of a map: give one, or leave them out",
            );
        }
        self.check_noise()?;
        if self.bumps.contains(&Bump::ObjectNormal) && places {
            return refuse(
                "--frame, --world-height and --uv-set do not go with --bump object-normal: its normals are those of the mesh's \
                 own surface",
            );
        }
        if self.frame == FrameChoice::Triplanar && self.uv_set != 0 {
            return refuse("--frame triplanar uses no texture coordinates: leave out --uv-set");
        }
        self.of_map(has_map).map(drop)
    }

    /// Refuses options of noise that would have no effect.
    fn check_noise(&self) -> Result<(), UsageError> {
        let refuse = |line: &str| Err(UsageError(line.to_owned()));
        let has_noise = self.bumps.iter().any(|bump| matches!(bump, Bump::Noise(_)));
        let is_analytic = self.noise_derivative == VolumeDerivative::Analytic
            && self.perturbation == Perturbation::SurfaceGradient;
        let has_defaults = is_analytic && self.octaves == OctaveFilter::Fade;
        if !has_noise && !has_defaults {
            return refuse(
                "--octaves, --noise-derivative and --perturbation go with --bump noise:KIND:OCTAVES",
            );
        }
        if !is_analytic && self.octaves != OctaveFilter::Fade {
            return refuse(
                "--octaves filters noise with its formula and the surface gradient: leave out --noise-derivative and \
                 --perturbation",
            );
        }
        let in_space =
            matches!(self.noise_derivative, VolumeDerivative::Analytic | VolumeDerivative::Numeric);
        if self.perturbation == Perturbation::Perlin && !in_space {
            return refuse(
                "--perturbation perlin needs the gradient in space: use --noise-derivative analytic or numeric",
            );
        }
        Ok(())
    }

    /// The sets of texture coordinates that maps use, given whether there is a first one.
    pub fn uv_sets(&self, has_map: bool) -> Vec<usize> {
        let first = (has_map && self.frame != FrameChoice::Triplanar).then_some(self.uv_set);
        first.into_iter().chain(self.added.iter().filter_map(AddedMap::uv_set)).collect()
    }

    /// The noise in a scene of this radius.
    pub fn noise(&self, radius: f64) -> Result<Option<NoiseDetail>, UsageError> {
        let mut choices = self.bumps.iter().filter_map(|bump| match bump {
            Bump::Noise(choice) => Some(choice),
            _ => None,
        });
        let first = choices.next();
        if choices.next().is_some() {
            return Err(UsageError("--bump takes one noise: more octaves make it finer".to_owned()));
        }
        Ok(first.map(|choice| NoiseDetail {
            filter: self.octaves,
            derivative: self.noise_derivative,
            perturbation: self.perturbation,
            ..NoiseDetail::new(choice.noise(radius))
        }))
    }

    /// How the map is placed, for a map that a texel of this size covers.
    pub fn placement(&self, texel: f64) -> Placement {
        let tangents = self.frame.tangent_source(self.uv_set);
        let placement = Placement::default().with_uv_set(self.uv_set).with_tangent_source(tangents);
        match (self.world_height, self.frame) {
            (Some(height), _) => placement.with_world_height_per_texel(f64::from(height)),
            (None, FrameChoice::Triplanar) => placement.with_world_height_per_texel(texel),
            (None, _) => placement,
        }
    }

    /// Geometric specular antialiasing, if asked for.
    pub fn curvature(&self) -> Option<GeometricFilter> {
        self.geometric_aa.then(GeometricFilter::default)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bumps_are_a_map_or_noise() {
        assert_eq!(Bump::parse("normal"), Ok(Bump::Normal));
        assert_eq!(Bump::parse("height"), Ok(Bump::Height(HeightDerivative::Fine)));
        assert_eq!(Bump::parse("height:bicubic"), Ok(Bump::Height(HeightDerivative::Bicubic)));
        let Ok(Bump::Noise(choice)) = Bump::parse("noise:turbulence:6") else { panic!("noise") };
        let noise = choice.noise(2.0);
        assert_eq!((noise.kind, noise.octaves, noise.frequency), (NoiseKind::Turbulence, 6, 2.0));
        let Ok(Bump::Noise(choice)) = Bump::parse("noise:fbm:8:20:0.01") else { panic!("noise") };
        assert_eq!((choice.noise(2.0).frequency, choice.noise(2.0).amplitude), (20.0, 0.01));
        for wrong in [
            "",
            "bump",
            "normal:1",
            "height:sobel",
            "noise",
            "noise:fbm",
            "noise:fbm:0",
            "noise:fbm:8:-1",
            "noise:fbm:8:x",
            "noise:fbm:8:1:nan",
            "noise:fbm:8:1:1:1",
            "noise:white:3",
            "noise:fbm:1000",
        ] {
            assert!(Bump::parse(wrong).is_err(), "{wrong}");
        }
    }
}
