//! The game's methods on a graphics adapter.

use super::ProjectionRequest;
use super::methods::{FAMILIES, find};
use super::race::Race;
use super::score::{Score, Truth, tally};
use super::time::TimedFrame;
use crate::chart::{ChartError, Sheet};
use lensrunner::lensing::adversarial::{Row, by_camera};
use lensrunner::lensing::methods::{METHODS, Method, Vertex};
use lensrunner::spacetime::light::{Branch, Order};

/// Of the cameras that are timed on the processor every so manyth is timed here: an adapter does many points of each at once.
const TIMED: usize = 2;
/// Rounds in which the methods take turns; the median counts.
const ROUNDS: usize = 5;

fn packed(vertex: Vertex, order: Order, branch: Branch) -> [f32; 4] {
    let Vertex { along, across, height, .. } = vertex;
    let age = if branch == Branch::Minus { 4.0 } else { 0.0 };
    [along, across, height, f32::from(order.number()) + age]
}

/// The result, or None and a word on stderr.
fn told<T>(result: Result<T, impl std::fmt::Display>) -> Option<T> {
    result.inspect_err(|error| eprintln!("lensrunner: {error}")).ok()
}

/// What the method answers to `rows` in each order: ψ in the rain frame and the delay.
fn answers(race: &mut Race, method: Method, rows: &[Row]) -> [Vec<Option<[f64; 2]>>; 3] {
    let mut all = [Vec::new(), Vec::new(), Vec::new()];
    for rows in by_camera(rows) {
        // One dispatch a camera: its slice is the same for all orders.
        let asked: Vec<_> =
            Order::ALL.into_iter().flat_map(|order| rows.iter().map(move |row| packed(row.input.into(), order, row.branch))).collect();
        let seen =
            |[[cos, sin, delay, there], _]: [[f32; 4]; 2]| (there == 1.0).then(|| [f64::from(sin).atan2(f64::from(cos)), f64::from(delay)]);
        let found = told(race.look_up(method, rows[0].input.camera, &asked))
            .map_or_else(|| vec![None; asked.len()], |rays| rays.into_iter().map(seen).collect());
        for (all, found) in all.iter_mut().zip(found.chunks(rows.len())) {
            all.extend_from_slice(found);
        }
    }
    all
}

const COLUMNS: &[&str] = &[
    "method", "family", "order", "rows", "answered", "missing", "false", "max_degrees", "p999_degrees", "rms_degrees", "worst_r",
    "worst_phi", "worst_L", "delay_over_allowed", "delay_worst_r", "delay_worst_phi", "delay_worst_L", "nanoseconds", "bytes",
];

/// One row for each method and order, on the very `rows` of the processor, whose truth in each order is `truths`; timed on points of the
/// processor's `frames`.
pub fn measure(
    request: &ProjectionRequest,
    race: &mut Race,
    rows: &[Row],
    truths: &[Vec<Truth>],
    frames: &[TimedFrame],
) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(COLUMNS, &race.adapter());
    sheet.notes.push(("points".into(), format!("{}, {}", super::describe_rows(request, rows), super::draw::SAME)));
    let wanted = |method: &Method| request.methods.is_empty() || request.methods.iter().any(|wanted| wanted == method.name);
    let methods: Vec<_> = METHODS.into_iter().filter(wanted).collect();
    eprintln!("timing {} methods on {}", methods.len(), race.adapter());
    let times = nanoseconds(race, &methods, frames);
    for (method, time) in methods.into_iter().zip(times) {
        eprintln!("scoring {} on the adapter", method.name);
        // What a frame hands to the adapter, where it is more than the constants of the camera.
        let bytes = method.table.map_or(0, |_| 16 * race.texels(method, 10.0).len());
        let family = find(method.name).map_or("", |entry| FAMILIES[entry.family]);
        let answers = answers(race, method, rows);
        for ((order, truth), answers) in Order::ALL.into_iter().zip(truths).zip(&answers) {
            let mut cells = vec![method.name.to_owned(), family.to_owned()];
            cells.extend([order.number().to_string(), rows.len().to_string()]);
            cells.extend(score_cells(&tally(rows, answers, truth)));
            // A large graphics card needs hundredths of a nanosecond.
            cells.extend([format!("{time:.4}"), bytes.to_string()]);
            sheet.push(cells);
        }
    }
    Ok(sheet)
}

/// The median nanoseconds of a look-up by each method, side by side: orders 1 and 2, as on the processor.
fn nanoseconds(race: &mut Race, methods: &[Method], frames: &[TimedFrame]) -> Vec<f64> {
    let asked = |point: &Vertex| [0, 1].map(|order| packed(*point, Order::ALL[order], Branch::Plus));
    let timed = frames.iter().step_by(TIMED);
    let timed: Vec<(f64, Vec<[f32; 4]>)> = timed.map(|frame| (frame.camera, frame.points.iter().flat_map(asked).collect())).collect();
    let mut times = vec![Vec::new(); methods.len()];
    for round in 0..=ROUNDS {
        for (method, times) in methods.iter().zip(&mut times) {
            let each: Option<Vec<f64>> = timed.iter().map(|(camera, rows)| told(race.time(*method, *camera, rows))).collect();
            let mean = each.map_or(f64::NAN, |each| each.iter().sum::<f64>() * 1e9 / each.len() as f64);
            // The first round compiles.
            if round > 0 {
                times.push(mean);
            }
        }
    }
    let median = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    times.into_iter().map(median).collect()
}

/// The columns from `answered` to `delay_worst_L`.
fn score_cells(score: &Score) -> Vec<String> {
    let Score { answered, missing, invented, angle, delay_share, .. } = score;
    let mut cells = [answered, missing, invented].map(|count| count.to_string()).to_vec();
    cells.extend([angle.max, angle.most, angle.rms].map(|v| format!("{v:.4e}")));
    cells.extend(angle.worst.map(|v| format!("{v:.9}")));
    cells.push(format!("{:.4e}", delay_share.max));
    cells.extend(delay_share.worst.map(|v| format!("{v:.9}")));
    cells
}
