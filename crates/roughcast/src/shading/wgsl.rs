//! The WGSL twins of the shading models, as modules that are put together without a preprocessor.
//!
//! Functions have the names and the order of arguments of their Rust twins; a mean slope is a `vec2f`, a covariance a
//! `vec3f` (xx, yy, xy). The modules have no entry points and no resources, and only `BumpFacet` and `GgxSurface` hold a
//! `vec3f`, each followed by an `f32`, so that no language needs padding. Local names repeat between functions.

use crate::UnknownName;

/// A piece of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// Its name: of a model, the one that the command line uses.
    pub name: &'static str,
    /// The code.
    pub source: &'static str,
    /// The modules that it uses directly. They come before it in [`MODULES`].
    pub needs: &'static [&'static str],
    /// What it is, in a line.
    pub summary: &'static str,
    /// The text that it implements.
    pub citation: &'static str,
    /// Whether it is for users to call, or only a part of others.
    pub role: Role,
}

/// What a module is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A shading model.
    Model,
    /// Functions beside the models.
    Companion,
    /// What others are made of.
    Part,
}

/// Every module, each after those that it needs.
pub const MODULES: &[Module] = &[
    Module {
        name: "options",
        source: include_str!("options.wgsl"),
        needs: &[],
        summary: "how lobes are evaluated",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "packing",
        source: include_str!("../texture/packing.wgsl"),
        needs: &[],
        summary: "from stored texels to values",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "vector",
        source: include_str!("vector.wgsl"),
        needs: &[],
        summary: "directions",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "masking",
        source: include_str!("masking.wgsl"),
        needs: &[],
        summary: "shadowing and masking",
        citation: "Smith, 1967; Walter et al., 2007, 5.2; Heitz, 2014",
        role: Role::Part,
    },
    Module {
        name: "footprint",
        source: include_str!("footprint.wgsl"),
        needs: &["options"],
        summary: "which part of the variance under a texture filter is the pixel's",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "facet",
        source: include_str!("facet.wgsl"),
        needs: &["options", "packing", "vector", "masking"],
        summary: "a facet of the bump map and cosine lobes",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "base",
        source: include_str!("base.wgsl"),
        needs: &["options"],
        summary: "base roughness in the plane of the surface",
        citation: "Olano & Baker, LEAN Mapping, 2010, 3.4",
        role: Role::Part,
    },
    Module {
        name: "gaussian",
        source: include_str!("gaussian.wgsl"),
        needs: &["options", "vector", "masking"],
        summary: "a Gaussian of slopes",
        citation: "Olano & Baker, LEAN Mapping, 2010, Eq. 1",
        role: Role::Part,
    },
    Module {
        name: "moment-surface",
        source: include_str!("moment_surface.wgsl"),
        needs: &["base", "footprint", "gaussian"],
        summary: "from filtered moments to a Gaussian of slopes",
        citation: "",
        role: Role::Part,
    },
    Module {
        name: "phong",
        source: include_str!("phong.wgsl"),
        needs: &["facet"],
        summary: "Phong, about the reflected ray, on the filtered bump normal",
        citation: "Phong, Illumination for Computer Generated Pictures, 1975",
        role: Role::Model,
    },
    Module {
        name: "blinn-phong",
        source: include_str!("blinn_phong.wgsl"),
        needs: &["facet"],
        summary: "Blinn-Phong on the filtered bump normal: the ordinary way",
        citation: "Blinn, Models of light reflection for computer synthesized pictures, 1977",
        role: Role::Model,
    },
    Module {
        name: "beckmann",
        source: include_str!("beckmann.wgsl"),
        needs: &["facet", "gaussian"],
        summary: "Beckmann in the frame of the filtered bump normal",
        citation: "Beckmann & Spizzichino, 1963; Olano & Baker, LEAN Mapping, 2010, 3.1",
        role: Role::Model,
    },
    Module {
        name: "off-centre",
        source: include_str!("off_centre.wgsl"),
        needs: &["facet", "base", "gaussian"],
        summary: "off-centre Beckmann in the surface frame, of the filtered bump's slope",
        citation: "Olano & Baker, LEAN Mapping, 2010, Eq. 1",
        role: Role::Model,
    },
    Module {
        name: "lean",
        source: include_str!("lean.wgsl"),
        needs: &["facet", "moment-surface"],
        summary: "LEAN mapping, from filtered moments",
        citation: "Olano & Baker, LEAN Mapping, 2010, Eq. 1, 5 and 6, Figure 16",
        role: Role::Model,
    },
    Module {
        name: "clean",
        source: include_str!("clean.wgsl"),
        needs: &["packing", "moment-surface"],
        summary: "CLEAN mapping, from the filtered trace of the moments",
        citation: "Olano, Shiny and CLEAN, 2011",
        role: Role::Model,
    },
    Module {
        name: "toksvig",
        source: include_str!("toksvig.wgsl"),
        needs: &["facet", "blinn-phong"],
        summary: "Toksvig: Blinn-Phong, dulled by the averaged normal's length",
        citation: "Toksvig, Mipmapping normal maps, 2005",
        role: Role::Model,
    },
    Module {
        name: "variance",
        source: include_str!("variance.wgsl"),
        needs: &["packing", "moment-surface"],
        summary: "off-centre Beckmann with a stored variance",
        citation: "Olano, Shiny and CLEAN, 2011",
        role: Role::Model,
    },
    Module {
        name: "ggx",
        source: include_str!("ggx.wgsl"),
        needs: &["facet", "gaussian"],
        summary: "GGX with baked roughness, isotropic or anisotropic",
        citation: "Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007; glTF KHR_materials_anisotropy",
        role: Role::Model,
    },
    Module {
        name: "reflectance",
        source: include_str!("reflectance.wgsl"),
        needs: &["options", "vector"],
        summary: "ambient, diffuse and specular radiance of a lobe, with Schlick's Fresnel term",
        citation: "Schlick, A customizable reflectance model for everyday rendering, 1993; Kilgard, 2000",
        role: Role::Companion,
    },
];

