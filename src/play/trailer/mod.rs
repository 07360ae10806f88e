//! The trailer: half a minute of the game as pictures and sound, made by one command. What it shows is the table in [`plan`].

pub mod plan;
pub mod score;
pub mod take;
pub mod title;

use std::path::PathBuf;

use thiserror::Error;

use crate::argument::whole;
use crate::play::demonstration::{FlightError, drawn, empty_folder, progress, write_png};
use crate::play::sound::file::{self, SoundFileError};
use crate::render::gpu::device::DeviceError;
use crate::render::gpu::readback::PictureError;
use crate::render::gpu::targets::target;
use crate::render::settings::Settings;
use crate::render::shot::surroundings;
use crate::render::stage::{Stage, settings};
use crate::render::{Gpu, Renderer};
use plan::{PARTS, Part, TITLE, TrailerMoment, smooth};
use take::{Take, TakeError};
use title::{Letters, Style};

/// Makes the trailer: thirty seconds of missions and scenes with sound, as numbered pictures and a WAV file.
#[derive(clap::Args, Clone, Debug)]
pub struct TrailerArgs {
    /// Where frames/frame-NNNNN.png and sound.wav go.
    #[arg(short, value_name = "DIR", default_value = "trailer")]
    pub output: PathBuf,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = crate::render::shot::size)]
    pub size: [u32; 2],
    /// Pictures a second.
    #[arg(long, value_name = "N", default_value_t = 24, allow_negative_numbers = true, value_parser = whole::<u32>(1, 120))]
    pub fps: u32,
    /// Length in seconds; all parts become longer or shorter.
    #[arg(long, value_name = "N", default_value_t = 30, allow_negative_numbers = true, value_parser = whole::<u32>(1, 300))]
    pub seconds: u32,
}

/// Why there is no trailer.
#[derive(Debug, Error)]
pub enum TrailerError {
    /// A part cannot be played.
    #[error(transparent)]
    Take(#[from] TakeError),
    /// There is nothing to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A picture did not come back from the GPU.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A picture could not be written.
    #[error(transparent)]
    Frame(#[from] FlightError),
    /// The sound could not be written.
    #[error(transparent)]
    Sound(#[from] SoundFileError),
}

/// Light of the picture behind the title, of 1.
const BEHIND_TITLE: f64 = 0.7;

/// Makes a film of these parts, at least one; how many pictures it has.
pub fn make(gpu: &Gpu, args: &TrailerArgs, parts: &[Part]) -> Result<u32, TrailerError> {
    let folder = args.output.join("frames");
    empty_folder(&folder)?;
    let mut takes = parts.iter().map(Take::play).collect::<Result<Vec<Take>, TakeError>>()?;
    let (frames, seconds) = (args.seconds * args.fps, f64::from(args.seconds));
    let (moments, each) = score::score(parts, &takes, seconds);
    file::write(&args.output.join("sound.wav"), &moments, each, &score::VOLUMES)?;
    let mut studio = Studio::new(gpu, args.size);
    let bar = progress("trailer", frames);
    for index in 0..frames {
        let moment = TrailerMoment::at(parts, f64::from(index) / f64::from(frames), seconds);
        let (Some(take), Some(part)) = (takes.get_mut(moment.part), parts.get(moment.part)) else { continue };
        let mut rgb = studio.picture(take, &moment, 1.0 / f64::from(args.fps))?;
        finish(&mut studio.letters, part, &moment, args.size, &mut rgb);
        write_png(&folder.join(format!("frame-{index:05}.png")), args.size, &rgb, None)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(frames)
}

/// Makes it and says so.
pub fn run(args: &TrailerArgs) -> Result<String, TrailerError> {
    let frames = make(&Gpu::headless()?, args, &PARTS)?;
    let [width, height] = args.size;
    Ok(format!("{}: {frames} pictures of {width}x{height}, {} s", args.output.display(), args.seconds))
}

/// What draws.
struct Studio<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    size: [u32; 2],
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    letters: Letters,
    /// The part that is on the stage.
    set: Option<(usize, Stage, Settings)>,
}

impl Studio<'_> {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Studio<'_> {
        let colours = wgpu::TextureFormat::Rgba8UnormSrgb;
        let renderer = Renderer::new(gpu, &surroundings(), colours, size);
        let (texture, view) = target(&gpu.device, "trailer", size, colours);
        Studio { gpu, renderer, size, texture, view, letters: Letters::default(), set: None }
    }

    /// The picture of a moment, RGB; `seconds` have passed since the one before.
    fn picture(&mut self, take: &mut Take, moment: &TrailerMoment, seconds: f64) -> Result<Vec<u8>, PictureError> {
        let config = &take.session.config;
        let (mut stage, mut settings) = match self.set.take() {
            Some((part, stage, settings)) if part == moment.part => {
                // From the second picture on the eye adapts.
                let adaptation = (1.0 - (-config.render.exposure_speed * seconds).exp2()) as f32;
                (stage, Settings { adaptation, ..settings })
            }
            _ => {
                let stage = Stage::new(&mut self.renderer, &take.session.scene, &take.session.effective());
                // Only a ship that is marked as the player's is lit for the picture.
                let own_ship = take.session.scene.ships.iter().position(|ship| ship.player);
                let engines = Some([config.ship.thrust, config.enemy.thrust]);
                (stage, Settings { own_ship, engines, ..settings(config) })
            }
        };
        let (camera, hidden) = take.camera(&stage, moment);
        let frame = stage.frame(camera, self.size, moment.time, &take.histories(), hidden, &settings);
        let rgba = drawn(self.gpu, &mut self.renderer, &frame, (&self.texture, &self.view))?;
        settings.adaptation = 1.0;
        self.set = Some((moment.part, stage, settings));
        Ok(rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect())
    }
}

/// Fades, and writes the words.
fn finish(letters: &mut Letters, part: &Part, moment: &TrailerMoment, size: [u32; 2], rgb: &mut [u8]) {
    // The title comes after the first third of the last part.
    let title = if moment.is_last { smooth((moment.share - 0.3) / 0.25) } else { 0.0 };
    let light = moment.light * (1.0 + (BEHIND_TITLE - 1.0) * title);
    rgb.iter_mut().for_each(|channel| *channel = (f64::from(*channel) * light).round() as u8);
    let line = Style { height: 0.06, at: 0.88, spread: 0.04, strength: moment.light * smooth(moment.share / 0.3) };
    letters.write(part.line, &line, size, rgb);
    if title > 0.0 {
        let strength = moment.light * title;
        letters.write(TITLE[0], &Style { height: 0.17, at: 0.26, spread: 0.22, strength }, size, rgb);
        letters.write(TITLE[1], &Style { height: 0.055, at: 0.4, spread: 0.06, strength }, size, rgb);
    }
}
