//! The lookup in f32: the twin of shaders/lensing/lookup.wgsl, line by line.

pub mod inside;
pub mod source_point;

use source_point::{SourcePoint, source_point};
use wide::f32x4;

use crate::lensing::closed_form::elementary::single::{above, ln4, stumpffs};
use crate::lensing::single::*;
use crate::lensing::table::slice::{HEADER, Slice};
use inside::inside;

/// What the lookup returns: directions in the rain frame, momenta per angular momentum (in 1/r_s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensRay {
    /// Cosine of the look direction from the outward radial.
    pub cos_psi: f32,
    /// Sine of the same, ≥ 0.
    pub sin_psi: f32,
    /// T_arrival − T_emission, in r_s/c.
    pub delay: f32,
    /// The photon's frequency in the rain frame at the camera.
    pub frequency: f32,
    /// The photon's rain-frame momentum at the point: outward.
    pub emission_radial: f32,
    /// The same against the sweep.
    pub emission_tangential: f32,
    /// Its frequency there.
    pub emission_frequency: f32,
    /// w = du/dΦ at the camera, in 1/r_s.
    pub slope: f32,
    /// w_e = du/dΦ at the point, in 1/r_s.
    pub emission_slope: f32,
    /// e = 1/b, in 1/r_s; negative where E < 0.
    pub energy: f32,
    /// Whether there is an answer: such a ray exists and all inputs are finite.
    pub valid: bool,
}

/// The answer where there is none.
const NOTHING: LensRay = LensRay {
    cos_psi: 1.0,
    sin_psi: 0.0,
    delay: 0.0,
    frequency: 1.0,
    emission_radial: 0.0,
    emission_tangential: 0.0,
    emission_frequency: 1.0,
    slope: 0.0,
    emission_slope: 0.0,
    energy: 0.0,
    valid: false,
};

/// The least 1 − 1/r that the logarithm of the horizon is taken of.
pub const LEAST_LAPSE2: f32 = 1e-7;

/// The outermost weight at a node.
const SIXTH: f32 = 1.0 / 6.0;

/// The residuals of `slice` at its coordinates `x` and `y` in 0..=1, clamped.
#[inline]
pub fn residuals(slice: &Slice, x: f32, y: f32) -> [f32; 3] {
    let wide = slice.size[0] as i32 + 2;
    let cells = f32x4::from([(wide - 3) as f32, (slice.size[1] - 1) as f32, 0.0, 0.0]);
    let position = f32x4::from([x, y, 0.0, 0.0]).fast_max(f32x4::ZERO).fast_min(f32x4::ONE) * cells;
    let first = position.fast_min(cells - 0.5).fast_trunc_int();
    let [tx, ty, ..] = (position - f32x4::from_i32x4(first)).to_array();
    let [i, j, ..] = first.to_array();
    // The weights of both: those of the nodes beside the position, and the outer ones.
    let t = f32x4::from([tx, 1.0 - tx, ty, 1.0 - ty]);
    let square = t * t;
    let inner = (square * (t * 0.5 - 1.0) + 4.0 * SIXTH).to_array();
    let outer = (square * t * SIXTH).to_array();
    let wx = [outer[1], inner[0], inner[1], outer[0]].map(f32x4::splat);
    let wy = [outer[3], inner[2], inner[3], outer[2]].map(f32x4::splat);
    // Four channels at once: a texel is one register.
    let at = HEADER + (j * wide + i) as usize;
    let row = |b: usize| {
        let row = slice.texels[at + b * wide as usize..].first_chunk().unwrap_or(&[[0.0; 4]; 4]);
        let [p, q, r, s] = row.map(f32x4::from);
        (p * wx[0] + q * wx[1] + (r * wx[2] + s * wx[3])) * wy[b]
    };
    let sum = row(0) + row(1) + (row(2) + row(3));
    let [turn, delay, emission_turn, _] = sum.to_array();
    [turn, delay, emission_turn]
}

/// Whether a number is neither NaN nor infinite.
#[inline]
pub fn finite(x: f32) -> bool {
    x.abs() < 3e38
}

/// The part of e² that the square of the slope at the point has to be for e to give it better than the table does. By hand.
const STEEP: f32 = 0.3;

/// (w, e, w_e) made consistent from the two slopes of the table: each is taken from where it is well conditioned.
#[inline]
pub fn joined(w: f32, w_e: f32, cam: &LensCamera, c: f32, lapse2: f32) -> [f32; 3] {
    let (here, there) = (cam.a * cam.a * cam.lapse2, c * c * lapse2);
    if cam.lapse2 <= 0.0 {
        // Inside, e is a small difference of large terms at the camera, a sum at the point; the ray comes from above.
        let square = (w_e * w_e + there).max(0.0);
        return [-(square - here).sqrt(), square.sqrt(), w_e];
    }
    let square = (w * w + here).max(0.0);
    // Away from a turning point the energy gives the magnitude more precisely.
    let rest = square - there;
    let root = rest.max(0.0).sqrt();
    [w, square.sqrt(), above(rest - STEEP * square, root.copysign(w_e), w_e)]
}

