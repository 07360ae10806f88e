//! The motion of curtains against the physics of charged sheets.

use std::f64::consts::PI;

use glam::DVec2;
use lensrunner::scene::aurora::curtains::curtains;
use lensrunner::scene::aurora::curve::Curve;
use lensrunner::scene::aurora::motion::poisson::Poisson;
use lensrunner::scene::aurora::motion::{AuroraMotion, Node, Plan, RAYS_LENGTH, STEP, TOP_SPEED, jump};
use lensrunner::scene::aurora::random::uniform;
use lensrunner::scene::config::AuroraConfig;
use lensrunner::scene::planet::AuroraShape;

/// Curtains of an even charge that is never renewed.
fn even(curves: Vec<Curve>, nodes: usize, field: f64) -> Plan {
    Plan { curves, nodes, field, renewal: f64::INFINITY, contrast: 0.0, seed: 1 }
}

fn steps(motion: &mut AuroraMotion, count: u32) {
    (0..count).for_each(|_| motion.step());
}

/// The first node of each piece of a curtain between two nodes.
fn pieces(motion: &AuroraMotion) -> impl Iterator<Item = usize> {
    motion.layout().starts.windows(2).flat_map(|window| window[0]..window[1] - 1)
}

#[test]
fn poisson_is_solved_exactly() {
    let n = 20;
    let h = 3.0;
    let mut poisson = Poisson::new(n, h);
    let source: Vec<f64> = (0..n * n).map(|k| f64::from(uniform(3, k as u32, 0)) - 0.3).collect();
    let mut v = source.clone();
    poisson.solve(&mut v);
    // From 1, with a frame of zeros.
    let at = |i: usize, j: usize| if (1..=n).contains(&i) && (1..=n).contains(&j) { v[(j - 1) * n + i - 1] } else { 0.0 };
    for (k, source) in source.iter().enumerate() {
        let (i, j) = (k % n + 1, k / n + 1);
        let laplacian = (at(i + 1, j) + at(i - 1, j) + at(i, j + 1) + at(i, j - 1) - 4.0 * at(i, j)) / (h * h);
        assert!((laplacian + source).abs() < 1e-11);
    }
    // And a smooth source has the analytic solution: V = sin(πx) sin(2πy) on the unit square, −∇²V = 5π² V.
    let (n, h) = (63, 1.0 / 64.0);
    let exact = |k: usize| (PI * h * (k % n + 1) as f64).sin() * (2.0 * PI * h * (k / n + 1) as f64).sin();
    let mut v: Vec<f64> = (0..n * n).map(|k| 5.0 * PI * PI * exact(k)).collect();
    Poisson::new(n, h).solve(&mut v);
    let worst = (0..n * n).map(|k| (v[k] - exact(k)).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst}");
}

fn straight(half: f64) -> Curve {
    let at = |x| DVec2::new(x, 0.0);
    Curve { control: [at(-half), at(-half / 3.0), at(half / 3.0), at(half)], amplitude: 0.0, waves: 0.0, phase: 0.0, width: 5.0 }
}

#[test]
fn a_charged_sheet_has_its_field_on_both_sides() {
    let mut motion = AuroraMotion::new(even(vec![straight(500.0)], 600, 40.0), 0.0);
    motion.step();
    // 60 km from the middle of a sheet 1000 km long, a finite sheet has 92 % of an endless one's (2/π atan(500/60)); the frame adds a
    // little.
    let above = motion.field_at(DVec2::new(0.0, 60.0));
    let below = motion.field_at(DVec2::new(0.0, -60.0));
    // Electrons charge it negatively: the field points to the sheet from both sides.
    assert!((above.y / (-40.0 * 0.924) - 1.0).abs() < 0.08, "{above}");
    assert!((below.y + above.y).abs() < 1e-6 * above.y.abs(), "{below}");
    assert!(above.x.abs() < 0.02 * above.y.abs());
}

