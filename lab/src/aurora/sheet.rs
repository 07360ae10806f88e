//! Which electrons come down where: seeds along curves, energies from a spectrum, and the fall of each tabulated.

use glam::{DVec2, DVec3, Vec3};

use lensrunner::scene::aurora::air::overhead;
use lensrunner::scene::aurora::curve::Curve;
use lensrunner::scene::aurora::dipole::{REFERENCE_HEIGHT, inclination};
use lensrunner::scene::aurora::fall::{self, Spectrum};
use lensrunner::scene::aurora::lines;
use lensrunner::scene::aurora::random::uniform;

/// Levels of height at which an electron may collide.
pub const LEVELS: usize = 160;
/// The highest of them, km.
pub const TOP: f64 = 420.0;
/// The lowest of them, km.
pub const BOTTOM: f64 = 84.0;
/// Rows of the table of falls.
pub const FALLS: usize = 512;
/// Reaches µR(E) of the first and last row, g cm⁻².
const REACHES: [f64; 2] = [1e-8, 2e-2];
/// How far astray an electron is at the lowest level, at most, km.
const SWAY: f64 = 0.25;
/// The magnetic latitude of the patch, radians: its field is inclined by 78°.
const LATITUDE: f64 = 1.185;

/// The height of level `k`, km: half a kilometre apart at the bottom, six at the top, as the scale height of the air grows.
pub fn level_height(k: usize) -> f64 {
    let s = (k as f64 + 0.5) / LEVELS as f64;
    TOP + (BOTTOM - TOP) * (1.0 - (1.0 - s).powi(2)) * 0.9 + (BOTTOM - TOP) * 0.1 * s
}

/// What every walk needs of the air: the levels, the falls, the light.
#[derive(Clone, Debug)]
pub struct Falls {
    /// Heights of the levels, km, falling.
    pub heights: [f32; LEVELS],
    /// For each row the share of the energy spent above each level's layer, and last the share spent above the ground.
    pub spent: Vec<[f32; LEVELS + 1]>,
    /// For each row the level from which on nothing is spent any more.
    pub stops: Vec<usize>,
    /// How far collisions have led an electron astray at each level, km: as the square root of the path.
    pub sway: [f32; LEVELS],
    /// Air overhead at the lower end of each level's layer, g cm⁻².
    pub overheads: [f64; LEVELS],
    /// Photons per collision by line at each level.
    pub light: [[f32; 4]; LEVELS],
}

impl Falls {
    /// Tabulates the fall.
    pub fn new() -> Self {
        let edge = |k: usize| {
            if k + 1 == LEVELS {
                2.0 * level_height(k) - 0.5 * (level_height(k) + level_height(k - 1))
            } else {
                0.5 * (level_height(k) + level_height(k + 1))
            }
        };
        let overheads: [f64; LEVELS] = std::array::from_fn(|k| overhead(edge(k)));
        let above = |row: usize, k: usize| k.checked_sub(1).map_or(0.0, |k| (1.0 - fall::share_left(overheads[k], row_reach(row))) as f32);
        let spent: Vec<[f32; LEVELS + 1]> = (0..FALLS).map(|row| std::array::from_fn(|k| above(row, k))).collect();
        let stop = |row: &[f32; LEVELS + 1]| row.iter().position(|spent| *spent == row[LEVELS]).unwrap_or(0);
        let stops = spent.iter().map(stop).collect();
        let sway = std::array::from_fn(|k| (SWAY * ((TOP - level_height(k)) / (TOP - BOTTOM)).sqrt()) as f32);
        Falls {
            heights: std::array::from_fn(|k| level_height(k) as f32),
            spent,
            stops,
            sway,
            overheads,
            light: std::array::from_fn(|k| lines::photons(level_height(k)).map(|x| x as f32)),
        }
    }
}

impl Default for Falls {
    fn default() -> Self {
        Falls::new()
    }
}

/// The reach that a row of [`Falls::spent`] is for, g cm⁻².
pub fn row_reach(row: usize) -> f64 {
    REACHES[0] * (REACHES[1] / REACHES[0]).powf(row as f64 / (FALLS - 1) as f64)
}

