//! Makes products anew: one after the other, each into a folder of its own first, so that a broken run leaves the documents as they are.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use indicatif::{ProgressBar, ProgressStyle};

use super::made::{Record, RecordError, made};
use super::{Made, Product, Program, Run, Standing, git, standing};
use crate::chart::Provenance;
use crate::say::say;

/// What is to be made.
#[derive(Clone, Debug)]
pub struct MakeRequest {
    /// The project's root.
    pub root: PathBuf,
    /// Where products go.
    pub folder: PathBuf,
    /// Where they are made, and their logs kept.
    pub workshop: PathBuf,
    /// In small.
    pub quick: bool,
    /// Also what is up to date.
    pub again: bool,
    /// Only these products; empty for all.
    pub only: Vec<String>,
    /// The file that keeps how long each took.
    pub times: PathBuf,
    /// The name of the graphics adapter, if there is one.
    pub adapter: String,
}

/// Why products cannot be made at all.
#[derive(Debug, thiserror::Error)]
pub enum MakeError {
    /// No product is called so.
    #[error("--only {0}: there is no such product; lab/run status lists them")]
    Unknown(String),
    /// The record of the folder.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Where this program lies.
    #[error("the programs are not found: {0}")]
    Programs(io::Error),
}

/// Why one product was not made.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}: {1}")]
    Io(String, io::Error),
    #[error("{0} ended with {1} and did not write {2}; see {3}")]
    NotWritten(&'static str, String, String, PathBuf),
}

/// How long products took, in seconds, by their names.
struct Times {
    path: PathBuf,
    table: toml::Table,
}

impl Times {
    /// Of the last run; what cannot be read is forgotten, as it is only guessed by.
    fn load(path: &Path) -> Times {
        let table = fs::read_to_string(path).ok().and_then(|text| text.parse().ok()).unwrap_or_default();
        Times { path: path.to_owned(), table }
    }

    fn key(product: &Product, quick: bool) -> String {
        format!("{}{}", product.name, if quick { "-quick" } else { "" })
    }

    fn expected(&self, product: &Product, quick: bool) -> f64 {
        let known = self.table.get(&Times::key(product, quick)).and_then(toml::Value::as_float);
        known.unwrap_or(product.seconds[usize::from(quick)])
    }

    fn put(&mut self, product: &Product, quick: bool, seconds: f64) {
        self.table.insert(Times::key(product, quick), seconds.into());
        // Without it the next run only guesses worse.
        let _ = fs::write(&self.path, self.table.to_string());
    }
}

/// "1 h 02 min", "3 min 20 s", "8 s".
pub fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, m, s) => format!("{m} min {s:02} s"),
        (h, m, _) => format!("{h} h {m:02} min"),
    }
}

/// The products that are asked for, in the order of the table.
pub fn asked(all: &'static [Product], request: &MakeRequest) -> Result<Vec<&'static Product>, MakeError> {
    if let Some(unknown) = request.only.iter().find(|name| !all.iter().any(|product| product.name == name.as_str())) {
        return Err(MakeError::Unknown(unknown.clone()));
    }
    let wanted = |product: &&Product| request.only.is_empty() || request.only.iter().any(|name| name == product.name);
    Ok(all.iter().filter(wanted).filter(|product| !product.runs(request.quick).is_empty()).collect())
}

/// Whether the product in the folder was made by the same commands from the same sources.
pub fn is_done(product: &Product, request: &MakeRequest, record: &Record) -> bool {
    made(&request.root, &request.folder, product, record).is_some_and(|made: Made| {
        made.told
            && same(&made.commands, &product.commands(request.quick))
            && standing(&request.root, &made.on.commit, product.all_sources()) == Standing::Fresh
    })
}

/// Whether commands are the same, in whatever order their options stand.
fn same(a: &[String], b: &[String]) -> bool {
    let sorted = |command: &String| {
        let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
        words.sort();
        words
    };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| sorted(a) == sorted(b))
}

