//! A piece of a ray against static bodies.

use glam::{DVec2, DVec3};

use super::piece::{Ends, Met, Piece};
use super::triangle::weights;
use crate::judge::geodesic::root;
use crate::judge::picture::world::World;

impl World<'_> {
    /// Intersects the piece with the `leaves` of the tree, or with all of it. Boxes are grown by `grow` (r_s).
    pub(super) fn meet_static(&self, piece: &Piece, ends: &Ends, grow: f64, leaves: Option<&[u32]>, met: &mut Option<Met>) {
        let [from, to] = ends.positions.map(|position| piece.embed(position));
        let span = piece.to - piece.from;
        let meet = |item: u32, until: f64| {
            let corners = self.static_bodies.triangles[item as usize].map(|i| self.static_bodies.vertices[i as usize]);
            let Some((elapsed, barycentrics)) = cross_static(piece, ends, corners) else { return until };
            let (thing, triangle) = self.static_bodies.owners[item as usize];
            Met { elapsed, thing, triangle, barycentrics }.offer(met);
            (elapsed - piece.from) / span
        };
        match leaves {
            Some(leaves) => self.static_bodies.tree.along_leaves(leaves, from, to, grow, meet),
            None => self.static_bodies.tree.along(from, to, grow, 1.0, meet),
        }
    }
}

/// The first crossing of a piece with a triangle that does not move.
///
/// The triangle's plane cuts the plane of the orbit in a line a·x = c. The path of light is strictly convex (u'' + u = (3/2)u² > 0) and
/// turns by less than half a turn in a segment, so it crosses a line at most twice, once on each side of where it runs parallel to it.
fn cross_static(piece: &Piece, ends: &Ends, corners: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let a = DVec2::new(normal.dot(piece.axes[0]), normal.dot(piece.axes[1]));
    let c = normal.dot(corners[0]);
    let segment = piece.segment;
    let height = |s: f64| a.dot(segment.position(s)) - c;
    let (from, to) = (piece.from, piece.to);
    let [h0, h1] = ends.positions.map(|position| a.dot(position) - c);
    let rounding = 8.0 * f64::EPSILON * ends.positions[0].length().max(ends.positions[1].length());
    let try_at = |elapsed: f64| weights(corners, normal, piece.position(elapsed), rounding).map(|weights| (elapsed, weights));
    if a == DVec2::ZERO || h0 == 0.0 && h1 == 0.0 && height(0.5 * (from + to)) == 0.0 {
        // The ray is in the plane of the triangle, which it sees edge on.
        return None;
    }
    if h0 * h1 < 0.0 {
        return try_at(segment.cross_line(a, c, from, to));
    }
    let at_start = || (h0 == 0.0).then(|| try_at(from)).flatten();
    let at_end = || (h1 == 0.0).then(|| try_at(to)).flatten();
    // Both ends are on one side, or on the line. In between the ray crosses the line only if it first approaches and then recedes.
    let [rate0, rate1] = ends.rates(piece).map(|rate| a.dot(rate));
    if rate0 * rate1 >= 0.0 || h0 * rate0 > 0.0 || h1 * rate1 < 0.0 {
        return at_start().or_else(at_end);
    }
    let middle = root(from, to, |s| (a.dot(segment.velocity(s)), a.dot(segment.acceleration(s))));
    let turned = height(middle);
    let between = |across: bool, from: f64, to: f64| across.then(|| try_at(segment.cross_line(a, c, from, to))).flatten();
    at_start()
        .or_else(|| between(h0 * turned < 0.0 || h0 != 0.0 && turned == 0.0, from, middle))
        .or_else(|| between(turned * h1 < 0.0, middle, to))
        .or_else(at_end)
}
