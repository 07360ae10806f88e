//! What the processor works out for a frame before the device is told of it: plain data.

use crate::lensing::{Slice, Table};

use crate::lensing::methods::Method;
use crate::render::gpu::types;
use crate::render::sky::table::{SkyTables, straight_sky_table};

/// A frame that is planned: what is to be uploaded for it.
#[derive(Debug)]
pub(super) struct FramePlan {
    /// Width and height of what is drawn, in pixels.
    pub size: [u32; 2],
    /// The uniform, but for what was on the screen before.
    pub uniform: types::Frame,
}

/// The tables at one radius of the camera, by one method; kept until these change.
#[derive(Debug, Default)]
pub(super) struct Slices {
    /// Radius (r_s) and method; None before the first frame.
    at: Option<(f64, Method)>,
    /// Of the residual table.
    pub slice: Option<Slice>,
    /// The table of the sky.
    pub sky: Vec<[f32; 4]>,
    /// What it is interpolated from.
    skies: SkyTables,
    /// Whether they are to be uploaded.
    pub are_new: bool,
}

impl Slices {
    /// Takes the slices for a camera at the radius `l` (r_s): one nearer than 0.05 or farther than 5,000 r_s sees the hole as from there.
    pub fn follow(&mut self, table: &Table, l: f64, method: Method) {
        if self.at == Some((l, method)) {
            return;
        }
        match &mut self.slice {
            Some(slice) => slice.move_to(table, l),
            None => self.slice = Some(Slice::new(table, l)),
        }
        if method.bends {
            self.skies.at(l, &mut self.sky);
        } else {
            straight_sky_table(&mut self.sky);
        }
        self.at = Some((l, method));
        self.are_new = true;
    }
}
