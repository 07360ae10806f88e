//! Runs of many cases collected in a table: a CSV with a row for each run, and the same for reading, in Markdown, beside it.

use std::fmt::Write;
use std::path::Path;

use super::outcome::{Counts, Row, counts};
use crate::chart::{Provenance, Sheet, SheetError, quantile};
use crate::compare::fault::{Kind, Limits};
use crate::compare::judged::Terms;

/// The columns: what was drawn, of how many, from which seed; the limits; how many were within them, with nothing solid among those,
/// beyond, given up, slow for the judge; how many failed by each kind of worst fault; seconds of the median case.
pub const COLUMNS: [&str; 13] =
    ["what", "cases", "seed", "limits", "within", "empty", "failed", "gave_up", "slow", "by_kind", "seconds", "commit", "command"];

/// Adds a run to the table in `csv`, in the place of an earlier one of the same cases, and writes its Markdown beside it. `what` names what
/// was drawn: `random`, or a scene that was flown.
pub fn add(csv: &Path, what: &str, seed: &str, terms: &Terms, rows: &[Row]) -> Result<(), SheetError> {
    let mut sheet = Sheet::open(csv, &COLUMNS)?;
    let provenance = Provenance::now("");
    let new = row(what, seed, terms, rows, &provenance);
    let same = |old: &Vec<String>| old[..3] == new[..3];
    match sheet.rows.iter_mut().find(|old| same(old)) {
        Some(old) => *old = new,
        None => sheet.rows.push(new),
    }
    sheet.save_with(csv, &markdown(&sheet))
}

/// The row of a run.
pub fn row(what: &str, seed: &str, terms: &Terms, rows: &[Row], provenance: &Provenance) -> Vec<String> {
    let Counts { cases, within, empty, failed, gave_up, slow, by_kind } = counts(rows);
    let Limits { most, max, coverage, outline, thin, .. } = Limits::small(2);
    let limits = format!(
        "99 % {most} px; all {max} px; outline {outline} px or {coverage} of the pixels and {thin} sigma; {} s a case",
        terms.seconds
    );
    let kinds: Vec<String> = Kind::ALL.iter().filter_map(|kind| by_kind.get(kind).map(|count| format!("{kind} {count}"))).collect();
    let median = quantile(rows.iter().map(|row| row.seconds), 0.5);
    let numbers = [within, empty, failed, gave_up, slow].map(|count| count.to_string());
    [what.to_owned(), cases.to_string(), seed.to_owned(), limits]
        .into_iter()
        .chain(numbers)
        .chain([kinds.join("; "), format!("{median:.2}"), provenance.commit.clone(), provenance.command.replace(',', ";")])
        .collect()
}

/// The table for reading.
pub fn markdown(sheet: &Sheet) -> String {
    let mut text = String::from(
        "| what | seed | cases | within | of these empty | fail, by their worst fault | given up | slow | s a case | commit |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in &sheet.rows {
        let cell = |name: &str| sheet.text(row, name);
        let failed =
            if cell("by_kind").is_empty() { cell("failed").to_owned() } else { format!("{}: {}", cell("failed"), cell("by_kind")) };
        let cells = [cell("what"), cell("seed"), cell("cases"), cell("within"), cell("empty"), &failed];
        let rest = [cell("gave_up"), cell("slow"), cell("seconds"), cell("commit")];
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} | {} |", cells.join(" | "), rest.join(" | "));
    }
    text
}
