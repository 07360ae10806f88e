//! A tour of the interface without a display: every screen and page, drawn as a player sees it, in each language and at each size.

mod stops;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::TimeUpdateStrategy;

use crate::play::choices::Choices;
use crate::play::picture::stage_loading::CurrentStage;
use crate::play::session::{Session, SessionError};
use crate::play::window::interface::DrawnOn;
use crate::play::window::{Options, OutputSurface, app};
use crate::render::Gpu;
use crate::render::gpu::device::DeviceError;
use crate::scene::Difficulty;
use crate::scene::config::{Value, setting};
use stops::STOPS;

/// Draws every screen of the game, in English and Japanese, as pictures.
#[derive(clap::Args, Clone, Debug)]
pub struct TourArgs {
    /// The folder for the pictures, `LANGUAGE-WIDTHxHEIGHT-NAME.jpg`.
    #[arg(short, value_name = "DIR", default_value = "docs/screens")]
    output: PathBuf,
    /// Width and height in pixels; may be repeated [default: 1280x720 and 1920x1080].
    #[arg(long, value_name = "WxH", value_parser = crate::render::shot::size)]
    size: Vec<[u32; 2]>,
    /// en or ja; both without it.
    #[arg(long, value_name = "LANGUAGE", value_parser = ["en", "ja"])]
    language: Option<String>,
    /// Size of all text and panels, 0.8 to 2.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    text_size: f64,
    /// Only screens whose name contains this.
    #[arg(long, value_name = "WORD")]
    only: Option<String>,
}

/// Why there are no pictures.
#[derive(Debug, thiserror::Error)]
pub enum TourError {
    /// There is no device to draw with.
    #[error(transparent)]
    Gpu(#[from] DeviceError),
    /// The game's own files are wrong.
    #[error(transparent)]
    Session(#[from] SessionError),
    /// A setting out of range.
    #[error("--text-size: {0}")]
    TextSize(String),
    /// A picture could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A picture did not come.
    #[error("the picture of {0} did not come")]
    NoPicture(&'static str),
}

/// Frames until what was changed is on the picture: one for the entries, one to measure, one for the letters, two on their way.
const FRAMES: u32 = 5;
/// Frames after which a picture that has not come will not come: the scene is loaded and the pipelines are compiled meanwhile.
const PATIENCE: u32 = 2000;
/// Time that passes in a frame, in seconds.
const FRAME: f64 = 1.0 / 20.0;

/// Draws all of them; how many.
pub fn draw(args: &TourArgs) -> Result<usize, TourError> {
    // In words, before Bevy opens the device again.
    drop(Gpu::headless()?);
    std::fs::create_dir_all(&args.output).map_err(|error| TourError::Write { path: args.output.clone(), reason: error.to_string() })?;
    let sizes = if args.size.is_empty() { vec![[1280, 720], [1920, 1080]] } else { args.size.clone() };
    let mut count = 0;
    for language in ["en", "ja"].into_iter().filter(|language| args.language.as_ref().is_none_or(|only| only == language)) {
        for &size in &sizes {
            count += visit(args, language, size)?;
        }
    }
    Ok(count)
}

/// One tour.
fn visit(args: &TourArgs, language: &str, size: [u32; 2]) -> Result<usize, TourError> {
    let mut session = Session::load(None, None, Some(5))?;
    session.difficulty = Difficulty::Easy;
    for (path, value) in [("interface.language", Value::Word(language.into())), ("accessibility.text_size", Value::Number(args.text_size))]
    {
        let Some(setting) = setting(path) else { continue };
        setting.set(&mut session.config, value).map_err(TourError::TextSize)?;
    }
    let mut app = app(session, &Options::default(), OutputSurface::Picture(size), Choices::default());
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)));
    app.finish();
    app.cleanup();
    let mut count = 0;
    for stop in STOPS {
        (stop.act)(&mut app);
        wait_for_scene(&mut app);
        if args.only.as_ref().is_some_and(|only| !stop.name.contains(only.as_str())) {
            app.update();
            continue;
        }
        for _ in 0..FRAMES {
            app.update();
        }
        let [width, height] = size;
        take(&mut app, stop.name, &args.output.join(format!("{language}-{width}x{height}-{}.jpg", stop.name)))?;
        count += 1;
    }
    Ok(count)
}

/// Goes on until the scene is there, which is made on threads.
pub fn wait_for_scene(app: &mut App) {
    /// Looks, and the wall time between two: a minute in all.
    const LOOKS: (u32, Duration) = (6000, Duration::from_millis(10));
    app.update();
    for _ in 0..LOOKS.0 {
        if app.world().contains_resource::<CurrentStage>() {
            return;
        }
        std::thread::sleep(LOOKS.1);
        app.update();
    }
}

/// Writes what is drawn.
fn take(app: &mut App, name: &'static str, path: &Path) -> Result<(), TourError> {
    let Some(DrawnOn(image)) = app.world().get_resource::<DrawnOn>().cloned() else { return Err(TourError::NoPicture(name)) };
    let (sender, receiver) = channel();
    app.world_mut()
        .spawn(Screenshot::image(image))
        .observe(move |captured: On<ScreenshotCaptured>| _ = sender.send(captured.image.clone()));
    let image = wait(app, &receiver).ok_or(TourError::NoPicture(name))?;
    let wrong = |reason: String| TourError::Write { path: path.to_path_buf(), reason };
    let picture = image.try_into_dynamic().map_err(|error| wrong(error.to_string()))?.to_rgb8();
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).map_err(|error| wrong(error.to_string()))?);
    // Good enough to read every letter; a tenth of the bytes of a PNG with stars.
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut file, 65);
    picture.write_with_encoder(encoder).map_err(|error| wrong(error.to_string()))
}

fn wait(app: &mut App, receiver: &Receiver<Image>) -> Option<Image> {
    for _ in 0..PATIENCE {
        app.update();
        if let Ok(image) = receiver.try_recv() {
            return Some(image);
        }
    }
    None
}
