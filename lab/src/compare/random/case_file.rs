//! A case in a file: a scene file whose first comment lines say size and T, where it comes from, and what was wrong.

use std::path::{Path, PathBuf};

use lensrunner::judge::case::{Case, TraceError};
use lensrunner::scene::{self, GameConfig, Scene, SceneError};
use lensrunner::user_file::{FileFault, MOST_TEXT, read_text};

/// A scene with the size of its picture and T.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseFile {
    /// What the comment lines say besides, a line each.
    pub notes: Vec<String>,
    /// The text of the scene.
    pub text: String,
    /// T in r_s/c.
    pub at: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// The size of a picture whose file says none, in pixels.
pub const SIZE: [u32; 2] = [160, 90];

impl CaseFile {
    /// Reads the text of a file; `file` is named where something is wrong. Without a size it is 160x90, without a T 0.
    pub fn parse(file: &Path, text: &str) -> Result<CaseFile, TraceError> {
        let mut case = CaseFile { notes: Vec::new(), text: String::new(), at: 0.0, size: SIZE };
        let mut lines = text.lines().peekable();
        let mut number = 0;
        while let Some(line) = lines.next_if(|line| line.starts_with('#')) {
            number += 1;
            let note = line.trim_start_matches('#').trim();
            let wrong = |what: String| TraceError::Input(format!("{}:{number}: {what}", file.display()));
            if let Some(size) = note.strip_prefix("size:") {
                case.size = scene::picture_size(size.trim()).map_err(wrong)?;
            } else if let Some(at) = note.strip_prefix("T:") {
                let time = at.trim().parse().ok().filter(|time| (0.0..=1e5).contains(time));
                case.at = time.ok_or_else(|| wrong(format!("T: `{}` must be a number from 0 to 100000 r_s/c", at.trim())))?;
            } else if !note.is_empty() {
                case.notes.push(note.to_owned());
            }
        }
        case.text = lines.collect::<Vec<_>>().join("\n").trim_start().to_owned() + "\n";
        Ok(case)
    }

    /// Reads a file.
    pub fn load(file: &Path) -> Result<CaseFile, TraceError> {
        let read = |fault: FileFault| SceneError::Read { path: file.to_path_buf(), source: fault.into() };
        CaseFile::parse(file, &read_text(file, MOST_TEXT).map_err(read)?)
    }

    /// The text of the file.
    pub fn to_text(&self) -> String {
        let [width, height] = self.size;
        let notes: String = self.notes.iter().map(|note| format!("# {note}\n")).collect();
        format!("{notes}# size: {width}x{height}\n# T: {}\n\n{}\n", self.at, self.text.trim())
    }

    /// The case for the judge; an error names what is wrong in the scene, called `file`, or that its camera sees nothing.
    pub fn case(&self, file: &Path, config: &GameConfig) -> Result<Case, TraceError> {
        let scene = Scene::from_toml(file, &self.text).map_err(SceneError::Invalid)?;
        let case = Case::new(scene, config.clone(), self.at, self.size);
        case.check()?;
        Ok(case)
    }
}

/// The case files among `paths`: each file, and those of each folder that end in .toml, by name.
pub fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, TraceError> {
    let mut found = Vec::new();
    for path in paths {
        if !path.is_dir() {
            found.push(path.clone());
            continue;
        }
        let entries = std::fs::read_dir(path).map_err(|source| SceneError::Read { path: path.clone(), source })?;
        let mut inside: Vec<PathBuf> =
            entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
        inside.sort();
        found.extend(inside);
    }
    Ok(found)
}
