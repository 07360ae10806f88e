//! Work where there is one thread: it goes on between frames, from one breath to the next.

use std::sync::{Arc, Mutex, PoisonError};

use super::Wake;

/// Work that goes on between frames.
#[derive(Debug)]
pub struct Job<T>(Arc<Mutex<Option<T>>>);

impl<T: Send + 'static> Job<T> {
    /// Begins the work; its end wakes who waits.
    pub fn begin<F: Future<Output = T> + 'static>(
        _: &str,
        wake: &Wake,
        work: impl FnOnce() -> F + Send + 'static,
    ) -> std::io::Result<Job<T>> {
        let (made, wake) = (Arc::new(Mutex::new(None)), wake.clone());
        let place = made.clone();
        wasm_bindgen_futures::spawn_local(async move {
            // After what the page is doing now.
            crate::page::breath().await;
            let made = work().await;
            *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
            wake.wake();
        });
        Ok(Job(made))
    }

    /// Whether [`join`](Job::join) has what was made.
    pub fn is_finished(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// What was made. Fails before the end: a page cannot wait.
    pub fn join(self) -> std::thread::Result<T> {
        let made = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        made.ok_or_else(|| Box::new("it is not done yet") as _)
    }
}
