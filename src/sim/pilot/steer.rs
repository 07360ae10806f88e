//! Turning the nose.

use glam::DVec3;

/// Body rates that turn the nose (−z) towards `direction` (a unit vector on body axes): proportional to the sine of the angle, full when
/// behind.
pub fn turn_nose(direction: DVec3, max_rate: f64) -> DVec3 {
    let axis = DVec3::NEG_Z.cross(direction);
    let wanted = if direction.z > 0.0 { axis.try_normalize().unwrap_or(DVec3::Y) } else { axis };
    wanted * max_rate
}
