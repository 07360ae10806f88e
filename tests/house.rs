//! The structure of both packages: a floor imports only what `docs/architecture.md` allows it, and no files import each other in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Floors from the ground up, each with the floors that it may import.
const FLOORS: [(&str, &[&str]); 13] = [
    ("user_file", &[]),
    ("page", &[]),
    ("breath", &["page"]),
    ("argument", &[]),
    ("game_files", &["user_file"]),
    ("picture_file", &["user_file"]),
    ("spacetime", &[]),
    ("lensing", &["spacetime", "game_files", "user_file"]),
    // Of the methods of projection it knows the names alone.
    ("scene", &["spacetime", "lensing::methods::NAMES", "breath", "game_files", "user_file"]),
    ("sim", &["argument", "spacetime", "scene", "game_files", "user_file"]),
    // The judge may look neither at the tables nor at the closed form of light.
    (
        "judge",
        &["spacetime::metric", "spacetime::matter", "spacetime::frames", "spacetime::observer", "scene", "picture_file", "user_file"],
    ),
    ("render", &["spacetime", "lensing", "scene", "sim", "picture_file", "breath", "page", "game_files", "user_file"]),
    ("play", &["argument", "spacetime", "lensing", "scene", "sim", "render", "picture_file", "breath", "page", "game_files", "user_file"]),
];

/// The one file of the judge that reads a simulated scene, and what it may import more.
const CASE: (&str, &[&str]) = ("judge::case", &["sim", "spacetime::orbit"]);

/// A module, as the names from the crate's root to it.
type Module = Vec<String>;

/// The files of a crate by the module that each holds.
fn modules(root: &Path) -> BTreeMap<Module, PathBuf> {
    fn walk(folder: &Path, module: &Module, found: &mut BTreeMap<Module, PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
            let mut inner = module.clone();
            if path.is_dir() {
                inner.push(stem);
                walk(&path, &inner, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") && stem != "main" {
                if !["mod", "lib"].contains(&stem.as_str()) {
                    inner.push(stem);
                }
                found.insert(inner, path);
            }
        }
    }
    let mut found = BTreeMap::new();
    walk(root, &Vec::new(), &mut found);
    found
}

/// A path that a file names: its parts, and whether it is exported again.
struct Named {
    path: Vec<String>,
    exported: bool,
}

/// The text without comments and without the module of its tests.
fn code(text: &str) -> String {
    let text = text.split("mod tests {").next().unwrap_or("");
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// All paths of a `use` with braces in it.
fn expand(tree: &str, before: &[String], found: &mut Vec<Vec<String>>) {
    let (mut depth, mut from) = (0, 0);
    let mut parts = Vec::new();
    for (i, c) in tree.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&tree[from..i]);
                from = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&tree[from..]);
    for part in parts.into_iter().map(str::trim).filter(|part| !part.is_empty()) {
        let words = |path: &str| path.split("::").map(str::trim).filter(|word| !word.is_empty()).map(String::from).collect::<Vec<_>>();
        if let Some(open) = part.find('{') {
            let prefix = [before, &words(&part[..open])].concat();
            expand(part[open + 1..].trim_end().trim_end_matches('}'), &prefix, found);
        } else {
            found.push([before, &words(part.split(" as ").next().unwrap_or(part))].concat());
        }
    }
}

/// What a file names: its `use` lines, and paths from `crate`, `super` or `self` elsewhere.
fn named(text: &str) -> Vec<Named> {
    let text = code(text);
    let mut all = Vec::new();
    let mut other = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let trimmed = line.trim_start();
        let exported = trimmed.starts_with("pub ") || trimmed.starts_with("pub(");
        let after = if exported { trimmed.split_once(' ').map_or("", |(_, after)| after) } else { trimmed };
        let after = after.strip_prefix("(super) ").unwrap_or(after);
        if let Some(first) = after.strip_prefix("use ") {
            let mut tree = first.to_owned();
            while !tree.contains(';') {
                tree.push_str(lines.next().unwrap_or(";"));
            }
            let mut paths = Vec::new();
            expand(tree.split(';').next().unwrap_or(""), &[], &mut paths);
            all.extend(paths.into_iter().map(|path| Named { path, exported }));
        } else {
            other.push_str(line);
            other.push('\n');
        }
    }
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in other.match_indices(start) {
            let whole = other[..at].chars().next_back().is_none_or(|c| !(c.is_alphanumeric() || c == '_' || c == ':' || c == '$'));
            // Who may see an item is no import.
            let whole = whole && !other[..at].ends_with("pub(in ");
            let path: String = other[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
            if whole {
                let path = path.split("::").filter(|word| !word.is_empty()).map(String::from).collect();
                all.push(Named { path, exported: false });
            }
        }
    }
    all
}

/// A path as it is named in a module, from the crate's root; None for what is not of the crate.
fn absolute(module: &Module, path: &[String], modules: &BTreeMap<Module, PathBuf>) -> Option<Vec<String>> {
    match path.first()?.as_str() {
        "crate" => Some(path[1..].to_vec()),
        "self" => Some([&module[..], &path[1..]].concat()),
        "super" => {
            let ups = path.iter().take_while(|word| *word == "super").count();
            Some([&module[..module.len().checked_sub(ups)?], &path[ups..]].concat())
        }
        first => {
            let child = [&module[..], &[first.to_owned()]].concat();
            modules.contains_key(&child).then(|| [&module[..], path].concat())
        }
    }
}

