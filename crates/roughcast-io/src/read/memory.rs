//! Checks sizes against the limits, and allocates buffers with an error instead of an abort.

use std::fmt::Display;

use crate::{Limits, ReadError};

/// Largest ratio of raw to compressed bytes that deflate can reach: 258 bytes by two codes of one bit each.
/// (<https://zlib.net/zlib_tech.html>, "maximum compression factor")
pub(super) const DEFLATE_MAX_RATIO: u64 = 1032;

/// Checks the width and height of an image against zero and the limit.
///
/// # Errors
/// [`ReadError::Malformed`] if a side is zero, [`ReadError::TooLarge`] if the pixels exceed the limit.
pub(crate) fn check_size(
    format: &'static str,
    width: u64,
    height: u64,
    limits: &Limits,
) -> Result<(usize, usize), ReadError> {
    if width == 0 || height == 0 {
        return Err(malformed(format, format_args!("it states {width}x{height} pixels")));
    }
    let too_large = ReadError::TooLarge { width, height, max_pixels: limits.max_pixels };
    if width.checked_mul(height).is_none_or(|pixels| pixels > limits.max_pixels) {
        return Err(too_large);
    }
    match (usize::try_from(width), usize::try_from(height)) {
        (Ok(width), Ok(height)) => Ok((width, height)),
        _ => Err(too_large),
    }
}

/// Allocates `len` zeros. Unlike `vec!` it returns an error if memory runs out.
pub(super) fn zeros<T: bytemuck::Zeroable>(len: usize) -> Result<Vec<T>, ReadError> {
    bytemuck::allocation::try_zeroed_vec(len).map_err(|()| {
        let message = format!("not enough memory for {len} samples");
        ReadError::Io(std::io::Error::new(std::io::ErrorKind::OutOfMemory, message))
    })
}

/// [`ReadError::Malformed`], with a decoder's message shortened to one line of bounded length.
pub(super) fn malformed(format: &'static str, fault: impl Display) -> ReadError {
    ReadError::Malformed { format, fault: one_line(&fault.to_string()) }
}

/// [`ReadError::Unsupported`], with a decoder's message shortened to one line of bounded length.
pub(super) fn unsupported(format: &'static str, what: impl Display, remedy: &'static str) -> ReadError {
    ReadError::Unsupported { format, what: one_line(&what.to_string()), remedy }
}

/// A decoder's message may quote the file, so it may contain line breaks and be of any length.
fn one_line(text: &str) -> String {
    const MAX_CHARS: usize = 200;
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|w| !w.is_empty()).collect();
    words.join(" ").chars().take(MAX_CHARS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_itself_is_allowed_and_one_more_pixel_is_not() {
        let limits = Limits::of_pixels(12);
        assert_eq!(check_size("PNG", 4, 3, &limits).unwrap(), (4, 3));
        assert!(matches!(check_size("PNG", 13, 1, &limits), Err(ReadError::TooLarge { .. })));
        assert!(matches!(check_size("PNG", u64::MAX, 2, &limits), Err(ReadError::TooLarge { .. })));
        assert!(matches!(check_size("PNG", 0, 7, &limits), Err(ReadError::Malformed { .. })));
    }

    #[test]
    fn running_out_of_memory_is_an_error() {
        assert!(matches!(zeros::<u64>(usize::MAX / 16), Err(ReadError::Io(_))));
    }

    #[test]
    fn errors_are_one_short_line() {
        let error = malformed("PNG", format_args!("a\nb\t{}", "c".repeat(1000))).to_string();
        assert!(error.starts_with("PNG: broken file: a b ccc"), "{error}");
        assert!(!error.contains('\n') && error.len() < 300, "{error}");
    }
}
