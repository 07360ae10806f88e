//! The whole frame at the levels that players choose between: measured error against time, beside everything at its finest.

use lensrunner::play::picture::quality::{LOW, MEDIUM};
use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::render::quality::ladder::{QualityRung, ladder, within};
use lensrunner::render::quality::options::turned;
use lensrunner::render::settings::Settings;
use lensrunner::scene;

use super::moments::{MomentCase, begin, class_of};
use super::{DialRequest, Keep};
use crate::chart::{ChartError, Sheet};

/// Columns of the sheet.
pub const COLUMNS: [&str; 8] = ["class", "scene", "T", "level", "rung", "FLIP", "ms", "everything, ms"];

/// The levels, from the finest.
pub const LEVELS: [&str; 4] = ["high", "medium", "low", "fastest"];

/// A scene of each class; the last is the scripted chase.
pub const SCENES: [&str; 4] = ["ring", "disk", "02-first-pursuit", CHASE];

/// The scripted chase.
const CHASE: &str = "chase";

/// T between two moments, in r_s/c.
const STEP: f64 = 6.0;

/// Everything at its finest, whatever is configured.
pub fn everything(configured: &Settings) -> Settings {
    let Settings { resolution, pixel_error, orders, halvings, least_width, coarse_below, faintest_star, smooth, .. } = Settings::finest();
    Settings { resolution, pixel_error, orders, halvings, least_width, coarse_below, faintest_star, smooth, ..*configured }
}

fn rung_of(level: &str, rungs: &[QualityRung]) -> usize {
    match level {
        "high" => 0,
        "medium" => within(rungs, MEDIUM),
        "low" => within(rungs, LOW),
        _ => rungs.len() - 1,
    }
}

/// Measures every level at `moments` moments of a scene of each class; `keep` gets the rows after each moment.
pub fn measure(request: &DialRequest, keep: Keep) -> Result<Sheet, ChartError> {
    let (mut bench, mut sheet, _) = begin(request, &COLUMNS)?;
    for number in 0..request.moments {
        for scene in SCENES {
            let class = class_of(&scene::load(scene)?);
            let rungs = ladder(QualityCosts::shipped(), class);
            let case = MomentCase { scene: scene.to_owned(), at: number as f64 * STEP, seed: request.seed(), turn: [0.0; 2] };
            eprintln!("{}/{}: {scene} at T = {}", number + 1, request.moments, case.at);
            let mut shown = bench.show(&case)?;
            let asked = shown.finest;
            let whole = everything(&asked);
            let finest = bench.finest(&mut shown, &whole)?;
            for level in LEVELS {
                let rung = rung_of(level, &rungs);
                let [error, time, beside] = bench.beside(&mut shown, &finest, &whole, &turned(&asked, &rungs[rung].steps))?;
                let (class, at, rung) = (class.name(), case.at, rung + 1);
                sheet.line(format_args!("{class}|{scene}|{at}|{level}|{rung}|{error:.5}|{time:.2}|{beside:.2}"));
            }
            keep(&sheet)?;
        }
    }
    Ok(sheet)
}

/// Mean FLIP of a level and its share of the time of everything, over all moments of a scene.
pub fn level_of(sheet: &Sheet, scene: &str, level: &str) -> Option<[f64; 2]> {
    let rows: Vec<_> = sheet.of([("scene", scene), ("level", level)]).collect();
    let sum = |column| rows.iter().map(|row| sheet.number(row, column)).sum::<f64>();
    (!rows.is_empty()).then(|| [sum("FLIP") / rows.len() as f64, sum("ms") / sum("everything, ms")])
}

/// The verdict, in a sentence.
pub fn verdict(sheet: &Sheet) -> String {
    let words = LEVELS.iter().filter_map(|level| {
        let [error, time] = level_of(sheet, CHASE, level)?;
        Some(format!("{level} takes {:.0} % at FLIP {error:.3}", 100.0 * time))
    });
    format!("Of the chase with everything at its finest {}.", words.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_told_by_sums_of_time() {
        let mut sheet = Sheet::new(&COLUMNS);
        for (flip, ms, all) in [(0.01, 10.0, 40.0), (0.03, 30.0, 60.0)] {
            let numbers = [flip, ms, all].map(|number: f64| number.to_string());
            sheet.push(["aurora", CHASE, "0", "low", "9"].map(str::to_owned).into_iter().chain(numbers));
        }
        assert_eq!(level_of(&sheet, CHASE, "low"), Some([0.02, 0.4]));
        assert_eq!(level_of(&sheet, "disk", "low"), None);
        assert_eq!(verdict(&sheet), "Of the chase with everything at its finest low takes 40 % at FLIP 0.020.");
    }

    #[test]
    fn everything_is_finer_than_the_game() {
        let configured = lensrunner::render::stage::settings(&lensrunner::scene::GameConfig::default());
        let all = everything(&configured);
        assert!(all.orders > configured.orders && all.pixel_error < configured.pixel_error);
        assert_eq!((all.bloom, all.exposure_key), (configured.bloom, configured.exposure_key));
    }
}
