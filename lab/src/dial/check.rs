//! Predictions against measurements, at moments and rungs that nobody chose.

use lensrunner::render::quality::costs::{QualityCosts, SceneClass};
use lensrunner::render::quality::ladder::ladder;
use lensrunner::render::quality::options::turned;
use rand::RngExt;

use super::moments::{MomentCase, begin, case, scenes};
use super::{DialRequest, Keep, empty};
use crate::chart::{ChartError, Sheet};

/// Columns of the sheet.
pub const COLUMNS: [&str; 9] =
    ["class", "scene", "T", "rung", "steps", "predicted FLIP", "FLIP", "predicted share of the time", "share of the time"];

/// How close predictions must be.
const FACTOR: f64 = 4.0;
const TIME: f64 = 0.25;

/// Measures `moments` moments, all classes in turn; `keep` gets the rows after each.
pub fn measure(request: &DialRequest, keep: Keep) -> Result<Sheet, ChartError> {
    let (mut bench, mut sheet, mut rng) = begin(request, &COLUMNS)?;
    let classes: Vec<_> = SceneClass::ALL.into_iter().map(|class| Ok((class, scenes(class)?))).collect::<Result<_, ChartError>>()?;
    for number in 0..request.moments {
        let (class, scenes) = &classes[number % classes.len()];
        let rungs = ladder(QualityCosts::shipped(), *class);
        let case = case(scenes, &mut rng).ok_or_else(|| empty(class.name()))?;
        let place = rng.random_range(1..rungs.len().max(2));
        let Some(rung) = rungs.get(place) else { continue };
        eprintln!("{}/{}: {} at T = {}, rung {}", number + 1, request.moments, case.scene, case.at, place + 1);
        let mut shown = bench.show(&case)?;
        let asked = shown.finest;
        let finest = bench.finest(&mut shown, &asked)?;
        let [error, time, beside] = bench.beside(&mut shown, &finest, &asked, &turned(&asked, &rung.steps))?;
        let steps = rung.steps.map(|step| step.to_string()).join(" ");
        let (class, MomentCase { scene, at, .. }, [told, share]) = (class.name(), &case, [rung.error, rung.time]);
        sheet.line(format_args!("{class}|{scene}|{at}|{}|{steps}|{told:.5}|{error:.5}|{share:.4}|{:.4}", place + 1, time / beside));
        keep(&sheet)?;
    }
    Ok(sheet)
}

/// The share of moments at which the predicted error was an upper bound, at which it was within four times of the measured, and at which
/// the predicted time was within a quarter.
pub fn shares(sheet: &Sheet) -> [f64; 3] {
    let numbers = |row: &[String]| {
        ["predicted FLIP", "FLIP", "predicted share of the time", "share of the time"].map(|column| sheet.number(row, column))
    };
    let share =
        |holds: fn([f64; 4]) -> bool| sheet.rows.iter().filter(|row| holds(numbers(row))).count() as f64 / sheet.rows.len().max(1) as f64;
    [
        share(|[predicted, error, ..]| error <= predicted),
        share(|[predicted, error, ..]| predicted <= FACTOR * error),
        share(|[.., predicted, time]| (predicted / time - 1.0).abs() <= TIME),
    ]
}

/// The verdict, in a sentence.
pub fn verdict(sheet: &Sheet) -> String {
    let [bound, near, time] = shares(sheet).map(|share| 100.0 * share);
    format!(
        "At {} moments the predicted error is an upper bound in {bound:.1} %, within four times in {near:.1} %; the predicted time is within a \
         quarter in {time:.1} %.",
        sheet.rows.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_counted() {
        let mut sheet = Sheet::new(&COLUMNS);
        for [predicted, error, time, measured] in
            [[0.1, 0.05, 0.5, 0.5], [0.1, 0.01, 0.5, 0.8], [0.1, 0.2, 0.5, 0.45], [0.1, 0.1, 0.5, 0.6]]
        {
            let numbers = [predicted, error, time, measured].map(|number: f64| number.to_string());
            sheet.push(["disk", "disk", "0", "2", "1 0 0 0 0"].map(str::to_owned).into_iter().chain(numbers));
        }
        assert_eq!(shares(&sheet), [0.75, 0.75, 0.75]);
        assert!(verdict(&sheet).starts_with("At 4 moments the predicted error is an upper bound in 75.0 %"));
    }
}
