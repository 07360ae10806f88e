//! The closed form of `spacetime::light`.

use super::{Method, ProjectionInput, Projector, Sight, sight};
use crate::spacetime::light::{self, Branch, Order};

/// The method.
pub const METHOD: Method = Method {
    name: "exact",
    about: "the ray in closed form (elliptic functions), f64, solved for each point",
    make: |_| Box::new(Exact),
    shader: ("shaders/method/exact.wgsl", include_str!("../../../shaders/method/exact.wgsl")),
    table: None,
    orders: 3,
    bends: true,
    is_exact: true,
};

/// The ray through elliptic functions in f64, solved for each point to the last digits.
pub struct Exact;

impl Projector for Exact {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        let (u_point, u_camera) = (1.0 / input.r, 1.0 / input.camera);
        let branch = if u_point > 1.0 && u_camera > 1.0 { branch } else { Branch::Plus };
        let ray = light::connect(u_point, order.swept(input.phi), u_camera, branch)?;
        Some(sight(ray.slope, ray.energy, ray.delay, u_camera))
    }
}
