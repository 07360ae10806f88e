//! An aurora drawn on the processor: electrons are walked and their points become a picture, on one thread or on all.

use std::hint::black_box;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Instant;

use super::lattice::Lattice;
use super::points::Points;
use super::pyramid::Pyramid;
use super::shares::Shares;
use super::splat::{Gaussian, Picture, Splat};
use super::tasks::{Taker, Tasks, on_threads};
use super::walk::{Method, Walker};
use crate::aurora::eye::Eye;
use crate::aurora::sheet::{Falls, Streak};

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
    let drawing = Drawing { variant, job, tables, walker };
    let before = start.elapsed().as_secs_f64();
    let threads = if variant.threads { rayon::current_num_threads() } else { 1 };
    let parts: Vec<OnceLock<Part>> = std::iter::repeat_with(OnceLock::new).take(threads).collect();
    let tasks = Tasks::new(job.streaks, threads);
    let mut picture = tables.picture(job.eye.size);
    if tasks.is_empty() {
        // Else each row is written as a whole, or it is a thread's canvas.
        picture.pixels.fill([0.0; 4]);
    }
    let bands = Mutex::new(bands(&mut picture, threads));
    let (ready, drawn) = (start.elapsed().as_secs_f64(), OnceLock::new());
    on_threads(parts.iter(), |thread, part| {
        let mut taker = tasks.taker(thread);
        if let Some(own) = drawing.part(&mut taker) {
            // The thread's own place, in which nothing was before.
            let _ = part.set(own);
        }
        drop(taker);
        // A thread that comes late and has none waits as well, as the sum's bands are for all.
        tasks.wait();
        drawn.get_or_init(|| start.elapsed().as_secs_f64());
        let pyramids: Vec<&Pyramid> = parts.iter().filter_map(|part| part.get()?.canvas.layers()).collect();
        if !pyramids.is_empty() {
            sum_bands(&bands, &pyramids);
        }
    });
    drop(bands);
    let drawn = drawn.get().copied().unwrap_or(ready);
    let times = parts.iter().filter_map(OnceLock::get).fold([0.0, 0.0], |sum, part| [sum[0] + part.times[0], sum[1] + part.times[1]]);
    gather(parts.into_iter().filter_map(OnceLock::into_inner), &mut picture, tables);
    let total = start.elapsed().as_secs_f64();
    let walk = before + (drawn - ready) * times[0] / (times[0] + times[1]).max(1e-12);
    Timed { picture: black_box(picture), walk: walk * 1e3, splat: (total - walk) * 1e3 }
}

/// What all threads of a picture share.
struct Drawing<'a> {
    variant: Variant,
    job: &'a Job<'a>,
    tables: &'a Tables,
    walker: Walker<'a>,
}

/// What one thread has drawn.
struct Part {
    canvas: Canvas,
    /// Seconds of walk and of splats.
    times: [f64; 2],
}

impl Drawing<'_> {
    /// Walks and draws the electrons that a thread takes; None if there are none.
    fn part(&self, taker: &mut Taker) -> Option<Part> {
        let mut part: Option<Part> = None;
        let mut points = Points::default();
        for some in taker {
            let start = Instant::now();
            points.clear();
            self.walker.walk(self.variant.method, some, &mut points);
            let walked = start.elapsed().as_secs_f64();
            let part = part
                .get_or_insert_with(|| Part { canvas: Canvas::new(self.variant.splats, self.job.eye.size, self.tables), times: [0.0; 2] });
            part.canvas.add(&points, self.job, self.variant.splats, self.tables);
            part.times[0] += walked;
            part.times[1] += start.elapsed().as_secs_f64() - walked;
        }
        part
    }
}

/// Bands of rows, each of which one thread sums at once: there are more of them than threads, as no two threads are ready at once.
fn bands(picture: &mut Picture, threads: usize) -> impl Iterator<Item = (Range<usize>, &mut [[f32; 4]])> + Send {
    let [width, height] = picture.size;
    let band = height.div_ceil(if threads > 1 { 2 * threads } else { 1 }).max(1);
    let rows = (0..height).step_by(band).map(move |first| first..(first + band).min(height));
    rows.zip(picture.pixels.chunks_mut((width * band).max(1)))
}

/// Sums the pyramids of all threads in bands for as long as there are any.
fn sum_bands<'a>(bands: &Mutex<impl Iterator<Item = (Range<usize>, &'a mut [[f32; 4]])>>, pyramids: &[&Pyramid]) {
    loop {
        let next = bands.lock().unwrap_or_else(PoisonError::into_inner).next();
        let Some((rows, out)) = next else { break };
        Pyramid::sum(pyramids, rows, out);
    }
}

/// Adds up the pictures of the threads, if they have drawn any, and gives all memory back.
fn gather(parts: impl Iterator<Item = Part>, picture: &mut Picture, tables: &Tables) {
    let mut direct = false;
    for part in parts {
        match part.canvas {
            Canvas::Direct(own) if direct => {
                picture.merge(&own);
                tables.take_back(own);
            }
            Canvas::Direct(own) => {
                tables.take_back(std::mem::replace(picture, own));
                direct = true;
            }
            Canvas::Layers(pyramid) => tables.spare().push(pyramid),
        }
    }
}
