//! The tables: mappings, lookup against an integrator of its own, singular edges, files, hostile input.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use lensrunner::lensing::lookup::source_point::SourcePoint;
use lensrunner::lensing::lookup::{YOUNG, lookup};
use lensrunner::lensing::table::grid;
use lensrunner::lensing::{Scheme, Slice, Table, TableError, double, lens_lookup, lens_lookup_at, load_or_bake, paper, score};
use lensrunner::spacetime::light::Order;
use proptest::prelude::*;
use rand::SeedableRng;

use crate::lensing::integrator as judge;
use crate::support::table;

/// The angle in radians between the looked-up and the true direction, and the error of the delay over its allowance.
fn errors(row: [f64; 3], order: Order) -> (f64, f64) {
    let [r, phi, l] = row;
    let truth = judge::connect(1.0 / r, order.swept(phi), 1.0 / l);
    let seen = score::look_up_row(&Slice::new(table(), l), row, order);
    assert!(seen.valid, "no answer at {row:?}");
    let angle = (f64::from(seen.sin_psi).atan2(f64::from(seen.cos_psi)) - judge::rain_angle(&truth, 1.0 / l)).abs();
    let tilt = |slope: f64| (1.0 / r).atan2(-slope);
    let emission = (tilt(f64::from(seen.emission_slope)) - tilt(truth.emission_slope)).abs();
    assert!(emission < 2e-4, "emission off by {emission} at {row:?}");
    let allowed = if r < 1.05 { 0.02 } else { 0.002 + 3e-7 * truth.delay };
    (angle, (f64::from(seen.delay) - truth.delay).abs() / allowed)
}

#[test]
fn every_mapping_comes_back() {
    for i in 0..=40 {
        let z = i as f64 / 40.0;
        let l = grid::camera_radius(z);
        assert!((grid::camera_axis(l) - z).abs() < 1e-12, "L = {l}");
        let cam = double::camera(l);
        for j in 0..=20 {
            let x = j as f64 / 20.0;
            let c = grid::point(&cam, x);
            assert!((grid::coordinates(&cam, c, 0.0).0 - x).abs() < 1e-9, "c = {c}, L = {l}");
            let sweep = grid::sweep(&cam, c, x);
            assert!((grid::coordinates(&cam, c, sweep).1 - x).abs() < 1e-12, "Φ = {sweep}, L = {l}");
        }
    }
    for scheme in [Scheme::Paper, Scheme::PaperUniform] {
        for inside in [true, false] {
            let camera = paper::camera_mesh(scheme, inside);
            for i in 0..=20 {
                let z = i as f64 / 20.0;
                assert!((camera.coordinate(camera.value(z)) - z).abs() < 1e-6);
                for mesh in paper::slice_meshes(scheme, inside, 30.0) {
                    assert!((mesh.coordinate(mesh.value(z)) - z).abs() < 1e-6);
                }
            }
        }
    }
}

/// Half of half a pixel at 3840 pixels over 60° (0.008°), and the delay within its allowance.
#[test]
fn the_lookup_agrees_with_an_integrator_of_its_own() {
    let mut rng = rand::rngs::SmallRng::seed_from_u64(7);
    for order in Order::ALL {
        for _ in 0..400 {
            let row = score::draw(score::Points::Adversarial, &mut rng);
            let (angle, delay) = errors(row, order);
            assert!(angle.to_degrees() < 0.004, "{row:?} {order:?}: {}°", angle.to_degrees());
            assert!(delay < 1.0, "{row:?} {order:?}: delay {delay} times what is allowed");
        }
    }
}

