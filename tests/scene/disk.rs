//! The gas of the disk against published values and against what it must keep.

use std::f64::consts::TAU;

use glam::DVec3;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::arcs::Arcs;
use lensrunner::scene::disk::radial::{Radial, page_thorne_flux};
use lensrunner::scene::disk::{Gas, generations, slant};

fn gas() -> Gas {
    Gas::new(&GameConfig::default().disk, 1e10)
}

/// F·M²/Ṁ at r/M, from the integral form of Page & Thorne 1974 by quadrature.
#[test]
fn the_flux_is_page_and_thornes() {
    for (x, want) in [
        (6.5, 2.36305761e-6),
        (7.0, 6.11501027e-6),
        (8.0, 1.144749107e-5),
        (10.0, 1.356875464e-5),
        (15.0, 8.33736209e-6),
        (20.0, 4.725144066e-6),
        (30.0, 1.854943167e-6),
        (50.0, 5.068679512e-7),
        (100.0, 7.785853592e-8),
    ] {
        let got = page_thorne_flux(x);
        assert!((got / want - 1.0).abs() < 2e-9, "F({x}) is {got:e}, must be {want:e}");
    }
    assert_eq!(page_thorne_flux(6.0), 0.0);
}

/// Outside its innermost quarter r_s the temperature is the flux's fourth root; at 10¹⁰ suns and a tenth of Eddington's rate the hottest
/// ring has 22,220 K (by hand: F = 1.3678e-5 Ṁc⁸/(GM)² with Ṁ = 2.45e24 kg/s).
#[test]
fn temperature_goes_as_the_fourth_root_of_the_flux() {
    let mut disk = GameConfig::default().disk;
    disk.accretion_rate = 0.1;
    let radial = Radial::new(&disk, 1e10);
    let peak = radial.temperature(0.5 * 9.550928);
    assert!((peak / 22_220.0 - 1.0).abs() < 5e-3, "the hottest ring has {peak} K");
    for r in [3.3, 4.0, 6.0, 11.0] {
        let want = peak * (page_thorne_flux(2.0 * r) / 1.367811e-5).powf(0.25);
        let got = radial.temperature(r);
        assert!((got / want - 1.0).abs() < 1e-4, "T({r}) is {got}, must be {want}");
    }
    // The hole is ten times heavier at the same rate in Eddington's units: T falls as M^(−1/4).
    let heavier = Radial::new(&disk, 1e11).temperature(5.0) / radial.temperature(5.0);
    assert!((heavier - 0.1f64.powf(0.25)).abs() < 1e-9);
}

/// Orbits: the energy per mass γ − βp_r is (r − 1)/√(r(r − 3/2)), the angular momentum r/√(2r − 3); falling gas keeps both from r = 3.
#[test]
fn gas_moves_on_geodesics() {
    let gas = gas();
    for r in [1.3, 1.8, 2.4, 2.95, 3.0, 3.5, 6.0, 11.0] {
        let azimuth = 0.7f64;
        let position = DVec3::new(r * azimuth.cos(), r * azimuth.sin(), 0.0);
        let p = gas.momentum(position);
        let energy = (1.0 + p.length_squared()).sqrt() - p.dot(position) / (r * f64::sqrt(r));
        let angular = position.cross(p).z;
        let at = f64::max(r, 3.0);
        let (want_energy, want_angular) = ((at - 1.0) / (at * (at - 1.5)).sqrt(), at / (2.0 * at - 3.0).sqrt());
        assert!((energy - want_energy).abs() < 1e-12, "E at {r} is {energy}, must be {want_energy}");
        assert!((angular - want_angular).abs() < 1e-12, "L at {r} is {angular}, must be {want_angular}");
        // dr/dτ = p_r − βγ.
        let fall = p.dot(position) / r - (1.0 + p.length_squared()).sqrt() / f64::sqrt(r);
        let want = if r < 3.0 { -(3.0 / r - 1.0f64).powf(1.5) / 3.0 } else { 0.0 };
        assert!((fall - want).abs() < 1e-12, "dr/dτ at {r} is {fall}, must be {want}");
    }
}

/// A knot keeps its azimuth on the orbit, φ₀ + Ω(r)T, while its generation is the one seen: the pattern there does not change but for
/// shares.
#[test]
fn streaks_move_with_the_orbits() {
    let gas = gas();
    // In the middle of a renewal the younger generation alone is seen.
    let at = |r: f64, azimuth: f64, time: f64| gas.turbulence(r, azimuth, time);
    for r in [3.2, 5.0, 9.0] {
        let rate = 1.0 / (2.0f64 * r * r * r).sqrt();
        let start = 40.0 - 1e-3;
        let (mut moved, mut stood) = (0.0f64, 0.0f64);
        for k in 0..200 {
            let azimuth = TAU * f64::from(k) / 200.0;
            let before = at(r, azimuth, start);
            moved = moved.max((at(r, azimuth + rate * 2e-3, start + 2e-3) - before).abs());
            stood = stood.max((at(r, azimuth, start + 0.5) - before).abs());
        }
        assert!(moved < 1e-2, "r = {r}: along the orbit the pattern changed by {moved}");
        assert!(stood > 0.02, "r = {r}: the pattern does not move");
    }
}

