//! The nodes of the aurora's curtains: their near field where curves end, and the curve that is drawn between them.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use lensrunner::scene::aurora::curtains::curtains;
use lensrunner::scene::aurora::curve::between_nodes;
use lensrunner::scene::aurora::motion::near::{Charge, Near};
use lensrunner::scene::aurora::motion::{AuroraMotion, Plan};
use lensrunner::scene::aurora::random::uniform;
use lensrunner::scene::planet::AuroraShape;

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

#[test]
fn between_nodes_a_curtain_is_round() {
    // A curl of seven nodes: by straight lines it is off by a tenth of its radius.
    let node = |k: i32| 7.0 * DVec2::from_angle(TAU / 7.0 * f64::from(k));
    for k in 0..7 {
        let nodes = [-1, 0, 1, 2].map(|beside| node(k + beside));
        for t in [0.0, 0.1, 0.25, 0.5, 0.8, 1.0] {
            let [place, step] = between_nodes(nodes, t);
            assert!((place.length() / 7.0 - 1.0).abs() < 0.005, "{} km from the middle of a circle of 7 km", place.length());
            // It goes round, and about as fast everywhere: within a twentieth.
            assert!(step.angle_to(place.perp()).abs() < 0.06, "{step} at {place}");
            assert!((step.length() / nodes[1].distance(nodes[2]) - 1.0).abs() < 0.05, "{step} at {place}");
            // The derivative is one.
            let [[a, _], [b, _]] = [t - 1e-5, t + 1e-5].map(|t| between_nodes(nodes, t));
            assert!(((b - a) / 2e-5).distance(step) < 1e-6, "{step} at {t}");
        }
    }
}

#[test]
fn between_nodes_at_any_distance_there_is_no_loop() {
    for k in 0..2000u32 {
        let random = |number: u32| f64::from(uniform(5, k, number));
        // Steps a hundred times as long as others, turned by up to 100° each.
        let mut nodes = [DVec2::ZERO; 4];
        let mut angle = TAU * random(0);
        for step in 1..4u32 {
            angle += (random(step) - 0.5) * 200f64.to_radians();
            nodes[step as usize] = nodes[step as usize - 1] + DVec2::from_angle(angle) * 100f64.powf(random(10 + step));
        }
        let chord = (nodes[2] - nodes[1]).normalize();
        let [ahead, farthest] = (0..=100).fold([f64::INFINITY, 0.0f64], |[ahead, farthest], j| {
            let [place, step] = between_nodes(nodes, f64::from(j) / 100.0);
            [ahead.min(step.dot(chord)), farthest.max((place - nodes[1]).perp_dot(chord).abs())]
        });
        // Where it turns by less than a right angle at a node it never runs back, and it is never far from the straight line.
        let length = nodes[1].distance(nodes[2]);
        let turned = [nodes[2] - nodes[0], nodes[3] - nodes[1]].map(|direction| direction.angle_to(chord).abs());
        assert!(ahead > -0.01 * length || turned.into_iter().fold(0.0, f64::max) > 0.5 * PI, "{nodes:?} run back by {ahead}");
        assert!(farthest < 0.3 * length, "{nodes:?}: {farthest} km off a line of {length} km");
    }
    // Nodes at one place have no direction; there is a place all the same.
    for nodes in [[DVec2::ONE; 4], [DVec2::ZERO, DVec2::ZERO, DVec2::X, DVec2::ZERO]] {
        assert!(between_nodes(nodes, 0.3).iter().all(|vector| vector.is_finite()));
    }
}

#[test]
fn rows_go_on_beyond_the_ends_of_curves() {
    for shape in [AuroraShape::Oval, AuroraShape::Arcs] {
        let plan = Plan { curves: curtains(shape, 3), nodes: 2000, field: 50.0, renewal: 60.0, contrast: 0.7, seed: 3 };
        let mut motion = AuroraMotion::new(plan, 0.0);
        (0..60).for_each(|_| motion.step());
        let row: Vec<DVec2> = motion.row().map(|node| node.place).collect();
        let curves = motion.layout().starts.windows(2).enumerate();
        let curves: Vec<[usize; 2]> = curves.map(|(curve, own)| [own[0], own[1] - 1].map(|node| node + 2 * curve + 1)).collect();
        assert_eq!(row.len(), motion.nodes().len() + 2 * curves.len());
        let mut joints = 0;
        for (curve, &[first, last]) in curves.iter().enumerate() {
            // Its own nodes in their order.
            let own = motion.nodes()[motion.layout().starts[curve]..motion.layout().starts[curve + 1]].iter().map(|node| node.place);
            assert!(own.eq(row[first..=last].iter().copied()));
            match curves.iter().find(|[other, _]| row[*other].distance(row[last]) < 1.0) {
                // Both curves have the same direction where they are joined.
                Some(&[next, _]) => {
                    assert!(row[last + 1].distance(row[next + 1]) < 1e-9 && row[next - 1].distance(row[last - 1]) < 1e-9);
                    joints += 1;
                }
                None => assert!((row[last + 1] - row[last]).distance(row[last] - row[last - 1]) < 1e-9),
            }
        }
        // A ring of twelve parts and half of another; arcs have their ends for themselves.
        assert_eq!(joints, if shape == AuroraShape::Oval { 12 + 5 } else { 0 });
    }
}
