//! The rays of the drawings, by the closed form of light: lines in a plane through the hole, which is at the origin. Lengths in r_s,
//! angles in radians, azimuths counter-clockwise from +x.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use crate::spacetime::light::{Branch, Connection, Order, SweepEnd, connect, follow, static_angle, swept_to_sky};

/// Where a ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the horizon.
    Caught,
    /// Far away.
    Escaped,
}

/// The length of a step along a ray over its radius: a chord then keeps within 1/800 of the radius of curvature of a circle.
const STEP: f64 = 0.1;
/// The most steps on one ray: it would take a winding closer than 1e-12 to the critical one to need more.
const MOST_STEPS: usize = 2000;

/// A ray from the camera's end: u, w, the azimuth there, and +1 where it turns counter-clockwise, else −1.
struct Start {
    u: f64,
    w: f64,
    azimuth: f64,
    sense: f64,
}

impl Start {
    fn place(&self, r: f64, swept: f64) -> DVec2 {
        r * DVec2::from_angle(self.azimuth + self.sense * swept)
    }

    /// Points along the ray until it swept `most`, reached the horizon or came to r = `far`.
    fn walk(&self, most: f64, far: f64) -> (Vec<DVec2>, Option<End>) {
        let mut points = vec![self.place(1.0 / self.u, 0.0)];
        let (mut u, mut slope, mut swept) = (self.u, self.w, 0.0);
        for _ in 0..MOST_STEPS {
            swept += STEP / (slope / u).hypot(1.0);
            if swept >= most {
                return (points, None);
            }
            match follow(self.u, self.w, swept) {
                SweepEnd::At { u: next, .. } if next >= 1.0 => {
                    points.push(self.place(1.0, swept - STEP * (next - 1.0) / (next - u) / (slope / u).hypot(1.0)));
                    return (points, Some(End::Caught));
                }
                SweepEnd::At { u: next, slope: now } => (u, slope) = (next, now),
                SweepEnd::Plunged => return (points, Some(End::Caught)),
                SweepEnd::Escaped => return (points, Some(End::Escaped)),
            }
            points.push(self.place(1.0 / u, swept));
            if slope < 0.0 && u * far < 1.0 {
                return (points, Some(End::Escaped));
            }
        }
        (points, None)
    }
}

/// Light from infinity that flies towards +x at the height `impact` (its impact parameter, not 0), from r = `far` on until it is at the
/// horizon or as far again. None where `far` is not outside of the ray's nearest point.
pub fn from_afar(impact: f64, far: f64) -> Option<(Vec<DVec2>, End)> {
    let (u, e) = (1.0 / far, 1.0 / impact.abs());
    let w = (e * e - u * u + u * u * u).sqrt();
    // The same line, flown the other way, leaves for the sky.
    let before = swept_to_sky(-w, e, u)?;
    let sense = -impact.signum();
    let start = Start { u, w, azimuth: PI + sense * before, sense };
    let (points, end) = start.walk(TAU * 4.0, far);
    Some((points, end?))
}

/// The light by which a camera sees a point.
pub struct Sight {
    /// From the camera to the point.
    pub line: Vec<DVec2>,
    /// The ray.
    pub ray: Connection,
    /// The angle between the image and the centre of the hole for a camera that stays in place.
    pub off: f64,
    /// The unit vector to the image, as such a camera sees it: its axes outward and along the azimuth.
    pub look: DVec2,
}

/// The light from `point` to `camera`, both outside the horizon, by which the image `order` is seen; None where there is none.
pub fn sight(camera: DVec2, point: DVec2, order: Order) -> Option<Sight> {
    let turn = camera.angle_to(point);
    let sense = if order.flips() { -turn.signum() } else { turn.signum() };
    let swept = order.swept(turn.abs());
    let (u_camera, u_point) = (1.0 / camera.length(), 1.0 / point.length());
    let ray = connect(u_point, swept, u_camera, Branch::Plus)?;
    let start = Start { u: u_camera, w: ray.slope, azimuth: camera.to_angle(), sense };
    let (mut line, _) = start.walk(swept, f64::INFINITY);
    line.push(point);
    let psi = static_angle(ray.slope, ray.energy, u_camera)?;
    let outward = camera.normalize();
    let look = outward * psi.cos() + outward.perp() * (sense * psi.sin());
    Some(Sight { line, ray, off: PI - psi, look })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::metric::CRITICAL_IMPACT;
    use glam::dvec2;

    #[test]
    fn light_is_caught_below_the_critical_impact_parameter() {
        for share in [0.1, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0] {
            for side in [1.0, -1.0] {
                let (line, end) = from_afar(side * share * CRITICAL_IMPACT, 15.0).expect("a ray from outside");
                let last = line[line.len() - 1];
                if share < 1.0 {
                    assert_eq!(end, End::Caught, "{share}");
                    assert!((last.length() - 1.0).abs() < 1e-9, "{share}: {last}");
                } else {
                    assert_eq!(end, End::Escaped, "{share}");
                    assert!(last.length() > 14.9, "{share}: {last}");
                }
            }
        }
    }

    /// Far out a ray lies on the straight line of its impact parameter; weak bending is 2/b.
    #[test]
    fn a_ray_from_afar_comes_along_its_line_and_is_bent_inwards() {
        let (line, _) = from_afar(100.0, 1e5).expect("a ray from outside");
        assert!((line[0].y - 100.0).abs() < 1e-2 && line[0].x < 0.0, "{}", line[0]);
        let (before, last) = (line[line.len() - 2], line[line.len() - 1]);
        let bent = (last - before).normalize().perp_dot(DVec2::X);
        assert!((bent / (2.0 / 100.0) - 1.0).abs() < 0.05, "{bent}");
    }

    #[test]
    fn light_goes_round_both_sides() {
        let (camera, ship) = (dvec2(9.0, 0.0), dvec2(-8.0, 1.3));
        let [first, second] = [1, 2].map(|n| sight(camera, ship, Order::new(n).expect("an order")).expect("light"));
        for (seen, side) in [(&first, 1.0), (&second, -1.0)] {
            assert_eq!(seen.line[0], camera);
            assert_eq!(seen.line[seen.line.len() - 1], ship);
            // It passes the hole on its own side, outside of the photon sphere.
            let least = seen.line.iter().min_by(|a, b| a.length().total_cmp(&b.length())).expect("points");
            assert!(least.y * side > 1.5, "{least}");
            // The line on the sheet begins as the camera looks, up to the stretching of lengths beside the hole.
            assert!((seen.line[1] - camera).normalize().distance(seen.look) < 0.05, "{}", seen.look);
        }
        assert!(second.ray.delay > first.ray.delay);
    }
}
