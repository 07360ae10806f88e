//! The image of a thin disk: two integrations of different equations, and the constants of the motion.

use lensrunner::judge::picture::World;
use lensrunner::spacetime::frames;
use lensrunner::spacetime::matter::ShipState;
use lensrunner::spacetime::metric::river_speed;
use lensrunner_lab::thin_disk::ray::{Screen, image, orbit_shift};
use lensrunner_lab::thin_disk::{RING, difference, judge, screen};

#[test]
fn both_integrations_see_the_same_disk() {
    for (radius, inclination, field_of_view) in [(50.0, 1.22, 0.314), (6.0, 0.4, 1.6), (400.0, 1.4, 0.08), (4.0, 2.0, 2.6)] {
        let screen = Screen { radius, inclination, field_of_view, pixels: 24 };
        let truth = judge(&screen, &RING, 1e-15);
        assert!(truth.iter().filter(|impact| impact.g.is_finite()).count() > 60, "{screen:?}");
        // Rays that wind round the photon sphere have lost some of their digits.
        let fine = difference(&truth, &image(&screen, &RING, 1e-13));
        assert!(fine.coverage == 0 && fine.shift < 1e-8 && fine.flux < 1e-8, "{screen:?}: {fine:?}");
        // A coarser tolerance is worse, so the measure is alive, and still as good as it says.
        let coarse = difference(&truth, &image(&screen, &RING, 1e-6));
        assert!(coarse.shift > fine.shift && coarse.shift < 1e-2 && coarse.coverage <= 2, "{screen:?}: {coarse:?}");
    }
}

#[test]
fn g_follows_from_the_constants_of_the_motion() {
    let screen = screen(16);
    let world = World::new(&[], Vec::new(), 0.0, true);
    let position = screen.position();
    let beta = 1.0 / screen.radius.sqrt();
    let state = ShipState::new(position, position * (beta / (screen.radius * (1.0 - beta * beta).sqrt())));
    let pictured = judge(&screen, &RING, 1e-13);
    let mut checked = 0;
    for (i, impact) in pictured.iter().enumerate() {
        let photon = frames::ship_to_rain(state.momentum, state.attitude) * (-screen.look(i % 16, i / 16)).extend(1.0);
        world.look_through(position, -photon.truncate(), 1e-13, &mut |crossing| {
            if (crossing.position.length() - impact.radius).abs() < 1e-9 {
                // The light's angular momentum about +z over its energy.
                let (x, k) = (crossing.position, crossing.momentum);
                let (r, along) = (x.length(), x.dot(k) / x.length());
                let turning = x.cross(k).z / (k.length() - river_speed(r) * along);
                assert!((orbit_shift(r, screen.radius, turning) / impact.g - 1.0).abs() < 1e-11);
                checked += 1;
            }
        });
    }
    assert!(checked > 40, "{checked}");
    // One side comes, the other goes.
    let shifts = pictured.iter().map(|impact| impact.g).filter(|g| g.is_finite());
    assert!(shifts.clone().any(|g| g > 1.1) && shifts.clone().any(|g| g < 0.8));
}
