//! Table 2: the scripted chase, each way to draw the disk at every place of it, with the error beside each time.

use crate::chart::{ChartError, Sheet, mean, quantile};
use lensrunner::scene::disk::Gas;

use super::bench::Bench;
use super::error::{DiskPictureError, compare, peak};
use super::exact::picture;
use super::request::{DISK_PASSES, DiskContestant, DiskRequest, MeasuredView, own};
use super::script::script;

/// The exact picture has this many samples squared in a pixel.
const SAMPLES: u32 = 3;

/// A picture is exposed for its own peak, but for no less than this part of the brightest one's along the way: in the plane itself the disk
/// is seen edge on, from within its gas, and has a hundred-thousandth of its light. Nothing brings that to white.
const LEAST_PEAK: f32 = 0.01;

/// A row for each place and contestant. The frames that are timed have stars and the Milky Way behind the disk, as in the game; the
/// pictures that are compared show the disk alone. Times are medians of the rounds, in which all take turns.
pub(super) fn chase(request: &DiskRequest, contestants: &[DiskContestant], bench: &mut Bench) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(
        &[
            "contestant", "family", "step", "situation", "frame_ms", "wall_ms", "disk_ms", "arcs_ms", "mesh_ms", "draw_ms", "psnr_db",
            "flip",
        ],
        bench.adapter(),
    );
    let base = &contestants[0].config;
    let gas = Gas::new(&base.disk, base.hole.mass_solar);
    let steps = request.steps.max(2);
    let runners: Vec<(usize, &DiskContestant)> = contestants.iter().enumerate().filter(|(_, contestant)| contestant.family != 3).collect();
    let places: Vec<_> = (0..steps).map(|step| script((step as f64 + 0.5) / steps as f64, base.disk.inner)).collect();
    let truths: Vec<_> = places.iter().map(|(eye, time, _)| picture(&gas, eye, request.error_size, *time, 3, SAMPLES)).collect();
    let brightest = truths.iter().map(|truth| peak(truth)).fold(0.0, f32::max);
    for (step, (&(eye, time, situation), truth)) in places.iter().zip(&truths).enumerate() {
        let exposed = peak(truth).max(LEAST_PEAK * brightest);
        let [alone, in_game] = [false, true].map(|sky| MeasuredView { eye, time, sky, counted: false });
        let mut times = vec![[const { Vec::new() }; 6]; runners.len()];
        for _ in 0..request.rounds {
            let without = bench.timed(None, &in_game)?;
            for (&(number, _), times) in runners.iter().zip(&mut times) {
                let shown = bench.timed(Some(number), &in_game)?;
                let [arcs, mesh, drawn] = DISK_PASSES.map(|label| shown.pass(label));
                let all = [shown.processor.unwrap_or(shown.whole), shown.whole, own(&shown, &without), arcs, mesh, drawn];
                times.iter_mut().zip(all).for_each(|(times, time)| times.push(time));
            }
        }
        for (&(number, contestant), times) in runners.iter().zip(&times) {
            let shown = bench.frame(Some(number), &alone, Some(request.error_size))?;
            let error = compare(&shown.picture, truth, request.error_size, exposed);
            let times: String = times.iter().map(|times| format!("|{:.3}", quantile(times.iter().copied(), 0.5))).collect();
            let (DiskContestant { name, family, .. }, DiskPictureError { psnr, flip, .. }) = (contestant, error);
            sheet.line(format_args!("{name}|{family}|{step}|{situation}{times}|{psnr:.2}|{flip:.4}"));
        }
    }
    Ok(sheet)
}

/// What the chase comes to: each contestant's mean and worst frame, how near the worst comes to the mean in frames per second, where it is,
/// and the mean and worst error.
pub(super) fn summary(chase: &Sheet) -> Sheet {
    let mut sheet = Sheet::new(&[
        "contestant", "mean_ms", "worst_ms", "worst_to_mean_fps", "worst_in", "disk_mean_ms", "psnr_db", "flip", "worst_flip",
    ]);
    sheet.notes.clone_from(&chase.notes);
    for name in chase.distinct("contestant") {
        let rows: Vec<&Vec<String>> = chase.of([("contestant", name)]).collect();
        let column = |column: &str| -> Vec<f64> { rows.iter().map(|row| chase.number(row, column)).collect() };
        let frames = column("frame_ms");
        let worst = frames.iter().copied().fold(0.0, f64::max);
        let place = rows.iter().find(|row| chase.number(row, "frame_ms") == worst).map_or("", |row| chase.text(row, "situation"));
        let flips = column("flip");
        let (mean_ms, ratio, most) = (mean(&frames), mean(&frames) / worst, flips.iter().copied().fold(0.0, f64::max));
        let [disk, psnr, flip] = ["disk_ms", "psnr_db", "flip"].map(|name| mean(&column(name)));
        sheet.line(format_args!("{name}|{mean_ms:.1}|{worst:.1}|{ratio:.2}|{place}|{disk:.1}|{psnr:.1}|{flip:.4}|{most:.4}"));
    }
    sheet
}
