//! The accretion disk: one model of the gas, in f64. The renderer draws it in three representations; the judge evaluates it at single
//! points.
//!
//! The gas lies in the plane z = 0 and turns counter-clockwise as seen from +z. [`Gas::emission`] is the temperature and opacity at a point
//! and time; [`Gas::momentum`] the motion of the gas there. Light that crosses the plane at (r, azimuth) at its emission time T_e gains the
//! Planck spectrum at gT times a, and keeps the share 1 − a of what came from behind, with a = [`Emission::opacity`].
//!
//! The rule of composition: a ray crosses the plane once for each image order of the disk, order 1 nearest to the camera. So the light of a
//! pixel is a₁B₁ + (1 − a₁)(a₂B₂ + (1 − a₂)(a₃B₃ + (1 − a₃) sky)). The order in which the arcs of one image order are drawn does not
//! matter, because no two points of the disk are seen at one pixel in the same order. Whether a solid body is in front of a crossing or
//! behind it is decided by light path.

pub mod arcs;
pub mod noise;
pub mod polygons;
pub mod radial;
pub mod sprites;

use std::f64::consts::TAU;

use glam::DVec3;

use super::config;
use noise::streaks;
use radial::Radial;

/// Time, in r_s/c, after which another generation of streaks begins to grow. Each lives for twice this: it grows while the one before
/// fades. In this time orbits at r = 3 and r = 4 separate by 2.1 rad: enough to shear knots into streaks, too little to wind them up.
pub const RENEWAL: f64 = 40.0;
/// Time, in r_s/c, for which a generation has already been sheared when it appears, so that unsheared gas is never seen.
pub const SHEARED: f64 = 20.0;
/// The height of the pattern in ln r: it repeats after a factor of 16 in radius, more than a disk shows at once in detail.
pub const PATTERN_HEIGHT: f64 = 2.772_588_722_239_781;
/// Light of a black body at 5,772 K in the scene's unit of radiance (a white surface in full light), whether it is gas of the disk or a
/// surface. With it a disk of less than 3,000 K is a few times as bright as a lit ship, and stars are visible beside it.
pub const DISK_UNIT: f64 = 24.0;
/// Finest octaves, for near views: the pattern again, this many times finer, this strong. By hand.
pub const DETAIL: (f64, f64) = (8.0, 0.35);
/// Step from one generation's position in the pattern to the next, in turns and heights: powers of the plastic number's inverse (Roberts
/// 2018), of which no small multiple is close to a whole number in both.
pub const OFFSET_STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
/// Standard deviation of ln density at turbulence 1. By hand.
const FULL_TURBULENCE: f64 = 0.95;

/// Temperature and opacity of a point of the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Temperature of its black-body light, in K, in the gas's own frame.
    pub temperature: f64,
    /// Optical depth straight through the disk.
    pub depth: f64,
    /// Half height of the disk there, in r_s.
    pub half_height: f64,
}

impl Emission {
    /// The share of light that a crossing stops (and, by Kirchhoff, the share of a black body's light that it adds). `cosine` is |cos| of
    /// the angle between ray and normal in the gas's frame, [`Gas::cosine`]; `path` is the light path from the camera to the crossing, in
    /// r_s.
    ///
    /// It is 1 − exp(−τ f/cosine). The factor f = 1 − exp(−x²/2), with x = path·cosine/half height, leaves out the gas behind a camera that
    /// is inside the disk's thickness, so that nothing jumps when the camera goes through the disk.
    pub fn opacity(&self, cosine: f64, path: f64) -> f64 {
        -(-self.depth * slant(cosine, path, self.half_height)).exp_m1()
    }
}

/// Optical depth along a ray over that straight through the disk; see [`Emission::opacity`]. No ray is more slanted than [`LEAST_COSINE`]:
/// the disk is not infinite.
pub fn slant(cosine: f64, path: f64, half_height: f64) -> f64 {
    let x = path * cosine / half_height.max(1e-9);
    -(-0.5 * x * x).exp_m1() / cosine.max(LEAST_COSINE)
}

/// Least |cos| of the angle between ray and normal that counts.
pub const LEAST_COSINE: f64 = 0.02;

/// The gas of one disk.
#[derive(Clone, Debug)]
pub struct Gas {
    /// Functions of the radius alone.
    pub radial: Radial,
    /// Half height over radius.
    pub thickness: f64,
    /// Standard deviation of ln density.
    pub contrast: f64,
    seed: u32,
}

/// A generation of streaks as seen at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generation {
    /// Its number, counted from T = 0.
    pub number: i64,
    /// Time for which it has been sheared, in r_s/c.
    pub age: f64,
    /// Its share; the squares of both shares add up to 1, so that the contrast stays the same.
    pub weight: f64,
}

