//! `NAME.json`: what a shader needs to know about baked files, for loaders that drop the files' own metadata.

use std::path::PathBuf;

use roughcast::texture::{Packing, TextureInfo, layers_of};
use roughcast::{SampleType, level_sizes};
use roughcast_io::Stored;
use serde_json::{Value, json};

/// Describes the written files.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sidecar {
    /// The meaning of the texels in the first file; the other files differ only in their part and layer.
    pub info: TextureInfo,
    /// The type of the texels.
    pub sample_type: SampleType,
    /// Width of level 0.
    pub width: usize,
    /// Height of level 0.
    pub height: usize,
    /// Number of levels.
    pub levels: usize,
    /// How stored texels are converted to values.
    pub packing: Packing,
    /// The parts, in the order in which they were written.
    pub parts: Vec<SidecarPart>,
}

/// A part of a layout, or a layer of it that has its own file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SidecarPart {
    /// The names of its files, without their folder: a single one, or for PNG one per level.
    pub files: Vec<String>,
    /// The meaning of its texels.
    pub info: TextureInfo,
    /// Its layers: names and channels.
    pub layers: Vec<(&'static str, Vec<&'static str>)>,
    /// The format of its texels: `RGBA 16-bit float`, `BC5`.
    pub format: String,
}

impl Sidecar {
    /// Describes the written files. `files` are the paths of all files, in the order of `stored`; for PNG, the levels
    /// of each follow one another.
    ///
    /// # Panics
    /// If `stored` is empty, or there are fewer files than parts.
    pub fn new(stored: &[Stored], files: &[PathBuf]) -> Self {
        let first = &stored[0];
        let (width, height) = first.size();
        let levels = level_sizes(width, height).len();
        // Either one file for each entry of `stored`, or one file for each of its levels.
        let files_each = if files.len() == stored.len() { 1 } else { levels };
        let parts =
            stored.iter().zip(files.chunks(files_each)).map(|(part, files)| SidecarPart::new(part, files));
        let sample_type = first.sample_type();
        Self {
            info: *first.info(),
            sample_type,
            width,
            height,
            levels,
            packing: Packing::new(first.info(), sample_type),
            parts: parts.collect(),
        }
    }

    /// The content of the file; the manual documents its keys.
    pub fn to_json(&self) -> Value {
        let info = &self.info;
        let pairs = info.to_pairs();
        json!({
            "roughcast": env!("CARGO_PKG_VERSION"),
            "layout": info.layout.name(),
            "bits": self.sample_type.name(),
            "width": self.width,
            "height": self.height,
            "levels": self.levels,
            "scale": info.scale,
            "variance_scale": info.spread_scale,
            "base": info.base.name(),
            "base_variance": info.base_variance,
            "specular_power": info.specular_power(),
            "brdf": info.brdf.name(),
            "roughness_stored": info.roughness_stored.name(),
            "wrap": info.wrap.name(),
            "normal_range": info.normal_range.name(),
            "set": pairs.get("roughcast.set"),
            "packing": self.packing_json(),
            "files": self.parts.iter().map(SidecarPart::to_json).collect::<Vec<_>>(),
            "conventions": pairs.get("roughcast.conventions"),
        })
    }

    /// The members of the exported shaders' `Packing`: `value = stored * pair[0] + pair[1]`, where stored is the value
    /// that a sampler returns, and two numbers that encode choices.
    fn packing_json(&self) -> Value {
        let packing = &self.packing;
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
}

impl SidecarPart {
    fn new(stored: &Stored, files: &[PathBuf]) -> Self {
        let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let info = *stored.info();
        let channels = stored.channels();
        let layers = layers_of(&info).iter().map(|layer| (layer.name, layer.channels[..channels].to_vec()));
        Self {
            files: files.iter().map(name).collect(),
            info,
            layers: layers.collect(),
            format: stored.format_name(),
        }
    }

    fn to_json(&self) -> Value {
        let layers = self.layers.iter().map(|(name, channels)| json!({ "name": name, "channels": channels }));
        json!({
            "files": self.files,
            "part": self.info.part.name(),
            "layers": layers.collect::<Vec<_>>(),
            "format": self.format,
        })
    }
}
