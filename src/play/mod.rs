//! Playing: screens, input, camera, HUD, dev overlay, and the demonstration flight without a display.
//!
//! Each feature is a plugin: [`game`] (screens, keys, time), [`picture`] (camera and frame), [`hud`], [`coach`], [`menus`], [`overlay`],
//! [`sound`],
//! [`window`] (which adds them all to an app); [`schedule`] says in which order they run. [`demonstration`] flies the chase to files
//! without a window.
//! They share [`session`] (what is played), [`player_state`] (how the player plays) and [`camera`].

pub mod camera;
pub mod choices;
pub mod coach;
pub mod demonstration;
pub mod develop;
pub mod files;
pub mod game;
pub mod hud;
pub mod input;
pub mod loading;
pub mod menus;
pub mod missions;
pub mod overlay;
pub mod pace;
pub mod photo;
pub mod picture;
pub mod player_state;
pub mod records;
pub mod schedule;
pub mod session;
pub mod share;
pub mod sound;
mod switches;
pub mod tour;
pub mod trailer;
pub mod window;
pub mod words;

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use web_time::Instant;

use crate::argument::whole;
use crate::render::Gpu;
use crate::scene::pilot_kind::PilotKind;
use crate::scene::{Difficulty, config};
use crate::sim::replay::Replay;
use crate::user_file::check_writable;
use demonstration::DemonstrationRequest;
use session::Session;

/// Plays the chase: in a window, or without a display as a demonstration flight to PNG files.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct PlayArgs {
    /// The game's configuration [default: game.toml where there is one].
    #[arg(long, value_name = "game.toml")]
    pub config: Option<PathBuf>,
    /// Sets a value over the configuration and the player's choices, as render.orders=3; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<crate::scene::config::Assignment>,
    /// The scene or mission: a TOML file, or the name of one in assets/scenes or assets/missions [default: chase].
    #[arg(long, alias = "mission", value_name = "NAME|FILE")]
    #[arg(long_help = crate::scene::help("The scene: a TOML file, or the name of one in assets/scenes [default: chase]."))]
    pub scene: Option<String>,
    /// Seed for everything left to chance [default: 0].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: Option<u64>,
    /// Of a mission: easy, normal or hard [default: easy on the title, normal where a scene is named].
    #[arg(long, value_name = "LEVEL")]
    pub difficulty: Option<crate::scene::Difficulty>,
    /// Flies at once, without the title.
    #[arg(long)]
    pub at_once: bool,
    /// Shows the flight of a replay: a file, a link, or one of the game's own, as 01-training-expert; --scene is then the file of a
    /// mission of your own.
    #[arg(long, value_name = "NAME|FILE", conflicts_with_all = ["seed", "difficulty"])]
    pub replay: Option<PathBuf>,
    /// The autopilot flies the player's ship.
    #[arg(long)]
    pub autopilot: bool,
    /// Who flies the player's ship instead: naive, ignoring, person, practised, apprentice, expert, or hands, which throw it about.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["autopilot", "replay"])]
    pub pilot: Option<PilotKind>,
    /// Renders the demonstration flight to PNG files, without a window.
    #[arg(long)]
    pub headless: bool,
    /// Frames to draw: of the demonstration flight [default: 240]; in a window, after which it closes [default: no end].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 1_000_000))]
    pub frames: Option<u32>,
    /// Width and height in pixels [default: 640x360 without a window, else as game.toml says].
    #[arg(long, value_name = "WxH", value_parser = crate::render::shot::size)]
    pub size: Option<[u32; 2]>,
    /// Writes every frame as PNG, each with its moment for `--from`, into this folder [default: out/ without a window].
    #[arg(long, value_name = "DIR")]
    pub record: Option<PathBuf>,
    /// Writes the sound of the flight to this file; without --record and --frames the sound alone.
    #[arg(long, value_name = "FILE.wav", requires = "headless")]
    pub sound: Option<PathBuf>,
    /// Says in the terminal how much of the model is drawn, and why, whenever that changes.
    #[arg(long)]
    pub verbose: bool,
    /// Writes when each frame was ready, counted from the start; with --headless the game is played unseen, without files of pictures.
    #[arg(long, value_name = "FILE.csv", requires = "frames", conflicts_with_all = ["record", "sound"])]
    pub timings: Option<PathBuf>,
}

/// Where no window is opened, warnings (a model that cannot be read, a table that is baked anew) go to standard error as they are.
pub fn warn_on_stderr() {
    use bevy::log::tracing_subscriber::fmt;
    let plain = fmt().with_writer(std::io::stderr).with_ansi(std::io::stderr().is_terminal());
    let plain = plain.with_max_level(bevy::log::Level::WARN).without_time().with_target(false);
    // An error means that somebody listens already.
    _ = bevy::log::tracing::subscriber::set_global_default(plain.finish());
}

/// A line on standard output, if anybody still reads there.
fn print_line(words: &str) {
    use std::io::Write;
    _ = writeln!(std::io::stdout(), "{words}");
}

/// Whether there is a screen to open a window on. On Linux windows speak X11: `DISPLAY` must name a server that answers.
fn has_display() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    std::env::var("DISPLAY").is_ok_and(|display| answers(&display))
}

