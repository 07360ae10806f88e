//! The flight of one ship through one span of T: engine, programme, fuel. Plain functions; the ECS calls them.

use glam::DVec3;

use crate::scene::ship::Burn;
use crate::spacetime::matter::{ShipState, has_ended, step, step_until};

/// What the pilot asks of the ship, constant over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Proper acceleration in body axes, c²/r_s.
    pub thrust: DVec3,
    /// Body rates, rad per proper r_s/c.
    pub rates: DVec3,
}

/// A ship in flight: its state, and the Δv left in its tanks (c; infinite for a ship without limits).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Where it is.
    pub state: ShipState,
    /// ∫ |proper acceleration| dτ still available, in c.
    pub fuel: f64,
}

/// What [`fly`] reports of every substep.
#[derive(Clone, Copy, Debug)]
pub struct Leg<'a> {
    /// T at its end, in r_s/c.
    pub time: f64,
    /// The state there.
    pub state: &'a ShipState,
    /// The command in force, after programme and fuel.
    pub command: Command,
}

/// Flies from T = `from` to T = `to`: the programme's burn where there is one, else `command`; engines stop when the tank is empty.
/// Switch times and the moment the tank runs dry split the step. Returns the flight there and the T it really reached, which is less
/// than `to` only for a ship that has ended.
pub fn fly(flight: &Flight, from: f64, to: f64, command: Command, programme: &[Burn], mut visit: impl FnMut(Leg)) -> (Flight, f64) {
    let mut now = *flight;
    let mut time = from;
    while time < to && !has_ended(&now.state) {
        let end = next_switch(programme, time).min(to);
        let mut order = commanded(programme, time, command);
        let magnitude = order.thrust.length();
        if now.fuel <= 0.0 {
            order.thrust = DVec3::ZERO;
        }
        let mut span = end - time;
        let mut dry = false;
        if magnitude > 0.0 && now.fuel > 0.0 && now.fuel.is_finite() {
            let burn_time = now.fuel / magnitude;
            let covered = step(&now.state, span, order.thrust, order.rates).proper_time - now.state.proper_time;
            if covered >= burn_time {
                dry = true;
                span = dry_after(&now.state, span * burn_time / covered, burn_time, &order);
            }
        }
        let (state, elapsed) = step_until(&now.state, span, order.thrust, order.rates, |elapsed, state| {
            let here = if elapsed == span && !dry { end } else { time + elapsed };
            visit(Leg { time: here, state, command: order });
        });
        now.fuel = if dry { 0.0 } else { (now.fuel - order.thrust.length() * (state.proper_time - now.state.proper_time)).max(0.0) };
        now.state = state;
        if elapsed < span {
            time += elapsed;
            break;
        }
        let reached = if dry { time + span } else { end };
        if reached <= time && !dry {
            break;
        }
        time = reached;
    }
    (now, time)
}

/// How much T it takes until `burn_time` of proper time has passed; four Newton steps from `guess`, enough for any step in use.
fn dry_after(state: &ShipState, guess: f64, burn_time: f64, order: &Command) -> f64 {
    let mut span = guess;
    for _ in 0..4 {
        let end = step(state, span, order.thrust, order.rates);
        let rate = 1.0 / crate::spacetime::matter::gamma(end.momentum);
        span += (burn_time - (end.proper_time - state.proper_time)) / rate;
    }
    span.clamp(0.0, guess * 2.0)
}

fn next_switch(programme: &[Burn], time: f64) -> f64 {
    programme.iter().flat_map(|burn| [burn.from, burn.until]).filter(|&t| t > time).fold(f64::INFINITY, f64::min)
}

fn commanded(programme: &[Burn], time: f64, command: Command) -> Command {
    match programme.iter().find(|burn| burn.from <= time && time < burn.until) {
        Some(burn) => Command { thrust: burn.acceleration, rates: command.rates },
        None => command,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn far(fuel: f64) -> Flight {
        Flight { state: ShipState::new(DVec3::new(1e6, 0.0, 0.0), DVec3::ZERO), fuel }
    }

    #[test]
    fn switch_times_split_the_step() {
        let burns = [Burn { from: 0.3, until: 0.55, acceleration: DVec3::Y }];
        let (whole, reached) = fly(&far(f64::INFINITY), 0.0, 1.0, Command::default(), &burns, |_| ());
        let mut parts = far(f64::INFINITY);
        for (from, to) in [(0.0, 0.3), (0.3, 0.4), (0.4, 0.55), (0.55, 1.0)] {
            parts = fly(&parts, from, to, Command::default(), &burns, |_| ()).0;
        }
        assert_eq!(reached, 1.0);
        assert!((whole.state.momentum.y - parts.state.momentum.y).abs() < 1e-15);
        // Flat space: p = aT for constant proper acceleration from rest.
        assert!((whole.state.momentum.y - 0.25).abs() < 1e-8, "{}", whole.state.momentum.y);
    }

    #[test]
    fn an_empty_tank_stops_the_engine_in_mid_step() {
        let command = Command { thrust: DVec3::Y, rates: DVec3::ZERO };
        let (end, reached) = fly(&far(0.4), 0.0, 1.0, command, &[], |_| ());
        assert_eq!((end.fuel, reached), (0.0, 1.0));
        assert!((end.state.momentum.y - f64::sinh(0.4)).abs() < 1e-8, "{}", end.state.momentum.y);
    }
}
