//! The files of the page: the program, what loads it, how large it is, and all of it compressed.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use wasm_bindgen_cli_support::Bindgen;

/// What a program in WebAssembly is joined to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum For {
    /// A page.
    Page,
    /// Node.
    Node,
}

/// The page's loader asks for the program's size here, for its bar.
const SIZES: &str = "sizes.json";
/// Brotli's effort, of 11, and its window, in bits: more takes minutes and saves little.
const BROTLI: (u32, u32) = (9, 24);

/// Writes `program` and the JavaScript that loads it into `folder`.
pub fn join(program: &Path, target: For, folder: &Path) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    let chosen = match target {
        For::Page => bindgen.web(true),
        For::Node => bindgen.nodejs(true),
    };
    chosen
        .and_then(|bindgen| bindgen.typescript(false).input_path(program).generate(folder))
        .map_err(|error| format!("{}: {error:#}", program.display()))
}

/// Makes the page of `program` and the files in `page` in `folder`.
pub fn page(program: &Path, page: &Path, folder: &Path) -> Result<(), String> {
    let at = |path: &Path| {
        let path = path.display().to_string();
        move |error: std::io::Error| format!("{path}: {error}")
    };
    if folder.exists() {
        // A folder that is none of the page's is left alone.
        if !folder.join(SIZES).is_file() {
            return Err(format!("{}: it is there, and no page that was made here; remove it first", folder.display()));
        }
        fs::remove_dir_all(folder).map_err(at(folder))?;
    }
    fs::create_dir_all(folder).map_err(at(folder))?;
    // First, so that what is stopped half way is replaced by the next.
    let sizes = folder.join(SIZES);
    fs::write(&sizes, "{}").map_err(at(&sizes))?;
    join(program, For::Page, folder)?;
    for file in files(page).map_err(at(page))? {
        fs::copy(&file, folder.join(file.file_name().unwrap_or_default())).map_err(at(&file))?;
    }
    let mut found = serde_json::Map::new();
    for file in files(folder).map_err(at(folder))?.into_iter().filter(|file| *file != sizes) {
        let bytes = fs::read(&file).map_err(at(&file))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        found.insert(name.clone(), bytes.len().into());
        let to = folder.join(format!("{name}.br"));
        let written = fs::File::create(&to).and_then(|file| {
            let mut out = brotli::CompressorWriter::new(file, 1 << 16, BROTLI.0, BROTLI.1);
            out.write_all(&bytes)?;
            out.flush()
        });
        written.map_err(at(&to))?;
    }
    fs::write(&sizes, serde_json::Value::Object(found).to_string()).map_err(at(&sizes))
}

/// The files in a folder, by name.
fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder)?.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    found.retain(|path| path.is_file());
    found.sort();
    Ok(found)
}
