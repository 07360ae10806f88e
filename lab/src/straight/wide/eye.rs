//! Rays from one eye, four groups together, through what a packet has left for them.
//!
//! All four look at a node at once, by the hull of all. At a block it is asked which rays reach its box. A block that few rays
//! reach is tested by each of them; else its triangles are tested by sixteen rays at once, after a cheaper test has left out most.

use super::best::Best;
use super::best::GROUP;
use super::edges::Edges;
use super::group::{Item, corner, push};
use super::hull::{Axes, Hull, Planes};
use super::lanes::{Eight, Mask, Sixteen};
use super::ray::{self, meet, sheared, splat};
use super::tree::{Block, LEAF, Stack, Waits, Wide, Wide8, leaf};
use crate::straight::ray::{Hit, Ray};
use crate::straight::triangle::Shear;

/// Groups that descend together, 8 × 8 pixels: from one to two castle gains a fifth, from two to four a tenth.
pub(super) const TOGETHER: usize = 4;

/// A block that no more rays than this reach is tested ray by ray: eight triangles at once.
const FEW: u32 = 4;

/// After this many looks boxes of inner nodes are asked ray by ray too: there are many things smaller than a pixel, which most rays miss.
const MANY: u32 = 8;

/// What a group of rays from one eye is to a packet: lane by lane along the packet's axes.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Laid {
    /// Direction along x and along y over that along z.
    pub slopes: [[f32; GROUP]; 2],
    /// Depth for t.
    pub along: [f32; GROUP],
    /// The last t that counts.
    pub until: [f32; GROUP],
}

/// Sixteen rays from the eye, and what they have met.
#[derive(Clone, Copy)]
struct Group<'a, S> {
    best: Best<'a, S>,
    /// One bit a lane that holds a ray.
    used: u32,
    /// Of `Shear`.
    slopes: [S; 3],
    /// Depth for x and for y.
    inverse: [S; 2],
    along: S,
}

impl<'a, S: Sixteen> Group<'a, S> {
    #[inline(always)]
    fn new(rays: &'a [Ray], laid: &Laid, axes: &Axes) -> Group<'a, S> {
        let (zero, one, sign) = (S::splat(0.0), S::splat(1.0), S::splat(axes.sign));
        let [x, y] = [S::load(&laid.slopes[0]), S::load(&laid.slopes[1])];
        let along = S::load(&laid.along);
        Group {
            best: Best::new(rays, S::load(&laid.until)),
            used: (1 << rays.len()) - 1,
            // Over the direction itself and not its size: the same bits but for the sign.
            slopes: [x.mul(sign), y.mul(sign), one.div(along).mul(sign)],
            // Never −0, whose reciprocal would turn an interval round.
            inverse: [one.div(x.add(zero)), one.div(y.add(zero))],
            along,
        }
    }

    /// Behind this depth nothing can be nearer than what every ray has.
    #[inline(always)]
    fn deepest(&self) -> f32 {
        self.along.mul(self.best.last()).greatest()
    }

    /// Which rays reach a box, given from the eye along the packet's axes, before what they have met.
    #[inline(always)]
    fn reach(&self, [x, y, z]: &[[f32; 2]; 3], widening: f32) -> u32 {
        let mut near = S::splat(z[0]);
        let mut far = self.along.mul(self.best.last()).add(S::splat(widening)).min(S::splat(z[1]));
        for (k, side) in [x, y].into_iter().enumerate() {
            let (a, b) = (S::splat(side[0]).mul(self.inverse[k]), S::splat(side[1]).mul(self.inverse[k]));
            // What is not a number, 0 · ∞, says nothing.
            near = b.min(a).max(near);
            far = a.max(b).min(far);
        }
        near.at_most(far).bits() & self.used
    }

    /// Tests one ray against a block, and says whether it has met something nearer.
    #[inline(always)]
    fn one<L: Eight>(&mut self, lane: usize, block: &Block, axis: usize) -> bool {
        let ray = &self.best.rays[lane];
        let slopes = [self.slopes[0].store()[lane], self.slopes[1].store()[lane], self.slopes[2].store()[lane]];
        let before = Hit { t: self.best.t.store()[lane], triangle: self.best.triangle.store()[lane].to_bits() };
        let mut best = before;
        ray::block::<L>(block, &Shear { origin: ray.origin, axis, slopes }, ray.until, &mut best);
        if best == before {
            return false;
        }
        self.best.t = self.best.t.with(lane, best.t);
        self.best.triangle = self.best.triangle.with(lane, f32::from_bits(best.triangle));
        true
    }

    /// `Shear::meet` for one triangle, and whether it is nearer for any ray.
    #[inline(always)]
    fn triangle(&mut self, block: &Block, lane: usize, axes: [usize; 3]) -> bool {
        let eye = self.best.rays[0].origin;
        let origin: [S; 3] = splat([eye[axes[0]], eye[axes[1]], eye[axes[2]]]);
        let met = meet(
            sheared(corner(block, 0, axes, lane), origin, self.slopes),
            sheared(corner(block, 1, axes, lane), origin, self.slopes),
            sheared(corner(block, 2, axes, lane), origin, self.slopes),
        );
        self.best.take(&met, met.inside, block, lane)
    }

    #[inline(always)]
    fn write(&self, hits: &mut [Hit]) {
        hits.copy_from_slice(&self.best.hits()[..hits.len()]);
    }
}

/// Up to [`TOGETHER`] groups of a packet from one eye, the last of which may not be full.
pub(super) struct Run<'a> {
    /// Their rays.
    pub rays: &'a [Ray],
    /// The groups, laid out.
    pub laid: &'a [Laid],
    /// Their hulls.
    pub hulls: &'a [Hull],
}

