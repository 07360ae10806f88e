//! The cost table: each step of each option, all others at their finest.

use lensrunner::render::quality::costs::{HEADER, QualityCosts, SceneClass};
use lensrunner::render::quality::options::{QualityOption, turned};

use super::moments::{MomentCase, begin, case, scenes};
use super::{DialRequest, Keep, empty};
use crate::chart::{ChartError, Sheet, quantile};

/// Columns of the sheet of all that was measured.
pub const COLUMNS: [&str; 8] = ["class", "scene", "T", "knob", "step", "FLIP", "ms", "finest ms"];

/// The error that is the cost: the greatest but one in a hundred,
const BOUND: f64 = 0.99;
/// and so much more: a few moments seldom have the worst.
const MARGIN: f64 = 1.2;

/// Measures every step at `moments` moments of each class; `keep` gets the rows after each moment.
pub fn measure(request: &DialRequest, keep: Keep) -> Result<Sheet, ChartError> {
    let (mut bench, mut sheet, mut rng) = begin(request, &COLUMNS)?;
    for class in SceneClass::ALL {
        let scenes = scenes(class)?;
        for number in 0..request.moments {
            let case = case(&scenes, &mut rng).ok_or_else(|| empty(class.name()))?;
            eprintln!("{} {}/{}: {} at T = {}", class.name(), number + 1, request.moments, case.scene, case.at);
            let mut shown = bench.show(&case)?;
            let asked = shown.finest;
            let finest = bench.finest(&mut shown, &asked)?;
            for (k, option) in QualityOption::ALL.into_iter().enumerate() {
                for step in 1..option.steps() {
                    let mut steps = [0; QualityOption::ALL.len()];
                    steps[k] = step;
                    let [error, time, beside] = bench.beside(&mut shown, &finest, &asked, &turned(&asked, &steps))?;
                    let (class, option, MomentCase { scene, at, .. }) = (class.name(), option.name, &case);
                    sheet.line(format_args!("{class}|{scene}|{at}|{option}|{step}|{error:.5}|{time:.2}|{beside:.2}"));
                }
            }
            keep(&sheet)?;
        }
    }
    Ok(sheet)
}

/// A step that saves less is within what measurements differ by, and saves nothing.
const SAVES: f64 = 0.03;

/// The table that the game reads, from what was measured: of each class the greatest errors and the median times. A step never costs less
/// than the one before it, nor takes longer.
pub fn table(sheet: &Sheet) -> Result<String, ChartError> {
    let mut text: String = sheet.notes.iter().map(|(name, note)| format!("# {name}: {note}\n")).collect();
    text.push_str(HEADER);
    text.push('\n');
    for class in SceneClass::ALL {
        for option in QualityOption::ALL {
            let (mut dearest, mut quickest) = (0f64, 1f64);
            for step in 1..option.steps() {
                let number = step.to_string();
                let rows = || sheet.of([("class", class.name()), ("knob", option.name), ("step", &number)]);
                let error = quantile(rows().map(|row| sheet.number(row, "FLIP")), BOUND);
                dearest = dearest.max((MARGIN * error).min(1.0));
                let time = quantile(rows().map(|row| sheet.number(row, "ms") / sheet.number(row, "finest ms")), 0.5);
                quickest = if time < 1.0 - SAVES { quickest.min(time) } else { quickest };
                text.push_str(&format!("{},{},{step},{},{dearest:.5},{quickest:.4}\n", class.name(), option.name, option.describe(step)));
            }
        }
    }
    QualityCosts::read(&text)?;
    Ok(text)
}
