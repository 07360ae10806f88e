//! The procedural textures: a chequer, a spiral galaxy, a planet. Deterministic.

use std::f32::consts::{PI, TAU};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rayon::prelude::*;

use super::Image;
use crate::breath::breath;
use crate::scene::aurora::random;

/// Width and height of the galaxy, in pixels.
const GALAXY_SIZE: u32 = 1024;

/// A chequer of 24 × 12 fields in ivory and deep blue, 768 × 384 pixels: square fields on the equator of a sphere.
pub fn checker() -> Arc<Image> {
    static IMAGE: OnceLock<Arc<Image>> = OnceLock::new();
    IMAGE
        .get_or_init(|| {
            Arc::new(draw(768, 384, |x, y| {
                let light = (x / 32 + y / 32) % 2 == 0;
                if light { [235, 225, 200, 255] } else { [28, 52, 120, 255] }
            }))
        })
        .clone()
}

/// A spiral galaxy seen face on: warm core with a short bar, two logarithmic arms and two weaker ones in blue, dust lanes along
/// their inner sides, pink H II regions; black and opaque outside the disk.
pub fn galaxy() -> Arc<Image> {
    static IMAGE: OnceLock<Arc<Image>> = OnceLock::new();
    IMAGE
        .get_or_init(|| {
            Arc::new(draw(GALAXY_SIZE, GALAXY_SIZE, |x, y| {
                let half = GALAXY_SIZE as f32 / 2.0;
                let light = galaxy_light((x as f32 + 0.5) / half - 1.0, 1.0 - (y as f32 + 0.5) / half);
                let [r, g, b] = light.map(encode_srgb);
                [r, g, b, 255]
            }))
        })
        .clone()
}

/// A planet of oceans, land, ice at the poles and clouds, 1024 × 512 pixels by longitude and latitude; `seed` says which. The last one is
/// kept.
pub fn planet(seed: u32) -> Arc<Image> {
    let lock = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, image)) = lock().as_ref().filter(|(last, _)| *last == seed) {
        return image.clone();
    }
    let image = Arc::new(draw(PLANET_SIZE[0], PLANET_SIZE[1], |x, y| planet_pixel(x, y, seed)));
    *lock() = Some((seed, image.clone()));
    image
}

/// Has the same planet made now, a few rows at a time, so that [`planet`] has it.
pub async fn make_planet(seed: u32) {
    let lock = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if lock().as_ref().is_some_and(|(last, _)| *last == seed) {
        return;
    }
    let [width, height] = PLANET_SIZE;
    let mut rgba = Vec::with_capacity((width * height * 4) as usize);
    for first in (0..height).step_by(ROWS) {
        rgba.append(&mut draw(width, ROWS as u32, |x, y| planet_pixel(x, first + y, seed)).rgba);
        breath().await;
    }
    *lock() = Some((seed, Arc::new(Image { width, height, rgba })));
}

/// Width and height of the planet, in pixels.
const PLANET_SIZE: [u32; 2] = [1024, 512];
/// Rows of it that are made at once.
const ROWS: usize = 8;
/// The planet that was made last.
static LAST: Mutex<Option<(u32, Arc<Image>)>> = Mutex::new(None);

fn planet_pixel(x: u32, y: u32, seed: u32) -> [u8; 4] {
    let (longitude, colatitude) = (TAU * (x as f32 + 0.5) / 1024.0, PI * (y as f32 + 0.5) / 512.0);
    let (sine, cosine) = colatitude.sin_cos();
    let position = [sine * longitude.sin(), cosine, sine * longitude.cos()];
    let [r, g, b] = planet_light(position, seed).map(encode_srgb);
    [r, g, b, 255]
}

/// Albedo of the planet at a unit vector, linear sRGB.
fn planet_light(position: [f32; 3], seed: u32) -> [f32; 3] {
    let height = clouds_of_noise(position, 1.7, seed) + 0.35 * (clouds_of_noise(position, 6.0, seed ^ 5) - 0.5);
    let land = smooth(0.51, 0.54, height);
    let high = smooth(0.54, 0.75, height);
    let ground = mix([0.05, 0.09, 0.035], [0.20, 0.15, 0.09], high);
    let open = mix([0.010, 0.028, 0.060], ground, land);
    let frozen = smooth(0.80, 0.90, position[1].abs() + 0.12 * (height - 0.5));
    let surface = if frozen > 0.0 { mix(open, ice_light(position, land, seed), frozen) } else { open };
    let cloud = smooth(0.50, 0.72, clouds_of_noise(position.map(|x| x + 0.15 * height), 3.1, seed ^ 77));
    // Over the ice, where air is cold and dry, clouds are thin.
    mix(surface, [0.75; 3], (0.8 - 0.45 * frozen) * cloud)
}

