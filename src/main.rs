//! The command line.

mod built;
mod inside;

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::OnceLock;

use clap::{Args, Parser, Subcommand, ValueEnum};
use lensrunner::argument::{number, whole};
use lensrunner::judge::{case, to_file};
use lensrunner::lensing::project::{self, ProjectError};
use lensrunner::lensing::{self, Scheme, methods};
use lensrunner::picture_file::moment::moment_of;
use lensrunner::scene::config::Assignment;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, Difficulty};
use lensrunner::sim::replay::{Replay, ReplayError, record};
use lensrunner::sim::run::RunRequest;
use lensrunner::sim::simulate::{self, SimulateError};
use lensrunner::sim::sweep::{self, Axis};
use lensrunner::sim::{agent, balance, check};
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner::user_file::{Named, brief, write_whole};

/// The committed table, inside the program.
const TABLE: lensrunner::game_files::Inside = ("tables/default.lut", include_bytes!("../tables/default.lut"));
/// Width and height of a picture of a scene, in pixels.
const SIZE: [u32; 2] = [1280, 720];

/// A chase game in the spacetime of a black hole, and the instrument that proves its picture right.
#[derive(Parser)]
#[command(version = version(), about, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Without a subcommand: play.
    #[cfg(feature = "game")]
    #[command(flatten)]
    play: lensrunner::play::PlayArgs,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "game")]
    Play(lensrunner::play::PlayArgs),
    #[cfg(feature = "game")]
    Shot(ShotArgs),
    #[cfg(feature = "game")]
    Screens(lensrunner::play::tour::TourArgs),
    #[cfg(feature = "game")]
    Trailer(lensrunner::play::trailer::TrailerArgs),
    Bake(BakeArgs),
    Project(ProjectArgs),
    Simulate(SimulateArgs),
    Check(check::CheckArgs),
    Balance(balance::BalanceArgs),
    Trace(TraceArgs),
}

// What a picture shows. (No docstring: clap would take it for the command's.)
#[derive(Args)]
struct Shown {
    /// The scene: a TOML file, or the name of one in assets/scenes; or a moment that the dev overlay has saved.
    #[arg(long, value_name = "NAME|FILE", required_unless_present = "from")]
    #[arg(long_help = scene::help("The scene: a TOML file, or the name of one in assets/scenes; or a moment that the dev overlay has saved."))]
    scene: Option<String>,
    /// Instead of a scene, the moment that a PNG of the game carries: its flight, T, camera and settings.
    #[arg(long, value_name = "PICTURE.png", conflicts_with_all = ["scene", "at", "config", "set"])]
    from: Option<PathBuf>,
}

// Settings and file of a picture.
#[derive(Args)]
struct PictureOut {
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// Sets a value over the configuration, as render.orders=3; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Assignment>,
    /// The picture: .png or .exr.
    #[arg(short, value_name = "FILE")]
    output: PathBuf,
}

/// Draws one picture of a scene, without a window.
///
/// A .png holds the finished picture; an .exr linear light (R, G, B) and with --layers object.id, image.order, travel.time (r_s/c) and
/// frequency.ratio (g = ν_observed/ν_emitted) of the nearest surface.
#[cfg(feature = "game")]
#[derive(Args)]
struct ShotArgs {
    #[command(flatten)]
    shown: Shown,
    /// Width and height in pixels [default: 1280x720, with --from that of the picture].
    #[arg(long, value_name = "WxH", value_parser = lensrunner::render::shot::size)]
    size: Option<[u32; 2]>,
    /// The time T, in r_s/c, rounded to a step of the simulation (clock.step in game.toml: 0.03125, 1/32, unless changed).
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = number)]
    at: f64,
    /// Adds object id, image order, travel time and g to an .exr.
    #[arg(long)]
    layers: bool,
    #[command(flatten)]
    picture: PictureOut,
}

