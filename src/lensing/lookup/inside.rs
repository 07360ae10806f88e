//! Camera and point both inside the horizon, in f32: the twin of shaders/lensing/inside.wgsl, line by line.
//!
//! Between two points inside there is no turning point, so with t = √r and q = e² the angle swept is
//!
//! Φ = ∫ 2 dt/W from √L to √r,  W² = 1 − t² + q t⁶.
//!
//! It falls with q, and 1/Φ² is concave in q (a power mean of functions linear in q), so Newton's method on 1/Φ² never overshoots from
//! below: no bracket is needed. The integral is taken by Gauss's rule in θ, t = √S sin θ, where S = 1 + δ is the root of W² that lies next
//! to the horizon while q is small (W² = S cos²θ − q (S³ − r³)), so that nothing is singular where r → 1 and e → 0 together.
//!
//! Both signs of E belong to one path. Their delays have a mean in closed form, that of the ray of zero energy:
//! mean = 2 [artanh t − t].

use super::source_point::{SourcePoint, angle};
use crate::lensing::closed_form::elementary::single::{log1p, stumpff};
use crate::lensing::single::LensCamera;

/// Steps of Newton's method: the sixth changes the direction by less than 0.001°.
const INSIDE_STEPS: u32 = 6;
/// A relative error of Φ that needs no further step: rounding has as much.
const INSIDE_CLOSE: f32 = 3e-7;
/// Nodes of Gauss's rule on (−1, 1), one half, and their weights (Abramowitz & Stegun 25.4.30, n = 12): the rule leaves 0.0002°.
const INSIDE_NODES: [[f32; 2]; 6] = [
    [0.125_233_41, 0.249_147_05],
    [0.367_831_5, 0.233_492_54],
    [0.587_317_94, 0.203_167_43],
    [0.769_902_7, 0.160_078_33],
    [0.904_117_3, 0.106_939_33],
    [0.981_560_65, 0.047_175_337],
];
/// The q from which the substitution needs no root: beyond it W² has no zero near the horizon.
const INSIDE_ROOT: f32 = 0.12;

/// The integrals over a path.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// Φ.
    pub sweep: f32,
    /// dΦ/dq.
    pub by_square: f32,
    /// ∫ (t⁴ + 3 t²) 2 dt/W.
    pub lag: f32,
}

/// The integrals from L to r of the path with q = e²; `zl` = 1 − L, `zr` = 1 − r, `dr` = r − L.
fn inside_path(q: f32, l: f32, r: f32, zl: f32, zr: f32, dr: f32) -> Path {
    let mut d = 0.5;
    if q < INSIDE_ROOT {
        // δ = q (1 + δ)³ by Newton's method.
        d = q;
        for _ in 0..4 {
            let s = 1.0 + d;
            d -= (q * s * s * s - d) / (3.0 * q * s * s - 1.0);
        }
    }
    let s = 1.0 + d;
    let (hl, hr) = (zl + d, zr + d);
    // sin and cos of the span of θ, without the difference of two angles.
    let sine = dr / ((r * hl).sqrt() + (l * hr).sqrt());
    let cosine = ((r * l).sqrt() + (hr * hl).sqrt()) / s;
    let half = 0.5 * angle(sine, cosine, 1.0);
    let middle = angle(l.sqrt(), hl.sqrt(), s.sqrt()) + half;
    let mut path = Path { sweep: 0.0, by_square: 0.0, lag: 0.0 };
    for k in 0..12 {
        let [x, weight] = INSIDE_NODES[k % 6];
        let theta = middle + if k < 6 { half * x } else { -half * x };
        let (sine, cos) = stumpff(theta * theta);
        let sin = theta * sine;
        let rho = s * sin * sin;
        let square = (s * cos * cos - d + q * rho * rho * rho).max(1e-12);
        let part = weight * half * 2.0 * cos * (s / square).sqrt();
        path.sweep += part;
        path.by_square -= 0.5 * part * rho * rho * rho / square;
        path.lag += part * (rho + 3.0) * rho;
    }
    path
}

/// (w, e, w_e, delay) of the ray that joins the point at `at` (inside, farther out than the camera, which is inside too) to the camera and
/// sweeps `sweep` > 0. Of the two rays it is the one whose light left on the same side of the zero-energy ray as light of age `elapsed`
/// (r_s/c): 0 asks for E > 0, anything huge for E < 0. None where there is no ray.
pub fn inside(cam: &LensCamera, at: SourcePoint, sweep: f32, elapsed: f32) -> Option<[f32; 4]> {
    let (l, r, dr) = (cam.l, at.r, at.dr);
    let (zl, zr) = (-cam.lapse2 * l, -at.lapse2 * r);
    if !(dr > 0.0 && zr > 0.0) {
        return None;
    }
    let (tl, tr) = (l.sqrt(), r.sqrt());
    let dt = dr / (tl + tr);
    // The ray of zero energy reaches farthest.
    if sweep >= 2.0 * angle(dr / (tr * zl.sqrt() + tl * zr.sqrt()), tr * tl + (zr * zl).sqrt(), 1.0) {
        return None;
    }
    // As if W were everywhere what it is halfway.
    let m = 0.5 * (tl + tr);
    let mut q = ((4.0 * dt * dt / (sweep * sweep) - (1.0 - m * m)) / (m * m * m * m * m * m)).max(0.0);
    let mut path = inside_path(q, l, r, zl, zr, dr);
    for _ in 0..INSIDE_STEPS {
        let turn = path.sweep / sweep;
        if (turn - 1.0).abs() < INSIDE_CLOSE {
            break;
        }
        q = (q - 0.5 * (turn * turn - 1.0) * path.sweep / path.by_square).max(0.0);
        path = inside_path(q, l, r, zl, zr, dr);
    }
    let e = q.sqrt();
    let (wl, wr) = ((zl + q * l * l * l).sqrt(), (zr + q * r * r * r).sqrt());
    // All that changes along the path is written with r − L.
    let fall = e * dt * (l + tl * tr + r) + dr * (q * (r * r + r * l + l * l) - 1.0) / (wl + wr);
    let plus = 2.0 * (log1p(dt / (1.0 + tl)) - log1p(fall / (e * l * tl + wl)) - dt) + e * path.lag;
    let mean = log1p(2.0 * dt * (1.0 + tr) / (zr * (1.0 + tl))) - 2.0 * dt;
    let (w, w_e) = (-wl / (l * tl), -wr / (r * tr));
    Some(if elapsed > mean { [w, -e, w_e, 2.0 * mean - plus] } else { [w, e, w_e, plus] })
}
