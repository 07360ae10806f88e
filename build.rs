//! Writes `built.rs` for `src/built.rs`: the target, and where the commit is read.
//!
//! git's own log of commits and checkouts becomes an input of the program alone. A commit then compiles the command line anew; it does not
//! run this script again, after which all of the package would be compiled.

use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let [root, out] = ["CARGO_MANIFEST_DIR", "OUT_DIR"].map(|name| PathBuf::from(std::env::var_os(name).expect("cargo sets it")));
    let target = std::env::var("TARGET").expect("cargo sets it");
    let log = git_log(&root).map_or("b\"\"".into(), |log| format!("include_bytes!({log:?})"));
    // No constant that is read at run time: what is left of the log in the program are twelve letters.
    let text = format!(
        "/// The target.\npub const TARGET: &str = {target:?};\n\
         /// The commit, or zeros.\npub const COMMIT: [u8; 12] = last_commit({log});\n"
    );
    std::fs::write(out.join("built.rs"), text).expect("cargo's folder can be written");
}

/// The log of the commits that were checked out, if git keeps one.
fn git_log(root: &Path) -> Option<PathBuf> {
    let git = root.join(".git");
    // A further work tree has a file that names its folder.
    let (folder, lasting) = match std::fs::read_to_string(&git) {
        Ok(text) => (root.join(text.strip_prefix("gitdir:")?.trim()), git),
        Err(_) => (git.clone(), git.join("config")),
    };
    let log = folder.join("logs/HEAD");
    if !log.is_file() {
        return None;
    }
    // It is there as long as git's folder is, and hardly ever changes.
    println!("cargo::rerun-if-changed={}", lasting.display());
    Some(log)
}
