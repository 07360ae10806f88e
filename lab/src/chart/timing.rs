//! Times measured side by side.

use std::sync::OnceLock;
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

/// The value that the share `q` of `values` does not exceed, interpolated between neighbours; NaN of none.
pub fn quantile(values: impl IntoIterator<Item = f64>, q: f64) -> f64 {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q * last as f64;
    let (below, share) = (at as usize, at.fract());
    if share > 0.0 { sorted[below] + share * (sorted[below + 1] - sorted[below]) } else { sorted[below] }
}

/// The mean; 0 of none.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// The least and the greatest of those that are finite; [∞, 0] of none.
pub fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold([f64::INFINITY, 0.0], |[least, most], value| [least.min(value), most.max(value)])
}

/// Times every contestant `rounds` times, one after another in each round, so that whatever else the machine does falls on all of
/// them alike; one more round before is thrown away. Each runs on the calling thread.
pub fn interleaved(contestants: &mut [&mut dyn FnMut()], rounds: usize) -> Vec<Timing> {
    interleaved_by(wall_time, contestants, rounds)
}

/// The same by another clock, which gives seconds.
pub fn interleaved_by(clock: fn() -> f64, contestants: &mut [&mut dyn FnMut()], rounds: usize) -> Vec<Timing> {
    let mut seconds = vec![Vec::with_capacity(rounds); contestants.len()];
    for round in 0..=rounds.max(1) {
        for (run, times) in contestants.iter_mut().zip(&mut seconds) {
            let start = clock();
            run();
            if round > 0 {
                times.push(clock() - start);
            }
        }
    }
    seconds.into_iter().map(Timing::of).collect()
}

/// How often the time of the first each of the others takes: the medians over `rounds` of ratios within one round, whose order is turned
/// round each time. One more round before is thrown away. Finer than a ratio of medians where the machine changes its speed from second to
/// second.
pub fn times_the_first(clock: fn() -> f64, contestants: &mut [&mut dyn FnMut()], rounds: usize) -> Vec<f64> {
    let number = contestants.len();
    let mut ratios = vec![Vec::with_capacity(rounds); number];
    let mut seconds = vec![0.0; number];
    for round in 0..=rounds.max(1) {
        for place in 0..number {
            let i = if round % 2 == 0 { place } else { number - 1 - place };
            let start = clock();
            contestants[i]();
            seconds[i] = clock() - start;
        }
        if round > 0 {
            for (ratios, time) in ratios.iter_mut().zip(&seconds) {
                ratios.push(time / seconds[0]);
            }
        }
    }
    ratios.into_iter().map(|ratios| Timing::of(ratios).median).collect()
}

/// Seconds that have passed since some moment.
pub fn wall_time() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Seconds that the calling thread has had a processor, so that a busy machine does not count; [`wall_time`] where that is not known.
pub fn thread_time() -> f64 {
    #[cfg(all(target_os = "linux", target_pointer_width = "64"))]
    {
        /// Of the system's C library.
        #[repr(C)]
        struct Timespec {
            seconds: i64,
            nanoseconds: i64,
        }
        const CLOCK_THREAD_CPUTIME_ID: i32 = 3;
        #[allow(unsafe_code)]
        // SAFETY: declared as in <time.h> of 64-bit Linux; every Rust program there is linked with it.
        unsafe extern "C" {
            fn clock_gettime(clock: i32, time: *mut Timespec) -> i32;
        }
        let mut time = Timespec { seconds: 0, nanoseconds: 0 };
        #[allow(unsafe_code)]
        // SAFETY: it writes one timespec, and `time` is one.
        if unsafe { clock_gettime(CLOCK_THREAD_CPUTIME_ID, &mut time) } == 0 {
            return time.seconds as f64 + time.nanoseconds as f64 * 1e-9;
        }
    }
    wall_time()
}
