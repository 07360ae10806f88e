//! Sixteen rays through what a packet has left for them.

use super::best::Best;
use super::best::GROUP;
use super::hull::{Axes, Planes};
use super::lanes::{Eight, Lanes, Mask, Sixteen};
use super::ray::{meet, sheared};
use super::tree::{Block, LEAF, Stack, Waits, Wide, leaf, wait};
use crate::straight::ray::{Hit, Ray};

/// Rays that a transposition takes at once.
pub(super) const EIGHT: usize = 8;

/// Every lane of a group.
pub(super) const ALL: u32 = 0xffff;

/// Groups that have looked at this many nodes and blocks share too little (rays from an eye look at about ten), and their rays go on one by
/// one.
const PATIENCE: u32 = 40;

/// So many more looks does each block buy in which a ray met something nearer: at the outlines of many small things single rays are slow
/// too; rays to a light, which meet nothing, do better alone. With 20 balls4A and tree10 gain 4 %, and balls4C, with dozens of triangles in
/// a pixel, loses 16 %.
const BONUS: u32 = 10;

/// A part of the tree that a packet still has to look at: a node, and those of its children that the packet reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub node: u32,
    pub children: u32,
    /// The depth where the nearest of them begins.
    pub near: f32,
}

/// Where a ray ends that meets nothing: lanes without a ray, and ends that are not a number or lie before the start.
pub(super) const NO_END: f32 = -1.0;

/// `N` rays or fewer; lanes without one repeat the last, with an end before its start.
#[inline(always)]
pub(super) fn filled<'a, const N: usize>(rays: &'a [Ray], spare: &'a mut [Ray; N]) -> &'a [Ray; N] {
    if let Ok(full) = rays.try_into() {
        return full;
    }
    *spare = [Ray { until: NO_END, ..rays[rays.len() - 1] }; N];
    spare[..rays.len()].copy_from_slice(rays);
    spare
}

/// Rays lane by lane: origin, direction, end.
#[inline(always)]
pub(super) fn lanes<L: Eight>(rays: &[Ray; EIGHT]) -> ([L; 3], [L; 3], L) {
    let [x, y, z, along_x, along_y, along_z, until] = L::columns(bytemuck::cast_ref(rays));
    ([x, y, z], [along_x, along_y, along_z], until)
}

/// Puts some children of a node on the stack, the nearest on top.
#[inline(always)]
pub(super) fn push<L: Eight>(wide: &Wide, stack: &mut Stack, height: &mut usize, mut lanes: u32, parent: u32, nears: &[f32; 8]) {
    let children = &wide.nodes[parent as usize].children;
    let ground = *height;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        let waits = Waits { child: children[lane], near: nears[lane], place: parent << 3 | lane as u32 };
        wide.fetch::<L>(waits.child);
        wait(stack, ground, height, waits);
    }
}

/// Of `Shear`, for rays along one axis.
#[inline(always)]
fn slopes_along<L: Lanes>(direction: &[L; 3], axis: usize) -> [L; 3] {
    let [x, y, z] = [direction[(axis + 1) % 3], direction[(axis + 2) % 3], direction[axis]];
    [x.div(z), y.div(z), L::splat(1.0).div(z)]
}

/// A corner of the triangle in one lane of a block, for every ray.
#[inline(always)]
pub(super) fn corner<L: Lanes>(block: &Block, corner: usize, axes: [usize; 3], lane: usize) -> [L; 3] {
    let corner = &block.corners[corner];
    [L::splat(corner[axes[0]][lane]), L::splat(corner[axes[1]][lane]), L::splat(corner[axes[2]][lane])]
}

/// Sixteen rays laid out lane by lane, and what they have met.
struct Group<'a, S: Lanes> {
    best: Best<'a, S>,
    origin: [S; 3],
    /// Of `Shear`, each lane along its own fastest axis.
    slopes: [S; 3],
    /// By axis: the lanes that move fastest along it.
    fastest: [S::Mask; 3],
    /// One bit an axis along which any lane moves fastest.
    axes: u32,
    /// The depth where each ray starts, and depth for t.
    depth: [S; 2],
}

