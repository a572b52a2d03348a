//! LEAN and CLEAN maps baked on the GPU, fast enough for bumps that move every frame.
//!
//! The result matches that of [`roughcast::Bake`] within one step of the format on every texel of every level: the
//! options and the order of additions are the same, and quotients and roots are rounded as on the CPU.

mod bandwidth;
mod bindings;
mod builder;
mod compute;
mod pipelines;
mod plan;
mod raster;
mod scale;
mod source;
mod target;

use std::sync::LazyLock;

use roughcast::texture::{TextureArray, TextureInfo};
use roughcast::wgsl::Role;
use roughcast::{BakePlan, ImageView, MaxSlope, ScaleChoice, SourceCounts};
use wgpu::util::DeviceExt;

use crate::read_back::read_buffer;
use crate::{Gpu, GpuError, Span};
pub use bandwidth::{Bandwidth, bake_bandwidth, copy_bandwidth};
use bindings::Bindings;
pub use builder::GpuBake;
use compute::ComputeBake;
use raster::RasterBake;
use scale::AutoScale;
use source::MapFormat;
use target::{Target, base_variance_of, level_count, level_view};

/// The library's WGSL functions.
static LIBRARY: LazyLock<String> = LazyLock::new(|| roughcast::wgsl::library_of(Role::Bake));

/// WGSL that returns the largest slope, for passes that run once it is known.
const SLOPE_LIMIT: &str = include_str!("wgsl/slope_limit.wgsl");

/// How a map is baked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum BakePath {
    /// Compute shaders if the device has them, otherwise render passes.
    #[default]
    Fastest,
    /// Compute shaders.
    Compute,
    /// Render passes, the method of the LEAN paper (section 3).
    Raster,
}

/// Bakes a map of one size and format repeatedly: pipelines, bindings and textures are created once, by a [`GpuBake`].
pub struct GpuBaker {
    gpu: Gpu,
    job: Job,
    work: Work,
    auto_scale: Option<AutoScale>,
}

enum Work {
    Compute(ComputeBake),
    Raster(RasterBake),
}

/// What all passes of a bake share.
struct Job {
    map: wgpu::Texture,
    map_view: wgpu::TextureView,
    map_format: MapFormat,
    size: wgpu::Extent3d,
    plan: BakePlan,
    base_variance: f32,
    target: Target,
    textures: Vec<wgpu::Texture>,
    /// WGSL's `PackedStores`.
    stores: wgpu::Buffer,
    /// Counts of repaired texels, in the order of [`SourceCounts`].
    counts: wgpu::Buffer,
}

/// Number of floats in WGSL's `PackedStores`, and the indices of the scale and the largest slope within it.
const STORES_FLOATS: usize = 12;
const SCALE_AT: usize = 10;
const LIMIT_AT: usize = 11;

impl GpuBaker {
    async fn new(gpu: &Gpu, map: &wgpu::Texture, bake: &GpuBake<'_>) -> Result<Self, GpuError> {
        let path = match bake.path {
            BakePath::Fastest if gpu.has_compute() => BakePath::Compute,
            BakePath::Fastest => BakePath::Raster,
            chosen => chosen,
        };
        let job = Job::new(gpu, map, bake, path).await?;
        let finds_scale = !job.target.is_float() && bake.options.scale == ScaleChoice::Auto;
        let auto_scale = if finds_scale { Some(AutoScale::new(gpu, &job).await?) } else { None };
        let work = match path {
            BakePath::Raster => Work::Raster(RasterBake::new(gpu, &job).await?),
            BakePath::Compute | BakePath::Fastest => Work::Compute(ComputeBake::new(gpu, &job).await?),
        };
        Ok(Self { gpu: gpu.clone(), job, work, auto_scale })
    }