#[test]
fn what_lies_beside_a_sheet_drifts_as_over_the_north_of_the_earth() {
    // E toward the sheet and B down: E × B goes with +x where y > 0 and back where y < 0, a vortex that turns clockwise from above.
    for side in [60.0, -60.0] {
        let at = |x| DVec2::new(x, side);
        let beside = Curve { control: [at(-1.0), at(-0.3), at(0.3), at(1.0)], ..straight(1.0) };
        let mut motion = AuroraMotion::new(even(vec![straight(500.0), beside], 600, 40.0), 0.0);
        let first = motion.layout().starts[1];
        let before = motion.nodes()[first].place;
        motion.step();
        // 37 mV/m in 5e-5 T is 0.74 km/s; Adams' and Bashforth's first step is half as long again.
        let moved = (motion.nodes()[first].place - before).x * side.signum();
        assert!((moved / (0.74 * 1.5 * STEP) - 1.0).abs() < 0.1, "{moved} km");
    }
}

/// A closed curve of four quarters round the origin with a sine of `waves` waves on each.
fn ring(radius: f64, amplitude: f64, waves: f64) -> Vec<Curve> {
    let quarter = |k: u32| {
        let (a, b) = (DVec2::from_angle(0.5 * PI * f64::from(k)), DVec2::from_angle(0.5 * PI * f64::from(k + 1)));
        let control = [a, a + 0.5523 * a.perp(), b - 0.5523 * b.perp(), b].map(|point| point * radius);
        Curve { control, amplitude, waves, phase: 0.0, width: 5.0 }
    };
    (0..4).map(quarter).collect()
}

#[test]
fn waves_of_a_sheet_grow_as_those_of_a_vortex_sheet() {
    // 32 and 104 waves round a ring 2000 km wide, 196 and 60 km long; its grid has cells of 42 km. Two km high: low against their length,
    // and high against what the quarters' Bézier curves, not quite circles, do in these 20 s.
    for waves in [32.0, 104.0] {
        let mut motion = AuroraMotion::new(even(ring(1000.0, 2.0, 0.25 * waves), 1200, 30.0), 0.0);
        // The part of the radius that goes with so many waves, of the nodes in their order: quarter after quarter, evenly.
        let amplitude = |motion: &AuroraMotion| {
            let part = |quarter: usize, window: &[usize]| {
                let last = window[1] - 1 - window[0];
                let angle = |k: usize| 0.5 * PI * waves * (quarter as f64 + k as f64 / last as f64);
                (0..last).map(|k| motion.nodes()[window[0] + k].place.length() * angle(k).sin()).sum::<f64>()
            };
            motion.layout().starts.windows(2).enumerate().map(|(quarter, window)| part(quarter, window)).sum::<f64>()
        };
        let before = amplitude(&motion);
        steps(&mut motion, 40);
        // A wave at rest grows as a hyperbolic cosine.
        let rate = (amplitude(&motion) / before).acosh() / (40.0 * STEP);
        let (k, d, speed) = (waves / 1000.0, motion.thickness(), jump(30.0));
        let thin = 0.5 * k * speed;
        // A sheet of Gaussians of standard deviation d: the integrals over k of exp(−k²d²/2)/k² along and across the sheet, with erfc by
        // quadrature.
        let bell = |j: u32| (-(k * d / 2f64.sqrt() * (f64::from(j) + 0.5) / 1000.0).powi(2)).exp();
        let erfc = 1.0 - (0..1000).map(bell).sum::<f64>() / 1000.0 * k * d * (2.0 / PI).sqrt();
        let (along, across) = (0.5 * k * erfc, (1.0 - (-0.5 * (k * d).powi(2)).exp()) / (d * (2.0 * PI).sqrt()));
        let thick = speed * (along * (along + across)).sqrt();
        // 6 %: on a ring of n waves a thin sheet's grow slower by 1/n, 3 % of the longer ones, and the near field ends at 1/450.
        assert!((rate / thick - 1.0).abs() < 0.06, "{waves} waves grow at {rate} per s, a sheet {d} km thick at {thick}");
        // What is long against the thickness (kd = 0.19) is within 15 % of kU/2; the other's kd is 0.63.
        assert!(waves > 32.0 || (rate / thin - 1.0).abs() < 0.15, "{waves} waves grow at {rate} per s, kU/2 is {thin}");
    }
}

