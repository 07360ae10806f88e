//! The scenes in `tests/scenes`: each failed once and is judged as a whole, at the size and T that its first lines say.

use lensrunner::scene::GameConfig;
use lensrunner_lab::compare::fault::Kind;
use lensrunner_lab::compare::judged::{Terms, judge};
use lensrunner_lab::compare::random::case_file::{CaseFile, files};
use lensrunner_lab::contestant::GameContestant;

/// Light may be off by some times the limit: what is known of that is in docs/lab/verdict.md, and sums of thin images vary a little from run
/// to run.
#[test]
fn scenes_that_failed_once_are_right() {
    const LIGHT_OFF: f64 = 3.0;
    let folder = crate::support::root().join("tests/scenes");
    let contestant = GameContestant::default();
    let paths = files(&[folder]).unwrap();
    assert!(!paths.is_empty());
    let mut wrong = Vec::new();
    for path in paths {
        let case = CaseFile::load(&path).unwrap().case(&path, &GameConfig::default()).unwrap();
        let judged = judge(&case, &Terms { seconds: 600.0, ..Terms::default() }, &|case| contestant.draw(case));
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match judged {
            Ok(judged) => {
                let faults = judged.faults.iter().filter(|fault| fault.kind != Kind::Light || fault.excess > LIGHT_OFF);
                wrong.extend(faults.map(|fault| format!("{name}: {}: {fault}", fault.kind)));
            }
            Err(gave_up) => wrong.push(format!("{name}: {gave_up}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
