//! The slice of the residual table at one camera radius: what a frame sends to the GPU.

use super::{Scheme, Table};
use super::{bake, grid, spline};
use crate::lensing::double;
use crate::lensing::single::{LensCamera, camera};

/// Texels before the coefficients.
pub const HEADER: usize = 4;

/// The constants of a camera radius and the coefficients of its slice.
#[derive(Clone, Debug)]
pub struct Slice {
    /// The constants that the lookup needs besides the table.
    pub camera: LensCamera,
    /// Nodes along r and Φ; there are two more coefficients than nodes each way.
    pub size: [u32; 2],
    /// The storage buffer of the shader: four texels with the constants of `camera` and the size, then the coefficients, r fastest:
    /// the tangents of half the turns of w and w_e in 0 and 2, the residual of the delay in r_s/c in 1, 3 unused.
    pub(in crate::lensing) texels: Vec<[f32; 4]>,
}

/// Where a camera radius lies in a table: four layers and their weights.
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    /// The constants of the camera radius.
    pub camera: LensCamera,
    /// Nodes along r and Φ.
    pub size: [u32; 2],
    layers: [&'a [[f32; 3]]; 4],
    weights: [f32; 4],
    /// Between the nodes around the radius, 0 to 1.
    between: f32,
}

impl<'a> Cut<'a> {
    /// The cut of `table` (scheme residual) at the camera radius `l`, in r_s.
    ///
    /// A frame must be drawn wherever its camera is, so there is no error here: a radius beyond the table's range is moved to its nearer
    /// end ([`grid::CAMERA_RANGE`]), and what is not finite counts as the far end. `camera.l` tells the radius used. Who must not have that
    /// asks first whether the range holds the radius, as the methods of `project` do, which answer nothing beyond.
    pub fn new(table: &'a Table, l: f64) -> Cut<'a> {
        debug_assert_eq!(table.scheme, Scheme::Residual);
        let [nx, ny, nz] = table.size.map(|n| n as usize);
        let l = if l.is_finite() { l.clamp(grid::CAMERA_RANGE[0], grid::CAMERA_RANGE[1]) } else { grid::CAMERA_RANGE[1] };
        let (layer, t) = spline::cell(grid::camera_axis(l), nz);
        let size = (nx + 2) * (ny + 2) * 3;
        let layers = [0, 1, 2, 3].map(|k| table.values[(layer + k) * size..(layer + k + 1) * size].as_chunks::<3>().0);
        Cut { camera: camera(l), size: [nx as u32, ny as u32], layers, weights: spline::weights(t).map(|w| w as f32), between: t as f32 }
    }

    fn sum(&self, [a, b, c, d]: [&[f32; 3]; 4]) -> [f32; 4] {
        let [wa, wb, wc, wd] = self.weights;
        let sum = |h: usize| wa * a[h] + wb * b[h] + wc * c[h] + wd * d[h];
        [sum(0), sum(1), sum(2), 0.0]
    }

    /// The coefficient at `index`, r fastest: what [`Slice`] holds there.
    pub fn coefficient(&self, index: usize) -> [f32; 4] {
        self.sum(self.layers.map(|layer| &layer[index]))
    }

    /// The texel at `index` of [`Slice::nodes`], beyond the header, alone.
    pub fn node(&self, index: usize) -> [f32; 4] {
        node(|k| self.coefficient(k), self.size[0] as usize, index - HEADER)
    }

    /// The texel at `index` of [`Slice::halves`], beyond the header, alone.
    pub fn half(&self, index: usize) -> [f32; 4] {
        let first = 2 * (index - HEADER);
        pair([first, first + 1].map(|k| if k < self.layers[0].len() { self.coefficient(k) } else { [0.0; 4] }))
    }
}

/// The residuals at the node `k`, r fastest, from the coefficients around it: at a node three along each axis count.
fn node(coefficient: impl Fn(usize) -> [f32; 4], nx: usize, k: usize) -> [f32; 4] {
    let weights = spline::weights(0.0).map(|w| w as f32);
    let (i, j) = (k % nx, k / nx);
    (0..9).map(|tap| (tap % 3, tap / 3)).fold([0.0; 4], |sum, (a, b)| {
        let texel = coefficient((j + b) * (nx + 2) + i + a);
        std::array::from_fn(|h| sum[h] + weights[a] * weights[b] * texel[h])
    })
}

/// Two coefficients in half precision, each in two words.
fn pair(coefficients: [[f32; 4]; 2]) -> [f32; 4] {
    let bits = |x: f32| u32::from(half::f16::from_f32(x).to_bits());
    let [[a, b], [c, d]] = coefficients.map(|t| [f32::from_bits(bits(t[0]) | bits(t[1]) << 16), f32::from_bits(bits(t[2]))]);
    [a, b, c, d]
}

impl Slice {
    /// The slice of `table` (scheme residual) at the camera radius `l`, in r_s; beyond the table's range as [`Cut::new`] says.
    pub fn new(table: &Table, l: f64) -> Slice {
        let cut = Cut::new(table, l);
        let [a, b, c, d] = cut.layers;
        let coefficients = a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| cut.sum([a, b, c, d]));
        Slice::assembled(cut.camera, cut.size, coefficients)
    }