/// What the committed table promises: every direction within 0.008° (half a pixel at 3840 pixels over 60°), their root mean square within
/// 0.0005°, every delay within 0.002 r_s/c + 3e-7 of it outside r = 1.05 and 0.02 nearer. The truth is the exact ray, which
/// `light_against_judge` and `spacetime_light` hold to integrators.
fn keeps_its_promise(points: usize, seed: u64) {
    for (i, score) in score::score(table(), score::Points::Adversarial, points, seed).into_iter().enumerate() {
        let (order, angle, delay) = (i + 1, score.angle, score.delay_share);
        println!("order {order}: {:.6}° at most, {:.7}° rms, delay {:.3} of what is allowed", angle.max, angle.rms, delay.max);
        assert!(angle.max <= 0.008, "order {order}: {}° at {:?}", angle.max, angle.worst);
        assert!(angle.rms <= 0.0005, "order {order}: {}° rms", angle.rms);
        assert!(delay.max <= 1.0, "order {order}: delay {} times what is allowed at {:?}", delay.max, delay.worst);
    }
}

/// The same for points that are still inside, seen from inside: of `points` adversarial rows those whose camera and point both are, with
/// light of the sign of E that they ask for, and the answer that there is none. Most rows have none, so that each is also taken as far
/// around as its share of the way that light goes.
fn keeps_its_promise_inside(points: usize, seed: u64) {
    use lensrunner::lensing::adversarial::rows;
    use lensrunner::spacetime::light::{Branch, connect, rain_angle};
    use rayon::prelude::*;
    let limit = |r: f64, l: f64| (1.0 - 2.0 * r).acos() - (1.0 - 2.0 * l).acos();
    let drawn = rows(points, seed).into_iter().filter(|row| row.input.camera < 1.0 && row.input.r < 1.0);
    let inside: Vec<_> = drawn
        .flat_map(|row| {
            let mut seen = row;
            seen.input.phi *= limit(row.input.r, row.input.camera) / PI;
            [Some(row), (row.input.r > row.input.camera).then_some(seen)].into_iter().flatten()
        })
        .collect();
    let errors: Vec<[f64; 2]> = inside
        .par_iter()
        .filter_map(|row| {
            let [r, phi, l] = [row.input.r, row.input.phi, row.input.camera];
            let ray = score::look_up_row_on(&Slice::new(table(), l), [r, phi, l], Order::ALL[0], row.branch);
            // Light reaches no farther around than the ray of zero energy; what rounding φ and r does at that edge is left open.
            let edge = r > l && (phi / limit(r, l) - 1.0).abs() < 1e-5;
            let truth = connect(1.0 / r, phi, 1.0 / l, row.branch);
            assert!(ray.valid == truth.is_some() || edge, "{row:?}: {ray:?}, {truth:?}");
            let truth = truth.filter(|_| ray.valid)?;
            let angle = f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)) - rain_angle(truth.slope, truth.energy, 1.0 / l);
            Some([angle.abs().to_degrees(), (f64::from(ray.delay) - truth.delay).abs()])
        })
        .collect();
    let most = |k: usize| errors.iter().map(|e| e[k]).fold(0.0, f64::max);
    let rms = (errors.iter().map(|e| e[0] * e[0]).sum::<f64>() / errors.len() as f64).sqrt();
    let both = [Branch::Plus, Branch::Minus].map(|branch| inside.iter().filter(|row| row.branch == branch).count());
    println!(
        "inside: {} of {} seen, {:.6}° at most, {rms:.7}° rms, delay off by {:.6} at most",
        errors.len(),
        inside.len(),
        most(0),
        most(1)
    );
    assert!(errors.len() > points / 50 && both.iter().all(|count| *count > points / 100), "{} seen, {both:?}", errors.len());
    assert!(most(0) <= 0.008 && rms <= 0.0005, "{}° at most, {rms}° rms", most(0));
    assert!(most(1) <= 0.02, "delay off by {} r_s/c", most(1));
}

#[test]
fn the_committed_table_keeps_its_promise() {
    keeps_its_promise(20_000, 1);
    keeps_its_promise_inside(60_000, 1);
}

