//! The chart `bvh`: tracers of straight rays on the scenes of Sei 2008, all in one process and on one thread.

mod check;
mod contest;
mod draw;
#[cfg(feature = "embree")]
mod embree;
pub mod others;
mod rays;

use std::path::PathBuf;

use clap::Args;
use lensrunner::argument::whole;

use crate::chart::{ChartError, Output, Sheet, interleaved_by, thread_time, times_the_first};
use crate::straight::Hit;
use rays::{Job, SCENES};

/// Tracers of straight rays on one thread: ours, those of Sei 2008, the crates obvhs and bvh, and Embree in a build with the feature
/// embree.
#[derive(Args, Clone, Debug)]
pub struct BvhRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Scenes: balls4A, balls4B, balls4C, tree10, castle, bunny.
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "bunny,castle,tree10,balls4A,balls4B,balls4C")]
    pub scenes: Vec<String>,
    /// How often each method runs; the median counts.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole::<usize>(1, 255))]
    pub rounds: usize,
    /// The Stanford bunny, binary PLY of triangles; without it a blob of as many triangles takes its place.
    #[arg(long, value_name = "FILE.ply", default_value = "../shared/data/bunny.ply")]
    pub bunny: PathBuf,
    /// Compares hits instead of timing: all methods with each other, 2,000 rays and every dispute with brute force in f64.
    #[arg(long)]
    pub check: bool,
}

/// How many times as often as everything else runs what is compared with 8 × 8: single percents are to be told apart there.
const MORE_ROUNDS: usize = 10;

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &BvhRequest) -> Result<Vec<PathBuf>, ChartError> {
    if let Some(unknown) = request.scenes.iter().find(|name| !SCENES.contains(&name.as_str())) {
        return Err(ChartError::Input(format!("--scenes {unknown}: unknown; there are {}", SCENES.join(", "))));
    }
    if request.check {
        let wrong = request.scenes.iter().map(|name| check::check(&Job::new(name, &request.bunny)?)).sum::<Result<usize, ChartError>>()?;
        return if wrong == 0 { Ok(Vec::new()) } else { Err(ChartError::Failed(format!("{wrong} hits are wrong"))) };
    }
    let sheet = request.output.sheet("bvh", || measure(request))?;
    let files = draw::draw(&sheet).save(&request.output.folder, "bvh")?;
    Ok(files.into_iter().chain([request.output.csv("bvh")]).collect())
}

const COLUMNS: [&str; 10] =
    ["scene", "triangles", "rays", "method", "packet", "Mrays_per_s", "best_Mrays_per_s", "times_obvhs", "time_over_8x8", "hits"];

fn measure(request: &BvhRequest) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(&COLUMNS, "");
    for name in &request.scenes {
        let job = Job::new(name, &request.bunny)?;
        let triangles = job.scene.triangles.len();
        eprintln!("{name}: {triangles} triangles{}", if job.stand_in { " (stand-in)" } else { "" });
        let built = contest::Built::new(&job)?;
        let mut entries = contest::entries(&job, &built);
        let compared: Vec<usize> =
            (0..entries.len()).filter(|&i| entries[i].kind == "primary" && entries[i].method == "ours" && entries[i].packet >= 8).collect();
        let mut met = vec![0; entries.len()];
        let mut runs: Vec<_> = entries
            .iter_mut()
            .zip(&mut met)
            .map(|(entry, met)| {
                let mut hits = vec![Hit::MISS; entry.rays];
                move || {
                    (entry.trace)(&mut hits);
                    *met = hits.iter().filter(|hit| hit.is_hit()).count();
                }
            })
            .collect();
        let mut contestants: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run as &mut dyn FnMut()).collect();
        let times = interleaved_by(thread_time, &mut contestants, request.rounds);
        // The sizes of ours from 8 × 8 on once more, back to back.
        let mut contestants: Vec<_> =
            contestants.into_iter().enumerate().filter(|(i, _)| compared.contains(i)).map(|(_, contestant)| contestant).collect();
        let over = times_the_first(thread_time, &mut contestants, MORE_ROUNDS * request.rounds);
        drop(contestants);
        drop(runs);
        let speed = |i: usize, seconds: f64| entries[i].rays as f64 / seconds * 1e-6;
        for (i, entry) in entries.iter().enumerate() {
            let bar = entries.iter().position(|e| e.kind == entry.kind && e.method == "obvhs");
            let times_obvhs = bar.map_or(f64::NAN, |bar| speed(i, times[i].median) / speed(bar, times[bar].median));
            let over_8x8 = compared.iter().position(|&size| size == i).map_or(f64::NAN, |place| over[place]);
            let (kind, method, packet, [median, best]) =
                (entry.kind, entry.method, entry.packet, [times[i].median, times[i].least].map(|seconds| speed(i, seconds)));
            sheet.line(format_args!(
                "{name}|{triangles}|{kind}|{method}|{packet}|{median:.3}|{best:.3}|{times_obvhs:.3}|{over_8x8:.3}|{}",
                met[i]
            ));
        }
    }
    Ok(sheet)
}
