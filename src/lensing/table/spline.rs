//! Cubic B-splines on uniform nodes, with not-a-knot ends.
//!
//! A B-spline whose coefficients are solved for beforehand passes through its samples, is twice differentiable, and has a sixth
//! of the error of four-point Lagrange interpolation (de Boor, A Practical Guide to Splines, ch. IX and XII).

/// The matrix, (n + 2) × n by rows, that turns `n` samples into the n + 2 coefficients of the spline. `n` is at least 5.
pub fn coefficients(n: usize) -> Vec<f64> {
    let m = n + 2;
    // Columns 0..m of each row: the collocation matrix; the rest: its right-hand side.
    let width = m + n;
    let mut rows = vec![vec![0.0f64; width]; m];
    for i in 0..n {
        rows[i + 1][i] = 1.0 / 6.0;
        rows[i + 1][i + 1] = 4.0 / 6.0;
        rows[i + 1][i + 2] = 1.0 / 6.0;
        rows[i + 1][m + i] = 1.0;
    }
    for (j, fourth_difference) in [1.0, -4.0, 6.0, -4.0, 1.0].into_iter().enumerate() {
        rows[0][j] = fourth_difference;
        rows[m - 1][m - 5 + j] = fourth_difference;
    }
    for column in 0..m {
        let pivot = (column..m).max_by(|&x, &y| rows[x][column].abs().total_cmp(&rows[y][column].abs())).unwrap_or(column);
        rows.swap(column, pivot);
        let scale = 1.0 / rows[column][column];
        rows[column].iter_mut().for_each(|v| *v *= scale);
        let lead = rows[column].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[column];
            if i != column && factor != 0.0 {
                row.iter_mut().zip(&lead).for_each(|(v, l)| *v -= factor * l);
            }
        }
    }
    rows.iter().flat_map(|row| row[m..].iter().copied()).collect()
}

/// The weights of the four coefficients that reach the position `t` in 0..=1 between two nodes.
pub fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0]
}

/// The cell that holds the position `x` in 0..=1 among `n` nodes, and the position within it; clamped at the ends.
pub fn cell(x: f64, n: usize) -> (usize, f64) {
    let x = x.clamp(0.0, 1.0) * (n - 1) as f64;
    let i = (x as usize).min(n - 2);
    (i, x - i as f64)
}
