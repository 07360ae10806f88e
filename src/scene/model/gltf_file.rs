//! The file of a glTF model and the files that it names, checked before anything is made of them.

use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

use data_encoding::BASE64;
use gltf::json;

use super::accessors;
use super::error::ModelError;
use crate::game_files::GameFile;
use crate::user_file::{self, FileFault, short};

/// The most bytes of a model's file and of all that it names, together.
const MOST_BYTES: u64 = 256 << 20;
/// The most entries of its JSON: what takes memory when it is read.
const MOST_ENTRIES: usize = 500_000;

/// A document whose accessors lie inside their buffers, and the buffers.
pub struct GltfFile {
    /// What it says.
    pub document: gltf::Document,
    /// Bytes of each buffer, at least as many as the document says.
    pub buffers: Vec<Vec<u8>>,
    folder: PathBuf,
    /// Bytes that may still be read.
    left: u64,
}

/// Reads and checks a `.glb` or `.gltf` file, and the buffers that it names.
pub fn read(file: &GameFile) -> Result<GltfFile, ModelError> {
    let path = &file.path;
    let unusable = |reason: String| ModelError::Unusable { path: path.clone(), reason };
    let bytes = file.read(MOST_BYTES).map_err(|source| ModelError::Read { path: path.clone(), source })?;
    check_outline(&bytes).map_err(unusable)?;
    let failed = |source: gltf::Error| match source {
        gltf::Error::Validation(wrong) => unusable(all_wrong(&wrong)),
        source => ModelError::Gltf { path: path.clone(), source },
    };
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(&bytes).map_err(failed)?;
    // The reader's own checks take these to be there.
    accessors::check_positions(document.as_json()).map_err(unusable)?;
    let document = gltf::Document::from_json(document.into_json()).map_err(failed)?;
    let left = MOST_BYTES - bytes.len() as u64;
    drop(bytes);
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    accessors::check(document.as_json()).map_err(unusable)?;
    let mut file = GltfFile { document, buffers: Vec::new(), folder, left };
    file.read_buffers(blob).map_err(unusable)?;
    Ok(file)
}

/// The JSON of a binary file, whose header and chunks are checked (glTF 2.0 specification, section 4.4).
fn binary_json(bytes: &[u8]) -> Result<&[u8], String> {
    const HEADER: usize = 12;
    const CHUNK: usize = 8;
    let there = bytes.len();
    let word = |at: usize| bytes.get(at..at + 4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]) as usize);
    let cut = |place: &str| format!("{place}: the file ends in it, at byte {there}");
    let (Some(version), Some(length)) = (word(4), word(8)) else { return Err(cut("header")) };
    if version != 2 {
        return Err(format!("header: version {version}, allowed 2"));
    }
    if length < HEADER + CHUNK {
        return Err(format!("header: length {length}, allowed {} or more", HEADER + CHUNK));
    }
    if length > there {
        return Err(format!("header: length {length}, but the file ends after {there} bytes"));
    }
    let mut json = None;
    let mut start = HEADER;
    for (name, kind) in [("JSON chunk", b"JSON"), ("binary chunk", b"BIN\0")] {
        if start == length && json.is_some() {
            break;
        }
        let (Some(chunk), Some(found)) = (word(start), bytes.get(start + 4..start + CHUNK)) else { return Err(cut(name)) };
        if found != kind {
            return Err(format!("{name}, byte {}: its kind is {:?}, allowed {:?}", start + 4, text(found), text(kind)));
        }
        let content = start + CHUNK;
        if chunk > length.saturating_sub(content) {
            return Err(format!("{name}, byte {start}: length {chunk}, allowed 0 to {}", length.saturating_sub(content)));
        }
        json = json.or(bytes.get(content..content + chunk));
        start = content + chunk;
    }
    Ok(json.unwrap_or_default())
}

fn text(bytes: &[u8]) -> String {
    short(&String::from_utf8_lossy(bytes))
}

