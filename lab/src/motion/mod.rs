//! How the motion of a near body is told to the graphics card: one smooth motion about its centre's emission time, or so many nodes of what
//! was recorded. Error against the processor's time, while hands fly: `lensrunner-lab chart motion`.

pub mod smooth;

use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use glam::DVec3;

use crate::chart::{ChartError, Output, Provenance, Sheet, mean, quantile};
use crate::compare::flight::hands::PACES;
use crate::plot::{Axis, Figure, Guide, Panel, Point, Scatter};
use lensrunner::argument::whole;
use lensrunner::render::gpu::types::Instance;
use lensrunner::render::gpu::types::placed::STRAYS;
use lensrunner::render::instances::local_motion::{ImageExtent, LocalMotion, local_motion_at};
use lensrunner::scene::mission::Difficulty;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::{History, Moment};
use lensrunner::spacetime::matter::gamma;
use smooth::Smooth;

/// How the motion of a near body is told to the graphics card, smooth or by nodes: error against cost, while hands fly.
#[derive(Args, Clone, Debug)]
pub struct MotionRequest {
    /// Where the chart goes.
    #[command(flatten)]
    pub output: Output,
    /// Moments at each pace.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = whole::<usize>(1, 100_000))]
    pub moments: usize,
}

/// Columns of the sheet: displacement of points of the own ship in pixels of a picture 640 wide, and the processor's time for an image.
pub const COLUMNS: [&str; 6] = ["way", "pace", "mean_px", "p99_px", "max_px", "microseconds"];

/// The mission that is flown, with bolts.
const MISSION: &str = "06-the-long-shot";
/// Distance of the hunter's farthest vertex from its centre, in r_s.
const REACH: f64 = 0.145;
/// From this far, in r_s, the own ship is seen in a picture of this many pixels over 60°.
const SEEN: (f64, f64) = (0.86, 640.0);
/// Times between nodes that are asked for, as the widths (px) of images that would have them.
const WIDTHS: [f64; 3] = [1.0, 9.0, 64.0];
/// T of the first moment, and between two, in r_s/c.
const TIMES: (f64, f64) = (3.0, 0.37);

/// Measures (or reads) `motion.csv`, draws `motion.png`; returns the files.
pub fn run(request: &MotionRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.sheet("motion", || measure(request.moments))?;
    let mut files = vec![request.output.csv("motion")];
    files.extend(figure(&sheet).save(&request.output.folder, "motion")?);
    Ok(files)
}

/// Displacements and seconds of one way.
#[derive(Default)]
struct Measured {
    errors: Vec<f64>,
    seconds: Vec<f64>,
}

/// A row for each way and pace.
pub fn measure(moments: usize) -> Result<Sheet, ChartError> {
    let scene = scene::load(MISSION)?;
    let mut sheet = Sheet::measured(&COLUMNS, "");
    for (seed, pace) in PACES.into_iter().enumerate() {
        let mut config = GameConfig::default();
        config.clock.pace = pace;
        let config = scene.config(&config, Difficulty::Easy);
        let mut moment = Moment::with_pilot(&scene, &config, seed as u64, PilotKind::Hands);
        let last = TIMES.0 + TIMES.1 * moments as f64 + 1.0;
        moment.advance((last / config.clock.step) as u64);
        let history = moment.histories()[0];
        let mut smooth = Measured::default();
        let mut nodes: [(f64, Measured); WIDTHS.len()] = WIDTHS.map(|_| (0.0, Measured::default()));
        for k in 0..moments {
            let emission = TIMES.0 + TIMES.1 * k as f64;
            let began = Instant::now();
            let way = black_box(Smooth::new(history, emission, REACH, config.clock.step));
            smooth.seconds.push(began.elapsed().as_secs_f64());
            smooth.errors.extend(displaced(history, emission, |body, s| way.at(body, s)));
            for ((intervals, measured), width) in nodes.iter_mut().zip(WIDTHS) {
                let seen = ImageExtent { span: 1.5 * REACH, width, pixel: pixel() };
                let began = Instant::now();
                let local_motion = black_box(LocalMotion::new(history, emission, REACH, &seen, Vec::new()));
                measured.seconds.push(began.elapsed().as_secs_f64());
                *intervals += (local_motion.nodes.len() - 1) as f64 / moments as f64;
                let instance = instance_of(history, emission, &local_motion);
                measured.errors.extend(displaced(history, emission, |body, s| {
                    local_motion_at(&instance, &local_motion.nodes, body.as_vec3(), s as f32).0.as_dvec3()
                }));
            }
        }
        sheet.line(row("smooth", pace, smooth));
        for (intervals, measured) in nodes {
            sheet.line(row(&format!("nodes {intervals:.0}"), pace, measured));
        }
    }
    Ok(sheet)
}

