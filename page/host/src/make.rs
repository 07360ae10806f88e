//! The files of the page: the programs, what loads them, how large they are, and all of it compressed.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::json;
use wasm_bindgen_cli_support::Bindgen;

/// What a program in WebAssembly is joined to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum For {
    /// A page.
    Page,
    /// Node.
    Node,
}

/// What a page is made of.
#[derive(clap::Args)]
pub struct Parts {
    /// The game.
    #[arg(long)]
    game: PathBuf,
    /// Its sound.
    #[arg(long)]
    sound: PathBuf,
    /// The table of lensing.
    #[arg(long)]
    table: PathBuf,
    /// The icon.
    #[arg(long)]
    icon: PathBuf,
    /// A folder of files that are taken as they are.
    #[arg(long)]
    page: PathBuf,
    /// The script that has the game write what is worked out when the page is made, for Node.
    #[arg(long)]
    prepare: PathBuf,
}

/// The page's loader and its service worker ask for the files' names and sizes here.
const LIST: &str = "files.json";
/// What the loader loads, with a bar.
const LOADED: [&str; 3] = ["lensrunner_page_bg.wasm", "table.bin", "shaders.json"];
/// The service worker, in which [`VERSION`] is put.
const KEEPER: &str = "keep.js";
const VERSION: &str = "VERSION";
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
        .and_then(|bindgen| {
            bindgen.typescript(false).remove_name_section(true).remove_producers_section(true).input_path(program).generate(folder)
        })
        .map_err(|error| format!("{}: {error:#}", program.display()))
}

fn at(path: &Path) -> impl Fn(std::io::Error) -> String {
    let path = path.display().to_string();
    move |error| format!("{path}: {error}")
}

/// Makes the page in `folder`.
pub fn page(parts: &Parts, folder: &Path) -> Result<(), String> {
    let list = folder.join(LIST);
    if folder.exists() {
        // A folder that is none of the page's is left alone.
        if !list.is_file() {
            return Err(format!("{}: it is there, and no page that was made here; remove it first", folder.display()));
        }
        fs::remove_dir_all(folder).map_err(at(folder))?;
    }
    fs::create_dir_all(folder).map_err(at(folder))?;
    // First, so that what is stopped half way is replaced by the next.
    fs::write(&list, "{}").map_err(at(&list))?;
    join(&parts.game, For::Page, folder)?;
    join(&parts.sound, For::Page, folder)?;
    // The thread for sound needs the program alone.
    let loader = folder.join("lensrunner_sound.js");
    fs::remove_file(&loader).map_err(at(&loader))?;
    prepare(parts, folder)?;
    for file in files(&parts.page).map_err(at(&parts.page))? {
        fs::copy(&file, folder.join(file.file_name().unwrap_or_default())).map_err(at(&file))?;
    }
    fs::copy(&parts.icon, folder.join("icon.png")).map_err(at(&parts.icon))?;
    let mut sizes = serde_json::Map::new();
    let mut sum = 0;
    for file in files(folder).map_err(at(folder))?.into_iter().filter(|file| *file != list) {
        let bytes = fs::read(&file).map_err(at(&file))?;
        sum = crc32(sum, &bytes);
        sizes.insert(file.file_name().unwrap_or_default().to_string_lossy().into_owned(), bytes.len().into());
    }
    // Other files are another version.
    let keeper = folder.join(KEEPER);
    let text = fs::read_to_string(&keeper).map_err(at(&keeper))?.replace(VERSION, &format!("{sum:08x}"));
    fs::write(&keeper, text).map_err(at(&keeper))?;
    sizes.remove(KEEPER);
    let loaded: serde_json::Map<_, _> = LOADED.iter().filter_map(|name| Some(((*name).to_owned(), sizes.get(*name)?.clone()))).collect();
    fs::write(&list, json!({ "files": sizes, "loaded": loaded }).to_string()).map_err(at(&list))?;
    files(folder).map_err(at(folder))?.iter().try_for_each(|file| compress(file))
}

/// Has the game write its shaders, and the table packed.
fn prepare(parts: &Parts, folder: &Path) -> Result<(), String> {
    let done = Command::new("node").arg(&parts.prepare).arg(folder).arg(&parts.table).status();
    match done {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{}: it ended with {status}", parts.prepare.display())),
        Err(error) => Err(format!("Node cannot be started ({error}): install it from https://nodejs.org")),
    }
}

/// Writes a file compressed beside it.
fn compress(file: &Path) -> Result<(), String> {
    let bytes = fs::read(file).map_err(at(file))?;
    let mut to = file.as_os_str().to_owned();
    to.push(".br");
    let to = PathBuf::from(to);
    let written = fs::File::create(&to).and_then(|file| {
        let mut out = brotli::CompressorWriter::new(file, 1 << 16, BROTLI.0, BROTLI.1);
        out.write_all(&bytes)?;
        out.flush()
    });
    written.map_err(at(&to))
}

/// CRC-32 of `bytes` after those of which it is `sum`.
fn crc32(sum: u32, bytes: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(sum);
    hasher.update(bytes);
    hasher.finalize()
}

/// The files in a folder, by name.
fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder)?.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    found.retain(|path| path.is_file());
    found.sort();
    Ok(found)
}