/// Albedo of what is frozen: on land snow and older, bluer ice, with bare rock along ridges; on the sea floes, with dark leads of open
/// water between them.
fn ice_light(position: [f32; 3], land: f32, seed: u32) -> [f32; 3] {
    let (broad, fine) = (clouds_of_noise(position, 9.0, seed ^ 211), clouds_of_noise(position, 17.0, seed ^ 212));
    // Where noise passes through its mean it draws lines.
    let line = |noise: f32, width: f32| smooth(width, 0.0, (noise - 0.5).abs());
    let leads = line(broad, 0.045).max(0.7 * line(fine, 0.03));
    let floes = mix([0.20, 0.27, 0.34], [0.55, 0.60, 0.65], smooth(0.35, 0.62, 0.4 * broad + 0.6 * fine));
    let sea = mix(floes, [0.015, 0.035, 0.060], 0.92 * leads);
    let snow = mix([0.40, 0.50, 0.60], [0.90, 0.92, 0.94], smooth(0.36, 0.60, 0.6 * broad + 0.4 * fine));
    let rock = smooth(0.56, 0.68, broad) * line(fine, 0.05);
    mix(sea, mix(snow, [0.10, 0.09, 0.08], 0.85 * rock), land)
}

fn mix(a: [f32; 3], b: [f32; 3], s: f32) -> [f32; 3] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * s)
}

/// Six octaves of smooth noise in [0, 1] over space.
fn clouds_of_noise(position: [f32; 3], scale: f32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, scale);
    for octave in 0..6u32 {
        sum += weight * space_noise(position.map(|x| x * scale + 17.3), seed.wrapping_mul(31).wrapping_add(octave));
        weight *= 0.5;
        scale *= 2.03;
    }
    sum / (1.0 - 1.0 / 64.0)
}

/// Noise in [0, 1], smooth, one value at each point of the integer lattice.
fn space_noise(position: [f32; 3], seed: u32) -> f32 {
    let cell = position.map(floor);
    let s: [f32; 3] = std::array::from_fn(|k| {
        let t = position[k] - cell[k];
        t * t * (3.0 - 2.0 * t)
    });
    let mut sum = 0.0;
    // On the lower and the upper side along each axis: a weight, and the number so far, hashed with the place.
    let along = |k: usize, key: u32| {
        let hashed = |bit: f32| random::hash(key.wrapping_add((cell[k] + bit) as i32 as u32));
        [(1.0 - s[k], hashed(0.0)), (s[k], hashed(1.0))]
    };
    let first = along(0, seed).map(|(x, key)| (x, along(1, key)));
    let corners =
        first.map(|(x, second)| second.map(|(y, key)| along(2, key).map(|(z, key)| x * y * z * (key >> 8) as f32 / 16_777_216.0)));
    for corner in 0..8 {
        sum += corners[corner & 1][corner >> 1 & 1][corner >> 2];
    }
    sum
}

/// The greatest whole number that is not above `x`, of some millions at most. The library's is a call on processors of old.
fn floor(x: f32) -> f32 {
    let whole = x as i32 as f32;
    if whole > x { whole - 1.0 } else { whole }
}

fn draw(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4] + Sync) -> Image {
    let mut rgba = vec![0; (width * height * 4) as usize];
    rgba.par_chunks_exact_mut(width as usize * 4).zip(0..height).for_each(|(row, y)| {
        for (bytes, x) in row.chunks_exact_mut(4).zip(0..width) {
            bytes.copy_from_slice(&pixel(x, y));
        }
    });
    Image { width, height, rgba }
}