/// The rays of up to [`TOGETHER`] groups through the items that are left. The packet's z is the axis along which each of them moves
/// fastest.
#[inline(always)]
pub(super) fn descend<L: Eight, S: Sixteen>(wide: &Wide, run: &Run, hits: &mut [Hit], axes: &Axes, items: &[Item], stack: &mut Stack) {
    // Built here and not in a constructor: it would copy them, and packets of 2 × 2 rays take a tenth longer.
    let first = Group::<S>::new(&run.rays[..run.rays.len().min(GROUP)], &run.laid[0], axes);
    let mut groups = Groups { eye: run.rays[0].origin, groups: [first; TOGETHER], untils: [f32::NEG_INFINITY; TOGETHER] };
    groups.take(run, axes);
    let planes = Planes::<L>::new(&Hull::around(run.hulls), axes);
    let mut until = groups.deepest();
    let mut looks = 0;
    for item in items {
        if item.near > until {
            continue;
        }
        let mut only = item.children;
        stack[0] = Waits { child: item.node, near: item.near, place: 0 };
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let Waits { child: at, near, place } = stack[height];
            if near > until {
                continue;
            }
            looks += 1;
            let inner = at & LEAF == 0;
            let mut reached = Reached { lanes: [0; TOGETHER], count: 0 };
            // An item's own box has been asked.
            if !inner || (looks > MANY && only == !0) {
                let parent = &wide.nodes[(place >> 3) as usize];
                let sides = seen_from(parent, (place & 7) as usize, groups.eye, axes);
                reached = groups.reach(&sides, axes.widening);
                if reached.count == 0 {
                    continue;
                }
            }
            if inner {
                let node = &wide.nodes[at as usize];
                let (met, near) = planes.boxes(node, until);
                let met = met & only;
                only = !0;
                if met != 0 {
                    push::<L>(wide, stack, &mut height, met, at, &near.store());
                }
                continue;
            }
            let (block, held) = leaf(at);
            groups.block::<L>(&wide.blocks[block], held, &reached, axes);
            until = groups.deepest();
        }
    }
    for (group, hits) in groups.groups.iter().zip(hits.chunks_mut(GROUP)) {
        group.write(hits);
    }
}

/// The groups of a run.
struct Groups<'a, S> {
    /// Where all rays start.
    eye: [f32; 3],
    groups: [Group<'a, S>; TOGETHER],
    /// The last depth that counts for each.
    untils: [f32; TOGETHER],
}

