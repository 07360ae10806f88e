//! The rungs from the finest picture to the fastest: each turns one option a step further than the one before, that which adds the least
//! error for the time it saves.
//!
//! Errors of several options add up: a bound. Of the time that the others leave, each option leaves its share; what is done pixel by pixel
//! saves less where there are fewer pixels. `lab/run chart dial --check` holds both against measurements.

use super::costs::{QualityCosts, SceneClass};
use super::options::{OptionSteps, QualityOption, area};

/// One rung.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualityRung {
    /// The step of each option.
    pub steps: OptionSteps,
    /// Its predicted error, in mean FLIP.
    pub error: f64,
    /// Its predicted time, as a share of that of the finest.
    pub time: f64,
}

/// Less than this share of the time is not worth an error: it is within what measurements differ by.
const LEAST_SAVED: f64 = 0.01;

/// Added to the error of any rung but the finest: what single moments differ by where an option mostly changes nothing.
const LEAST_ERROR: f64 = 0.003;

impl QualityRung {
    fn at(costs: &QualityCosts, class: SceneClass, steps: OptionSteps) -> QualityRung {
        let all = QualityOption::ALL.into_iter().zip(steps).map(|(option, step)| (option, costs.of(class, option, step)));
        let area = area(&steps);
        let (error, time) = all.fold((0.0, 1.0), |(error, time), (option, cost)| {
            let saved = (1.0 - cost.time) * if option.is_by_pixel { area } else { 1.0 };
            (error + cost.error, time * (1.0 - saved))
        });
        let finest = steps == [0; QualityOption::ALL.len()];
        QualityRung { steps, error: if finest { 0.0 } else { (error + LEAST_ERROR).min(1.0) }, time }
    }

    /// What is not at its finest, in words.
    pub fn describe(&self) -> String {
        let turned = QualityOption::ALL.into_iter().zip(self.steps).filter(|(_, step)| *step > 0);
        let words: Vec<String> = turned.map(|(option, step)| format!("{} {}", option.name, option.describe(step))).collect();
        if words.is_empty() { "everything at its finest".into() } else { words.join(", ") }
    }
}

/// All rungs for a class of scenes, the finest first.
pub fn ladder(costs: &QualityCosts, class: SceneClass) -> Vec<QualityRung> {
    let mut rungs = vec![QualityRung::at(costs, class, [0; QualityOption::ALL.len()])];
    loop {
        let now = rungs[rungs.len() - 1];
        // Of each option the next step that saves anything.
        let further = QualityOption::ALL.into_iter().enumerate().filter_map(|(k, option)| {
            let step_to = |step| {
                let mut steps = now.steps;
                steps[k] = step;
                QualityRung::at(costs, class, steps)
            };
            (now.steps[k] + 1..option.steps()).map(step_to).find(|rung| now.time - rung.time >= LEAST_SAVED * now.time)
        });
        let cost = |rung: &QualityRung| (rung.error - now.error).max(0.0) / (now.time - rung.time);
        match further.min_by(|a, b| cost(a).total_cmp(&cost(b))) {
            Some(next) => rungs.push(next),
            None => return rungs,
        }
    }
}

/// The fastest rung with no more than this error.
pub fn within(ladder: &[QualityRung], error: f64) -> usize {
    ladder.iter().rposition(|rung| rung.error <= error).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rung_is_faster_and_no_better() {
        for class in SceneClass::ALL {
            let rungs = ladder(QualityCosts::shipped(), class);
            assert!(rungs.len() > 4, "{}: {} rungs", class.name(), rungs.len());
            assert_eq!((rungs[0].error, rungs[0].time), (0.0, 1.0));
            for pair in rungs.windows(2) {
                assert!(pair[1].time < pair[0].time && pair[1].error >= pair[0].error, "{pair:?}");
            }
            assert!(rungs[rungs.len() - 1].time < 0.6, "{}: the last takes {}", class.name(), rungs[rungs.len() - 1].time);
        }
    }

    #[test]
    fn a_budget_chooses_the_fastest_within_it() {
        let rung = |error, time| QualityRung { steps: [0; QualityOption::ALL.len()], error, time };
        let rungs = [rung(0.0, 1.0), rung(0.01, 0.7), rung(0.05, 0.4)];
        assert_eq!([0.0, 0.02, 1.0].map(|error| within(&rungs, error)), [0, 1, 2]);
    }
}
