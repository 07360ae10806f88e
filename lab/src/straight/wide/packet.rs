//! Packets of any size through the wide tree, split as they descend.
//!
//! Sei 2008 splits a packet in 4 or 16 at each node. Here packet and tree are descended together: a packet carries the list of those nodes
//! that its hull reaches, each opened for as long as that throws away more children than it keeps. Then the packet is split, and each part
//! sifts the list with its own, narrower hull. What is left at the end is sixteen rays, or 64 from one eye, and the few small nodes in
//! front of them, nearest first. The nodes above are opened once for all rays, whatever the size of the packet, and no node is opened for
//! rays that cannot reach it.

use std::ops::Range;

use super::best::GROUP;
use super::eye::{self, Laid, Run, TOGETHER};
use super::group::{EIGHT, Item, group, push};
use super::hull::{Axes, Hull, Planes};
use super::lanes::{Eight, Pair, Portable, Sixteen};
#[cfg(target_arch = "x86_64")]
use super::lanes_x86::{Avx, Avx512};
use super::sweep;
use super::tree::{Instructions, STACK, Stack, Waits, Wide};
use crate::straight::ray::{Hit, Ray};

/// So many groups at most share their last list, the one that is sorted; twice as many are as fast.
const SHARE: usize = TOGETHER;

/// A node is kept closed while a packet reaches at least this many of its children: its parts will throw away more.
const CLOSED: u32 = 3;

/// Packets whose slopes differ by more do not sift: they reach almost everything.
const SIFTED: f32 = 0.5;

/// Groups whose slopes differ by more share too little and go one by one. Measured on mirrored and scattered rays: anything between a
/// twentieth and a fifth is as good; rays from an eye are far below.
const NARROW: f32 = 0.1;

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
    /// The groups, where all rays start in one point.
    laid: Vec<Laid>,
    /// Of each [`SHARE`] groups.
    wider: Vec<Hull>,
    stack: Box<Stack>,
}

impl Default for Packets {
    fn default() -> Packets {
        Packets {
            items: Vec::new(),
            parts: Vec::new(),
            hulls: Vec::new(),
            laid: Vec::new(),
            wider: Vec::new(),
            stack: Box::new([Waits::default(); STACK]),
        }
    }
}

