//! Playing: screens, input, camera, HUD, dev overlay, and the demonstration flight without a display.

use std::path::PathBuf;
use std::process::ExitCode;

/// Plays a scene in a window, or without a display as pictures.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct PlayArgs {
    /// The game's configuration [default: game.toml where there is one].
    #[arg(long, value_name = "game.toml")]
    pub config: Option<PathBuf>,
    /// The scene: a TOML file, or the name of one in assets/scenes [default: chase].
    #[arg(long, value_name = "NAME|FILE")]
    pub scene: Option<String>,
}

/// Plays.
pub fn run(_args: &PlayArgs) -> ExitCode {
    ExitCode::SUCCESS
}
