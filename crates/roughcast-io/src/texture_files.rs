//! The files of a texture: one, or several that belong together.
//!
//! A layout of one part is one file. A layout of several parts has one file per part, `NAME.PART.ext`; if every layer
//! has its own file, that is `NAME.LAYER.ext`; and PNG has one file per level, `NAME.L0.png` and so on.
//! [`TextureFiles`] writes all of them or none; [`read_with_parts`] finds the other files in the folder of the given
//! one.

mod names;
mod read;
mod write;

pub use names::{file_path, leftover_parts, level_path, name_of_layer, name_of_part};
pub use read::{
    ReadFilesError, is_baked, layout_named_in, read_texture_bytes, read_with_parts, with_other_parts,
};
pub use write::{TextureFiles, WriteFilesError, check_destination, is_same_file};
