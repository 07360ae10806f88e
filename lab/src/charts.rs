//! The charts of the command line: what they are asked for, and their exit codes.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Subcommand};
use lensrunner::argument::{number, whole};
use lensrunner::render::quality::prices::Prices;
use lensrunner::scene;
use lensrunner_lab::dial::{self, DialRequest};
use lensrunner_lab::projection::ChartError;
use lensrunner_lab::projection::race::Race;
use lensrunner_lab::{
    aurora, aurora_race, bvh, chart, drivers, flight, frame_times, hands_frames, motion, projection, soak, tessellation, thin_disk,
    window_rates,
};

use crate::fail;

/// Measures and draws a chart of error against time: CSV, SVG and PNG.
#[derive(Subcommand)]
pub enum ChartCommand {
    Projection(ChartProjectionArgs),
    Trace(ChartTraceArgs),
    Aurora(ChartAuroraArgs),
    Bvh(ChartBvhArgs),
    Frame(ChartFrameArgs),
    Dial(ChartDialArgs),
    Disk(ChartDiskArgs),
    Drivers(ChartDriversArgs),
    Flight(ChartFlightArgs),
    Tessellation(ChartTessellationArgs),
    Quarry(ChartQuarryArgs),
    Soak(ChartSoakArgs),
    Hands(ChartHandsArgs),
    Motion(ChartMotionArgs),
    Steps(ChartStepsArgs),
    Overlay(ChartOverlayArgs),
    Window(ChartWindowArgs),
}

/// Integrators of matter: error in energy, angular momentum and phase against cost on five flights, and the step at which each fails.
#[derive(Args)]
pub struct ChartFlightArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// How often each flight is timed; the median counts.
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true, value_parser = whole::<u8>(1, 255))]
    rounds: u8,
    /// The most evaluations of the equations of motion in a flight; what takes more is left out.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, allow_negative_numbers = true, value_parser = whole::<u64>(1_000, u64::MAX))]
    evaluations: u64,
}

/// Ways to divide triangles: displacement of surface points on the picture against vertices and time.
#[derive(Args)]
pub struct ChartTessellationArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "ring,parade,galaxy")]
    scene: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Bounds in pixels; 0.5, the game's own, is what the others are told against.
    #[arg(long, value_name = "PX,…", value_delimiter = ',', default_value = "0.125,0.25,0.5,1,2,4,8")]
    bounds: Vec<f64>,
    /// Rounds of timing in which all ways take turns; the median counts.
    #[arg(long, value_name = "N", default_value_t = 9, allow_negative_numbers = true, value_parser = whole::<u8>(1, 255))]
    rounds: u8,
}

/// Where a chart goes.
#[derive(Args)]
pub struct ChartArgs {
    /// The folder for CSV, SVG and PNG.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
    /// Draws again from the CSV in that folder, without measuring.
    #[arg(long)]
    redraw: bool,
}

impl From<ChartArgs> for chart::Output {
    fn from(args: ChartArgs) -> Self {
        Self { folder: args.output, redraw: args.redraw }
    }
}

/// How long the quarry lasts, flown by the game's pilot, straight away, and at random, before the same hunter: a table.
#[derive(Args)]
pub struct ChartQuarryArgs {
    /// A scene or mission whose first ship hunts the second.
    #[arg(long, value_name = "NAME|FILE", default_value = "02-first-pursuit")]
    scene: String,
    /// Chases of each kind.
    #[arg(long, value_name = "N", default_value_t = 100, allow_negative_numbers = true, value_parser = whole::<u64>(1, 1_000_000))]
    seeds: u64,
    /// T at which a chase ends undecided, in r_s/c.
    #[arg(long, value_name = "T", default_value_t = 270.0, value_parser = number)]
    limit: f64,
}

/// What each knob of the picture's quality costs and saves: the price list that the game reads (quality.csv); with --check whether the
/// predictions from the game's own list hold, and the chart.
#[derive(Args)]
pub struct ChartDialArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Moments of each class of scenes; with --check moments in all.
    #[arg(long, value_name = "N", default_value_t = 8, allow_negative_numbers = true, value_parser = whole::<u32>(1, 100_000))]
    moments: u32,
    /// Seed of the moments; with --check another each time unless it is given.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    seed: Option<u64>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Compares predictions with measurements, at moments and rungs at random.
    #[arg(long)]
    check: bool,
    /// Measures the levels high, medium, low and the fastest beside everything at its finest, at moments of the chase and three scenes.
    #[arg(long, conflicts_with = "check")]
    levels: bool,
    /// Compares each frame of four scenes with the one before, with the rungs that a governor goes through and without; --moments frames.
    #[arg(long, conflicts_with_all = ["check", "levels"])]
    moving: bool,
}

