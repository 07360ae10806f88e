//! Work on threads of its own while something else is shown, and what wakes who waits for it. A page has one thread: there the work goes on
//! between frames, wherever it takes a [breath](crate::breath).

#[cfg(target_family = "wasm")]
mod page;
#[cfg(not(target_family = "wasm"))]
mod thread;

#[cfg(target_family = "wasm")]
pub use page::Job;
#[cfg(not(target_family = "wasm"))]
pub use thread::Job;

use std::sync::{Arc, Condvar, Mutex, PoisonError};
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_job_wakes() {
        let wake = Wake::default();
        let begin = web_time::Instant::now();
        let job = Job::begin("job", &wake, async || 5).unwrap();
        wake.wait(Duration::from_secs(60));
        assert!(job.is_finished() && begin.elapsed() < Duration::from_secs(50));
        assert_eq!(job.join().unwrap(), 5);
        // One that ends badly too; and what came before one waits is not missed.
        let job = Job::<()>::begin("bad job", &wake, async || std::panic::resume_unwind(Box::new(()))).unwrap();
        wake.wait(Duration::from_secs(60));
        assert!(job.is_finished() && job.join().is_err());
        wake.wake();
        wake.wait(Duration::from_secs(60));
        assert!(begin.elapsed() < Duration::from_secs(50));
        // Without news one waits no longer than was said.
        wake.wait(Duration::from_millis(1));
    }
}
