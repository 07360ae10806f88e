//! `lensrunner check`: flies scenes and missions as their `[expect]` says, and tells what came otherwise.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::rules::Outcome;
use super::run::{FlightReport, RunRequest, run};
use crate::scene::expect::Expect;
use crate::scene::model::import::load_or_placeholder;
use crate::scene::{GameConfig, Scene, SceneError};

/// Why nothing can be checked.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A folder cannot be read.
    #[error("{path}: {source}")]
    Read {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A folder holds nothing that could be checked.
    #[error("{0}: there is no .toml file in it")]
    Empty(PathBuf),
}

/// What came of one file.
#[derive(Debug)]
pub enum CheckResult {
    /// As expected.
    AsExpected(FlightReport),
    /// It expects nothing and was not flown: only that the file is right was checked.
    NothingExpected,
    /// Otherwise than expected: one sentence each.
    Failed(Vec<String>),
    /// The file is wrong.
    Refused(SceneError),
}

impl CheckResult {
    /// Whether it counts as a failure.
    pub fn is_failure(&self) -> bool {
        matches!(self, CheckResult::Failed(_) | CheckResult::Refused(_))
    }
}

impl std::fmt::Display for CheckResult {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            CheckResult::AsExpected(report) => {
                write!(f, "as expected: {} at T = {:.2}, tau = {:.2}", outcome_name(report.outcome), report.time, report.proper_time)
            }
            CheckResult::NothingExpected => f.write_str("nothing expected"),
            CheckResult::Failed(wrong) => write!(f, "FAILED: {}", wrong.join("; ")),
            CheckResult::Refused(error) => write!(f, "REFUSED: {error}"),
        }
    }
}

/// The files that a path stands for: itself, or every .toml file of a folder, sorted.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, CheckError> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let read = |source| CheckError::Read { path: path.to_path_buf(), source };
    let entries = std::fs::read_dir(path).map_err(read)?.collect::<Result<Vec<_>, _>>().map_err(read)?;
    let mut files: Vec<PathBuf> =
        entries.into_iter().map(|entry| entry.path()).filter(|file| file.extension().is_some_and(|ending| ending == "toml")).collect();
    files.sort();
    if files.is_empty() { Err(CheckError::Empty(path.to_path_buf())) } else { Ok(files) }
}

/// Flies every file, in parallel; verdicts in the order of the files.
pub fn check_all(files: &[PathBuf], config: &GameConfig) -> Vec<CheckResult> {
    files.par_iter().map(|file| check_file(file, config)).collect()
}

fn check_file(file: &Path, config: &GameConfig) -> CheckResult {
    match crate::scene::load(&file.to_string_lossy()) {
        Ok(scene) => check(&scene, config),
        Err(error) => CheckResult::Refused(error),
    }
}

/// Flies a scene as it expects to be flown.
pub fn check(scene: &Scene, config: &GameConfig) -> CheckResult {
    // Each file once, however many ships are made of it.
    let models: BTreeSet<&str> = scene.ships.iter().filter_map(|ship| ship.model.as_deref()).collect();
    let missing: Vec<String> = models.into_iter().filter_map(|model| load_or_placeholder(model).1).map(|error| error.to_string()).collect();
    if !missing.is_empty() {
        return CheckResult::Failed(missing);
    }
    let Some(expect) = &scene.expect else { return CheckResult::NothingExpected };
    if scene.ships.is_empty() {
        return CheckResult::Failed(vec!["[expect] needs at least one [[ship]]".into()]);
    }
    let request = RunRequest { difficulty: expect.difficulty, pilot: expect.pilot, seed: expect.seed, until: expect.until };
    let report = run(scene, config, &request);
    let wrong = differences(expect, &report);
    if wrong.is_empty() { CheckResult::AsExpected(report) } else { CheckResult::Failed(wrong) }
}

/// The name of an outcome in `[expect]`.
pub fn outcome_name(outcome: Option<Outcome>) -> &'static str {
    outcome.map_or("undecided", Outcome::name)
}

/// What came otherwise than expected, a sentence each.
fn differences(expect: &Expect, report: &FlightReport) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut outside = |name: &str, range: Option<[f64; 2]>, least: f64, most: f64, unit: &str| {
        if let Some([low, high]) = range
            && (least < low || most > high)
        {
            let found = if least == most { format!("{least}") } else { format!("{least} to {most}") };
            wrong.push(format!("{name} = {found}, expected {low} to {high} {unit}"));
        }
    };
    outside("time", expect.time, report.time, report.time, "r_s/c");
    outside("own_time", expect.own_time, report.proper_time, report.proper_time, "r_s/c");
    outside("radius", expect.radius, report.radius[0], report.radius[1], "r_s");
    outside("fuel", expect.fuel.map(|least| [least, f64::INFINITY]), report.fuel, report.fuel, "c");
    outside("drift of E", expect.drift.map(|[most, _]| [0.0, most]), report.drift[0], report.drift[0], "");
    outside("drift of L", expect.drift.map(|[_, most]| [0.0, most]), report.drift[1], report.drift[1], "r_s c");
    let outcome = outcome_name(report.outcome);
    if expect.outcome.as_ref().is_some_and(|expected| expected != outcome) {
        wrong.push(format!("outcome = {outcome}, expected {}", expect.outcome.as_deref().unwrap_or_default()));
    }
    let hash = report.hash.to_string();
    if expect.hash.as_ref().is_some_and(|expected| *expected != hash) {
        wrong.push(format!("hash = {hash}, expected {}", expect.hash.as_deref().unwrap_or_default()));
    }
    wrong
}

/// Flies scenes and missions as their expect section says, in parallel; exit code 1 when one comes otherwise, 2 when a file is wrong.
///
/// A line for each file, then a summary. Files without one are only read.
#[derive(clap::Args, Clone, Debug)]
pub struct CheckArgs {
    /// Scene or mission files, and folders of them.
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    pub config: Option<PathBuf>,
}

/// Runs the command; lines go to `out`. The exit code: 0 if all is as expected.
pub fn run_command(args: &CheckArgs, out: &mut dyn std::io::Write) -> Result<u8, CommandError> {
    let config = crate::scene::config::find(args.config.as_deref())?;
    let mut paths = Vec::new();
    for path in &args.paths {
        paths.extend(files(path)?);
    }
    let verdicts = check_all(&paths, &config);
    for (path, verdict) in paths.iter().zip(&verdicts) {
        writeln!(out, "{}: {verdict}", path.display())?;
    }
    let failed = verdicts.iter().filter(|verdict| verdict.is_failure()).count();
    let as_expected = verdicts.iter().filter(|verdict| matches!(verdict, CheckResult::AsExpected(_))).count();
    writeln!(out, "{as_expected} as expected, {failed} failed, {} without [expect]", verdicts.len() - as_expected - failed)?;
    let refused = verdicts.iter().any(|verdict| matches!(verdict, CheckResult::Refused(_)));
    Ok(if refused { 2 } else { u8::from(failed > 0) })
}

/// Why the command did not run.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// The configuration is wrong.
    #[error(transparent)]
    Config(#[from] crate::scene::ConfigError),
    /// A path is wrong.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// A scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// An argument is wrong.
    #[error("{0}")]
    Argument(String),
    /// Writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

impl CommandError {
    /// Whether it is what was asked for that is wrong.
    pub fn is_input(&self) -> bool {
        !matches!(self, CommandError::Io(_))
    }
}