/// The rays of a run that reach a box.
struct Reached {
    /// One bit a ray, group by group.
    lanes: [u32; TOGETHER],
    /// How many they are.
    count: u32,
}

impl<'a, S: Sixteen> Groups<'a, S> {
    /// Takes up the rays of a run.
    #[inline(always)]
    fn take(&mut self, run: &Run<'a>, axes: &Axes) {
        let Run { rays, laid, .. } = *run;
        for group in &mut self.groups[rays.len().div_ceil(GROUP)..] {
            group.used = 0;
        }
        for (i, rays) in rays.chunks(GROUP).enumerate().take(TOGETHER) {
            if i > 0 {
                self.groups[i] = Group::new(rays, &laid[i], axes);
            }
            self.untils[i] = self.groups[i].deepest() + axes.widening;
        }
    }

    /// The last depth that counts for any group.
    #[inline(always)]
    fn deepest(&self) -> f32 {
        let mut deepest = self.untils[0];
        for &until in &self.untils[1..] {
            deepest = if until > deepest { until } else { deepest };
        }
        deepest
    }

    /// Which rays reach a box, given as in [`Group::reach`].
    #[inline(always)]
    fn reach(&self, sides: &[[f32; 2]; 3], widening: f32) -> Reached {
        let mut reached = Reached { lanes: [0; TOGETHER], count: 0 };
        for i in 0..TOGETHER {
            reached.lanes[i] = self.groups[i].reach(sides, widening);
            reached.count += reached.lanes[i].count_ones();
        }
        reached
    }

    /// Tests the `held` triangles of a block for the rays that reach its box, and sees anew how deep each group looks.
    #[inline(always)]
    fn block<L: Eight>(&mut self, block: &Block, held: u32, reached: &Reached, axes: &Axes) {
        let nearer = if reached.count <= FEW {
            self.ray_by_ray::<L>(block, &reached.lanes, axes.axes[2])
        } else {
            self.triangle_by_triangle::<L>(block, held, &reached.lanes, axes)
        };
        for i in 0..TOGETHER {
            if nearer[i] {
                self.untils[i] = self.groups[i].deepest() + axes.widening;
            }
        }
    }

    /// Eight triangles at once, and in which groups a ray has met something nearer.
    #[inline(always)]
    fn ray_by_ray<L: Eight>(&mut self, block: &Block, reached: &[u32; TOGETHER], axis: usize) -> [bool; TOGETHER] {
        let mut nearer = [false; TOGETHER];
        for i in 0..TOGETHER {
            let mut lanes = reached[i];
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize & (GROUP - 1);
                lanes &= lanes - 1;
                nearer[i] |= self.groups[i].one::<L>(lane, block, axis);
            }
        }
        nearer
    }

    /// Sixteen rays at once, and in which groups a ray has met something nearer.
    #[inline(always)]
    fn triangle_by_triangle<L: Eight>(&mut self, block: &Block, held: u32, reached: &[u32; TOGETHER], axes: &Axes) -> [bool; TOGETHER] {
        let mut nearer = [false; TOGETHER];
        let edges = Edges::new::<L>(block, self.eye, axes.axes[2]);
        for lane in 0..held as usize {
            for i in 0..TOGETHER {
                if reached[i] != 0 && edges.may_be_met(lane, self.groups[i].slopes) {
                    nearer[i] |= self.groups[i].triangle(block, lane, axes.axes);
                }
            }
        }
        nearer
    }
}

/// The box in one lane of a node, widened, from the eye along the packet's axes: lower and upper end.
#[inline(always)]
fn seen_from(node: &Wide8, lane: usize, eye: [f32; 3], axes: &Axes) -> [[f32; 2]; 3] {
    let mut sides = [[0.0; 2]; 3];
    for (side, axis) in sides.iter_mut().zip(axes.axes) {
        let [low, high] = [node.bounds[axis][0][lane], node.bounds[axis][1][lane]];
        *side = [low - axes.widening - eye[axis], high + axes.widening - eye[axis]];
    }
    if axes.sign < 0.0 {
        sides[2] = [-sides[2][1], -sides[2][0]];
    }
    sides
}
