//! A disk ready to be drawn.

use crate::scene::GameConfig;
use crate::scene::config;
use crate::scene::disk::arcs::Arcs;
use crate::scene::disk::{Gas, PATTERN_HEIGHT};

/// Number of radii in the table of gas for sprites and polygons.
const RADII: usize = 512;

/// A disk ready to be drawn.
#[derive(Clone, Debug)]
pub struct Disk {
    /// The gas.
    pub gas: Gas,
    /// Its arcs.
    pub arcs: Arcs,
    /// What `game.toml` and the scene say.
    pub config: config::Disk,
    /// Least width of thin images, in pixels.
    pub min_width: f64,
}

impl Disk {
    /// The disk of `disk` around the hole of `config`.
    pub fn new(disk: config::Disk, config: &GameConfig) -> Disk {
        let gas = Gas::new(&disk, config.hole.mass_solar);
        let arcs = Arcs::new(&disk, &gas.radial);
        Disk { gas, arcs, config: disk, min_width: config.render.min_width }
    }

    /// Two rows for each radius, as `shaders/disk/radial.wgsl` reads them.
    pub(super) fn radial_table(&self) -> Vec<[f32; 4]> {
        let radial = &self.gas.radial;
        let [start, end] = self.gas.extent();
        (0..RADII)
            .flat_map(|k| {
                let r = start + (end - start) * k as f64 / (RADII - 1) as f64;
                let [outward, along] = radial.momentum(r);
                let pattern = radial.pattern_radius(r).ln() / PATTERN_HEIGHT;
                [
                    [radial.temperature(r).ln(), radial.depth(r), outward, along].map(|value| value as f32),
                    [radial.lag(r), self.gas.half_height(r), pattern, r].map(|value| value as f32),
                ]
            })
            .collect()
    }
}
