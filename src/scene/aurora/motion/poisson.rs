//! Poisson's equation −∇²V = f on a square of N × N inner points with V = 0 on its edge, solved exactly: for the five-point Laplacian, or
//! for charges that are Gaussian clouds.
//!
//! The sine modes are the eigenvectors of both, so V = S Λ⁻¹ S f with the sine transform S along both sides: four products of N × N
//! matrices. Every mode is even or odd about the middle, so a row is folded there and each product takes half of the multiplications: at
//! N = 95 no more time than fast transforms of twice 96 points, and the same on every processor. The boundary is a grounded frame: far
//! charges are screened by it, so the square should be at least twice as wide as the charges.

use std::f64::consts::PI;

/// Modes of one parity whose sums are made together; the rows of their table are filled up to a multiple.
const TOGETHER: usize = 16;

/// The solver for one N and spacing.
#[derive(Clone, Debug)]
pub struct Poisson {
    n: usize,
    /// √(2/(N+1)) sin(π (i+1)(j+1)/(N+1)), the transform's own inverse, by place i in the first half: for the modes that are even about the
    /// middle (j = 0, 2, …) and for the odd ones, one after the other.
    sine: [Vec<f64>; 2],
    /// Eigenvalues of the one-dimensional −d²/dx².
    eigenvalues: Vec<f64>,
    /// Factor on each mode of one dimension.
    gains: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Poisson {
    /// For the five-point Laplacian on `n` × `n` inner points with distance `spacing` between them.
    pub fn new(n: usize, spacing: f64) -> Self {
        let angle = PI / (n + 1) as f64;
        let norm = (2.0 / (n + 1) as f64).sqrt();
        let width = n.div_ceil(2).next_multiple_of(TOGETHER);
        let value = |place: usize, mode: usize| norm * (angle * ((place + 1) * (mode + 1)) as f64).sin();
        let sine = [0, 1].map(|parity| {
            let modes =
                |place: usize| (0..width).map(move |k| 2 * k + parity).map(move |mode| if mode < n { value(place, mode) } else { 0.0 });
            (0..n.div_ceil(2)).flat_map(modes).collect()
        });
        let eigenvalues = (0..n).map(|k| (2.0 * (0.5 * angle * (k + 1) as f64).sin() / spacing).powi(2)).collect();
        Poisson { n, sine, eigenvalues, gains: vec![1.0; n], first: vec![0.0; n * n], second: vec![0.0; n * n] }
    }

    /// For point charges that are laid on the grid cloud in cell, as the smooth part of their field: each is replaced by a Gaussian of
    /// standard deviation `sigma`, with the exact eigenvalues k². Laying out charges and bilinear reading of the potential each damp a mode
    /// by sinc²(kh/2) (Hockney and Eastwood, *Computer Simulation Using Particles*, 8-3); this is undone here.
    pub fn of_clouds(n: usize, spacing: f64, sigma: f64) -> Self {
        let waves = (1..=n).map(|k| PI * k as f64 / ((n + 1) as f64 * spacing));
        let gain = |k: f64| {
            let half = 0.5 * k * spacing;
            (-0.5 * (k * sigma).powi(2)).exp() * (half / half.sin()).powi(4)
        };
        let gains = waves.clone().map(gain).collect();
        Poisson { eigenvalues: waves.map(|k| k * k).collect(), gains, ..Poisson::new(n, spacing) }
    }

    /// Points along a side, without the edge.
    pub fn side(&self) -> usize {
        self.n
    }

    /// Replaces the source f (row by row) by the potential V.
    pub fn solve(&mut self, field: &mut [f64]) {
        let n = self.n;
        // (S f)ᵀ twice is S f S: the transpose of the product with the transform along rows.
        transform_transposed(&self.sine, field, &mut self.first, n);
        transform_transposed(&self.sine, &self.first, &mut self.second, n);
        for (k, value) in self.second.iter_mut().enumerate() {
            *value *= self.gains[k / n] * self.gains[k % n] / (self.eigenvalues[k / n] + self.eigenvalues[k % n]);
        }
        transform_transposed(&self.sine, &self.second, &mut self.first, n);
        transform_transposed(&self.sine, &self.first, field, n);
    }
}

/// out = (f S)ᵀ, S symmetric: out[j][i] = Σ_k f[i][k] S[k][j].
fn transform_transposed(sine: &[Vec<f64>; 2], f: &[f64], out: &mut [f64], n: usize) {
    let half = n.div_ceil(2);
    let mut folded = vec![0.0; half];
    for (i, row) in f.chunks_exact(n).enumerate() {
        for (parity, modes) in sine.iter().enumerate() {
            for (k, value) in folded.iter_mut().enumerate() {
                let (near, far) = (row[k], row[n - 1 - k]);
                // In the middle both are one.
                let far = if k == n - 1 - k { 0.0 } else { far };
                *value = if parity == 0 { near + far } else { near - far };
            }
            for first in (0..n.div_ceil(2)).step_by(TOGETHER) {
                let sums = sums(&folded, &modes[first..], modes.len() / half);
                for (k, sum) in sums.into_iter().enumerate() {
                    let mode = 2 * (first + k) + parity;
                    if mode < n {
                        out[mode * n + i] = sum;
                    }
                }
            }
        }
    }
}

/// The sums over all places of the values there times each of [`TOGETHER`] modes; `width` numbers lie between one place's modes and the
/// next's.
fn sums(values: &[f64], modes: &[f64], width: usize) -> [f64; TOGETHER] {
    let mut sums = [0.0; TOGETHER];
    for (value, modes) in values.iter().zip(modes.chunks(width)) {
        for (sum, mode) in sums.iter_mut().zip(&modes[..TOGETHER]) {
            *sum += value * mode;
        }
    }
    sums
}
