//! Packets of any size through the wide tree, split as they descend.
//!
//! Paper 4 splits a packet in 4 or 16 at each node. Here packet and tree are descended together: a packet carries the list of those nodes that its
//! hull reaches, each opened for as long as that throws away more children than it keeps. Then the packet is split, and each part sifts the list with
//! its own, narrower hull. What is left at the end is eight rays and the few small nodes in front of them, nearest first. The nodes above are opened once
//! for all rays, whatever the size of the packet, and no node is opened for rays that cannot reach it.

use super::hull::{Axes, Hull, Planes};
use super::lanes::{Lanes, Portable};
use super::ray::{Hit, Ray, widening};
use super::triangle::{Shear, fastest};
use super::wide::{Block, LEAF, STACK, Wide, leaf};
use super::wide_ray::{meet, sheared};

/// Rays that are tested at once.
const GROUP: usize = 8;

/// A node is kept closed while a packet reaches at least this many of its children: its parts will throw away more.
const CLOSED: u32 = 4;

/// Eight rays that have looked at this many nodes and blocks together share too little (rays from an eye look at about ten), and go on one by one.
const PATIENCE: u32 = 40;

/// So many more looks does each block buy in which a ray met something nearer: at the outlines of many small things single rays are slow too, and giving
/// up there cost a sixth of all time on balls4A; rays to a light, which meet nothing, do better alone. Anything from 10 to 80 is as good.
const BONUS: u32 = 20;

/// Packets whose slopes differ by more do not sift: they reach almost everything.
const SIFTED: f32 = 0.5;

/// Eight rays whose slopes differ by more share too little and go one by one. Measured on mirrored and scattered rays: anything between a twentieth
/// and a fifth is as good; rays from an eye are far below.
const TOGETHER: f32 = 0.1;

/// A part of the tree that a packet still has to look at: a node, and those of its children that the packet reaches.
#[derive(Clone, Copy, Debug)]
struct Item {
    node: u32,
    children: u32,
    /// The depth where the nearest of them begins.
    near: f32,
}

/// A run of groups, and the run of items that the packet it was split off has left for it.
#[derive(Clone, Copy, Debug)]
struct Part {
    first: usize,
    count: usize,
    items: [usize; 2],
}

/// What packets need to remember on their way; keep one for each thread.
pub struct Packets {
    items: Vec<Item>,
    parts: Vec<Part>,
    /// Of each group.
    hulls: Vec<Hull>,
    /// Of each eight groups.
    wider: Vec<Hull>,
    stack: Box<[(u32, f32); STACK]>,
}

impl Default for Packets {
    fn default() -> Packets {
        Packets { items: Vec::new(), parts: Vec::new(), hulls: Vec::new(), wider: Vec::new(), stack: Box::new([(0, 0.0); STACK]) }
    }
}

