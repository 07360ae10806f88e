//! The command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use lensrunner::measure::project;
use lensrunner::spacetime::light::{Branch, Order};
use std::io::{Read, Write};
use std::process::ExitCode;

/// A chase game in the spacetime of a black hole, and the instrument that proves its picture right.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Read points as CSV (r,phi,L) on stdin, write how they are seen as CSV (r,phi,L,psi,delay,redshift) on stdout.
    Project(ProjectArgs),
}

#[derive(Args)]
struct ProjectArgs {
    /// How the ray is found: exact (closed form, f64).
    #[arg(long, default_value = "exact", value_name = "NAME")]
    method: String,
    /// Which image: 1 is the primary, 2 the secondary, 3 the one after a full turn.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
    order: u8,
    /// The frame at the camera in which psi is measured: hovering, or falling from rest at infinity.
    #[arg(long, value_enum, default_value_t = FrameArg::Static)]
    frame: FrameArg,
    /// The sign of the photon's energy; matters only where camera and point are both inside the horizon.
    #[arg(long, value_enum, default_value_t = BranchArg::Plus)]
    branch: BranchArg,
}

#[derive(Clone, Copy, ValueEnum)]
enum FrameArg {
    Static,
    Rain,
}

#[derive(Clone, Copy, ValueEnum)]
enum BranchArg {
    Plus,
    Minus,
}

/// Why a command ended early.
enum Failure {
    /// The user's input is wrong: exit code 2.
    Input(String),
    /// Something else failed: exit code 1.
    Other(String),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Project(args) => run_project(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Input(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Other(message)) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run_project(args: &ProjectArgs) -> Result<(), Failure> {
    let wrong = |error: project::ProjectError| Failure::Input(error.to_string());
    let method = project::method(&args.method).map_err(wrong)?;
    let order = Order::new(args.order).ok_or_else(|| Failure::Input("order: 1, 2 or 3".to_owned()))?;
    let frame = match args.frame {
        FrameArg::Static => project::Frame::Static,
        FrameArg::Rain => project::Frame::Rain,
    };
    let branch = match args.branch {
        BranchArg::Plus => Branch::Plus,
        BranchArg::Minus => Branch::Minus,
    };
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).map_err(|error| Failure::Other(format!("stdin: {error}")))?;
    let input = String::from_utf8(bytes).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
        Failure::Input(format!("line {line}: not UTF-8 text"))
    })?;
    let output = project::project(&input, method.as_ref(), order, frame, branch).map_err(wrong)?;
    match std::io::stdout().write_all(output.as_bytes()) {
        // Whoever reads may stop reading.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Other(format!("stdout: {error}"))),
        _ => Ok(()),
    }
}
