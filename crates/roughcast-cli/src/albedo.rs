//! The diffuse colour of a surface, as the command line gives it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow};
use roughcast_io::{Limits, ReadError};
use roughcast_pipeline::{ColourError, read_colours};
use roughcast_scene::AlbedoMap;

use crate::scene_args::colour;
use crate::{refusals, warn};

/// One colour, or a picture of colours.
#[derive(Clone, Debug, PartialEq)]
pub enum AlbedoChoice {
    /// Linear RGB.
    Colour([f32; 3]),
    /// A file.
    Map(PathBuf),
}

/// What covers a surface.
#[derive(Clone, Debug)]
pub enum Albedo {
    /// Linear RGB.
    Colour([f32; 3]),
    /// A map in memory.
    Map(Arc<AlbedoMap>),
}

impl AlbedoChoice {
    /// A colour if the text consists of numbers, otherwise a path.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.split(',').all(|part| part.trim().parse::<f64>().is_ok()) {
            return colour(text).map(Self::Colour);
        }
        Ok(Self::Map(text.into()))
    }

    /// The path of the picture, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Colour(_) => None,
            Self::Map(path) => Some(path),
        }
    }

    /// The colour, or the map read from its file.
    pub fn load(&self, limits: &Limits) -> Result<Albedo> {
        match self {
            Self::Colour(colour) => Ok(Albedo::Colour(*colour)),
            Self::Map(path) => Ok(Albedo::Map(Arc::new(load(path, limits)?))),
        }
    }
}

fn load(path: &Path, limits: &Limits) -> Result<AlbedoMap> {
    let named = || path.display().to_string();
    let decoded = match read_colours(path, limits) {
        Err(ColourError::Read(ReadError::Io(error))) if error.kind() == ErrorKind::NotFound => {
            return Err(
                anyhow!("there is no such file: --albedo is one number, R,G,B or a picture").context(named())
            );
        }
        other => other.map_err(|error| refusals::of_colours(path, error))?,
    };
    decoded.info.warnings.iter().for_each(|clause| warn(path, clause));
    AlbedoMap::of_image(&decoded.image).with_context(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_a_colour_and_anything_else_is_a_path() {
        assert_eq!(AlbedoChoice::parse("0.2"), Ok(AlbedoChoice::Colour([0.2; 3])));
        assert_eq!(AlbedoChoice::parse("0.2, 0,1"), Ok(AlbedoChoice::Colour([0.2, 0.0, 1.0])));
        for path in ["rock.png", "0.2,0.1,rock.png", "1.png", "folder/1,2,3.jpg", ""] {
            assert_eq!(AlbedoChoice::parse(path), Ok(AlbedoChoice::Map(path.into())));
        }
        // Numbers that are no colour are not taken for the names of files.
        for wrong in ["-1", "0.1,0.2", "1,2,3,4", "nan", "inf", "1e999"] {
            assert!(AlbedoChoice::parse(wrong).is_err(), "{wrong}");
        }
    }
}
