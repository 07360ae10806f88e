//! A graphics device without a window, for pictures, tests and charts. In the game Bevy makes the device.

use thiserror::Error;

/// Why there is no device to draw with.
#[derive(Debug, Error)]
pub enum DeviceError {
    /// No driver offers an adapter.
    #[error(
        "no GPU adapter: no Vulkan, Metal or DirectX 12 driver was found. On Debian or Ubuntu, install the software driver with \
         `apt-get install mesa-vulkan-drivers`. `simulate`, `bake` and `project` work without one. ({0})"
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

/// Storage buffers that one stage of geometry binds: 3 tables, the exposure, 13 of its own and the arguments.
pub const STORAGE_BUFFERS: u32 = 18;

/// What is missing for the renderer on a device with these limits, or None.
pub fn missing_limits(limits: &wgpu::Limits) -> Option<String> {
    if limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS {
        return Some(format!(
            "a compute stage needs {STORAGE_BUFFERS} storage buffers, the driver offers {}",
            limits.max_storage_buffers_per_shader_stage
        ));
    }
    None
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
}

impl Gpu {
    /// Opens the best adapter there is, a software one if need be.
    pub fn headless() -> Result<Gpu, DeviceError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = wait(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        }))
        .map_err(DeviceError::NoAdapter)?;
        let info = adapter.get_info();
        let limits = adapter.limits();
        if let Some(needs) = missing_limits(&limits) {
            return Err(DeviceError::TooSmall { adapter: info.name, needs });
        }
        let optional = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_FILTERABLE;
        let (device, queue) = wait(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("lensrunner"),
            required_features: adapter.features() & optional,
            required_limits: limits,
            ..Default::default()
        }))
        .map_err(|source| DeviceError::NoDevice { adapter: info.name.clone(), source })?;
        Ok(Gpu { device, queue, adapter: info })
    }
}

/// Waits for a future that wgpu completes at once on native platforms.
pub fn wait<T>(future: impl Future<Output = T>) -> T {
    bevy::tasks::block_on(future)
}
