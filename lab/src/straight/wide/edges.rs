//! Which triangles of a block rays from one eye may meet, at two products an edge.
//!
//! Seen from the eye, an edge from P to Q is the plane with the normal P × Q = P × (Q − P); a ray of slopes (x, y, 1) is on the side that
//! the sign of normal · (x, y, 1) tells. That is the edge function of `Shear`, but for rounding: so it only leaves out, by a margin that
//! covers both roundings, and `Shear` decides on what is left.

use super::group::ALL;
use super::lanes::{Eight, Lanes, Mask, Sixteen};
use super::ray::{load, splat};
use super::tree::Block;

/// Units in the last place, relative to the eye's distance times an edge's length, by which an edge function must have a sign for it to
/// count: 2⁻¹⁹ are 32 of 2⁻²⁴.
///
/// `Shear` puts each corner 3 units of the distance at most beside its place in x and in y, which moves an edge by 4.3 times its length,
/// itself at most twice the sum of its components' sizes: 8.5. The normal here is off by 6, the two products and sums by 8.
const MARGIN: f32 = 1.0 / (1 << 19) as f32;

/// The planes through an eye and the edges of up to eight triangles.
pub(super) struct Edges {
    /// By edge and axis of the shear (z last).
    normals: [[[f32; 8]; 3]; 3],
    margins: [f32; 8],
}

impl Edges {
    /// `axis`: along which the rays move fastest.
    #[inline(always)]
    pub fn new<L: Eight>(block: &Block, eye: [f32; 3], axis: usize) -> Edges {
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let eye = splat([eye[axes[0]], eye[axes[1]], eye[axes[2]]]);
        let a = from::<L>(load(&block.corners[0], axes), eye);
        let b = from::<L>(load(&block.corners[1], axes), eye);
        let c = from::<L>(load(&block.corners[2], axes), eye);
        let (u, v, w) = (from(b, c), from(c, a), from(a, b));
        let size = reach(u).max(reach(v)).max(reach(w));
        let far = farthest(a).max(farthest(b)).max(farthest(c));
        Edges {
            normals: [normal(c, u), normal(a, v), normal(b, w)],
            // Four times as much and back: infinite, so that nothing is left out, before any product above is. What underflows is less than
            // the last term.
            margins: far.mul(size.mul(L::splat(4.0))).mul(L::splat(0.25 * MARGIN)).add(L::splat(1e-36)).store(),
        }
    }

    /// Whether any of the rays with these slopes may meet the triangle in one lane.
    #[inline(always)]
    pub fn may_be_met<S: Sixteen>(&self, lane: usize, slopes: [S; 3]) -> bool {
        let (u, v, w) = (self.side(0, lane, slopes), self.side(1, lane, slopes), self.side(2, lane, slopes));
        let margin = S::splat(self.margins[lane]);
        let below = u.min(v).min(w).less(margin.negative());
        let above = margin.less(u.max(v).max(w));
        below.and(above).bits() != ALL
    }

    /// The edge function.
    #[inline(always)]
    fn side<S: Sixteen>(&self, edge: usize, lane: usize, slopes: [S; 3]) -> S {
        let [x, y, z] = &self.normals[edge];
        slopes[0].roughly(S::splat(x[lane]), slopes[1].roughly(S::splat(y[lane]), S::splat(z[lane])))
    }
}

#[inline(always)]
fn from<L: Lanes>(point: [L; 3], origin: [L; 3]) -> [L; 3] {
    [point[0].sub(origin[0]), point[1].sub(origin[1]), point[2].sub(origin[2])]
}

/// The sum of the sizes of the components.
#[inline(always)]
fn reach<L: Lanes>(edge: [L; 3]) -> L {
    edge[0].abs().add(edge[1].abs()).add(edge[2].abs())
}

/// The largest component.
#[inline(always)]
fn farthest<L: Lanes>(corner: [L; 3]) -> L {
    corner[0].abs().max(corner[1].abs()).max(corner[2].abs())
}