/// Traces one picture of a scene, each pixel by a light ray of its own: the exact picture that the game's is judged by.
///
/// A .png holds the finished picture; an .exr linear light (R, G, B) and with --layers what the centre of each pixel shows: object.id,
/// triangle.id, barycentric.a to c, texture.u and v, image.order, swept.angle (radians), travel.time (r_s/c) and frequency.ratio
/// (g = ν_observed/ν_emitted).
#[derive(Args)]
struct TraceArgs {
    #[command(flatten)]
    shown: Shown,
    /// Width and height in pixels [default: 1280x720, with --from that of the picture].
    #[arg(long, value_name = "WxH", value_parser = scene::picture_size)]
    size: Option<[u32; 2]>,
    /// Prints lines `progress 0.42`, the share that is finished, to standard output instead of a bar.
    #[arg(long)]
    progress: bool,
    /// The time T, in r_s/c, rounded to a step of the simulation (clock.step in game.toml: 0.03125, 1/32, unless changed).
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = number)]
    at: f64,
    /// Rays a pixel: a square number, 1 to 256.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u32>(1, 256))]
    samples: u32,
    /// Threads; 0 as many as there are cores.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<usize>(0, 1024))]
    threads: usize,
    /// Error of each step of a ray, relative to r (1e-17 to 1e-3).
    #[arg(long, value_name = "E", default_value_t = case::DEFAULT_TOLERANCE, allow_negative_numbers = true, value_parser = number)]
    tolerance: f64,
    /// Rays along each side of a packet, 1 to 8: neighbours are followed together until they diverge. The picture is the same.
    #[arg(long, value_name = "N", default_value_t = lensrunner::judge::picture::DEFAULT_PACKET)]
    #[arg(allow_negative_numbers = true, value_parser = whole::<u32>(1, 8))]
    packet: u32,
    /// Gives up after so many seconds of tracing, with code 1, and says how far it came; without it there is no limit.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = number)]
    limit: Option<f64>,
    /// Adds what each pixel shows to an .exr.
    #[arg(long)]
    layers: bool,
    #[command(flatten)]
    picture: PictureOut,
}

/// Plays a scene without graphics, as fast as it goes, and writes the ships' states as CSV.
///
/// Columns: ship,T,tau,x,y,z,px,py,pz,qw,qx,qy,qz,E,Lx,Ly,Lz, per unit mass in r_s = c = 1. p is the rain-frame momentum, q turns body axes
/// into rain axes through the pure boost of p. Rows by T, then in scene order.
#[derive(Args)]
struct SimulateArgs {
    /// The scene: a TOML file, or the name of one in assets/scenes.
    #[arg(long_help = scene::help("The scene: a TOML file, or the name of one in assets/scenes."), required_unless_present = "replay")]
    scene: Option<String>,
    /// Flies a replay again instead, and says whether it comes to the same end: a file, a link, or one of the game's own, as
    /// 01-training-expert.
    /// SCENE is then the file of a mission of your own.
    #[arg(long, value_name = "NAME|FILE", conflicts_with_all = ["until", "every", "seed", "output"])]
    replay: Option<PathBuf>,
    /// Of a mission: easy, normal or hard.
    #[arg(long, value_name = "LEVEL", default_value_t)]
    difficulty: Difficulty,
    /// Who flies the player's ship: naive, ignoring, person, practised, apprentice, expert, or hands, which throw it about.
    #[arg(long, value_name = "NAME", default_value_t)]
    pilot: PilotKind,
    /// Another program flies: a line of JSON with what is seen goes to standard output, a line with what to do comes from standard input.
    #[arg(long, conflicts_with_all = ["replay", "sweep", "output", "pilot"])]
    agent: bool,
    /// Flies all combinations of settings instead, a row each: KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,… of game.toml; may be repeated.
    #[arg(long, value_name = "KEY=VALUES", conflicts_with_all = ["replay", "save_replay"])]
    sweep: Vec<Axis>,
    /// Flights of each combination of a sweep, from --seed on.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "sweep")]
    #[arg(allow_negative_numbers = true, value_parser = whole::<u64>(1, 1_000_000))]
    seeds: u64,
    /// Writes the flight as a replay.
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    save_replay: Option<PathBuf>,
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// The last T, in r_s/c [default: the chase's time limit, or 100 when no ship has an AI].
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    until: Option<f64>,
    /// T between rows, in r_s/c.
    #[arg(long, value_name = "DT", default_value_t = simulate::DEFAULT_EVERY, allow_negative_numbers = true, value_parser = number)]
    every: f64,
    /// Seed for everything left to chance.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    seed: u64,
    /// Where the rows go [default: standard output].
    #[arg(short, value_name = "FILE.csv")]
    output: Option<PathBuf>,
}

