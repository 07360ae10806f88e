//! Makes products anew: one after the other, each into a folder of its own first, so that a broken run leaves the documents as they are.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use clap::Args;
use lensrunner::render::Gpu;

use super::made::{Made, ProductsError, Record, Standing, git, made, standing};
use super::{DOCUMENTS, Product};
use crate::chart::Provenance;
use crate::say::say;

/// Makes every chart, table and picture of the documents anew. What was made by the same command from the same sources is left, so a run
/// that was broken off goes on where it was.
#[derive(Args, Clone, Debug, Default)]
pub struct MakeRequest {
    /// Everything in small, in less than ten minutes on two cores, into a folder of its own.
    #[arg(long)]
    pub quick: bool,
    /// Only these products, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Also what is up to date.
    #[arg(long)]
    pub again: bool,
    /// The folder [default: docs, with --quick out/quick].
    #[arg(short, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The project's root.
    #[arg(skip)]
    pub root: PathBuf,
}

impl MakeRequest {
    /// Where products go.
    pub fn folder(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| self.root.join(if self.quick { "out/quick" } else { DOCUMENTS }))
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

/// Whether the product in the folder was made by the same commands from the same sources.
pub fn is_done(product: &Product, request: &MakeRequest, record: &Record) -> bool {
    // In whatever order their options stand.
    let sorted = |commands: &[String]| -> Vec<Vec<String>> {
        let sorted = |command: &String| {
            let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
            words.sort();
            words
        };
        commands.iter().map(sorted).collect()
    };
    made(&request.root, &request.folder(), product, record).is_some_and(|made: Made| {
        !made.guessed
            && sorted(&made.commands) == sorted(&product.commands(request.quick))
            && standing(&request.root, &made.on.commit, &product.sources) == Standing::Fresh
    })
}

/// Makes those that are asked for by the programs that lie beside `programs`; says each as it is done, and returns the names of those that
/// failed.
pub fn make(all: &[Product], request: &MakeRequest, programs: &Path) -> Result<Vec<String>, ProductsError> {
    if let Some(unknown) = request.only.iter().find(|name| all.iter().all(|product| product.name != **name)) {
        return Err(ProductsError::Unknown(unknown.clone()));
    }
    let mut record = Record::load(&request.folder())?;
    let wanted = |product: &&Product| request.only.is_empty() || request.only.contains(&product.name);
    let (done, todo): (Vec<&Product>, Vec<&Product>) = all
        .iter()
        .filter(wanted)
        .filter(|product| !product.runs(request.quick).is_empty())
        .partition(|product| !request.again && is_done(product, request, &record));
    for product in done {
        say(format_args!("{}: up to date", product.name));
    }
    let adapter = Gpu::headless().map(|gpu| gpu.adapter.name.clone()).unwrap_or_default();
    let mut failed = Vec::new();
    for (place, product) in todo.iter().enumerate() {
        eprintln!("{}/{} {}", place + 1, todo.len(), product.name);
        let began = Instant::now();
        if let Err(failure) = one(product, request, programs) {
            say(format_args!("{}: FAILED: {failure}", product.name));
            failed.push(product.name.clone());
            continue;
        }
        let seconds = began.elapsed().as_secs_f64().round();
        let on = Provenance { command: String::new(), commit: commit(&request.root, product), ..Provenance::now(&adapter) };
        record.put(&product.name, &Made { commands: product.commands(request.quick), on, seconds, guessed: false })?;
        say(format_args!("{}: {}", product.name, duration(seconds)));
    }
    Ok(failed)
}

/// The commit checked out, with "+" if sources of the product differ from it.
fn commit(root: &Path, product: &Product) -> String {
    let head = git(root, &["rev-parse", "--short=10", "HEAD"]).unwrap_or_default();
    let mark = if standing(root, &head, &product.sources) == Standing::Fresh { "" } else { "+" };
    format!("{head}{mark}")
}

/// Makes one product in the workshop and takes its files to the folder.
fn one(product: &Product, request: &MakeRequest, programs: &Path) -> Result<(), ProductsError> {
    let place = request.root.join("out/workshop").join(&product.name);
    let wrong = |path: &Path| {
        let path = path.to_owned();
        move |error| ProductsError::Io(path, error)
    };
    if place.exists() {
        fs::remove_dir_all(&place).map_err(wrong(&place))?;
    }
    fs::create_dir_all(&place).map_err(wrong(&place))?;
    let home = request.folder().join(&product.folder);
    if product.grows && !request.quick {
        for file in product.files.iter().filter(|file| home.join(file).is_file()) {
            fs::copy(home.join(file), place.join(file)).map_err(wrong(&home.join(file)))?;
        }
    }
    let (since, mut ended) = (SystemTime::now(), [String::new(), String::new()]);
    for run in product.runs(request.quick) {
        ended = call(run, request, &place, programs)?;
    }
    for file in &product.files {
        let from = place.join(file);
        // A file system's clock may stand a little before the system's.
        let written = from.metadata().and_then(|data| data.modified()).is_ok_and(|time| time + Duration::from_secs(2) >= since);
        if !written {
            let [program, code] = ended;
            return Err(ProductsError::NotWritten(program, code, file.clone(), place.join(LOG)));
        }
    }
    for file in &product.files {
        let (from, to) = (place.join(file), home.join(file));
        if file.ends_with('/') {
            take_folder(&from, &to).map_err(wrong(&to))?;
        } else {
            fs::create_dir_all(&home).and_then(|()| fs::copy(&from, &to)).map_err(wrong(&to))?;
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

/// Runs a command to its end; the program and how it ended. A code that is not 0 may be a verdict, so whether the files are there decides.
fn call(run: &str, request: &MakeRequest, place: &Path, programs: &Path) -> Result<[String; 2], ProductsError> {
    let here = |word: &str| word.replace("{}", &place.to_string_lossy());
    let (command, printed) = run.split_once(" > ").map_or((run, None), |(command, file)| (command, Some(here(file))));
    let mut words = command.split_whitespace();
    let name = words.next().unwrap_or_default();
    let program = programs.with_file_name(name);
    let wrong = |error| ProductsError::Io(program.clone(), error);
    let log = File::options().create(true).append(true).open(place.join(LOG)).map_err(wrong)?;
    let output: Stdio = match printed {
        Some(file) => File::create(file).map_err(wrong)?.into(),
        None => log.try_clone().map_err(wrong)?.into(),
    };
    let mut command = Command::new(&program);
    command.args(words.map(here)).current_dir(&request.root).stdin(Stdio::null()).stdout(output).stderr(log);
    Ok([name.to_owned(), command.status().map_err(wrong)?.to_string()])
}
