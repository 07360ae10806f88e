//! Rays from one eye, made ready for the tree.

use super::ray::{Slabs, WIDENING};
use super::triangle::Shear;

/// Rays from one eye, in an order in which every aligned run of 4ᵏ is a square of 2ᵏ × 2ᵏ pixels ([`super::order::squares`]).
#[derive(Clone, Copy, Debug)]
pub struct EyePacket<'a> {
    /// Where all rays start.
    pub eye: [f32; 3],
    /// Where they go. A packet splits if their number is a power of 4.
    pub directions: &'a [[f32; 3]],
    /// The camera's axes to the right and upwards, V_right and V_up.
    pub screen: [[f32; 3]; 2],
}

/// A ray made ready for boxes and triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ready {
    pub(super) slabs: Slabs,
    pub(super) shear: Shear,
}

impl Ready {
    pub(super) fn inverse(&self) -> [f32; 3] {
        self.slabs.inverse
    }

    /// The eye as the planes are tested against it where rays enter and where they leave.
    pub(super) fn shifts(&self) -> [[f32; 3]; 2] {
        [self.slabs.enter, self.slabs.leave]
    }
}

/// The widening of a box as [`widening`] has it, for a plane through the eye with this normal.
#[inline]
pub(super) fn slack(normal: [f32; 3], wide: f32) -> f32 {
    // Rounding of the three products, of the same size as what the widening stands for.
    (normal[0].abs() + normal[1].abs() + normal[2].abs()) * wide * (1.0 + WIDENING)
}