/// Says where points are seen: CSV r,phi,L on standard input, CSV r,phi,L,psi,delay,redshift on standard output.
///
/// Lengths in r_s, angles in radians, phi in [0, π], delay in r_s/c. psi is measured at the camera from the outward radial direction;
/// redshift is ν_observed/ν_emitted between static observers. Fields stay empty where nothing is seen. Rows are answered as they come:
/// above a wrong line there may be answers already.
#[derive(Args)]
#[command(after_long_help = methods::help(), after_help = methods::help())]
struct ProjectArgs {
    /// How the ray is found; exact is the closed form in f64. The methods are listed below.
    #[arg(long, value_name = "NAME", default_value = "exact")]
    method: String,
    /// Which image: 1 the primary, 2 the secondary, 3 the one after a full turn.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u8>(1, 3))]
    order: u8,
    /// The frame at the camera in which psi is measured.
    #[arg(long, value_enum, default_value_t = FrameArg::Static)]
    frame: FrameArg,
    /// The sign of the photon's energy; matters only where camera and point are both inside the horizon.
    #[arg(long, value_enum, default_value_t = BranchArg::Plus)]
    branch: BranchArg,
}

/// Bakes a lensing table with a progress bar; prints its size, the time, and its error on fresh random points.
///
/// Errors are those of the direction (rain frame, degrees), of the travel time (r_s/c, and as a share of what is allowed: 0.002 + 3e-7 of
/// the travel time, 0.02 nearer than r = 1.05) and of the direction at emission. Adversarial points crowd where methods fail: at the
/// camera, at the axis, at the horizon and the photon sphere; friendly ones are spread evenly. The game draws with tables/default.lut.
#[derive(Args)]
struct BakeArgs {
    /// Size of the table, 5 to 128: nodes along each axis for the schemes of Yamashita 2012, along Φ for the scheme residual (L and r take
    /// fewer).
    #[arg(long, value_name = "N", default_value_t = lensing::FULL_NODES as u8)]
    #[arg(allow_negative_numbers = true, value_parser = whole::<u8>(5, 128))]
    nodes: u8,
    /// What is stored.
    #[arg(long, value_name = "NAME", value_enum, default_value_t = SchemeArg::Residual)]
    scheme: SchemeArg,
    /// The file to write.
    #[arg(short, value_name = "FILE", default_value = "tables/baked.lut")]
    output: PathBuf,
    /// Random points for each order to measure the error on, 0 to measure nothing.
    #[arg(long, value_name = "N", default_value_t = 30_000, allow_negative_numbers = true, value_parser = whole::<usize>(0, 1_000_000_000))]
    points: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum SchemeArg {
    /// Residuals against closed forms, as splines: the one the game draws with.
    Residual,
    /// Yamashita 2012, the meshes of its equations 3 to 7.
    Paper,
    /// Yamashita 2012, uniform meshes.
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

/// `0.1.0 (e5844de1a2b3, x86_64-unknown-linux-gnu)`: version, commit, target.
fn version() -> &'static str {
    static VERSION: OnceLock<String> = OnceLock::new();
    let [named, found] = [option_env!("LENSRUNNER_COMMIT").unwrap_or(""), str::from_utf8(&built::COMMIT).unwrap_or("")];
    let commit = [named, found].into_iter().find(|commit| !commit.is_empty() && !commit.starts_with('\0')).unwrap_or("unknown");
    VERSION.get_or_init(|| format!("{} ({commit}, {})", env!("CARGO_PKG_VERSION"), built::TARGET))
}

/// What the command line says; a refusal is said as clap says it, but for the middle of what is long.
fn parsed() -> Result<Cli, ExitCode> {
    Cli::try_parse().map_err(|error| {
        let said = error.to_string();
        if said.lines().map(str::len).max().unwrap_or(0) < 1500 {
            error.exit();
        }
        said.lines().for_each(|line| eprintln!("{}", brief(line)));
        ExitCode::from(2)
    })
}

fn main() -> ExitCode {
    lensrunner::game_files::embed(inside::FILES.iter().copied().chain([TABLE]));
    let cli = match parsed() {
        Ok(cli) => cli,
        Err(code) => return code,
    };
    match cli.command {
        #[cfg(feature = "game")]
        None => lensrunner::play::run(&cli.play),
        #[cfg(not(feature = "game"))]
        None => fail(&"this build has no renderer: choose a subcommand (--help lists them)", 2),
        #[cfg(feature = "game")]
        Some(Command::Play(args)) => lensrunner::play::run(&args),
        #[cfg(feature = "game")]
        Some(Command::Shot(args)) => run_shot(&args),
        #[cfg(feature = "game")]
        Some(Command::Screens(args)) => match lensrunner::play::tour::draw(&args) {
            Ok(count) => {
                // Nobody may be reading.
                _ = writeln!(io::stdout(), "{count} pictures");
                ExitCode::SUCCESS
            }
            Err(error) => fail(&error, 1),
        },
        #[cfg(feature = "game")]
        Some(Command::Trailer(args)) => {
            lensrunner::play::warn_on_stderr();
            match lensrunner::play::trailer::run(&args) {
                Ok(done) => {
                    // Nobody may be reading.
                    _ = writeln!(io::stdout(), "{done}");
                    ExitCode::SUCCESS
                }
                Err(error) => fail(&error, 1),
            }
        }
        Some(Command::Bake(args)) => run_bake(args),
        Some(Command::Project(args)) => run_project(&args),
        Some(Command::Simulate(args)) => run_simulate(&args),
        Some(Command::Check(args)) => match check::run_command(&args, &mut io::stdout()) {
            Ok(code) => ExitCode::from(code),
            Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
        },
        Some(Command::Balance(args)) => match balance::run_command(&args) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
        },
        Some(Command::Trace(args)) => run_trace(&args),
    }
}

