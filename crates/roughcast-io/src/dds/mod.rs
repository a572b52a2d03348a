//! DDS, the texture container of Direct3D: <https://learn.microsoft.com/windows/win32/direct3ddds/dx-graphics-dds>.
//!
//! Writes, always with the DX10 header: 1, 2 or 4 channels of 8-bit or 16-bit UNORM, half or single float, and BC4,
//! BC5, BC7. Reads as an image: these, and also SNORM, blue-first orders, BC1, BC2, BC3, and Direct3D 9's formats given
//! by masks or numbers. Cube maps, volumes, integers, depth, BC6H, YUV and palettes are refused with advice.

mod format;
mod header;
mod read;
mod write;

pub use read::{read_image, read_textures};
pub use write::write;

const CONTAINER: &str = "DDS";

/// First bytes of every DDS file.
pub(crate) const IDENTIFIER: [u8; 4] = *b"DDS ";

fn malformed(fault: impl Into<String>) -> crate::ReadError {
    crate::ReadError::Malformed { format: CONTAINER, fault: fault.into() }
}

fn unsupported(what: impl Into<String>, remedy: &'static str) -> crate::ReadError {
    crate::ReadError::Unsupported { format: CONTAINER, what: what.into(), remedy }
}
