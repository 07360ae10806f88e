//! Work on threads of its own while something else is shown, and what wakes who waits for it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use bevy::prelude::Resource;

/// Wakes who waits for what is made on threads. Both worlds have it.
#[derive(Resource, Clone, Debug, Default)]
pub struct Wake(Arc<(Mutex<bool>, Condvar)>);

impl Wake {
    /// There is something new: who waits goes on, and who would wait next does not.
    pub fn wake(&self) {
        let (is_new, waiting) = &*self.0;
        *is_new.lock().unwrap_or_else(PoisonError::into_inner) = true;
        waiting.notify_all();
    }

    /// Waits until there is something new, but no longer than this.
    pub fn wait(&self, most: Duration) {
        let (is_new, waiting) = &*self.0;
        let guard = is_new.lock().unwrap_or_else(PoisonError::into_inner);
        let (mut is_new, _) = waiting.wait_timeout_while(guard, most, |is_new| !*is_new).unwrap_or_else(PoisonError::into_inner);
        *is_new = false;
    }
}

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
    pub fn begin(name: &str, wake: &Wake, work: impl FnOnce() -> T + Send + 'static) -> std::io::Result<Job<T>> {
        let ended = Arc::new(AtomicBool::new(false));
        let ends = Ends(ended.clone(), wake.clone());
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _ends = ends;
            work()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_job_wakes() {
        let wake = Wake::default();
        let begin = std::time::Instant::now();
        let job = Job::begin("job", &wake, || 5).unwrap();
        wake.wait(Duration::from_secs(60));
        assert!(job.is_finished() && begin.elapsed() < Duration::from_secs(50));
        assert_eq!(job.join().unwrap(), 5);
        // One that ends badly too; and what came before one waits is not missed.
        let job = Job::<()>::begin("bad job", &wake, || std::panic::resume_unwind(Box::new(()))).unwrap();
        wake.wait(Duration::from_secs(60));
        assert!(job.is_finished() && job.join().is_err());
        wake.wake();
        wake.wait(Duration::from_secs(60));
        assert!(begin.elapsed() < Duration::from_secs(50));
        // Without news one waits no longer than was said.
        wake.wait(Duration::from_millis(1));
    }
}
