//! What is seen in one direction: the ray followed backwards in closed form, and where it crosses the plane of the disk.
//!
//! The plane of a ray meets the plane z = 0 in a line through the hole, so the ray crosses it at Φ₀, Φ₀ + π, Φ₀ + 2π with Φ₀ in (0, π):
//! one crossing for each image order.

use std::f64::consts::PI;

use glam::{DMat4, DVec3};

use crate::scene::disk::{Gas, slant};
use crate::spacetime::Observer;
use crate::spacetime::light::{self, Branch, SweepEnd};
use crate::spacetime::matter::gamma;

/// Sine of the least height of the camera over the disk's plane; in the plane itself the first crossing is the camera's own place.
const LEAST_HEIGHT: f64 = 1e-9;
/// Sine of the least angle between a ray and the line from hole to camera.
const LEAST_SINE: f64 = 1e-9;
/// So many standard deviations of ln density count as what the gas may have anywhere: 95 % of it.
const DEVIATIONS: f64 = 2.0;
/// Share of a pixel's light that a crossing must surely give to be what the pixel shows. By hand.
const SHOWN: f64 = 0.4;
/// Share of the light from behind that gas may stop where it does not hide what is there. By hand.
const CLEAR: f64 = 0.2;

/// A camera with its disk, ready to look.
pub struct Eye<'a> {
    /// The camera.
    pub camera: &'a Observer,
    /// 1/L, in 1/r_s.
    pub u: f64,
    /// Unit vector from the hole to the camera.
    pub outward: DVec3,
    /// ψ of the shadow's edge, rain frame, in rad.
    pub edge: f64,
    gas: Option<&'a Gas>,
    rain_from_camera: DMat4,
    /// Sine of the camera's height over the disk's plane, never 0.
    height: f64,
}

/// Where a ray goes through gas of the disk.
#[derive(Clone, Copy, Debug)]
pub struct GasCrossing {
    /// The image order.
    pub order: u8,
    /// Φ, in rad.
    pub swept: f64,
    /// Where, in r_s; z = 0.
    pub position: DVec3,
    /// ν_observed/ν_emitted.
    pub g: f64,
    /// Share of light that it stops: least and most that the gas may there.
    opacity: [f64; 2],
}

/// What is seen in one direction.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// The direction: unit vector in camera axes.
    pub seen: DVec3,
    /// ψ in the rain frame, from the outward radial direction, in rad.
    pub psi: f64,
    /// The way the ray sweeps: unit vector across `outward`.
    pub side: DVec3,
    /// Whether it ends in the shadow.
    pub captured: bool,
    /// Gas on the way, in order.
    crossings: [Option<GasCrossing>; 3],
}

