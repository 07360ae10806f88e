//! One ray through the wide tree: eight boxes or eight triangles at a time.

use super::lanes::{Eight, Lanes, Mask, Portable};
use super::tree::{Block, Instructions, LEAF, NOBODY, STACK, Stack, Waits, Wide, Wide8, leaf, wait};
use crate::straight::ray::{Hit, Ray, Slabs, widening};
use crate::straight::triangle::Shear;

impl Wide {
    /// The nearest triangle that each ray meets, ray by ray. `hits` is as long as `rays`.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn closest_each(&self, rays: &[Ray], hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        let mut stack = [Waits::default(); STACK];
        self.each::<false>(rays, hits, &mut stack);
    }

    /// Whether each ray meets anything before its end; the hit is any that was found.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn any_each(&self, rays: &[Ray], hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        let mut stack = [Waits::default(); STACK];
        self.each::<true>(rays, hits, &mut stack);
    }

    /// Asks for the memory of a child.
    #[inline(always)]
    pub(super) fn fetch<L: Eight>(&self, child: u32) {
        if child & LEAF == 0 {
            L::prefetch(&self.nodes[child as usize]);
        } else {
            L::prefetch(&self.blocks[leaf(child).0]);
        }
    }

    pub(super) fn each<const ANY: bool>(&self, rays: &[Ray], hits: &mut [Hit], stack: &mut Stack) {
        #[cfg(target_arch = "x86_64")]
        if self.instructions != Instructions::Portable {
            #[allow(unsafe_code)]
            // SAFETY: only what was detected is chosen.
            return unsafe { each_avx::<ANY>(self, rays, hits, stack) };
        }
        each::<Portable, ANY>(self, rays, hits, stack);
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
fn each_avx<const ANY: bool>(wide: &Wide, rays: &[Ray], hits: &mut [Hit], stack: &mut Stack) {
    each::<super::lanes_x86::Avx, ANY>(wide, rays, hits, stack);
}

#[inline(always)]
fn each<L: Eight, const ANY: bool>(wide: &Wide, rays: &[Ray], hits: &mut [Hit], stack: &mut Stack) {
    for (ray, hit) in rays.iter().zip(hits) {
        *hit = descend::<L, ANY>(wide, ray, stack);
    }
}

#[inline(always)]
fn descend<L: Eight, const ANY: bool>(wide: &Wide, ray: &Ray, stack: &mut Stack) -> Hit {
    let mut best = Hit::MISS;
    if wide.nodes.is_empty() {
        return best;
    }
    let slabs = Slabs::new(ray, widening(&wide.root, ray.origin));
    // Built here and not in a constructor: with one, single rays take a tenth longer.
    let line = Line::<L> {
        inverse: splat(slabs.inverse),
        enter: splat(slabs.enter),
        leave: splat(slabs.leave),
        first: slabs.inverse.map(|i| usize::from(i.is_sign_negative())),
    };
    let shear = Shear::new(ray);
    let mut until = ray.until;
    stack[0] = Waits::default();
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let Waits { child, near, .. } = stack[height];
        if near > until {
            continue;
        }
        let at = nearest_leaf(wide, &line, child, until, stack, &mut height);
        if at != NOBODY {
            block::<L>(&wide.blocks[leaf(at).0], &shear, ray.until, &mut best);
            until = until.min(best.t);
            if ANY && best.is_hit() {
                break;
            }
        }
    }
    best
}

/// One ray, laid out for eight boxes at once.
struct Line<L> {
    /// As in [`Slabs`].
    inverse: [L; 3],
    enter: [L; 3],
    leave: [L; 3],
    /// By axis: which of a box's two sides the ray comes to first.
    first: [usize; 3],
}

impl<L: Eight> Line<L> {
    /// Which of a node's boxes the ray meets before `until`, and where they begin.
    #[inline(always)]
    fn boxes(&self, node: &Wide8, until: f32) -> (u32, L) {
        let (mut near, mut far) = (L::splat(0.0), L::splat(until));
        for axis in 0..3 {
            let first = self.first[axis];
            let [low, high]: [L; 2] = [L::load(&node.bounds[axis][first]), L::load(&node.bounds[axis][1 - first])];
            // As in `Slabs::enter`: what is not a number loses against the second operand.
            near = low.sub(self.enter[axis]).mul(self.inverse[axis]).max(near);
            far = high.sub(self.leave[axis]).mul(self.inverse[axis]).min(far);
        }
        (near.at_most(far).bits(), near)
    }
}

