//! What is asked for, and what the frames of a scene took.

use std::fmt;
use std::path::PathBuf;

use clap::Args;
use lensrunner::argument::{number, whole};
use lensrunner::render::disk::types::DiskCounters;
use lensrunner::render::gpu::types::Counters;
use lensrunner::scene;

use super::parts::{PROCESSOR, Parts, Spread};
use crate::chart::{DEFAULT_FOLDER, Sheet};

/// Times whole frames of scenes and of the chase from start to end, and every part of them.
#[derive(Args, Clone, Debug)]
pub struct FrameTimesRequest {
    /// The folder for what is written.
    #[arg(short, value_name = "DIR", default_value = DEFAULT_FOLDER)]
    pub output: PathBuf,
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(long = "scene", value_name = "NAME|FILE", value_delimiter = ',', default_value = "ring,galaxy,parade,disk,chase,aurora-orbit")]
    #[arg(long_help = scene::help("TOML files, or names in assets/scenes."))]
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = scene::picture_size)]
    pub size: [u32; 2],
    /// Frames of each scene.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = whole::<u32>(1, 10_000))]
    pub frames: u32,
    /// The time T, in r_s/c, rounded to a step of the simulation (clock.step in game.toml: 0.03125, 1/32, unless changed).
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = number)]
    pub at: f64,
    /// Hold the aurora to its share of a frame, as in the window.
    #[arg(long)]
    pub rationed: bool,
    /// Draw on the fastest rung of automatic quality.
    #[arg(long)]
    pub fastest: bool,
    /// Frames of the scene `chase`, flown by its pilots from start to end. 0 for none.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole::<u32>(0, 100_000))]
    pub flight: u32,
}

/// All that the processor does for a frame.
const TOGETHER: &str = "processor together";
/// Passes after the picture in linear light is drawn.
const AFTERWARDS: [&str; 5] = ["bloom", "exposure", "flashes", "tone map", "smooth"];

/// One scene's times, in milliseconds.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes {
    /// The scene.
    pub scene: String,
    /// Of the first frame: what depends on a driver's state is compiled.
    pub first: f64,
    /// Whole frames and their parts.
    pub parts: Parts,
    /// Whole frames of the same moments without bodies and aurora.
    pub alone: Vec<f64>,
    /// Processor time of all threads for each frame, where the system tells it: on a software driver it says more than the clock does when
    /// other programs run.
    pub processor: Vec<f64>,
    /// T of each frame of a flight, in r_s/c.
    pub moments: Vec<f64>,
    /// What the device has allocated, where its driver's allocator tells it.
    pub memory: Option<Memory>,
    /// Fragments that passes shaded, where the GPU counts them.
    pub fragments: Vec<(&'static str, u64)>,
    /// What the stages of the geometry counted in the last frame.
    pub counters: Counters,
    /// And those of the disk, where it is one of arcs.
    pub disk: Option<DiskCounters>,
    /// Strokes of the aurora in it, by level of the pyramid.
    pub strokes: Option<Vec<u32>>,
}

/// Memory of a device, in bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Of all buffers and textures.
    pub all: u64,
    /// Of the largest of them.
    pub largest: u64,
    /// Its label.
    pub label: String,
}

impl Memory {
    /// What a device's allocator reports.
    pub(super) fn of(report: &wgpu::AllocatorReport) -> Memory {
        let largest = report.allocations.iter().max_by_key(|allocation| allocation.size);
        let (largest, label) = largest.map_or((0, ""), |allocation| (allocation.size, allocation.name.as_str()));
        Memory { all: report.total_allocated_bytes, largest, label: label.to_owned() }
    }
}

impl FrameTimes {
    /// No times yet.
    pub(super) fn of(scene: &str) -> FrameTimes {
        FrameTimes { scene: scene.to_owned(), ..FrameTimes::default() }
    }

    /// How many times as long a frame takes as one from the same place without bodies and aurora: the ratio of the medians.
    pub fn ratio(&self) -> f64 {
        self.parts.whole().median / Spread::of(&self.alone).median
    }

    /// Its rows of the sheet.
    pub(super) fn write(&self, sheet: &mut Sheet) {
        let whole = self.parts.whole().mean;
        let mut row = |kind: &str, part: &str, spread: Spread| {
            let (scene, Spread { mean, median, worst }) = (&self.scene, spread);
            sheet.line(format_args!("{scene}|{kind}|{part}|{mean:.3}|{median:.3}|{worst:.3}|{:.4}", mean / whole));
        };
        row("whole", "first frame", Spread::of(&[self.first]));
        row("whole", "frame", self.parts.whole());
        row("whole", "without bodies and aurora", Spread::of(&self.alone));
        row("whole", "processor time of all threads", Spread::of(&self.processor));
        row("whole", TOGETHER, self.parts.together(PROCESSOR));
        for (whose, name, spread) in self.parts.spreads() {
            row(whose, name, spread);
        }
        let rest = self.parts.in_no_part();
        row("rest", "in no pass", Spread { mean: rest, median: f64::NAN, worst: f64::NAN });
    }
}

impl fmt::Display for FrameTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Spread { mean, median, worst } = self.parts.whole();
        write!(f, "{}: median {median:.1} ms, mean {mean:.1}, worst {worst:.1} (first {:.0}", self.scene, self.first)?;
        if !self.processor.is_empty() {
            write!(f, "; {:.0} of processor time", Spread::of(&self.processor).median)?;
        }
        write!(f, "; {:.2} times as long as without bodies and aurora)", self.ratio())?;
        let Spread { mean: together, median, worst } = self.parts.together(PROCESSOR);
        write!(f, "\n  {TOGETHER}: mean {together:.2} ms, median {median:.2}, worst {worst:.2}, {:.2} times the mean", worst / together)?;
        for (whose, label, Spread { mean, median, worst }) in self.parts.spreads() {
            write!(f, "\n  {whose:<10} {label:<20} mean {mean:7.2} ms, median {median:7.2}, worst {worst:7.2}")?;
            if let Some((_, count)) = self.fragments.iter().find(|(known, _)| *known == label) {
                write!(f, ", {count} fragments")?;
            }
        }
        let rest = self.parts.in_no_part();
        write!(f, "\n  {:<10} {:<20} mean {rest:7.2} ms, {:.1} % of the frame", "rest", "in no pass", 100.0 * rest / mean)?;
        write!(f, "\n  what comes after the picture is {:.2} of the frame", self.parts.sum(&AFTERWARDS) / mean)?;
        write!(f, "\n  {}", self.counters)?;
        if let Some(complaint) = self.counters.complaint() {
            write!(f, "\n  {complaint}")?;
        }
        if let Some(disk) = &self.disk {
            write!(f, "\n  {disk}")?;
        }
        if let Some(strokes) = &self.strokes {
            let levels: Vec<String> = strokes.iter().map(u32::to_string).collect();
            write!(f, "\n  the aurora's passes take {:.2} of the frame", self.parts.sum(&["aurora"]) / mean)?;
            write!(f, "\n  {} strokes of the aurora (each level of half the size: {})", strokes.iter().sum::<u32>(), levels.join(", "))?;
        }
        Ok(())
    }
}
