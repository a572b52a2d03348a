//! The base roughness of the material, as the command line gives it.

use std::path::PathBuf;

use clap::Args;
use roughcast::texture::{Base, Brdf, RoughnessStored};
use roughcast_pipeline::RoughnessInput;

use crate::args::{one_of, specular_power};

/// Base roughness.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Roughness of the material itself")]
pub struct RoughnessArgs {
    /// The material's shininess, as a Blinn-Phong exponent
    #[arg(long, value_name = "S", value_parser = specular_power, conflicts_with = "roughness")]
    pub specular_power: Option<f32>,

    /// The material's roughness: a number, or a picture, which is resampled if it differs in size from the map. Colour pictures
    /// use the green channel, as glTF packs occlusion, roughness and metalness; pbr keeps the other two
    #[arg(long, value_name = "FILE|VALUE")]
    pub roughness: Option<String>,

    /// Channel of the picture that contains the roughness, by name: r, g, b, a, or any channel of an EXR [default: g in
    /// colour, the only one in grey]
    #[arg(long, value_name = "CHANNEL", requires = "roughness")]
    pub roughness_channel: Option<String>,

    /// What the values of --roughness mean: perceptual, as in glTF and most tools; alpha, its square, which is the width of
    /// the highlight; gloss, 1 minus perceptual
    #[arg(long, value_name = "HOW", default_value = "perceptual", value_parser = one_of::<RoughnessStored>())]
    pub roughness_stored: RoughnessStored,

    /// How pbr stores the roughness that it writes [default: perceptual; with --brdf blinn-phong in floats specular-power]
    #[arg(long, value_name = "HOW", value_parser = one_of::<RoughnessStored>())]
    pub roughness_output: Option<RoughnessStored>,

    /// The shading model that the roughness is meant for
    #[arg(long, default_value = "ggx", value_parser = one_of::<Brdf>())]
    pub brdf: Brdf,

    /// Whether this roughness is folded into the stored moments: none (the shader adds it) or baked (already
    /// included, so the shader must not add it). pbr and toksvig always contain it
    #[arg(long, default_value = "none", value_parser = one_of::<Base>())]
    pub base: Base,
}

impl RoughnessArgs {
    /// The base roughness that the arguments specify; `None` if they specify none.
    pub fn input(&self) -> Option<RoughnessInput> {
        if let Some(power) = self.specular_power {
            return Some(RoughnessInput::SpecularPower(power));
        }
        let text = self.roughness.as_ref()?;
        let stored = self.roughness_stored;
        Some(match text.parse::<f32>() {
            Ok(value) => RoughnessInput::Value { value, stored },
            Err(_) => {
                let channel = self.roughness_channel.clone();
                RoughnessInput::File { path: PathBuf::from(text), channel, stored }
            }
        })
    }
}
