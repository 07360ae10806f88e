//! The laboratory's command line.

mod all;
mod charts;
mod map_of_stability;
mod verdict;

use std::process::ExitCode;
use std::sync::OnceLock;

use clap::{Parser, Subcommand};

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
    Stability(map_of_stability::StabilityArgs),
    All(all::AllArgs),
    Status(all::StatusArgs),
    #[command(hide = true)]
    EmptyWindow(charts::EmptyWindowArgs),
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
        Command::Stability(args) => map_of_stability::run(args),
        Command::All(args) => all::all(args),
        Command::Status(args) => all::status(&args),
        Command::EmptyWindow(args) => charts::show_empty_window(&args),
    }
}

fn fail(error: &dyn std::fmt::Display, code: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(code)
}
