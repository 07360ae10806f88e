//! Packets of any size through the wide tree, split as they descend.
//!
//! Paper 4 splits a packet in 4 or 16 at each node. Here packet and tree are descended together: a packet carries the list of those nodes that its
//! hull reaches, each opened for as long as that throws away more children than it keeps. Then the packet is split, and each part sifts the list with
//! its own, narrower hull. What is left at the end is sixteen rays and the few small nodes in front of them, nearest first. The nodes above are opened once
//! for all rays, whatever the size of the packet, and no node is opened for rays that cannot reach it.

use super::hull::{Axes, Hull, Planes};
use super::lanes::{Lanes, Portable};
use super::ray::{Hit, Ray, widening};
use super::triangle::fastest;
use super::wide::{STACK, Wide};
use super::wide_group::{EIGHT, Item, eight, group, lanes, push};

/// Eights that descend together: a look at a node costs the same for one as for two, and 4 × 4 pixels have hardly more in front of them than 4 × 2.
const EIGHTS: usize = 2;

/// Rays of a group.
const GROUP: usize = EIGHT * EIGHTS;

/// So many groups at most share their last list, the one that is sorted; twice as many are as fast.
const SHARE: usize = 4;

/// A node is kept closed while a packet reaches at least this many of its children: its parts will throw away more.
const CLOSED: u32 = 4;

/// Packets whose slopes differ by more do not sift: they reach almost everything.
const SIFTED: f32 = 0.5;

/// Groups whose slopes differ by more share too little and go one by one. Measured on mirrored and scattered rays: anything between a twentieth
/// and a fifth is as good; rays from an eye are far below.
const TOGETHER: f32 = 0.1;

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
    /// Of each [`SHARE`] groups.
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
        if rays.len() <= EIGHT {
            wide.each::<false>(rays, hits, &mut packets.stack);
        } else {
            let middle = (rays.len() / 2).next_multiple_of(EIGHT);
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
            let hull = united(&wider[groups.start / SHARE..groups.end.div_ceil(SHARE)]);
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
                if part.count <= SHARE {
                    // What is nearest first hides most of the rest from each group.
                    items[end..].sort_unstable_by(|a, b| a.near.total_cmp(&b.near));
                }
            }
        }
        if part.count > SHARE {
            // In 16 or in 64 is as fast. Parts begin at multiples of `SHARE`, as `wider` has them.
            let size = (part.count.next_power_of_two() / 4).max(SHARE);
            for first in groups.step_by(size).rev() {
                parts.push(Part { first, count: size.min(part.first + part.count - first), items: list });
            }
            continue;
        }
        for at in groups {
            let run = at * GROUP..((at + 1) * GROUP).min(rays.len());
            if hulls[at].is_narrow(TOGETHER) {
                let planes = Planes::<L>::new(&hulls[at], &axes);
                let items = &items[list[0]..list[1]];
                if run.len() > EIGHT {
                    group::<L, EIGHTS>(wide, &rays[run.clone()], &mut hits[run], &axes, &planes, items, stack);
                } else {
                    group::<L, 1>(wide, &rays[run.clone()], &mut hits[run], &axes, &planes, items, stack);
                }
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

/// The common direction of the rays, the hull of each group and of each [`SHARE`] groups; None if they have none.
#[inline(always)]
fn sweep<L: Lanes>(wide: &Wide, rays: &[Ray], hulls: &mut Vec<Hull>, wider: &mut Vec<Hull>) -> Option<Axes> {
    let mut spare = [rays[0]; EIGHT];
    let middle = rays[rays.len() / 2].direction;
    let z = fastest(middle);
    let axes = [(z + 1) % 3, (z + 2) % 3, z];
    let sign = 1f32.copysign(middle[z]);
    let (mut low, mut high) = ([L::splat(f32::INFINITY); 3], [L::splat(f32::NEG_INFINITY); 3]);
    for rays in rays.chunks(EIGHT) {
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
    for (number, rays) in rays.chunks(EIGHT).enumerate() {
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
        if number % EIGHTS == 0 {
            hulls.push(hull);
        } else if let Some(last) = hulls.last_mut() {
            *last = last.union(&hull);
        }
    }
    for hulls in hulls.chunks(SHARE) {
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
