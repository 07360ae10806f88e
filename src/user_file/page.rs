//! A user's files in a page: the texts that the browser keeps for it, by their paths.

use std::io;
use std::path::Path;

use web_sys::Storage;

use super::FileFault;

/// What the browser keeps; fails where it keeps nothing, as in a private window of some.
fn kept() -> io::Result<Storage> {
    let refused = || io::Error::new(io::ErrorKind::PermissionDenied, "this browser keeps nothing for the page");
    web_sys::window().and_then(|window| window.local_storage().ok().flatten()).ok_or_else(refused)
}

fn text(path: &Path) -> io::Result<Option<String>> {
    kept()?.get_item(&path.to_string_lossy()).map_err(|_| io::Error::other("this browser does not give it"))
}

pub(super) fn read(path: &Path, most: u64) -> Result<Vec<u8>, FileFault> {
    let text = text(path)?.ok_or(io::ErrorKind::NotFound).map_err(io::Error::from)?;
    if text.len() as u64 > most { Err(FileFault::TooLong { bytes: text.len() as u64, most }) } else { Ok(text.into_bytes()) }
}

/// The browser writes all of it or nothing.
pub(super) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let text = std::str::from_utf8(bytes).map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no text"))?;
    let full = |_| io::Error::new(io::ErrorKind::StorageFull, "the browser has no more room for this page");
    kept()?.set_item(&path.to_string_lossy(), text).map_err(full)
}

pub(super) fn exists(path: &Path) -> bool {
    text(path).is_ok_and(|text| text.is_some())
}

pub(super) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    let text = text(from)?.ok_or(io::ErrorKind::NotFound)?;
    write(to, text.as_bytes())?;
    kept()?.remove_item(&from.to_string_lossy()).map_err(|_| io::Error::other("this browser does not forget it"))
}
