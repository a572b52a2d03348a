//! Bounds on what is kept of a foreign file's metadata.

use std::collections::BTreeMap;

/// More pairs than any tool writes; a file may claim millions.
const MAX_PAIRS: usize = 256;
/// Longer values are named by their length instead.
const MAX_VALUE_BYTES: usize = 4096;

/// Adds a pair, unless there are too many already. Values that are no text, or too long, are named by their length.
pub(crate) fn keep(pairs: &mut BTreeMap<String, String>, key: &str, value: &[u8]) {
    if pairs.len() >= MAX_PAIRS && !pairs.contains_key(key) {
        return;
    }
    let text = std::str::from_utf8(value).ok().filter(|text| text.len() <= MAX_VALUE_BYTES);
    let readable = text.map(|text| text.trim_end_matches('\0')).filter(|text| !text.contains('\0'));
    let value = readable.map_or_else(|| format!("({} bytes)", value.len()), str::to_owned);
    pairs.insert(key.to_owned(), value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_kept_and_the_rest_is_named_by_its_length() {
        let mut pairs = BTreeMap::new();
        keep(&mut pairs, "text", b"rd\0");
        keep(&mut pairs, "binary", &[0, 1, 0, 255]);
        keep(&mut pairs, "long", &[b'x'; MAX_VALUE_BYTES + 1]);
        assert_eq!(pairs["text"], "rd");
        assert_eq!(pairs["binary"], "(4 bytes)");
        assert_eq!(pairs["long"], "(4097 bytes)");
    }

    #[test]
    fn there_is_an_end_to_it() {
        let mut pairs = BTreeMap::new();
        for index in 0..1000 {
            keep(&mut pairs, &index.to_string(), b"x");
        }
        assert_eq!(pairs.len(), MAX_PAIRS);
    }
}
