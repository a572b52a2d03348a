//! Layers: several maps of bumps on one surface, mixed, added or masked, and filtered together.
//!
//! A layer has a map, a transform of its texture coordinates with a velocity, and a weight. [`LayerMethod`] lists the ways
//! to combine layers; the first three are those of Olano & Baker, "LEAN Mapping", 2010, section 3.5.
//!
//! | method | made from | needs | leaves out |
//! |---|---|---|---|
//! | [`Joint`](LayerMethod::Joint) | [`Layers::joint`], a map like any other | a new map when anything changes | nothing |
//! | [`MixingTextures`](LayerMethod::MixingTextures) | [`mixed`], with [`Layers::mixing_textures`] | a texture per pair, new when layers move | slopes of varying weights |
//! | [`Approximate`](LayerMethod::Approximate) | [`approximated`] | nothing | those, and what layers have in common |
//! | [`Add`](LayerMethod::Add) | [`added`] | nothing | what layers have in common |
//! | [`Mask`](LayerMethod::Mask) | [`masked`], with [`Layers::masked_textures`] | a texture per layer | steps at the edges of masks |
//!
//! *What is left out.* The slope of heights mixed with weights that vary is `Σ tᵢbᵢ - Σ fᵢ∇tᵢ`. The last sum is a slope of
//! its own, which only the joint map has, and only for layers whose heights are known. Where weights vary by little over a
//! bump's width, it is small. A mask's edge is where one surface ends and another begins, with no slope between them.
//!
//! *Base roughness.* Layers have none: their bumps are mixed, and the base of the mixed surface is added once, last. The
//! functions refuse distributions that contain it; [`without_base`] and [`level_without_base`] subtract a known one.
//!
//! *Precision.* What is stored is raw second moments, which are linear, so that any texture filter may average them. Covariances
//! are computed from them once per pixel, per layer and pair, with exact products, and only covariances are mixed:
//! `Σ = Σ tᵢ² Σᵢ + Σ tᵢtⱼ Kᵢⱼ` with the [`CrossMoments::covariance`] K of each pair. Mixing the raw moments first
//! ([`mixed_moments`], the paper's form) would lose small bumps on steep slopes in single floats.
//!
//! ```
//! use roughcast::layers::{CrossMoments, approximated, mixed};
//! use roughcast::{Covariance, Distribution, Slope};
//!
//! // sin x and -sin x, from far away: slopes of mean zero whose variance is 1/2 along x.
//! let flat = Slope::default();
//! let ridges = Distribution::gaussian(flat, Covariance { xx: 0.5, yy: 0.0, xy: 0.0 });
//! let layers = [(0.5, ridges), (0.5, ridges)];
//! // Their products average to -1/2, so the equal mix is smooth...
//! let cross = CrossMoments { xx: -1.0, yy: 0.0, xy: 0.0 };
//! assert_eq!(mixed(&layers, &[cross])?.whole().covariance, Covariance::default());
//! // ...which the means alone do not tell (Figure 10 of the paper).
//! assert_eq!(approximated(&layers)?.whole().covariance.xx, 0.25);
//! # Ok::<(), roughcast::layers::LayerError>(())
//! ```
//!
//! [`NormalBlend`] has the blends of normals in common use, for comparison. The twins in WGSL are in `layers.wgsl` and
//! `layers/normal_blends.wgsl`.

mod base;
mod cross;
mod error;
mod layer;
mod levels;
mod mask;
mod mix;
mod normal_blends;
mod set;
mod slope_map;
mod transform;

use crate::named::named_enum;
pub use base::{level_without_base, without_base};
pub use cross::{CrossMoments, pair_count, pairs};
pub use error::{LayerError, WEIGHT_SUM_TOLERANCE};
pub use layer::Layer;
pub use levels::{LayerLevel, MixingTexture, approximated_levels, masked_levels, mixed_levels};
pub use mask::{MaskedMoments, masked, masked_gaussian, masked_layers};
pub use mix::{added, approximated, correlated_layers, mixed, mixed_moments};
pub use normal_blends::{
    NormalBlend, blend_partial_derivatives, blend_reoriented, blend_udn, blend_whiteout,
};
pub use set::Layers;
pub use slope_map::SlopeMap;
pub use transform::{LayerTransform, RepeatedBumps};

named_enum! {
    /// A way to combine layers.
    #[non_exhaustive]
    pub enum LayerMethod: "way to combine layers" {
        /// Mixed as height fields, or as slopes, when one map is made of all layers. Way (a) of the paper.
        Joint = "joint",
        /// Mixed per pixel, with a texture of cross terms for every pair of layers. Way (b).
        MixingTextures = "mixing-textures",
        /// Mixed per pixel from the filtered means alone, as if the layers were uncorrelated. Way (c).
        Approximate = "approximate",
        /// Independent bumps on top of each other: means and covariances add. The weights are factors of heights.
        Add = "add",
        /// Every point belongs to one of the layers: their moments mix linearly, by the area that each covers.
        Mask = "mask",
    }
}

impl LayerMethod {
    /// Whether the weights of all layers must sum to one.
    ///
    /// The mixes are of height fields with barycentric weights: with another sum, bumps that all layers have would be
    /// scaled. Added layers have factors, and masks are areas, whose sum is divided out.
    pub const fn needs_unit_sum(self) -> bool {
        matches!(self, Self::Joint | Self::MixingTextures | Self::Approximate)
    }
}
