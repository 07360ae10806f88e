//! The aurora's light on the ground: a map, in the plane across the field, of the brightness of white ground beneath.
//!
//! The map is in that plane and not in the planet's texture coordinates, because there positions of curtains can be used as they are, all
//! texels have the same size, the map is no larger than the oval and what it lights, and one map serves both poles of an oval.

use glam::DVec2;

use super::curve::Curve;
use super::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};

/// Side of a texel, in km. Sources are laid out cloud in cell and the map is read bilinearly. That blurs by a variance of up to half a
/// texel's square. A long straight curtain 110 km up loses up to 25²/(2 · 110²) = 2.6 % of its light beneath it.
const TEXEL: f64 = 25.0;
/// Most texels along a side; an oval's map has 290.
const MOST: usize = 400;
/// Light from farther than the first distance, in km, goes over to a coarser map, and beyond the second it is in that alone. It changes
/// slowly there, and within the horizon of a source there are thousands of fine texels, nine times as many as coarse ones.
const NEAR: [f64; 2] = [90.0, 360.0];
/// Fine texels along the side of a coarse one.
const COARSE: usize = 3;

/// Brightness of level white ground by a square kilometre of a thin level sheet of brightness 1, in km⁻². That part of the sheet is
/// `height` km above the ground and `distance` km away in the plane across the field. The sheet shines equally to all sides: along its
/// normal an area A of brightness L has the intensity L A. At r km from it, h km below it, the irradiance is E = L A h/r³, and white ground
/// has the brightness E/π. The ground is round: below the horizon there is no light.
pub fn lit(distance: f64, height: f64) -> f64 {
    let (sine, cosine) = (distance / (PLANET_RADIUS + REFERENCE_HEIGHT)).sin_cos();
    // From the point on the ground to the source: along the ground and up.
    let [aside, up] = [(PLANET_RADIUS + height) * sine, (PLANET_RADIUS + height) * cosine - PLANET_RADIUS];
    up.max(0.0) / (std::f64::consts::PI * (aside * aside + up * up).powf(1.5))
}

/// Distance of a source at a height from the points that have it on their horizon, in km in the plane across the field.
pub fn horizon(height: f64) -> f64 {
    (PLANET_RADIUS / (PLANET_RADIUS + height)).acos() * (PLANET_RADIUS + REFERENCE_HEIGHT)
}

