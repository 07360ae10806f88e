//! The fall of electrons and its light as tables: for each brightness of a curtain, the heights between which equal parts of each line's
//! light are made, and how much light that is.
//!
//! A row is the mean over all electrons at that brightness, of every energy and slope of the spectrum: a streak is not one electron but all
//! of a few hundred metres of a curtain. If electrons were drawn one by one, each with a random energy, five times as many would still make
//! a picture with more grain.
//!
//! Steps are short where much light is made and long where there is little. How high and how deep the light goes depends on the spectrum:
//! from 500 km for the softest electrons to 65 km for the hardest. So do the heights between which it is drawn ([`Quantiles::ends`]).

use super::air::overhead;
use super::fall::{Spectrum, range, sane_energy, share_left, slope};
use super::lines;

/// Rows of the tables, evenly spaced in the square root of the energy flux over its mean.
pub const ROWS: usize = 32;
/// Equal parts of the light.
pub const PARTS: usize = 32;
/// Energy flux over its mean in the first and the last row; beyond them the table is constant.
pub const FLUXES: [f64; 2] = [0.05, 4.0];
/// Kinds of light, each with its own heights: green with blue and crimson; and red, which is made higher up and is delayed too long to use
/// theirs.
pub const KINDS: usize = 2;
/// The lines of each kind: 1 for those that it has of green, blue, red, crimson.
const LINES: [[f64; 4]; KINDS] = [[1.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]];
/// The greatest and the least height at which any light is drawn, km.
pub const HEIGHTS: [f64; 2] = [500.0, 60.0];
/// For each kind, the share of a line's light that may be made above the heights at which it is drawn, and as much below; it is drawn at
/// their ends. More for red, of which 1 % comes from above 450 km: its chords have to be short further down, where it is delayed by
/// seconds.
const OUTSIDE: [f64; KINDS] = [0.002, 0.008];
/// Steps of height of the integrals, km.
const STEP: f64 = 0.5;
/// Reaches µR(E) of which the spectrum is mixed, evenly spaced in their logarithm: their number; below, the first and the last in g cm⁻².
const REACHES: usize = 128;
const REACH_ENDS: [f64; 2] = [2e-9, 0.25];
/// Slopes over which the spectrum is summed; below, energies above that of the potential, up to so many thermal energies.
const SLOPES: usize = 64;
const ENERGIES: usize = 96;
const THERMALS: f64 = 16.0;

/// The tables.
#[derive(Clone, Debug)]
pub struct Quantiles {
    /// Heights (km) by row, kind and part: PARTS + 1 each, falling.
    pub heights: Vec<f32>,
    /// By row and part: photons of green, blue, red and crimson above those heights (of red above those of its kind), per 35 eV that come
    /// down.
    pub photons: Vec<[f32; 4]>,
    /// Mean delay (s) of green and red at 64 heights from 80 to 500 km; the molecules have none.
    pub delays: Vec<[f32; 2]>,
    /// For each kind the greatest and the least height (km) at which it is drawn, the same for all rows.
    pub ends: [[f32; 2]; KINDS],
}

/// Heights of [`Quantiles::delays`], km.
const DELAY_HEIGHTS: [f64; 2] = [80.0, 500.0];
/// Entries of [`Quantiles::delays`].
const DELAYS: usize = 64;

/// Energy flux over its mean of a row.
pub fn flux(row: usize) -> f64 {
    let [first, last] = FLUXES.map(f64::sqrt);
    (first + (last - first) * row as f64 / (ROWS - 1) as f64).powi(2)
}

/// Share of the energy that electrons of each of the [`REACHES`] bring; the sum is 1. Their number goes as E exp(−(E − E_acc)/E_th), so the
/// energy as E times that. Isotropic electrons have slopes √u, with u uniform in [0, 1).
fn shares(spectrum: &Spectrum) -> Vec<f64> {
    let mut shares = vec![0.0; REACHES];
    let step = THERMALS / ENERGIES as f64;
    for k in 0..ENERGIES {
        let x = step * (k as f64 + 0.5);
        let energy = spectrum.accelerated + spectrum.thermal * x;
        let weight = energy * energy * (-x).exp();
        for j in 0..SLOPES {
            let reach = slope((j as f64 + 0.5) / SLOPES as f64) * range(sane_energy(energy));
            let place = (reach / REACH_ENDS[0]).ln() / (REACH_ENDS[1] / REACH_ENDS[0]).ln() * (REACHES - 1) as f64;
            let place = place.clamp(0.0, (REACHES - 1) as f64);
            let below = (place as usize).min(REACHES - 2);
            shares[below] += weight * (1.0 - (place - below as f64));
            shares[below + 1] += weight * (place - below as f64);
        }
    }
    let total: f64 = shares.iter().sum();
    shares.iter().map(|share| share / total).collect()
}

