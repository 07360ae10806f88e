//! The frequency ratio over one image of the planet. The planet rotates: one side comes nearer, the other recedes, so the ratio is nearly
//! linear over the screen.

use crate::spacetime::Observer;
use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};

use crate::render::instances::InstanceView;
use crate::sim::History;
use crate::sim::history::Sample;
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::matter::{gamma, momentum_of};

/// Number of frequency ratios at which colours are given. Over the 8 % between the sides of a planet with a day of 40 r_s/c, linear
/// interpolation is off by less than a thousandth of green's brightness; over twice as much, from 0.88 to 1.05, by 0.25 %. The violet
/// bands, which become visible there, change colour fastest.
pub const SHIFTS: usize = 16;

/// Distance from the centre of the points that are evaluated, in planet radii: 130 km over the Earth.
const HEIGHT: f64 = 1.02;
/// If the camera is nearer to the planet's centre than this, in planet radii, it sees only a part of it, and points are chosen on a grid of
/// the screen.
const NEAR: f64 = 4.0;
/// Steps of the search for the emission time of a point.
const SEARCH: u32 = 4;
/// Screen coordinates of that grid, from −1 to 1.
const ACROSS: [f64; 4] = [-0.9, -0.3, 0.3, 0.9];
/// Points of a planet's image that are evaluated: directions from its centre, body axes.
type Places = [Option<DVec3>; ACROSS.len() * ACROSS.len()];
/// Coordinates of the corners of an icosahedron: (0, ±short, ±long) and cyclic permutations.
const SHORT: f64 = 0.525_731_112_119_133_6;
const LONG: f64 = 0.850_650_808_352_039_9;

/// ν_observed/ν_emitted over an image, as a linear function of screen coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageShift {
    /// In the middle of the screen.
    pub middle: f64,
    /// By the coordinates of the screen, each from −1 to 1, right and up.
    pub slope: DVec2,
    /// The least and the greatest ratio that was found at any point.
    pub range: [f64; 2],
}

impl ImageShift {
    /// The same everywhere.
    pub fn even(g: f64) -> ImageShift {
        ImageShift { middle: g, slope: DVec2::ZERO, range: [g, g] }
    }

    /// For the image of `order` of a planet with this radius (r_s) and history, fitted to points all over its visible part; `time` are T of
    /// the light from its centre, as it leaves and as it is seen. None if too few are seen. If neither colour nor brightness depend on the
    /// ratio, it is 1 everywhere.
    pub fn new(view: &InstanceView, [began, time]: [f64; 2], history: &History, order: Order, radius: f64) -> Option<ImageShift> {
        if !view.settings.doppler && !view.settings.beaming {
            return Some(ImageShift::even(1.0));
        }
        let aspect = view.aspect.filter(|_| view.settings.method.bends)?;
        let mut began = began;
        let away = view.camera.position - history.at(began).position;
        let near = away.length() < NEAR * radius;
        if near && view.settings.light_delay {
            // The nearest part of the planet is seen by younger light than its centre.
            began = (time - (away.length() - radius).max(0.0)).max(began);
        }
        let places = if near { on_grid(view.camera, aspect, &history.at(began), radius) } else { icosahedron() };
        let seen = places.map(|place| {
            let place = place?;
            // The position at the emission time of its own light, by the table's delays. Each step reduces the error to the planet's
            // speed over c, a third or less.
            let mut emission = began;
            for _ in 0..if view.settings.light_delay { SEARCH } else { 0 } {
                let planet = history.at(emission);
                let position = planet.position + planet.attitude * place * (HEIGHT * radius);
                emission = time - view.look(position, order, time - emission)?.1;
            }
            let body = moving(history, emission, place * (HEIGHT * radius));
            let (position, velocity) = body;
            let ends = RayEnds::new(view.camera, position, order)?;
            let outward = (position - history.at(emission).position).normalize();
            let ratio = ends.ratio(view.camera, position, velocity)?;
            let at = on_screen(view.camera, ends.look, aspect)?;
            (near || ends.leaving.dot(outward) > 0.0).then_some((at, ratio))
        });
        fitted(&seen)
    }

    /// The ratio at a place on the screen.
    pub fn at(&self, place: DVec2) -> f64 {
        (self.middle + self.slope.dot(place)).clamp(self.range[0], self.range[1])
    }

    /// The ratio in steps, of which `SHIFTS` − 1 lead from the least to the greatest: in the middle, and its change right and up.
    pub(super) fn steps(&self) -> [f64; 3] {
        let step = (self.range[1] - self.range[0]) / (SHIFTS - 1) as f64;
        if step > 0.0 { [self.middle - self.range[0], self.slope.x, self.slope.y].map(|value| value / step) } else { [0.0; 3] }
    }
}

/// Both ends of a ray, rain frame.
struct RayEnds {
    /// Direction in which it is seen, a unit vector.
    look: DVec3,
    /// Momentum of the photon at the camera and at the point, in the same unit.
    arriving: DVec3,
    leaving: DVec3,
}

