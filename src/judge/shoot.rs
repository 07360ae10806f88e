//! The boundary value: in which direction, and how late, a camera sees a given point. Rays are shot until one hits.
//!
//! The only law used: at a fixed swept angle, r falls strictly as the look direction turns from outwards to inwards while E > 0,
//! and rises again while E < 0 (below the horizon).

use glam::DVec2;

use super::ray::{End, Stop, TracedRay, sky_radius};

/// The sign of the energy of the light; it matters only below the horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergySign {
    /// E > 0: light that came from outside, or could have.
    Plus,
    /// E < 0: only between two points below the horizon.
    Minus,
}

/// How a point is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// ψ at the camera in the rain frame from outwards, radians.
    pub psi_rain: f64,
    /// T_arrival − T_emission, r_s/c (infinite for the sky).
    pub delay: f64,
    /// E in units of the frequency that a rain observer at the camera sees.
    pub energy: f64,
    /// The angular momentum in the same units (times r_s), not negative; b = angular_momentum / energy.
    pub angular_momentum: f64,
    /// The rain-frame momentum (radial, tangential) where the light is emitted, in the same units, towards the future; tangential
    /// the way the ray sweeps, so negative. For the sky (−E, 0).
    pub emission: DVec2,
}

/// What a shot found, seen from the target radius.
enum Found {
    /// At the swept angle the ray is above the target.
    Above,
    /// At the swept angle the ray is below the target, or was captured before.
    Below,
    /// It got there: mismatch (rising with r), and the sighting if this is the one.
    Arrived(f64, Sighting),
}

/// How a camera at `camera` (r_s, > 0) sees the point at radius `r` (r_s), which lies `phi` (0 to π) around the hole, in the image
/// of `order` (1: Φ = φ, 2: 2π − φ, 3: 2π + φ, and so on). `tolerance` is the local error of the integration; 1e-17 lets rounding
/// rule. None where no such light exists: a point at or below the horizon seen from outside, or one below it too far around.
pub fn shoot(r: f64, phi: f64, camera: f64, order: u32, sign: EnergySign, tolerance: f64) -> Option<Sighting> {
    if camera >= 1.0 && (r <= 1.0 || sign == EnergySign::Minus) || sign == EnergySign::Minus && r >= 1.0 || camera < 1.0 && r <= camera {
        return None;
    }
    let swept = swept_angle(order, phi);
    if swept == 0.0 {
        return radial(r, camera, sign, tolerance);
    }
    // Only a ray that has come close to the horizon below half the target's height is given up: nearer ones lead the search.
    let stop =
        Stop { radius: 2.0 * r.max(1.0), swept, delay: f64::INFINITY, horizon_gap: (0.5 * (r - 1.0).abs()).max(1e-12), clings_until: 0.0 };
    search(camera, sign, |cotangent| {
        let ray = TracedRay::trace_in_plane(camera, look(cotangent), tolerance, &stop);
        match ray.end {
            End::Escaped => return Found::Above,
            // Seen from below, what clings to r = 1 is above every target there.
            End::Captured if r <= 1.0 => return Found::Above,
            End::Captured | End::Steps => return Found::Below,
            End::Limit => {}
        }
        let Some((i, elapsed)) = ray.find_swept(swept) else {
            return Found::Below;
        };
        let state = ray.segments[i].at(elapsed);
        let here = state.position.length();
        let along = state.position / here;
        let emission = DVec2::new(along.dot(state.momentum), along.perp_dot(state.momentum));
        let mut seen = sighting(cotangent, camera, ray.segments[i].start + elapsed, emission);
        // The last digits of r, lost to the instability of the photon sphere, to first order: E dT = p·dx on the past light cone.
        seen.delay -= emission.x * (r - here) / seen.energy;
        // In 1/r, which is nearly linear in the cotangent of ψ.
        Found::Arrived((here - r) / (here * r), seen)
    })
}

/// How a camera at `camera` sees the point of the sky that lies `phi` around the hole (0 to π), in the image of `order`.
pub fn shoot_sky(phi: f64, camera: f64, order: u32, tolerance: f64) -> Option<Sighting> {
    let swept = swept_angle(order, phi);
    let seen = |cotangent: f64| {
        let mut s = sighting(cotangent, camera, f64::INFINITY, DVec2::ZERO);
        s.emission = DVec2::new(-s.energy, 0.0);
        s
    };
    if swept == 0.0 {
        return Some(seen(f64::NEG_INFINITY));
    }
    let stop = Stop { radius: sky_radius(camera), horizon_gap: 0.5, ..Stop::default() };
    search(camera, EnergySign::Plus, |cotangent| {
        let ray = TracedRay::trace_in_plane(camera, look(cotangent), tolerance, &stop);
        match ray.sky_swept() {
            Some(found) => Found::Arrived(swept - found, seen(cotangent)),
            None => Found::Below,
        }
    })
}

