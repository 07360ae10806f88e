//! Frame rates in a window: the chase as it is played, by the levels of its picture, beside an empty window of the same engine:
//! `lensrunner-lab chart window`.
//!
//! - [`empty`]: the empty window, in a process of its own.
//! - [`mod@rates`]: frame rates from the times of frames.
//! - [`sides`]: what the most used rung looks like beside the finest.

pub mod empty;
pub mod rates;
pub mod sides;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::render::Gpu;
use lensrunner::scene::picture_size;

use crate::chart::{ChartError, DEFAULT_FOLDER, Sheet};
use crate::say::say;
use rates::{Rates, rates};

/// The scene that is played.
pub const SCENE: &str = "chase";
/// Seed of its pilots.
const SEED: u64 = 5;
/// What is shown first is not judged, in s: memory and clocks settle.
const SETTLED: f64 = 2.0;
/// Columns of the sheet.
pub const COLUMNS: [&str; 9] =
    ["size", "what", "round", "frames", "frames/s", "least over half a second", "share of the empty window's", "its share", "rung"];

/// Frame rates of the chase in a window, beside an empty window of the same engine; needs a display.
#[derive(Args, Clone, Debug)]
pub struct WindowRequest {
    /// The folder for what is written.
    #[arg(short, value_name = "DIR", default_value = DEFAULT_FOLDER)]
    pub output: PathBuf,
    /// Widths and heights in pixels.
    #[arg(long = "size", value_name = "WxH,…", value_delimiter = ',', default_value = "1280x720,1920x1080", value_parser = picture_size)]
    pub sizes: Vec<[u32; 2]>,
    /// Frames of each run.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = whole::<u32>(50, 100_000))]
    pub frames: u32,
    /// How often all runs take turns.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = whole::<u32>(1, 100))]
    pub rounds: u32,
}

/// What is run in turn: its name, and the setting of the game; None: the empty window.
const RUNS: [(&str, Option<&str>); 4] =
    [("empty window", None), ("automatic", Some("automatic")), ("high", Some("high")), ("empty window", None)];

const NO_DISPLAY: &str =
    "there is no display to open a window on: start it under a display, for instance xvfb-run -s '-screen 0 1920x1080x24'";

/// Measures, writes `window.csv` and the pictures of the rung that is used most, and says what came out.
pub fn run(request: &WindowRequest) -> Result<Vec<PathBuf>, ChartError> {
    if std::env::var_os("DISPLAY").is_none_or(|display| display.is_empty()) {
        return Err(ChartError::Failed(NO_DISPLAY.into()));
    }
    let here = std::env::current_exe().map_err(|error| ChartError::Program("this program".into(), error.to_string()))?;
    let game = here.with_file_name(format!("lensrunner{}", std::env::consts::EXE_SUFFIX));
    let mut sheet = Sheet::measured(&COLUMNS, &Gpu::headless()?.adapter_name());
    let mut paths = Vec::new();
    for size in &request.sizes {
        let mut used = Vec::new();
        for round in 1..=request.rounds {
            let mut taken = Vec::new();
            for (what, quality) in RUNS {
                let table = request.output.join("window-times.csv");
                let rows = match quality {
                    None => play(&here, "empty-window", *size, request.frames, &table)?,
                    Some(quality) => {
                        // Without a window manager a window may have no focus.
                        let set = format!("--set video.quality={quality} --set video.pause_without_focus=false");
                        let command = format!("play --scene {SCENE} --seed {SEED} --at-once --autopilot {set}");
                        play(&game, &command, *size, request.frames, &table)?
                    }
                };
                let rates = rates(&rows, SETTLED).ok_or_else(|| too_few(&table))?;
                if quality == Some("automatic") {
                    used.push(rates.clone());
                }
                taken.push((what, rates));
                _ = std::fs::remove_file(table);
            }
            let empty = 0.5 * (taken[0].1.mean + taken[RUNS.len() - 1].1.mean);
            for (what, rates) in taken {
                say(write_row(&mut sheet, *size, what, round, &rates, empty));
            }
            sheet.save(&request.output.join("window.csv"))?;
        }
        if let Some(rates) = used.last() {
            paths.push(sides::draw(rates.rung, *size, SEED, &request.output)?);
        }
    }
    paths.insert(0, request.output.join("window.csv"));
    Ok(paths)
}

fn write_row(sheet: &mut Sheet, [width, height]: [u32; 2], what: &str, round: u32, rates: &Rates, empty: f64) -> String {
    let Rates { frames, mean, least, rung } = rates;
    let (share, worst) = (mean / empty, least / empty);
    sheet.line(format_args!("{width}x{height}|{what}|{round}|{frames}|{mean:.2}|{least:.2}|{share:.3}|{worst:.3}|{rung}"));
    format!(
        "{width}x{height}, {what}: {mean:.1} frames/s, {share:.2} of the empty window; least over half a second {least:.1}, {worst:.2}; rung {rung}"
    )
}

/// Runs a program that writes its times to `table`.
fn play(program: &Path, command: &str, [width, height]: [u32; 2], frames: u32, table: &Path) -> Result<Vec<rates::Row>, ChartError> {
    if let Some(folder) = table.parent() {
        std::fs::create_dir_all(folder).map_err(|error| ChartError::Write(folder.into(), error.to_string()))?;
    }
    let failed = |reason: String| ChartError::Program(program.display().to_string(), reason);
    let command = format!("{command} --size {width}x{height} --frames {frames} --timings");
    let ran = Command::new(program).args(command.split(' ')).arg(table).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let status = ran.map_err(|error| failed(error.to_string()))?;
    if !status.success() {
        return Err(failed(format!("ended with {status}")));
    }
    rates::read(&Sheet::load(table)?).ok_or_else(|| too_few(table))
}

fn too_few(table: &Path) -> ChartError {
    ChartError::Failed(format!("{}: too few frames in play to tell a rate", table.display()))
}
