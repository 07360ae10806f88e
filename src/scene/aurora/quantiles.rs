//! The fall and its light as tables: for each reach µR(E), the heights between which equal parts of each line's light lie, and how much it is.
//!
//! A splat is then always as bright as its neighbours, and steps are short where light is made and long where there is none.

use super::air::overhead;
use super::fall::share_left;
use super::lines;

/// Rows of the table, evenly spaced in ln of the reach.
pub const ROWS: usize = 96;
/// Equal parts of the light.
pub const PARTS: usize = 32;
/// Reaches of the first and the last row, g cm⁻².
pub const REACHES: [f64; 2] = [1e-8, 2e-2];
/// Kinds of light, each with heights and waits of its own: green, prompt (blue and crimson), red.
pub const KINDS: usize = 3;
/// For each kind the greatest and the least height at which it is drawn, km.
pub const HEIGHTS: [[f64; 2]; KINDS] = [[340.0, 84.0], [340.0, 84.0], [480.0, 130.0]];
/// Steps of height of the integrals, km.
const STEP: f64 = 0.5;

/// The tables.
#[derive(Clone, Debug)]
pub struct Quantiles {
    /// Heights (km) by row, kind and part: PARTS + 1 each, falling.
    pub heights: Vec<f32>,
    /// Photons per collision (35 eV of the electron's whole energy) by row: green, blue, red, crimson.
    pub photons: Vec<[f32; 4]>,
    /// Mean wait (s) of green and red at 64 heights from 80 to 500 km; the molecules do not wait.
    pub delays: Vec<[f32; 2]>,
}

/// Heights of [`Quantiles::delays`], km.
pub const DELAY_HEIGHTS: [f64; 2] = [80.0, 500.0];
/// Entries of [`Quantiles::delays`].
pub const DELAYS: usize = 64;

/// The reach of a row, g cm⁻².
pub fn reach(row: usize) -> f64 {
    REACHES[0] * (REACHES[1] / REACHES[0]).powf(row as f64 / (ROWS - 1) as f64)
}

impl Quantiles {
    /// Integrates the falls.
    pub fn new() -> Self {
        let levels: Vec<f64> = (0..).map(|k| 500.0 - STEP * f64::from(k)).take_while(|&z| z >= 80.0).collect();
        let overheads: Vec<f64> = levels.iter().map(|z| overhead(z - 0.5 * STEP)).collect();
        let light: Vec<[f64; 4]> = levels.iter().map(|&z| lines::photons(z)).collect();
        let mut heights = Vec::with_capacity(ROWS * KINDS * (PARTS + 1));
        let mut photons = Vec::with_capacity(ROWS);
        for row in 0..ROWS {
            let mut sums = vec![[0.0; 4]; levels.len() + 1];
            let mut before = 1.0;
            for (k, (over, light)) in overheads.iter().zip(&light).enumerate() {
                let left = share_left(*over, reach(row));
                sums[k + 1] = std::array::from_fn(|line| sums[k][line] + (before - left) * light[line]);
                before = left;
            }
            let total = sums[levels.len()];
            photons.push(total.map(|x| x as f32));
            for (kind, range) in HEIGHTS.iter().enumerate() {
                let mut k = 0;
                for part in 0..=PARTS {
                    let wanted = total[kind] * part as f64 / PARTS as f64;
                    while k + 1 < sums.len() && sums[k + 1][kind] < wanted {
                        k += 1;
                    }
                    let rise = sums.get(k + 1).map_or(0.0, |next| next[kind] - sums[k][kind]);
                    let inside = if rise > 0.0 { ((wanted - sums[k][kind]) / rise).clamp(0.0, 1.0) } else { 0.0 };
                    let height = 500.0 + 0.5 * STEP - STEP * (k as f64 + inside);
                    heights.push(height.clamp(range[1], range[0]) as f32);
                }
            }
        }
        let delays = (0..DELAYS)
            .map(|k| {
                let z = DELAY_HEIGHTS[0] + (DELAY_HEIGHTS[1] - DELAY_HEIGHTS[0]) * k as f64 / (DELAYS - 1) as f64;
                let [green, _, red, _] = lines::delays(z);
                [green as f32, red as f32]
            })
            .collect();
        Quantiles { heights, photons, delays }
    }
}

impl Default for Quantiles {
    fn default() -> Self {
        Quantiles::new()
    }
}
