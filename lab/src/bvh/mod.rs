//! The chart `bvh`: tracers of straight rays on the scenes of Sei 2008, all in one process and on one thread.

mod check;
mod contest;
mod draw;
#[cfg(feature = "embree")]
mod embree;
pub mod others;
mod rays;
mod request;

use std::path::PathBuf;

use super::chart::{Provenance, Sheet, interleaved_by, thread_time, times_the_first};
use rays::Job;

pub use request::{BvhRequest, ChartError};

/// How many times as often as everything else runs what is compared with 8 × 8: single percents are to be told apart there.
const MORE_ROUNDS: usize = 10;

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &BvhRequest) -> Result<Vec<PathBuf>, ChartError> {
    if let Some(unknown) = request.scenes.iter().find(|name| !request::ALL.contains(&name.as_str())) {
        return Err(ChartError::Scene(unknown.clone()));
    }
    if request.check {
        let wrong = request.scenes.iter().map(|name| check::check(&Job::new(name, request)?)).sum::<Result<usize, ChartError>>()?;
        return if wrong == 0 { Ok(Vec::new()) } else { Err(ChartError::Wrong(wrong)) };
    }
    let sheet = request.output.sheet("bvh", || measure(request))?;
    let files = draw::draw(&sheet).save(&request.output.folder, "bvh")?;
    Ok(files.into_iter().chain([request.output.csv("bvh")]).collect())
}

fn measure(request: &BvhRequest) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(&[
        "scene",
        "triangles",
        "rays",
        "method",
        "packet",
        "Mrays_per_s",
        "best_Mrays_per_s",
        "times_obvhs",
        "time_over_8x8",
        "hits",
    ]);
    sheet.notes = Provenance::now("").notes();
    for name in &request.scenes {
        let job = Job::new(name, request)?;
        eprintln!("{name}: {} triangles{}", job.scene.triangles.len(), if job.stand_in { " (stand-in)" } else { "" });
        let built = contest::Built::new(&job)?;
        let mut entries = contest::entries(&job, &built);
        let compared: Vec<bool> = entries.iter().map(|e| e.kind == "primary" && e.method == "ours" && e.packet >= 8).collect();
        let mut hits = vec![0; entries.len()];
        let mut runs: Vec<_> = entries.iter_mut().zip(&mut hits).map(|(entry, hits)| move || *hits = (entry.run)()).collect();
        let mut contestants: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run as &mut dyn FnMut()).collect();
        let times = interleaved_by(thread_time, &mut contestants, request.rounds);
        drop(contestants);
        // The sizes of ours from 8 × 8 on once more, back to back.
        let sizes: Vec<usize> = (0..compared.len()).filter(|&i| compared[i]).collect();
        let mut contestants: Vec<&mut dyn FnMut()> =
            runs.iter_mut().zip(&compared).filter(|(_, compared)| **compared).map(|(run, _)| run as &mut dyn FnMut()).collect();
        let over = times_the_first(thread_time, &mut contestants, MORE_ROUNDS * request.rounds);
        drop(contestants);
        drop(runs);
        let speed = |i: usize, seconds: f64| entries[i].rays as f64 / seconds * 1e-6;
        for (i, entry) in entries.iter().enumerate() {
            let bar = entries.iter().position(|e| e.kind == entry.kind && e.method == "obvhs");
            let times_obvhs = bar.map_or(f64::NAN, |bar| speed(i, times[i].median) / speed(bar, times[bar].median));
            let over_8x8 = sizes.iter().position(|&size| size == i).map_or(f64::NAN, |place| over[place]);
            sheet.push([
                name.clone(),
                job.scene.triangles.len().to_string(),
                entry.kind.to_owned(),
                entry.method.clone(),
                entry.packet.to_string(),
                format!("{:.3}", speed(i, times[i].median)),
                format!("{:.3}", speed(i, times[i].least)),
                format!("{times_obvhs:.3}"),
                format!("{over_8x8:.3}"),
                hits[i].to_string(),
            ]);
        }
    }
    Ok(sheet)
}
