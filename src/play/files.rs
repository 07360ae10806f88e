//! Files of the user: written whole or not at all, set aside when they are damaged.

use std::io;
use std::path::{Path, PathBuf};

/// Writes a file so that it is either the old one or the new, whatever happens.
pub fn write_whole(file: &Path, text: &str) -> io::Result<()> {
    let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", file.display()));
    let beside = file.with_extension("new");
    std::fs::create_dir_all(file.parent().unwrap_or(Path::new("."))).map_err(named)?;
    std::fs::write(&beside, text).map_err(named)?;
    std::fs::rename(&beside, file).map_err(named)
}

/// Renames a damaged file so that the next can be written; returns its new name, or None if it stays where it is.
pub fn set_aside(file: &Path) -> Option<PathBuf> {
    let stem = file.file_stem()?.to_string_lossy().into_owned();
    let aside = (1..10_000).map(|n| file.with_file_name(format!("{stem}.damaged-{n}.toml"))).find(|aside| !aside.exists())?;
    std::fs::rename(file, &aside).ok().map(|()| aside)
}
