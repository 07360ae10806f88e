//! Straight rays, what they meet, and how far boxes are widened so that rounding loses nothing.

use super::bounds::Bounds;

/// A straight ray: origin + t · direction for 0 ≤ t ≤ until. Any unit of length.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Finite and not zero, of a length between 1e−15 and 1e15; t counts in its length.
    pub direction: [f32; 3],
    /// The largest t that counts; ∞ for no end.
    pub until: f32,
}

impl Ray {
    /// A ray without end.
    pub const fn new(origin: [f32; 3], direction: [f32; 3]) -> Ray {
        Ray { origin, direction, until: f32::INFINITY }
    }
}

/// The nearest thing that a ray meets. Of several at the same t, the triangle with the lowest number, so that the answer does not depend on
/// the order in which a method looks.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Hit {
    /// Along the ray, in lengths of its direction; ∞ for a miss.
    pub t: f32,
    /// The triangle's number in the list that the tree was built of; [`Hit::NONE`] for a miss.
    pub triangle: u32,
}

impl Hit {
    /// The triangle of a miss.
    pub const NONE: u32 = u32::MAX;
    /// Nothing was met.
    pub const MISS: Hit = Hit { t: f32::INFINITY, triangle: Hit::NONE };
    /// Something was met; nobody has asked what.
    pub const SOME: Hit = Hit { t: 0.0, triangle: 0 };

    /// Whether something was met.
    pub fn is_hit(&self) -> bool {
        self.triangle != Hit::NONE
    }

    /// Whether this one is to be kept rather than the other.
    #[inline]
    pub fn before(&self, other: &Hit) -> bool {
        self.t < other.t || (self.t == other.t && self.triangle < other.triangle)
    }
}

/// By how much, relative to the largest distance between a ray's origin and the tree's corners, a box is widened on each side.
///
/// The triangle test puts a hit up to about 14 · 2⁻²⁴ of that distance beside the triangle's box: the shear is off by 4 units, the depth by
/// 6, the slab test itself by 3 or 4. Twice that, so that every box that holds a hit passes its test whatever the order of operations.
pub const WIDENING: f32 = 1.0 / (1 << 19) as f32;

/// The length by which boxes are widened for a ray from `origin` through a tree of this root.
#[inline]
pub fn widening(root: &Bounds<f32>, origin: [f32; 3]) -> f32 {
    let (mut far, mut offset) = (0f32, 0f32);
    for axis in 0..3 {
        far = far.max((root.min[axis] - origin[axis]).abs()).max((root.max[axis] - origin[axis]).abs());
        offset = offset.max(origin[axis].abs());
    }
    // It is added to coordinates of the origin: enough that their rounding leaves it.
    far * WIDENING + offset * (1.0 / (1 << 22) as f32)
}

/// A ray made ready for boxes: the slab test with inclusive faces that a 0 · ∞ cannot spoil.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    /// 1 / direction; ±∞ where the ray runs along a face.
    pub inverse: [f32; 3],
    /// The origin, moved on by the widening: the planes where the ray enters are tested against it.
    pub enter: [f32; 3],
    /// The origin, moved back by the widening: the planes where it leaves.
    pub leave: [f32; 3],
}

impl Slabs {
    /// `widening` from [`widening`].
    #[inline]
    pub fn new(ray: &Ray, widening: f32) -> Slabs {
        let inverse = ray.direction.map(|d| 1.0 / d);
        // The sign of the reciprocal, as −0 is a direction too.
        let shift = inverse.map(|i| widening.copysign(i));
        Slabs {
            inverse,
            enter: std::array::from_fn(|a| ray.origin[a] + shift[a]),
            leave: std::array::from_fn(|a| ray.origin[a] - shift[a]),
        }
    }

    /// The t at which the ray enters the widened box, if it does so before `until`.
    #[inline]
    pub fn enter(&self, bounds: &Bounds<f32>, until: f32) -> Option<f32> {
        let (mut near, mut far) = (0f32, until);
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            let (first, last) = if self.inverse[axis].is_sign_negative() { (high, low) } else { (low, high) };
            let enter = (first - self.enter[axis]) * self.inverse[axis];
            let leave = (last - self.leave[axis]) * self.inverse[axis];
            // A NaN (0 · ∞, the ray in the widened face) fails both comparisons and so says nothing.
            if enter > near {
                near = enter;
            }
            if leave < far {
                far = leave;
            }
        }
        (near <= far).then_some(near)
    }
}
