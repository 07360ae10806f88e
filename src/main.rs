//! The command line.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use lensrunner::scene;
use lensrunner::sim::simulate::{self, SimulateError};

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

fn main() -> ExitCode {
    match Cli::parse().command {
        Command::Simulate(args) => run_simulate(&args),
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

/// A buffered writer to `path`, or to standard output.
fn output(path: Option<&PathBuf>) -> io::Result<Box<dyn Write>> {
    Ok(match path {
        Some(path) => Box::new(BufWriter::new(
            File::create(path).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))?,
        )),
        None => Box::new(BufWriter::new(io::stdout().lock())),
    })
}

fn fail(error: &dyn std::error::Error, code: u8) -> ExitCode {
    eprintln!("lensrunner: {error}");
    ExitCode::from(code)
}