/// Linear to sRGB, 8 bits (IEC 61966-2-1).
pub fn encode_srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// The light of the galaxy at (x, y) in [−1, 1]², linear sRGB.
fn galaxy_light(x: f32, y: f32) -> [f32; 3] {
    let radius = x.hypot(y);
    let angle = y.atan2(x);
    // Arms r ∝ exp(θ tan p), pitch p = 16°, made ragged by noise that follows the gas.
    let wind = (radius + 0.02).ln() / 16f32.to_radians().tan();
    let ragged = 1.1 * (fractal(4.0 * x, 4.0 * y, 11) - 0.5) + 0.35 * (fractal(14.0 * x, 14.0 * y, 12) - 0.5);
    let phase = 2.0 * (angle - wind) + 2.2 * ragged;
    let arm = (0.5 + 0.5 * phase.cos()).powf(2.2) + 0.35 * (0.5 + 0.5 * (2.0 * phase + 1.1).cos()).powf(4.0);
    // Dust lies where the gas is compressed: on the inner, leading side of each arm.
    let dust_arm = (0.5 + 0.5 * (phase - 0.85).cos()).powf(7.0);
    let grain = fractal(9.0 * x, 9.0 * y, 13);
    let fine = fractal(40.0 * x, 40.0 * y, 14);

    let edge = smooth(1.0, 0.72, radius + 0.12 * (grain - 0.5));
    let disk = (-radius / 0.30).exp() * edge;
    let core = (-(radius / 0.055).powi(2)).exp() + 0.42 * (-radius / 0.085).exp();
    let (along, across) = (x * 0.8 + y * 0.6, y * 0.8 - x * 0.6);
    let bar = 0.35 * (-(along / 0.16).powi(2) - (across / 0.05).powi(2)).exp();
    let inside_arms = smooth(0.06, 0.2, radius);
    let dust = 1.0 - 0.8 * (dust_arm * inside_arms * smooth(0.85, 0.3, radius) * (0.45 + 0.9 * grain)).min(1.0);

    let old = 0.34 * disk * (0.35 + 0.75 * arm) * dust + (core + bar) * (0.35 + 0.65 * dust);
    let clumps = (0.25 + 1.5 * grain * grain) * (0.5 + fine);
    let young = 2.1 * disk * arm * inside_arms * clumps * dust;
    let pink = 3.4 * disk.sqrt() * arm.powf(1.5) * inside_arms * spots(x, y, 46.0, 21) * edge;
    let cluster = 1.6 * disk.sqrt() * arm * inside_arms * spots(x, y, 90.0, 22) * edge;
    [
        1.15 * old + 0.30 * young + 1.0 * pink + 0.65 * cluster,
        0.84 * old + 0.55 * young + 0.16 * pink + 0.84 * cluster,
        0.52 * old + 1.15 * young + 0.38 * pink + 1.15 * cluster,
    ]
    .map(|light| 1.0 - (-1.35 * light).exp())
}

/// 0 at `from`, 1 at `to`, smooth between; `from` may be the greater.
fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Round spots of random position and strength, at most one in a cell of a `cells` × `cells` grid over [−1, 1]², most cells empty.
fn spots(x: f32, y: f32, cells: f32, seed: u32) -> f32 {
    let (gx, gy) = ((x + 1.0) * cells / 2.0, (y + 1.0) * cells / 2.0);
    let mut light = 0.0f32;
    for dy in -1..=1 {
        for dx in -1..=1 {
            let (cx, cy) = (gx.floor() as i32 + dx, gy.floor() as i32 + dy);
            let strength = hash(cx, cy, seed);
            if strength < 0.72 {
                continue;
            }
            let turn = TAU * hash(cx, cy, seed + 100);
            let away = 0.3 * hash(cx, cy, seed + 200);
            let spread = 0.10 + 0.22 * hash(cx, cy, seed + 300);
            let distance = (gx - cx as f32 - 0.5 - away * turn.cos()).hypot(gy - cy as f32 - 0.5 - away * turn.sin());
            light += (strength - 0.72) * 3.5 * (-(distance / spread).powi(2)).exp();
        }
    }
    light
}

/// Five octaves of value noise in [0, 1].
fn fractal(x: f32, y: f32, seed: u32) -> f32 {
    let (mut total, mut weight, mut scale) = (0.0, 0.5, 1.0);
    for octave in 0..5 {
        // Each octave is turned, so that the grids do not show.
        let (sine, cosine) = (0.6 * octave as f32 + PI / 7.0).sin_cos();
        total += weight * noise(scale * (x * cosine - y * sine), scale * (x * sine + y * cosine), seed + octave);
        (weight, scale) = (weight / 2.0, scale * 2.0);
    }
    total / 0.968_75
}

fn noise(x: f32, y: f32, seed: u32) -> f32 {
    let (cx, cy) = (x.floor(), y.floor());
    let (fx, fy) = (smooth(0.0, 1.0, x - cx), smooth(0.0, 1.0, y - cy));
    let at = |dx: i32, dy: i32| hash(cx as i32 + dx, cy as i32 + dy, seed);
    let lower = at(0, 0) + fx * (at(1, 0) - at(0, 0));
    let upper = at(0, 1) + fx * (at(1, 1) - at(0, 1));
    lower + fy * (upper - lower)
}

/// A number in [0, 1) from a grid point: the avalanche steps of a 32-bit integer hash.
fn hash(x: i32, y: i32, seed: u32) -> f32 {
    let mut h = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    h ^= h >> 15;
    (h >> 8) as f32 / (1u32 << 24) as f32
}
