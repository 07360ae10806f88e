//! The exact picture of a photo, traced in the background by a program of its own: this one, started as `lensrunner trace`. The game goes
//! on meanwhile; what the tracer takes beyond its memory and time is its own trouble.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How far a picture has come.
#[derive(Clone, Debug, PartialEq)]
pub enum DevelopProgress {
    /// The share that is traced, 0 to 1.
    Traced(f64),
    /// The exact picture is in this file.
    Done(PathBuf),
    /// There is none: why, in a sentence.
    Failed(String),
    /// It was given up, as asked.
    Cancelled,
}

/// A picture that is being traced. Dropped, it is given up.
#[derive(Debug)]
pub struct Developing(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    progress: DevelopProgress,
    child: Option<Child>,
}

/// The longest line that is read from the tracer, in bytes.
const LONGEST: u64 = 4096;
/// Between two looks whether the tracer has ended, once it has said all.
const PATIENCE: Duration = Duration::from_millis(20);

/// What this program starts of itself.
fn with_own_program(start: impl FnOnce(&Path) -> Developing) -> Developing {
    match std::env::current_exe() {
        Ok(program) => start(&program),
        Err(error) => Developing::of(DevelopProgress::Failed(format!("the program cannot be found: {error}"))),
    }
}

impl Developing {
    /// Begins to trace the moment that `picture` carries, with `samples` rays a pixel (a square number), into `output`. A core is left to
    /// the game.
    pub fn trace(picture: &Path, samples: u32, output: &Path) -> Developing {
        with_own_program(|program| Developing::trace_with(program, picture, samples, output))
    }

    /// The same with this program as the tracer.
    pub fn trace_with(program: &Path, picture: &Path, samples: u32, output: &Path) -> Developing {
        let threads = std::thread::available_parallelism().map_or(1, |cores| cores.get().saturating_sub(1).max(1));
        let mut command = Command::new(program);
        command.arg("trace").arg("--from").arg(picture).arg("-o").arg(output).arg("--progress");
        command.args(["--samples", &samples.to_string(), "--threads", &threads.to_string()]);
        Developing::run(command, output)
    }

    /// Begins to draw the moment that `picture` carries as the game does, into `output`.
    pub fn draw(picture: &Path, output: &Path) -> Developing {
        with_own_program(|program| {
            let mut command = Command::new(program);
            command.arg("shot").arg("--from").arg(picture).arg("-o").arg(output);
            Developing::run(command, output)
        })
    }

    fn run(mut command: Command, output: &Path) -> Developing {
        let developing = Developing::of(DevelopProgress::Traced(0.0));
        let (state, output) = (developing.0.clone(), output.to_path_buf());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Starting a program takes longer than a frame may.
        std::thread::spawn(move || {
            let end = trace(&state, command, output);
            let mut state = locked(&state);
            state.child = None;
            if state.progress != DevelopProgress::Cancelled {
                state.progress = end;
            }
        });
        developing
    }

    fn of(progress: DevelopProgress) -> Developing {
        Developing(Arc::new(Mutex::new(State { progress, child: None })))
    }

    /// How far it has come.
    pub fn progress(&self) -> DevelopProgress {
        locked(&self.0).progress.clone()
    }

    /// Gives the picture up, unless it is done.
    pub fn cancel(&self) {
        let mut state = locked(&self.0);
        if matches!(state.progress, DevelopProgress::Traced(_)) {
            state.progress = DevelopProgress::Cancelled;
            // One that has just ended cannot be killed, and need not be.
            _ = state.child.as_mut().map(Child::kill);
        }
    }
}

impl Drop for Developing {
    fn drop(&mut self) {
        self.cancel();
    }
}

fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs the tracer to its end.
fn trace(state: &Mutex<State>, mut command: Command, output: PathBuf) -> DevelopProgress {
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => return DevelopProgress::Failed(format!("the tracer cannot be started: {error}")),
    };
    let (said, complained) = (child.stdout.take(), child.stderr.take());
    {
        let mut state = locked(state);
        if state.progress == DevelopProgress::Cancelled {
            _ = child.kill();
        }
        state.child = Some(child);
    }
    // Read beside the other, so that neither waits for the other's reader.
    let complaint = std::thread::spawn(move || complained.and_then(last_error));
    for line in said.into_iter().flat_map(lines) {
        let share = line.strip_prefix("progress ").and_then(|share| share.parse::<f64>().ok());
        let mut state = locked(state);
        if let (Some(share), DevelopProgress::Traced(_)) = (share.filter(|share| share.is_finite()), &state.progress) {
            state.progress = DevelopProgress::Traced(share.clamp(0.0, 1.0));
        }
    }
    let complaint = complaint.join().ok().flatten();
    let status = loop {
        // The lock is given back in between, for whoever cancels.
        let ended = locked(state).child.as_mut().map(Child::try_wait);
        match ended {
            Some(Ok(None)) => std::thread::sleep(PATIENCE),
            Some(Ok(Some(status))) => break Some(status),
            _ => break None,
        }
    };
    match (status, complaint) {
        (Some(status), _) if status.success() => DevelopProgress::Done(output),
        (_, Some(complaint)) => DevelopProgress::Failed(complaint),
        (status, None) => DevelopProgress::Failed(ended_badly(status)),
    }
}

fn ended_badly(status: Option<ExitStatus>) -> String {
    format!("the tracer ended early{}", status.map_or(String::new(), |status| format!(": {status}")))
}

/// The lines that come, each up to [`LONGEST`] bytes; the rest of a longer one counts as the next.
fn lines(source: impl Read) -> impl Iterator<Item = String> {
    let mut source = BufReader::new(source);
    std::iter::from_fn(move || {
        let mut line = Vec::new();
        let read = (&mut source).take(LONGEST).read_until(b'\n', &mut line).ok()?;
        (read > 0).then(|| String::from_utf8_lossy(&line).trim_end().to_owned())
    })
}

/// What the last error line says.
fn last_error(source: impl Read) -> Option<String> {
    lines(source).filter_map(|line| line.strip_prefix("error: ").map(String::from)).last()
}
