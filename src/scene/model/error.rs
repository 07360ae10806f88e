//! What can be wrong with the file of a model.

use std::path::PathBuf;

use crate::user_file::{FileFault, brief, short};

/// Why a model could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The file cannot be read.
    #[error("model {}: {source}", brief(&path.to_string_lossy()))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: FileFault,
    },
    /// Malformed.
    #[error("model {}: {}", brief(&path.to_string_lossy()), short(&source.to_string()))]
    Gltf {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: gltf::Error,
    },
    /// Readable, but of no use.
    #[error("model {}: {reason}", brief(&path.to_string_lossy()))]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Place, value and what is allowed.
        reason: String,
    },
}
