//! The lookup in f32: the twin of shaders/functions/lensing.wgsl, line by line.

use super::single::*;
use super::slice::Slice;

/// Where a point is, as the lookup needs it; in f32, free of cancellation near the camera and near the hole.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// r, in r_s.
    pub r: f32,
    /// 1 − 1/r.
    pub room: f32,
    /// r − L, in r_s.
    pub dr: f32,
    /// φ, the angle at the hole, in 0..=π.
    pub phi: f32,
}

/// What the lookup returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// (cos ψ, sin ψ) of the look direction in the rain frame, ψ from the outward radial; sin ψ ≥ 0.
    pub look: [f32; 2],
    /// w = du/dΦ at the camera, in 1/r_s.
    pub slope: f32,
    /// w_e = du/dΦ at the point, in 1/r_s.
    pub emission_slope: f32,
    /// e = 1/b, in 1/r_s.
    pub energy: f32,
    /// T_arrival − T_emission, in r_s/c.
    pub delay: f32,
    /// Whether the point is within the table: outside the horizon and all inputs finite.
    pub valid: bool,
}

/// The angle of (sine, cosine), sine ≥ 0, accurate near 0 and π whatever the platform's atan2.
pub fn angle(sine: f32, cosine: f32) -> f32 {
    if sine < 0.25 {
        let y = sine * sine;
        let x = sine * (1.0 + y * (1.0 / 6.0 + y * (3.0 / 40.0 + y * (15.0 / 336.0 + y * (105.0 / 3456.0)))));
        return if cosine < 0.0 { HALF_TURN - x } else { x };
    }
    sine.atan2(cosine)
}

/// The place of a point from its `offset` from the camera and its `position` from the hole, both rounded from f64, and the unit
/// vector `outward` from the hole to the camera. Near the camera the offset counts, elsewhere the position.
pub fn place(cam: &Camera, outward: [f32; 3], offset: [f32; 3], position: [f32; 3]) -> Place {
    let square = dot(offset, offset);
    if square < 0.25 * cam.l * cam.l {
        let along = dot(offset, outward);
        let cross = [0, 1, 2].map(|i| offset[i] - along * outward[i]);
        let up = cam.l + along;
        let r = (up * up + dot(cross, cross)).sqrt();
        let dr = (2.0 * cam.l * along + square) / (r + cam.l);
        let room = cam.room + dr / (r * cam.l);
        return Place { r, room, dr, phi: angle((dot(cross, cross)).sqrt() / r, up / r) };
    }
    let r = dot(position, position).sqrt();
    let along = dot(position, outward);
    let cross = [0, 1, 2].map(|i| position[i] - along * outward[i]);
    Place { r, room: (r - 1.0) / r, dr: r - cam.l, phi: angle((dot(cross, cross)).sqrt() / r, along / r) }
}

/// a · b.
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The weights of the four B-spline coefficients around the place `t` in 0..=1 between two nodes.
pub fn spline_weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0]
}

/// The residuals of `slice` at its coordinates `x` and `y` in 0..=1, clamped.
pub fn residuals(slice: &Slice, x: f32, y: f32) -> [f32; 3] {
    let [nx, ny] = slice.size;
    let px = x.clamp(0.0, 1.0) * (nx - 1) as f32;
    let py = y.clamp(0.0, 1.0) * (ny - 1) as f32;
    let i = (px as u32).min(nx - 2);
    let j = (py as u32).min(ny - 2);
    let wx = spline_weights(px - i as f32);
    let wy = spline_weights(py - j as f32);
    let mut sum = [0.0; 3];
    for b in 0..4 {
        let mut row = [0.0; 3];
        for a in 0..4 {
            let texel = slice.texels[((j + b) * (nx + 2) + i + a) as usize];
            (0..3).for_each(|h| row[h] += wx[a as usize] * texel[h]);
        }
        (0..3).for_each(|h| sum[h] += wy[b as usize] * row[h]);
    }
    sum
}

/// Whether a number is neither NaN nor infinite.
pub fn finite(x: f32) -> bool {
    x.abs() < 3e38
}

/// The ray from the point at `at` to the camera of `slice` that sweeps `sweep` (φ, 2π − φ or 2π + φ).
pub fn lookup(slice: &Slice, at: Place, sweep: f32) -> Seen {
    let cam = &slice.camera;
    let nothing = Seen { look: [1.0, 0.0], slope: 0.0, emission_slope: 0.0, energy: 0.0, delay: 0.0, valid: false };
    if !(finite(at.r) && finite(at.dr) && finite(sweep) && at.r > 1e-3 && sweep >= 0.0) {
        return nothing;
    }
    let swept = sweep.max(SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    let room = at.room.max(1e-4);
    let bent = bent_sweep(swept);
    let guess = slope_guess(cam, -at.dr / (at.r * cam.l), bent);
    let table = residuals(slice, point_axis(cam, c, room), sweep_axis(cam, c, swept));
    let w = turned_slope(guess[0], cam.a, table[0]);
    let e = energy(w, cam.a, cam.room);
    let mut w_e = turned_slope(guess[1], c, table[2]);
    // Away from a turning point the energy gives the magnitude more precisely.
    let square = e * e - c * c * room;
    if square > 0.3 * e * e {
        w_e = if w_e < 0.0 { -square.sqrt() } else { square.sqrt() };
    }
    let parts = delay_parts(cam, at.r, room, at.dr, bent, w, e, w_e);
    let delay = parts[0] + parts[2] * (parts[1] + table[1]);
    let look = look(w, e, cam.a, cam.beta, cam.room);
    if !(finite(look[0]) && finite(look[1]) && finite(w) && finite(w_e) && finite(e) && finite(delay)) {
        return nothing;
    }
    Seen { look, slope: w, emission_slope: w_e, energy: e, delay, valid: at.room > 0.0 }
}
