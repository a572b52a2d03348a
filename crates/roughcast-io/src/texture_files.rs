//! The files of a texture: one, or several that belong together.
//!
//! A layout of one part is one file. A layout of several parts is a file for each, `NAME.PART.ext`; if every layer has a file of its
//! own, that is `NAME.LAYER.ext`; and PNG has a file for each level, `NAME.L0.png` and so on. [`TextureFiles`] writes all of
//! them or none; [`read_with_parts`] finds the others beside the one that was named.

mod names;
mod read;
mod write;

pub use names::{file_path, leftover_parts, level_path, name_of_layer, name_of_part};
pub use read::{
    ReadFilesError, is_baked, layout_named_in, read_texture_bytes, read_with_parts, with_other_parts,
};
pub use write::{TextureFiles, WriteFilesError, check_destination, is_same_file};