/// The conventions of all modules, a sentence a line.
pub const CONVENTIONS: &[&str] = &[
    "Directions are unit vectors in the tangent frame of the surface: x right (growing u), y up, z the surface normal.",
    "A slope is (N.x / N.z, N.y / N.z). Second moments and covariances are in the order xx, yy, xy, and have no unit.",
    "alpha is the width of a lobe: Beckmann's and GGX's alpha^2 = 2 variance, Blinn-Phong's variance = 1 / s.",
    "Texels are sampled linearly, never as sRGB. Packing says how they are read: value = stored * x + y.",
    "NAME_surface makes a surface of filtered texels, or of a filtered normal, once a pixel.",
    "NAME_lobe is its lobe for a direction to the viewer and one to the light, zero where either is not above the surface.",
    "In the normalised form a lobe is a microfacet distribution D; in the physical form D G2 / n.v; in the paper's 2 pi D h.z^4.",
    "No lobe is NaN or infinite for texels that filtering can give and specular powers from 1 to 100000.",
];

/// The module of this name.
///
/// # Errors
/// [`UnknownName`] where there is none.
pub fn module(name: &str) -> Result<&'static Module, UnknownName> {
    MODULES.iter().find(|module| module.name == name).ok_or_else(|| UnknownName {
        what: "WGSL module",
        got: name.to_owned(),
        known: MODULES.iter().map(|module| module.name).collect::<Vec<_>>().join(", "),
    })
}

/// The modules of these names and all that they need, each once, in the order of [`MODULES`].
///
/// # Errors
/// [`UnknownName`] where one of the names is of no module.
pub fn modules(names: &[&str]) -> Result<Vec<&'static Module>, UnknownName> {
    let mut wanted = names.iter().map(|name| module(name)).collect::<Result<Vec<_>, _>>()?;
    let mut next = 0;
    while let Some(module) = wanted.get(next) {
        for needed in module.needs {
            let needed = self::module(needed)?;
            if !wanted.contains(&needed) {
                wanted.push(needed);
            }
        }
        next += 1;
    }
    Ok(MODULES.iter().filter(|module| wanted.contains(module)).collect())
}

