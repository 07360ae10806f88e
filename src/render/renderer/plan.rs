//! What the processor works out for a frame before the device is told of it: plain data.

use crate::lensing::Slice;

use crate::lensing::methods::Method;
use crate::render::geometry::lists::BodyLists;
use crate::render::gpu::types;
use crate::render::sky::table::{sky_table, straight_sky_table};
use crate::render::tables::Tables;

/// A frame that is planned: what is to be uploaded for it.
#[derive(Debug)]
pub(super) struct FramePlan {
    /// Width and height of what is drawn, in pixels.
    pub size: [u32; 2],
    /// The uniform, but for what was on the screen before.
    pub uniform: types::Frame,
    /// The objects.
    pub bodies: BodyLists,
    /// Clusters of stars that may be on the screen: first star, how many, order.
    pub stars: Vec<[u32; 4]>,
}

/// The tables at one radius of the camera, by one method; kept until these change.
#[derive(Debug, Default)]
pub(super) struct Slices {
    /// Radius (r_s) and method; None before the first frame.
    at: Option<(f64, Method)>,
    /// Of the residual table.
    pub slice: Option<Slice>,
    /// What the shaders look light up in.
    pub lens: Vec<[f32; 4]>,
    /// The table of the sky.
    pub sky: Vec<[f32; 4]>,
    /// Whether they are to be uploaded.
    pub are_new: bool,
}

impl Slices {
    /// Takes the slices for a camera at the radius `l` (r_s): one nearer than 0.05 or farther than 5,000 r_s sees the hole as from there.
    pub fn follow(&mut self, tables: &mut Tables, l: f64, method: Method) {
        if self.at == Some((l, method)) {
            return;
        }
        let slice = Slice::new(tables.small(), l);
        *self = Slices {
            at: Some((l, method)),
            lens: tables.texels(method, l, &slice),
            sky: if method.bends { sky_table(l) } else { straight_sky_table() },
            slice: Some(slice),
            are_new: true,
        };
    }
}
