//! The experiment of Sekiguchi et al. (figure 5): ten auroras, numbers of electrons and radii of splats swept, seen from the side, from
//! below and from orbit, and from orbit through bent light. Times are medians of runs taken in turn; errors are against the exact line
//! integral.

use glam::DVec3;

use super::engine::draw::{Job, Splats, Tables, Timed, VARIANTS, draw};
use super::engine::points::Points;
use super::engine::splat::{Picture, Splat};
use super::engine::walk::{Method, Walker};
use super::eye::{Eye, Planet};
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
                let planet = Planet { at: DVec3::new(6.0, 0.0, -24.0), radius: 0.8, facing: DVec3::new(-0.5, -0.3, 0.8) };
                Eye::bent(Slice::new(table, 12.0), 12.0, &planet, degrees(0.32), size, 1)
            }
        }
    }
}

/// A way to draw that lives above this floor: the passes on a GPU.
pub trait Runner {
    /// Its name in the table.
    fn name(&self) -> &str;
    /// Draws the electrons; None if it cannot draw this view.
    fn draw(&mut self, job: &Job) -> Option<Timed>;
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
    let judge = request.counts.iter().max().map_or(JUDGE[0], |&count| (10u32.saturating_mul(count)).clamp(JUDGE[0], JUDGE[1]));
    let mut rows = Vec::new();
    for (view, name) in View::ALL {
        let eye = view.eye(request.size, table);
        for &radius in &request.radii {
            let splat = Splat { radius, table: true };
            let site = Site { view, name, eye: &eye, falls: &falls, splat, tables: &tables };
            let auroras: Vec<Aurora> = sheets.iter().map(|sheet| Aurora { sheet, truth: site.truth(sheet, judge) }).collect();
            for &count in &request.counts {
                report(&format!("{name}, {count} electrons, splats of {radius} km"));
                rows.extend(site.rows(&auroras, count, request.repeats, runners));
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

/// What all numbers of electrons are drawn with.
struct Site<'a> {
    view: View,
    /// The name of the view.
    name: &'static str,
    eye: &'a Eye,
    falls: &'a Falls,
    splat: Splat,
    tables: &'a Tables,
}

/// An aurora, and the picture of it as it should be.
struct Aurora<'a> {
    sheet: &'a Sheet,
    truth: Picture,
}

impl<'a> Site<'a> {
    fn job(&self, streaks: &'a [Streak], seed: u32) -> Job<'a> {
        Job { eye: self.eye, falls: self.falls, streaks, seed, splat: self.splat }
    }

    /// The picture as it should be. Through bent light there is no line integral to judge by but the particle method itself: `judge`
    /// electrons of another seed.
    fn truth(&self, sheet: &Sheet, judge: u32) -> Picture {
        if self.view != View::Bent {
            return Emission::new(sheet, self.falls, self.splat).picture(self.eye, 0.5 * f64::from(self.splat.radius).min(1.5));
        }
        let seed = sheet.seed + 7000;
        let streaks = Sheet { seed, ..sheet.clone() }.streaks(judge);
        draw(VARIANTS[4], &self.job(&streaks, seed), self.tables).picture
    }

    /// A row for each way that can draw the view, with `count` electrons: means over the auroras.
    fn rows(&self, auroras: &[Aurora], count: u32, repeats: usize, runners: &mut [Box<dyn Runner>]) -> Vec<Row> {
        let ways = VARIANTS.len() + runners.len();
        let mut sums = vec![[0.0f64; 5]; ways];
        let mut drawn = vec![true; ways];
        let mut points = 0.0;
        for Aurora { sheet, truth } in auroras {
            let streaks = sheet.streaks(count);
            let job = self.job(&streaks, sheet.seed);
            let mut found = Points::default();
            Walker::new(self.eye, self.falls, None, sheet.seed).walk(Method::Particles, &streaks, &mut found);
            points += found.len() as f64 / auroras.len() as f64;
            let heat = Heat::run(&job, truth, self.tables, repeats, runners);
            for way in 0..ways {
                drawn[way] &= heat.drawn[way];
                for (sum, value) in sums[way].iter_mut().zip(heat.result(way)) {
                    *sum += value / auroras.len() as f64;
                }
            }
        }
        let row = |way: usize| {
            let method = VARIANTS.get(way).map_or_else(|| runners[way - VARIANTS.len()].name(), |variant| variant.name).to_owned();
            let [walk, splat, total, error, difference] = sums[way];
            Row { view: self.name, method, count, radius: self.splat.radius, points, walk, splat, total, error, difference }
        };
        (0..ways).filter(|&way| drawn[way]).map(row).collect()
    }
}

/// What all ways came to with one aurora: those of [`VARIANTS`], then the runners.
struct Heat {
    /// Of each way and run: milliseconds from electrons to points, from points to the picture, and both.
    times: Vec<Vec<[f64; 3]>>,
    /// Of each way: error against the truth and difference from the particle method.
    errors: Vec<[f64; 2]>,
    /// Which ways can draw the view.
    drawn: Vec<bool>,
    /// Pictures of the particle method, with which others are compared.
    pictures: Vec<Option<Picture>>,
}

impl Heat {
    /// Draws the job in every way, in turn, so that what else the machine does falls on all alike.
    fn run(job: &Job, truth: &Picture, tables: &Tables, repeats: usize, runners: &mut [Box<dyn Runner>]) -> Heat {
        let ways = VARIANTS.len() + runners.len();
        let mut heat = Heat {
            times: vec![Vec::new(); ways],
            errors: vec![[f64::NAN; 2]; ways],
            drawn: vec![true; ways],
            pictures: vec![None; VARIANTS.len()],
        };
        for run in 0..repeats.max(LEAST_RUNS) {
            for way in 0..ways {
                if run >= repeats.max(1) && way < VARIANTS.len() {
                    continue;
                }
                let timed = match VARIANTS.get(way) {
                    Some(variant) => Some(draw(*variant, job, tables)),
                    None => runners[way - VARIANTS.len()].draw(job),
                };
                match timed {
                    Some(timed) => heat.take(way, timed, truth, tables),
                    None => heat.drawn[way] = false,
                }
            }
        }
        heat
    }

    /// Takes up one run of a way.
    fn take(&mut self, way: usize, timed: Timed, truth: &Picture, tables: &Tables) {
        self.times[way].push([timed.walk, timed.splat, timed.walk + timed.splat]);
        let own = reference(way);
        let other = own.and_then(|own| self.pictures[own].as_ref()).unwrap_or(&timed.picture);
        self.errors[way] = [timed.picture.error(truth), timed.picture.error(other)];
        // Those of an adapter come from elsewhere.
        if own == Some(way) {
            // For all ways alike, the one before is taken back.
            if let Some(before) = self.pictures[way].replace(timed.picture) {
                tables.take_back(before);
            }
        } else if way < VARIANTS.len() {
            tables.take_back(timed.picture);
        }
    }

    /// Medians of a way's times, then its errors.
    fn result(&self, way: usize) -> [f64; 5] {
        let median = |k: usize| {
            let mut column: Vec<f64> = self.times[way].iter().map(|time| time[k]).collect();
            column.sort_by(f64::total_cmp);
            column.get(column.len() / 2).copied().unwrap_or(f64::NAN)
        };
        let [error, difference] = self.errors[way];
        [median(0), median(1), median(2), error, difference]
    }
}