/// The source of the modules of these names with all that they need.
///
/// # Errors
/// [`UnknownName`] where one of the names is of no module.
pub fn library(names: &[&str]) -> Result<String, UnknownName> {
    let sources = modules(names)?.into_iter().map(|module| module.source);
    Ok(sources.collect::<Vec<_>>().join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::{LobeOptions, Shading};
    use crate::texture::{Base, RoughnessStored};

    #[test]
    fn every_model_has_a_module_and_every_need_comes_first() {
        for shading in Shading::ALL {
            assert_eq!(module(shading.name()).map(|module| module.role), Ok(Role::Model));
        }
        assert_eq!(MODULES.iter().filter(|m| m.role == Role::Model).count(), Shading::ALL.len());
        for (place, module) in MODULES.iter().enumerate() {
            for needed in module.needs {
                assert!(MODULES[..place].iter().any(|m| m.name == *needed), "{}: {needed}", module.name);
            }
        }
    }

    #[test]
    fn a_library_holds_what_is_needed_once() {
        let text = library(&["lean", "clean", "lean"]).expect("these modules exist");
        for once in ["fn lean_lobe(", "fn clean_lobe(", "fn gaussian_lobe(", "struct LobeOptions {"] {
            assert_eq!(text.matches(once).count(), 1, "{once}");
        }
        assert!(!text.contains("ggx"));
        assert!(library(&["lean", "loan"]).is_err_and(|error| error.to_string().contains("loan")));
    }

    #[test]
    fn the_choices_have_the_same_numbers_on_both_sides() {
        let source = module("options").expect("it exists").source;
        let number = |name: &str| {
            let (_, rest) = source.split_once(&format!("const {name}: u32 = ")).expect(name);
            rest.split_once('u').expect("a number ends with u").0.parse::<u32>().expect(name)
        };
        let words = |options: LobeOptions| options.to_words();
        let default = LobeOptions::default();
        for (stored, name) in RoughnessStored::ALL.iter().zip([
            "STORED_PERCEPTUAL",
            "STORED_ALPHA",
            "STORED_ALPHA_SQUARED",
            "STORED_GLOSS",
            "STORED_SPECULAR_POWER",
        ]) {
            assert_eq!(words(LobeOptions { roughness_stored: *stored, ..default })[5], number(name));
        }
        use crate::shading::{BaseLobe, FootprintModel, Form, Masking, Repair};
        for (form, name) in Form::ALL.iter().copied().zip(["FORM_PHYSICAL", "FORM_NORMALISED", "FORM_PAPER"])
        {
            assert_eq!(words(LobeOptions { form, ..default })[1], number(name));
        }
        for (base, name) in [(BaseLobe::Plane, "BASE_PLANE"), (BaseLobe::Facet, "BASE_FACET")] {
            assert_eq!(words(LobeOptions { base, ..default })[2], number(name));
        }
        for (repair, name) in [(Repair::Clamp, "REPAIR_CLAMP"), (Repair::Published, "REPAIR_PUBLISHED")] {
            assert_eq!(words(LobeOptions { repair, ..default })[3], number(name));
        }
        for (base, name) in [(Base::None, "MAPS_WITHOUT_BASE"), (Base::Baked, "MAPS_WITH_BASE")] {
            assert_eq!(words(LobeOptions { base_in_maps: base, ..default })[4], number(name));
        }
        for (masking, name) in [(Masking::Base, "MASKING_BASE"), (Masking::Full, "MASKING_FULL")] {
            assert_eq!(words(LobeOptions { masking, ..default })[6], number(name));
        }
        for (footprint, name) in [
            (FootprintModel::Corrected, "FOOTPRINT_CORRECTED"),
            (FootprintModel::Published, "FOOTPRINT_PUBLISHED"),
        ] {
            assert_eq!(words(LobeOptions { footprint, ..default })[7], number(name));
        }
        // A caller that leaves all choices zero has the defaults.
        assert_eq!(words(default)[1..], [0; 7]);
        assert_eq!(f32::from_bits(default.to_words()[0]), default.specular_power);
    }
}
