//! The demonstration flight: the autopilot plays the chase, and the flight is drawn to PNG files. It needs no display.

pub mod sheet;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;
use web_time::Instant;

use bevy::prelude::*;
use indicatif::{ProgressBar, ProgressStyle};
use thiserror::Error;

use crate::picture_file;
use crate::render::frame::FrameInput;
use crate::render::gpu::readback::{self, PictureError};
use crate::render::gpu::targets::target;
use crate::render::settings::greatest_rise;
use crate::render::shot::surroundings;
use crate::render::stage::{Stage, settings};
use crate::render::{Gpu, Renderer};
use crate::scene::pilot_kind::PilotKind;
use crate::sim::bolts::Bolts;
use crate::sim::replay::Replay;
use crate::sim::snapshot::{FrameCamera, Snapshot, step_after};
use crate::sim::{Clock, Fleet, History, outcome};
use crate::sim::{app_of, board};
use crate::user_file::write_whole;

use crate::play::camera::director::{Cast, Director};
use crate::play::demonstration::sheet::ContactSheet;
use crate::play::session::Session;
use crate::play::sound::file::SoundFileError;
use crate::play::sound::record::Recorder;

/// Frames, unless asked otherwise.
pub const FRAMES: u32 = 240;
/// Size, unless asked otherwise.
pub const SIZE: [u32; 2] = [640, 360];
/// The shortest and the longest flight shown, in r_s/c of T.
const SPAN: (f64, f64) = (20.0, 100.0);
/// What is shown after the chase is decided, in r_s/c of T.
const AFTERWARDS: f64 = 3.0;

/// What to draw.
#[derive(Clone, Debug)]
pub struct DemonstrationRequest {
    /// How many frames.
    pub frames: u32,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Where they go.
    pub folder: PathBuf,
    /// Who flies the player's ship.
    pub pilot: PilotKind,
    /// The flight that is shown; without it that of the pilot.
    pub replay: Option<Replay>,
    /// The WAV file of its sound, if one is wanted.
    pub sound: Option<PathBuf>,
}