/// The same scenes by two Vulkan drivers: how many pixels differ, and a picture of those that differ most.
#[derive(Args)]
pub struct ChartDriversArgs {
    /// The manifest of the second driver, or a folder with its pictures of the scenes, NAME.png, drawn by `lensrunner shot` on another
    /// machine; the table is then named after the folder.
    #[arg(long, value_name = "FILE.json|DIR")]
    driver: PathBuf,
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(
        long,
        value_name = "NAME|FILE",
        value_delimiter = ',',
        default_value = "ring,parade,galaxy-axis-vertex,disk,disk-inner,disk-80,chase,plunge,aurora-orbit,aurora-below,aurora-lensed,02-first-pursuit"
    )]
    scene: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// The folder for the table and the picture.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
}

/// Whether memory grows over a long flight and many frames: a table.
#[derive(Args)]
pub struct ChartSoakArgs {
    /// Steps of the simulation.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, allow_negative_numbers = true, value_parser = whole::<u64>(10, 100_000_000))]
    steps: u64,
    /// Frames.
    #[arg(long, value_name = "N", default_value_t = 10_000, allow_negative_numbers = true, value_parser = whole::<u64>(10, 10_000_000))]
    frames: u64,
    /// The folder for the table.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
}

/// Whether any frame stands still while hands throw the ship about, at five paces from 0.05 to 3: a table.
#[derive(Args)]
pub struct ChartHandsArgs {
    /// Scenes or missions.
    #[arg(
        long,
        value_name = "NAME,…",
        value_delimiter = ',',
        default_value = "02-first-pursuit,04-the-ghost,06-the-long-shot,09-two-of-them"
    )]
    scenes: Vec<String>,
    /// Frames of all flights together.
    #[arg(long, value_name = "N", default_value_t = 20_000, allow_negative_numbers = true, value_parser = whole::<usize>(1, 10_000_000))]
    frames: usize,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// The folder for the table.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
}

/// How the motion of a near body is told to the graphics card, smooth or by nodes: error against cost, while hands fly.
#[derive(Args)]
pub struct ChartMotionArgs {
    /// Moments at each pace.
    #[arg(long, value_name = "N", default_value_t = 200, allow_negative_numbers = true, value_parser = whole::<usize>(1, 100_000))]
    moments: usize,
    /// Draws again from the CSV, without measuring.
    #[arg(long)]
    redraw: bool,
    /// The folder for the chart.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
}

/// What the dev overlay costs the processor in a frame, page by page, beside a frame without it: a table.
#[derive(Args)]
pub struct ChartOverlayArgs {
    /// Frames of each page.
    #[arg(long, value_name = "N", default_value_t = 2000, allow_negative_numbers = true, value_parser = whole::<u32>(10, 1_000_000))]
    frames: u32,
}

/// Frame rates of the chase in a window, beside an empty window of the same engine; needs a display.
#[derive(Args)]
pub struct ChartWindowArgs {
    /// The folder for the table and the pictures.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
    /// Widths and heights in pixels.
    #[arg(long, value_name = "WxH,…", value_delimiter = ',', default_value = "1280x720,1920x1080", value_parser = lensrunner::render::shot::size)]
    size: Vec<[u32; 2]>,
    /// Frames of each run.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = whole::<u32>(50, 100_000))]
    frames: u32,
    /// How often all runs take turns.
    #[arg(long, value_name = "N", default_value_t = 2, allow_negative_numbers = true, value_parser = whole::<u32>(1, 100))]
    rounds: u32,
}

/// The empty window that `chart window` opens.
#[derive(Args)]
pub struct EmptyWindowArgs {
    #[arg(long, value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    #[arg(long, allow_negative_numbers = true, value_parser = whole::<u32>(0, u32::MAX.into()))]
    frames: u32,
    #[arg(long)]
    timings: PathBuf,
}

