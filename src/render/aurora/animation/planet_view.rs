//! A planet with an aurora as one frame sees it: its worldline, where it is, how large and how shifted.

use glam::{DQuat, DVec3};

use crate::render::instances::{InstanceView, against_static};
use crate::scene::planet::Planet;
use crate::sim::History;
use crate::sim::flight::Command;
use crate::sim::sight::light_path;
use crate::spacetime::Observer;
use crate::spacetime::light::{Branch, Order};
use crate::spacetime::matter::{ShipState, gamma, velocity};

/// Attitudes are interpolated between nodes; over a fiftieth of a turn linear motion is off by 0.2 %. In r_s/c, whatever the day.
const LONGEST_STEP: f64 = 2.0;
/// At most so many nodes, however far back light comes from.
const MOST_NODES: f64 = 400.0;
/// How much farther back than is asked for a worldline goes, as a share: so a camera that flies away does not ask for another one.
const FARTHER: f64 = 0.5;

/// The worldline of a planet as it goes on from frame to frame. Its nodes are at whole multiples of their distance in T, so what is read of
/// it does not depend on the frames before.
#[derive(Clone, Debug, Default)]
pub struct PlanetLine {
    /// Turns the axes of the planet's model.
    turn: DQuat,
    kept: Option<KeptLine>,
}

#[derive(Clone, Debug)]
struct KeptLine {
    history: History,
    /// Distance of its nodes, r_s/c.
    step: f64,
    /// The number of its last node.
    last: i64,
}

impl PlanetLine {
    /// Of a planet with the axes of its model turned by `turn`.
    pub fn new(turn: DQuat) -> PlanetLine {
        PlanetLine { turn, kept: None }
    }

    /// The worldline of the planet about T = `time`, as far `back` (r_s/c) as light may come from.
    pub fn about(&mut self, planet: &Planet, time: f64, back: f64) -> Option<&History> {
        let turn = self.turn;
        let state = |t: f64| planet.state(t).map(|state| ShipState { attitude: state.attitude * turn, ..state });
        let finest = (planet.day / 50.0).min(LONGEST_STEP);
        // In powers of two of the finest, so that it seldom changes.
        let step = finest * (back / MOST_NODES / finest).max(1.0).log2().ceil().exp2();
        let wanted = (time / step).floor() as i64 + 2;
        let reaches = |line: &KeptLine| line.history.node_at(f64::NEG_INFINITY).0 <= time - back && line.last as f64 * step > time - back;
        let mut kept = match self.kept.take().filter(|line| line.step == step && reaches(line)) {
            Some(kept) => kept,
            None => {
                let keep = back * (1.0 + FARTHER);
                let last = ((time - keep) / step).floor() as i64;
                let first = last as f64 * step;
                let mut history = History::new(first, &state(first)?);
                history.forget_beyond(keep);
                KeptLine { history, step, last }
            }
        };
        while kept.last < wanted {
            kept.last += 1;
            let t = kept.last as f64 * step;
            kept.history.push(t, &state(t)?, &Command::default());
        }
        Some(&self.kept.insert(kept).history)
    }
}

/// A planet in one frame.
pub struct PlanetView<'a> {
    /// The camera.
    pub view: &'a InstanceView<'a>,
    /// T of the frame.
    pub time: f64,
    /// The planet's worldline, with the dipole's axes.
    pub history: &'a History,
    /// Its radius, in r_s.
    pub radius: f64,
    /// Where its centre is now.
    pub position: DVec3,
    /// The dipole's axes now.
    pub attitude: DQuat,
    /// Of its centre from the camera, in r_s.
    pub distance: f64,
    /// How wide it would be seen if space were flat, in pixels.
    pub pixels: f64,
}

impl<'a> PlanetView<'a> {
    /// A planet of that radius (r_s) with this history, whose axes are the dipole's, at T = `time`.
    pub fn new(view: &'a InstanceView<'a>, time: f64, history: &'a History, radius: f64) -> Self {
        let now = history.at(time);
        let distance = (now.position - view.camera.position).length();
        let pixels = 2.0 * radius / distance.max(1e-6) / view.pixel;
        PlanetView { view, time, history, radius, position: now.position, attitude: now.attitude, distance, pixels }
    }

    /// How much longer the hole's lensing makes its image behind the hole: the point lens of weak fields, μ = (u² + 2)/(u √(u² + 4)) with
    /// u the angle from the axis over Einstein's angle. Only for how many streaks are drawn.
    pub fn magnification(&self) -> f64 {
        let (l, r) = (self.view.camera.radius(), self.position.length());
        let behind = -self.position.dot(self.view.camera.position) / l;
        if behind <= 0.0 || !self.view.settings.method.bends {
            return 1.0;
        }
        let einstein = (2.0 * behind / (l * (l + behind))).sqrt();
        // The planet moves while its light travels: its distance from the axis is known to a few radii only.
        let off = ((r * r - behind * behind).max(0.0).sqrt() - 4.0 * self.radius).max(0.5 * self.radius) / (l + behind);
        let u = off / einstein;
        (u * u + 2.0) / (u * (u * u + 4.0).sqrt())
    }

    /// ν_observed/ν_emitted for the centre, in an image whose light left it at T = `emission`: the ratio of proper times between two wave
    /// crests, from the light path's derivatives along both worldlines. Where light is drawn straight it is that of special relativity
    /// against what hovers, as for all else.
    pub fn frequency_ratio(&self, order: Order, emission: f64) -> Option<f64> {
        let camera = self.view.camera;
        let emitted = self.history.at(emission);
        if !self.view.settings.method.bends {
            let k = (camera.position - emitted.position).normalize();
            let frequency = |position, momentum| {
                let p = against_static(position, momentum);
                gamma(p) - p.dot(k)
            };
            return Some(frequency(camera.position, camera.momentum) / frequency(emitted.position, emitted.momentum));
        }
        let (_, gradient) = light_path(camera, emitted.position, order, Branch::Plus)?;
        let moving = velocity(&ShipState::new(camera.position, camera.momentum));
        // A millionth of the radius: the light path is exact to 1e-12 of it.
        let h = 1e-6 * camera.radius();
        let path = |s: f64| {
            light_path(&Observer { position: camera.position + moving * s, ..*camera }, emitted.position, order, Branch::Plus)
                .map(|path| path.0)
        };
        let along = (path(h)? - path(-h)?) / (2.0 * h);
        let received = 1.0 - along;
        let sent = 1.0 + gradient.dot(emitted.velocity);
        let g = gamma(camera.momentum) / gamma(emitted.momentum) * received / sent;
        (g.is_finite() && g > 0.0).then_some(g)
    }
}
