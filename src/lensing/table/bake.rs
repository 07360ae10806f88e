//! Baking: the exact ray at every node, less its closed form, as B-spline coefficients.

use rayon::prelude::*;

use super::{Scheme, Table};
use super::{grid, spline};
use crate::lensing::closed_form::elementary::double::stumpff;
use crate::lensing::double::{
    LensCamera, bent_sweep, delay_across, delay_along, delay_factor, emission_scale, lens_equation, light_cones, slope_guess,
};
use crate::spacetime::light::{Branch, Ray, delay, join_near};

/// The smallest angle swept at which the bake asks for a ray, in radians; the limit at 0 is reached long before.
const SMALLEST_BAKED_SWEEP: f64 = 1e-4;

/// The residuals at one point: the tangent of half the turn of the camera's slope, that of the delay, the same of the point's slope.
/// None where no ray joins the two.
pub fn residual(cam: &LensCamera, c: f64, sweep: f64) -> Option<[f64; 3]> {
    let bent = bent_sweep(sweep);
    let (w0, w_e0) = slope_guess(cam, c - cam.a, bent);
    let ray = join_near(c, sweep, cam.a, Branch::Plus, Some(w0))?;
    let time = delay(&ray, c, sweep, cam.a);
    let Ray { slope: w, emission_slope: w_e, energy: e } = ray;
    let (r, lapse2, dr) = (1.0 / c, 1.0 - c, 1.0 / c - cam.l);
    let lens = lens_equation(cam, c, bent, stumpff(0.25 * bent * bent));
    let cones = light_cones((w, w_e), e, (cam.a, c), (cam.beta, c.sqrt()), (cam.lapse2, lapse2));
    let rest = time - delay_along(cam, r, c, dr, cones);
    let across = delay_across(cam, r, c, lapse2, dr, lens, ((r * cam.a).ln(), (0.5 * lens[1]).ln()));
    let turn = |u: f64, from: f64, to: f64| (0.5 * (u.atan2(-to) - u.atan2(-from))).tan();
    Some([turn(cam.a, w0, w), rest / delay_factor(cam, c, lens[0], e) - across, turn(emission_scale(cam, c), w_e0, w_e)])
}

/// Nodes along r and Φ for each 100 along L. By hand.
const SHARES: [usize; 2] = [62, 106];

/// How many nodes along r, Φ and L a table of `nodes` has.
pub fn size(nodes: usize) -> [usize; 3] {
    [(nodes * SHARES[0] / 100).max(5), (nodes * SHARES[1] / 100).max(5), nodes]
}

/// The table of `nodes` camera radii. `done` is called with each share of the work
/// that is finished; the shares add up to 1.
pub fn residual_table(nodes: usize, done: impl Fn(f64) + Sync) -> Table {
    let [nx, ny, nz] = size(nodes);
    let (mx, my, mz) = (spline::coefficients(nx), spline::coefficients(ny), spline::coefficients(nz));
    let layers: Vec<Vec<[f64; 3]>> = (0..nz)
        .into_par_iter()
        .map(|iz| {
            let coefficients = layer(&grid::camera_at(iz as f64 / (nz - 1) as f64), nx, ny, &mx, &my);
            done(1.0 / nz as f64);
            coefficients
        })
        .collect();
    let size = (nx + 2) * (ny + 2);
    let values = (0..nz + 2)
        .into_par_iter()
        .flat_map_iter(|k| {
            let row = &mz[k * nz..(k + 1) * nz];
            let mut sum = vec![[0.0; 3]; size];
            for (weight, layer) in row.iter().zip(&layers) {
                add_scaled(&mut sum, *weight, layer);
            }
            sum.into_iter().flatten().map(|v| v as f32).collect::<Vec<f32>>()
        })
        .collect();
    Table { scheme: Scheme::Residual, size: [nx as u32, ny as u32, nz as u32], values }
}

/// The coefficients, (nx + 2) × (ny + 2), of the residuals seen by one camera.
pub(super) fn layer(cam: &LensCamera, nx: usize, ny: usize, mx: &[f64], my: &[f64]) -> Vec<[f64; 3]> {
    let mut samples = vec![[0.0; 3]; nx * ny];
    for ix in 0..nx {
        let c = grid::point(cam, ix as f64 / (nx - 1) as f64);
        for iy in 0..ny {
            let sweep = grid::sweep(cam, c, iy as f64 / (ny - 1) as f64).max(SMALLEST_BAKED_SWEEP);
            // Every point outside is seen in every order: a missing ray would be a fault of the solver, and its neighbour serves.
            samples[iy * nx + ix] = residual(cam, c, sweep).unwrap_or_else(|| if iy > 0 { samples[(iy - 1) * nx + ix] } else { [0.0; 3] });
        }
    }
    let wide = nx + 2;
    let mut rows = vec![[0.0; 3]; wide * ny];
    for iy in 0..ny {
        for i in 0..wide {
            for (weight, v) in mx[i * nx..(i + 1) * nx].iter().zip(&samples[iy * nx..(iy + 1) * nx]) {
                (0..3).for_each(|h| rows[iy * wide + i][h] += weight * v[h]);
            }
        }
    }
    let mut coefficients = vec![[0.0; 3]; wide * (ny + 2)];
    for j in 0..ny + 2 {
        for iy in 0..ny {
            let weight = my[j * ny + iy];
            add_scaled(&mut coefficients[j * wide..(j + 1) * wide], weight, &rows[iy * wide..(iy + 1) * wide]);
        }
    }
    coefficients
}

/// sum += weight · values.
fn add_scaled(sum: &mut [[f64; 3]], weight: f64, values: &[[f64; 3]]) {
    for (s, v) in sum.iter_mut().zip(values) {
        (0..3).for_each(|h| s[h] += weight * v[h]);
    }
}
