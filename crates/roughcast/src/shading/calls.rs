//! How the models are called in WGSL. This is the single definition for our renderer, for exports and for their
//! headers.

use super::Shading;

/// The WGSL functions of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Calls {
    /// The WGSL module that has both functions: see [`crate::wgsl`].
    pub module: &'static str,
    /// `NAME(distribution, options)`, called once per pixel, returns the surface.
    pub surface: &'static str,
    /// `NAME(surface, view, light, options)`, called once per light, returns the lobe.
    pub lobe: &'static str,
}

impl Calls {
    /// Pairs of the names that a host uses for the functions of any model and the names of this model's functions:
    /// for [`crate::wgsl::renamed`].
    pub fn names(self) -> [(&'static str, &'static str); 2] {
        [("model_surface", self.surface), ("model_lobe", self.lobe)]
    }
}

/// The number of Gaussians in the distributions of a source of bumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gaussians {
    /// One. The shader then contains no code for several.
    One,
    /// One to [`crate::MAX_GAUSSIANS`].
    Several,
}

impl Shading {
    /// How the model is called in WGSL. Some models shade only the total distribution of several Gaussians.
    pub const fn calls(self, gaussians: Gaussians) -> Calls {
        let [module, surface, lobe] = match (self, gaussians) {
            (Self::Phong, _) => ["phong", "phong_surface", "phong_lobe"],
            (Self::BlinnPhong, _) => ["blinn-phong", "blinn_phong_surface", "blinn_phong_lobe"],
            (Self::Beckmann, _) => ["beckmann", "beckmann_surface", "beckmann_lobe"],
            (Self::OffCentre, _) => ["off-centre", "off_centre_surface", "gaussian_lobe"],
            (Self::Lean | Self::Clean | Self::Variance, Gaussians::One) => {
                ["gaussian-surface", "gaussian_surface", "gaussian_lobe"]
            }
            (Self::Lean | Self::Clean | Self::Variance, Gaussians::Several) => {
                ["mixture", "mixture_surface", "mixture_lobe"]
            }
            (Self::Toksvig, _) => ["toksvig", "toksvig_surface", "blinn_phong_lobe"],
            (Self::Ggx, _) => ["ggx", "ggx_surface", "ggx_lobe"],
        };
        Calls { module, surface, lobe }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl::library;

    #[test]
    fn the_functions_exist_with_these_arguments() {
        assert!(!Shading::ALL.is_empty());
        for (model, gaussians) in
            Shading::ALL.iter().flat_map(|model| [(model, Gaussians::One), (model, Gaussians::Several)])
        {
            let Calls { module, surface, lobe } = model.calls(gaussians);
            let code = library(&[module]).expect("it exists");
            let made = format!("fn {surface}(distribution: Distribution, options: ShadingOptions) -> ");
            let (_, rest) = code.split_once(&made).unwrap_or_else(|| panic!("{model}: no {made}"));
            let of_type = rest.split_whitespace().next().expect("a type");
            let taken =
                format!("fn {lobe}(surface: {of_type}, view: vec3f, light: vec3f, options: ShadingOptions)");
            assert!(code.contains(&taken), "{model}: no {taken}");
        }
    }
}
