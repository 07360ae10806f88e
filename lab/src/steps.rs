//! What a step of the simulation costs: coasting ships by their number, and the chase with its two pilots.

use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::sim::{app_of, step};

/// Numbers of coasting ships.
pub const SHIPS: [usize; 3] = [2, 20, 200];
/// Runs of each; the quickest counts, as others on the machine only make it slower.
const RUNS: usize = 5;
/// Steps before the first that is timed: until then histories grow and memory is fetched.
const WARM: u64 = 500;

/// `count` ships on circles of their own, r = 6 to 12.
fn circles(count: usize) -> Result<Scene, String> {
    let ship = |k: usize| {
        let share = k as f64 / count as f64;
        format!("[[ship]]\nname = \"s{k}\"\norbit = {{ radius = {}, phase = {} }}\n", 6.0 + 6.0 * share, 6.0 * share)
    };
    Scene::from_toml(Path::new("circles.toml"), &(0..count).map(ship).collect::<String>()).map_err(|error| error.to_string())
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

/// Times them and writes a table.
pub fn run(steps: u64, out: &mut dyn Write) -> Result<(), String> {
    let mut rows = Vec::new();
    for count in SHIPS {
        // As many steps of a ship for each number.
        let steps = (steps * 2 / count as u64).max(1);
        rows.push((format!("{count} coasting ships"), count, seconds(&circles(count)?, steps)));
    }
    rows.push(("chase, two pilots".to_owned(), 2, seconds(&scene::load("chase").map_err(|error| error.to_string())?, steps)));
    write_table(&rows, out).map_err(|error| error.to_string())
}

fn write_table(rows: &[(String, usize, f64)], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "| what flies | steps a second | µs a step | µs a step and ship |\n|---|---|---|---|")?;
    for (name, ships, seconds) in rows {
        let micro = 1e6 * seconds;
        writeln!(out, "| {name} | {:.0} | {micro:.1} | {:.2} |", 1.0 / seconds, micro / *ships as f64)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_for_each_number_and_the_chase() {
        let mut out = Vec::new();
        run(4, &mut out).expect("scenes");
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text.lines().count(), 2 + SHIPS.len() + 1, "{text}");
    }
}
