//! The exact line integral: emission in space is flux across the field times deposition along it, integrated along each pixel's ray. It
//! knows no electron, no splat and no projection: what the walks are judged by.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::eye::Eye;
use super::sheet::{BOTTOM, FALLS, Falls, FlatAurora, LEVELS, TOP, field_direction, level_height, reach_row};
use super::splat::SplatPicture;
use lensrunner::scene::aurora::dipole::REFERENCE_HEIGHT;
use lensrunner::scene::aurora::{fall, lines};

/// Spacing of the map of the flux, km.
const CELL: f64 = 0.5;
/// Points laid on the map for each curve.
const SEEDS: u32 = 150_000;
/// Spacing of the profile of the light, km.
const LAYER: f64 = 0.25;

/// Emission of an aurora in space.
#[derive(Clone, Debug)]
pub struct Emission {
    low: DVec2,
    columns: usize,
    rows: usize,
    /// Electrons per km² (of the plane z = const), of one electron altogether.
    flux: Vec<f32>,
    /// Photons by line per electron and km of height, from [`BOTTOM`] − margin upwards.
    profile: Vec<[f64; 4]>,
    bottom: f64,
}

impl Emission {
    /// The emission of `sheet` blurred by blobs of standard deviation `radius` km.
    pub fn new(sheet: &FlatAurora, falls: &Falls, radius: f64) -> Emission {
        let seeds: Vec<DVec2> = (0..SEEDS)
            .flat_map(|k| {
                // The plastic number's lattice fills the square evenly (Roberts 2018).
                let (a, b) = (0.754_877_666_246_693 * f64::from(k) % 1.0, 0.569_840_290_998_053 * f64::from(k) % 1.0);
                sheet.curves.iter().map(move |curve| curve.seed(a, b))
            })
            .collect();
        let margin = 5.0 * radius + 2.0;
        let low = seeds.iter().copied().fold(DVec2::INFINITY, DVec2::min) - margin;
        let high = seeds.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max) + margin;
        let (columns, rows) = (((high.x - low.x) / CELL) as usize + 2, ((high.y - low.y) / CELL) as usize + 2);
        let mut flux = vec![0.0f32; columns * rows];
        let weight = (1.0 / seeds.len() as f64 / (CELL * CELL)) as f32;
        for seed in &seeds {
            let p = (*seed - low) / CELL;
            let (i, j) = (p.x as usize, p.y as usize);
            let (s, t) = (p.x.fract() as f32, p.y.fract() as f32);
            for (di, dj, part) in [(0, 0, (1.0 - s) * (1.0 - t)), (1, 0, s * (1.0 - t)), (0, 1, (1.0 - s) * t), (1, 1, s * t)] {
                flux[(j + dj) * columns + i + di] += weight * part;
            }
        }
        // A ball of light cut by the level z = const, carried along the field: round to within the field's 12° from the vertical.
        blur(&mut flux, columns, rows, radius / CELL);
        let bottom = BOTTOM - 5.0 * radius - 2.0;
        Emission { low, columns, rows, flux, profile: profile(sheet, falls, radius, bottom), bottom }
    }

    /// The light per km of a ray at a point, by line.
    fn at(&self, point: DVec3, up: DVec3) -> [f64; 4] {
        let z = (point.z - self.bottom) / LAYER;
        let k = z.floor();
        if k < 0.0 || k as usize + 1 >= self.profile.len() {
            return [0.0; 4];
        }
        let foot = point - up * ((point.z - REFERENCE_HEIGHT) / up.z);
        let p = (foot.truncate() - self.low) / CELL;
        let (i, j) = (p.x.floor(), p.y.floor());
        if i < 0.0 || j < 0.0 || i as usize + 1 >= self.columns || j as usize + 1 >= self.rows {
            return [0.0; 4];
        }
        let (i, j, s, t) = (i as usize, j as usize, p.x - i, p.y - j);
        let flux = |i: usize, j: usize| f64::from(self.flux[j * self.columns + i]);
        let here = (flux(i, j) * (1.0 - s) + flux(i + 1, j) * s) * (1.0 - t) + (flux(i, j + 1) * (1.0 - s) + flux(i + 1, j + 1) * s) * t;
        let (a, b) = (self.profile[k as usize], self.profile[k as usize + 1]);
        let part = z - k;
        std::array::from_fn(|line| here * (a[line] + (b[line] - a[line]) * part))
    }

    /// The picture in flat space, up to a constant factor.
    pub fn picture(&self, eye: &Eye, step: f64) -> SplatPicture {
        let up = field_direction();
        let axes = eye.axes.as_dmat3().transpose();
        let position = eye.position.as_dvec3();
        let [width, height] = eye.size;
        let mut picture = SplatPicture::new(eye.size);
        picture.pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                let direction = axes
                    * DVec3::new(x as f64 + 0.5 - 0.5 * width as f64, 0.5 * height as f64 - y as f64 - 0.5, -f64::from(eye.focal))
                        .normalize();
                // Through the layer that shines, and no farther than 3000 km.
                let to = |z: f64| (z - position.z) / direction.z;
                let (a, b) = (to(self.bottom), to(TOP + 10.0));
                let (near, far) = if a.is_finite() && b.is_finite() { (a.min(b).max(0.0), a.max(b).min(3000.0)) } else { (0.0, 3000.0) };
                // Never through the ground, which hides what is behind it.
                let far = if direction.z < 0.0 { far.min(to(0.0)) } else { far };
                let mut sum = [0.0; 4];
                let count = ((far - near) / step).ceil().max(0.0) as usize;
                for k in 0..count {
                    let light = self.at(position + direction * (near + (k as f64 + 0.5) * step), up);
                    for line in 0..4 {
                        sum[line] += light[line];
                    }
                }
                *pixel = sum.map(|line| (line * step) as f32);
            }
        });
        picture
    }
}

