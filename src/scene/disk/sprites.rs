//! The disk as point sprites (paper 2, section 2.2), for the chart: bits of gas at random places, each a small spot.

use std::f64::consts::TAU;

use crate::scene::config;

use super::noise::hash;
use super::radial::Radial;

/// One bit of gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprite {
    /// Radius in r_s.
    pub radius: f64,
    /// Azimuth at T = 0, in rad.
    pub azimuth: f64,
}

/// `disk.sprites` sprites, evenly over the disk's area.
pub fn sprites(disk: &config::Disk, radial: &Radial) -> Vec<Sprite> {
    let [start, end] = radial.extent();
    (0..u64::from(disk.sprites))
        .map(|k| {
            let bits = hash(k, u64::from(disk.seed) << 8 | 2);
            let [a, b] = [(bits >> 32) as f64, (bits & 0xffff_ffff) as f64].map(|half| half / 4_294_967_296.0);
            Sprite { radius: (start * start + a * (end * end - start * start)).sqrt(), azimuth: b * TAU }
        })
        .collect()
}
