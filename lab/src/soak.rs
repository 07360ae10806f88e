//! Whether memory grows: a long flight without graphics, then many frames of many scenes on every rung of the picture's quality, with the
//! resident memory of the process after each tenth: `lensrunner-lab chart soak`.

use std::path::PathBuf;

use bevy::app::FixedUpdate;
use bevy::ecs::message::Messages;
use clap::Args;
use lensrunner::argument::whole;
use lensrunner::render::Gpu;
use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::render::quality::ladder::ladder;
use lensrunner::render::quality::options::turned;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::{History, SimEvent, app_of};

use crate::chart::{ChartError, Output, Sheet};
use crate::dial::moments::class_of;
use crate::offscreen::Offscreen;
use crate::say::say;

/// Whether memory grows over a long flight and many frames: a table.
#[derive(Args, Clone, Debug)]
pub struct SoakRequest {
    /// Where the sheet goes.
    #[command(flatten)]
    pub output: Output,
    /// Steps of the simulation.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = whole::<u64>(10, 100_000_000))]
    pub steps: u64,
    /// Frames.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = whole::<u64>(10, 10_000_000))]
    pub frames: u64,
}

/// Columns of the sheet.
pub const COLUMNS: [&str; 3] = ["what", "done", "resident MiB"];

/// Parts after each of which memory is read.
const PARTS: u64 = 10;
/// How much of the ships' histories is kept, in r_s/c.
const KEEP: f64 = 150.0;
/// The flight: pilots that hunt and flee, without an end.
const FLIGHT: &str = "chase";
/// The frames, in turn: a stage is uploaded anew each time.
const SCENES: [&str; 5] = ["chase", "disk-inner", "parade", "aurora-orbit", "plunge"];
/// Frames of a scene before the next.
const EACH: u64 = 50;
const SIZE: [u32; 2] = [160, 90];
/// T of the frames, in r_s/c: the camera of `plunge` is inside the horizon, and has not met its end.
const AT: f64 = 1.5;

/// Resident memory of the process in MiB; None where the system does not say.
fn resident() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmRSS:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn note(sheet: &mut Sheet, what: &str, done: u64) {
    let memory = resident().unwrap_or(f64::NAN);
    say(format_args!("{done} {what}: {memory:.1} MiB"));
    sheet.line(format_args!("{what}|{done}|{memory:.1}"));
}

/// Runs both, writes `soak.csv` and says what came out.
pub fn run(request: &SoakRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.sheet("soak", || measure(request))?;
    ["steps", "frames"].iter().for_each(|what| say(verdict(&sheet, what)));
    Ok(vec![request.output.csv("soak")])
}

fn measure(request: &SoakRequest) -> Result<Sheet, ChartError> {
    let gpu = Gpu::headless()?;
    let mut sheet = Sheet::measured(&COLUMNS, &gpu.adapter_name());
    fly(request.steps, &mut sheet)?;
    show(&gpu, request.frames, &mut sheet)?;
    Ok(sheet)
}

fn fly(steps: u64, sheet: &mut Sheet) -> Result<(), ChartError> {
    let config = GameConfig::default();
    let mut app = app_of(&scene::load(FLIGHT)?, &config, 1);
    let world = app.world_mut();
    for mut history in world.query::<&mut History>().iter_mut(world) {
        history.forget_beyond(KEEP);
    }
    for step in 1..=steps {
        world.run_schedule(FixedUpdate);
        world.clear_trackers();
        world.resource_mut::<Messages<SimEvent>>().clear();
        if step % (steps / PARTS).max(1) == 0 {
            note(sheet, "steps", step);
        }
    }
    Ok(())
}

fn show(gpu: &Gpu, frames: u64, sheet: &mut Sheet) -> Result<(), ChartError> {
    let config = GameConfig::default();
    let mut offscreen = Offscreen::new(gpu, SIZE);
    let mut done = 0;
    for round in 0.. {
        let scene = scene::load(SCENES[round % SCENES.len()])?;
        let mut stage = Stage::new(&mut offscreen.renderer, &scene, &config);
        // By hands, who throw the ship about.
        let mut moment = Moment::with_pilot(&scene, &config, 1, PilotKind::Hands);
        moment.advance((AT / config.clock.step).round() as u64);
        let rungs = ladder(QualityCosts::shipped(), class_of(&scene));
        for _ in 0..EACH {
            if scene.name == FLIGHT {
                moment.advance(1);
            }
            let camera = stage.camera(moment.time(), &moment.ships());
            let settings = turned(&settings(&config), &rungs[done as usize % rungs.len()].steps);
            offscreen.draw(&stage.frame(camera, SIZE, moment.time(), &moment.histories(), None, &settings))?;
            done += 1;
            if done % (frames / PARTS).max(1) == 0 {
                note(sheet, "frames", done);
            }
            if done >= frames {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Growth from the third tenth on: before that caches fill.
pub fn verdict(sheet: &Sheet, what: &str) -> String {
    let rows: Vec<_> = sheet.of([("what", what)]).collect();
    let (Some(early), Some(last)) = (rows.get(2), rows.last()) else { return format!("{what}: too few to tell") };
    let [from, to] = [early, last].map(|row| sheet.number(row, "resident MiB"));
    format!("{what}: {from:.1} MiB after {}, {to:.1} MiB after {}", sheet.text(early, "done"), sheet.text(last, "done"))
}
