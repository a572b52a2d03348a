//! A device, created here without a window or given by the caller, and its capabilities.

use crate::GpuError;
use crate::error::one_line;

/// Features that are requested if the adapter has them. None is required everywhere.
const WANTED_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS)
    .union(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM)
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

/// Which adapters may be used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AdapterChoice {
    /// The fastest adapter of any kind; a software driver only if there is no other.
    #[default]
    Fastest,
    /// A software driver, which behaves the same on every machine.
    Software,
}

/// Which limits are requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimitChoice {
    /// All limits of the adapter.
    #[default]
    Adapter,
    /// The limits that every WebGPU implementation guarantees, so that what works here works there too.
    WebGpu,
}

/// How to create a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct GpuOptions {
    /// The graphics APIs to choose from.
    pub backends: wgpu::Backends,
    /// Which adapters may be used.
    pub adapter: AdapterChoice,
    /// Which limits are requested.
    pub limits: LimitChoice,
}

impl GpuOptions {
    /// The same options with these APIs.
    #[must_use]
    pub fn with_backends(self, backends: wgpu::Backends) -> Self {
        Self { backends, ..self }
    }

    /// The same options with these adapters.
    #[must_use]
    pub fn with_adapter(self, adapter: AdapterChoice) -> Self {
        Self { adapter, ..self }
    }

    /// The same options with these limits.
    #[must_use]
    pub fn with_limits(self, limits: LimitChoice) -> Self {
        Self { limits, ..self }
    }
}

impl Default for GpuOptions {
    /// The fastest adapter of any API with all its limits.
    fn default() -> Self {
        Self {
            backends: wgpu::Backends::all(),
            adapter: AdapterChoice::default(),
            limits: LimitChoice::default(),
        }
    }
}

/// A device with its queue and its capabilities.
#[derive(Clone, Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    features: wgpu::Features,
    limits: wgpu::Limits,
    /// Used to query format support beyond WebGPU's guarantees; `None` for a device of the caller.
    adapter: Option<wgpu::Adapter>,
}

impl Gpu {
    /// Creates a device without a window.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] and [`GpuError::NoDevice`].
    pub async fn new(options: &GpuOptions) -> Result<Self, GpuError> {
        // OpenGL is used only if there is nothing better: it lacks compute shaders on many devices.
        let (first, second) = (options.backends & wgpu::Backends::PRIMARY, options.backends);
        let adapter = match request_adapter(first, options.adapter).await {
            Ok(adapter) => adapter,
            Err(_) => request_adapter(second, options.adapter)
                .await
                .map_err(|error| GpuError::NoAdapter { reason: one_line(&error) })?,
        };
        Self::from_adapter(&adapter, options.limits).await
    }

