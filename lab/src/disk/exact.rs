//! The gas of the disk seen exactly: for each sample of each pixel the closed-form ray in f64, its crossings of the plane, and the model of
//! `scene::disk` at each. No table, no triangles.

use lensrunner::spacetime::Observer;
use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use lensrunner::scene::blackbody;
use lensrunner::scene::disk::{DISK_UNIT, Gas};
use lensrunner::spacetime::frames;
use lensrunner::spacetime::light::{self, Ray, SweepEnd};

/// One crossing of the disk's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Radius in r_s.
    pub radius: f64,
    /// Azimuth in rad, from +x towards +y.
    pub azimuth: f64,
    /// Light path to the camera in r_s.
    pub path: f64,
    /// ν_observed/ν_emitted for gas that moves as it does there.
    pub ratio: f64,
    /// |cos| of the angle between ray and normal in the gas's frame.
    pub cosine: f64,
}

/// Linear light (red, green, blue) of the disk alone, row by row from the top, black where it is not; `samples`² samples a pixel in a
/// regular grid.
pub fn picture(gas: &Gas, eye: &Observer, size: [u32; 2], time: f64, orders: u32, samples: u32) -> Vec<[f32; 3]> {
    part(gas, eye, size, [[0; 2], size], time, orders, samples)
}

/// A part of that picture: the pixel where it begins, from the left and the top, and its width and height.
pub fn part(gas: &Gas, eye: &Observer, size: [u32; 2], part: [[u32; 2]; 2], time: f64, orders: u32, samples: u32) -> Vec<[f32; 3]> {
    let colours = blackbody::table(4096, 200.0, 2.0e6);
    let samples = samples.max(1);
    let step = 1.0 / f64::from(samples);
    let [[left, top], [width, height]] = part;
    (0..width * height)
        .into_par_iter()
        .map(|index| {
            let (x, y) = (f64::from(left + index % width), f64::from(top + index / width));
            let mut sum = [0.0; 3];
            for k in 0..samples * samples {
                let at = [x + (f64::from(k % samples) + 0.5) * step, y + (f64::from(k / samples) + 0.5) * step];
                let light = sample(gas, eye, size, at, time, orders, &colours);
                sum = std::array::from_fn(|c| sum[c] + light[c] * step * step);
            }
            sum.map(|light| light as f32)
        })
        .collect()
}

/// Light from the point `at` of the picture, in pixels: the crossings, nearest first, each before what is behind it.
fn sample(gas: &Gas, eye: &Observer, size: [u32; 2], at: [f64; 2], time: f64, orders: u32, colours: &[[f32; 4]]) -> [f64; 3] {
    let mut light = [0.0; 3];
    let mut passed = 1.0;
    for crossing in crossings(gas, eye, size, at, orders) {
        let there = gas.emission(crossing.radius, crossing.azimuth, time - crossing.path);
        let opacity = there.opacity(crossing.cosine, crossing.path);
        let rgb = blackbody::lookup(colours, 200.0, 2.0e6, (there.temperature * crossing.ratio) as f32);
        light = std::array::from_fn(|c| light[c] + passed * opacity * f64::from(rgb[c]) * DISK_UNIT);
        passed *= 1.0 - opacity;
    }
    light
}

/// Where the ray through the point `at` of the picture crosses the gas, order by order.
pub fn crossings(gas: &Gas, eye: &Observer, size: [u32; 2], at: [f64; 2], orders: u32) -> Vec<Crossing> {
    let [width, height] = size.map(f64::from);
    let focal = 0.5 * width / (0.5 * eye.field_of_view).tan();
    let seen = DVec3::new((at[0] - 0.5 * width) / focal, (0.5 * height - at[1]) / focal, -1.0).normalize();
    // Light of frequency 1 in the camera's frame, followed backwards.
    let past = (frames::ship_to_rain(eye.momentum, eye.attitude) * seen.extend(-1.0)).truncate();
    let frequency = past.length();
    let look = past / frequency;
    let l = eye.position.length();
    let (n, u) = (eye.position / l, 1.0 / l);
    let cosine = look.dot(n);
    let tangent = (look - n * cosine).normalize_or(n.any_orthonormal_vector());
    let psi = look.cross(n).length().atan2(cosine);
    let start = light::launch(psi, u);
    let here = light::rain_momentum(start.slope, start.energy, u);
    let observed = here[0].hypot(here[1]) / frequency;

    // The ray stays in the plane of n and the tangent; after Φ it is at n cos Φ + tangent sin Φ.
    let first = (-n.z).atan2(tangent.z).rem_euclid(PI);
    let [inner, outer] = gas.extent();
    (0..orders)
        .filter_map(|order| {
            let swept = first + PI * f64::from(order);
            let SweepEnd::At { u: u_point, slope } = light::follow(u, start.slope, swept) else { return None };
            let radius = 1.0 / u_point;
            if !(radius > inner && radius < outer) {
                return None;
            }
            let ray = Ray { slope: start.slope, emission_slope: slope, energy: start.energy };
            let path = light::delay(&ray, u_point, swept, u);
            let outward = n * swept.cos() + tangent * swept.sin();
            let onward = tangent * swept.cos() - n * swept.sin();
            let [radial, along] = light::rain_momentum(slope, start.energy, u_point);
            let photon = outward * radial + onward * along;
            let momentum = gas.momentum(outward * radius);
            let emitted = (1.0 + momentum.length_squared()).sqrt() * photon.length() - momentum.dot(photon);
            Some(Crossing {
                radius,
                azimuth: outward.y.atan2(outward.x),
                path,
                ratio: observed / emitted,
                cosine: Gas::cosine(momentum, photon),
            })
        })
        .collect()
}
