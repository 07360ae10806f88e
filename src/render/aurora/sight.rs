//! Whether an image of a planet's aurora may be on the screen: a cone about the image of the planet's middle that holds those of places all over the aurora's upper end.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::render::instances::visibility::cone_may_be_seen;
use crate::render::instances::{View, departure};
use crate::sim::History;
use crate::spacetime::light::Order;

/// Places that are looked at. Spread evenly, none of the ball's surface is farther than a sixth of a radian from one of them.
const PLACES: u32 = 256;
/// Nearer to the middle than this, in radii of the ball, the camera is amid the aurora, or so near that the ball fills half of what there is to see.
const AMID: f64 = 1.1;
/// Part by which the cone is wider than what holds those places: the outline of a ball 1.1 radii away lies between them by 5 % of its angular radius, of one far
/// away by 1.4 % (1 − cos ⅙); twice as much.
const BETWEEN: f64 = 0.1;
/// Added to it, radians in the camera's axes: the lookup's error and the width of strokes, some pixels.
const EDGE: f64 = 0.02;
/// Radii of the ball from the axis through the hole within which an image may go all round it: as it moves by a seventh of what light needs for the ball's
/// radius, 1.15 would do.
const ROUND: f64 = 1.3;
/// Nearer to the hole than this, in radii of the ball, its images are taken to be anywhere.
const DEEP: f64 = 3.0;
/// Looks for the moment at which the light of a place left: each time what is missing becomes a third or less, the part of c at which a planet moves.
const SEARCH: u32 = 5;

/// Whether any of the image of `order` of a ball of radius `reach` (r_s) about what has this history may be on the screen at T = `time`. Errs towards yes.
pub fn may_be_seen(view: &View, time: f64, history: &History, order: Order, reach: f64) -> bool {
    let Some((aspect, began)) = view.aspect.zip(departure(view, time, history, order)) else { return true };
    let camera = view.camera;
    let amid = (history.at(time).position - camera.position).length() < AMID * reach;
    let middle = history.at(began).position;
    if (amid && order.number() == 1) || middle.length() < DEEP * reach {
        return true;
    }
    let n = camera.position.normalize();
    let off_axis = (middle - n * middle.dot(n)).length();
    // Before the camera the primary image is a plain one.
    let is_round = view.settings.method.bends() && off_axis < ROUND * reach && (order.number() > 1 || middle.dot(n) < 0.0);
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
    // Where part of it is not seen, its image ends anywhere.
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
