//! `NAME.json`: what a shader needs to know of baked files, for loaders that drop the metadata of the files themselves.

use std::path::PathBuf;

use roughcast::texture::{Packing, TextureInfo, layers_of};
use roughcast::{SampleType, level_sizes};
use serde_json::{Value, json};

use crate::output::Stored;

/// What was written. `files` are the paths of all files, in the order of `stored`, of PNG all levels one after the other.
pub fn sidecar(stored: &[Stored], files: &[PathBuf]) -> Value {
    let first = &stored[0];
    let info = first.info();
    let pairs = info.to_pairs();
    let (width, height) = first.size();
    let levels = level_sizes(width, height).len();
    // One file for each of what is stored, or one for each level of it.
    let files_each = if files.len() == stored.len() { 1 } else { levels };
    let described = stored.iter().zip(files.chunks(files_each));
    let sample_type = first.sample_type();
    json!({
        "roughcast": env!("CARGO_PKG_VERSION"),
        "layout": info.layout.name(),
        "bits": sample_type.name(),
        "width": width,
        "height": height,
        "levels": levels,
        "scale": info.scale,
        "variance_scale": info.variance_scale,
        "base": info.base.name(),
        "base_variance": info.base_variance,
        "specular_power": info.specular_power(),
        "brdf": info.brdf.name(),
        "roughness_stored": info.roughness_stored.name(),
        "wrap": info.wrap.name(),
        "normal_range": info.normal_range.name(),
        "set": pairs.get("roughcast.set"),
        "packing": packing(info, sample_type),
        "files": described.map(|(part, files)| file(part, files)).collect::<Vec<_>>(),
        "conventions": pairs.get("roughcast.conventions"),
    })
}

/// The members of the exported shaders' `Packing`: `value = stored * pair[0] + pair[1]`, with stored as a sampler returns it, and two
/// numbers of choices.
fn packing(info: &TextureInfo, sample_type: SampleType) -> Value {
    let packing = Packing::new(info, sample_type);
    json!({
        "slope": packing.slope,
        "second": packing.second,
        "mixed": packing.mixed,
        "trace": packing.trace,
        "spread": packing.spread,
        "signed_spread": packing.signed_spread,
        "unit": packing.unit,
        "base": packing.base as u32,
        "roughness_stored": packing.roughness_stored as u32,
    })
}

fn file(stored: &Stored, files: &[PathBuf]) -> Value {
    let names: Vec<_> = files
        .iter()
        .map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    let info = stored.info();
    let layers: Vec<_> = layers_of(info)
        .iter()
        .map(|layer| json!({ "name": layer.name, "channels": layer.channels[..stored.channels()] }))
        .collect();
    json!({
        "files": names,
        "part": info.part.name(),
        "layers": layers,
        "format": stored.format_in_words(),
    })
}