/// Φ of an image: φ, 2π − φ, 2π + φ, 4π − φ, …
pub fn swept_angle(order: u32, phi: f64) -> f64 {
    let turns = std::f64::consts::TAU * f64::from(order / 2);
    if order % 2 == 1 { turns + phi } else { turns - phi }
}

/// The look direction with −cot ψ = `cotangent`, in the plane of the orbit. Both components keep all their digits, also where ψ is
/// within 1e-9 of its ends; in flat space 1/r at a fixed Φ is linear in it.
fn look(cotangent: f64) -> DVec2 {
    let sine = 1.0 / 1.0f64.hypot(cotangent);
    if cotangent.is_infinite() { DVec2::new(-cotangent.signum(), 0.0) } else { DVec2::new(-cotangent * sine, sine) }
}

fn sighting(cotangent: f64, camera: f64, delay: f64, emission: DVec2) -> Sighting {
    let look = look(cotangent);
    Sighting { psi_rain: look.y.atan2(look.x), delay, energy: 1.0 + look.x / camera.sqrt(), angular_momentum: camera * look.y, emission }
}

/// The light between two points on one radius.
fn radial(r: f64, camera: f64, sign: EnergySign, tolerance: f64) -> Option<Sighting> {
    let inwards = r < camera || sign == EnergySign::Minus;
    let cotangent = if inwards { f64::INFINITY } else { f64::NEG_INFINITY };
    if r == camera {
        return None;
    }
    let stop = Stop { radius: r, horizon_gap: 0.5 * (r - 1.0).abs(), ..Stop::default() };
    let ray = TracedRay::trace_in_plane(camera, look(cotangent), tolerance, &stop);
    for segment in &ray.segments {
        let (from, to) = (segment.position(0.0).x - r, segment.position(segment.length).x - r);
        if from * to <= 0.0 {
            let elapsed = segment.cross_line(DVec2::X, r, 0.0, segment.length);
            let momentum = segment.at(elapsed).momentum;
            return Some(sighting(cotangent, camera, segment.start + elapsed, momentum));
        }
    }
    None
}

/// Finds the shot that hits: secants in cot ψ, kept inside a bracket; bisection in ln tan(ψ/2) while secants do not converge.
fn search(camera: f64, sign: EnergySign, shoot: impl Fn(f64) -> Found) -> Option<Sighting> {
    // e^-50: closer to the radial direction than any point whose φ is not zero to rounding.
    const END: f64 = 50.0;
    // E = 0 where cos ψ = −√L: the sign of E changes there.
    let turn = if camera < 1.0 { (camera / (1.0 - camera)).sqrt().asinh() } else { END };
    // `high` is the end at which r is large.
    let (mut high, mut low) = match sign {
        EnergySign::Plus => (-END, turn),
        EnergySign::Minus => (END, turn),
    };
    // Below the horizon the orbit of E = 0 is the limit of both branches: what lies beneath it is not seen.
    if camera < 1.0 {
        match shoot(turn.sinh()) {
            Found::Above => return None,
            Found::Arrived(mismatch, _) if mismatch > 0.0 => return None,
            _ => {}
        }
    }
    let mut last: Option<(f64, f64)> = None;
    let mut best: Option<(f64, Sighting)> = None;
    let (mut step, mut step_before) = (f64::INFINITY, f64::INFINITY);
    let mut x = 0.5 * (high + low);
    // Bisection alone needs about 60.
    for _ in 0..150 {
        let cotangent = x.sinh();
        let mut secant = None;
        let above = match shoot(cotangent) {
            Found::Above => true,
            Found::Below => false,
            Found::Arrived(mismatch, sighting) => {
                if best.is_none_or(|(smallest, _)| mismatch.abs() <= smallest) {
                    best = Some((mismatch.abs(), sighting));
                }
                if mismatch == 0.0 {
                    break;
                }
                secant = last.map(|(c, m)| (cotangent - mismatch * (cotangent - c) / (mismatch - m)).asinh());
                last = Some((cotangent, mismatch));
                mismatch > 0.0
            }
        };
        if above {
            high = x;
        } else {
            low = x;
        }
        // Brent's rule: a secant must halve the step before the last one.
        let useful = |s: &f64| *s > high.min(low) && *s < high.max(low) && (s - x).abs() < 0.5 * step_before;
        let next = secant.filter(useful).unwrap_or(0.5 * (high + low));
        (step_before, step) = (step, (next - x).abs());
        let ulp = f64::EPSILON * x.abs().max(1.0);
        if step <= ulp {
            break;
        }
        x = next;
    }
    best.map(|(_, sighting)| sighting)
}
