//! A disk ready to be drawn.

use crate::render::disk::types::RadialGas;
use crate::scene::GameConfig;
use crate::scene::config;
use crate::scene::disk::arcs::Arcs;
use crate::scene::disk::{Gas, PATTERN_HEIGHT};

/// Number of radii in the table of gas for sprites and polygons.
const RADII: usize = 512;

/// A disk ready to be drawn.
#[derive(Clone, Debug)]
pub struct DrawnDisk {
    /// The gas.
    pub gas: Gas,
    /// Its arcs.
    pub arcs: Arcs,
    /// What `game.toml` and the scene say.
    pub config: config::Disk,
    /// Least width of thin images, in pixels.
    pub min_width: f64,
}

impl DrawnDisk {
    /// The disk of `disk` around the hole of `config`.
    pub fn new(disk: config::Disk, config: &GameConfig) -> DrawnDisk {
        let gas = Gas::new(&disk, config.hole.mass_solar);
        let arcs = Arcs::new(&disk, &gas.radial);
        DrawnDisk { gas, arcs, config: disk, min_width: config.render.min_width }
    }

    /// The gas at radius `r`, in r_s.
    pub(super) fn gas_at(&self, r: f64) -> RadialGas {
        let radial = &self.gas.radial;
        let [outward, along] = radial.momentum(r);
        RadialGas {
            radius: r as f32,
            lead: radial.lag(r) as f32,
            ln_temperature: radial.temperature(r).ln() as f32,
            depth: radial.depth(r) as f32,
            outward: outward as f32,
            along: along as f32,
            half_height: self.gas.half_height(r) as f32,
            pattern_height: (radial.pattern_radius(r).ln() / PATTERN_HEIGHT) as f32,
        }
    }

    /// The gas at radii that divide the disk evenly, for `shaders/disk/radial.wgsl`.
    pub(super) fn radial_table(&self) -> Vec<RadialGas> {
        let [start, end] = self.gas.extent();
        (0..RADII).map(|k| self.gas_at(start + (end - start) * k as f64 / (RADII - 1) as f64)).collect()
    }
}
