//! The demonstration flight: the autopilot plays the chase, and the flight is drawn to PNG files. It needs no display.

pub mod sheet;

use std::fs;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Instant;

use bevy::prelude::*;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use indicatif::{ProgressBar, ProgressStyle};
use thiserror::Error;

use crate::render::gpu::readback::{self, PictureError};
use crate::render::gpu::targets::target;
use crate::render::shot::surroundings;
use crate::render::stage::{Stage, settings};
use crate::render::{Gpu, Renderer};
use crate::sim::app_of;
use crate::sim::bolts::Bolts;
use crate::sim::replay::Replay;
use crate::sim::{Clock, Fleet, History, outcome};

use crate::play::camera::director::{Cast, Director};
use crate::play::demonstration::sheet::Sheet;
use crate::play::missions::nobody;
use crate::play::session::Session;

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
    /// The flight that is shown; without it the autopilot's.
    pub replay: Option<Replay>,
}

/// Why the flight was not drawn.
#[derive(Debug, Error)]
pub enum FlightError {
    /// A picture did not come back from the GPU.
    #[error(transparent)]
    Picture(#[from] PictureError),
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
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [from, to] = self.span;
        let [mean, worst] = self.milliseconds;
        writeln!(f, "The flight from T = {from:.1} to {to:.1} r_s/c: {}.", self.end)?;
        writeln!(f, "Frames: {}", self.frames.display())?;
        writeln!(f, "Contact sheet: {}", self.sheet.display())?;
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
    let (world, span, end) = play(session, flight.replay.as_ref());
    let names: Vec<Entity> = world.world().resource::<Fleet>().0.clone();
    let mut histories: Vec<&History> = names.iter().filter_map(|&ship| world.world().get::<History>(ship)).collect();
    let cast = cast(session, &histories);
    // No ghost flies along; bolts come after it.
    let nobody = nobody();
    histories.push(&nobody);
    histories.extend(world.world().resource::<Bolts>().0.iter().map(|bolt| &bolt.history));

    let frames_folder = flight.folder.join("frames");
    empty_folder(&frames_folder)?;
    let mut renderer = Renderer::new(gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, flight.size);
    let stage = Stage::new(&mut renderer, &session.scene, &session.effective());
    let (texture, view) = target(&gpu.device, "flight", flight.size, wgpu::TextureFormat::Rgba8UnormSrgb);
    let mut settings = settings(&session.config);
    settings.own_ship = Some(session.player());
    settings.engines = Some([session.config.ship.thrust, session.config.enemy.thrust]);
    let mut director = Director::default();

    let sheet_file = flight.folder.join("contact-sheet.png");
    let writer = Writer::start(frames_folder.clone(), sheet_file.clone(), flight.size, flight.frames);
    let bar = progress(flight.frames);
    let started = Instant::now();
    let mut times = Vec::new();
    let mut passes = Vec::new();
    for index in 0..flight.frames {
        let began = Instant::now();
        let share = f64::from(index) / f64::from((flight.frames - 1).max(1));
        let time = span[0] + (span[1] - span[0]) * share;
        let (camera, hidden) = director.camera(&cast, time, share, session.config.video.fov.to_radians());
        let frame = stage.frame(camera, flight.size, time, &histories, hidden, &settings);
        renderer.prepare(&frame);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder, &view);
        gpu.queue.submit([encoder.finish()]);
        let pixels = readback::texture(gpu, &texture, 4)?;
        times.push(began.elapsed().as_secs_f64() * 1e3);
        passes = renderer.timing().latest().to_vec();
        // From the second frame on the eye adapts, by the time that passes for a player.
        let seconds = (span[1] - span[0]) / f64::from(flight.frames) / session.config.clock.pace;
        settings.adaptation = (1.0 - (-session.config.render.exposure_speed * seconds).exp2()) as f32;
        if !writer.send(index, pixels) {
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
    })
}

/// The ships that the director follows.
fn cast<'a>(session: &Session, histories: &[&'a History]) -> Cast<'a> {
    let of = |ship: usize| (histories[ship], session.length(ship));
    let hunter = session.player();
    Cast { hunter: of(hunter), quarry: session.target().map(of), hunter_index: hunter }
}

fn progress(frames: u32) -> ProgressBar {
    let bar = ProgressBar::new(u64::from(frames));
    match ProgressStyle::with_template("demonstration flight {wide_bar} {pos}/{len} frames, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Plays the chase to its end; the app, the span to show, and how it ended.
fn play(session: &Session, replay: Option<&Replay>) -> (App, [f64; 2], String) {
    let config = session.effective();
    let mut app = match replay {
        Some(replay) => replay.app(&session.scene, &session.config),
        None => app_of(&session.scene, &config, session.seed),
    };
    // Of a replay all is shown.
    let longest = if replay.is_some() { f64::INFINITY } else { SPAN.1 };
    let limit = session.scene.rules(&config).time_limit;
    loop {
        app.world_mut().run_schedule(FixedUpdate);
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
fn empty_folder(folder: &Path) -> Result<(), FlightError> {
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
    queue: SyncSender<(u32, Vec<u8>)>,
    thread: JoinHandle<Result<(), FlightError>>,
}

impl Writer {
    fn start(folder: PathBuf, sheet_file: PathBuf, size: [u32; 2], frames: u32) -> Writer {
        // Few frames wait, so that memory stays small if the disk is slow.
        let (queue, pictures) = sync_channel::<(u32, Vec<u8>)>(8);
        let thread = std::thread::spawn(move || {
            let mut sheet = Sheet::new(size, frames);
            let chosen = Sheet::chosen(frames);
            for (index, rgba) in pictures {
                for (place, _) in chosen.iter().enumerate().filter(|(_, frame)| **frame == index) {
                    sheet.put(place as u32, size, &rgba);
                }
                let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
                write_png(&folder.join(format!("frame-{index:05}.png")), size, &rgb)?;
            }
            write_png(&sheet_file, sheet.size(), sheet.pixels())
        });
        Writer { queue, thread }
    }

    /// Hands a picture over; false if writing has failed.
    fn send(&self, index: u32, rgba: Vec<u8>) -> bool {
        self.queue.send((index, rgba)).is_ok()
    }

    fn finish(self) -> Result<(), FlightError> {
        drop(self.queue);
        self.thread
            .join()
            .unwrap_or_else(|_| Err(FlightError::Write { path: PathBuf::new(), reason: "the writing thread ended early".into() }))
    }
}

/// Writes RGB pixels as PNG, quickly rather than small.
pub fn write_png(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<(), FlightError> {
    let failed = |reason: String| FlightError::Write { path: path.to_path_buf(), reason };
    let file = fs::File::create(path).map_err(|error| failed(error.to_string()))?;
    PngEncoder::new_with_quality(BufWriter::new(file), CompressionType::Fast, FilterType::Sub)
        .write_image(rgb, size[0], size[1], ExtendedColorType::Rgb8)
        .map_err(|error| failed(error.to_string()))
}
