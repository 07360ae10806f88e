//! The shadow, the light round it, the stars that motion crowds.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::field::{Field, best, point};
use super::kind::{Phenomenon, Pointer};
use super::look::Look;
use crate::spacetime::frames;
use crate::spacetime::metric::CRITICAL_IMPACT;
use crate::spacetime::orbit::static_momentum;

/// Φ, in rad, of the light from the sky by which the ring round the shadow is pointed at: half a turn more than straight light from afar.
const ROUND: f64 = TAU;
/// Φ, in rad, that light of the disk must have swept there.
const NEARLY_ROUND: f64 = 1.25 * PI;
/// Speed, in c against who hovers there, from which on the crowding of stars can be noticed.
const FAST: f64 = 0.2;
/// How far from the direction of motion stars are still crowded: cosine of 30 degrees.
const AHEAD: f64 = 0.866;
/// Stars are crowded where angles shrink by this factor at least.
const CROWDED: f64 = 0.9;
/// What it is worth that the ring shines; 1 is half a screen between it and what else is pointed at. By hand.
const SHINES: f64 = 1.0;

/// The shadow where neither gas nor a body is before it, as far from its edge as can be.
pub fn shadow(field: &Field) -> Option<Pointer> {
    let open = |look: &Look| look.captured && look.is_clear(f64::INFINITY);
    let depths = field.depths(open);
    let (sum, count) = field.cells(&depths).fold((DVec3::ZERO, 0.0), |(sum, count), (_, look)| (sum + look.seen, count + 1.0));
    // Among equals the one nearest to the middle of the region.
    let middle = sum / f64::max(count, 1.0);
    let deepest = best(field.cells(&depths), |(depth, look)| f64::from(*depth) - 0.25 * look.seen.distance(middle));
    let found = deepest.map(|(_, look)| *look).or_else(|| {
        // Smaller than a cell.
        let edge = field.eye.edge;
        let inside = field.sides().into_iter().flat_map(|side| [0.3, 0.6, 1.0].map(|part| (edge + part * (PI - edge), side)));
        inside.filter_map(|(psi, side)| field.look(field.eye.seen(psi, side))).find(open)
    })?;
    Some(Pointer { sight: Phenomenon::Shadow, direction: found.seen, number: enlargement(field.eye.u) })
}

/// The shadow's angular radius over that of a ball of radius r_s in flat space at the same distance, for who hovers at u = 1/r (1/r_s).
/// None at and under the horizon.
pub fn enlargement(u: f64) -> Option<f64> {
    if u >= 1.0 {
        return None;
    }
    // Synge 1966: sin = b_c √(1 − u) u, seen from under the photon sphere as more than half the sky.
    let sine = libm::asin((CRITICAL_IMPACT * u * (1.0 - u).sqrt()).min(1.0));
    let radius = if u > 2.0 / 3.0 { PI - sine } else { sine };
    Some(radius / libm::asin(u))
}

/// A place just outside the edge of the shadow whose light went round the hole, if possible the disk's, away from `others` that are pointed
/// at.
pub fn photon_ring(field: &Field, others: &[Pointer]) -> Option<Pointer> {
    let places: Vec<[f64; 2]> = others.iter().filter_map(|pointer| field.screen.place(pointer.direction)).collect();
    let ring = field.sides().into_iter().filter_map(|side| {
        let look = field.look(field.eye.seen_ray(f64::INFINITY, ROUND, side)?)?;
        let place = field.screen.place(look.seen)?;
        let gap = places.iter().map(|other| libm::hypot(place[0] - other[0], place[1] - other[1])).fold(1.0, f64::min);
        match look.shown() {
            Some(gas) => (gas.swept >= NEARLY_ROUND && look.is_clear(gas.swept)).then_some((SHINES + gap, gas.swept, look)),
            None => (look.is_clear(f64::INFINITY) && !look.captured).then_some((gap, ROUND, look)),
        }
    });
    let (_, swept, look) = best(ring, |(score, ..)| *score)?;
    Some(point(Phenomenon::PhotonRing, &look, swept / TAU))
}

/// Sky near the direction in which the camera moves, for who hovers there; None where nothing hovers, and for slow cameras.
pub fn aberration(field: &Field) -> Option<Pointer> {
    let camera = field.eye.camera;
    let hovering = static_momentum(camera.position)?;
    // What hovers comes towards the camera from ahead.
    let passing = frames::relative_velocity(camera.momentum, hovering);
    let speed = passing.length();
    if speed.is_nan() || speed < FAST {
        return None;
    }
    let ahead = camera.attitude.conjugate() * (-passing / speed);
    // The angle that neighbours have for the camera over that for who hovers: the inverse of the frequency ratio.
    let gamma = 1.0 / ((1.0 - speed) * (1.0 + speed)).sqrt();
    let shrinks = |look: &Look| gamma * (1.0 - speed * look.seen.dot(ahead));
    let sky = |look: &Look| !look.captured && look.is_clear(f64::INFINITY) && look.seen.dot(ahead) >= AHEAD && shrinks(look) <= CROWDED;
    let found = field.look(ahead).filter(sky).or_else(|| {
        let depths = field.depths(sky);
        best(field.cells(&depths), |(depth, look)| look.seen.dot(ahead) + if *depth > 1 { 0.1 } else { 0.0 }).map(|(_, look)| *look)
    })?;
    let shrinks = shrinks(&found);
    Some(point(Phenomenon::Aberration, &found, shrinks))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::light;

    #[test]
    fn the_shadow_is_larger_than_the_hole() {
        // Far away by b_c, at the photon sphere half the sky.
        assert!((enlargement(1e-6).expect("outside") - CRITICAL_IMPACT).abs() < 1e-5);
        assert!((enlargement(2.0 / 3.0).expect("outside") - 0.5 * PI / libm::asin(2.0f64 / 3.0)).abs() < 1e-6);
        for u in [0.01, 0.1, 0.5, 0.6, 0.7, 0.9, 0.999] {
            let psi = light::static_angle((2.0 / 3.0 - u) * (u + 1.0 / 3.0f64).sqrt(), 0.0, u).expect("outside");
            let factor = enlargement(u).expect("outside");
            assert!((factor * libm::asin(u) + psi - PI).abs() < 1e-9, "{u}: {factor}");
            assert!(factor > 1.0);
        }
        assert_eq!(enlargement(1.0), None);
    }
}
