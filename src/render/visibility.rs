//! What may be on the screen at all: a first, cautious sieve on the processor.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::frame::Camera;

/// Whether any of a cone of directions may fall on the screen. The cone has `radius` (radians) about `look`, in rain axes; `margin` (radians) is
/// added in the camera's frame. `aspect` is height over width. Errs towards yes.
pub fn may_be_seen(camera: &Camera, look: DVec3, radius: f64, margin: f64, aspect: f64) -> bool {
    if radius.is_nan() || radius > 0.5 {
        return true;
    }
    let centre = camera.seen_direction(look);
    // Aberration turns a cone into a cone: its greatest radius about the image of the middle, from four places of its rim, and half as much
    // again for what lies between them.
    let (u, v) = look.any_orthonormal_pair();
    let rim = [u, -u, v, -v].map(|d| camera.seen_direction(look * radius.cos() + d * radius.sin()).angle_between(centre));
    let radius = 1.5 * rim.into_iter().fold(0.0, f64::max) + margin;
    if radius > FRAC_PI_2 {
        return true;
    }
    // Outside one plane of the view's pyramid by more than the radius: not seen.
    let tangent = (0.5 * camera.field_of_view).tan();
    let inside = |across: f64, tangent: f64| (-centre.z * tangent - across.abs()) / tangent.hypot(1.0) > -radius.sin();
    inside(centre.x, tangent) && inside(centre.y, tangent * aspect)
}