/// Why the flight was not drawn.
#[derive(Debug, Error)]
pub enum FlightError {
    /// A picture did not come back from the GPU.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The sound could not be written.
    #[error(transparent)]
    Sound(#[from] SoundFileError),
    /// A file could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// How it went.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Where the frames are.
    pub frames: PathBuf,
    /// The contact sheet.
    pub sheet: PathBuf,
    /// From what T to what T it goes, in r_s/c.
    pub span: [f64; 2],
    /// How the chase ended, in words.
    pub end: String,
    /// Mean and worst time of a frame, from its camera to its pixels in memory, in milliseconds; the first is left out, it compiles.
    pub milliseconds: [f64; 2],
    /// Frames written per second, everything included.
    pub rate: f64,
    /// Passes of one of the last frames on the GPU with their milliseconds, where it has timestamps.
    pub passes: Vec<(&'static str, f32)>,
    /// Length of the sound in seconds, if it was wanted: that of the frames at the game's pace.
    pub sound: Option<f64>,
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [from, to] = self.span;
        let [mean, worst] = self.milliseconds;
        writeln!(f, "The flight from T = {from:.1} to {to:.1} r_s/c: {}.", self.end)?;
        writeln!(f, "Frames: {}", self.frames.display())?;
        writeln!(f, "Contact sheet: {}", self.sheet.display())?;
        if let Some(seconds) = self.sound {
            writeln!(f, "Sound: {seconds:.2} s, as long as the flight at the game's pace.")?;
        }
        write!(f, "A frame took {mean:.1} ms in the mean, {worst:.1} ms at worst; {:.1} frames a second with writing.", self.rate)?;
        if !self.passes.is_empty() {
            let passes: Vec<String> = self.passes.iter().map(|(name, time)| format!("{name} {time:.1}")).collect();
            write!(f, "\nPasses of a late frame, in ms: {}.", passes.join(", "))?;
        }
        Ok(())
    }
}

/// Plays the chase without graphics, then draws it.
pub fn fly(gpu: &Gpu, session: &Session, flight: &DemonstrationRequest) -> Result<Report, FlightError> {
    let mut recorder = flight.sound.is_some().then(|| Recorder::new(session));
    let (world, span, end) = play(session, flight.pilot, flight.replay.as_ref(), recorder.as_mut());
    // Before the pictures, which take longer, so that what cannot be written is said soon.
    let sound = recorder.zip(flight.sound.as_ref()).map(|(recorder, path)| recorder.write(path, span[0])).transpose()?;
    let names: Vec<Entity> = world.world().resource::<Fleet>().0.clone();
    let mut histories: Vec<&History> = names.iter().filter_map(|&ship| world.world().get::<History>(ship)).collect();
    let cast = cast(session, &histories);
    // No ghost flies along; bolts come after it.
    let nobody = History::nobody();
    histories.push(&nobody);
    histories.extend(world.world().resource::<Bolts>().0.iter().map(|bolt| &bolt.history));

    let frames_folder = flight.folder.join("frames");
    empty_folder(&frames_folder)?;
    let mut renderer = Renderer::new(gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, flight.size);
    let mut stage = Stage::new(&mut renderer, &session.scene, &session.effective());
    let (texture, view) = target(&gpu.device, "flight", flight.size, wgpu::TextureFormat::Rgba8UnormSrgb);
    let mut settings = settings(&session.config);
    settings.own_ship = Some(session.player());
    settings.engines = Some([session.config.ship.thrust, session.config.enemy.thrust]);
    let mut director = Director::default();
    let own = || Replay::begin(&session.scene, &session.config, session.difficulty, flight.pilot, session.seed);
    let shown = flight.replay.clone().unwrap_or_else(own);
    let step = world.world().resource::<Clock>().step;

    let sheet_file = flight.folder.join("contact-sheet.png");
    let writer = Writer::start(frames_folder.clone(), sheet_file.clone(), flight.size, flight.frames);
    let bar = progress("demonstration flight", flight.frames);
    let started = Instant::now();
    let mut times = Vec::new();
    let mut passes = Vec::new();
    let seconds = (span[1] - span[0]) / f64::from(flight.frames) / session.config.clock.pace;
    settings.rise = greatest_rise(session.config.accessibility.reduced_flashes, seconds);
    for index in 0..flight.frames {
        let began = Instant::now();
        let share = f64::from(index) / f64::from((flight.frames - 1).max(1));
        let time = span[0] + (span[1] - span[0]) * share;
        let (camera, hidden) = director.camera(&cast, time, share, session.config.video.fov.to_radians());
        let frame = stage.frame(camera, flight.size, time, &histories, hidden, &settings);
        let pixels = drawn(gpu, &mut renderer, &frame, (&texture, &view))?;
        times.push(began.elapsed().as_secs_f64() * 1e3);
        passes = renderer.timing().latest().to_vec();
        // From the second frame on the eye adapts, by the time that passes for a player.
        settings.adaptation = (1.0 - (-session.config.render.exposure_speed * seconds).exp2()) as f32;
        let shot = FrameCamera { camera, hidden, lit: settings.own_ship };
        let flown = shown.up_to(step_after(time, step) as u64, world.world());
        let snapshot = Snapshot::new(flown, &session.scene, &session.config, world.world(), time, shot, flight.size);
        if !writer.send(index, pixels, snapshot) {
            break;
        }
        bar.inc(1);
    }
    writer.finish()?;
    bar.finish_and_clear();

    let rest = if times.len() > 1 { &times[1..] } else { &times[..] };
    Ok(Report {
        frames: frames_folder,
        sheet: sheet_file,
        span,
        end,
        milliseconds: [rest.iter().sum::<f64>() / rest.len() as f64, rest.iter().copied().fold(0.0, f64::max)],
        rate: f64::from(flight.frames) / started.elapsed().as_secs_f64(),
        passes,
        sound,
    })
}

/// Plays the chase and writes its sound alone: neither pictures nor a GPU. From what T to what T it goes (r_s/c), how it ended, and the
/// length of the sound in seconds.
pub fn sound(session: &Session, pilot: PilotKind, replay: Option<&Replay>, path: &Path) -> Result<([f64; 2], String, f64), SoundFileError> {
    let mut recorder = Recorder::new(session);
    let (_, span, end) = play(session, pilot, replay, Some(&mut recorder));
    Ok((span, end, recorder.write(path, span[0])?))
}

/// The ships that the director follows.
fn cast<'a>(session: &Session, histories: &[&'a History]) -> Cast<'a> {
    let of = |ship: usize| (histories[ship], session.length(ship));
    let hunter = session.player();
    Cast { hunter: of(hunter), quarry: session.target().map(of), hunter_index: hunter }
}