/// The share of the light at this distance (km) that is in the fine map.
fn near(distance: f64) -> f64 {
    let x = ((distance - NEAR[0]) / (NEAR[1] - NEAR[0])).clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

/// A square of the plane across the field: a fine map of light near its source, and a coarse map of the rest.
#[derive(Clone, Debug)]
pub struct GroundMap {
    fine: LightLevel,
    coarse: LightLevel,
}

impl GroundMap {
    /// For curtains about these curves whose light is made at `height`, in km.
    pub fn new(curves: &[Curve], height: f64) -> GroundMap {
        let places = || curves.iter().flat_map(|curve| (0..=32).map(|k| curve.point(f64::from(k) / 32.0)));
        let (low, high) = (places().fold(DVec2::INFINITY, DVec2::min), places().fold(DVec2::NEG_INFINITY, DVec2::max));
        let reach = horizon(height);
        let side = (high - low).max_element() + 2.0 * reach;
        let (size, middle) =
            if side.is_finite() { (((side / TEXEL).ceil() as usize + 1).min(MOST), 0.5 * (low + high)) } else { (1, DVec2::ZERO) };
        let first = middle - 0.5 * TEXEL * (size - 1) as f64;
        GroundMap {
            fine: LightLevel::new(first, TEXEL, size, NEAR[1].min(reach), |distance| near(distance) * lit(distance, height)),
            coarse: LightLevel::new(first, TEXEL * COARSE as f64, (size - 1) / COARSE + 2, reach, |distance| {
                (1.0 - near(distance)) * lit(distance, height)
            }),
        }
    }

    /// Texels along a side.
    pub fn size(&self) -> usize {
        self.fine.size
    }

    /// The corner of the map, before its first texel, and its side, km in the plane across the field.
    pub fn square(&self) -> (DVec2, f64) {
        (self.fine.first - 0.5 * TEXEL, TEXEL * self.fine.size as f64)
    }

    /// Brightness of white ground, row by row, for sources at these positions (km): each with its brightness times its area in km².
    pub fn of(&self, sources: impl Iterator<Item = (DVec2, f64)> + Clone) -> Vec<f32> {
        let (mut map, far, coarse) = (self.fine.of(sources.clone()), self.coarse.of(sources), self.coarse.size);
        for (y, row) in map.chunks_exact_mut(self.fine.size).enumerate() {
            let t = (y % COARSE) as f32 / COARSE as f32;
            let rows = &far[y / COARSE * coarse..][..2 * coarse];
            let between: Vec<f32> = rows[..coarse].iter().zip(&rows[coarse..]).map(|(a, b)| a + t * (b - a)).collect();
            for (x, texel) in row.iter_mut().enumerate() {
                let [a, b] = [0, 1].map(|next| between[x / COARSE + next]);
                *texel += a + (x % COARSE) as f32 / COARSE as f32 * (b - a);
            }
        }
        map
    }
}

/// Texels of one size, and the light of a source on the texels round it.
#[derive(Clone, Debug)]
struct LightLevel {
    /// The middle of the first texel, km, and the side of one.
    first: DVec2,
    texel: f64,
    /// Texels along a side.
    size: usize,
    /// Light on the texels round a source that is in the middle of one: a list of rows, each as long as a circle is wide there.
    spread: Vec<Vec<f32>>,
}

impl LightLevel {
    /// Sources light as far as `reach` (km), by their distance as `light` says.
    fn new(first: DVec2, texel: f64, size: usize, reach: f64, light: impl Fn(f64) -> f64) -> LightLevel {
        let most = (reach / texel) as i32;
        let row = |y: i32| {
            let half = f64::from(most * most - y * y).sqrt() as i32;
            (-half..=half).map(|x| light(f64::from(x).hypot(f64::from(y)) * texel) as f32).collect()
        };
        LightLevel { first, texel, size, spread: (-most..=most).map(row).collect() }
    }

    /// The part of the brightness of white ground that is in this map, row by row.
    fn of(&self, sources: impl Iterator<Item = (DVec2, f64)>) -> Vec<f32> {
        let laid = self.lay_out(sources);
        let mut map = vec![0.0; self.size * self.size];
        let reach = self.spread.len() / 2;
        for (at, &light) in laid.iter().enumerate().filter(|(_, light)| **light != 0.0) {
            let (x, y) = (at % self.size, at / self.size);
            for (k, row) in self.spread.iter().enumerate() {
                let half = row.len() / 2;
                // The part of the row on the map.
                let Some(y) = (y + k).checked_sub(reach).filter(|y| *y < self.size) else { continue };
                let (from, to) = (x.saturating_sub(half), (x + half + 1).min(self.size));
                let texels = &mut map[y * self.size + from..y * self.size + to];
                for (texel, part) in texels.iter_mut().zip(&row[from + half - x..]) {
                    *texel += light * part;
                }
            }
        }
        map
    }

    /// Lays the sources out, cloud in cell; what is beyond the map is left out.
    fn lay_out(&self, sources: impl Iterator<Item = (DVec2, f64)>) -> Vec<f32> {
        let mut laid = vec![0.0; self.size * self.size];
        for (place, light) in sources {
            let p = (place - self.first) / self.texel;
            let last = (self.size - 1) as f64;
            if !(light.is_finite() && p.min_element() >= 0.0 && p.max_element() < last) {
                continue;
            }
            let (x, y) = (p.x as usize, p.y as usize);
            let s = p.fract();
            for (x, y, part) in
                [(x, y, (1.0 - s.x) * (1.0 - s.y)), (x + 1, y, s.x * (1.0 - s.y)), (x, y + 1, (1.0 - s.x) * s.y), (x + 1, y + 1, s.x * s.y)]
            {
                laid[y * self.size + x] += (light * part) as f32;
            }
        }
        laid
    }
}
