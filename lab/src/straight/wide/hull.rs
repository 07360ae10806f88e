//! The space that a packet of rays sweeps: four planes and a front.
//!
//! All rays of a packet move along one axis, z, in one sense. Where they cross the plane in front of which they all start, their x lies in
//! [a₀, a₁]; their slopes dx/dz lie in [s₀, s₁]; so further on x lies in [a₀ + s₀ z, a₁ + s₁ z], and likewise y. For rays from one eye
//! these are the planes through the packet's outermost rays. Nothing is asked of the order of rays, nor that they start in one point.

use super::lanes::{Eight, Lanes, Mask};
use super::tree::{Block, Wide8};

/// Slopes above this make a hull too wide to be of use, and its rounding too large: such packets are split instead.
pub(super) const STEEPEST: f32 = 4.0;

/// What the rays of a packet sweep, as seen along one axis.
///
/// Of every interval the lower end and the negative of the upper one are kept, so that of two hulls the lesser numbers are the hull of
/// both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull {
    /// x where z = 0: lower and upper end, then y; then likewise their slopes.
    pub sides: [f32; 8],
    /// Where the first ray starts and where the last one ends, along z.
    pub depth: [f32; 2],
}

impl Hull {
    /// Holds nothing.
    pub const EMPTY: Hull = Hull { sides: [f32::INFINITY; 8], depth: [f32::INFINITY; 2] };

    /// The hull of all of these.
    #[inline(always)]
    pub fn around(hulls: &[Hull]) -> Hull {
        let mut all = Hull::EMPTY;
        for hull in hulls {
            all = all.union(hull);
        }
        all
    }

    /// The hull of both.
    #[inline(always)]
    pub fn union(&self, other: &Hull) -> Hull {
        // Loops that the compiler makes one instruction of.
        let mut both = *self;
        for (side, other) in both.sides.iter_mut().zip(other.sides) {
            *side = if other < *side { other } else { *side };
        }
        for (end, other) in both.depth.iter_mut().zip(other.depth) {
            *end = if other < *end { other } else { *end };
        }
        both
    }

    /// Whether the slopes differ by less than `spread` along x and along y.
    #[inline(always)]
    pub fn is_narrow(&self, spread: f32) -> bool {
        let [.., x, above_x, y, above_y] = self.sides;
        -above_x - x < spread && -above_y - y < spread
    }

    /// Whether no slope is as steep as 1, so that all rays move fastest along the packet's z.
    #[inline(always)]
    pub fn is_along_z(&self) -> bool {
        self.sides[4..].iter().all(|&s| s > -1.0)
    }

    /// Whether the slopes are finite and gentle.
    #[inline(always)]
    pub fn is_gentle(&self) -> bool {
        self.sides[4..].iter().all(|s| s.abs() <= STEEPEST)
    }
}

/// The axes of a packet: z is the one along which its rays move, in the sense of `sign`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// x, y, z as numbers of the scene's axes.
    pub axes: [usize; 3],
    /// 1 or −1.
    pub sign: f32,
    /// The scene's coordinate at which z = 0: no ray starts before it.
    pub front: f32,
    /// By how much boxes are widened.
    pub widening: f32,
}

/// A hull laid out for eight boxes or triangles at once.
#[derive(Clone, Copy)]
pub(super) struct Planes<L> {
    axes: Axes,
    offsets: [[L; 2]; 2],
    slopes: [[L; 2]; 2],
    sign: L,
    enter: L,
    leave: L,
    front: L,
    start: L,
    end: f32,
}

impl<L: Eight> Planes<L> {
    #[inline(always)]
    pub fn new(hull: &Hull, axes: &Axes) -> Planes<L> {
        let shift = axes.sign * axes.widening;
        // A slope carries the depth's widening over to x and y.
        let pad = axes.widening * (1.0 + STEEPEST);
        let [x, above_x, y, above_y, slope_x, upper_x, slope_y, upper_y] = hull.sides;
        Planes {
            axes: *axes,
            offsets: [[L::splat(x - pad), L::splat(pad - above_x)], [L::splat(y - pad), L::splat(pad - above_y)]],
            slopes: [[L::splat(slope_x), L::splat(-upper_x)], [L::splat(slope_y), L::splat(-upper_y)]],
            sign: L::splat(axes.sign),
            enter: L::splat(axes.front + shift),
            leave: L::splat(axes.front - shift),
            front: L::splat(axes.front),
            start: L::splat((hull.depth[0] - axes.widening).max(0.0)),
            end: axes.widening - hull.depth[1],
        }
    }

    /// Which of a node's boxes the hull reaches before the depth `until`, and the depths at which they begin.
    #[inline(always)]
    pub fn boxes(&self, node: &Wide8, until: f32) -> (u32, L) {
        let [x, y, z] = self.axes.axes;
        let first = usize::from(self.axes.sign < 0.0);
        // Nothing is met before the first ray starts.
        let near = L::load(&node.bounds[z][first]).sub(self.enter).mul(self.sign).max(self.start);
        let far = L::load(&node.bounds[z][1 - first]).sub(self.leave).mul(self.sign);
        let mut met = near.at_most(far).and(near.at_most(L::splat(until.min(self.end))));
        for (k, axis) in [x, y].into_iter().enumerate() {
            let [[a, b], [s, r]] = [self.offsets[k], self.slopes[k]];
            let low = a.add(s.mul(near).min(s.mul(far)));
            let high = b.add(r.mul(near).max(r.mul(far)));
            met = met.and(low.at_most(L::load(&node.bounds[axis][1]))).and(L::load(&node.bounds[axis][0]).at_most(high));
        }
        (met.bits(), near)
    }

    /// Which of a block's triangles are not wholly outside one of the planes, nor wholly behind the depth `until`.
    #[inline(always)]
    pub fn triangles(&self, block: &Block, until: f32) -> u32 {
        let [x, y, z] = self.axes.axes;
        let depth: [L; 3] = [
            L::load(&block.corners[0][z]).sub(self.front).mul(self.sign),
            L::load(&block.corners[1][z]).sub(self.front).mul(self.sign),
            L::load(&block.corners[2][z]).sub(self.front).mul(self.sign),
        ];
        let mut met = depth[0].min(depth[1]).min(depth[2]).at_most(L::splat(until + self.axes.widening));
        for (k, axis) in [x, y].into_iter().enumerate() {
            let across: [L; 3] = [L::load(&block.corners[0][axis]), L::load(&block.corners[1][axis]), L::load(&block.corners[2][axis])];
            let low = beside(&across, self.slopes[k][0], &depth);
            let high = beside(&across, self.slopes[k][1], &depth);
            met = met.and(self.offsets[k][0].at_most(low[0].max(low[1]).max(low[2])));
            met = met.and(high[0].min(high[1]).min(high[2]).at_most(self.offsets[k][1]));
        }
        met.bits()
    }
}

/// How far corners at these depths lie beside a plane of this slope through the origin.
#[inline(always)]
fn beside<L: Lanes>(across: &[L; 3], slope: L, depth: &[L; 3]) -> [L; 3] {
    [across[0].sub(slope.mul(depth[0])), across[1].sub(slope.mul(depth[1])), across[2].sub(slope.mul(depth[2]))]
}
