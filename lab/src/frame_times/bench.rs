//! Draws the frames that are timed.

use std::time::Instant;

use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::render::quality::ladder::ladder;
use lensrunner::render::quality::options::turned;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::settings::Settings;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::render::{Gpu, Renderer};
use lensrunner::scene::{GameConfig, Scene};

use super::parts::{PASS, PRESENTING, PROCESSOR, Part};
use super::times::{FrameTimes, Memory};
use crate::dial::moments::class_of;
use crate::offscreen::{processor_time, thread_time};

/// The format of the picture.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Frames in which a rationed aurora comes to its share: from all of its streaks to a sixteenth are a dozen steps.
const SETTLING: u32 = 24;
/// Frames before those that are timed: what is compiled and allocated is by then.
const WARMING: u32 = 3;

/// What all scenes are timed with.
pub(crate) struct Bench<'a> {
    pub gpu: Gpu,
    pub surroundings: &'a Surroundings,
    pub config: &'a GameConfig,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames of each scene.
    pub frames: u32,
    /// Hold the aurora to its share of a frame.
    pub rationed: bool,
    /// Draw on the fastest rung of automatic quality.
    pub fastest: bool,
}

/// A scene that is drawn.
struct Stand<'a> {
    bench: &'a Bench<'a>,
    renderer: Renderer,
    stage: Stage,
    settings: Settings,
    view: wgpu::TextureView,
    picture: wgpu::Texture,
    /// Where the picture is copied to, as a software driver does to show it.
    shown: wgpu::Buffer,
}

/// A frame that was drawn: milliseconds of the whole and of what the processor did.
struct Drawn {
    whole: f64,
    work: Vec<Part>,
}

impl Bench<'_> {
    /// Draws a scene from a moment on, a step of the clock between two frames, and times the frames one by one: a frame is submitted when
    /// the one before is done.
    pub fn time(&self, name: &str, scene: &Scene, mut moment: Moment) -> Result<FrameTimes, PictureError> {
        let mut stand = self.stand(scene);
        let settling = WARMING + if self.rationed { SETTLING } else { 0 };
        let mut times = FrameTimes::of(name);
        for number in 0..self.frames + settling {
            let start = (number == 0).then(Instant::now);
            let simulation = stand.advance(scene, &mut moment, 1);
            stand.frame(&moment, simulation, (number >= settling).then_some(&mut times))?;
            if let Some(start) = start {
                times.first = milliseconds(start);
            }
        }
        stand.finish(&mut times)?;
        Ok(times)
    }

    /// Flies a scene from its start for so many steps of the clock, and times `places` frames on the way, each after some that are not
    /// timed: what goes on beside the frames follows by then.
    pub fn fly(&self, name: &str, scene: &Scene, steps: u64, places: u32) -> Result<FrameTimes, PictureError> {
        let mut stand = self.stand(scene);
        let mut moment = Moment::new(scene, self.config, 0.0, 0);
        let mut times = FrameTimes::of(&format!("{name} from start to end"));
        let mut flown = 0;
        for place in 0..places {
            let start = (place == 0).then(Instant::now);
            let there = steps * u64::from(place) / u64::from(places.max(2) - 1);
            stand.advance(scene, &mut moment, there.saturating_sub(flown + u64::from(WARMING)));
            for frame in 0..WARMING {
                stand.frame(&moment, 0.0, None)?;
                if let (0, Some(start)) = (frame, start) {
                    times.first = milliseconds(start);
                }
                stand.advance(scene, &mut moment, u64::from(frame + 1 < WARMING));
            }
            let simulation = stand.advance(scene, &mut moment, 1);
            flown = there.max(flown + u64::from(WARMING));
            times.moments.push(moment.time());
            stand.frame(&moment, simulation, Some(&mut times))?;
        }
        stand.finish(&mut times)?;
        Ok(times)
    }

    fn stand(&self, scene: &Scene) -> Stand<'_> {
        let device = &self.gpu.device;
        let size = self.size;
        let (picture, view) = target(device, "bench", size, FORMAT);
        let shown = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("shown"),
            size: u64::from(row(size)) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut renderer = Renderer::new(&self.gpu, self.surroundings, FORMAT, size);
        // As in the window: splitting follows what earlier frames needed.
        renderer.set_counting(true);
        renderer.timing().set_timing(self.rationed);
        let stage = Stage::new(&mut renderer, scene, self.config).watched();
        let configured = settings(self.config);
        // As the game draws it: the player's own ship is not metered.
        let own_ship = scene.ships.iter().position(|ship| ship.player);
        let drawn = if self.fastest {
            let rungs = ladder(QualityCosts::shipped(), class_of(scene));
            rungs.last().map_or(configured, |rung| turned(&configured, &rung.steps))
        } else {
            configured
        };
        Stand { bench: self, renderer, stage, settings: Settings { own_ship, ..drawn }, view, picture, shown }
    }
}

