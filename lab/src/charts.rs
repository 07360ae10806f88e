//! The charts of the command line, and their exit codes.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Subcommand};
use lensrunner::argument::whole;
use lensrunner_lab::chart::{ChartError, Output, announce};
use lensrunner_lab::projection::race::Race;
use lensrunner_lab::{
    aurora, bvh, dial, disk, drivers, flight, frame_times, hands_frames, motion, overlay_cost, projection, quarry, soak, steps,
    tessellation, thin_disk, window_rates,
};

use crate::fail;

/// Measures and draws a chart of error against time: CSV, SVG and PNG.
#[derive(Subcommand)]
pub enum ChartCommand {
    Projection(projection::ProjectionRequest),
    Trace(thin_disk::ThinDiskRequest),
    Aurora(AuroraArgs),
    Bvh(BvhArgs),
    Frame(frame_times::FrameTimesRequest),
    Dial(dial::DialRequest),
    Disk(disk::request::DiskRequest),
    Drivers(drivers::DriversRequest),
    Flight(flight::FlightRequest),
    Tessellation(tessellation::TessellationRequest),
    Quarry(quarry::QuarryRequest),
    Soak(soak::SoakRequest),
    Hands(hands_frames::HandsRequest),
    Motion(motion::MotionRequest),
    Steps(steps::StepsRequest),
    Overlay(overlay_cost::OverlayRequest),
    Window(window_rates::WindowRequest),
}

/// The experiment of Sekiguchi et al.: auroras by the particle method and by screen walks, time against error, from four views.
#[derive(Args)]
pub struct AuroraArgs {
    #[command(flatten)]
    output: Output,
    /// How many of the ten auroras.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = whole::<u8>(1, 10))]
    auroras: u8,
    /// Numbers of electrons.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1000,4000,16000")]
    #[arg(value_parser = whole::<u32>(1, 1_000_000))]
    electrons: Vec<u32>,
    /// Standard deviations of a point's light in km, 0.1 to 50.
    #[arg(long, value_name = "KM,…", value_delimiter = ',', default_value = "1,2,4", value_parser = aurora::chart::radius)]
    radii: Vec<f32>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = aurora::chart::size)]
    size: [usize; 2],
    /// Runs of which the median is taken.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole::<u8>(1, 100))]
    repeats: u8,
}

/// Tracers of straight rays on one thread: ours, those of Sei 2008, the crates obvhs and bvh, and Embree in a build with the feature
/// embree.
#[derive(Args)]
pub struct BvhArgs {
    #[command(flatten)]
    output: Output,
    /// Scenes: balls4A, balls4B, balls4C, tree10, castle, bunny; and needles, 200,000 long ones, which trees of boxes hold badly.
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "bunny,castle,tree10,balls4A,balls4B,balls4C")]
    scenes: Vec<String>,
    /// How often each method runs; the median counts.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole::<u8>(1, 255))]
    rounds: u8,
    /// The Stanford bunny, binary PLY of triangles; without it a blob of as many triangles takes its place.
    #[arg(long, value_name = "FILE.ply", default_value = "../shared/data/bunny.ply")]
    bunny: PathBuf,
    /// Compares hits instead of timing: all methods with each other, 2,000 rays and every dispute with brute force in f64.
    #[arg(long)]
    check: bool,
}

/// Runs one of them, and says what was written, or what went wrong.
pub fn run(chart: ChartCommand) -> ExitCode {
    finish(match &chart {
        ChartCommand::Projection(request) => {
            let mut race = if request.output.redraw { None } else { Race::on_best_adapter() };
            projection::run(request, race.as_mut())
        }
        ChartCommand::Trace(request) => thin_disk::run(request),
        ChartCommand::Aurora(args) => run_aurora(args),
        ChartCommand::Bvh(args) => run_bvh(args),
        ChartCommand::Frame(request) => frame_times::run(request),
        ChartCommand::Dial(request) => dial::run(request),
        ChartCommand::Disk(request) => disk::chart::run(request),
        ChartCommand::Drivers(request) => drivers::run(request),
        ChartCommand::Flight(request) => flight::run(request),
        ChartCommand::Tessellation(request) => tessellation::run(request),
        ChartCommand::Quarry(request) => quarry::run(request),
        ChartCommand::Soak(request) => soak::run(request),
        ChartCommand::Hands(request) => hands_frames::run(request),
        ChartCommand::Motion(request) => motion::run(request),
        ChartCommand::Steps(request) => steps::run(request),
        ChartCommand::Overlay(request) => overlay_cost::run(request),
        ChartCommand::Window(request) => window_rates::run(request),
    })
}

/// Says what was written, or what went wrong.
pub fn finish(done: Result<Vec<PathBuf>, ChartError>) -> ExitCode {
    match done {
        Ok(paths) => {
            announce(&paths);
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
    }
}

fn run_aurora(args: &AuroraArgs) -> Result<Vec<PathBuf>, ChartError> {
    let experiment = aurora::experiment::ExperimentRequest {
        auroras: usize::from(args.auroras),
        counts: args.electrons.clone(),
        radii: args.radii.clone(),
        size: args.size,
        repeats: usize::from(args.repeats),
    };
    aurora::chart::run(&args.output, &experiment).map_err(|error| ChartError::Failed(error.to_string()))
}

fn run_bvh(args: &BvhArgs) -> Result<Vec<PathBuf>, ChartError> {
    let request = bvh::BvhRequest {
        output: args.output.clone(),
        scenes: args.scenes.clone(),
        size: [1024, 768],
        rounds: args.rounds.into(),
        bunny: args.bunny.clone(),
        check: args.check,
    };
    bvh::run(&request)
        .map_err(|error| if error.is_input() { ChartError::Input(error.to_string()) } else { ChartError::Failed(error.to_string()) })
}
