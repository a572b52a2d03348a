//! The library in WGSL: twins of the Rust files next to them, as modules that are concatenated without a
//! preprocessor.
//!
//! Functions have the same names and argument order as their Rust twins; a mean slope is a `vec2f`, a covariance a
//! `vec3f` (xx, yy, xy). The modules have no entry points and no resources. Local names are not unique across
//! functions.
//!
//! - [`Role::Model`], [`Role::Companion`] and [`Role::Part`] are for shading: [`library`] assembles what a model
//!   needs to shade a distribution. Textures are read by the module of their layout's
//!   [`TexelReader`](crate::texture::TexelReader).
//! - [`Role::Detail`] modules are sources of bumps, which call some functions of their host; each file lists them.
//! - [`Role::Bake`] modules implement the arithmetic of baking, for a host with bindings and entry points.

mod modules;

use crate::UnknownName;
pub use modules::MODULES;

/// A module of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Module {
    /// The name of the module; for a model, the one used on the command line.
    pub name: &'static str,
    /// The code.
    pub source: &'static str,
    /// The modules that it uses directly. They precede it in [`MODULES`].
    pub needs: &'static [&'static str],
    /// A one-line description.
    pub summary: &'static str,
    /// The paper that it implements.
    pub citation: &'static str,
    /// Whether it is meant to be called by users or is only part of other modules.
    pub role: Role,
}

/// The purpose of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Role {
    /// A shading model.
    Model,
    /// Functions used together with the models.
    Companion,
    /// A building block of other modules.
    Part,
    /// A source of bumps, which calls functions of its host.
    Detail,
    /// The arithmetic of baking, rounded as on the CPU.
    Bake,
}

/// The conventions of all modules, one sentence per line.
pub const CONVENTIONS: &[&str] = &[
    "Directions are unit vectors in the tangent frame of the surface: x right (growing u), y up, z the surface normal.",
    "A slope is (N.x / N.z, N.y / N.z). Second moments and covariances are in the order xx, yy, xy, and have no unit.",
    "alpha is the width of a lobe: Beckmann's and GGX's alpha^2 = 2 variance, Blinn-Phong's variance = 1 / s.",
    "Texels are sampled linearly, never as sRGB. Packing says how they are read: value = stored * x + y.",
    "NAME_moments reads filtered texels as a distribution of slopes; NAME_surface converts it to a surface, once per pixel.",
    "NAME_lobe is its lobe for a direction to the viewer and one to the light, zero where either is not above the surface.",
    "In the normalised form a lobe is a microfacet distribution D; in the physical form D G2 / n.v; in the paper's 2 pi D h.z^4.",
    "No lobe is NaN or infinite for texels that filtering can give and specular powers from 1 to 100000.",
];

/// The module with this name.
///
/// # Errors
/// [`UnknownName`] if there is none.
pub fn module(name: &str) -> Result<&'static Module, UnknownName> {
    MODULES.iter().find(|module| module.name == name).ok_or_else(|| UnknownName {
        what: "WGSL module",
        got: name.to_owned(),
        known: MODULES.iter().map(|module| module.name).collect::<Vec<_>>().join(", "),
    })
}

/// The modules with these names and all their dependencies, each once, in the order of [`MODULES`].
///
/// # Errors
/// [`UnknownName`] if there is no module with one of the names.
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

/// The source of the modules with these names and all their dependencies.
///
/// # Errors
/// [`UnknownName`] if there is no module with one of the names.
pub fn library(names: &[&str]) -> Result<String, UnknownName> {
    let sources = modules(names)?.into_iter().map(|module| module.source);
    Ok(sources.collect::<Vec<_>>().join("\n"))
}

/// The source of all modules with one role, without their dependencies on other roles.
pub fn library_of(role: Role) -> String {
    let sources = MODULES.iter().filter(|module| module.role == role).map(|module| module.source);
    sources.collect::<Vec<_>>().join("\n")
}

/// Replaces whole words in code; used to replace a host's generic names by those of a model.
///
/// ```
/// use roughcast::wgsl::renamed;
///
/// let host = "let lobe = model_lobe(surface); // not model_lobes";
/// assert_eq!(renamed(host, &[("model_lobe", "ggx_lobe")]), "let lobe = ggx_lobe(surface); // not model_lobes");
/// ```
pub fn renamed(code: &str, names: &[(&str, &str)]) -> String {
    map_words(code, |word, _| names.iter().find(|(from, _)| *from == word).map(|(_, to)| (*to).to_owned()))
}

