//! The slice of the residual table at one camera radius: what a frame sends to the GPU.

use super::double;
use super::single::{Camera, camera};
use super::table::{Scheme, Table};
use super::{bake, grid, spline};

/// Texels before the coefficients.
pub const HEADER: usize = 4;

/// The constants of a camera radius and the coefficients of its slice.
#[derive(Clone, Debug)]
pub struct Slice {
    /// The constants that the lookup needs besides the table.
    pub camera: Camera,
    /// Nodes along r and Φ; there are two more coefficients than nodes each way.
    pub size: [u32; 2],
    /// The storage buffer of the shader: four texels with the constants of `camera` and the size, then the coefficients, r fastest:
    /// the tangents of half the turns of w and w_e in 0 and 2, the residual of the delay in r_s/c in 1, 3 unused.
    pub(super) texels: Vec<[f32; 4]>,
}

impl Slice {
    /// The slice of `table` (scheme residual) at the camera radius `l`, in r_s, clamped to the table's range.
    pub fn new(table: &Table, l: f64) -> Slice {
        debug_assert_eq!(table.scheme, Scheme::Residual);
        let [nx, ny, nz] = table.size.map(|n| n as usize);
        let l = if l.is_finite() { l.clamp(grid::CAMERA_RANGE[0], grid::CAMERA_RANGE[1]) } else { grid::CAMERA_RANGE[1] };
        let (layer, t) = spline::cell(grid::camera_axis(l), nz);
        let weights = spline::weights(t).map(|w| w as f32);
        let size = (nx + 2) * (ny + 2) * 3;
        let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|k| table.values[(layer + k) * size..(layer + k + 1) * size].as_chunks::<3>().0);
        let coefficients = s0.iter().zip(s1).zip(s2).zip(s3).map(|(((a, b), c), d)| {
            let sum = |h: usize| weights[0] * a[h] + weights[1] * b[h] + weights[2] * c[h] + weights[3] * d[h];
            [sum(0), sum(1), sum(2), 0.0]
        });
        Slice::assembled(camera(l), [nx as u32, ny as u32], coefficients)
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
        let weights = spline::weights(0.0).map(|w| w as f32);
        let node = |k: usize| {
            let (i, j) = (k % nx, k / nx);
            // At a node three coefficients along each axis count.
            let taps = (0..9).map(|tap| (tap % 3, tap / 3));
            taps.fold([0.0; 4], |sum, (a, b)| {
                let texel = self.texels[HEADER + (j + b) * (nx + 2) + i + a];
                std::array::from_fn(|h| sum[h] + weights[a] * weights[b] * texel[h])
            })
        };
        self.texels[..HEADER].iter().copied().chain((0..nx * ny).map(node)).collect()
    }

    /// The texels of the method "table-half": the header, then the coefficients in half precision, two to a texel, each in two words.
    pub fn halves(&self) -> Vec<[f32; 4]> {
        let bits = |x: f32| u32::from(half::f16::from_f32(x).to_bits());
        let packed = |t: &[f32; 4]| [f32::from_bits(bits(t[0]) | bits(t[1]) << 16), f32::from_bits(bits(t[2]))];
        let pairs = self.texels[HEADER..].chunks(2).map(|pair| {
            let (first, second) = (packed(&pair[0]), pair.get(1).map_or([0.0; 2], packed));
            [first[0], first[1], second[0], second[1]]
        });
        self.texels[..HEADER].iter().copied().chain(pairs).collect()
    }

    fn assembled(cam: Camera, size: [u32; 2], coefficients: impl Iterator<Item = [f32; 4]>) -> Slice {
        let header = [
            [cam.l, cam.room, cam.a, cam.beta],
            [cam.fade, cam.bend, cam.rate, cam.force],
            [cam.soft, cam.start, cam.scale, cam.share],
            [size[0] as f32, size[1] as f32, cam.reach, cam.lift],
        ];
        Slice { camera: cam, size, texels: header.into_iter().chain(coefficients).collect() }
    }
}