/// Opens it.
pub fn show_empty_window(args: &EmptyWindowArgs) -> ExitCode {
    match window_rates::empty::show(args.size, args.frames, &args.timings) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

/// What a step of the simulation costs, by the number of ships: a table.
#[derive(Args)]
pub struct ChartStepsArgs {
    /// Steps of two ships in each of five runs; with more ships fewer.
    #[arg(long, value_name = "N", default_value_t = 40_000, allow_negative_numbers = true, value_parser = whole::<u64>(1, 100_000_000))]
    steps: u64,
}

/// Every method of projection on the same adversarial points: error against time per lookup and against memory.
#[derive(Args)]
pub struct ChartProjectionArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Adversarial points for each method and image order; about a tenth of them has no ray.
    #[arg(long, value_name = "N", default_value_t = 340_000)]
    #[arg(allow_negative_numbers = true, value_parser = whole::<usize>(1, 1_000_000_000))]
    points: usize,
    /// Seed of the points.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    seed: u64,
    /// Only these methods, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    methods: Vec<String>,
}

/// The experiment of Sekiguchi et al.: auroras by the particle method and by screen walks, time against error, from four views.
#[derive(Args)]
pub struct ChartAuroraArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// How many of the ten auroras.
    #[arg(long, value_name = "N", default_value_t = 10, allow_negative_numbers = true, value_parser = whole::<u8>(1, 10))]
    auroras: u8,
    /// Numbers of electrons.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1000,4000,16000")]
    #[arg(allow_negative_numbers = true, value_parser = whole::<u32>(1, 1_000_000))]
    electrons: Vec<u32>,
    /// Standard deviations of a point's light in km, 0.1 to 50.
    #[arg(long, value_name = "KM,…", value_delimiter = ',', default_value = "1,2,4", value_parser = aurora::chart::radius)]
    radii: Vec<f32>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = aurora::chart::size)]
    size: [usize; 2],
    /// Runs of which the median is taken.
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true, value_parser = whole::<u8>(1, 100))]
    repeats: u8,
}

/// A thin disk after Page and Thorne: error against rays per second, by the judge and by Gyoto where that is installed.
#[derive(Args)]
pub struct ChartTraceArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Pixels along each side of the picture.
    #[arg(long, value_name = "N", default_value_t = 64, allow_negative_numbers = true, value_parser = whole::<u32>(8, 1024))]
    pixels: u32,
}

/// Tracers of straight rays on one thread: ours, those of Sei 2008, the crates obvhs and bvh, and Embree in a build with the feature
/// embree.
#[derive(Args)]
pub struct ChartBvhArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Scenes: balls4A, balls4B, balls4C, tree10, castle, bunny; and needles, 200,000 long ones, which trees of boxes hold badly.
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "bunny,castle,tree10,balls4A,balls4B,balls4C")]
    scenes: Vec<String>,
    /// How often each method runs; the median counts.
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true, value_parser = whole::<u8>(1, 255))]
    rounds: u8,
    /// The Stanford bunny, binary PLY of triangles; without it a blob of as many triangles takes its place.
    #[arg(long, value_name = "FILE.ply", default_value = "../shared/data/bunny.ply")]
    bunny: PathBuf,
    /// Compares hits instead of timing: all methods with each other, 2,000 rays and every dispute with brute force in f64.
    #[arg(long)]
    check: bool,
}

/// Times whole frames of scenes and of the chase from start to end, and every part of them.
#[derive(Args)]
pub struct ChartFrameArgs {
    /// The folder for the CSVs.
    #[arg(short, value_name = "DIR", default_value = chart::DEFAULT_FOLDER)]
    output: PathBuf,
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "ring,galaxy,parade,disk,chase,aurora-orbit")]
    #[arg(long_help = scene::help("TOML files, or names in assets/scenes."))]
    scene: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Hold the aurora to its share of a frame, as in the window.
    #[arg(long)]
    rationed: bool,
    /// Frames of each scene.
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = whole::<u32>(1, 10_000))]
    frames: u32,
    /// The time T, in r_s/c, rounded to a step of the simulation (clock.step in game.toml: 0.03125, 1/32, unless changed).
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = number)]
    at: f64,
    /// Frames of the scene `chase`, flown by its pilots from start to end. 0 for none.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u32>(0, 100_000))]
    flight: u32,
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
}

/// The accretion disk as polygons, sprites and arcs: time and error of each alone, and along a scripted chase.
#[derive(Args)]
pub struct ChartDiskArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Width and height of the frames that are timed.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Width and height of the pictures that are compared with the exact one.
    #[arg(long, value_name = "WxH", default_value = "480x270", value_parser = lensrunner::render::shot::size)]
    error_size: [u32; 2],
    /// Rounds in which all ways take turns.
    #[arg(long, value_name = "N", default_value_t = 9, allow_negative_numbers = true, value_parser = whole::<u16>(1, 1000))]
    rounds: u16,
    /// Places along the chase.
    #[arg(long, value_name = "N", default_value_t = 25, allow_negative_numbers = true, value_parser = whole::<u16>(2, 1000))]
    steps: u16,
    /// Frames in which the chase is also flown as in the game: 1,000 and more tell what 99.9 % of them stay under. 0 for none.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u32>(0, 100_000))]
    flight: u32,
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
}

