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

impl Slice {
    /// The slice of `table` (scheme residual) at the camera radius `l`, in r_s.
    ///
    /// A frame must be drawn wherever its camera is, so there is no error here: a radius beyond the table's range is moved to its nearer
    /// end ([`grid::CAMERA_RANGE`]), and what is not finite counts as the far end. `camera.l` tells the radius used. Who must not have that
    /// asks first whether the range holds the radius, as the methods of `project` do, which answer nothing beyond.
    pub fn new(table: &Table, l: f64) -> Slice {
        let mut slice = Slice { camera: camera(grid::CAMERA_RANGE[1]), size: [0; 2], texels: Vec::new() };
        slice.move_to(table, l);
        slice
    }

    /// Becomes [`Slice::new`] of this table and radius, in the memory that it has.
    pub fn move_to(&mut self, table: &Table, l: f64) {
        debug_assert_eq!(table.scheme, Scheme::Residual);
        let [nx, ny, nz] = table.size.map(|n| n as usize);
        let l = if l.is_finite() { l.clamp(grid::CAMERA_RANGE[0], grid::CAMERA_RANGE[1]) } else { grid::CAMERA_RANGE[1] };
        let (layer, t) = spline::cell(grid::camera_axis(l), nz);
        let size = (nx + 2) * (ny + 2) * 3;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| table.values[(layer + k) * size..(layer + k + 1) * size].as_chunks::<3>().0);
        let [wa, wb, wc, wd] = spline::weights(t).map(|w| w as f32);
        let coefficients = a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| {
            let sum = |h: usize| wa * a[h] + wb * b[h] + wc * c[h] + wd * d[h];
            [sum(0), sum(1), sum(2), 0.0]
        });
        self.assemble(camera(l), [nx as u32, ny as u32], coefficients);
    }

    /// The exact slice at `l`, baked on the spot with the same layout: what the interpolation in L is judged by.
    pub fn bake(nodes: usize, l: f64) -> Slice {
        let [nx, ny, _] = bake::size(nodes);
        let layer = bake::layer(&double::camera(l), nx, ny, &spline::coefficients(nx), &spline::coefficients(ny));
        let coefficients = layer.into_iter().map(|v| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0]);
        let mut slice = Slice { camera: camera(l), size: [0; 2], texels: Vec::new() };
        slice.assemble(camera(l), [nx as u32, ny as u32], coefficients);
        slice
    }

    /// What the shader's `lens_texel` reads.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    fn assemble(&mut self, cam: LensCamera, size: [u32; 2], coefficients: impl Iterator<Item = [f32; 4]>) {
        let header = [
            [cam.l, cam.lapse2, cam.a, cam.beta],
            [cam.fade, cam.bend, cam.rate, cam.even],
            [cam.soft, cam.start, cam.scale, cam.share],
            [size[0] as f32, size[1] as f32, cam.reach, cam.lift],
        ];
        (self.camera, self.size) = (cam, size);
        self.texels.clear();
        self.texels.extend(header.into_iter().chain(coefficients));
    }
}
