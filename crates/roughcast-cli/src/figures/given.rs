//! The mesh and the height map that the arguments give to figures.

use anyhow::{Context, Result};
use roughcast::{Gradient, HeightSense, Image, Kind, SourceOptions};
use roughcast_pipeline::{MapOptions, read_map};
use roughcast_scene::Mesh;
use roughcast_scene::pattern::Pattern;

use super::Args;
use crate::scene_args::mesh_of;
use crate::usage;

/// A height map with its name for the report.
pub struct Heights {
    pub image: Image,
    pub source: SourceOptions,
    pub name: String,
}

/// The mesh of the arguments with its name, if they have one.
pub fn mesh(args: &Args) -> Result<Option<(Mesh, String)>> {
    let Some(path) = &args.mesh else { return Ok(None) };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Some((mesh_of(path, args.normals)?, name)))
}

/// The mesh of the arguments, for figures that put a map on it.
pub fn textured_mesh(args: &Args) -> Result<Option<(Mesh, String)>> {
    let given = mesh(args)?;
    match (&given, &args.mesh) {
        (Some((mesh, _)), Some(path)) if !mesh.has_texture_coordinates() => Err(usage(
            path,
            "this figure needs a mesh with texture coordinates: give another, or name other figures",
        )),
        _ => Ok(given),
    }
}

/// The height map of the arguments, or this pattern.
pub fn heights_or(args: &Args, pattern: impl FnOnce() -> (Pattern, String)) -> Result<Heights> {
    let (image, source, name) = match &args.height_map {
        Some(path) => {
            let mut options = MapOptions::default();
            options.kind = Some(Kind::Height);
            if args.invert_height {
                options.height_sense = HeightSense::WhiteDeep;
            }
            let map = read_map(path, &options).with_context(|| path.display().to_string())?;
            (map.image, map.options, path.file_name().unwrap_or_default().to_string_lossy().into_owned())
        }
        None => {
            let (pattern, name) = pattern();
            let source = pattern.source_options();
            (pattern.heights, source, name)
        }
    };
    // Central differences are the slopes of the heights themselves: Sobel smooths across.
    Ok(Heights { image, source: source.with_gradient(Gradient::Central), name })
}
