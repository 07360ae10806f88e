//! Where a camera sees a position, and how wide the image of a ball there is.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_aged;
use crate::render::instances::visibility::{may_be_seen, part_of_screen};
use crate::render::settings::Settings;
use crate::spacetime::Observer;
use crate::spacetime::light::Order;

/// A camera, and what is needed to tell how wide an image is.
#[derive(Clone, Copy, Debug)]
pub struct InstanceView<'a> {
    /// The camera.
    pub camera: &'a Observer,
    /// The table at its radius.
    pub slice: &'a Slice,
    /// Angle of a pixel in radians.
    pub pixel: f64,
    /// Height over width of the screen: images off it are left out. None: no image is left out.
    pub aspect: Option<f64>,
    /// How the picture is made.
    pub settings: &'a Settings,
}

/// Where the image of a ball is seen, in the rain frame.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Extent {
    /// The direction of its centre, a unit vector in rain axes.
    pub(in crate::render) look: DVec3,
    /// Radius, in radians, of a cone about `look` that holds the image.
    pub(in crate::render) radius: f64,
    /// Largest width on the screen, in pixels: the extent in ψ, or the angular size if that is less.
    pub(in crate::render) width: f64,
    /// How long it is across that, round the axis, in pixels.
    pub(in crate::render) length: f64,
    /// Half its extent in azimuth round the axis, in radians.
    pub(in crate::render) round: f64,
}

/// Factor by which an extent is enlarged. It is that of a ball at one time, from five of its points; the points between them and the motion
/// need more.
pub(in crate::render) const MARGIN: f64 = 3.0;

/// An image is drawn out if it is so many times as long as wide, and its half spans more than this azimuth, in radians.
const DRAWN_OUT: f64 = 4.0;
const DRAWN_OUT_ROUND: f64 = 0.25;

impl Extent {
    /// Whether light draws it out along the ring, so that it shows sections of the body at many azimuths.
    pub(in crate::render) fn is_drawn_out(&self) -> bool {
        self.round > DRAWN_OUT_ROUND && self.length > DRAWN_OUT * self.width
    }

    pub(super) fn may_be_seen(&self, camera: &Observer, aspect: f64) -> bool {
        may_be_seen(camera, self.look, MARGIN * self.radius, 0.01, aspect)
    }

    /// The part of the screen on which the image may be: left, upper, right and lower edge as shares of width and height.
    pub(in crate::render) fn part_of_screen(&self, camera: &Observer, aspect: f64) -> [f64; 4] {
        part_of_screen(camera, self.look, MARGIN * self.radius, aspect)
    }
}

