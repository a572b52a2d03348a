//! Restores names to their original spelling: naga numbers every local name that another function has already used, and
//! appends an underscore to names that end in a digit.

use std::collections::{HashMap, HashSet};

/// Restores the local names of each function in generated code, wherever that is unambiguous.
///
/// A function ends with a line that closes its brace in the first column. A name is restored unless the function uses
/// the original for something else, the code calls or defines something with that name, or naga has renamed it because
/// it is a reserved word.
pub fn with_plain_names(code: &str) -> String {
    let mut reserved = HashSet::new();
    for token in tokens(code) {
        if token.called {
            reserved.insert(token.text);
        }
        if let Some(word) = token.text.strip_suffix('_')
            && !word.ends_with(|c: char| c.is_ascii_digit())
        {
            reserved.insert(word);
        }
    }
    let mut plain = String::with_capacity(code.len());
    for function in code.split_inclusive("\n}") {
        rename(function, &reserved, &mut plain);
    }
    plain
}

/// Writes one function with its original names.
fn rename(function: &str, reserved: &HashSet<&str>, out: &mut String) {
    let all = tokens(function);
    let mut used: HashSet<&str> = all.iter().filter(|token| !token.member).map(|token| token.text).collect();
    let mut names = HashMap::new();
    for token in all.iter().filter(|token| !token.member && !token.called) {
        if let Some(name) = without_number(token.text)
            && !names.contains_key(token.text)
            && !reserved.contains(name)
            && used.insert(name)
        {
            names.insert(token.text, name);
        }
    }
    let mut at = 0;
    for token in all.iter().filter(|token| !token.member) {
        if let Some(name) = names.get(token.text) {
            out.push_str(&function[at..token.start]);
            out.push_str(name);
            at = token.start + token.text.len();
        }
    }
    out.push_str(&function[at..]);
}

/// The name without naga's suffix: `view` of `view_3`, `lean1` of `lean1_` and `lean1_2`.
fn without_number(name: &str) -> Option<&str> {
    let (base, number) = name.rsplit_once('_')?;
    let ends_in_digit = base.ends_with(|c: char| c.is_ascii_digit());
    let numbered = number.chars().all(|c| c.is_ascii_digit()) && (ends_in_digit || !number.is_empty());
    (numbered && !base.is_empty()).then_some(base)
}

/// An identifier of the code.
struct Token<'a> {
    text: &'a str,
    start: usize,
    /// Whether it follows a dot or a double colon: a member, or a name in another namespace.
    member: bool,
    /// Whether a bracket follows: a function or a type.
    called: bool,
}

fn tokens(code: &str) -> Vec<Token<'_>> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(offset) = code[at..].find(is_part) {
        let start = at + offset;
        let length = code[start..].find(|c| !is_part(c)).unwrap_or(code.len() - start);
        at = start + length;
        let text = &code[start..at];
        // The parts of a number such as 1e-7 are not identifiers, or not renamed ones.
        if !text.starts_with(|c: char| c.is_ascii_digit()) {
            let before = &code[..start];
            found.push(Token {
                text,
                start,
                member: before.ends_with('.') || before.ends_with("::"),
                called: code[at..].starts_with('('),
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_where_the_name_is_free() {
        let code = "float f(float view) {\n    return view;\n}\n\nfloat g(float view_1, float lean1_) {\n    return view_1 + lean1_.x;\n}\n";
        let plain = "float f(float view) {\n    return view;\n}\n\nfloat g(float view, float lean1) {\n    return view + lean1.x;\n}\n";
        assert_eq!(with_plain_names(code), plain);
    }

    #[test]
    fn numbers_stay_where_the_name_is_taken() {
        for code in [
            // By another name of the same function.
            "float g(float view, float view_1) {\n    return view + view_1;\n}\n",
            // By a function.
            "float view() {\n    return 1.0;\n}\n\nfloat g(float view_1) {\n    return view_1;\n}\n",
            // By the language.
            "float f(float half_) {\n    return half_;\n}\n\nfloat g(float half_1) {\n    return half_1;\n}\n",
        ] {
            assert_eq!(with_plain_names(code), code);
        }
    }

    #[test]
    fn the_first_of_two_numbered_names_gets_the_plain_one() {
        let code = "float g(float h_1) {\n    float h_2 = h_1.h_2;\n    return h_2;\n}\n";
        let plain = "float g(float h) {\n    float h_2 = h.h_2;\n    return h_2;\n}\n";
        assert_eq!(with_plain_names(code), plain);
    }

    #[test]
    fn members_and_temporaries_are_left_alone() {
        let code = "float g(float x) {\n    const float _e2 = metal::fast_1(x).s_1;\n    return _e2;\n}\n";
        assert_eq!(with_plain_names(code), code);
    }
}
