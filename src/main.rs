//! The command line.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use lensrunner::lensing::{self, Scheme};
use lensrunner::measure::project::{self, ProjectError};
use lensrunner::measure::{aurora, chart, projection, trace};
use lensrunner::scene;
use lensrunner::sim::simulate::{self, SimulateError};
use lensrunner::spacetime::light::{Branch, Order};

/// A chase game in the spacetime of a black hole, and the instrument that proves its picture right.
#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "game")]
    Play(lensrunner::play::PlayArgs),
    #[cfg(feature = "game")]
    Shot(ShotArgs),
    Bake(BakeArgs),
    Project(ProjectArgs),
    Simulate(SimulateArgs),
    Trace(TraceArgs),
    #[command(subcommand)]
    Chart(ChartCommand),
}

/// Measures and draws a chart of error against time: CSV, SVG and PNG.
#[derive(Subcommand)]
enum ChartCommand {
    Projection(ChartProjectionArgs),
    Aurora(ChartAuroraArgs),
    #[cfg(feature = "game")]
    Frame(ChartFrameArgs),
    #[cfg(feature = "game")]
    Disk(ChartDiskArgs),
}

/// Where a chart goes.
#[derive(Args)]
struct ChartArgs {
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

/// Every method of projection on the same adversarial points: error against time per lookup and against memory.
#[derive(Args)]
struct ChartProjectionArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Adversarial points for each method and image order.
    #[arg(long, value_name = "N", default_value_t = 300_000)]
    points: usize,
    /// Seed of the points.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// The experiment of paper 3: auroras by the particle method and by screen walks, time against error, from four views.
#[derive(Args)]
struct ChartAuroraArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// How many of the ten auroras.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u8).range(1..=10))]
    auroras: u8,
    /// Numbers of electrons.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1000,4000,16000", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    electrons: Vec<u32>,
    /// Standard deviations of a point's light in km, 0.1 to 50.
    #[arg(long, value_name = "KM,…", value_delimiter = ',', default_value = "1,2,4", value_parser = aurora::chart::radius)]
    radii: Vec<f32>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = aurora::chart::size)]
    size: [usize; 2],
    /// Runs of which the median is taken.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=100))]
    repeats: u8,
}

/// Times whole frames of scenes, and each pass of them.
#[cfg(feature = "game")]
#[derive(Args)]
struct ChartFrameArgs {
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "ring,galaxy,parade,chase")]
    scene: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Frames of each scene.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: u32,
    /// The time T, in r_s/c.
    #[arg(long, value_name = "T", default_value_t = 0.0)]
    at: f64,
    /// The game's configuration [default: built in, as the game.toml that comes with the game].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
}

/// The accretion disk as polygons, sprites and arcs: time and error of each alone, and along a scripted chase.
#[cfg(feature = "game")]
#[derive(Args)]
struct ChartDiskArgs {
    #[command(flatten)]
    chart: ChartArgs,
    /// Width and height of the frames that are timed.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// Width and height of the pictures that are compared with the exact one.
    #[arg(long, value_name = "WxH", default_value = "480x270", value_parser = lensrunner::render::shot::size)]
    error_size: [u32; 2],
    /// Rounds in which all ways take turns.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u16).range(1..=1000))]
    rounds: u16,
    /// Places along the chase.
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u16).range(2..=1000))]
    steps: u16,
    /// The game's configuration [default: built in, as the game.toml that comes with the game].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
}

/// Draws one picture of a scene, without a window.
///
/// A .png holds the developed picture; an .exr linear light (R, G, B) and with --layers object.id, image.order, travel.time (r_s/c) and
/// frequency.ratio (g = ν_observed/ν_emitted) of the nearest surface.
#[cfg(feature = "game")]
#[derive(Args)]
struct ShotArgs {
    /// The scene: a TOML file, or the name of one in assets/scenes.
    #[arg(long, value_name = "NAME|FILE")]
    scene: String,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = lensrunner::render::shot::size)]
    size: [u32; 2],
    /// The time T, in r_s/c.
    #[arg(long, value_name = "T", default_value_t = 0.0)]
    at: f64,
    /// Adds object id, image order, travel time and g to an .exr.
    #[arg(long)]
    layers: bool,
    /// The game's configuration [default: built in, as the game.toml that comes with the game].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// The picture: .png or .exr.
    #[arg(short, value_name = "FILE")]
    output: PathBuf,
}

