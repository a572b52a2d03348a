//! Maps on top of a map: what `render --add` takes.

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Context, Result};
use glam::{DAffine3, DMat3, DVec3};
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast::{Green, Kind, Named, UnknownName, Wrap};
use roughcast_io::Limits;
use roughcast_pipeline::{Map, MapOptions, TextureOptions, bake_for};
use roughcast_scene::{Placement, TangentSource};

use crate::args::{finite, positive};
use crate::bumps::FrameChoice;
use crate::{findings, refusals, textures, usage};

/// A map on top of others, with its own place and strength.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedMap {
    pub path: PathBuf,
    /// Factor of the heights.
    pub strength: f32,
    pub place: Place,
    world_height: Option<f64>,
    kind: Option<Kind>,
    green: Option<Green>,
}

/// Where a map lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// On the surface.
    Frame(FrameChoice, usize),
    /// Inside a box.
    Box(DecalBox),
}

/// A cube that a map is projected through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecalBox {
    centre: DVec3,
    size: f64,
    /// The side of the box that the map faces.
    towards: DVec3,
}

/// What `--add` takes, for messages.
const WANTED: &str = "it must be MAP[,SETTING=VALUE...], with the settings strength, uv-set, frame, decal, world-height, kind \
                      and green";

/// The names of the settings after the path.
const SETTINGS: [&str; 7] = ["strength", "uv-set", "frame", "decal", "world-height", "kind", "green"];

/// The settings that decide where a map lies.
#[derive(Default)]
struct PlaceSettings {
    frame: Option<FrameChoice>,
    uv_set: Option<usize>,
    decal: Option<DecalBox>,
}

impl PlaceSettings {
    fn place(self) -> Result<Place, String> {
        match (self.decal, self.frame, self.uv_set) {
            (Some(decal), None, None) => Ok(Place::Box(decal)),
            (Some(_), ..) => Err("a decal is placed by its box: leave out frame and uv-set".to_owned()),
            (None, Some(FrameChoice::Triplanar), Some(_)) => {
                Err("frame=triplanar uses no texture coordinates: leave out uv-set".to_owned())
            }
            (None, frame, set) => Ok(Place::Frame(frame.unwrap_or(FrameChoice::Mesh), set.unwrap_or(0))),
        }
    }
}

impl AddedMap {
    pub fn parse(text: &str) -> Result<Self, String> {
        // A path may contain commas: it ends before the first setting.
        let end =
            SETTINGS.iter().filter_map(|name| text.find(&format!(",{name}="))).min().unwrap_or(text.len());
        let (path, settings) = text.split_at(end);
        if path.is_empty() {
            return Err(WANTED.to_owned());
        }
        let mut map = Self {
            path: path.into(),
            strength: 1.0,
            place: Place::Frame(FrameChoice::Mesh, 0),
            world_height: None,
            kind: None,
            green: None,
        };
        let (mut place, mut given) = (PlaceSettings::default(), Vec::new());
        for setting in settings.split(',').skip(1) {
            let (name, value) = setting.split_once('=').ok_or(WANTED)?;
            if given.contains(&name) {
                return Err(format!("{name} is given twice"));
            }
            given.push(name);
            map.set(&mut place, name, value).map_err(|words| format!("{name}={value}: {words}"))?;
        }
        map.place = place.place()?;
        Ok(map)
    }

    /// Applies a setting, or says what is wrong with it.
    fn set(&mut self, place: &mut PlaceSettings, name: &str, value: &str) -> Result<(), String> {
        match name {
            "strength" => self.strength = finite(value)?,
            "uv-set" => {
                let set = value.parse().map_err(|_| "it must be a whole number, 0 or above")?;
                place.uv_set = Some(set);
            }
            "frame" => place.frame = Some(named(value)?),
            "decal" => place.decal = Some(value.parse()?),
            "world-height" => self.world_height = Some(positive(value)?.into()),
            "kind" => self.kind = Some(named(value)?),
            "green" => self.green = Some(named(value)?),
            _ => return Err(format!("there is no such setting, only {}", SETTINGS.join(", "))),
        }
        Ok(())
    }

