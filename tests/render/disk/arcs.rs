//! The drawn disk against the exact one: where it is seen and how it is shifted. Its pictures are in `lab/tests/disk/pictures.rs`.

use lensrunner::spacetime::Observer;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::disk::arcs::ArcPass;
use lensrunner::render::disk::sigma::{bearing, sigma};
use lensrunner::render::disk::types::DiskVertex;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::scene::disk::{Gas, shares, slant};
use lensrunner::spacetime::light::{self, Branch, Order};

use crate::gpu::GPU;
use crate::render::support::{a_disk, camera, renderer, settings};
use crate::twin::run;

/// Seen vertices of the grid, with their circle, azimuth and order; and the indices of all triangles.
struct Drawn {
    grid: Vec<(DiskVertex, f64, f64, u32)>,
    all: Vec<DiskVertex>,
    triangles: Vec<[u32; 3]>,
}

fn drawn(renderer: &mut Renderer, disk: &DrawnDisk, camera: Observer) -> Drawn {
    renderer.set_disk(Some(disk.clone()));
    let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
    renderer.picture(&input, false).unwrap();
    let slice = lensrunner::lensing::Slice::new(renderer.table(), camera.radius());
    let view = lensrunner::render::disk::view::DiskView::new(disk, &input, &slice, renderer.size()[0]);
    let passes = renderer.disk().unwrap().arcs();
    let bytes = readback::buffer(&GPU, passes.seen()).unwrap();
    // A buffer that grew has room to spare.
    let whole = bytes.len() / size_of::<DiskVertex>() * size_of::<DiskVertex>();
    let all: Vec<DiskVertex> = bytemuck::cast_slice(&bytes[..whole]).to_vec();
    let origin = camera.position.y.atan2(camera.position.x);
    let columns = view.frame.columns as usize;
    let mut grid = Vec::new();
    for (row, circle) in view.circles.iter().enumerate() {
        for column in (0..columns).step_by(2) {
            let azimuth = bearing(f64::from(view.cuts[column / 2]), f64::from(view.frame.steepness))[0] + origin;
            grid.push((all[row * columns + column], f64::from(circle.gas.radius), azimuth, circle.order));
        }
    }
    let counters = renderer.disk_counters().unwrap().unwrap();
    assert_eq!((counters.coarse, counters.caught), (0, 0));
    let bytes = readback::buffer(&GPU, renderer.disk().unwrap().arcs().indices()).unwrap();
    let indices: &[u32] = bytemuck::cast_slice(&bytes);
    // Those of order 1, near and beyond.
    let lists = [0, 3].map(|list| &indices[ArcPass::lists()[list] as usize..][..counters.indices[list] as usize]);
    let triangles = lists.concat().chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Drawn { grid, all, triangles }
}

/// The exact ray of an order from a place on the disk: the direction in camera axes, and g for the gas there.
pub fn exact(gas: &Gas, camera: &Observer, r: f64, azimuth: f64, order: Order) -> Option<(DVec3, f64)> {
    let point = DVec3::new(r * azimuth.cos(), r * azimuth.sin(), 0.0);
    let l = camera.radius();
    let n = camera.position / l;
    let across = point - n * point.dot(n);
    let phi = across.length().atan2(point.dot(n));
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, Branch::Plus)?;
    let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
    let turn = if order.flips() { -1.0 } else { 1.0 };
    let side = across.normalize();
    let look = n * psi.cos() + side * (turn * psi.sin());
    let here = light::rain_momentum(ray.slope, ray.energy, 1.0 / l);
    let arriving = look * -here[0].hypot(here[1]);
    let m = point / r;
    let onward = (side * m.dot(n) - n * m.dot(side)) * turn;
    let there = light::rain_momentum(ray.emission_slope, ray.energy, 1.0 / r);
    let leaving = m * there[0] + onward * there[1];
    let emitter = gas.momentum(point);
    let gamma = |p: DVec3| (1.0 + p.length_squared()).sqrt();
    let frequency = |p: DVec3, k: DVec3| gamma(p) * k.length() - p.dot(k);
    Some((camera.seen_direction(look), frequency(camera.momentum, arriving) / frequency(emitter, leaving)))
}

fn direction(vertex: &DiskVertex) -> DVec3 {
    let [x, y, z] = vertex.apparent;
    DVec3::new(f64::from(x), f64::from(y), f64::from(z)).normalize()
}

