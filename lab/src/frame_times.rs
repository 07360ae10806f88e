//! How long whole frames of a scene take, and their passes: `lensrunner-lab chart frame`.

use std::fmt;
use std::io::Write;
use std::time::{Duration, Instant};

use lensrunner::scene::{self, GameConfig, Scene};

use lensrunner::render::aurora::ration::shares;
use lensrunner::render::disk::types::DiskCounters;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::gpu::types::Counters;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::shot::{Moment, ShotError, surroundings};
use lensrunner::render::stage::{Stage, settings};
use lensrunner::render::{Gpu, Renderer};

/// What to time.
#[derive(Clone, Debug)]
pub struct FrameTimesRequest {
    /// Names or files of scenes.
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames that are timed, after two that are not.
    pub frames: u32,
    /// T of the frames, in r_s/c.
    pub at: f64,
    /// Whether the aurora is held to its share of a frame, as in the window; it is given `SETTLING` frames more for that.
    pub rationed: bool,
}

/// Frames in which a rationed aurora comes to its share: from all of its streaks to a sixteenth are a dozen steps.
const SETTLING: u32 = 24;

/// One scene's times, in milliseconds.
#[derive(Clone, Debug)]
pub struct FrameTimes {
    /// The scene.
    pub scene: String,
    /// From the first frame asked for to its end: pipelines are compiled, models uploaded.
    pub first: f64,
    /// Whole frames from preparation to the end of the GPU's work: the least, the median, the greatest.
    pub whole: [f64; 3],
    /// Of that the median on the processor, before submission.
    pub prepare: f64,
    /// Processor time of all threads for a frame, where the system tells it: on a software driver it says more than the clock does when
    /// other programs run.
    pub processor: Option<f64>,
    /// Median and least of each pass by the GPU's timestamps, where it has them.
    pub passes: Vec<(&'static str, [f64; 2])>,
    /// Fragments that passes shaded, where the GPU counts them.
    pub fragments: Vec<(&'static str, u64)>,
    /// What the stages of the geometry counted in the last frame.
    pub counters: Counters,
    /// And those of the disk, where it is one of arcs.
    pub disk: Option<DiskCounters>,
    /// Strokes of the aurora in it, by level of the pyramid.
    pub strokes: Option<Vec<u32>>,
}

impl fmt::Display for FrameTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [least, median, most] = self.whole;
        write!(f, "{}: median {median:.1} ms (least {least:.1}, greatest {most:.1}; first {:.0}", self.scene, self.first)?;
        write!(f, ", of each {:.1} before submission", self.prepare)?;
        if let Some(time) = self.processor {
            write!(f, "; {time:.0} of processor time")?;
        }
        write!(f, ")")?;
        for (label, [median, least]) in &self.passes {
            write!(f, "\n  {label:<12} {median:8.2} ms (least {least:.2})")?;
            if let Some((_, count)) = self.fragments.iter().find(|(known, _)| known == label) {
                write!(f, ", {count} fragments")?;
            }
        }
        write!(f, "\n  {}", self.counters)?;
        if let Some(complaint) = self.counters.complaint() {
            write!(f, "\n  {complaint}")?;
        }
        if let Some(disk) = &self.disk {
            write!(f, "\n  {disk}")?;
        }
        let passes: Vec<(&str, f32)> = self.passes.iter().map(|&(label, [median, _])| (label, median as f32)).collect();
        if let ([aurora, rest], Some(strokes)) = (shares(&passes), &self.strokes) {
            write!(f, "\n  the aurora takes {:.2} of the passes' time", aurora / (aurora + rest))?;
            let levels: Vec<String> = strokes.iter().map(u32::to_string).collect();
            write!(f, "\n  {} strokes of the aurora (each level of half the size: {})", strokes.iter().sum::<u32>(), levels.join(", "))?;
        }
        Ok(())
    }
}

/// Times the scenes one after the other and says each result as it comes. What is wrong with any of them is said before the first is drawn.
pub fn run(request: &FrameTimesRequest, config: &GameConfig, out: &mut impl Write) -> Result<(), ShotError> {
    let played = |name: &String| -> Result<(Scene, Moment), ShotError> {
        let scene = scene::load(name)?;
        let moment = Moment::new(&scene, config, request.at, 0);
        scene.camera.check(moment.time(), &moment.ships())?;
        Ok((scene, moment))
    };
    let scenes: Vec<_> = request.scenes.iter().map(played).collect::<Result<_, _>>()?;
    let bench = Bench { gpu: Gpu::headless()?, surroundings: surroundings(), request, config };
    let [width, height] = request.size;
    let say = |error: std::io::Error| PictureError::Write { path: "standard output".into(), reason: error.to_string() };
    writeln!(out, "{}, {width}x{height}, {} frames", bench.gpu.adapter.name, request.frames).map_err(say)?;
    for (name, (scene, moment)) in request.scenes.iter().zip(&scenes) {
        let times = bench.time(name, scene, moment)?;
        writeln!(out, "{times}").map_err(say)?;
    }
    Ok(())
}