#[test]
fn the_field_is_that_of_all_charges_and_their_images() {
    for curves in [curtains(AuroraShape::Arcs, 3), curtains(AuroraShape::Oval, 3)] {
        let mut motion = AuroraMotion::new(Plan { curves, nodes: 2048, field: 50.0, renewal: 60.0, contrast: 0.7, seed: 3 }, 0.0);
        steps(&mut motion, 60);
        let (centre, side) = motion.square();
        let d = motion.thickness();
        // A grounded frame is mirrors on all sides: the charges' images, with the other sign for each mirror, over and over again.
        let direct = |place: DVec2| {
            let mut field = DVec2::ZERO;
            for charge in motion.charges() {
                let own = charge.place - centre;
                for m in -6i32..=6 {
                    for n in -6i32..=6 {
                        let image = |x: f64, k: i32| f64::from(k) * side + if k % 2 == 0 { x } else { -x };
                        let sign = if (m + n) % 2 == 0 { 1.0 } else { -1.0 };
                        let away = place - centre - DVec2::new(image(own.x, m), image(own.y, n));
                        let square = away.length_squared().max(1e-12);
                        let spread = if m == 0 && n == 0 { 1.0 - (-0.5 * square / (d * d)).exp() } else { 1.0 };
                        field += away * (sign * charge.amount * spread / (2.0 * PI * square));
                    }
                }
            }
            field
        };
        let nodes = motion.nodes();
        let (mut error, mut whole) = (0.0, 0.0);
        for k in 0..24 {
            // On the curves, and up to 300 km beside them.
            let beside = DVec2::from_angle(f64::from(k)) * 300.0 * f64::from(k % 4) / 3.0;
            let place = nodes[nodes.len() * k as usize / 24].place + beside;
            let (got, want) = (motion.field_at(place), direct(place));
            error += got.distance_squared(want);
            whole += want.length_squared();
        }
        // 2 % (root mean square): modes between the grid's points have 1 % of a charge left, the near field ends at 1/450 and takes charges
        // together.
        let relative = (error / whole).sqrt();
        assert!(relative < 0.02, "the field is off by {relative}");
    }
}

/// The greatest angle in degrees between a piece of the curtains and the same piece at rest, and the greatest distance from there, km.
fn folded(motion: &AuroraMotion, rest: &[Node]) -> (f64, f64) {
    let now = motion.nodes();
    let turned =
        pieces(motion).map(|k| (now[k + 1].place - now[k].place).angle_to(rest[k + 1].place - rest[k].place).abs()).fold(0.0, f64::max);
    let moved = now.iter().zip(rest).map(|(a, b)| a.place.distance(b.place)).fold(0.0, f64::max);
    (turned.to_degrees(), moved)
}

#[test]
fn curtains_fold_and_never_run_away() {
    let knot = Curve {
        // Crosses itself.
        control: [DVec2::new(-200.0, 0.0), DVec2::new(400.0, 300.0), DVec2::new(-400.0, 300.0), DVec2::new(200.0, 0.0)],
        amplitude: 12.0,
        waves: 5.0,
        phase: 0.3,
        width: 4.0,
    };
    for (field, renewal) in [(50.0, 60.0), (1e6, 60.0), (500.0, 1000.0), (f64::NAN, 60.0), (50.0, 0.0), (50.0, f64::NAN)] {
        let curves = vec![knot, straight(300.0)];
        let mut motion = AuroraMotion::new(Plan { curves, nodes: 300, field, renewal, contrast: 1.0, seed: 4 }, 0.0);
        let rest = motion.nodes().to_vec();
        for _ in 0..240 {
            motion.step();
            let (_, moved) = folded(&motion, &rest);
            // No farther than the greatest speed takes a node between two surges, which leave a twentieth, and so on: 72 s at most with
            // this field.
            let finite = motion.nodes().iter().all(|node| node.place.is_finite());
            assert!(finite && moved < 72.0 * TOP_SPEED * 1.05, "field {field}: {moved} km");
        }
        assert!((motion.time() - 240.0 * STEP).abs() < 1e-9);
        assert!(motion.nodes().iter().all(|node| (0.0..=2.0).contains(&node.flux)));
        let (turned, moved) = folded(&motion, &rest);
        if field == 50.0 && renewal == 60.0 {
            assert!(moved > 3.0 && turned > 90.0, "{moved} km and {turned}° in two minutes");
        }
    }
}

