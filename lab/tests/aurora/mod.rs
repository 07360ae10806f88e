//! The aurora of the laboratory: the drawing on the processor, and the shaders.

mod engine;
mod shaders;
mod types;
