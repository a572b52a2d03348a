//! The offsets of the library's structs in buffers, for each language.
//!
//! Sources: WGSL, 14.4.1 "Alignment and Size"; OpenGL 4.6, 7.6.2.2 "Standard Uniform Block Layout" (std140, std430);
//! Direct3D, "Packing rules for constant variables". Metal's structs as exported have WGSL's offsets: their
//! three-component members are `packed_float3`.

use naga::{Module, Type, TypeInner, VectorSize};

/// A rule for the offsets of members.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// WGSL, std430 and the exported Metal.
    Natural,
    /// std140: structs begin and end at multiples of 16.
    Std140,
    /// A cbuffer of HLSL: no member crosses a multiple of 16, and structs begin at one.
    Cbuffer,
}

/// A struct's members with their offsets, and its size, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub members: Vec<(String, u32)>,
    pub size: u32,
}

/// The layout of a struct of the library; `None` if there is no struct with that name.
pub fn layout(module: &Module, name: &str, rule: Rule) -> Option<Layout> {
    let (_, found) = module.types.iter().find(|(_, found)| found.name.as_deref() == Some(name))?;
    let TypeInner::Struct { members, .. } = &found.inner else { return None };
    let (mut at, mut largest) = (0, 4);
    let mut places = Vec::new();
    for member in members {
        let (size, align) = size_and_align(module, &module.types[member.ty], rule);
        largest = largest.max(align);
        let straddles = rule == Rule::Cbuffer && at % 16 + size > 16;
        at = at.next_multiple_of(if straddles { 16 } else { align });
        places.push((member.name.clone().unwrap_or_default(), at));
        at += size;
    }
    // A cbuffer's next member may begin directly after the last one.
    let end = match rule {
        Rule::Natural => largest,
        Rule::Std140 => 16,
        Rule::Cbuffer => 4,
    };
    Some(Layout { members: places, size: at.next_multiple_of(end) })
}

fn size_and_align(module: &Module, of: &Type, rule: Rule) -> (u32, u32) {
    match &of.inner {
        TypeInner::Vector { size, .. } => {
            let count = *size as u32;
            let align = if *size == VectorSize::Bi { 8 } else { 16 };
            (4 * count, if rule == Rule::Cbuffer { 4 } else { align })
        }
        TypeInner::Struct { members, .. } => {
            let inner = of.name.as_deref().and_then(|name| layout(module, name, rule));
            let aligns =
                members.iter().map(|member| size_and_align(module, &module.types[member.ty], rule).1);
            let align = match rule {
                Rule::Natural => aligns.max().unwrap_or(4),
                Rule::Std140 | Rule::Cbuffer => 16,
            };
            (inner.map_or(0, |layout| layout.size), align)
        }
        _ => (4, 4),
    }
}

/// The names of all structs, in the library's order.
pub fn structs(module: &Module) -> Vec<String> {
    let is_struct = |of: &Type| matches!(of.inner, TypeInner::Struct { .. });
    module.types.iter().filter(|(_, of)| is_struct(of)).filter_map(|(_, of)| of.name.clone()).collect()
}

/// A line for a header: `Packing takes 48 bytes: slope 0, second 8 ...`.
pub fn in_words(name: &str, layout: &Layout) -> String {
    let members: Vec<_> = layout.members.iter().map(|(member, at)| format!("{member} {at}")).collect();
    format!("{name} takes {} bytes: {}", layout.size, members.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::export::parse;
    use roughcast::wgsl::{MODULES, Role, library};

    fn whole() -> Module {
        let exported = MODULES.iter().filter(|module| !matches!(module.role, Role::Bake | Role::Detail));
        let names: Vec<_> = exported.map(|module| module.name).collect();
        parse(&library(&names).expect("they exist")).expect("valid WGSL").0
    }

    #[test]
    fn natural_offsets_match_naga() {
        let module = whole();
        let names = structs(&module);
        assert!(names.len() > 7, "{names:?}");
        for (_, of) in module.types.iter() {
            let TypeInner::Struct { members, span } = &of.inner else { continue };
            let name = of.name.as_deref().expect("structs have names");
            let found = layout(&module, name, Rule::Natural).expect("it is there");
            assert_eq!(found.size, *span, "{name}");
            for (member, (_, at)) in members.iter().zip(&found.members) {
                assert_eq!(member.offset, *at, "{name}.{:?}", member.name);
            }
        }
    }

    #[test]
    fn uniform_structs_have_the_same_offsets_by_every_rule() {
        let module = whole();
        for name in ["Packing", "ShadingOptions"] {
            let [natural, std140, cbuffer] =
                [Rule::Natural, Rule::Std140, Rule::Cbuffer].map(|rule| layout(&module, name, rule));
            assert_eq!(natural, std140, "{name}");
            assert_eq!(natural, cbuffer, "{name}");
        }
        // Others do not.
        let ratio = |rule| layout(&module, "FootprintRatio", rule).expect("it is there").size;
        assert_eq!([ratio(Rule::Natural), ratio(Rule::Std140), ratio(Rule::Cbuffer)], [32, 48, 48]);
        let gaussian = |rule| layout(&module, "SlopeGaussian", rule).expect("it is there").size;
        assert_eq!([gaussian(Rule::Natural), gaussian(Rule::Std140)], [24, 32]);
    }

    #[test]
    fn the_manual_has_the_same_table() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/shaders.md");
        let manual = std::fs::read_to_string(path).expect("docs/shaders.md is there");
        let module = whole();
        let row = |name: &String| {
            let [natural, std140, cbuffer] = [Rule::Natural, Rule::Std140, Rule::Cbuffer]
                .map(|rule| layout(&module, name, rule).expect("it is there"));
            let cell = |layout: &Layout| {
                let places: Vec<_> = layout.members.iter().map(|(_, at)| at.to_string()).collect();
                format!("{}: {}", layout.size, places.join(", "))
            };
            let members: Vec<_> = natural.members.iter().map(|(member, _)| format!("`{member}`")).collect();
            format!(
                "| `{name}` | {} | {} | {} | {} |",
                members.join(", "),
                cell(&natural),
                cell(&std140),
                cell(&cbuffer)
            )
        };
        let rows: Vec<_> = structs(&module).iter().map(row).collect();
        let missing: Vec<_> = rows.iter().filter(|row| !manual.contains(*row)).cloned().collect();
        assert!(rows.len() > 7 && missing.is_empty(), "docs/shaders.md lacks:\n{}", missing.join("\n"));
    }
}
