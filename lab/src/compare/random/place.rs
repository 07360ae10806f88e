//! Where things are put and how they move: anywhere, and where methods fail.

use std::f64::consts::TAU;

use glam::DVec3;
use rand::RngExt;
use rand::rngs::StdRng;

use super::corner::Corner;
use lensrunner::scene::{Body, GameConfig, Scene};
use lensrunner::spacetime::frames::{rest_to_rain, seen_direction};
use lensrunner::spacetime::light::{Branch, connect, rain_angle};
use lensrunner::spacetime::matter::{ShipState, energy, gamma};
use lensrunner::spacetime::orbit::{Elements, circular_momentum, orbital_frequency, static_momentum};

/// A direction, all alike.
pub fn direction(chance: &mut StdRng) -> DVec3 {
    let z: f64 = chance.random_range(-1.0..1.0);
    let (sine, cosine) = chance.random_range(0.0..TAU).sin_cos();
    let across = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(across * cosine, across * sine, z)
}

/// A number whose logarithm is spread evenly.
pub fn log_uniform(chance: &mut StdRng, least: f64, most: f64) -> f64 {
    least * (most / least).powf(chance.random())
}

/// One of them.
pub fn pick<'a, T>(chance: &mut StdRng, of: &'a [T]) -> &'a T {
    &of[chance.random_range(0..of.len())]
}

/// Across `n`, of unit length.
fn across(chance: &mut StdRng, n: DVec3) -> DVec3 {
    let (a, b) = n.any_orthonormal_pair();
    let (sine, cosine) = chance.random_range(0.0..TAU).sin_cos();
    a * cosine + b * sine
}

/// How far the camera is from the hole, in r_s.
pub fn camera_radius(corner: Corner, chance: &mut StdRng) -> f64 {
    match corner {
        Corner::PhotonSphere => {
            let off = log_uniform(chance, 1e-4, 0.3);
            1.5 + if chance.random_bool(0.5) { off } else { -off }
        }
        Corner::Horizon => match chance.random_range(0..3) {
            0 => 1.0 + log_uniform(chance, 1e-3, 0.3),
            1 => 1.0 - log_uniform(chance, 1e-3, 0.3),
            _ => chance.random_range(0.15..0.9),
        },
        Corner::Axis | Corner::Small => log_uniform(chance, 2.0, 40.0),
        Corner::Rings | Corner::Within | Corner::Planet => log_uniform(chance, 3.0, 40.0),
        Corner::Open | Corner::Fast => match chance.random_range(0..8) {
            0 => chance.random_range(0.2..1.0),
            1 => chance.random_range(1.02..2.0),
            _ => log_uniform(chance, 2.0, 60.0),
        },
    }
}

/// A camera's rain-frame momentum; None: held in place, or falling with the rain inside.
pub fn camera_momentum(chance: &mut StdRng, eye: DVec3) -> Option<DVec3> {
    let (r, n) = (eye.length(), eye.normalize());
    match chance.random_range(0..8) {
        0..4 => None,
        4 => Some(DVec3::ZERO),
        5 => circular_momentum(eye, across(chance, n)).filter(|_| r > 1.6),
        // Outwards, as seen by who falls.
        6 => Some(n * chance.random_range(0.1..2.0)),
        _ => Some(direction(chance) * chance.random_range(0.0..1.0)),
    }
}

/// The direction, in the axes of a camera of this rain-frame momentum (None: held in place, or falling with the rain), in which it sees a
/// point that stands still; the hole's for the origin, and where no light comes from the point.
pub fn seen(eye: DVec3, momentum: Option<DVec3>, point: DVec3) -> DVec3 {
    let momentum = momentum.or_else(|| static_momentum(eye)).unwrap_or(DVec3::ZERO);
    let (n, u) = (eye.normalize(), 1.0 / eye.length());
    let swept = point.angle_between(eye);
    let across = (point - n * point.dot(n)).normalize_or(n.any_orthonormal_vector());
    let ray = (point.length() > 1e-6 && swept > 1e-6).then(|| connect(1.0 / point.length(), swept, u, Branch::Plus)).flatten();
    let look = ray.map_or(-n, |ray| {
        let (sine, cosine) = rain_angle(ray.slope, ray.energy, u).sin_cos();
        n * cosine + across * sine
    });
    seen_direction(&ShipState::new(eye, momentum), -look)
}

/// A ship's rain-frame momentum: hovering, falling, moving outwards, or at a speed of up to 0.99 c against who hovers there (or falls,
/// inside).
pub fn ship_momentum(chance: &mut StdRng, corner: Corner, position: DVec3) -> DVec3 {
    let n = position.normalize();
    let hovering = static_momentum(position).unwrap_or(DVec3::ZERO);
    let speed: f64 = match (corner, chance.random_range(0..4)) {
        (Corner::Fast, _) => chance.random_range(0.8..0.99),
        (_, 0) => return hovering,
        (_, 1) => return DVec3::ZERO,
        _ => chance.random_range(0.0..0.9),
    };
    let along = match chance.random_range(0..4) {
        0 => n,
        1 => across(chance, n),
        _ => direction(chance),
    };
    let own = along * speed / (1.0 - speed * speed).sqrt();
    rest_to_rain(hovering, own) + hovering * gamma(own)
}

