//! The experiment of Sekiguchi et al. (figure 5): ten auroras, numbers of electrons and radii of splats swept, seen from the side, from
//! below and from orbit, and from orbit through bent light. Times are medians of runs taken in turn; errors are against the exact line
//! integral.

use std::time::Instant;

use glam::DVec3;

use super::eye::{Eye, Planet};
use super::lattice::Lattice;
use super::sheet::{Falls, FlatAurora, Streak, field_direction};
use super::splat::{Gaussian, SplatPicture};
use super::truth::Emission;
use super::walk::{Method, Walker};
use lensrunner::lensing::{Slice, Table};

/// From where the auroras are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewpoint {
    /// From the ground 700 km to the south.
    Side,
    /// From the ground under the arcs, along the field.
    Below,
    /// From 900 km up, looking down on them.
    Orbit,
    /// On a planet near a black hole, through its lensing.
    Bent,
}

impl Viewpoint {
    /// All of them, and their names.
    pub const ALL: [(Viewpoint, &'static str); 4] =
        [(Viewpoint::Side, "side"), (Viewpoint::Below, "below"), (Viewpoint::Orbit, "orbit"), (Viewpoint::Bent, "bent")];

    /// The camera of the view; `table` is used by the bent one alone.
    pub fn eye(self, size: [usize; 2], table: &Table) -> Eye {
        let degrees = |d: f64| d.to_radians();
        match self {
            Viewpoint::Side => Eye::flat(DVec3::new(0.0, -700.0, 1.0), DVec3::new(0.0, 0.0, 190.0), DVec3::Z, degrees(45.0), size),
            Viewpoint::Below => {
                let up = field_direction();
                let foot = DVec3::new(10.0, 32.0, 1.0);
                Eye::flat(foot, foot + up * 100.0, DVec3::Y, degrees(90.0), size)
            }
            Viewpoint::Orbit => Eye::flat(DVec3::new(250.0, -500.0, 900.0), DVec3::new(0.0, 20.0, 130.0), DVec3::Z, degrees(40.0), size),
            Viewpoint::Bent => {
                // A planet of 0.8 r_s on the other side of the hole, 25 r_s out, seen past it from 12 r_s.
                let planet = Planet { at: DVec3::new(6.0, 0.0, -24.0), radius: 0.8, facing: DVec3::new(-0.5, -0.3, 0.8) };
                Eye::bent(Slice::new(table, 12.0), 12.0, &planet, degrees(0.32), size, 1)
            }
        }
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
    /// Standard deviation of a point's light, km.
    pub radius: f32,
}

/// A picture, and how long its two stages took, in milliseconds.
#[derive(Clone, Debug)]
pub struct Timed {
    /// The picture.
    pub picture: SplatPicture,
    /// From electrons to points.
    pub walk: f64,
    /// From points to the picture.
    pub splat: f64,
}

/// Error allowed to chords through bent light, pixels.
pub const TOLERANCE: f32 = 0.25;

/// Electrons walked before their points are drawn: those nearly fit into a processor's first cache.
const TOGETHER: usize = 64;

/// Draws `job` on one thread of the processor: some electrons are walked, their points drawn, then the next.
pub fn draw(method: Method, job: &Job, gaussian: &Gaussian) -> Timed {
    let start = Instant::now();
    // In flat space each streak is one chord, of its own.
    let lattice = (method == Method::Exact && job.eye.bent.is_some()).then(|| Lattice::around(job.eye, job.streaks, TOLERANCE));
    let walker = Walker::new(job.eye, job.falls, lattice.as_ref(), job.seed);
    let mut walk = start.elapsed().as_secs_f64();
    let mut picture = SplatPicture::new(job.eye.size);
    let mut points = Vec::new();
    for streaks in job.streaks.chunks(TOGETHER) {
        let before = Instant::now();
        points.clear();
        walker.walk(method, streaks, &mut points);
        walk += before.elapsed().as_secs_f64();
        picture.add(&points, job.falls, job.radius, gaussian);
    }
    let total = start.elapsed().as_secs_f64();
    Timed { picture, walk: walk * 1e3, splat: (total - walk) * 1e3 }
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
    pub method: &'static str,
    /// Electrons.
    pub count: u32,
    /// Standard deviation of a point's light, km.
    pub radius: f32,
    /// Milliseconds from electrons to points, from points to the picture, and both.
    pub walk: f64,
    /// See `walk`.
    pub splat: f64,
    /// See `walk`.
    pub total: f64,
    /// Root mean square error of the picture over that of the truth. With few electrons it is their grain for the most part, whatever the
    /// walk.
    pub error: f64,
    /// The same against the particle method with the same electrons and random numbers: what the walk itself gets wrong.
    pub difference: f64,
}

/// Runs the experiment; `report` is told what is being drawn.
pub fn run(request: &ExperimentRequest, table: &Table, mut report: impl FnMut(&str)) -> Vec<Row> {
    let falls = Falls::new();
    let gaussian = Gaussian::default();
    let sheets = FlatAurora::ten();
    let sheets = &sheets[..request.auroras.clamp(1, 10)];
    let judge = request.counts.iter().max().map_or(JUDGE[0], |&count| (10u32.saturating_mul(count)).clamp(JUDGE[0], JUDGE[1]));
    let mut rows = Vec::new();
    for (view, name) in Viewpoint::ALL {
        let eye = view.eye(request.size, table);
        for &radius in &request.radii {
            let site = Site { name, eye: &eye, falls: &falls, radius, gaussian: &gaussian };
            let auroras: Vec<Aurora> = sheets.iter().map(|sheet| Aurora { sheet, truth: site.truth(sheet, judge) }).collect();
            for &count in &request.counts {
                report(&format!("{name}, {count} electrons, splats of {radius} km"));
                rows.extend(site.rows(&auroras, count, request.repeats.max(1)));
            }
        }
    }
    rows
}

/// Electrons of the judge through bent light, at least and at most.
const JUDGE: [u32; 2] = [10_000, 150_000];

/// What all numbers of electrons are drawn with.
struct Site<'a> {
    /// The name of the view.
    name: &'static str,
    eye: &'a Eye,
    falls: &'a Falls,
    radius: f32,
    gaussian: &'a Gaussian,
}

/// An aurora, and the picture of it as it should be.
struct Aurora<'a> {
    sheet: &'a FlatAurora,
    truth: SplatPicture,
}

impl<'a> Site<'a> {
    fn job(&self, streaks: &'a [Streak], seed: u32) -> Job<'a> {
        Job { eye: self.eye, falls: self.falls, streaks, seed, radius: self.radius }
    }

    /// The picture as it should be. Through bent light there is no line integral to judge by but the particle method itself: `judge`
    /// electrons of another seed.
    fn truth(&self, sheet: &FlatAurora, judge: u32) -> SplatPicture {
        if self.eye.bent.is_none() {
            let radius = f64::from(self.radius);
            return Emission::new(sheet, self.falls, radius).picture(self.eye, 0.5 * radius.min(1.5));
        }
        let seed = sheet.seed + 7000;
        let streaks = FlatAurora { seed, ..sheet.clone() }.streaks(judge);
        draw(Method::Particles, &self.job(&streaks, seed), self.gaussian).picture
    }

    /// A row for each method, with `count` electrons: means over the auroras.
    fn rows(&self, auroras: &[Aurora], count: u32, repeats: usize) -> Vec<Row> {
        let mut sums = [[0.0; 5]; Method::ALL.len()];
        for Aurora { sheet, truth } in auroras {
            let streaks = sheet.streaks(count);
            let job = self.job(&streaks, sheet.seed);
            let mut runs: [Vec<Timed>; Method::ALL.len()] = Default::default();
            // In turn, so that what else the machine does falls on all alike.
            for _ in 0..repeats {
                for ((method, _), runs) in Method::ALL.iter().zip(&mut runs) {
                    runs.push(draw(*method, &job, self.gaussian));
                }
            }
            let reference = &runs[0][0].picture;
            for (sums, runs) in sums.iter_mut().zip(&runs) {
                let picture = &runs[0].picture;
                let times = [median(runs, |run| run.walk), median(runs, |run| run.splat), median(runs, |run| run.walk + run.splat)];
                for (sum, value) in sums.iter_mut().zip(times.into_iter().chain([picture.error(truth), picture.error(reference)])) {
                    *sum += value / auroras.len() as f64;
                }
            }
        }
        let row = |((_, method), [walk, splat, total, error, difference]): (&(Method, &'static str), [f64; 5])| Row {
            view: self.name,
            method,
            count,
            radius: self.radius,
            walk,
            splat,
            total,
            error,
            difference,
        };
        Method::ALL.iter().zip(sums).map(row).collect()
    }
}

/// The median of a time of some runs.
fn median(runs: &[Timed], time: impl Fn(&Timed) -> f64) -> f64 {
    let mut times: Vec<f64> = runs.iter().map(time).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
