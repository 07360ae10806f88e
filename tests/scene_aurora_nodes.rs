//! The nodes of the aurora's curtains: their near field where curves end.

use std::f64::consts::TAU;

use glam::DVec2;
use lensrunner::scene::aurora::near::{Charge, Near};

#[test]
fn charges_of_two_curves_are_not_taken_together() {
    // Two curves of 20 nodes, 800 km apart, and a grid that knows charges as clouds 20 km wide. 20 is no whole number of sixes.
    let (thickness, sigma) = (6.0, 20.0);
    let charges: Vec<Charge> = (0..40)
        .map(|k| Charge { place: DVec2::new(5.0 * f64::from(k % 20), 800.0 * f64::from(k / 20)), amount: -1.0 - 0.1 * f64::from(k % 3) })
        .collect();
    let mut near = Near::new(thickness, sigma, DVec2::new(50.0, 400.0), 2000.0);
    near.sort(charges.clone(), &[0, 20, 40]);
    for end in [0, 19, 20, 39] {
        let place = charges[end].place + DVec2::new(3.0, 8.0);
        let field = |charge: &Charge| {
            let away = place - charge.place;
            let left = |w: f64| (-0.5 * away.length_squared() / (w * w)).exp();
            away * (charge.amount * (left(sigma) - left(thickness)) / (TAU * away.length_squared()))
        };
        let want: DVec2 = charges.iter().map(field).sum();
        // 1 %: what is left out of charges taken together, of the table between its values, and beyond the reach.
        let got = near.field_at(place);
        assert!(got.distance(want) < 0.01 * want.length(), "beside charge {end}: {got} mV/m, pair by pair {want}");
    }
}
