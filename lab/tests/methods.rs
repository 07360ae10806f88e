//! The methods of projection in the shader: each does what its twin in Rust does, by the shipped functions.

use std::sync::{Arc, LazyLock};

use lensrunner::lensing::lookup::source_point::source_point;
use lensrunner::lensing::lookup::{OLD, YOUNG, lens_lookup_aged, lookup_with, residuals_half, residuals_linear};
use lensrunner::lensing::{LensRay, SMALL_NODES, Scheme, Slice, Table, bake, closed, shooting};
use lensrunner::render::method::Method;
use lensrunner::render::method::race::Race;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::gpu::GPU;

static TABLE: LazyLock<Arc<Table>> = LazyLock::new(|| Arc::new(bake(Scheme::Residual, SMALL_NODES, |_| ())));

/// The twin's answer.
fn twin(method: Method, slice: &Slice, texels: &[[f32; 4]], row: [f32; 4]) -> Option<LensRay> {
    let [along, across, height, code] = row;
    let (order, elapsed) = (code as u32 % 4, if code >= 4.0 { OLD } else { YOUNG });
    let cam = &slice.camera;
    let at = source_point(cam, along, across, height);
    let sweep = match order {
        2 => 2.0 * std::f32::consts::PI - at.phi,
        3 => 2.0 * std::f32::consts::PI + at.phi,
        _ => at.phi,
    };
    let table = || lens_lookup_aged(slice, along, across, height, order, elapsed);
    let linear = || lookup_with(cam, at, sweep, elapsed, |x, y| residuals_linear(|i| texels[i], slice.size, x, y));
    let outside = at.lapse2 > 0.0;
    let nothing = LensRay { valid: false, ..table() };
    Some(match method {
        Method::Table | Method::TableFull | Method::ResidualCubic { .. } => table(),
        Method::TableLinear | Method::ResidualLinear { .. } => linear(),
        Method::TableHalf => lookup_with(cam, at, sweep, elapsed, |x, y| residuals_half(|i| texels[i], slice.size, x, y)),
        Method::Newton => shooting::refined_ray(cam, at, sweep, table()),
        Method::Exact if !outside => table(),
        Method::Exact => shooting::exact_ray(cam, at, sweep),
        Method::Rk4 { .. } if !outside => nothing,
        Method::Rk4 { steps } => shooting::integrated_ray(cam, at, sweep, steps),
        Method::Beloborodov => closed::closed_ray(closed::tilt_beloborodov, cam, at, order),
        Method::Poutanen => closed::closed_ray(closed::tilt_poutanen, cam, at, order),
        // These have tests of their own.
        Method::Flat | Method::Paper1 { .. } => return None,
    })
}

/// Rows of a camera: points outside from next to the horizon to far away, and for a camera inside also inside.
fn rows(l: f64, random: &mut StdRng) -> Vec<[f32; 4]> {
    (0..1500)
        .map(|i| {
            let both = l < 1.0 && i % 3 == 0;
            let inside = l + (0.999 - l) * random.random::<f64>();
            let r = if both { inside } else { (1.001f64.ln() + random.random::<f64>() * (3000f64 / 1.001).ln()).exp() };
            let phi = std::f64::consts::PI * random.random::<f64>();
            let (order, phi) = if both { (1, 0.4 * phi) } else { (1 + i % 3, phi) };
            let half = (0.5 * phi).sin();
            let along = (r - l) - 2.0 * r * half * half;
            [along as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, order as f32 + if i % 4 == 0 { 4.0 } else { 0.0 }]
        })
        .collect()
}

