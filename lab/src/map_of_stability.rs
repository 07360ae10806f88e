//! `stability` on the command line.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use lensrunner_lab::chart::{DEFAULT_FOLDER, Output, announce};
use lensrunner_lab::stability::{StabilityRequest, faults, run as measure};

use crate::fail;

/// Where methods fail: a page with a number for each method at each place, and the tests that hold the rest.
#[derive(Args)]
pub struct StabilityArgs {
    /// The folder for the page and its numbers.
    #[arg(short, value_name = "DIR", default_value = DEFAULT_FOLDER)]
    output: PathBuf,
    /// Writes the page again from the numbers in that folder, without measuring.
    #[arg(long)]
    redraw: bool,
    /// Leaves out pictures, and what must be baked first.
    #[arg(long)]
    quick: bool,
    /// Puts a fault for each test of the page into a copy of the committed sources and runs them there: each must fail.
    #[arg(long, conflicts_with_all = ["redraw", "quick"])]
    faults: bool,
}

/// Runs it.
pub fn run(args: StabilityArgs) -> ExitCode {
    if args.faults {
        return try_faults();
    }
    let request = StabilityRequest { output: Output { folder: args.output, redraw: args.redraw }, quick: args.quick };
    match measure(&request) {
        Ok(files) => {
            announce(&files);
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, 1),
    }
}

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
