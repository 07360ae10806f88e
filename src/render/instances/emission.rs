//! When the light left by which a body is seen, as the settings ask for it.

use glam::DVec3;

use crate::lensing::lookup::lens_lookup_at;
use crate::render::instances::view::InstanceView;
use crate::render::settings::Settings;
use crate::sim::sight::{branch_of, emission_time, leaving, light_path};
use crate::sim::{History, Sample};
use crate::spacetime::Observer;
use crate::spacetime::light::{Branch, Order};

/// The light by which the centre of a flying body is seen.
#[derive(Clone, Copy, Debug)]
pub struct Departure {
    /// When it left, in r_s/c.
    pub time: f64,
    /// The body then.
    pub sample: Sample,
    /// The length of its path, in r_s, and the gradient of that over the position; None where no bent light goes.
    pub path: Option<(f64, DVec3)>,
}

impl Departure {
    /// Of the body as it is at T = `time`, seen at T = `now`.
    fn at(time: f64, now: f64, camera: &Observer, history: &History, order: Order) -> Departure {
        let sample = history.at(time);
        let branch = branch_of(camera, sample.position, now - time);
        Departure { time, sample, path: light_path(camera, sample.position, order, branch) }
    }
}

/// The light by which the centre of a flying body is seen at `time`, as the settings ask for it; None if it is not seen.
pub fn departure(view: &InstanceView, time: f64, history: &History, order: Order) -> Option<Departure> {
    let camera = view.camera;
    let at = |emitted: f64| Departure::at(emitted, time, camera, history, order);
    match view.settings {
        Settings { light_delay: false, .. } => Some(at(time)),
        Settings { method, .. } if !method.bends => flat_emission_time(camera, time, history).map(at),
        _ => found_by_table(view, time, history, order).or_else(|| emission_time(camera, time, history, order).map(at)),
    }
}

/// Steps of the search by the table; more than a few are needed only where it is better not used.
const TABLE_STEPS: usize = 6;
/// A step this short, over 1 r_s/c and the age of the light, ends the search. After one of the table the exact solution is near enough for
/// Newton's method to end in one or two steps; after one of those the time is right to its square, 1e-10.
const SHORT: f64 = 1e-5;
/// Most exact steps.
const EXACT_STEPS: usize = 3;

/// The light that arrives at `time`, sought by the table and then by the exact solution. None where that does not lead to it: seen from
/// inside the horizon, or at its edge.
fn found_by_table(view: &InstanceView, time: f64, history: &History, order: Order) -> Option<Departure> {
    let camera = view.camera;
    if camera.radius() <= 1.0 {
        return None;
    }
    // Newton's step back from T = `t`, by a path and its gradient; no light is of the future.
    let step = |t: f64, sample: &Sample, (path, gradient): (f64, DVec3)| {
        let slope = 1.0 + gradient.dot(sample.velocity);
        ((t + path - time) / slope.max(1e-3)).max(t - time)
    };
    let is_short = |step: f64, t: f64| step.abs() < SHORT * (1.0 + (time - t).abs());
    let mut t = time;
    let mut steps = 0..TABLE_STEPS;
    loop {
        steps.next()?;
        let sample = history.at(t);
        let back = step(t, &sample, tabled_path(view, sample.position, order)?);
        t -= back;
        if is_short(back, t) {
            break;
        }
    }
    for _ in 0..EXACT_STEPS {
        let sample = history.at(t);
        let (path, gradient) = light_path(camera, sample.position, order, Branch::Plus)?;
        let back = step(t, &sample, (path, gradient));
        t -= back;
        if is_short(back, t) {
            return Some(Departure { time: t, sample: history.at(t), path: Some((time - t, gradient)) });
        }
    }
    None
}

/// [`light_path`] by the table, for a camera outside the horizon.
fn tabled_path(view: &InstanceView, position: DVec3, order: Order) -> Option<(f64, DVec3)> {
    let n = view.camera.position.normalize();
    let height = position.dot(n);
    let across = position - n * height;
    let along = (position - view.camera.position).dot(n);
    let ray = lens_lookup_at(view.slice, along as f32, across.length() as f32, height as f32, u32::from(order.number()));
    // dΔ/dx = −k/E at the point, k the photon's spatial momentum there.
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let turn = if order.flips() { -1.0 } else { 1.0 };
    let m = position.normalize();
    let tangent = (side * m.dot(n) - n * m.dot(side)) * turn;
    let [radial, tangential, energy] = [ray.emission_radial, ray.emission_tangential, ray.energy].map(f64::from);
    let gradient = (tangent * tangential - m * radial) / energy;
    (ray.valid && gradient.is_finite()).then_some((f64::from(ray.delay), gradient))
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

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::lensing::{Slice, default_table_or};
    use crate::render::stage::settings;
    use crate::scene::GameConfig;
    use crate::spacetime::matter::ShipState;
    use crate::spacetime::orbit::circular_orbit;

    /// The search by the table ends where that by the exact solution alone does.
    #[test]
    fn the_table_leads_to_the_exact_time() {
        let settings = settings(&GameConfig::default());
        let table = default_table_or(|error| panic!("{error}"));
        let mut by_table = 0;
        let mut all = 0;
        for k in 0..600 {
            // Numbers that fill [0, 1) evenly.
            let even = |step: f64| (f64::from(k) * step).fract();
            let (r, phase) = (1.2 + 14.0 * even(0.618_034), 6.0 * even(0.414_214));
            let state = if k % 3 == 0 && r > 2.0 {
                circular_orbit(r, phase).expect("a circle")
            } else {
                let position = DVec3::new(phase.cos(), phase.sin(), 0.5 * even(0.732_051)).normalize() * r;
                ShipState::new(position, DVec3::new(even(0.302_776), even(0.645_751), even(0.236_068)) * 2.0 - 1.0)
            };
            let history = History::new(0.0, &state);
            let l = 1.05 + 12.0 * even(0.122_499);
            let camera = Observer {
                position: DVec3::new(0.3, 0.2, 1.0).normalize() * l,
                momentum: DVec3::ZERO,
                attitude: DQuat::IDENTITY,
                field_of_view: 1.0,
            };
            let slice = Slice::new(&table, l);
            let view = InstanceView { camera: &camera, slice: &slice, pixel: 1e-3, aspect: None, settings: &settings };
            for order in Order::ALL {
                let exact = emission_time(&camera, 0.0, &history, order);
                let Some(found) = found_by_table(&view, 0.0, &history, order) else {
                    all += u32::from(exact.is_some());
                    continue;
                };
                let exact = exact.expect("it has an exact time too");
                assert!((found.time - exact).abs() < 1e-8 * (1.0 - exact), "case {k}, {order:?}: {} and {exact}", found.time);
                let (_, gradient) = light_path(&camera, found.sample.position, order, Branch::Plus).expect("a ray");
                let (path, near) = found.path.expect("a path");
                assert!((path + found.time).abs() < 1e-12 * path && near.distance(gradient) < 1e-3 * (1.0 + gradient.length()), "case {k}");
                (by_table, all) = (by_table + 1, all + 1);
            }
        }
        assert!(by_table * 10 > all * 9, "{by_table} of {all}");
    }
}
