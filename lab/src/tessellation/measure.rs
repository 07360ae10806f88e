//! Displacements by the judge, vertices by the renderer's counters, times of its passes.

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{DEFAULT_PACKET, Sampling, TracedPicture};
use lensrunner::render::Gpu;
use lensrunner::render::gpu::types::Counters;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::Stage;
use lensrunner::scene::{self, GameConfig};

use super::TessellationRequest;
use super::ways::{NAMES, Way};
use crate::chart::{ChartError, Sheet, Timing, mean, quantile};
use crate::compare::deadline::Deadline;
use crate::compare::measure::displacement::Effort;
use crate::compare::measure::metrics::{Verdict, compare_with};
use crate::compare::measure::probe::probe;
use crate::contestant::GameContestant;
use crate::offscreen::Offscreen;

/// Error of each step of the judge's rays.
const TOLERANCE: f64 = 1e-10;
/// Pixels of an image at which displacements are measured.
const PIXELS: usize = 1500;
/// Of those, so many from several starts.
const DOUBTFUL: usize = 12;
/// Seconds for the displacements of one picture.
const SECONDS: f64 = 20.0;
/// The game's own bound, px, whose time the others are told against.
pub const OWN: f64 = 0.5;
/// Passes that depend on how triangles are divided.
const PASSES: [&str; 7] = ["vertices", "edges", "triangles", "refine", "mesh", "draw", "thin"];

const COLUMNS: [&str; 13] = [
    "scene", "way", "bound_px", "vertices", "passes_ms", "time_over_ours", "mean_px", "p99_px", "max_px", "measured", "differ_percent",
    "failed", "note",
];

/// A row for each scene and way.
pub fn measure(request: &TessellationRequest) -> Result<Sheet, ChartError> {
    let gpu = Gpu::headless()?;
    let mut sheet = Sheet::measured(&COLUMNS, &gpu.adapter.name);
    let base = GameConfig::default();
    let ways = Way::all(&request.bounds);
    let mut contestant = GameContestant::default();
    for name in &request.scenes {
        eprintln!("{name}");
        let times = times(&gpu, name, &ways, &base, request)?;
        let own = ways.iter().position(|way| *way == Way::Ours(OWN)).map_or(f64::NAN, |place| times[place].0.median);
        let mut case = Case::new(scene::load(name)?, base.clone(), 0.0, request.size);
        let judge = case.trace(&Sampling { samples: 1, tolerance: TOLERANCE, packet: DEFAULT_PACKET }, false, &|_| ());
        for (way, (time, counters)) in ways.iter().zip(&times) {
            case.config = way.config(&base);
            contestant.set_midpoint(way.is_midpoint());
            let found = judged(&case, &judge, &contestant);
            let found = match found {
                Ok(Seen { mean, most, max, measured, differ }) => {
                    let bound = if way.bound().is_nan() { OWN } else { way.bound() };
                    let failed = u8::from(most.is_nan() || most > bound);
                    format!("{mean:.4}|{most:.4}|{max:.4}|{measured}|{differ:.3}|{failed}|{}", counters.complaint().unwrap_or_default())
                }
                Err(reason) => format!("NaN|NaN|NaN|0|NaN|1|{reason}"),
            };
            let (way, bound, median) = (NAMES[way.family()], way.bound(), time.median);
            sheet.line(format_args!("{name}|{way}|{bound}|{}|{median:.3}|{:.3}|{found}", counters.vertices, median / own));
        }
    }
    Ok(sheet)
}

/// What the judge finds, over all images.
struct Seen {
    mean: f64,
    most: f64,
    max: f64,
    measured: usize,
    /// Per cent of the pixels of images that show something else.
    differ: f64,
}

/// Sets the renderer's picture of the case beside the judge's.
fn judged(case: &Case, judge: &TracedPicture, contestant: &GameContestant) -> Result<Seen, String> {
    let frame = contestant.draw(case)?;
    let probe = probe(case, TOLERANCE);
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    let effort = Effort { pixels: PIXELS, doubtful: DOUBTFUL, deadline: Deadline::after(SECONDS) };
    let verdict = compare_with(judge, &frame, &probe, &names, &vec![0.0; judge.light.len()], &effort);
    Ok(seen(&verdict))
}

fn seen(verdict: &Verdict) -> Seen {
    let displaced: Vec<f64> = verdict.displaced.iter().filter(|px| px.is_finite()).map(|px| f64::from(*px)).collect();
    let at = |share: f64| quantile(displaced.iter().copied(), share);
    let sum = |count: fn(&crate::compare::measure::metrics::Group) -> usize| verdict.groups.iter().map(count).sum::<usize>() as f64;
    Seen {
        mean: mean(&displaced),
        most: at(0.99),
        max: at(1.0),
        measured: displaced.len(),
        differ: 100.0 * sum(|group| group.mismatched) / sum(|group| group.pixels).max(1.0),
    }
}

/// Milliseconds of the passes and what the renderer counted, of each way; all take turns.
fn times(
    gpu: &Gpu,
    name: &str,
    ways: &[Way],
    base: &GameConfig,
    request: &TessellationRequest,
) -> Result<Vec<(Timing, Counters)>, ChartError> {
    let scene = scene::load(name)?;
    let moment = Moment::new(&scene, base, 0.0, 0);
    let mut offscreen = Offscreen::new(gpu, request.size);
    let mut stage = Stage::new(&mut offscreen.renderer, &scene, base);
    let camera = stage.camera(moment.time(), &moment.ships());
    let mut found = vec![(Vec::new(), Counters::default()); ways.len()];
    for round in 0..=request.rounds {
        for (way, (times, counters)) in ways.iter().zip(&mut found) {
            let frame = stage.frame(camera, request.size, moment.time(), &moment.histories(), None, &way.settings(base));
            // The first frame after another method's compiles and fills its tables.
            for _ in 0..2 {
                offscreen.draw(&frame)?;
            }
            let passes = offscreen.renderer.timing().latest().iter().filter(|(label, _)| PASSES.contains(label));
            let whole = passes.map(|(_, ms)| f64::from(*ms)).sum::<f64>();
            if round > 0 {
                times.push(whole);
                *counters = offscreen.renderer.counters()?;
            }
        }
    }
    Ok(found.into_iter().map(|(times, counters)| (Timing::of(times), counters)).collect())
}