impl Stand<'_> {
    /// Plays on, until the camera sees nothing any more; gives the milliseconds of it.
    fn advance(&self, scene: &Scene, moment: &mut Moment, steps: u64) -> f64 {
        let begin = Instant::now();
        for _ in 0..steps {
            let next = moment.time() + self.bench.config.clock.step;
            if scene.camera.check(next, &moment.ships()).is_err() {
                break;
            }
            moment.advance(1);
        }
        milliseconds(begin)
    }

    /// Draws one frame as it is played, and if it is timed once more pass by pass, and once more without bodies and aurora.
    fn frame(&mut self, moment: &Moment, simulation: f64, times: Option<&mut FrameTimes>) -> Result<(), PictureError> {
        self.renderer.timing().set_counting(times.is_none());
        let spent = processor_time();
        let begin = Instant::now();
        let camera = self.stage.camera(moment.time(), &moment.ships());
        let frame = self.stage.frame(camera, self.bench.size, moment.time(), &moment.histories(), None, &self.settings);
        let placing = milliseconds(begin);
        let mut drawn = self.draw(&frame)?;
        let processor = spent.zip(processor_time()).map(|(then, now)| now - then);
        if self.bench.rationed {
            self.stage.ration_aurora(self.renderer.timing().latest());
        }
        let Some(times) = times else {
            self.stage.reuse(frame);
            return Ok(());
        };
        drawn.work.splice(0..0, [(PROCESSOR, "simulation", simulation), (PROCESSOR, "instances and aurora", placing)]);
        drawn.whole += simulation + placing;
        let bare = FrameInput { placed: Vec::new(), held: None, aurora: None, ..frame.clone() };
        let alone = self.draw(&bare)?;
        self.renderer.timing().set_steps(&self.bench.gpu, true);
        self.draw(&frame)?;
        for (name, time) in self.renderer.timing().stepped() {
            drawn.work.push((if name == COPY { PRESENTING } else { PASS }, name, f64::from(time)));
        }
        self.renderer.timing().set_steps(&self.bench.gpu, false);
        times.parts.add(drawn.whole, &drawn.work);
        times.alone.push(alone.whole + simulation);
        times.processor.extend(processor);
        self.stage.reuse(frame);
        Ok(())
    }

    /// Draws one frame to its end.
    fn draw(&mut self, frame: &FrameInput) -> Result<Drawn, PictureError> {
        let Gpu { device, queue, .. } = &self.bench.gpu;
        let begin = Instant::now();
        if !self.renderer.prepare(frame) {
            return Err(self.bench.gpu.watch.complaint().map_or(PictureError::Nothing, PictureError::Device));
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        self.renderer.encode(&mut encoder, &self.view);
        let submitting = thread_time();
        let size = self.bench.size;
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.shown,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row(size)), rows_per_image: None },
            },
            self.picture.size(),
        );
        self.renderer.timing().step(&mut encoder, COPY);
        queue.submit([encoder.finish()]);
        // A software driver begins its own work meanwhile: this thread may have to wait for a processor.
        let submitted = thread_time() - submitting;
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
        let whole = milliseconds(begin);
        let work = self.renderer.timing().work().iter().map(|&(name, time)| (PROCESSOR, name, f64::from(time)));
        Ok(Drawn { whole, work: work.chain([(PROCESSOR, "submission", submitted)]).collect() })
    }

    /// What is known once all frames are drawn.
    fn finish(&mut self, times: &mut FrameTimes) -> Result<(), PictureError> {
        times.memory = self.bench.gpu.device.generate_allocator_report().map(|report| Memory::of(&report));
        times.fragments = self.renderer.timing().latest_fragments().to_vec();
        times.counters = self.renderer.counters()?;
        times.disk = self.renderer.disk_counters()?;
        times.strokes = self.renderer.aurora_strokes()?;
        Ok(())
    }
}

/// The name of the copy of the picture among the steps.
const COPY: &str = "copy of the picture";

/// Bytes of a row of the copy.
fn row(size: [u32; 2]) -> u32 {
    (4 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn milliseconds(begin: Instant) -> f64 {
    begin.elapsed().as_secs_f64() * 1e3
}
