//! One case before the judge, from the picture to its faults, in bounded time.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use super::ContestantFrame;
use super::command::DrawCase;
use super::deadline::{Deadline, GaveUp, trace_within};
use super::fault::{Fault, Kind, Limits};
use super::measure::displacement::Effort;
use super::measure::light::{LEAST_ROUNDS, lights};
use super::measure::metrics::{Verdict, compare_with};
use super::measure::narrow::{grossly_wrong, see_again_but};
use super::measure::probe::probe;
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{DEFAULT_PACKET, Sampling, TracedPicture};

/// How a case is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Local error of each step of a ray.
    pub tolerance: f64,
    /// Seconds that the judge may take over a case.
    pub seconds: f64,
    /// The most pixels of one image at which displacements are measured.
    pub pixels: usize,
    /// The most of those at which a doubtful displacement is measured from several starts.
    pub doubtful: usize,
}

impl Default for Terms {
    fn default() -> Terms {
        Terms { tolerance: 1e-10, seconds: 60.0, pixels: 400, doubtful: 12 }
    }
}

/// What came of a case.
#[derive(Clone, Debug)]
pub struct Judged {
    /// What is beyond the limits; nothing if the picture is right.
    pub faults: Vec<Fault>,
    /// The verdict; None where the renderer gave no picture.
    pub verdict: Option<Verdict>,
    /// Whether there was anything to judge.
    pub solid: bool,
    /// The two pictures, of the renderer and of the judge.
    pub pictures: Option<(ContestantFrame, TracedPicture)>,
    /// Seconds for the renderer's picture.
    pub drawing: f64,
    /// Seconds for the judge's picture.
    pub tracing: f64,
    /// Seconds for narrow images and displacements.
    pub measuring: f64,
    /// Rays a second and thread of the judge's picture.
    pub rate: f64,
}

/// Draws the case and judges it with one ray a pixel, nine where images are narrow, by the limits of small pictures. An error if the judge
/// ran out of time.
pub fn judge(case: &Case, terms: &Terms, contestant: &DrawCase) -> Result<Judged, GaveUp> {
    let started = Instant::now();
    let drawn = draw(case, contestant);
    let drawing = started.elapsed().as_secs_f64();
    let frame = match drawn {
        Ok(frame) => frame,
        Err(reason) => {
            let faults = vec![Fault::new(Kind::NoPicture, 1.0, 1.0, format!("the renderer gave no picture: {reason}"))];
            let none = Judged { faults, verdict: None, solid: true, pictures: None, drawing, tracing: 0.0, measuring: 0.0, rate: f64::NAN };
            return Ok(none);
        }
    };
    let deadline = Deadline::after(terms.seconds);
    let started = Instant::now();
    let sampling = Sampling { samples: 1, tolerance: terms.tolerance, packet: DEFAULT_PACKET };
    let mut judge = trace_within(case, &sampling, &deadline)?;
    let tracing = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let verdict = measure(case, &frame, &mut judge, terms, &deadline)?;
    let measuring = started.elapsed().as_secs_f64();
    let limits = Limits::small(case.config.render.orders);
    let rays = f64::from(case.camera.size[0]) * f64::from(case.camera.size[1]);
    Ok(Judged {
        faults: verdict.beyond(&limits),
        solid: verdict.is_judged(&limits),
        verdict: Some(verdict),
        pictures: Some((frame, judge)),
        drawing,
        tracing,
        measuring,
        rate: rays / (tracing * rayon::current_num_threads() as f64).max(1e-9),
    })
}

/// The part of the judge's time that displacements may take besides.
const MEASURING: f64 = 0.25;
/// The same for light.
const LIGHT: f64 = 0.25;

/// Sets the picture beside the judge's, which is looked at again where images are narrow.
fn measure(case: &Case, frame: &ContestantFrame, judge: &mut TracedPicture, terms: &Terms, deadline: &Deadline) -> Result<Verdict, GaveUp> {
    let probe = probe(case, terms.tolerance);
    let gross: BTreeSet<_> = grossly_wrong(judge, frame);
    see_again_but(judge, frame, &probe, &gross, deadline);
    // What is as wrong as that has its verdict, whatever else there was no time for.
    if gross.is_empty() {
        deadline.check("narrow images were looked at with nine rays a pixel")?;
    }
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    // A part of the pixels, spread over the picture, tells how far points are displaced: there is less time for them than for what is seen
    // at all.
    let effort = Effort { pixels: terms.pixels, doubtful: terms.doubtful, deadline: Deadline::after(MEASURING * terms.seconds) };
    // Colours are not judged with one ray a pixel.
    let no_difference = vec![0.0; judge.light.len()];
    let verdict = compare_with(judge, frame, &probe, &names, &no_difference, &effort);
    // What is grossly wrong needs no more rays.
    let deadline = Deadline::after(LIGHT * terms.seconds);
    let limits = Limits::small(case.config.render.orders);
    let lights = if gross.is_empty() { lights(judge, frame, &probe, &names, &limits, LEAST_ROUNDS, &deadline) } else { Vec::new() };
    Ok(Verdict { lights, ..verdict })
}

/// The renderer's picture, or why there is none; a panic is a reason.
pub fn draw(case: &Case, contestant: &DrawCase) -> Result<ContestantFrame, String> {
    catch_unwind(AssertUnwindSafe(|| contestant(case))).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned().or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Err(format!("it panicked: {}", text.unwrap_or_default()))
    })
}