    /// The set of texture coordinates that it uses, if it uses any.
    pub fn uv_set(&self) -> Option<usize> {
        match self.place {
            Place::Frame(FrameChoice::Triplanar, _) | Place::Box(_) => None,
            Place::Frame(_, set) => Some(set),
        }
    }

    pub fn is_decal(&self) -> bool {
        matches!(self.place, Place::Box(_))
    }

    /// How the map is placed, given its width in texels, in a scene whose textures repeat this often per unit of length.
    pub fn placement(&self, width: usize, repeats: f64) -> Placement {
        let (set, tangents, texel) = match self.place {
            Place::Frame(FrameChoice::Triplanar, _) => {
                (0, TangentSource::Derivatives, Some((width as f64 * repeats).recip()))
            }
            Place::Frame(frame, set) => (set, frame.tangent_source(set), None),
            // The bumps of a decal are as steep as its map says.
            Place::Box(decal) => (0, TangentSource::Derivatives, Some(decal.size / width as f64)),
        };
        let placement = Placement::default().with_uv_set(set).with_tangent_source(tangents);
        self.world_height.or(texel).map_or(placement, |height| placement.with_world_height_per_texel(height))
    }

    /// Reads the map, or the file that `bake` wrote.
    pub fn load(&self, limits: &Limits) -> Result<AddedContent> {
        // A misspelt setting is taken for a part of the path.
        if self.path.to_string_lossy().contains(',') && !self.path.exists() {
            let line = format!(
                "there is no such file; the settings that may follow one are {}",
                SETTINGS.join(", ")
            );
            return Err(usage(&self.path, &line));
        }
        if textures::is_baked(&self.path, limits) {
            if self.kind.is_some() || self.green.is_some() {
                return Err(usage(
                    &self.path,
                    "kind and green are for maps, and `bake` wrote this file: leave them out",
                ));
            }
            return Ok(AddedContent::Baked(textures::read_with_parts(&self.path, limits)?));
        }
        let mut options = MapOptions::default();
        options.read = options.read.with_limits(*limits);
        options.kind = self.kind;
        options.green = self.green;
        let map = roughcast_pipeline::read_map(&self.path, &options)
            .map_err(|error| refusals::of_read_map(&self.path, error))?;
        findings::warn_of(&self.path, &map);
        Ok(AddedContent::Map(Box::new(map)))
    }
}

/// What a file of `--add` contains.
pub enum AddedContent {
    Map(Box<Map>),
    /// All textures of one bake.
    Baked(Vec<TextureArray>),
}

impl AddedContent {
    /// Width and height of level 0.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Self::Map(map) => (map.image.width(), map.image.height()),
            Self::Baked(arrays) => arrays[0].size(),
        }
    }

    /// What lies beyond the edge of the map.
    pub fn wrap(&self) -> Wrap {
        match self {
            Self::Map(map) => map.options.wrap,
            Self::Baked(arrays) => arrays[0].info.wrap,
        }
    }

    /// Textures that any model can shade: the map's distribution of slopes, without a base roughness of its own.
    pub fn arrays(&self, options: TextureOptions, added: &AddedMap) -> Result<Vec<TextureArray>> {
        match self {
            Self::Map(map) => bake_for(Shading::Lean, &map.image, &map.options, options)
                .with_context(|| added.path.display().to_string()),
            Self::Baked(arrays) => Ok(arrays.clone()),
        }
    }
}

impl DecalBox {
    /// From world space to the box, which is the cube from -1/2 to 1/2.
    pub fn box_from_world(&self) -> DAffine3 {
        // Upright, and to the right as seen from the side that the map faces.
        let up = match self.towards {
            towards if towards.y == 0.0 => DVec3::Y,
            towards => DVec3::NEG_Z * towards.y,
        };
        let turn = DMat3::from_cols(up.cross(self.towards), up, self.towards);
        DAffine3 { matrix3: turn * self.size, translation: self.centre }.inverse()
    }
}

