//! Scenes that nobody chose, judged as any other.
//!
//! - [`draw`]: a case from a seed and its number; [`place`] puts things where methods fail; [`text`] writes the scene.
//! - [`case_file`]: a case as a scene file with its size and T.
//! - [`reduce`]: a failing case made smaller.
//! - [`outcome`]: what came of many.
//! - [`collect`]: runs of many cases in one table.
//! - [`command`]: `lensrunner-lab compare --random` and `--case`.

pub mod case_file;
pub mod collect;
pub mod command;
pub mod corner;
pub mod draw;
pub mod outcome;
pub mod place;
pub mod reduce;
pub mod text;
