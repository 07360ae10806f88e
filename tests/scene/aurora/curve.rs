//! Curves across the field, and the dipole's field lines.

use std::f64::consts::PI;

use glam::DVec2;
use lensrunner::scene::aurora::curve::Curve;
use lensrunner::scene::aurora::dipole::{PLANET_RADIUS, inclination, on_field_line, upwards};
use lensrunner::scene::aurora::random::uniform;

#[test]
fn seeds_lie_within_the_width_of_the_curve() {
    let curve = Curve {
        control: [DVec2::ZERO, DVec2::new(100.0, 80.0), DVec2::new(200.0, -80.0), DVec2::new(300.0, 0.0)],
        amplitude: 10.0,
        waves: 3.0,
        phase: 1.0,
        width: 6.0,
    };
    for k in 0..500 {
        let (along, across) = (f64::from(uniform(1, k, 0)), f64::from(uniform(1, k, 1)));
        let seed = curve.seed(along, across);
        let nearest = (0..=3000).map(|i| curve.point(f64::from(i) / 3000.0).distance(seed)).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 3.0 + 0.2, "{nearest} km from the curve");
        assert!((seed.distance(curve.point(along)) - 6.0 * (across - 0.5).abs()).abs() < 1e-9);
    }
    // Coincident control points have no direction; a seed is still a place.
    let point = Curve { control: [DVec2::ONE; 4], ..curve };
    assert!(point.seed(0.5, 0.9).is_finite());
}

#[test]
fn field_lines_are_the_dipoles() {
    for (x, y) in [(0.0, 0.0), (900.0, 1800.0), (-2400.0, 300.0), (7000.0, 100.0)] {
        for z in [0.0, 100.0, 400.0] {
            let p = DVec2::new(x, y);
            let point = on_field_line(p, z);
            assert!((point.length() - PLANET_RADIUS - z).abs() < 1e-6);
            // The line's tangent, by a difference, is the field.
            let tangent = (on_field_line(p, z + 0.5) - on_field_line(p, z - 0.5)).normalize();
            assert!(tangent.distance(upwards(point)) < 1e-5, "at {p}, {z} km: {tangent} against {}", upwards(point));
        }
    }
    // tan I = 2 tan λ: 78° at 67.9°.
    assert!((inclination(67.9f64.to_radians()).to_degrees() - 78.5).abs() < 0.1);
    let latitude = 67.9f64.to_radians();
    let p = DVec2::new((PI / 2.0 - latitude) * (PLANET_RADIUS + 110.0), 0.0);
    let point = on_field_line(p, 110.0);
    let dip = upwards(point).dot(point.normalize()).asin();
    assert!((dip - inclination(latitude)).abs() < 1e-9);
}