/// Draws a frame into a texture and brings it back: RGBA, 4 bytes a pixel.
pub fn drawn(
    gpu: &Gpu,
    renderer: &mut Renderer,
    frame: &FrameInput,
    (texture, view): (&wgpu::Texture, &wgpu::TextureView),
) -> Result<Vec<u8>, PictureError> {
    renderer.prepare(frame);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.encode(&mut encoder, view);
    gpu.queue.submit([encoder.finish()]);
    readback::texture(gpu, texture, 4)
}

/// A bar on the terminal that counts the frames of `what`.
pub fn progress(what: &str, frames: u32) -> ProgressBar {
    let bar = ProgressBar::new(u64::from(frames));
    match ProgressStyle::with_template(&format!("{what} {{wide_bar}} {{pos}}/{{len}} frames, {{eta}} left")) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Plays the chase to its end, with somebody who listens; the app, the span to show, and how it ended.
fn play(session: &Session, pilot: PilotKind, replay: Option<&Replay>, mut recorder: Option<&mut Recorder>) -> (App, [f64; 2], String) {
    let config = session.effective();
    let mut app = match replay {
        Some(replay) => replay.app(&session.scene, &session.config),
        None => {
            let mut app = app_of(&session.scene, &config, session.seed);
            board(app.world_mut(), pilot);
            app
        }
    };
    // Of a replay all is shown.
    let longest = if replay.is_some() { f64::INFINITY } else { SPAN.1 };
    let limit = session.scene.rules(&config).time_limit;
    loop {
        app.world_mut().run_schedule(FixedUpdate);
        if let Some(recorder) = &mut recorder {
            recorder.listen(app.world());
        }
        let now = app.world().resource::<Clock>().time;
        let decided = outcome(app.world());
        let until = decided.map_or(limit, |(_, at)| at + AFTERWARDS).max(SPAN.0);
        if now >= until {
            let end = decided.map_or("undecided".to_owned(), |(outcome, at)| format!("{outcome} at T = {at:.1}"));
            return (app, [(now - longest).max(0.0), now], end);
        }
    }
}

/// Makes the folder, without frames of an earlier flight.
pub fn empty_folder(folder: &Path) -> Result<(), FlightError> {
    let failed = |error: std::io::Error| FlightError::Write { path: folder.to_path_buf(), reason: error.to_string() };
    fs::create_dir_all(folder).map_err(failed)?;
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.starts_with("frame-") && name.ends_with(".png") {
            fs::remove_file(&path).map_err(failed)?;
        }
    }
    Ok(())
}

/// A thread that writes pictures, so that drawing goes on meanwhile.
struct Writer {
    queue: SyncSender<(u32, Vec<u8>, Snapshot)>,
    thread: JoinHandle<Result<(), FlightError>>,
}

impl Writer {
    fn start(folder: PathBuf, sheet_file: PathBuf, size: [u32; 2], frames: u32) -> Writer {
        // Few frames wait, so that memory stays small if the disk is slow.
        let (queue, pictures) = sync_channel::<(u32, Vec<u8>, Snapshot)>(8);
        let thread = std::thread::spawn(move || {
            let mut sheet = ContactSheet::new(size, frames);
            let chosen = ContactSheet::chosen(frames);
            for (index, rgba, snapshot) in pictures {
                for (place, _) in chosen.iter().enumerate().filter(|(_, frame)| **frame == index) {
                    sheet.put(place as u32, size, &rgba);
                }
                let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
                write_png(&folder.join(format!("frame-{index:05}.png")), size, &rgb, Some(&snapshot.to_text()))?;
            }
            write_png(&sheet_file, sheet.size(), sheet.pixels(), None)
        });
        Writer { queue, thread }
    }

    /// Hands a picture over; false if writing has failed.
    fn send(&self, index: u32, rgba: Vec<u8>, snapshot: Snapshot) -> bool {
        self.queue.send((index, rgba, snapshot)).is_ok()
    }

    fn finish(self) -> Result<(), FlightError> {
        drop(self.queue);
        self.thread
            .join()
            .unwrap_or_else(|_| Err(FlightError::Write { path: PathBuf::new(), reason: "the writing thread ended early".into() }))
    }
}

/// Writes RGB pixels as PNG, quickly rather than small, with a text in it.
pub fn write_png(path: &Path, size: [u32; 2], rgb: &[u8], text: Option<&str>) -> Result<(), FlightError> {
    let failed = |reason: String| FlightError::Write { path: path.to_path_buf(), reason };
    let bytes = picture_file::png(rgb, size, true, text).map_err(failed)?;
    write_whole(path, &bytes).map_err(|error| failed(error.to_string()))
}
