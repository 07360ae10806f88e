//! What all passes use: the device, bindings and buffers, the types that cross to the shaders, the shaders, targets, reading back,
//! times.

pub mod device;
pub mod layout;
pub mod library;
pub mod readback;
pub mod shaders;
pub mod steps;
pub mod targets;
pub mod timing;
pub mod types;
