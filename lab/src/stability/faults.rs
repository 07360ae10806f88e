//! Faults put into a copy of the sources, all at once, since each is found by a test of its own: which tests fail then?

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::held::{HELD, Held};

/// Why the faults could not be tried.
#[derive(Debug, thiserror::Error)]
pub enum FaultError {
    /// A file of the sources or of the copy.
    #[error("{0}: {1}")]
    File(PathBuf, io::Error),
    /// A program that could not be run, or failed.
    #[error("`{0}`: {1}")]
    Run(&'static str, String),
    /// What a fault replaces is not there, or more than once.
    #[error("{0}: `{1}` stands there {2} times, not once")]
    Place(&'static str, &'static str, usize),
}

/// Puts the faults into the copy of the sources in `folder`.
fn spoil(folder: &Path) -> Result<(), FaultError> {
    for held in HELD {
        let fault = held.fault;
        let path = folder.join(fault.file);
        let text = std::fs::read_to_string(&path).map_err(|error| FaultError::File(path.clone(), error))?;
        let count = text.matches(fault.right).count();
        if count != 1 {
            return Err(FaultError::Place(fault.file, fault.right, count));
        }
        std::fs::write(&path, text.replace(fault.right, fault.wrong)).map_err(|error| FaultError::File(path, error))?;
    }
    Ok(())
}

/// What the test says after its name in cargo's output: None where it did not run.
fn passed(output: &str, held: &Held) -> Option<bool> {
    let ending = format!("::{} ... ", held.test[1]);
    let line = output.lines().find(|line| line.contains(&ending))?;
    Some(!line.trim_end().ends_with("FAILED"))
}

/// Copies the committed sources to `folder`, spoils them, runs the tests there, and says of each place whether its test found the fault.
/// It takes as long as a build of all tests.
pub fn run(sources: &Path, folder: &Path) -> Result<Vec<(&'static str, bool)>, FaultError> {
    let started = |what: &'static str| move |error: io::Error| FaultError::Run(what, error.to_string());
    let cloned = Command::new("git").arg("clone").arg("-q").arg(sources).arg(folder).output().map_err(started("git clone"))?;
    if !cloned.status.success() {
        return Err(FaultError::Run("git clone", String::from_utf8_lossy(&cloned.stderr).into_owned()));
    }
    spoil(folder)?;
    let names = HELD.iter().map(|held| held.test[1]);
    let tested = Command::new("./test")
        .args(["--no-fail-fast", "--"])
        .args(names)
        .current_dir(folder)
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(started("./test"))?;
    let output = String::from_utf8_lossy(&tested.stdout).into_owned();
    let found = HELD.iter().map(|held| passed(&output, held).map(|passed| (held.test[1], !passed)));
    found.collect::<Option<_>>().ok_or_else(|| FaultError::Run("./test", "some of the tests did not run".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every fault can be put in, and every test is there.
    #[test]
    fn faults_and_tests_are_where_the_table_says() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for held in HELD {
            let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
            assert_eq!(text(held.fault.file).matches(held.fault.right).count(), 1, "{}: {}", held.fault.file, held.fault.right);
            assert!(text(held.test[0]).contains(&format!("fn {}(", held.test[1])), "{:?}", held.test);
        }
    }

    #[test]
    fn outcomes_are_read() {
        let say = |word: &str| format!("running 1 test\ntest a::b::{} ... {word}\n", HELD[0].test[1]);
        assert_eq!([say("ok"), say("FAILED"), String::new()].map(|text| passed(&text, &HELD[0])), [Some(true), Some(false), None]);
    }
}
