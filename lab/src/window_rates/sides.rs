//! Moments of the chase on a rung beside everything as configured, one below the other: the part about the player's ship.

use std::path::{Path, PathBuf};

use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::render::quality::ladder::ladder;
use lensrunner::render::quality::options::turned;
use lensrunner::scene;

use super::SCENE;
use crate::chart::ChartError;
use crate::dial::moments::{Bench, MomentCase, class_of};
use crate::say::say;

/// Moments, T in r_s/c.
const MOMENTS: [f64; 3] = [2.0, 12.0, 24.0];

/// Writes `window-WIDTHxHEIGHT.png`: left the finest, right the rung (a number from 1), and says their FLIP.
pub fn draw(rung: usize, size: [u32; 2], seed: u64, folder: &Path) -> Result<PathBuf, ChartError> {
    let rungs = ladder(QualityCosts::shipped(), class_of(&scene::load(SCENE)?));
    let rung = &rungs[rung.clamp(1, rungs.len()) - 1];
    let mut bench = Bench::new(size)?;
    let [width, height] = size;
    // Half as wide and high, from here on.
    let ([left, top], [wide, high]) = ([width / 4, 2 * height / 5], [width / 2, height / 2]);
    let mut picture = image::RgbImage::new(2 * wide, MOMENTS.len() as u32 * high);
    for (row, at) in MOMENTS.into_iter().enumerate() {
        let mut shown = bench.show(&MomentCase { scene: SCENE.into(), at, seed, turn: [0.0; 2] })?;
        let asked = shown.finest;
        let finest = bench.picture(&mut shown, &asked)?;
        let taken = bench.picture(&mut shown, &turned(&asked, &rung.steps))?;
        let error = bench.error(&finest, &taken);
        say(format_args!("T = {at}: {}; FLIP {error:.3}, predicted at most {:.3}", rung.describe(), rung.error));
        for (column, side) in [finest, taken].into_iter().enumerate() {
            for (x, y) in (0..high).flat_map(|y| (0..wide).map(move |x| (x, y))) {
                let at = 4 * ((y + top) * width + x + left) as usize;
                let pixel = [side.bytes[at], side.bytes[at + 1], side.bytes[at + 2]];
                picture.put_pixel(x + column as u32 * wide, y + row as u32 * high, image::Rgb(pixel));
            }
        }
    }
    let path = folder.join(format!("window-{width}x{height}.png"));
    picture.save(&path).map_err(|error| ChartError::Write(path.clone(), error.to_string()))?;
    Ok(path)
}
