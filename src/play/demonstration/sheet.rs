//! The contact sheet: frames of a flight side by side.

/// Frames across and down, at most.
pub const GRID: [u32; 2] = [4, 4];

/// A sheet being filled with pictures of `frame` pixels, each brought down to half its size.
#[derive(Clone, Debug)]
pub struct ContactSheet {
    grid: [u32; 2],
    cell: [u32; 2],
    pixels: Vec<u8>,
}

/// The gap between pictures, in pixels.
const GAP: u32 = 4;

impl ContactSheet {
    /// An empty sheet for the pictures that are chosen of `frames` of this size.
    pub fn new(frame: [u32; 2], frames: u32) -> ContactSheet {
        let cell = frame.map(|side| (side / 2).max(1));
        let across = frames.clamp(1, GRID[0]);
        let mut sheet = ContactSheet { grid: [across, frames.div_ceil(across).clamp(1, GRID[1])], cell, pixels: Vec::new() };
        let [width, height] = sheet.size();
        sheet.pixels = vec![18; (width * height * 3) as usize];
        sheet
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        std::array::from_fn(|k| self.grid[k] * (self.cell[k] + GAP) + GAP)
    }

    /// Its pixels, RGB.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// The frames, of `frames`, that are shown.
    pub fn chosen(frames: u32) -> Vec<u32> {
        let places = GRID[0] * GRID[1];
        (0..places.min(frames)).map(|k| if frames <= places { k } else { (k * (frames - 1)) / (places - 1) }).collect()
    }

    /// Puts a picture (RGBA, `frame` pixels wide and high) into the place `place`.
    pub fn put(&mut self, place: u32, frame: [u32; 2], rgba: &[u8]) {
        let [width, _] = self.size();
        let corner = [GAP + (place % self.grid[0]) * (self.cell[0] + GAP), GAP + (place / self.grid[0]) * (self.cell[1] + GAP)];
        let step = |side: usize, k: u32| (k * 2).min(frame[side] - 1);
        for y in 0..self.cell[1] {
            for x in 0..self.cell[0] {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
                    let (sx, sy) = ((step(0, x) + dx).min(frame[0] - 1), (step(1, y) + dy).min(frame[1] - 1));
                    ((sy * frame[0] + sx) * 4) as usize
                });
                let to = (((corner[1] + y) * width + corner[0] + x) * 3) as usize;
                for channel in 0..3 {
                    let sum: u32 = corners.iter().map(|&from| u32::from(rgba[from + channel])).sum();
                    self.pixels[to + channel] = (sum / 4) as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_and_last_frame_are_shown() {
        let chosen = ContactSheet::chosen(240);
        assert_eq!((chosen.len(), chosen[0], chosen[15]), (16, 0, 239));
        assert_eq!(ContactSheet::chosen(3), [0, 1, 2]);
    }

    #[test]
    fn few_pictures_make_a_small_sheet() {
        // Cells of 4 × 2 with gaps of 4.
        assert_eq!(ContactSheet::new([8, 4], 3).size(), [3 * 8 + 4, 6 + 4]);
        assert_eq!(ContactSheet::new([8, 4], 12).size(), [4 * 8 + 4, 3 * 6 + 4]);
        assert_eq!(ContactSheet::new([8, 4], 1000).size(), [4 * 8 + 4, 4 * 6 + 4]);
    }

    #[test]
    fn a_picture_lands_in_its_place() {
        let mut sheet = ContactSheet::new([8, 4], 16);
        sheet.put(5, [8, 4], &[200; 8 * 4 * 4]);
        let [width, _] = sheet.size();
        let at = |x: u32, y: u32| sheet.pixels()[((y * width + x) * 3) as usize];
        // Place 5 is the second of the second row; cells are 4 × 2 with gaps of 4.
        assert_eq!([at(12, 10), at(15, 11), at(11, 10), at(16, 10), at(12, 9), at(12, 12)], [200, 200, 18, 18, 18, 18]);
    }
}
