//! Makes exports safe to paste together: splits the generated code into its items and regroups them by module, so that
//! two exports can share a file and no constant is unused.
//!
//! In GLSL, HLSL and Metal's language each module has a guard. A constant that an export does not use is omitted from
//! it, so each constant has its own guard; constants for the caller are always included.

use std::collections::BTreeSet;

use roughcast::wgsl::Module;

use super::prefix::{CONSTRUCT, Prefix, global_names, is_constant};

/// The modules whose constants are for the caller: the choices of `ShadingOptions`, of `Packing` and of `Noise`.
const FOR_CALLERS: &[&str] = &["options", "packing", "noise-options"];

/// How the names of functions begin that naga adds, such as conversions of floats to integers that never overflow.
const NAGAS_HELPER: &str = "naga_";

/// A constant, struct or function of the generated code.
struct Item<'a> {
    name: &'a str,
    text: &'a str,
}

/// Generated code by module, each with its guard, and with a prefix on every name.
///
/// # Errors
/// A line about code that belongs to no module.
pub fn with_guards(code: &str, modules: &[&Module], prefix: &Prefix) -> Result<String, String> {
    let (prelude, items) = items(code);
    let (helpers, items): (Vec<_>, Vec<_>) =
        items.into_iter().partition(|item| item.name.starts_with(NAGAS_HELPER));
    let names = global_names();
    let module_of = |item: &Item<'_>| {
        let name = item.name.strip_prefix(CONSTRUCT).unwrap_or(item.name);
        names.get(name).copied().ok_or_else(|| format!("'{}' belongs to no module", item.name))
    };
    let owners = items.iter().map(module_of).collect::<Result<Vec<_>, _>>()?;
    let mut out = prelude;
    let helper_names: BTreeSet<&str> = helpers.iter().map(|helper| helper.name).collect();
    for name in helper_names {
        let overloads: Vec<_> = helpers.iter().filter(|helper| helper.name == name).collect();
        guarded(&prefix.module_guard(name), &overloads, prefix, &mut out);
    }
    for module in modules {
        let own =
            || items.iter().zip(&owners).filter(|(_, owner)| **owner == module.name).map(|(item, _)| item);
        let (constants, rest): (Vec<_>, Vec<_>) = own().partition(|item| is_constant(item.name));
        if FOR_CALLERS.contains(&module.name) {
            guarded(&prefix.constant_guard(module.name), &constants, prefix, &mut out);
        } else {
            for constant in constants.into_iter().filter(|item| is_used(item, &items)) {
                guarded(&prefix.constant_guard(constant.name), &[constant], prefix, &mut out);
            }
        }
        if !rest.is_empty() {
            guarded(&prefix.module_guard(module.name), &rest, prefix, &mut out);
        }
    }
    Ok(out)
}

fn guarded(macro_name: &str, items: &[&Item<'_>], prefix: &Prefix, out: &mut String) {
    *out += &format!("#ifndef {macro_name}\n#define {macro_name}\n");
    for (place, item) in items.iter().enumerate() {
        // Constants are adjacent; other items are separated by blank lines.
        if place > 0 && !(is_constant(item.name) && is_constant(items[place - 1].name)) {
            out.push('\n');
        }
        *out += prefix.apply(item.text.trim_matches('\n')).as_str();
        out.push('\n');
    }
    *out += "#endif\n\n";
}

/// Whether another item uses the name.
fn is_used(constant: &Item<'_>, items: &[Item<'_>]) -> bool {
    items.iter().any(|item| item.name != constant.name && has_word(item.text, constant.name))
}

fn has_word(code: &str, word: &str) -> bool {
    code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).any(|part| part == word)
}

/// The lines before the first item, such as includes, and the items in order.
fn items(code: &str) -> (String, Vec<Item<'_>>) {
    let (mut prelude, mut items) = (String::new(), Vec::new());
    let mut start = None;
    let mut at = 0;
    for line in code.split_inclusive('\n') {
        let end = at + line.len();
        let text = line.trim_end();
        match start {
            None if text.is_empty() => {}
            None if text.starts_with(['#', '/']) || text.starts_with("using ") => prelude += line,
            None if text.ends_with(';') && !text.starts_with('}') => items.push(item(&code[at..end])),
            None => start = Some(at),
            // Items end with a brace in the first column.
            Some(begin) if text == "}" || text == "};" => {
                items.push(item(&code[begin..end]));
                start = None;
            }
            Some(_) => {}
        }
        at = end;
    }
    if !prelude.is_empty() {
        prelude.push('\n');
    }
    (prelude, items)
}

/// The name of an item: the word before `=`, `{` or `(`.
fn item(text: &str) -> Item<'_> {
    let end = text.find(['=', '{', '(']).unwrap_or(text.len());
    let name = text[..end].split_whitespace().next_back().unwrap_or_default();
    Item { name, text }
}

/// The original WGSL, with prefixes and without unused constants. WGSL has no guards.
pub fn written(modules: &[&Module], prefix: &Prefix) -> String {
    let whole: String = modules.iter().map(|module| module.source).collect::<Vec<_>>().join("\n");
    let uses = |name: &str| {
        let code = whole.lines().filter(|line| !line.trim_start().starts_with("//"));
        code.filter(|line| has_word(line.split("//").next().unwrap_or_default(), name)).count() > 1
    };
    let mut sources = Vec::new();
    for module in modules {
        let always = FOR_CALLERS.contains(&module.name);
        let is_idle = |line: &str| {
            let name = line.strip_prefix("const ").and_then(|rest| rest.split(':').next());
            !always && name.is_some_and(|name| !uses(name))
        };
        let paragraphs = module.source.split("\n\n").filter_map(|paragraph| {
            let kept: Vec<&str> = paragraph.lines().filter(|line| !is_idle(line)).collect();
            let only_comments = kept.iter().all(|line| line.starts_with("//"));
            // A comment belongs to the constant that it describes.
            let had_code = paragraph.lines().any(|line| !line.starts_with("//"));
            (!(only_comments && had_code)).then(|| kept.join("\n"))
        });
        sources.push(paragraphs.collect::<Vec<_>>().join("\n\n"));
    }
    prefix.apply(&sources.join("\n\n"))
}
