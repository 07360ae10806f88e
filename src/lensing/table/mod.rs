//! A table and its file.
//!
//! Little-endian: magic `LENSTAB\n`, version u32, scheme as 16 bytes of text, three sizes u32, six ranges f64 (L, r, Φ), the units
//! as 32 bytes of text, the number of values u64, the values f32, and the CRC-32 of all that comes before it.

pub mod bake;
pub mod grid;
pub mod packed;
pub mod slice;
pub mod spline;

use std::path::{Path, PathBuf};

use crate::game_files::GameFile;
use crate::user_file::{self, FileFault};

/// The first bytes of a table file.
const MAGIC: &[u8; 8] = b"LENSTAB\n";
/// The version of the layout and of the formulas that the values belong to: raised whenever either changes.
pub const VERSION: u32 = 4;
/// The units of the ranges and of what is looked up.
const UNITS: &str = "r_s; r_s/c; rad";
/// Bytes before the values.
const HEADER: usize = 8 + 4 + 16 + 12 + 48 + 32 + 8;
/// The most nodes along an axis.
const MOST_NODES: u32 = 4096;
/// The most bytes of a file: some times the largest table that `bake` makes.
const MOST_BYTES: u64 = 256 << 20;
/// The largest value, far more than any delay in r_s/c from the farthest point.
const MOST_VALUE: f32 = 1e6;

/// What a table stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Residuals against closed forms, as B-spline coefficients: the default.
    Residual,
    /// Yamashita 2012, the meshes of equations 3 to 7.
    Paper,
    /// Yamashita 2012, uniform meshes.
    PaperUniform,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Scheme; 3] = [Scheme::Residual, Scheme::Paper, Scheme::PaperUniform];

    /// The name on the command line and in the file.
    pub fn name(self) -> &'static str {
        match self {
            Scheme::Residual => "residual",
            Scheme::Paper => "paper",
            Scheme::PaperUniform => "paper-uniform",
        }
    }

    /// The scheme of that name.
    pub fn named(name: &str) -> Option<Scheme> {
        Scheme::ALL.into_iter().find(|s| s.name() == name)
    }

    /// How many values a table of this size holds, if the size is within reason.
    fn count(self, [x, y, z]: [u32; 3]) -> Option<usize> {
        if [x, y, z].iter().any(|n| !(5..=MOST_NODES).contains(n)) {
            return None;
        }
        let [x, y, z] = [x as usize, y as usize, z as usize];
        Some(match self {
            Scheme::Residual => (x + 2) * (y + 2) * (z + 2) * 3,
            // These have as many along each axis.
            _ if x != y || y != z => return None,
            Scheme::Paper | Scheme::PaperUniform => x * y * z * crate::lensing::paper_format::CHANNELS,
        })
    }

    /// The ranges of L, r and Φ.
    fn ranges(self) -> [f64; 6] {
        match self {
            Scheme::Residual => {
                let [far, near] = crate::lensing::double::POINT_RANGE;
                let [low, high] = grid::CAMERA_RANGE;
                [low, high, 1.0 / near, 1.0 / far, 0.0, crate::lensing::double::LARGEST_SWEEP]
            }
            _ => crate::lensing::paper_format::RANGES,
        }
    }
}

/// A baked table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What is stored.
    pub scheme: Scheme,
    /// Nodes along r, Φ and L.
    pub size: [u32; 3],
    /// Residual: the three residuals at (nx + 2) × (ny + 2) × (nz + 2) coefficients, r fastest. Paper: see `paper`.
    pub values: Vec<f32>,
}

/// Why a table file cannot be used.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum TableError {
    #[error("{}: there is no such table", .0.display())]
    Missing(PathBuf),
    #[error("{}: cannot be read or written: {}", .0.display(), .1)]
    Io(PathBuf, std::io::Error),
    #[error("{}: not a lensing table", .0.display())]
    Magic(PathBuf),
    #[error("{}: version {}, this program reads {}", .0.display(), .1, VERSION)]
    Version(PathBuf, u32),
    #[error("{}: cut short: {} bytes of {}", .0.display(), .1, .2)]
    Short(PathBuf, usize, usize),
    #[error("{}: damaged, its checksum is wrong", .0.display())]
    Checksum(PathBuf),
    #[error("{}: holds scheme \"{}\", wanted \"{}\"", .0.display(), .1, .2)]
    Scheme(PathBuf, String, &'static str),
    #[error("{}: its sizes or ranges are not this program's", .0.display())]
    Layout(PathBuf),
    #[error("{}: {}", .0.display(), .1)]
    File(PathBuf, FileFault),
    #[error("{}: value {} is {}, allowed are numbers from -{MOST_VALUE} to {MOST_VALUE}", .0.display(), .1, .2)]
    Value(PathBuf, usize, f32),
    #[error("{}: has {:?} nodes along r, Φ and L, wanted are at least {:?}", .0.display(), .1, .2)]
    Nodes(PathBuf, [u32; 3], [u32; 3]),
}

