//! The residual table as the game uses it: sliced once a frame, looked up in f32.

use super::{Method, ProjectionInput, Projector, Sight, Vertex};
use crate::lensing::lookup::{OLD, YOUNG, lens_lookup_aged};
use crate::lensing::{self, LensRay, SMALL_NODES, Scheme, Slice};
use crate::spacetime::light::{self, Branch, Order};

/// The method.
pub const METHOD: Method = Method {
    name: "table",
    about: "what the game draws with: the residual table, sliced at the camera's radius for a frame, cubic, f32",
    make: |load| Box::new(Table(load(Scheme::Residual, SMALL_NODES))),
    shader: ("shaders/method/table.wgsl", include_str!("../../../shaders/method/table.wgsl")),
    table: Some((Scheme::Residual, SMALL_NODES)),
    orders: 3,
    bends: true,
    is_exact: true,
};

/// The lensing table as the GPU evaluates it: a slice at the camera's radius, then the lookup in f32.
pub struct Table(pub lensing::Table);

/// Whether the tables reach so far.
pub fn in_range(input: ProjectionInput) -> bool {
    let [low, high] = lensing::table::grid::CAMERA_RANGE;
    (low..=high).contains(&input.camera) && 1.0 / input.r >= lensing::double::POINT_RANGE[0]
}

/// One point in a slice.
pub fn look_up(slice: &Slice, point: &Vertex, order: Order, branch: Branch) -> LensRay {
    let elapsed = if branch == Branch::Minus { OLD } else { YOUNG };
    lens_lookup_aged(slice, point.along, point.across, point.height, u32::from(order.number()), elapsed)
}

/// What the f32 lookup found; None if nothing.
pub fn seen(ray: &LensRay, input: ProjectionInput) -> Option<Sight> {
    ray.valid.then(|| Sight {
        psi_rain: f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)),
        psi_static: light::static_angle(f64::from(ray.slope), f64::from(ray.energy), 1.0 / input.camera),
        delay: f64::from(ray.delay),
    })
}

impl Projector for Table {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        if !in_range(input) {
            return None;
        }
        seen(&look_up(&Slice::new(&self.0, input.camera), &input.into(), order, branch), input)
    }
}
