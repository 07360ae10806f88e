//! Flight by hand: the player's commands become the controls of the player's ship.

use bevy::prelude::*;

use super::SimSet;
use super::bolts::Trigger;
use super::clock::Clock;
use super::intercept::Way;
use super::player_commands::{ManualControl, PlayerCommands};
use super::ship::{Controls, Engine, Manual, Player, ShipMotion};
use super::target::Targets;

/// The assist has taken the thrust from the player in the last step to keep off the hole.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Avoiding(pub bool);

/// The player's commands to the player's ship, in `SimSet::Input`.
pub struct PlayerCommandsPlugin;

impl Plugin for PlayerCommandsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<PlayerCommands>().init_resource::<Avoiding>().add_systems(
            FixedUpdate,
            (choose_pilot, apply_commands).chain().in_set(SimSet::Input).run_if(resource_exists::<ManualControl>),
        );
    }
}

/// The player's ship is flown by hand, unless the player lets the autopilot fly.
pub fn choose_pilot(player_commands: Res<PlayerCommands>, ships: Query<(Entity, Has<Manual>), With<Player>>, mut commands: Commands) {
    for (ship, manual) in &ships {
        match (player_commands.autopilot, manual) {
            (true, true) => _ = commands.entity(ship).remove::<Manual>(),
            (false, false) => _ = commands.entity(ship).insert(Manual),
            _ => (),
        }
    }
}

type ByHand = (With<Player>, With<Manual>);
/// A ship: how it moves, what it can do, what is asked of it, its way to the mark, and its trigger.
type Flown<'a> = (Entity, &'a ShipMotion, &'a mut Engine, &'a mut Controls, &'a mut Way, Option<&'a mut Trigger>);

/// The player's commands become the ship's controls.
fn apply_commands(
    (player_commands, control, clock): (Res<PlayerCommands>, Res<ManualControl>, Res<Clock>),
    targets: Targets,
    mut avoiding: ResMut<Avoiding>,
    mut ships: Query<Flown, ByHand>,
) {
    avoiding.0 = false;
    for (ship, motion, mut engine, mut controls, mut way, trigger) in &mut ships {
        engine.max_rate = control.turn_rate / player_commands.pace;
        let mark = player_commands.facing.then(|| targets.mark((ship, &mut way), &motion.0, clock.time, engine.max_thrust)).flatten();
        let asked = mark.map_or(*player_commands, |(mark, serves)| player_commands.turned_to(mark, serves));
        let known = asked.needs_target().then(|| targets.known(ship, &motion.0, clock.time)).flatten();
        let help = asked.command(&motion.0, &engine, known.map(|known| known.point.velocity()), &control.assist);
        avoiding.0 = help.avoiding;
        controls.0 = help.command;
        if let Some(mut trigger) = trigger {
            trigger.pulled = asked.fire;
        }
    }
}
