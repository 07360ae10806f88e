//! Where on the screen a given point of a body is seen, whether or not something hides it.

use glam::{DVec2, DVec3};

use lensrunner::judge::picture::{BodyMotion, Thing, World};
use lensrunner::judge::trace::PixelCamera;
use lensrunner::judge::{EnergySign, shoot};

/// Local error of the integration of each ray that is shot.
const TOLERANCE: f64 = 1e-13;
/// Emission times are found to this, in r_s/c.
const TIME_TOLERANCE: f64 = 1e-10;
/// Steps of the search for an emission time; 40 halvings alone reach the tolerance from 100 r_s/c.
const STEPS: usize = 60;

/// Where `camera` sees the point `body` (body axes, the model's unit) of a thing in the image of `order`, in pixels from the upper left
/// corner. None where it is not seen: no light of that order arrives, or it is behind the camera. None too if point and camera are both
/// inside the horizon: there two rays may arrive.
pub fn seen_at(world: &World, camera: &PixelCamera, thing: &Thing, order: u32, body: DVec3) -> Option<DVec2> {
    let at_rest = body * thing.scale;
    let look = match thing.motion {
        BodyMotion::Static { position, attitude } => sighting(world, camera, position + attitude * at_rest, order)?.0,
        BodyMotion::Flying(line) => {
            let place = |time: f64| line.at(time).place_of(at_rest);
            let time = emission_time(world.time, |time| Some(sighting(world, camera, place(time), order)?.1))?;
            sighting(world, camera, place(time), order)?.0
        }
    };
    camera.seen_at(look).map(|(place, _)| place.into())
}

/// The direction (rain axes) from which light of `order` comes from a place on the slice, and its delay in r_s/c.
fn sighting(world: &World, camera: &PixelCamera, place: DVec3, order: u32) -> Option<(DVec3, f64)> {
    let eye = camera.observer.position;
    if !world.hole {
        let line = place - eye;
        return (order == 1).then(|| (line.normalize_or_zero(), line.length()));
    }
    let (r, l) = (place.length(), eye.length());
    if l < 1.0 && r <= 1.0 {
        return None;
    }
    let outwards = eye / l;
    let across = place - outwards * place.dot(outwards);
    let phi = across.length().atan2(place.dot(outwards));
    let seen = shoot(r, phi, l, order, EnergySign::Plus, TOLERANCE)?;
    let side = across.normalize_or_zero() * if order.is_multiple_of(2) { -1.0 } else { 1.0 };
    Some((outwards * seen.psi_rain.cos() + side * seen.psi_rain.sin(), seen.delay))
}

/// The emission time T_e of light that arrives at `time`: the root of T_e + delay(T_e) − time, which increases with T_e. Where there is no
/// light T_e is too late. Regula falsi in the manner of Illinois, within a bracket.
fn emission_time(time: f64, delay: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let late = |t: f64| delay(t).map_or(f64::INFINITY, |delay| t + delay - time);
    let (mut high, mut above) = (time, late(time));
    let mut back = if above.is_finite() { above } else { 1.0 };
    let (mut low, mut below) = loop {
        let t = time - back;
        match late(t) {
            found if found <= 0.0 => break (t, found),
            found => (high, above) = (t, found),
        }
        back *= 2.0;
        if back > 1e6 {
            return None;
        }
    };
    for _ in 0..STEPS {
        let secant = low + (high - low) * (below / (below - above));
        let t = if above.is_finite() && secant > low && secant < high { secant } else { 0.5 * (low + high) };
        let found = late(t);
        if found.abs() <= TIME_TOLERANCE || high - low <= TIME_TOLERANCE {
            return found.is_finite().then_some(t);
        }
        if found > 0.0 {
            (high, above) = (t, found);
            below *= 0.5;
        } else {
            (low, below) = (t, found);
            above *= 0.5;
        }
    }
    Some(0.5 * (low + high))
}
