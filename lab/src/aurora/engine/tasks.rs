//! How threads share the electrons of a picture, and how they are woken.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::aurora::sheet::Streak;

/// Electrons walked before their points are drawn: some 2,000 points, which nearly fit into a processor's first cache.
const TASK: usize = 64;

/// The electrons, in as many parts as there are threads. Each thread takes its own part, task by task, as neighbours in the list are
/// neighbours in the picture: so each has pixels of its own in its caches, and there are fewer that two threads have drawn in and must be
/// summed. Then it takes what others have left, as no thread is woken at once and none is as fast as the other.
#[derive(Debug)]
pub struct Tasks<'a> {
    /// The electrons of each part.
    parts: Vec<&'a [Streak]>,
    /// The next task of each part.
    next: Vec<AtomicUsize>,
    /// Tasks that are done.
    done: AtomicUsize,
    count: usize,
}

impl<'a> Tasks<'a> {
    /// For so many threads, at least one. Whatever their number, tasks are the same: points are joined within a task, and else the picture
    /// would be another.
    pub fn new(streaks: &'a [Streak], threads: usize) -> Self {
        let share = streaks.len().div_ceil(TASK).div_ceil(threads.max(1)).max(1) * TASK;
        let parts: Vec<&[Streak]> = streaks.chunks(share).collect();
        let count = parts.iter().map(|part| part.len().div_ceil(TASK)).sum();
        Tasks { next: parts.iter().map(|_| AtomicUsize::new(0)).collect(), parts, done: AtomicUsize::new(0), count }
    }

    /// Whether there are none at all.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// What the `thread`-th thread takes.
    pub fn taker(&self, thread: usize) -> Taker<'_, 'a> {
        Taker { tasks: self, thread, taken: 0 }
    }

    /// Waits, awake, until all tasks that any thread has taken are done, or given up by a panic.
    pub fn wait(&self) {
        while self.done.load(Ordering::Acquire) < self.count {
            std::thread::yield_now();
        }
    }
}

/// The tasks of one thread. They count as done when this is dropped, if only by a panic, so that no other thread waits for ever.
#[derive(Debug)]
pub struct Taker<'t, 'a> {
    tasks: &'t Tasks<'a>,
    thread: usize,
    taken: usize,
}

impl<'a> Iterator for Taker<'_, 'a> {
    type Item = &'a [Streak];

    fn next(&mut self) -> Option<&'a [Streak]> {
        let Tasks { parts, next, .. } = self.tasks;
        for part in (0..parts.len()).map(|k| (self.thread + k) % parts.len()) {
            let task = next[part].fetch_add(1, Ordering::Relaxed);
            if let Some(some) = parts[part].chunks(TASK).nth(task) {
                self.taken += 1;
                return Some(some);
            }
        }
        None
    }
}

impl Drop for Taker<'_, '_> {
    fn drop(&mut self) {
        self.tasks.done.fetch_add(self.taken, Ordering::Release);
    }
}

/// Does `work` for each of `parts`, with its number, on a thread of its own. This thread takes the first itself: the others alone have to
/// be woken.
pub fn on_threads<T: Send>(parts: impl Iterator<Item = T>, work: impl Fn(usize, T) + Sync) {
    let mut parts = parts.enumerate();
    rayon::in_place_scope(|scope| {
        let own = parts.next();
        let work = &work;
        for (number, part) in parts {
            scope.spawn(move |_| work(number, part));
        }
        if let Some((number, part)) = own {
            work(number, part);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aurora::sheet::Sheet;

    #[test]
    fn every_electron_is_taken_once_whoever_is_late() {
        let streaks = Sheet::numbered(0).streaks(1000);
        for (threads, count) in [(1, 1000), (2, 1000), (3, 65), (5, 200), (16, 1000), (2, 0), (4, 1)] {
            let tasks = Tasks::new(&streaks[..count], threads);
            assert_eq!(tasks.is_empty(), count == 0);
            let own = tasks.parts.iter().flat_map(|part| part.chunks(TASK).map(|some| some.iter().map(|streak| streak.id)));
            let one = streaks[..count].chunks(TASK).map(|some| some.iter().map(|streak| streak.id));
            assert!(own.map(Vec::from_iter).eq(one.map(Vec::from_iter)), "{threads} threads have other tasks than one");
            let mut takers: Vec<Taker> = (0..threads).map(|thread| tasks.taker(thread)).collect();
            let mut taken: Vec<u32> = Vec::new();
            // The last thread takes one task for two of the one before, and so on; the first comes when all others have done.
            let mut left = true;
            while left {
                left = false;
                for (k, taker) in takers.iter_mut().enumerate().skip(1) {
                    for some in taker.take(threads - k) {
                        taken.extend(some.iter().map(|streak| streak.id));
                        left = true;
                    }
                }
            }
            taken.extend(takers[0].by_ref().flatten().map(|streak| streak.id));
            taken.sort_unstable();
            let mut all: Vec<u32> = streaks[..count].iter().map(|streak| streak.id).collect();
            all.sort_unstable();
            assert_eq!(taken, all, "{threads} threads, {count} electrons");
            drop(takers);
            tasks.wait();
        }
    }

    #[test]
    fn threads_begin_in_different_parts() {
        let streaks = Sheet::numbered(0).streaks(1000);
        assert!(streaks.is_sorted_by(|a, b| a.top.x <= b.top.x), "electrons go from west to east");
        let tasks = Tasks::new(&streaks, 3);
        for (thread, first) in [(0, 0), (1, 300), (2, 700)] {
            let own = tasks.taker(thread).next().and_then(|some| some.first()).map_or(f32::NAN, |streak| streak.top.x);
            assert!(own >= streaks[first].top.x && own <= streaks[first + 100].top.x, "thread {thread} begins at {own} km");
        }
    }
}