/// The committed table is no larger than 16 MiB, and what this program bakes: a table of older formulas would be read as if it fitted.
#[test]
fn the_committed_table_is_what_the_program_bakes() {
    let table = table();
    assert!(table.to_bytes().len() <= 16 << 20);
    assert_eq!(table.size[2] as usize, lensrunner::lensing::SMALL_NODES);
    // At a node along L nothing is interpolated: what is left is the rounding to f32.
    for node in [0usize, 3, 40, 70, 95] {
        let l = grid::camera_radius(node as f64 / (lensrunner::lensing::SMALL_NODES - 1) as f64);
        let (stored, fresh) = (Slice::new(table, l), Slice::bake(lensrunner::lensing::SMALL_NODES, l));
        for (a, b) in stored.texels().iter().zip(fresh.texels()) {
            let off = (0..3).map(|h| (a[h] - b[h]).abs() / (1.0 + b[h].abs())).fold(0.0, f32::max);
            assert!(off < 1e-5, "L {l}: {a:?} in the file, {b:?} baked");
        }
    }
}

#[test]
fn nothing_happens_at_the_singular_edges() {
    let tiny = 1e-5;
    for order in Order::ALL {
        for l in [0.3, 0.999, 1.001, 1.499, 1.501, 10.0, 1000.0] {
            for phi in [tiny, 0.3, PI - tiny] {
                for r in [1.001, 1.0 + tiny + 5e-4, 1.499, 1.501, l * (1.0 - 1e-3), l * (1.0 + 1e-3), 9e3] {
                    if r > 1.0005 && (r / l - 1.0).abs() > 1e-4 {
                        let (angle, _) = errors([r, phi, l], order);
                        assert!(angle.to_degrees() < 0.004, "r {r} φ {phi} L {l} {order:?}: {}°", angle.to_degrees());
                    }
                }
            }
        }
    }
}

/// The camera falls through the horizon in small steps: the error against the integrator does not jump.
#[test]
fn falling_through_the_horizon_shows_no_seam() {
    for (r, phi) in [(1.3, 0.5), (3.0, 2.0), (50.0, 3.1)] {
        for order in Order::ALL {
            for i in 0..60 {
                let l = 1.003 - 1e-4 * f64::from(i);
                let (angle, delay) = errors([r, phi, l], order);
                assert!(angle.to_degrees() < 0.001 && delay < 1.0, "{}°, {delay} at r {r} φ {phi} L {l}", angle.to_degrees());
            }
        }
    }
}

#[test]
fn a_file_gives_back_the_table_and_says_what_is_wrong() {
    let small = lensrunner::lensing::bake(Scheme::Residual, 5, |_| ());
    let folder = crate::support::Folder::new();
    let path = folder.path().join("t.lut");
    small.save(&path).unwrap();
    assert_eq!(Table::load(&path, Scheme::Residual).unwrap(), small);

    let good = std::fs::read(&path).unwrap();
    let broken = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = good.clone();
        change(&mut bytes);
        Table::from_bytes(&path, &bytes, Scheme::Residual).unwrap_err()
    };
    assert!(matches!(Table::load(&folder.path().join("none"), Scheme::Residual), Err(TableError::Missing(_))));
    for length in [0, 5, 10, 60, good.len() - 1] {
        assert!(matches!(broken(&|b| b.truncate(length)), TableError::Short(..)), "cut at {length}");
    }
    for length in [1, 7, 8, 11, good.len()] {
        let wrong = broken(&|b| {
            b[0] = b'X';
            b.truncate(length);
        });
        assert!(matches!(wrong, TableError::Magic(_)), "cut at {length}: {wrong}");
    }
    assert!(matches!(broken(&|b| b[8] = 99), TableError::Version(_, 99)));
    assert!(matches!(broken(&|b| b[500] ^= 1), TableError::Checksum(_)));
    assert!(matches!(broken(&|b| b.push(0)), TableError::Layout(_)));
    assert!(matches!(Table::load(&path, Scheme::Paper), Err(TableError::Scheme(..))));
    // A right checksum over values that are none.
    for value in [f32::NAN, f32::INFINITY, -1e30] {
        let mut wrong = small.clone();
        wrong.values[7] = value;
        let said = Table::from_bytes(&path, &wrong.to_bytes(), Scheme::Residual).unwrap_err().to_string();
        assert!(said.contains(&format!("t.lut: value 7 is {value}, allowed are numbers from -1000000 to 1000000")), "{said}");
    }
    let paper = lensrunner::lensing::bake(Scheme::Paper, 5, |_| ());
    let flat = Table { size: [5, 5, 6], values: [&paper.values[..], &paper.values[..25 * 8]].concat(), ..paper };
    assert!(matches!(Table::from_bytes(&path, &flat.to_bytes(), Scheme::Paper), Err(TableError::Layout(_))));
    // Refused by its length: it would not fit into memory.
    std::fs::File::create(&path).and_then(|file| file.set_len(12 << 30)).unwrap();
    let said = Table::load(&path, Scheme::Residual).unwrap_err().to_string();
    assert!(said.contains("t.lut: it has 12884901888 bytes, allowed are at most 268435456"), "{said}");
    if cfg!(unix) {
        let said = Table::load(std::path::Path::new("/dev/zero"), Scheme::Residual).unwrap_err().to_string();
        assert!(said.contains("/dev/zero: it is a device"), "{said}");
    }
}

