//! The method of Yamashita 2012, as its author had it: ψ in the static frame in four tables (inside and outside r = L, primary and
//! secondary), trilinear, on uniform meshes (its table 2) or on the meshes of its equations 3 to 7 (its table 3).
//!
//! Yamashita, "GPU-based real time computer graphics in a black hole space-time" (2012). The delay is stored beside ψ, which the
//! paper does not have.

use rayon::prelude::*;

use super::paper_format::{CHANNELS, RANGES};
use super::table::{Scheme, Table};
use crate::spacetime::light::{Branch, Order, connect, static_angle};

/// The smallest φ at which a ray is asked for, in radians; ψ at φ = 0 is its limit.
const SMALLEST_ANGLE: f64 = 1e-9;

/// One mesh: F[A, a, b] of section 4.2; A = 0 is uniform.
#[derive(Clone, Copy, Debug)]
pub struct Mesh {
    bias: f64,
    first: f64,
    last: f64,
}

impl Mesh {
    /// The place at `z` in 0..=1.
    pub fn value(self, z: f64) -> f64 {
        let share = if self.bias == 0.0 { z } else { (self.bias * z).exp_m1() / self.bias.exp_m1() };
        self.first + (self.last - self.first) * share
    }

    /// A, 0 where it is uniform.
    pub fn bias(self) -> f64 {
        self.bias
    }

    /// a and b.
    pub fn ends(self) -> [f64; 2] {
        [self.first, self.last]
    }

    /// The z of a place.
    pub fn coordinate(self, x: f64) -> f64 {
        let share = (x - self.first) / (self.last - self.first).max(f64::MIN_POSITIVE);
        if self.bias == 0.0 { share } else { (share * self.bias.exp_m1()).ln_1p() / self.bias }
    }
}

/// The mesh of L for the table inside (r ≤ L) or outside: equation 7.
pub fn camera_mesh(scheme: Scheme, inside: bool) -> Mesh {
    let bias = if scheme == Scheme::PaperUniform {
        0.0
    } else if inside {
        15.3
    } else {
        8.54
    };
    Mesh { bias, first: RANGES[0], last: RANGES[1] }
}

/// The meshes of r and φ at the camera radius `l`: equations 3 to 6.
pub fn slice_meshes(scheme: Scheme, inside: bool, l: f64) -> [Mesh; 2] {
    let x = (l / RANGES[0]).ln() / (RANGES[1] / RANGES[0]).ln();
    let [radial, angular] = match (scheme, inside) {
        (Scheme::PaperUniform, _) => [0.0, 0.0],
        (_, true) => [-4.70 * x - 2.12 + 0.123 / (x + 0.00605), 4.38 * x + 3.56 + 0.000130 / (x + 0.000250)],
        (_, false) => [-7.95 * x + 14.4, 3.72 * x + 3.70],
    };
    let [first, last] = if inside { [RANGES[2], l] } else { [l, RANGES[3]] };
    [Mesh { bias: radial, first, last }, Mesh { bias: angular, first: 0.0, last: RANGES[5] }]
}

/// ψ and the delay at one node of the table inside or outside; at the camera itself and on the axis, their limits.
fn node(inside: bool, order: Order, r: f64, phi: f64, l: f64) -> [f32; 2] {
    let swept = order.swept(phi).max(SMALLEST_ANGLE);
    let at_camera = order.number() == 1 && phi < SMALLEST_ANGLE && (r - l).abs() < 1e-12 * l;
    let limit = if inside { std::f64::consts::PI } else { 0.0 };
    if at_camera {
        return [limit as f32, 0.0];
    }
    connect(1.0 / r, swept, 1.0 / l, Branch::Plus)
        .and_then(|ray| Some([static_angle(ray.slope, ray.energy, 1.0 / l)? as f32, ray.delay as f32]))
        .unwrap_or([limit as f32, 0.0])
}

