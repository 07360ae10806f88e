//! The experiment of Sekiguchi et al. (figure 5): ten auroras, numbers of electrons and radii of splats swept, seen from the side, from
//! below and from orbit, and from orbit through bent light. Times are medians of runs taken in turn; errors are against the exact line
//! integral.

use std::hint::black_box;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Instant;

use glam::DVec3;

use super::engine::lattice::Lattice;
use super::engine::points::Points;
use super::engine::pyramid::Pyramid;
use super::engine::shares::Shares;
use super::engine::splat::{Gaussian, Picture, Splat};
use super::engine::tasks::{Tasks, on_threads};
use super::engine::walk::{Method, Walker};
use super::eye::Eye;
use super::sheet::{Falls, Sheet, Streak, field_direction};
use super::truth::Emission;
use lensrunner::lensing::{Slice, Table};

/// From where the auroras are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From the ground 700 km to the south.
    Side,
    /// From the ground under the arcs, along the field.
    Below,
    /// From 900 km up, looking down on them.
    Orbit,
    /// On a planet near a black hole, through its lensing.
    Bent,
}

impl View {
    /// All of them, and their names.
    pub const ALL: [(View, &'static str); 4] = [(View::Side, "side"), (View::Below, "below"), (View::Orbit, "orbit"), (View::Bent, "bent")];

    /// The camera of the view; `table` is used by the bent one alone.
    pub fn eye(self, size: [usize; 2], table: &Table) -> Eye {
        let degrees = |d: f64| d.to_radians();
        match self {
            View::Side => Eye::flat(DVec3::new(0.0, -700.0, 1.0), DVec3::new(0.0, 0.0, 190.0), DVec3::Z, degrees(45.0), size),
            View::Below => {
                let up = field_direction();
                let foot = DVec3::new(10.0, 32.0, 1.0);
                Eye::flat(foot, foot + up * 100.0, DVec3::Y, degrees(90.0), size)
            }
            View::Orbit => Eye::flat(DVec3::new(250.0, -500.0, 900.0), DVec3::new(0.0, 20.0, 130.0), DVec3::Z, degrees(40.0), size),
            View::Bent => {
                // A planet of 0.8 r_s on the other side of the hole, 25 r_s out, seen past it from 12 r_s.
                let at = DVec3::new(6.0, 0.0, -24.0);
                let slice = Slice::new(table, 12.0);
                Eye::bent(slice, 12.0, at, 0.8, DVec3::new(-0.5, -0.3, 0.8), degrees(0.32), size, 1)
            }
        }
    }
}

/// How points become a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Splats {
    /// An exponential for every pixel.
    Exponential,
    /// The tabulated Gaussian of Sekiguchi et al.
    Table,
    /// Through the layers of a [`Pyramid`].
    Pyramid,
}

/// One way to draw an aurora.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Its name in the table.
    pub name: &'static str,
    /// How points are found.
    pub method: Method,
    /// On all threads, or on one.
    pub threads: bool,
    /// How they become a picture.
    pub splats: Splats,
}

const fn variant(name: &'static str, method: Method, threads: bool, splats: Splats) -> Variant {
    Variant { name, method, threads, splats }
}

/// The ways on the CPU. The first is the baseline of Sekiguchi et al.: one thread, no table.
pub const VARIANTS: [Variant; 12] = [
    variant("particles-no-table", Method::Particles, false, Splats::Exponential),
    variant("particles", Method::Particles, false, Splats::Table),
    variant("linear", Method::Linear, false, Splats::Table),
    variant("exact", Method::Exact, false, Splats::Table),
    variant("particles-threads", Method::Particles, true, Splats::Table),
    variant("linear-threads", Method::Linear, true, Splats::Table),
    variant("exact-threads", Method::Exact, true, Splats::Table),
    variant("particles-pyramid", Method::Particles, false, Splats::Pyramid),
    variant("exact-pyramid", Method::Exact, false, Splats::Pyramid),
    variant("particles-pyramid-threads", Method::Particles, true, Splats::Pyramid),
    variant("exact-pyramid-threads", Method::Exact, true, Splats::Pyramid),
    variant("particles-tabled", Method::Tabled, false, Splats::Table),
];

/// What is tabulated once for all pictures, and memory for the next.
#[derive(Debug, Default)]
pub struct Tables {
    /// That of Sekiguchi et al.
    pub gaussian: Gaussian,
    /// The pyramid's.
    pub shares: Shares,
    /// Those of earlier pictures: new memory would be given by the system page by page, within a picture's time.
    spare: Mutex<Vec<Pyramid>>,
    /// Earlier pictures, for the same cause.
    seen: Mutex<Vec<Picture>>,
}

