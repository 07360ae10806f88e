//! Whether the code that a product shows has changed since it was made.

use std::fmt;
use std::path::Path;

use super::git;

/// How a product stands to the code of today.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Standing {
    /// None of its sources has changed.
    Fresh,
    /// These of its sources have.
    Stale(Vec<String>),
    /// It was made from files that were in no commit.
    Uncommitted,
    /// Git does not know the commit.
    Unknown,
    /// It is not there.
    Missing,
}

/// Sources that are named of those that changed.
const NAMED: usize = 2;

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Standing::Fresh => write!(f, "fresh"),
            Standing::Stale(changed) => {
                write!(f, "STALE: {}", changed[..changed.len().min(NAMED)].join(", "))?;
                if changed.len() > NAMED {
                    write!(f, " and {} more changed since", changed.len() - NAMED)
                } else {
                    write!(f, " changed since")
                }
            }
            Standing::Uncommitted => write!(f, "STALE: made from uncommitted files"),
            Standing::Unknown => write!(f, "STALE?: git does not know its commit"),
            Standing::Missing => write!(f, "MISSING"),
        }
    }
}

/// How what was made at `commit` from `sources`, paths from `root`, stands to the files there: committed since, changed, or new.
pub fn standing<'a>(root: &Path, commit: &str, sources: impl Iterator<Item = &'a str>) -> Standing {
    if commit.ends_with('+') {
        return Standing::Uncommitted;
    }
    let sources: Vec<&str> = sources.collect();
    let changed = git::lines(root, &[&["diff", "--name-only", commit, "--"], &sources[..]].concat());
    let new = git::lines(root, &[&["ls-files", "--others", "--exclude-standard", "--"], &sources[..]].concat());
    match (commit.is_empty(), changed, new) {
        (false, Some(mut changed), Some(new)) => {
            changed.extend(new);
            if changed.is_empty() { Standing::Fresh } else { Standing::Stale(changed) }
        }
        _ => Standing::Unknown,
    }
}
