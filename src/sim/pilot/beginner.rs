//! How somebody flies who plays for the first time: nose to the marker, full thrust, assist on. It shows whether a mission can be won
//! without knowing anything, and is no opponent.

use bevy::prelude::*;
use glam::DVec3;

use super::steer::turn_nose;
use crate::sim::assist::{AssistSettings, Reference, Stick, assisted};
use crate::sim::bolts::Trigger;
use crate::sim::clock::Clock;
use crate::sim::goals::ActiveMission;
use crate::sim::history::History;
use crate::sim::player_commands::ManualControl;
use crate::sim::ship::{Controls, Ended, Engine, Fleet, Pilot, PilotOrder, ShipMotion};
use crate::sim::sight::{apparition, true_direction};
use crate::spacetime::Observer;
use crate::spacetime::light::Order as ImageOrder;
use crate::spacetime::matter::ShipState;

/// Marks a ship that is flown so.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Beginner {
    /// Where it saw its mark, on body axes of that moment, turned to rest-frame axes; None at first.
    seen: Option<DVec3>,
    /// T of the next look, in r_s/c.
    next_look: f64,
}

/// T between two looks at the marker, in r_s/c: a sixth of a second at the usual pace.
const LOOK: f64 = 0.25;
/// The nose is on the mark within this angle, in radians; before, a beginner only turns.
const ON_MARK: f64 = 0.35;
/// A beginner fires within this angle, in radians.
const FIRES: f64 = 0.03;

/// Farther out than this, in r_s, one who flees does not go on outward.
const OUT: f64 = 8.0;

type BeginnerShip<'a> = (&'a Pilot, &'a mut Beginner, &'a mut Controls, &'a ShipMotion, &'a Engine, Option<&'a mut Trigger>);

/// Sets the controls of every beginner's ship.
pub fn fly_as_beginner(
    (clock, fleet): (Res<Clock>, Res<Fleet>),
    control: Option<Res<ManualControl>>,
    mission: Option<Res<ActiveMission>>,
    mut ships: Query<BeginnerShip, Without<Ended>>,
    others: Query<&History>,
) {
    let assist = control.map_or(AssistSettings { damping_time: 3.0, avoid_radius: None }, |control| control.assist);
    let marked_now = mission.is_none_or(|mission| mission.0.now_marker);
    for &entity in &fleet.0 {
        let Ok((pilot, mut beginner, mut controls, motion, engine, trigger)) = ships.get_mut(entity) else { continue };
        let state = &motion.0;
        if clock.time >= beginner.next_look {
            let other = pilot.order.target().and_then(|ship| others.get(ship).ok());
            beginner.seen = mark(state, clock.time, pilot.order, other, marked_now).map(|ahead| state.attitude * ahead);
            beginner.next_look = clock.time + LOOK;
        }
        let ahead = beginner.seen.map(|seen| state.attitude.conjugate() * seen);
        let stick = stick(pilot.order, ahead);
        let mut command = assisted(state, &stick, engine, Reference::Orbit, &assist).command;
        if let Some(ahead) = ahead {
            command.rates = turn_nose(ahead, engine.fastest_turn());
        }
        controls.0 = command;
        if let (Some(mut trigger), Some(ahead), PilotOrder::Hit(_)) = (trigger, ahead, pilot.order) {
            trigger.pulled = ahead.angle_between(DVec3::NEG_Z) < FIRES;
        }
    }
}

/// What a beginner commands with the mark at `ahead` (body axes).
fn stick(order: PilotOrder, ahead: Option<DVec3>) -> Stick {
    let on_mark = ahead.is_some_and(|ahead| ahead.angle_between(DVec3::NEG_Z) < ON_MARK);
    let pushes = match order {
        PilotOrder::Rest | PilotOrder::Turn | PilotOrder::Face(_) => false,
        PilotOrder::Catch(_) | PilotOrder::Hit(_) | PilotOrder::Escape(_) | PilotOrder::Pass(_) | PilotOrder::Keep(_) => on_mark,
    };
    Stick { thrust: if pushes { DVec3::NEG_Z } else { DVec3::ZERO }, turn: if order == PilotOrder::Turn { DVec3::Y } else { DVec3::ZERO } }
}

/// The direction to fly to, on body axes.
fn mark(state: &ShipState, time: f64, order: PilotOrder, other: Option<&History>, marked_now: bool) -> Option<DVec3> {
    let ShipState { position, momentum, attitude, .. } = *state;
    let eye = Observer { position, momentum, attitude, field_of_view: 1.0 };
    let to_body = attitude.conjugate();
    match order {
        PilotOrder::Catch(_) | PilotOrder::Hit(_) if marked_now => true_direction(&eye, other?.at(time).position),
        PilotOrder::Catch(_) | PilotOrder::Hit(_) | PilotOrder::Face(_) => {
            Some(apparition(&eye, time, other?, ImageOrder::ALL[0])?.direction)
        }
        // Too far out there is no help: along the way it goes already.
        PilotOrder::Escape(_) if position.length() > OUT => {
            let outward = position / position.length();
            Some(to_body * momentum.reject_from(outward).try_normalize()?)
        }
        PilotOrder::Escape(_) => true_direction(&eye, other?.at(time).position).map(|there| -there),
        PilotOrder::Pass(place) => true_direction(&eye, place),
        // Outward or inward, along the line from the hole.
        PilotOrder::Keep(radius) => {
            let outward = position / position.length();
            Some(to_body * if position.length() < radius { outward } else { -outward })
        }
        PilotOrder::Rest | PilotOrder::Turn => None,
    }
}
