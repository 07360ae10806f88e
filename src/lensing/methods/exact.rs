//! The closed form of `spacetime::light`.

use super::{Projector, Query, Sight, sight};
use crate::spacetime::light::{self, Branch, Order};

/// The ray through elliptic functions in f64, solved for each point to the last digits.
pub struct Exact;

impl Projector for Exact {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        let (u_point, u_camera) = (1.0 / query.r, 1.0 / query.camera);
        let branch = if u_point > 1.0 && u_camera > 1.0 { branch } else { Branch::Plus };
        let ray = light::connect(u_point, order.swept(query.phi), u_camera, branch)?;
        Some(sight(ray.slope, ray.energy, ray.delay, u_camera))
    }
}
