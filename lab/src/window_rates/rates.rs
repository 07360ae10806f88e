//! Frame rates from the times at which frames were handed to the window.

use crate::chart::Sheet;

/// One frame in play.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// When it was handed over, in s since the start of the program.
    pub seconds: f64,
    /// The number of its rung, from 1.
    pub rung: usize,
}

/// What the times come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// Frames that count.
    pub frames: usize,
    /// Frames a second.
    pub mean: f64,
    /// The least number of frames a second over any half second.
    pub least: f64,
    /// The rung that was shown longest.
    pub rung: usize,
}

/// The rows in play of a table of `--timings`.
pub fn read(sheet: &Sheet) -> Option<Vec<Row>> {
    let [seconds, shown, rung] = ["seconds", "shown", "rung"].map(|name| sheet.column(name).ok());
    let (seconds, shown, rung) = (seconds?, shown?, rung?);
    let playing = sheet.rows.iter().filter(|row| row[shown] == "playing");
    playing.map(|row| Some(Row { seconds: row[seconds].parse().ok()?, rung: row[rung].parse().ok()? })).collect()
}

/// The rates from `settled` seconds after the first row on; None for less than two rows.
pub fn rates(rows: &[Row], settled: f64) -> Option<Rates> {
    const HALF: f64 = 0.5;
    // Of sums of seconds.
    const ROUNDING: f64 = 1e-9;
    let first = rows.first()?.seconds + settled;
    let rows: Vec<&Row> = rows.iter().filter(|row| row.seconds >= first).collect();
    let spans: Vec<(f64, usize)> = rows.windows(2).map(|two| (two[1].seconds - two[0].seconds, two[1].rung)).collect();
    let whole: f64 = spans.iter().map(|(span, _)| span).sum();
    if whole.is_nan() || whole <= 0.0 {
        return None;
    }
    // Over at least half a second, so that long frames count whole.
    let from = |k: usize| {
        let mut seconds = 0.0;
        let taken = spans[k..].iter().position(|(span, _)| {
            seconds += span;
            seconds >= HALF - ROUNDING
        })?;
        Some((taken + 1) as f64 / seconds)
    };
    let mean = spans.len() as f64 / whole;
    let least = (0..spans.len()).filter_map(from).fold(f64::INFINITY, f64::min);
    let shown = |rung: usize| spans.iter().filter(|(_, of)| *of == rung).map(|(span, _)| span).sum::<f64>();
    let rung = spans.iter().map(|(_, rung)| *rung).max_by(|a, b| shown(*a).total_cmp(&shown(*b)))?;
    Some(Rates { frames: spans.len(), mean, least: if least.is_finite() { least } else { mean }, rung })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(spans: &[(f64, usize)]) -> Vec<Row> {
        let mut seconds = 3.0;
        let first = Row { seconds, rung: 1 };
        let rest = spans.iter().map(|&(span, rung)| {
            seconds += span;
            Row { seconds, rung }
        });
        [first].into_iter().chain(rest).collect()
    }

    #[test]
    fn the_least_is_over_half_a_second() {
        let mut spans = vec![(0.05, 4); 40];
        spans.splice(20..25, [(0.1, 5); 5]);
        let found = rates(&rows(&spans), 0.0).expect("rates");
        assert_eq!((found.frames, found.rung), (40, 4));
        assert!((found.mean - 40.0 / 2.25).abs() < 1e-9 && (found.least - 10.0).abs() < 1e-6, "{found:?}");
        assert_eq!(rates(&rows(&[]), 0.0), None);
    }

    #[test]
    fn what_is_shown_first_does_not_count() {
        let mut spans = vec![(1.0, 1); 3];
        spans.extend([(0.1, 7); 30]);
        let found = rates(&rows(&spans), 3.0).expect("rates");
        assert_eq!((found.frames, found.rung), (30, 7));
    }

    #[test]
    fn only_play_is_read() {
        let mut sheet = Sheet::new(&["frame", "seconds", "milliseconds", "shown", "time", "rung"]);
        sheet.push(["0", "1.0", "5", "loading", "0", "0"]);
        sheet.push(["1", "2.5", "5", "playing", "0.5", "3"]);
        assert_eq!(read(&sheet), Some(vec![Row { seconds: 2.5, rung: 3 }]));
        assert_eq!(read(&Sheet::new(&["seconds"])), None);
    }
}