    /// Replaces the map with another image of the same size, channels and sample type.
    ///
    /// # Errors
    /// [`GpuError::OtherMap`] if the image differs in any of these; [`GpuError::MapUsage`] if the map's texture
    /// cannot be copied to.
    pub fn upload<'i>(&self, image: impl Into<ImageView<'i>>) -> Result<(), GpuError> {
        let image = image.into();
        let size = self.job.size;
        let same_size = (image.width(), image.height()) == (size.width as usize, size.height as usize);
        if !same_size || MapFormat::of_image(&image)? != self.job.map_format {
            return Err(GpuError::OtherMap {
                wanted: (size.width, size.height),
                format: self.job.map.format(),
                got: (image.width(), image.height()),
                channels: image.channels(),
                sample_type: image.samples().sample_type(),
            });
        }
        require_usage(&self.job.map, wgpu::TextureUsages::COPY_DST)?;
        source::upload(&self.gpu, &image, &self.job.map);
        Ok(())
    }

    /// Encodes a bake of the map's texture, with the contents that it has when the commands run. Creates nothing on the
    /// GPU.
    ///
    /// `span` measures the bake: the whole of a compute bake; with render passes, everything except the search for a
    /// scale.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, span: Option<&Span>) {
        encoder.clear_buffer(&self.job.counts, 0, None);
        if let Some(auto_scale) = &self.auto_scale {
            auto_scale.encode_reset(encoder);
        }
        match &self.work {
            Work::Compute(compute) => {
                let mut pass = compute::begin_pass(encoder, span);
                if let Some(auto_scale) = &self.auto_scale {
                    auto_scale.encode(&mut pass);
                }
                compute.encode(&mut pass);
            }
            Work::Raster(raster) => {
                if let Some(auto_scale) = &self.auto_scale {
                    auto_scale.encode(&mut compute::begin_pass(encoder, None));
                }
                raster.encode(encoder, span);
            }
        }
    }

    /// Encodes and submits one bake.
    pub fn run(&self) {
        let mut encoder = self.gpu.device().create_command_encoder(&Default::default());
        self.encode(&mut encoder, None);
        self.gpu.queue().submit([encoder.finish()]);
    }

    /// The baked textures, in the order of the layout's layers: `lean1` and `lean2`, or `clean`. Every bake writes to
    /// the same textures.
    pub fn textures(&self) -> &[wgpu::Texture] {
        &self.job.textures
    }

    /// Number of dispatches of a bake, excluding those that find a scale; 0 with render passes.
    pub fn dispatch_count(&self) -> usize {
        match &self.work {
            Work::Compute(compute) => compute.dispatch_count(),
            Work::Raster(_) => 0,
        }
    }

    /// A buffer for shaders whose eleventh float is the scale and whose twelfth is the largest slope: see
    /// `PackedStores` in `bake/common.wgsl`.
    pub fn scale_buffer(&self) -> &wgpu::Buffer {
        &self.job.stores
    }

    /// The meaning of the texels. An automatic scale is read back from the GPU.
    ///
    /// # Errors
    /// [`GpuError::ReadBack`] if the device was lost.
    pub async fn info(&self) -> Result<TextureInfo, GpuError> {
        let mut info = self.job.plan.info;
        if !self.job.target.is_float() {
            info.scale = self.stores().await?[SCALE_AT];
        }
        Ok(info)
    }

    /// The largest slope of the last bake, read back from the GPU. With [`MaxSlope::Auto`] it may depend on the map.
    ///
    /// # Errors
    /// [`GpuError::ReadBack`] if the device was lost.
    pub async fn max_slope(&self) -> Result<f32, GpuError> {
        Ok(self.stores().await?[LIMIT_AT])
    }

    async fn stores(&self) -> Result<Vec<f32>, GpuError> {
        Ok(bytemuck::pod_collect_to_vec(&read_buffer(&self.gpu, &self.job.stores).await?))
    }

    /// Counts of the texels that the last bake repaired; `None` with render passes, which do not count them.
    ///
    /// # Errors
    /// [`GpuError::ReadBack`] if the device was lost.
    pub async fn counts(&self) -> Result<Option<SourceCounts>, GpuError> {
        if matches!(self.work, Work::Raster(_)) {
            return Ok(None);
        }
        let counts: Vec<u32> = bytemuck::pod_collect_to_vec(&read_buffer(&self.gpu, &self.job.counts).await?);
        let [clamped, behind, invalid, non_finite] = std::array::from_fn(|i| u64::from(counts[i]));
        Ok(Some(SourceCounts { clamped, behind, invalid, non_finite }))
    }

    /// Reads the baked textures back into memory, to be written to files.
    ///
    /// # Errors
    /// [`GpuError`] if they do not fit into memory or the device was lost.
    pub async fn read_back(&self) -> Result<TextureArray, GpuError> {
        let info = self.info().await?;
        self.job.target.read_back(&self.gpu, &self.job.textures, info).await
    }
}

