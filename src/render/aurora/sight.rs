//! Whether an image of a planet's aurora may be on the screen. The aurora's upper end is a ball round the planet; a cone about the image of
//! the ball's middle is made that holds the images of points all over the ball.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::render::instances::visibility::cone_may_be_seen;
use crate::render::instances::{InstanceView, departure};
use crate::sim::History;
use crate::spacetime::light::Order;

/// Number of points that are evaluated. Evenly spread, they leave no part of the ball's surface farther than a sixth of a radian from one
/// of them.
const PLACES: u32 = 256;
/// If the camera is nearer to the middle than this, in radii of the ball, it is inside the aurora, or so near that the ball fills half of
/// its view.
const AMID: f64 = 1.1;
/// Share by which the cone is widened beyond those points. Between them the outline of a ball 1.1 radii away extends by up to 5 % of its
/// angular radius, of a far one by 1.4 % (1 − cos ⅙). This is twice as much.
const BETWEEN: f64 = 0.1;
/// Added to the cone, in radians in the camera's frame: the lookup's error and the width of strokes, some pixels.
const EDGE: f64 = 0.02;
/// If the ball's middle is nearer to the axis through the hole than this, in radii of the ball, its image may be a whole ring. The planet
/// moves by a seventh of the radius while light crosses that radius, so 1.15 would be enough.
const ROUND: f64 = 1.3;
/// If the ball is nearer to the hole than this, in its radii, its images may be anywhere.
const DEEP: f64 = 3.0;
/// Steps of the search for the emission time of a point. Each reduces the error to the planet's speed over c, a third or less.
const SEARCH: u32 = 5;

/// Whether any part of the image of `order` of a ball may be on the screen at T = `time`. The ball has the radius `reach` (r_s) and moves
/// with `history`. In doubt the answer is yes.
pub fn may_be_seen(view: &InstanceView, time: f64, history: &History, order: Order, reach: f64) -> bool {
    let Some((aspect, began)) = view.aspect.zip(departure(view, time, history, order).map(|light| light.time)) else { return true };
    let camera = view.camera;
    let amid = (history.at(time).position - camera.position).length() < AMID * reach;
    let middle = history.at(began).position;
    if (amid && order.number() == 1) || middle.length() < DEEP * reach {
        return true;
    }
    let n = camera.position.normalize();
    let off_axis = (middle - n * middle.dot(n)).length();
    // In front of the hole the primary image is no ring.
    let is_round = view.settings.method.bends && off_axis < ROUND * reach && (order.number() > 1 || middle.dot(n) < 0.0);
    let about = if is_round { Some(-n) } else { view.look(middle, order, time - began).map(|(look, _)| look) };
    let Some(about) = about.map(|look| camera.seen_direction(look)) else { return true };
    if cone_may_be_seen(camera, about, 0.0, aspect) {
        return true;
    }
    let angle = |place: DVec3| {
        let mut emission = began;
        let mut seen = None;
        for _ in 0..if view.settings.light_delay { SEARCH } else { 1 } {
            let (look, path) = view.look(history.at(emission).position + place, order, time - emission)?;
            seen = Some(look);
            if view.settings.light_delay {
                emission = time - path;
            }
        }
        Some(camera.seen_direction(seen?).angle_between(about))
    };
    let widest = places().map(|place| angle(place * reach)).try_fold(0.0, |widest, angle| angle.map(|angle| f64::max(widest, angle)));
    // If a part of the ball is not seen, nothing is known of where its image ends.
    widest.is_none_or(|widest| cone_may_be_seen(camera, about, widest * (1.0 + BETWEEN) + EDGE, aspect))
}

/// Unit vectors spread evenly: by equal areas from pole to pole, each turned from the last by the golden angle.
fn places() -> impl Iterator<Item = DVec3> {
    (0..PLACES).map(|k| {
        let z = 1.0 - (f64::from(k) + 0.5) * 2.0 / f64::from(PLACES);
        let (sine, cosine) = (f64::from(k) * TAU * 0.381_966_011_250_105).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(cosine * across, sine * across, z)
    })
}