/// Photons by line per electron and km of height, averaged over spectrum and pitch, blurred.
fn profile(sheet: &FlatAurora, falls: &Falls, radius: f64, bottom: f64) -> Vec<[f64; 4]> {
    // The spread of reaches by quasi-random draws: what the walk draws from, by another lattice.
    let mut weights = vec![0.0; FALLS];
    let draws = 20_000u32;
    for k in 0..draws {
        let at = |step: f64| (0.5 + step * f64::from(k + 1)) % 1.0;
        let [u, v, w, mu] = [0.856_674_883_854_502_8, 0.733_891_856_627_126, 0.628_706_721_037_75, 0.538_597_257_252_6].map(at);
        let energy = sheet.spectrum.energy(1.0 - u, 1.0 - v, w);
        let reach = fall::slope(mu) * fall::range(energy);
        let row = reach_row(reach);
        weights[row] += energy / fall::PAIR_ENERGY / f64::from(draws);
    }
    let count = ((TOP + 10.0 - bottom) / LAYER) as usize;
    let mut result = vec![[0.0; 4]; count];
    // Losses per level spread over the level's layer.
    for level in 0..LEVELS {
        let lost_in = |spent: &[f32; LEVELS + 1]| f64::from(spent[level + 1]) - f64::from(spent[level]);
        let lost: f64 = falls.spent.iter().zip(&weights).map(|(spent, weight)| lost_in(spent) * weight).sum();
        let light = lines::photons(level_height(level)).map(|line| line * lost);
        let position = (level_height(level) - bottom) / LAYER;
        let (k, s) = (position as usize, position.fract());
        for line in 0..4 {
            if k + 1 < count {
                result[k][line] += light[line] * (1.0 - s) / LAYER;
                result[k + 1][line] += light[line] * s / LAYER;
            }
        }
    }
    let kernel = kernel(radius / LAYER);
    (0..count).map(|z| std::array::from_fn(|line| blurred(&kernel, count, z, |k| result[k][line]))).collect()
}

/// A Gaussian in steps of one, as far as four standard deviations to either side, with a sum of 1.
fn kernel(sigma: f64) -> Vec<f64> {
    let reach = (4.0 * sigma).ceil() as i64;
    let kernel: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma.max(1e-6)).powi(2)).exp()).collect();
    let norm: f64 = kernel.iter().sum();
    kernel.into_iter().map(|part| part / norm).collect()
}

/// The `count` values of a line, blurred, at the place `at`.
fn blurred(kernel: &[f64], count: usize, at: usize, value: impl Fn(usize) -> f64) -> f64 {
    let first = at as i64 - kernel.len() as i64 / 2;
    let inside = |(k, part): (i64, &f64)| (0..count as i64).contains(&k).then(|| value(k as usize) * part);
    (first..).zip(kernel).filter_map(inside).sum()
}

/// A Gaussian blur of the map, along rows and then along columns.
fn blur(map: &mut [f32], columns: usize, rows: usize, sigma: f64) {
    let kernel = kernel(sigma);
    let source = map.to_vec();
    map.par_iter_mut().enumerate().for_each(|(k, value)| {
        let (row, column) = (k / columns, k % columns);
        *value = blurred(&kernel, columns, column, |x| f64::from(source[row * columns + x])) as f32;
    });
    let source = map.to_vec();
    map.par_iter_mut().enumerate().for_each(|(k, value)| {
        let (row, column) = (k / columns, k % columns);
        *value = blurred(&kernel, rows, row, |y| f64::from(source[y * columns + column])) as f32;
    });
}