impl Job {
    async fn new(
        gpu: &Gpu,
        map: &wgpu::Texture,
        bake: &GpuBake<'_>,
        path: BakePath,
    ) -> Result<Self, GpuError> {
        let GpuBake { source, roughness, options, .. } = bake;
        let plan = BakePlan::new(source, *roughness, options)?;
        let target = Target::new(options)?;
        let base_variance = base_variance_of(&plan.info, *roughness)?;
        let map_format = MapFormat::of_texture(map.format())?;
        map_format.check_channels(&plan.source)?;
        if map.dimension() != wgpu::TextureDimension::D2 || map.sample_count() != 1 {
            return Err(GpuError::MapDimension);
        }
        require_usage(map, wgpu::TextureUsages::TEXTURE_BINDING)?;
        let usage = match path {
            BakePath::Raster => wgpu::TextureUsages::RENDER_ATTACHMENT,
            BakePath::Compute | BakePath::Fastest => wgpu::TextureUsages::STORAGE_BINDING,
        };
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..map.size() };
        let textures = target.textures(gpu, size, usage).await?;
        let scale = match options.scale {
            ScaleChoice::Fixed(scale) if !target.is_float() => Some(scale),
            ScaleChoice::Fixed(_) | ScaleChoice::Auto => None,
        };
        Ok(Self {
            map: map.clone(),
            map_view: level_view(map, 0),
            map_format,
            size,
            plan,
            base_variance,
            target,
            textures,
            stores: stores_buffer(gpu, scale, plan.source.max_slope.before_survey()),
            counts: counts_buffer(gpu).await?,
        })
    }

    fn last_level(&self) -> u32 {
        level_count(self.size) - 1
    }

    fn level_size(&self, level: u32) -> (u32, u32) {
        ((self.size.width >> level).max(1), (self.size.height >> level).max(1))
    }

    fn texels(&self, level: u32) -> u64 {
        let (width, height) = self.level_size(level);
        u64::from(width) * u64::from(height)
    }

    /// The survey stride, as in WGSL's `Params`; zero if the largest slope is known.
    fn survey_stride(&self) -> u32 {
        match self.plan.source.max_slope {
            MaxSlope::Auto => {
                roughcast::survey_stride(self.size.width as usize, self.size.height as usize) as u32
            }
            MaxSlope::Limit(_) => 0,
        }
    }

    /// A view of one level of each texture.
    fn level_views(&self, level: u32) -> Vec<wgpu::TextureView> {
        self.textures.iter().map(|texture| level_view(texture, level)).collect()
    }

    /// Declares the map's binding.
    fn bind_map<'a>(&'a self, bindings: &mut Bindings<'a>) {
        let format = self.map_format;
        bindings.sampled_texture("map", format.wgsl_type(), format.sample_type(), &self.map_view);
    }

    /// WGSL of `map_slope` and `averages_of_slope`. The map must be declared first.
    fn map_wgsl(&self) -> String {
        self.map_format.wgsl(&self.plan.source) + self.target.averages_wgsl()
    }

    /// WGSL's `Params` for a pass that reads this level.
    fn params(&self, device: &wgpu::Device, level: u32) -> wgpu::Buffer {
        let (width, height) = self.level_size(level);
        let source = &self.plan.source;
        let [factor_x, factor_y] = source.normal_factors();
        let words = [
            width,
            height,
            0,
            source::code_of_wrap(source.wrap),
            source.max_slope.before_survey().to_bits(),
            source::texels_from_height(source, self.size.width).to_bits(),
            self.base_variance.to_bits(),
            factor_x.to_bits(),
            factor_y.to_bits(),
            self.survey_stride(),
            // Pads the size to a multiple of 16 bytes.
            0,
            0,
        ];
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("bake"),
            contents: bytemuck::cast_slice(&words),
            usage: wgpu::BufferUsages::UNIFORM,
        })
    }
}

/// WGSL's `PackedStores`: the largest slope, and the packing for a scale. The packing is the identity for floats and
/// until a scale has been found.
fn stores_buffer(gpu: &Gpu, scale: Option<f32>, max_slope: f32) -> wgpu::Buffer {
    let mut floats: [f32; STORES_FLOATS] = match scale {
        None => [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0],
        Some(scale) => {
            let square = scale * scale;
            let (slope, second, mixed, trace) =
                (0.5 / scale, 1.0 / square, 0.5 / square, 1.0 / (2.0 * square));
            [slope, 0.5, second, 0.0, mixed, 0.5, trace, 0.0, 0.5, 0.5, scale, 0.0]
        }
    };
    floats[LIMIT_AT] = max_slope;
    let mut usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_SRC;
    if gpu.has_compute() {
        usage |= wgpu::BufferUsages::STORAGE;
    }
    gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("scale"),
        contents: bytemuck::cast_slice(&floats),
        usage,
    })
}

async fn counts_buffer(gpu: &Gpu) -> Result<wgpu::Buffer, GpuError> {
    let mut usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    if gpu.has_compute() {
        usage |= wgpu::BufferUsages::STORAGE;
    }
    let descriptor =
        wgpu::BufferDescriptor { label: Some("repaired texels"), size: 16, usage, mapped_at_creation: false };
    gpu.create_buffer("counts", &descriptor).await
}

/// Checks that the texture of a map has a usage.
fn require_usage(map: &wgpu::Texture, usage: wgpu::TextureUsages) -> Result<(), GpuError> {
    if map.usage().contains(usage) { Ok(()) } else { Err(GpuError::MapUsage { missing: usage }) }
}