/// What all scenes are timed with.
struct Bench<'a> {
    gpu: Gpu,
    surroundings: Surroundings,
    request: &'a FrameTimesRequest,
    config: &'a GameConfig,
}

impl Bench<'_> {
    /// Draws a scene at a moment again and again and times the frames one by one: a frame is submitted when the one before is done.
    fn time(&self, name: &str, scene: &Scene, moment: &Moment) -> Result<FrameTimes, ShotError> {
        let Bench { gpu, request, config, .. } = self;
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let (_, view) = target(&gpu.device, "bench", request.size, format);
        let start = Instant::now();
        let mut renderer = Renderer::new(gpu, &self.surroundings, format, request.size);
        let stage = Stage::new(&mut renderer, scene, config);
        let camera = stage.camera(moment.time(), &moment.ships());
        let mut taken = Taken::default();
        let mut first = 0.0;
        let mut spent = None;
        let settling = 2 + if request.rationed { SETTLING } else { 0 };
        for number in 0..request.frames + settling {
            let begin = Instant::now();
            let frame = stage.frame(camera, request.size, moment.time(), &moment.histories(), None, &settings(config));
            renderer.timing().set_counting(number < settling);
            let ready = self.draw(&mut renderer, &frame, &view)?;
            let latest = renderer.timing().latest();
            if request.rationed {
                stage.ration_aurora(latest);
            }
            if number == 0 {
                first = milliseconds(start.elapsed());
            }
            if number < settling {
                spent = processor_time();
            } else {
                taken.add(begin.elapsed(), ready - begin, latest);
            }
        }
        let processor = processor_time().zip(spent).map(|(now, then)| (now - then) / f64::from(request.frames));
        let Taken { mut whole, mut prepared, passes } = taken;
        Ok(FrameTimes {
            scene: name.to_owned(),
            first,
            whole: [0.0, 0.5, 1.0].map(|q| quantile(&mut whole, q)),
            prepare: quantile(&mut prepared, 0.5),
            processor,
            passes: passes.into_iter().map(|(label, mut times)| (label, [0.5, 0.0].map(|q| quantile(&mut times, q)))).collect(),
            fragments: renderer.timing().latest_fragments().to_vec(),
            counters: renderer.counters()?,
            disk: renderer.disk_counters()?,
            strokes: renderer.aurora_strokes()?,
        })
    }

    /// Draws one frame to its end, and says when it was handed to the GPU.
    fn draw(&self, renderer: &mut Renderer, frame: &FrameInput, view: &wgpu::TextureView) -> Result<Instant, PictureError> {
        renderer.prepare(frame);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder, view);
        let ready = Instant::now();
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
        Ok(ready)
    }
}

/// Times of frames, in milliseconds.
#[derive(Default)]
struct Taken {
    whole: Vec<f64>,
    /// Before submission.
    prepared: Vec<f64>,
    /// Of each pass.
    passes: Vec<(&'static str, Vec<f64>)>,
}

impl Taken {
    fn add(&mut self, whole: Duration, prepared: Duration, passes: &[(&'static str, f32)]) {
        self.whole.push(milliseconds(whole));
        self.prepared.push(milliseconds(prepared));
        for (label, time) in passes.iter().map(|&(label, time)| (label, f64::from(time))) {
            match self.passes.iter_mut().find(|(known, _)| *known == label) {
                Some((_, times)) => times.push(time),
                None => self.passes.push((label, vec![time])),
            }
        }
    }
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn quantile(values: &mut [f64], q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(((values.len().max(1) - 1) as f64 * q).round() as usize).copied().unwrap_or(f64::NAN)
}

/// Milliseconds that all threads of this process that still run have run so far, on Linux.
pub fn processor_time() -> Option<f64> {
    let mut sum = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        // The first field is the time on a processor, in ns. A thread may end while we read.
        let Ok(text) = std::fs::read_to_string(task.ok()?.path().join("schedstat")) else { continue };
        sum += text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6;
    }
    Some(sum)
}
