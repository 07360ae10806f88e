//! A moment of a flight in a file: in the text that a PNG carries, or as a file of its own, which holds that text alone.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::chunk::{MOST_BYTES, TextError, read_text};

/// What the text of a moment begins with.
const BEGINNING: &[u8] = b"snapshot = ";

/// Whether a file is a moment of its own: no picture, and no scene.
pub fn is_moment(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(BEGINNING.len() as u64).read_to_end(&mut start));
    read.is_ok() && start == BEGINNING
}

/// The file of the moment that a command was given: as `--from`, or in the place of a scene.
pub fn moment_of(scene: Option<&str>, from: Option<&Path>) -> Option<PathBuf> {
    from.or_else(|| scene.map(Path::new).filter(|scene| is_moment(scene))).map(Path::to_path_buf)
}

/// The text of the moment in a file, which may be a PNG that carries one.
pub fn read_moment(path: &Path) -> Result<String, TextError> {
    if !is_moment(path) {
        return read_text(path);
    }
    let failed = |source| TextError::Read { path: path.to_path_buf(), source };
    let mut text = String::new();
    File::open(path).and_then(|file| file.take(MOST_BYTES).read_to_string(&mut text)).map_err(failed)?;
    Ok(text)
}
