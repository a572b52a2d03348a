//! How the models are called in WGSL: the one place that says so, for our renderer, for exports and for their headers.

use super::Shading;

/// The functions of a model in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calls {
    /// `NAME(distribution, options)`, once a pixel: the surface.
    pub surface: &'static str,
    /// `NAME(surface, view, light, options)`, once a light: the lobe.
    pub lobe: &'static str,
}

impl Calls {
    /// The names that a host uses for the functions of any model, with those of this one: for [`crate::wgsl::renamed`].
    pub fn names(self) -> [(&'static str, &'static str); 2] {
        [("model_surface", self.surface), ("model_lobe", self.lobe)]
    }
}

impl Shading {
    /// How the model is called in WGSL.
    pub const fn calls(self) -> Calls {
        let (surface, lobe) = match self {
            Self::Phong => ("phong_surface", "phong_lobe"),
            Self::BlinnPhong => ("blinn_phong_surface", "blinn_phong_lobe"),
            Self::Beckmann => ("beckmann_surface", "beckmann_lobe"),
            Self::OffCentre => ("off_centre_surface", "mixture_lobe"),
            Self::Lean | Self::Clean | Self::Variance => ("mixture_surface", "mixture_lobe"),
            Self::Toksvig => ("toksvig_surface", "blinn_phong_lobe"),
            Self::Ggx => ("ggx_surface", "ggx_lobe"),
        };
        Calls { surface, lobe }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl::library;

    #[test]
    fn the_functions_are_there_with_these_arguments() {
        assert!(!Shading::ALL.is_empty());
        for model in Shading::ALL {
            let code = library(&[model.name()]).expect("every model has a module");
            let Calls { surface, lobe } = model.calls();
            let made = format!("fn {surface}(distribution: Distribution, options: LobeOptions) -> ");
            let (_, rest) = code.split_once(&made).unwrap_or_else(|| panic!("{model}: no {made}"));
            let of_type = rest.split_whitespace().next().expect("a type");
            let taken =
                format!("fn {lobe}(surface: {of_type}, view: vec3f, light: vec3f, options: LobeOptions)");
            assert!(code.contains(&taken), "{model}: no {taken}");
        }
    }
}
