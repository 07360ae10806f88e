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
use super::wide::{Block, LEAF, STACK, Wide};
use super::wide_ray::meet;

/// Rays that are tested at once.
const GROUP: usize = 8;

/// A node is kept closed while a packet reaches at least this many of its children: its parts will throw away more.
const CLOSED: u32 = 4;

/// A part of the tree that a packet still has to look at: a node, and those of its children that the packet reaches.
#[derive(Clone, Copy, Debug)]
struct Item {
    node: u32,
    children: u32,
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
    hulls: Vec<Hull>,
    stack: Box<[(u32, f32); STACK]>,
}

impl Default for Packets {
    fn default() -> Packets {
        Packets { items: Vec::new(), parts: Vec::new(), hulls: Vec::new(), stack: Box::new([(0, 0.0); STACK]) }
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
            // SAFETY: `fast` is set only where AVX2 was detected.
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
    let Some(axes) = sweep::<L>(wide, rays, &mut packets.hulls) else {
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
    let Packets { items, parts, hulls, stack } = packets;
    items.clear();
    items.push(Item { node: 0, children: !0 });
    parts.clear();
    parts.push(Part { first: 0, count: rays.len().div_ceil(GROUP), items: [0, 1] });
    while let Some(part) = parts.pop() {
        let [start, end] = part.items;
        items.truncate(end);
        let groups = part.first..part.first + part.count;
        if part.count == 1 {
            let run = part.first * GROUP..((part.first + 1) * GROUP).min(rays.len());
            let planes = Planes::<L>::new(&hulls[part.first], &axes);
            group(wide, &rays[run.clone()], &mut hits[run], &axes, &planes, &items[start..end], stack);
            continue;
        }
        let hull = hulls[groups.clone()].iter().fold(Hull::EMPTY, |all, h| all.union(h));
        let planes = Planes::<L>::new(&hull, &axes);
        for i in start..end {
            sift(wide, &planes, items[i], items, stack);
        }
        if items.len() == end {
            hits[groups.start * GROUP..(groups.end * GROUP).min(rays.len())].fill(Hit::MISS);
            continue;
        }
        let size = if part.count > 8 { part.count.next_power_of_two() / 4 } else { 1 };
        for first in groups.step_by(size).rev() {
            parts.push(Part { first, count: size.min(part.first + part.count - first), items: [end, items.len()] });
        }
    }
}

/// The common direction of the rays and the hull of each group; None if they have none.
#[inline(always)]
fn sweep<L: Lanes>(wide: &Wide, rays: &[Ray], hulls: &mut Vec<Hull>) -> Option<Axes> {
    let middle = rays[rays.len() / 2].direction;
    let z = fastest(middle);
    let axes = [(z + 1) % 3, (z + 2) % 3, z];
    let sign = 1f32.copysign(middle[z]);
    let mut front = f32::INFINITY;
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for ray in rays {
        // Also false for what is not a number.
        let forward = ray.direction[z] * sign > 0.0;
        if !forward {
            return None;
        }
        front = front.min(ray.origin[z] * sign);
        for axis in 0..3 {
            low[axis] = low[axis].min(ray.origin[axis]);
            high[axis] = high[axis].max(ray.origin[axis]);
        }
    }
    let widening = widening(&wide.root, low).max(widening(&wide.root, high));
    let axes = Axes { axes, sign, front: front * sign, widening };
    hulls.clear();
    for rays in rays.chunks(GROUP) {
        let mut hull = Hull::EMPTY;
        for ray in rays {
            let depth = (ray.origin[z] - axes.front) * sign;
            let along = ray.direction[z] * sign;
            for k in 0..2 {
                let slope = ray.direction[axes.axes[k]] / along;
                let offset = ray.origin[axes.axes[k]] - slope * depth;
                hull.slopes[k] = [hull.slopes[k][0].min(slope), hull.slopes[k][1].max(slope)];
                hull.offsets[k] = [hull.offsets[k][0].min(offset), hull.offsets[k][1].max(offset)];
            }
        }
        if !hull.is_gentle() {
            return None;
        }
        hulls.push(hull);
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
        if inner == 0 || met.count_ones() >= CLOSED {
            items.push(Item { node: at, children: met });
            continue;
        }
        if met != inner {
            items.push(Item { node: at, children: met & !inner });
        }
        let nears = near.store();
        push(stack, &mut height, inner, &node.children, &nears);
    }
}

/// Puts children on the stack, the nearest on top.
#[inline(always)]
fn push(stack: &mut [(u32, f32); STACK], height: &mut usize, mut lanes: u32, children: &[u32; 8], nears: &[f32; 8]) {
    let ground = *height;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        let waits = (children[lane], nears[lane]);
        let mut place = *height;
        while place > ground && stack[place - 1].1 < waits.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = waits;
        *height += 1;
    }
}

/// Eight rays laid out lane by lane.
struct Group<L> {
    origin: [L; 3],
    /// Of `Shear`, each lane along its own fastest axis.
    slopes: [L; 3],
    /// By axis: the lanes that move fastest along it.
    fastest: [u32; 3],
    hits: [Hit; GROUP],
    until: [f32; GROUP],
    /// By lane: the depth of the ray's start, and depth for t.
    depth: [[f32; GROUP]; 2],
}

impl<L: Lanes> Group<L> {
    #[inline(always)]
    fn new(rays: &[Ray], axes: &Axes) -> Group<L> {
        let (mut origin, mut slopes) = ([[0.0; GROUP]; 3], [[0.0; GROUP]; 3]);
        let mut group = Group {
            origin: [L::splat(0.0); 3],
            slopes: [L::splat(0.0); 3],
            fastest: [0; 3],
            hits: [Hit::MISS; GROUP],
            until: [-1.0; GROUP],
            depth: [[0.0; GROUP]; 2],
        };
        let z = axes.axes[2];
        for (lane, ray) in rays.iter().enumerate() {
            let shear = Shear::new(ray);
            group.fastest[shear.axis] |= 1 << lane;
            group.until[lane] = ray.until;
            group.depth[0][lane] = (ray.origin[z] - axes.front) * axes.sign;
            group.depth[1][lane] = ray.direction[z] * axes.sign;
            for k in 0..3 {
                origin[k][lane] = ray.origin[k];
                slopes[k][lane] = shear.slopes[k];
            }
        }
        group.origin = origin.map(|o| L::load(&o));
        group.slopes = slopes.map(|s| L::load(&s));
        group
    }

