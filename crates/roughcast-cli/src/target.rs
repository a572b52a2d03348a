//! Where textures are going to be used, and what can be read there.

use roughcast::{BakeOptions, Blocks, SampleType, named_enum};

use crate::UsageError;
use crate::output::Container;

named_enum! {
    /// Where textures are going to be used.
    pub enum Target: "target" {
        /// Native programs on Vulkan, Metal, Direct3D or OpenGL.
        Desktop = "desktop",
        /// WebGPU and WebGL 2, as three.js and Babylon.js use them.
        Web = "web",
        /// Everywhere, phones included.
        Any = "any",
    }
}

/// Which common readers refuse files of this kind: one line, or none.
///
/// Sources: the loaders of three.js 0.187 (uploads layer 0 of an uncompressed array), Babylon.js and Godot (read no arrays);
/// Babylon.js and PlayCanvas (read no 16-bit UNORM); WebGPU and WebGL, which need an extension for it.
pub fn reader_note(container: Container, layers: usize, sample_type: SampleType) -> Option<String> {
    if !matches!(container, Container::Ktx2 | Container::Dds) {
        return None;
    }
    let arrays = (layers > 1).then_some(
        "three.js, Babylon.js and Godot read no array textures (--split writes a file for each layer)",
    );
    let sixteen = (sample_type == SampleType::U16).then_some(
        "browsers sample 16-bit integers only with an extension, Babylon.js and PlayCanvas not at all (--bits half or \
         --target web)",
    );
    let all: Vec<&str> = arrays.into_iter().chain(sixteen).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

impl Target {
    /// Refuses what cannot be sampled there at all.
    ///
    /// Sources: WebGPU, "Texture Format Capabilities" (16-bit UNORM formats need the feature `texture-formats-tier1`, blocks the
    /// feature `texture-compression-bc`); OpenGL ES 3.0, table 3.13 (no 16-bit normalised formats), EXT_texture_norm16.
    pub fn check(self, container: Container, options: &BakeOptions) -> Result<(), UsageError> {
        let refuse = |line: String| Err(UsageError(line));
        match (self, container) {
            (Target::Desktop, _) => Ok(()),
            (_, Container::Png) if options.bits == SampleType::U16 => refuse(format!(
                "browsers decode a PNG to 8 bits, too few for the layout '{}': write .ktx2, or say --as variance --bits 8",
                options.layout
            )),
            _ if options.bits == SampleType::U16 => refuse(
                "textures of 16-bit integers need WebGPU's feature texture-formats-tier1 or WebGL's EXT_texture_norm16, \
                 which many devices lack: leave --bits out, or say --bits half"
                    .to_owned(),
            ),
            (Target::Any, _) if options.blocks == Blocks::Bc => refuse(
                "phones lack the blocks of --compress bc: leave it out, or say --target web or --target desktop".to_owned(),
            ),
            _ => Ok(()),
        }
    }

    /// What works there only with a feature, or loses something.
    pub fn warnings(self, container: Container, options: &BakeOptions) -> Vec<String> {
        let mut warnings = Vec::new();
        if self == Target::Desktop {
            return warnings;
        }
        if options.bits == SampleType::F32 {
            warnings.push(
                "single floats are filtered only with WebGPU's feature float32-filterable or WebGL's \
                 OES_texture_float_linear, which phones often lack: half floats need neither"
                    .to_owned(),
            );
        }
        if options.blocks == Blocks::Bc {
            warnings.push(
                "blocks need WebGPU's feature texture-compression-bc or WebGL's EXT_texture_compression_rgtc and \
                 EXT_texture_compression_bptc, which phones lack: --target any excludes them"
                    .to_owned(),
            );
        }
        if matches!(container, Container::Png | Container::Exr) {
            warnings.push(format!(
                "loaders of .{container} take one level and make the others anew, which loses the roughness: write .ktx2"
            ));
        }
        warnings
    }
}
