//! The table of products, and what `status` and `all` make of it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use lensrunner_lab::chart::{Provenance, Sheet};
use lensrunner_lab::products::made::{Record, made, plain};
use lensrunner_lab::products::make::{MakeRequest, duration, is_done, make};
use lensrunner_lab::products::{DOCUMENTS, Made, PRODUCTS, Product, Program, Run, Standing, standing};

use crate::support::{Folder, root};

/// What the laboratory and the game make; words are written by people.
const MADE: [&str; 5] = ["png", "svg", "csv", "jpg", "exr"];

fn is_made(path: &Path) -> bool {
    path.extension().is_some_and(|extension| MADE.iter().any(|made| extension == *made))
}

/// All files under a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Every path of the table, from the root.
fn paths() -> Vec<String> {
    PRODUCTS.iter().flat_map(Product::paths).map(|path| format!("{DOCUMENTS}/{path}")).collect()
}

fn is_in_table(path: &str) -> bool {
    paths().iter().any(|known| known == path || (known.ends_with('/') && path.starts_with(known.as_str())))
}

#[test]
fn the_table_names_only_what_exists() {
    let root = root();
    for path in paths() {
        assert!(root.join(&path).exists(), "{path} is in the table and not there");
    }
    for product in PRODUCTS {
        for source in product.all_sources().filter(|source| !source.starts_with(":(")) {
            let found = if let Some(name) = source.strip_prefix("assets/*/") {
                ["scenes", "missions"].iter().any(|folder| root.join("assets").join(folder).join(name).is_file())
            } else {
                root.join(source).exists()
            };
            assert!(found, "{}: {source} is not there", product.name);
        }
        for excluded in product.all_sources().filter_map(|source| source.strip_prefix(":(exclude)")) {
            assert!(root.join(excluded).exists(), "{}: {excluded} is not there", product.name);
        }
    }
}

#[test]
fn nothing_is_made_twice() {
    let names: BTreeSet<_> = PRODUCTS.iter().map(|product| product.name).collect();
    let all = paths();
    assert_eq!(names.len(), PRODUCTS.len());
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
}

#[test]
fn every_figure_of_the_documents_is_in_the_table() {
    let root = root();
    let documents = files(&root.join(DOCUMENTS));
    for path in documents.iter().filter(|path| is_made(path)) {
        let path = path.strip_prefix(&root).unwrap().to_str().unwrap();
        assert!(is_in_table(path), "{path} is not in the table");
    }
    let pages = documents.iter().filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    for page in pages.chain([&root.join("README.md")]) {
        let text = std::fs::read_to_string(page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            let target = page.parent().unwrap().join(link);
            if !link.contains("://") && is_made(&target) {
                let target = target.canonicalize().unwrap_or_else(|error| panic!("{}: {link}: {error}", page.display()));
                let path = target.strip_prefix(root.canonicalize().unwrap()).unwrap().to_str().unwrap().to_owned();
                assert!(is_in_table(&path), "{}: {path} is not in the table", page.display());
            }
        }
    }
}

/// A page's command is the table's, wherever it writes to and in whatever order its options stand.
#[test]
fn pages_say_the_commands_of_the_table() {
    let sorted = |command: &str| {
        let mut words: Vec<String> = plain(command).split_whitespace().map(str::to_owned).collect();
        words.sort();
        words
    };
    for name in ["projection", "disk", "aurora", "bvh", "trace", "flight", "tessellation"] {
        let product = PRODUCTS.iter().find(|product| product.name == name).unwrap();
        let page = std::fs::read_to_string(root().join(format!("docs/lab/{name}.md"))).unwrap();
        let said = page.lines().filter_map(|line| line.trim().strip_prefix("lab/run ")).map(|line| line.split(" #").next().unwrap());
        let wanted = sorted(product.runs[0].arguments);
        assert!(said.map(sorted).any(|said| said == wanted), "docs/lab/{name}.md should say: lab/run {}", product.runs[0].arguments);
    }
}