/// Runs one of them.
pub fn run(chart: ChartCommand) -> ExitCode {
    match chart {
        ChartCommand::Projection(args) => run_chart_projection(args),
        ChartCommand::Trace(args) => {
            finish_chart(thin_disk::run(&thin_disk::ThinDiskRequest { output: args.chart.into(), pixels: args.pixels as usize }))
        }
        ChartCommand::Aurora(args) => run_chart_aurora(args),
        ChartCommand::Bvh(args) => run_chart_bvh(args),
        ChartCommand::Frame(args) => run_chart_frame(args),
        ChartCommand::Disk(args) => run_chart_disk(args),
        ChartCommand::Flight(args) => finish_chart(flight::run(&flight::FlightRequest {
            output: args.chart.into(),
            rounds: args.rounds.into(),
            evaluations: args.evaluations,
        })),
        ChartCommand::Tessellation(args) => finish_chart(tessellation::run(&tessellation::TessellationRequest {
            output: args.chart.into(),
            scenes: args.scene,
            size: args.size,
            bounds: args.bounds,
            rounds: args.rounds.into(),
        })),
        ChartCommand::Quarry(args) => run_chart_quarry(&args),
        ChartCommand::Dial(args) => run_chart_dial(args),
        ChartCommand::Drivers(args) => {
            let output = chart::Output { folder: args.output, redraw: false };
            let request = drivers::DriversRequest { output, driver: args.driver, scenes: args.scene, size: args.size };
            match drivers::run(&request) {
                Err(error) if error.is_input() => fail(&error, 2),
                other => finish_chart(other),
            }
        }
        ChartCommand::Soak(args) => {
            let output = chart::Output { folder: args.output, redraw: false };
            finish_chart(soak::run(&soak::SoakRequest { output, steps: args.steps, frames: args.frames }, &mut io::stdout().lock()))
        }
        ChartCommand::Hands(ChartHandsArgs { scenes, frames, size, output }) => {
            let output = chart::Output { folder: output, redraw: false };
            finish_chart(hands_frames::run(&hands_frames::HandsRequest { output, scenes, frames, size }, &mut io::stdout().lock()))
        }
        ChartCommand::Motion(ChartMotionArgs { moments, redraw, output }) => {
            finish_chart(motion::run(&motion::MotionRequest { output: chart::Output { folder: output, redraw }, moments }))
        }
        ChartCommand::Overlay(args) => match lensrunner_lab::overlay_cost::run(args.frames as usize, &mut io::stdout().lock()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail(&error, 1),
        },
        ChartCommand::Window(args) => {
            let output = chart::Output { folder: args.output, redraw: false };
            let request = window_rates::WindowRequest { output, sizes: args.size, frames: args.frames, rounds: args.rounds };
            finish_chart(window_rates::run(&request, &mut io::stdout().lock()))
        }
        ChartCommand::Steps(args) => match lensrunner_lab::steps::run(args.steps, &mut io::stdout().lock()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail(&error, 1),
        },
    }
}