    /// The exact slice at `l`, baked on the spot with the same layout: what the interpolation in L is judged by.
    pub fn bake(nodes: usize, l: f64) -> Slice {
        let [nx, ny, _] = bake::size(nodes);
        let layer = bake::layer(&double::camera(l), nx, ny, &spline::coefficients(nx), &spline::coefficients(ny));
        let coefficients = layer.into_iter().map(|v| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0]);
        Slice::assembled(camera(l), [nx as u32, ny as u32], coefficients)
    }

    /// What the shader's `lens_texel` reads.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// The texels of the method "table-linear": the header, then the residuals at the nodes instead of the coefficients, r fastest.
    pub fn nodes(&self) -> Vec<[f32; 4]> {
        let [nx, ny] = self.size.map(|n| n as usize);
        let node = |k: usize| node(|index| self.texels[HEADER + index], nx, k);
        self.texels[..HEADER].iter().copied().chain((0..nx * ny).map(node)).collect()
    }

    /// The texels of the method "table-half": the header, then the coefficients in half precision, two to a texel, each in two words.
    pub fn halves(&self) -> Vec<[f32; 4]> {
        let pairs = self.texels[HEADER..].chunks(2).map(|two| pair([two[0], two.get(1).copied().unwrap_or_default()]));
        self.texels[..HEADER].iter().copied().chain(pairs).collect()
    }

    /// The texels of a table that is linear in all three dimensions between its nodes, laid out as [`Slice::nodes`]; `half`: between nodes
    /// in half precision.
    pub fn trilinear(table: &Table, l: f64, half: bool) -> Vec<[f32; 4]> {
        let cut = Cut::new(table, l);
        // At a node three layers count.
        let [first, middle, last, _] = spline::weights(0.0).map(|w| w as f32);
        let layer = |weights: [f32; 4]| {
            let cut = Cut { weights, ..cut };
            let coefficients = (0..cut.layers[0].len()).map(|k| cut.coefficient(k));
            let nodes = Slice::assembled(cut.camera, cut.size, coefficients).nodes();
            let stored = |x: f32| if half { half::f16::from_f32(x).to_f32() } else { x };
            let (header, nodes) = nodes.split_at(HEADER);
            (header.to_vec(), nodes.iter().map(|node| node.map(stored)).collect::<Vec<_>>())
        };
        let (mut texels, low) = layer([first, middle, last, 0.0]);
        let (_, high) = layer([0.0, first, middle, last]);
        texels.extend(low.iter().zip(&high).map(|(a, b)| std::array::from_fn(|h| a[h] * (1.0 - cut.between) + b[h] * cut.between)));
        texels
    }

    fn assembled(cam: LensCamera, size: [u32; 2], coefficients: impl Iterator<Item = [f32; 4]>) -> Slice {
        let header = [
            [cam.l, cam.lapse2, cam.a, cam.beta],
            [cam.fade, cam.bend, cam.rate, cam.even],
            [cam.soft, cam.start, cam.scale, cam.share],
            [size[0] as f32, size[1] as f32, cam.reach, cam.lift],
        ];
        Slice { camera: cam, size, texels: header.into_iter().chain(coefficients).collect() }
    }
}