/// Makes them by the programs that lie beside this one; says each as it is done, and returns the names of those that failed.
pub fn make(all: &'static [Product], request: &MakeRequest) -> Result<Vec<&'static str>, MakeError> {
    make_with(all, request, &std::env::current_exe().map_err(MakeError::Programs)?)
}

/// The same by the programs that lie beside `programs`.
pub fn make_with(all: &'static [Product], request: &MakeRequest, programs: &Path) -> Result<Vec<&'static str>, MakeError> {
    let mut record = Record::load(&request.folder)?;
    let mut times = Times::load(&request.times);
    let (done, todo): (Vec<&Product>, Vec<&Product>) =
        asked(all, request)?.into_iter().partition(|product| !request.again && is_done(product, request, &record));
    if !done.is_empty() {
        let names: Vec<_> = done.iter().map(|product| product.name).collect();
        say(format_args!("up to date: {}", names.join(", ")));
    }
    let expected: Vec<f64> = todo.iter().map(|product| times.expected(product, request.quick)).collect();
    let whole: f64 = expected.iter().sum();
    if !todo.is_empty() {
        say(format_args!("to make: {} products, about {}", todo.len(), duration(whole)));
    }
    let bar = ProgressBar::new((10.0 * whole) as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {msg}") {
        bar.set_style(style);
    }
    let (mut failed, mut before) = (Vec::new(), 0.0);
    for (place, (product, expected)) in todo.iter().zip(&expected).enumerate() {
        let began = Instant::now();
        let tick = |elapsed: f64| {
            let now = before + elapsed.min(*expected);
            bar.set_position((10.0 * now) as u64);
            bar.set_message(format!("{}/{} {}: {} left", place + 1, todo.len(), product.name, duration(whole - now)));
        };
        let result = one(product, request, programs, &tick);
        let seconds = began.elapsed().as_secs_f64();
        before += expected;
        let left = duration(whole - before);
        match result {
            Ok(()) => {
                times.put(product, request.quick, seconds);
                let on = Provenance { command: String::new(), commit: commit(&request.root, product), ..Provenance::now(&request.adapter) };
                record.put(product.name, &Made { commands: product.commands(request.quick), on, seconds, told: true })?;
                bar.suspend(|| say(format_args!("{}: {}; {left} left", product.name, duration(seconds))));
            }
            Err(failure) => {
                failed.push(product.name);
                bar.suspend(|| say(format_args!("{}: FAILED: {failure}; {left} left", product.name)));
            }
        }
    }
    bar.finish_and_clear();
    Ok(failed)
}

/// The commit checked out, with "+" if sources of the product differ from it.
fn commit(root: &Path, product: &Product) -> String {
    let head = git::ask(root, &["rev-parse", "--short=10", "HEAD"]).unwrap_or_default();
    let mark = if standing(root, &head, product.all_sources()) == Standing::Fresh { "" } else { "+" };
    format!("{head}{mark}")
}

/// Makes one product in the workshop and takes its files to the folder.
fn one(product: &Product, request: &MakeRequest, programs: &Path, tick: &dyn Fn(f64)) -> Result<(), Failure> {
    let place = request.workshop.join(product.name);
    let io = |path: &Path| {
        let path = path.display().to_string();
        move |error| Failure::Io(path, error)
    };
    if place.exists() {
        fs::remove_dir_all(&place).map_err(io(&place))?;
    }
    fs::create_dir_all(&place).map_err(io(&place))?;
    let home = request.folder.join(product.folder);
    if product.grows && !request.quick {
        for file in product.files.iter().filter(|file| home.join(file).is_file()) {
            fs::copy(home.join(file), place.join(file)).map_err(io(&home.join(file)))?;
        }
    }
    let (began, since) = (Instant::now(), SystemTime::now());
    let mut last = (Program::Lab, String::from("nothing"));
    for run in product.runs(request.quick) {
        let code = call(run, request, &place, programs, &|| tick(began.elapsed().as_secs_f64()))?;
        last = (run.program, code);
    }
    let log = place.join(LOG);
    for file in product.files {
        let from = place.join(file);
        // A file system's clock may stand a little before the system's.
        let written = from.metadata().and_then(|data| data.modified()).is_ok_and(|time| time + Duration::from_secs(2) >= since);
        if !written {
            return Err(Failure::NotWritten(last.0.name(), last.1, (*file).to_owned(), log));
        }
    }
    for file in product.files {
        let (from, to) = (place.join(file), home.join(file));
        if file.ends_with('/') {
            take_folder(&from, &to).map_err(io(&to))?;
        } else {
            fs::create_dir_all(&home).and_then(|()| fs::copy(&from, &to)).map_err(io(&to))?;
        }
    }
    Ok(())
}

/// What a product's programs say, in its workshop.
const LOG: &str = "log.txt";

/// Puts what is in `from` in the place of what is in `to`.
fn take_folder(from: &Path, to: &Path) -> io::Result<()> {
    if to.exists() {
        fs::remove_dir_all(to)?;
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Runs a program to its end; how it ended. A code that is not 0 may be a verdict, so whether the files are there decides.
fn call(run: &Run, request: &MakeRequest, place: &Path, programs: &Path, tick: &dyn Fn()) -> Result<String, Failure> {
    let program = programs.with_file_name(run.program.name());
    let wrong = |what: &Path| {
        let what = what.display().to_string();
        move |error| Failure::Io(what, error)
    };
    let log = place.join(LOG);
    let log_file = File::options().create(true).append(true).open(&log).map_err(wrong(&log))?;
    let output: Stdio = match run.printed {
        Some(name) => File::create(place.join(name)).map_err(wrong(&place.join(name)))?.into(),
        None => log_file.try_clone().map_err(wrong(&log))?.into(),
    };
    let folder = place.to_string_lossy();
    let arguments = run.arguments.split_whitespace().map(|word| word.replace("{}", &folder));
    let mut command = Command::new(&program);
    command.args(arguments).current_dir(&request.root).stdin(Stdio::null()).stdout(output).stderr(log_file);
    let mut child = command.spawn().map_err(wrong(&program))?;
    loop {
        tick();
        if let Some(status) = child.try_wait().map_err(wrong(&program))? {
            return Ok(status.to_string());
        }
        std::thread::sleep(Duration::from_millis(200));
    }
}
