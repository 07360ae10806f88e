//! The Milky Way `assets/sky/milky-way.png`: brightness over the whole sky, made by `assets/sky/make_sky.py` from the contours of
//! d3-celestial.
//!
//! Equirectangular: u = right ascension / 2π (growing to the right, wrapping), v = 1/2 − declination / π (0 at the north pole).
//! Directions as in [`stars`](super::stars).

use std::f32::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};

use crate::game_files::{self, GameFile};
use crate::scene::blackbody;

/// The surface brightness of the brightest cloud, in stars of magnitude 0 per steradian: 20.2 magnitudes per square arc second.
pub const PEAK: f32 = 355.0;

/// The picture with its smaller copies.
#[derive(Debug, Clone, PartialEq)]
pub struct MilkyWay {
    /// From full size down to one pixel, each half as wide and high.
    pub levels: Vec<Level>,
}

/// One size of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear brightness, 1 being [`PEAK`]; rows from the north pole down.
    pub brightness: Vec<f32>,
}

/// Why `milky-way.png` could not be used.
#[derive(Debug, thiserror::Error)]
pub enum MilkyWayError {
    /// Missing, unreadable or no picture.
    #[error("Milky Way {}: {source}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: image::ImageError,
    },
    /// Not twice as wide as high.
    #[error("Milky Way {}: {width} × {height} pixels, must be twice as wide as high, both powers of two", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

/// The most bytes of the file.
const MOST_BYTES: u64 = 64 << 20;

/// Reads the picture and makes its smaller copies.
pub fn load(path: &Path) -> Result<MilkyWay, MilkyWayError> {
    read(&GameFile::at(path))
}

fn read(file: &GameFile) -> Result<MilkyWay, MilkyWayError> {
    let path = &file.path;
    let bytes = file.read(MOST_BYTES).map_err(|fault| image::ImageError::IoError(fault.into()));
    let picture = bytes.and_then(|bytes| image::load_from_memory(&bytes));
    let picture = picture.map_err(|source| MilkyWayError::Image { path: path.clone(), source })?.into_luma8();
    let (width, height) = picture.dimensions();
    if width != 2 * height || !height.is_power_of_two() {
        return Err(MilkyWayError::Shape { path: path.clone(), width, height });
    }
    // The file holds the square root of the brightness, so that 8 bits suffice for the faint parts.
    let brightness = picture.into_raw().into_iter().map(|grey| (f32::from(grey) / 255.0).powi(2)).collect();
    Ok(MilkyWay::from_full(Level { width: width as usize, height: height as usize, brightness }))
}

/// The picture of `assets/sky/`, or a dark sky and the reason.
pub fn load_or_dark() -> (MilkyWay, Option<MilkyWayError>) {
    match read(&game_files::find("assets/sky/milky-way.png")) {
        Ok(milky_way) => (milky_way, None),
        Err(error) => (MilkyWay::from_full(Level { width: 2, height: 1, brightness: vec![0.0; 2] }), Some(error)),
    }
}

impl MilkyWay {
    fn from_full(full: Level) -> Self {
        let mut levels = vec![full];
        while let Some(half) = levels.last().and_then(Level::half) {
            levels.push(half);
        }
        MilkyWay { levels }
    }

    /// The brightness in a direction (unit vector), 1 being [`PEAK`]: bilinear, at the nearest level at or below `level`.
    pub fn sample(&self, direction: Vec3, level: usize) -> f32 {
        let level = &self.levels[level.min(self.levels.len() - 1)];
        let uv = direction_to_uv(direction);
        let (x, y) = (uv.x * level.width as f32 - 0.5, uv.y * level.height as f32 - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let at = |dx: i32, dy: i32| {
            let column = (x.floor() as i32 + dx).rem_euclid(level.width as i32) as usize;
            let row = (y.floor() as i32 + dy).clamp(0, level.height as i32 - 1) as usize;
            level.brightness[row * level.width + column]
        };
        let upper = at(0, 0) + fx * (at(1, 0) - at(0, 0));
        let lower = at(0, 1) + fx * (at(1, 1) - at(0, 1));
        upper + fy * (lower - upper)
    }
}

impl Level {
    /// Every pixel as linear RGB, luminance 1 being [`PEAK`].
    pub fn light(&self) -> Vec<[f32; 3]> {
        let tints = tints();
        self.brightness.iter().map(|&brightness| light(brightness, &tints)).collect()
    }

    /// Half as wide and high, each pixel the mean over the solid angle of the four it replaces; the last step to 1 × 1 joins two.
    fn half(&self) -> Option<Level> {
        if self.width == 1 {
            return None;
        }
        let (width, height) = (self.width / 2, (self.height / 2).max(1));
        let weight = |row: usize| (PI * (row as f32 + 0.5) / self.height as f32).sin();
        let mut brightness = Vec::with_capacity(width * height);
        for row in 0..height {
            let (upper, lower) = ((2 * row).min(self.height - 1), (2 * row + 1).min(self.height - 1));
            for column in 0..width {
                let pair = |row: usize| {
                    let first = row * self.width + 2 * column;
                    0.5 * (self.brightness[first] + self.brightness[first + 1])
                };
                let sum = weight(upper) * pair(upper) + weight(lower) * pair(lower);
                brightness.push(sum / (weight(upper) + weight(lower)));
            }
        }
        Some(Level { width, height, brightness })
    }
}

/// Where in the picture a direction (unit vector) lies: u in [0, 1), v in [0, 1].
pub fn direction_to_uv(direction: Vec3) -> Vec2 {
    let u = direction.y.atan2(direction.x) / TAU;
    Vec2::new(u - u.floor(), 0.5 - direction.z.clamp(-1.0, 1.0).asin() / PI)
}

/// Temperatures, in K, of the black bodies that have the colours of the faintest and of the brightest parts: the outer parts are as white
/// as young stars, the bulge is yellow.
const TEMPERATURES: [f64; 2] = [7200.0, 4700.0];

/// Linear RGB of luminance 1 of the faintest and of the brightest parts.
pub fn tints() -> [[f32; 3]; 2] {
    TEMPERATURES.map(|temperature| {
        let rgb = blackbody::blackbody_rgb(temperature);
        rgb.map(|channel| (channel / blackbody::luminance(rgb)) as f32)
    })
}

/// Linear RGB of a part of this brightness: its tint goes from the faintest to the brightest as the root of the brightness.
pub fn light(brightness: f32, [faint, bright]: &[[f32; 3]; 2]) -> [f32; 3] {
    let root = brightness.clamp(0.0, 1.0).sqrt();
    std::array::from_fn(|c| brightness * (faint[c] + root * (bright[c] - faint[c])))
}
