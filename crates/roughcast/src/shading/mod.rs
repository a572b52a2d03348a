//! Shading models: what a filtered surface reflects. One model per file, each with a WGSL twin of the same name next
//! to it.
//!
//! A model processes a [`Distribution`] of slopes, whatever its source, in two steps with the same names in Rust and
//! in WGSL:
//!
//! 1. `<model>_surface`, once per pixel: converts the distribution under a pixel to a surface; impossible covariances
//!    are repaired and the base roughness is added;
//! 2. `<model>_lobe`, once per light: evaluates the lobe for a direction to the viewer and one to the light.
//!
//! [`Shading::surface_of`] and [`Surface::lobe`] perform both steps for any model, and [`reflect`] converts the lobe
//! to radiance. The preceding steps are independent of the model: [`crate::texture`] decodes texels to distributions
//! (`lean_moments` and similar functions), and [`pixel_distribution`] removes the variance that a texture filter
//! covers beyond the pixel.
//!
//! All directions are unit vectors in the tangent frame of the *surface* (x right, y up, z the surface normal), and
//! `h` is the half vector. A lobe of slope density `p` has three forms ([`Form`]).
//!
//! No lobe is ever NaN or infinite, whatever the result of filtering: a zero normal counts as flat, a horizontal one
//! as steep, and a covariance without width is raised to the minimum ([`LEAST_VARIANCE`]). The base's exponent s
//! should be from 1 to 10⁵.
//!
//! ```
//! use roughcast::shading::{ShadingOptions, Shading};
//! use roughcast::{Covariance, Distribution, Slope};
//!
//! // Bumps with a standard deviation of 0.1 along x hide under the pixel; the material's own exponent is 200.
//! let bumps = Distribution::gaussian(Slope::default(), Covariance { xx: 0.01, yy: 0.0, xy: 0.0 });
//! let options = ShadingOptions::default().with_specular_power(200.0);
//! let surface = Shading::Lean.surface_of(&bumps, &options);
//! let from = |x: f32, y: f32| [x, y, (1.0 - x * x - y * y).sqrt()];
//! // The highlight is wider along x than along y.
//! let view = from(0.0, 0.0);
//! assert!(surface.lobe(view, from(0.3, 0.0), &options) > surface.lobe(view, from(0.0, 0.3), &options));
//! ```

mod base;
mod beckmann;
mod blinn_phong;
mod calls;
mod facet;
mod footprint;
mod gaussian;
mod geometric;
mod ggx;
mod masking;
mod mixture;
mod off_centre;
mod phong;
mod pixel;
mod reflectance;
mod surface;
mod toksvig;
mod vector;

pub use base::{base_covariance, base_in_map, base_to_add};
pub use beckmann::{beckmann_lobe, beckmann_surface};
pub use blinn_phong::{blinn_phong_lobe, blinn_phong_surface};
pub use calls::{Calls, Gaussians};
pub use facet::{
    BumpFacet, LEAST_COSINE, LEAST_VIEW_COSINE, bump_facet, cosine_lobe, cosine_power, facet_visible_part,
    unit_normal,
};
pub use footprint::{
    FilterVariances, FootprintAxes, FootprintRatio, PIXEL_STANDARD_DEVIATION, PixelPart, footprint_axes,
    footprint_ratio, hardware_variances, level_variances, pixel_part,
};
pub use gaussian::{
    LARGEST_EXPONENT, LEAST_VARIANCE, SlopeGaussian, gaussian_lobe, gaussian_visible_part, slope_gaussian,
    squared_deviations,
};
pub use geometric::{GeometricFilter, geometric_covariance};
pub use ggx::{
    GgxSurface, PrincipalAxes, ggx_lambda, ggx_lobe, ggx_surface, ggx_visible_part, principal_axes,
};
pub use masking::{gaussian_lambda, projected_variance, visible_part};
pub use mixture::{MixtureSurface, gaussian_surface, mixture_lobe, mixture_surface, shaded_gaussian};
pub use off_centre::off_centre_surface;
pub use phong::{phong_lobe, phong_surface};
pub use pixel::pixel_distribution;
pub(crate) use pixel::reduce_to_pixel;
pub use reflectance::{
    LightSample, Material, Radiance, ambient_radiance, diffuse_radiance, reflect, schlick, specular_radiance,
};
pub use surface::{ModelSurface, Surface};
pub use toksvig::toksvig_surface;
pub use vector::LEAST_HEIGHT;

#[cfg(doc)]
use crate::Distribution;
use crate::named::named_enum;
use crate::setters::setters;

named_enum! {
    /// A shading model.
    #[non_exhaustive]
    pub enum Shading: "shading model" {
        /// Phong: a lobe about the reflected ray at the filtered bump normal.
        Phong = "phong",
        /// Blinn-Phong on the filtered bump normal: the conventional method, which loses the bumps.
        BlinnPhong = "blinn-phong",
        /// Beckmann (Ward) in the frame of the filtered bump normal.
        Beckmann = "beckmann",
        /// Off-centre Beckmann in the surface frame, about the filtered bump's slope (LEAN Eq. 1 without filtered
        /// moments).
        OffCentre = "off-centre",
        /// LEAN mapping, using filtered moments.
        Lean = "lean",
        /// CLEAN mapping, using the filtered trace of the moments.
        Clean = "clean",
        /// Toksvig: Blinn-Phong with an exponent reduced according to the length of the averaged normal.
        Toksvig = "toksvig",
        /// Off-centre Beckmann with a stored variance.
        Variance = "variance",
        /// GGX with the baked roughness of `pbr`, isotropic or anisotropic.
        Ggx = "ggx",
    }
}

