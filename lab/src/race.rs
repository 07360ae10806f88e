//! The race of methods on the GPU, handed to the chart of projections: the floor of measurements knows no renderer.

use std::sync::Arc;

use crate::projection::Adapter;
use lensrunner::lensing;
use lensrunner::render::Gpu;
use lensrunner::render::method::Method;
use lensrunner::render::method::race::Race;

/// The race on the best adapter there is; None, and a word on stderr, where there is none.
pub fn race() -> Option<Race> {
    match Gpu::headless() {
        Ok(gpu) => Some(Race::new(&gpu, Arc::new(lensing::default_table()))),
        Err(error) => {
            eprintln!("lensrunner: {error}; the chart is drawn without a graphics adapter");
            None
        }
    }
}

/// The index of the method's family in `lensing::methods::FAMILIES`.
fn family(method: Method) -> usize {
    match method {
        Method::Table | Method::TableFull | Method::TableLinear | Method::TableHalf | Method::Newton => 0,
        Method::ResidualCubic { .. } | Method::ResidualLinear { .. } => 0,
        Method::Paper1 { .. } => 1,
        Method::Beloborodov | Method::Poutanen | Method::Flat => 2,
        Method::Rk4 { .. } => 3,
        Method::Exact => 4,
    }
}

/// The result, or None and a word on stderr.
fn told<T>(result: Result<T, impl std::fmt::Display>) -> Option<T> {
    result.inspect_err(|error| eprintln!("lensrunner: {error}")).ok()
}

impl Adapter for Race {
    fn name(&self) -> String {
        self.adapter()
    }

    fn methods(&self) -> Vec<(&'static str, usize)> {
        Method::all().map(|method| (method.name(), family(method))).collect()
    }

    fn look_up(&mut self, method: &str, camera: f64, rows: &[[f32; 4]]) -> Option<Vec<Option<[f64; 2]>>> {
        let rays = told(Race::look_up(self, Method::named(method)?, camera, rows))?;
        let seen =
            |[[cos, sin, delay, there], _]: [[f32; 4]; 2]| (there == 1.0).then(|| [f64::from(sin).atan2(f64::from(cos)), f64::from(delay)]);
        Some(rays.into_iter().map(seen).collect())
    }

    fn time(&mut self, method: &str, camera: f64, rows: &[[f32; 4]]) -> Option<f64> {
        told(Race::time(self, Method::named(method)?, camera, rows)).map(|seconds| seconds * 1e9)
    }

    fn bytes(&mut self, method: &str) -> usize {
        Method::named(method).map_or(0, |method| if reads_table(method) { 16 * self.texels(method, 10.0).len() } else { 0 })
    }
}

/// Whether the method reads more than the constants of the camera.
fn reads_table(method: Method) -> bool {
    family(method) < 2
}