/// Every grid vertex of order 1 within a fifth of a pixel of its exact place, and its heat that of gT with the exact g to a part in a
/// thousand; from far, from within the disk's radius, and from below.
#[test]
fn vertices_of_the_disk_land_where_they_are_seen() {
    let size = [1280, 720];
    let mut disk = a_disk();
    // With a gap all circles are drawn, and as they are: where rings are drawn together heat is fitted to all of the gas between two
    // circles.
    disk.config.gap = 0.5;
    // Few rows, for the picture does not matter; the width decides how many arcs there are.
    let mut renderer = renderer([1280, 16]);
    let pixel = 2.0 * 30f64.to_radians().tan() / f64::from(size[0]);
    for (l, degrees) in [(22.0, 80.0), (22.0, 30.0), (7.0, 87.0), (7.0, 93.0), (2.2, 70.0)] {
        let camera = camera(l, degrees, 60f64.to_radians());
        let drawn = drawn(&mut renderer, &disk, camera);
        let (mut checked, mut worst, mut worst_heat) = (0, 0.0f64, 0.0f64);
        for (vertex, r, azimuth, _) in drawn.grid.iter().filter(|row| row.3 == 1) {
            let Some((want, g)) = exact(&disk.gas, &camera, *r, *azimuth, Order::ALL[0]) else { continue };
            let off = direction(vertex).angle_between(want) / pixel;
            let temperature = f64::from(vertex.ln_temperature).exp();
            let heat = (temperature / (g * disk.gas.radial.temperature(*r)) - 1.0).abs();
            assert!(off < 0.2, "L = {l}, {degrees}°, r = {r}, azimuth {azimuth}: {off} px off");
            assert!(heat < 2e-3, "L = {l}, {degrees}°, r = {r}, azimuth {azimuth}: T is {temperature}, off by {heat}");
            (worst, worst_heat) = (worst.max(off), worst_heat.max(heat));
            checked += 1;
        }
        assert!(checked > 200, "only {checked} vertices");
        println!("L = {l}, {degrees}°: {checked} vertices, worst {worst:.4} px, heat {worst_heat:.1e}");
    }
}

/// Luminet's isoradial curves: impact parameters (in GM/c²) of the near, the side and the far point of a ring, in the direct image and in
/// the ghost. His observer is at infinity, so two steps: the exact ray from 10⁸ r_s has his impact parameter, and seen from 40 r_s the
/// shader's vertex has that of the exact ray; both to 0.1 %.
#[test]
fn isoradials_are_luminets() {
    let mut disk = a_disk();
    disk.arcs.cuts = (0..=8).map(|k| TAU * f64::from(k) / 8.0).collect();
    disk.arcs.circles = vec![2.0, 3.0, 5.0, 15.0, 20.0];
    disk.arcs.rings = (0..4).map(|k| [k, k + 1]).collect();
    // With a gap all circles are drawn, however narrow.
    disk.config.gap = 0.5;
    let mut renderer = renderer([640, 16]);
    let impact = |camera: &Observer, seen: DVec3| {
        let l = camera.radius();
        2.0 * l * seen.x.hypot(seen.y) / (1.0 - 1.0 / l).sqrt()
    };
    for (degrees, r, direct, ghost) in [
        (80.0, 3.0, [1.0432174887, 6.9321484792, 6.6693652767], [5.2646955221, 5.4789137221, 6.304566478]),
        (80.0, 5.0, [1.7378104897, 10.95611505, 8.4071152572], [5.3040583002, 5.6661503407, 7.4299270419]),
        (60.0, 15.0, [15.035861112, 30.984087521, 20.592608048], [5.428061125, 5.9505398829, 8.2960598342]),
    ] {
        let far = camera(1e8, degrees, 1.0);
        // A picture of a thousandth of a degree: the width that thin images are given is nothing beside it.
        let near = camera(40.0, degrees, 2e-5);
        let drawn = drawn(&mut renderer, &disk, near);
        for (order, values) in [(1, direct), (2, ghost)] {
            for (theta, want) in [(0.0, values[0]), (PI / 2.0, values[1]), (PI, values[2])] {
                let ray = Order::ALL[order as usize - 1];
                let azimuth = theta - PI / 2.0;
                let b = impact(&far, exact(&disk.gas, &far, r, azimuth, ray).unwrap().0);
                assert!((b / want - 1.0).abs() < 1e-3, "r = {r}, {degrees}°, order {order}, θ = {theta}: b is {b}, must be {want}");
                let b = impact(&near, exact(&disk.gas, &near, r, azimuth, ray).unwrap().0);
                let (vertex, ..) = drawn
                    .grid
                    .iter()
                    .filter(|row| row.3 == order && (row.1 - r).abs() < 1e-6)
                    .find(|row| ((row.2 - azimuth + PI).rem_euclid(TAU) - PI).abs() < 1e-5)
                    .expect("a vertex there");
                let got = impact(&near, direction(vertex));
                assert!(
                    (got / b - 1.0).abs() < 1e-3,
                    "r = {r}, {degrees}°, order {order}, θ = {theta}: the vertex has b = {got}, must be {b}"
                );
            }
        }
    }
}

