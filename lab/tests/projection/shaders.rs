//! The game's methods of projection in the shader: each does what Rust does, by the shipped functions.

use std::sync::Arc;

use lensrunner::lensing::lookup::{OLD, YOUNG, lens_lookup_aged};
use lensrunner::lensing::methods::{Exact, Method, ProjectionInput, Projector, exact, flat, paper};
use lensrunner::lensing::{Scheme, Slice, bake};
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner_lab::projection::methods::Paper;
use lensrunner_lab::projection::race::Race;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::gpu::GPU;
use crate::support::{shared_table, table};

/// Radians.
const QUARTER_PIXEL: f64 = 0.004 * std::f64::consts::PI / 180.0;

/// ψ of an answer.
fn angle(answer: [f32; 4]) -> f64 {
    f64::from(answer[1]).atan2(f64::from(answer[0]))
}

fn input(row: [f32; 4], camera: f64) -> ProjectionInput {
    let (height, across) = (f64::from(row[2]), f64::from(row[1]));
    ProjectionInput { r: height.hypot(across), phi: across.atan2(height), camera }
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

/// Directions within a quarter of a pixel, delays and frequencies within a thousandth and two hundredths for all rows but few: another
/// order of sums gives another answer where single precision ends.
#[test]
fn the_table_is_the_same_in_both_languages() {
    let mut race = Race::new(&GPU, shared_table());
    let mut random = StdRng::seed_from_u64(3);
    for l in [0.3, 1.02, 1.5, 6.0, 900.0] {
        let rows = rows(l, &mut random);
        let slice = Slice::new(table(), l);
        let (mut seen, mut off) = (0, 0);
        for (row, [a, b]) in rows.iter().zip(race.look_up(Method::default(), l, &rows).unwrap()) {
            let [along, across, height, code] = *row;
            let want = lens_lookup_aged(&slice, along, across, height, code as u32 % 4, if code >= 4.0 { OLD } else { YOUNG });
            if (a[3] == 1.0) != want.valid {
                off += 1;
            } else if want.valid {
                seen += 1;
                let direction = (angle(a) - f64::from(want.sin_psi).atan2(f64::from(want.cos_psi))).abs() / QUARTER_PIXEL;
                let delay = f64::from((a[2] - want.delay).abs() / (1e-3 * (1.0 + want.delay.abs())));
                let frequency = f64::from((b[2] - want.emission_frequency).abs() / (2e-2 * (1.0 + want.emission_frequency)));
                off += usize::from(!(direction <= 1.0 && delay <= 1.0 && frequency <= 1.0));
            }
        }
        println!("L = {l}: {seen} seen, {off} off");
        assert!(seen > 1000 && off <= rows.len() / 300);
    }
}

/// The closed form in single precision against that in double precision, where both ends are not inside (there the shader's answer is the
/// table's). Rays that wind around the photon sphere lose their digits in single precision: at most 5 of 1,500.
#[test]
fn the_exact_method_is_exact() {
    let mut race = Race::new(&GPU, shared_table());
    let mut random = StdRng::seed_from_u64(3);
    for l in [0.3, 1.02, 1.5, 6.0, 900.0] {
        let rows = rows(l, &mut random);
        let (mut seen, mut off) = (0, 0);
        for (row, [a, _]) in rows.iter().zip(race.look_up(exact::METHOD, l, &rows).unwrap()) {
            let input = input(*row, l);
            if input.r <= 1.0 {
                continue;
            }
            let want = Exact.project(input, Order::new(row[3] as u8 % 4).unwrap(), Branch::Plus);
            let Some(want) = want.filter(|_| a[3] == 1.0) else {
                off += usize::from((a[3] == 1.0) != want.is_some());
                continue;
            };
            seen += 1;
            let direction = (angle(a) - want.psi_rain).abs() / QUARTER_PIXEL;
            let delay = (f64::from(a[2]) - want.delay).abs() / (1e-3 * (1.0 + want.delay));
            off += usize::from(!(direction <= 1.0 && delay <= 1.0));
        }
        println!("L = {l}: {seen} seen, {off} off");
        assert!(seen > 900 && off <= rows.len() / 150);
    }
}

/// Straight light is the direction of the offset itself, its time the distance.
#[test]
fn the_flat_method_goes_straight() {
    let mut race = Race::new(&GPU, shared_table());
    let rows = rows(6.0, &mut StdRng::seed_from_u64(4));
    for (row, [a, _]) in rows.iter().zip(race.look_up(flat::METHOD, 6.0, &rows).unwrap()) {
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
    let table = bake(Scheme::Paper, 12, |_| ());
    let mut race = Race::new(&GPU, shared_table());
    race.tables().set(paper::METHOD, Arc::new(table.clone()));
    let paper = Paper(table);
    let mut random = StdRng::seed_from_u64(5);
    for l in [1.05, 6.0, 900.0] {
        let rows = rows(l, &mut random);
        let mut seen = 0;
        for (row, [a, _]) in rows.iter().zip(race.look_up(paper::METHOD, l, &rows).unwrap()) {
            let order = row[3] as u8 % 4;
            let input = input(*row, l);
            let Some(want) = paper.project(input, Order::new(order).unwrap(), Branch::Plus) else { continue };
            assert_eq!(a[3], 1.0, "{input:?}");
            seen += 1;
            let off = (angle(a) - want.psi_rain).abs();
            // Next to the horizon aberration stretches what f32 leaves of ψ near π.
            assert!(off < 2e-4 && (f64::from(a[2]) - want.delay).abs() < 1e-4 * (1.0 + want.delay.abs()), "{input:?}: {a:?}, {want:?}");
        }
        assert!(seen > 800, "{seen} at {l}");
    }
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
    let mut race = Race::new(&GPU, shared_table());
    projection::run(&request, Some(&mut race)).unwrap();
    let sheet = Sheet::load(&folder.path().join("projection-gpu.csv")).unwrap();
    assert_eq!(sheet.rows.len(), 6);
    assert_eq!(sheet.note("adapter"), Some(race.adapter().as_str()));
    for row in sheet.rows.iter().filter(|row| sheet.text(row, "method") == "table") {
        assert!(sheet.number(row, "max_degrees") < 0.008 && sheet.number(row, "missing") == 0.0);
        assert!(sheet.number(row, "answered") > 1000.0 && sheet.number(row, "nanoseconds").is_finite());
    }
}