fn run_chart_dial(args: ChartDialArgs) -> ExitCode {
    let fresh = || std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |since| since.subsec_nanos().into());
    let seed = args.seed.unwrap_or_else(|| if args.check { fresh() } else { 1 });
    let request = DialRequest { moments: args.moments as usize, seed, size: args.size };
    let output = chart::Output::from(args.chart);
    let said = |words: String| eprintln!("{words}");
    let done = if args.levels {
        output.growing_sheet("dial-levels", |keep| dial::levels::measure(&request, said, keep)).and_then(|sheet| {
            println!("{}", dial::levels::verdict(&sheet));
            dial::draw::draw_levels(&sheet, &output).map(|files| chart::announce(&files))
        })
    } else if args.moving {
        output.growing_sheet("dial-moving", |keep| dial::moving::measure(&request, said, keep)).map(|sheet| {
            println!("{}", dial::moving::verdict(&sheet));
            chart::announce(&[output.csv("dial-moving")]);
        })
    } else if args.check {
        output.growing_sheet("dial-check", |keep| dial::check::measure(&request, said, keep)).and_then(|sheet| {
            println!("{}", dial::check::verdict(&sheet));
            dial::draw::draw(Prices::shipped(), &sheet, &output).map(|files| chart::announce(&files))
        })
    } else {
        output.growing_sheet("dial", |keep| dial::prices::measure(&request, said, keep)).and_then(|sheet| {
            let file = output.csv("quality");
            std::fs::write(&file, dial::prices::table(&sheet)?).map_err(|error| chart::SheetError::Io(file.clone(), error))?;
            chart::announce(&[file]);
            Ok(())
        })
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

fn run_chart_quarry(args: &ChartQuarryArgs) -> ExitCode {
    let loaded = scene::config::find(None).map_err(|error| error.to_string());
    let scene = scene::load(&args.scene).map_err(|error| error.to_string());
    let (config, scene) = match (loaded, scene) {
        (Ok(config), Ok(scene)) if scene.ships.len() >= 2 => (config, scene),
        (Ok(_), Ok(_)) => return fail(&format!("{}: it needs two ships, the first to hunt the second", args.scene), 2),
        (Err(error), _) | (_, Err(error)) => return fail(&error, 2),
    };
    match lensrunner_lab::quarry::run(&scene, &config, args.seeds, args.limit, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

fn run_chart_disk(args: ChartDiskArgs) -> ExitCode {
    use lensrunner::render::Gpu;
    use lensrunner_lab::disk::{chart, request::DiskRequest};
    let config = match scene::config::find(args.config.as_deref()) {
        Ok(config) => config,
        Err(error) => return fail(&error, 2),
    };
    let request = DiskRequest {
        output: args.chart.into(),
        size: args.size,
        error_size: args.error_size,
        rounds: usize::from(args.rounds),
        steps: usize::from(args.steps),
        flight: args.flight as usize,
    };
    if request.output.redraw {
        return finish_chart(chart::redraw(&request));
    }
    match Gpu::headless() {
        Ok(gpu) => finish_chart(chart::run(&request, &config, gpu)),
        Err(error) => fail(&error, 1),
    }
}

fn run_chart_frame(args: ChartFrameArgs) -> ExitCode {
    let config = match scene::config::find(args.config.as_deref()) {
        Ok(config) => config,
        Err(error) => return fail(&error, 2),
    };
    let request = frame_times::FrameTimesRequest {
        output: chart::Output { folder: args.output, redraw: false },
        scenes: args.scene,
        size: args.size,
        frames: args.frames,
        at: args.at,
        rationed: args.rationed,
        flight: args.flight,
    };
    match frame_times::run(&request, &config, &mut io::stdout().lock()) {
        Ok(paths) => {
            chart::announce(&paths);
            ExitCode::SUCCESS
        }
        Err(error) => fail_shot(&error),
    }
}

fn run_chart_projection(args: ChartProjectionArgs) -> ExitCode {
    let request = projection::ProjectionRequest { output: args.chart.into(), points: args.points, seed: args.seed, methods: args.methods };
    let mut race = if request.output.redraw { None } else { Race::on_best_adapter() };
    match projection::run(&request, race.as_mut()) {
        Err(error @ ChartError::Method { .. }) => fail(&error, 2),
        result => finish_chart(result),
    }
}

fn run_chart_aurora(args: ChartAuroraArgs) -> ExitCode {
    let experiment = aurora::experiment::ExperimentRequest {
        auroras: usize::from(args.auroras),
        counts: args.electrons,
        radii: args.radii,
        size: args.size,
        repeats: usize::from(args.repeats),
    };
    let output: chart::Output = args.chart.into();
    let (adapter, mut runners) = if output.redraw { Default::default() } else { aurora_race::runners() };
    finish_chart(aurora::chart::run(&output, &experiment, &adapter, &mut runners))
}

fn run_chart_bvh(args: ChartBvhArgs) -> ExitCode {
    let request = bvh::BvhRequest {
        output: args.chart.into(),
        scenes: args.scenes,
        size: [1024, 768],
        rounds: args.rounds.into(),
        bunny: args.bunny,
        check: args.check,
    };
    match bvh::run(&request) {
        Err(error) if error.is_input() => fail(&error, 2),
        done => finish_chart(done),
    }
}

/// Says what was written, or what went wrong.
fn finish_chart<E: std::fmt::Display>(written: Result<Vec<PathBuf>, E>) -> ExitCode {
    match written {
        Ok(paths) => {
            chart::announce(&paths);
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, 1),
    }
}

fn fail_shot(error: &lensrunner::render::shot::ShotError) -> ExitCode {
    fail(error, if error.is_input() { 2 } else { 1 })
}
