//! What each step of each option costs and saves, measured by `lab/run chart dial`: `tables/quality.csv`.

use std::sync::LazyLock;

use thiserror::Error;

use super::options::QualityOption;

/// Kinds of scenes, by what takes their time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneClass {
    /// Bodies under the stars.
    Bodies,
    /// The disk alone.
    Disk,
    /// The disk and bodies.
    Chase,
    /// A planet with an aurora, with a disk or without.
    Aurora,
}

impl SceneClass {
    /// All of them.
    pub const ALL: [SceneClass; 4] = [SceneClass::Bodies, SceneClass::Disk, SceneClass::Chase, SceneClass::Aurora];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            SceneClass::Bodies => "bodies",
            SceneClass::Disk => "disk",
            SceneClass::Chase => "chase",
            SceneClass::Aurora => "aurora",
        }
    }

    /// The class of a scene with these things in it.
    pub fn of(has_bodies: bool, has_disk: bool, has_aurora: bool) -> SceneClass {
        match (has_bodies, has_disk, has_aurora) {
            (.., true) => SceneClass::Aurora,
            (true, true, false) => SceneClass::Chase,
            (false, true, false) => SceneClass::Disk,
            (_, false, false) => SceneClass::Bodies,
        }
    }
}

/// What one step of an option comes to, all others at their finest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualityCost {
    /// Error that it adds, in mean FLIP: at most this at 99 of 100 moments.
    pub error: f64,
    /// Time of a frame, as a share of that of the finest.
    pub time: f64,
}

/// The costs of all steps of all options, for each class of scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct QualityCosts(Vec<(SceneClass, &'static str, u8, QualityCost)>);

/// What is wrong with a table of costs.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum QualityCostsError {
    /// A line is not one of the table.
    #[error("line {line}: `{text}` is not class,knob,step,value,error,time with an error from 0 to 1 and a time above 0")]
    Line {
        /// Its number, from 1.
        line: usize,
        /// What it says.
        text: String,
    },
    /// A cost is missing.
    #[error("no cost for step {step} of {option} in scenes of the class {class}")]
    Missing {
        /// The class.
        class: &'static str,
        /// The option.
        option: &'static str,
        /// The step.
        step: u8,
    },
}

/// The first line of the table that is not a comment.
pub const HEADER: &str = "class,knob,step,value,error,time";

/// The table that the game is built with.
const SHIPPED: &str = include_str!("../../../tables/quality.csv");
static COSTS: LazyLock<QualityCosts> = LazyLock::new(|| QualityCosts::read(SHIPPED).unwrap_or_else(|_| QualityCosts(Vec::new())));

impl QualityCosts {
    /// Those that the game is built with.
    pub fn shipped() -> &'static QualityCosts {
        &COSTS
    }

    /// Reads a table; lines with `#` are comments.
    pub fn read(text: &str) -> Result<QualityCosts, QualityCostsError> {
        let mut costs = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if line.starts_with('#') || line == HEADER || line.trim().is_empty() {
                continue;
            }
            let cost = entry(line).ok_or_else(|| QualityCostsError::Line { line: number + 1, text: line.chars().take(80).collect() })?;
            costs.push(cost);
        }
        let costs = QualityCosts(costs);
        for class in SceneClass::ALL {
            for option in QualityOption::ALL {
                if let Some(step) = (1..option.steps()).find(|step| costs.find(class, option, *step).is_none()) {
                    return Err(QualityCostsError::Missing { class: class.name(), option: option.name, step });
                }
            }
        }
        Ok(costs)
    }

    /// The cost of a step; nothing is saved by step 0, nor by one that is not in the table.
    pub fn of(&self, class: SceneClass, option: QualityOption, step: u8) -> QualityCost {
        self.find(class, option, step).unwrap_or(QualityCost { error: 0.0, time: 1.0 })
    }

    fn find(&self, class: SceneClass, option: QualityOption, step: u8) -> Option<QualityCost> {
        self.0.iter().find(|(of, what, at, _)| (*of, *what, *at) == (class, option.name, step)).map(|(.., cost)| *cost)
    }
}

fn entry(line: &str) -> Option<(SceneClass, &'static str, u8, QualityCost)> {
    let parts: Vec<&str> = line.split(',').collect();
    let [class, option, step, _, error, time] = parts[..] else { return None };
    let class = SceneClass::ALL.into_iter().find(|known| known.name() == class)?;
    let option = QualityOption::ALL.into_iter().find(|known| known.name == option)?;
    let cost = QualityCost { error: error.parse().ok()?, time: time.parse().ok()? };
    let step: u8 = step.parse().ok()?;
    let is_sound = (0.0..=1.0).contains(&cost.error) && cost.time > 0.0 && cost.time.is_finite() && step < option.steps();
    is_sound.then_some((class, option.name, step, cost))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_table_is_whole() {
        let costs = QualityCosts::read(SHIPPED).expect("tables/quality.csv");
        assert_eq!(&costs, QualityCosts::shipped());
        for class in SceneClass::ALL {
            assert!(costs.of(class, QualityOption::ALL[0], 4).time < 1.0, "{}: fewer pixels take less time", class.name());
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        let missing = QualityCosts::read(HEADER).expect_err("empty");
        assert!(matches!(missing, QualityCostsError::Missing { step: 1, .. }), "{missing}");
        for wrong in
            ["disk,resolution,1,0.8,nan,0.7", "disk,resolution,1,0.8,0.1,0", "disk,resolution,99,0.8,0.1,0.5", "disk,x,1,0,0.1,0.5", "a"]
        {
            assert_eq!(QualityCosts::read(wrong), Err(QualityCostsError::Line { line: 1, text: wrong.into() }));
        }
    }

    #[test]
    fn scenes_have_their_class() {
        assert_eq!(SceneClass::of(true, true, false), SceneClass::Chase);
        assert_eq!(SceneClass::of(false, true, false), SceneClass::Disk);
        assert_eq!(SceneClass::of(true, true, true), SceneClass::Aurora);
        assert_eq!(SceneClass::of(true, false, false), SceneClass::Bodies);
    }
}
