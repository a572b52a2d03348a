//! Reads image files: identifies the format and picks the reader.
//!
//! The first bytes of a file identify its format, whatever its name; only TGA, which need not have a signature, is
//! identified by its extension.

mod bmp_webp_tga;
mod choice;
mod exr;
mod hdr;
mod jpeg;
mod memory;
mod png;
mod tiff;

use std::path::Path;

pub(crate) use memory::check_size;

use crate::{Decoded, ReadError, ReadOptions};

/// The supported file formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Png,
    Jpeg,
    Tga,
    Bmp,
    WebP,
    Tiff,
    Hdr,
    Exr,
    Ktx2,
    Dds,
}

/// Reads level 0 of layer 0 of an image file held in memory.
///
/// Samples keep their precision: 8-bit files give [`roughcast::Samples::U8`] (fewer bits are widened to the full
/// range), 16-bit ones `U16`, half floats `F16`, floats and doubles `F32`. Grey stays one channel, named `Y`; colour
/// profiles and gamma are ignored, since these files hold data, not colours.
///
/// An EXR may contain many layers and channels: [`ReadOptions::layer`] and [`ReadOptions::channels`] select from them.
/// A TIFF may contain many images: [`ReadOptions::layer`] selects one by number. The other formats have no layers;
/// channels are chosen by their names in [`crate::FileInfo::channels`].
///
/// `extension`, in lower case and without the dot, matters only for TGA files without a footer: all other formats are
/// identified by their first bytes.
///
/// # Errors
/// [`ReadError`]: an unknown format, an unsupported variant, damaged bytes, or more pixels than `limits` allow. No
/// input makes it panic, and nothing is allocated before its size has been checked against the limits.
pub fn read_image(
    bytes: &[u8],
    extension: Option<&str>,
    options: &ReadOptions,
) -> Result<Decoded, ReadError> {
    let limits = &options.limits;
    let decoded = match format_of(bytes, extension)? {
        Format::Png => png::read(bytes, limits),
        Format::Jpeg => jpeg::read(bytes, limits),
        Format::Tga => bmp_webp_tga::read_tga(bytes, limits),
        Format::Bmp => bmp_webp_tga::read_bmp(bytes, limits),
        Format::WebP => bmp_webp_tga::read_webp(bytes, limits),
        Format::Tiff => return tiff::read(bytes, options),
        Format::Hdr => hdr::read(bytes, limits),
        Format::Exr => return exr::read(bytes, options),
        Format::Ktx2 => crate::ktx2::read_image(bytes, limits),
        Format::Dds => crate::dds::read_image(bytes, limits),
    }?;
    choice::chosen(decoded, options)
}

/// Reads level 0 of layer 0 of an image file, by [`read_image`].
///
/// # Errors
/// [`ReadError::Io`] if the file cannot be read, and all errors of [`read_image`].
pub fn read_image_file(path: &Path, options: &ReadOptions) -> Result<Decoded, ReadError> {
    read_image_of(path, &std::fs::read(path)?, options)
}

/// Reads level 0 of layer 0 of an image file with these bytes, by [`read_image`]. Only the extension of the path is
/// used, and only if the bytes do not identify the format.
///
/// # Errors
/// As [`read_image`].
pub fn read_image_of(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Decoded, ReadError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    read_image(bytes, extension.as_deref(), options)
}

/// Identifies the format by the first bytes, or TGA by the last bytes or the extension.
fn format_of(bytes: &[u8], extension: Option<&str>) -> Result<Format, ReadError> {
    const SIGNATURES: [(&[u8], Format); 13] = [
        (b"\x89PNG\r\n\x1a\n", Format::Png),
        (b"\xff\xd8\xff", Format::Jpeg),
        (b"BM", Format::Bmp),
        (b"II\x2a\0", Format::Tiff),
        (b"MM\0\x2a", Format::Tiff),
        // BigTIFF: offsets of 64 bits.
        (b"II\x2b\0", Format::Tiff),
        (b"MM\0\x2b", Format::Tiff),
        (b"#?RADIANCE", Format::Hdr),
        (b"#?RGBE", Format::Hdr),
        (b"\x76\x2f\x31\x01", Format::Exr),
        // Also version 1: the KTX2 reader refuses it with advice.
        (b"\xabKTX ", Format::Ktx2),
        (b"DDS ", Format::Dds),
        // A file truncated by a failed upload is recognised here, so that it is reported as a broken PNG.
        (b"\x89PNG", Format::Png),
    ];
    const TGA_FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";

    if bytes.is_empty() {
        return Err(ReadError::Empty);
    }
    // A TGA may also begin with the two letters of a BMP; then the extension or the footer decides.
    let is_tga = extension == Some("tga") || bytes.ends_with(TGA_FOOTER);
    let by_signature = SIGNATURES.iter().find(|(signature, _)| bytes.starts_with(signature));
    match by_signature {
        Some((_, Format::Bmp)) if is_tga => Ok(Format::Tga),
        Some(&(_, format)) => Ok(format),
        None if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") => Ok(Format::WebP),
        None if is_tga => Ok(Format::Tga),
        None => Err(ReadError::UnknownFormat),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_wins_over_the_extension() {
        let png = b"\x89PNG\r\n\x1a\n....";
        assert_eq!(format_of(png, Some("jpg")).unwrap(), Format::Png);
        assert_eq!(format_of(png, Some("tga")).unwrap(), Format::Png);
        assert_eq!(format_of(png, None).unwrap(), Format::Png);
    }

    #[test]
    fn tga_is_known_by_extension_or_footer_only() {
        let header = [0; 18];
        assert!(matches!(format_of(&header, None), Err(ReadError::UnknownFormat)));
        assert!(matches!(format_of(&header, Some("png")), Err(ReadError::UnknownFormat)));
        assert_eq!(format_of(&header, Some("tga")).unwrap(), Format::Tga);
        let with_footer = [&header[..], b"TRUEVISION-XFILE.\0"].concat();
        assert_eq!(format_of(&with_footer, None).unwrap(), Format::Tga);
    }

    #[test]
    fn a_tga_whose_first_bytes_spell_bm_stays_a_tga() {
        assert_eq!(format_of(b"BM................", Some("tga")).unwrap(), Format::Tga);
        assert_eq!(format_of(b"BM................", Some("bmp")).unwrap(), Format::Bmp);
    }

    #[test]
    fn an_empty_file_is_reported_as_empty() {
        let error = format_of(b"", Some("png")).unwrap_err();
        assert_eq!(error.to_string(), "the file is empty");
    }
}
