//! Which moments of a flight are looked at: half of them oppositions, at which the hole is between the camera and the place where another
//! ship is seen.

use std::f64::consts::PI;

use glam::DVec3;
use rand::RngExt;

use crate::compare::random::draw::chance;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{GameConfig, Mount, Scene};
use lensrunner::sim::{History, Moment};
use lensrunner::spacetime::light::{Branch, Order, connect};

/// The least T between two moments that are oppositions, in r_s/c.
const APART: f64 = 0.5;

/// A flight looked over from its start to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Steps of the clock to its end.
    pub steps: u64,
    /// After each step from the first on the greatest angle at the hole between the camera and the seen place of another ship, in radians;
    /// not a number where none is seen.
    pub angles: Vec<f64>,
}

/// Flies `scene`, the player's ship by `pilot`, until the chase is decided or T = `until`, and looks after each step where ships are seen.
pub fn survey(scene: &Scene, config: &GameConfig, seed: u64, until: f64, pilot: PilotKind) -> Survey {
    let mut moment = Moment::with_pilot(scene, config, seed, pilot);
    let most = (until / config.clock.step).floor() as u64;
    let mut angles = Vec::new();
    while (angles.len() as u64) < most && !moment.is_decided() {
        moment.advance(1);
        let (time, ships) = (moment.time(), moment.ships());
        if scene.camera.check(time, &ships).is_err() {
            break;
        }
        let eye = scene.camera.viewpoint(time, &ships).position;
        let own = match &scene.camera.mount {
            Mount::Follow { ship, .. } => scene.ships.iter().position(|other| &other.name == ship),
            _ => None,
        };
        let histories = moment.histories();
        let others = histories.iter().enumerate().filter(|(ship, _)| Some(*ship) != own);
        let seen = others.filter_map(|(_, history)| seen_angle(history, time, eye));
        angles.push(seen.fold(f64::NAN, f64::max));
    }
    Survey { steps: angles.len() as u64, angles }
}

/// The angle at the hole between the camera and where the ship is seen by light that sweeps that angle, in radians; None where there is no
/// such light.
fn seen_angle(history: &History, time: f64, eye: DVec3) -> Option<f64> {
    let order = Order::new(1)?;
    // T_e + Δ(x(T_e)) grows with T_e: halved between a time that is too early and now.
    let angle = |place: DVec3| place.angle_between(eye);
    let late = |emitted: f64| {
        let place = history.at(emitted).position;
        let there = connect(1.0 / place.length(), order.swept(angle(place)).clamp(1e-9, PI), 1.0 / eye.length(), Branch::Plus)?;
        Some(emitted + there.delay > time)
    };
    let mut span = [time - 3.0 * (eye.length() + history.at(time).position.length()) - 30.0, time];
    for _ in 0..30 {
        let middle = 0.5 * (span[0] + span[1]);
        // Where there is no light to the camera the ship was inside by then.
        if late(middle).unwrap_or(true) { span[1] = middle } else { span[0] = middle }
    }
    Some(angle(history.at(span[0]).position)).filter(|angle| angle.is_finite())
}

/// The steps after which `count` moments are looked at, in order, none before the second step or at the last: half of them, if there are so
/// many, at the greatest angles of their surroundings, the others drawn evenly.
pub fn choose(survey: &Survey, count: usize, step: f64, seed: u64) -> Vec<u64> {
    let last = survey.steps.saturating_sub(1);
    if last < 2 {
        return Vec::new();
    }
    let angles = &survey.angles;
    // angles[k] is that after step k + 1.
    let mut peaks: Vec<usize> = (1..angles.len().saturating_sub(1))
        .filter(|&k| angles[k] >= angles[k - 1] && angles[k] > angles[k + 1] && (2..=last).contains(&(k as u64 + 1)))
        .collect();
    peaks.sort_by(|a, b| angles[*b].total_cmp(&angles[*a]));
    let apart = (APART / step).ceil() as u64;
    let mut chosen: Vec<u64> = Vec::new();
    for at in peaks.into_iter().map(|k| k as u64 + 1) {
        if chosen.len() >= count.div_ceil(2) {
            break;
        }
        if chosen.iter().all(|other| other.abs_diff(at) >= apart) {
            chosen.push(at);
        }
    }
    // Then around the best of them, a few steps to either side: the ring is crossed in a moment.
    for best in chosen.clone() {
        for off in [-4i64, -2, -1, 1, 2, 4] {
            let at = best.saturating_add_signed(off);
            if chosen.len() < count.div_ceil(2) && (2..=last).contains(&at) && !chosen.contains(&at) {
                chosen.push(at);
            }
        }
    }
    let mut chance = chance(seed, u64::MAX);
    let mut tries = 0;
    while chosen.len() < count && tries < 100 * count {
        let at = chance.random_range(2..=last);
        if !chosen.contains(&at) {
            chosen.push(at);
        }
        tries += 1;
    }
    chosen.sort_unstable();
    chosen
}
