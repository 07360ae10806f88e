//! The methods on a graphics adapter: handed in from above, for this floor knows no renderer.

use super::points::{CAMERAS, Row, row_of};
use super::score::{tally, truth};
use super::{ChartError, Request};
use crate::measure::chart::{Provenance, Sheet};
use crate::measure::methods::{FAMILIES, Vertex};
use crate::spacetime::light::{Branch, Order};
use rand::SeedableRng;
use rand::rngs::SmallRng;

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

/// Camera radii: each needs a slice of its own, so there are fewer than on the processor.
const FRAMES: usize = 320;
/// Of which every so manyth is timed.
const TIMED: usize = 40;
/// Rounds in which the methods take turns; the median counts.
const ROUNDS: usize = 5;

fn packed(row: &Row, order: Order) -> [f32; 4] {
    let Vertex { along, across, height, .. } = row.query.into();
    let age = if row.branch == Branch::Minus { 4.0 } else { 0.0 };
    [along, across, height, f32::from(order.number()) + age]
}

/// Adversarial points of `FRAMES` cameras, as in [`super::rows`].
fn frames(request: &Request) -> Vec<Vec<Row>> {
    let mut rng = SmallRng::seed_from_u64(request.seed ^ 0x6b75);
    let count = request.points.div_ceil(FRAMES).clamp(64, 1024);
    (0..FRAMES)
        .map(|_| {
            let camera = super::points::camera(&mut rng);
            (0..count).map(|_| row_of(&mut rng, camera)).collect()
        })
        .collect()
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

/// One row for each method and order.
pub fn measure(request: &Request, adapter: &mut dyn Adapter) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(COLUMNS);
    sheet.notes = Provenance::now(&adapter.name()).notes();
    let frames = frames(request);
    let [low, high] = CAMERAS;
    let points = frames.len() * frames[0].len();
    sheet
        .notes
        .push(("points".into(), format!("{points} for each order, from {FRAMES} cameras in {low} … {high} r_s, seed {}", request.seed)));
    let methods: Vec<_> = adapter
        .methods()
        .into_iter()
        .filter(|(name, _)| request.methods.is_empty() || request.methods.iter().any(|wanted| wanted == name))
        .collect();
    // Times side by side: orders 1 and 2, as on the processor, of cameras that every method has an answer for.
    let timed: Vec<(f64, Vec<[f32; 4]>)> = frames
        .iter()
        .filter(|rows| rows[0].query.camera > 1.02)
        .step_by(TIMED)
        .map(|rows| (rows[0].query.camera, rows.iter().flat_map(|row| Order::ALL[..2].iter().map(|order| packed(row, *order))).collect()))
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
    let truths: Vec<Vec<Vec<_>>> = Order::ALL.into_iter().map(|order| frames.iter().map(|rows| truth(rows, order)).collect()).collect();
    for ((name, family), mut times) in methods.into_iter().zip(times) {
        times.sort_by(f64::total_cmp);
        let bytes = adapter.bytes(name);
        for (order, truths) in Order::ALL.into_iter().zip(&truths) {
            let mut answers = Vec::new();
            for rows in &frames {
                let asked: Vec<_> = rows.iter().map(|row| packed(row, order)).collect();
                answers.extend(adapter.look_up(name, rows[0].query.camera, &asked).unwrap_or_else(|| vec![None; rows.len()]));
            }
            let s = tally(&frames.concat(), &answers, &truths.concat());
            let mut cells = vec![
                name.to_owned(),
                FAMILIES[family].to_owned(),
                order.number().to_string(),
                points.to_string(),
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
            cells.extend([format!("{:.1}", times[times.len() / 2]), bytes.to_string()]);
            sheet.push(cells);
        }
    }
    Ok(sheet)
}
