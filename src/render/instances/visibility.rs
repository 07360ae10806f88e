//! Whether anything of an image may be on the screen: a first, cautious test on the processor.

use crate::spacetime::Observer;
use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

/// The part of the screen on which a cone of directions may fall, as shares of width and height: left, upper, right and lower edge. The
/// cone has `radius` (radians) about `look`, in rain axes; `aspect` is height over width. In doubt it is the whole screen.
pub fn part_of_screen(camera: &Observer, look: DVec3, radius: f64, aspect: f64) -> [f64; 4] {
    const WHOLE: [f64; 4] = [0.0, 0.0, 1.0, 1.0];
    let centre = camera.seen_direction(look);
    let Some(radius) = seen_radius(camera, look, radius).filter(|radius| *radius < 0.5) else { return WHOLE };
    let away = centre.angle_between(DVec3::NEG_Z);
    // Far from the middle of the screen angles are stretched.
    if away + radius > 1.3 {
        return WHOLE;
    }
    let reach = (away + radius).tan() - away.tan();
    let [x, y] = [-centre.x / centre.z, centre.y / centre.z];
    let half = (0.5 * camera.field_of_view).tan();
    let share = |at: f64, half: f64| (0.5 + 0.5 * at / half).clamp(0.0, 1.0);
    [share(x - reach, half), share(y - reach, half * aspect), share(x + reach, half), share(y + reach, half * aspect)]
}

/// The radius of the cone as the camera sees it, in radians about the image of its middle: the largest of four points of its rim, and half
/// as much again for what lies between. None for a wide cone.
fn seen_radius(camera: &Observer, look: DVec3, radius: f64) -> Option<f64> {
    if radius.is_nan() || radius > 0.5 {
        return None;
    }
    let centre = camera.seen_direction(look);
    let (u, v) = look.any_orthonormal_pair();
    let rim = [u, -u, v, -v].map(|d| camera.seen_direction(look * radius.cos() + d * radius.sin()).angle_between(centre));
    Some(1.5 * rim.into_iter().fold(0.0, f64::max))
}

/// Whether any of a cone of directions may fall on the screen. The cone has `radius` (radians) about `look`, in rain axes; `margin`
/// (radians) is added in the camera's frame. `aspect` is height over width. In doubt the answer is yes.
pub fn may_be_seen(camera: &Observer, look: DVec3, radius: f64, margin: f64, aspect: f64) -> bool {
    let Some(radius) = seen_radius(camera, look, radius) else { return true };
    cone_may_be_seen(camera, camera.seen_direction(look), radius + margin, aspect)
}

/// Whether any of a cone of directions about `centre` (a unit vector, camera axes) may fall on the screen; `radius` in radians. In doubt
/// the answer is yes.
pub fn cone_may_be_seen(camera: &Observer, centre: DVec3, radius: f64, aspect: f64) -> bool {
    if radius.is_nan() || radius > FRAC_PI_2 {
        return true;
    }
    let tangent = (0.5 * camera.field_of_view).tan();
    // Not seen: farther from the screen's middle than a corner by more than the radius. That includes what is behind the camera.
    let corner = (tangent * aspect.hypot(1.0)).atan();
    if centre.angle_between(DVec3::NEG_Z) > corner + radius {
        return false;
    }
    // Not seen: outside a plane of the view's pyramid by more than the radius.
    let inside = |across: f64, tangent: f64| (-centre.z * tangent - across.abs()) / tangent.hypot(1.0) > -radius.sin();
    inside(centre.x, tangent) && inside(centre.y, tangent * aspect)
}