/// Whether an X server listens at `[host]:number[.screen]`.
#[cfg(unix)]
fn answers(display: &str) -> bool {
    use std::net::{TcpStream, ToSocketAddrs};
    use std::os::unix::net::UnixStream;
    let Some((host, rest)) = display.rsplit_once(':') else { return false };
    let Ok(number) = rest.split('.').next().unwrap_or_default().parse::<u16>() else { return false };
    if host.is_empty() || host == "unix" {
        // Where every X server listens, by the X11 protocol's transport (xtrans).
        let path = format!("/tmp/.X11-unix/X{number}");
        #[cfg(target_os = "linux")]
        {
            use std::os::linux::net::SocketAddrExt;
            let hidden = std::os::unix::net::SocketAddr::from_abstract_name(&path);
            if hidden.is_ok_and(|address| UnixStream::connect_addr(&address).is_ok()) {
                return true;
            }
        }
        return UnixStream::connect(path).is_ok();
    }
    let patience = std::time::Duration::from_secs(3);
    let Some(port) = number.checked_add(6000) else { return false };
    (host, port).to_socket_addrs().is_ok_and(|mut all| all.any(|address| TcpStream::connect_timeout(&address, patience).is_ok()))
}

#[cfg(not(unix))]
fn answers(_: &str) -> bool {
    true
}

/// Says which of the named files and folders cannot be written.
fn check_places(args: &PlayArgs) -> Result<(), String> {
    let named = |path: &Path| {
        let said = path.display().to_string();
        move |error: std::io::Error| format!("cannot write {said}: {error}")
    };
    for file in [&args.sound, &args.timings].into_iter().flatten() {
        check_writable(file).map_err(named(file))?;
    }
    let Some(folder) = args.record.as_deref() else { return Ok(()) };
    if folder.exists() && !folder.is_dir() {
        return Err(format!("cannot write to {}: it is no folder", folder.display()));
    }
    std::fs::create_dir_all(folder).map_err(named(folder))
}

/// Plays. Exit code 2 for wrong input, 1 for a failure.
pub fn run(args: &PlayArgs) -> ExitCode {
    let started = Instant::now();
    let fail = |error: &dyn std::fmt::Display, code: u8| {
        eprintln!("error: {error}");
        ExitCode::from(code)
    };
    let replay = match args
        .replay
        .as_deref()
        .map(|path| Replay::load(path).and_then(|replay| replay.scene(path, args.scene.as_deref()).map(|_| replay)))
    {
        None => None,
        Some(Ok(replay)) => Some(replay),
        Some(Err(error)) => return fail(&error, 2),
    };
    let scene = args.scene.as_deref().or(replay.as_ref().map(|replay| replay.scene.as_str()));
    let mut session = match Session::load(args.config.as_deref(), scene, args.seed) {
        Ok(session) => session,
        Err(error) => return fail(&error, 2),
    };
    // Who opens the game begins easily; a flight that is named is as elsewhere.
    let first = if args.scene.is_none() && !args.headless { Difficulty::Easy } else { Difficulty::default() };
    session.difficulty = args.difficulty.unwrap_or(first);
    session.set.clone_from(&args.set);
    // Clashes are said before anything is opened.
    let mut asked = session.config.clone();
    if let Err(error) = config::assign(&mut asked, &args.set) {
        return fail(&error, 2);
    }
    // As is what cannot be written.
    if let Err(error) = check_places(args) {
        return fail(&error, 1);
    }
    let without_window = args.headless || !has_display();
    if without_window && args.timings.is_none() {
        session.put_set();
    }
    if let Some(replay) = &replay {
        session.config = replay.config(&session.config);
        (session.difficulty, session.seed) = (replay.difficulty, replay.seed);
    }
    if without_window && !args.headless && args.timings.is_none() {
        print_line("There is no display that a window can be opened on: the demonstration flight is drawn to files instead.");
    }
    if let (Some(path), None, None) = (&args.sound, &args.record, args.frames) {
        warn_on_stderr();
        return match demonstration::sound(&session, args.pilot.unwrap_or_default(), replay.as_ref(), path) {
            Ok(([from, to], end, seconds)) => {
                print_line(&format!("The flight from T = {from:.1} to {to:.1} r_s/c: {end}.\nSound: {}, {seconds:.2} s.", path.display()));
                ExitCode::SUCCESS
            }
            Err(error) => fail(&error, 1),
        };
    }
    let gpu = match Gpu::headless() {
        Ok(gpu) => gpu,
        Err(error) => return fail(&error, 1),
    };
    if !without_window || args.timings.is_some() {
        // Bevy opens the adapter again; this one was to say in words what is missing.
        drop(gpu);
        let options = window::Options {
            pilot: args.pilot.or(args.autopilot.then_some(PilotKind::Expert)),
            size: args.size,
            frames: args.frames,
            record: args.record.clone(),
            replay,
            at_once: args.at_once,
            data: None,
            refused_link: false,
            verbose: args.verbose,
            timings: args.timings.clone().map(|file| (file, started)),
        };
        let exit = if without_window {
            window::run_unseen(session, &options, args.size.unwrap_or(demonstration::SIZE))
        } else {
            window::run(session, &options)
        };
        return match exit {
            bevy::app::AppExit::Success => ExitCode::SUCCESS,
            bevy::app::AppExit::Error(code) => ExitCode::from(code.get()),
        };
    }
    let flight = DemonstrationRequest {
        frames: args.frames.unwrap_or(demonstration::FRAMES),
        size: args.size.unwrap_or(demonstration::SIZE),
        folder: args.record.clone().unwrap_or_else(|| PathBuf::from("out")),
        pilot: args.pilot.unwrap_or_default(),
        replay,
        sound: args.sound.clone(),
    };
    warn_on_stderr();
    match demonstration::fly(&gpu, &session, &flight) {
        Ok(report) => {
            print_line(&report.to_string());
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error, 1),
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::answers;

    #[test]
    fn a_display_that_does_not_answer_is_none() {
        for display in ["", ":", ":x", "77", ":64999", "localhost:59999", "nowhere.invalid:0"] {
            assert!(!answers(display), "{display}");
        }
    }
}