impl Tables {
    fn spare(&self) -> MutexGuard<'_, Vec<Pyramid>> {
        // A list of pyramids is whole whatever happened to the thread that had it.
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn seen(&self) -> MutexGuard<'_, Vec<Picture>> {
        // As above.
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a picture that nobody looks at any more, for its memory.
    pub fn take_back(&self, picture: Picture) {
        self.seen().push(picture);
    }

    /// A picture of a size, in which anything may be.
    fn picture(&self, size: [usize; 2]) -> Picture {
        let mut seen = self.seen();
        let at = seen.iter().position(|picture| picture.size == size);
        at.map_or_else(|| Picture::new(size), |k| seen.swap_remove(k))
    }

    /// A black pyramid for pictures of a size.
    fn pyramid(&self, size: [usize; 2]) -> Pyramid {
        let mut spare = self.spare();
        let Some(k) = spare.iter().position(|pyramid| pyramid.size() == size) else { return Pyramid::new(size) };
        let mut pyramid = spare.swap_remove(k);
        pyramid.wipe();
        pyramid
    }
}

/// A way to draw that lives above this floor: the passes on a GPU.
pub trait Runner {
    /// Its name in the table.
    fn name(&self) -> &str;
    /// Draws the electrons; None if it cannot draw this view.
    fn draw(&mut self, job: &Job) -> Option<Timed>;
}

/// What is to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The camera.
    pub eye: &'a Eye,
    /// The fall.
    pub falls: &'a Falls,
    /// The electrons.
    pub streaks: &'a [Streak],
    /// Which random numbers.
    pub seed: u32,
    /// How points are spread.
    pub splat: Splat,
}

/// A picture, and how long its two stages took, in milliseconds.
#[derive(Clone, Debug)]
pub struct Timed {
    /// The picture.
    pub picture: Picture,
    /// From electrons to points.
    pub walk: f64,
    /// From points to the picture.
    pub splat: f64,
}

/// Error allowed to chords through bent light, pixels.
pub const TOLERANCE: f32 = 0.25;

/// A picture in the making.
#[allow(clippy::large_enum_variant, reason = "there is one for each thread")]
enum Canvas {
    Direct(Picture),
    Layers(Pyramid),
}

impl Canvas {
    fn new(splats: Splats, size: [usize; 2], tables: &Tables) -> Canvas {
        match splats {
            Splats::Pyramid => Canvas::Layers(tables.pyramid(size)),
            Splats::Table | Splats::Exponential => {
                let mut picture = tables.picture(size);
                picture.pixels.fill([0.0; 4]);
                Canvas::Direct(picture)
            }
        }
    }

    fn add(&mut self, points: &Points, job: &Job, splats: Splats, tables: &Tables) {
        match self {
            Canvas::Direct(picture) => {
                picture.add(points, job.falls, Splat { table: splats == Splats::Table, ..job.splat }, &tables.gaussian);
            }
            Canvas::Layers(pyramid) => pyramid.add(points, job.falls, job.splat.radius, &tables.shares),
        }
    }

    /// The pyramid, if it is one.
    fn layers(&self) -> Option<&Pyramid> {
        match self {
            Canvas::Direct(_) => None,
            Canvas::Layers(pyramid) => Some(pyramid),
        }
    }
}

