//! `lensrunner-lab compare`: a renderer's picture of a scene, handed in from above, against the judge's.

use crate::say::say;
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};

use super::ContestantFrame;
use super::collect::{COLUMNS, add, moments};
use super::deadline::Deadline;
use super::measure::light::lights;
use super::measure::metrics::{Limits, Verdict, compare};
use super::measure::narrow;
use super::measure::probe::probe;
use super::report::{side_by_side, table};
use crate::chart::{Sheet, SheetError};
use crate::flip::flip;
use lensrunner::judge::case::{Case, TraceError, TraceRequest};
use lensrunner::judge::picture::{Sampling, TracedPicture};
use lensrunner::picture_file::{PictureFileError, check_writable, write_png};
use lensrunner::scene;
use lensrunner::scene::Model;

/// Draws the case with the renderer that is to be judged.
pub type DrawCase<'a> = dyn Fn(&Case) -> Result<ContestantFrame, String> + 'a;

/// Why there is no verdict.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The judge has no picture.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The contestant has none: exit code 1.
    #[error("the renderer gave no picture: {0}")]
    Contestant(String),
    /// The table of verdicts cannot be read or written (exit code 1), or is another table (2).
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// A file or folder cannot be written: exit code 1.
    #[error("cannot write {}: {}", .0.display(), .1)]
    Output(PathBuf, std::io::Error),
}

impl From<PictureFileError> for CompareError {
    fn from(error: PictureFileError) -> Self {
        CompareError::Trace(error.into())
    }
}

impl CompareError {
    /// Whether the asker is at fault.
    pub fn is_input(&self) -> bool {
        match self {
            CompareError::Trace(error) => error.is_input(),
            CompareError::Sheet(error) => !matches!(error, SheetError::Io(..)),
            _ => false,
        }
    }
}

/// The name that stands for every scene of the project.
pub const ALL: &str = "all";

/// Judges every scene of the project, at each of its times, into the folder `output`: pictures side by side, and the table of all verdicts.
/// Scenes without anything solid get the rays that colours need. Gives what goes beyond the limits, and what could not be judged.
pub fn run_all(request: &TraceRequest, config: Option<&Path>, output: &Path, contestant: &DrawCase) -> Result<Vec<String>, CompareError> {
    let mut faults = Vec::new();
    for (scene, at) in moments() {
        let name = if at == 0.0 { format!("{scene}.png") } else { format!("{scene}-{at}.png") };
        say(format_args!("{scene}, T = {at}:"));
        let solid = scene::load(&scene).map_or(true, |scene| !(scene.ships.is_empty() && scene.props.is_empty() && scene.planet.is_none()));
        let samples = if solid { request.samples } else { request.samples.max(COLOUR_SAMPLES) };
        let request = TraceRequest { scene, at, samples, ..request.clone() };
        match run(&request, config, &output.join(name), Some(&output.join("verdict.csv")), contestant) {
            Ok(found) => faults.extend(found),
            // What the asker did wrong is wrong everywhere; the other scenes can be judged without this one.
            Err(error) if error.is_input() => return Err(error),
            Err(error) => {
                say(format_args!("no verdict: {error}"));
                faults.push(format!("{}, T = {at}: no verdict: {error}", request.scene));
            }
        }
    }
    Ok(faults)
}

/// Renders both, gives what goes beyond the limits, prints the verdict to standard output, writes the pictures side by side to `output`, a
/// .png, and adds the verdict to `collected`, a .csv.
pub fn run(
    request: &TraceRequest,
    config: Option<&Path>,
    output: &Path,
    collected: Option<&Path>,
    contestant: &DrawCase,
) -> Result<Vec<String>, CompareError> {
    request.check()?;
    let config = scene::config::find(config).map_err(TraceError::from)?;
    let scene = scene::load(&request.scene).map_err(TraceError::from)?;
    run_case(&Case::new(scene, config, request.at, request.size), request, output, collected, contestant)
}

