//! Verdicts collected in a table: a CSV with a row for each object and image order, and the same for reading, in Markdown, beside it.

use std::fmt::Write;
use std::path::Path;

use super::measure::metrics::{Limits, Verdict};
use super::report::{BEYOND, said};
use crate::chart::{Provenance, Sheet, SheetError};
use lensrunner::judge::case::TraceRequest;
use lensrunner::scene;

/// The columns. T in r_s/c; displacements in pixels; `percent` of an image's pixels and its rim; thin areas in pixels; `verdict` is
/// `within`, that nothing was judged, or all that is beyond the limits, and holds for the whole picture, as do wrong orders, holes and lit
/// pixels.
pub const COLUMNS: [&str; 23] = [
    "scene", "at", "size", "samples", "object", "order", "pixels", "mean", "most", "max", "apart", "mismatched", "percent", "inside",
    "thin_judge", "thin_shown", "wrong_order", "holes", "lit", "flip", "verdict", "commit", "command",
];

/// When scenes that move are looked at, besides T = 0: in the chase the ships turn and thrust; in the plunge the camera nears the horizon
/// (1.2) and is inside (1.5).
pub const LATER: [(&str, &[f64]); 2] = [("chase", &[5.0, 20.0, 25.0]), ("plunge", &[1.2, 1.5])];

/// The scenes that the project comes with, each with the times T (r_s/c) at which it is judged.
pub fn moments() -> Vec<(String, f64)> {
    let later = |name: &str| LATER.iter().find(|(scene, _)| *scene == name).map_or(&[][..], |(_, times)| times);
    scene::names()
        .into_iter()
        .flat_map(|name| std::iter::once(0.0).chain(later(&name).iter().copied()).map(move |at| (name.clone(), at)))
        .collect()
}

/// Adds a verdict to the table in `csv`, in the place of an earlier one of the same scene, T and rays a pixel, and writes its Markdown
/// beside it.
pub fn add(csv: &Path, request: &TraceRequest, verdict: &Verdict, limits: &Limits, faults: &[String]) -> Result<(), SheetError> {
    let mut sheet = Sheet::open(csv, &COLUMNS)?;
    let commit = Provenance::now("").commit;
    insert(&mut sheet, rows(request, verdict, limits, faults, &commit));
    sheet.save_with(csv, &markdown(&sheet))
}

/// The rows of a verdict; one, without an object, where nothing solid is seen.
pub fn rows(request: &TraceRequest, verdict: &Verdict, limits: &Limits, faults: &[String], commit: &str) -> Vec<Vec<String>> {
    let [width, height] = request.size;
    let before = [request.scene.clone(), request.at.to_string(), format!("{width}x{height}"), request.samples.to_string()];
    let said = match said(verdict, limits, faults) {
        BEYOND => faults.join("; ").replace(',', ";"),
        other => other.to_owned(),
    };
    let command = format!(
        "lensrunner-lab compare --scene {} --at {} --size {width}x{height} --samples {}",
        request.scene, request.at, request.samples
    );
    let counts = [verdict.wrong_order, verdict.holes, verdict.lit].map(|count| count.to_string());
    let row = |middle: Vec<String>, flip: f64| {
        let after = counts.iter().cloned().chain([format!("{flip:.4}"), said.clone(), commit.to_owned(), command.clone()]);
        before.iter().cloned().chain(middle).chain(after).collect()
    };
    let groups = verdict.groups.iter().filter(|group| group.order <= limits.orders);
    let mut rows: Vec<Vec<String>> = groups
        .map(|group| {
            let d = &group.displacement;
            let middle = vec![
                group.name.clone(),
                group.order.to_string(),
                group.pixels.to_string(),
                format!("{:.3}", d.mean),
                format!("{:.3}", d.most),
                format!("{:.3}", d.max),
                d.apart.to_string(),
                group.mismatched.to_string(),
                format!("{:.3}", 100.0 * group.mismatched as f64 / (group.pixels + group.rim).max(1) as f64),
                group.beyond_rim.to_string(),
                format!("{:.2}", group.thin[0]),
                format!("{:.2}", group.thin[1]),
            ];
            row(middle, verdict.flip)
        })
        .collect();
    if rows.is_empty() {
        rows.push(row(vec![String::new(); 12], verdict.flip));
    }
    rows
}

/// Puts rows into the sheet where rows of the same scene, T and rays a pixel were, or at its end.
fn insert(sheet: &mut Sheet, rows: Vec<Vec<String>>) {
    let same = |row: &Vec<String>| rows.first().is_some_and(|new| (&new[0], &new[1], &new[3]) == (&row[0], &row[1], &row[3]));
    let place = sheet.rows.iter().position(same).unwrap_or(sheet.rows.len());
    sheet.rows.retain(|row| !same(row));
    let place = place.min(sheet.rows.len());
    sheet.rows.splice(place..place, rows);
}

/// The table for reading: scene, T, size and rays, then for each image the displacement (99 % and greatest) and what differs.
pub fn markdown(sheet: &Sheet) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "| scene | T | size, rays | image | 99 %, max | differ | thin: judge, game | verdict | commit |");
    let _ = writeln!(text, "|---|---|---|---|---|---|---|---|---|");
    let mut last = [""; 3];
    for row in &sheet.rows {
        let cell = |name: &str| sheet.text(row, name);
        let key = ["scene", "at", "samples"].map(cell);
        // What holds for the whole picture is said once.
        let once = |text: String| if last == key { String::new() } else { text };
        let thin = sheet.number(row, "thin_judge") > 0.0 || sheet.number(row, "thin_shown") > 0.0;
        let solid = sheet.number(row, "pixels") > 0.0;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            once(format!("`{}`", cell("scene"))),
            once(cell("at").to_owned()),
            once(format!("{}, {}", cell("size").replace('x', " × "), cell("samples"))),
            if cell("object").is_empty() { "nothing solid".to_owned() } else { format!("{} {}", cell("object"), cell("order")) },
            if solid { format!("{}, {}", cell("most"), cell("max")) } else { String::new() },
            if solid { format!("{} of {} px, {} %", cell("mismatched"), cell("pixels"), cell("percent")) } else { String::new() },
            if thin { format!("{}, {}", cell("thin_judge"), cell("thin_shown")) } else { String::new() },
            once(cell("verdict").to_owned()),
            once(cell("commit").to_owned()),
        );
        last = key;
    }
    text
}