/// Draws `job` in the given way: some electrons are walked, their points drawn, then the next. With threads, the time from start to end is
/// divided between walk and splats as the threads' own times are. Threads are woken once for a picture: before they sum its layers they
/// wait for one another awake, as to be woken again takes as long as the sum.
pub fn draw(variant: Variant, job: &Job, tables: &Tables) -> Timed {
    let start = Instant::now();
    // In flat space each streak is one chord, of its own.
    let lattice = (variant.method == Method::Exact && job.eye.bent.is_some()).then(|| Lattice::around(job.eye, job.streaks, TOLERANCE));
    let walker = Walker::new(job.eye, job.falls, lattice.as_ref(), job.seed);
    let before = start.elapsed().as_secs_f64();
    let threads = if variant.threads { rayon::current_num_threads() } else { 1 };
    // Each thread's canvas, and seconds of walk and of splats.
    let parts: Vec<OnceLock<(Canvas, [f64; 2])>> = std::iter::repeat_with(OnceLock::new).take(threads).collect();
    let tasks = Tasks::new(job.streaks, threads);
    let [width, height] = job.eye.size;
    let mut picture = tables.picture([width, height]);
    if tasks.is_empty() {
        // Else each row is written as a whole, or it is a thread's canvas.
        picture.pixels.fill([0.0; 4]);
    }
    // Rows that a thread sums at once: there are more bands than threads, as no two are ready at once.
    let band = height.div_ceil(if threads > 1 { 2 * threads } else { 1 }).max(1);
    let bands = Mutex::new(picture.pixels.chunks_mut((width * band).max(1)).zip((0..height).step_by(band)));
    let (ready, drawn) = (start.elapsed().as_secs_f64(), OnceLock::new());
    on_threads(parts.iter(), |thread, part| {
        let mut taker = tasks.taker(thread);
        let mut canvas = None;
        let mut times = [0.0; 2];
        let mut points = Points::default();
        for some in taker.by_ref() {
            let start = Instant::now();
            points.clear();
            walker.walk(variant.method, some, &mut points);
            let walked = start.elapsed().as_secs_f64();
            let canvas = canvas.get_or_insert_with(|| Canvas::new(variant.splats, job.eye.size, tables));
            canvas.add(&points, job, variant.splats, tables);
            times[0] += walked;
            times[1] += start.elapsed().as_secs_f64() - walked;
        }
        if let Some(canvas) = canvas {
            // The thread's own place, in which nothing was before.
            let _ = part.set((canvas, times));
        }
        drop(taker);
        // A thread that comes late and has none waits as well, as the sum's bands are for all.
        tasks.wait();
        drawn.get_or_init(|| start.elapsed().as_secs_f64());
        let pyramids: Vec<&Pyramid> = parts.iter().filter_map(|part| part.get()?.0.layers()).collect();
        if pyramids.is_empty() {
            return;
        }
        loop {
            let next = bands.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((out, first)) = next else { break };
            Pyramid::sum(&pyramids, first..(first + band).min(height), out);
        }
    });
    let drawn = drawn.get().copied().unwrap_or(ready);
    let times = parts.iter().filter_map(OnceLock::get).fold([0.0, 0.0], |sum, (_, times)| [sum[0] + times[0], sum[1] + times[1]]);
    let mut direct = false;
    for (canvas, _) in parts.into_iter().filter_map(OnceLock::into_inner) {
        match canvas {
            Canvas::Direct(part) if direct => {
                picture.merge(&part);
                tables.take_back(part);
            }
            Canvas::Direct(part) => {
                tables.take_back(std::mem::replace(&mut picture, part));
                direct = true;
            }
            Canvas::Layers(pyramid) => tables.spare().push(pyramid),
        }
    }
    let total = start.elapsed().as_secs_f64();
    let walk = before + (drawn - ready) * times[0] / (times[0] + times[1]).max(1e-12);
    Timed { picture: black_box(picture), walk: walk * 1e3, splat: (total - walk) * 1e3 }
}

/// What is swept.
#[derive(Clone, Debug)]
pub struct ExperimentRequest {
    /// Numbers of the auroras, 1 to 10 of them.
    pub auroras: usize,
    /// Electrons.
    pub counts: Vec<u32>,
    /// Standard deviations of a point's light, km.
    pub radii: Vec<f32>,
    /// Size of the picture.
    pub size: [usize; 2],
    /// Runs of which the median is taken.
    pub repeats: usize,
}

/// One row of the table: the mean over the auroras.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// From where.
    pub view: &'static str,
    /// How.
    pub method: String,
    /// Electrons.
    pub count: u32,
    /// Standard deviation of a point's light, km.
    pub radius: f32,
    /// Luminous points of the particle method in the frame and around it.
    pub points: f64,
    /// Milliseconds from electrons to points, from points to the picture, and both.
    pub walk: f64,
    /// See `walk`.
    pub splat: f64,
    /// See `walk`.
    pub total: f64,
    /// Root mean square error of the picture over that of the truth. With few electrons it is their grain for the most part, whatever the
    /// walk.
    pub error: f64,
    /// The same against the particle method with the same electrons, random numbers and splats: what the walk itself gets wrong. 0 for the
    /// particle method.
    pub difference: f64,
}

/// Runs the experiment; `report` is told what is being drawn.
pub fn run(request: &ExperimentRequest, table: &Table, runners: &mut [Box<dyn Runner>], mut report: impl FnMut(&str)) -> Vec<Row> {
    let falls = Falls::new();
    let tables = Tables::default();
    let sheets = Sheet::ten();
    let sheets = &sheets[..request.auroras.clamp(1, 10)];
    let mut rows = Vec::new();
    for (view, name) in View::ALL {
        let eye = view.eye(request.size, table);
        for &radius in &request.radii {
            let splat = Splat { radius, table: true };
            let judge = request.counts.iter().max().map_or(JUDGE[0], |&count| (10u32.saturating_mul(count)).clamp(JUDGE[0], JUDGE[1]));
            let truths: Vec<Picture> = sheets.iter().map(|sheet| truth(view, &eye, sheet, &falls, splat, judge, &tables)).collect();
            for &count in &request.counts {
                report(&format!("{name}, {count} electrons, splats of {radius} km"));
                rows.extend(case((view, name), &eye, (sheets, &truths), &falls, count, splat, &tables, request.repeats, runners));
            }
        }
    }
    rows
}

