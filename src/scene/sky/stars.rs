//! The star catalogue `assets/sky/stars.bin`: Hipparcos (van Leeuwen 2007), made by `assets/sky/make_sky.py`.
//!
//! Directions are in ICRS at epoch 1991.25, used as the axes of the scene: x to right ascension 0, z to the celestial north pole.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};

use crate::game_files::{self, GameFile};

/// The B−V taken for a star without one: that of the Sun.
const DEFAULT_B_MINUS_V: f32 = 0.65;
/// The scene's unit of radiance (a white surface in full light) holds this part of one star of magnitude 0 per steradian: bright enough
/// that stars down to magnitude 6 show beside a lit ship.
pub const SKY_UNIT: f32 = 4e-4;
/// The version of the file that is understood.
pub const VERSION: u32 = 1;

const MAGIC: &[u8; 8] = b"LRSTARS\0";
/// The most bytes of the file: five million stars.
const MOST_BYTES: u64 = 64 << 20;
const HEADER: usize = 24;
const RECORD: usize = 12;

/// A star at infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Star {
    /// Unit vector towards it.
    pub direction: Vec3,
    /// Its light, in units of a star of magnitude 0 (2.54e-6 lux; Allen's *Astrophysical Quantities*, 4th edition): 10^(−0.4 Hp).
    pub flux: f32,
    /// Effective temperature in K, from B−V.
    pub temperature: f32,
}

/// Why `stars.bin` could not be used.
#[derive(Debug, thiserror::Error)]
pub enum StarsError {
    /// Missing or unreadable.
    #[error("stars {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// Not a star file, or one that was cut short or changed.
    #[error("stars {}: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

/// Reads the catalogue, from bright to faint.
pub fn load(path: &Path) -> Result<Vec<Star>, StarsError> {
    read(&GameFile::at(path))
}

fn read(file: &GameFile) -> Result<Vec<Star>, StarsError> {
    let bytes = file.read(MOST_BYTES).map_err(|fault| StarsError::Read { path: file.path.clone(), source: fault.into() })?;
    parse(&bytes).map_err(|reason| StarsError::Damaged { path: file.path.clone(), reason })
}

/// The catalogue of `assets/sky/`, or [`stand_in`] and the reason.
pub fn load_or_stand_in() -> (Vec<Star>, Option<StarsError>) {
    match read(&game_files::find("assets/sky/stars.bin")) {
        Ok(stars) => (stars, None),
        Err(error) => (stand_in(), Some(error)),
    }
}

fn parse(bytes: &[u8]) -> Result<Vec<Star>, String> {
    let Some((header, body)) = bytes.split_at_checked(HEADER) else {
        return Err(format!("{} bytes are too few for its header", bytes.len()));
    };
    if &header[..8] != MAGIC {
        return Err("is no star file (its first bytes are not LRSTARS)".into());
    }
    let word = |index: usize| {
        let at = 8 + 4 * index;
        u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]])
    };
    let [version, count, checksum, record] = [0, 1, 2, 3].map(word);
    if version != VERSION || record as usize != RECORD {
        return Err(format!("version {version} with records of {record} bytes, expected version {VERSION} with {RECORD}"));
    }
    if body.len() as u64 != u64::from(count) * RECORD as u64 {
        return Err(format!("holds {} bytes of stars, its header promises {count} stars of {RECORD}", body.len()));
    }
    let actual = crc32fast::hash(body);
    if actual != checksum {
        return Err(format!("checksum {actual:08x}, its header says {checksum:08x}"));
    }
    body.chunks_exact(RECORD).map(star).collect()
}

fn star(record: &[u8]) -> Result<Star, String> {
    let float = |at: usize| f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]);
    let short = |at: usize| i16::from_le_bytes([record[at], record[at + 1]]);
    let (ra, dec) = (f64::from(float(0)), f64::from(float(4)));
    if !(ra.is_finite() && dec.is_finite()) {
        return Err(format!("a star at right ascension {ra}, declination {dec}"));
    }
    let b_minus_v = if short(10) == i16::MIN { DEFAULT_B_MINUS_V } else { f32::from(short(10)) / 1000.0 };
    Ok(Star {
        direction: DVec3::new(dec.cos() * ra.cos(), dec.cos() * ra.sin(), dec.sin()).as_vec3(),
        flux: flux(f32::from(short(8)) / 1000.0),
        temperature: temperature(b_minus_v),
    })
}

/// The flux of a star of this magnitude, in units of one of magnitude 0.
pub fn flux(magnitude: f32) -> f32 {
    10f32.powf(-0.4 * magnitude)
}

/// Effective temperature in K from B−V. Ballesteros, *New insights into black bodies*, EPL 97 (2012) 34008, equation 14.
/// B−V is held within [−0.4, 3], outside of which the formula was not meant.
pub fn temperature(b_minus_v: f32) -> f32 {
    let colour = b_minus_v.clamp(-0.4, 3.0);
    4600.0 * (1.0 / (0.92 * colour + 1.7) + 1.0 / (0.92 * colour + 0.62))
}

/// An invented sky of 6,000 evenly spread stars for when the catalogue is missing: magnitudes up to 6.5, ten times as many for each two
/// magnitudes fainter, as in the true sky. Always the same.
pub fn stand_in() -> Vec<Star> {
    const COUNT: u32 = 6000;
    // Points of a spiral on the sphere lie in rows; a step by the fractional parts of multiples of irrational numbers hides them.
    let part = |index: u32, step: f64| (f64::from(index) * step).fract();
    (1..=COUNT)
        .map(|index| {
            let z = 2.0 * part(index, 0.754_877_666_246_692_7) - 1.0;
            let angle = std::f64::consts::TAU * part(index, 0.569_840_290_998_053_3);
            let across = (1.0 - z * z).sqrt();
            Star {
                direction: DVec3::new(across * angle.cos(), across * angle.sin(), z).as_vec3(),
                flux: flux(6.5 + 2.0 * (f64::from(index) / f64::from(COUNT)).log10() as f32),
                temperature: 3500.0 + 8000.0 * part(index, 0.618_033_988_749_894_8).powi(2) as f32,
            }
        })
        .collect()
}
