//! Whether an image of a planet's aurora may be on the screen. The aurora's upper end is a ball round the planet; a cone about the image of
//! the ball's middle is made that holds the images of points all over the ball.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::render::instances::InstanceView;
use crate::render::instances::visibility::cone_may_be_seen;
use crate::sim::History;
use crate::spacetime::light::Order;

/// If the camera is nearer to the middle than this, in radii of the ball, it is inside the aurora, or so near that the ball fills half of
/// its view.
const AMID: f64 = 1.1;
/// Number of points that are evaluated, and the share by which the cone is widened beyond them: first few points, and more where those do
/// not tell that nothing is seen. Evenly spread, 256 leave no part of the ball's surface farther than a sixth of a radian from one of them.
/// Between them the outline of a ball 1.1 radii away extends by up to 5 % of its angular radius, of a far one by 1.4 % (1 − cos ⅙). The
/// share is twice as much, and for a quarter of the points four times as much as that.
const FINE: (u32, f64) = (256, 0.1);
const COARSE: (u32, f64) = (64, 0.4);
/// Added to the cone, in radians in the camera's frame: the lookup's error and the width of strokes, some pixels.
const EDGE: f64 = 0.02;
/// If the ball's middle is nearer to the axis through the hole than this, in radii of the ball, its image may be a whole ring. The planet
/// moves by a seventh of the radius while light crosses that radius, so 1.15 would be enough.
const ROUND: f64 = 1.3;
/// If the ball is nearer to the hole than this, in its radii, its images may be anywhere.
const DEEP: f64 = 3.0;
/// Steps of the search for the emission time of a point. Each reduces the error to the planet's speed over c, a third or less; the first is
/// off by the light's way through the ball at most.
const SEARCH: u32 = 3;

/// Whether any part of the image of `order` of a ball may be on the screen. The ball has the radius `reach` (r_s) and moves with `history`;
/// `time` are T of the light from its middle, as it leaves and as it is seen. In doubt the answer is yes.
pub fn may_be_seen(view: &InstanceView, [began, time]: [f64; 2], history: &History, order: Order, reach: f64) -> bool {
    let Some(aspect) = view.aspect else { return true };
    let camera = view.camera;
    let amid = (history.at(time).position - camera.position).length() < AMID * reach;
    let ball = history.at(began);
    let middle = ball.position;
    if (amid && order.number() == 1) || middle.length() < DEEP * reach {
        return true;
    }
    let n = camera.position.normalize();
    let off_axis = (middle - n * middle.dot(n)).length();
    // In front of the hole the primary image is no ring.
    let is_round = view.settings.method.bends && off_axis < ROUND * reach && (order.number() > 1 || middle.dot(n) < 0.0);
    let about = if is_round { Some(-n) } else { view.look(middle, order, time - began).map(|(look, _)| look) };
    let Some(about) = about.map(|look| camera.seen_direction(look)) else { return true };
    let on_screen = |widest: f64| cone_may_be_seen(camera, about, widest, aspect);
    if on_screen(0.0) {
        return true;
    }
    // The angle at which a point is seen, by the light that left it: the ball goes on meanwhile, and straight.
    let angle = |place: DVec3| {
        let mut emission = began;
        let mut seen = None;
        for _ in 0..if view.settings.light_delay { SEARCH } else { 1 } {
            let centre = middle + ball.velocity * (emission - began);
            let (look, path) = view.look(centre + place * reach, order, time - emission)?;
            seen = Some(look);
            if view.settings.light_delay {
                emission = time - path;
            }
        }
        Some(camera.seen_direction(seen?).angle_between(about))
    };
    [COARSE, FINE].into_iter().all(|(number, between)| {
        let mut widest = 0.0;
        for place in places(number) {
            // If a part of the ball is not seen, nothing is known of where its image ends.
            let Some(angle) = angle(place) else { return true };
            widest = f64::max(widest, angle);
            if angle == widest && on_screen(widest * (1.0 + between) + EDGE) {
                return true;
            }
        }
        false
    })
}

/// Unit vectors spread evenly: by equal areas from pole to pole, each turned from the last by the golden angle.
fn places(number: u32) -> impl Iterator<Item = DVec3> {
    (0..number).map(move |k| {
        let z = 1.0 - (f64::from(k) + 0.5) * 2.0 / f64::from(number);
        let (sine, cosine) = (f64::from(k) * TAU * 0.381_966_011_250_105).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(cosine * across, sine * across, z)
    })
}
