//! How bodies move.

use glam::{DQuat, DVec3};

use crate::judge::picture::roots::Bend;
use crate::spacetime::matter::gamma;

/// A body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its centre on the slice, in r_s.
    pub position: DVec3,
    /// Rain-frame momentum per mass, in c.
    pub momentum: DVec3,
    /// Body axes to rain axes, through the pure boost of `momentum`.
    pub attitude: DQuat,
}

impl Pose {
    /// From a position on the slice to the body's rest frame and axes: along the momentum lengths are γ times longer there.
    pub fn to_body(&self, place: DVec3) -> DVec3 {
        let away = place - self.position;
        let p = self.momentum;
        self.attitude.conjugate() * (away + p * (p.dot(away) / (1.0 + gamma(p))))
    }

    /// The inverse of [`Pose::to_body`].
    pub fn place_of(&self, body: DVec3) -> DVec3 {
        let v = self.attitude * body;
        let p = self.momentum;
        let g = gamma(p);
        self.position + v - p * (p.dot(v) / (g * (1.0 + g)))
    }
}

/// Bounds on how a body moves over a while, in r_s, c and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sway {
    /// |dx/dT| of the centre.
    pub velocity: f64,
    /// |d²x/dT²|.
    pub acceleration: f64,
    /// The least |p| of the momentum per mass, and the greatest.
    pub momentum: [f64; 2],
    /// |dp/dT|.
    pub force: f64,
    /// |d²p/dT²|, but at jumps of the force.
    pub surge: f64,
    /// The angular velocity of the attitude, constant between jumps.
    pub turning: f64,
    /// Sum of all jumps of the force, and of the angular velocity.
    pub jumps: [f64; 2],
}

impl Sway {
    /// How much the path of light bends in the body's axes. The light is within `away` (r_s) of the body's centre; on the slice it has the
    /// speed `light` and |d²x/dT²| up to `bend`.
    ///
    /// A point there is y = M (x − c), M = Rᵀ B with the rotation R of the attitude and the boost B = 1 + p pᵀ/(1 + γ), |B| = γ. With f =
    /// 1/(1 + γ), |p| f < 1 and |γ'| ≤ |p'|: |B'| ≤ 3|p'| and |B''| ≤ 3|p''| + (8f + 1/γ)|p'|². The rest is the product rule.
    pub(in crate::judge::picture) fn bend(&self, away: f64, light: f64, bend: f64) -> Bend {
        let [least, gamma] = self.momentum.map(|p| p.hypot(1.0));
        let rate = self.turning * gamma + 3.0 * self.force;
        let boost = 3.0 * self.surge + (8.0 / (1.0 + least) + 1.0 / least) * self.force * self.force;
        let twice = self.turning * (self.turning * gamma + 6.0 * self.force) + boost;
        let curve = twice * away + 2.0 * rate * (light + self.velocity) + gamma * (bend + self.acceleration);
        Bend { curve, kink: away * (self.jumps[1] * gamma + 3.0 * self.jumps[0]) }
    }
}

/// How something flies: where it is at any T.
pub trait Worldline: Sync {
    /// The body at T = `time`, in r_s/c.
    fn at(&self, time: f64) -> Pose;

    /// Whether there is such a body at T = `time`: a bolt is there from when it is fired until it ends.
    fn exists_at(&self, _time: f64) -> bool {
        true
    }

    /// Bounds on its motion from T = `from` to `to`. None if they are not known; then the bend of light in the body's axes is measured
    /// instead.
    fn sway(&self, _from: f64, _to: f64) -> Option<Sway> {
        None
    }
}

/// How a thing moves.
#[derive(Clone, Copy)]
pub enum BodyMotion<'a> {
    /// Static: held in place, at rest in Schwarzschild's coordinates.
    Static {
        /// In r_s.
        position: DVec3,
        /// Model axes to coordinate axes.
        attitude: DQuat,
    },
    /// Along a worldline, its shape at rest in its own frame.
    Flying(&'a dyn Worldline),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything at once: a bent path, a momentum that grows and turns, an even turn.
    struct Wild(f64);

    impl Worldline for Wild {
        fn at(&self, time: f64) -> Pose {
            let k = self.0;
            let momentum = DVec3::new(1.2 * k + 0.8 * time, 0.5 * (2.0 * time).sin(), 0.3 * k);
            let position = DVec3::new(0.3 * time, 0.4 * time * time, 0.2 * (1.5 * time).cos());
            Pose { position, momentum, attitude: DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 0.5) * time) }
        }
    }

    #[test]
    fn light_strays_from_its_chord_in_a_bodys_axes_by_less_than_the_bound() {
        let light = |time: f64| DVec3::new(0.1, 0.9 * time, 0.3 + 0.4 * time * time);
        let mut tightest = f64::INFINITY;
        for (k, from, span) in [(-1.0, -0.2, 0.5), (0.0, 0.0, 0.3), (2.0, 0.4, 0.2), (6.0, -0.5, 0.4), (0.0, -1.0, 1.0)] {
            let line = Wild(k);
            let times: Vec<f64> = (0..=400).map(|i| from + span * f64::from(i) / 400.0).collect();
            let most = |of: &dyn Fn(f64) -> f64| times.iter().map(|t| of(*t)).fold(0.0, f64::max);
            let p = |t: f64| line.at(t).momentum.length();
            let sway = Sway {
                velocity: most(&|t| DVec3::new(0.3, 0.8 * t, -0.3 * (1.5 * t).sin()).length()),
                acceleration: most(&|t| DVec3::new(0.0, 0.8, -0.45 * (1.5 * t).cos()).length()),
                momentum: [times.iter().map(|t| p(*t)).fold(f64::INFINITY, f64::min), most(&p)],
                force: most(&|t| DVec3::new(0.8, (2.0 * t).cos(), 0.0).length()),
                surge: most(&|t| 2.0 * (2.0 * t).sin().abs()),
                turning: DVec3::new(0.4, -0.7, 0.5).length(),
                jumps: [0.0; 2],
            };
            let away = most(&|t| light(t).distance(line.at(t).position));
            let bound = sway.bend(away, most(&|t| 0.9f64.hypot(0.8 * t)), 0.8).sagitta(span);
            let body = |t: f64| line.at(t).to_body(light(t));
            let strays = most(&|t| body(t).distance(body(from).lerp(body(from + span), (t - from) / span)));
            assert!(strays <= bound, "{k}: {strays} {bound}");
            tightest = tightest.min(bound / strays);
        }
        assert!(tightest < 15.0, "a bound of no use: {tightest}");
    }
}
