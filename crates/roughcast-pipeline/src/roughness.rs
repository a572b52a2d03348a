//! The base roughness of the material: a number, or a picture read from a file.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use roughcast::texture::RoughnessStored;
use roughcast::{BaseRoughness, Image, RoughnessMap, variance_from_stored};
use roughcast_io::{Decoded, FileInfo, Limits, ReadError, ReadOptions, read_image_file};

use crate::findings::RoughnessForm;
use crate::map::{MapError, refuse_baked};

/// The allowed range of Blinn-Phong exponents. Below 1 nothing is shiny; above the maximum single floats cannot
/// represent bumps.
pub const SPECULAR_POWERS: RangeInclusive<f32> = 1.0..=1_000_000.0;

/// Where the roughness of a material comes from.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RoughnessInput {
    /// A Blinn-Phong exponent.
    SpecularPower(f32),
    /// A single number for the whole material.
    Value {
        /// The number.
        value: f32,
        /// What it means.
        stored: RoughnessStored,
    },
    /// A picture. It is resampled if its size differs from the map's.
    File {
        /// The picture.
        path: PathBuf,
        /// The channel, by name. `None` selects green in colour pictures, as in glTF's packing, and the only channel in
        /// grey ones.
        channel: Option<String>,
        /// What its values mean.
        stored: RoughnessStored,
    },
}

/// Why the roughness of a material could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RoughnessError {
    /// The number is outside of the range of this kind of roughness.
    #[error(
        "{value} is not a roughness stored as '{stored}': it must be from {} to {}",
        range.start(),
        range.end()
    )]
    OutOfRange {
        /// The number.
        value: f32,
        /// The intended meaning of the number.
        stored: RoughnessStored,
        /// The allowed range.
        range: RangeInclusive<f32>,
    },
    /// The picture cannot be read.
    #[error("the roughness {} cannot be read", path.display())]
    Read {
        /// The picture.
        path: PathBuf,
        /// The reason.
        source: ReadError,
    },
    /// The picture lacks the named channel.
    #[error("the roughness {} cannot be read from the channel that was named", path.display())]
    Channel {
        /// The picture.
        path: PathBuf,
        /// The reason.
        source: ReadError,
    },
    /// The picture was written by `bake`.
    #[error("{} has no roughness of a material", path.display())]
    Map {
        /// The picture.
        path: PathBuf,
        /// The reason.
        source: MapError,
    },
}

/// A base roughness, with its picture if it comes from one.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Roughness {
    /// The slope variance per axis.
    Variance(f32),
    /// A channel of a picture.
    Map {
        /// The picture.
        image: Image,
        /// The channel.
        channel: usize,
        /// What its values mean.
        stored: RoughnessStored,
    },
}

impl Roughness {
    /// The roughness in the form that [`roughcast::Bake`] expects.
    pub fn base(&self) -> BaseRoughness<'_> {
        match self {
            Roughness::Variance(variance) => BaseRoughness::Variance(*variance),
            Roughness::Map { image, channel, stored } => {
                BaseRoughness::Map(RoughnessMap { image: image.view(), channel: *channel, stored: *stored })
            }
        }
    }

    /// Whether it is a colour picture with roughness in green, as in glTF's packed texture; its other channels are
    /// kept.
    pub fn is_packed(&self) -> bool {
        matches!(self, Roughness::Map { image, channel: 1, .. } if image.channels() >= 3 && !is_grey(image))
    }
}

/// Whether red, green and blue are equal throughout, up to the error of lossy compression.
fn is_grey(image: &Image) -> bool {
    /// The error of JPEG's chroma rounding.
    const LOSSY: f32 = 4.5 / 255.0;
    (0..image.height()).all(|y| {
        (0..image.width()).all(|x| {
            let [r, g, b] = [0, 1, 2].map(|channel| image.get(x, y, channel));
            (r - g).abs() <= LOSSY && (b - g).abs() <= LOSSY
        })
    })
}

/// The index of the channel with this name. The only channel of a grey picture also counts as red.
fn channel_of(info: &FileInfo, name: &str) -> Option<usize> {
    let is_grey = info.channels.len() == 1 && info.channels[0] == "Y";
    let place = info.channels.iter().position(|channel| channel.eq_ignore_ascii_case(name));
    place.or_else(|| (is_grey && name.eq_ignore_ascii_case("r")).then_some(0))
}

impl RoughnessInput {
    /// The path of the picture, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            RoughnessInput::File { path, .. } => Some(path),
            _ => None,
        }
    }

    /// How the roughness was given.
    pub fn form(&self) -> RoughnessForm {
        match self {
            RoughnessInput::SpecularPower(_) => RoughnessForm::SpecularPower,
            RoughnessInput::Value { .. } | RoughnessInput::File { .. } => RoughnessForm::Roughness,
        }
    }

    /// The roughness, read from its file if it is a picture.
    ///
    /// # Errors
    /// [`RoughnessError`].
    pub fn load(&self, limits: &Limits) -> Result<Roughness, RoughnessError> {
        match self {
            RoughnessInput::SpecularPower(power) => {
                Ok(Roughness::Variance(variance_of(*power, RoughnessStored::SpecularPower)?))
            }
            RoughnessInput::Value { value, stored } => Ok(Roughness::Variance(variance_of(*value, *stored)?)),
            RoughnessInput::File { path, channel, stored } => {
                picture(path, channel.as_deref(), *stored, limits)
            }
        }
    }
}

fn variance_of(value: f32, stored: RoughnessStored) -> Result<f32, RoughnessError> {
    let range = match stored {
        RoughnessStored::SpecularPower => SPECULAR_POWERS,
        _ => 0.0..=1.0,
    };
    if !range.contains(&value) {
        return Err(RoughnessError::OutOfRange { value, stored, range });
    }
    Ok(variance_from_stored(value, stored))
}

fn picture(
    path: &Path,
    channel: Option<&str>,
    stored: RoughnessStored,
    limits: &Limits,
) -> Result<Roughness, RoughnessError> {
    let Decoded { image, info } = read(path, channel, limits)?;
    refuse_baked(&info).map_err(|source| RoughnessError::Map { path: path.to_owned(), source })?;
    let channel = match channel {
        Some(name) => channel_of(&info, name).unwrap_or(0),
        None if image.channels() >= 3 => 1,
        None => 0,
    };
    Ok(Roughness::Map { image, channel, stored })
}

/// Reads the picture, or its named channel if only a layer of the file has it, as in EXR.
fn read(path: &Path, channel: Option<&str>, limits: &Limits) -> Result<Decoded, RoughnessError> {
    let whole = ReadOptions::from(*limits);
    let unread = |source| RoughnessError::Read { path: path.to_owned(), source };
    let Some(name) = channel else { return read_image_file(path, &whole).map_err(unread) };
    match read_image_file(path, &whole) {
        Ok(decoded) if channel_of(&decoded.info, name).is_some() => Ok(decoded),
        Ok(_) | Err(ReadError::OpenChannels { .. }) => {
            let named = whole.with_channels(vec![name.to_owned()]);
            read_image_file(path, &named)
                .map_err(|source| RoughnessError::Channel { path: path.to_owned(), source })
        }
        Err(error) => Err(unread(error)),
    }
}
