//! The screen as a coarse grid of directions.

use glam::DVec3;

/// Columns of the grid.
const COLUMNS: usize = 48;
/// Least and most rows.
const ROWS: [f64; 2] = [12.0, 48.0];
/// Share of the half width and half height in which is pointed; nothing is pointed at in what is left at the edges.
const WITHIN: f64 = 0.96;
/// A field of view in radians that has a flat picture.
const FIELDS: [f64; 2] = [1e-6, 3.1];

/// A camera's screen.
#[derive(Clone, Copy, Debug)]
pub struct CameraScreen {
    /// Tangents of half the angles that are used, across and up.
    half: [f64; 2],
    rows: usize,
}

impl CameraScreen {
    /// Of a horizontal field of view in rad; `aspect` is width over height.
    pub fn new(field_of_view: f64, aspect: f64) -> CameraScreen {
        let across = WITHIN * libm::tan(0.5 * field_of_view.clamp(FIELDS[0], FIELDS[1]));
        let aspect = if aspect.is_finite() { aspect.clamp(0.05, 20.0) } else { 1.0 };
        CameraScreen { half: [across, across / aspect], rows: (COLUMNS as f64 / aspect).round().clamp(ROWS[0], ROWS[1]) as usize }
    }

    /// Where in the part that is used a direction (camera axes) is: −1 to 1 to the right and up; None off it.
    pub fn place(&self, seen: DVec3) -> Option<[f64; 2]> {
        if seen.z.is_nan() || seen.z >= 0.0 {
            return None;
        }
        let place = [-seen.x / seen.z / self.half[0], -seen.y / seen.z / self.half[1]];
        place.iter().all(|x| x.abs() <= 1.0).then_some(place)
    }

    /// The directions of the grid's cells, row by row from the lower left.
    pub fn directions(&self) -> impl Iterator<Item = DVec3> + '_ {
        let middle = |k: usize, count: usize| (2 * k + 1) as f64 / count as f64 - 1.0;
        (0..self.rows * COLUMNS).map(move |k| {
            let [x, y] = [middle(k % COLUMNS, COLUMNS), middle(k / COLUMNS, self.rows)];
            DVec3::new(x * self.half[0], y * self.half[1], -1.0).normalize()
        })
    }

    /// For each cell how many steps it lies inside a region: 0 outside it, 1 at its border.
    pub fn depths(&self, inside: impl Fn(usize) -> bool) -> Vec<u16> {
        let mut depths: Vec<u16> = (0..self.rows * COLUMNS).map(|k| if inside(k) { u16::MAX } else { 0 }).collect();
        // Rosenfeld & Pfaltz 1966: forwards with the neighbours before, backwards with those after; the screen's border is outside.
        for k in 0..depths.len() {
            let left = if k % COLUMNS > 0 { depths[k - 1] } else { 0 };
            let below = if k >= COLUMNS { depths[k - COLUMNS] } else { 0 };
            depths[k] = depths[k].min(left.min(below) + 1);
        }
        for k in (0..depths.len()).rev() {
            let right = if (k + 1) % COLUMNS > 0 { depths[k + 1] } else { 0 };
            let above = depths.get(k + COLUMNS).copied().unwrap_or(0);
            depths[k] = depths[k].min(right.min(above) + 1);
        }
        depths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_the_way_to_the_border() {
        let screen = CameraScreen::new(1.0, 16.0 / 9.0);
        let inside = |k: usize| (10..17).contains(&(k % COLUMNS)) && (5..12).contains(&(k / COLUMNS));
        let depths = screen.depths(inside);
        assert_eq!(depths[8 * COLUMNS + 13], 4);
        assert_eq!(depths[5 * COLUMNS + 13], 1);
        assert_eq!(depths[4 * COLUMNS + 13], 0);
        assert_eq!(screen.depths(|_| true)[0], 1);
    }

    #[test]
    fn every_cell_is_on_the_screen() {
        for aspect in [0.3, 1.0, 16.0 / 9.0, 4.0] {
            for field in [1e-9, 0.05, 1.0, 3.0, 7.0] {
                let screen = CameraScreen::new(field, aspect);
                assert!(screen.directions().all(|seen| screen.place(seen).is_some()), "{aspect} {field}");
                assert!(screen.place(DVec3::Z).is_none());
            }
        }
    }
}
