//! A planet with an aurora as one frame sees it: its worldline, where it is, how large and how shifted.

use glam::{DQuat, DVec3};

use crate::render::instances::{InstanceView, against_static, departure};
use crate::scene::planet::Planet;
use crate::sim::History;
use crate::sim::flight::Command;
use crate::sim::sight::light_path;
use crate::spacetime::Observer;
use crate::spacetime::light::{Branch, Order};
use crate::spacetime::matter::{ShipState, gamma, velocity};

/// The worldline of a planet about T = `time`, as far back as light may come from, with the axes of its model turned by `turn`.
pub fn planet_history(planet: &Planet, time: f64, back: f64, turn: DQuat) -> Option<History> {
    let state = |t: f64| planet.state(t).map(|state| ShipState { attitude: state.attitude * turn, ..state });
    // Attitudes are interpolated between nodes; over a fiftieth of a turn linear motion is off by 0.2 %. At most 400 nodes, however far
    // back light comes from.
    let step = (planet.day / 50.0).min(2.0).max(back / 400.0);
    let first = time - back;
    let mut history = History::new(first, &state(first)?);
    for k in 1..=(back / step).ceil() as u32 + 1 {
        let t = first + f64::from(k) * step;
        history.push(t, &state(t)?, &Command::default());
    }
    Some(history)
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

    /// ν_observed/ν_emitted for the centre, in an image: the ratio of proper times between two wave crests, from the light path's
    /// derivatives along both worldlines. Where light is drawn straight it is that of special relativity against what hovers, as for all
    /// else.
    pub fn frequency_ratio(&self, order: Order) -> Option<f64> {
        let camera = self.view.camera;
        let emitted = departure(self.view, self.time, self.history, order)?.sample;
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
