//! The device that all tests share.

use std::sync::LazyLock;

use lensrunner::render::Gpu;

/// The software driver is installed by `./test`, so a machine without any adapter is a failure and not a reason to skip.
pub static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().expect("a Vulkan driver"));
