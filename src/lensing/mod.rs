//! The tables: from (r, Φ, L) to the direction in which a point is seen and the time its light takes.
//!
//! `closed_form` is right near the camera and where the field is weak; `table` holds what is left, over coordinates that open up the
//! Einstein ring, the horizon and the surroundings of the camera (`table::grid`): how it is baked, filed and cut at one camera radius for a
//! frame. `lookup` evaluates it in f32 as the GPU does, with `lookup::inside` for camera and point both inside the horizon. `paper` is the
//! method of Yamashita 2012, for comparison, and `score` measures the error of either. `methods` is the methods of projection by name,
//! `project` the command that asks one, `adversarial` the points where they break.

pub mod adversarial;
pub mod closed_form;
pub mod command;
pub mod lookup;
pub mod methods;
pub mod paper;
pub mod paper_format;
pub mod project;
pub mod score;
pub mod table;

pub use closed_form::{double, single};
pub use lookup::{LensRay, lens_lookup, lens_lookup_aged, lens_lookup_at};
use std::path::Path;
pub use table::slice::Slice;
pub use table::{Scheme, Table, TableError};

/// The camera radii of a full-size bake (`table::bake::size`).
pub const FULL_NODES: usize = 112;
/// The camera radii of the small committed table.
pub const SMALL_NODES: usize = 96;

/// Bakes a table of `scheme` with `nodes` (at least 5) along each axis; `done` is called with finished shares that add up to 1.
pub fn bake(scheme: Scheme, nodes: usize, done: impl Fn(f64) + Sync) -> Table {
    match scheme {
        Scheme::Residual => table::bake::residual_table(nodes, done),
        Scheme::Paper | Scheme::PaperUniform => paper::bake(scheme, nodes, done),
    }
}

/// Where the small committed table lies, from the project's folder.
pub const DEFAULT_PATH: &str = "tables/default.lut";

/// The committed table's file: under the folder that the program is started in, else where the program was built, else beside the program.
pub fn default_file() -> std::path::PathBuf {
    let beside = std::env::current_exe().ok().and_then(|program| program.parent().map(std::path::Path::to_path_buf));
    let folders = [Some(".".into()), Some(std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"))), beside];
    let mut files = folders.into_iter().flatten().map(|folder| folder.join(DEFAULT_PATH));
    let first = files.next().unwrap_or_else(|| DEFAULT_PATH.into());
    if first.is_file() {
        return first;
    }
    // Where there is none it is baked to the first folder that has a place for it.
    let places: Vec<_> = std::iter::once(first.clone()).chain(files).collect();
    let has_place = |file: &&std::path::PathBuf| file.parent().is_some_and(std::path::Path::is_dir);
    places.iter().find(|file| file.is_file()).or_else(|| places.iter().find(has_place)).cloned().unwrap_or(first)
}

/// The committed table; where its file cannot be used, says why on stderr and bakes it again.
pub fn default_table() -> Table {
    let complain = |wrong: &TableError| eprintln!("lensrunner: {wrong}; baking the table again");
    load_or_bake(&default_file(), Scheme::Residual, SMALL_NODES, complain, |_| ())
}

/// The table of `path`; where that cannot be used or has fewer nodes, `complain` is told why, the table is baked with `nodes` and written there
/// (`complain` is told if that fails), and never anything drawn from the file.
pub fn load_or_bake(path: &Path, scheme: Scheme, nodes: usize, complain: impl Fn(&TableError), done: impl Fn(f64) + Sync) -> Table {
    let wanted = match scheme {
        Scheme::Residual => table::bake::size(nodes).map(|nodes| nodes as u32),
        Scheme::Paper | Scheme::PaperUniform => [nodes as u32; 3],
    };
    let loaded = Table::load(path, scheme).and_then(|table| {
        let has_fewer = table.size.iter().zip(wanted).any(|(found, wanted)| *found < wanted);
        if has_fewer { Err(TableError::Nodes(path.to_path_buf(), table.size, wanted)) } else { Ok(table) }
    });
    let wrong = match loaded {
        Ok(table) => return table,
        Err(wrong) => wrong,
    };
    complain(&wrong);
    let table = bake(scheme, nodes, done);
    if let Err(wrong) = table.save(path) {
        complain(&wrong);
    }
    table
}