/// A table of fewer nodes than its name says is not drawn with.
#[test]
fn a_coarser_table_is_named_and_baked_again() {
    let folder = crate::support::Folder::new();
    for scheme in [Scheme::Paper, Scheme::Residual] {
        let path = folder.path().join("paper-7.lut");
        lensrunner::lensing::bake(scheme, 5, |_| ()).save(&path).unwrap();
        // The shares of the residual scheme: 62 and 106 in a hundred.
        let (found, wanted) = if scheme == Scheme::Paper { ([5; 3], [16; 3]) } else { ([5; 3], [9, 16, 16]) };
        let told = std::cell::Cell::new(String::new());
        let table = load_or_bake(&path, scheme, 16, |wrong| told.set(wrong.to_string()), |_| ());
        let said = told.take();
        assert!(said.contains(&format!("paper-7.lut: has {found:?} nodes along r, Φ and L, wanted are at least {wanted:?}")), "{said}");
        assert_eq!(table.size, wanted);
        // Now it is there; and one of more nodes is as good.
        let same = load_or_bake(&path, scheme, 16, |wrong| panic!("{wrong}"), |_| ());
        assert!(same == table && load_or_bake(&path, scheme, 6, |wrong| panic!("{wrong}"), |_| ()) == table);
    }
}

#[test]
fn a_damaged_file_is_named_and_never_used() {
    let folder = crate::support::Folder::new();
    let path = folder.path().join("t.lut");
    std::fs::write(&path, b"not a table at all, but long enough").unwrap();
    let told = std::cell::Cell::new(0);
    let complain = |wrong: &TableError| {
        assert!(matches!(wrong, TableError::Magic(_)));
        told.set(told.get() + 1);
    };
    let first = load_or_bake(&path, Scheme::PaperUniform, 5, complain, |_| ());
    assert_eq!(told.get(), 1);
    assert_eq!(Table::load(&path, Scheme::PaperUniform).unwrap(), first);
}

/// Equations 3 to 6 of Yamashita 2012 at both ends of the range of L and in the middle, worked out by hand.
#[test]
fn paper_ones_meshes_are_its_own() {
    let [low, high] = [lensrunner::lensing::paper_format::RANGES[0], lensrunner::lensing::paper_format::RANGES[1]];
    for (x, inside, radial, angular) in [
        (0.0, true, 18.210579, 4.08),
        (0.5, true, -4.226936, 5.750260),
        (1.0, true, -6.697740, 7.940130),
        (0.0, false, 14.4, 3.70),
        (1.0, false, 6.45, 7.42),
    ] {
        let l = low * f64::powf(high / low, x);
        let [r, phi] = paper::slice_meshes(Scheme::Paper, inside, l);
        assert!((r.bias() - radial).abs() < 1e-5 && (phi.bias() - angular).abs() < 1e-5, "x {x}: {} and {}", r.bias(), phi.bias());
    }
}

/// The meshes of Yamashita 2012 do at small size what its table 3 says of 32³: a few degrees at worst over its own points, and the uniform
/// meshes of its table 2 fail.
#[test]
fn paper_ones_meshes_beat_its_uniform_ones() {
    let rms = |scheme| score::score(&lensrunner::lensing::bake(scheme, 24, |_| ()), score::Points::Friendly, 2000, 3)[0].angle.rms;
    let (uniform, good) = (rms(Scheme::PaperUniform), rms(Scheme::Paper));
    assert!(good < 6.0 && uniform > 10.0, "uniform {uniform}°, optimised {good}°");
}

