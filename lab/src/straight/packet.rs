//! Packets of rays from one eye through the binary tree, after Wald et al. 2007 and after Sei 2008: chapter 3.4 without a split,
//! chapter 4 with one split in four at each node, section 4.4 with two (in sixteen); more are allowed.

use super::bounds::Bounds;
use super::bundle::{EyePacket, Ready};
use super::ray::{Hit, Ray, Slabs, widening};
use super::single::Mesh;
use super::split::{Bundle, bundles};
use super::triangle::Shear;

/// A packet is split at most this often at one node.
pub const MOST_SPLITS: u32 = 3;

/// What a packet needs to remember on its way; keep one for each thread.
#[derive(Clone, Debug, Default)]
pub struct EyePackets {
    rays: Vec<Ready>,
    bundles: Vec<Bundle>,
}

impl Mesh {
    /// The nearest triangle that each ray of a packet meets; the same bits as [`Mesh::closest`]. `splits` is how often a packet may be
    /// split in four at one node: 0 for the packets of Wald et al. 2007, 1 and 2 for those of Sei 2008. Planes are made anew here: the eye
    /// may move from call to call.
    ///
    /// # Panics
    /// When the lengths of directions and hits differ, or with more than [`MOST_SPLITS`].
    pub fn closest_packet(&self, packet: &EyePacket, splits: u32, hits: &mut [Hit], scratch: &mut EyePackets) {
        assert_eq!(packet.directions.len(), hits.len(), "one hit a ray");
        assert!(splits <= MOST_SPLITS, "{splits} splits at one node; {MOST_SPLITS} at most");
        hits.fill(Hit::MISS);
        let Some(root) = self.tree.nodes.first() else { return };
        if hits.is_empty() {
            return;
        }
        let wide = widening(&root.bounds, packet.eye);
        let EyePackets { rays, bundles: list } = scratch;
        rays.clear();
        rays.extend(packet.directions.iter().map(|&direction| {
            let ray = Ray::new(packet.eye, direction);
            Ready { slabs: Slabs::new(&ray, wide), shear: Shear::new(&ray) }
        }));
        bundles(packet, rays, splits > 0, list);
        Descent { mesh: self, rays, bundles: list, splits, wide, hits }.enter(0, 0, 0);
    }
}

struct Descent<'a> {
    mesh: &'a Mesh,
    rays: &'a [Ready],
    bundles: &'a [Bundle],
    splits: u32,
    wide: f32,
    hits: &'a mut [Hit],
}

/// Bundles that a split leaves.
struct Parts {
    list: [usize; Parts::MOST],
    count: usize,
}

impl Parts {
    const MOST: usize = 1 << (2 * MOST_SPLITS);
}

impl Descent<'_> {
    /// Sei 2008, figures 3.10 and 4.7: takes a bundle into a node. Rays before `first` have missed an ancestor of it.
    fn enter(&mut self, node: usize, bundle: usize, first: usize) {
        let bounds = self.mesh.tree.nodes[node].bounds;
        let this = &self.bundles[bundle];
        // Early hit test; if it fails, early miss exit; packet test of last resort.
        let mut first = first.max(this.first);
        if !self.meets(first, &bounds) {
            if this.misses(&bounds) {
                return;
            }
            first += 1;
            while first < this.end && !self.meets(first, &bounds) {
                first += 1;
            }
            if first == this.end {
                return;
            }
        }
        let mut parts = Parts { list: [0; Parts::MOST], count: 0 };
        self.keep(&bounds, bundle, self.splits, &mut parts);
        let list = &parts.list[..parts.count];
        let rays: usize = list.iter().map(|&part| self.bundles[part].end - self.bundles[part].first).sum();
        if 2 * rays > this.end - this.first {
            // Several small packets would do more work than one that drags some rays along.
            return self.open(node, bundle, first);
        }
        for &part in list.iter().filter(|&&part| first < self.bundles[part].end) {
            self.open(node, part, first.max(self.bundles[part].first));
        }
    }

    /// Lists the parts of a bundle that a box can be seen in, after `left` splits; four parts that are all kept stay together.
    fn keep(&self, bounds: &Bounds<f32>, bundle: usize, left: u32, parts: &mut Parts) {
        let this = &self.bundles[bundle];
        if left > 0 && this.parts != 0 {
            let sides = this.planes.map(|plane| plane.side(bounds, this.eye, self.wide));
            let start = parts.count;
            for part in 0..4 {
                // Parts 1 and 3 lie to the right, 2 and 3 below.
                if sides[0].reaches(part & 1 == 1) && sides[1].reaches(part & 2 == 2) {
                    self.keep(bounds, this.parts + part, left - 1, parts);
                }
            }
            if parts.list[start..parts.count] != [0, 1, 2, 3].map(|part| this.parts + part) {
                return;
            }
            parts.count = start;
        }
        parts.list[parts.count] = bundle;
        parts.count += 1;
    }

    fn open(&mut self, node: usize, bundle: usize, first: usize) {
        let this = &self.mesh.tree.nodes[node];
        if this.is_leaf() {
            for ray in first..self.bundles[bundle].end {
                if !self.meets(ray, &this.bounds) {
                    continue;
                }
                for place in this.run() {
                    let number = self.mesh.tree.order[place];
                    self.rays[ray].shear.update(&self.mesh.corners[place], number, f32::INFINITY, &mut self.hits[ray]);
                }
            }
            return;
        }
        // Ordered traversal: nearer first, as the first active ray sees it.
        let [left, right] = this.children();
        let near = |child: usize| self.rays[first].slabs.enter(&self.mesh.tree.nodes[child].bounds, f32::INFINITY).unwrap_or(f32::INFINITY);
        let (one, other) = if near(left) <= near(right) { (left, right) } else { (right, left) };
        self.enter(one, bundle, first);
        self.enter(other, bundle, first);
    }

    #[inline]
    fn meets(&self, ray: usize, bounds: &Bounds<f32>) -> bool {
        self.rays[ray].slabs.enter(bounds, self.hits[ray].t).is_some()
    }
}
