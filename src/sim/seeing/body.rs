//! Bodies, and the patches of the sky that their images cover.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::look::{Eye, Look};
use crate::scene::planet::Planet;
use crate::sim::history::History;
use crate::sim::sight;
use crate::spacetime::light::Order;
use crate::spacetime::matter::velocity;

/// How much larger than the nearest and farthest points of a ball its image may be, for a ball that is near. The outline of a ball at twice
/// its radius is 1.16 times as far from the middle as its greatest circle across the line of sight.
const ROOM: f64 = 1.25;

/// What flies.
#[derive(Clone, Copy)]
pub enum Track<'a> {
    /// A ship.
    Ship(&'a History),
    /// A planet.
    Planet(&'a Planet),
}

impl Track<'_> {
    /// Position on the slice (r_s) and dx/dT (c) at T = `time`.
    fn at(&self, time: f64) -> Option<[DVec3; 2]> {
        match self {
            Track::Ship(history) => {
                let sample = history.at(time);
                Some([sample.position, sample.velocity])
            }
            Track::Planet(planet) => planet.state(time).map(|state| [state.position, velocity(&state)]),
        }
    }

    /// Position at T = `time`, in r_s, if there is such a thing then.
    pub fn place(&self, time: f64) -> Option<DVec3> {
        let exists = match self {
            Track::Ship(history) => history.exists_at(time),
            Track::Planet(_) => true,
        };
        if exists { self.at(time).map(|[position, _]| position) } else { None }
    }
}

/// A ball that flies.
#[derive(Clone, Copy)]
pub struct SeenBody<'a> {
    /// Its worldline.
    pub track: Track<'a>,
    /// Its radius, in r_s.
    pub radius: f64,
}

/// One image of a body.
#[derive(Clone, Copy, Debug)]
pub struct SeenImage {
    /// Towards its middle: unit vector in camera axes.
    pub direction: DVec3,
    /// Age of its light in T, in r_s/c.
    pub age: f64,
    /// Φ that the light of its middle swept, in rad.
    pub swept: f64,
    /// Radius of its middle when the light left, in r_s.
    pub r: f64,
    /// The way its light sweeps: unit vector across the outward direction.
    pub side: DVec3,
    /// Half the angle, round the line from hole to camera, over which it is drawn out, in rad; π if it is a ring.
    pub half_turn: f64,
    /// ψ between which it lies, rain frame, in rad.
    psi: [f64; 2],
}

impl SeenImage {
    /// The image of order `order` of a body at T = `time`; None where no light of it arrives.
    pub fn of(eye: &Eye, time: f64, body: &SeenBody, order: Order) -> Option<SeenImage> {
        let emitted = sight::emission_time_of(eye.camera, time, |t| body.track.at(t), order)?;
        let position = body.track.place(emitted)?;
        let age = time - emitted;
        let direction = sight::direction(eye.camera, position, order, age)?;
        let branch = sight::branch_of(eye.camera, position, age);
        let r = position.length();
        let phi = position.angle_between(eye.outward);
        let across = position - eye.outward * position.dot(eye.outward);
        // Rounding alone has no side.
        let side = if across.length() > 1e-9 * r { across.normalize() } else { eye.side(0.0) };
        let side = if order.flips() { -side } else { side };
        let swept = order.swept(phi.max(1e-12));
        let half_turn = if across.length() <= body.radius { PI } else { libm::asin(body.radius / across.length()) };
        let opening = if r <= body.radius { FRAC_PI_2 } else { libm::asin(body.radius / r) };

        let middle = eye.psi(r, swept, branch)?;
        let ends = [(r, swept - opening), (r, swept + opening), (r - body.radius, swept), (r + body.radius, swept)];
        let (mut low, mut high) = (middle, middle);
        for (r, swept) in ends {
            // Where it lies across the line from hole to camera its image reaches the middle of the shadow, or of the sky; where there is
            // no ray, nobody knows how far into the shadow.
            let psi = match swept {
                ..=0.0 if r * eye.u > 1.0 => 0.0,
                ..=0.0 => PI,
                _ => eye.psi(r.max(1e-3), swept, branch).unwrap_or(PI),
            };
            (low, high) = (low.min(psi), high.max(psi));
        }
        let psi = [middle - ROOM * (middle - low), middle + ROOM * (high - middle)];
        Some(SeenImage { direction, age, swept, r, side, half_turn, psi })
    }

    /// Whether this image may be what is seen there.
    pub fn covers(&self, look: &Look) -> bool {
        let half_turn = ROOM * self.half_turn;
        (self.psi[0]..=self.psi[1]).contains(&look.psi) && (half_turn >= PI || look.side.dot(self.side) >= libm::cos(half_turn))
    }
}
