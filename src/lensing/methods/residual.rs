//! The residual table without a slice: interpolated in three dimensions for each point, linearly or by cubic B-splines, in single or
//! half precision.

use half::f16;

use super::slice::{in_range, seen};
use super::{Frame, Projector, Query, Sight, Vertex, each};
use crate::lensing::Table;
use crate::lensing::lookup::source_point::source_point;
use crate::lensing::lookup::{LensRay, OLD, YOUNG, lookup_with, swept};
use crate::lensing::single::{LensCamera, camera};
use crate::lensing::table::{grid, spline};
use crate::spacetime::light::{Branch, Order};

/// How values between the nodes are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// From the eight nodes around: what texture hardware does.
    Linear,
    /// From 64 B-spline coefficients.
    Cubic,
}

/// Three residuals as they are kept.
pub trait Texels: Copy + Sync + Send {
    /// Rounds.
    fn pack(values: [f32; 3]) -> Self;
    /// Back.
    fn unpack(self) -> [f32; 3];
}

impl Texels for [f32; 3] {
    fn pack(values: [f32; 3]) -> Self {
        values
    }

    fn unpack(self) -> [f32; 3] {
        self
    }
}

impl Texels for [f16; 3] {
    fn pack(values: [f32; 3]) -> Self {
        values.map(f16::from_f32)
    }

    fn unpack(self) -> [f32; 3] {
        self.map(f16::to_f32)
    }
}

/// The table: coefficients for the cubic, values at the nodes for the linear interpolation.
pub struct Residual<T> {
    interpolation: Interpolation,
    /// Nodes along r, Φ, L.
    nodes: [usize; 3],
    /// Values along them, r fastest.
    size: [usize; 3],
    values: Vec<T>,
}

impl<T: Texels> Residual<T> {
    /// From a table of the scheme residual.
    pub fn new(table: &Table, interpolation: Interpolation) -> Self {
        let nodes = table.size.map(|n| n as usize);
        let coefficients = table.values.as_chunks::<3>().0;
        if interpolation == Interpolation::Cubic {
            return Self { interpolation, nodes, size: nodes.map(|n| n + 2), values: coefficients.iter().map(|v| T::pack(*v)).collect() };
        }
        let [nx, ny, nz] = nodes;
        let weights = spline::weights(0.0);
        let mut values = Vec::with_capacity(nx * ny * nz);
        for (k, j, i) in (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (k, j, i)))) {
            // At a node three coefficients along each axis count.
            let mut sum = [0.0; 3];
            for tap in 0..27 {
                let [a, b, c] = [tap % 3, tap / 3 % 3, tap / 9];
                let weight = (weights[a] * weights[b] * weights[c]) as f32;
                let value = coefficients[((k + c) * (ny + 2) + j + b) * (nx + 2) + i + a];
                (0..3).for_each(|h| sum[h] += weight * value[h]);
            }
            values.push(T::pack(sum));
        }
        Self { interpolation, nodes, size: nodes, values }
    }

    /// The residuals at coordinates in 0..=1; `layer` holds the cell along L and the place in it.
    fn at(&self, x: f32, y: f32, layer: (usize, f32)) -> [f32; 3] {
        let cell = |x: f32, n: usize| {
            let x = x.clamp(0.0, 1.0) * (n - 1) as f32;
            let i = (x as usize).min(n - 2);
            (i, x - i as f32)
        };
        let cells = [cell(x, self.nodes[0]), cell(y, self.nodes[1]), layer];
        match self.interpolation {
            Interpolation::Linear => self.sum(cells.map(|c| c.0), cells.map(|c| [1.0 - c.1, c.1])),
            Interpolation::Cubic => self.sum(cells.map(|c| c.0), cells.map(|c| crate::lensing::lookup::spline_weights(c.1))),
        }
    }

    fn sum<const N: usize>(&self, [i, j, k]: [usize; 3], [wx, wy, wz]: [[f32; N]; 3]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for (c, wz) in wz.into_iter().enumerate() {
            for (b, wy) in wy.into_iter().enumerate() {
                let first = ((k + c) * self.size[1] + j + b) * self.size[0] + i;
                let row = &self.values[first..first + N];
                for (texel, wx) in row.iter().zip(wx) {
                    let value = texel.unpack();
                    let weight = wx * wy * wz;
                    (0..3).for_each(|h| sum[h] += weight * value[h]);
                }
            }
        }
        sum
    }

    fn layer(&self, l: f64) -> (usize, f32) {
        let (layer, t) = spline::cell(grid::camera_axis(l), self.nodes[2]);
        (layer, t as f32)
    }

    fn ray(&self, cam: &LensCamera, layer: (usize, f32), point: &Vertex, order: Order, branch: Branch) -> LensRay {
        let at = source_point(cam, point.along, point.across, point.height);
        let elapsed = if branch == Branch::Minus { OLD } else { YOUNG };
        lookup_with(cam, at, swept(at, u32::from(order.number())), elapsed, |x, y| self.at(x, y, layer))
    }
}

impl<T: Texels> Projector for Residual<T> {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        if !in_range(query) {
            return None;
        }
        let ray = self.ray(&camera(query.camera), self.layer(query.camera), &query.into(), order, branch);
        ray.valid.then(|| seen(&ray, query))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let (cam, layer) = (camera(l), self.layer(l));
        each(move |point, order| self.ray(&cam, layer, point, order, Branch::Plus))
    }

    fn memory(&self) -> usize {
        size_of_val(self.values.as_slice())
    }
}
