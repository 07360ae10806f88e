//! The exact joining of points by light, judged by a plain numerical integration of the orbit, by tabulated values and by laws.

use lensrunner::spacetime::light::{
    Branch, Connection, Fate, Order, connect, follow, join, join_near, launch, rain_angle, rain_momentum, shadow_angle, sky_angle,
    sky_slope, static_angle, static_redshift, swept_to_sky,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// A ray integrated step by step: u, w = du/dΦ, ∂u/∂w₀ and its slope, and the Painlevé–Gullstrand travel time, over Φ.
type State = [f64; 5];

/// The right-hand side. dT/dΦ is written from the photon's rain-frame momentum, in one of two forms that agree on the orbit:
/// `rising` is singular only where light crosses the future horizon, the other only where it turns or left the past horizon. One step keeps to one form, for between the stages of
/// a step w and e do not quite fit each other.
fn rate(y: &State, e: f64, rising: bool) -> State {
    let [u, w, v, v_slope, _] = *y;
    let beta = u.sqrt();
    let time = if rising {
        (e + beta * w) / (u * u * (1.0 - u))
    } else {
        (beta * u * u - e * w) / (u * u * (beta * e - w))
    };
    [w, -u + 1.5 * u * u, v_slope, (3.0 * u - 1.0) * v, time]
}

fn plus(a: &State, b: &State, h: f64) -> State {
    std::array::from_fn(|i| a[i] + h * b[i])
}

/// One step by Gragg's midpoint rule extrapolated to order 14.
fn step(y: &State, h: f64, e: f64) -> State {
    const ROWS: usize = 7;
    let rising = e < 0.0 || y[0] < 0.9 || (y[0] < 1.0 && y[1] > -0.5 * e);
    let mut table: Vec<State> = Vec::new();
    for row in 0..ROWS {
        let n = 2 * (row + 1);
        let small = h / n as f64;
        let (mut before, mut now) = (*y, plus(y, &rate(y, e, rising), small));
        for _ in 1..n {
            (before, now) = (now, plus(&before, &rate(&now, e, rising), 2.0 * small));
        }
        let end: State = plus(&plus(&now, &before, 1.0), &rate(&now, e, rising), small).map(|x| 0.5 * x);
        let mut best = end;
        for column in 0..row {
            let from = (row - column) as f64 / (row + 1) as f64;
            let previous = table[column];
            table[column] = best;
            best = std::array::from_fn(|i| best[i] + (best[i] - previous[i]) / (1.0 / (from * from) - 1.0));
        }
        table.push(best);
    }
    // The last diagonal element.
    *table.last().expect("rows")
}

/// Carries a ray over `swept`, which may be negative.
fn integrate(u: f64, w: f64, e: f64, swept: f64) -> State {
    let mut y = [u, w, 0.0, 1.0, 0.0];
    let mut left = swept.abs();
    while left > 0.0 {
        let [u, w, ..] = y;
        // Short against the distance to r = ∞, to r = 0 and to the past horizon.
        let mut h: f64 = (0.15_f64).min(0.1 * u / w.abs()).min(0.1 / u.sqrt());
        if e * w > 0.0 {
            h = h.min(0.1 * (1.0 - u).abs() / w.abs());
        }
        let h = if h > 0.999 * left { left } else { h };
        y = step(&y, h.copysign(swept), e);
        left -= h;
    }
    y
}

/// What the integrator makes of a connection: both ends are integrated to the middle, where they should meet.
struct Verdict {
    /// The error of ψ in the rain frame at the camera, radians.
    angle: f64,
    /// The error of the slope at the point, against |w_e| + u.
    emission: f64,
    /// The relative error of the travel time.
    delay: f64,
}

fn judge(c: &Connection, u_point: f64, swept: f64, u: f64) -> Verdict {
    let near = integrate(u, c.slope, c.energy, 0.5 * swept);
    let far = integrate(u_point, c.emission_slope, c.energy, -0.5 * swept);
    // Newton's correction of both slopes: u and w must agree in the middle.
    let (du, dw) = (far[0] - near[0], far[1] - near[1]);
    let determinant = near[2] * far[3] - near[3] * far[2];
    let at_camera = (du * far[3] - dw * far[2]) / determinant;
    let at_point = (du * near[3] - dw * near[2]) / determinant;
    // Along it e² = w² + u² − u³ changes too.
    let energy = c.energy + c.slope * at_camera / c.energy;
    let angle = (rain_angle(c.slope + at_camera, energy, u) - rain_angle(c.slope, c.energy, u)).abs();
    Verdict {
        angle,
        emission: at_point.abs() / (c.emission_slope.abs() + u_point),
        delay: ((near[4] - far[4]) / c.delay - 1.0).abs(),
    }
}
