//! The tables of Yamashita 2012 as a game would fetch from them: what depends on the camera's radius alone computed once a frame, one
//! logarithm for each of r and φ, eight corners, all in f32.

use wide::f32x8;

use lensrunner::lensing::lookup::source_point::source_point;
use lensrunner::lensing::methods::paper::answers;
use lensrunner::lensing::methods::{ProjectionInput, Projector, Sight, Vertex};
use lensrunner::lensing::paper_format::CHANNELS;
use lensrunner::lensing::single::{LensCamera, camera};
use lensrunner::lensing::table::spline;
use lensrunner::lensing::{Table, paper};
use lensrunner::spacetime::light::{Branch, Order};

use super::batch::{self, LANES};
use super::{Frame, Method, each};

/// The four tables of Yamashita 2012.
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
    cam: LensCamera,
    halves: [Half; 2],
}

impl Paper {
    fn ready(&self, l: f64) -> Ready {
        let nodes = self.0.size[0] as usize;
        let half = |inside: bool| {
            let z = paper::camera_mesh(self.0.scheme, inside).coordinate(l);
            let (layer, share) = spline::cell(if z.is_finite() { z } else { 0.0 }, nodes);
            let [radial, angular] = paper::slice_meshes(self.0.scheme, inside, l);
            let first = radial.ends()[0] as f32;
            Half { radial: Axis::new(radial, nodes), angular: Axis::new(angular, nodes), layer, share: share as f32, first }
        };
        Ready { cam: camera(l), halves: [half(true), half(false)] }
    }

    /// ψ of a static camera, and the delay.
    fn fetch(&self, ready: &Ready, point: &Vertex, order: Order) -> [f32; 2] {
        let n = self.0.size[0] as usize;
        let at = source_point(&ready.cam, point.along, point.across, point.height);
        let inside = at.dr <= 0.0;
        let half = &ready.halves[usize::from(!inside)];
        let (i, x) = half.radial.cell(if inside { at.r - half.first } else { at.dr }, n);
        let (j, y) = half.angular.cell(at.phi, n);
        let channel = if inside { 0 } else { 4 } + 2 * (usize::from(order.number()) - 1);
        self.corners([i, j, half.layer], [x, y, half.share], channel)
    }

    /// ψ and the delay between the eight nodes around a place.
    fn corners(&self, [i, j, layer]: [usize; 3], [x, y, share]: [f32; 3], channel: usize) -> [f32; 2] {
        let n = self.0.size[0] as usize;
        let mut sum = [0.0f32; 2];
        for (k, wz) in [(layer, 1.0 - share), (layer + 1, share)] {
            for (j, wy) in [(j, 1.0 - y), (j + 1, y)] {
                let base = ((k * n + j) * n + i) * CHANNELS + channel;
                let corner = &self.0.values[base..base + CHANNELS + 2];
                let weight = wz * wy;
                for h in 0..2 {
                    sum[h] += weight * (corner[h] * (1.0 - x) + corner[CHANNELS + h] * x);
                }
            }
        }
        sum
    }
}

/// The same fetch for eight points at once: places and logarithms in SIMD registers, corners lane by lane.
pub struct PaperBatch(pub Paper);

/// Where the points of a batch lie along one of the axes, in cells.
fn cells(axis: [Axis; LANES], offset: f32x8, nodes: usize) -> ([f32; LANES], [f32; LANES]) {
    let of = |field: fn(&Axis) -> f32| f32x8::from(axis.each_ref().map(field));
    let x = of(|a| a.factor) * offset.fast_max(f32x8::ZERO);
    let z = if axis[0].uniform { x } else { (f32x8::ONE + x).ln() * of(|a| a.cells) };
    let z = z.fast_max(f32x8::ZERO).fast_min(f32x8::splat((nodes - 1) as f32));
    let cell = z.floor().fast_min(f32x8::splat((nodes - 2) as f32));
    (cell.to_array(), (z - cell).to_array())
}

impl PaperBatch {
    fn fetch(&self, ready: &Ready, points: &[Vertex], order: Order) -> [[f32; 2]; LANES] {
        let n = self.0.0.size[0] as usize;
        let last = points.len() - 1;
        let of = |field: fn(&Vertex) -> f32| f32x8::from(std::array::from_fn(|i| field(&points[i.min(last)])));
        let [r, _, dr, phi] = batch::source_point(&ready.cam, of(|p| p.along), of(|p| p.across), of(|p| p.height));
        let beyond = dr.simd_gt(f32x8::ZERO);
        let side = beyond.to_bitmask();
        let halves: [&Half; LANES] = std::array::from_fn(|i| &ready.halves[(side >> i & 1) as usize]);
        let first = f32x8::from(halves.map(|half| half.first));
        let (i, x) = cells(halves.map(|half| half.radial), beyond.select(dr, r - first), n);
        let (j, y) = cells(halves.map(|half| half.angular), phi, n);
        std::array::from_fn(|lane| {
            let (half, x, y) = (halves[lane], x[lane], y[lane]);
            let channel = if side >> lane & 1 == 0 { 0 } else { 4 } + 2 * (usize::from(order.number()) - 1);
            let (i, j) = (i[lane] as usize, j[lane] as usize);
            self.0.corners([i, j, half.layer], [x, y, half.share], channel)
        })
    }
}

struct Batches<'a>(&'a PaperBatch, Ready);

impl Frame for Batches<'_> {
    fn look_up(&self, points: &[Vertex], order: Order) {
        for points in points.chunks(LANES) {
            std::hint::black_box(self.0.fetch(&self.1, points, order));
        }
    }
}

impl Projector for PaperBatch {
    fn project(&self, input: ProjectionInput, order: Order, _branch: Branch) -> Option<Sight> {
        if !answers(input, order) {
            return None;
        }
        let [psi, delay] = self.fetch(&self.0.ready(input.camera), &[input.into()], order)[0].map(f64::from);
        Some(Sight::from_static(psi, delay, input.camera))
    }
}

impl Method for PaperBatch {
    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        Box::new(Batches(self, self.0.ready(l)))
    }

    fn memory(&self) -> usize {
        self.0.memory()
    }
}

impl Projector for Paper {
    fn project(&self, input: ProjectionInput, order: Order, _branch: Branch) -> Option<Sight> {
        if !answers(input, order) {
            return None;
        }
        let [psi, delay] = self.fetch(&self.ready(input.camera), &input.into(), order).map(f64::from);
        Some(Sight::from_static(psi, delay, input.camera))
    }
}

impl Method for Paper {
    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let ready = self.ready(l);
        each(move |point, order| self.fetch(&ready, point, order))
    }

    fn memory(&self) -> usize {
        size_of_val(self.0.values.as_slice())
    }
}
