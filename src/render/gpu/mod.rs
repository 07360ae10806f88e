//! What all passes stand on: the device, bindings and buffers, the layouts that cross to the shaders, the shaders' text, targets, reading
//! back, time.

pub mod device;
pub mod layout;
pub mod readback;
pub mod shaders;
pub(crate) mod stopwatch;
pub mod targets;
pub mod timing;
pub mod types;
