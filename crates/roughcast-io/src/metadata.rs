//! The text pairs that files store alongside the pixels, limited in number and size.

use std::collections::BTreeMap;

/// Maximum number of pairs kept from one file. A baked texture has about twenty.
const MAX_PAIRS: usize = 256;
/// Longest key kept, in bytes: EXR allows 255, PNG 79.
const MAX_KEY_BYTES: usize = 255;
/// Longest value kept, in bytes. These pairs are not meant for whole XMP packets and thumbnails.
pub(crate) const MAX_VALUE_BYTES: usize = 16 << 10;

/// Adds a pair, unless the limits are reached. A value that is too long is left out, since a truncated one would be
/// wrong. If a key has two values, the first is kept.
pub(crate) fn insert(pairs: &mut BTreeMap<String, String>, key: &str, value: &str) {
    let fits = pairs.len() < MAX_PAIRS && key.len() <= MAX_KEY_BYTES && value.len() <= MAX_VALUE_BYTES;
    if fits && !key.is_empty() {
        pairs.entry(key.to_owned()).or_insert_with(|| value.to_owned());
    }
}

/// Adds a pair whose value is bytes. Text, which may end with NULs, is kept as text; anything else becomes its length
/// in words.
pub(crate) fn insert_bytes(pairs: &mut BTreeMap<String, String>, key: &str, value: &[u8]) {
    let text = std::str::from_utf8(value).ok().map(|text| text.trim_end_matches('\0'));
    match text.filter(|text| !text.contains('\0')) {
        Some(text) => insert(pairs, key, text),
        None => insert(pairs, key, &format!("({} bytes)", value.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_and_size_are_bounded() {
        let mut pairs = BTreeMap::new();
        insert(&mut pairs, "long", &"x".repeat(MAX_VALUE_BYTES + 1));
        insert(&mut pairs, "", "no key");
        assert!(pairs.is_empty());
        insert(&mut pairs, "key", "first");
        insert(&mut pairs, "key", "second");
        assert_eq!(pairs["key"], "first");
        (0..1000).for_each(|i| insert(&mut pairs, &format!("key {i}"), ""));
        assert_eq!(pairs.len(), MAX_PAIRS);
    }

    #[test]
    fn bytes_are_text_or_named_by_their_length() {
        let mut pairs = BTreeMap::new();
        insert_bytes(&mut pairs, "text", b"rd\0");
        insert_bytes(&mut pairs, "binary", &[0, 1, 0, 255]);
        insert_bytes(&mut pairs, "two texts", b"a\0b\0");
        assert_eq!([&pairs["text"], &pairs["binary"], &pairs["two texts"]], ["rd", "(4 bytes)", "(4 bytes)"]);
    }
}
