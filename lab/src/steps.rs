//! What a step of the simulation costs: coasting ships by their number, and the chase with its two pilots.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::sim::{app_of, step};

use crate::chart::ChartError;
use crate::say::say;

/// What a step of the simulation costs, by the number of ships: a table.
#[derive(Args, Clone, Debug)]
pub struct StepsRequest {
    /// Steps of two ships in each of five runs; with more ships fewer.
    #[arg(long, value_name = "N", default_value_t = 40_000, value_parser = whole::<u64>(1, 100_000_000))]
    pub steps: u64,
}

/// Numbers of coasting ships.
const SHIPS: [usize; 3] = [2, 20, 200];
/// Runs of each; the quickest counts, as others on the machine only make it slower.
const RUNS: usize = 5;
/// Steps before the first that is timed: until then histories grow and memory is fetched.
const WARM: u64 = 500;

/// `count` ships on circles of their own, r = 6 to 12.
fn circles(count: usize) -> Result<Scene, ChartError> {
    let ship = |k: usize| {
        let share = k as f64 / count as f64;
        format!("[[ship]]\nname = \"s{k}\"\norbit = {{ radius = {}, phase = {} }}\n", 6.0 + 6.0 * share, 6.0 * share)
    };
    Scene::from_toml(Path::new("circles.toml"), &(0..count).map(ship).collect::<String>())
        .map_err(|complaints| ChartError::Failed(complaints.to_string()))
}

/// Seconds a step, the least of [`RUNS`], over `steps` steps each.
fn seconds(scene: &Scene, steps: u64) -> f64 {
    let run = || {
        let mut app = app_of(scene, &GameConfig::default(), 0);
        let world = app.world_mut();
        let mut fly = |steps: u64| {
            for _ in 0..steps {
                step(world);
                world.clear_trackers();
            }
        };
        fly(WARM);
        let began = Instant::now();
        fly(steps);
        began.elapsed().as_secs_f64() / steps as f64
    };
    (0..RUNS).map(|_| run()).fold(f64::INFINITY, f64::min)
}

/// Times them and says a table.
pub fn run(request: &StepsRequest) -> Result<Vec<PathBuf>, ChartError> {
    say(table(request.steps)?.trim_end());
    Ok(Vec::new())
}

fn table(steps: u64) -> Result<String, ChartError> {
    let mut table = String::from("| what flies | steps a second | µs a step | µs a step and ship |\n|---|---|---|---|\n");
    let mut row = |name: &str, ships: usize, seconds: f64| {
        let micro = 1e6 * seconds;
        _ = writeln!(table, "| {name} | {:.0} | {micro:.1} | {:.2} |", 1.0 / seconds, micro / ships as f64);
    };
    for count in SHIPS {
        // As many steps of a ship for each number.
        let steps = (steps * 2 / count as u64).max(1);
        row(&format!("{count} coasting ships"), count, seconds(&circles(count)?, steps));
    }
    row("chase, two pilots", 2, seconds(&scene::load("chase")?, steps));
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_for_each_number_and_the_chase() {
        let text = table(4).expect("scenes");
        assert_eq!(text.lines().count(), 2 + SHIPS.len() + 1, "{text}");
    }
}
