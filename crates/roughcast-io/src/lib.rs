//! File input and output for `roughcast`: reads images of ten formats, writes textures with all their levels and reads
//! them back.
//!
//! - [`read_image`] and [`read_image_file`] decode PNG, JPEG, TGA, BMP, WebP, TIFF, Radiance HDR, OpenEXR, KTX2 and DDS
//!   to an [`roughcast::Image`] in the type in which the file stores its samples;
//! - [`ktx2`], [`dds`] and [`exr`] write a [`roughcast::texture::TextureArray`] with its levels, and read back what
//!   they wrote; [`png_levels`] writes one level as a PNG;
//! - [`picture`] writes rendered pictures as PNG, animated PNG and EXR;
//! - [`compress`] makes BC4, BC5 and BC7 blocks, [`decompress`] returns what a graphics processor will see, and
//!   [`stored_of`] also measures what they cost;
//! - [`texture_files`] writes all files of a layout or none, and finds those that belong together; [`Container`] knows
//!   what each format can store;
//! - `mesh`, with the feature of that name (on by default), reads Wavefront OBJ and glTF;
//! - [`AtomicFile`] and [`AtomicSet`] write files atomically.
//!
//! Readers accept any bytes: none panics or allocates more memory than [`Limits`] allow. Errors are one line with the
//! fault and the remedy; the caller adds the path. Values are data: gamma and colour profiles are ignored.
//!
//! Out of scope: the meaning of a layout's texels (see [`roughcast::texture`]), cube maps, volumes, BC6H, ETC2, HDR
//! ASTC, and colour management.
//!
//! # Example
//!
//! ```
//! use roughcast::{Bake, Image, SampleType};
//! use roughcast_io::{Limits, Payload, ReadOptions, Supercompression, ktx2};
//!
//! let map = Image::zeros(16, 16, 3, SampleType::F32);
//! let baked = Bake::of(&map).run()?;
//!
//! let mut file = Vec::new();
//! ktx2::write(Payload::Texels(&baked.arrays[0]), Supercompression::Zstd, &mut file)?;
//!
//! // As roughcast textures, with all levels and their meaning …
//! let textures = ktx2::read_textures(&file, &Limits::default())?;
//! assert_eq!(textures, baked.arrays[0]);
//!
//! // … or as any other picture: level 0 of the first layer.
//! let picture = roughcast_io::read_image(&file, None, &ReadOptions::default())?;
//! assert_eq!((picture.info.container, picture.info.levels), ("KTX2", 5));
//! assert_eq!(picture.info.metadata["roughcast.layout"], "lean");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod atomic;
mod blocks;
mod container;
pub mod dds;
mod error;
pub mod exr;
mod file_info;
pub mod ktx2;
pub mod material_names;
#[cfg(feature = "mesh")]
pub mod mesh;
mod metadata;
mod payload;
pub mod picture;
pub mod png_levels;
mod read;
mod stored;
mod texels;
pub mod texture_files;

pub use atomic::{AtomicFile, AtomicSet};
pub use blocks::{BlockArray, BlockFormat, BlockLayer, FractionDone, compress, compress_watched, decompress};
pub use container::{Container, ContainerError};
pub use error::{ReadError, WriteError};
pub use file_info::{FileInfo, LengthUnit, Limits, NormalEncoding, PixelSize, ReadOptions, ValueRange};
pub use payload::{Payload, Supercompression};
pub use read::{read_image, read_image_file, read_image_of};
pub use stored::{CompressError, CompressionError, Stored, stored_of};

use roughcast::Image;

/// An image as it was read: level 0 of layer 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The pixels.
    pub image: Image,
    /// The information that the file contains about itself.
    pub info: FileInfo,
}
