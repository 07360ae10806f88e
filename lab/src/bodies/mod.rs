//! How the time of a frame and the memory grow with the number of bodies, held ones and flying ones: `lensrunner-lab chart bodies`.
//!
//! [`scenes`] makes the scenes, [`sheet`] has the columns of what is measured, [`growth`] fits it.

mod draw;
pub mod growth;
pub mod scenes;
pub mod sheet;

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::render::Gpu;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::shot::surroundings;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::Moment;

use crate::chart::{ChartError, Output, Sheet};
use crate::frame_times::FrameTimes;
use crate::frame_times::bench::Bench;
use crate::frame_times::parts::{PASS, PROCESSOR};
use crate::say::say;
use scenes::Kind;
use sheet::{COLUMNS, MISSING, ORDERS};

/// How the time of a frame grows with the bodies in it: held balls and flying ships, the processor's work and the passes apart.
#[derive(Args, Clone, Debug)]
pub struct BodiesRequest {
    /// Where the chart goes.
    #[command(flatten)]
    pub output: Output,
    /// Numbers of held balls.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "10,30,100,300,1000,3000,10000,30000,100000")]
    #[arg(value_parser = whole::<u32>(1, 200_000))]
    pub held: Vec<u32>,
    /// Numbers of flying ships.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,3,10,30,100,300,1000", value_parser = whole::<u32>(1, 1_000))]
    pub flying: Vec<u32>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = scene::picture_size)]
    pub size: [u32; 2],
    /// Frames of each number of bodies.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole::<u32>(1, 10_000))]
    pub frames: u32,
    /// Seconds. Once a number of bodies takes longer, greater ones are left out.
    #[arg(long, value_name = "S", default_value_t = 60, value_parser = whole::<u32>(1, 100_000))]
    pub bound: u32,
}

/// Measures (or reads) `bodies.csv`, fits `bodies-growth.csv`, draws `bodies.svg` and `bodies.png`; returns the files.
pub fn run(request: &BodiesRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.growing_sheet::<ChartError>("bodies", |so_far| measure(request, so_far))?;
    let growth = growth::sheet(&sheet);
    let mut files = ["bodies", "bodies-growth"].map(|name| request.output.csv(name)).to_vec();
    growth.save(&files[1])?;
    files.extend(draw::figure(&sheet, &growth).save(&request.output.folder, "bodies")?);
    Ok(files)
}

/// Measures one number of bodies after the other, and writes what there is after each.
fn measure(request: &BodiesRequest, so_far: &dyn Fn(&Sheet) -> Result<(), crate::chart::SheetError>) -> Result<Sheet, ChartError> {
    let config = &scene::config::find(None)?;
    let surroundings = surroundings();
    let [width, height] = request.size;
    let mut sheet = Sheet::measured(&COLUMNS, &Gpu::headless()?.adapter_name());
    sheet.notes.push(("size".into(), format!("{width}x{height}")));
    sheet.notes.push((ORDERS.into(), config.render.orders.to_string()));
    for (kind, numbers) in [(Kind::Held, &request.held), (Kind::Flying, &request.flying)] {
        let mut numbers = numbers.clone();
        numbers.sort_unstable();
        let mut stopped: Option<String> = None;
        for bodies in numbers {
            let begin = Instant::now();
            let measured = match &stopped {
                Some(reason) => Err(reason.clone()),
                None => time(request, config, &surroundings, kind, bodies),
            };
            let seconds = begin.elapsed().as_secs_f64();
            match measured {
                Ok(times) => {
                    say(told(kind, bodies, &times));
                    sheet::write(&mut sheet, kind, bodies, &times);
                    if seconds > f64::from(request.bound) {
                        stopped = Some(format!("left out: {bodies} took {seconds:.0} s"));
                    }
                }
                Err(reason) => {
                    say(format_args!("{bodies} {kind}: {reason}"));
                    let words = reason.replace('|', "/").split_whitespace().collect::<Vec<_>>().join(" ");
                    sheet.line(format_args!("{kind}|{bodies}|{MISSING}|{words}||||"));
                    stopped.get_or_insert(format!("left out: {bodies} were not drawn"));
                }
            }
            so_far(&sheet)?;
        }
    }
    Ok(sheet)
}

/// Draws so many bodies, on a device of their own: its memory is theirs, and what goes wrong with it stays there.
fn time(request: &BodiesRequest, config: &GameConfig, surroundings: &Surroundings, kind: Kind, bodies: u32) -> Result<FrameTimes, String> {
    let gpu = Gpu::headless().map_err(|error| error.to_string())?;
    let scene = kind.scene(bodies).map_err(|error| error.to_string())?;
    let moment = Moment::new(&scene, config, 0.0, 0);
    let BodiesRequest { size, frames, .. } = *request;
    let bench = Bench { gpu, surroundings, config, size, frames, rationed: false, fastest: false };
    bench.time(kind.name(), &scene, moment).map_err(|error| error.to_string())
}

/// A line for a person who waits.
fn told(kind: Kind, bodies: u32, times: &FrameTimes) -> String {
    let [whole, processor, passes] = [times.parts.whole(), times.parts.together(PROCESSOR), times.parts.together(PASS)];
    let memory = times.memory.as_ref().map_or(String::new(), |memory| {
        let [all, largest] = [memory.all, memory.largest].map(|bytes| bytes as f64 / 1_048_576.0);
        format!(", {all:.0} MiB ({} {largest:.1})", memory.label)
    });
    let [whole, processor, passes] = [whole, processor, passes].map(|spread| spread.median);
    format!("{bodies} {kind}: frame {whole:.2} ms, processor {processor:.2}, passes {passes:.2}{memory}")
}
