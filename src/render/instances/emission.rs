//! When the light left by which a body is seen, as the settings ask for it.

use crate::render::instances::view::InstanceView;
use crate::render::settings::Settings;
use crate::sim::History;
use crate::sim::sight::{emission_time, leaving};
use crate::spacetime::Observer;
use crate::spacetime::light::Order;

/// The emission time of the centre of a flying body that is seen at `time`, as the settings ask for; None if it is not seen.
pub fn departure(view: &InstanceView, time: f64, history: &History, order: Order) -> Option<f64> {
    match view.settings {
        Settings { light_delay: false, .. } => Some(time),
        Settings { method, .. } if !method.bends => flat_emission_time(view.camera, time, history),
        _ => emission_time(view.camera, time, history, order),
    }
}

/// The emission time of straight light.
fn flat_emission_time(camera: &Observer, time: f64, history: &History) -> Option<f64> {
    leaving(time, |t| {
        let sample = history.at(t);
        let line = sample.position - camera.position;
        // Seen across the hole a ship may fall faster than straight light.
        Some((t + line.length() - time, (1.0 + line.normalize_or_zero().dot(sample.velocity)).max(0.05)))
    })
}
