//! What is known of a product as it lies in a folder: when, where and how it was made.
//!
//! The file `products.toml` of the folder says it of all that `lab/run all` made. A chart's own CSV says it of what was made by hand since,
//! and of the rest git knows when it was committed.

use std::path::{Path, PathBuf};

use super::{Product, git};
use crate::chart::{Provenance, Sheet};

/// The file's name.
pub const FILE: &str = "products.toml";

/// How a product came to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Made {
    /// The commands, without where they write to.
    pub commands: Vec<String>,
    /// Commit, machine, driver, date; its command is left empty.
    pub on: Provenance,
    /// How long it took, in seconds; 0 where that is not known.
    pub seconds: f64,
    /// Whether it says so itself. Else it is the commit that the file came with, which it cannot be younger than.
    pub told: bool,
}

/// Why the record cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file cannot be read or written.
    #[error("{}: cannot be read or written: {}", .0.display(), .1)]
    Io(PathBuf, std::io::Error),
    /// It is no TOML.
    #[error("{}: {}", .0.display(), .1)]
    Toml(PathBuf, String),
}

/// A command without its program's path and without where it writes to.
pub fn plain(arguments: &str) -> String {
    let mut words = Vec::new();
    let mut all = arguments.split_whitespace();
    while let Some(word) = all.next() {
        match word {
            "-o" | "--output" | "--collect" | "--record" => drop(all.next()),
            word => words.push(word),
        }
    }
    words.join(" ")
}

/// What `folder` records of its products.
#[derive(Clone, Debug, Default)]
pub struct Record {
    path: PathBuf,
    table: toml::Table,
}

impl Record {
    /// Reads it; an empty one where there is none.
    pub fn load(folder: &Path) -> Result<Record, RecordError> {
        let path = folder.join(FILE);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(RecordError::Io(path, error)),
        };
        let table = text.parse().map_err(|error: toml::de::Error| RecordError::Toml(path.clone(), error.to_string()))?;
        Ok(Record { path, table })
    }

    /// What it says of a product.
    pub fn of(&self, name: &str) -> Option<Made> {
        let entry = self.table.get(name)?.as_table()?;
        let text = |key: &str| entry.get(key).and_then(toml::Value::as_str).unwrap_or_default().to_owned();
        let commands = entry.get("commands").and_then(toml::Value::as_array).into_iter().flatten();
        Some(Made {
            commands: commands.filter_map(|command| Some(command.as_str()?.to_owned())).collect(),
            on: Provenance {
                processor: text("processor"),
                adapter: text("adapter"),
                date: text("date"),
                commit: text("commit"),
                command: String::new(),
            },
            seconds: entry.get("seconds").and_then(toml::Value::as_float).unwrap_or_default(),
            told: true,
        })
    }

    /// Records a product and writes the file.
    pub fn put(&mut self, name: &str, made: &Made) -> Result<(), RecordError> {
        let mut entry = toml::Table::new();
        entry.insert("commands".into(), made.commands.iter().cloned().map(toml::Value::String).collect::<Vec<_>>().into());
        let on = &made.on;
        for (key, text) in [("commit", &on.commit), ("date", &on.date), ("processor", &on.processor), ("adapter", &on.adapter)] {
            entry.insert(key.into(), text.clone().into());
        }
        entry.insert("seconds".into(), (made.seconds * 10.0).round().max(1.0).div_euclid(10.0).into());
        self.table.insert(name.into(), entry.into());
        let head = "# Written by `lab/run all`: how each product of this folder was made.\n\n";
        let wrong = |error| RecordError::Io(self.path.clone(), error);
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder).map_err(wrong)?;
        }
        std::fs::write(&self.path, format!("{head}{}", self.table)).map_err(wrong)
    }
}

/// How the product in `folder` came to be; None if it is not there, without a commit if nobody knows. `root` is the project's.
pub fn made(root: &Path, folder: &Path, product: &Product, record: &Record) -> Option<Made> {
    let files: Vec<PathBuf> = product.paths().map(|path| folder.join(path)).collect();
    if !files.iter().all(|file| file.exists()) {
        return None;
    }
    let recorded = record.of(product.name);
    let sheets = files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "csv"));
    let told = sheets.filter_map(|file| Provenance::told(&Sheet::load(file).ok()?.notes)).next();
    match (recorded, told) {
        // A sheet of another commit was made by hand since.
        (Some(recorded), Some(told)) if clean(&told.commit) != clean(&recorded.on.commit) => Some(by_hand(told)),
        (Some(recorded), _) => Some(recorded),
        (None, Some(told)) => Some(by_hand(told)),
        (None, None) => {
            let said = git::ask(root, &["log", "-1", "--format=%h %cs", "--abbrev=10", "--", files.first()?.to_str()?]).unwrap_or_default();
            let (commit, date) = said.split_once(' ').unwrap_or_default();
            Some(Made { on: Provenance { commit: commit.into(), date: date.into(), ..Provenance::default() }, ..Made::default() })
        }
    }
}

/// The commit without the mark of uncommitted files: a record's is of the product's sources alone, a sheet's of all files.
fn clean(commit: &str) -> &str {
    commit.trim_end_matches('+')
}

fn by_hand(told: Provenance) -> Made {
    let mut words = told.command.split_whitespace();
    // Charts were once commands of the game.
    words.next();
    let command = format!("{} {}", super::Program::Lab.name(), plain(&words.collect::<Vec<_>>().join(" ")));
    Made { commands: vec![command], on: Provenance { command: String::new(), ..told }, seconds: 0.0, told: true }
}