impl Table {
    /// The table as the bytes of its file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + 4 * self.values.len() + 4);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&padded::<16>(self.scheme.name()));
        self.size.iter().for_each(|n| bytes.extend_from_slice(&n.to_le_bytes()));
        self.scheme.ranges().iter().for_each(|v| bytes.extend_from_slice(&v.to_le_bytes()));
        bytes.extend_from_slice(&padded::<32>(UNITS));
        bytes.extend_from_slice(&(self.values.len() as u64).to_le_bytes());
        self.values.iter().for_each(|v| bytes.extend_from_slice(&v.to_le_bytes()));
        bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// The table in the bytes of the file `path`, which must hold `wanted`.
    pub fn from_bytes(path: &Path, bytes: &[u8], wanted: Scheme) -> Result<Table, TableError> {
        let path = || path.to_path_buf();
        if !MAGIC.starts_with(&bytes[..bytes.len().min(MAGIC.len())]) {
            return Err(TableError::Magic(path()));
        }
        if bytes.len() < 12 {
            return Err(TableError::Short(path(), bytes.len(), HEADER + 4));
        }
        let version = u32::from_le_bytes(array(bytes, 8));
        if version != VERSION {
            return Err(TableError::Version(path(), version));
        }
        if bytes.len() < HEADER + 4 {
            return Err(TableError::Short(path(), bytes.len(), HEADER + 4));
        }
        let count = u64::from_le_bytes(array(bytes, HEADER - 8));
        let whole = usize::try_from(count).ok().and_then(|n| n.checked_mul(4)).and_then(|n| n.checked_add(HEADER + 4));
        let whole = whole.ok_or_else(|| TableError::Layout(path()))?;
        if bytes.len() < whole {
            return Err(TableError::Short(path(), bytes.len(), whole));
        }
        if bytes.len() > whole {
            return Err(TableError::Layout(path()));
        }
        if crc32fast::hash(&bytes[..whole - 4]) != u32::from_le_bytes(array(bytes, whole - 4)) {
            return Err(TableError::Checksum(path()));
        }
        let name = String::from_utf8_lossy(&bytes[12..28]).trim_end_matches('\0').to_string();
        if name != wanted.name() {
            return Err(TableError::Scheme(path(), name, wanted.name()));
        }
        let size = [0, 1, 2].map(|i| u32::from_le_bytes(array(bytes, 28 + 4 * i)));
        let ranges = [0, 1, 2, 3, 4, 5].map(|i| f64::from_le_bytes(array(bytes, 40 + 8 * i)));
        // To the bit, signs of zeros too: a table is written as it was read.
        let same = ranges.map(f64::to_bits) == wanted.ranges().map(f64::to_bits);
        let fits = wanted.count(size) == Some(count as usize) && same && bytes[88..120] == padded::<32>(UNITS);
        if !fits {
            return Err(TableError::Layout(path()));
        }
        let values: Vec<f32> = bytes[HEADER..whole - 4].as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        if let Some(place) = values.iter().position(|value| value.is_nan() || value.abs() > MOST_VALUE) {
            return Err(TableError::Value(path(), place, values[place]));
        }
        Ok(Table { scheme: wanted, size, values })
    }

    /// Writes the file `path`.
    pub fn save(&self, path: &Path) -> Result<(), TableError> {
        user_file::write_whole(path, &self.to_bytes()).map_err(|e| TableError::Io(path.to_path_buf(), e))
    }

    /// Reads the file `path`, which must hold `wanted`.
    pub fn load(path: &Path, wanted: Scheme) -> Result<Table, TableError> {
        Table::read(&GameFile::at(path), wanted)
    }

    /// Reads a file that the game comes with, which must hold `wanted`.
    pub fn read(file: &GameFile, wanted: Scheme) -> Result<Table, TableError> {
        let path = &file.path;
        let bytes = file.read(MOST_BYTES).map_err(|fault| match fault {
            FileFault::Io(e) if e.kind() == std::io::ErrorKind::NotFound => TableError::Missing(path.clone()),
            FileFault::Io(e) => TableError::Io(path.clone(), e),
            fault => TableError::File(path.clone(), fault),
        })?;
        Table::from_bytes(path, &bytes, wanted)
    }
}

/// `text` in N bytes, filled with zeros.
fn padded<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    bytes[..text.len()].copy_from_slice(text.as_bytes());
    bytes
}

/// The N bytes at `offset`; the caller has checked the length.
fn array<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    let mut out = [0; N];
    out.copy_from_slice(&bytes[offset..offset + N]);
    out
}
