//! How long the judge may take over a case, and what it says when that is over.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::measure::trace::Case;
use crate::reference::picture::{Picture, Quality};

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

/// The judge's picture, without the sky, if it is finished before the deadline. This is the one place where the judge learns of it.
pub fn trace_within(case: &Case, quality: &Quality, deadline: &Deadline) -> Result<Picture, GaveUp> {
    let done = AtomicU64::new(0);
    let total = u64::from(case.camera.size[0]) * u64::from(case.camera.size[1]);
    // The judge ends no ray early, so it is left between two bands of rows, by a jump that no panic hook hears of.
    let step = |pixels: u64| {
        let before = done.load(Ordering::Relaxed);
        if before + pixels < total && deadline.is_over() {
            resume_unwind(Box::new(Over));
        }
        done.fetch_add(pixels, Ordering::Relaxed);
    };
    catch_unwind(AssertUnwindSafe(|| case.trace(quality, false, &step))).map_err(|other| {
        if !other.is::<Over>() {
            resume_unwind(other);
        }
        deadline.gave_up(format!("its picture was not finished ({} of {total} pixels were)", done.load(Ordering::Relaxed)))
    })
}

/// What the jump carries.
struct Over;