/// No pop: in a hundredth of r_s/c nothing changes by more than a small part, at any time; no repeat: the pattern of one renewal is not
/// like that of another; no winding up: it is as smooth over the radius late as early.
#[test]
fn streaks_renew_themselves_without_a_trace() {
    let gas = gas();
    let ring = |time: f64| -> Vec<f64> { (0..256).map(|k| gas.turbulence(4.0, TAU * f64::from(k) / 256.0, time)).collect() };
    let mut worst = 0.0f64;
    for k in 0..400 {
        let time = 0.5 * f64::from(k) - 0.005;
        let (a, b) = (ring(time), ring(time + 0.01));
        worst = worst.max(a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
    }
    // Ω(4) = 0.088: a hundredth moves the pattern by 9e-4 rad, a seventh of a cell of the lattice and, eight times finer, of a whole cell.
    assert!(worst < 0.5, "something jumps by {worst}");
    let correlation = |a: &[f64], b: &[f64]| {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
    };
    // The whole disk: one ring alone has few knots, and two of forty may well resemble one another.
    let whole = |time: f64| -> Vec<f64> {
        let places = (0..1024).map(|k| (3.0 + 0.25 * f64::from(k / 64), TAU * f64::from(k % 64) / 64.0));
        places.map(|(r, azimuth)| gas.turbulence(r, azimuth, time)).collect()
    };
    let first = whole(100.0);
    let most = (1..40).map(|k| correlation(&first, &whole(100.0 + 80.0 * f64::from(k))).abs()).fold(0.0, f64::max);
    assert!(most < 0.6, "two renewals look alike: {most}");
    let roughness = |time: f64| -> f64 {
        (0..400)
            .map(|k| {
                (gas.turbulence(3.5 + 0.002 * f64::from(k), 1.0, time) - gas.turbulence(3.502 + 0.002 * f64::from(k), 1.0, time)).powi(2)
            })
            .sum()
    };
    let (early, late) = (roughness(95.0), roughness(100_015.0));
    assert!(late < 4.0 * early, "wound up: {early} early, {late} late");
    let [young, old] = generations(57.0);
    assert!((young.weight.powi(2) + old.weight.powi(2) - 1.0).abs() < 1e-12 && old.age - young.age == 40.0);
}

/// From far the opacity face on is what `game.toml` says; a camera in the disk sees none of it begin or end at once.
#[test]
fn opacity_is_as_asked_and_never_jumps() {
    let mut disk = GameConfig::default().disk;
    disk.turbulence = 0.0;
    let gas = Gas::new(&disk, 1e10);
    let there = gas.emission(6.0, 1.0, 0.0);
    assert!((there.opacity(1.0, 100.0) - disk.opacity).abs() < 1e-12);
    assert!(there.opacity(0.1, 100.0) > there.opacity(1.0, 100.0));
    // Going through the plane: the light path to the crossing under one's feet goes to zero.
    let through = [1e-1, 1e-2, 1e-3, 0.0].map(|path| slant(1.0, path, there.half_height));
    assert!(through.windows(2).all(|pair| pair[1] <= pair[0]) && through[3] == 0.0, "{through:?}");
}

/// The count of arcs, their order, and that they cover the disk without a gap, or with the one asked for.
#[test]
fn arcs_cover_the_disk() {
    let mut disk = GameConfig::default().disk;
    for (arcs, width) in [(570, 0.43), (1_100, 0.31), (4_200, 0.16), (17_000, 0.08)] {
        disk.arcs = arcs;
        disk.width = width;
        let layout = Arcs::new(&disk, &Radial::new(&disk, 1e10));
        let count = layout.count() as f64;
        assert!((count / f64::from(arcs) - 1.0).abs() < 0.05, "{count} arcs instead of {arcs}");
        assert!(layout.circles.windows(2).all(|pair| pair[0] < pair[1]) && layout.cuts.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((layout.cuts[0], *layout.cuts.last().unwrap()), (0.0, TAU));
        assert!(layout.rings.windows(2).all(|pair| pair[0][1] == pair[1][0]));
    }
    disk.gap = 0.25;
    let layout = Arcs::new(&disk, &Radial::new(&disk, 1e10));
    let covered: f64 = layout.rings.iter().map(|[a, b]| layout.circles[*b as usize] - layout.circles[*a as usize]).sum();
    let [start, end] = gas().extent();
    assert!((covered / (end - start) - 0.75).abs() < 1e-9);
}

/// Matter falls in at an even rate, so the whole disk is as bright at one time as at another: no ring of the pattern is brighter all round
/// than the next one. What is left is chance: where two generations have their largest knots in the same places, or one where the other has
/// none (0.88 to 1.06 of the mean).
#[test]
fn the_whole_disk_keeps_its_light() {
    let gas = gas();
    let [start, end] = gas.extent();
    let light = |time: f64| {
        let mut sum = 0.0;
        for i in 0..200 {
            let r = start + (end - start) * (f64::from(i) + 0.5) / 200.0;
            for k in 0..256 {
                let emission = gas.emission(r, TAU * (f64::from(k) + 0.5) / 256.0, time);
                // Wien's law at 550 nm.
                sum += r * (-26_160.0 / emission.temperature).exp() * emission.opacity(1.0, 100.0);
            }
        }
        sum
    };
    let lights: Vec<f64> = (0..60).map(|k| light(10.0 * f64::from(k))).collect();
    let (least, most) = lights.iter().fold((f64::MAX, 0.0f64), |(a, b), &l| (a.min(l), b.max(l)));
    let mean = lights.iter().sum::<f64>() / lights.len() as f64;
    println!("least {:.3}, most {:.3} of the mean", least / mean, most / mean);
    assert!(least > 0.85 * mean && most < 1.10 * mean);
}
