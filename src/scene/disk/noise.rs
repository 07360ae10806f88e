//! The pattern of the gas: streaks along the orbits, periodic both ways, as a lattice with smooth interpolation.
//!
//! The GPU has the lattice as a texture, so both evaluate the same function. It does not depend on the scene.

use std::sync::LazyLock;

/// Columns of the lattice, round the hole.
pub const WIDTH: usize = 1024;
/// Rows of the lattice, over ln r.
pub const HEIGHT: usize = 512;

/// Octaves: cells round the hole, cells over the height, amplitude. Cells are about ten times as long as wide; those of rings are longer
/// still. Chosen by hand, for the look of streaks; only ratios of amplitudes count, as each row is scaled to deviation 1.
const OCTAVES: [(usize, usize, f64); 8] =
    [(3, 16, 0.75), (4, 48, 0.70), (7, 28, 0.70), (14, 56, 0.55), (10, 128, 0.50), (28, 112, 0.40), (56, 224, 0.28), (112, 256, 0.16)];

/// Values are cut off at so many deviations.
const CUT: f64 = 3.0;

/// The lattice, row by row; each row has mean 0 and deviation 1.
pub static LATTICE: LazyLock<Vec<f32>> = LazyLock::new(lattice);

/// The pattern at x turns and y heights: the lattice, interpolated by weights 3t² − 2t³, so that no crease is visible from near.
pub fn streaks(x: f64, y: f64) -> f64 {
    let (i, u) = cell(x, WIDTH);
    let (j, v) = cell(y, HEIGHT);
    let at = |i: usize, j: usize| f64::from(LATTICE[(j % HEIGHT) * WIDTH + i % WIDTH]);
    let row = |j| at(i, j) + u * (at(i + 1, j) - at(i, j));
    row(j) + v * (row(j + 1) - row(j))
}

/// The lattice point before a coordinate in periods, and the smooth weight of the next.
fn cell(x: f64, count: usize) -> (usize, f64) {
    // Texels lie at the middle of their cells.
    let position = (x - x.floor()) * count as f64 - 0.5 + count as f64;
    let whole = position.floor();
    (whole as usize % count, smooth(position - whole))
}

fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// A well-mixed number of two (Steele, Lea & Flood 2014, SplitMix64).
pub fn hash(a: u64, b: u64) -> u64 {
    let mut z =
        a.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(b.wrapping_mul(0xd1b5_4a32_d192_ed03)).wrapping_add(0x632b_e59b_d9b4_e019);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn lattice() -> Vec<f32> {
    let mut sum = vec![0.0f64; WIDTH * HEIGHT];
    for (number, &(columns, rows, amplitude)) in OCTAVES.iter().enumerate() {
        let knots: Vec<f64> =
            (0..columns * rows).map(|k| (hash(k as u64, 1 + number as u64) >> 11) as f64 / (1u64 << 52) as f64 - 1.0).collect();
        // Every second row of cells is shifted, so that cells do not line up along radii.
        let shift = |j: usize| (hash(j as u64, 101 + number as u64) >> 40) as f64 / (1u64 << 24) as f64;
        // The octave along each row of its cells.
        let mut lines = vec![0.0; WIDTH * rows];
        for (j, line) in lines.chunks_exact_mut(WIDTH).enumerate() {
            for (x, value) in line.iter_mut().enumerate() {
                let turn = (x as f64 + 0.5) / WIDTH as f64;
                let position = turn * columns as f64 + shift(j) * columns as f64;
                let whole = position.floor();
                let t = smooth(position - whole);
                let i = whole as usize % columns;
                let (a, b) = (knots[j * columns + i], knots[j * columns + (i + 1) % columns]);
                *value = a + t * (b - a);
            }
        }
        for (y, sums) in sum.chunks_exact_mut(WIDTH).enumerate() {
            let position = (y as f64 + 0.5) / HEIGHT as f64 * rows as f64;
            let j = position as usize % rows;
            let t = smooth(position.fract());
            let line = |j: usize| &lines[j * WIDTH..][..WIDTH];
            for ((sum, a), b) in sums.iter_mut().zip(line(j)).zip(line((j + 1) % rows)) {
                *sum += amplitude * (a + t * (b - a));
            }
        }
    }
    // Each row is normalised by itself: a ring brighter than its neighbours all round would make the whole disk brighter until its
    // generation dies.
    for row in sum.chunks_mut(WIDTH) {
        let mean = row.iter().sum::<f64>() / WIDTH as f64;
        let deviation = (row.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / WIDTH as f64).sqrt();
        row.iter_mut().for_each(|v| *v = (*v - mean) / deviation);
    }
    sum.iter().map(|v| v.clamp(-CUT, CUT) as f32).collect()
}
