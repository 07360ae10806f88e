//! The configuration while the game runs: `game.toml` is read again when it changes, and every change, from there or from the overlay,
//! takes effect at once.

use crate::play::hud::notice::Notice;
use std::time::{Duration, SystemTime};

use bevy::prelude::*;

use crate::scene::GameConfig;
use crate::scene::config;
use crate::scene::ship::Ai;
use crate::sim::assist::AssistMode;
use crate::sim::player_commands::ManualControl;
use crate::sim::replay::ReplayLog;
use crate::sim::setup::{reach_of, skills};
use crate::sim::{ChaseRules, Clock, Engine, Fleet, Skills};

use crate::play::choices::Choices;
use crate::play::input::bindings::Bindings;
use crate::play::menus::navigate::FileConfig;
use crate::play::picture::stage_loading::{CurrentStage, restage};
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::Session;

/// Time between two looks at the file.
const PERIOD: Duration = Duration::from_secs(1);

/// Watches the file and applies changes.
pub struct LivePlugin;

impl Plugin for LivePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Notice>().add_systems(Update, (reload, apply).chain().in_set(GameSet::Configure));
    }
}

fn reload(
    mut session: ResMut<Session>,
    real: Res<Time<Real>>,
    mut notice: ResMut<Notice>,
    (choices, mut base): (Option<Res<Choices>>, Option<ResMut<FileConfig>>),
    mut look: Local<(Duration, Option<SystemTime>)>,
    mut last: Local<Option<GameConfig>>,
) {
    let (next, seen) = &mut *look;
    let Some(file) = session.config_file.clone() else { return };
    if real.elapsed() < *next {
        return;
    }
    *next = real.elapsed() + PERIOD;
    let Some(changed) = std::fs::metadata(&file).and_then(|data| data.modified()).ok() else { return };
    let said = last.get_or_insert_with(|| {
        let mut said = base.as_ref().map_or_else(|| session.config.clone(), |base| base.0.clone());
        choices.iter().for_each(|choices| choices.over(&mut said));
        said
    });
    if seen.replace(changed).is_none_or(|before| before == changed) {
        return;
    }
    let text = match config::load(&file) {
        Ok(mut config) => {
            if let Some(base) = &mut base {
                base.0 = config.clone();
            }
            choices.iter().for_each(|choices| choices.over(&mut config));
            session.config = taken_up(&session.config, said, &config);
            *said = config;
            format!("{} read again", file.display())
        }
        Err(error) => {
            warn!("{error}\nThe last good values stay.");
            format!("{error}\nThe last good values stay.")
        }
    };
    // Time to read each line.
    let seconds = 4.0 + 2.0 * text.lines().count() as f64;
    *notice = Notice { text, until: real.elapsed_secs_f64() + seconds, share: None };
}

/// What to play with after the file, which said `before`, says `now`: what it says otherwise than before; all else stays as it is in
/// `playing`, whoever changed it: keys, menus, the overlay, the command line.
fn taken_up(playing: &GameConfig, before: &GameConfig, now: &GameConfig) -> GameConfig {
    let mut config = playing.clone();
    for setting in config::settings() {
        let value = setting.get(now);
        if value != setting.get(before) {
            // It was checked as it was read.
            _ = setting.set(&mut config, value);
        }
    }
    // Two that do not go together: the file's is the last word.
    if config::check(now).is_ok() && config::check(&config).is_err() { now.clone() } else { config }
}

/// Whether the models and the disk of the scene are to be made again.
fn changes_models(before: &GameConfig, now: &GameConfig) -> bool {
    if before.disk != now.disk || before.hole != now.hole || before.render.min_width != now.render.min_width {
        return true;
    }
    before.ship.size != now.ship.size || before.enemy.size != now.enemy.size || before.render.ambient != now.render.ambient
}

/// Whether ships fly otherwise with another configuration.
fn flies_otherwise(before: &GameConfig, now: &GameConfig) -> bool {
    before.ship != now.ship || before.enemy != now.enemy || before.assist != now.assist || before.rules != now.rules
}

fn apply(world: &mut World, mut before: Local<Option<GameConfig>>) {
    let session = world.resource::<Session>();
    if before.as_ref() == Some(&session.config) {
        return;
    }
    let session = session.clone();
    // A flight's log is that of the settings it began with.
    if world.get_resource::<ReplayLog>().is_some_and(|log| flies_otherwise(&log.0.config(&session.config), &session.config)) {
        world.remove_resource::<ReplayLog>();
    }
    let config = &session.effective();
    world.insert_resource(Bindings::of(config));
    world.insert_resource(ManualControl::from(config));
    // The autopilot's is that of whoever boarded.
    world.get_resource_or_init::<Skills>().enemy = skills(config).enemy;
    world.insert_resource(ChaseRules(session.scene.rules(config)));
    // The clock counts steps: a change of the step takes effect with the next chase, so that T never jumps.
    let fleet = world.get_resource::<Fleet>().cloned().unwrap_or_default();
    for (&ship, spec) in fleet.0.iter().zip(&session.scene.ships) {
        if let Some(mut engine) = world.get_mut::<Engine>(ship) {
            let thrust = if matches!(spec.ai, Ai::Flee | Ai::Pursue) && !spec.player { config.enemy.thrust } else { config.ship.thrust };
            engine.max_thrust = spec.max_thrust.unwrap_or(thrust);
            engine.reach = reach_of(spec, [config.ship.size, config.enemy.size]);
        }
    }
    // The key switches for the chase; a change of the configuration is newer.
    if before.as_ref().is_some_and(|before| AssistMode::of(before) != AssistMode::of(config))
        && let Some(mut player) = world.get_resource_mut::<PlayerState>()
    {
        player.assist = None;
    }
    if let Some(mut current) = world.get_resource_mut::<CurrentStage>() {
        if before.as_ref().is_some_and(|before| changes_models(before, config)) {
            restage(world);
        } else if before.as_ref().is_some_and(|before| before.aurora != config.aurora) {
            current.0.change_aurora(&config.aurora);
        }
    }
    *before = Some(session.config);
    debug_assert!(world.get_resource::<Clock>().is_some());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The player's pace outlives a change of anything else in the file, and ends with a change of its own.
    #[test]
    fn a_reload_keeps_what_the_keys_changed() {
        let before = GameConfig::default();
        let mut playing = before.clone();
        playing.clock.pace = 3.0;
        playing.video.reduced_motion = true;
        let mut now = before.clone();
        now.disk.arcs = 900;
        let kept = taken_up(&playing, &before, &now);
        assert_eq!((kept.disk.arcs, kept.clock.pace, kept.video.reduced_motion), (900, 3.0, true));

        now.clock.pace = 0.5;
        assert_eq!(taken_up(&kept, &before, &now).clock.pace, 0.5);
    }
}
