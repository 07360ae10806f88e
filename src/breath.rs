//! A page has one thread: long work on it lets the page go on in between. Elsewhere it is on a thread of its own and goes on at once. It
//! imports no floor, and every floor may import it.

/// Lets the page answer and paint, if that is due.
#[cfg(all(target_family = "wasm", feature = "game"))]
pub async fn breath() {
    use std::cell::Cell;
    use web_time::{Duration, Instant};

    /// So long the page may wait for an answer: two frames.
    const DUE: Duration = Duration::from_millis(33);
    thread_local! {
        static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
    }
    if LAST.get().is_none_or(|last| last.elapsed() > DUE) {
        crate::page::breath().await;
        LAST.set(Some(Instant::now()));
    }
}

/// Nobody waits.
#[cfg(not(all(target_family = "wasm", feature = "game")))]
pub async fn breath() {}