impl RayEnds {
    fn new(camera: &Observer, position: DVec3, order: Order) -> Option<RayEnds> {
        let (l, r) = (camera.radius(), position.length());
        let n = camera.position / l;
        let across = position - n * position.dot(n);
        let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        let ray = light::join(1.0 / r, order.swept(across.length().atan2(position.dot(n)).max(1e-12)), 1.0 / l, Branch::Plus)?;
        let turn = if order.flips() { -1.0 } else { 1.0 };
        let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
        let look = n * psi.cos() + side * (turn * psi.sin());
        let [here, there] =
            [(ray.slope, 1.0 / l), (ray.emission_slope, 1.0 / r)].map(|(slope, u)| light::rain_momentum(slope, ray.energy, u));
        let m = position / r;
        let onward = (side * m.dot(n) - n * m.dot(side)) * turn;
        Some(RayEnds { look, arriving: look * -here[0].hypot(here[1]), leaving: m * there[0] + onward * there[1] })
    }

    /// ν_observed/ν_emitted for an emitter at `position` with `velocity` dx/dT.
    fn ratio(&self, camera: &Observer, position: DVec3, velocity: DVec3) -> Option<f64> {
        // Frequency of a photon for an observer of momentum `p` per mass.
        let frequency = |p: DVec3, photon: DVec3| gamma(p) * photon.length() - p.dot(photon);
        let ratio = frequency(camera.momentum, self.arriving) / frequency(momentum_of(position, velocity)?, self.leaving);
        (ratio.is_finite() && ratio > 0.0).then_some(ratio)
    }
}

/// Position and velocity at T of a point of the body (body axes, from its centre), in r_s and c. Lorentz contraction, which moves it by a
/// hundredth, is left out.
fn moving(history: &History, time: f64, place: DVec3) -> (DVec3, DVec3) {
    /// Over this time, in r_s/c, the rotation is linear.
    const STEP: f64 = 0.02;
    let now = history.at(time);
    let turning = [STEP, -STEP].map(|step| history.at(time + step).attitude * place);
    (now.position + now.attitude * place, now.velocity + (turning[0] - turning[1]) / (2.0 * STEP))
}

/// Screen coordinates, from −1 to 1, right and up, of a direction in rain axes; None behind the camera.
fn on_screen(camera: &Observer, look: DVec3, aspect: f64) -> Option<DVec2> {
    let seen = camera.seen_direction(look);
    let wide = (0.5 * camera.field_of_view).tan();
    (seen.z < 0.0).then(|| DVec2::new(seen.x, seen.y / aspect) / (-seen.z * wide))
}

/// The corners of an icosahedron.
fn icosahedron() -> Places {
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corner = |(a, b): (f64, f64)| DVec3::new(0.0, a * SHORT, b * LONG);
    let corners = signs.map(|sign| [corner(sign), corner(sign).zxy(), corner(sign).yzx()]);
    std::array::from_fn(|k| corners.as_flattened().get(k).copied())
}

/// Directions from the planet's centre (body axes) to the points at [`HEIGHT`] that are seen at the grid of the screen, along straight
/// light: from near it is straight enough.
fn on_grid(camera: &Observer, aspect: f64, planet: &Sample, radius: f64) -> Places {
    let wide = (0.5 * camera.field_of_view).tan();
    let from = camera.position - planet.position;
    let place = |seen: DVec3| {
        let look = camera.rain_direction(seen);
        // The nearest and the farthest root of |from + s·look| = reach.
        let along = from.dot(look);
        let roots = |reach: f64| {
            let square = along * along - from.length_squared() + reach * reach;
            (square >= 0.0).then(|| [-along - square.sqrt(), -along + square.sqrt()])
        };
        let ground = roots(radius).filter(|[near, _]| *near > 0.0).map_or(f64::INFINITY, |[near, _]| near);
        let s = roots(HEIGHT * radius)?.into_iter().find(|&s| s > 0.0 && s < ground)?;
        Some(planet.attitude.inverse() * (from + look * s).normalize_or(DVec3::Z))
    };
    std::array::from_fn(|k| place(DVec3::new(ACROSS[k / 4] * wide, ACROSS[k % 4] * wide * aspect, -1.0)))
}

/// The linear function that fits the ratios at points on the screen best, by least squares.
fn fitted(seen: &[Option<(DVec2, f64)>]) -> Option<ImageShift> {
    let seen = || seen.iter().flatten();
    let count = seen().count() as f64;
    let mean = seen().map(|(_, ratio)| ratio).sum::<f64>() / count;
    if !mean.is_finite() {
        return None;
    }
    let range = seen().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, ratio)| [low.min(*ratio), high.max(*ratio)]);
    let row = |place: &DVec2| DVec3::new(1.0, place.x, place.y);
    let mut square = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for (place, ratio) in seen() {
        let row = row(place);
        square += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right += row * *ratio;
    }
    // If the points lie on one line or close together, only the mean is known.
    let scale = square.y_axis.y.max(square.z_axis.z).max(1e-300);
    let flat = count < 3.0 || square.determinant() < 1e-9 * count * scale * scale;
    let plane = if flat { DVec3::new(mean, 0.0, 0.0) } else { square.inverse() * right };
    Some(ImageShift { middle: plane.x, slope: DVec2::new(plane.y, plane.z), range })
}