#[cfg(feature = "game")]
fn run_shot(args: &ShotArgs) -> ExitCode {
    lensrunner::play::warn_on_stderr();
    if args.layers && args.picture.output.extension().is_some_and(|extension| extension != "exr") {
        return fail(&format!("{}: layers are written to .exr only", args.picture.output.display()), 2);
    }
    use lensrunner::render::shot::{ShotRequest, shot_again_to_file, shot_to_file};
    let is_light = args.picture.output.extension().is_some_and(|extension| extension == "exr");
    if let Some(from) = &moment_of(args.shown.scene.as_deref(), args.shown.from.as_deref()) {
        if let Err(error) = alone(args.at, &args.picture) {
            return fail(&error, 2);
        }
        let (snapshot, moment) = match case::flown_again(from, args.size) {
            Ok(flown) => flown,
            Err(error) => return fail(&error, 2),
        };
        return match shot_again_to_file(&snapshot, &moment, args.layers, !is_light, &args.picture.output) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail_shot(&error),
        };
    }
    let scene = args.shown.scene.as_deref().unwrap_or_default();
    let request = ShotRequest { scene, size: args.size.unwrap_or(SIZE), at: args.at, layers: args.layers, fill: !is_light };
    let config = match scene::config::find_with(args.picture.config.as_deref(), &args.picture.set) {
        Ok(config) => config,
        Err(error) => return fail(&error, 2),
    };
    match shot_to_file(&request, &config, &args.picture.output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail_shot(&error),
    }
}

#[cfg(feature = "game")]
fn fail_shot(error: &lensrunner::render::shot::ShotError) -> ExitCode {
    fail(error, if error.is_input() { 2 } else { 1 })
}

/// A moment has a T and settings of its own.
fn alone(at: f64, picture: &PictureOut) -> Result<(), String> {
    if at == 0.0 && picture.config.is_none() && picture.set.is_empty() {
        return Ok(());
    }
    Err("a moment has its own T and settings: --at, --config and --set do not go with it".into())
}

/// Says how far the work is; ends the program when nobody listens any more.
fn report_progress(share: f64) {
    let mut out = io::stdout().lock();
    if writeln!(out, "progress {share:.2}").and_then(|()| out.flush()).is_err() {
        std::process::exit(1);
    }
}

