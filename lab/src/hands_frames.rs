//! Whether any frame stands still, or shows what has no numbers, while hands throw the ship about: missions at several paces, a frame each
//! 1/30 s of wall time: `lensrunner-lab chart hands`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use glam::DQuat;
use lensrunner::argument::whole;
use lensrunner::play::camera::{CameraView, on_ship, state_of};
use lensrunner::render::Gpu;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::mission::Difficulty;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::{History, Moment};

use crate::chart::{ChartError, Output, Sheet, quantile};
use crate::compare::flight::eye::own_ship;
use crate::compare::flight::hands::PACES;
use crate::offscreen::Offscreen;
use crate::say::say;

/// Whether any frame stands still while hands throw the ship about, at five paces from 0.05 to 3: a table.
#[derive(Args, Clone, Debug)]
pub struct HandsRequest {
    /// Where the sheet goes.
    #[command(flatten)]
    pub output: Output,
    /// Scenes or missions.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    #[arg(default_value = "02-first-pursuit,04-the-ghost,06-the-long-shot,09-two-of-them")]
    pub scenes: Vec<String>,
    /// Frames of all flights together.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = whole::<usize>(1, 10_000_000))]
    pub frames: usize,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = scene::picture_size)]
    pub size: [u32; 2],
}

/// Columns of the sheet: times of a frame; the longest over the median, with its T; the most vertices and pieces of a frame over their
/// medians; results without numbers, and images drawn more slowly than they move, in all frames.
pub const COLUMNS: [&str; 11] =
    ["scene", "pace", "frames", "median_ms", "longest_ms", "ratio", "T", "vertices_ratio", "coarse", "not_finite", "calmed"];

/// Wall time between two frames, in seconds.
const FRAME: f64 = 1.0 / 30.0;
/// T at which the frames of a flight begin, in r_s/c: the light of what the hands did has come by then.
const FROM: f64 = 2.5;
/// Frames before the first that is timed: what is compiled and allocated is by then.
const WARMING: usize = 3;
/// Frames until the camera is another one.
const LOOKS: usize = 40;

/// Draws, writes `hands.csv` and says what came out.
pub fn run(request: &HandsRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.sheet("hands", || measure(request))?;
    let worst = sheet.rows.iter().map(|row| sheet.number(row, "ratio")).fold(0.0, f64::max);
    let failed: f64 = sheet.rows.iter().map(|row| sheet.number(row, "not_finite")).sum();
    say(format_args!("The longest frame takes {worst:.2} times the median of its flight; {failed} results have no numbers."));
    Ok(vec![request.output.csv("hands")])
}

fn measure(request: &HandsRequest) -> Result<Sheet, ChartError> {
    let gpu = Gpu::headless()?;
    let mut sheet = Sheet::measured(&COLUMNS, &gpu.adapter_name());
    let flights = request.scenes.len() * PACES.len();
    for name in &request.scenes {
        for (seed, pace) in PACES.into_iter().enumerate() {
            let row = fly(&gpu, name, pace, seed as u64, request.frames.div_ceil(flights), request.size)?;
            say(row.replace('|', "  "));
            sheet.line(row);
        }
    }
    Ok(sheet)
}

/// A frame that was drawn.
struct Drawn {
    time: f64,
    milliseconds: f64,
    vertices: f64,
}

/// The row of one flight; where it is decided, the next begins.
fn fly(gpu: &Gpu, name: &str, pace: f64, seed: u64, frames: usize, size: [u32; 2]) -> Result<String, ChartError> {
    let scene = scene::load(name)?;
    let mut config = GameConfig::default();
    config.clock.pace = pace;
    let config = scene.config(&config, Difficulty::Easy);
    let mut offscreen = Offscreen::new(gpu, size);
    let mut stage = Stage::new(&mut offscreen.renderer, &scene, &config).watched();
    let own = own_ship(&scene);
    let mut drawn: Vec<Drawn> = Vec::new();
    let (mut coarse, mut not_finite, mut calmed, mut done) = (0, 0, 0, 0);
    for flight in 0.. {
        let mut moment = Moment::with_pilot(&scene, &config, 5 * flight + seed, PilotKind::Hands);
        let mut time = FROM;
        while done < frames + WARMING {
            while moment.time() < time + config.clock.step && !moment.is_decided() {
                moment.advance(1);
            }
            if moment.is_decided() {
                break;
            }
            let nobody = History::nobody();
            let histories: Vec<&History> = moment.histories().into_iter().chain([&nobody]).chain(moment.bolts()).collect();
            let state = state_of(&histories[own].at(time));
            let around = DQuat::from_rotation_y(0.05 * done as f64) * DQuat::from_rotation_x(0.4);
            let (kind, attitude) = match done / LOOKS % 3 {
                0 => (CameraView::ThirdPerson, state.attitude),
                1 => (CameraView::Cockpit, state.attitude),
                _ => (CameraView::ThirdPerson, state.attitude * around),
            };
            let camera = on_ship(&state, kind, attitude, config.ship.size, config.video.fov.to_radians());
            let hidden = (kind == CameraView::Cockpit).then_some(own);
            let wanted = Settings { own_ship: Some(own), ..settings(&config) };
            let began = Instant::now();
            offscreen.draw(&stage.frame(camera, size, time, &histories, hidden, &wanted))?;
            let milliseconds = began.elapsed().as_secs_f64() * 1e3;
            let counters = offscreen.renderer.counters()?;
            done += 1;
            if done > WARMING {
                drawn.push(Drawn { time, milliseconds, vertices: f64::from(counters.vertices + counters.split) });
                coarse += counters.coarse;
                not_finite += counters.caught;
                calmed += counters.calmed;
            }
            time += pace * FRAME;
        }
        if done >= frames + WARMING {
            break;
        }
    }
    let longest = drawn.iter().max_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
    let (longest, at) = longest.map_or((f64::NAN, f64::NAN), |frame| (frame.milliseconds, frame.time));
    let median = quantile(drawn.iter().map(|frame| frame.milliseconds), 0.5);
    let vertices = || drawn.iter().map(|frame| frame.vertices);
    let vertices = vertices().fold(0.0, f64::max) / quantile(vertices(), 0.5);
    let (count, ratio) = (drawn.len(), longest / median);
    Ok(format!("{name}|{pace}|{count}|{median:.2}|{longest:.2}|{ratio:.2}|{at:.4}|{vertices:.2}|{coarse}|{not_finite}|{calmed}"))
}
