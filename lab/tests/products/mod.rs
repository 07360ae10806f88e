//! The table of products, and what `status` and `all` make of it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use lensrunner_lab::chart::{Provenance, Sheet};
use lensrunner_lab::products::made::{Made, Record, Standing, made, standing};
use lensrunner_lab::products::make::{MakeRequest, duration, is_done, make};
use lensrunner_lab::products::{DOCUMENTS, Product, plain};

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

fn products() -> Vec<Product> {
    lensrunner_lab::products::products().unwrap()
}

/// Every path of the table, from the root.
fn paths() -> Vec<String> {
    products().iter().flat_map(Product::paths).map(|path| format!("{DOCUMENTS}/{path}")).collect()
}

#[test]
fn the_table_names_only_what_exists_and_nothing_twice() {
    let (root, paths, products) = (root(), paths(), products());
    for path in &paths {
        assert!(root.join(path).exists(), "{path} is in the table and not there");
    }
    for product in &products {
        for source in &product.sources {
            let found = match source.strip_prefix("assets/*/") {
                Some(name) => ["scenes", "missions"].iter().any(|folder| root.join("assets").join(folder).join(name).is_file()),
                None => root.join(source.trim_start_matches(":(exclude)")).exists(),
            };
            assert!(found, "{}: {source} is not there", product.name);
        }
    }
    assert_eq!(products.iter().map(|product| &product.name).collect::<BTreeSet<_>>().len(), products.len());
    assert_eq!(paths.iter().collect::<BTreeSet<_>>().len(), paths.len());
}

#[test]
fn every_figure_of_the_documents_is_in_the_table() {
    let root = root();
    let (documents, paths) = (files(&root.join(DOCUMENTS)), paths());
    let is_in_table = |path: &str| paths.iter().any(|known| known == path || (known.ends_with('/') && path.starts_with(known.as_str())));
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
    let products = products();
    for name in ["projection", "disk", "aurora", "bvh", "trace", "flight", "tessellation", "bodies"] {
        let run = products.iter().find(|product| product.name == name).unwrap().runs[0].strip_prefix("lensrunner-lab ").unwrap();
        let page = std::fs::read_to_string(root().join(format!("docs/lab/{name}.md"))).unwrap();
        let said = page.lines().filter_map(|line| line.trim().strip_prefix("lab/run ")).map(|line| line.split(" #").next().unwrap());
        let wanted = sorted(run);
        assert!(said.map(sorted).any(|said| said == wanted), "docs/lab/{name}.md should say: lab/run {run}");
    }
}

#[test]
fn every_run_writes_to_its_folder_in_small_too() {
    for product in products().iter().filter(|product| !product.quick.is_empty()) {
        for runs in [&product.runs, &product.quick] {
            let printed: Vec<&str> = runs.iter().filter_map(|run| Some(run.split_once(" > {}/")?.1)).collect();
            assert!(printed.iter().all(|file| product.files.iter().any(|known| known == file)), "{}: {printed:?}", product.name);
            assert!(runs.iter().all(|run| run.contains("{}")), "{}: {runs:?}", product.name);
        }
    }
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
    let stands = |commit: &str, sources: &[String]| standing(root, commit, sources);
    let sources = ["src/a.rs", "src/drawing", ":(exclude)src/drawing/draw.rs"].map(str::to_owned);
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

/// A product of one command, which depends on one file.
fn product(name: &str, run: &str, quick: &str, file: &str) -> Product {
    let one = |text: &str| vec![text.to_owned()];
    let (runs, quick, files, sources) = (one(run), one(quick), one(file), one("src/a.rs"));
    Product { name: name.into(), runs, quick, files, sources, ..Product::default() }
}

fn request(root: &Path) -> MakeRequest {
    MakeRequest { root: root.to_owned(), output: Some(root.join("docs")), ..MakeRequest::default() }
}

#[test]
fn what_is_done_is_left() {
    let folder = Folder::new();
    let root = folder.path();
    let commit = repository(root);
    let request = request(root);
    let one = product("one", "lensrunner-lab chart one --points 3 -o {}", "lensrunner-lab chart one --points 1 -o {}", "one.csv");
    let mut sheet = Sheet::new(&["x"]);
    let by = |command: &str| Provenance { commit: commit.clone(), command: command.into(), ..Provenance::now("llvmpipe") };
    let done = |request: &MakeRequest| is_done(&one, request, &Record::load(&request.folder()).unwrap());
    assert!(!done(&request), "there is nothing");
    // Made by hand, with its options in another order.
    sheet.notes = by("lensrunner-lab chart one -o docs --points 3").notes();
    sheet.save(&request.folder().join("one.csv")).unwrap();
    assert!(done(&request));
    assert!(!done(&MakeRequest { quick: true, ..request.clone() }), "with other arguments");
    // The record counts for as long as the sheet is of the same commit.
    let mut record = Record::load(&request.folder()).unwrap();
    let recorded = Made { commands: one.commands(true), on: by(""), seconds: 2.0, guessed: false };
    record.put("one", &recorded).unwrap();
    assert!(!done(&request) && done(&MakeRequest { quick: true, ..request.clone() }));
    let found = made(root, &request.folder(), &one, &Record::load(&request.folder()).unwrap()).unwrap();
    assert_eq!((found.on.adapter.as_str(), found.seconds), ("llvmpipe", 2.0));
    std::fs::write(root.join("src/a.rs"), "two").unwrap();
    assert!(!done(&request) && !done(&MakeRequest { quick: true, ..request.clone() }), "with another source");
}

#[test]
fn a_product_is_made_and_a_broken_one_is_told() {
    let folder = Folder::new();
    let root = folder.path();
    repository(root);
    // It prints its help into a file, which is then a product.
    let help = Product { folder: "deep".into(), ..product("help", "lensrunner-lab --help > {}/help.txt", "", "help.txt") };
    let broken = product("broken", "lensrunner-lab chart none -o {}", "", "other.txt");
    let program = Path::new(env!("CARGO_BIN_EXE_lensrunner-lab"));
    let run = |only: &str| make(&[help.clone(), broken.clone()], &MakeRequest { only: vec![only.into()], ..request(root) }, program);
    assert!(run("help").unwrap().is_empty());
    assert!(std::fs::read_to_string(root.join("docs/deep/help.txt")).unwrap().contains("Usage"));
    assert_eq!(Record::load(&root.join("docs")).unwrap().of("help").unwrap().commands, ["lensrunner-lab --help"]);
    assert_eq!(run("broken").unwrap(), ["broken"]);
    assert!(run("nothing").is_err());
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
    for chart in ["projection", "disk", "aurora", "bvh", "trace", "flight", "tessellation"] {
        let home = if chart == "disk" { "docs/disk" } else { "docs" };
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
        let drawing = format!("{chart}.svg");
        let [now, then] = [folder.path(), &root.join(home)].map(|folder| std::fs::read_to_string(folder.join(&drawing)).unwrap());
        assert!(now == then, "{home}/{drawing}: lab/run chart {chart} --redraw -o {home}");
    }
}
