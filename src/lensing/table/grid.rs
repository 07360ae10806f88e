//! The coordinates of the residual table: which (r, Φ, L) its nodes stand for.

use crate::lensing::closed_form::elementary::double::stumpff;
use crate::lensing::double::{LARGEST_SWEEP, LensCamera, POINT_RANGE, axes, bent_sweep, camera, lens_equation, near_axis};

/// The range of camera radii, in r_s.
pub const CAMERA_RANGE: [f64; 2] = [0.05, 5000.0];

/// Where nodes of L crowd: ln L of the middle, the width in ln L, and the weight beside [`PLAIN`]. Around the horizon, and around L = 2.5,
/// where the closed form goes from strong to weak fields. By hand, by the measured error; the table is right for any of them.
const CROWDED: [(f64, f64, f64); 2] = [(0.0, 0.2, 0.7), (0.9, 0.4, 1.2)];
/// Weight of ln L itself.
const PLAIN: f64 = 0.5;

/// ln L, stretched where nodes crowd.
fn camera_raw(l: f64) -> f64 {
    let crowd = |(middle, width, weight): (f64, f64, f64)| weight * ((l.ln() - middle) / width).asinh();
    PLAIN * l.ln() + crowd(CROWDED[0]) + crowd(CROWDED[1])
}

/// The third coordinate, 0 to 1 over `CAMERA_RANGE`.
pub fn camera_axis(l: f64) -> f64 {
    let (first, last) = (camera_raw(CAMERA_RANGE[0]), camera_raw(CAMERA_RANGE[1]));
    (camera_raw(l) - first) / (last - first)
}

/// Where in lo..=hi the increasing `f` is `value`.
fn invert(f: impl Fn(f64) -> f64, value: f64, [mut lo, mut hi]: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if f(middle) < value { lo = middle } else { hi = middle }
    }
    0.5 * (lo + hi)
}

/// The camera radius at the third coordinate `z`.
pub fn camera_radius(z: f64) -> f64 {
    invert(|l| camera_axis(l.exp()), z, CAMERA_RANGE.map(f64::ln)).exp()
}

/// The first two coordinates, for c = 1/r and the angle swept.
pub fn coordinates(cam: &LensCamera, c: f64, sweep: f64) -> (f64, f64) {
    let bent = bent_sweep(sweep);
    let [_, h, _] = lens_equation(cam, c, bent, stumpff(0.25 * bent * bent));
    axes(cam, (1.0 - c).max(0.0).sqrt(), sweep, [(c + cam.soft).ln(), near_axis(sweep).ln(), (0.5 * h).ln()])
}

/// 1/r at the first coordinate `x`.
pub fn point(cam: &LensCamera, x: f64) -> f64 {
    invert(|c| coordinates(cam, c, 0.0).0, x, POINT_RANGE)
}

/// Φ at the second coordinate `y`; the last nodes lie somewhat beyond 3π.
pub fn sweep(cam: &LensCamera, c: f64, y: f64) -> f64 {
    invert(|p| coordinates(cam, c, p).1, y, [0.0, 1.5 * LARGEST_SWEEP])
}

/// The camera at the third coordinate `z`.
pub fn camera_at(z: f64) -> LensCamera {
    camera(camera_radius(z))
}
