//! The image of a thin disk.

mod ray;
