//! Work where there is one thread: it is done when it is begun.

use bevy::platform::cell::SyncCell;

use super::Wake;

/// Work that is done.
pub struct Job<T>(SyncCell<T>);

impl<T> std::fmt::Debug for Job<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Job")
    }
}

impl<T: Send + 'static> Job<T> {
    /// Does the work; its end wakes who waits.
    pub fn begin(_: &str, wake: &Wake, work: impl FnOnce() -> T + Send + 'static) -> std::io::Result<Job<T>> {
        let made = work();
        wake.wake();
        Ok(Job(SyncCell::new(made)))
    }

    /// It is.
    pub fn is_finished(&self) -> bool {
        true
    }

    /// What was made.
    pub fn join(self) -> std::thread::Result<T> {
        Ok(SyncCell::to_inner(self.0))
    }
}
