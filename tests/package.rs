//! What is given on: files inside the program, licences of what it is made from. `.ci/package` tests the archive itself.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::root;

/// The folders of files that the game reads while it runs, and their endings.
const FOLDERS: [(&str, &[&str]); 5] = [
    ("assets/missions", &["toml"]),
    ("assets/models", &["bin", "glb", "gltf", "jpg", "png"]),
    ("assets/replays", &["toml"]),
    ("assets/scenes", &["toml"]),
    ("assets/sky", &["bin", "png"]),
];

#[test]
fn every_file_of_the_game_is_inside_the_program() {
    let mut files = BTreeSet::new();
    for (folder, endings) in FOLDERS {
        for entry in std::fs::read_dir(root().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| endings.iter().any(|known| ending == *known)) {
                files.insert(format!("{folder}/{}", path.file_name().unwrap().to_string_lossy()));
            }
        }
    }
    let text = std::fs::read_to_string(root().join("src/inside.rs")).unwrap();
    let named = text.lines().filter_map(|line| line.trim().strip_prefix('"')?.strip_suffix("\",").map(String::from));
    let named: BTreeSet<String> = named.collect();
    let other: Vec<&String> = named.symmetric_difference(&files).collect();
    assert!(other.is_empty(), "either src/inside.rs or the folders lack {other:?}");
}

/// A program that knows where it was built works only there.
#[test]
fn nothing_of_the_program_knows_the_folder_that_it_was_built_in() {
    fn walk(folder: &Path, seen: &mut usize) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, seen);
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let before_tests = text.split("mod tests {").next().unwrap_or("");
            assert!(!before_tests.contains("CARGO_MANIFEST_DIR"), "{}", path.display());
            *seen += 1;
        }
    }
    let mut seen = 0;
    walk(&root().join("src"), &mut seen);
    assert!(seen > 100, "only {seen} files were seen");
}

/// Whether an expression as `(MIT OR Apache-2.0) AND Unicode-3.0` can be kept by who may take these licences.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;
    fn any(words: &mut Words<'_>, allowed: &BTreeSet<String>) -> bool {
        let mut is = all(words, allowed);
        while words.next_if(|word| ["OR", "/"].contains(word)).is_some() {
            is |= all(words, allowed);
        }
        is
    }
    fn all(words: &mut Words<'_>, allowed: &BTreeSet<String>) -> bool {
        let mut is = one(words, allowed);
        while words.next_if_eq(&"AND").is_some() {
            is &= one(words, allowed);
        }
        is
    }
    fn one(words: &mut Words<'_>, allowed: &BTreeSet<String>) -> bool {
        let Some(word) = words.next() else { return false };
        if word == "(" {
            let is = any(words, allowed);
            return words.next() == Some(")") && is;
        }
        let mut name = word.to_owned();
        if words.next_if_eq(&"WITH").is_some() {
            name = format!("{name} WITH {}", words.next().unwrap_or(""));
        }
        allowed.contains(&name)
    }
    let spaced = expression.replace('/', " / ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    any(&mut words, allowed) && words.next().is_none()
}

/// The licences that `deny.toml` allows.
fn allowed() -> BTreeSet<String> {
    let text = std::fs::read_to_string(root().join("deny.toml")).unwrap();
    let file: toml::Table = toml::from_str(&text).unwrap();
    file["licenses"]["allow"].as_array().unwrap().iter().map(|name| name.as_str().unwrap().to_owned()).collect()
}

#[test]
fn licences_are_read_as_they_are_meant() {
    let allowed = BTreeSet::from(["MIT".to_owned(), "Zlib".to_owned()]);
    for (expression, is) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0/MIT", true),
        ("GPL-3.0 AND MIT", false),
        ("(GPL-3.0 OR MIT) AND Zlib", true),
        ("MIT AND (GPL-3.0 OR Apache-2.0)", false),
        ("MIT WITH exception", false),
        ("MIT Zlib", false),
        ("", false),
    ] {
        assert_eq!(is_allowed(expression, &allowed), is, "{expression}");
    }
}

/// Every library that is compiled here, those of the tests and of the laboratory too.
#[test]
fn every_library_has_a_licence_that_is_allowed() {
    let target = String::from_utf8(Command::new("rustc").arg("-vV").output().unwrap().stdout).unwrap();
    let target = target.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let cargo = std::env::var_os("CARGO").map_or_else(|| PathBuf::from("cargo"), PathBuf::from);
    let arguments = ["metadata", "--offline", "--locked", "--format-version", "1", "--filter-platform", target];
    let said = Command::new(cargo).args(arguments).current_dir(root()).output().unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&said.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 200, "only {} libraries were seen", packages.len());
    let allowed = allowed();
    for package in packages {
        let (name, licence) = (&package["name"], package["license"].as_str().unwrap_or(""));
        assert!(is_allowed(licence, &allowed), "{name}: {licence:?} (deny.toml)");
    }
}
