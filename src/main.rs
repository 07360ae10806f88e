//! The command line.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use lensrunner::lensing::{self, Scheme};
use lensrunner::measure::project::{self, ProjectError};
use lensrunner::sim::simulate::{self, SimulateError};
use lensrunner::spacetime::light::{Branch, Order};

/// A chase game in the spacetime of a black hole, and the instrument that proves its picture right.
#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Simulate(SimulateArgs),
    Project(ProjectArgs),
    Bake(BakeArgs),
}

/// Plays a scene without graphics, as fast as it goes, and writes the ships' states as CSV.
///
/// Columns: ship,T,tau,x,y,z,px,py,pz,qw,qx,qy,qz,E,Lx,Ly,Lz, per unit mass in r_s = c = 1. p is the rain-frame momentum, q turns body axes
/// into rain axes through the pure boost of p. Rows by T, then in scene order.
#[derive(Args)]
struct SimulateArgs {
    /// The scene file, TOML.
    scene: PathBuf,
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
        Command::Simulate(args) => run_simulate(&args),
        Command::Project(args) => run_project(&args),
        Command::Bake(args) => run_bake(args),
    }
}

fn run_simulate(args: &SimulateArgs) -> ExitCode {
    let request = simulate::Request {
        until: args.until,
        every: args.every,
        seed: args.seed,
    };
    let result = output(args.output.as_ref())
        .map_err(SimulateError::from)
        .and_then(|mut out| simulate::run(&args.scene, &request, &mut out, &mut io::stderr()));
    match result {
        Ok(_) => ExitCode::SUCCESS,
        Err(SimulateError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error @ SimulateError::Input(_)) => fail(&error, 2),
        Err(error @ SimulateError::Io(_)) => fail(&error, 1),
    }
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
    let result = project::method(&args.method).and_then(|method| {
        project::run(
            &mut io::stdin().lock(),
            &mut io::stdout().lock(),
            method.as_ref(),
            request,
        )
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(ProjectError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
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
    let request = lensing::command::Request {
        nodes: usize::from(args.nodes),
        scheme,
        output: args.output,
        points: args.points,
    };
    match lensing::command::run(&request) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

/// A buffered writer to `path`, or to standard output.
fn output(path: Option<&PathBuf>) -> io::Result<Box<dyn Write>> {
    Ok(match path {
        Some(path) => Box::new(BufWriter::new(File::create(path).map_err(|error| {
            io::Error::new(error.kind(), format!("{}: {error}", path.display()))
        })?)),
        None => Box::new(BufWriter::new(io::stdout().lock())),
    })
}

fn fail(error: &dyn std::error::Error, code: u8) -> ExitCode {
    eprintln!("lensrunner: {error}");
    ExitCode::from(code)
}
