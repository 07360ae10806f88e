//! Files of the user: written whole or not at all, set aside when they are damaged.

use std::io;
use std::path::{Path, PathBuf};

use crate::user_file;

/// Writes a file so that it is either the old one or the new, whatever happens.
pub fn write_whole(file: &Path, text: &str) -> io::Result<()> {
    let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", file.display()));
    user_file::write_whole(file, text.as_bytes()).map_err(named)
}

/// Renames a damaged file so that the next can be written; returns its new name, or None if it stays where it is.
pub fn set_aside(file: &Path) -> Option<PathBuf> {
    let stem = file.file_stem()?.to_string_lossy().into_owned();
    let aside = (1..10_000).map(|n| file.with_file_name(format!("{stem}.damaged-{n}.toml"))).find(|aside| !user_file::exists(aside))?;
    user_file::rename(file, &aside).ok().map(|()| aside)
}