impl Wide {
    /// The nearest triangle that each ray meets; the same bits as [`Wide::closest_each`]. The rays are taken in the order given, so that neighbours in
    /// the list should be neighbours in space ([`super::order::tiles`] arranges a picture): any set gives the right answer, a good order a fast one.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn closest_packet(&self, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        #[cfg(target_arch = "x86_64")]
        if self.fast {
            #[allow(unsafe_code)]
            // SAFETY: `fast` is set only where these instructions were detected.
            return unsafe { packet_avx(self, rays, hits, packets) };
        }
        packet::<Portable>(self, rays, hits, packets);
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
fn packet_avx(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    packet::<super::lanes::Avx>(wide, rays, hits, packets);
}

#[inline(always)]
fn packet<L: Lanes>(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    if wide.nodes.is_empty() {
        hits.fill(Hit::MISS);
        return;
    }
    if rays.is_empty() {
        return;
    }
    let Some(axes) = sweep::<L>(wide, rays, &mut packets.hulls, &mut packets.wider) else {
        // No common direction: halves may have one, eight rays need none.
        if rays.len() <= GROUP {
            wide.each::<false>(rays, hits, &mut packets.stack);
        } else {
            let middle = (rays.len() / 2).next_multiple_of(GROUP);
            let (first, second) = hits.split_at_mut(middle);
            wide.closest_packet(&rays[..middle], first, packets);
            wide.closest_packet(&rays[middle..], second, packets);
        }
        return;
    };
    let Packets { items, parts, hulls, wider, stack } = packets;
    items.clear();
    items.push(Item { node: 0, children: !0, near: 0.0 });
    parts.clear();
    parts.push(Part { first: 0, count: rays.len().div_ceil(GROUP), items: [0, 1] });
    while let Some(part) = parts.pop() {
        let [start, end] = part.items;
        items.truncate(end);
        let groups = part.first..part.first + part.count;
        let mut list = [start, end];
        if part.count > 1 {
            let hull = united(&wider[groups.start / GROUP..groups.end.div_ceil(GROUP)]);
            if hull.is_narrow(SIFTED) {
                let planes = Planes::<L>::new(&hull, &axes);
                for i in start..end {
                    sift(wide, &planes, items[i], items, stack);
                }
                if items.len() == end {
                    hits[groups.start * GROUP..(groups.end * GROUP).min(rays.len())].fill(Hit::MISS);
                    continue;
                }
                list = [end, items.len()];
                if part.count <= GROUP {
                    // What is nearest first hides most of the rest from each group.
                    items[end..].sort_unstable_by(|a, b| a.near.total_cmp(&b.near));
                }
            }
        }
        if part.count > GROUP {
            // In 16 or in 64 is as fast. Parts begin where eight groups do, as `wider` has them.
            let size = (part.count.next_power_of_two() / 4).max(GROUP);
            for first in groups.step_by(size).rev() {
                parts.push(Part { first, count: size.min(part.first + part.count - first), items: list });
            }
            continue;
        }
        for at in groups {
            let run = at * GROUP..((at + 1) * GROUP).min(rays.len());
            if hulls[at].is_narrow(TOGETHER) {
                let planes = Planes::<L>::new(&hulls[at], &axes);
                group(wide, &rays[run.clone()], &mut hits[run], &axes, &planes, &items[list[0]..list[1]], stack);
            } else {
                wide.each::<false>(&rays[run.clone()], &mut hits[run], stack);
            }
        }
    }
}

/// The hull of all of these.
#[inline(always)]
fn united(hulls: &[Hull]) -> Hull {
    let mut all = Hull::EMPTY;
    for hull in hulls {
        all = all.union(hull);
    }
    all
}

/// Eight rays or fewer; lanes without one repeat the last, with an end before its start.
#[inline(always)]
fn eight<'a>(rays: &'a [Ray], spare: &'a mut [Ray; GROUP]) -> &'a [Ray; GROUP] {
    if let Ok(full) = rays.try_into() {
        return full;
    }
    *spare = [Ray { until: -1.0, ..rays[rays.len() - 1] }; GROUP];
    spare[..rays.len()].copy_from_slice(rays);
    spare
}

/// Rays lane by lane: origin, direction, end.
#[inline(always)]
fn lanes<L: Lanes>(rays: &[Ray; GROUP]) -> ([L; 3], [L; 3], L) {
    let [x, y, z, along_x, along_y, along_z, until] = L::columns(bytemuck::cast_ref(rays));
    ([x, y, z], [along_x, along_y, along_z], until)
}

/// The common direction of the rays, the hull of each group and of each eight groups; None if they have none.
#[inline(always)]
fn sweep<L: Lanes>(wide: &Wide, rays: &[Ray], hulls: &mut Vec<Hull>, wider: &mut Vec<Hull>) -> Option<Axes> {
    let mut spare = [rays[0]; GROUP];
    let middle = rays[rays.len() / 2].direction;
    let z = fastest(middle);
    let axes = [(z + 1) % 3, (z + 2) % 3, z];
    let sign = 1f32.copysign(middle[z]);
    let (mut low, mut high) = ([L::splat(f32::INFINITY); 3], [L::splat(f32::NEG_INFINITY); 3]);
    for rays in rays.chunks(GROUP) {
        let (origin, ..) = lanes::<L>(eight(rays, &mut spare));
        for axis in 0..3 {
            low[axis] = origin[axis].min(low[axis]);
            high[axis] = origin[axis].max(high[axis]);
        }
    }
    let low = [low[0].least(), low[1].least(), low[2].least()];
    let high = [high[0].greatest(), high[1].greatest(), high[2].greatest()];
    let front = if sign > 0.0 { low[z] } else { high[z] };
    let widening = widening(&wide.root, low).max(widening(&wide.root, high));
    let axes = Axes { axes, sign, front, widening };
    hulls.clear();
    wider.clear();
    for rays in rays.chunks(GROUP) {
        let (origin, direction, until) = lanes::<L>(eight(rays, &mut spare));
        let along = direction[z].mul(L::splat(sign));
        let depth = origin[z].sub(L::splat(front)).mul(L::splat(sign));
        let end = depth.add(along.mul(until));
        let [x, y] = [axes.axes[0], axes.axes[1]];
        let (slope_x, slope_y) = (direction[x].div(along), direction[y].div(along));
        let (offset_x, offset_y) = (origin[x].sub(slope_x.mul(depth)), origin[y].sub(slope_y.mul(depth)));
        let lower_and_upper =
            [offset_x, offset_x.negative(), offset_y, offset_y.negative(), slope_x, slope_x.negative(), slope_y, slope_y.negative()];
        let hull = Hull { sides: L::leasts(lower_and_upper).store(), depth: [depth.least(), -end.greatest()] };
        // The comparison also fails where something is not a number.
        if L::splat(0.0).less(along).bits() != 0xff || !hull.is_gentle() {
            return None;
        }
        hulls.push(hull);
    }
    for hulls in hulls.chunks(GROUP) {
        wider.push(united(hulls));
    }
    Some(axes)
}

/// Opens an item for a packet as far as it pays, and adds what is left to the list, nearest first.
#[inline(always)]
fn sift<L: Lanes>(wide: &Wide, planes: &Planes<L>, item: Item, items: &mut Vec<Item>, stack: &mut [(u32, f32); STACK]) {
    let mut only = item.children;
    stack[0] = (item.node, 0.0);
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let at = stack[height].0;
        let node = &wide.nodes[at as usize];
        let (met, near) = planes.boxes(node, f32::INFINITY);
        let met = met & only;
        only = !0;
        let inner = met & node.inner;
        if met == 0 {
            continue;
        }
        let nears = near.store();
        if inner == 0 || met.count_ones() >= CLOSED {
            items.push(Item { node: at, children: met, near: nearest(&nears, met) });
            continue;
        }
        if met != inner {
            items.push(Item { node: at, children: met & !inner, near: nearest(&nears, met & !inner) });
        }
        push::<L>(wide, stack, &mut height, inner, &node.children, &nears);
    }
}

