//! The aurora's light on the ground: a map in the plane across the field, of how bright a white ground is beneath.
//!
//! A map in that plane, and not one in the planet's texture coordinates: the curtains' places are in it as they are, a texel is as large everywhere, it is no larger
//! than the oval with what it lights, and where an oval has two, the north's is the south's as well.

use glam::DVec2;

use super::curve::Curve;
use super::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};

/// Side of a texel, km. Sources are laid out cloud in cell and the map is read straight between texels: that blurs by a variance of a third of a texel's square, of
/// which a long straight curtain 110 km up loses 30²/(3 · 110²) = 2.5 % beneath it.
const TEXEL: f64 = 30.0;
/// Most texels along a side: an oval's map has 240.
const MOST: usize = 320;

/// The brightness of a level white ground over that of a source, a part of a thin sheet, times the area of that part in km², which is `height` km above a place `distance` km away in
/// the plane across the field. The sheet shines as much to all sides: where it is seen along its normal with brightness L, dA of it has the intensity L dA, so that
/// E = L dA h/r³, and a white ground is as bright as E/π. The ground is round: below the horizon there is nothing.
pub fn lit(distance: f64, height: f64) -> f64 {
    let (sine, cosine) = (distance / (PLANET_RADIUS + REFERENCE_HEIGHT)).sin_cos();
    // From the place on the ground to the source: along the ground and up.
    let [aside, up] = [(PLANET_RADIUS + height) * sine, (PLANET_RADIUS + height) * cosine - PLANET_RADIUS];
    up.max(0.0) / (std::f64::consts::PI * (aside * aside + up * up).powf(1.5))
}

/// How far a source at a height is from the places that have it on their horizon, km in the plane across the field.
pub fn horizon(height: f64) -> f64 {
    (PLANET_RADIUS / (PLANET_RADIUS + height)).acos() * (PLANET_RADIUS + REFERENCE_HEIGHT)
}

/// A square of the plane across the field, and what a source lights about it.
#[derive(Clone, Debug)]
pub struct GroundMap {
    /// The middle of the first texel, km.
    first: DVec2,
    /// Texels along a side.
    size: usize,
    /// What the texels about a source in the middle of one have: rows from the one that many texels before it on.
    spread: Vec<Vec<f32>>,
}

impl GroundMap {
    /// Of curtains about these curves, whose light is made at a height, km.
    pub fn new(curves: &[Curve], height: f64) -> GroundMap {
        let places = || curves.iter().flat_map(|curve| (0..=32).map(|k| curve.point(f64::from(k) / 32.0)));
        let (low, high) = (places().fold(DVec2::INFINITY, DVec2::min), places().fold(DVec2::NEG_INFINITY, DVec2::max));
        let reach = horizon(height);
        let side = (high - low).max_element() + 2.0 * reach;
        let size = if side.is_finite() { ((side / TEXEL).ceil() as usize + 1).min(MOST) } else { 1 };
        let middle = if side.is_finite() { 0.5 * (low + high) } else { DVec2::ZERO };
        let most = (reach / TEXEL) as i32;
        // Rows are as long as the circle of the horizon is there.
        let row = |y: i32| {
            let half = (f64::from(most * most - y * y)).sqrt() as i32;
            (-half..=half).map(|x| lit(f64::from(x).hypot(f64::from(y)) * TEXEL, height) as f32).collect()
        };
        GroundMap { first: middle - 0.5 * TEXEL * (size - 1) as f64, size, spread: (-most..=most).map(row).collect() }
    }

    /// Texels along a side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The corner of the map, before its first texel, and its side, km in the plane across the field.
    pub fn square(&self) -> (DVec2, f64) {
        (self.first - 0.5 * TEXEL, TEXEL * self.size as f64)
    }

    /// How bright a white ground is, row by row, where sources are at these places (km): their brightness times their area in km².
    pub fn of(&self, sources: impl Iterator<Item = (DVec2, f64)>) -> Vec<f32> {
        let laid = self.lay_out(sources);
        let mut map = vec![0.0; self.size * self.size];
        let reach = self.spread.len() / 2;
        for (at, &light) in laid.iter().enumerate().filter(|(_, light)| **light != 0.0) {
            let (x, y) = (at % self.size, at / self.size);
            for (k, row) in self.spread.iter().enumerate() {
                let half = row.len() / 2;
                // The part of the row that is on the map.
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
            let p = (place - self.first) / TEXEL;
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
