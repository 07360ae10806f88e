//! What git knows.

use std::path::Path;
use std::process::Command;

/// What a command of git prints in `root`; None where it fails or is not there.
pub fn ask(root: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The same, line by line.
pub fn lines(root: &Path, arguments: &[&str]) -> Option<Vec<String>> {
    Some(ask(root, arguments)?.lines().map(str::to_owned).collect())
}