/// The least of some lanes.
#[inline(always)]
fn nearest(numbers: &[f32; 8], mut lanes: u32) -> f32 {
    let mut least = f32::INFINITY;
    while lanes != 0 {
        least = least.min(numbers[lanes.trailing_zeros() as usize]);
        lanes &= lanes - 1;
    }
    least
}

/// Puts children on the stack, the nearest on top.
#[inline(always)]
fn push<L: Lanes>(wide: &Wide, stack: &mut [(u32, f32); STACK], height: &mut usize, mut lanes: u32, children: &[u32; 8], nears: &[f32; 8]) {
    let ground = *height;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        let waits = (children[lane], nears[lane]);
        wide.fetch::<L>(waits.0);
        let mut place = *height;
        while place > ground && stack[place - 1].1 < waits.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = waits;
        *height += 1;
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
fn corner<L: Lanes>(block: &Block, corner: usize, axes: [usize; 3], lane: usize) -> [L; 3] {
    let corner = &block.corners[corner];
    [L::splat(corner[axes[0]][lane]), L::splat(corner[axes[1]][lane]), L::splat(corner[axes[2]][lane])]
}

/// Eight rays laid out lane by lane, and what they have met.
struct Group<'a, L> {
    rays: &'a [Ray; GROUP],
    origin: [L; 3],
    /// Of `Shear`, each lane along its own fastest axis.
    slopes: [L; 3],
    /// By axis: the lanes that move fastest along it.
    fastest: [L; 3],
    /// One bit an axis along which any lane moves fastest.
    axes: u32,
    until: L,
    t: L,
    /// Numbers of triangles as bits.
    triangle: L,
    /// The depth where each ray starts, and depth for t.
    depth: [L; 2],
}