proptest! {
    #![proptest_config(crate::support::fixed(256))]

    /// Whatever comes in, no NaN comes out.
    #[test]
    fn no_nan(along in any::<f32>(), across in any::<f32>(), height in any::<f32>(), l in 0.05f64..5000.0, order in 1u32..4) {
        static SLICE: OnceLock<Slice> = OnceLock::new();
        let mut slice = SLICE.get_or_init(|| Slice::new(table(), 1.0)).clone();
        slice.camera = lensrunner::lensing::single::camera(l);
        for seen in [lens_lookup_at(&slice, along, across, height, order), lens_lookup(&slice, along, across.abs(), order)] {
            for v in [seen.cos_psi, seen.sin_psi, seen.delay, seen.frequency, seen.emission_radial, seen.emission_tangential,
                seen.emission_frequency, seen.slope, seen.emission_slope, seen.energy] {
                prop_assert!(v.is_finite(), "{seen:?}");
            }
        }
    }

    /// The same for points that can be.
    #[test]
    fn answers_everywhere(l in -3.0f64..8.5, r in 0.0005f64..9.2, phi in 0.0..PI, order in 1u32..4) {
        let (l, r) = (l.exp(), r.exp());
        let slice = Slice::new(table(), l);
        let seen = lens_lookup_at(&slice, (r * phi.cos() - l) as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, order);
        prop_assert!(seen.valid || r < 1.001);
        let length = seen.cos_psi.hypot(seen.sin_psi);
        prop_assert!((length - 1.0).abs() < 1e-5);
    }
}

/// At fixed (L, Φ), r decreases strictly as ψ grows.
#[test]
fn nearer_points_are_seen_deeper() {
    for l in [0.2, 0.95, 1.2, 6.0, 700.0] {
        let slice = Slice::new(table(), l);
        for sweep in [0.4, 1.5, 3.0, 3.6, 5.0, TAU - 0.1] {
            let order = if sweep < PI { 1 } else { 2 };
            let phi = if sweep < PI { sweep } else { TAU - sweep };
            let mut last = -1.0;
            for i in 0..60 {
                let r = (9.0 - 0.15 * f64::from(i)).exp().max(1.001);
                let seen = lens_lookup_at(&slice, (r * phi.cos() - l) as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, order);
                let psi = f64::from(seen.sin_psi).atan2(f64::from(seen.cos_psi));
                assert!(psi > last - 2e-5 || r <= 1.001, "L {l} Φ {sweep} r {r}: {psi} after {last}");
                last = psi;
            }
        }
    }
}

/// Next to the horizon, nearer than is promised (r = 1.0005), delays grow as the logarithm of r − 1 and are still told within what is
/// allowed there; r in f32 has no more digits for the nearest.
#[test]
fn delays_next_to_the_horizon_keep_their_digits() {
    for height in [2e-5, 1e-4, 4e-4] {
        for l in [0.3, 0.97, 1.2, 3.0, 200.0] {
            for order in Order::ALL {
                for phi in [0.05, 1.5, 3.0] {
                    let r: f64 = 1.0 + height;
                    let truth = judge::connect(1.0 / r, order.swept(phi), 1.0 / l);
                    let slice = Slice::new(table(), l);
                    let half = (0.5 * phi).sin();
                    let along = (r - l) - 2.0 * r * half * half;
                    let ray =
                        lens_lookup_at(&slice, along as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, u32::from(order.number()));
                    let off = (f64::from(ray.delay) - truth.delay).abs();
                    assert!(ray.valid && off < 0.02, "r − 1 = {height}, φ {phi}, L {l}, {order:?}: {} and {}", ray.delay, truth.delay);
                }
            }
        }
    }
}

