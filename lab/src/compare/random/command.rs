//! `lensrunner-lab compare --random` and `--case`: many cases judged one after the other.

use crate::say::say;
use std::path::{Path, PathBuf};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

use super::case_file::CaseFile;
use super::collect;
use super::draw::draw;
use super::outcome::{Outcome, Row, summary};
use super::place;
use super::reduce::reduce;
use crate::chart::Sheet;
use crate::compare::command::{CompareError, DrawCase, difference};
use crate::compare::deadline::Deadline;
use crate::compare::fault::{Fault, main_fault};
use crate::compare::judged::{Judged, Terms, judge};
use crate::compare::report::side_by_side;
use lensrunner::judge::case::{Case, TraceError};
use lensrunner::picture_file::write_png;
use lensrunner::scene::{self, GameConfig};

/// How many cases are judged, however they are drawn.
#[derive(Clone, Debug)]
pub struct Run {
    /// How each is judged.
    pub terms: Terms,
    /// The game's configuration; None: every value its default, whatever `game.toml` says.
    pub config: Option<PathBuf>,
    /// The folder for what fails.
    pub output: PathBuf,
    /// Whether what fails is made smaller before it is left there.
    pub reduce: bool,
    /// The table that the run is added to, a .csv.
    pub collected: Option<PathBuf>,
}

impl Run {
    /// Looks over all that may be wrong before the work of which it would lose the result, and gives the configuration.
    pub fn begin(&self) -> Result<GameConfig, CompareError> {
        check_terms(&self.terms)?;
        self.collected.as_deref().map(|csv| Sheet::open(csv, &collect::COLUMNS)).transpose()?;
        make_folder(&self.output)?;
        Ok(configuration(self.config.as_deref())?)
    }

    /// How failing cases are kept.
    pub fn keep(&self) -> Option<Keep<'_>> {
        Some(Keep { folder: &self.output, reduce: self.reduce })
    }
}

fn check_terms(terms: &Terms) -> Result<(), TraceError> {
    let input = |text: String| Err(TraceError::Input(text));
    if !(0.1..=86_400.0).contains(&terms.seconds) {
        return input(format!("--limit {}: must be from 0.1 to 86400 seconds a case", terms.seconds));
    }
    if !(1e-17..=1e-3).contains(&terms.tolerance) {
        return input(format!("--tolerance {}: must be from 1e-17 to 1e-3", terms.tolerance));
    }
    Ok(())
}

/// The configuration of cases: that of a named file, else all defaults.
fn configuration(named: Option<&Path>) -> Result<GameConfig, TraceError> {
    Ok(named.map(scene::config::load).transpose()?.unwrap_or_default())
}

/// How failing cases are kept.
#[derive(Clone, Copy, Debug)]
pub struct Keep<'a> {
    /// The folder for them.
    pub folder: &'a Path,
    /// Whether they are made smaller first, which takes many times as long as to judge one.
    pub reduce: bool,
}

/// Judges `count` cases that nobody chose, drawn from a seed, from the number `first` on; leaves each that fails in the folder; prints a
/// table. Gives a row for each case.
pub fn run(seed: u64, first: u64, count: u64, run: &Run, contestant: &DrawCase) -> Result<Vec<Row>, CompareError> {
    let config = run.begin()?;
    let bar = bar(count);
    let mut rows = Vec::new();
    for number in first..first.saturating_add(count) {
        let drawn = draw(seed, number);
        let name = format!("seed-{seed}-case-{number}");
        let command = format!("lensrunner-lab compare --random 1 --seed {seed} --first {number}");
        let notes = vec![format!("case {number} of seed {seed} ({}): {command}", drawn.corner.word())];
        let file = CaseFile { notes, text: drawn.text, at: drawn.at, size: drawn.size };
        let row = one(&name, drawn.corner.word(), &file, &config, &run.terms, run.keep(), contestant)?;
        report(&bar, &row);
        rows.push(row);
    }
    bar.finish_and_clear();
    say(summary(&rows).trim_end());
    if let Some(csv) = &run.collected {
        let seed = if first == 0 { seed.to_string() } else { format!("{seed} from {first}") };
        collect::add(csv, "random", &seed, &run.terms, &rows)?;
    }
    Ok(rows)
}

/// Judges the cases of these files and folders; prints a table. Gives a row for each.
pub fn run_files(
    paths: &[PathBuf],
    config: Option<&Path>,
    terms: &Terms,
    keep: Option<Keep>,
    contestant: &DrawCase,
) -> Result<Vec<Row>, CompareError> {
    check_terms(terms)?;
    let config = configuration(config)?;
    // All are read before the first is judged.
    let files = super::case_file::files(paths)?;
    let cases = files.iter().map(|path| Ok((path, CaseFile::load(path)?))).collect::<Result<Vec<_>, TraceError>>()?;
    if let Some(keep) = keep {
        make_folder(keep.folder)?;
    }
    let bar = bar(cases.len() as u64);
    let mut rows = Vec::new();
    for (path, file) in cases {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let row = one(&name, "file", &file, &config, terms, keep, contestant)?;
        report(&bar, &row);
        rows.push(row);
    }
    bar.finish_and_clear();
    say(summary(&rows).trim_end());
    Ok(rows)
}