/// The edges of the disk, as they are drawn, against the exact curves: the distance of the middle of each chord of the outermost and the
/// innermost circle.
#[test]
fn edges_of_the_disk_are_right_to_half_a_pixel() {
    let size = [1280, 720];
    let disk = a_disk();
    let mut renderer = renderer(size);
    let mut all = Vec::new();
    for (l, degrees) in [(22.0, 80.0), (22.0, 89.5), (30.0, 60.0), (26.0, 0.5), (8.0, 85.0)] {
        let camera = camera(l, degrees, 60f64.to_radians());
        let drawn = drawn(&mut renderer, &disk, camera);
        let [inner, outer] = disk.gas.extent();
        for (edge, r) in [(f64::max(inner, 1.0), inner), (outer, outer)] {
            let height = disk.gas.radial.pattern_radius(edge).ln() / lensrunner::scene::disk::PATTERN_HEIGHT;
            let lag = disk.gas.radial.lag(r);
            let depth_there = |v: &DiskVertex| (f64::from(v.pattern_height) - height).abs() < 1e-6;
            for triangle in &drawn.triangles {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let (a, b) = (&drawn.all[triangle[i] as usize], &drawn.all[triangle[j] as usize]);
                    // Inside the last orbit all circles share one height in the pattern; the innermost has no gas.
                    if !(depth_there(a) && depth_there(b)) || (r < 3.0 && (a.depth > 0.0 || b.depth > 0.0)) || a.turns == b.turns {
                        continue;
                    }
                    let (da, db) = (direction(a), direction(b));
                    let (Some(pa), Some(pb)) = (camera.pixel(da, size), camera.pixel(db, size)) else { continue };
                    let inside = |p: [f64; 2]| p[0] > 0.0 && p[1] > 0.0 && p[0] < 1280.0 && p[1] < 720.0;
                    if !inside(pa) || !inside(pb) {
                        continue;
                    }
                    let middle = 0.5 * (f64::from(a.turns) + f64::from(b.turns)) * TAU + lag;
                    let Some((want, _)) = exact(&disk.gas, &camera, r, middle, Order::ALL[0]) else { continue };
                    let Some(p) = camera.pixel(want, size) else { continue };
                    let (dx, dy) = (pb[0] - pa[0], pb[1] - pa[1]);
                    let length = dx.hypot(dy);
                    if length > 0.1 {
                        all.push(((p[0] - pa[0]) * dy - (p[1] - pa[1]) * dx).abs() / length);
                    }
                }
            }
        }
    }
    all.sort_by(f64::total_cmp);
    assert!(all.len() > 500, "only {} chords", all.len());
    let at = all[all.len() * 99 / 100];
    println!("{} chords: 99 % within {at:.3} px, worst {:.3}", all.len(), all[all.len() - 1]);
    assert!(at <= 0.5);
}

/// A Planck spectrum seen at gT has g⁴ times the power: ∫B(gT)dν over ∫B(T)dν by quadrature, with the gT that the vertices carry.
#[test]
fn the_power_of_a_shifted_black_body_goes_as_the_fourth_power_of_g() {
    let mut disk = a_disk();
    // As above: with a gap the vertices carry the heat of their own circle.
    disk.config.gap = 0.5;
    let mut renderer = renderer([64, 36]);
    let camera = camera(22.0, 80.0, 60f64.to_radians());
    let drawn = drawn(&mut renderer, &disk, camera);
    // x³/(eˣ − 1) over x = hν/kT₀ for T in units of T₀.
    let power = |t: f64| -> f64 { (1..4000).map(|k| 0.02 * f64::from(k)).map(|x| x.powi(3) / (x / t).exp_m1() * 0.02).sum() };
    let mut span = (f64::INFINITY, 0.0f64);
    for (vertex, r, azimuth, _) in drawn.grid.iter().filter(|row| row.3 == 1 && row.1 > 3.5).step_by(7) {
        let Some((_, g)) = exact(&disk.gas, &camera, *r, *azimuth, Order::ALL[0]) else { continue };
        let shown = f64::from(vertex.ln_temperature).exp() / disk.gas.radial.temperature(*r);
        let ratio = power(shown) / power(1.0);
        assert!((ratio / g.powi(4) - 1.0).abs() < 8e-3, "r = {r}: {ratio} instead of {}", g.powi(4));
        span = (span.0.min(g), span.1.max(g));
    }
    assert!(span.0 < 0.7 && span.1 > 1.2, "g only from {} to {}", span.0, span.1);
}