impl<'a, S: Sixteen> Group<'a, S> {
    #[inline(always)]
    fn new(rays: &'a [Ray; GROUP], axes: &Axes) -> Group<'a, S> {
        let [x, y, z, along_x, along_y, along_z, until] = S::columns(bytemuck::cast_ref(rays));
        let until = until.max(S::splat(NO_END));
        let (origin, direction) = ([x, y, z], [along_x, along_y, along_z]);
        // As `fastest`.
        let [x, y, z] = [along_x.abs(), along_y.abs(), along_z.abs()];
        let fastest = [y.at_most(x).and(z.at_most(x)), x.less(y).and(z.at_most(y)), x.less(z).and(y.less(z))];
        let some = [fastest[0].bits(), fastest[1].bits(), fastest[2].bits()];
        let slopes = if some[0] == ALL {
            slopes_along(&direction, 0)
        } else if some[1] == ALL {
            slopes_along(&direction, 1)
        } else if some[2] == ALL {
            slopes_along(&direction, 2)
        } else {
            let (a, b, c) = (slopes_along(&direction, 0), slopes_along(&direction, 1), slopes_along(&direction, 2));
            [
                S::select(fastest[0], a[0], S::select(fastest[1], b[0], c[0])),
                S::select(fastest[0], a[1], S::select(fastest[1], b[1], c[1])),
                S::select(fastest[0], a[2], S::select(fastest[1], b[2], c[2])),
            ]
        };
        let depth = axes.axes[2];
        let sign = S::splat(axes.sign);
        Group {
            best: Best::new(rays, until),
            origin,
            slopes,
            fastest,
            axes: u32::from(some[0] != 0) | u32::from(some[1] != 0) << 1 | u32::from(some[2] != 0) << 2,
            depth: [origin[depth].sub(S::splat(axes.front)).mul(sign), direction[depth].mul(sign)],
        }
    }

    /// Behind this depth nothing can be nearer than what every ray has.
    #[inline(always)]
    fn deepest(&self) -> f32 {
        self.depth[0].add(self.depth[1].mul(self.best.last())).greatest()
    }

    /// Tests some triangles of one block, and says whether a ray has met something nearer.
    #[inline(always)]
    fn block(&mut self, block: &Block, mut lanes: u32) -> bool {
        let mut nearer = false;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let mut axes = self.axes;
            while axes != 0 {
                let axis = axes.trailing_zeros() as usize;
                axes &= axes - 1;
                nearer |= self.triangle(block, lane, axis);
            }
        }
        nearer
    }

    /// `Shear::meet` for the lanes that move fastest along one axis.
    #[inline(always)]
    fn triangle(&mut self, block: &Block, lane: usize, axis: usize) -> bool {
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let origin = [self.origin[axes[0]], self.origin[axes[1]], self.origin[axes[2]]];
        let met = meet(
            sheared(corner(block, 0, axes, lane), origin, self.slopes),
            sheared(corner(block, 1, axes, lane), origin, self.slopes),
            sheared(corner(block, 2, axes, lane), origin, self.slopes),
        );
        self.best.take(&met, met.inside.and(self.fastest[axis]), block, lane)
    }
}

/// The rays of a group, sixteen or fewer, through the items that are left.
#[inline(always)]
pub(super) fn group<L: Eight, S: Sixteen>(
    wide: &Wide,
    rays: &[Ray],
    hits: &mut [Hit],
    axes: &Axes,
    planes: &Planes<L>,
    items: &[Item],
    stack: &mut Stack,
) {
    let mut spare = [rays[0]; GROUP];
    let mut group = Group::<S>::new(filled(rays, &mut spare), axes);
    let mut until = group.deepest() + axes.widening;
    let mut looks = 0;
    let mut patience = PATIENCE;
    for item in items {
        if item.near > until {
            continue;
        }
        let mut only = item.children;
        stack[0] = Waits { child: item.node, near: item.near, place: 0 };
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let Waits { child: at, near, .. } = stack[height];
            if near > until {
                continue;
            }
            looks += 1;
            if looks > patience {
                return wide.each::<false>(rays, hits, stack);
            }
            if at & LEAF == 0 {
                let node = &wide.nodes[at as usize];
                let (met, near) = planes.boxes(node, until);
                let met = met & only;
                only = !0;
                if met != 0 {
                    push::<L>(wide, stack, &mut height, met, at, &near.store());
                }
            } else {
                let (block, count) = leaf(at);
                let block = &wide.blocks[block];
                let lanes = if count > 1 { planes.triangles(block, until) } else { 1 };
                if group.block(block, lanes) {
                    patience += BONUS;
                    until = group.deepest() + axes.widening;
                }
            }
        }
    }
    hits.copy_from_slice(&group.best.hits()[..hits.len()]);
}
