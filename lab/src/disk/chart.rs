//! The chart `disk`: the two tables of Yamashita 2025 with the error of the picture beside each time, and speed against error.
//!
//! Table 1: each representation alone, seen from 80°, and its error from other places. Table 2: one scripted chase through all situations,
//! the same for every row (`chase.rs`); and the same, asked for, frame by frame (`flight.rs`).

use super::bench::Bench;
use super::request::{DiskContestant, DiskRequest, MeasuredView, REFERENCE, TIME, contestants, eye, own, passes};
use lensrunner::spacetime::Observer;
use std::path::PathBuf;

use glam::DVec3;

use crate::chart::{ChartError, Sheet, quantile};
use lensrunner::render::Gpu;
use lensrunner::scene::{self, disk::Gas};

use super::chase::{chase, summary};
use super::draw::figure;
use super::error::{DiskPictureError, compare, peak};
use super::exact::picture;
use super::flight::{self, flight};
use super::places::errors_by_place;

/// Measures (or reads what was measured before) and draws; returns the files written.
pub fn run(request: &DiskRequest) -> Result<Vec<PathBuf>, ChartError> {
    if request.output.redraw {
        let [alone, chase] = ["disk-alone", "disk-chase"].map(|name| Sheet::load(&request.output.csv(name)));
        let (alone, chase) = (alone?, chase?);
        return Ok(figure(&alone, &chase, &summary(&chase)).save(&request.output.folder, "disk")?.to_vec());
    }
    let (config, gpu) = (&scene::config::find(None)?, Gpu::headless()?);
    let contestants = contestants(config);
    let bench = &mut Bench::new(gpu, &contestants, request.size);
    let alone = request.output.sheet("disk-alone", || alone(request, &contestants, bench))?;
    let chase = request.output.sheet("disk-chase", || chase(request, &contestants, bench))?;
    request.output.sheet("disk-places", || errors_by_place(request, &contestants, bench))?;
    let summary = summary(&chase);
    summary.save(&request.output.csv("disk-summary"))?;
    let figure = figure(&alone, &chase, &summary);
    let mut files = figure.save(&request.output.folder, "disk")?.to_vec();
    files.extend(["disk-alone", "disk-chase", "disk-summary", "disk-places"].map(|name| request.output.csv(name)));
    if request.flight > 0 {
        let flown = request.output.sheet("disk-flight", || flight(request, config, bench))?;
        flight::summary(&flown).save(&request.output.csv("disk-flight-summary"))?;
        files.extend(["disk-flight", "disk-flight-summary"].map(|name| request.output.csv(name)));
    }
    Ok(files)
}

/// From 80° at 27 r_s, as the scene `disk`.
fn portrait() -> Observer {
    let position = DVec3::new(0.0, -26.5898, 4.6885);
    eye(position, -position)
}

fn alone(request: &DiskRequest, contestants: &[DiskContestant], bench: &mut Bench) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(
        &["contestant", "family", "disk_ms", "passes_ms", "wall_ms", "against_arcs_4200", "psnr_db", "flip", "mean_difference"],
        bench.adapter(),
    );
    let view = MeasuredView { eye: portrait(), time: TIME, sky: false, counted: false };
    let named = contestants.iter().position(|contestant| contestant.name == REFERENCE);
    let reference = named.ok_or_else(|| ChartError::Failed(format!("no contestant is called {REFERENCE:?}")))?;
    let base = &contestants[0].config;
    let truth = picture(&Gas::new(&base.disk, base.hole.mass_solar), &view.eye, request.error_size, TIME, 3, 6);
    let mut errors: Vec<DiskPictureError> = Vec::new();
    for number in 0..contestants.len() {
        let shown = bench.frame(Some(number), &view, Some(request.error_size))?;
        errors.push(compare(&shown.picture, &truth, request.error_size, peak(&truth)));
    }
    let mut times = vec![[const { Vec::new() }; 3]; contestants.len()];
    for _ in 0..request.rounds {
        let without = bench.timed(None, &view)?;
        for (number, [own_times, pass_times, whole]) in times.iter_mut().enumerate() {
            let shown = bench.timed(Some(number), &view)?;
            own_times.push(own(&shown, &without));
            pass_times.push(passes(&shown));
            whole.push(shown.whole);
        }
    }
    let against = times[reference][0].clone();
    for ((contestant, error), [own_times, pass_times, whole]) in contestants.iter().zip(errors).zip(&times) {
        // Round by round, for what else runs on the machine changes from round to round.
        let ratios: Vec<f64> = own_times.iter().zip(&against).map(|(own, reference)| own / reference).collect();
        let medians = [own_times, pass_times, whole, &ratios].map(|times| format!("{:.3}", quantile(times.iter().copied(), 0.5))).join("|");
        let (DiskContestant { name, family, .. }, DiskPictureError { psnr, flip, relative }) = (contestant, error);
        sheet.line(format_args!("{name}|{family}|{medians}|{psnr:.2}|{flip:.4}|{relative:.4}"));
    }
    Ok(sheet)
}
