//! What can be wrong with a file a person wrote, said so that the person can mend it.

use std::fmt;
use std::path::PathBuf;

use crate::user_file::{brief, short};

/// One wrong entry of a TOML file: `game.toml:12: render.orders: 7 is out of range, allowed 1 to 3`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complaint {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// The line, from 1; `None` where the file as a whole is meant (a missing section).
    pub line: Option<usize>,
    /// The dotted key, arrays by index from 0: `ship[1].position`. Empty where the text is no TOML at all.
    pub key: String,
    /// What is wrong, with the value and what is allowed.
    pub problem: String,
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        if !self.key.is_empty() {
            write!(f, " {}:", self.key)?;
        }
        write!(f, " {}", self.problem)
    }
}

/// Everything that is wrong with one file, in the order of its lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complaints(pub Vec<Complaint>);

impl fmt::Display for Complaints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, complaint) in self.0.iter().enumerate() {
            write!(f, "{}{complaint}", if k == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

/// Why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// Neither a scene of that name nor a file.
    #[error("no scene {:?}: {}; known scenes: {known}", short(name), brief(tried))]
    NotFound {
        /// What was asked for.
        name: String,
        /// Where it was looked for.
        tried: String,
        /// The names that would have worked, separated by commas.
        known: String,
    },
    /// The file exists and cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// Entries are wrong.
    #[error("{0}")]
    Invalid(Complaints),
}

/// Why `game.toml` could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// Entries are wrong.
    #[error("{0}")]
    Invalid(Complaints),
    /// What the command line sets clashes.
    #[error("--set: {0}")]
    Set(String),
}
