//! The sheet `bodies`: what its rows are, how they are written and found.

use super::scenes::Kind;
use crate::chart::Sheet;
use crate::frame_times::FrameTimes;
use crate::frame_times::parts::{PASS, PROCESSOR, Spread};

/// The note that says how many image orders are drawn.
pub const ORDERS: &str = "image orders";
/// The columns. `whose` is what the row is of: the processor's work, the passes, or one of those below. Rows of memory
/// have bytes, all others times.
pub const COLUMNS: [&str; 8] = ["kind", "bodies", "whose", "part", "mean_ms", "median_ms", "worst_ms", "bytes"];
/// Whole frames.
pub const WHOLE: &str = "whole";
/// Memory of the device.
pub const MEMORY: &str = "memory";
/// A number of bodies that was not measured; the part says why.
pub const MISSING: &str = "missing";
/// The part that is the sum of all parts of one frame.
pub const TOGETHER: &str = "together";
/// The part that is the first frame, in which all is compiled.
pub const FIRST: &str = "first frame";
/// The part that is all memory of the device.
pub const ALL: &str = "all";
/// The part that is the largest buffer or texture alone.
pub const LARGEST: &str = "largest";

/// The rows of so many bodies.
pub(super) fn write(sheet: &mut Sheet, kind: Kind, bodies: u32, times: &FrameTimes) {
    let mut row = |whose: &str, part: &str, Spread { mean, median, worst }: Spread| {
        sheet.line(format_args!("{kind}|{bodies}|{whose}|{part}|{mean:.4}|{median:.4}|{worst:.4}|"));
    };
    row(WHOLE, FIRST, Spread::of(&[times.first]));
    row(WHOLE, "frame", times.parts.whole());
    for whose in [PROCESSOR, PASS] {
        row(whose, TOGETHER, times.parts.together(whose));
    }
    for (whose, part, spread) in times.parts.spreads() {
        row(whose, part, spread);
    }
    if let Some(memory) = &times.memory {
        for (part, bytes) in [(ALL, memory.all), (LARGEST, memory.largest)] {
            sheet.line(format_args!("{kind}|{bodies}|{MEMORY}|{part}||||{bytes}"));
        }
    }
}

/// The points (number, `column`) of a part, as the sheet `bodies` has them.
pub fn points(sheet: &Sheet, kind: &str, whose: &str, part: &str, column: &str) -> Vec<[f64; 2]> {
    let rows = sheet.of([("kind", kind), ("whose", whose), ("part", part)]);
    rows.map(|row| [sheet.number(row, "bodies"), sheet.number(row, column)]).collect()
}
