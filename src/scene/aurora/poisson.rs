//! Poisson's equation −∇²V = f on a square of N × N inner points with V = 0 on its edge, solved exactly for the five-point Laplacian.
//!
//! The sine modes are its eigenvectors, so V = S Λ⁻¹ S f with the sine transform S along both sides: four products of N × N matrices, about
//! N³/125 µs. The boundary is a grounded frame: far charges are screened by it, so the square should be at least twice as wide as the charges.

/// The solver for one N and spacing.
#[derive(Clone, Debug)]
pub struct Poisson {
    n: usize,
    /// √(2/(N+1)) sin(π (i+1)(j+1)/(N+1)), row by row: its own inverse.
    sine: Vec<f64>,
    /// Eigenvalues of the one-dimensional −d²/dx².
    eigenvalues: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Poisson {
    /// For `n` × `n` inner points with distance `spacing` between them.
    pub fn new(n: usize, spacing: f64) -> Self {
        let angle = std::f64::consts::PI / (n + 1) as f64;
        let norm = (2.0 / (n + 1) as f64).sqrt();
        let sine = (0..n * n).map(|k| norm * (angle * ((k / n + 1) * (k % n + 1)) as f64).sin()).collect();
        let eigenvalues = (0..n).map(|k| (2.0 * (0.5 * angle * (k + 1) as f64).sin() / spacing).powi(2)).collect();
        Poisson { n, sine, eigenvalues, first: vec![0.0; n * n], second: vec![0.0; n * n] }
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
            *value /= self.eigenvalues[k / n] + self.eigenvalues[k % n];
        }
        product_transposed(&self.sine, &self.second, &mut self.first, n);
        product_transposed(&self.sine, &self.first, field, n);
    }
}

/// out = (f S)ᵀ, S symmetric: out[j][i] = Σ_k f[i][k] S[j][k], rows with rows.
fn product_transposed(sine: &[f64], f: &[f64], out: &mut [f64], n: usize) {
    for (i, row) in f.chunks_exact(n).enumerate() {
        for (j, mode) in sine.chunks_exact(n).enumerate() {
            // Four sums at once: one would wait for itself.
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
