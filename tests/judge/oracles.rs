//! The judge of light against published and independently computed numbers, and against its own conservation laws.
//!
//! Oracle rows: `E` is the photon's conserved energy; static angles are turned into the rain frame here, by the boost of speed β.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use lensrunner::judge::shoot::{shoot, shoot_sky};
use lensrunner::judge::{End, EnergySign, RayFate, Stop, TracedRay, fate};

use crate::spacetime::oracles::{DEFLECTIONS, FLASHES, JOINED, SHADOWS_FALLING, SHADOWS_HOVERING};

/// Rounding rules.
const FINE: f64 = 1e-17;

/// ψ in the static frame of a camera at `l`, from ψ in the rain frame: the static observer moves outwards at β through the rain.
fn static_angle(psi_rain: f64, l: f64) -> f64 {
    let beta = 1.0 / l.sqrt();
    let (sine, cosine) = psi_rain.sin_cos();
    ((1.0 - beta * beta).sqrt() * sine).atan2(cosine + beta)
}

/// The inverse.
fn rain_angle(psi_static: f64, l: f64) -> f64 {
    let beta = 1.0 / l.sqrt();
    let (sine, cosine) = psi_static.sin_cos();
    ((1.0 - beta * beta).sqrt() * sine).atan2(cosine - beta)
}

/// T − t, the Painlevé–Gullstrand clock ahead of the Schwarzschild clock, outside.
fn clock_offset(r: f64) -> f64 {
    2.0 * r.sqrt() + ((r.sqrt() - 1.0) / (r.sqrt() + 1.0)).ln()
}

/// In the rain frame at radius `l`, the look direction of the light with impact parameter `b` that moves inwards (followed backwards).
fn look_for(b: f64, l: f64, inwards: bool) -> DVec2 {
    // In components: an angle near π would lose the digits of b.
    let redshift = (1.0 - 1.0 / l).sqrt();
    let sine = b / l * redshift;
    let cosine = (1.0 - sine * sine).sqrt() * if inwards { -1.0 } else { 1.0 };
    let beta = 1.0 / l.sqrt();
    DVec2::new(cosine - beta, redshift * sine) / (1.0 - beta * cosine)
}

/// The total deflection of light with impact parameter `b` (r_s) from infinity to infinity.
fn deflection(b: f64) -> f64 {
    // From a camera at l, backwards inwards, the ray sweeps Φ∞; forwards outwards (by time reversal, that is the other way along the same
    // orbit) it sweeps what a ray with the mirrored look direction sweeps. Both start in the same place, so Φ∞ + Φ∞' = π + α.
    let l = 10.0 * b.max(3.0);
    let sky = |inwards| {
        let look = look_for(b, l, inwards);
        match fate(DVec3::X * l, DVec3::new(look.x, look.y, 0.0), FINE) {
            RayFate::Escaped { swept, .. } => swept,
            RayFate::Captured => f64::NAN,
        }
    };
    sky(true) + sky(false) - PI
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "found {found:.15}, expected {expected:.15}, off by {:.2e}", found - expected);
}

#[test]
fn deflection_after_darwin() {
    for (approach, expected) in DEFLECTIONS {
        let b = (approach.powi(3) / (approach - 2.0)).sqrt() / 2.0;
        // Rounding of b near b_c is amplified by dα/db = 1/(b − b_c).
        let amplified = 2e-15 / (b - 1.5 * 3f64.sqrt());
        close(deflection(b), expected, 1e-11 + amplified);
    }
    // Impact parameter b in the same units.
    #[rustfmt::skip]
    let by_impact: [(f64, f64); 10] = [
        (5.2, 6.8103719566635), (5.25, 4.19479970823466), (5.5, 2.55302018234534), (6.0, 1.71938831023017), (8.0, 0.858730018079095),
        (10.0, 0.590395787605827), (20.0, 0.23613599538847), (50.0, 0.0850834503832475), (100.0, 0.0412225397492737),
        (1000.0, 0.00401182380992536),
    ];
    for (impact, expected) in by_impact {
        close(deflection(impact / 2.0), expected, 1e-10);
    }
}

#[test]
fn deflection_near_the_critical_ray() {
    // α = nπ/2 at these impact parameters (units of M).
    for (impact, alpha) in [
        (5.35695863074179, PI),
        (5.20268040281046, TAU),
        (5.19643350110572, 3.0 * PI),
        (5.19616456675938, 4.0 * PI),
        (5.2279386085338, 1.5 * PI),
    ] {
        // The table has 15 digits: 5e-15, amplified by dα/db.
        let amplified = 1e-14 / (impact - 27f64.sqrt());
        close(deflection(impact / 2.0), alpha, 1e-11 + amplified);
    }
}

#[test]
fn shadow_edge_of_a_falling_camera() {
    let captured = |l: f64, degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        fate(DVec3::Y * l, DVec3::new(sine, -cosine, 0.0), FINE) == RayFate::Captured
    };
    for (l, edge) in SHADOWS_FALLING {
        assert!(captured(l, edge - 1e-9), "L = {l}");
        assert!(!captured(l, edge + 1e-9), "L = {l}");
        assert!(captured(l, 0.0) && !captured(l, 180.0));
    }
}

