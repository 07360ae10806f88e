//! Every place where the program reads what a person hands in, with the inputs that fuzzing has found worth keeping ([docs/doors.md]).

use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;

#[path = "../fuzz/src/doors.rs"]
mod open;

/// Until an input counts as one that hangs. Far more than any takes, on a slow machine with all other tests beside it: what is guarded is
/// that it ends.
const PATIENCE: Duration = Duration::from_secs(60);

/// The inputs kept for a door: those of the corpus and those that something was wrong with.
fn inputs(door: &str) -> Vec<PathBuf> {
    let folders = ["corpus", "found"].map(|kind| crate::support::root().join("fuzz").join(kind).join(door));
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
fn every_door_refuses_in_words() {
    let mut seen = 0;
    for &(door, _) in open::DOORS {
        let files = inputs(door);
        assert!(files.len() >= 2, "{door} has {} inputs", files.len());
        for file in files {
            seen += 1;
            let bytes = std::fs::read(&file).unwrap();
            assert!(bytes.len() <= 8192, "{} is long", name(&file));
            let (done, wait) = channel();
            let knock = std::thread::spawn(move || {
                open::knock(door, &bytes);
                // Nobody waits any more where it came too late.
                _ = done.send(());
            });
            match wait.recv_timeout(PATIENCE) {
                Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("{} hangs", name(&file)),
                _ => assert!(knock.join().is_ok(), "{} ends the program", name(&file)),
            }
        }
    }
    println!("{seen} inputs");
}

/// The corpus holds what is right too: fuzzing that starts from refusals alone sees nothing behind them.
#[test]
fn every_door_lets_something_in() {
    for (door, open) in open::DOORS {
        let right = inputs(door).iter().filter(|file| open(&std::fs::read(file).unwrap()).is_ok()).count();
        assert!(right > 0, "{door}: nothing is let in");
    }
}

#[test]
fn the_corpus_is_small() {
    let bytes: u64 = open::DOORS.iter().flat_map(|(door, _)| inputs(door)).map(|file| file.metadata().unwrap().len()).sum();
    assert!(bytes < 300_000, "{bytes} bytes");
}
