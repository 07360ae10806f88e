//! The pictures of the race, from its sheet alone.

use super::methods::FAMILIES;
use crate::chart::{Provenance, Sheet};
use crate::plot::{Axis, Figure, Guide, Panel, Point, Scatter, tick_text};

/// What the sheet of a graphics adapter says of its points if they are those of the processor.
pub const SAME: &str = "the same as in projection.csv";
/// Half a pixel at 3840 pixels over 60°, degrees.
pub const HALF_PIXEL: f64 = 0.008;
/// Smaller errors are drawn here, degrees: less than a hundred-thousandth of a pixel.
const LEAST_ERROR: f64 = 1e-7;
/// A method that leaves more than this share of the rows with a ray unanswered, or invents as many, has failed.
const MOST_WRONG: f64 = 0.001;

/// A method over all its orders.
struct Entry {
    name: String,
    family: usize,
    /// Share of the rows with the wrong presence.
    wrong: f64,
    max: f64,
    nanoseconds: f64,
    bytes: f64,
}

impl Entry {
    /// Whether it answers what the game asks: every point, none off by more than can be seen.
    fn failed(&self) -> bool {
        self.wrong > MOST_WRONG || self.max.is_nan() || self.max > HALF_PIXEL
    }

    /// What is written beside its point.
    fn label(&self) -> String {
        let Entry { name, wrong, max, .. } = self;
        if *wrong > MOST_WRONG {
            let digits = usize::from(*wrong < 0.01);
            format!("{name} ({:.digits$} %)", 100.0 * wrong)
        } else if *max == 0.0 {
            format!("{name} (the measure of the others: below 1e-9)")
        } else if name == RECOMMENDED {
            format!("{name}: use this")
        } else {
            name.clone()
        }
    }
}

fn entries(sheet: &Sheet) -> Vec<Entry> {
    let mut all: Vec<Entry> = Vec::new();
    let mut counts: Vec<[f64; 2]> = Vec::new();
    for row in &sheet.rows {
        let name = sheet.text(row, "method");
        let at = all.iter().position(|entry| entry.name == name).unwrap_or_else(|| {
            let family = FAMILIES.iter().position(|family| *family == sheet.text(row, "family")).unwrap_or(0);
            let (nanoseconds, bytes) = (sheet.number(row, "nanoseconds"), sheet.number(row, "bytes"));
            all.push(Entry { name: name.to_owned(), family, wrong: 0.0, max: 0.0, nanoseconds, bytes });
            counts.push([0.0; 2]);
            all.len() - 1
        });
        let (entry, count) = (&mut all[at], &mut counts[at]);
        let wrong = sheet.number(row, "missing") + sheet.number(row, "false");
        *count = [count[0] + wrong, count[1] + sheet.number(row, "rows")];
        entry.max = entry.max.max(sheet.number(row, "max_degrees"));
    }
    for (entry, [wrong, rows]) in all.iter_mut().zip(counts) {
        entry.wrong = wrong / rows.max(1.0);
    }
    all
}

/// The same from the sheet of a graphics adapter.
fn on_adapter(sheet: &Sheet) -> Panel {
    let entries = entries(sheet);
    let mut panel = scatter(&entries, false, "");
    let same = if sheet.note("points").is_some_and(|points| points.ends_with(SAME)) { ", the same points" } else { "" };
    panel.title = format!("On the graphics adapter{same}: {}", sheet.note("adapter").unwrap_or("unknown"));
    panel.x = Axis::log("nanoseconds a lookup, many at once");
    Panel::Scatter(unnamed(panel))
}

/// Without the names that would cover each other.
fn unnamed(mut panel: Scatter) -> Scatter {
    for point in panel.points.iter_mut().filter(|point| nameless(point.label.split(' ').next().unwrap_or_default())) {
        point.label.clear();
    }
    panel
}

const LARGEST: &str = "largest error, degrees (rain frame)";
const GUIDE: &str = "half a pixel at 3840 over 60°: what lies lower cannot be seen";

