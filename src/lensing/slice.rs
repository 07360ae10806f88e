//! The slice of the residual table at one camera radius: what a frame sends to the GPU.

use super::double;
use super::single::{Camera, camera};
use super::table::{Scheme, Table};
use super::{grid, spline};

/// The constants of a camera radius and the coefficients of its slice.
#[derive(Clone, Debug)]
pub struct Slice {
    /// The constants that the lookup needs besides the table.
    pub camera: Camera,
    /// Nodes along r and Φ; there are two more coefficients than nodes each way.
    pub size: [u32; 2],
    /// Coefficients, r fastest: the turns of w and w_e in radians in 0 and 2, the residual of the delay in r_s/c in 1, 3 unused.
    pub texels: Vec<[f32; 4]>,
}

impl Slice {
    /// The slice of `table` (scheme residual) at the camera radius `l`, in r_s, clamped to the table's range.
    pub fn at(table: &Table, l: f64) -> Slice {
        debug_assert_eq!(table.scheme, Scheme::Residual);
        let [nx, ny, nz] = table.size.map(|n| n as usize);
        let l = if l.is_finite() { l.clamp(grid::CAMERA_RANGE[0], grid::CAMERA_RANGE[1]) } else { grid::CAMERA_RANGE[1] };
        let (layer, t) = spline::cell(grid::camera_axis(l), nz);
        let weights = spline::weights(t).map(|w| w as f32);
        let size = (nx + 2) * (ny + 2) * 3;
        let layers = [0, 1, 2, 3].map(|k| &table.values[(layer + k) * size..(layer + k + 1) * size]);
        let texels = (0..size / 3)
            .map(|i| {
                let sum = |h: usize| (0..4).map(|k| weights[k] * layers[k][3 * i + h]).sum::<f32>();
                [sum(0), sum(1), sum(2), 0.0]
            })
            .collect();
        Slice { camera: camera(l), size: [nx as u32, ny as u32], texels }
    }

    /// The exact slice at `l`, baked on the spot: what the interpolation in L is judged by.
    pub fn bake(nodes: usize, l: f64) -> Slice {
        let cam = double::camera(l);
        let (nx, ny) = (nodes, 2 * nodes);
        let layer = super::bake::layer(&cam, nx, ny, &spline::coefficients(nx), &spline::coefficients(ny));
        let texels = layer.into_iter().map(|v| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0]).collect();
        Slice { camera: camera(l), size: [nx as u32, ny as u32], texels }
    }
}