/// Light of no age: where there are two rays, the one with E > 0.
pub const YOUNG: f32 = 0.0;
/// Light of any age: where there are two rays, the one with E < 0.
pub const OLD: f32 = 3e38;

/// The ray from the point at `at` to the camera of `slice` that sweeps `sweep` (φ, 2π − φ or 2π + φ). Where camera and point are both
/// inside the horizon there are two: `elapsed` (r_s/c), the time since the light left as far as it is known, decides ([`YOUNG`], [`OLD`]).
#[inline]
pub fn lookup(slice: &Slice, at: SourcePoint, sweep: f32, elapsed: f32) -> LensRay {
    let cam = &slice.camera;
    if !(finite(at.r) && finite(at.dr) && finite(sweep) && at.r > 1e-3 && sweep >= 0.0) {
        return NOTHING;
    }
    let swept = sweep.max(SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    let mut lapse2 = at.lapse2;
    if lapse2 > 0.0 {
        lapse2 = lapse2.max(LEAST_LAPSE2);
        let bent = bent_sweep(swept);
        let square = half_angle(cam, bent);
        let [half, turned] = stumpffs(0.25 * bent * bent, square);
        let guesses = slopes(cam, -at.dr * c * cam.a, basis(cam, bent, square, turned));
        let lens = lens_equation(cam, c, bent, half);
        let logs = ln4([c + cam.soft, near_axis(swept), 0.5 * lens[1]], at.dr * cam.a);
        let (x, y) = axes(cam, lapse2.sqrt(), swept, [logs[0], logs[1], logs[2]]);
        let across = delay_across(cam, at.r, c, lapse2, at.dr, lens, (logs[3], logs[2]));
        let table = residuals(slice, x, y);
        let (w, w_e) = turned_slopes(guesses, (cam.a, emission_scale(cam, c)), (table[0], table[2]));
        let [w, e, w_e] = joined(w, w_e, cam, c, lapse2);
        let cones = light_cones((w, w_e), e, (cam.a, c), (cam.beta, c.sqrt()), (cam.lapse2, lapse2));
        let delay = delay_along(cam, at.r, c, at.dr, cones) + delay_factor(cam, c, lens[0], e) * (across + table[1]);
        return ray_with(cam, c, [w, e, w_e, delay], cones);
    }
    if cam.lapse2 < 0.0 {
        let Some(ray) = inside(cam, at, swept, elapsed) else { return NOTHING };
        return ray_of(cam, c, lapse2, ray);
    }
    NOTHING
}

/// The ray with these (w, e, w_e, delay) between a camera and a point at c = 1/r, `lapse2` = 1 − c.
#[inline]
fn ray_of(cam: &LensCamera, c: f32, lapse2: f32, [w, e, w_e, delay]: [f32; 4]) -> LensRay {
    let cones = light_cones((w, w_e), e, (cam.a, c), (cam.beta, c.sqrt()), (cam.lapse2, lapse2));
    ray_with(cam, c, [w, e, w_e, delay], cones)
}

/// The same with the photon's [`light_cones`].
#[inline]
fn ray_with(cam: &LensCamera, c: f32, [w, e, w_e, delay]: [f32; 4], [seen, emitted, seen_less, emitted_less]: [f32; 4]) -> LensRay {
    let twice = seen + seen_less;
    let left = emitted + emitted_less;
    if !finite(twice.abs() + left.abs() + w.abs() + w_e.abs() + delay.abs()) {
        return NOTHING;
    }
    let inverse = 1.0 / twice;
    LensRay {
        cos_psi: (seen_less - seen) * inverse,
        sin_psi: 2.0 * cam.a * inverse,
        delay,
        frequency: 0.5 * twice,
        emission_radial: 0.5 * (emitted - emitted_less),
        emission_tangential: c,
        emission_frequency: 0.5 * left,
        slope: w,
        emission_slope: w_e,
        energy: e,
        valid: true,
    }
}

/// The ray of `order` (1 to 3) from the point `along` outward and `across` from the axis, away from the camera of `slice`;
/// `height` = L + along, rounded from f64; `elapsed` as in [`lookup`].
pub fn lens_lookup_aged(slice: &Slice, along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    // Far from the camera the position is known without it: it must be a number all the same.
    if !finite(along) {
        return NOTHING;
    }
    let at = source_point(&slice.camera, along, across, height);
    lookup(slice, at, swept(at, order), elapsed)
}

/// Φ of `order` for the point at `at`.
#[inline]
pub fn swept(at: SourcePoint, order: u32) -> f32 {
    match order {
        2 => 2.0 * HALF_TURN - at.phi,
        3 => 2.0 * HALF_TURN + at.phi,
        _ => at.phi,
    }
}

/// The same for E > 0.
pub fn lens_lookup_at(slice: &Slice, along: f32, across: f32, height: f32, order: u32) -> LensRay {
    lens_lookup_aged(slice, along, across, height, order, YOUNG)
}

/// The same where only the offset is at hand.
pub fn lens_lookup(slice: &Slice, along: f32, across: f32, order: u32) -> LensRay {
    lens_lookup_at(slice, along, across, slice.camera.l + along, order)
}
