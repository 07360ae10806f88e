//! What is asked for, and what the frames of a scene took.

use std::fmt;

use lensrunner::render::disk::types::DiskCounters;
use lensrunner::render::gpu::types::Counters;

use super::parts::{Parts, Spread};
use crate::chart::{Output, Sheet};

/// What to time.
#[derive(Clone, Debug)]
pub struct FrameTimesRequest {
    /// Where the sheets go.
    pub output: Output,
    /// Names or files of scenes.
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames that are timed, after some that are not.
    pub frames: u32,
    /// T of the frames, in r_s/c.
    pub at: f64,
    /// Whether the aurora is held to its share of a frame, as in the window; it is given some frames more for that.
    pub rationed: bool,
    /// Frames that are timed along the chase; 0 for none.
    pub flight: u32,
}

/// Passes after the picture in linear light is drawn.
const AFTERWARDS: [&str; 5] = ["bloom", "exposure", "flashes", "tone map", "smooth"];

/// One scene's times, in milliseconds.
#[derive(Clone, Debug)]
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
    /// Fragments that passes shaded, where the GPU counts them.
    pub fragments: Vec<(&'static str, u64)>,
    /// What the stages of the geometry counted in the last frame.
    pub counters: Counters,
    /// And those of the disk, where it is one of arcs.
    pub disk: Option<DiskCounters>,
    /// Strokes of the aurora in it, by level of the pyramid.
    pub strokes: Option<Vec<u32>>,
}

impl FrameTimes {
    /// No times yet.
    pub(super) fn of(scene: &str) -> FrameTimes {
        FrameTimes {
            scene: scene.to_owned(),
            first: 0.0,
            parts: Parts::default(),
            alone: Vec::new(),
            processor: Vec::new(),
            moments: Vec::new(),
            fragments: Vec::new(),
            counters: Counters::default(),
            disk: None,
            strokes: None,
        }
    }

    /// How many times as long a frame takes as one from the same place without bodies and aurora: the ratio of the medians.
    pub fn ratio(&self) -> f64 {
        self.parts.whole().median / Spread::of(&self.alone).median
    }

    /// Its rows of the sheet.
    pub(super) fn write(&self, sheet: &mut Sheet) {
        let whole = self.parts.whole().mean;
        let mut row = |kind: &str, part: &str, spread: Spread| {
            let times = [spread.mean, spread.median, spread.worst].map(|time| format!("{time:.3}"));
            let cells = [self.scene.clone(), kind.to_owned(), part.to_owned()];
            sheet.push(cells.into_iter().chain(times).chain([format!("{:.4}", spread.mean / whole)]));
        };
        row("whole", "first frame", Spread::of(&[self.first]));
        row("whole", "frame", self.parts.whole());
        row("whole", "without bodies and aurora", Spread::of(&self.alone));
        row("whole", "processor time of all threads", Spread::of(&self.processor));
        for (whose, name, spread) in self.parts.spreads() {
            row(&whose.to_string(), name, spread);
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
        for (whose, label, Spread { mean, median, worst }) in self.parts.spreads() {
            write!(f, "\n  {:<10} {label:<20} mean {mean:7.2} ms, median {median:7.2}, worst {worst:7.2}", whose.to_string())?;
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
