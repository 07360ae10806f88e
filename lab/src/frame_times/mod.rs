//! How long whole frames take, of scenes and of a flown chase, and every part of them: `lensrunner-lab chart frame`.
//!
//! What the processor does is timed in frames drawn as they are played; passes in a frame of the same moment that is submitted pass by pass
//! ([`Steps`](lensrunner::render::gpu::steps::Steps)), since a software driver's timestamps miss its passes of compute.

pub(crate) mod bench;
pub mod parts;
mod times;

use std::path::PathBuf;

use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::sim::Moment;

use lensrunner::render::Gpu;
use lensrunner::render::shot::{ShotError, surroundings};

use crate::chart::{ChartError, Sheet};
use crate::say::say;
use bench::Bench;
pub use times::{FrameTimes, FrameTimesRequest, Memory};

/// The scene whose chase is flown by its pilots.
const CHASE: &str = "chase";
/// T at which a chase ends undecided, in r_s/c.
const END: f64 = 120.0;
/// The columns of the sheet `frame`.
const COLUMNS: [&str; 7] = ["scene", "whose", "part", "mean_ms", "median_ms", "worst_ms", "share_of_frame"];

/// Times the scenes one after the other, then the chase, and says each result as it comes. What is wrong with any of them is said before
/// the first is drawn. Writes the sheets `frame` and, of the chase, `frame-flight`.
pub fn run(request: &FrameTimesRequest) -> Result<Vec<PathBuf>, ChartError> {
    let config = &scene::config::find(None)?;
    let played = |name: &String| -> Result<(Scene, Moment), ShotError> {
        let scene = scene::load(name)?;
        let moment = Moment::new(&scene, config, request.at, 0);
        scene.camera.check(moment.time(), &moment.ships())?;
        Ok((scene, moment))
    };
    let scenes: Vec<_> = request.scenes.iter().map(played).collect::<Result<_, _>>()?;
    let FrameTimesRequest { size, frames, rationed, fastest, .. } = *request;
    let bench = Bench { gpu: Gpu::headless()?, surroundings: &surroundings(), config, size, frames, rationed, fastest };
    let [width, height] = size;
    say(format_args!("{}, {width}x{height}, {frames} frames", bench.gpu.adapter.name));
    let mut sheet = Sheet::measured(&COLUMNS, &bench.gpu.adapter_name());
    sheet.notes.push(("size".into(), format!("{width}x{height}")));
    for (name, (scene, moment)) in request.scenes.iter().zip(scenes) {
        let times = bench.time(name, &scene, moment)?;
        say(&times);
        times.write(&mut sheet);
    }
    let mut paths = vec![request.output.join("frame.csv")];
    if request.flight > 0 {
        let scene = scene::load(CHASE)?;
        let times = bench.fly(CHASE, &scene, steps_of(&scene, config), request.flight)?;
        say(&times);
        times.write(&mut sheet);
        let mut flight = Sheet::new(&["time", "frame_ms", "without_bodies_and_aurora_ms"]);
        flight.notes.clone_from(&sheet.notes);
        for ((time, whole), alone) in times.moments.iter().zip(times.parts.frames()).zip(&times.alone) {
            flight.line(format_args!("{time:.5}|{whole:.3}|{alone:.3}"));
        }
        paths.push(request.output.join("frame-flight.csv"));
        flight.save(&paths[1])?;
    }
    sheet.save(&paths[0])?;
    Ok(paths)
}

/// Steps of the clock until the chase is decided, its camera sees nothing any more, or T = [`END`].
fn steps_of(scene: &Scene, config: &GameConfig) -> u64 {
    let mut moment = Moment::new(scene, config, 0.0, 0);
    let mut steps = 0;
    while moment.time() < END && !moment.is_decided() && scene.camera.check(moment.time(), &moment.ships()).is_ok() {
        moment.advance(1);
        steps += 1;
    }
    steps
}
