//! How the lines of one image of the planet are shifted: its rotation makes one side come nearer and the other go away, which on the screen is linear.

use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};

use super::colours::SHIFTS;
use crate::render::frame::Camera;
use crate::render::placements::{View, departure};
use crate::sim::History;
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::matter::gamma;

/// Height of the places that are looked at, in planet radii: 130 km over the Earth.
const HEIGHT: f64 = 1.02;
/// Nearer to the planet's centre than this, in its radii, the camera sees a part of it: up to its horizon.
const NEAR: f64 = 4.0;
/// How far to the horizon places are looked at.
const AROUND: [f64; 2] = [0.45, 0.9];
/// Places farther off the screen than this, in coordinates that are 1 at its edges, do not count from near.
const BESIDE: f64 = 1.3;
/// Coordinates of the corners of an icosahedron: 0, short and long, and turned round.
const SHORT: f64 = 0.525_731_112_119_133_6;
const LONG: f64 = 0.850_650_808_352_039_9;

/// ν_observed/ν_emitted over an image, as it goes on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// In the middle of the screen.
    pub middle: f64,
    /// By the coordinates of the screen, each from −1 to 1, right and up.
    pub slope: DVec2,
    /// The least and the greatest that was found anywhere.
    pub range: [f64; 2],
}

impl Shift {
    /// The same everywhere.
    pub fn even(g: f64) -> Shift {
        Shift { middle: g, slope: DVec2::ZERO, range: [g, g] }
    }

    /// Of the image of `order` of a planet of that radius (r_s) with this history, by places all over what is seen of it. None where too little is.
    pub fn new(view: &View, time: f64, history: &History, order: Order, radius: f64) -> Option<Shift> {
        let aspect = view.aspect.filter(|_| view.settings.method.bends())?;
        let centre = history.at(departure(view, time, history, order)?);
        let towards = view.camera.position - centre.position;
        let near = towards.length() < NEAR * radius;
        let places = if near { around(centre.attitude.inverse() * towards, radius) } else { icosahedron() };
        let seen: Vec<(DVec2, f64)> = places
            .iter()
            .filter_map(|place| {
                // Where it was when its own light left: once more is enough, for it turns by a few degrees while light crosses the planet.
                let mut emission = departure(view, time, history, order)?;
                let mut body = moving(history, emission, *place * (HEIGHT * radius));
                if view.settings.light_delay {
                    emission = time - Ends::new(view.camera, body.0, order)?.delay;
                    body = moving(history, emission, *place * (HEIGHT * radius));
                }
                let (position, velocity) = body;
                let ends = Ends::new(view.camera, position, order)?;
                let outward = (position - history.at(emission).position).normalize();
                let ratio = ends.ratio(view.camera, position, velocity)?;
                let at = on_screen(view.camera, ends.look, aspect)?;
                let counts = if near { at.abs().max_element() < BESIDE } else { ends.leaving.dot(outward) > 0.0 };
                counts.then_some((at, ratio))
            })
            .collect();
        fitted(&seen)
    }

    /// The ratio at a place on the screen.
    pub fn at(&self, place: DVec2) -> f64 {
        (self.middle + self.slope.dot(place)).clamp(self.range[0], self.range[1])
    }

    /// What is `SHIFTS` − 1 steps from the least ratio to the greatest: at the middle, by right and by up.
    pub(super) fn steps(&self) -> [f64; 3] {
        let step = (self.range[1] - self.range[0]) / (SHIFTS - 1) as f64;
        if step > 0.0 { [self.middle - self.range[0], self.slope.x, self.slope.y].map(|value| value / step) } else { [0.0; 3] }
    }
}

/// Both ends of a ray, rain frame.
struct Ends {
    /// Direction in which it is seen, a unit vector.
    look: DVec3,
    /// Momentum of the photon at the camera and at the place, in one unit.
    arriving: DVec3,
    leaving: DVec3,
    /// In r_s/c.
    delay: f64,
}

