//! [`ShipPhysicsPlugin`]: all ships fly one fixed step.

use bevy::prelude::*;

use crate::scene::ship::Burn;
use crate::spacetime::matter::{gamma, has_ended};

use super::clock::Clock;
use super::flight::{Command, Flight, fly};
use super::history::History;
use super::ship::{Controls, CrossedHorizon, EndReason, Ended, Engine, Fleet, Fuel, Programme, Ship, ShipMotion, Turning};
use super::{SimEvent, SimSet};

/// Integrates the ships, in `SimSet::Integrate`; the clock goes on last.
pub struct ShipPhysicsPlugin;

impl Plugin for ShipPhysicsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Clock>()
            .init_resource::<Fleet>()
            .add_message::<SimEvent>()
            .add_systems(FixedUpdate, (integrate_ships, advance_clock).chain().in_set(SimSet::Integrate));
    }
}

type Flying<'a> = (
    (&'a Ship, &'a Engine, &'a Controls, &'a Programme),
    (&'a mut ShipMotion, &'a mut Turning, &'a mut Fuel, &'a mut History),
    Has<CrossedHorizon>,
);

/// Flies every ship that has not ended from `clock.time` to the next step, adding the substeps to its history.
pub fn integrate_ships(
    clock: Res<Clock>,
    fleet: Res<Fleet>,
    mut ships: Query<Flying, Without<Ended>>,
    mut events: MessageWriter<SimEvent>,
    mut commands: Commands,
) {
    let (from, to) = (clock.time, clock.next());
    for &entity in &fleet.0 {
        let Ok(((ship, engine, controls, programme), (mut motion, mut turning, mut fuel, mut history), crossed)) = ships.get_mut(entity)
        else {
            continue;
        };
        let flight = Flight { state: motion.0, fuel: fuel.left };
        turning.0 = engine.turn(controls.0.rates, turning.0, (to - from) / gamma(motion.0.momentum));
        let order = Command { thrust: engine.thrust(controls.0.thrust), rates: turning.0 };
        let (end, reached) = fly(&flight, from, to, order, &programme.0, |leg| history.push(leg.time, leg.state, &leg.command));
        if flight.fuel > 0.0 && end.fuel <= 0.0 {
            events.write(SimEvent::FuelSpent { ship: ship.name.clone(), time: to });
        }
        if end.state.is_finite() {
            motion.0 = end.state;
        }
        fuel.left = end.fuel;
        if !crossed && motion.0.position.length() < 1.0 {
            let time = crossing_time(&flight, from, reached, order, &programme.0);
            commands.entity(entity).insert(CrossedHorizon(time));
            if flight.state.position.length() >= 1.0 {
                events.write(SimEvent::CrossedHorizon { ship: ship.name.clone(), time });
            }
        }
        if has_ended(&end.state) {
            let reason = if end.state.is_finite() { EndReason::Singularity } else { EndReason::NotFinite };
            commands.entity(entity).insert(Ended { time: reached, reason });
            events.write(SimEvent::Ended { ship: ship.name.clone(), time: reached, proper_time: motion.0.proper_time, reason });
        }
    }
}

/// The T between `from` and `to` at which the ship goes through r = 1, by halving; `from` if it was inside already.
fn crossing_time(flight: &Flight, from: f64, to: f64, order: Command, programme: &[Burn]) -> f64 {
    let (mut outside, mut inside) = (from, to);
    for _ in 0..50 {
        let middle = 0.5 * (outside + inside);
        if fly(flight, from, middle, order, programme, |_| ()).0.state.position.length() < 1.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

pub(super) fn advance_clock(mut clock: ResMut<Clock>) {
    clock.advance();
}
