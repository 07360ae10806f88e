//! Poisson's equation −∇²V = f on a square of N × N inner points with V = 0 on its edge, solved exactly: for the five-point Laplacian, or
//! for charges that are Gaussian clouds.
//!
//! The sine modes are the eigenvectors of both, so V = S Λ⁻¹ S f with the sine transform S along both sides: four products of N × N
//! matrices. The boundary is a grounded frame: far charges are screened by it, so the square should be at least twice as wide as the
//! charges.

use std::f64::consts::PI;

/// The solver for one N and spacing.
#[derive(Clone, Debug)]
pub struct Poisson {
    n: usize,
    /// √(2/(N+1)) sin(π (i+1)(j+1)/(N+1)), row by row: its own inverse.
    sine: Vec<f64>,
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
        let sine = (0..n * n).map(|k| norm * (angle * ((k / n + 1) * (k % n + 1)) as f64).sin()).collect();
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
        product_transposed(&self.sine, field, &mut self.first, n);
        product_transposed(&self.sine, &self.first, &mut self.second, n);
        for (k, value) in self.second.iter_mut().enumerate() {
            *value *= self.gains[k / n] * self.gains[k % n] / (self.eigenvalues[k / n] + self.eigenvalues[k % n]);
        }
        product_transposed(&self.sine, &self.second, &mut self.first, n);
        product_transposed(&self.sine, &self.first, field, n);
    }
}

/// out = (f S)ᵀ, S symmetric: out[j][i] = Σ_k f[i][k] S[j][k], rows with rows.
fn product_transposed(sine: &[f64], f: &[f64], out: &mut [f64], n: usize) {
    for (i, row) in f.chunks_exact(n).enumerate() {
        for (j, mode) in sine.chunks_exact(n).enumerate() {
            // Four sums at once, since additions of one sum wait for each other.
            let mut sums = [0.0; 4];
            let (a, b) = (row.chunks_exact(4), mode.chunks_exact(4));
            let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(x, y)| x * y).sum();
            for (x, y) in a.zip(b) {
                for k in 0..4 {
                    sums[k] += x[k] * y[k];
                }
            }
            out[j * n + i] = sums[0] + sums[1] + sums[2] + sums[3] + rest;
        }
    }
}