fn scatter(entries: &[Entry], memory: bool, title: &str) -> Scatter {
    // Against memory only methods with a table take part.
    let points = entries.iter().filter(|entry| !memory || entry.bytes > 0.0).map(|entry| Point {
        // What an adapter does for nothing beside its overhead is drawn at a nanosecond.
        x: if memory { entry.bytes } else { entry.nanoseconds.max(1.0) },
        y: entry.max.max(LEAST_ERROR),
        label: entry.label(),
        family: entry.family,
        failed: entry.failed(),
        chosen: entry.name == RECOMMENDED,
    });
    let points: Vec<Point> = points.collect();
    // Crosses are red whatever their family.
    let shown = |family: usize| points.iter().any(|point| !point.failed && point.family == family);
    let families = FAMILIES.iter().enumerate().map(|(i, name)| if shown(i) { (*name).to_owned() } else { String::new() }).collect();
    let x = if memory { "memory of tables, bytes" } else { "nanoseconds a lookup, one core" };
    Scatter {
        title: title.into(),
        x: Axis::log(x),
        y: Axis::log(LARGEST),
        points,
        families,
        pareto: true,
        guides: vec![Guide { at: HALF_PIXEL, label: GUIDE.into() }],
        guides_x: Vec::new(),
        good_below: Some(HALF_PIXEL),
    }
}

fn footer(sheet: &Sheet) -> Vec<String> {
    let mut lines = Provenance::footer(&sheet.notes);
    if let Some(points) = sheet.note("points") {
        lines.insert(
            0,
            format!("adversarial points: {points}; orders 1 to 3; cameras from r = 0.05 to 5000 r_s, points from 1.0005 to 10000 r_s"),
        );
    }
    lines
}

/// What to use and why, from the numbers themselves: the verdict and what stands under it; None where the methods that they speak of did
/// not take part.
fn verdict(entries: &[Entry]) -> Option<[String; 2]> {
    let named = |name: &str| entries.iter().find(|entry| entry.name == name);
    let (table, batch, paper) = (named(RECOMMENDED)?, named("table-batch")?, named("paper1-128")?);
    let pixels = |entry: &Entry| tick_text(significant(entry.max / (2.0 * HALF_PIXEL)));
    Some([
        format!("Use \"table\": never off by more than {} of a pixel, in {:.0} ns", pixels(table), table.nanoseconds),
        format!(
            "{:.0} MB of memory; eight points at once (\"table-batch\") it takes {:.0} ns a point. The best table of Yamashita 2012 takes {:.0} ns and \
             {:.0} MB, is off by up to {} pixels and leaves {:.0} % of the points unanswered.\n",
            table.bytes / 1e6,
            batch.nanoseconds,
            paper.nanoseconds,
            paper.bytes / 1e6,
            pixels(paper),
            100.0 * paper.wrong,
        ),
    ])
}

/// `value` to two digits.
fn significant(value: f64) -> f64 {
    let unit = 10f64.powf(value.abs().max(1e-300).log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// What the game draws with.
const RECOMMENDED: &str = "table";

/// Whether a method's name is left out: of the tables of Yamashita 2012 only the largest of each kind are named, so that names do not cover
/// each other.
fn nameless(name: &str) -> bool {
    name.starts_with("paper1-") && !["paper1-128", "paper1-uniform-128"].contains(&name)
}

/// The picture for a stranger: the largest error against time, against memory, and on the graphics adapter where one took part, one under
/// the other, as wide as a page shows it.
pub fn race(sheet: &Sheet, graphics: Option<&Sheet>) -> Figure {
    let entries = entries(sheet);
    let panel = |memory: bool, title: &str| unnamed(scatter(&entries, memory, title));
    let mut panels = vec![
        Panel::Scatter(panel(false, "On the processor: error against time (lower and further left is better)")),
        Panel::Scatter(panel(true, "Error against memory, of the methods that keep a table")),
    ];
    panels.extend(graphics.map(on_adapter));
    let [verdict, why] = verdict(&entries).unwrap_or_default();
    Figure {
        verdict,
        title: "Where a vertex is seen near a black hole: error against cost".into(),
        subtitle: why
            + "Each mark is the worst error of a method that finds where a point near a black hole is seen, on points chosen to be hard. The \
               black line joins what nothing beats. Red crosses fail: off by more than half a pixel, or without an answer for some points \
               (so many per cent: camera inside, higher orders). Crosses without a name: smaller tables of Yamashita 2012.",
        size: [1000, 230 + 540 * panels.len() as u32],
        columns: 1,
        panels,
        footer: footer(sheet),
    }
}