    /// Creates a device from an adapter that the caller has chosen, such as one that can present to a window.
    ///
    /// # Errors
    /// [`GpuError::NoDevice`].
    pub async fn from_adapter(adapter: &wgpu::Adapter, limits: LimitChoice) -> Result<Self, GpuError> {
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("roughcast"),
            required_features: adapter.features() & WANTED_FEATURES,
            required_limits: match limits {
                LimitChoice::Adapter => adapter.limits(),
                LimitChoice::WebGpu => wgpu::Limits::default(),
            },
            ..Default::default()
        };
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| {
            GpuError::NoDevice { adapter: adapter.get_info().name, reason: one_line(&error) }
        })?;
        Ok(Self { adapter: Some(adapter.clone()), ..Self::from_device(device, queue) })
    }

    /// Uses a device of the caller, such as an engine's, a browser's or a window's.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let (info, features, limits) = (device.adapter_info(), device.features(), device.limits());
        Self { device, queue, info, features, limits, adapter: None }
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// The adapter's name and driver, and whether it is a software adapter.
    pub fn info(&self) -> &wgpu::AdapterInfo {
        &self.info
    }

    /// Features that may be used.
    pub fn features(&self) -> wgpu::Features {
        self.features
    }

    /// The device's limits.
    pub fn limits(&self) -> &wgpu::Limits {
        &self.limits
    }

    /// Whether the adapter is a software implementation on the CPU, whose timings are not those of graphics hardware.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device has compute shaders. WebGL2 has none.
    pub fn has_compute(&self) -> bool {
        self.limits.max_compute_invocations_per_workgroup > 0
    }

    /// Whether passes can be timed.
    pub fn has_timestamps(&self) -> bool {
        self.features.contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Checks that the device can use a format in all of these ways.
    ///
    /// # Errors
    /// [`GpuError::Format`], which names what to use instead.
    pub fn require_format(
        &self,
        format: wgpu::TextureFormat,
        usages: wgpu::TextureUsages,
    ) -> Result<(), GpuError> {
        let instead = match format {
            wgpu::TextureFormat::Rgba16Unorm => "use half floats or 8 bits instead",
            _ => "use half floats instead",
        };
        if !self.features.contains(format.required_features()) {
            return Err(GpuError::Format { wanted: "use", format, instead });
        }
        // With adapter-specific formats, only creating a texture shows what a device of the caller supports.
        let specific = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
        let allowed = match (&self.adapter, self.features.contains(specific)) {
            (_, false) => format.guaranteed_format_features(self.features).allowed_usages,
            (Some(adapter), true) => adapter.get_texture_format_features(format).allowed_usages,
            (None, true) => usages,
        };
        for (usage, wanted) in [
            (wgpu::TextureUsages::STORAGE_BINDING, "store to"),
            (wgpu::TextureUsages::RENDER_ATTACHMENT, "render to"),
            (wgpu::TextureUsages::TEXTURE_BINDING, "sample"),
        ] {
            if usages.contains(usage) && !allowed.contains(usage) {
                return Err(GpuError::Format { wanted, format, instead });
            }
        }
        Ok(())
    }

    /// Checks that the device can filter a format.
    ///
    /// # Errors
    /// [`GpuError::Format`], which names what to use instead.
    pub fn require_filterable(&self, format: wgpu::TextureFormat) -> Result<(), GpuError> {
        self.require_format(format, wgpu::TextureUsages::TEXTURE_BINDING)?;
        let kind = format.sample_type(None, Some(self.features));
        if kind == Some(wgpu::TextureSampleType::Float { filterable: true }) {
            return Ok(());
        }
        let instead = "use half floats instead";
        Err(GpuError::Format { wanted: "filter", format, instead })
    }

    /// Creates a texture, or returns the reason why it cannot be created.
    ///
    /// # Errors
    /// [`GpuError::Empty`], [`GpuError::TextureTooLarge`], [`GpuError::OutOfMemory`], [`GpuError::Refused`].
    pub async fn create_texture(
        &self,
        what: &'static str,
        descriptor: &wgpu::TextureDescriptor<'_>,
    ) -> Result<wgpu::Texture, GpuError> {
        let wgpu::Extent3d { width, height, .. } = descriptor.size;
        let limit = self.limits.max_texture_dimension_2d;
        if width == 0 || height == 0 {
            return Err(GpuError::Empty { width, height });
        }
        if width > limit || height > limit {
            return Err(GpuError::TextureTooLarge { width, height, limit });
        }
        self.checked(what, |device| device.create_texture(descriptor)).await
    }

    /// Creates a buffer, or returns the reason why it cannot be created.
    ///
    /// # Errors
    /// [`GpuError::BufferTooLarge`], [`GpuError::OutOfMemory`], [`GpuError::Refused`].
    pub async fn create_buffer(
        &self,
        what: &'static str,
        descriptor: &wgpu::BufferDescriptor<'_>,
    ) -> Result<wgpu::Buffer, GpuError> {
        let mut limit = self.limits.max_buffer_size;
        if descriptor.usage.contains(wgpu::BufferUsages::STORAGE) {
            limit = limit.min(self.limits.max_storage_buffer_binding_size);
        }
        if descriptor.size > limit {
            return Err(GpuError::BufferTooLarge { what, bytes: descriptor.size, limit });
        }
        self.checked(what, |device| device.create_buffer(descriptor)).await
    }

    /// Creates something that wgpu may reject as invalid or too large, and turns wgpu's message into an error instead
    /// of a panic.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`], [`GpuError::Refused`].
    pub async fn checked<T>(
        &self,
        what: &'static str,
        make: impl FnOnce(&wgpu::Device) -> T,
    ) -> Result<T, GpuError> {
        let (made, refused, full) = {
            let full = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
            let refused = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
            let made = make(&self.device);
            // The inner scope must be popped first.
            let refused = refused.pop();
            (made, refused, full.pop())
        };
        if full.await.is_some() {
            return Err(GpuError::OutOfMemory { what });
        }
        match refused.await {
            Some(error) => Err(GpuError::Refused { what, reason: one_line(&error) }),
            None => Ok(made),
        }
    }
}

async fn request_adapter(
    backends: wgpu::Backends,
    choice: AdapterChoice,
) -> Result<wgpu::Adapter, wgpu::RequestAdapterError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let request = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: choice == AdapterChoice::Software,
        ..Default::default()
    };
    wgpu::Instance::new(descriptor).request_adapter(&request).await
}
