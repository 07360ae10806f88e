//! The sky behind everything: the Milky Way where a ray ends, and the stars, which no ray hits, found the other way round.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::shade::{LightShift, shifted_colour};
use super::texture::{Level, Pyramid};
use crate::judge::ray::{RayFollower, Stop, sky_radius};
use crate::judge::trace::PixelCamera;
use crate::scene::blackbody;
use crate::scene::sky::milky_way::{self, MilkyWay};
use crate::scene::sky::stars::{SKY_UNIT, Star};
use crate::spacetime::metric::{CRITICAL_IMPACT, river_speed};

/// The Milky Way as linear light.
#[derive(Clone, Debug)]
pub struct SkyBackground {
    light: Pyramid,
    /// The factor on it, in the scene's unit; 0 where it is switched off.
    pub brightness: f32,
}

impl SkyBackground {
    /// From the picture, with `brightness` as a factor.
    pub fn new(milky_way: &MilkyWay, brightness: f32) -> SkyBackground {
        let levels = milky_way
            .levels
            .iter()
            .map(|level| Level { width: level.width, height: level.height, pixels: level.light().into_iter().map(Vec3::from).collect() })
            .collect();
        SkyBackground { light: Pyramid { levels, wrap_v: false }, brightness: brightness * SKY_UNIT * milky_way::PEAK }
    }

    /// The light from `direction`, seen at ν_observed/ν_infinity = `g` by a sample that covers `size` radians of the sky.
    pub fn light(&self, direction: DVec3, size: f64, g: f64, shift: LightShift) -> Vec3 {
        if self.brightness == 0.0 {
            return Vec3::ZERO;
        }
        let uv: Vec2 = milky_way::direction_to_uv(direction.as_vec3());
        let texels = self.light.levels[0].height as f64 / PI;
        let light = self.light.sample(uv, (size * texels).max(1e-6).log2() as f32);
        (shifted_colour(light, g as f32, shift) * self.brightness).min(Vec3::splat(6e4))
    }
}

/// A star's spot on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Pixels from the upper left corner.
    pub place: [f64; 2],
    /// Linear light of the whole star, to be spread over its spot.
    pub light: Vec3,
}

/// Standard deviation of a star's spot, in pixels; as in sky/stars_draw.wgsl.
pub const SPOT_SIGMA: f64 = 0.7;
/// Least sine of the angle from the axis: a star's disc is finite (sky/stars_project.wgsl).
const STAR_DISC: f64 = 1e-6;
/// Ends of the table of black bodies, in K: 512 entries are within 0.5 % of the spectra's integrals, which take too long for 10^5 stars.
const COLDEST: f32 = 200.0;
const HOTTEST: f32 = 2.0e6;
/// Image orders in which stars are looked for: the third lies within a ten-thousandth of the shadow's edge.
const STAR_ORDERS: u32 = 2;

/// The angle swept to infinity as a function of the look, for one camera radius: nodes of the judge's own rays, cubic between.
///
/// With ψ = ψ_shadow (1 − e^{−s}) the swept angle Φ(s) is smooth and grows to infinity with s.
struct Sweep {
    edge: f64,
    step: f64,
    /// Φ and dΦ/ds.
    nodes: Vec<[f64; 2]>,
}

impl Sweep {
    /// As many nodes as bring the cubic within 1e-8 rad: its error is h⁴/384 of the fourth derivative, of order 1.
    const NODES: usize = 1200;
    const END: f64 = 14.0;

    fn new(radius: f64, hole: bool, tolerance: f64) -> Sweep {
        let edge = if hole { shadow_angle(radius) } else { PI };
        let step = Sweep::END / (Sweep::NODES - 1) as f64;
        // Beyond ψ = 0, three steps for the differences, the ray is the mirror image.
        let swept = |k: i64| {
            let psi = edge * -(-step * k as f64).exp_m1();
            if !hole {
                return psi;
            }
            let stop = Stop { radius: sky_radius(radius), horizon_gap: 0.5, ..Stop::default() };
            let mut follower = RayFollower::new(radius, DVec2::new(psi.cos(), psi.abs().sin()), tolerance, stop);
            while follower.step().is_some() {}
            follower.sky_swept().map_or(f64::INFINITY, |swept| swept.copysign(psi))
        };
        let values: Vec<f64> = (-3..Sweep::NODES as i64 + 3).into_par_iter().map(swept).collect();
        // Slopes by a difference of sixth order.
        let slope = |v: &[f64]| (45.0 * (v[4] - v[2]) - 9.0 * (v[5] - v[1]) + v[6] - v[0]) / (60.0 * step);
        let nodes = values.windows(7).map(|v| [v[3], slope(v)]).collect();
        Sweep { edge, step, nodes }
    }