/// A neighbour's delay is right to a small part of itself, next to the horizon too: it decides where a thing that falls beside the camera
/// is seen. The most is 0.0016 (L = 1.002).
#[test]
fn delays_of_neighbours_are_right_to_a_part_of_themselves() {
    for l in [0.8, 0.95, 0.99, 1.0, 1.0189, 1.03, 1.08, 1.3, 1.5, 6.0, 300.0] {
        let slice = Slice::new(table(), l);
        for step in 0..12 {
            let phi = 0.012 * 1.4f64.powi(step);
            for place in -12..=12 {
                let r = l + 0.1 * f64::from(place) * (l - 1.0).abs().max(0.02);
                if r < 1.0005 {
                    continue;
                }
                let truth = judge::connect(1.0 / r, phi, 1.0 / l);
                let half = (0.5 * phi).sin();
                let along = (r - l) - 2.0 * r * half * half;
                let ray = lens_lookup_at(&slice, along as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, 1);
                let off = (f64::from(ray.delay) / truth.delay - 1.0).abs();
                assert!(ray.valid && off < 2.5e-3, "r {r}, φ {phi}, L {l}: {} and {}", ray.delay, truth.delay);
            }
        }
    }
}

/// What colours and brightness are made from: a photon per unit of angular momentum, so that its tangential momentum is 1/r at either end,
/// its frequency the length of its momentum, and ω − √(1/r) p_r the same energy e at both (a falling observer's energy is not the one at
/// infinity).
#[test]
fn momenta_and_frequencies_belong_to_one_photon() {
    use lensrunner::lensing::adversarial::rows;
    use lensrunner::spacetime::light::Branch;
    let mut inside = 0;
    for row in rows(6000, 3) {
        let [mut phi, r, l] = [row.input.phi, row.input.r, row.input.camera];
        if r < 1.0 && r > l {
            phi *= 0.9 * ((1.0 - 2.0 * r).acos() - (1.0 - 2.0 * l).acos()) / PI;
        }
        for order in Order::ALL {
            let ray = score::look_up_row_on(&Slice::new(table(), l), [r, phi, l], order, row.branch);
            if !ray.valid {
                continue;
            }
            inside += u32::from(r < 1.0 && row.branch == Branch::Minus);
            let near = |a: f64, b: f64, scale: f64, what: &str| {
                assert!((a - b).abs() < 3e-5 * scale, "{what}: {a} and {b} at r {r} φ {phi} L {l} {order:?} {:?}: {ray:?}", row.branch);
            };
            let [frequency, sin, cos, energy] = [ray.frequency, ray.sin_psi, ray.cos_psi, ray.energy].map(f64::from);
            let [left, out, around] = [ray.emission_frequency, ray.emission_radial, ray.emission_tangential].map(f64::from);
            // Looking and moving are opposite.
            near(frequency * sin, 1.0 / l, 1.0 / l, "tangential at the camera");
            near(frequency * (1.0 + cos / l.sqrt()), energy, frequency * (1.0 + 1.0 / l.sqrt()), "energy at the camera");
            near(around, 1.0 / r, 1.0 / r, "tangential at the point");
            near(out.hypot(around), left, left, "frequency at the point");
            near(left - out / r.sqrt(), energy, left * (1.0 + 1.0 / r.sqrt()), "energy at the point");
            near(
                f64::from(ray.slope).hypot((1.0 - 1.0 / l).max(0.0).sqrt() / l),
                energy.hypot((1.0 / l - 1.0).max(0.0).sqrt() / l),
                frequency,
                "slope",
            );
            let signed = row.branch == Branch::Plus || r > 1.0;
            assert!((energy >= 0.0) == signed, "energy {energy} of {:?}", row.branch);
        }
    }
    assert!(inside > 30, "only {inside} with E < 0");
}

/// A point exactly as far out as the camera is seen like its neighbours: what is divided by r − L has its limit there.
#[test]
fn the_cameras_own_radius_is_no_hole() {
    for l in [1.2, 40.0] {
        let slice = Slice::new(table(), l);
        let seen = |dr: f32| {
            let place = SourcePoint { r: l as f32 + dr, lapse2: 1.0 - 1.0 / (l as f32 + dr), dr, phi: 0.5 };
            lookup(&slice, place, 0.5, YOUNG)
        };
        let (at, beside) = (seen(0.0), seen(l as f32 * 1e-5));
        assert!(
            at.valid && (at.delay - beside.delay).abs() < 1e-3 * at.delay && (at.cos_psi - beside.cos_psi).abs() < 1e-3,
            "{at:?} {beside:?}"
        );
    }
}