#[test]
fn shadow_edge_of_a_hovering_camera() {
    let captured = |l: f64, degrees: f64| {
        let psi = rain_angle(PI - degrees.to_radians(), l);
        fate(DVec3::X * l, DVec3::new(psi.cos(), psi.sin(), 0.0), FINE) == RayFate::Captured
    };
    for (l, edge) in SHADOWS_HOVERING {
        assert!(captured(l, edge - 2e-9), "L = {l}");
        assert!(!captured(l, edge + 2e-9), "L = {l}");
    }
}

#[test]
fn points_seen_by_a_hovering_camera() {
    for (r, degrees, l, psi, _, time) in JOINED {
        let swept = f64::to_radians(degrees);
        let (order, phi) = if swept > PI { (2, TAU - swept) } else { (1, swept) };
        let seen = shoot(r, phi, l, order, EnergySign::Plus, FINE).unwrap();
        close(static_angle(seen.psi_rain, l), psi, 2e-13);
        // The table has 13 digits.
        close(seen.delay - clock_offset(l) + clock_offset(r), time, 1e-8f64.min(1e-12 * time + 6e-11).max(time * 5e-12));
    }
}

#[test]
fn a_camera_sees_its_own_flash_as_rings() {
    for (turns, (degrees, closest, trip)) in (1..).zip(FLASHES) {
        // A flash at the camera's own place, `turns` times around: order 2·turns with φ = 0.
        let seen = shoot(10.0, 0.0, 10.0, 2 * turns, EnergySign::Plus, FINE).unwrap();
        close(180.0 - static_angle(seen.psi_rain, 10.0).to_degrees(), degrees, 1e-10);
        close(seen.delay, trip, 2e-10);
        let look = DVec3::new(seen.psi_rain.cos(), seen.psi_rain.sin(), 0.0);
        let ray = TracedRay::trace(DVec3::X * 10.0, look, FINE, &Stop::default());
        let middle = ray.at_swept(f64::from(turns) * PI).unwrap();
        close(middle.position.length(), closest, 1e-9);
    }
}

#[test]
fn energy_and_angular_momentum_are_kept() {
    for l in [0.05, 0.7, 0.999, 1.001, 1.4, 1.6, 30.0, 4000.0] {
        for i in 0..24 {
            let psi = PI * (f64::from(i) + 0.5) / 24.0;
            let stop = Stop { radius: 1e4, ..Stop::default() };
            let ray = TracedRay::trace_in_plane(l, DVec2::new(psi.cos(), psi.sin()), FINE, &stop);
            let first = ray.segments[0].at(0.0);
            let (energy, spin) = (first.energy(), first.angular_momentum());
            assert_ne!(ray.end, End::Steps);
            let mut size = 1.0f64;
            for segment in &ray.segments {
                for part in [0.0, 0.3, 0.7, 1.0] {
                    let state = segment.at(part * segment.length);
                    // E is a difference of terms of size |p|, L a product of size r|p|, and where a ray clings to the horizon |p| has no
                    // bound.
                    size = size.max(state.momentum.length());
                    close(state.energy(), energy, 1e-13 * size * (1.0 + 1.0 / l.sqrt()));
                    close(state.angular_momentum(), spin, 1e-14 * size * state.position.length().max(1.0));
                }
            }
        }
    }
}

#[test]
fn halving_the_tolerance_converges() {
    // The error stays under a fixed multiple of the tolerance all the way to rounding, on a ray that winds around the photon sphere.
    let look = look_for(0.5 * 5.2279386085338, 8.0, true);
    let sky = |tolerance: f64| {
        let ray = TracedRay::trace_in_plane(8.0, look, tolerance, &Stop { radius: 60.0, ..Stop::default() });
        ray.sky_swept().unwrap()
    };
    let exact = sky(1e-18);
    let mut tolerance = 1e-4;
    while tolerance > 1e-15 {
        // The instability multiplies an early error by about e^{3π/2 + π}.
        close(sky(tolerance), exact, 2000.0 * tolerance + 1e-11);
        tolerance *= 0.5;
    }
    // And the tolerance is not met by being always exact.
    assert!((sky(1e-4) - exact).abs() > 1e-8);
}

#[test]
fn the_same_ray_in_space_and_in_its_plane() {
    let position = DVec3::new(3.0, -4.0, 12.0);
    let look = DVec3::new(-0.4, 0.3, -1.0);
    let ray = TracedRay::trace(position, look, FINE, &Stop::default());
    let normal = position.cross(look).normalize();
    assert!(ray.at_delay(-1.0).is_none() && ray.at_swept(100.0).is_none());
    for i in 0..50 {
        let delay = ray.last_delay() * f64::from(i) / 50.0;
        let sample = ray.at_delay(delay).unwrap();
        close(sample.position.dot(normal), 0.0, 1e-11);
        let again = ray.at_swept(sample.swept).unwrap();
        if sample.swept > 0.0 {
            close(again.delay, delay, 1e-9);
        }
    }
    // It starts at the camera, along the look: dx/dτ = look + βn.
    let early = ray.at_delay(1e-6).unwrap();
    let rate = (early.position - position) / 1e-6;
    let expected = look.normalize() + position.normalize() / 13f64.sqrt();
    assert!((rate - expected).length() < 1e-6);
}

