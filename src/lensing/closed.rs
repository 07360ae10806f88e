//! Closed approximations of light bending in f32: the twins of shaders/functions/closed.wgsl and static_ray.wgsl, line by line. What the
//! GPU's methods "beloborodov" and "poutanen" do, and how "paper1" gets its momenta.
//!
//! Both relations read 1 − cos α = X(u, y), y = 1 − cos χ, with the angle α of the ray from the outward radial in the static frame and χ,
//! the angle it still sweeps on its way to infinity; the impact parameter is the same at both ends. Sources: `lensing::methods`.

use super::lookup::source_point::SourcePoint;
use super::lookup::{LensRay, NOTHING, finite, ray_of};
use super::single::{HALF_TURN, LensCamera, energy};

/// X of Beloborodov 2002, eq. 1.
pub fn tilt_beloborodov(u: f32, y: f32) -> f32 {
    (1.0 - u) * y
}

/// X of Poutanen 2020.
pub fn tilt_poutanen(u: f32, y: f32) -> f32 {
    // The logarithm diverges where the ray comes from straight behind, beyond the relation's range (160°).
    let rest = (1.0 - 0.5 * y).max(1e-6).ln() + 0.5 * y;
    ((1.0 - u) * y * (1.0 + u * u * y * y / 112.0 - 0.027_182_818 * u * y * rest)).min(2.0)
}

/// The ray of what a static camera sees at `psi` with `delay`.
pub fn static_ray(cam: &LensCamera, at: SourcePoint, order: u32, psi: f32, delay: f32) -> LensRay {
    // From the static angle the rest follows; on which side of a turning point the light left, as straight light would.
    let c = 1.0 / at.r;
    let lapse2 = at.lapse2.max(1e-4);
    let w = -cam.a * cam.lapse2.sqrt() * psi.cos() / psi.sin().max(1e-7);
    let e = energy(w, cam.a, cam.lapse2);
    let w_e = (e * e - c * c * lapse2).max(0.0).sqrt();
    let leaves_inward = c * at.phi.cos() > cam.a && order == 1;
    ray_of(cam, c, lapse2, [w, e, if leaves_inward { w_e } else { -w_e }, delay])
}

/// b² of the ray at 1/u that sweeps `chi` more.
fn impact(tilt: fn(f32, f32) -> f32, u: f32, lapse2: f32, chi: f32) -> f32 {
    let half = (0.5 * chi).sin();
    let x = tilt(u, 2.0 * half * half);
    x * (2.0 - x) / (u * u * lapse2)
}

/// α.
fn local_angle(tilt: fn(f32, f32) -> f32, u: f32, chi: f32) -> f32 {
    let half = (0.5 * chi).sin();
    let sine = (0.5 * tilt(u, 2.0 * half * half)).sqrt().min(1.0);
    2.0 * sine.atan2((1.0 - sine * sine).max(0.0).sqrt())
}

/// The excess of the delay over that of the radial ray (Poutanen and Beloborodov 2006, MNRAS 373, 836).
fn lag(u: f32, chi: f32) -> f32 {
    let half = (0.5 * chi).sin();
    let y = 2.0 * half * half;
    y / u * (1.0 + u * y / 8.0 * (1.0 + y * (1.0 / 3.0 - u / 14.0)))
}

/// Steps of false position.
pub const CLOSED_STEPS: u32 = 40;

/// The ray by the relation `tilt`; order 1, both ends outside.
pub fn closed_ray(tilt: fn(f32, f32) -> f32, cam: &LensCamera, at: SourcePoint, order: u32) -> LensRay {
    if !(order == 1 && at.lapse2 > 0.0 && cam.lapse2 > 0.0 && finite(at.r)) {
        return NOTHING;
    }
    let c = 1.0 / at.r;
    let camera_beyond = at.dr <= 0.0;
    let (outer, inner, outer_lapse2, inner_lapse2) =
        if camera_beyond { (cam.a, c, cam.lapse2, at.lapse2) } else { (c, cam.a, at.lapse2, cam.lapse2) };
    let excess = |chi: f32| impact(tilt, outer, outer_lapse2, chi) - impact(tilt, inner, inner_lapse2, chi + at.phi);
    // Illinois: b falls short at the outer end while χ is small, and overshoots where the ray goes on inward.
    let (mut low, mut high) = (1e-6, HALF_TURN - 0.5 * at.phi);
    let (mut at_low, mut at_high) = (excess(low), excess(high));
    if !(at_low < 0.0 && at_high > 0.0) {
        return NOTHING;
    }
    let mut chi = low;
    for _ in 0..CLOSED_STEPS {
        let next = (low * at_high - high * at_low) / (at_high - at_low);
        let done = (next - chi).abs() <= 3e-7 * next;
        chi = next;
        let value = excess(chi);
        if done || value == 0.0 {
            break;
        }
        if value < 0.0 {
            (low, at_low) = (chi, value);
            at_high *= 0.5;
        } else {
            (high, at_high) = (chi, value);
            at_low *= 0.5;
        }
    }
    let psi = if camera_beyond { HALF_TURN - local_angle(tilt, outer, chi) } else { local_angle(tilt, cam.a, chi + at.phi) };
    let radial = at.dr.abs() + (inner * outer_lapse2 / (outer * inner_lapse2)).ln();
    let time = radial + lag(inner, chi + at.phi) - lag(outer, chi);
    // From Schwarzschild's time to Painlevé and Gullstrand's.
    let (l, r) = (cam.l.sqrt(), at.r.sqrt());
    let ends = (1.0 + r) / (1.0 + l);
    let rain = 2.0 * at.dr / (l + r) - (cam.l * cam.lapse2 / (at.r * at.lapse2) * ends * ends).ln();
    static_ray(cam, at, order, psi, time - rain)
}
