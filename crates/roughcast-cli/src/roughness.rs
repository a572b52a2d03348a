//! The base roughness of the material, as the command line gives it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use clap::Args;
use roughcast::texture::{Base, Brdf, RoughnessStored};
use roughcast::{BaseRoughness, Image, RoughnessMap, variance_from_stored};
use roughcast_io::{Decoded, FileInfo, Limits, ReadError, ReadOptions};

use crate::UsageError;
use crate::args::{SPECULAR_POWERS, one_of, specular_power};
use crate::input::{read_image, refuse_baked};

/// Base roughness.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Roughness of the material itself")]
pub struct RoughnessArgs {
    /// The material's shininess, as a Blinn-Phong exponent
    #[arg(long, value_name = "S", value_parser = specular_power, conflicts_with = "roughness")]
    pub specular_power: Option<f32>,

    /// The material's roughness: a number, or a picture, which is resampled where its size is not the map's. Of a colour picture it is green, as glTF packs
    /// occlusion, roughness and metalness; pbr keeps the other two
    #[arg(long, value_name = "FILE|VALUE")]
    pub roughness: Option<String>,

    /// Channel of the picture that contains the roughness, by name: r, g, b, a, or any channel of an EXR [default: g in
    /// colour, the only one in grey]
    #[arg(long, value_name = "CHANNEL", requires = "roughness")]
    pub roughness_channel: Option<String>,

    /// How the roughness that is given is stored: perceptual is what glTF and most tools paint, alpha its square, the width of
    /// the highlight; gloss is 1 minus perceptual
    #[arg(long, value_name = "HOW", default_value = "perceptual", value_parser = one_of::<RoughnessStored>())]
    pub roughness_stored: RoughnessStored,

    /// How pbr stores the roughness that it writes [default: perceptual; with --brdf blinn-phong in floats specular-power]
    #[arg(long, value_name = "HOW", value_parser = one_of::<RoughnessStored>())]
    pub roughness_output: Option<RoughnessStored>,

    /// The highlight's shape for which the roughness is meant
    #[arg(long, default_value = "ggx", value_parser = one_of::<Brdf>())]
    pub brdf: Brdf,

    /// Whether this roughness is folded into the stored moments: none (the shader adds it) or baked (it is in, and the
    /// shader must not). pbr and toksvig always hold it
    #[arg(long, default_value = "none", value_parser = one_of::<Base>())]
    pub base: Base,
}

/// A base roughness with the picture that it may come from.
pub enum Roughness {
    Variance(f32),
    Map { image: Image, channel: usize, stored: RoughnessStored },
}

impl Roughness {
    /// As the library takes it.
    pub fn base(&self) -> BaseRoughness<'_> {
        match self {
            Roughness::Variance(variance) => BaseRoughness::Variance(*variance),
            Roughness::Map { image, channel, stored } => {
                BaseRoughness::Map(RoughnessMap { image, channel: *channel, stored: *stored })
            }
        }
    }

    /// Whether it is a colour picture with roughness in green: glTF's packed texture, of which the rest is worth keeping.
    pub fn is_packed(&self) -> bool {
        matches!(self, Roughness::Map { image, channel: 1, .. } if image.channels() >= 3 && !is_grey(image))
    }
}

/// Whether red, green and blue are equal throughout, but for what lossy compression does.
fn is_grey(image: &Image) -> bool {
    /// JPEG's rounding of chroma.
    const LOSSY: f32 = 4.5 / 255.0;
    (0..image.height()).all(|y| {
        (0..image.width()).all(|x| {
            let [r, g, b] = [0, 1, 2].map(|channel| image.get(x, y, channel));
            (r - g).abs() <= LOSSY && (b - g).abs() <= LOSSY
        })
    })
}

/// The place of a channel of this name. The only channel of a grey picture is its red as well.
fn channel_of(info: &FileInfo, name: &str) -> Option<usize> {
    let is_grey = info.channels.len() == 1 && info.channels[0] == "Y";
    let place = info.channels.iter().position(|channel| channel.eq_ignore_ascii_case(name));
    place.or_else(|| (is_grey && name.eq_ignore_ascii_case("r")).then_some(0))
}

impl RoughnessArgs {
    /// The picture that the arguments name.
    pub fn file(&self) -> Option<&Path> {
        self.roughness.as_deref().filter(|text| text.parse::<f32>().is_err()).map(Path::new)
    }

    /// Loads what the arguments name; `None` where they name nothing.
    pub fn load(&self, limits: &Limits) -> Result<Option<Roughness>> {
        if let Some(power) = self.specular_power {
            return Ok(Some(Roughness::Variance(1.0 / power)));
        }
        let Some(text) = &self.roughness else { return Ok(None) };
        match text.parse::<f32>() {
            Ok(value) => self.value(value).map(Some),
            Err(_) => self.map(&PathBuf::from(text), limits).map(Some),
        }
    }

    fn value(&self, value: f32) -> Result<Roughness> {
        let stored = self.roughness_stored;
        let in_range = match stored {
            RoughnessStored::SpecularPower => SPECULAR_POWERS.contains(&value),
            _ => (0.0..=1.0).contains(&value),
        };
        if !in_range {
            let range = match stored {
                RoughnessStored::SpecularPower => {
                    format!("from {} to {}", SPECULAR_POWERS.start(), SPECULAR_POWERS.end())
                }
                _ => "from 0 to 1".to_owned(),
            };
            return Err(UsageError(format!(
                "--roughness {value}: a roughness stored as '{stored}' is a number {range}"
            ))
            .into());
        }
        Ok(Roughness::Variance(variance_from_stored(value, stored)))
    }

    /// The picture, or of it the channel that was named where the picture as such does not have it: a layer of an EXR may.
    fn read(&self, path: &Path, limits: &Limits) -> Result<Decoded> {
        let whole = ReadOptions::from(*limits);
        let Some(name) = &self.roughness_channel else { return read_image(path, &whole) };
        match roughcast_io::read_image_file(path, &whole) {
            Ok(decoded) if channel_of(&decoded.info, name).is_some() => Ok(decoded),
            Ok(_) | Err(ReadError::OpenChannels { .. }) => {
                let named = ReadOptions { channels: vec![name.clone()], ..whole };
                roughcast_io::read_image_file(path, &named)
                    .map_err(|error| anyhow!("{error}: name one of these with --roughness-channel"))
                    .with_context(|| path.display().to_string())
            }
            Err(error) => Err(error).with_context(|| path.display().to_string()),
        }
    }

    fn map(&self, path: &Path, limits: &Limits) -> Result<Roughness> {
        let Decoded { image, info } = self.read(path, limits)?;
        refuse_baked(&info).with_context(|| path.display().to_string())?;
        let channel = match &self.roughness_channel {
            Some(name) => channel_of(&info, name).unwrap_or(0),
            None if image.channels() >= 3 => 1,
            None => 0,
        };
        Ok(Roughness::Map { image, channel, stored: self.roughness_stored })
    }
}