/// The leaf that a ray comes to by the nearest box of each node, from the child `at` on; [`NOBODY`] where it meets none. The other boxes
/// that it meets wait on the stack.
#[inline(always)]
fn nearest_leaf<L: Eight>(wide: &Wide, line: &Line<L>, mut at: u32, until: f32, stack: &mut Stack, height: &mut usize) -> u32 {
    while at & LEAF == 0 {
        let node = &wide.nodes[at as usize];
        let (mut met, near) = line.boxes(node, until);
        if met == 0 {
            return NOBODY;
        }
        let nears = near.store();
        let lane = met.trailing_zeros() as usize;
        met &= met - 1;
        at = node.children[lane];
        if met == 0 {
            continue;
        }
        // The nearest goes on; the others wait.
        let mut nearest = nears[lane];
        let ground = *height;
        while met != 0 {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            let mut waits = Waits { child: node.children[lane], near: nears[lane], place: 0 };
            wide.fetch::<L>(waits.child);
            if waits.near < nearest {
                std::mem::swap(&mut waits.child, &mut at);
                std::mem::swap(&mut waits.near, &mut nearest);
            }
            wait(stack, ground, height, waits);
        }
    }
    at
}

// Here and wherever lanes are worked on there is no closure that touches them: a closure is compiled without the wide instructions of the
// function it stands in, and then every operation on lanes is a call. That made rays three times slower.

/// The same three numbers in every lane.
#[inline(always)]
pub(super) fn splat<L: Lanes>([x, y, z]: [f32; 3]) -> [L; 3] {
    [L::splat(x), L::splat(y), L::splat(z)]
}

/// Three coordinates of eight points, in the order of `axes`.
#[inline(always)]
pub(super) fn load<L: Eight>(coordinates: &[[f32; 8]; 3], axes: [usize; 3]) -> [L; 3] {
    [L::load(&coordinates[axes[0]]), L::load(&coordinates[axes[1]]), L::load(&coordinates[axes[2]])]
}

/// A corner as `Shear` sees it from a ray's origin.
#[inline(always)]
pub(super) fn sheared<L: Lanes>(corner: [L; 3], origin: [L; 3], slopes: [L; 3]) -> [L; 3] {
    let (x, y, z) = (corner[0].sub(origin[0]), corner[1].sub(origin[1]), corner[2].sub(origin[2]));
    [x.sub(slopes[0].mul(z)), y.sub(slopes[1].mul(z)), slopes[2].mul(z)]
}

/// Tests the triangles of one block: `Shear::meet`, operation by operation.
#[inline(always)]
pub(super) fn block<L: Eight>(block: &Block, shear: &Shear, until: f32, best: &mut Hit) {
    let axes = [(shear.axis + 1) % 3, (shear.axis + 2) % 3, shear.axis];
    let slopes: [L; 3] = splat(shear.slopes);
    let origin = splat([shear.origin[axes[0]], shear.origin[axes[1]], shear.origin[axes[2]]]);
    let met = meet(
        sheared(load(&block.corners[0], axes), origin, slopes),
        sheared(load(&block.corners[1], axes), origin, slopes),
        sheared(load(&block.corners[2], axes), origin, slopes),
    );
    let mut inside = met.inside.bits();
    if inside == 0 {
        return;
    }
    let (exact, ts) = (met.exact().bits(), met.t().store());
    while inside != 0 {
        let lane = inside.trailing_zeros() as usize;
        inside &= inside - 1;
        let hit = Hit { t: ts[lane], triangle: block.triangles[lane] };
        if exact >> lane & 1 == 1 {
            shear.update(&block.lane(lane), hit.triangle, until, best);
        } else if hit.t >= 0.0 && hit.t <= until && hit.before(best) {
            *best = hit;
        }
    }
}

/// Pairs of a ray and a triangle that may meet.
#[derive(Clone, Copy)]
pub(super) struct Met<L: Lanes> {
    edges: [L; 3],
    depths: [L; 3],
    least: L,
    most: L,
    /// Mask: the edges are of one sign.
    pub inside: L::Mask,
}

/// `Shear::meet` for as many pairs as there are lanes, given their sheared corners.
#[inline(always)]
pub(super) fn meet<L: Lanes>(a: [L; 3], b: [L; 3], c: [L; 3]) -> Met<L> {
    let u = c[0].mul(b[1]).sub(c[1].mul(b[0]));
    let v = a[0].mul(c[1]).sub(a[1].mul(c[0]));
    let w = b[0].mul(a[1]).sub(b[1].mul(a[0]));
    let zero = L::splat(0.0);
    let (least, most) = (u.min(v).min(w), u.max(v).max(w));
    let inside = zero.at_most(least).or(most.at_most(zero));
    Met { edges: [u, v, w], depths: [a[2], b[2], c[2]], least, most, inside }
}

impl<L: Lanes> Met<L> {
    /// Mask: pairs inside that have an edge function of 0, whose sign only f64 can tell. (Beside edges of both signs it does not matter.)
    #[inline(always)]
    pub fn exact(&self) -> L::Mask {
        let zero = L::splat(0.0);
        // One sign: either the least is 0 and none is below, or the most is 0 and none is above.
        let touches = zero.at_most(self.least).and(self.least.at_most(zero)).or(zero.at_most(self.most).and(self.most.at_most(zero)));
        touches.and(self.inside)
    }

    /// t of each pair.
    #[inline(always)]
    pub fn t(&self) -> L {
        let [u, v, w] = self.edges;
        let whole = u.add(v).add(w);
        u.mul(self.depths[0]).add(v.mul(self.depths[1])).add(w.mul(self.depths[2])).div(whole)
    }
}
