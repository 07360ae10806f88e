//! The scripted chase frame by frame, as it is played: how long the adapter works on each frame, and the processor before that.

use crate::chart::{ChartError, Sheet, mean};
use lensrunner::scene::GameConfig;

use super::bench::Bench;
use super::request::{DISK_PASSES, DiskRequest, MeasuredView, REFERENCE, contestants};
use super::script::script;

/// Times each place is drawn: timestamps are read one frame later, and of two frames in a row only those of one.
const DRAWN: usize = 3;

/// A row for each of `request.flight` frames, drawn from the default arcs before stars and the Milky Way: the time of all passes by the
/// adapter's timestamps, of them the disk's own, and the processor's until the frame was submitted, all in ms; and the fragments that the
/// disk's draw shaded.
pub(super) fn flight(request: &DiskRequest, config: &GameConfig, bench: &mut Bench) -> Result<Sheet, ChartError> {
    let mut sheet =
        Sheet::measured(&["frame", "situation", "passes_ms", "disk_ms", "before_submission_ms", "disk_fragments"], bench.adapter());
    let number = contestants(config).iter().position(|contestant| contestant.name == REFERENCE);
    for frame in 0..request.flight {
        let share = frame as f64 / request.flight.saturating_sub(1).max(1) as f64;
        let (eye, time, situation) = script(share, config.disk.inner);
        let mut drawn = |counted| {
            let view = MeasuredView { eye, time, sky: true, counted };
            for _ in 1..DRAWN {
                bench.frame(number, &view, None)?;
            }
            bench.frame(number, &view, None)
        };
        let fragments = drawn(true)?.fragments;
        let shown = drawn(false)?;
        // An adapter without timestamps tells nothing.
        let of = |time: f64| if shown.passes.is_empty() { f64::NAN } else { time };
        let all = of(shown.passes.iter().map(|(_, time)| time).sum());
        let disk = of(DISK_PASSES.iter().map(|label| shown.pass(label)).sum());
        let fragments = fragments.map_or("NaN".to_owned(), |count| count.to_string());
        sheet.line(format_args!("{frame}|{situation}|{all:.3}|{disk:.3}|{:.3}|{fragments}", shown.before));
    }
    Ok(sheet)
}

/// What the flight comes to: of each time, and of the fragments, the mean, and what 99 and 99.9 % of the frames stay under, and the worst.
pub fn summary(flight: &Sheet) -> Sheet {
    let mut sheet = Sheet::new(&["what", "mean", "p99", "p99_9", "worst"]);
    sheet.notes.clone_from(&flight.notes);
    for column in ["passes_ms", "disk_ms", "before_submission_ms", "disk_fragments"] {
        let mut times: Vec<f64> = flight.rows.iter().map(|row| flight.number(row, column)).collect();
        times.sort_by(f64::total_cmp);
        let (mean, [most, nearly, worst]) = (mean(&times), [0.99, 0.999, 1.0].map(|share| under(&times, share)));
        sheet.line(format_args!("{column}|{mean:.3}|{most:.3}|{nearly:.3}|{worst:.3}"));
    }
    sheet
}

/// What a share of the values, ascending, is not above; NaN of none.
fn under(values: &[f64], share: f64) -> f64 {
    let count = (share * values.len() as f64).ceil() as usize;
    values.get(count.max(1) - 1).copied().unwrap_or(f64::NAN)
}
