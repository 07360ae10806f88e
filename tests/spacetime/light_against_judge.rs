//! The closed form of light against the judge, on seeded random points, the awkward ones among them.

use std::f64::consts::PI;

use lensrunner::judge::{shoot, shoot::swept_angle, shoot_sky};
use lensrunner::spacetime::light;
use rand::{RngExt, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// Points in each group.
const COUNT: usize = 300;

/// Radians for directions; relative to 1 + delay for delays. What rounding of 1/r and 1/L makes of a point at 1e-4 L is 1e-12.
const TOLERANCE: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
struct Point {
    r: f64,
    phi: f64,
    camera: f64,
}

fn log_uniform(rng: &mut StdRng, from: f64, to: f64) -> f64 {
    rng.random_range(from.ln()..to.ln()).exp()
}

/// φ: half uniform, half clustered at 0 and π down to 1e-5.
fn angle(rng: &mut StdRng) -> f64 {
    let near = log_uniform(rng, 1e-5, 1.0);
    match rng.random_range(0..4) {
        0 => near,
        1 => PI - near,
        _ => rng.random_range(0.0..PI),
    }
}

/// L: log-uniform over 0.05 to 5000, a third in [0.95, 1.6]; on the asked side of the horizon.
fn camera(rng: &mut StdRng, outside: bool) -> f64 {
    loop {
        let camera = if rng.random_range(0..3) == 0 { rng.random_range(0.95..1.6) } else { log_uniform(rng, 0.05, 5000.0) };
        if (camera > 1.0) == outside {
            return camera;
        }
    }
}

/// r: half log-uniform over 1.0005 to 1e4, half clustered around L down to 1e-4 of it.
fn point(rng: &mut StdRng, outside: bool) -> Point {
    let camera = camera(rng, outside);
    let r = if rng.random() {
        log_uniform(rng, 1.0005, 1e4)
    } else {
        let apart = log_uniform(rng, 1e-4, 1.0);
        if rng.random() { camera * (1.0 + apart) } else { camera / (1.0 + apart) }
    };
    Point { r, phi: angle(rng), camera }
}

/// The largest disagreements of a group, in ψ, delay, and the slope of the ray where it leaves the point.
fn compare(points: Vec<Point>, order: u32, branch: light::Branch) -> usize {
    let judged_branch = match branch {
        light::Branch::Plus => lensrunner::judge::EnergySign::Plus,
        light::Branch::Minus => lensrunner::judge::EnergySign::Minus,
    };
    let judged: Vec<_> = points
        .par_iter()
        .map(|&p| {
            let exact = light::connect(1.0 / p.r, swept_angle(order, p.phi), 1.0 / p.camera, branch);
            (p, exact, shoot(p.r, p.phi, p.camera, order, judged_branch, 1e-17))
        })
        .collect();
    let mut seen = 0;
    let mut wrong = Vec::new();
    for (p, exact, judge) in judged {
        let (exact, judge) = match (exact, judge) {
            (None, None) => continue,
            (Some(exact), Some(judge)) => (exact, judge),
            other => {
                wrong.push(format!("{p:?} order {order} {branch:?}: {other:?}"));
                continue;
            }
        };
        seen += 1;
        let psi = light::rain_angle(exact.slope, exact.energy, 1.0 / p.camera) - judge.psi_rain;
        let delay = (exact.delay - judge.delay) / (1.0 + judge.delay);
        // du/dΦ where the light leaves: −u (dr/dτ)/(r dΦ/dτ), from the judge's momentum there.
        let u = 1.0 / p.r;
        let slope = -u * (judge.emission.length() * u.sqrt() - judge.emission.x) / -judge.emission.y;
        let slope = (exact.emission_slope - slope) / (exact.emission_slope.abs() + u);
        let size = psi.abs().max(delay.abs());
        // NaN must fail too. The slope of a nearly radial ray is 1/φ, so its rounding is worth more.
        if !(size <= TOLERANCE && slope.abs() <= 1e-7) {
            wrong.push(format!(
                "{p:?} order {order} {branch:?}: psi off {psi:.2e}, delay off {delay:.2e} (of 1 + delay), slope off {slope:.2e}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {seen} disagree:\n{}", wrong.len(), wrong.join("\n"));
    seen
}

#[test]
fn outside() {
    let mut rng = StdRng::seed_from_u64(11);
    for order in 1..=3 {
        let points = (0..COUNT).map(|_| point(&mut rng, true)).collect();
        assert!(compare(points, order, light::Branch::Plus) > COUNT / 2);
    }
}

#[test]
fn inside() {
    let mut rng = StdRng::seed_from_u64(12);
    for order in 1..=3 {
        let points = (0..COUNT).map(|_| point(&mut rng, false)).collect();
        assert!(compare(points, order, light::Branch::Plus) > COUNT / 4);
    }
}

#[test]
fn both_inside() {
    let mut rng = StdRng::seed_from_u64(13);
    for branch in [light::Branch::Plus, light::Branch::Minus] {
        let points = (0..COUNT)
            .map(|_| {
                let camera = log_uniform(&mut rng, 0.05, 0.999);
                let r = rng.random_range(camera..1.0);
                let limit = (1.0 - 2.0 * r).acos() - (1.0 - 2.0 * camera).acos();
                // Half of them close to the end of what is seen, where E is nearly zero; some beyond it.
                let part = if rng.random() { rng.random_range(0.0..1.1) } else { 1.0 - log_uniform(&mut rng, 1e-3, 1.0) };
                Point { r, phi: (part * limit).min(PI), camera }
            })
            .filter(|p| p.phi > 0.0)
            .collect();
        assert!(compare(points, 1, branch) > COUNT / 2);
    }
}

#[test]
fn the_sky() {
    let mut rng = StdRng::seed_from_u64(14);
    let points: Vec<_> = (0..2 * COUNT).map(|i| (1 + i as u32 % 3, angle(&mut rng), camera(&mut rng, i % 2 == 0))).collect();
    points.par_iter().for_each(|&(order, phi, camera)| {
        let exact = light::connect(0.0, swept_angle(order, phi), 1.0 / camera, light::Branch::Plus).unwrap();
        let judge = shoot_sky(phi, camera, order, 1e-17).unwrap();
        let psi = light::rain_angle(exact.slope, exact.energy, 1.0 / camera);
        assert!((psi - judge.psi_rain).abs() <= TOLERANCE, "phi {phi} L {camera} order {order}: {psi} and {}", judge.psi_rain);
        assert!(exact.delay.is_infinite());
    });
}

#[test]
fn the_shadow() {
    use glam::DVec3;
    let mut rng = StdRng::seed_from_u64(15);
    for i in 0..COUNT {
        let camera = camera(&mut rng, i % 2 == 0);
        // The shadow is the cone from this angle to π; both sides of its edge, and anywhere.
        let edge = light::shadow_angle(1.0 / camera);
        let apart = log_uniform(&mut rng, 1e-9, 1e-3);
        for psi in [edge - apart * (PI - edge), edge + apart * (PI - edge), rng.random_range(0.0..PI)] {
            let look = DVec3::new(f64::cos(psi), f64::sin(psi), 0.0);
            let exact = light::sky_angle(psi, 1.0 / camera);
            match (exact, lensrunner::judge::fate(DVec3::X * camera, look, 1e-17)) {
                (None, lensrunner::judge::RayFate::Captured) => {}
                (Some(exact), lensrunner::judge::RayFate::Escaped { swept, .. }) => {
                    // Near the edge the swept angle is a logarithm of the distance from it, and ψ itself has been rounded.
                    let rounding = 1e-14 / (psi - edge).abs() * (PI / (PI - edge));
                    assert!((exact - swept).abs() <= TOLERANCE + rounding, "L {camera} psi {psi}: {exact} and {swept}");
                }
                other => panic!("L {camera} psi {psi} (edge {edge}): {other:?}"),
            }
        }
    }
}
