//! The error of a table on fresh random points, against the exact ray.

use std::f64::consts::PI;

use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use super::lookup::{LensRay, OLD, YOUNG, lens_lookup_aged};
use super::methods::ProjectionInput;
use super::table::slice::Slice;
use super::table::{Scheme, Table};
use super::{adversarial, paper};
use crate::spacetime::light::{Branch, Order, connect, rain_angle, static_angle};

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Points {
    /// Those of [`adversarial`] outside of the horizon.
    Adversarial,
    /// L log-uniform over 1.01 … 5000, half the points clustered at the camera, nothing nearer than 0.01 √L.
    Friendly,
}

/// A point and a camera: r, φ, L.
pub fn draw(points: Points, rng: &mut SmallRng) -> [f64; 3] {
    loop {
        let ([r, phi, l], fits) = match points {
            Points::Adversarial => {
                let ProjectionInput { r, phi, camera } = adversarial::row(rng).input;
                ([r, phi, camera], r >= adversarial::POINTS[0])
            }
            Points::Friendly => friendly(rng),
        };
        if fits {
            return [r, phi, l];
        }
    }
}

/// A friendly point, and whether it lies where friendly points do.
fn friendly(rng: &mut SmallRng) -> ([f64; 3], bool) {
    let l = adversarial::between(rng, [1.01, 5000.0]);
    let clustered = rng.random_bool(0.5);
    let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let r = if clustered { l * (1.0 + side * adversarial::between(rng, [1e-4, 1.0])) } else { adversarial::between(rng, [1.005, 1e4]) };
    let phi = PI * if clustered { adversarial::between(rng, [1e-5, 1.0]) } else { rng.random::<f64>() };
    let half = (0.5 * phi).sin();
    let distance = ((r - l).powi(2) + 4.0 * r * l * half * half).sqrt();
    ([r, phi, l], (1.005..=1e4).contains(&r) && distance >= 0.01 * l.sqrt())
}

/// Maximum, 99.9th percentile and root mean square of some errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spread {
    /// The largest.
    pub max: f64,
    /// The 99.9th percentile.
    pub most: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The row (r, φ, L) of the largest.
    pub worst: [f64; 3],
}

/// The errors of one order.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    /// The angle between the directions, in degrees: in the rain frame, for the tables of Yamashita 2012 in the static frame as stored.
    pub angle: Spread,
    /// The error of the delay in r_s/c outside r = 1.05.
    pub delay: Spread,
    /// The same from there down to the horizon.
    pub delay_near: Spread,
    /// The error of the delay over its allowance, 0.002 + 3e-7 × delay outside r = 1.05, 0.02 nearer.
    pub delay_share: Spread,
    /// The error of the angle atan2(1/r, −w_e) of the slope at the point, in degrees.
    pub emission: Spread,
}

fn spread(mut values: Vec<(f64, [f64; 3])>) -> Spread {
    if values.is_empty() {
        return Spread::default();
    }
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = values.len();
    let (max, worst) = values[n - 1];
    let rms = (values.iter().map(|v| v.0 * v.0).sum::<f64>() / n as f64).sqrt();
    Spread { max, most: values[((n as f64 * 0.999) as usize).min(n - 1)].0, rms, worst }
}

/// The table's answer for one row through the f32 lookup, positions differenced in f64 first.
pub fn look_up_row(slice: &Slice, row: [f64; 3], order: Order) -> LensRay {
    look_up_row_on(slice, row, order, Branch::Plus)
}

/// The same for either sign of E, which matters only where both ends are inside the horizon.
pub fn look_up_row_on(slice: &Slice, [r, phi, l]: [f64; 3], order: Order, branch: Branch) -> LensRay {
    let elapsed = if branch == Branch::Minus { OLD } else { YOUNG };
    let half = (0.5 * phi).sin();
    // r cos φ − L in a form that keeps its digits near the camera.
    let along = (r - l) - 2.0 * r * half * half;
    lens_lookup_aged(slice, along as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, u32::from(order.number()), elapsed)
}

/// The errors of `table` for each order on `count` points of each, drawn from `seed`.
pub fn score(table: &Table, points: Points, count: usize, seed: u64) -> Vec<Score> {
    let orders = if table.scheme == Scheme::Residual { 3 } else { 2 };
    Order::ALL.into_iter().take(orders).map(|order| score_order(table, points, count, seed, order)).collect()
}

/// r, φ, L, and the errors: angle in degrees, delay in r_s/c, the delay itself, emission in degrees.
type ScoredRow = ([f64; 3], [f64; 4]);

fn score_order(table: &Table, points: Points, count: usize, seed: u64, order: Order) -> Score {
    let rows: Vec<ScoredRow> = (0..count)
        .into_par_iter()
        .filter_map(|i| {
            let mut rng = SmallRng::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ ((order.number() as u64) << 40 | i as u64));
            let row = draw(points, &mut rng);
            let [r, phi, l] = row;
            let exact = connect(1.0 / r, order.swept(phi), 1.0 / l, Branch::Plus)?;
            if table.scheme != Scheme::Residual {
                let exact_angle = static_angle(exact.slope, exact.energy, 1.0 / l)?;
                let seen = paper::lookup(table, row, order.number());
                return Some((row, [(seen[0] - exact_angle).abs().to_degrees(), (seen[1] - exact.delay).abs(), exact.delay, 0.0]));
            }
            let seen = look_up_row(&Slice::new(table, l), row, order);
            let psi = rain_angle(exact.slope, exact.energy, 1.0 / l);
            let (cos, sin) = (seen.cos_psi as f64, seen.sin_psi as f64);
            let angle = (sin * psi.cos() - cos * psi.sin()).atan2(cos * psi.cos() + sin * psi.sin()).abs();
            let angle = if seen.valid { angle } else { std::f64::consts::PI };
            let emission = ((1.0 / r).atan2(-seen.emission_slope as f64) - (1.0 / r).atan2(-exact.emission_slope)).abs();
            Some((row, [angle.to_degrees(), (seen.delay as f64 - exact.delay).abs(), exact.delay, emission.to_degrees()]))
        })
        .collect();
    let pick = |f: &dyn Fn(&ScoredRow) -> Option<f64>| spread(rows.iter().filter_map(|x| Some((f(x)?, x.0))).collect());
    Score {
        angle: pick(&|x| Some(x.1[0])),
        delay: pick(&|x| (x.0[0] >= 1.05).then_some(x.1[1])),
        delay_near: pick(&|x| (x.0[0] < 1.05).then_some(x.1[1])),
        delay_share: pick(&|x| Some(x.1[1] / if x.0[0] < 1.05 { 0.02 } else { 0.002 + 3e-7 * x.1[2] })),
        emission: pick(&|x| Some(x.1[3])),
    }
}