/// Where a thing of this size is put; `is_static` if it may not move, so not inside the horizon.
pub fn thing(chance: &mut StdRng, corner: Corner, eye: DVec3, size: f64, is_static: bool) -> DVec3 {
    let n = eye.normalize();
    let way = match corner {
        Corner::Axis | Corner::Small => 0,
        Corner::Horizon => *pick(chance, &[1, 2, 3, 0]),
        Corner::PhotonSphere => *pick(chance, &[0, 1, 2, 4]),
        Corner::Fast => *pick(chance, &[0, 1, 2, 3, 4]),
        Corner::Rings => *pick(chance, &[0, 0, 0, 5]),
        Corner::Within | Corner::Planet => *pick(chance, &[1, 2, 3, 4]),
        Corner::Open => *pick(chance, &[0, 1, 2, 3, 4, 4]),
    };
    match way {
        // Behind the hole, on the axis or beside it by less than its size.
        0 => {
            let far = log_uniform(chance, 1.3, 30.0) + 0.6 * size;
            let beside = if chance.random_bool(0.1) { 0.0 } else { log_uniform(chance, 1e-3, 1.0) * size };
            // On the camera's side now and then: the axis of the second image.
            let side = if chance.random_bool(0.15) { 1.0 } else { -1.0 };
            n * (side * far) + across(chance, n) * beside
        }
        // Beside the camera.
        1 => eye + direction(chance) * (0.9 * size + log_uniform(chance, 0.1, 4.0)),
        // Close to the horizon.
        2 => {
            let gap = log_uniform(chance, 0.02, 0.5);
            direction(chance) * (1.0 + gap + if is_static { 0.55 * size } else { 0.0 })
        }
        // Astride the plane of the disk.
        3 => {
            let (sine, cosine) = chance.random_range(0.0..TAU).sin_cos();
            let r = chance.random_range(2.5..12.0) + 0.6 * size;
            DVec3::new(r * cosine, r * sine, chance.random_range(-0.4..0.4) * size)
        }
        // Before the hole, on the line to it or beside that by less than its size: it may hide its own second image.
        5 => eye * chance.random_range(0.2..0.85) + across(chance, n) * (log_uniform(chance, 0.05, 1.0) * size),
        _ => direction(chance) * (log_uniform(chance, 1.6, 40.0) + 0.6 * size),
    }
}

/// A ball that the camera is in, and that keeps off the hole: its centre and its diameter.
pub fn ball_around(chance: &mut StdRng, eye: DVec3) -> (DVec3, f64) {
    let size = chance.random_range(0.1..1.0) * (eye.length() - 1.5);
    (eye + direction(chance) * (chance.random_range(0.0..0.7 * WITHIN) * size), size)
}

/// A camera that is nearer to a ball's centre than this share of its radius is in it, however few triangles it has.
const WITHIN: f64 = 0.7;

/// The angle from its node at which a planet on such a circle is at T = 0, so that it is behind the hole, give or take, when its light leaves
/// that arrives at T = `at`.
pub fn phase_behind(chance: &mut StdRng, eye: DVec3, at: f64, circle: &Elements) -> f64 {
    let radius = circle.semi_latus_rectum;
    let behind = |phase: f64| Elements { phase, ..*circle }.state().map_or(1.0, |state| state.position.normalize().dot(eye.normalize()));
    let nearest = (0..360).map(|degrees| f64::from(degrees).to_radians()).min_by(|a, b| behind(*a).total_cmp(&behind(*b))).unwrap_or(0.0);
    nearest - orbital_frequency(radius) * (at - radius - eye.length()) + chance.random_range(-0.1..0.1)
}

/// Whether a scene can be judged: the camera sees something and is in no thing (unless it may be `within` one), what is held in place is
/// outside the horizon as a whole, and no ship inside has an energy E ≤ 0: followed backwards such a one hugs r = 1 from within for ever, half of it outside, which nothing
/// that fell in does.
pub fn is_fair(scene: &Scene, config: &GameConfig, at: f64, within: bool) -> bool {
    let assembly = scene.assemble(config);
    let Ok(eye) = (if at == 0.0 { eye_at_start(scene) } else { eye_at(scene, config, at) }) else { return false };
    let apart = assembly.objects.iter().all(|object| {
        let reach = 1.02 * f64::from(assembly.models[object.model].radius()) * object.scale;
        match object.body {
            Body::Static { position, .. } => {
                let away = position.distance(eye);
                position.length() - reach > 1.002 && (away > reach || within && away < WITHIN * reach)
            }
            Body::Ship(ship) => {
                let state = &scene.ships[ship].state;
                state.position.distance(eye) > reach.max(0.3) && (state.position.length() > 1.0 || energy(state) > 0.0)
            }
            Body::Planet | Body::Bolt(_) | Body::Ghost => true,
        }
    });
    let planet = scene.planet.as_ref().is_none_or(|planet| {
        let apart = |time: f64| planet.state(time).is_some_and(|state| state.position.distance(eye) > 1.1 * planet.radius);
        // Where it is now, and where it was when its light left.
        (0..20).all(|k| apart(at - f64::from(k)))
    });
    apart && planet
}

fn eye_at_start(scene: &Scene) -> Result<DVec3, ()> {
    scene.camera.check(0.0, &[]).map_err(|_| ())?;
    Ok(scene.camera.viewpoint(0.0, &[]).position)
}

fn eye_at(scene: &Scene, config: &GameConfig, at: f64) -> Result<DVec3, ()> {
    let moment = lensrunner::sim::Moment::new(scene, config, at, 0);
    let (time, ships) = (moment.time(), moment.ships());
    scene.camera.check(time, &ships).map_err(|_| ())?;
    let eye = scene.camera.viewpoint(time, &ships).position;
    // Flown together by then, or into the singularity.
    let fair = ships.iter().all(|(_, state)| state.position.distance(eye) > 0.3 && state.position.length() > 0.1);
    if fair { Ok(eye) } else { Err(()) }
}
