//! What a measurement was made on: processor, graphics adapter, date, commit, command.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

/// The name of each note, in the order of the lines under a chart.
const NOTES: [&str; 5] = ["processor", "adapter", "date", "commit", "command"];

/// Where numbers come from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(default)]
pub struct Provenance {
    /// The processor and how many of it.
    pub processor: String,
    /// The graphics adapter; empty where none took part.
    pub adapter: String,
    /// The day, UTC: 2026-11-21.
    pub date: String,
    /// The commit of the sources; empty where git does not know.
    pub commit: String,
    /// The command that does it again.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub command: String,
}

impl Provenance {
    /// Of the running program; `adapter` is handed in by whoever opened one.
    pub fn now(adapter: &str) -> Provenance {
        let program = "lensrunner-lab".to_owned();
        let command = std::iter::once(program).chain(std::env::args().skip(1)).collect::<Vec<_>>().join(" ");
        Provenance { processor: processor(), adapter: adapter.to_owned(), date: today(), commit: commit(), command }
    }

    /// What the notes of a sheet say; None if they name no commit.
    pub fn from_notes(notes: &[(String, String)]) -> Option<Provenance> {
        let text = |name: &str| notes.iter().find(|(n, _)| n == name).map(|(_, text)| text.clone());
        let [processor, adapter, date, commit, command] = NOTES.map(text);
        let all = |text: Option<String>| text.unwrap_or_default();
        Some(Provenance { processor: all(processor), adapter: all(adapter), date: all(date), commit: commit?, command: all(command) })
    }

    /// As the notes of a sheet.
    pub fn notes(&self) -> Vec<(String, String)> {
        let texts = [&self.processor, &self.adapter, &self.date, &self.commit, &self.command];
        NOTES.iter().zip(texts).filter(|(_, text)| !text.is_empty()).map(|(name, text)| ((*name).to_owned(), text.clone())).collect()
    }

    /// The lines under a chart, from the notes of the sheet that it is drawn from.
    pub fn footer(notes: &[(String, String)]) -> Vec<String> {
        let text = |name: &str| notes.iter().find(|(n, _)| n == name).map(|(_, text)| text.clone());
        let first = NOTES[..4].iter().filter_map(|name| Some(format!("{name}: {}", text(name)?))).collect::<Vec<_>>().join("  ·  ");
        [Some(first), text("command")].into_iter().flatten().filter(|line| !line.is_empty()).collect()
    }
}

/// "AMD EPYC × 2", from the system where it says so.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(": ")).map(|(_, name)| name.trim());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} × {cores}", name.unwrap_or(std::env::consts::ARCH))
}

/// The day by the system's clock, UTC.
fn today() -> String {
    let days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs() / 86_400);
    let [year, month, day] = civil(days as i64);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Year, month and day of a number of days since 1970-01-01 in the Gregorian calendar, from 400-year cycles that begin in March.
pub fn civil(days: i64) -> [i64; 3] {
    let shifted = days + 719_468;
    let era = shifted.div_euclid(146_097);
    let of_era = shifted.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    [era * 400 + year_of_era + i64::from(month <= 2), month, day]
}

/// The commit of the sources that this was built from, shortened, with "+" if files differ from it; empty where they are not. Documents do
/// not count: what has just been measured lies there.
pub fn commit() -> String {
    let git = |args: &[&str]| {
        let output = std::process::Command::new("git").args(["-C", env!("CARGO_MANIFEST_DIR")]).args(args).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    match (
        git(&["rev-parse", "--short=10", "HEAD"]),
        git(&["status", "--porcelain", "--untracked-files=no", "--", ":/", ":(top,exclude)docs"]),
    ) {
        (Some(commit), Some(changes)) => format!("{commit}{}", if changes.is_empty() { "" } else { "+" }),
        _ => String::new(),
    }
}
