//! Playing: screens, input, camera, HUD, dev overlay, and the demonstration flight without a display.
//!
//! [`game`] is screens, keys and time, [`window`] adds window and picture; [`demonstration`] flies it to files. Between them they share [`session`] (what is played), [`camera`]
//! and [`seen`] (where the image of a ship appears).

pub mod camera;
pub mod contestant;
pub mod demonstration;
pub mod director;
pub mod game;
pub mod hud;
pub mod input;
pub mod instruments;
pub mod live;
pub mod menu;
pub mod overlay;
pub mod record;
pub mod screens;
pub mod seen;
pub mod session;
pub mod sheet;
pub mod window;

use std::path::PathBuf;
use std::process::ExitCode;

use crate::render::Gpu;
use demonstration::Flight;
use session::Session;

/// Plays the chase: in a window, or without a display as a demonstration flight to PNG files.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct PlayArgs {
    /// The game's configuration [default: game.toml where there is one].
    #[arg(long, value_name = "game.toml")]
    pub config: Option<PathBuf>,
    /// The scene: a TOML file, or the name of one in assets/scenes [default: chase].
    #[arg(long, value_name = "NAME|FILE")]
    pub scene: Option<String>,
    /// Seed for everything left to chance [default: 0].
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// The autopilot flies the player's ship.
    #[arg(long)]
    pub autopilot: bool,
    /// Renders the demonstration flight to PNG files, without a window.
    #[arg(long)]
    pub headless: bool,
    /// Frames to draw: of the demonstration flight [default: 240]; in a window, after which it closes [default: no end].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// Width and height in pixels [default: 640x360 without a window, else as game.toml says].
    #[arg(long, value_name = "WxH", value_parser = crate::render::shot::size)]
    pub size: Option<[u32; 2]>,
    /// Writes every frame as PNG into this folder [default: out/ without a window].
    #[arg(long, value_name = "DIR")]
    pub record: Option<PathBuf>,
}

/// Whether there is a screen to open a window on.
fn has_display() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Plays. Exit code 2 for wrong input, 1 for a failure.
pub fn run(args: &PlayArgs) -> ExitCode {
    let fail = |error: &dyn std::fmt::Display, code: u8| {
        eprintln!("error: {error}");
        ExitCode::from(code)
    };
    let session = match Session::load(args.config.as_deref(), args.scene.as_deref(), args.seed.unwrap_or(0)) {
        Ok(session) => session,
        Err(error) => return fail(&error, 2),
    };
    let without_window = args.headless || !has_display();
    if without_window && !args.headless {
        println!("There is no display: the demonstration flight is drawn to files instead.");
    }
    let gpu = match Gpu::headless() {
        Ok(gpu) => gpu,
        Err(error) => return fail(&error, 1),
    };
    if !without_window {
        // Bevy opens the adapter again; this one was to say in words what is missing.
        drop(gpu);
        let options = window::Options { autopilot: args.autopilot, size: args.size, frames: args.frames, record: args.record.clone() };
        return match window::run(session, &options) {
            bevy::app::AppExit::Success => ExitCode::SUCCESS,
            bevy::app::AppExit::Error(code) => ExitCode::from(code.get()),
        };
    }
    let flight = Flight {
        frames: args.frames.unwrap_or(demonstration::FRAMES),
        size: args.size.unwrap_or(demonstration::SIZE),
        folder: args.record.clone().unwrap_or_else(|| PathBuf::from("out")),
    };
    match demonstration::fly(&gpu, &session, &flight) {
        Ok(report) => {
            println!("{report}");
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, 1),
    }
}