impl Quantiles {
    /// Integrates the falls of a curtain's electrons. `spectrum` is theirs at the mean flux. Where there is more flux electrons are harder:
    /// the potential goes as the square root of the flux.
    pub fn new(spectrum: &Spectrum) -> Self {
        let levels: Vec<f64> = (0..).map(|k| HEIGHTS[0] - STEP * f64::from(k)).take_while(|&z| z >= HEIGHTS[1]).collect();
        let overheads: Vec<f64> = levels.iter().map(|z| overhead(z - 0.5 * STEP)).collect();
        let light: Vec<[f64; 4]> = levels.iter().map(|&z| lines::photons(z)).collect();
        // Energy left below each level, of electrons of each reach.
        let reach = |k: usize| REACH_ENDS[0] * (REACH_ENDS[1] / REACH_ENDS[0]).powf(k as f64 / (REACHES - 1) as f64);
        let left: Vec<Vec<f64>> = (0..REACHES).map(|k| overheads.iter().map(|over| share_left(*over, reach(k))).collect()).collect();
        // Of each row, sums of each line from above down to each level.
        let of_row = |row: usize| {
            let shares = shares(&Spectrum { accelerated: spectrum.accelerated * flux(row).sqrt(), ..*spectrum });
            let mut sums = vec![[0.0; 4]; levels.len() + 1];
            let mut before = 1.0;
            for (k, light) in light.iter().enumerate() {
                let left: f64 = shares.iter().zip(&left).map(|(share, left)| share * left[k]).sum();
                sums[k + 1] = std::array::from_fn(|line| sums[k][line] + (before - left) * light[line]);
                before = left;
            }
            sums
        };
        let sums: Vec<Vec<[f64; 4]>> = (0..ROWS).map(of_row).collect();
        let ends: [[f32; 2]; KINDS] = std::array::from_fn(|kind| ends(&sums, LINES[kind], OUTSIDE[kind]));
        let mut heights = Vec::with_capacity(ROWS * KINDS * (PARTS + 1));
        let mut photons = Vec::with_capacity(ROWS * (PARTS + 1));
        for sums in &sums {
            let mut made = [[0.0; 4]; PARTS + 1];
            for (lines, [highest, lowest]) in LINES.iter().zip(ends) {
                for (part, made) in equal_parts(sums, *lines, PARTS).zip(&mut made) {
                    heights.push((part.height as f32).clamp(lowest, highest));
                    *made = std::array::from_fn(|line| made[line] + (lines[line] * part.made[line]) as f32);
                }
            }
            photons.extend(made);
        }
        let delays = (0..DELAYS)
            .map(|k| {
                let z = DELAY_HEIGHTS[0] + (DELAY_HEIGHTS[1] - DELAY_HEIGHTS[0]) * k as f64 / (DELAYS - 1) as f64;
                let [green, _, red, _] = lines::delays(z);
                [green as f32, red as f32]
            })
            .collect();
        Quantiles { heights, photons, delays, ends }
    }

    /// All tables in the order in which shaders/aurora/streaks.wgsl reads them.
    pub fn laid_out(&self) -> Vec<f32> {
        let photons = self.photons.iter().flatten();
        photons.chain(self.delays.iter().flatten()).chain(&self.heights).copied().collect()
    }
}

/// Where one equal part of the light ends and the next begins.
struct Quantile {
    /// km.
    height: f64,
    /// Photons above it, by line.
    made: [f64; 4],
}

/// Heights (km) between which all but the share `outside` of the light of each of some lines is made, at either end and in every row.
fn ends(rows: &[Vec<[f64; 4]>], lines: [f64; 4], outside: f64) -> [f32; 2] {
    let parts = (1.0 / outside).round() as usize;
    let [mut highest, mut lowest] = [HEIGHTS[1], HEIGHTS[0]];
    for sums in rows {
        for line in (0..4).filter(|&line| lines[line] > 0.0) {
            let alone = std::array::from_fn(|k| if k == line { 1.0 } else { 0.0 });
            let at = |part: usize| equal_parts(sums, alone, parts).nth(part).map(|part| part.height);
            highest = at(1).map_or(highest, |height| highest.max(height));
            lowest = at(parts - 1).map_or(lowest, |height| lowest.min(height));
        }
    }
    [highest.min(HEIGHTS[0]) as f32, lowest.max(HEIGHTS[1]) as f32]
}

/// The ends of so many equal parts of the light of some lines, from sums of each line at [`STEP`]s down from the first of [`HEIGHTS`].
fn equal_parts(sums: &[[f64; 4]], lines: [f64; 4], parts: usize) -> impl Iterator<Item = Quantile> {
    let of = move |sum: &[f64; 4]| -> f64 { sum.iter().zip(&lines).map(|(sum, line)| sum * line).sum() };
    let total = sums.last().map_or(0.0, of);
    let mut k = 0;
    (0..=parts).map(move |part| {
        let wanted = total * part as f64 / parts as f64;
        while k + 2 < sums.len() && of(&sums[k + 1]) < wanted {
            k += 1;
        }
        let (above, below) = (&sums[k], &sums[k + 1]);
        let rise = of(below) - of(above);
        let inside = if rise > 0.0 { ((wanted - of(above)) / rise).clamp(0.0, 1.0) } else { 0.0 };
        let made = std::array::from_fn(|line| above[line] + inside * (below[line] - above[line]));
        Quantile { height: HEIGHTS[0] + 0.5 * STEP - STEP * (k as f64 + inside), made }
    })
}
