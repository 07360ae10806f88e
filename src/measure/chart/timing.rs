//! Times measured side by side.

use std::time::Instant;

/// What a run took, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// The middle one.
    pub median: f64,
    /// The shortest.
    pub least: f64,
    /// The longest.
    pub most: f64,
}

impl Timing {
    /// Of some times in seconds; all zero if there is none.
    pub fn of(mut seconds: Vec<f64>) -> Timing {
        seconds.sort_by(f64::total_cmp);
        match (seconds.first(), seconds.last()) {
            (Some(&least), Some(&most)) => Timing { median: seconds[seconds.len() / 2], least, most },
            _ => Timing::default(),
        }
    }
}

/// Times every contestant `rounds` times, one after another in each round, so that whatever else the machine does falls on all of
/// them alike; one more round before is thrown away. Each runs on the calling thread.
pub fn interleaved(contestants: &mut [&mut dyn FnMut()], rounds: usize) -> Vec<Timing> {
    let mut seconds = vec![Vec::with_capacity(rounds); contestants.len()];
    for round in 0..=rounds.max(1) {
        for (run, times) in contestants.iter_mut().zip(&mut seconds) {
            let start = Instant::now();
            run();
            if round > 0 {
                times.push(start.elapsed().as_secs_f64());
            }
        }
    }
    seconds.into_iter().map(Timing::of).collect()
}
