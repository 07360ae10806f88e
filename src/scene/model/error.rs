//! What can be wrong with the file of a model.

use std::path::PathBuf;

use crate::user_file::{FileFault, short};

/// Why a model could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The file cannot be read.
    #[error("model {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: FileFault,
    },
    /// Malformed.
    #[error("model {}: {}", path.display(), short(&source.to_string()))]
    Gltf {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: gltf::Error,
    },
    /// Readable, but of no use.
    #[error("model {}: {reason}", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Place, value and what is allowed.
        reason: String,
    },
}