/// Directions within a quarter of a pixel and delays within a thousandth for all rows but few: where a method itself is at the end of
/// single precision (rays that wind around the photon sphere, brackets that end on a rounding) another order of sums gives another answer.
#[test]
fn every_method_is_the_same_in_both_languages() {
    let mut race = Race::new(&GPU, TABLE.clone());
    race.tables().set_full(TABLE.clone());
    let rounded = TABLE.rounded();
    let mut random = StdRng::seed_from_u64(3);
    for method in Method::all().filter(|method| !matches!(method, Method::Flat | Method::Paper1 { .. })) {
        for l in [0.3, 1.02, 1.5, 6.0, 900.0] {
            let rows = rows(l, &mut random);
            let slice = Slice::new(if method == (Method::ResidualCubic { half: true }) { &rounded } else { &TABLE }, l);
            let texels = race.texels(method, l);
            let out = race.look_up(method, l, &rows).unwrap();
            let (mut seen, mut presence, mut off) = (0, 0, Vec::new());
            for (row, [a, b]) in rows.iter().zip(&out) {
                let Some(want) = twin(method, &slice, &texels, *row) else { continue };
                if (a[3] == 1.0) != want.valid {
                    presence += 1;
                } else if want.valid {
                    seen += 1;
                    let angle = |s: f32, c: f32| f64::from(s).atan2(f64::from(c));
                    let direction = (angle(a[1], a[0]) - angle(want.sin_psi, want.cos_psi)).abs() / 4e-3f64.to_radians();
                    let delay = f64::from((a[2] - want.delay).abs() / (1e-3 * (1.0 + want.delay.abs())));
                    let frequency = f64::from((b[2] - want.emission_frequency).abs() / (2e-2 * (1.0 + want.emission_frequency)));
                    // Sixteen steps leave no digit of the time of light that comes almost straight down: what is left is where it is seen.
                    let steps = matches!(method, Method::Rk4 { .. });
                    let worst = if steps { direction } else { direction.max(delay).max(frequency) };
                    off.push(if worst.is_nan() { f64::INFINITY } else { worst });
                }
            }
            let beyond = off.iter().filter(|x| **x > 1.0).count();
            println!("{method:?} L = {l}: {seen} seen, {beyond} off, {presence} of other presence");
            let few = if matches!(method, Method::Exact | Method::Rk4 { .. }) { rows.len() / 50 } else { rows.len() / 300 };
            assert!(beyond + presence <= few, "{method:?} L = {l}: {beyond} of {seen} are off, {presence} have another presence");
            let asked = !matches!(method, Method::Rk4 { .. } | Method::Beloborodov | Method::Poutanen);
            assert!(seen > 1000 || !asked, "{method:?} L = {l}: only {seen} seen");
        }
    }
}

/// Straight light is the direction of the offset itself, its time the distance.
#[test]
fn the_flat_method_goes_straight() {
    let mut race = Race::new(&GPU, TABLE.clone());
    let rows = rows(6.0, &mut StdRng::seed_from_u64(4));
    for (row, [a, _]) in rows.iter().zip(race.look_up(Method::Flat, 6.0, &rows).unwrap()) {
        let distance = row[0].hypot(row[1]);
        assert_eq!(a[3] == 1.0, row[3] as u32 % 4 == 1, "{row:?}");
        if a[3] == 1.0 {
            let off = (a[0] - row[0] / distance).abs().max((a[1] - row[1] / distance).abs()).max((a[2] / distance - 1.0).abs());
            assert!(off < 2e-6, "{row:?}: {a:?}");
        }
    }
}

/// The fetch of Yamashita 2012 in the shader against that of the chart, which is written for the processor.
#[test]
fn paper_ones_fetch_is_the_same_on_both() {
    use lensrunner::lensing::methods::{Paper, Projector, Query};
    use lensrunner::spacetime::light::{Branch, Order};
    let table = bake(Scheme::Paper, 12, |_| ());
    let mut race = Race::new(&GPU, TABLE.clone());
    race.tables().set_paper(64, false, Arc::new(table.clone()));
    let paper = Paper(table);
    let mut random = StdRng::seed_from_u64(5);
    for l in [1.05, 6.0, 900.0] {
        let rows = rows(l, &mut random);
        let mut seen = 0;
        for (row, [a, _]) in rows.iter().zip(race.look_up(Method::Paper1 { nodes: 64, uniform: false }, l, &rows).unwrap()) {
            let order = row[3] as u8 % 4;
            let (height, across) = (f64::from(row[2]), f64::from(row[1]));
            let query = Query { r: height.hypot(across), phi: across.atan2(height), camera: l };
            let Some(want) = paper.project(query, Order::new(order).unwrap(), Branch::Plus) else { continue };
            assert_eq!(a[3], 1.0, "{query:?}");
            seen += 1;
            let off = (f64::from(a[1]).atan2(f64::from(a[0])) - want.psi_rain).abs();
            // Next to the horizon aberration stretches what f32 leaves of ψ near π.
            assert!(off < 2e-4 && (f64::from(a[2]) - want.delay).abs() < 1e-4 * (1.0 + want.delay.abs()), "{query:?}: {a:?}, {want:?}");
        }
        assert!(seen > 800, "{seen} at {l}");
    }
}