/// The same of a case; scene, T and size are the case's, and the request says how to name them.
pub fn run_case(
    case: &Case,
    request: &TraceRequest,
    output: &Path,
    collected: Option<&Path>,
    contestant: &DrawCase,
) -> Result<Vec<String>, CompareError> {
    // Before the work of which it would lose the result.
    if let Some(csv) = collected {
        Sheet::open(csv, &COLUMNS)?;
    }
    let side = request.check()?;
    if output.extension().and_then(|extension| extension.to_str()) != Some("png") {
        return Err(TraceError::Input(format!("cannot write {}: the name must end in .png", output.display())).into());
    }
    check_writable(output)?;
    case.check().map_err(TraceError::from)?;
    if let Some(what) = case.left_out() {
        eprintln!("note: {what}");
    }
    let frame = contestant(case).map_err(CompareError::Contestant)?;
    let bar = ProgressBar::new(u64::from(request.size[0]) * u64::from(request.size[1]));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} pixels, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    let sampling = Sampling { samples: side, tolerance: request.tolerance, packet: request.packet };
    let judge = case.trace_within(&sampling, true, request.limit, &|pixels| bar.inc(pixels));
    bar.finish_and_clear();
    let mut judge = judge.map_err(TraceError::from)?;
    if let Some(what) = judge.given_up_in_words() {
        eprintln!("note: {what}");
    }
    let probe = probe(case, request.tolerance);
    if side < narrow::SIDE {
        narrow::see_again(&mut judge, &frame, &probe);
    }
    let difference = difference(&judge, &frame);
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    let verdict = compare(&judge, &frame, &probe, &names, &difference);
    let lights = lights(&judge, &frame, &probe, &names, &Limits::default(), request.samples, &Deadline::never());
    let verdict = Verdict { lights, ..verdict };
    // Colours of surfaces follow from where their points are; what else differs there are steps along edges, of a ray a pixel in the game.
    let limits = Limits { orders: case.config.render.orders, ..Limits::default() };
    let nothing_solid = !verdict.is_judged(&limits);
    let limits = Limits { flip: (request.samples >= COLOUR_SAMPLES && nothing_solid).then(|| colour_limit(&judge)), ..limits };
    let faults = verdict.faults(&limits);
    say(table(&verdict, &limits, &faults).trim_end());
    let (size, bytes) = side_by_side(&judge, &frame, &difference, &verdict.displaced, &case.post_process());
    write_png(output, &bytes, size)?;
    if let Some(csv) = collected {
        add(csv, request, &verdict, &limits, &faults)?;
    }
    Ok(faults)
}

/// From this many rays a pixel on the judge's colours are judged by: with fewer its own streaks are rough.
const COLOUR_SAMPLES: u32 = 16;

/// The mean ꟻLIP that a picture may have: that of the judge's own picture moved by half a pixel along its rows, which every surface point
/// may be displaced by, as linear filtering moves it: each pixel the mean of itself and its left neighbour, so what is as fine as a pixel
/// also grows softer.
pub fn colour_limit(judge: &TracedPicture) -> f64 {
    let width = judge.size[0] as usize;
    let moved: Vec<[f32; 3]> = (0..judge.light.len())
        .map(|i| {
            let left = judge.light[if i % width > 0 { i - 1 } else { i }];
            std::array::from_fn(|channel| 0.5 * (judge.light[i][channel] + left[channel]))
        })
        .collect();
    let map = contrast(judge, &moved);
    map.iter().map(|d| f64::from(*d)).sum::<f64>() / map.len().max(1) as f64
}

/// ꟻLIP of the two pictures, both exposed so that the judge's brightest hundredth is white.
pub fn difference(judge: &TracedPicture, frame: &ContestantFrame) -> Vec<f32> {
    contrast(judge, &frame.light)
}

fn contrast(judge: &TracedPicture, light: &[[f32; 3]]) -> Vec<f32> {
    let mut peaks: Vec<f32> = judge.light.iter().map(|rgb| rgb.iter().copied().fold(0.0, f32::max)).filter(|peak| *peak > 0.0).collect();
    peaks.sort_by(f32::total_cmp);
    let white = peaks.get(peaks.len() * 99 / 100).copied().unwrap_or(1.0).max(1e-9);
    let exposed = |light: &[[f32; 3]]| -> Vec<[f32; 3]> { light.iter().map(|rgb| rgb.map(|c| c / white)).collect() };
    flip(&exposed(&judge.light), &exposed(light), judge.size)
}

/// What makes of a model one with the first two of its points' coordinates as texture coordinates, and one with the third: a renderer that
/// draws these shows, in its layer of texture coordinates, which point of a surface is at each pixel. Coarser models that stand in for one
/// must be marked after they are made.
pub const MARKS: [fn(&Model) -> Model; 2] =
    [|model| with_places(model, |[x, y, _]| [x, y]), |model| with_places(model, |[_, _, z]| [z, 0.0])];

fn with_places(model: &Model, pick: fn([f32; 3]) -> [f32; 2]) -> Model {
    let mut model = model.clone();
    for vertex in &mut model.vertices {
        vertex.uv = pick(vertex.position);
    }
    model
}