fn run_trace(args: &TraceArgs) -> ExitCode {
    let request = case::TraceRequest {
        scene: args.shown.scene.clone().unwrap_or_default(),
        size: args.size.unwrap_or(SIZE),
        at: args.at,
        samples: args.samples,
        threads: args.threads,
        tolerance: args.tolerance,
        packet: args.packet,
        limit: args.limit,
    };
    let progress = args.progress.then_some(&report_progress as &(dyn Fn(f64) + Sync));
    let output = to_file::Output { file: &args.picture.output, layers: args.layers, text: None, progress };
    let traced = match &moment_of(args.shown.scene.as_deref(), args.shown.from.as_deref()) {
        None => scene::config::find_with(args.picture.config.as_deref(), &args.picture.set)
            .map_err(case::TraceError::from)
            .and_then(|config| to_file::trace_to_file(&request, &config, &output)),
        // A wrong argument is said before the flight is flown.
        Some(from) => to_file::check(&request, &output).and_then(|_| {
            alone(args.at, &args.picture).map_err(case::TraceError::Input)?;
            let (snapshot, moment) = case::flown_again(from, args.size).map_err(|error| case::TraceError::Input(error.to_string()))?;
            let (text, request) = (snapshot.to_text(), case::TraceRequest { at: snapshot.time, ..request });
            let case = case::Case::again(&snapshot, &moment, snapshot.size);
            to_file::trace_case(&case, &request, &to_file::Output { text: Some(&text), ..output })
        }),
    };
    match traced {
        Ok(rate) => {
            eprintln!("{rate:.0} rays per second and thread");
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
    }
}

fn run_simulate(args: &SimulateArgs) -> ExitCode {
    if let Some(path) = &args.replay {
        return run_replay(path, args.scene.as_deref(), args.config.as_deref());
    }
    match simulate_scene(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(SimulateError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error @ SimulateError::Io(_)) => fail(&error, 1),
        Err(error) => fail(&error, 2),
    }
}

fn simulate_scene(args: &SimulateArgs) -> Result<(), SimulateError> {
    let config = scene::config::find(args.config.as_deref())?;
    let scene = scene::load(args.scene.as_deref().unwrap_or_default())?;
    let SimulateArgs { until, every, seed, difficulty, pilot, .. } = *args;
    let request = simulate::SimulateRequest { until, every, seed, pilot };
    let levelled = scene.config(&config, difficulty);
    request.check(&scene, &levelled)?;
    if args.agent {
        let until = request.check_recorded(&scene, &levelled)?;
        let request = agent::AgentRequest { until, seed, config: &config, difficulty };
        let replay = agent::fly(&scene, &levelled, &request, &mut io::stdin().lock(), &mut io::stdout().lock())?;
        if replay.outcome == "undecided" {
            eprintln!("there were no more actions, or the time was out: undecided after {} steps", replay.ticks);
        }
        return args.save_replay.as_ref().map_or(Ok(()), |path| save(path, &replay.to_text()));
    }
    if let Some(path) = &args.save_replay {
        request.check_recorded(&scene, &levelled)?;
        let (report, replay) = record(&scene, &config, &RunRequest { difficulty, pilot, seed, until });
        save(path, &replay.to_text())?;
        eprintln!("{}: {} at T = {}", path.display(), replay.outcome, report.time);
        return Ok(());
    }
    let mut out = output(args.output.as_ref())?;
    if !args.sweep.is_empty() {
        if let Some(path) = sweep::repeated(&args.sweep) {
            return Err(SimulateError::Input(format!("--sweep {path} is given twice")));
        }
        let rows = sweep::combinations(&args.sweep, args.seeds)
            .ok_or_else(|| SimulateError::Input(format!("a sweep has at most {} flights", sweep::MOST_FLIGHTS)))?;
        let run = RunRequest { difficulty, pilot, seed, until };
        return Ok(sweep::sweep(&scene, &config, &args.sweep, &rows, (&run, args.seeds), &mut out)?);
    }
    simulate::simulate(&scene, &levelled, &request, &mut out, &mut io::stderr())?;
    Ok(())
}

/// Writes a whole file; what goes wrong names it.
fn save(path: &Path, text: &str) -> Result<(), SimulateError> {
    let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
    Ok(write_whole(path, text.as_bytes()).map_err(named)?)
}

fn run_replay(path: &Path, scene: Option<&str>, config: Option<&Path>) -> ExitCode {
    let config = match scene::config::find(config) {
        Ok(config) => config,
        Err(error) => return fail(&error, 2),
    };
    match Replay::load(path).and_then(|replay| replay.verify(path, scene, &config).map(|report| (replay, report))) {
        Ok((replay, report)) => {
            eprintln!("{}: {} at T = {}, state {}, as it was", replay.scene, replay.outcome, report.time, replay.hash);
            ExitCode::SUCCESS
        }
        Err(error @ ReplayError::Differs { .. }) => fail(&error, 1),
        Err(error) => fail(&error, 2),
    }
}

fn run_project(args: &ProjectArgs) -> ExitCode {
    let order = Order::new(args.order).expect("clap has checked the range");
    let request = project::ProjectRequest {
        order,
        frame: match args.frame {
            FrameArg::Static => project::AngleFrame::Static,
            FrameArg::Rain => project::AngleFrame::Rain,
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
    let request = lensing::command::BakeRequest { nodes: usize::from(args.nodes), scheme, output: args.output, points: args.points };
    match lensing::command::run(&request) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

fn output(path: Option<&PathBuf>) -> io::Result<Box<dyn Write>> {
    Ok(match path {
        Some(path) => {
            let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
            std::fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).map_err(named)?;
            Box::new(BufWriter::new(Named { path: path.clone(), writer: File::create(path).map_err(named)? }))
        }
        None => Box::new(BufWriter::new(io::stdout())),
    })
}

fn fail(error: &dyn std::fmt::Display, code: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(code)
}
