//! Tables 2 and 3 of Yamashita 2012: its own meshes, its own rule for points, errors of ψ in the static frame.
//!
//! The paper says: about 300,000 "various" (r, φ, L), none nearer to the camera than 0.01 √L, and gives the largest error and the standard
//! deviation for the inside and outside tables of each order. It does not say how the points are distributed, so three ways are tried.

use std::f64::consts::PI;

use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use super::ProjectionRequest;
use super::methods;
use crate::chart::Sheet;
use lensrunner::lensing::Scheme;
use lensrunner::lensing::methods::{Exact, ProjectionInput, Projector};
use lensrunner::lensing::paper::{camera_mesh, slice_meshes};
use lensrunner::lensing::paper_format::RANGES;
use lensrunner::spacetime::light::{Branch, Order};

/// How r, φ, L may have been drawn.
const SAMPLINGS: [&str; 3] = ["uniform", "logarithmic", "as the nodes"];

/// What the paper prints: scheme, nodes, order, inside, (largest, standard deviation) in degrees.
const PRINTED: [(Scheme, usize, u8, bool, [f64; 2]); 24] = [
    (Scheme::PaperUniform, 16, 1, true, [96.576, 36.610]),
    (Scheme::PaperUniform, 16, 1, false, [89.312, 32.641]),
    (Scheme::PaperUniform, 32, 1, true, [91.263, 32.721]),
    (Scheme::PaperUniform, 32, 1, false, [88.623, 30.121]),
    (Scheme::PaperUniform, 64, 1, true, [84.526, 28.804]),
    (Scheme::PaperUniform, 64, 1, false, [87.246, 27.279]),
    (Scheme::PaperUniform, 128, 1, true, [81.782, 14.230]),
    (Scheme::PaperUniform, 128, 1, false, [85.617, 24.178]),
    (Scheme::Paper, 16, 1, true, [2.881, 0.520]),
    (Scheme::Paper, 16, 1, false, [7.949, 1.485]),
    (Scheme::Paper, 16, 2, true, [1.688, 0.306]),
    (Scheme::Paper, 16, 2, false, [5.941, 1.878]),
    (Scheme::Paper, 32, 1, true, [0.837, 0.145]),
    (Scheme::Paper, 32, 1, false, [1.226, 0.214]),
    (Scheme::Paper, 32, 2, true, [0.940, 0.210]),
    (Scheme::Paper, 32, 2, false, [1.679, 0.227]),
    (Scheme::Paper, 64, 1, true, [0.392, 0.034]),
    (Scheme::Paper, 64, 1, false, [0.751, 0.065]),
    (Scheme::Paper, 64, 2, true, [0.470, 0.023]),
    (Scheme::Paper, 64, 2, false, [0.874, 0.071]),
    (Scheme::Paper, 128, 1, true, [0.201, 0.009]),
    (Scheme::Paper, 128, 1, false, [0.401, 0.019]),
    (Scheme::Paper, 128, 2, true, [0.229, 0.009]),
    (Scheme::Paper, 128, 2, false, [0.432, 0.020]),
];

/// Every row of both tables with the printed values and ours.
pub fn measure(request: &ProjectionRequest) -> Sheet {
    let mut sheet = Sheet::measured(
        &[
            "mesh", "nodes", "order", "half", "printed_max", "printed_deviation", "points", "max", "p999", "deviation", "worst_r",
            "worst_phi", "worst_L",
        ],
        "",
    );
    for (scheme, nodes, order, inside, printed) in PRINTED {
        let (name, mesh) =
            if scheme == Scheme::Paper { (format!("paper1-{nodes}"), "optimised") } else { (format!("paper1-uniform-{nodes}"), "uniform") };
        eprintln!("table {} of Yamashita 2012: {name}, order {order}", if scheme == Scheme::Paper { 3 } else { 2 });
        let (Some(method), Some(order)) = (methods::named(&name), Order::new(order)) else { continue };
        for (sampling, sampling_name) in SAMPLINGS.iter().enumerate() {
            let spread = errors(method.as_ref(), scheme, request, order, inside, sampling);
            let half = if inside { "inside" } else { "outside" };
            let mut cells = vec![mesh.to_owned(), nodes.to_string(), order.number().to_string(), half.to_owned()];
            cells.extend(printed.map(|v| v.to_string()));
            cells.push((*sampling_name).to_owned());
            cells.extend([spread.max, spread.most, spread.rms].map(|v| format!("{v:.4}")));
            cells.extend(spread.worst.map(|v| format!("{v:.5}")));
            sheet.push(cells);
        }
    }
    sheet
}

/// The errors of ψ in degrees. The standard deviation of errors whose mean is far smaller is their rms.
fn errors(
    method: &dyn Projector,
    scheme: Scheme,
    request: &ProjectionRequest,
    order: Order,
    inside: bool,
    sampling: usize,
) -> super::score::Spread {
    let drawn: Vec<(f64, [f64; 3])> = (0..request.points)
        .into_par_iter()
        .filter_map(|i| {
            let mut rng = SmallRng::seed_from_u64(request.seed ^ (i as u64) << 20 ^ (sampling as u64) << 8 ^ u64::from(inside));
            let input = draw(&mut rng, scheme, inside, sampling);
            let truth = Exact.project(input, order, Branch::Plus)?.psi_static?;
            let seen = method.project(input, order, Branch::Plus)?.psi_static?;
            Some(((seen - truth).abs().to_degrees(), [input.r, input.phi, input.camera]))
        })
        .collect();
    super::score::Spread::of(drawn)
}

fn draw(rng: &mut SmallRng, scheme: Scheme, inside: bool, sampling: usize) -> ProjectionInput {
    loop {
        let [x, y, z] = [rng.random::<f64>(), rng.random::<f64>(), rng.random::<f64>()];
        let uniform = |[low, high]: [f64; 2], x: f64| low + (high - low) * x;
        let logarithmic = |[low, high]: [f64; 2], x: f64| low * (high / low).powf(x);
        let cameras = [RANGES[0], RANGES[1]];
        let camera = match sampling {
            0 => uniform(cameras, z),
            1 => logarithmic(cameras, z),
            _ => camera_mesh(scheme, inside).value(z),
        };
        let radii = if inside { [RANGES[2], camera] } else { [camera, RANGES[3]] };
        let (r, phi) = match sampling {
            0 => (uniform(radii, x), PI * y),
            1 => (logarithmic(radii, x), PI * y),
            _ => {
                let [radial, angular] = slice_meshes(scheme, inside, camera);
                (radial.value(x), angular.value(y))
            }
        };
        let half = (0.5 * phi).sin();
        let distance = (r - camera).hypot(2.0 * half * (r * camera).sqrt());
        // The f32 offset decides which half is asked: a point on the border may fall to either.
        let clear = (r - camera).abs() > 1e-6 * camera;
        if distance >= 0.01 * camera.sqrt() && phi > 1e-9 && clear {
            return ProjectionInput { r, phi, camera };
        }
    }
}
