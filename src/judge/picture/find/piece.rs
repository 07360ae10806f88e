//! A piece of a ray: its ends, its crossing of the plane z = 0, and the nearest intersection on it.

use std::cell::OnceCell;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::judge::geodesic::Segment;
use crate::judge::picture::disk::PlaneCrossing;
use crate::judge::ray::unwrap;
use crate::judge::trace::Hit;

/// A piece of a ray between two delays, in the plane of its orbit, which is spanned by `axes`.
pub(super) struct Piece<'a> {
    /// The step that it is of.
    pub segment: &'a Segment,
    /// Axes of the plane.
    pub axes: [DVec3; 2],
    /// Elapsed time in the segment where it begins.
    pub from: f64,
    /// And where it ends.
    pub to: f64,
    /// A bound on |d²x/dτ²| in the segment, in 1/r_s.
    pub bend: f64,
}

impl Piece<'_> {
    /// Where the light is at that elapsed time, in r_s.
    pub fn position(&self, elapsed: f64) -> DVec3 {
        self.embed(self.segment.position(elapsed))
    }

    /// A vector of the plane in space.
    pub fn embed(&self, v: DVec2) -> DVec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }

    /// Where a piece crosses z = 0, before it has met something at the elapsed time `met`. The plane goes through the hole, and a segment
    /// turns round the hole by less than half a turn, so it crosses at most once. If a piece starts on the plane, the one before has
    /// reported it.
    pub fn cross_plane(&self, ends: &Ends, met: Option<f64>) -> Option<PlaneCrossing> {
        let a = DVec2::new(self.axes[0].z, self.axes[1].z);
        let end = met.unwrap_or(self.to);
        let h0 = a.dot(ends.positions[0]);
        let h1 = a.dot(met.map_or(ends.positions[1], |elapsed| self.segment.position(elapsed)));
        if h0 == 0.0 || h0 * h1 > 0.0 {
            return None;
        }
        let elapsed = self.segment.cross_line(a, 0.0, self.from, end);
        let state = self.segment.at(elapsed);
        let position = self.embed(state.position);
        Some(PlaneCrossing {
            position: DVec3::new(position.x, position.y, 0.0),
            momentum: self.embed(state.momentum),
            delay: self.segment.start + elapsed,
        })
    }
}

/// A piece's two ends in the plane of the orbit.
pub(super) struct Ends {
    /// In r_s.
    pub positions: [DVec2; 2],
    /// dx/dτ, asked for by triangles alone.
    pub rates: OnceCell<[DVec2; 2]>,
}

impl Ends {
    /// dx/dτ at both.
    pub fn rates(&self, piece: &Piece) -> [DVec2; 2] {
        *self.rates.get_or_init(|| [piece.from, piece.to].map(|elapsed| piece.segment.velocity(elapsed)))
    }
}

/// The nearest intersection so far.
#[derive(Clone, Copy)]
pub(super) struct Met {
    /// Time in the segment.
    pub elapsed: f64,
    /// What is met.
    pub thing: u32,
    /// The number of the triangle in its model.
    pub triangle: u32,
    /// Where in it.
    pub barycentrics: [f64; 3],
}

impl Met {
    /// Keeps the nearer one. Of two at the same point, on a shared edge, it keeps the one of lower number, so that the order in which they
    /// were found does not matter.
    pub fn offer(self, met: &mut Option<Met>) {
        let key = |met: &Met| (met.thing, met.triangle);
        if met.is_none_or(|other| self.elapsed < other.elapsed || self.elapsed == other.elapsed && key(&self) < key(&other)) {
            *met = Some(self);
        }
    }

    /// The hit of a ray that had swept `swept` radians before this step.
    pub fn hit(&self, piece: &Piece, swept: f64) -> Hit {
        let state = piece.segment.at(self.elapsed);
        let swept = unwrap(state.position.y.atan2(state.position.x), swept);
        Hit {
            object: self.thing as usize,
            triangle: self.triangle as usize,
            barycentrics: self.barycentrics,
            order: (swept / PI) as u32 + 1,
            swept,
            delay: piece.segment.start + self.elapsed,
            position: piece.embed(state.position),
            momentum: piece.embed(state.momentum),
        }
    }
}

/// Number of pieces into which a step of this bend, length and chord is cut, so that the sagitta of each is at most a fiftieth of its
/// chord. Then boxes hardly grow, and pieces are few.
pub(super) fn pieces(bend: f64, length: f64, chord: f64) -> f64 {
    let sagitta = bend * length * length / 8.0;
    (50.0 * sagitta / chord.max(1e-300)).ceil().clamp(1.0, 64.0)
}

/// How far a piece of the delay `span` is from the chord between its ends at most, with rounding: a few ulp of the distance from the hole.
pub(super) fn growth(bend: f64, span: f64, ends: [DVec2; 2]) -> f64 {
    bend * span * span / 8.0 + 1e-15 * (1.0 + ends[0].length().max(ends[1].length()))
}