impl InstanceView<'_> {
    /// The direction (a unit vector, rain axes) from which light of age `age` (r_s/c) comes from a position, and the length of its path.
    /// Inside the horizon `age` decides which of two rays is meant.
    pub(in crate::render) fn look(&self, position: DVec3, order: Order, age: f64) -> Option<(DVec3, f64)> {
        let n = self.camera.position.normalize();
        let height = position.dot(n);
        let across = position - n * height;
        let (psi, path) = self.angle([(position - self.camera.position).dot(n), across.length(), height], order, age)?;
        let turn = if order.flips() { -1.0 } else { 1.0 };
        Some((n * psi.cos() + across.normalize_or_zero() * (turn * psi.sin()), path))
    }

    /// The angle ψ from outwards at which a position is seen, and the length of the light's path. The position is given by its distance
    /// outward of the camera, its distance from the axis, and its height along the axis from the hole.
    pub(in crate::render) fn angle(&self, [along, across, height]: [f64; 3], order: Order, age: f64) -> Option<(f64, f64)> {
        if !self.settings.method.bends {
            return Some((across.atan2(along), along.hypot(across)));
        }
        let [along, across, height] = [along, across, height].map(|x| x as f32);
        let ray = lens_lookup_aged(self.slice, along, across, height, u32::from(order.number()), age as f32);
        ray.valid.then(|| (f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)), f64::from(ray.delay)))
    }

    /// Where the image of a ball of radius `reach` at `position` is seen.
    /// Estimated from the ball's nearest, farthest and outermost points in the plane of the axis.
    /// `age` decides, inside the horizon, which light is meant.
    pub(in crate::render) fn extent(&self, position: DVec3, reach: f64, order: Order, age: f64) -> Extent {
        let (l, r) = (self.camera.radius(), position.length());
        let n = self.camera.position / l;
        let phi = position.dot(n).clamp(-r, r) / r;
        let phi = phi.acos();
        let anywhere = Extent { look: n, radius: PI, width: PI / self.pixel, length: 2.0 * PI / self.pixel, round: PI };
        if reach >= r || position.distance(self.camera.position) <= reach {
            return anywhere;
        }
        let half = (reach / r).asin();
        let seen = |r: f64, phi: f64| {
            let (sine, cosine) = phi.clamp(0.0, PI).sin_cos();
            self.angle([r * cosine - l, r * sine, r * cosine], order, age)
        };
        let low_side = if l < 1.0 { (r - reach).max(l + 0.01 * (r - l)) } else { (r - reach).max(1.001) };
        let points = [(r, phi), (r, phi - half), (r, phi + half), (low_side, phi), (r + reach, phi)];
        // If a part of the object is not seen, its image may end anywhere.
        let around = points.map(|(r, phi)| seen(r, phi));
        let Some((centre, path)) = around[0].filter(|_| around.iter().all(Option::is_some)) else { return anywhere };
        let (low, high) = around.iter().flatten().fold((centre, centre), |(low, high), &(psi, _)| (low.min(psi), high.max(psi)));
        let across = position - n * position.dot(n);
        let distance = across.length();
        // Half its extent in azimuth round the axis: a ball that meets the axis is seen all round.
        let round = if reach < distance { (reach / distance).asin() } else { PI };
        let turn = if order.flips() { -1.0 } else { 1.0 };
        // On the axis any side will do: what is left of `across` there is rounding.
        let side = if distance > 1e-9 * r { across * (turn / distance) } else { n.any_orthonormal_vector() };
        let look = n * centre.cos() + side * centre.sin();
        let steepest = low.sin().max(high.sin()).max(if low < FRAC_PI_2 && high > FRAC_PI_2 { 1.0 } else { 0.0 });
        let enlargement = self.enlargement(n, side, [low, high], round);
        Extent {
            look,
            radius: (high - centre).max(centre - low) + round * steepest,
            width: (high - low).min(2.0 * reach / path.max(1e-9)) * enlargement,
            length: 2.0 * round * steepest * enlargement,
            round,
        }
    }

    /// The largest number of pixels per radian of ψ on the screen, by aberration and by the projection onto the plane screen. For
    /// directions between two angles from outwards `n`, up to `round` (radians of azimuth) on both sides of `side`.
    fn enlargement(&self, n: DVec3, side: DVec3, [low, high]: [f64; 2], round: f64) -> f64 {
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(1e-4));
        let edge = 1.1 * (0.5 * self.camera.field_of_view).tan() * self.aspect.unwrap_or(1.0).max(1.0);
        let enlarged = |k: i32| {
            let (sine, cosine) = (0.25 * f64::from(k) * round).sin_cos();
            let side = side * cosine + n.cross(side) * sine;
            let [a, b] = [middle - half, middle + half].map(|psi| self.camera.seen_direction(n * psi.cos() + side * psi.sin()));
            let [p, q] = [a, b].map(|seen| DVec2::new(seen.x, seen.y) / -seen.z);
            let on_screen = |seen: DVec3, at: DVec2| seen.z < 0.0 && at.abs().max_element() < edge;
            // Off the screen the projection does not count.
            let length = if on_screen(a, p) || on_screen(b, q) { p.distance(q) } else { a.angle_between(b) };
            length / (2.0 * half * self.pixel)
        };
        // A tenth of a radian is enlarged alike all along it.
        let step = if round < 0.1 { 4 } else { 1 };
        (-4..=4).step_by(step).map(enlarged).fold(0.0, f64::max)
    }
}
