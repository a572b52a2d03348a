//! Locations of a glTF file's buffers: `data:` URIs (RFC 2397) and relative paths (RFC 3986).

use std::path::{Component, Path, PathBuf};

/// The bytes of a base64 `data:` URI; `None` for any other URI, an error if it is broken.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = uri.strip_prefix("data:")?;
    Some(match rest.split_once(";base64,") {
        Some((_, encoded)) => base64(encoded).ok_or_else(|| "a data URI is not base64".to_owned()),
        None => Err("a data URI is not base64".to_owned()),
    })
}

/// Decodes base64 (RFC 4648), with or without padding.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    if text.len() % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for &c in group {
            bits = bits << 6 | u32::from(sextet(c)?);
        }
        // A group of n characters contains n - 1 bytes, in its upper bits.
        let aligned = bits << (6 * (4 - group.len()));
        bytes.extend_from_slice(&aligned.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn sextet(c: u8) -> Option<u8> {
    Some(match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    })
}

/// The path of a relative URI that stays within the folder of the referencing file; `None` for any other.
pub(super) fn relative_path(uri: &str) -> Option<PathBuf> {
    let decoded = percent_decoded(uri)?;
    let path = Path::new(&decoded);
    let inside = path.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    // A scheme such as http: or C: is not a relative reference.
    let scheme = uri.split('/').next().is_some_and(|first| first.contains(':'));
    (inside && !scheme && !decoded.is_empty() && !decoded.contains('\0')).then(|| path.to_owned())
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(b) = rest.next() {
        if b == b'%' {
            let mut digit = || rest.next().and_then(|c| char::from(c).to_digit(16));
            bytes.push((digit()? << 4 | digit()?) as u8);
        } else {
            bytes.push(b);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_decoded() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg", "foob"),
            ("Zm9vYmFy", "foobar"),
        ] {
            assert_eq!(base64(text).unwrap(), bytes.as_bytes());
        }
        for broken in ["Z", "Zm9vY", "Zm9*", "Zm 9"] {
            assert_eq!(base64(broken), None, "{broken}");
        }
        assert_eq!(data_uri("data:application/octet-stream;base64,AAEC"), Some(Ok(vec![0, 1, 2])));
        assert!(data_uri("data:text/plain,hello").unwrap().is_err());
        assert_eq!(data_uri("buffer.bin"), None);
    }

    #[test]
    fn paths_stay_in_the_folder() {
        assert_eq!(relative_path("a%20b/c.bin"), Some(PathBuf::from("a b/c.bin")));
        for uri in
            ["../x.bin", "/etc/x", "a/../../x", "http://a/x.bin", "file:x", "%2e%2e/x", "x%", "x%00", ""]
        {
            assert_eq!(relative_path(uri), None, "{uri}");
        }
    }
}
