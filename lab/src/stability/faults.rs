//! Faults put into a copy of the sources, all at once, since each is found by a test of its own: which tests fail then?

use std::path::Path;
use std::process::{Command, Stdio};

use super::held::{Held, held};

/// Puts the faults into the copy of the sources in `folder`.
fn spoil(folder: &Path, all: &[Held]) -> Result<(), String> {
    for Held { file, right, wrong, .. } in all {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{file}: {error}"))?;
        let count = text.matches(right).count();
        if count != 1 {
            return Err(format!("{file}: `{right}` stands there {count} times, not once"));
        }
        std::fs::write(&path, text.replace(right, wrong)).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

/// What the test says after its name in cargo's output: None where it did not run.
fn passed(output: &str, held: &Held) -> Option<bool> {
    let ending = format!("::{} ... ", held.test[1]);
    let line = output.lines().find(|line| line.contains(&ending))?;
    Some(!line.trim_end().ends_with("FAILED"))
}

/// Copies the committed sources to `folder`, spoils them, runs the tests there, and says of each place whether its test found the fault, or
/// why that could not be tried. It takes as long as a build of all tests.
pub fn run(sources: &Path, folder: &Path) -> Result<Vec<(String, bool)>, String> {
    let all = held().map_err(|error| format!("held.toml: {error}"))?;
    let cloned = Command::new("git").arg("clone").arg("-q").arg(sources).arg(folder).output().map_err(|error| format!("git: {error}"))?;
    if !cloned.status.success() {
        return Err(format!("git clone: {}", String::from_utf8_lossy(&cloned.stderr)));
    }
    spoil(folder, &all)?;
    let names = all.iter().map(|held| &held.test[1]);
    let mut test = Command::new("./test");
    let tested = test.args(["--no-fail-fast", "--"]).args(names).current_dir(folder).stderr(Stdio::inherit()).output();
    let output = String::from_utf8_lossy(&tested.map_err(|error| format!("./test: {error}"))?.stdout).into_owned();
    let found = all.iter().map(|held| passed(&output, held).map(|passed| (held.test[1].clone(), !passed)));
    found.collect::<Option<_>>().ok_or_else(|| "./test: some of the tests did not run".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every fault can be put in, and every test is there.
    #[test]
    fn faults_and_tests_are_where_the_table_says() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for Held { test, file, right, .. } in held().unwrap() {
            let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
            assert_eq!(text(&file).matches(&right).count(), 1, "{file}: {right}");
            assert!(text(&test[0]).contains(&format!("fn {}(", test[1])), "{test:?}");
        }
    }

    #[test]
    fn outcomes_are_read() {
        let first = &held().unwrap()[0];
        let say = |word: &str| format!("running 1 test\ntest a::b::{} ... {word}\n", first.test[1]);
        assert_eq!([say("ok"), say("FAILED"), String::new()].map(|text| passed(&text, first)), [Some(true), Some(false), None]);
    }
}