impl FromStr for DecalBox {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "it must be X:Y:Z:SIZE[:AXIS], the centre of a cube, its side, and where the map faces: x, y, z, -x, -y \
                      or -z";
        let mut parts = text.split(':');
        let mut number = || match parts.next().map(str::parse::<f64>) {
            Some(Ok(number)) if number.is_finite() => Ok(number),
            _ => Err(wanted.to_owned()),
        };
        let centre = DVec3::new(number()?, number()?, number()?);
        let size = number()?;
        let towards = match parts.next() {
            None | Some("z") => DVec3::Z,
            Some("x") => DVec3::X,
            Some("y") => DVec3::Y,
            Some("-x") => DVec3::NEG_X,
            Some("-y") => DVec3::NEG_Y,
            Some("-z") => DVec3::NEG_Z,
            Some(_) => return Err(wanted.to_owned()),
        };
        // The reciprocal of the side, with which positions are multiplied, must be a finite single float.
        let is_a_size = size > 0.0 && (size.recip() as f32).is_finite();
        if !is_a_size || parts.next().is_some() {
            return Err(wanted.to_owned());
        }
        Ok(Self { centre, size, towards })
    }
}

fn named<T: Named + FromStr<Err = UnknownName>>(value: &str) -> Result<T, String> {
    value.parse().map_err(|error: UnknownName| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_followed_by_settings() {
        let plain = AddedMap::parse("a,b=c/rust.png").expect("a path");
        assert_eq!((plain.path.to_str(), plain.strength), (Some("a,b=c/rust.png"), 1.0));
        assert_eq!((plain.place, plain.uv_set()), (Place::Frame(FrameChoice::Mesh, 0), Some(0)));
        let second = AddedMap::parse("rust.png,uv-set=1,strength=-0.5").expect("settings");
        assert_eq!((second.strength, second.place), (-0.5, Place::Frame(FrameChoice::Mesh, 1)));
        let decal = AddedMap::parse("logo.png,decal=1:2:-3:0.5:-x,kind=height").expect("settings");
        assert_eq!((decal.uv_set(), decal.kind), (None, Some(Kind::Height)));
        let placement = decal.placement(50, 7.0);
        assert_eq!(placement.world_height_per_texel(), Some(0.01));
        for wrong in [
            "",
            ",strength=1",
            "a.png,strength=x",
            "a.png,strength=1e39",
            "a.png,strength=1,strength=2",
            "a.png,uv-set=-1",
            "a.png,frame=world",
            "a.png,strength=1,colour=red",
            "a.png,decal=1:2:3",
            "a.png,decal=1:2:3:0",
            "a.png,decal=1:2:3:1e-40",
            "a.png,decal=1:2:3:1:w",
            "a.png,decal=1:2:3:1,uv-set=1",
            "a.png,frame=triplanar,uv-set=1",
            "a.png,world-height=0",
            "a.png,kind=picture",
        ] {
            assert!(AddedMap::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_decal_is_upright_and_not_mirrored_on_every_side() {
        for axis in ["x", "y", "z", "-x", "-y", "-z"] {
            let decal: DecalBox = format!("1:2:3:4:{axis}").parse().expect("a box");
            let from_world = decal.box_from_world();
            // A rotation and a scale by 1/4 about the centre.
            assert!((from_world.matrix3.determinant() - 1.0 / 64.0).abs() < 1e-12, "{axis}");
            assert_eq!(from_world.transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::ZERO);
            assert_eq!(from_world.transform_vector3(4.0 * decal.towards), DVec3::Z, "{axis}");
            if decal.towards.y == 0.0 {
                assert_eq!(from_world.transform_vector3(DVec3::Y), DVec3::Y / 4.0, "{axis}");
            }
        }
    }
}
