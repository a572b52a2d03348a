//! KTX2, the Khronos texture container: <https://registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html>.
//!
//! Writes 1, 2 or 4 channels of 8-bit or 16-bit UNORM, half or single float, and BC4, BC5, BC7; plain or with
//! Zstandard. Reads as an image: these, and also 3 channels, SNORM, blue-first orders, BC1, BC2, BC3, and Basis
//! Universal (ETC1S, UASTC) and ASTC, see `basis.rs`. Cube maps, volumes, integers, depth, BC6H, ETC2 and PVRTC are
//! refused with advice.
//!
//! The `ktx2` crate is only used as an independent reader in the tests: its parser panics on a data format descriptor
//! whose block dimension is 255 (0.5.0), and a reader of untrusted files must not panic.

mod basis;
mod format;
mod header;
mod read;
mod write;

pub use read::{read_image, read_textures};
pub use write::write;

const CONTAINER: &str = "KTX2";

/// First bytes of every KTX2 file.
pub(crate) const IDENTIFIER: [u8; 12] = *b"\xABKTX 20\xBB\r\n\x1A\n";

/// First bytes of every KTX1 file, which is another format.
pub(crate) const IDENTIFIER_OF_KTX1: [u8; 12] = *b"\xABKTX 11\xBB\r\n\x1A\n";

fn malformed(fault: impl Into<String>) -> crate::ReadError {
    crate::ReadError::Malformed { format: CONTAINER, fault: fault.into() }
}

fn unsupported(what: impl Into<String>, remedy: &'static str) -> crate::ReadError {
    crate::ReadError::Unsupported { format: CONTAINER, what: what.into(), remedy }
}
