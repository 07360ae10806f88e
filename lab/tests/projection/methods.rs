//! The methods that the chart sets beside the game's: what they answer where there is no light, and how near they come.

use lensrunner::lensing::methods::{Exact, Flat, ProjectionInput, Projector, Table};
use lensrunner::lensing::{Slice, lens_lookup_at, score};
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner_lab::projection::methods::{Approximation, Batch, Integrate, catalogue, lens_lookup_batch};
use rand::SeedableRng;

use crate::projector::{does_not_jump_on_the_fall, says_where_no_ray_is, small};
use crate::support::table;

#[test]
fn no_ray_is_said_by_every_peer() {
    for entry in catalogue() {
        says_where_no_ray_is(entry.name, entry.made(&small).expect("it is made").as_ref());
    }
}

#[test]
fn no_point_jumps_on_the_fall_through_the_horizon() {
    does_not_jump_on_the_fall("table-batch", 3e-6, &Batch(Table(table().clone())));
    does_not_jump_on_the_fall("rk4-64", 1e-9, &Integrate { steps: 64 });
}

/// The closed approximations against the exact ray where their authors claim them: Beloborodov 1 % of the deflection for r > 2, Poutanen
/// 0.2 %; here far from the axis, where that is below these angles.
#[test]
fn the_approximations_do_what_their_authors_say() {
    for (r, phi, camera) in [(3.0, 1.0, 50.0), (5.0, 1.5, 200.0), (40.0, 1.2, 4.0), (6.0, 0.3, 8.0)] {
        let input = ProjectionInput { r, phi, camera };
        let psi = |method: &dyn Projector| method.project(input, Order::ALL[0], Branch::Plus).expect("seen").psi_rain.to_degrees();
        let exact = psi(&Exact);
        let off = |method: &dyn Projector| (psi(method) - exact).abs();
        let (flat, rough, fine) = (off(&Flat), off(&Approximation::Beloborodov), off(&Approximation::Poutanen));
        assert!(rough < 0.2 && fine < 0.1 && rough < flat, "{input:?}: flat {flat}°, Beloborodov {rough}°, Poutanen {fine}°");
        let delay = |method: &dyn Projector| method.project(input, Order::ALL[0], Branch::Plus).expect("seen").delay;
        assert!((delay(&Approximation::Poutanen) - delay(&Exact)).abs() < 0.15, "{input:?}");
    }
}

/// More steps, less error: the integrator converges with the fourth order that it claims (16 times less for half the step; 8 is asked).
#[test]
fn the_integrator_converges() {
    for (r, phi, camera) in [(20.0, 2.0, 10.0), (3.0, 1.0, 1.2), (4.0, 2.5, 0.6)] {
        let input = ProjectionInput { r, phi, camera };
        let psi = |method: &dyn Projector| method.project(input, Order::ALL[0], Branch::Plus).expect("seen").psi_rain;
        let exact = psi(&Exact);
        let off = |steps: usize| (psi(&Integrate { steps }) - exact).abs();
        assert!(off(32) > 8.0 * off(64) && off(256) < 1e-6, "{input:?}: {} {} {}", off(32), off(64), off(256));
    }
}

/// Eight at once give what one at a time gives, to the rounding of f32: directions to 5e-6 rad, delays to 1e-5 of them.
#[test]
fn the_batch_agrees_with_the_lookup() {
    let mut rng = rand::rngs::SmallRng::seed_from_u64(11);
    for _ in 0..300 {
        let l = score::draw(score::Points::Adversarial, &mut rng)[2];
        let slice = Slice::new(table(), l);
        let mut points: [[f32; 3]; 8] = std::array::from_fn(|_| {
            let [r, phi, camera] = score::draw(score::Points::Adversarial, &mut rng);
            let r = (r / camera * l).clamp(1.0005, 1e4);
            let half = (0.5 * phi).sin();
            [(r - l) - 2.0 * r * half * half, r * phi.sin(), r * phi.cos()].map(|v| v as f32)
        });
        // One lane holds what is not a point outside.
        points[7][2] = [f32::NAN, 0.3, f32::INFINITY][(l * 1e6) as usize % 3];
        let lanes = |k: usize| points.map(|point| point[k]);
        for order in 1..=3 {
            let rays = lens_lookup_batch(&slice, lanes(0), lanes(1), lanes(2), order);
            for (i, [along, across, height]) in points.into_iter().enumerate() {
                let one = lens_lookup_at(&slice, along, across, height, order);
                let ray = rays.ray(i);
                assert_eq!(ray.valid, one.valid, "L {l} lane {i}");
                let angle = |s: f32, c: f32| f64::from(s).atan2(f64::from(c));
                let off = (angle(ray.sin_psi, ray.cos_psi) - angle(one.sin_psi, one.cos_psi)).abs();
                assert!(off < 5e-6, "L {l} order {order}: {ray:?} and {one:?}");
                assert!((ray.delay - one.delay).abs() < 2e-4 + 1e-5 * one.delay.abs(), "L {l} order {order}: {ray:?} and {one:?}");
                let tilt = |e: &lensrunner::lensing::LensRay| angle(e.emission_tangential, -e.emission_radial);
                assert!((tilt(&ray) - tilt(&one)).abs() < 2e-5, "L {l} order {order}: {ray:?} and {one:?}");
            }
        }
    }
}

/// Eight at a time or one by one, light of negative energy is the same.
#[test]
fn the_batch_answers_for_both_signs_of_energy() {
    let (one, eight) = (Table(table().clone()), Batch(Table(table().clone())));
    for (r, phi, camera) in [(0.8, 0.2, 0.5), (0.9, 0.3, 0.2), (5.0, 1.0, 0.5), (5.0, 1.0, 3.0)] {
        let input = ProjectionInput { r, phi, camera };
        let [plus, minus] = [Branch::Plus, Branch::Minus].map(|branch| {
            let [one, eight] = [&one as &dyn Projector, &eight]
                .map(|method| method.project(input, Order::ALL[0], branch).unwrap_or_else(|| panic!("{input:?} {branch:?}: nothing seen")));
            let off = (one.psi_rain - eight.psi_rain).abs().max((one.delay - eight.delay).abs() / (1.0 + one.delay));
            assert!(off < 1e-4, "{input:?} {branch:?}: {one:?} and {eight:?}");
            eight
        });
        assert_eq!((plus.psi_rain - minus.psi_rain).abs() > 1e-5, r < 1.0, "inside the two differ, from outside there is one: {input:?}");
    }
}
