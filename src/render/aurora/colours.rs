//! The colours of the spectral lines over an image: at some frequency ratios, and which ratio holds where on the screen.

use crate::render::aurora::shift::SHIFTS;
use bytemuck::{Pod, Zeroable};
use glam::DVec2;

use crate::render::aurora::shift::ImageShift;

/// `Lines` in shaders/aurora/levels/lit_corners.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Colours {
    /// Colour of a kilorayleigh of each line at each ratio, the least ratio first: XYZ or linear sRGB, and a number that is unused.
    pub lines: [[[f32; 4]; 4]; SHIFTS],
    /// By how many steps the ratio changes per screen coordinate right and up (−1 to 1).
    pub slope: [f32; 2],
    /// Width and height of a tile in those coordinates; the pass fills them in.
    pub tile: [f32; 2],
    /// Steps from the least ratio to that in the middle of the screen.
    pub middle: f32,
    /// Nothing.
    pub unused: [f32; 3],
}

impl Colours {
    /// From the frequency ratios over the image and a function `of` that gives the lines' colours at a ratio.
    pub fn new(shift: &ImageShift, of: impl Fn(f64) -> [[f32; 4]; 4]) -> Colours {
        let [least, greatest] = shift.range;
        let ratio = |k: usize| least + (greatest - least) * k as f64 / (SHIFTS - 1) as f64;
        let [middle, right, up] = shift.steps().map(|value| value as f32);
        Colours { lines: std::array::from_fn(|k| of(ratio(k))), slope: [right, up], middle, ..Colours::zeroed() }
    }

    /// The lines' colours at a place on the screen, coordinates from −1 to 1; the twin of `colour_at` in
    /// shaders/aurora/levels/resolve.wgsl.
    pub fn at(&self, place: DVec2) -> [[f32; 4]; 4] {
        let [right, up] = self.slope;
        let steps = (self.middle + right * place.x as f32 + up * place.y as f32).clamp(0.0, (SHIFTS - 1) as f32);
        let below = (steps as usize).min(SHIFTS - 2);
        let t = steps - below as f32;
        std::array::from_fn(|line| std::array::from_fn(|c| (1.0 - t) * self.lines[below][line][c] + t * self.lines[below + 1][line][c]))
    }
}