impl Ends {
    fn new(camera: &Camera, position: DVec3, order: Order) -> Option<Ends> {
        let (l, r) = (camera.radius(), position.length());
        let n = camera.position / l;
        let across = position - n * position.dot(n);
        let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        let ray = light::connect(1.0 / r, order.swept(across.length().atan2(position.dot(n)).max(1e-12)), 1.0 / l, Branch::Plus)?;
        let turn = if order.flips() { -1.0 } else { 1.0 };
        let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
        let look = n * psi.cos() + side * (turn * psi.sin());
        let [here, there] =
            [(ray.slope, 1.0 / l), (ray.emission_slope, 1.0 / r)].map(|(slope, u)| light::rain_momentum(slope, ray.energy, u));
        let m = position / r;
        let onward = (side * m.dot(n) - n * m.dot(side)) * turn;
        Some(Ends { look, arriving: look * -here[0].hypot(here[1]), leaving: m * there[0] + onward * there[1], delay: ray.delay })
    }

    /// ν_observed/ν_emitted for what goes through `position` with that dx/dT.
    fn ratio(&self, camera: &Camera, position: DVec3, velocity: DVec3) -> Option<f64> {
        // Against the rain, which falls with √(1/r).
        let v = velocity + position / position.length().powf(1.5);
        let emitted = (self.leaving.length() - v.dot(self.leaving)) / (1.0 - v.length_squared()).sqrt();
        let p = camera.momentum;
        let observed = gamma(p) * self.arriving.length() - p.dot(self.arriving);
        let ratio = observed / emitted;
        (ratio.is_finite() && ratio > 0.0).then_some(ratio)
    }
}

/// Where a place of the body (body axes, from its centre) is at T and how it moves, r_s and c. That it is contracted changes its place by a hundredth.
fn moving(history: &History, time: f64, place: DVec3) -> (DVec3, DVec3) {
    /// Over so much time the turning is a straight line, r_s/c.
    const STEP: f64 = 0.02;
    let now = history.at(time);
    let turning = [STEP, -STEP].map(|step| history.at(time + step).attitude * place);
    (now.position + now.attitude * place, now.velocity + (turning[0] - turning[1]) / (2.0 * STEP))
}

/// Coordinates on the screen, from −1 to 1, right and up, of a direction in rain axes; None behind the camera.
fn on_screen(camera: &Camera, look: DVec3, aspect: f64) -> Option<DVec2> {
    let seen = camera.seen_direction(look);
    let wide = (0.5 * camera.field_of_view).tan();
    (seen.z < 0.0).then(|| DVec2::new(seen.x, seen.y / aspect) / (-seen.z * wide))
}

fn icosahedron() -> Vec<DVec3> {
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corner = |(a, b): (f64, f64)| DVec3::new(0.0, a * SHORT, b * LONG);
    signs.iter().flat_map(|&sign| [corner(sign), corner(sign).zxy(), corner(sign).yzx()]).collect()
}

/// Directions to places at [`HEIGHT`] from what is straight below or above a camera at `towards` (from the centre of a planet of that radius) to its horizon.
fn around(towards: DVec3, radius: f64) -> Vec<DVec3> {
    let direction = towards.normalize_or(DVec3::Z);
    let (a, b) = direction.any_orthonormal_pair();
    let horizon = (radius / towards.length().max(radius)).acos() + (1.0 / HEIGHT).acos();
    let aside = |k: u32, share: f64| {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
        direction * (horizon * share).cos() + (a * cosine + b * sine) * (horizon * share).sin()
    };
    std::iter::once(direction).chain(AROUND.into_iter().flat_map(|share| (0..8).map(move |k| aside(k, share)))).collect()
}

/// The plane through ratios at places on the screen, by least squares.
fn fitted(seen: &[(DVec2, f64)]) -> Option<Shift> {
    let count = seen.len() as f64;
    let mean = seen.iter().map(|(_, ratio)| ratio).sum::<f64>() / count;
    if seen.is_empty() || !mean.is_finite() {
        return None;
    }
    let range = seen.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, ratio)| [low.min(*ratio), high.max(*ratio)]);
    let row = |place: &DVec2| DVec3::new(1.0, place.x, place.y);
    let mut square = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for (place, ratio) in seen {
        let row = row(place);
        square += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right += row * *ratio;
    }
    // Places on one line, or next to one another: of the plane nothing is known but its height.
    let scale = square.y_axis.y.max(square.z_axis.z).max(1e-300);
    let flat = seen.len() < 3 || square.determinant() < 1e-9 * count * scale * scale;
    let plane = if flat { DVec3::new(mean, 0.0, 0.0) } else { square.inverse() * right };
    Some(Shift { middle: plane.x, slope: DVec2::new(plane.y, plane.z), range })
}
