//! The methods on a graphics adapter: handed in from above, for this floor knows no renderer.

use super::score::{Truth, tally};
use super::time::TimedFrame;
use super::{ChartError, ProjectionRequest};
use crate::chart::{Provenance, Sheet};
use lensrunner::lensing::adversarial::{Row, by_camera};
use lensrunner::lensing::methods::{FAMILIES, Vertex};
use lensrunner::spacetime::light::{Branch, Order};

/// The methods of projection on a graphics adapter, by their names in `game.toml`.
pub trait Adapter {
    /// The adapter's name.
    fn name(&self) -> String;
    /// Each method with its family, an index into [`FAMILIES`].
    fn methods(&self) -> Vec<(&'static str, usize)>;
    /// ψ in the rain frame and the delay for each row (along, across, height; the order, 4 more for light of any age) seen from the radius
    /// `camera`. None where the adapter failed.
    fn look_up(&mut self, method: &str, camera: f64, rows: &[[f32; 4]]) -> Option<Vec<Option<[f64; 2]>>>;
    /// Nanoseconds for each of many such look-ups at once. None where the adapter failed.
    fn time(&mut self, method: &str, camera: f64, rows: &[[f32; 4]]) -> Option<f64>;
    /// Bytes that a frame hands to the adapter for the method.
    fn bytes(&mut self, method: &str) -> usize;
}

/// Of the cameras that are timed on the processor every so manyth is timed here: an adapter does many points of each at once.
const TIMED: usize = 2;
/// Rounds in which the methods take turns; the median counts.
const ROUNDS: usize = 5;

fn packed(vertex: Vertex, order: Order, branch: Branch) -> [f32; 4] {
    let Vertex { along, across, height, .. } = vertex;
    let age = if branch == Branch::Minus { 4.0 } else { 0.0 };
    [along, across, height, f32::from(order.number()) + age]
}

/// What the method answers to `rows` in each order.
fn answers(adapter: &mut dyn Adapter, method: &str, rows: &[Row]) -> [Vec<Option<[f64; 2]>>; 3] {
    let mut all = [Vec::new(), Vec::new(), Vec::new()];
    for rows in by_camera(rows) {
        // One dispatch a camera: its slice is the same for all orders.
        let asked: Vec<_> =
            Order::ALL.into_iter().flat_map(|order| rows.iter().map(move |row| packed(row.query.into(), order, row.branch))).collect();
        let found = adapter.look_up(method, rows[0].query.camera, &asked).unwrap_or_else(|| vec![None; asked.len()]);
        for (all, found) in all.iter_mut().zip(found.chunks(rows.len())) {
            all.extend_from_slice(found);
        }
    }
    all
}

const COLUMNS: &[&str] = &[
    "method",
    "family",
    "order",
    "rows",
    "answered",
    "missing",
    "false",
    "max_degrees",
    "p999_degrees",
    "rms_degrees",
    "worst_r",
    "worst_phi",
    "worst_L",
    "delay_over_allowed",
    "delay_worst_r",
    "delay_worst_phi",
    "delay_worst_L",
    "nanoseconds",
    "bytes",
];

/// One row for each method and order, on the very `rows` of the processor, whose truth in each order is `truths`; timed on points of the
/// processor's `frames`.
pub fn measure(
    request: &ProjectionRequest,
    adapter: &mut dyn Adapter,
    rows: &[Row],
    truths: &[Vec<Truth>],
    frames: &[TimedFrame],
) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(COLUMNS);
    sheet.notes = Provenance::now(&adapter.name()).notes();
    sheet.notes.push(("points".into(), format!("{}, {}", super::told(request, rows), super::draw::SAME)));
    let methods: Vec<_> = adapter
        .methods()
        .into_iter()
        .filter(|(name, _)| request.methods.is_empty() || request.methods.iter().any(|wanted| wanted == name))
        .collect();
    // Times side by side: orders 1 and 2, as on the processor.
    let timed: Vec<(f64, Vec<[f32; 4]>)> = frames
        .iter()
        .step_by(TIMED)
        .map(|frame| {
            let asked = |point: &Vertex| [0, 1].map(|order| packed(*point, Order::ALL[order], Branch::Plus));
            (frame.camera, frame.points.iter().flat_map(asked).collect())
        })
        .collect();
    eprintln!("timing {} methods on {}", methods.len(), adapter.name());
    let mut times = vec![Vec::new(); methods.len()];
    for round in 0..=ROUNDS {
        for ((name, _), times) in methods.iter().zip(&mut times) {
            let each: Option<Vec<f64>> = timed.iter().map(|(camera, rows)| adapter.time(name, *camera, rows)).collect();
            let mean = each.map_or(f64::NAN, |each| each.iter().sum::<f64>() / each.len() as f64);
            // The first round compiles.
            if round > 0 {
                times.push(mean);
            }
        }
    }
    for ((name, family), mut times) in methods.into_iter().zip(times) {
        eprintln!("scoring {name} on the adapter");
        times.sort_by(f64::total_cmp);
        let bytes = adapter.bytes(name);
        let answers = answers(adapter, name, rows);
        for ((order, truth), answers) in Order::ALL.into_iter().zip(truths).zip(&answers) {
            let s = tally(rows, answers, truth);
            let mut cells = vec![
                name.to_owned(),
                FAMILIES[family].to_owned(),
                order.number().to_string(),
                rows.len().to_string(),
                s.answered.to_string(),
                s.missing.to_string(),
                s.invented.to_string(),
                format!("{:.4e}", s.angle.max),
                format!("{:.4e}", s.angle.most),
                format!("{:.4e}", s.angle.rms),
            ];
            cells.extend(s.angle.worst.map(|v| format!("{v:.9}")));
            cells.push(format!("{:.4e}", s.delay_share.max));
            cells.extend(s.delay_share.worst.map(|v| format!("{v:.9}")));
            // A large graphics card needs hundredths of a nanosecond.
            cells.extend([format!("{:.4}", times[times.len() / 2]), bytes.to_string()]);
            sheet.push(cells);
        }
    }
    Ok(sheet)
}
