//! How long the judge may take over a case, and what it says when that is over.

use std::time::{Duration, Instant};

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{Sampling, TracedPicture};

/// When a piece of work must be over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deadline {
    from: Instant,
    limit: Option<Duration>,
}

impl Deadline {
    /// There is none.
    pub fn never() -> Deadline {
        Deadline { from: Instant::now(), limit: None }
    }

    /// So many seconds from now.
    pub fn after(seconds: f64) -> Deadline {
        Deadline { from: Instant::now(), limit: Duration::try_from_secs_f64(seconds).ok() }
    }

    /// Whether it has passed.
    pub fn is_over(&self) -> bool {
        self.limit.is_some_and(|limit| self.from.elapsed() >= limit)
    }

    /// Seconds that are left, if there is a limit.
    fn left(&self) -> Option<f64> {
        self.limit.map(|limit| limit.saturating_sub(self.from.elapsed()).as_secs_f64())
    }

    /// An error if it has passed during the work `what`, in words.
    pub fn check(&self, what: &str) -> Result<(), GaveUp> {
        if self.is_over() { Err(self.gave_up(what.to_owned())) } else { Ok(()) }
    }

    fn gave_up(&self, what: String) -> GaveUp {
        GaveUp { seconds: self.limit.unwrap_or_default().as_secs_f64(), what }
    }
}

/// The judge has given up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the judge gave up after {seconds} s: {what}")]
pub struct GaveUp {
    /// The limit, in seconds.
    pub seconds: f64,
    /// What it was at.
    pub what: String,
}

/// The judge's picture, without the sky, if it is finished before the deadline.
pub fn trace_within(case: &Case, sampling: &Sampling, deadline: &Deadline) -> Result<TracedPicture, GaveUp> {
    case.trace_within(sampling, false, deadline.left(), &|_| {})
        .map_err(|late| deadline.gave_up(format!("its picture was not finished ({} of {} pixels were)", late.pixels, late.all)))
}
