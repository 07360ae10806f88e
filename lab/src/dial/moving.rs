//! Whether anything pops: frames one after the other, with a governor that moves over the whole ladder, and each with the rung of the frame
//! before it.

use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::render::quality::governor::Governor;
use lensrunner::render::quality::ladder::ladder;
use lensrunner::render::quality::options::turned;
use lensrunner::scene;

use super::levels::SCENES;
use super::moments::{MomentCase, Taken, begin, class_of};
use super::{DialRequest, Keep};
use crate::chart::{ChartError, Sheet};

/// Columns of the sheet: FLIP from the frame before, as it is and had the rung stayed.
pub const COLUMNS: [&str; 6] = ["scene", "T", "rung before", "rung", "FLIP", "FLIP with the rung before"];

/// T from frame to frame, in r_s/c: a step of the simulation.
const STEP: f64 = 1.0 / 32.0;
/// The time to hold, in ms. Which it is does not matter: the load is told by it.
const HOLD: f64 = 40.0;
/// The load, as the time of the finest in times to hold: least and greatest,
const LOAD: [f64; 2] = [0.7, 3.0];
/// and frames from one to the other.
const HALF_A_WAVE: usize = 75;

/// Time of the finest in times to hold: up and down in straight lines.
fn load(frame: usize) -> f64 {
    let part = (frame % (2 * HALF_A_WAVE)) as f64 / HALF_A_WAVE as f64;
    let part = if part > 1.0 { 2.0 - part } else { part };
    LOAD[0] + part * (LOAD[1] - LOAD[0])
}

/// Draws `moments` frames of each scene; `keep` gets the rows after each.
pub fn measure(request: &DialRequest, keep: Keep) -> Result<Sheet, ChartError> {
    let (mut bench, mut sheet, _) = begin(request, &COLUMNS)?;
    for scene in SCENES {
        eprintln!("{scene}");
        let rungs = ladder(QualityCosts::shipped(), class_of(&scene::load(scene)?));
        let mut governor = Governor::default();
        let mut last: Option<Taken> = None;
        for frame in 0..request.moments {
            let case = MomentCase { scene: scene.to_owned(), at: frame as f64 * STEP, seed: request.seed(), turn: [0.0; 2] };
            let mut shown = bench.show(&case)?;
            let asked = shown.finest;
            let before = governor.rung();
            let time = HOLD * load(frame) * rungs[before].time;
            let rung = governor.follow(&rungs, HOLD, time, time);
            let taken = bench.picture(&mut shown, &turned(&asked, &rungs[rung].steps))?;
            if let Some(last) = last {
                let moved = bench.error(&last, &taken);
                let stayed = if rung == before {
                    moved
                } else {
                    let unchanged = bench.picture(&mut shown, &turned(&asked, &rungs[before].steps))?;
                    bench.error(&last, &unchanged)
                };
                sheet.line(format_args!("{scene}|{}|{}|{}|{moved:.5}|{stayed:.5}", case.at, before + 1, rung + 1));
            }
            last = Some(taken);
        }
        keep(&sheet)?;
    }
    Ok(sheet)
}

/// Of a scene: how many changes there were, mean FLIP between neighbouring frames as a multiple of that with the rung unchanged, over all
/// frames and over the changes alone.
pub fn ratios(sheet: &Sheet, scene: &str) -> (usize, [f64; 2]) {
    let rows = || sheet.of([("scene", scene)]);
    let is_change = |row: &&Vec<String>| sheet.text(row, "rung") != sheet.text(row, "rung before");
    let ratio = |rows: &mut dyn Iterator<Item = &Vec<String>>| {
        let (moved, stayed) = rows.fold((0.0, 0.0), |(moved, stayed), row| {
            (moved + sheet.number(row, "FLIP"), stayed + sheet.number(row, "FLIP with the rung before"))
        });
        moved / stayed
    };
    (rows().filter(is_change).count(), [ratio(&mut rows()), ratio(&mut rows().filter(is_change))])
}

/// The verdict, in a sentence.
pub fn verdict(sheet: &Sheet) -> String {
    let words = sheet.distinct("scene").into_iter().map(|scene| {
        let (changes, [all, changed]) = ratios(sheet, scene);
        format!("{scene}: {all:.2} times over all frames, {changed:.2} at its {changes} changes")
    });
    format!("FLIP between neighbouring frames beside that with one rung: {}.", words.collect::<Vec<_>>().join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_of_sums() {
        let mut sheet = Sheet::new(&COLUMNS);
        for (rung, moved, stayed) in [("1", 0.1, 0.1), ("3", 0.4, 0.1)] {
            sheet.push(["disk".to_owned(), "0".into(), "1".into(), rung.into(), moved.to_string(), stayed.to_string()]);
        }
        assert_eq!(ratios(&sheet, "disk"), (1, [2.5, 4.0]));
        assert!(verdict(&sheet).ends_with("disk: 2.50 times over all frames, 4.00 at its 1 changes."));
    }

    #[test]
    fn the_load_goes_up_and_down() {
        assert_eq!([0, HALF_A_WAVE, 2 * HALF_A_WAVE].map(load), [LOAD[0], LOAD[1], LOAD[0]]);
    }
}