/// The longest beginning of a path that is a module.
fn module_of(path: &[String], modules: &BTreeMap<Module, PathBuf>) -> Module {
    (0..=path.len()).rev().map(|k| path[..k].to_vec()).find(|module| modules.contains_key(module)).unwrap_or_default()
}

/// Something that a module imports, as paths from the root.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Import {
    /// As it is named.
    named: Vec<String>,
    /// Where it is defined: `named`, unless that module only hands it on.
    defined: Vec<String>,
}

/// What each module of a crate imports; what it only hands on within its floor is none of that.
fn imports(root: &Path) -> BTreeMap<Module, BTreeSet<Import>> {
    let modules = modules(root);
    let mut handed_on: BTreeMap<Vec<String>, Vec<String>> = BTreeMap::new();
    let mut all: BTreeMap<Module, BTreeSet<Vec<String>>> = BTreeMap::new();
    for (module, file) in &modules {
        for Named { path, exported } in named(&std::fs::read_to_string(file).unwrap()) {
            let Some(target) = absolute(module, &path, &modules) else { continue };
            if exported {
                let name = target.last().cloned().unwrap_or_default();
                handed_on.insert([&module[..], &[name]].concat(), target.clone());
            }
            if !exported || target.first() != module.first() {
                all.entry(module.clone()).or_default().insert(target);
            }
        }
    }
    let import = |named: Vec<String>| {
        let mut path = named.clone();
        for _ in 0..8 {
            let module = module_of(&path, &modules);
            match path.get(module.len()).and_then(|name| handed_on.get(&[&module[..], std::slice::from_ref(name)].concat())) {
                Some(target) if *target != path => path = target.clone(),
                _ => break,
            }
        }
        Import { named, defined: path }
    };
    all.into_iter().map(|(module, paths)| (module, paths.into_iter().map(import).collect())).collect()
}

fn packages() -> [PathBuf; 2] {
    ["src", "lab/src"].map(|folder| crate::support::root().join(folder))
}

#[test]
fn floors_know_only_the_floors_below() {
    let mut seen = 0;
    for (module, imports) in imports(&packages()[0]) {
        let Some((floor, allowed)) = module.first().and_then(|name| FLOORS.iter().find(|(floor, _)| floor == name)) else { continue };
        for path in imports.into_iter().map(|import| import.defined) {
            if path.first().is_none_or(|first| first == floor || !FLOORS.iter().any(|(name, _)| name == first)) {
                continue;
            }
            seen += 1;
            let (module, path) = (module.join("::"), path.join("::"));
            let more: &[&str] = if module == CASE.0 { CASE.1 } else { &[] };
            let is_allowed = allowed.iter().chain(more).any(|prefix| path == *prefix || path.starts_with(&format!("{prefix}::")));
            // A type that its floor hands on is that of the module that defines it.
            assert!(is_allowed, "{module} may not import {path} (docs/architecture.md)");
        }
    }
    assert!(seen > 300, "only {seen} imports were seen: the test looks at nothing");
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    for root in packages() {
        let modules = modules(&root);
        let mut edges: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
        for (module, imports) in imports(&root) {
            // Both the file that defines it and the one that hands it on.
            let paths = imports.iter().flat_map(|import| [&import.named, &import.defined]);
            let targets = paths.map(|path| module_of(path, &modules)).filter(|target| *target != module && !target.is_empty());
            edges.insert(module.clone(), targets.collect());
        }
        assert!(
            edges.values().map(BTreeSet::len).sum::<usize>() > 200,
            "{} has hardly any imports: the test looks at nothing",
            root.display()
        );
        // Files that nothing in what is left imports, or that import nothing of it, are in no circle.
        loop {
            let imported: BTreeSet<Module> = edges.values().flatten().cloned().collect();
            let open: Vec<Module> =
                edges.iter().filter(|(module, targets)| targets.is_empty() || !imported.contains(*module)).map(|e| e.0.clone()).collect();
            if open.is_empty() {
                break;
            }
            for module in &open {
                edges.remove(module);
            }
            let left: BTreeSet<Module> = edges.keys().cloned().collect();
            edges.values_mut().for_each(|targets| targets.retain(|target| left.contains(target)));
        }
        let text = |module: &Module| module.join("::");
        let circle: Vec<String> = edges
            .iter()
            .map(|(module, targets)| format!("{} -> {}", text(module), targets.iter().map(text).collect::<Vec<_>>().join(", ")))
            .collect();
        assert!(circle.is_empty(), "files import each other in a circle:\n{}", circle.join("\n"));
    }
}

/// What moves a ship rounds alike on every machine: sines and the like come from `libm`, not from the system.
#[test]
fn the_simulation_has_one_mathematical_library() {
    const SYSTEMS: [&str; 27] = [
        "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "exp2",
        "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "powi", "cbrt", "hypot", "mul_add",
    ];
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let moves = |module: &Module| matches!(module.first().map(String::as_str), Some("spacetime" | "sim")) || *module == ["scene", "swarm"];
    for (module, path) in modules(&root).into_iter().filter(|(module, _)| moves(module)) {
        let text = code(&std::fs::read_to_string(path).unwrap());
        for name in SYSTEMS {
            let called = [format!(".{name}("), format!("f64::{name}")];
            assert!(!called.iter().any(|call| text.contains(call.as_str())), "{}: {name}", module.join("::"));
        }
    }
}
