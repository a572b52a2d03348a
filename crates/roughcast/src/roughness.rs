//! Conventions of roughness: the reflectance function it is meant for, how and where it is stored, and whether the
//! moments contain it.
//!
//! In this crate every roughness is a slope variance per axis; see the table of conventions in the [crate's](crate)
//! documentation.

use crate::named::named_enum;

named_enum! {
    /// Whether the second moments already contain the base roughness of the material.
    #[non_exhaustive]
    pub enum Base: "base" {
        /// Not contained: add it once, at shading.
        None = "none",
        /// Folded in when the map was made (LEAN Eq. 6): add nothing at shading.
        Baked = "baked",
    }
}

named_enum! {
    /// The microfacet distribution that a stored roughness is meant for.
    #[non_exhaustive]
    pub enum Brdf: "BRDF" {
        /// GGX, by the convention `alpha^2 = alpha0^2 + 2 sigma^2`: it has no finite slope variance of its own.
        Ggx = "ggx",
        /// Beckmann, where `alpha^2 = 2 sigma^2` exactly.
        Beckmann = "beckmann",
        /// Blinn-Phong, where `sigma^2 = 1 / s`.
        BlinnPhong = "blinn-phong",
    }
}

named_enum! {
    /// The quantity that represents a stored roughness. `alpha` is the width of the lobe.
    #[non_exhaustive]
    pub enum RoughnessStored: "way to store roughness" {
        /// glTF's perceptual roughness, `sqrt(alpha)`.
        Perceptual = "perceptual",
        /// The width itself.
        Alpha = "alpha",
        /// The square of the width.
        AlphaSquared = "alpha-squared",
        /// One minus the perceptual roughness.
        Gloss = "gloss",
        /// A Blinn-Phong exponent, `2 / alpha^2`.
        SpecularPower = "specular-power",
    }
}

named_enum! {
    /// Whether the roughness of a physically based material depends on the direction.
    pub enum Anisotropy: "lobe" {
        /// One roughness for every direction.
        Isotropic = "isotropic",
        /// Two roughnesses and a direction, as in KHR_materials_anisotropy.
        Anisotropic = "anisotropic",
    }
}

named_enum! {
    /// The channels in which `pbr` stores roughness. The variants are named after the channels.
    #[non_exhaustive]
    pub enum RoughnessTexture: "roughness layout" {
        /// One channel: BC4, and renderers that read a single value.
        Alone = "r",
        /// Green, where glTF and three.js read it, with an occlusion of 1 in red and a metalness of 0 in blue.
        Green = "g",
        /// glTF's packed texture: occlusion in red, roughness in green, metalness in blue; all three come from an input
        /// texture if there is one.
        Packed = "orm",
    }
}

impl RoughnessTexture {
    /// Number of channels of the texture.
    pub const fn channels(self) -> usize {
        match self {
            RoughnessTexture::Alone => 1,
            RoughnessTexture::Green | RoughnessTexture::Packed => 4,
        }
    }

    /// The channel that contains the roughness.
    pub const fn roughness_channel(self) -> usize {
        match self {
            RoughnessTexture::Alone => 0,
            RoughnessTexture::Green | RoughnessTexture::Packed => 1,
        }
    }
}

/// Slope variance per axis of a stored roughness: `alpha^2 / 2`, as for Beckmann's lobe.
pub fn variance_from_stored(value: f32, stored: RoughnessStored) -> f32 {
    let alpha_squared = match stored {
        RoughnessStored::Perceptual => value.powi(4),
        RoughnessStored::Alpha => value * value,
        RoughnessStored::AlphaSquared => value,
        RoughnessStored::Gloss => (1.0 - value).powi(4),
        RoughnessStored::SpecularPower => 2.0 / value,
    };
    0.5 * alpha_squared
}

/// The inverse of [`variance_from_stored`]. A variance of zero has no finite specular power: the result is infinite.
pub fn stored_from_variance(variance: f32, stored: RoughnessStored) -> f32 {
    let alpha_squared = 2.0 * variance;
    match stored {
        RoughnessStored::Perceptual => alpha_squared.sqrt().sqrt(),
        RoughnessStored::Alpha => alpha_squared.sqrt(),
        RoughnessStored::AlphaSquared => alpha_squared,
        RoughnessStored::Gloss => 1.0 - alpha_squared.sqrt().sqrt(),
        RoughnessStored::SpecularPower => 1.0 / variance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_store_roughness_reads_back() {
        const ROUNDING: f32 = 4e-6; // four roots and powers in f32, relative
        for stored in RoughnessStored::ALL {
            for variance in [1e-4_f32, 0.02, 0.3] {
                let back = variance_from_stored(stored_from_variance(variance, *stored), *stored);
                // Gloss loses digits in `1 - r`, and the fourth power amplifies the error.
                let tolerance = if *stored == RoughnessStored::Gloss { 20.0 * ROUNDING } else { ROUNDING };
                assert!((back / variance - 1.0).abs() < tolerance, "{stored}: {variance} -> {back}");
            }
        }
    }

    #[test]
    fn the_table_of_conventions_holds() {
        assert_eq!(variance_from_stored(64.0, RoughnessStored::SpecularPower), 1.0 / 64.0);
        assert_eq!(variance_from_stored(0.5, RoughnessStored::Perceptual), 0.5 * 0.25 * 0.25);
        assert_eq!(variance_from_stored(0.5, RoughnessStored::Alpha), 0.125);
        assert_eq!(variance_from_stored(1.0, RoughnessStored::Gloss), 0.0);
    }
}
