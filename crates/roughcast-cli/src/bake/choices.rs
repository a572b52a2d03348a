//! What the arguments of `bake` come down to.

use std::ffi::OsString;
use std::path::PathBuf;

use roughcast::texture::{Brdf, RoughnessStored, TextureInfo};
use roughcast::{BakeOptions, Blocks, Named, NormalRange, PbrOptions, RoughnessTexture, SampleType};

use super::{Args, Supercompress};
use crate::UsageError;
use crate::output::Container;
use crate::roughness::Roughness;
use crate::target::Target;

impl Args {
    /// Names that a folder's outputs get: all parts and levels start with it.
    pub fn output_in_folder(&self, mut name: OsString) -> PathBuf {
        name.push(".");
        name.push(self.container_in_folder().name());
        self.output.join(name)
    }

    /// The format of a folder's outputs.
    pub fn container_in_folder(&self) -> Container {
        self.format.unwrap_or(Container::Ktx2)
    }

    /// The library's options; where nothing was said, those that suit the container.
    pub(super) fn options(&self, container: Container, roughness: Option<&Roughness>) -> BakeOptions {
        let bits = self.bits.unwrap_or(match (container, self.layout.default_sample_type(), self.compress) {
            (_, _, Blocks::Bc) => SampleType::U8,
            (Container::Exr, SampleType::U8 | SampleType::U16, _) => SampleType::F16,
            (Container::Ktx2 | Container::Dds, SampleType::U16, _) if self.target != Target::Desktop => {
                SampleType::F16
            }
            (_, suited, _) => suited,
        });
        // Blinn-Phong renderers want exponents, which only floats hold.
        let stored = match (self.roughness.roughness_output, self.roughness.brdf) {
            (Some(stored), _) => stored,
            (None, Brdf::BlinnPhong) if bits.is_float() => RoughnessStored::SpecularPower,
            (None, _) => RoughnessStored::Perceptual,
        };
        BakeOptions {
            layout: self.layout,
            bits,
            scale: self.scale,
            base: self.roughness.base,
            brdf: self.roughness.brdf,
            pbr: PbrOptions {
                roughness_stored: stored,
                anisotropy: self.anisotropy,
                roughness_texture: self.roughness_texture(container, roughness),
                normal_range: self.normal_range.unwrap_or(NormalRange::Unorm),
            },
            blocks: self.compress,
            filter: self.filter,
        }
    }

    /// The channels of `pbr`'s roughness: glTF's, with the occlusion and metalness of the picture where it has them. Renderers
    /// that read EXR take a roughness of one channel.
    fn roughness_texture(&self, container: Container, roughness: Option<&Roughness>) -> RoughnessTexture {
        self.roughness_layout.unwrap_or_else(|| match container {
            _ if roughness.is_some_and(Roughness::is_packed) => RoughnessTexture::Packed,
            Container::Exr => RoughnessTexture::Alone,
            _ => RoughnessTexture::Green,
        })
    }

    /// Whether each layer gets a file of its own. PNG has no layers, and the targets of the web have loaders that know none.
    pub fn splits(&self, container: Container) -> bool {
        self.split || container == Container::Png || self.target != Target::Desktop
    }

    /// Refuses options that do not go together, before any work is done.
    pub fn check(&self, container: Container) -> Result<(), UsageError> {
        let options = self.options(container, None);
        container.check(&options)?;
        self.target.check(container, &options)?;
        for (given, option) in [
            (self.anisotropy.is_some(), "--anisotropy"),
            (self.roughness_layout.is_some(), "--roughness-layout"),
            (self.normal_range.is_some(), "--normal-range"),
            (self.roughness.roughness_output.is_some(), "--roughness-output"),
        ] {
            if given && !self.layout.reads_pbr_options() {
                return Err(UsageError(format!(
                    "{option} is for --as pbr, and the layout is '{}': leave it out",
                    self.layout
                )));
            }
        }
        if self.normal_range.is_some() && !options.bits.is_float() {
            return Err(UsageError(format!(
                "--normal-range is for floats, and {} bits always hold n/2 + 1/2: leave it out, or say --bits half",
                options.bits
            )));
        }
        if self.supercompress == Supercompress::Zstd && container != Container::Ktx2 {
            return Err(UsageError(format!(
                "--supercompress is for .ktx2, not for .{container}: leave it out"
            )));
        }
        Ok(())
    }

    /// What the first file that is written contains.
    pub(super) fn first_file(&self, container: Container) -> TextureInfo {
        let parts = self.layout.parts_written(self.compress, &self.options(container, None).pbr);
        let info = TextureInfo::new(self.layout, parts[0]);
        if self.splits(container) { roughcast::texture::split_infos(&info)[0] } else { info }
    }
}
