//! The adversarial points: where projections break.

use std::f64::consts::PI;

use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};

use super::methods::ProjectionInput;
use crate::spacetime::light::Branch;

/// Camera radii, r_s.
pub const CAMERAS: [f64; 2] = [0.05, 5000.0];
/// Where a third of them lies: around the horizon and the photon sphere.
const NEAR: [f64; 2] = [0.95, 1.6];
/// Radii of points, r_s; a camera inside also looks at points inside.
pub const POINTS: [f64; 2] = [1.0005, 1e4];
/// The least distance in the slice, in camera radii.
const LEAST_DISTANCE: f64 = 1e-4;

/// Points of one camera: a graphics adapter needs a slice for each camera, so they come in groups of one camera.
const EACH: usize = 100;

/// A point, a camera and the sign of the photon's energy, which matters only where both are inside.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// r, φ, L.
    pub input: ProjectionInput,
    /// The sign.
    pub branch: Branch,
}

/// `count` rows from `seed`: L log-uniform, a third of them in 0.95 … 1.6; r half log-uniform, half log-clustered around L down to 1e-4
/// of it; φ half uniform, half clustered at 0 and π down to 1e-5 π; nothing left out but slice distances below 1e-4 L. Among the points
/// around a camera inside are some that no light joins to it. Rows of one camera follow each other, `EACH` at a time.
pub fn rows(count: usize, seed: u64) -> Vec<Row> {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut rows = Vec::with_capacity(count + EACH);
    while rows.len() < count {
        let camera = camera(&mut rng);
        rows.extend((0..EACH).map(|_| row_of(&mut rng, camera)));
    }
    rows.truncate(count);
    rows
}

/// The rows of each camera.
pub fn by_camera(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| a.input.camera == b.input.camera)
}

/// A row of a camera of its own.
pub fn row(rng: &mut SmallRng) -> Row {
    let camera = camera(rng);
    row_of(rng, camera)
}

/// A camera's radius.
fn camera(rng: &mut SmallRng) -> f64 {
    if rng.random_bool(1.0 / 3.0) { between(rng, NEAR) } else { between(rng, CAMERAS) }
}

/// A row of that camera.
fn row_of(rng: &mut SmallRng, camera: f64) -> Row {
    let branch = if rng.random_bool(0.5) { Branch::Plus } else { Branch::Minus };
    loop {
        let clustered = rng.random_bool(0.5);
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let r = if clustered { camera * (1.0 + side * between(rng, [1e-4, 1.0])) } else { between(rng, POINTS) };
        let phi = match (rng.random_bool(0.5), rng.random_bool(0.5)) {
            (true, true) => PI * between(rng, [1e-5, 1.0]),
            (true, false) => PI - PI * between(rng, [1e-5, 1.0]),
            (false, _) => PI * rng.random::<f64>(),
        };
        let half = (0.5 * phi).sin();
        let distance = (r - camera).hypot(2.0 * half * (r * camera).sqrt());
        let inside = camera < 1.0 && r < 1.0 && r > 1e-3;
        if (inside || (POINTS[0]..=POINTS[1]).contains(&r)) && phi > 0.0 && distance >= LEAST_DISTANCE * camera {
            let branch = if inside { branch } else { Branch::Plus };
            return Row { input: ProjectionInput { r, phi, camera }, branch };
        }
    }
}

/// A number between two, evenly spread by its logarithm.
pub fn between(rng: &mut SmallRng, [low, high]: [f64; 2]) -> f64 {
    (low.ln() + rng.random::<f64>() * (high / low).ln()).exp()
}
