//! What sixteen rays have met so far, and how a triangle comes to be it.

use super::lanes::{Mask, Sixteen};
use super::ray::Met;
use super::tree::Block;
use crate::straight::ray::{Hit, Ray};
use crate::straight::triangle::Shear;

/// Rays that descend together: a look at a node costs the same for all, and 4 × 4 pixels have hardly more in front of them than 4 × 2.
pub(super) const GROUP: usize = 16;

/// Sixteen rays or fewer, lane by lane, and the nearest that each has met.
#[derive(Clone, Copy)]
pub(super) struct Best<'a, S> {
    pub rays: &'a [Ray],
    /// The last t that counts.
    pub until: S,
    pub t: S,
    /// Numbers of triangles as bits.
    pub triangle: S,
}

impl<'a, S: Sixteen> Best<'a, S> {
    /// Nothing yet.
    #[inline(always)]
    pub fn new(rays: &'a [Ray], until: S) -> Best<'a, S> {
        Best { rays, until, t: S::splat(Hit::MISS.t), triangle: S::splat(f32::from_bits(Hit::NONE)) }
    }

    /// The last t that is still worth looking at.
    #[inline(always)]
    pub fn last(&self) -> S {
        self.t.min(self.until)
    }

    /// Takes up where rays have `met` the triangle in one lane of a block, those that are `inside` it, and says whether that is nearer for
    /// any.
    #[inline(always)]
    pub fn take(&mut self, met: &Met<S>, inside: S::Mask, block: &Block, lane: usize) -> bool {
        if inside.bits() == 0 {
            return false;
        }
        let number = block.triangles[lane];
        let t = met.t();
        let nearer = inside.and(S::splat(0.0).at_most(t)).and(t.at_most(self.until)).and(t.at_most(self.t));
        // What happens seldom is done one by one: an edge function of 0, or the same t as the best.
        let seldom = met.exact().and(inside).or(nearer.and(self.t.at_most(t)));
        if seldom.bits() != 0 {
            return self.one_by_one(inside.bits(), &block.lane(lane), number);
        }
        self.t = S::select(nearer, t, self.t);
        self.triangle = S::select(nearer, S::splat(f32::from_bits(number)), self.triangle);
        nearer.bits() != 0
    }

    #[inline(never)]
    fn one_by_one(&mut self, lanes: u32, corners: &[[f32; 3]; 3], number: u32) -> bool {
        let mut hits = self.hits();
        let before = hits;
        for (lane, ray) in self.rays.iter().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1) {
            Shear::new(ray).update(corners, number, ray.until, &mut hits[lane]);
        }
        self.t = S::load(&hits.map(|hit| hit.t));
        self.triangle = S::load(&hits.map(|hit| f32::from_bits(hit.triangle)));
        hits != before
    }

    /// Ray by ray.
    #[inline(always)]
    pub fn hits(&self) -> [Hit; GROUP] {
        bytemuck::cast(self.t.beside(self.triangle))
    }
}
