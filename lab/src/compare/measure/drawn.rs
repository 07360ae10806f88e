//! How a contestant draws its images: by coverage, or by what it meets in pixels' centres.

use std::collections::HashSet;

use crate::compare::{ContestantFrame, Shown};

/// Objects and orders that are drawn by coverage somewhere.
pub(super) fn drawn_by_coverage(frame: &ContestantFrame) -> HashSet<(u32, u32)> {
    frame.shown.iter().filter(|shown| shown.object > 0 && shown.coverage < 1.0).map(Shown::image).collect()
}

/// Objects and orders that are shown, and nowhere by coverage. They show what is in the centre of each pixel, so that a line along a row of
/// pixels is there in all of them or in none: the judge's single rays tell whether it is right, and more rays do not.
pub(super) fn drawn_by_centres(frame: &ContestantFrame) -> HashSet<(u32, u32)> {
    let by_coverage = drawn_by_coverage(frame);
    let all = frame.shown.iter().filter(|shown| shown.object > 0).map(Shown::image);
    all.filter(|image| !by_coverage.contains(image)).collect()
}
