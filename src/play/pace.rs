//! The game's pace: near danger it slows by itself, where the player lets it (`clock.slow_near_danger`).

use std::time::Duration;

use bevy::prelude::*;

use crate::play::loading::Loading;
use crate::play::menus::screens::Screen;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::sim::pilot::rollout::{Point, advance};
use crate::sim::replay::Playback;
use crate::sim::{ActiveMission, Fleet, ShipMotion};

/// The share of the chosen pace at which the game goes on, 0.25 to 1.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Slowing(pub f64);

impl Default for Slowing {
    fn default() -> Self {
        Slowing(1.0)
    }
}

/// Time stands still, but for single steps: for the dev overlay.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Freeze {
    /// It does.
    pub on: bool,
    /// Steps that are to pass.
    pub steps: u32,
}

/// The share of the pace until the first input.
const BEFORE_INPUT: f64 = 0.25;
/// The least share of the pace near danger.
const SLOWEST: f64 = 0.4;
/// The game slows when danger is less far ahead than this, in r_s/c of T, and is slowest at [`HERE`].
const AHEAD: f64 = 6.0;
/// See [`AHEAD`].
const HERE: f64 = 2.0;
/// How finely the way ahead is looked through, in r_s/c.
const STEP: f64 = 0.5;
/// Below this radius, in r_s, the hole is a danger: free fall from the photon sphere, 1.5, comes back only outward.
const DEEP: f64 = 1.7;
/// Another ship is near within this distance, in r_s: it takes a hand to hold it or to keep off.
const NEAR: f64 = 0.8;
/// Wall time in which the pace falls, in seconds, and in which it rises: the first touch does not throw one forward.
const LAG: (f64, f64) = (0.5, 1.5);

/// Slows the game near danger. Needs [`Session`] and [`PlayerState`].
pub struct PacePlugin;

impl Plugin for PacePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Slowing>()
            .init_resource::<Freeze>()
            .add_systems(Update, (slow_down, step_frozen.after(run_time)).in_set(GameSet::Answer));
    }
}

fn slow_down(
    (session, player, screen): (Res<Session>, Res<PlayerState>, Res<State<Screen>>),
    (playback, mission): (Option<Res<Playback>>, Option<Res<ActiveMission>>),
    fleet: Option<Res<Fleet>>,
    real: Res<Time<Real>>,
    ships: Query<&ShipMotion>,
    mut slowing: ResMut<Slowing>,
) {
    let by_hand = *screen.get() == Screen::Playing && !player.autopilot && playback.is_none();
    let wanted = if by_hand && session.config.clock.slow_near_danger {
        let points: Vec<Point> =
            fleet.iter().flat_map(|fleet| &fleet.0).filter_map(|&ship| ships.get(ship).ok()).map(|m| Point::from(&m.0)).collect();
        let me = session.player();
        let others = points.iter().enumerate().filter(|(index, _)| *index != me).map(|(_, point)| *point).collect();
        points.get(me).map_or(1.0, |own| share(danger(*own, others, mission.is_some_and(|mission| mission.0.inside))))
    } else {
        1.0
    };
    // Until the player does something there is time to read.
    let wanted = if by_hand && !player.touched { wanted.min(BEFORE_INPUT) } else { wanted };
    let lag = if wanted < slowing.0 { LAG.0 } else { LAG.1 };
    slowing.0 += (wanted - slowing.0) * (1.0 - (-real.delta_secs_f64() / lag).exp());
}

/// Lets the steps pass that were asked for while time stands still.
fn step_frozen(world: &mut World) {
    let Freeze { on: true, steps: 1.. } = *world.resource::<Freeze>() else { return };
    let steps = std::mem::take(&mut world.resource_mut::<Freeze>().steps);
    if world.resource::<State<Screen>>().get().runs() {
        (0..steps).for_each(|_| world.run_schedule(FixedUpdate));
    }
}

/// Game time: its pace, its step, and whether it passes.
pub(in crate::play) fn run_time(
    screen: Res<State<Screen>>,
    next: Res<NextState<Screen>>,
    (session, slowing, loading, freeze): (Res<Session>, Res<Slowing>, Option<Res<Loading>>, Res<Freeze>),
    mut time: ResMut<Time<Virtual>>,
    mut fixed: ResMut<Time<Fixed>>,
) {
    let leaving = matches!(*next, NextState::Pending(next) if !next.runs());
    if !screen.get().runs() || leaving || loading.is_some() || freeze.on {
        // Nor does the step change: of a shorter one there would be some left to be flown.
        time.pause();
        return;
    }
    let clock = &session.config.clock;
    let step = clock.step / (clock.pace * slowing.0);
    fixed.set_timestep_seconds(step);
    time.set_max_delta(Duration::from_secs_f64((step * f64::from(clock.max_steps)).clamp(0.01, 0.5)));
    time.unpause();
}

/// The share of the pace with danger `ahead`, in r_s/c of T.
fn share(ahead: f64) -> f64 {
    SLOWEST + (1.0 - SLOWEST) * (1.0 - nearness(ahead))
}

/// How near danger is that is `ahead`, in r_s/c of T: 0 beyond [`AHEAD`], 1 at [`HERE`].
pub(in crate::play) fn nearness(ahead: f64) -> f64 {
    1.0 - ((ahead - HERE) / (AHEAD - HERE)).clamp(0.0, 1.0)
}

/// How far ahead danger is if all coast, in r_s/c of T; infinite beyond [`AHEAD`]. `inside`: the hole is none.
pub(in crate::play) fn danger(mut own: Point, mut others: Vec<Point>, inside: bool) -> f64 {
    let mut time = 0.0;
    while time < AHEAD {
        let deep = !inside && own.x.length_squared() < DEEP * DEEP;
        if deep || others.iter().any(|other| other.x.distance_squared(own.x) < NEAR * NEAR) {
            return time;
        }
        own = advance(&own, STEP, 1.0, |_| glam::DVec3::ZERO);
        for other in &mut others {
            *other = advance(other, STEP, 1.0, |_| glam::DVec3::ZERO);
        }
        time += STEP;
    }
    f64::INFINITY
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::matter::ShipState;
    use crate::spacetime::orbit::circular_orbit;
    use glam::DVec3;

    fn orbit(radius: f64, phase: f64) -> Point {
        Point::from(&circular_orbit(radius, phase).expect("a circle"))
    }

    #[test]
    fn a_fall_is_danger_and_an_orbit_is_none() {
        assert_eq!(danger(orbit(6.0, 0.0), vec![], false), f64::INFINITY);
        // The rain falls from r to 1.7 in 2/3 (r^1.5 − 1.7^1.5).
        let rain = Point::from(&ShipState::new(DVec3::X * 3.0, DVec3::ZERO));
        let fall = 2.0 / 3.0 * (3f64.powf(1.5) - DEEP.powf(1.5));
        assert!((danger(rain, vec![], false) - fall).abs() <= STEP, "{} {fall}", danger(rain, vec![], false));
        assert_eq!(danger(rain, vec![], true), f64::INFINITY);
    }

    #[test]
    fn ships_that_meet_are_danger() {
        assert_eq!(danger(orbit(6.0, 0.0), vec![orbit(6.0, 0.1)], false), 0.0);
        assert_eq!(danger(orbit(6.0, 0.0), vec![orbit(6.0, 1.0)], false), f64::INFINITY, "they stay apart");
    }

    #[test]
    fn the_pace_is_whole_far_from_danger_and_never_stands() {
        assert_eq!((share(f64::INFINITY), share(0.0)), (1.0, SLOWEST));
        assert!(share(3.0) < share(5.0));
    }
}