/// p × edge.
#[inline(always)]
fn normal<L: Eight>(p: [L; 3], edge: [L; 3]) -> [[f32; 8]; 3] {
    [
        p[1].mul(edge[2]).sub(p[2].mul(edge[1])).store(),
        p[2].mul(edge[0]).sub(p[0].mul(edge[2])).store(),
        p[0].mul(edge[1]).sub(p[1].mul(edge[0])).store(),
    ]
}

#[cfg(test)]
mod tests {
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::straight::ray::Ray;
    use crate::straight::triangle::{Shear, fastest};
    use crate::straight::wide::best::GROUP;
    use crate::straight::wide::lanes::{Pair, Portable};

    /// Triangles of any size and shape at any distance, and rays through their corners, along their edges and beside them: none that
    /// `Shear` says is met is left out, and of the others few are kept.
    #[test]
    fn what_is_met_is_never_left_out() {
        let mut random = StdRng::seed_from_u64(11);
        let (mut met, mut kept, mut all) = (0, 0, 0);
        for round in 0..20_000 {
            let mut number = |size: f32| random.random_range(-size..size);
            let eye = [number(3.0), number(3.0), number(3.0)];
            let size = 10f32.powf(number(4.0) - 2.0);
            let middle = [number(20.0), number(20.0), number(20.0)];
            let mut corners: [[f32; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|axis| middle[axis] + number(size)));
            if round % 3 == 0 {
                // A sliver: the third corner all but on the opposite edge.
                let part = 0.5 + number(0.4);
                corners[2] = std::array::from_fn(|axis| corners[0][axis] + part * (corners[1][axis] - corners[0][axis]) + number(1e-6));
            }
            let weights: [[f32; 3]; GROUP] = std::array::from_fn(|i| {
                let (a, b) = (number(1.5), number(1.5));
                match i {
                    0 => [1.0, 0.0, 0.0],
                    1 => [0.0, 1.0, 0.0],
                    2..6 => [a, 1.0 - a, 0.0],
                    6..9 => [0.0, a, 1.0 - a],
                    _ => [a, b, 1.0 - a - b],
                }
            });
            let rays = weights.map(|w| {
                Ray::new(eye, std::array::from_fn(|axis| (0..3).map(|corner| w[corner] * corners[corner][axis]).sum::<f32>() - eye[axis]))
            });
            let axis = fastest(rays[0].direction);
            let mut slopes = [[0f32; GROUP]; 3];
            for (i, ray) in rays.iter().enumerate() {
                // Rays that move fastest along another axis, or nowhere, are not asked together: they repeat the first.
                let ray = if fastest(ray.direction) == axis && ray.direction[axis] != 0.0 { ray } else { &rays[0] };
                let shear = Shear::new(ray);
                (slopes[0][i], slopes[1][i], slopes[2][i]) = (shear.slopes[0], shear.slopes[1], shear.slopes[2]);
            }
            let block = Block::new(&[0], &[corners]);
            let edges = Edges::new::<Portable>(&block, eye, axis);
            for i in 0..GROUP {
                // One ray at a time, so that no other one keeps the triangle.
                let one: [Pair<Portable>; 3] = std::array::from_fn(|k| Pair::splat(slopes[k][i]));
                let may = edges.may_be_met(0, one);
                let shear = Shear { origin: eye, axis, slopes: [slopes[0][i], slopes[1][i], slopes[2][i]] };
                let hit = shear.meet(&corners).is_some();
                assert!(may || !hit, "round {round}, ray {i}: {corners:?} from {eye:?}");
                // Of rays beside well shaped triangles hardly any may be kept in vain.
                if i >= 9 && fastest(rays[i].direction) == axis && size > 0.1 && round % 3 != 0 {
                    met += u32::from(hit);
                    kept += u32::from(may);
                    all += 1;
                }
            }
        }
        assert!(met > all / 20 && kept < met + met / 20, "{met} met, {kept} kept of {all}");
    }
}