/// The row nearest to a reach.
pub(super) fn reach_row(reach: f64) -> usize {
    let s = (reach / REACHES[0]).ln() / (REACHES[1] / REACHES[0]).ln();
    (s * (FALLS - 1) as f64).round().clamp(0.0, (FALLS - 1) as f64) as usize
}

/// One electron, standing for many, on its field line.
#[derive(Clone, Copy, Debug)]
pub struct Streak {
    /// The field line at [`TOP`], km.
    pub top: Vec3,
    /// The field line where the electron stops, or at [`BOTTOM`], km.
    pub end: Vec3,
    /// The height of `end`, km.
    pub end_height: f32,
    /// Energy over 35 eV.
    pub collisions: f32,
    /// Row of the table of falls.
    pub row: u32,
    /// Its number, for random numbers.
    pub id: u32,
}

/// An aurora in the flat patch.
#[derive(Clone, Debug)]
pub struct FlatAurora {
    /// Curves in the plane across the field; (x, y) is where the field line passes the reference height, relative to the patch's middle.
    pub curves: Vec<Curve>,
    /// The energies.
    pub spectrum: Spectrum,
    /// Which random numbers.
    pub seed: u32,
}

/// The unit vector along the field of the patch, upwards; north is +y, and the field leans south going up.
pub fn field_direction() -> DVec3 {
    let dip = inclination(LATITUDE);
    DVec3::new(0.0, -dip.cos(), dip.sin())
}

impl FlatAurora {
    /// Ten different auroras, as the experiment of Sekiguchi et al. has: quiet arcs, folds, curls and several curtains.
    pub fn ten() -> Vec<FlatAurora> {
        (0..10).map(FlatAurora::numbered).collect()
    }

    /// One of the ten.
    pub fn numbered(number: u32) -> FlatAurora {
        let random = |k: u32| f64::from(uniform(900 + number, k, 0));
        let count = 1 + number as usize % 3;
        let curves = (0..count as u32)
            .map(|c| {
                let at =
                    |k: u32, x: f64| DVec2::new(x, 60.0 * (f64::from(c) - 0.5 * (count as f64 - 1.0)) + 120.0 * (random(8 * c + k) - 0.5));
                let span = 120.0 + 130.0 * random(8 * c + 5);
                Curve {
                    control: [at(0, -span), at(1, -span / 3.0 * (1.0 + number as f64 * 0.2)), at(2, span / 3.0), at(3, span)],
                    amplitude: 2.0 + 14.0 * random(8 * c + 6),
                    waves: (1.0 + 7.0 * random(8 * c + 7)).floor(),
                    phase: 0.7 * f64::from(number),
                    width: 1.0 + 3.0 * random(100 + c),
                }
            })
            .collect();
        FlatAurora {
            curves,
            spectrum: Spectrum { accelerated: 1.0 + f64::from(number), thermal: 0.3 + 0.2 * f64::from(number % 4) },
            seed: number + 1,
        }
    }

    /// `count` electrons from west to east, so that those that follow one another are neighbours in the picture. µ is moved a little, so
    /// that each falls exactly as a row of the table says.
    pub fn streaks(&self, count: u32) -> Vec<Streak> {
        let up = field_direction();
        let mut streaks: Vec<Streak> = (0..count)
            .map(|id| {
                let random = |k: u32| f64::from(uniform(self.seed, id, 1_000_000 + k));
                let curve = &self.curves[id as usize % self.curves.len()];
                let place = curve.seed(random(0), random(1));
                let energy = self.spectrum.energy(1.0 - random(2), 1.0 - random(3), random(4));
                let row = reach_row(fall::slope(random(5)) * fall::range(energy));
                let end_height =
                    (0..LEVELS).find(|&k| overhead(level_height(k)) > row_reach(row)).map_or(BOTTOM, level_height).min(TOP - 1.0);
                let at = |z: f64| (DVec3::new(place.x, place.y, REFERENCE_HEIGHT) + up * ((z - REFERENCE_HEIGHT) / up.z)).as_vec3();
                Streak {
                    top: at(TOP),
                    end: at(end_height),
                    end_height: end_height as f32,
                    collisions: (energy / fall::PAIR_ENERGY) as f32,
                    row: row as u32,
                    id,
                }
            })
            .collect();
        streaks.sort_by(|a, b| a.top.x.total_cmp(&b.top.x));
        streaks
    }
}
