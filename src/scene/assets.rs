//! Where the files that come with the game lie.

use std::path::{Path, PathBuf};

/// The folder `assets/`: in the current folder, beside or above the program, or where the program was built.
pub fn assets_folder() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    std::iter::once(PathBuf::from("."))
        .chain(program.ancestors().skip(1).map(Path::to_path_buf))
        .chain(std::iter::once(PathBuf::from(env!("CARGO_MANIFEST_DIR"))))
        .map(|folder| folder.join("assets"))
        .find(|folder| folder.join("scenes").is_dir())
        .unwrap_or_else(|| PathBuf::from("assets"))
}
