//! No hole.

use super::{Method, ProjectionInput, Projector, Sight};
use crate::spacetime::light::{Branch, Order};

/// The method.
pub const METHOD: Method = Method {
    name: "flat",
    about: "straight lines",
    make: |_| Box::new(Flat),
    shader: ("shaders/method/flat.wgsl", include_str!("../../../shaders/method/flat.wgsl")),
    table: None,
    orders: 1,
    bends: false,
    is_exact: false,
};

/// Light goes straight: the angle of flat space for a static camera, in the rain frame where nothing is static.
pub struct Flat;

impl Projector for Flat {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        if order.number() != 1 || branch != Branch::Plus {
            return None;
        }
        let ProjectionInput { r, phi, camera: l } = input;
        let half = (0.5 * phi).sin();
        let along = (r - l) - 2.0 * r * half * half;
        let across = r * phi.sin();
        let (psi, delay) = (across.atan2(along), along.hypot(across));
        Some(if l > 1.0 { Sight::from_static(psi, delay, l) } else { Sight { psi_rain: psi, psi_static: None, delay } })
    }
}
