//! Paper 1's tables as a game would fetch from them: what depends on the camera's radius alone computed once a frame, one logarithm for
//! each of r and φ, eight corners, all in f32.

use super::{Frame, Projector, Query, Sight, Vertex, each};
use crate::lensing::lookup::place;
use crate::lensing::single::{Camera, camera};
use crate::lensing::{Table, paper};
use crate::spacetime::light::{Branch, Order};

/// Paper 1's four tables.
pub struct Paper(pub Table);

/// The inverse of a mesh: z = ln(1 + k (x − first))/A, or k (x − first) where it is uniform; then in cells.
#[derive(Clone, Copy)]
struct Axis {
    factor: f32,
    /// (n − 1)/A.
    cells: f32,
    uniform: bool,
}

impl Axis {
    fn new(mesh: paper::Mesh, nodes: usize) -> Axis {
        let (bias, [first, last]) = (mesh.bias(), mesh.ends());
        let length = (last - first).max(f64::MIN_POSITIVE);
        let n = (nodes - 1) as f64;
        if bias == 0.0 {
            return Axis { factor: (n / length) as f32, cells: 1.0, uniform: true };
        }
        Axis { factor: (bias.exp_m1() / length) as f32, cells: (n / bias) as f32, uniform: false }
    }

    /// The cell and the place in it of a point `offset` beyond the first node.
    fn cell(self, offset: f32, nodes: usize) -> (usize, f32) {
        // Rounding puts points on the first node before it, where the logarithm ends.
        let x = self.factor * offset.max(0.0);
        let z = if self.uniform { x } else { (1.0 + x).max(1e-30).ln() * self.cells };
        let z = z.clamp(0.0, (nodes - 1) as f32);
        let i = (z as usize).min(nodes - 2);
        (i, z - i as f32)
    }
}

/// One of the two halves (r ≤ L, r ≥ L) at a camera radius.
#[derive(Clone, Copy)]
struct Half {
    radial: Axis,
    angular: Axis,
    layer: usize,
    share: f32,
    first: f32,
}

/// What a frame needs.
struct Ready {
    cam: Camera,
    halves: [Half; 2],
}

impl Paper {
    fn ready(&self, l: f64) -> Ready {
        let nodes = self.0.size[0] as usize;
        let half = |inside: bool| {
            let z = paper::camera_mesh(self.0.scheme, inside).coordinate(l);
            let (layer, share) = crate::lensing::spline::cell(if z.is_finite() { z } else { 0.0 }, nodes);
            let [radial, angular] = paper::slice_meshes(self.0.scheme, inside, l);
            let first = radial.ends()[0] as f32;
            Half { radial: Axis::new(radial, nodes), angular: Axis::new(angular, nodes), layer, share: share as f32, first }
        };
        Ready { cam: camera(l), halves: [half(true), half(false)] }
    }

    /// ψ of a static camera, and the delay.
    fn fetch(&self, ready: &Ready, point: &Vertex, order: Order) -> [f32; 2] {
        let n = self.0.size[0] as usize;
        let at = place(&ready.cam, point.along, point.across, point.height);
        let inside = at.dr <= 0.0;
        let half = &ready.halves[usize::from(!inside)];
        let (i, x) = half.radial.cell(if inside { at.r - half.first } else { at.dr }, n);
        let (j, y) = half.angular.cell(at.phi, n);
        let channel = if inside { 0 } else { 4 } + 2 * (usize::from(order.number()) - 1);
        let mut sum = [0.0f32; 2];
        for (k, wz) in [(half.layer, 1.0 - half.share), (half.layer + 1, half.share)] {
            for (j, wy) in [(j, 1.0 - y), (j + 1, y)] {
                let base = ((k * n + j) * n + i) * paper::CHANNELS + channel;
                let corner = &self.0.values[base..base + paper::CHANNELS + 2];
                let weight = wz * wy;
                for h in 0..2 {
                    sum[h] += weight * (corner[h] * (1.0 - x) + corner[paper::CHANNELS + h] * x);
                }
            }
        }
        sum
    }
}

impl Projector for Paper {
    fn project(&self, query: Query, order: Order, _branch: Branch) -> Option<Sight> {
        let [l_low, l_high, r_low, r_high, ..] = paper::RANGES;
        if order.number() > 2 || !(l_low..=l_high).contains(&query.camera) || !(r_low..=r_high).contains(&query.r) {
            return None;
        }
        let [psi, delay] = self.fetch(&self.ready(query.camera), &query.into(), order).map(f64::from);
        Some(Sight::from_static(psi, delay, query.camera))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let ready = self.ready(l);
        each(move |point, order| self.fetch(&ready, point, order))
    }

    fn memory(&self) -> usize {
        size_of_val(self.0.values.as_slice())
    }
}