impl<'a, L: Lanes> Group<'a, L> {
    #[inline(always)]
    fn new(rays: &'a [Ray; GROUP], axes: &Axes) -> Group<'a, L> {
        let (origin, direction, until) = lanes::<L>(rays);
        // As `fastest`.
        let [x, y, z] = [direction[0].abs(), direction[1].abs(), direction[2].abs()];
        let (all, none) = (L::splat(0.0).at_most(L::splat(0.0)), L::splat(0.0));
        let first = y.at_most(x).and(z.at_most(x));
        let second = first.select(none, z.at_most(y));
        let fastest = [first, second, first.or(second).select(none, all)];
        let slopes = if first.bits() == 0xff {
            slopes_along(&direction, 0)
        } else if second.bits() == 0xff {
            slopes_along(&direction, 1)
        } else if fastest[2].bits() == 0xff {
            slopes_along(&direction, 2)
        } else {
            let (a, b, c) = (slopes_along(&direction, 0), slopes_along(&direction, 1), slopes_along(&direction, 2));
            [
                first.select(a[0], second.select(b[0], c[0])),
                first.select(a[1], second.select(b[1], c[1])),
                first.select(a[2], second.select(b[2], c[2])),
            ]
        };
        let depth = axes.axes[2];
        let sign = L::splat(axes.sign);
        Group {
            rays,
            origin,
            slopes,
            fastest,
            axes: u32::from(fastest[0].bits() != 0) | u32::from(fastest[1].bits() != 0) << 1 | u32::from(fastest[2].bits() != 0) << 2,
            until,
            t: L::splat(Hit::MISS.t),
            triangle: L::splat(f32::from_bits(Hit::NONE)),
            depth: [origin[depth].sub(L::splat(axes.front)).mul(sign), direction[depth].mul(sign)],
        }
    }

    /// Behind this depth nothing can be nearer than what every ray has.
    #[inline(always)]
    fn deepest(&self) -> f32 {
        self.depth[0].add(self.depth[1].mul(self.t.min(self.until))).greatest()
    }

    /// Tests one block, and says whether a ray has met something nearer.
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
        let inside = met.inside.and(self.fastest[axis]);
        if inside.bits() == 0 {
            return false;
        }
        let number = block.triangles[lane];
        let t = met.t();
        let nearer = inside.and(L::splat(0.0).at_most(t)).and(t.at_most(self.until)).and(t.at_most(self.t));
        // What happens seldom is done one by one: an edge function of 0, or the same t as the best.
        let seldom = met.exact().and(inside).or(nearer.and(self.t.at_most(t)));
        if seldom.bits() != 0 {
            return self.one_by_one(inside.bits(), &block.lane(lane), number);
        }
        self.t = nearer.select(t, self.t);
        self.triangle = nearer.select(L::splat(f32::from_bits(number)), self.triangle);
        nearer.bits() != 0
    }

    #[inline(never)]
    fn one_by_one(&mut self, lanes: u32, corners: &[[f32; 3]; 3], number: u32) -> bool {
        let mut hits = self.hits();
        let before = hits;
        for lane in (0..GROUP).filter(|lane| lanes >> lane & 1 == 1) {
            let ray = &self.rays[lane];
            Shear::new(ray).update(corners, number, ray.until, &mut hits[lane]);
        }
        self.t = L::load(&hits.map(|h| h.t));
        self.triangle = L::load(&hits.map(|h| f32::from_bits(h.triangle)));
        hits != before
    }

    #[inline(always)]
    fn hits(&self) -> [Hit; GROUP] {
        let (t, triangle) = (self.t.store(), self.triangle.store());
        std::array::from_fn(|i| Hit { t: t[i], triangle: triangle[i].to_bits() })
    }
}

/// Eight rays or fewer through the items that are left.
#[inline(always)]
fn group<L: Lanes>(
    wide: &Wide,
    rays: &[Ray],
    hits: &mut [Hit],
    axes: &Axes,
    planes: &Planes<L>,
    items: &[Item],
    stack: &mut [(u32, f32); STACK],
) {
    let mut spare = [rays[0]; GROUP];
    let mut group = Group::<L>::new(eight(rays, &mut spare), axes);
    let mut until = group.deepest() + axes.widening;
    let mut looks = 0;
    let mut patience = PATIENCE;
    for item in items {
        if item.near > until {
            continue;
        }
        let mut only = item.children;
        stack[0] = (item.node, item.near);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, near) = stack[height];
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
                    push::<L>(wide, stack, &mut height, met, &node.children, &near.store());
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
    hits.copy_from_slice(&group.hits()[..rays.len()]);
}