/// The full table cut at the camera's radius once a frame gives the numbers of the table in three dimensions, in either precision.
#[test]
fn a_cut_is_the_table_in_three_dimensions() {
    use lensrunner::lensing::methods::{Interpolation, Projector, Query, Residual};
    use lensrunner::spacetime::light::{Branch, Order};
    let mut race = Race::new(&GPU, TABLE.clone());
    race.tables().set_full(TABLE.clone());
    let method = |linear: bool, half: bool| -> Box<dyn Projector> {
        let interpolation = if linear { Interpolation::Linear } else { Interpolation::Cubic };
        if half {
            Box::new(Residual::<[half::f16; 3]>::new(&TABLE, interpolation))
        } else {
            Box::new(Residual::<[f32; 3]>::new(&TABLE, interpolation))
        }
    };
    let mut random = StdRng::seed_from_u64(6);
    for (linear, half) in [(false, false), (false, true), (true, false), (true, true)] {
        let (name, judge) = (if linear { Method::ResidualLinear { half } } else { Method::ResidualCubic { half } }, method(linear, half));
        for l in [0.3, 1.04, 6.0, 900.0] {
            let rows = rows(l, &mut random);
            let (mut seen, mut off) = (0, 0);
            for (row, [a, _]) in rows.iter().zip(race.look_up(name, l, &rows).unwrap()) {
                let (height, across) = (f64::from(row[2]), f64::from(row[1]));
                let query = Query { r: height.hypot(across), phi: across.atan2(height), camera: l };
                if row[3] >= 4.0 || query.r < 1.0 {
                    continue;
                }
                let Some(want) = judge.project(query, Order::new(row[3] as u8).unwrap(), Branch::Plus) else { continue };
                seen += 1;
                let angle = (f64::from(a[1]).atan2(f64::from(a[0])) - want.psi_rain).abs();
                // Rounding to half precision moves most directions by more than this, another order of sums in f32 hardly any.
                off += u32::from(angle > 4e-6 || (f64::from(a[2]) - want.delay).abs() > 2e-4 * (1.0 + want.delay.abs()));
            }
            println!("{name:?} {l}: {seen} seen, {off} off");
            assert!(seen > 500 && off <= seen / 200, "{name:?} {l}: {off} of {seen} are off");
        }
    }
}

/// What `game.toml` may say is what there is.
#[test]
fn every_name_is_a_method() {
    let names: Vec<&str> = Method::all().map(Method::name).collect();
    assert_eq!(names, lensrunner::scene::METHODS);
    assert!(Method::all().all(|method| Method::named(method.name()) == Some(method)));
    // `project` has the same and those that do eight points at once, which a graphics adapter does anyway.
    let mut others: Vec<&str> =
        lensrunner::lensing::methods::CATALOGUE.iter().map(|entry| entry.name).filter(|name| !name.ends_with("-batch")).collect();
    let mut names = names;
    others.sort_unstable();
    names.sort_unstable();
    assert_eq!(names, others);
    assert_eq!(Method::named("exakt"), None);
}

/// The chart's rows of the adapter: every method takes part, the table is under half a pixel on it too.
#[test]
fn the_adapter_takes_part_in_the_chart() {
    use lensrunner_lab::chart::{Output, Sheet};
    use lensrunner_lab::projection;
    let folder = crate::support::Folder::new();
    let output = Output { folder: folder.path().to_owned(), redraw: false };
    let methods = vec!["table".to_owned(), "flat".to_owned()];
    let request = projection::ProjectionRequest { output, points: 4096, seed: 1, methods };
    let mut race = Race::new(&GPU, TABLE.clone());
    projection::run(&request, Some(&mut race)).unwrap();
    let sheet = Sheet::load(&folder.path().join("projection-gpu.csv")).unwrap();
    assert_eq!(sheet.rows.len(), 6);
    assert_eq!(sheet.note("adapter"), Some(race.adapter().as_str()));
    for row in sheet.rows.iter().filter(|row| sheet.text(row, "method") == "table") {
        assert!(sheet.number(row, "max_degrees") < 0.008 && sheet.number(row, "missing") == 0.0);
        assert!(sheet.number(row, "answered") > 1000.0 && sheet.number(row, "nanoseconds").is_finite());
    }
}
