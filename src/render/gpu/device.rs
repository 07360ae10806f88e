//! A graphics device without a window, for pictures, tests and charts. In the game Bevy makes the device.

use std::sync::{Arc, Mutex, PoisonError};

use thiserror::Error;

/// Why there is no device to draw with.
#[derive(Debug, Error)]
pub enum DeviceError {
    /// No driver offers an adapter.
    #[error(
        "no GPU adapter: no Vulkan, Metal or DirectX 12 driver was found. On Debian or Ubuntu, install the software driver with \
         `apt-get install mesa-vulkan-drivers`. `simulate`, `bake`, `project`, `trace` and the charts of the processor work without one. ({0})"
    )]
    NoAdapter(wgpu::RequestAdapterError),
    /// The adapter refused to open.
    #[error("the GPU adapter `{adapter}` does not open: {source}")]
    NoDevice {
        /// Its name.
        adapter: String,
        /// What it said.
        source: wgpu::RequestDeviceError,
    },
    /// The adapter cannot do what the renderer needs.
    #[error("the GPU adapter `{adapter}` cannot be used: {needs}")]
    TooSmall {
        /// Its name.
        adapter: String,
        /// What is missing.
        needs: String,
    },
}

/// What the renderer asks of an adapter: what WebGPU guarantees everywhere, and no more. Textures and buffers may be larger where it has
/// room: for large pictures.
fn minimum() -> wgpu::Limits {
    wgpu::Limits::default()
}

/// Features that are used where the adapter has them: times and fragments of passes, tables sampled, aurora and thin images added up in
/// 32-bit floats.
pub(in crate::render) const OPTIONAL: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::PIPELINE_STATISTICS_QUERY)
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::FLOAT32_BLENDABLE);

/// What is missing for the renderer on a device with these limits, or None.
pub fn missing_limits(limits: &wgpu::Limits) -> Option<String> {
    let mut missing = Vec::new();
    minimum().check_limits_with_fail_fn(limits, false, |name, needed, offered| {
        missing.push(format!("`{name}` is {offered}, it must be {needed}"));
    });
    (!missing.is_empty()).then(|| missing.join("; "))
}

/// The minimum, with the room that an adapter of these limits has.
fn required(offered: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_texture_dimension_2d: offered.max_texture_dimension_2d,
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..minimum()
    }
}

/// Errors that a device reports. If nobody listens, wgpu ends the program at the first one.
#[derive(Clone, Debug, Default)]
pub struct Watch(Arc<Mutex<Option<String>>>);

impl Watch {
    /// Listens to a device of ours; Bevy listens to its own, and quits with a message.
    fn over(device: &wgpu::Device) -> Watch {
        let watch = Watch::default();
        let (lost, wrong) = (watch.clone(), watch.clone());
        device
            .set_device_lost_callback(move |reason, message| lost.report(format!("the graphics device was lost ({reason:?}): {message}")));
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| wrong.report(error.to_string())));
        watch
    }

    /// Keeps the first complaint, and logs it.
    fn report(&self, what: String) {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            bevy::log::error!("{what}");
            *first = Some(what);
        }
    }

    /// The first thing that went wrong; None while all is well.
    pub fn complaint(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A device and its queue.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name and kind of the adapter.
    pub adapter: wgpu::AdapterInfo,
    /// What went wrong with it.
    pub watch: Watch,
}

impl Gpu {
    /// The adapter's name and kind.
    pub fn adapter_name(&self) -> String {
        let kind = if self.adapter.device_type == wgpu::DeviceType::Cpu { " (software)" } else { "" };
        format!("{}{kind}", self.adapter.name)
    }

    /// Opens the best adapter there is, a software one if need be.
    pub fn headless() -> Result<Gpu, DeviceError> {
        Gpu::headless_with(OPTIONAL)
    }

    /// The same with no more of its optional features than these.
    pub fn headless_with(optional: wgpu::Features) -> Result<Gpu, DeviceError> {
        wait(Gpu::open(optional))
    }

    /// The same, where one cannot wait.
    pub async fn open(optional: wgpu::Features) -> Result<Gpu, DeviceError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        // As Bevy's: the arguments of indirect calls are made by shaders of ours. `./test` has them checked.
        descriptor.flags = (wgpu::InstanceFlags::default() - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL).with_env();
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions { power_preference: wgpu::PowerPreference::HighPerformance, ..Default::default() };
        let adapter = instance.request_adapter(&options).await.map_err(DeviceError::NoAdapter)?;
        let info = adapter.get_info();
        let limits = adapter.limits();
        if let Some(needs) = missing_limits(&limits) {
            return Err(DeviceError::TooSmall { adapter: info.name, needs });
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("lensrunner"),
            required_features: adapter.features() & optional,
            required_limits: required(&limits),
            ..Default::default()
        };
        let opened = adapter.request_device(&descriptor).await;
        let (device, queue) = opened.map_err(|source| DeviceError::NoDevice { adapter: info.name.clone(), source })?;
        let watch = Watch::over(&device);
        Ok(Gpu { device, queue, adapter: info, watch })
    }
}

/// Waits for a future that wgpu completes at once on native platforms.
pub fn wait<T>(future: impl Future<Output = T>) -> T {
    bevy::tasks::block_on(future)
}
