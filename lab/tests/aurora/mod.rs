//! The aurora of the laboratory: walks, pyramids of splats, and the shaders.

mod pyramid;
mod shaders;
mod walk;
