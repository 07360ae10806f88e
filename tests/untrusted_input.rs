//! Every place where the program reads untrusted input, with the inputs that fuzzing has found worth keeping ([docs/untrusted-input.md]).

use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;

#[path = "../fuzz/src/untrusted_input.rs"]
mod targets;

/// Until an input counts as one that hangs. Far more than any takes, on a slow machine with all other tests beside it: what is guarded is
/// that it ends.
const PATIENCE: Duration = Duration::from_secs(60);

/// The inputs kept for a target: those of the corpus and those that something was wrong with.
fn inputs(target: &str) -> Vec<PathBuf> {
    let folders = ["corpus", "found"].map(|kind| crate::support::root().join("fuzz").join(kind).join(target));
    let mut files: Vec<PathBuf> =
        folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten()).flatten().map(|entry| entry.path()).collect();
    files.sort();
    files
}

fn name(path: &Path) -> String {
    path.strip_prefix(crate::support::root()).unwrap_or(path).display().to_string()
}

/// No input ends the program, none hangs, and each refusal says where and is short.
#[test]
fn every_target_refuses_in_words() {
    let mut seen = 0;
    for &(target, _) in targets::TARGETS {
        let files = inputs(target);
        assert!(files.len() >= 2, "{target} has {} inputs", files.len());
        for file in files {
            seen += 1;
            let bytes = std::fs::read(&file).unwrap();
            assert!(bytes.len() <= 8192, "{} is long", name(&file));
            let (done, wait) = channel();
            let checking = std::thread::spawn(move || {
                targets::check(target, &bytes);
                // Nobody waits any more where it came too late.
                _ = done.send(());
            });
            match wait.recv_timeout(PATIENCE) {
                Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("{} hangs", name(&file)),
                _ => assert!(checking.join().is_ok(), "{} ends the program", name(&file)),
            }
        }
    }
    println!("{seen} inputs");
}

/// The corpus holds what is right too: fuzzing that starts from refusals alone sees nothing behind them.
#[test]
fn every_target_accepts_something() {
    for (target, run) in targets::TARGETS {
        let right = inputs(target).iter().filter(|file| run(&std::fs::read(file).unwrap()).is_ok()).count();
        assert!(right > 0, "{target}: nothing is let in");
    }
}

#[test]
fn the_corpus_is_small() {
    let bytes: u64 = targets::TARGETS.iter().flat_map(|(target, _)| inputs(target)).map(|file| file.metadata().unwrap().len()).sum();
    assert!(bytes < 300_000, "{bytes} bytes");
}