/// Traces one picture of a scene, each pixel by a light ray of its own: the exact picture that the game's is judged by.
///
/// A .png holds the developed picture; an .exr linear light (R, G, B) and with --layers what the centre of each pixel shows: object.id,
/// triangle.id, barycentric.a to c, texture.u and v, image.order, swept.angle (radians), travel.time (r_s/c) and frequency.ratio
/// (g = ν_observed/ν_emitted).
#[derive(Args)]
struct TraceArgs {
    /// The scene: a TOML file, or the name of one in assets/scenes.
    #[arg(long, value_name = "NAME|FILE")]
    scene: String,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = scene::picture_size)]
    size: [u32; 2],
    /// The time T, in r_s/c.
    #[arg(long, value_name = "T", default_value_t = 0.0)]
    at: f64,
    /// Rays a pixel: a square number, 1 to 256.
    #[arg(long, value_name = "N", default_value_t = 1)]
    samples: u32,
    /// Threads; 0 as many as there are cores.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Error of each step of a ray, relative to r (1e-17 to 1e-3).
    #[arg(long, value_name = "E", default_value_t = trace::DEFAULT_TOLERANCE)]
    tolerance: f64,
    /// Adds what each pixel shows to an .exr.
    #[arg(long)]
    layers: bool,
    /// The game's configuration [default: built in, as the game.toml that comes with the game].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// The picture: .png or .exr.
    #[arg(short, value_name = "FILE")]
    output: PathBuf,
}

/// Plays a scene without graphics, as fast as it goes, and writes the ships' states as CSV.
///
/// Columns: ship,T,tau,x,y,z,px,py,pz,qw,qx,qy,qz,E,Lx,Ly,Lz, per unit mass in r_s = c = 1. p is the rain-frame momentum, q turns body axes
/// into rain axes through the pure boost of p. Rows by T, then in scene order.
#[derive(Args)]
struct SimulateArgs {
    /// The scene: a TOML file, or the name of one in assets/scenes.
    scene: String,
    /// The game's configuration [default: built in, as the game.toml that comes with the game].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// The last T, in r_s/c [default: the chase's time limit, or 100 when no ship has an AI].
    #[arg(long, value_name = "T")]
    until: Option<f64>,
    /// T between rows, in r_s/c.
    #[arg(long, value_name = "DT", default_value_t = simulate::DEFAULT_EVERY)]
    every: f64,
    /// Seed for everything left to chance.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Where the rows go [default: standard output].
    #[arg(short, value_name = "FILE.csv")]
    output: Option<PathBuf>,
}

/// Says where points are seen: CSV r,phi,L on standard input, CSV r,phi,L,psi,delay,redshift on standard output.
///
/// Lengths in r_s, angles in radians, phi in [0, π], delay in r_s/c. psi is measured at the camera from the outward radial direction;
/// redshift is ν_observed/ν_emitted between static observers. Fields stay empty where nothing is seen.
#[derive(Args)]
struct ProjectArgs {
    /// How the ray is found; exact is the closed form in f64.
    #[arg(long, value_name = "NAME", default_value = "exact")]
    method: String,
    /// Which image: 1 the primary, 2 the secondary, 3 the one after a full turn.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
    order: u8,
    /// The frame at the camera in which psi is measured.
    #[arg(long, value_enum, default_value_t = FrameArg::Static)]
    frame: FrameArg,
    /// The sign of the photon's energy; matters only where camera and point are both inside the horizon.
    #[arg(long, value_enum, default_value_t = BranchArg::Plus)]
    branch: BranchArg,
}

