//! The map of the house: a floor imports only what `docs/architecture.md` allows it.

use std::path::Path;

/// Floors from the ground up, each with the floors that it may import.
const FLOORS: [(&str, &[&str]); 7] = [
    ("spacetime", &[]),
    ("lensing", &["spacetime"]),
    ("scene", &["spacetime"]),
    ("sim", &["spacetime", "scene"]),
    // The judge may look neither at the tables nor at the closed form of light.
    ("judge", &["spacetime::metric", "spacetime::matter", "spacetime::frames", "spacetime::observer", "scene"]),
    ("render", &["spacetime", "lensing", "scene", "sim"]),
    ("play", &["spacetime", "lensing", "scene", "sim", "render"]),
];

fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn floors_know_only_the_floors_below() {
    let root = crate::support::root().join("src");
    let mut imports = 0;
    for (floor, allowed) in FLOORS {
        let mut files = Vec::new();
        sources(&root.join(floor), &mut files);
        assert!(!files.is_empty(), "the floor {floor} is empty");
        for file in files {
            let text = std::fs::read_to_string(&file).unwrap();
            for (number, line) in text.lines().enumerate() {
                let code = line.split("//").next().unwrap_or("");
                let mut rest = code;
                while let Some(at) = rest.find("crate::") {
                    rest = &rest[at + 7..];
                    let path: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
                    let target = path.split("::").next().unwrap_or("");
                    if target == floor || !FLOORS.iter().any(|(name, _)| *name == target) {
                        continue;
                    }
                    imports += 1;
                    // The one file of the judge that reads a simulated scene.
                    if file.ends_with("judge/case.rs") && (path.starts_with("sim") || path.starts_with("spacetime::orbit")) {
                        continue;
                    }
                    assert!(
                        allowed.iter().any(|prefix| path.starts_with(prefix)),
                        "{}:{}: {floor} may not import {path} (docs/architecture.md)",
                        file.display(),
                        number + 1
                    );
                }
            }
        }
    }
    assert!(imports > 30, "only {imports} imports were seen: the test looks at nothing");
}
