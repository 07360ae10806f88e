//! Work on a thread of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

use bevy::tasks::block_on;

use super::Wake;

/// Work on a thread of its own.
#[derive(Debug)]
pub struct Job<T> {
    thread: JoinHandle<T>,
    ended: Arc<AtomicBool>,
}

/// Says at the end of a thread, a bad one too, that it ends.
struct Ends(Arc<AtomicBool>, Wake);

impl Drop for Ends {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
        self.1.wake();
    }
}

impl<T: Send + 'static> Job<T> {
    /// Begins work on a thread of this name; its end wakes who waits.
    pub fn begin<F: Future<Output = T>>(name: &str, wake: &Wake, work: impl FnOnce() -> F + Send + 'static) -> std::io::Result<Job<T>> {
        let ended = Arc::new(AtomicBool::new(false));
        let ends = Ends(ended.clone(), wake.clone());
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _ends = ends;
            block_on(work())
        })?;
        Ok(Job { thread, ended })
    }

    /// Whether [`join`](Job::join) does not wait any more.
    pub fn is_finished(&self) -> bool {
        self.ended.load(Ordering::Acquire)
    }

    /// What was made, or how the thread ended.
    pub fn join(self) -> std::thread::Result<T> {
        self.thread.join()
    }
}
