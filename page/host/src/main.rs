//! Makes the page's files, and serves them on this machine.

mod make;
mod serve;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Makes the page's files, and serves them on this machine.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Joins a program in WebAssembly to JavaScript for Node.
    Node {
        /// The program.
        program: PathBuf,
        /// Where both are written.
        folder: PathBuf,
    },
    /// Makes a folder of static files of the page.
    Page {
        #[command(flatten)]
        parts: make::Parts,
        /// Where all are written; what was there is replaced.
        folder: PathBuf,
    },
    /// Serves a folder on this machine alone.
    Serve {
        /// The folder.
        folder: PathBuf,
        /// The port; 0 is any that is free.
        #[arg(long, default_value_t = 8080)]
        port: u16,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Node { program, folder } => make::join(&program, make::For::Node, &folder),
        Command::Page { parts, folder } => make::page(&parts, &folder),
        Command::Serve { folder, port } => serve::serve(&folder, port),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}
