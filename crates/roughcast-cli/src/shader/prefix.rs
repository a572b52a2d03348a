//! The prefix that distinguishes an export's names from those of the shader that includes it.

use std::collections::HashMap;
use std::str::FromStr;
use std::sync::LazyLock;

use roughcast::wgsl::{MODULES, Role, map_words};

/// The prefix of functions and structs; constants have it in capitals.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

impl FromStr for Prefix {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_word = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_word || text.starts_with(|c: char| c.is_ascii_digit()) {
            return Err("names consist of letters, digits and _, and start with no digit".to_owned());
        }
        if text.starts_with("gl_") || text.starts_with('_') || text.contains("__") {
            return Err(
                "GLSL keeps names that start with gl_ or contain __, and other languages those that start with _"
                    .to_owned(),
            );
        }
        Ok(Self(text.to_owned()))
    }
}

impl Prefix {
    /// A global name of the library with its prefix.
    pub fn of(&self, name: &str) -> String {
        if is_constant(name) {
            format!("{}{name}", self.0.to_ascii_uppercase())
        } else {
            format!("{}{name}", self.0)
        }
    }

    /// The macro that marks a module as defined. It keeps the case of the prefix: `rc_` and `RC_` differ.
    pub fn module_guard(&self, module: &str) -> String {
        format!("{}{}_MODULE", self.0, module.replace('-', "_").to_ascii_uppercase())
    }

    /// The macro that marks constants as defined; their names have the prefix in capitals.
    pub fn constant_guard(&self, name: &str) -> String {
        format!("{}{}_CONSTANT", self.0, name.replace('-', "_")).to_ascii_uppercase()
    }

    /// Prefixes every global name of the library in the code, including names changed by naga. Members of structs keep
    /// their names.
    pub fn apply(&self, code: &str) -> String {
        if self.0.is_empty() {
            return code.to_owned();
        }
        let names = global_names();
        map_words(code, |word, before| {
            let known = names.contains_key(word)
                || word.strip_prefix(CONSTRUCT).is_some_and(|of| names.contains_key(of));
            // A word after a single dot is a member; text after `1.` is not a word.
            (known && !before.ends_with('.')).then(|| self.of(word))
        })
    }
}

/// The prefix of naga's constructor functions in HLSL.
pub const CONSTRUCT: &str = "Construct";

/// Constants are in capitals.
pub fn is_constant(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
}

/// The module of every constant, struct and function of the library.
pub fn global_names() -> &'static HashMap<&'static str, &'static str> {
    static NAMES: LazyLock<HashMap<&str, &str>> = LazyLock::new(read_global_names);
    &NAMES
}

fn read_global_names() -> HashMap<&'static str, &'static str> {
    let mut names = HashMap::new();
    // The modules for baking are not exported, and have names of their own.
    for module in MODULES.iter().filter(|module| module.role != Role::Bake) {
        for line in module.source.lines() {
            let name = ["const ", "struct ", "fn "].iter().find_map(|keyword| line.strip_prefix(keyword));
            if let Some(name) = name.and_then(|rest| rest.split([':', ' ', '(']).next()) {
                names.insert(name, module.name);
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prefix(text: &str) -> Prefix {
        text.parse().expect("a prefix")
    }

    #[test]
    fn names_get_it_and_members_do_not() {
        let code = "float x = mixture_lobe(surface.variance, TWO_PI) * view.mixture_lobe; BumpFacet f = ConstructBumpFacet(n, 1.);";
        let expected = "float x = rc_mixture_lobe(surface.variance, RC_TWO_PI) * view.mixture_lobe; rc_BumpFacet f = \
                        rc_ConstructBumpFacet(n, 1.);";
        assert_eq!(prefix("rc_").apply(code), expected);
        assert_eq!(prefix("").apply(code), code);
    }

    #[test]
    fn invalid_prefixes_are_refused() {
        for wrong in ["1a", "a-b", "a b", "gl_", "__x", "_x", "a__", "ä"] {
            assert!(Prefix::from_str(wrong).is_err(), "{wrong}");
        }
        for right in ["", "rc_", "Roughcast", "r2_"] {
            assert!(Prefix::from_str(right).is_ok(), "{right}");
        }
    }

    #[test]
    fn every_module_is_found_by_its_names() {
        let names = global_names();
        for module in MODULES.iter().filter(|module| !matches!(module.role, Role::Bake | Role::Detail)) {
            assert!(names.values().any(|of| *of == module.name), "{}", module.name);
        }
        assert_eq!(names["lean_moments"], "lean");
        assert_eq!(names["SlopeGaussian"], "gaussian");
        assert_eq!(names["TWO_PI"], "vector");
    }
}