/// Judges one case; if it fails and there is a folder, its scene and its pictures are left there.
pub fn one(
    name: &str,
    corner: &str,
    file: &CaseFile,
    config: &GameConfig,
    terms: &Terms,
    keep: Option<Keep>,
    contestant: &DrawCase,
) -> Result<Row, CompareError> {
    let started = Instant::now();
    let case = file.case(Path::new(&format!("{name}.toml")), config)?;
    let outcome = match judge(&case, terms, contestant) {
        Ok(judged) => {
            if let (Some(keep), Some(fault)) = (keep, main_fault(&judged.faults)) {
                let reduced = if keep.reduce { reduced(file, fault, config, terms, contestant) } else { None };
                let (file, case, judged) = match &reduced {
                    Some((file, case, judged)) => (file, case, judged),
                    None => (file, &case, &judged),
                };
                leave(keep.folder, name, file, case, judged)?;
            }
            Outcome::of(&judged)
        }
        Err(gave_up) => Outcome::GaveUp(gave_up.to_string()),
    };
    Ok(Row { name: name.to_owned(), corner: corner.to_owned(), size: file.size, outcome, seconds: started.elapsed().as_secs_f64() })
}

/// The case made smaller while it fails in the same way, with what came of it; None if that could not be done.
fn reduced(file: &CaseFile, fault: &Fault, config: &GameConfig, terms: &Terms, contestant: &DrawCase) -> Option<(CaseFile, Case, Judged)> {
    let deadline = Deadline::after(REDUCTION * terms.seconds);
    let path = Path::new("reduced.toml");
    let is_fair = |case: &Case| place::is_fair(&case.scene, config, case.time, false);
    let was_fair = file.case(path, config).is_ok_and(|case| is_fair(&case));
    let mut last = None;
    // A fault that is hardly one any more is another.
    let least = fault.excess.sqrt();
    let (mut best, asked) = reduce(file, &mut |smaller| {
        if deadline.is_over() {
            return None;
        }
        let Some(case) = smaller.case(path, config).ok().filter(|case| !was_fair || is_fair(case)) else { return Some(false) };
        let Ok(judged) = judge(&case, terms, contestant) else { return Some(false) };
        let same = main_fault(&judged.faults).is_some_and(|found| found.kind == fault.kind && found.excess >= least);
        if same {
            last = Some((case, judged));
        }
        Some(same)
    });
    let (case, judged) = last?;
    best.notes.push(format!("reduced in {asked} steps from a case with the fault: {}: {fault}", fault.kind));
    Some((best, case, judged))
}

/// Reducing a case may take so many times what the judge may take over one.
const REDUCTION: f64 = 3.0;

/// Writes the scene with its faults as comment lines, and the pictures side by side.
pub fn leave(output: &Path, name: &str, file: &CaseFile, case: &Case, judged: &Judged) -> Result<(), CompareError> {
    let path = output.join(format!("{name}.toml"));
    let mut file = file.clone();
    // Those of an earlier verdict.
    file.notes.retain(|note| !["judged by:", "main fault:", "fault:"].iter().any(|old| note.starts_with(old)));
    file.notes.push(format!("judged by: lensrunner-lab compare --case {name}.toml"));
    file.notes.extend(main_fault(&judged.faults).map(|fault| format!("main fault: {}: {fault}", fault.kind)));
    file.notes.extend(judged.faults.iter().map(|fault| format!("fault: {}: {fault}", fault.kind)));
    write(&path, &file.to_text())?;
    if let (Some((frame, picture)), Some(verdict)) = (&judged.pictures, &judged.verdict) {
        let difference = difference(picture, frame);
        let (size, bytes) = side_by_side(picture, frame, &difference, &verdict.displaced, &case.post_process());
        write_png(&path.with_extension("png"), &bytes, size)?;
    }
    Ok(())
}

/// Writes a text file; an error names it.
pub fn write(path: &Path, text: &str) -> Result<(), CompareError> {
    std::fs::write(path, text).map_err(|error| CompareError::Output(path.to_path_buf(), error))
}

/// Makes the folder if there is none; an error names it.
fn make_folder(path: &Path) -> Result<(), CompareError> {
    std::fs::create_dir_all(path).map_err(|error| CompareError::Output(path.to_path_buf(), error))
}

/// A bar of so many cases.
pub fn bar(count: u64) -> ProgressBar {
    let bar = ProgressBar::new(count);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} cases, {elapsed}, {eta} left  {msg}") {
        bar.set_style(style);
    }
    bar
}

/// Moves the bar on, and says what a case came to, where something is to be said.
pub fn report(bar: &ProgressBar, row: &Row) {
    bar.inc(1);
    if let Some(line) = row.remark() {
        // Also where there is no terminal for the bar.
        bar.suspend(|| say(line));
    }
}
