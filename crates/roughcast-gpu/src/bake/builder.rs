//! What a bake on the GPU needs to know.

use roughcast::{BakeOptions, BaseRoughness, ImageView, SourceOptions};

use super::source::{self, MapFormat};
use super::{BakePath, GpuBaker};
use crate::{Gpu, GpuError};

/// A bake on the GPU, as [`roughcast::Bake`] is one on the CPU: a source and options, from which a [`GpuBaker`] is made for
/// images of one size and format, or for a texture.
///
/// ```
/// use roughcast::{BakeOptions, Image, SampleType, Samples};
/// use roughcast_gpu::bake::GpuBake;
/// use roughcast_gpu::{Gpu, GpuOptions};
///
/// # pollster::block_on(async {
/// let gpu = Gpu::new(&GpuOptions::default()).await?;
/// let normals = Image::new(2, 2, 3, Samples::U8([128, 128, 255].repeat(4)))?;
/// let options = BakeOptions::default().with_sample_type(SampleType::F16);
/// let baker = GpuBake::new().options(options).for_image(&gpu, &normals).await?;
/// baker.run();
/// assert_eq!(baker.read_back().await?.level_count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// # }).unwrap();
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct GpuBake<'a> {
    pub(super) source: SourceOptions,
    pub(super) roughness: Option<BaseRoughness<'a>>,
    pub(super) options: BakeOptions,
    pub(super) path: BakePath,
}

impl<'a> GpuBake<'a> {
    /// The default source, no roughness, the default options, and the fastest path.
    pub fn new() -> Self {
        Self::default()
    }

    /// How the map is read.
    #[must_use]
    pub fn source(self, source: SourceOptions) -> Self {
        Self { source, ..self }
    }

    /// The material's own roughness, one for the whole map.
    #[must_use]
    pub fn roughness(self, roughness: impl Into<Option<BaseRoughness<'a>>>) -> Self {
        Self { roughness: roughness.into(), ..self }
    }

    /// What is baked.
    #[must_use]
    pub fn options(self, options: BakeOptions) -> Self {
        Self { options, ..self }
    }

    /// The kind of passes.
    #[must_use]
    pub fn path(self, path: BakePath) -> Self {
        Self { path, ..self }
    }

    /// Creates a baker for images like this one and uploads the image. Nothing is baked yet.
    ///
    /// # Errors
    /// [`GpuError`] if options contradict each other or are unsupported on a GPU, the map is too large, or a format is
    /// missing.
    pub async fn for_image(self, gpu: &Gpu, image: impl Into<ImageView<'_>>) -> Result<GpuBaker, GpuError> {
        let image = image.into();
        let format = MapFormat::of_image(&image)?;
        let side = |texels: usize| u32::try_from(texels).unwrap_or(u32::MAX);
        let size = wgpu::Extent3d {
            width: side(image.width()),
            height: side(image.height()),
            depth_or_array_layers: 1,
        };
        let descriptor = wgpu::TextureDescriptor {
            label: Some("map"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: format.texture_format(),
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        };
        let map = gpu.create_texture("the map", &descriptor).await?;
        source::upload(gpu, &image, &map);
        self.for_texture(gpu, &map).await
    }

    /// Creates a baker for a texture that is already on the GPU, such as bumps drawn every frame. Each bake reads its
    /// level 0. The texture needs the usage `TEXTURE_BINDING`.
    ///
    /// # Errors
    /// As [`GpuBake::for_image`].
    pub async fn for_texture(self, gpu: &Gpu, map: &wgpu::Texture) -> Result<GpuBaker, GpuError> {
        GpuBaker::new(gpu, map, &self).await
    }
}