impl Gas {
    /// The disk that `disk` describes, around a hole of `mass_solar` solar masses.
    pub fn new(disk: &config::Disk, mass_solar: f64) -> Gas {
        Gas {
            radial: Radial::new(disk, mass_solar),
            thickness: disk.thickness,
            contrast: FULL_TURBULENCE * disk.turbulence,
            seed: disk.seed,
        }
    }

    /// The radii between which there is gas, in r_s.
    pub fn extent(&self) -> [f64; 2] {
        self.radial.extent()
    }

    /// Temperature and opacity of the gas at radius `r` (r_s) and `azimuth` (rad, from +x towards +y) at T = `time` (r_s/c).
    pub fn emission(&self, r: f64, azimuth: f64, time: f64) -> Emission {
        let ln_density = self.contrast * self.turbulence(r, azimuth, time);
        Emission {
            // The power radiated goes as the density: T as its fourth root.
            temperature: self.radial.temperature(r) * (0.25 * ln_density).exp(),
            depth: self.radial.depth(r) * ln_density.exp(),
            half_height: self.half_height(r),
        }
    }

    /// Half height at radius `r`, in r_s: it grows with the radius, and falling gas keeps that of the last stable orbit.
    pub fn half_height(&self, r: f64) -> f64 {
        (self.thickness * self.radial.pattern_radius(r)).max(1e-3)
    }

    /// The streaks at a point and time: approximately normally distributed, mean 0, deviation 1.
    ///
    /// Every generation is a pattern fixed in the gas: at radius r its azimuth is φ₀ + Ω(r)·age, so it moves with the orbits and is sheared
    /// by them. It grows and fades; before it is wound up another has replaced it. The generations are the pattern at other offsets.
    pub fn turbulence(&self, r: f64, azimuth: f64, time: f64) -> f64 {
        let y = self.radial.pattern_radius(r).ln() / PATTERN_HEIGHT;
        let (rate, lag) = (self.radial.turning_rate(r), self.radial.lag(r));
        generations(time)
            .into_iter()
            .map(|generation| {
                let [x0, y0] = self.offset(generation.number);
                let x = (azimuth - lag - rate * generation.age) / TAU + x0;
                generation.weight * pattern(x, y + y0)
            })
            .sum()
    }

    /// Position of a generation in the pattern, in turns and heights: steps of [`OFFSET_STEP`], which never repeat.
    pub fn offset(&self, generation: i64) -> [f64; 2] {
        let bits = noise::hash(0, u64::from(self.seed));
        let first = [(bits >> 32) as f64, (bits & 0xffff_ffff) as f64].map(|half| half / 4_294_967_296.0);
        std::array::from_fn(|k| (first[k] + (generation as f64 * OFFSET_STEP[k]).rem_euclid(1.0)).fract())
    }

    /// Rain-frame momentum per mass of the gas at `position` in the plane z = 0 (r_s): a circular orbit, or the plunge from the last of
    /// them.
    pub fn momentum(&self, position: DVec3) -> DVec3 {
        let r = position.truncate().length();
        let outward = DVec3::new(position.x / r, position.y / r, 0.0);
        let [radial, along] = self.radial.momentum(r);
        outward * radial + DVec3::Z.cross(outward) * along
    }

    /// |cos| of the angle between the disk's normal and light of rain-frame momentum `photon` (any scale), in the frame of gas with the
    /// rain-frame momentum `momentum` per mass.
    pub fn cosine(momentum: DVec3, photon: DVec3) -> f64 {
        let gamma = (1.0 + momentum.length_squared()).sqrt();
        photon.z.abs() / (gamma * photon.length() - momentum.dot(photon))
    }
}

/// The pattern of one generation at x turns and y heights, with the octaves that only near views show.
pub fn pattern(x: f64, y: f64) -> f64 {
    streaks(x, y) + DETAIL.1 * streaks(DETAIL.0 * x, DETAIL.0 * y)
}

/// The two generations that are seen at T = `time`, the younger first.
pub fn generations(time: f64) -> [Generation; 2] {
    let phase = time / RENEWAL;
    let number = phase.floor();
    let grown = phase - number;
    let [young, old] = shares(grown);
    let generation = |number: f64, weight| Generation { number: number as i64, age: (phase - number) * RENEWAL + SHEARED, weight };
    [generation(number, young), generation(number - 1.0, old)]
}

/// Shares of the younger and the older generation when the younger has lived `grown` of a renewal.
pub fn shares(grown: f64) -> [f64; 2] {
    let young = grown * grown * (3.0 - 2.0 * grown);
    let scale = 1.0 / (young * young + (1.0 - young) * (1.0 - young)).sqrt();
    [young * scale, (1.0 - young) * scale]
}