#[test]
fn curtains_of_a_planet_fold_again_and_again() {
    let config = AuroraConfig::default();
    for (shape, nodes) in [(AuroraShape::Arcs, 1024), (AuroraShape::Oval, 3500)] {
        let (renewal, contrast) = (config.renewal, config.contrast);
        let mut motion = AuroraMotion::new(Plan { renewal, contrast, seed: 3, ..even(curtains(shape, 3), nodes, config.field) }, 0.0);
        let rest = motion.nodes().to_vec();
        let mut over = Vec::new();
        for minute in 1..=4 {
            steps(&mut motion, 120);
            let (turned, moved) = folded(&motion, &rest);
            assert!(turned > 90.0, "minute {minute}: nothing is turned by more than {turned}°");
            // At the drift U, half beside a curtain and half from others, for a renewal time and a surge.
            assert!(moved < 2.0 * jump(config.field) * config.renewal, "minute {minute}: {moved} km from its rest");
            let now = motion.nodes();
            let back = |k: &usize| (now[k + 1].place - now[*k].place).dot(rest[k + 1].place - rest[*k].place) < 0.0;
            let back = pieces(&motion).filter(back).count();
            over.push(back as f64 / now.len() as f64);
        }
        // Pieces that run against their direction at rest: with the grid alone they are 1 to 3 in 100, where surges push a curtain
        // together.
        let mean = over[1..].iter().sum::<f64>() / 3.0;
        assert!(mean > 0.05, "{over:?} of the pieces run back");
    }
}

#[test]
fn brightness_goes_round_an_oval_without_a_seam() {
    let plan = Plan { curves: ring(2300.0, 20.0, 5.0), nodes: 3000, field: 50.0, renewal: 60.0, contrast: 1.0, seed: 3 };
    let mut motion = AuroraMotion::new(plan, 100.0);
    motion.step();
    let nodes = motion.nodes();
    for (quarter, window) in motion.layout().starts.windows(2).enumerate() {
        let (end, next) = (nodes[window[1] - 1], nodes[motion.layout().starts[(quarter + 1) % 4]]);
        assert!((end.flux - next.flux).abs() < 1e-9 && end.place.distance(next.place) < 1e-6, "{end:?} and {next:?} are one place");
        let jump = (end.along - next.along) / RAYS_LENGTH;
        assert!((jump - jump.round()).abs() < 1e-9, "the rays jump from {} to {} km", end.along, next.along);
        assert!(nodes[window[0]..window[1]].iter().all(|node| node.flux <= 2.0));
    }
    // A kilometre is one as on any other curtain, but for the whole number of periods round the ring.
    let scale = (nodes[101].along - nodes[100].along) / nodes[101].place.distance(nodes[100].place);
    assert!((scale - 1.0).abs() < 0.15, "{scale} km for one");
}

/// However short a surge is beside a step, each node gets what a period should give it: without a field, e⁻³ of the way from where it rests
/// is left.
#[test]
fn short_surges_come_to_as_much_as_long_ones() {
    for renewal in [1.0, 1.5, 2.0, 6.0] {
        let mut motion = AuroraMotion::new(Plan { contrast: 1.0, seed: 4, ..even(vec![straight(500.0)], 300, 100.0) }, 0.0);
        let rest = motion.nodes().to_vec();
        steps(&mut motion, 20);
        motion.change(0.0, renewal, 1.0);
        // A step still goes on with half of the speed before it.
        steps(&mut motion, 2);
        let away =
            |motion: &AuroraMotion| motion.nodes().iter().zip(&rest).map(|(now, rest)| now.place.distance(rest.place)).collect::<Vec<_>>();
        let before = away(&motion);
        steps(&mut motion, 12);
        let periods = 12.0 * STEP / renewal;
        for (before, after) in before.iter().zip(away(&motion)).filter(|(before, _)| **before > 1e-3) {
            let left = (after / before).ln() / (-3.0 * periods);
            assert!((left - 1.0).abs() < 1e-3, "renewal {renewal} s: {left} of what should come");
        }
    }
}
