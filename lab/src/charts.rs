//! The charts of the command line, and their exit codes.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Subcommand};
use lensrunner::argument::whole;
use lensrunner_lab::chart::{ChartError, Output, announce};
use lensrunner_lab::projection::race::Race;
use lensrunner_lab::{
    aurora, bodies, bvh, dial, disk, drivers, flight, frame_times, hands_frames, hud_cost, motion, overlay_cost, projection, quarry, soak,
    steps, tessellation, thin_disk, window_rates,
};

use crate::fail;

/// Measures and draws a chart of error against time: CSV, SVG and PNG.
#[derive(Subcommand)]
pub enum ChartCommand {
    Projection(projection::ProjectionRequest),
    Trace(thin_disk::ThinDiskRequest),
    Aurora(AuroraArgs),
    Bvh(bvh::BvhRequest),
    Bodies(bodies::BodiesRequest),
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
    Hud(hud_cost::HudRequest),
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

/// Runs one of them, and says what was written, or what went wrong.
pub fn run(chart: ChartCommand) -> ExitCode {
    finish(match &chart {
        ChartCommand::Projection(request) => {
            let mut race = if request.output.redraw { None } else { Race::on_best_adapter() };
            projection::run(request, race.as_mut())
        }
        ChartCommand::Trace(request) => thin_disk::run(request),
        ChartCommand::Aurora(args) => run_aurora(args),
        ChartCommand::Bvh(request) => bvh::run(request),
        ChartCommand::Bodies(request) => bodies::run(request),
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
        ChartCommand::Hud(request) => hud_cost::run(request),
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
