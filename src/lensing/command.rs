//! The subcommand `bake`.

use std::io::Write;
use std::path::PathBuf;
use web_time::Instant;

use super::score::{Points, Spread, score};
use super::{Scheme, bake};
use crate::user_file::check_writable;

/// A line on standard output. A reader that has gone away is no reason to stop: the file is written all the same.
macro_rules! say {
    ($($words:tt)*) => {
        _ = writeln!(std::io::stdout(), $($words)*)
    };
}

/// What `bake` is asked for.
#[derive(Clone, Debug)]
pub struct BakeRequest {
    /// Nodes along each axis, at least 5 (twice as many angles in the scheme residual).
    pub nodes: usize,
    /// What to store.
    pub scheme: Scheme,
    /// The file to write.
    pub output: PathBuf,
    /// Random points for each order to measure the error on.
    pub points: usize,
}

/// Bakes with a progress bar, writes the file, prints size, time and the error on fresh random points.
pub fn run(args: &BakeRequest) -> Result<(), super::TableError> {
    check_writable(&args.output).map_err(|error| super::TableError::Io(args.output.clone(), error))?;
    let style =
        indicatif::ProgressStyle::with_template("{bar:40} {percent} % {msg}").unwrap_or_else(|_| indicatif::ProgressStyle::default_bar());
    let bar = indicatif::ProgressBar::new(1000).with_style(style).with_message("baking");
    let finished = std::sync::Mutex::new(0.0);
    let start = Instant::now();
    let table = bake(args.scheme, args.nodes, |share| {
        if let Ok(mut sum) = finished.lock() {
            *sum += 1000.0 * share;
            bar.set_position(*sum as u64);
        }
    });
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    table.save(&args.output)?;
    let size = table.to_bytes().len() as f64 / (1024.0 * 1024.0);
    say!("{}: scheme {}, {:?} nodes, {size:.2} MiB, baked in {seconds:.1} s", args.output.display(), args.scheme.name(), table.size);
    if args.points == 0 {
        return Ok(());
    }
    let seed = web_time::SystemTime::now().duration_since(web_time::UNIX_EPOCH).map_or(0, |d| d.as_nanos() as u64);
    for (points, name) in [(Points::Adversarial, "adversarial"), (Points::Friendly, "friendly")] {
        if points == Points::Adversarial && args.scheme != Scheme::Residual {
            continue;
        }
        say!("{name} points, {} for each order: max, 99.9 %, rms; at r, φ, L", args.points);
        for (i, s) in score(&table, points, args.points, seed).iter().enumerate() {
            let order = i + 1;
            line(order, "angle, degrees", s.angle);
            line(order, "delay, r ≥ 1.05", s.delay);
            line(order, "delay, r < 1.05", s.delay_near);
            if args.scheme == Scheme::Residual {
                line(order, "delay / allowed", s.delay_share);
                line(order, "emission, degrees", s.emission);
            }
        }
    }
    Ok(())
}

fn line(order: usize, what: &str, s: Spread) {
    // No point of that kind.
    if s.worst == [0.0; 3] {
        return;
    }
    let [r, phi, l] = s.worst;
    say!("  order {order}  {what:18} {:10.6} {:10.6} {:10.7}   at {r:.5}, {phi:.5}, {l:.5}", s.max, s.most, s.rms);
}
