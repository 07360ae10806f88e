//! What a table after Yamashita 2012 holds, and of which range.

/// ε of table 1 of Yamashita 2012: r starts at 1 + ε, L at 1 + 2ε (r_s).
const EPSILON: f64 = 0.005;

/// r_max of table 1 of Yamashita 2012, in r_s; L ends at half of it.
const LARGEST_R: f64 = 1e4;

/// The ranges of L, r and φ.
pub const RANGES: [f64; 6] = [1.0 + 2.0 * EPSILON, LARGEST_R / 2.0, 1.0 + EPSILON, LARGEST_R, 0.0, std::f64::consts::PI];

/// Values at a node: ψ and the delay, for each of the four tables.
pub const CHANNELS: usize = 8;
