//! The time of a lookup on one core, all methods side by side.

use std::time::Instant;

use rand::SeedableRng;
use rand::rngs::SmallRng;

use super::methods::{Entry, Frame, Method};
use crate::chart::interleaved;
use lensrunner::lensing::adversarial::row;
use lensrunner::lensing::methods::{ProjectionInput, Vertex};
use lensrunner::spacetime::light::Order;

/// Camera radii that points are timed from.
const FRAMES: usize = 16;
/// Points for each.
const POINTS: usize = 1024;
/// Rounds, of which the median counts.
const ROUNDS: usize = 9;
/// A method's share of a round, seconds: a slow one does fewer points.
const SHARE: f64 = 0.02;

/// The points of a frame.
pub struct TimedFrame {
    /// The camera's radius.
    pub camera: f64,
    /// The points.
    pub points: Vec<Vertex>,
}

/// What a method takes.
#[derive(Clone, Copy, Debug)]
pub struct Timed {
    /// Nanoseconds a lookup, orders 1 and 2 alike.
    pub nanoseconds: f64,
    /// Microseconds to make ready for a frame.
    pub frame_microseconds: f64,
}

/// Adversarial points that every method has an answer for: the ranges of Yamashita 2012.
pub fn frames(seed: u64) -> Vec<TimedFrame> {
    let mut rng = SmallRng::seed_from_u64(seed ^ 0x5eed);
    let drawn: Vec<_> = (0..FRAMES * POINTS * 40).map(|_| row(&mut rng)).collect();
    let cameras: Vec<f64> = drawn.iter().map(|row| row.input.camera).filter(|l| (1.02..5000.0).contains(l)).take(FRAMES).collect();
    // The points are drawn around other cameras: kept as multiples of those.
    let points: Vec<(f64, f64)> = drawn.iter().map(|row| (row.input.r / row.input.camera, row.input.phi)).collect();
    let mut rest = points.into_iter();
    let frame = |camera: f64| {
        let within = |r: &f64| (1.006..9900.0).contains(r);
        let points = rest.by_ref().map(|(ratio, phi)| (ratio * camera, phi)).filter(|(r, _)| within(r)).take(POINTS);
        let points = points.map(|(r, phi)| ProjectionInput { r, phi, camera }.into()).collect();
        TimedFrame { camera, points }
    };
    cameras.into_iter().map(frame).collect()
}

/// Times every method.
pub fn measure(methods: &[(Entry, Box<dyn Method>)], frames: &[TimedFrame]) -> Vec<Timed> {
    let orders = [Order::ALL[0], Order::ALL[1]];
    let ready: Vec<Vec<Box<dyn Frame + '_>>> =
        methods.iter().map(|(_, method)| frames.iter().map(|frame| method.frame(frame.camera)).collect()).collect();
    let pass = |frame: &dyn Frame, points: &[Vertex]| orders.into_iter().for_each(|order| frame.look_up(points, order));
    // How many points a frame fit into a method's share of a round.
    let counts: Vec<usize> = ready
        .iter()
        .map(|ready| {
            let probe = 16;
            let start = Instant::now();
            for (frame, points) in ready.iter().zip(frames) {
                pass(frame.as_ref(), &points.points[..probe.min(points.points.len())]);
            }
            let each = start.elapsed().as_secs_f64() / (probe * frames.len()) as f64;
            ((SHARE / each.max(1e-12)) as usize / frames.len()).clamp(16, POINTS)
        })
        .collect();
    let repeats: Vec<usize> = counts.iter().map(|count| if *count == POINTS { 2 } else { 1 }).collect();
    let mut runs: Vec<Box<dyn FnMut() + '_>> = Vec::new();
    for ((ready, count), repeat) in ready.iter().zip(&counts).zip(&repeats) {
        runs.push(Box::new(move || {
            for _ in 0..*repeat {
                for (frame, points) in ready.iter().zip(frames) {
                    pass(frame.as_ref(), &points.points[..(*count).min(points.points.len())]);
                }
            }
        }));
    }
    let mut contestants: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run.as_mut() as &mut dyn FnMut()).collect();
    let times = interleaved(&mut contestants, ROUNDS);
    let lookups = |count: usize, repeat: usize| {
        (repeat * orders.len()) as f64 * frames.iter().map(|frame| frame.points.len().min(count)).sum::<usize>() as f64
    };
    let set_up = |method: &dyn Method| {
        let start = Instant::now();
        frames.iter().for_each(|frame| drop(std::hint::black_box(method.frame(frame.camera))));
        start.elapsed().as_secs_f64() / frames.len() as f64 * 1e6
    };
    times
        .iter()
        .zip(counts.iter().zip(&repeats))
        .zip(methods)
        .map(|((time, (count, repeat)), (_, method))| Timed {
            nanoseconds: time.median / lookups(*count, *repeat) * 1e9,
            frame_microseconds: set_up(method.as_ref()),
        })
        .collect()
}