/// What is written in both languages: slant, shares, orbital rate.
#[test]
fn functions_of_the_gas_are_the_same_in_both_languages() {
    let body = "#import lensrunner::disk::motion::{disk_rate, disk_shares}
    twin_out[id.x] = vec4<f32>(disk_slant(row.x, row.y, row.z), disk_shares(row.w).x, disk_rate(row.w), 0.0);";
    let rows: Vec<[f32; 4]> = (0..200)
        .map(|k| {
            let t = k as f32 / 199.0;
            [t, 0.01 + 30.0 * t * t, 0.02 + 0.2 * t, 0.3 + 0.69 * t]
        })
        .collect();
    let got = run(Pass::DiskDraw, body, [&[], &[]], &rows, 1);
    for (row, got) in rows.iter().zip(got) {
        let [cosine, path, half_height, grown] = row.map(f64::from);
        let radius = (lensrunner::scene::disk::PATTERN_HEIGHT * grown).exp();
        let rate = 1.0 / (TAU * (2.0 * radius.powi(3)).sqrt());
        let want = [slant(cosine, path, half_height), shares(grown)[0], rate];
        for k in 0..3 {
            assert!(
                (f64::from(got[k]) - want[k]).abs() < 2e-5 * (1.0 + want[k].abs()),
                "row {row:?}, value {k}: {} on the GPU, {} in Rust",
                got[k],
                want[k]
            );
        }
    }
}

/// The inverse of σ is that in both languages, at any height over the plane; and next to the plane the angle round the axis that follows
/// from it is right where the disk passes behind the hole, though θ hardly moves there.
#[test]
fn bearings_are_the_inverse_of_sigma_in_both_languages() {
    let body = "let there = bearing(row.x, row.y);
        twin_out[id.x] = vec4<f32>(there.theta, there.cosine, there.sine, atan2(there.sine, row.y * there.cosine));";
    let mut rows = Vec::new();
    for height in [1e-5f32, 1e-3, 0.1, 1.0] {
        rows.extend((0..500).map(|k| [-3.0 + 12.3 * k as f32 / 499.0, height, 0.0, 0.0]));
    }
    // What drivers' own arctangents are off by.
    let rounding = 1e-5;
    for (row, got) in rows.iter().zip(run(Pass::DiskVertices, body, [&[], &[]], &rows, 1)) {
        let [wanted, height] = [f64::from(row[0]), f64::from(row[1])];
        let [theta, cosine, sine] = bearing(wanted, height);
        assert!((sigma(theta, height) - wanted).abs() < 1e-9, "{row:?}: σ is {}", sigma(theta, height));
        let around = sine.atan2(height * cosine);
        for (got, want) in got.into_iter().zip([theta, cosine, sine, around]) {
            let off = (f64::from(got) - want + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < rounding, "{row:?}: {got} on the GPU, {want} in Rust");
        }
    }
}

/// From within its plane the disk is what light from behind the hole makes of it on its way round: a ring as round as from elsewhere, whose
/// upper half is of the first order. Its chords are as near to it as the budget asks for.
#[test]
fn from_within_its_plane_the_disk_is_a_round_ring() {
    let disk = a_disk();
    let mut renderer = renderer([512, 512]);
    for (l, field_of_view) in [(20.0, 40f64), (8.0, 100.0)] {
        let camera = camera(l, 90.0, field_of_view.to_radians());
        let drawn = drawn(&mut renderer, &disk, camera);
        let [_, outer] = disk.gas.extent();
        let ray = light::connect(1.0 / outer, PI, 1.0 / l, Branch::Plus).unwrap();
        let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
        let axis = camera.position / l;
        let radius = camera.seen_direction(axis * psi.cos() + DVec3::Z * psi.sin()).angle_between(DVec3::NEG_Z);
        let (mut around, mut worst) = (0.0, 0.0f64);
        for triangle in &drawn.triangles {
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let [a, b] = [i, j].map(|k: usize| direction(&drawn.all[triangle[k] as usize]));
                let on_it = |v: DVec3| (v.angle_between(DVec3::NEG_Z) - radius).abs() < 1e-4;
                if !on_it(a) || !on_it(b) {
                    continue;
                }
                worst = worst.max(radius - (a + b).angle_between(DVec3::NEG_Z));
                around += a.truncate().angle_to(b.truncate()).abs();
            }
        }
        println!("L = {l}: chords go round {:.4} times, worst {worst:.2e} rad aside", around / TAU);
        // The other half is of the second order; next to the plane a circle leaves the ring.
        assert!((0.45..0.5).contains(&(around / TAU)));
        // A half ring in n segments sags by π²/8 over n² of its radius.
        assert!(worst < 1.3 * disk.config.error_budget, "{worst} rad aside");
    }
}