impl<'a> Eye<'a> {
    /// None where light cannot be computed: at the hole's middle, at a camera that is not finite.
    pub fn new(camera: &'a Observer, gas: Option<&'a Gas>) -> Option<Eye<'a>> {
        let l = camera.radius();
        let sound = camera.position.is_finite() && camera.momentum.is_finite() && camera.attitude.is_finite();
        // Nearer to the hole's middle rounding is felt as far out as the horizon.
        if !sound || !(1e-6..=1e6).contains(&l) {
            return None;
        }
        let outward = camera.position / l;
        let height = if outward.z.abs() < LEAST_HEIGHT { LEAST_HEIGHT.copysign(outward.z) } else { outward.z };
        let rain_from_camera = camera.rain_from_camera();
        Some(Eye { camera, u: 1.0 / l, outward, edge: light::shadow_angle(1.0 / l), gas, rain_from_camera, height })
    }

    /// The gas of the disk.
    pub fn gas(&self) -> Option<&Gas> {
        self.gas
    }

    /// The direction, in camera axes, of the light that comes at ψ = `psi` (rain frame, rad) on the side `side`.
    pub fn seen(&self, psi: f64, side: DVec3) -> DVec3 {
        self.camera.seen_direction(self.outward * libm::cos(psi) + side * libm::sin(psi))
    }

    /// As [`Eye::seen`] for the ray that meets what is at radius `r` (r_s; infinite for the sky) after the angle `swept`; None where there
    /// is no such ray.
    pub fn seen_ray(&self, r: f64, swept: f64, side: DVec3) -> Option<DVec3> {
        Some(self.seen(self.psi(r, swept, Branch::Plus)?, side))
    }

    /// ψ of that ray, in rad.
    pub fn psi(&self, r: f64, swept: f64, branch: Branch) -> Option<f64> {
        let ray = light::join(1.0 / r, swept, self.u, branch)?;
        Some(light::rain_angle(ray.slope, ray.energy, self.u)).filter(|psi| psi.is_finite())
    }

    /// Φ in (0, π) where rays on the side `side` cross the disk's plane first.
    pub fn first_crossing(&self, side: DVec3) -> f64 {
        let upward = self.height.signum();
        libm::atan2(self.height * upward, -side.z * upward)
    }

    /// The unit vector across `outward` at this angle from the disk's normal on the camera's side, in rad.
    pub fn side(&self, angle: f64) -> DVec3 {
        let normal = DVec3::Z * self.height.signum();
        let up =
            (normal - self.outward * self.outward.dot(normal)).try_normalize().unwrap_or_else(|| self.outward.any_orthonormal_vector());
        up * libm::cos(angle) + self.outward.cross(up) * libm::sin(angle)
    }

    /// What is seen in the direction `seen` (unit vector in camera axes).
    pub fn look(&self, seen: DVec3) -> Look {
        let photon = self.rain_from_camera * seen.extend(-1.0);
        let blue = -1.0 / photon.w;
        let look = photon.truncate().normalize_or(self.outward);
        let cos = look.dot(self.outward);
        let across = look - self.outward * cos;
        let sin = across.length();
        // Rounding alone has no side, and the radial directions themselves have rays of infinite slope.
        let side = if sin > LEAST_SINE { across / sin } else { self.side(0.0) };
        let psi = libm::atan2(sin.max(LEAST_SINE), cos);
        let mut found = Look { seen, psi, side, captured: psi >= self.edge, crossings: [None; 3] };
        if let Some(gas) = self.gas {
            self.cross(gas, &mut found, blue);
        }
        found
    }

    /// Finds where the ray crosses gas.
    fn cross(&self, gas: &Gas, look: &mut Look, blue: f64) {
        let ray = light::launch(look.psi, self.u);
        // Light of negative energy was never outside.
        if ray.energy.is_nan() || ray.energy <= 0.0 {
            return;
        }
        let [start, end] = gas.extent();
        let at_camera = light::rain_momentum(ray.slope, ray.energy, self.u);
        let frequency = libm::hypot(at_camera[0], at_camera[1]);
        let first = self.first_crossing(look.side);
        for order in 1..=3u8 {
            let swept = first + PI * f64::from(order - 1);
            let SweepEnd::At { u, slope } = light::follow(self.u, ray.slope, swept) else { return };
            // Once it runs in under the photon sphere it does not come out again.
            if slope > 0.0 && u > 1.0 {
                return;
            }
            let r = 1.0 / u;
            if !(r > start && r < end) {
                continue;
            }
            let (sin, cos) = libm::sincos(swept);
            let (here, onward) = (self.outward * cos + look.side * sin, look.side * cos - self.outward * sin);
            let position = DVec3::new(here.x, here.y, 0.0) * r;
            let [radial, tangential] = light::rain_momentum(slope, ray.energy, u);
            let light = (here * radial + onward * tangential) / frequency;
            let momentum = gas.momentum(position);
            let g = blue / (gamma(momentum) * light.length() - momentum.dot(light));
            // Straight lines do: how far it is counts only from within the gas.
            let depth =
                gas.radial.depth(r) * slant(Gas::cosine(momentum, light), position.distance(self.camera.position), gas.half_height(r));
            let spread = libm::exp(DEVIATIONS * gas.contrast);
            let opacity = [depth / spread, depth * spread].map(|depth| -libm::expm1(-depth));
            if g.is_finite() && opacity[0].is_finite() {
                look.crossings[usize::from(order) - 1] = Some(GasCrossing { order, swept, position, g, opacity });
            }
        }
    }
}

impl Look {
    /// Whether the disk does not hide what is at Φ = `swept` (rad) on this ray.
    pub fn is_clear(&self, swept: f64) -> bool {
        self.through(swept) >= 1.0 - CLEAR
    }

    /// The gas that this direction shows, if it is gas.
    pub fn shown(&self) -> Option<&GasCrossing> {
        self.crossings.iter().flatten().find(|crossing| self.through(crossing.swept) * crossing.opacity[0] >= SHOWN)
    }

    /// Least share of light from Φ = `swept` that comes through the disk.
    fn through(&self, swept: f64) -> f64 {
        self.crossings.iter().flatten().filter(|crossing| crossing.swept < swept).map(|crossing| 1.0 - crossing.opacity[1]).product()
    }
}
