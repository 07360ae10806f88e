//! Flights as hashes of all ships every 64 steps, a line each: `./test-web` compares those of this machine with those of WebAssembly.

#[path = "../../../src/inside.rs"]
mod inside;

use std::fmt::Write as _;
use std::path::Path;

use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, Difficulty, GameConfig};
use lensrunner::sim::replay::Replay;
use lensrunner::sim::run::state_hash;
use lensrunner::sim::{Clock, ShipMotion, app_of, board, outcome, step};

/// Steps between two hashes.
const EVERY: u64 = 64;
/// Flights of pilots, over all missions and difficulties.
const FLIGHTS: u64 = 100;
/// How long a scene is flown, in r_s/c.
const SPAN: f64 = 64.0;

/// The parts of the comparison.
pub const PARTS: [&str; 3] = ["replays", "pilots", "scenes"];

/// The parts of the comparison, for JavaScript.
#[cfg(target_family = "wasm")]
#[wasm_bindgen::prelude::wasm_bindgen]
pub fn parts() -> Vec<String> {
    PARTS.map(String::from).into()
}

/// The lines of a part. `wrong`: after the first hash a ship is off by the last bit of one number, as by a sine of another library.
#[cfg_attr(target_family = "wasm", wasm_bindgen::prelude::wasm_bindgen)]
pub fn lines(part: &str, wrong: bool) -> Result<String, String> {
    lensrunner::game_files::embed(inside::FILES.iter().copied());
    let mut lines = String::new();
    let config = GameConfig::default();
    match part {
        "replays" => {
            for name in lensrunner::game_files::names("assets/replays") {
                let path = Path::new(&name);
                let replay = Replay::load(path).map_err(|error| error.to_string())?;
                let scene = replay.scene(path, None).map_err(|error| error.to_string())?;
                let end = replay.ticks as f64 * config.clock.step;
                fly(&mut replay.app(&scene, &config), &name, end, wrong, &mut lines);
            }
        }
        "pilots" => {
            let missions = scene::mission_names();
            for seed in 0..FLIGHTS {
                let among = |count: usize, every: u64| (seed / every) as usize % count;
                let name = &missions[among(missions.len(), 1)];
                let pilot = [PilotKind::Expert, PilotKind::Apprentice, PilotKind::Naive][among(3, missions.len() as u64)];
                let difficulty = Difficulty::ALL[among(Difficulty::ALL.len(), 3 * missions.len() as u64)];
                let scene = scene::load(name).map_err(|error| error.to_string())?;
                let config = scene.config(&config, difficulty);
                let mut app = app_of(&scene, &config, seed);
                board(app.world_mut(), pilot);
                fly(&mut app, &format!("{name} {difficulty} {pilot} {seed}"), scene.rules(&config).time_limit, wrong, &mut lines);
            }
        }
        "scenes" => {
            for name in scene::names() {
                let scene = scene::load(&name).map_err(|error| error.to_string())?;
                fly(&mut app_of(&scene, &config, 0), &name, SPAN, wrong, &mut lines);
            }
        }
        other => return Err(format!("{other}: no part; there are {}", PARTS.join(", "))),
    }
    Ok(lines)
}

/// Flies to the end, or until T = `until` (r_s/c).
fn fly(app: &mut bevy::app::App, name: &str, until: f64, mut wrong: bool, lines: &mut String) {
    let world = app.world_mut();
    loop {
        step(world);
        let clock = *world.resource::<Clock>();
        let ends = outcome(world).is_some() || clock.time >= until;
        if clock.tick.is_multiple_of(EVERY) || ends {
            _ = writeln!(lines, "{name}: step {}, {}", clock.tick, state_hash(world));
            if std::mem::take(&mut wrong)
                && let Some(mut motion) = world.query::<&mut ShipMotion>().iter_mut(world).next()
            {
                motion.0.position.x = motion.0.position.x.next_up();
            }
        }
        if ends {
            return;
        }
    }
}