named_enum! {
    /// The form of a lobe, given its density `p` over slopes.
    #[non_exhaustive]
    pub enum Form: "form" {
        /// `D G2 / n.v`: the normalised distribution D with Smith's height-correlated shadowing and masking. A
        /// microfacet BRDF reflects a quarter of it, times Fresnel's term, of a light's irradiance. For models in the
        /// surface frame n is the surface normal, for those in the frame of the bump the bump normal.
        Physical = "physical",
        /// A microfacet distribution, `D = p / h.z^4`: it integrates to 1 over the projected solid angle of its own
        /// axis. Blinn-Phong is `(s + 2) / (2 pi) cos^s`.
        Normalised = "normalised",
        /// The LEAN paper's form: `2 pi p`, without the factor `1 / h.z^4`. Blinn-Phong is `s cos^s`.
        Paper = "paper",
    }
}

named_enum! {
    /// Which slopes cause shadowing and masking in [`Form::Physical`], for models that separate base roughness from
    /// bumps. Phong and GGX do not separate them.
    #[non_exhaustive]
    pub enum Masking: "masking" {
        /// Those of the base roughness, as in close views of bump mapping, where each bump is lit separately.
        Base = "base",
        /// Those of base roughness and bumps, as for displaced geometry (Dupuy et al., "Linear Efficient Antialiased
        /// Displacement and Reflectance Mapping", 2013).
        Full = "full",
    }
}

named_enum! {
    /// Which variance counts as roughness.
    #[non_exhaustive]
    pub enum FootprintModel: "footprint" {
        /// The variance under the pixel: the part that the texture filter covers beyond it is removed. See
        /// [`footprint_ratio`].
        Corrected = "corrected",
        /// All variance under the texture filter, as in the papers.
        Published = "published",
    }
}

named_enum! {
    /// The shape of a facet's base roughness in the plane of the surface, for lobes in the surface frame.
    #[non_exhaustive]
    pub enum BaseFrame: "base lobe" {
        /// Round, with variance `1 / s` whatever the facet's slope: LEAN's approximation.
        Plane = "plane",
        /// The actual lobe of a facet of slope B in that plane: variance `(1 + B^2)^2 / s` along B, `(1 + B^2) / s`
        /// across.
        Facet = "facet",
    }
}

named_enum! {
    /// How a covariance that has become invalid by rounding is repaired.
    #[non_exhaustive]
    pub enum Repair: "repair" {
        /// Made positive semidefinite: negative variances become zero, the mixed term is clamped.
        Clamp = "clamp",
        /// The papers' rules: no highlight unless the determinant is positive (LEAN Figure 16), no covariance
        /// (CLEAN).
        Published = "published",
    }
}

/// The input that a shading model needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Wanted {
    /// Only the filtered normal.
    Normal,
    /// The distribution of slopes.
    Distribution,
}

/// How lobes are evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct ShadingOptions {
    /// Blinn-Phong exponent `s` of the base roughness; its slope variance is `1 / s`.
    pub specular_power: f32,
    /// The form of the lobe.
    pub form: Form,
    /// The base roughness in the plane of the surface.
    pub base_frame: BaseFrame,
    /// How invalid covariances are repaired.
    pub repair: Repair,
    /// Which slopes cause shadowing and masking in the physical form.
    pub masking: Masking,
    /// Which variance counts as roughness.
    pub footprint: FootprintModel,
}

setters!(ShadingOptions {
    with_specular_power(specular_power: f32),
    with_form(form: Form),
    with_base_frame(base_frame: BaseFrame),
    with_repair(repair: Repair),
    with_masking(masking: Masking),
    with_footprint(footprint: FootprintModel),
});

impl Default for ShadingOptions {
    fn default() -> Self {
        Self {
            specular_power: 256.0,
            form: Form::Physical,
            base_frame: BaseFrame::Plane,
            repair: Repair::Clamp,
            masking: Masking::Base,
            footprint: FootprintModel::Corrected,
        }
    }
}

impl ShadingOptions {
    /// LEAN mapping as published: the paper's form, using all variance under the texture filter.
    #[must_use]
    pub fn published(specular_power: f32) -> Self {
        Self { specular_power, form: Form::Paper, footprint: FootprintModel::Published, ..Self::default() }
    }

    /// The bytes of WGSL's `struct ShadingOptions`: the exponent's bits, the index of each choice in its enum's
    /// `ALL`, and two unused words.
    pub fn to_words(&self) -> [u32; 8] {
        [
            self.specular_power.to_bits(),
            self.form as u32,
            self.base_frame as u32,
            self.repair as u32,
            self.masking as u32,
            self.footprint as u32,
            0,
            0,
        ]
    }
}

impl Shading {
    /// The input that the model needs from a source of bumps.
    pub const fn wanted(self) -> Wanted {
        match self {
            Self::Phong | Self::BlinnPhong | Self::Beckmann | Self::OffCentre => Wanted::Normal,
            Self::Lean | Self::Clean | Self::Toksvig | Self::Variance | Self::Ggx => Wanted::Distribution,
        }
    }

    /// The model whose lobe the ground truth uses to shade each resolved bump. It does not use filtered moments.
    pub const fn reference(self) -> Self {
        match self {
            Self::Phong => Self::Phong,
            Self::BlinnPhong | Self::Toksvig => Self::BlinnPhong,
            Self::Beckmann => Self::Beckmann,
            Self::OffCentre | Self::Lean | Self::Clean | Self::Variance => Self::OffCentre,
            Self::Ggx => Self::Ggx,
        }
    }
}