    /// ψ of the ray that sweeps Φ, and dψ/dΦ.
    fn seen(&self, swept: f64) -> Option<(f64, f64)> {
        let after = self.nodes.partition_point(|node| node[0] <= swept);
        if after == 0 || after == self.nodes.len() || !self.nodes[after][0].is_finite() {
            return None;
        }
        let ([a, da], [b, db]) = (self.nodes[after - 1], self.nodes[after]);
        let (da, db) = (da * self.step, db * self.step);
        let (c2, c3) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
        let mut x = (swept - a) / (b - a);
        for _ in 0..8 {
            let value = a + x * (da + x * (c2 + x * c3)) - swept;
            x -= value / (da + x * (2.0 * c2 + 3.0 * x * c3));
        }
        let slope = (da + x * (2.0 * c2 + 3.0 * x * c3)) / self.step;
        let s = self.step * ((after - 1) as f64 + x);
        let gap = self.edge * (-s).exp();
        Some((self.edge - gap, gap / slope))
    }
}

/// ψ of the edge of the shadow in the rain frame at radius r: the ray of the critical impact parameter that comes past the photon sphere.
fn shadow_angle(r: f64) -> f64 {
    // Of light with E = 1 and L = b_c the rain frame at r sees the radial momentum p with |p| − βp_r = 1 and |p|² = p_r² + L²/r².
    let (b2, beta) = ((CRITICAL_IMPACT / r).powi(2), river_speed(r));
    let root = (1.0 - (1.0 - beta * beta) * b2).max(0.0).sqrt();
    // Light that goes outwards at the camera (seen looking inwards) beyond r = 3/2, inwards before.
    let radial = if r >= 1.5 { (beta + root) / (1.0 - beta * beta) } else { (b2 - 1.0) / (beta + root) };
    let frequency = 1.0 + beta * radial;
    (-radial / frequency).clamp(-1.0, 1.0).acos()
}

/// Where the camera sees each star, in the first two orders, and how bright. `brightness` is the factor on the catalogue.
pub fn stars(catalogue: &[Star], camera: &PixelCamera, hole: bool, tolerance: f64, brightness: f64, shift: LightShift) -> Vec<Spot> {
    let radius = camera.observer.position.length();
    let n = camera.observer.position / radius;
    let sweep = Sweep::new(radius, hole, tolerance);
    let pixel = 2.0 * (0.5 * camera.observer.field_of_view).tan() / f64::from(camera.size[0]);
    // A spot spreads a star's light over pixels of this solid angle.
    let unit = brightness * f64::from(SKY_UNIT) / (pixel * pixel);
    let beta = if hole { river_speed(radius) } else { 0.0 };
    let colours = blackbody::table(512, COLDEST, HOTTEST);
    let mut spots = Vec::new();
    for star in catalogue {
        let direction = star.direction.as_dvec3().normalize();
        let cosine = direction.dot(n).clamp(-1.0, 1.0);
        let across = direction - n * cosine;
        let sine = across.length();
        let phi = sine.atan2(cosine);
        for order in 1..=if hole { STAR_ORDERS } else { 1 } {
            let (swept, turn) = if order == 1 { (phi, 1.0) } else { (TAU - phi, -1.0) };
            let Some((psi, slope)) = sweep.seen(swept) else { continue };
            let look = n * psi.cos() + across * (turn * psi.sin() / sine.max(1e-300));
            let Some((place, blue)) = camera.seen_at(look) else { continue };
            let [width, height] = camera.size.map(f64::from);
            if place[0] < -3.0 || place[1] < -3.0 || place[0] > width + 3.0 || place[1] > height + 3.0 {
                continue;
            }
            // dΩ_camera/dΩ_sky = (sinψ dψ)/(sinΦ dΦ)/D², D being the frequency of the camera over the rain frame's.
            let magnification = psi.sin() * slope / sine.max(STAR_DISC) / (blue * blue);
            let g = blue / (1.0 + beta * psi.cos());
            let temperature = f64::from(star.temperature);
            let colour = |temperature: f64| {
                let rgb = blackbody::lookup(&colours, COLDEST, HOTTEST, temperature as f32);
                rgb.map(f64::from)
            };
            let (rest, seen) = (colour(temperature), colour(temperature * g));
            let light = if shift.doppler { seen } else { rest };
            let norm = blackbody::luminance(if shift.beaming { rest } else { light }).max(1e-30);
            let flux = f64::from(star.flux) * magnification * unit;
            spots.push(Spot { place, light: Vec3::from(light.map(|channel| (channel / norm * flux).min(6e4) as f32)) });
        }
    }
    spots
}