/// The four tables with `nodes` along each axis, values of a node together, r fastest.
pub fn bake(scheme: Scheme, nodes: usize, done: impl Fn(f64) + Sync) -> Table {
    let at = |i: usize| i as f64 / (nodes - 1) as f64;
    let values = (0..nodes)
        .into_par_iter()
        .flat_map_iter(|iz| {
            let mut layer = vec![0.0f32; nodes * nodes * CHANNELS];
            for (half, inside) in [true, false].into_iter().enumerate() {
                let l = camera_mesh(scheme, inside).value(at(iz));
                let [radial, angular] = slice_meshes(scheme, inside, l);
                for i in 0..nodes * nodes {
                    let (r, phi) = (radial.value(at(i % nodes)), angular.value(at(i / nodes)));
                    for (k, order) in Order::ALL.into_iter().take(2).enumerate() {
                        let place = i * CHANNELS + half * 4 + k * 2;
                        layer[place..place + 2].copy_from_slice(&node(inside, order, r, phi, l));
                    }
                }
            }
            done(1.0 / nodes as f64);
            layer
        })
        .collect();
    Table { scheme, size: [nodes as u32; 3], values }
}

/// Static ψ in radians and the delay in r_s/c at (r, φ, L) for order 1 or 2, trilinear in f32; clamped to the table's range.
pub fn lookup(table: &Table, [r, phi, l]: [f64; 3], order: u8) -> [f64; 2] {
    let n = table.size[0] as usize;
    let inside = r <= l;
    let z = camera_mesh(table.scheme, inside).coordinate(l);
    let [radial, angular] = slice_meshes(table.scheme, inside, l);
    let cells =
        [radial.coordinate(r), angular.coordinate(phi), z].map(|v| super::table::spline::cell(if v.is_finite() { v } else { 0.0 }, n));
    let channel = if inside { 0 } else { 4 } + 2 * (order as usize - 1);
    let mut sum = [0.0f32; 2];
    for corner in 0..8usize {
        let mut index = 0;
        let mut weight = 1.0f32;
        for axis in (0..3).rev() {
            let bit = corner >> axis & 1;
            index = index * n + cells[axis].0 + bit;
            weight *= if bit == 1 { cells[axis].1 as f32 } else { 1.0 - cells[axis].1 as f32 };
        }
        (0..2).for_each(|h| sum[h] += weight * table.values[index * CHANNELS + channel + h]);
    }
    sum.map(f64::from)
}

/// What shaders/method/paper1.wgsl reads: the constants of the camera radius `l` as in [`super::Slice`], four meshes (bias, first, last)
/// as r and φ inside, r and φ outside, then for each node, r fastest, two texels (ψ and delay of both orders) of the tables inside and
/// outside. L is constant within a frame, so the linear step along it is taken here; the two others are left to the shader.
pub fn slice(table: &Table, l: f64) -> Vec<[f32; 4]> {
    let n = table.size[0] as usize;
    let cam = super::single::camera(l);
    let mut texels = vec![
        [cam.l, cam.lapse2, cam.a, cam.beta],
        [cam.fade, cam.bend, cam.rate, cam.even],
        [cam.soft, cam.start, cam.scale, 0.0],
        [n as f32, n as f32, 0.0, 0.0],
    ];
    let layers = [true, false].map(|inside| {
        let meshes = slice_meshes(table.scheme, inside, l);
        texels.extend(meshes.map(|mesh| [mesh.bias as f32, mesh.first as f32, mesh.last as f32, 0.0]));
        let z = camera_mesh(table.scheme, inside).coordinate(l);
        super::table::spline::cell(if z.is_finite() { z } else { 0.0 }, n)
    });
    let node = |layer: usize, i: usize, h: usize| table.values[(layer * n * n + i) * CHANNELS + h];
    for i in 0..n * n {
        for (half, (layer, t)) in layers.iter().enumerate() {
            let t = *t as f32;
            texels.push(std::array::from_fn(|h| (1.0 - t) * node(*layer, i, 4 * half + h) + t * node(layer + 1, i, 4 * half + h)));
        }
    }
    texels
}
