//! The error of each way to draw the disk from all heights over its plane.

use lensrunner::spacetime::Observer;
use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::chart::{ChartError, Sheet};
use lensrunner::scene::disk::Gas;

use super::bench::Bench;
use super::error::{DiskPictureError, compare, peak};
use super::exact::picture;
use super::request::{DiskContestant, DiskRequest, MeasuredView, TIME, eye};

/// Degrees from the axis that the disk is seen at: from above to nearly edge on.
const INCLINATIONS: [f64; 8] = [0.0, 30.0, 60.0, 80.0, 85.0, 87.0, 88.0, 89.0];
/// How far the eye is from the hole, in r_s.
const DISTANCE: f64 = 27.0;
/// The exact picture has this many samples squared in a pixel.
const SAMPLES: u32 = 4;

/// A hovering eye this many degrees from the axis.
fn seat(degrees: f64) -> Observer {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let position = DISTANCE * DVec3::new(0.0, -sine, cosine);
    // A little aside, so that "up" is never the axis that the eye looks along.
    eye(position, DVec3::new(0.0, 1e-6, 0.0) - position)
}

/// Where eyes are: at each inclination, at the inner edge and close over the disk, as the scenes `disk-inner` and `disk-skim`.
fn seats() -> Vec<(String, Observer)> {
    let inner = eye(DVec3::new(0.0, -3.3, 0.5), DVec3::new(0.9, 0.55, -0.1));
    let skim = eye(DVec3::new(0.0, -6.5, 0.3), DVec3::new(-0.75, 0.66, -0.06));
    let close =
        [("at the inner edge".to_owned(), Observer { field_of_view: FRAC_PI_2, ..inner }), ("0.3 r_s over the disk".to_owned(), skim)];
    INCLINATIONS.iter().map(|&degrees| (degrees.to_string(), seat(degrees))).chain(close).collect()
}

/// PSNR and ꟻLIP of polygons and arcs from each of these places.
pub fn errors_by_place(request: &DiskRequest, contestants: &[DiskContestant], bench: &mut Bench) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(&["contestant", "family", "place", "psnr_db", "flip", "mean_difference"], bench.adapter());
    let base = &contestants[0].config;
    let gas = Gas::new(&base.disk, base.hole.mass_solar);
    for (place, eye) in seats() {
        let truth = picture(&gas, &eye, request.error_size, TIME, 3, SAMPLES);
        for (number, contestant) in contestants.iter().enumerate().filter(|(_, contestant)| contestant.family < 2) {
            let shown =
                bench.frame(Some(number), &MeasuredView { eye, time: TIME, sky: false, counted: false }, Some(request.error_size))?;
            let error = compare(&shown.picture, &truth, request.error_size, peak(&truth));
            let (DiskContestant { name, family, .. }, DiskPictureError { psnr, flip, relative }) = (contestant, error);
            sheet.line(format_args!("{name}|{family}|{place}|{psnr:.2}|{flip:.4}|{relative:.4}"));
        }
    }
    Ok(sheet)
}