#[test]
fn radial_light() {
    // Backwards outwards dr/dτ = 1 + β, inwards −(1 − β): delays in closed form. From 4 to 9 and from 9 to 4.
    let out = |r: f64| r - 2.0 * r.sqrt() + 2.0 * (1.0 + r.sqrt()).ln();
    let back = |r: f64| r + 2.0 * r.sqrt() + 2.0 * (r.sqrt() - 1.0).abs().ln();
    let seen = |r, l, branch| shoot(r, 0.0, l, 1, branch, FINE).unwrap();
    close(seen(9.0, 4.0, EnergySign::Plus).delay, out(9.0) - out(4.0), 1e-13);
    close(seen(4.0, 9.0, EnergySign::Plus).delay, back(9.0) - back(4.0), 1e-13);
    close(seen(1.001, 9.0, EnergySign::Plus).delay, back(9.0) - back(1.001), 1e-11);
    // Through the horizon, and below it on both branches.
    close(seen(5.0, 0.2, EnergySign::Plus).delay, out(5.0) - out(0.2), 1e-13);
    close(seen(0.8, 0.2, EnergySign::Plus).delay, out(0.8) - out(0.2), 1e-13);
    close(seen(0.8, 0.2, EnergySign::Minus).delay, back(0.2) - back(0.8), 1e-13);
    assert_eq!(seen(0.8, 0.2, EnergySign::Minus).psi_rain, PI);
    assert_eq!(seen(0.8, 0.2, EnergySign::Plus).psi_rain, 0.0);
}

#[test]
fn what_is_seen_from_below_the_horizon() {
    for l in [0.1f64, 0.5, 0.9] {
        for r in [0.3f64, 0.7, 0.95, 0.999] {
            for phi in [0.2f64, 1.0, 2.0, 3.0] {
                let visible = r > l && phi < (1.0 - 2.0 * r).acos() - (1.0 - 2.0 * l).acos();
                let plus = shoot(r, phi, l, 1, EnergySign::Plus, FINE);
                let minus = shoot(r, phi, l, 1, EnergySign::Minus, FINE);
                assert_eq!(plus.is_some(), visible, "L {l} r {r} phi {phi}");
                assert_eq!(minus.is_some(), visible, "L {l} r {r} phi {phi}");
                assert!(shoot(r, phi, l, 2, EnergySign::Plus, FINE).is_none());
                if let (Some(plus), Some(minus)) = (plus, minus) {
                    assert!(plus.energy > 0.0 && minus.energy < 0.0);
                    assert!(plus.delay > 0.0 && minus.delay > plus.delay);
                    // E² = b²-term: the same orbit up to the sign of E.
                    close(plus.angular_momentum / plus.energy, -minus.angular_momentum / minus.energy, 1e-9 / minus.energy.abs().min(1.0));
                }
            }
        }
        // Above r = 1 everything is seen once in every order, and later in each.
        for r in [1.001, 1.01, 1.5, 40.0] {
            for phi in [0.3, 2.0, PI] {
                let mut before = 0.0;
                for order in 1..=3 {
                    let seen =
                        shoot(r, phi, l, order, EnergySign::Plus, FINE).unwrap_or_else(|| panic!("L {l} r {r} phi {phi} order {order}"));
                    assert!(seen.delay >= before - 1e-9 && seen.energy > 0.0);
                    before = seen.delay;
                }
                assert!(shoot(r, phi, l, 1, EnergySign::Minus, FINE).is_none());
            }
        }
    }
    // From outside nothing at or below the horizon is seen.
    assert!(shoot(1.0, 0.3, 2.0, 1, EnergySign::Plus, FINE).is_none());
    assert!(shoot(0.5, 0.3, 2.0, 1, EnergySign::Plus, FINE).is_none());
}

#[test]
fn the_sky_is_the_limit_of_far_points() {
    for l in [0.3, 1.02, 1.5, 10.0] {
        for phi in [0.1, 1.5, 3.0] {
            for order in 1..=3 {
                let sky = shoot_sky(phi, l, order, FINE).unwrap();
                let far = shoot(1e8, phi, l, order, EnergySign::Plus, FINE).unwrap();
                close(far.psi_rain, sky.psi_rain, 3e-7);
                let look = DVec3::new(sky.psi_rain.cos(), sky.psi_rain.sin(), 0.0);
                let RayFate::Escaped { swept, .. } = fate(DVec3::X * l, look, FINE) else { panic!("the sky is in the shadow") };
                close(swept, lensrunner::judge::shoot::swept_angle(order, phi), 1e-7);
            }
        }
    }
}
