//! What every method of projection must do, those of the game and those of the laboratory.

use std::f64::consts::PI;

use lensrunner::lensing::methods::{self, ProjectionInput, Projector};
use lensrunner::lensing::{Scheme, Table, bake};
use lensrunner::spacetime::light::{Branch, Order};

/// A table that is quick to make: the committed one, or one of few nodes.
pub fn small(scheme: Scheme, _nodes: usize) -> Table {
    if scheme == Scheme::Residual { crate::support::table().clone() } else { bake(scheme, 8, |_| ()) }
}

/// Where no light joins a point to a camera a method says so, or has no answer; none invents one, none returns NaN.
pub fn says_where_no_ray_is(name: &str, method: &dyn Projector) {
    // Under the horizon from outside; nearer to the hole than a camera inside; inside but too far around; inside in order 2.
    let dark = [(0.5, 1.0, 5.0, 1), (0.9999, 0.1, 1.01, 1), (0.3, 0.5, 0.5, 1), (0.8, 2.9, 0.7, 1), (0.8, 0.2, 0.5, 2)];
    for (r, phi, camera, order) in dark {
        let order = Order::new(order).unwrap();
        assert!(methods::Exact.project(ProjectionInput { r, phi, camera }, order, Branch::Plus).is_none());
        let answer = method.project(ProjectionInput { r, phi, camera }, order, Branch::Plus);
        // Straight lines know nothing of a hole: the one method that invents.
        assert!(answer.is_none() || name == "flat", "{name} answers at r {r} φ {phi} L {camera}");
    }
    for camera in [0.06, 0.9, 1.0, 1.02, 1.5, 30.0, 4000.0] {
        for r in [0.2, 0.95, 1.0, 1.0006, 1.01, 1.5, 1.51, 30.0, 9999.0] {
            for phi in [1e-9, 1e-4, 1.0, PI - 1e-4, PI - 1e-9] {
                for order in Order::ALL {
                    for branch in [Branch::Plus, Branch::Minus] {
                        if let Some(sight) = method.project(ProjectionInput { r, phi, camera }, order, branch) {
                            let sound =
                                sight.psi_rain.is_finite() && (0.0..=PI + 1e-6).contains(&sight.psi_rain) && sight.delay.is_finite();
                            assert!(sound, "{name} at r {r} φ {phi} L {camera} {order:?} {branch:?}: {sight:?}");
                        }
                    }
                }
            }
        }
    }
}

/// A camera falls through the horizon in even steps while it watches a field of points: no point jumps by more than its neighbours in time
/// explain (three times their step), so there is no frame with a seam. `rounding` is what the method may jump by besides, radians.
pub fn does_not_jump_on_the_fall(name: &str, rounding: f64, method: &dyn Projector) {
    let points: Vec<(f64, f64)> =
        [1.2, 1.5, 2.0, 6.0, 60.0, 3000.0].into_iter().flat_map(|r| [0.01, 0.4, 1.0, 1.8, 2.6, 3.1].map(|phi| (r, phi))).collect();
    let look = |r, phi, camera, order| {
        method.project(ProjectionInput { r, phi, camera }, order, Branch::Plus).unwrap_or_else(|| panic!("{name}: nothing seen")).psi_rain
    };
    let mut worst: f64 = 0.0;
    for order in Order::ALL {
        let frames: Vec<Vec<f64>> = (0..=120)
            .map(|i| {
                let l = 1.006 - 1e-4 * f64::from(i);
                points.iter().map(|(r, phi)| look(*r, *phi, l, order)).collect()
            })
            .collect();
        for (p, point) in points.iter().enumerate() {
            for i in 1..frames.len() - 2 {
                let step = |i: usize| (frames[i + 1][p] - frames[i][p]).abs();
                let explained = step(i - 1).max(step(i + 1));
                let allowed = 3.0 * explained + rounding;
                worst = worst.max(step(i) - 3.0 * explained);
                assert!(step(i) < allowed, "{name} {point:?} {order:?} frame {i}: {} rad after {explained}", step(i));
            }
        }
    }
    println!("{name}: {worst:.2e} rad more than explained, {rounding:.0e} allowed");
}
