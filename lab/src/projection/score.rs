//! The error of a method on rows whose truth is known.

use rayon::prelude::*;

use lensrunner::lensing::adversarial::Row;
use lensrunner::lensing::methods::{Exact, Projector};
use lensrunner::spacetime::light::Order;

/// ψ in the rain frame and the delay of a row; None where no light joins the two.
///
/// The closed form in f64 of `spacetime::light`, which tests hold against the judge's integrator to 1e-9.
pub type Truth = Option<[f64; 2]>;

/// The truth of every row in one order.
pub fn truth(rows: &[Row], order: Order) -> Vec<Truth> {
    rows.par_iter().map(|row| Exact.project(row.input, order, row.branch).map(|sight| [sight.psi_rain, sight.delay])).collect()
}

/// Maximum, 99.9th percentile and root mean square of some errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spread {
    /// The largest.
    pub max: f64,
    /// The 99.9th percentile.
    pub most: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The row (r, φ, L) of the largest.
    pub worst: [f64; 3],
}

impl Spread {
    /// Of errors with their rows; NaN counts as the largest.
    pub fn of(mut errors: Vec<(f64, [f64; 3])>) -> Spread {
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        let n = errors.len();
        let Some(&(max, worst)) = errors.last() else {
            return Spread { max: f64::NAN, most: f64::NAN, rms: f64::NAN, worst: [f64::NAN; 3] };
        };
        let rms = (errors.iter().map(|e| e.0 * e.0).sum::<f64>() / n as f64).sqrt();
        Spread { max, most: errors[((n as f64 * 0.999) as usize).min(n - 1)].0, rms, worst }
    }
}

/// The errors of a method in one order.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// Rows with a ray that it answered.
    pub answered: usize,
    /// Rows with a ray that it did not answer, or with something that is not a number.
    pub missing: usize,
    /// Rows without a ray that it answered all the same.
    pub invented: usize,
    /// The angle between the directions in the rain frame, degrees.
    pub angle: Spread,
    /// The error of the delay, r_s/c.
    pub delay: Spread,
    /// The same over what is allowed: 0.002 + 3e-7 × delay outside r = 1.05, 0.02 nearer.
    pub delay_share: Spread,
}

/// Scores `method` on `rows`, whose truth in `order` is `truth`.
pub fn score(method: &dyn Projector, rows: &[Row], truth: &[Truth], order: Order) -> Score {
    let answers: Vec<Option<[f64; 2]>> = rows
        .par_iter()
        .map(|row| {
            let sight = method.project(row.input, order, row.branch)?;
            (sight.psi_rain.is_finite() && sight.delay.is_finite()).then_some([sight.psi_rain, sight.delay])
        })
        .collect();
    tally(rows, &answers, truth)
}

/// Scores `answers` (ψ in the rain frame, delay) to `rows`, whose truth is `truth`.
pub(super) fn tally(rows: &[Row], answers: &[Option<[f64; 2]>], truth: &[Truth]) -> Score {
    let mut angle = Vec::new();
    let (mut delay, mut share) = (Vec::new(), Vec::new());
    let (mut missing, mut invented) = (0, 0);
    for ((row, answer), truth) in rows.iter().zip(answers).zip(truth) {
        let at = [row.input.r, row.input.phi, row.input.camera];
        match (answer, truth) {
            (Some([psi, time]), Some([true_psi, true_time])) => {
                angle.push(((psi - true_psi).abs().to_degrees(), at));
                let off = (time - true_time).abs();
                delay.push((off, at));
                share.push((off / if at[0] < 1.05 { 0.02 } else { 0.002 + 3e-7 * true_time }, at));
            }
            (None, Some(_)) => missing += 1,
            (Some(_), None) => invented += 1,
            (None, None) => {}
        }
    }
    let answered = angle.len();
    Score { answered, missing, invented, angle: Spread::of(angle), delay: Spread::of(delay), delay_share: Spread::of(share) }
}
