//! A moment of a flight in a file: in the text that a PNG carries, or as a file of its own, which holds that text alone.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::text::{MOST_BYTES, MOST_PICTURE, TextError, read_text};
use crate::user_file;

/// What the text of a moment begins with.
const BEGINNING: &[u8] = b"snapshot = ";

/// Whether a file is a moment of its own: no picture, and no scene.
pub fn is_moment(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = user_file::open(path, MOST_PICTURE).map(|(file, _)| file.take(BEGINNING.len() as u64).read_to_end(&mut start));
    matches!(read, Ok(Ok(_))) && start == BEGINNING
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
    user_file::read_text(path, MOST_BYTES).map_err(|fault| TextError::Read { path: path.to_path_buf(), source: fault.into() })
}
