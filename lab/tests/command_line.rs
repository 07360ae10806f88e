//! The laboratory's commands as they are typed.

use std::process::{Command, Output};

use lensrunner::scene::names;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lensrunner-lab")).args(arguments).output().expect("the program starts")
}

#[test]
fn the_long_help_names_every_scene() {
    for command in [&["compare", "--help"][..], &["chart", "frame", "--help"]] {
        let said = String::from_utf8(run(command).stdout).expect("UTF-8");
        let words: Vec<&str> = said.split(|c: char| c.is_whitespace() || c == ',').collect();
        for name in names() {
            assert!(words.contains(&name.as_str()), "{command:?} does not name {name}");
        }
    }
}

/// The rain falls from r = 2 in T = (2/3)·2^1.5 = 1.886: after that no picture is drawn, and the reason is given.
#[test]
fn no_picture_is_drawn_from_within_the_singularity() {
    let output = std::env::temp_dir().join(format!("lensrunner-lab-singularity-{}.png", std::process::id()));
    let file = output.to_str().expect("UTF-8");
    let compare = ["compare", "--scene", "plunge", "--size", "16x9", "--at", "1.9", "-o", file];
    // Of several scenes all are looked at before anything is drawn or said.
    let frames = ["chart", "frame", "--scene", "ring,plunge", "--size", "16x9", "--frames", "1", "--at", "1.9"];
    for command in [&compare[..], &frames] {
        let after = run(command);
        let said = String::from_utf8_lossy(&after.stderr).into_owned();
        assert_eq!(after.status.code(), Some(2), "{command:?}: {said}");
        assert!(said.contains("--at: by T = 1.9") && said.contains("singularity") && after.stdout.is_empty(), "{command:?}: {said}");
        assert!(!output.exists(), "{command:?}");
    }
}
