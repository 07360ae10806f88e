//! The script that measures on a graphics card, with programs that only pretend to.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::{Folder, root};

fn program(folder: &Path, name: &str, text: &str) {
    let file = folder.join(name);
    std::fs::write(&file, format!("#!/usr/bin/env bash\n{text}\n")).unwrap();
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o755)).unwrap();
}

fn card(programs: &Path, limit: &str, arguments: &[&str]) -> Output {
    Command::new(root().join("lab/card")).env("PROGRAMS", programs).env("LIMIT", limit).args(arguments).output().expect("bash")
}

/// What fails or finds no time is named, the rest is done, and the table of times is that of the rows.
#[test]
fn a_step_that_fails_is_named_and_the_others_go_on() {
    let folder = Folder::new();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let refused = card(folder.path(), "60", &[out]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("is not there: build it"));
    let rows = ["chase,whole,frame,17,16,34,1", "chase,whole,processor together,3,2,6,0.2", "chase,rest,in no pass,1,NaN,NaN,-0.17"];
    let lab = format!("echo \"$@\" >> '{out}/said'\n[ $2 != frame ] || echo '{}' > '{out}/frame.csv'\n[ $2 != bodies ]", rows.join("\n"));
    program(folder.path(), "lensrunner-lab", &lab);
    program(folder.path(), "lensrunner", &format!("echo \"$@\" >> '{out}/said'"));
    let done = card(folder.path(), "60", &[out]);
    let [said, complaints] = [&done.stdout, &done.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert_eq!(done.status.code(), Some(1), "{complaints}");
    assert!(said.ends_with("| `chase` | 16.0 | 34.0 | 2.0 | 2.0 | -17 % |\n"), "{said}");
    assert_eq!(complaints.lines().filter(|line| line.starts_with("missing: ")).collect::<Vec<_>>(), ["missing: bodies"]);
    // Frames, bodies, twelve pictures, the dial.
    let steps = std::fs::read_to_string(Path::new(out).join("said")).unwrap();
    assert_eq!(steps.lines().count(), 15, "{steps}");
    let late = card(folder.path(), "0", &["--small", out]);
    let complaints = String::from_utf8_lossy(&late.stderr).into_owned();
    assert_eq!(complaints.lines().filter(|line| line.starts_with("missing: ")).count(), 5, "{complaints}");
}