/// Replaces words in code by the result of `new`, which also receives the code between the previous word and this
/// one, since a word after a single dot is a member of a struct.
pub fn map_words(code: &str, new: impl Fn(&str, &str) -> Option<String>) -> String {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let (mut out, mut rest) = (String::with_capacity(code.len()), code);
    while let Some(start) = rest.find(is_part) {
        let (before, from) = rest.split_at(start);
        let end = from.find(|c| !is_part(c)).unwrap_or(from.len());
        let (word, after) = from.split_at(end);
        out.push_str(before);
        out.push_str(&new(word, before).unwrap_or_else(|| word.to_owned()));
        rest = after;
    }
    out.push_str(rest);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::{Shading, ShadingOptions};
    use crate::texture::{Base, Packing, RoughnessStored};

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
    fn a_library_contains_each_module_once() {
        let text = library(&["lean", "clean", "lean"]).expect("these modules exist");
        for once in ["fn lean_moments(", "fn clean_moments(", "fn gaussian_lobe(", "struct ShadingOptions {"]
        {
            assert_eq!(text.matches(once).count(), 1, "{once}");
        }
        assert!(!text.contains("ggx"));
        assert!(library(&["lean", "loan"]).is_err_and(|error| error.to_string().contains("loan")));
    }

    #[test]
    fn choices_have_the_same_numbers_in_rust_and_wgsl() {
        let source = library(&["options", "packing", "distribution"]).expect("they exist");
        let number = |name: &str| {
            let (_, rest) = source.split_once(&format!("const {name}: u32 = ")).expect(name);
            rest.split_once('u').expect("a number ends with u").0.parse::<u32>().expect(name)
        };
        let words = |options: ShadingOptions| options.to_words();
        let default = ShadingOptions::default();
        for (stored, name) in RoughnessStored::ALL.iter().zip([
            "STORED_PERCEPTUAL",
            "STORED_ALPHA",
            "STORED_ALPHA_SQUARED",
            "STORED_GLOSS",
            "STORED_SPECULAR_POWER",
        ]) {
            let packing = Packing { roughness_stored: *stored, ..Packing::IDENTITY };
            assert_eq!(packing.to_words()[15], number(name));
        }
        use crate::shading::{BaseFrame, FootprintModel, Form, Masking, Repair};
        for (form, name) in Form::ALL.iter().copied().zip(["FORM_PHYSICAL", "FORM_NORMALISED", "FORM_PAPER"])
        {
            assert_eq!(words(ShadingOptions { form, ..default })[1], number(name));
        }
        for (base_frame, name) in [(BaseFrame::Plane, "BASE_PLANE"), (BaseFrame::Facet, "BASE_FACET")] {
            assert_eq!(words(ShadingOptions { base_frame, ..default })[2], number(name));
        }
        for (repair, name) in [(Repair::Clamp, "REPAIR_CLAMP"), (Repair::Published, "REPAIR_PUBLISHED")] {
            assert_eq!(words(ShadingOptions { repair, ..default })[3], number(name));
        }
        for (base, name) in [(Base::None, "MAPS_WITHOUT_BASE"), (Base::Baked, "MAPS_WITH_BASE")] {
            assert_eq!(Packing { base, ..Packing::IDENTITY }.to_words()[14], number(name));
        }
        for (masking, name) in [(Masking::Base, "MASKING_BASE"), (Masking::Full, "MASKING_FULL")] {
            assert_eq!(words(ShadingOptions { masking, ..default })[4], number(name));
        }
        for (footprint, name) in [
            (FootprintModel::Corrected, "FOOTPRINT_CORRECTED"),
            (FootprintModel::Published, "FOOTPRINT_PUBLISHED"),
        ] {
            assert_eq!(words(ShadingOptions { footprint, ..default })[5], number(name));
        }
        // A caller that leaves all choices zero gets the defaults.
        assert_eq!(words(default)[1..], [0; 7]);
        assert_eq!(f32::from_bits(default.to_words()[0]), default.specular_power);
    }
}
