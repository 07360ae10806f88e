//! Bolts: fast bodies without engines that a ship fires ahead. They fly timelike geodesics as ships do, so they bend round the hole, and
//! hit what they come near to.

use bevy::prelude::*;
use glam::DVec3;

use super::clock::Clock;
use super::flight::{Command, Flight, fly};
use super::history::History;
use super::ship::{Ended, Fleet, Ship, ShipMotion};
use super::{SimEvent, SimSet};
pub use crate::scene::assembly::MOST_BOLTS;
use crate::spacetime::frames::rest_to_rain;
use crate::spacetime::matter::{ShipState, has_ended};

/// The speed at which a bolt leaves a ship, in c.
const MUZZLE_SPEED: f64 = 0.8;
/// Its momentum per mass, in c: γv.
const MUZZLE_MOMENTUM: f64 = MUZZLE_SPEED / 0.6;
/// A bolt hits what it passes within this distance on the slice T = const, in r_s: about a ship's length.
pub const HIT_RADIUS: f64 = 0.3;
/// How long a bolt flies, in r_s/c of T.
pub const LIFE: f64 = 40.0;
/// T between two bolts of a ship, in r_s/c.
const RELOAD: f64 = 0.75;

/// A ship's gun.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Gun {
    /// Bolts left.
    pub left: u32,
    /// T of the next, in r_s/c.
    pub ready: f64,
}

/// What the pilot does with it.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trigger {
    /// A bolt is to be fired as soon as the gun is ready.
    pub pulled: bool,
}

/// How often a ship was hit.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hits(pub u32);

/// A bolt.
#[derive(Clone, Debug)]
pub struct Bolt {
    /// Whose it is.
    pub owner: Entity,
    /// Where it is, at [`Clock::time`] while it flies.
    pub state: ShipState,
    /// T at which it was fired, in r_s/c.
    pub fired: f64,
    /// T at which it hit or ended, in r_s/c; None while it flies.
    pub ended: Option<f64>,
    /// Its worldline.
    pub history: History,
}

/// All bolts: each has its place for as long as it is kept.
#[derive(Resource, Clone, Debug, Default)]
pub struct Bolts(pub Vec<Bolt>);

impl Bolts {
    /// The next takes the place of the oldest where there are [`MOST_BOLTS`].
    fn add(&mut self, bolt: Bolt) {
        if self.0.len() < MOST_BOLTS {
            self.0.push(bolt);
        } else if let Some(oldest) = self.0.iter_mut().min_by(|a, b| a.fired.total_cmp(&b.fired)) {
            *oldest = bolt;
        }
    }
}

/// Fires bolts and flies them: in `SimSet::Integrate`, before the clock goes on.
pub struct BoltsPlugin;

impl Plugin for BoltsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Bolts>().add_systems(
            FixedUpdate,
            (fire.before(super::physics::integrate_ships), fly_bolts.after(super::physics::advance_clock)).in_set(SimSet::Integrate),
        );
    }
}

/// The state of a bolt as it leaves a ship in `ship` straight ahead.
pub fn fired_by(ship: &ShipState) -> ShipState {
    ShipState { momentum: bolt_momentum(ship.momentum, ship.attitude * DVec3::NEG_Z), ..*ship }
}

/// The rain-frame momentum per mass (c) of a bolt fired in `direction` (a unit vector on rest-frame axes) by a ship with `momentum`.
pub fn bolt_momentum(momentum: DVec3, direction: DVec3) -> DVec3 {
    let muzzle = direction * MUZZLE_MOMENTUM;
    rest_to_rain(momentum, muzzle) + momentum * (1.0 + MUZZLE_MOMENTUM * MUZZLE_MOMENTUM).sqrt()
}

fn fire(
    clock: Res<Clock>,
    fleet: Res<Fleet>,
    mut bolts: ResMut<Bolts>,
    mut ships: Query<(&ShipMotion, &mut Gun, &mut Trigger), Without<Ended>>,
) {
    for &entity in &fleet.0 {
        let Ok((motion, mut gun, mut trigger)) = ships.get_mut(entity) else { continue };
        if std::mem::take(&mut trigger.pulled) && gun.left > 0 && clock.time >= gun.ready {
            gun.left -= 1;
            gun.ready = clock.time + RELOAD;
            let state = fired_by(&motion.0);
            let mut history = History::new(clock.time, &state);
            history.begins(clock.time);
            bolts.add(Bolt { owner: entity, state, fired: clock.time, ended: None, history });
        }
    }
}

/// Flies the bolts a step, as ships fly, and sees what they hit. The ships have flown it already, and the clock has gone on.
fn fly_bolts(
    clock: Res<Clock>,
    fleet: Res<Fleet>,
    mut bolts: ResMut<Bolts>,
    mut ships: Query<(&Ship, &ShipMotion, &History, Option<&mut Hits>), Without<Ended>>,
    mut events: MessageWriter<SimEvent>,
) {
    let (to, from) = (clock.time, clock.time - clock.step);
    for bolt in bolts.0.iter_mut().filter(|bolt| bolt.ended.is_none()) {
        let before = bolt.state;
        let flight = Flight { state: before, fuel: 0.0 };
        let history = &mut bolt.history;
        let (end, reached) = fly(&flight, from, to, Command::default(), &[], |leg| history.push(leg.time, leg.state, &leg.command));
        if !end.state.is_finite() {
            bolt.ended = Some(from);
            continue;
        }
        bolt.state = end.state;
        for &entity in fleet.0.iter().filter(|&&entity| entity != bolt.owner) {
            let Ok((ship, motion, worldline, hits)) = ships.get_mut(entity) else { continue };
            let there = [worldline.at(from).position, motion.0.position];
            if nearest(before.position - there[0], end.state.position - there[1]) <= HIT_RADIUS {
                bolt.ended = Some(to);
                if let Some(mut hits) = hits {
                    hits.0 += 1;
                }
                events.write(SimEvent::Hit { ship: ship.name.clone(), time: to });
                break;
            }
        }
        if bolt.ended.is_none() && (has_ended(&end.state) || to - bolt.fired > LIFE) {
            bolt.ended = Some(reached);
        }
        if let Some(ended) = bolt.ended {
            bolt.history.ends(ended);
        }
    }
}

/// The least distance from the origin to the straight line between two places, in their unit.
pub fn nearest(from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let share = (-from.dot(way) / way.length_squared().max(1e-30)).clamp(0.0, 1.0);
    (from + way * share).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::frames::relative_velocity;

    #[test]
    fn a_bolt_leaves_the_ship_at_its_muzzle_speed() {
        for momentum in [DVec3::ZERO, DVec3::new(0.4, -0.7, 0.2), DVec3::new(30.0, 0.0, 5.0)] {
            let ship = ShipState::new(DVec3::new(6.0, 2.0, 1.0), momentum);
            let speed = relative_velocity(momentum, fired_by(&ship).momentum).length();
            assert!((speed - MUZZLE_SPEED).abs() < 1e-9, "{speed}");
        }
    }

    #[test]
    fn the_nearest_point_lies_between_the_ends() {
        assert_eq!(nearest(DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)), 1.0);
        assert_eq!(nearest(DVec3::new(3.0, 4.0, 0.0), DVec3::new(6.0, 8.0, 0.0)), 5.0);
        assert_eq!(nearest(DVec3::X, DVec3::X), 1.0);
    }
}
