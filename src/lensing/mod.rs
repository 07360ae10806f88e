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
use std::path::{Path, PathBuf};
pub use table::slice::Slice;
pub use table::{Scheme, Table, TableError};

use crate::game_files::{self, GameFile};

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

/// The name of the small committed table.
const DEFAULT_PATH: &str = "tables/default.lut";

/// The committed table. Where its file cannot be used, `complain` is told why, and the one inside the program takes its place; where that
/// cannot either, it is baked again.
pub fn default_table_or(complain: impl Fn(&TableError)) -> Table {
    let usable = |file: &GameFile| usable(file, Scheme::Residual, SMALL_NODES);
    let found = usable(&game_files::find(DEFAULT_PATH)).inspect_err(&complain);
    let inside = || game_files::inside(DEFAULT_PATH).and_then(|file| usable(&file).ok());
    let bake = || bake_to(&game_files::place_of(DEFAULT_PATH), Scheme::Residual, SMALL_NODES, &complain, |_| ());
    found.ok().or_else(inside).unwrap_or_else(bake)
}

/// [`default_table_or`] whose complaints go to stderr.
pub fn default_table() -> Table {
    default_table_or(|wrong| eprintln!("lensrunner: {wrong}; another takes its place"))
}

/// The file of another table, `paper-128.lut` or that of the full residual one, or where it is to be written.
pub fn table_file(scheme: Scheme, nodes: usize) -> PathBuf {
    let name = if scheme == Scheme::Residual { "full".into() } else { format!("{}-{nodes}", scheme.name()) };
    game_files::place_of(&format!("tables/{name}.lut"))
}

/// The table of a file, if that can be used and has enough nodes.
fn usable(file: &GameFile, scheme: Scheme, nodes: usize) -> Result<Table, TableError> {
    let wanted = match scheme {
        Scheme::Residual => table::bake::size(nodes).map(|nodes| nodes as u32),
        Scheme::Paper | Scheme::PaperUniform => [nodes as u32; 3],
    };
    let table = Table::read(file, scheme)?;
    let has_fewer = table.size.iter().zip(wanted).any(|(found, wanted)| *found < wanted);
    if has_fewer { Err(TableError::Nodes(file.path.clone(), table.size, wanted)) } else { Ok(table) }
}

/// The table of `path`; where that cannot be used or has fewer nodes, `complain` is told why, the table is baked with `nodes` and written
/// there (`complain` is told if that fails), and never anything drawn from the file.
pub fn load_or_bake(path: &Path, scheme: Scheme, nodes: usize, complain: impl Fn(&TableError), done: impl Fn(f64) + Sync) -> Table {
    usable(&GameFile::at(path), scheme, nodes).inspect_err(&complain).unwrap_or_else(|_| bake_to(path, scheme, nodes, &complain, done))
}

fn bake_to(path: &Path, scheme: Scheme, nodes: usize, complain: impl Fn(&TableError), done: impl Fn(f64) + Sync) -> Table {
    let table = bake(scheme, nodes, done);
    if let Err(wrong) = table.save(path) {
        complain(&wrong);
    }
    table
}
