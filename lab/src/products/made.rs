//! What is known of a product as it lies in a folder: when, where and how it was made, and whether the code that it shows has changed
//! since.
//!
//! The file `products.toml` of the folder says it of all that `lab/run all` made. A chart's own CSV says it of what was made by hand since,
//! and of the rest git knows when it was committed.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use super::{Product, plain};
use crate::chart::{Provenance, Sheet};

/// The file's name.
pub const FILE: &str = "products.toml";

/// How a product came to be.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Made {
    /// The commands, without where they write to.
    pub commands: Vec<String>,
    /// Commit, machine, driver, date; its command is left empty.
    #[serde(flatten)]
    pub on: Provenance,
    /// How long it took, in seconds; 0 where that is not known.
    #[serde(default)]
    pub seconds: f64,
    /// Whether nobody says so, and it is the commit that the file came with, which it cannot be younger than.
    #[serde(skip)]
    pub guessed: bool,
}

/// Why products cannot be made, or looked over.
#[derive(Debug, thiserror::Error)]
pub enum ProductsError {
    /// A file cannot be read or written.
    #[error("{}: cannot be read or written: {}", .0.display(), .1)]
    Io(PathBuf, std::io::Error),
    /// A file is no TOML.
    #[error("{}: {}", .0.display(), .1)]
    Toml(PathBuf, String),
    /// No product is called so.
    #[error("--only {0}: there is no such product; lab/run status lists them")]
    Unknown(String),
    /// A program ended and left a file unwritten.
    #[error("{0} ended with {1} and did not write {2}; see {3}")]
    NotWritten(String, String, String, PathBuf),
}

/// What `folder` records of its products.
#[derive(Clone, Debug, Default)]
pub struct Record {
    path: PathBuf,
    table: toml::Table,
}

impl Record {
    /// Reads it; an empty one where there is none.
    pub fn load(folder: &Path) -> Result<Record, ProductsError> {
        let path = folder.join(FILE);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(ProductsError::Io(path, error)),
        };
        let table = text.parse().map_err(|error: toml::de::Error| ProductsError::Toml(path.clone(), error.to_string()))?;
        Ok(Record { path, table })
    }

    /// What it says of a product.
    pub fn of(&self, name: &str) -> Option<Made> {
        self.table.get(name)?.clone().try_into().ok()
    }

    /// Records a product and writes the file.
    pub fn put(&mut self, name: &str, made: &Made) -> Result<(), ProductsError> {
        let entry = toml::Value::try_from(made).map_err(|error| ProductsError::Toml(self.path.clone(), error.to_string()))?;
        self.table.insert(name.into(), entry);
        let wrong = |error| ProductsError::Io(self.path.clone(), error);
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder).map_err(wrong)?;
        }
        let head = "# Written by `lab/run all`: how each product of this folder was made.\n\n";
        std::fs::write(&self.path, format!("{head}{}", self.table)).map_err(wrong)
    }
}

/// How the product in `folder` came to be; None if it is not there, without a commit if nobody knows. `root` is the project's.
pub fn made(root: &Path, folder: &Path, product: &Product, record: &Record) -> Option<Made> {
    let files: Vec<PathBuf> = product.paths().map(|path| folder.join(path)).collect();
    if !files.iter().all(|file| file.exists()) {
        return None;
    }
    let sheets = files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "csv"));
    let told = sheets.filter_map(|file| Provenance::from_notes(&Sheet::load(file).ok()?.notes)).next();
    // The mark of uncommitted files does not count: a record's is of the product's sources alone, a sheet's of all files.
    let clean = |on: &Provenance| on.commit.trim_end_matches('+').to_owned();
    match (record.of(product.name.as_str()), told) {
        // A sheet of another commit was made by hand since.
        (Some(recorded), told) if told.as_ref().is_none_or(|told| clean(told) == clean(&recorded.on)) => Some(recorded),
        (_, Some(told)) => {
            let words = told.command.split_once(' ').map_or("", |(_, words)| words);
            let commands = vec![format!("lensrunner-lab {}", plain(words))];
            Some(Made { commands, on: Provenance { command: String::new(), ..told }, ..Made::default() })
        }
        _ => {
            let said = git(root, &["log", "-1", "--format=%h %cs", "--abbrev=10", "--", files.first()?.to_str()?]).unwrap_or_default();
            let (commit, date) = said.split_once(' ').unwrap_or_default();
            let on = Provenance { commit: commit.into(), date: date.into(), ..Provenance::default() };
            Some(Made { on, guessed: true, ..Made::default() })
        }
    }
}

/// What a command of git prints in `root`; None where it fails or is not there.
pub(super) fn git(root: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

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

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Standing::Fresh => write!(f, "fresh"),
            Standing::Stale(changed) if changed.len() > 2 => {
                write!(f, "STALE: {} and {} more changed since", changed[..2].join(", "), changed.len() - 2)
            }
            Standing::Stale(changed) => write!(f, "STALE: {} changed since", changed.join(", ")),
            Standing::Uncommitted => write!(f, "STALE: made from uncommitted files"),
            Standing::Unknown => write!(f, "STALE?: git does not know its commit"),
            Standing::Missing => write!(f, "MISSING"),
        }
    }
}

/// How what was made at `commit` from `sources`, paths from `root`, stands to the files there: committed since, changed, or new.
pub fn standing(root: &Path, commit: &str, sources: &[String]) -> Standing {
    if commit.ends_with('+') {
        return Standing::Uncommitted;
    }
    let ask = |arguments: &[&str]| {
        let arguments: Vec<&str> = arguments.iter().copied().chain(sources.iter().map(String::as_str)).collect();
        git(root, &arguments)
    };
    let changed = ask(&["diff", "--name-only", commit, "--"]);
    let new = ask(&["ls-files", "--others", "--exclude-standard", "--"]);
    match (commit.is_empty(), changed, new) {
        (false, Some(changed), Some(new)) => {
            let all: Vec<String> = changed.lines().chain(new.lines()).map(str::to_owned).collect();
            if all.is_empty() { Standing::Fresh } else { Standing::Stale(all) }
        }
        _ => Standing::Unknown,
    }
}