#[test]
fn quick_runs_write_what_full_ones_do() {
    for product in PRODUCTS.iter().filter(|product| !product.quick.is_empty()) {
        let printed = |runs: &[Run]| runs.iter().filter_map(|run| run.printed).collect::<Vec<_>>();
        assert_eq!(printed(product.runs), printed(product.quick), "{}", product.name);
        for run in product.runs.iter().chain(product.quick) {
            assert!(run.printed.is_some() || run.arguments.contains("{}"), "{}: {}", product.name, run.arguments);
        }
    }
    let whole: f64 = PRODUCTS.iter().filter(|product| !product.quick.is_empty()).map(|product| product.seconds[1]).sum();
    assert!(whole < 600.0, "--quick would take {whole} s");
}

/// A repository of its own with one commit.
fn repository(folder: &Path) -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .args(["-C", folder.to_str().unwrap(), "-c", "user.name=test", "-c", "user.email=test@example.org"])
            .args(arguments)
            .output()
            .expect("git");
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    };
    std::fs::create_dir_all(folder.join("src/drawing")).unwrap();
    std::fs::create_dir_all(folder.join("docs")).unwrap();
    for file in ["src/a.rs", "src/b.rs", "src/drawing/draw.rs"] {
        std::fs::write(folder.join(file), "one").unwrap();
    }
    git(&["init", "-q"]);
    git(&["add", "-A"]);
    git(&["commit", "-qm", "one"]);
    git(&["rev-parse", "--short=10", "HEAD"])
}

