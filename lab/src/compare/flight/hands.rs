//! Flights by seeded hands: at which paces, which moments, and how far the own ship's points are displaced.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use rand::RngExt;

use super::eye::{Eye, own_ship};
use crate::chart::{Sheet, SheetError};
use crate::compare::judged::Judged;
use crate::compare::random::draw::chance;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::sim::Moment;

/// The paces that flights go through by turns, in r_s/c a second.
pub const PACES: [f64; 5] = [3.0, 1.5, 0.375, 0.09375, 0.05];

/// The pace of a flight.
pub fn pace(seed: u64) -> f64 {
    PACES[(seed % PACES.len() as u64) as usize]
}

/// So many steps after a bolt was fired it is near, by its light.
const FRESH: u64 = 48;

/// The steps after which `count` moments of the flight are looked at, in order: a quarter of them soon after a bolt was fired, if any was.
pub fn choose(scene: &Scene, config: &GameConfig, seed: u64, until: f64, count: usize) -> Vec<u64> {
    let mut moment = Moment::with_pilot(scene, config, seed, PilotKind::Hands);
    let most = (until / config.clock.step).floor() as u64;
    let (mut steps, mut fired) = (0, Vec::new());
    while steps < most && !moment.is_decided() {
        let before = moment.bolts().len();
        moment.advance(1);
        steps += 1;
        if moment.bolts().len() > before {
            fired.push(steps);
        }
    }
    let mut chance = chance(seed, u64::MAX);
    let mut chosen: Vec<u64> = Vec::new();
    let mut tries = 0;
    while steps > 2 && chosen.len() < count && tries < 100 * count {
        let at = match fired.len() {
            0 => chance.random_range(2..steps),
            bolts if tries % 4 == 0 => fired[chance.random_range(0..bolts)] + chance.random_range(1..FRESH),
            _ => chance.random_range(2..steps),
        };
        tries += 1;
        if at < steps && !chosen.contains(&at) {
            chosen.push(at);
        }
    }
    chosen.sort_unstable();
    chosen
}

/// What came of the moments at one pace.
#[derive(Clone, Debug, Default)]
struct AtPace {
    moments: usize,
    failed: usize,
    /// Displacements of points of the own ship, in pixels.
    displaced: Vec<f32>,
}

/// What came of flights by hands.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    paces: BTreeMap<u64, AtPace>,
    eyes: BTreeMap<&'static str, (usize, usize)>,
}

/// Columns of the sheet.
pub const COLUMNS: [&str; 7] = ["pace", "moments", "failed", "own_points", "own_mean_px", "own_p99_px", "own_max_px"];

impl Tally {
    /// Adds a moment.
    pub fn add(&mut self, scene: &Scene, pace: f64, eye: Eye, judged: &Judged) {
        let failed = usize::from(!judged.faults.is_empty());
        let at = self.paces.entry(pace.to_bits()).or_default();
        at.moments += 1;
        at.failed += failed;
        let seen = self.eyes.entry(eye.name()).or_default();
        *seen = (seen.0 + 1, seen.1 + failed);
        let (Some(verdict), Some((_, judge))) = (&judged.verdict, &judged.pictures) else { return };
        let own = own_ship(scene) as u32 + 1;
        let points = verdict.displaced.iter().zip(&judge.layers).filter(|(_, layer)| layer.object == own).map(|(displaced, _)| *displaced);
        at.displaced.extend(points.filter(|displaced| displaced.is_finite()));
    }

    /// As a table of numbers: a row for each pace, and one for all.
    pub fn sheet(&self) -> Sheet {
        let mut sheet = Sheet::measured(&COLUMNS, "");
        let mut all = AtPace::default();
        for (pace, at) in &self.paces {
            all.moments += at.moments;
            all.failed += at.failed;
            all.displaced.extend(&at.displaced);
            sheet.push(row(&f64::from_bits(*pace).to_string(), at));
        }
        sheet.push(row("all", &all));
        sheet
    }

    /// In words, for reading.
    pub fn text(&self) -> String {
        let sheet = self.sheet();
        let mut text = String::from("By hands, own ship's points displaced, px:\n");
        for row in &sheet.rows {
            let [pace, moments, failed, points, mean, most, max] = COLUMNS.map(|column| sheet.text(row, column));
            _ = writeln!(
                text,
                "  pace {pace}: {failed} of {moments} moments beyond a limit; {points} points: mean {mean}, 99 % {most}, max {max}"
            );
        }
        for (eye, (moments, failed)) in &self.eyes {
            _ = writeln!(text, "  {eye}: {failed} of {moments}");
        }
        text
    }

    /// Writes the table into a file.
    pub fn save(&self, csv: &Path) -> Result<(), SheetError> {
        self.sheet().save(csv)
    }
}

fn row(pace: &str, at: &AtPace) -> [String; 7] {
    let mut sorted = at.displaced.clone();
    sorted.sort_by(f32::total_cmp);
    let mean = sorted.iter().map(|d| f64::from(*d)).sum::<f64>() / sorted.len().max(1) as f64;
    let share = |share: f64| sorted.get(((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1))).copied();
    let [most, max] = [0.99, 1.0].map(|part| share(part).unwrap_or(f32::NAN));
    [
        pace.to_owned(),
        at.moments.to_string(),
        at.failed.to_string(),
        sorted.len().to_string(),
        format!("{mean:.4}"),
        format!("{most:.3}"),
        format!("{max:.3}"),
    ]
}