fn row(way: &str, pace: f64, Measured { errors, seconds }: Measured) -> String {
    let [most, worst] = [0.99, 1.0].map(|share| quantile(errors.iter().copied(), share));
    format!("{way}|{pace}|{:.5}|{most:.4}|{worst:.4}|{:.2}", mean(&errors), 1e6 * quantile(seconds, 0.5))
}

/// What a pixel spans at the ship, in r_s.
fn pixel() -> f64 {
    SEEN.0 * 2.0 * 30f64.to_radians().tan() / SEEN.1
}

/// How far points of the ship are from where its history has them while light crosses it, in pixels.
fn displaced(history: &History, emission: f64, way: impl Fn(DVec3, f64) -> DVec3) -> Vec<f64> {
    let centre = history.at(emission).position;
    let points = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::new(0.6, 0.3, -0.5)].map(|point| point * REACH);
    let times = (-8..=8).map(|k| 1.4 * REACH * f64::from(k) / 8.0);
    let off = |body: DVec3, s: f64| {
        let there = history.at(emission + s);
        let (y, p) = (there.attitude * body, there.momentum);
        let g = gamma(p);
        let exact = there.position + y - p * (p.dot(y) / (g * (1.0 + g))) - centre;
        way(body, s).distance(exact) / pixel()
    };
    times.flat_map(|s| points.map(|body| off(body, s))).collect()
}

/// What of an instance tells the motion, for a body of a unit of 1 r_s.
fn instance_of(history: &History, emission: f64, local_motion: &LocalMotion) -> Instance {
    let now = history.at(emission);
    let numbers = |v: DVec3| v.as_vec3().to_array();
    let [first_node, step] = local_motion.times.map(|time| time as f32);
    Instance {
        velocity: numbers(now.velocity),
        scale: 1.0,
        acceleration: numbers(local_motion.acceleration),
        jerk: numbers(local_motion.jerk),
        snap: numbers(local_motion.snap),
        contraction: numbers(now.momentum),
        force: numbers(local_motion.force),
        flags: if local_motion.strays { STRAYS } else { 0 },
        first_node,
        nodes_per_time: step.recip(),
        node_intervals: (local_motion.nodes.len() - 1) as f32,
        ..Instance::default()
    }
}

/// Error against the processor's time.
pub fn figure(sheet: &Sheet) -> Figure {
    let families = ["one smooth motion", "nodes"];
    let points = sheet.rows.iter().map(|row| {
        let way = sheet.text(row, "way");
        let family = usize::from(way != "smooth");
        let label = if sheet.text(row, "pace") == "0.05" { way.to_owned() } else { String::new() };
        let (x, y) = (sheet.number(row, "microseconds"), sheet.number(row, "p99_px").max(1e-4));
        Point { x, y, label, family, failed: false, chosen: false }
    });
    let panel = Panel::Scatter(Scatter {
        title: "Own ship, 640 pixels".into(),
        x: Axis::log("processor's time for an image, µs"),
        y: Axis::log("displacement that 99 % stay below, px"),
        points: points.collect(),
        families: families.map(String::from).to_vec(),
        guides: vec![Guide { at: 0.5, label: "the budget".into() }],
        ..Scatter::default()
    });
    // At each pace the best of a way, and of all paces the worst.
    let worst = |smooth: bool| {
        let best = |pace: &f64| {
            let rows = sheet.rows.iter().filter(|row| sheet.number(row, "pace") == *pace && (sheet.text(row, "way") == "smooth") == smooth);
            rows.map(|row| sheet.number(row, "p99_px")).fold(f64::INFINITY, f64::min)
        };
        PACES.iter().map(best).filter(|best| best.is_finite()).fold(0.0, f64::max)
    };
    Figure {
        verdict: format!("In hands one smooth motion is off by up to {:.1} px, nodes by {:.2} px", worst(true), worst(false)),
        title: "How a near body's motion is told: error against cost".into(),
        subtitle: "Seeded hands at five paces, a point each; the number of times between nodes. Left and down is better.".into(),
        panels: vec![panel],
        columns: 1,
        size: [900, 640],
        footer: Provenance::footer(&sheet.notes),
    }
}