#[test]
fn a_changed_source_makes_stale() {
    let folder = Folder::new();
    let root = folder.path();
    let commit = repository(root);
    let stands = |commit: &str, sources: &[&'static str]| standing(root, commit, sources.iter().copied());
    let sources = ["src/a.rs", "src/drawing", ":(exclude)src/drawing/draw.rs"];
    assert_eq!(stands(&commit, &sources), Standing::Fresh);
    // What is not among the sources, or excluded, does not count.
    std::fs::write(root.join("src/b.rs"), "two").unwrap();
    std::fs::write(root.join("src/drawing/draw.rs"), "two").unwrap();
    assert_eq!(stands(&commit, &sources), Standing::Fresh);
    std::fs::write(root.join("src/a.rs"), "two").unwrap();
    assert_eq!(stands(&commit, &sources), Standing::Stale(vec!["src/a.rs".into()]));
    assert!(stands(&commit, &sources).to_string().starts_with("STALE: src/a.rs"));
    std::fs::write(root.join("src/a.rs"), "one").unwrap();
    std::fs::write(root.join("src/drawing/new.rs"), "new").unwrap();
    assert_eq!(stands(&commit, &sources), Standing::Stale(vec!["src/drawing/new.rs".into()]));
    assert_eq!(stands(&format!("{commit}+"), &sources), Standing::Uncommitted);
    assert_eq!(stands("0123456789", &sources), Standing::Unknown);
    assert_eq!(stands("", &sources), Standing::Unknown);
}

const ONE: Product = Product {
    name: "one",
    runs: &[Run { program: Program::Lab, arguments: "chart one --points 3 -o {}", printed: None }],
    quick: &[Run { program: Program::Lab, arguments: "chart one --points 1 -o {}", printed: None }],
    folder: "",
    files: &["one.csv"],
    grows: false,
    sources: &[&["src/a.rs"]],
    seconds: [1.0, 1.0],
};

/// Prints its help into a file, which is then a product.
static HELP: [Product; 2] = [
    Product {
        name: "help",
        runs: &[Run { program: Program::Lab, arguments: "--help", printed: Some("help.txt") }],
        quick: &[],
        folder: "deep",
        files: &["help.txt"],
        ..ONE
    },
    Product {
        name: "broken",
        files: &["other.txt"],
        runs: &[Run { program: Program::Lab, arguments: "chart none", printed: None }],
        ..ONE
    },
];

fn request(root: &Path) -> MakeRequest {
    MakeRequest {
        root: root.to_owned(),
        folder: root.join("docs"),
        workshop: root.join("out"),
        quick: false,
        again: false,
        only: Vec::new(),
        times: root.join("times.toml"),
        adapter: "llvmpipe".into(),
    }
}

#[test]
fn what_is_done_is_left() {
    let folder = Folder::new();
    let root = folder.path();
    let commit = repository(root);
    let request = request(root);
    let mut sheet = Sheet::new(&["x"]);
    let by = |command: &str| Provenance { commit: commit.clone(), command: command.into(), ..Provenance::now("llvmpipe") };
    let done = |request: &MakeRequest| is_done(&ONE, request, &Record::load(&request.folder).unwrap());
    assert!(!done(&request), "there is nothing");
    // Made by hand, with its options in another order.
    sheet.notes = by("lensrunner-lab chart one -o docs --points 3").notes();
    sheet.save(&request.folder.join("one.csv")).unwrap();
    assert!(done(&request));
    assert!(!done(&MakeRequest { quick: true, ..request.clone() }), "with other arguments");
    // The record counts for as long as the sheet is of the same commit.
    let mut record = Record::load(&request.folder).unwrap();
    let recorded = Made { commands: ONE.commands(true), on: by(""), seconds: 2.0, told: true };
    record.put("one", &recorded).unwrap();
    assert!(!done(&request) && done(&MakeRequest { quick: true, ..request.clone() }));
    let found = made(root, &request.folder, &ONE, &Record::load(&request.folder).unwrap()).unwrap();
    assert_eq!((found.on.adapter.as_str(), found.seconds), ("llvmpipe", 2.0));
    std::fs::write(root.join("src/a.rs"), "two").unwrap();
    assert!(!done(&request) && !done(&MakeRequest { quick: true, ..request.clone() }), "with another source");
}

#[test]
fn a_product_is_made_once_and_a_broken_one_is_told() {
    let folder = Folder::new();
    let root = folder.path();
    repository(root);
    // The program beside which the others lie is this test; that of the laboratory is brought there by its own path.
    let program = Path::new(env!("CARGO_BIN_EXE_lensrunner-lab"));
    let request = MakeRequest { only: vec!["help".into()], ..request(root) };
    let run = |request: &MakeRequest| lensrunner_lab::products::make::make_with(&HELP, request, program).unwrap();
    assert!(run(&request).is_empty());
    let file = request.folder.join("deep/help.txt");
    assert!(std::fs::read_to_string(&file).unwrap().contains("Usage"));
    assert!(std::fs::read_to_string(&request.times).unwrap().contains("help"));
    // The second time it is left. Its commit is that of the project, which this repository does not know, so that it is told in the record.
    let broken = MakeRequest { only: vec!["broken".into()], ..request.clone() };
    assert_eq!(run(&broken), ["broken"]);
    assert!(make(PRODUCTS, &MakeRequest { only: vec!["nothing".into()], ..request }).is_err());
}

#[test]
fn durations_are_short() {
    assert_eq!([8.2, 200.0, 3720.0].map(duration), ["8 s", "3 min 20 s", "1 h 02 min"]);
    assert_eq!(plain("chart disk -o docs/disk --rounds 5"), "chart disk --rounds 5");
}

/// Each committed drawing is what the code draws from the committed numbers, and can be read.
#[test]
fn drawings_are_those_of_their_numbers() {
    let root = root();
    for (chart, home, drawings) in [
        ("projection", "docs", &["projection.svg"][..]),
        ("disk", "docs/disk", &["disk.svg"]),
        ("aurora", "docs", &["aurora.svg"]),
        ("bvh", "docs", &["bvh.svg"]),
        ("trace", "docs", &["trace.svg"]),
        ("flight", "docs", &["flight.svg"]),
        ("tessellation", "docs", &["tessellation.svg"]),
    ] {
        let folder = Folder::new();
        for file in std::fs::read_dir(root.join(home)).unwrap().map(|entry| entry.unwrap().path()) {
            if file.extension().is_some_and(|extension| extension == "csv") {
                std::fs::copy(&file, folder.path().join(file.file_name().unwrap())).unwrap();
            }
        }
        let output = Command::new(env!("CARGO_BIN_EXE_lensrunner-lab"))
            .args(["chart", chart, "--redraw", "-o", folder.path().to_str().unwrap()])
            .current_dir(&root)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("hard to read"), "{chart}: {said}");
        for drawing in drawings {
            let [now, then] = [folder.path(), &root.join(home)].map(|folder| std::fs::read_to_string(folder.join(drawing)).unwrap());
            assert!(now == then, "{home}/{drawing}: lab/run chart {chart} --redraw -o {home}");
        }
    }
}