/// Camera and point both inside: the lookup in f32 against the judge, who integrates the light, on both branches. Directions to 0.008°,
/// half a pixel at 3840 over 60°; the image folds over at E = 0, where a direction goes as the root of the distance from the fold, so that
/// what rounding φ to f32 does there (1e-7 of it) is allowed for.
#[test]
fn inside_the_horizon_both_branches_agree_with_the_judge() {
    use lensrunner::judge::shoot;
    use lensrunner::spacetime::light::Branch;
    use rand::RngExt;
    use rayon::prelude::*;
    let rows: Vec<([f64; 3], f64)> = (0..3000)
        .map(|i| {
            let mut rng = rand::rngs::SmallRng::seed_from_u64(100 + i);
            let l = (0.05f64.ln() + rng.random::<f64>() * (0.999f64 / 0.05).ln()).exp();
            let near = 1e-4f64.powf(rng.random());
            let r = match i % 3 {
                0 => l + (1.0 - l) * rng.random::<f64>(),
                1 => l + (1.0 - l) * near,
                _ => (1.0 - (1.0 - l) * near).min(0.9999).max(l + 1e-4 * (1.0 - l)),
            };
            let limit = (1.0 - 2.0 * r).acos() - (1.0 - 2.0 * l).acos();
            let part = 1e-4f64.powf(rng.random());
            let part = match i % 4 {
                0 => part,
                1 => 1.0 - part,
                2 => 1.05 * rng.random::<f64>(),
                _ => rng.random(),
            };
            ([r, (part * limit).max(1e-6), l], limit)
        })
        .collect();
    for (branch, judged) in [(Branch::Plus, lensrunner::judge::EnergySign::Plus), (Branch::Minus, lensrunner::judge::EnergySign::Minus)] {
        let seen: Vec<_> = rows
            .par_iter()
            .map(|&(row, limit)| {
                let [r, phi, l] = row;
                let truth = shoot(r, phi, l, 1, judged, 1e-17);
                let ray = score::look_up_row_on(&Slice::new(table(), l), row, Order::ALL[0], branch);
                let share = 1.0 - phi / limit;
                let Some(truth) = truth else {
                    assert!(!ray.valid || share.abs() < 1e-5, "an answer at {row:?} {branch:?}, where there is no light");
                    return None;
                };
                assert!(ray.valid || share < 1e-5, "no answer at {row:?} {branch:?}");
                let angle = (f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)) - truth.psi_rain).abs().to_degrees();
                let delay = (f64::from(ray.delay) - truth.delay).abs();
                assert!(angle < 0.004 + 1e-4 / share.sqrt(), "{row:?} {branch:?}: {angle}° (share {share})");
                let allowed = if r > 0.95 { 0.02 } else { 0.002 } + 2e-5 / share.sqrt();
                assert!(delay < allowed, "{row:?} {branch:?}: delay {} for {} (share {share})", ray.delay, truth.delay);
                let tangential = truth.emission.y.abs();
                let emission =
                    (f64::from(ray.emission_radial).atan2(f64::from(ray.emission_tangential)) - truth.emission.x.atan2(tangential)).abs();
                assert!(emission < 2e-3 + 1e-5 / share.sqrt() + 1e-6 / (1.0 - r), "{row:?} {branch:?}: emission off by {emission}");
                Some((angle, delay))
            })
            .collect();
        let there: Vec<_> = seen.iter().flatten().collect();
        let worst = there.iter().fold((0.0f64, 0.0f64), |w, s| (w.0.max(s.0), w.1.max(s.1)));
        println!("{branch:?}: {} points, worst {:.5}° and {:.6} r_s/c", there.len(), worst.0, worst.1);
        assert!(there.len() > 2500);
    }
}
