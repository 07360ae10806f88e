//! The laboratory's command line.

mod all;
mod charts;
mod verdict;

use std::path::Path;
use std::process::ExitCode;
use std::sync::OnceLock;

use clap::{Parser, Subcommand};
use lensrunner_lab::products::make::MakeRequest;
use lensrunner_lab::stability::{self, StabilityRequest, faults};
use lensrunner_lab::window_rates::empty::{self, EmptyWindowRequest};

/// The laboratory of Lensrunner: verdicts on the game's picture, and charts of speed against accuracy.
#[derive(Parser)]
#[command(version = version(), about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Compare(Box<verdict::CompareArgs>),
    #[command(subcommand)]
    Chart(charts::ChartCommand),
    Stability(StabilityRequest),
    All(MakeRequest),
    Status(all::StatusArgs),
    #[command(hide = true)]
    EmptyWindow(EmptyWindowRequest),
}

/// Version and commit of the sources.
fn version() -> &'static str {
    static VERSION: OnceLock<String> = OnceLock::new();
    VERSION.get_or_init(|| {
        let commit = lensrunner_lab::chart::provenance::commit();
        format!("{} ({})", env!("CARGO_PKG_VERSION"), if commit.is_empty() { "commit unknown" } else { &commit })
    })
}

fn main() -> ExitCode {
    match Cli::parse().command {
        Command::Compare(args) => verdict::run(&args),
        Command::Chart(chart) => charts::run(chart),
        Command::Stability(request) if request.faults => try_faults(),
        Command::Stability(request) => charts::finish(stability::run(&request)),
        Command::All(args) => all::all(args),
        Command::Status(args) => all::status(&args),
        Command::EmptyWindow(request) => empty::show(request).map_or_else(|error| fail(&error, 1), |()| ExitCode::SUCCESS),
    }
}

fn fail(error: &dyn std::fmt::Display, code: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(code)
}

/// Each fault of the map of failures, put into a copy of the sources.
fn try_faults() -> ExitCode {
    let folder = std::env::temp_dir().join(format!("lensrunner-faults-{}", std::process::id()));
    let tried = faults::run(Path::new("."), &folder);
    _ = std::fs::remove_dir_all(&folder);
    match tried {
        Ok(found) => {
            found.iter().for_each(|(test, found)| println!("{} {test}", if *found { "found " } else { "MISSED" }));
            if found.iter().all(|(_, found)| *found) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => fail(&error, 1),
    }
}