/// What a binary file says of its parts, and how much memory its JSON would take.
fn check_outline(bytes: &[u8]) -> Result<(), String> {
    let is_text = bytes.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{');
    if !is_text && !bytes.starts_with(b"glTF") {
        return Err("no glTF: it begins neither with the letters glTF nor with {".into());
    }
    let text = if is_text { bytes } else { binary_json(bytes)? };
    let (mut entries, mut is_string, mut is_escaped) = (0, false, false);
    for byte in text {
        if is_string {
            is_string = is_escaped || *byte != b'"';
            is_escaped = *byte == b'\\' && !is_escaped;
        } else {
            is_string = *byte == b'"';
            entries += usize::from(matches!(byte, b'{' | b'[' | b','));
        }
    }
    if entries > MOST_ENTRIES { Err(format!("its JSON has {entries} entries, allowed are {MOST_ENTRIES}")) } else { Ok(()) }
}

/// The first faults that the reader found, and how many more there are.
fn all_wrong(wrong: &[(json::Path, json::validation::Error)]) -> String {
    const FIRST: usize = 3;
    let mut text = String::new();
    for (k, (place, error)) in wrong.iter().take(FIRST).enumerate() {
        // Writing to a text does not fail.
        _ = write!(text, "{}{}: {error}", if k == 0 { "" } else { "; " }, short(place.as_str()));
    }
    if wrong.len() > FIRST {
        _ = write!(text, "; and {} more", wrong.len() - FIRST);
    }
    text
}

impl GltfFile {
    fn read_buffers(&mut self, mut blob: Option<Vec<u8>>) -> Result<(), String> {
        let told: Vec<(Option<String>, u64)> =
            self.document.as_json().buffers.iter().map(|buffer| (buffer.uri.clone(), buffer.byte_length.0)).collect();
        for (k, (uri, length)) in told.into_iter().enumerate() {
            let place = format!("buffers[{k}]");
            let bytes = match uri {
                Some(uri) => self.fetch(&uri).map_err(|wrong| format!("{place}.uri = {:?}: {wrong}", short(&uri)))?,
                None => blob.take().ok_or_else(|| format!("{place} has neither a uri nor a binary part"))?,
            };
            if (bytes.len() as u64) < length {
                return Err(format!("{place}.byteLength = {length}, but there are {} bytes", bytes.len()));
            }
            self.buffers.push(bytes);
        }
        Ok(())
    }

    /// The bytes at an address in the document: in itself, or in a regular file beside the model.
    pub fn fetch(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, text) = data.split_once(";base64,").ok_or("must hold its data as ;base64,")?;
            return BASE64.decode(text.as_bytes()).map_err(|error| error.to_string());
        }
        let name = percent_decoded(uri).ok_or("is no address")?;
        let is_beside = Path::new(&name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if name.is_empty() || name.contains([':', '\\']) || name.starts_with('/') || !is_beside {
            return Err("allowed are data: and files beside the model, without a scheme, a leading / and ..".into());
        }
        let bytes = user_file::read(&self.folder.join(name), self.left).map_err(|fault| match fault {
            FileFault::TooLong { bytes, .. } => {
                format!("it has {bytes} bytes, allowed are {MOST_BYTES} of the model and all its files together")
            }
            fault => fault.to_string(),
        })?;
        self.left -= bytes.len() as u64;
        Ok(bytes)
    }

    /// The bytes of a buffer's part.
    pub fn view(&self, view: &gltf::buffer::View<'_>) -> Option<&[u8]> {
        self.buffers.get(view.buffer().index())?.get(view.offset()..view.offset().checked_add(view.length())?)
    }
}

/// An address with its `%20` replaced; None where that is no text.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        bytes.push(if first == b'%' {
            let digits = std::str::from_utf8(rest.get(..2)?).ok()?;
            rest = &rest[2..];
            u8::from_str_radix(digits, 16).ok()?
        } else {
            first
        });
    }
    String::from_utf8(bytes).ok()
}
