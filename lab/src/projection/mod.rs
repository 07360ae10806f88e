//! The chart `projection`: every method of projection on the same points, error against time per lookup and against memory; where each
//! fails; and tables 2 and 3 of Yamashita 2012 with its own sampling.

mod adapter;
mod draw;
mod maps;
pub mod methods;
mod paper;
pub mod race;
mod score;
mod time;

use std::path::PathBuf;

pub use lensrunner::lensing::adversarial::{Row, rows};
pub use score::{Score, Truth, score, truth};

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::spacetime::light::Order;

use crate::chart::{ChartError, Output, Sheet};
use methods::{Entry, FAMILIES, Method};

/// Every method of projection on the same adversarial points: error against time per lookup and against memory.
#[derive(Args, Clone, Debug)]
pub struct ProjectionRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Adversarial points for each method and image order; about a tenth of them has no ray.
    #[arg(long, value_name = "N", default_value_t = 340_000, value_parser = whole::<usize>(1, 1_000_000_000))]
    pub points: usize,
    /// Seed of the points.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Only these methods, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
}

/// Measures (or reads) and draws; returns the files written. The race on an adapter adds a sheet and a panel of its own.
pub fn run(request: &ProjectionRequest, race: Option<&mut race::Race>) -> Result<Vec<PathBuf>, ChartError> {
    let output = &request.output;
    let sheet = output.sheet("projection", || measure(request))?;
    let mut paths = vec![output.csv("projection")];
    let graphics = match race {
        Some(race) => Some(output.sheet("projection-gpu", || {
            let rows = rows(request.points, request.seed);
            adapter::measure(request, race, &rows, &truths(&rows), &time::frames(request.seed))
        })?),
        None if output.redraw && output.csv("projection-gpu").is_file() => Some(Sheet::load(&output.csv("projection-gpu"))?),
        None => None,
    };
    paths.extend(graphics.iter().map(|_| output.csv("projection-gpu")));
    paths.extend(draw::race(&sheet, graphics.as_ref()).save(&output.folder, "projection")?);
    // The maps' sheet is large, and a folder to be redrawn need not have it.
    if !output.redraw || output.csv("projection-maps").is_file() {
        let sheet = output.sheet("projection-maps", || maps::measure(request))?;
        paths.push(output.csv("projection-maps"));
        paths.extend(maps::draw(&sheet).save(&output.folder, "projection-maps")?);
    }
    if request.methods.is_empty() {
        output.sheet("projection-paper1", || Ok::<_, ChartError>(paper::measure(request)))?;
        paths.push(output.csv("projection-paper1"));
    }
    Ok(paths)
}

/// Methods with what the catalogue says of them.
type Methods = Vec<(Entry, Box<dyn Method>)>;

/// The methods asked for.
fn chosen(request: &ProjectionRequest) -> Result<Methods, ChartError> {
    let mut all = methods::catalogue();
    if let Some(name) = request.methods.iter().find(|name| methods::find(name).is_none()) {
        let names: Vec<&str> = all.iter().map(|entry| entry.name).collect();
        return Err(ChartError::Input(format!("unknown method {name:?}: choose among {}", names.join(", "))));
    }
    all.retain(|entry| request.methods.is_empty() || request.methods.iter().any(|name| name == entry.name));
    Ok(all.into_iter().filter_map(|entry| Some((entry, methods::named(entry.name)?))).collect())
}

/// What the rows are, for the notes of a sheet.
fn describe_rows(request: &ProjectionRequest, rows: &[Row]) -> String {
    format!(
        "{} for each order, from {} cameras, seed {}",
        rows.len(),
        lensrunner::lensing::adversarial::by_camera(rows).count(),
        request.seed
    )
}

/// The truth of the rows in each order.
fn truths(rows: &[Row]) -> Vec<Vec<Truth>> {
    Order::ALL.into_iter().map(|order| truth(rows, order)).collect()
}

const COLUMNS: &[&str] = &[
    "method", "family", "order", "rows", "answered", "missing", "false", "max_degrees", "p999_degrees", "rms_degrees", "worst_r",
    "worst_phi", "worst_L", "delay_max", "delay_p999", "delay_over_allowed", "delay_worst_r", "delay_worst_phi", "delay_worst_L",
    "nanoseconds", "frame_microseconds", "bytes",
];

fn measure(request: &ProjectionRequest) -> Result<Sheet, ChartError> {
    let methods = chosen(request)?;
    let mut sheet = Sheet::measured(COLUMNS, "");
    eprintln!("timing {} methods", methods.len());
    let frames = time::frames(request.seed);
    let times = time::measure(&methods, &frames);
    let rows = rows(request.points, request.seed);
    sheet.notes.push(("points".into(), describe_rows(request, &rows)));
    let truths = truths(&rows);
    for ((entry, method), timed) in methods.iter().zip(times) {
        eprintln!("scoring {}", entry.name);
        for (order, truth) in Order::ALL.into_iter().zip(&truths) {
            let s = score(method.as_ref(), &rows, truth, order);
            let mut cells = vec![entry.name.to_owned(), FAMILIES[entry.family].to_owned(), order.number().to_string()];
            cells.extend([rows.len(), s.answered, s.missing, s.invented].map(|n| n.to_string()));
            cells.extend([s.angle.max, s.angle.most, s.angle.rms].map(|v| format!("{v:.4e}")));
            cells.extend(s.angle.worst.map(|v| format!("{v:.9}")));
            cells.extend([s.delay.max, s.delay.most, s.delay_share.max].map(|v| format!("{v:.4e}")));
            cells.extend(s.delay_share.worst.map(|v| format!("{v:.9}")));
            cells.push(format!("{:.1}", timed.nanoseconds));
            cells.push(format!("{:.2}", timed.frame_microseconds));
            cells.push(method.memory().to_string());
            sheet.push(cells);
        }
    }
    Ok(sheet)
}