impl Wide {
    /// The nearest triangle that each ray meets; the same bits as [`Wide::closest_each`]. The rays are taken in the order given, so that
    /// neighbours in the list should be neighbours in space ([`crate::straight::order::tiles`] arranges a picture): any set gives the right
    /// answer, a good order a fast one.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn closest_packet(&self, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        match self.instructions {
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            // SAFETY: only what was detected is chosen.
            Instructions::Avx512 => unsafe { packet_avx512(self, rays, hits, packets) },
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            // SAFETY: as above.
            Instructions::Avx2 => unsafe { packet_avx2(self, rays, hits, packets) },
            _ => packet::<Portable, Pair<Portable>>(self, rays, hits, packets),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
fn packet_avx512(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    packet::<Avx, Avx512>(wide, rays, hits, packets);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
fn packet_avx2(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    packet::<Avx, Pair<Avx>>(wide, rays, hits, packets);
}

#[inline(always)]
fn packet<L: Eight, S: Sixteen>(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    if wide.nodes.is_empty() {
        hits.fill(Hit::MISS);
        return;
    }
    if rays.is_empty() {
        return;
    }
    let Packets { hulls, laid, .. } = packets;
    let swept = match sweep::from_eye::<S>(wide, rays, hulls, laid) {
        Some(axes) => Some((axes, true)),
        None => sweep::from_anywhere::<L>(wide, rays, hulls).map(|axes| (axes, false)),
    };
    match swept {
        Some((axes, from_eye)) => descend::<L, S>(wide, rays, hits, &axes, from_eye, packets),
        None => halves(wide, rays, hits, packets),
    }
}

/// Rays without a common direction: halves may have one, eight rays need none.
#[inline(always)]
fn halves(wide: &Wide, rays: &[Ray], hits: &mut [Hit], packets: &mut Packets) {
    if rays.len() <= EIGHT {
        wide.each::<false>(rays, hits, &mut packets.stack);
    } else {
        let middle = (rays.len() / 2).next_multiple_of(EIGHT);
        let (first, second) = hits.split_at_mut(middle);
        wide.closest_packet(&rays[..middle], first, packets);
        wide.closest_packet(&rays[middle..], second, packets);
    }
}

/// Rays along common axes, once `packets` has their groups.
#[inline(always)]
fn descend<L: Eight, S: Sixteen>(wide: &Wide, rays: &[Ray], hits: &mut [Hit], axes: &Axes, from_eye: bool, packets: &mut Packets) {
    let Packets { items, parts, hulls, laid, wider, stack } = packets;
    wider.clear();
    for hulls in hulls.chunks(SHARE) {
        wider.push(Hull::around(hulls));
    }
    let swept = Swept { wide, rays, axes, hulls, wider, laid: from_eye.then_some(laid) };
    items.clear();
    items.push(Item { node: 0, children: !0, near: 0.0 });
    parts.clear();
    parts.push(Part { first: 0, count: hulls.len(), items: [0, 1] });
    while let Some(part) = parts.pop() {
        let Some([first, end]) = swept.sift::<L>(&part, items, stack) else {
            hits[swept.run(part.groups())].fill(Hit::MISS);
            continue;
        };
        if part.count > SHARE {
            part.split([first, end], parts);
        } else {
            swept.finish::<L, S>(part.groups(), hits, &items[first..end], stack);
        }
    }
}

impl Part {
    #[inline(always)]
    fn groups(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// Leaves the same `items` to each of four or so parts. Parts begin at multiples of [`SHARE`], as [`Packets::wider`] has them.
    #[inline(always)]
    fn split(&self, items: [usize; 2], parts: &mut Vec<Part>) {
        // In 16 or in 64 is as fast.
        let size = (self.count.next_power_of_two() / 4).max(SHARE);
        for first in self.groups().step_by(size).rev() {
            parts.push(Part { first, count: size.min(self.first + self.count - first), items });
        }
    }
}

/// The rays of a packet along their common axes, and what they sweep.
struct Swept<'a> {
    wide: &'a Wide,
    rays: &'a [Ray],
    axes: &'a Axes,
    /// Of each group.
    hulls: &'a [Hull],
    /// Of each [`SHARE`] groups.
    wider: &'a [Hull],
    /// The groups, where all rays start in one point.
    laid: Option<&'a [Laid]>,
}

impl Swept<'_> {
    /// The rays of these groups.
    #[inline(always)]
    fn run(&self, groups: Range<usize>) -> Range<usize> {
        groups.start * GROUP..(groups.end * GROUP).min(self.rays.len())
    }

    /// Sifts the items of a part, if its hull is narrow, and says which run of items is left for it; None if nothing is.
    #[inline(always)]
    fn sift<L: Eight>(&self, part: &Part, items: &mut Vec<Item>, stack: &mut Stack) -> Option<[usize; 2]> {
        let [start, end] = part.items;
        items.truncate(end);
        if part.count <= 1 {
            return Some([start, end]);
        }
        let groups = part.groups();
        let hull = Hull::around(&self.wider[groups.start / SHARE..groups.end.div_ceil(SHARE)]);
        if !hull.is_narrow(SIFTED) {
            return Some([start, end]);
        }
        let planes = Planes::<L>::new(&hull, self.axes);
        for i in start..end {
            open(self.wide, &planes, items[i], items, stack);
        }
        if items.len() == end {
            return None;
        }
        if part.count <= SHARE {
            // What is nearest first hides most of the rest from each group.
            items[end..].sort_unstable_by(|a, b| a.near.total_cmp(&b.near));
        }
        Some([end, items.len()])
    }

    /// The groups of a part, through the items that are left for it.
    #[inline(always)]
    fn finish<L: Eight, S: Sixteen>(&self, groups: Range<usize>, hits: &mut [Hit], items: &[Item], stack: &mut Stack) {
        let Swept { wide, rays, axes, hulls, .. } = *self;
        if let Some(laid) = self.laid
            && hulls[groups.clone()].iter().all(|hull| hull.is_along_z() && hull.is_narrow(NARROW))
        {
            let run = self.run(groups.clone());
            let eye = Run { rays: &rays[run.clone()], laid: &laid[groups.clone()], hulls: &hulls[groups] };
            eye::descend::<L, S>(wide, &eye, &mut hits[run], axes, items, stack);
            return;
        }
        for at in groups {
            let run = self.run(at..at + 1);
            if hulls[at].is_narrow(NARROW) {
                let planes = Planes::<L>::new(&hulls[at], axes);
                group::<L, S>(wide, &rays[run.clone()], &mut hits[run], axes, &planes, items, stack);
            } else {
                wide.each::<false>(&rays[run.clone()], &mut hits[run], stack);
            }
        }
    }
}

/// Opens an item for a packet as far as it pays, and adds what is left to the list, nearest first.
#[inline(always)]
fn open<L: Eight>(wide: &Wide, planes: &Planes<L>, item: Item, items: &mut Vec<Item>, stack: &mut Stack) {
    let mut only = item.children;
    stack[0] = Waits { child: item.node, near: 0.0, place: 0 };
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let at = stack[height].child;
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
        push::<L>(wide, stack, &mut height, inner, at, &nears);
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