/// Bakes a lensing table with a progress bar; prints its size, the time, and its error on fresh random points.
#[derive(Args)]
struct BakeArgs {
    /// Nodes along each axis, 5 to 128; the scheme residual takes twice as many angles.
    #[arg(long, value_name = "N", default_value_t = lensing::FULL_NODES as u8, value_parser = clap::value_parser!(u8).range(5..=128))]
    nodes: u8,
    /// What is stored.
    #[arg(long, value_name = "NAME", value_enum, default_value_t = SchemeArg::Residual)]
    scheme: SchemeArg,
    /// The file to write.
    #[arg(short, value_name = "FILE", default_value = "tables/baked.lut")]
    output: PathBuf,
    /// Random points for each order to measure the error on.
    #[arg(long, value_name = "N", default_value_t = 30_000)]
    points: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum SchemeArg {
    /// Residuals against closed forms, as splines: the one the game draws with.
    Residual,
    /// Paper 1, the meshes of its equations 3 to 7.
    Paper,
    /// Paper 1, uniform meshes.
    PaperUniform,
}

#[derive(Clone, Copy, ValueEnum)]
enum FrameArg {
    /// Hovering; exists only outside the horizon.
    Static,
    /// Falling from rest at infinity.
    Rain,
}

#[derive(Clone, Copy, ValueEnum)]
enum BranchArg {
    Plus,
    Minus,
}

fn main() -> ExitCode {
    match Cli::parse().command {
        #[cfg(feature = "game")]
        None => lensrunner::play::run(&lensrunner::play::PlayArgs::default()),
        #[cfg(not(feature = "game"))]
        None => fail(&"this build has no renderer: choose a subcommand (--help lists them)", 2),
        #[cfg(feature = "game")]
        Some(Command::Play(args)) => lensrunner::play::run(&args),
        #[cfg(feature = "game")]
        Some(Command::Shot(args)) => run_shot(&args),
        Some(Command::Bake(args)) => run_bake(args),
        Some(Command::Project(args)) => run_project(&args),
        Some(Command::Simulate(args)) => run_simulate(&args),
        Some(Command::Trace(args)) => run_trace(&args),
        Some(Command::Chart(chart)) => match chart {
            ChartCommand::Projection(args) => run_chart_projection(args),
            ChartCommand::Aurora(args) => run_chart_aurora(args),
            #[cfg(feature = "game")]
            ChartCommand::Frame(args) => run_chart_frame(args),
            #[cfg(feature = "game")]
            ChartCommand::Disk(args) => run_chart_disk(args),
        },
    }
}

#[cfg(feature = "game")]
fn run_chart_disk(args: ChartDiskArgs) -> ExitCode {
    use lensrunner::measure::disk::chart::{Request, Shown, contestants, run};
    use lensrunner::render::disk::bench::Bench;
    use lensrunner::render::frame::Camera;
    use lensrunner::render::{Gpu, shot};
    let config = match args.config.as_deref().map(scene::config::load).transpose() {
        Ok(config) => config.unwrap_or_default(),
        Err(error) => return fail(&error, 2),
    };
    let request = Request {
        output: args.chart.into(),
        size: args.size,
        error_size: args.error_size,
        rounds: usize::from(args.rounds),
        steps: usize::from(args.steps),
    };
    let gpu = match Gpu::headless() {
        Ok(gpu) => gpu,
        Err(error) => return fail(&error, 1),
    };
    let adapter = gpu.adapter.name.clone();
    let mut bench = None;
    finish_chart(run(&request, &config, &adapter, &mut |number, eye, time, picture| {
        let configs = || contestants(&config).into_iter().map(|contestant| contestant.config);
        let bench = bench.get_or_insert_with(|| Bench::new(gpu.clone(), &shot::surroundings(), configs(), request.size));
        let camera = Camera { position: eye.position, momentum: eye.momentum, attitude: eye.attitude, field_of_view: eye.field_of_view };
        let (whole, passes, picture) = bench.frame(number, camera, time, picture).map_err(|error| error.to_string())?;
        Ok(Shown { whole, passes, picture })
    }))
}

#[cfg(feature = "game")]
fn run_chart_frame(args: ChartFrameArgs) -> ExitCode {
    use lensrunner::render::bench;
    let config = match args.config.as_deref().map(scene::config::load).transpose() {
        Ok(config) => config.unwrap_or_default(),
        Err(error) => return fail(&error, 2),
    };
    let request = bench::Request { scenes: args.scene, size: args.size, frames: args.frames, at: args.at };
    match bench::run(&request, &config, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail_shot(&error),
    }
}

fn run_chart_projection(args: ChartProjectionArgs) -> ExitCode {
    let request = projection::Request { output: args.chart.into(), points: args.points, seed: args.seed };
    finish_chart(projection::run(&request))
}

fn run_chart_aurora(args: ChartAuroraArgs) -> ExitCode {
    let experiment = aurora::experiment::Request {
        auroras: usize::from(args.auroras),
        counts: args.electrons,
        radii: args.radii,
        size: args.size,
        repeats: usize::from(args.repeats),
    };
    let mut runners = Vec::new();
    finish_chart(aurora::chart::run(&args.chart.into(), &experiment, "", &mut runners))
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

#[cfg(feature = "game")]
fn run_shot(args: &ShotArgs) -> ExitCode {
    use lensrunner::render::shot::{Request, shot_to_file};
    let request = Request { scene: &args.scene, size: args.size, at: args.at, layers: args.layers };
    match shot_to_file(&request, args.config.as_deref(), &args.output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail_shot(&error),
    }
}

#[cfg(feature = "game")]
fn fail_shot(error: &lensrunner::render::shot::ShotError) -> ExitCode {
    use lensrunner::render::readback::PictureError;
    use lensrunner::render::shot::ShotError;
    match error {
        ShotError::Picture(PictureError::Format(_)) => fail(error, 2),
        ShotError::Device(_) | ShotError::Picture(_) => fail(error, 1),
        _ => fail(error, 2),
    }
}

fn run_trace(args: &TraceArgs) -> ExitCode {
    let request = trace::Request {
        scene: args.scene.clone(),
        size: args.size,
        at: args.at,
        samples: args.samples,
        threads: args.threads,
        tolerance: args.tolerance,
    };
    match trace::trace_to_file(&request, args.config.as_deref(), &args.output, args.layers) {
        Ok(rate) => {
            eprintln!("{rate:.0} rays per second and thread");
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
    }
}

fn run_simulate(args: &SimulateArgs) -> ExitCode {
    match simulate_scene(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(SimulateError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error @ SimulateError::Io(_)) => fail(&error, 1),
        Err(error) => fail(&error, 2),
    }
}

fn simulate_scene(args: &SimulateArgs) -> Result<(), SimulateError> {
    let config = args.config.as_deref().map(scene::config::load).transpose()?.unwrap_or_default();
    let scene = scene::load(&args.scene)?;
    let request = simulate::Request { until: args.until, every: args.every, seed: args.seed };
    request.check(&scene, &config)?;
    let mut out = output(args.output.as_ref())?;
    simulate::simulate(&scene, &config, &request, &mut out, &mut io::stderr())?;
    Ok(())
}

fn run_project(args: &ProjectArgs) -> ExitCode {
    let order = Order::new(args.order).expect("clap has checked the range");
    let request = project::Request {
        order,
        frame: match args.frame {
            FrameArg::Static => project::Frame::Static,
            FrameArg::Rain => project::Frame::Rain,
        },
        branch: match args.branch {
            BranchArg::Plus => Branch::Plus,
            BranchArg::Minus => Branch::Minus,
        },
    };
    let result = project::method(&args.method)
        .and_then(|method| project::run(&mut io::stdin().lock(), &mut io::stdout().lock(), method.as_ref(), request));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(ProjectError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error @ ProjectError::Io(_)) => fail(&error, 1),
        Err(error) => fail(&error, 2),
    }
}

fn run_bake(args: BakeArgs) -> ExitCode {
    let scheme = match args.scheme {
        SchemeArg::Residual => Scheme::Residual,
        SchemeArg::Paper => Scheme::Paper,
        SchemeArg::PaperUniform => Scheme::PaperUniform,
    };
    let request = lensing::command::Request { nodes: usize::from(args.nodes), scheme, output: args.output, points: args.points };
    match lensing::command::run(&request) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

fn output(path: Option<&PathBuf>) -> io::Result<Box<dyn Write>> {
    Ok(match path {
        Some(path) => Box::new(BufWriter::new(
            File::create(path).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))?,
        )),
        None => Box::new(BufWriter::new(io::stdout())),
    })
}

fn fail(error: &dyn std::fmt::Display, code: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(code)
}
