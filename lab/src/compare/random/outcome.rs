//! What came of many cases, in a row each and all together.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::chart::quantile;
use crate::compare::fault::{Kind, main_fault};
use crate::compare::judged::Judged;

/// What came of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Judged.
    Judged {
        /// The kinds of all faults, each once, the worst first.
        kinds: Vec<Kind>,
        /// The worst fault in words; empty if there is none.
        main: String,
        /// Whether there was anything to judge.
        solid: bool,
        /// Seconds for the renderer's picture, for the judge's, and for narrow images and displacements.
        seconds: [f64; 3],
        /// Rays a second and thread of the judge.
        rate: f64,
    },
    /// The judge gave up, and why.
    GaveUp(String),
}

impl Outcome {
    /// Of what was judged.
    pub fn of(judged: &Judged) -> Outcome {
        let mut kinds: Vec<Kind> = judged.faults.iter().map(|fault| fault.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let main = main_fault(&judged.faults).map(|fault| format!("{}: {fault}", fault.kind)).unwrap_or_default();
        let seconds = [judged.drawing, judged.tracing, judged.measuring];
        Outcome::Judged { kinds, main, solid: judged.solid, seconds, rate: judged.rate }
    }
}

/// A case and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Where it was drawn from.
    pub corner: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What came of it.
    pub outcome: Outcome,
    /// Seconds in all.
    pub seconds: f64,
}

/// Rays a second and thread below which a case is told as slow.
pub const SLOW: f64 = 2000.0;

impl Row {
    /// Whether something is wrong with the renderer's picture.
    pub fn failed(&self) -> bool {
        matches!(&self.outcome, Outcome::Judged { kinds, .. } if !kinds.is_empty())
    }

    /// A line where there is something to say: it failed, the judge gave up or was slow.
    pub fn remark(&self) -> Option<String> {
        let Row { name, corner, size: [width, height], seconds, .. } = self;
        let about = format!("{name} ({corner}, {width}x{height}, {seconds:.1} s)");
        match &self.outcome {
            Outcome::GaveUp(why) => Some(format!("{about}: {why}")),
            Outcome::Judged { main, rate, .. } => {
                let slow = (*rate < SLOW).then(|| format!("slow: the judge made {rate:.0} rays a second and thread"));
                let what: Vec<String> = [(!main.is_empty()).then(|| main.clone()), slow].into_iter().flatten().collect();
                (!what.is_empty()).then(|| format!("{about}: {}", what.join("; ")))
            }
        }
    }
}

/// How many there are of what.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Cases.
    pub cases: usize,
    /// Without a fault.
    pub within: usize,
    /// Of those, with nothing solid in the picture.
    pub empty: usize,
    /// With a fault.
    pub failed: usize,
    /// The judge gave up.
    pub gave_up: usize,
    /// The judge was slow.
    pub slow: usize,
    /// Failing cases by the kind of their worst fault.
    pub by_kind: BTreeMap<Kind, usize>,
}

/// Counts.
pub fn counts(rows: &[Row]) -> Counts {
    let mut counts = Counts { cases: rows.len(), ..Counts::default() };
    for row in rows {
        match &row.outcome {
            Outcome::GaveUp(_) => counts.gave_up += 1,
            Outcome::Judged { kinds, solid, rate, .. } => {
                counts.slow += usize::from(*rate < SLOW);
                match kinds.first() {
                    Some(kind) => {
                        counts.failed += 1;
                        *counts.by_kind.entry(*kind).or_default() += 1;
                    }
                    None => {
                        counts.within += 1;
                        counts.empty += usize::from(!solid);
                    }
                }
            }
        }
    }
    counts
}

/// The table at the end: each failing case with its worst fault, failures by kind, times.
pub fn summary(rows: &[Row]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    for row in rows.iter().filter(|row| row.failed() || matches!(row.outcome, Outcome::GaveUp(_))) {
        let _ = match &row.outcome {
            Outcome::Judged { main, .. } => writeln!(text, "{:<24} {:<16} {main}", row.name, row.corner),
            Outcome::GaveUp(why) => writeln!(text, "{:<24} {:<16} {why}", row.name, row.corner),
        };
    }
    let Counts { cases, within, empty, failed, gave_up, slow, by_kind } = counts(rows);
    let kinds: Vec<String> = by_kind.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
    let _ =
        writeln!(text, "{cases} cases: {within} within the limits ({empty} of them show nothing solid), {failed} fail, {gave_up} given up");
    if failed > 0 {
        let _ = writeln!(text, "failures by their worst fault: {}", kinds.join(", "));
    }
    if slow > 0 {
        let _ = writeln!(text, "in {slow} cases the judge made less than {SLOW} rays a second and thread");
    }
    if !rows.is_empty() {
        let [middle, most] = [0.5, 1.0].map(|q| quantile(rows.iter().map(|row| row.seconds), q));
        let mean = |part: usize| {
            let of = |row: &Row| match &row.outcome {
                Outcome::Judged { seconds, .. } => Some(seconds[part]),
                Outcome::GaveUp(_) => None,
            };
            let all: Vec<f64> = rows.iter().filter_map(of).collect();
            all.iter().sum::<f64>() / all.len().max(1) as f64
        };
        let _ = writeln!(
            text,
            "seconds a case: median {middle:.2}, most {most:.1}; in the mean {:.2} for the picture, {:.2} for the judge's, {:.2} to measure",
            mean(0),
            mean(1),
            mean(2)
        );
    }
    text
}