    /// Behind this depth nothing can be nearer than what every ray has.
    #[inline(always)]
    fn deepest(&self) -> f32 {
        let depth = |lane: usize| self.depth[0][lane] + self.depth[1][lane] * self.hits[lane].t.min(self.until[lane].max(0.0));
        (0..GROUP).map(depth).fold(0.0, f32::max)
    }

    /// Tests one block, and says whether a ray has met something nearer.
    #[inline(always)]
    fn block(&mut self, block: &Block, mut lanes: u32, rays: &[Ray]) -> bool {
        let mut nearer = false;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            for axis in 0..3 {
                if self.fastest[axis] != 0 {
                    nearer |= self.triangle(block, lane, axis, rays);
                }
            }
        }
        nearer
    }

    /// `Shear::meet` for the lanes that move fastest along one axis.
    #[inline(always)]
    fn triangle(&mut self, block: &Block, lane: usize, axis: usize, rays: &[Ray]) -> bool {
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let corner = |i: usize| {
            let [x, y, z] = std::array::from_fn(|k| L::splat(block.corners[i][axes[k]][lane]).sub(self.origin[axes[k]]));
            [x.sub(self.slopes[0].mul(z)), y.sub(self.slopes[1].mul(z)), self.slopes[2].mul(z)]
        };
        let (inside, exact, ts) = meet(corner(0), corner(1), corner(2));
        let mut inside = inside & self.fastest[axis];
        if inside == 0 {
            return false;
        }
        let triangle = block.triangles[lane];
        let ts = ts().store();
        let mut nearer = false;
        while inside != 0 {
            let ray = inside.trailing_zeros() as usize;
            inside &= inside - 1;
            let best = &mut self.hits[ray];
            let before = *best;
            if exact >> ray & 1 == 1 {
                Shear::new(&rays[ray]).update(&block.lane(lane), triangle, self.until[ray], best);
            } else {
                let hit = Hit { t: ts[ray], triangle };
                if hit.t >= 0.0 && hit.t <= self.until[ray] && hit.before(best) {
                    *best = hit;
                }
            }
            nearer |= *best != before;
        }
        nearer
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
    let mut group = Group::<L>::new(rays, axes);
    let mut until = f32::INFINITY;
    for item in items {
        let mut only = item.children;
        stack[0] = (item.node, 0.0);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, near) = stack[height];
            if near > until {
                continue;
            }
            if at & LEAF == 0 {
                let node = &wide.nodes[at as usize];
                let (met, near) = planes.boxes(node, until);
                let met = met & only;
                only = !0;
                if met != 0 {
                    push(stack, &mut height, met, &node.children, &near.store());
                }
            } else {
                let block = &wide.blocks[(at & !LEAF) as usize];
                let lanes = if block.count > 1 { planes.triangles(block) } else { 1 } & ((1 << block.count) - 1);
                if group.block(block, lanes, rays) {
                    until = group.deepest() + axes.widening;
                }
            }
        }
    }
    hits.copy_from_slice(&group.hits[..rays.len()]);
}
