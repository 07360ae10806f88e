//! The time that the processor works.

/// Milliseconds that all threads of this process that still run have run so far, on Linux.
pub fn processor_time() -> Option<f64> {
    let mut sum = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        // The first field is the time on a processor, in ns. A thread may end while we read.
        let Ok(text) = std::fs::read_to_string(task.ok()?.path().join("schedstat")) else { continue };
        sum += text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6;
    }
    Some(sum)
}