/// Runs of a way on the graphics adapter, at least: its clock has once been read as 0.02 ms for a pass of several, and with fewer than
/// three runs one such time can be the median.
const LEAST_RUNS: usize = 3;

/// The way whose picture another's is compared with: the particle method on one thread, spread in the same way. A graphics adapter's splats
/// are exponentials.
fn reference(way: usize) -> Option<usize> {
    let splats = VARIANTS.get(way).map_or(Splats::Exponential, |variant| variant.splats);
    VARIANTS.iter().position(|variant| variant.method == Method::Particles && !variant.threads && variant.splats == splats)
}

/// Electrons of the judge through bent light, at least and at most.
const JUDGE: [u32; 2] = [10_000, 150_000];

/// The picture as it should be. Through bent light there is no line integral to judge by but the particle method itself: `judge` electrons
/// of another seed.
fn truth(view: View, eye: &Eye, sheet: &Sheet, falls: &Falls, splat: Splat, judge: u32, tables: &Tables) -> Picture {
    if view != View::Bent {
        return Emission::new(sheet, falls, splat).picture(eye, 0.5 * f64::from(splat.radius).min(1.5));
    }
    let streaks = Sheet { seed: sheet.seed + 7000, ..sheet.clone() }.streaks(judge);
    let job = Job { eye, falls, streaks: &streaks, seed: sheet.seed + 7000, splat };
    draw(VARIANTS[4], &job, tables).picture
}

#[allow(clippy::too_many_arguments, reason = "one case of a sweep: each is one axis of it")]
fn case(
    (_, name): (View, &'static str),
    eye: &Eye,
    (sheets, truths): (&[Sheet], &[Picture]),
    falls: &Falls,
    count: u32,
    splat: Splat,
    tables: &Tables,
    repeats: usize,
    runners: &mut [Box<dyn Runner>],
) -> Vec<Row> {
    let ways = VARIANTS.len() + runners.len();
    // Per way and aurora: medians of the repeats; then the mean over the auroras.
    let mut sums = vec![[0.0f64; 5]; ways];
    let mut drawn = vec![true; ways];
    let mut points = 0.0;
    for (sheet, truth) in sheets.iter().zip(truths) {
        let streaks = sheet.streaks(count);
        let job = Job { eye, falls, streaks: &streaks, seed: sheet.seed, splat };
        let mut found = Points::default();
        Walker::new(eye, falls, None, sheet.seed).walk(Method::Particles, &streaks, &mut found);
        points += found.len() as f64 / sheets.len() as f64;
        let mut times = vec![Vec::new(); ways];
        let mut errors = vec![[f64::NAN; 2]; ways];
        // Pictures of the particle method, with which others are compared.
        let mut pictures: Vec<Option<Picture>> = vec![None; VARIANTS.len()];
        // In turn, so that what else the machine does falls on all alike.
        for run in 0..repeats.max(LEAST_RUNS) {
            for way in 0..ways {
                if run >= repeats.max(1) && way < VARIANTS.len() {
                    continue;
                }
                let timed = match way.checked_sub(VARIANTS.len()) {
                    None => Some(draw(VARIANTS[way], &job, tables)),
                    Some(runner) => runners[runner].draw(&job),
                };
                match timed {
                    Some(timed) => {
                        times[way].push([timed.walk, timed.splat, timed.walk + timed.splat]);
                        let own = reference(way);
                        let other = own.and_then(|own| pictures[own].as_ref()).unwrap_or(&timed.picture);
                        errors[way] = [timed.picture.error(truth), timed.picture.error(other)];
                        // Those of an adapter come from elsewhere.
                        if own == Some(way) {
                            // For all ways alike, the one before is taken back.
                            if let Some(before) = pictures[way].replace(timed.picture) {
                                tables.take_back(before);
                            }
                        } else if way < VARIANTS.len() {
                            tables.take_back(timed.picture);
                        }
                    }
                    None => drawn[way] = false,
                }
            }
        }
        for way in 0..ways {
            for k in 0..3 {
                let mut column: Vec<f64> = times[way].iter().map(|time| time[k]).collect();
                column.sort_by(f64::total_cmp);
                sums[way][k] += column.get(column.len() / 2).copied().unwrap_or(f64::NAN) / sheets.len() as f64;
            }
            for k in 0..2 {
                sums[way][3 + k] += errors[way][k] / sheets.len() as f64;
            }
        }
    }
    (0..ways)
        .filter(|&way| drawn[way])
        .map(|way| {
            let method = match way.checked_sub(VARIANTS.len()) {
                None => VARIANTS[way].name.to_owned(),
                Some(runner) => runners[runner].name().to_owned(),
            };
            let [walk, splat_ms, total, error, difference] = sums[way];
            Row { view: name, method, count, radius: splat.radius, points, walk, splat: splat_ms, total, error, difference }
        })
        .collect()
}
