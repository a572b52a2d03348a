//! Converts the arguments of `bake` into the library's options.

use roughcast_io::{Container, Supercompression};
use roughcast_pipeline::{BakeChoices, BakeSettings, BrokenTexels, LayerFiles, SidecarFile};

use super::{Args, Supercompress};
use crate::report::Times;

impl Args {
    /// The format of a folder's outputs.
    pub fn container_in_folder(&self) -> Container {
        self.format.unwrap_or(Container::Ktx2)
    }

    /// Whether the report shows the time of each stage.
    pub fn times(&self) -> Times {
        if self.verbose { Times::Shown } else { Times::Hidden }
    }

    /// How maps are read and baked.
    pub fn settings(&self) -> BakeSettings {
        let mut settings = BakeSettings::new(self.layout);
        settings.map = self.source.map_options();
        settings.roughness = self.roughness.input();
        settings.choices = self.choices();
        settings.broken_texels = if self.strict { BrokenTexels::Refuse } else { BrokenTexels::Repair };
        settings.sidecar = if self.sidecar { SidecarFile::Json } else { SidecarFile::None };
        settings
    }

    fn choices(&self) -> BakeChoices {
        let mut choices = BakeChoices::new(self.layout);
        choices.sample_type = self.bits;
        choices.scale = self.scale;
        choices.filter = self.filter;
        choices.base = self.roughness.base;
        choices.brdf = self.roughness.brdf;
        choices.roughness_stored = self.roughness.roughness_output;
        choices.anisotropy = self.anisotropy;
        choices.roughness_texture = self.roughness_layout;
        choices.normal_range = self.normal_range;
        choices.blocks = self.compress;
        choices.target = self.target;
        choices.layers = if self.split { LayerFiles::Split } else { LayerFiles::Together };
        choices.supercompression = match self.supercompress {
            Supercompress::None => Supercompression::None,
            Supercompress::Zstd => Supercompression::Zstd,
        };
        choices
    }
}
