//! `simulate` from outside: scene text in, CSV out.

use std::path::Path;

use lensrunner::scene::{GameConfig, Scene};
use lensrunner::sim::simulate::{COLUMNS, SimulateRequest, Summary, simulate};

/// One row.
pub struct Row {
    pub ship: String,
    pub numbers: Vec<f64>,
}

impl Row {
    /// By column name.
    pub fn get(&self, column: &str) -> f64 {
        let index = COLUMNS.split(',').position(|name| name == column).expect("a column");
        self.numbers[index - 1]
    }

    pub fn radius(&self) -> f64 {
        ["x", "y", "z"].map(|column| self.get(column).powi(2)).iter().sum::<f64>().sqrt()
    }
}

/// Runs the scene `text`: rows, what was said, how it went.
pub fn run(text: &str, until: f64, every: f64, seed: u64) -> (Vec<Row>, String, Summary) {
    let scene = Scene::from_toml(Path::new("test.toml"), text).expect("a scene");
    let (mut out, mut log) = (Vec::new(), Vec::new());
    let request = SimulateRequest { until: Some(until), every, seed, ..SimulateRequest::default() };
    let summary = simulate(&scene, &GameConfig::default(), &request, &mut out, &mut log).expect("a run");
    let csv = String::from_utf8(out).expect("text");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(COLUMNS));
    let rows = lines
        .map(|line| {
            let mut fields = line.split(',');
            let ship = fields.next().expect("a name").to_owned();
            Row { ship, numbers: fields.map(|field| field.parse().expect("a number")).collect() }
        })
        .collect();
    (rows, String::from_utf8(log).expect("text"), summary)
}

const CIRCLE: &str = "[[ship]]\nname = \"a\"\norbit = { radius = 3.0 }\n";

#[test]
fn rows_come_at_the_times_asked_for_and_the_last_one_at_the_end() {
    let (rows, log, summary) = run(CIRCLE, 1.0, 0.3, 0);
    let times: Vec<f64> = rows.iter().map(|row| row.get("T")).collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 0.9, 1.0]);
    // 32 steps of 1/32.
    assert_eq!(summary.steps, 32);
    let last = log.lines().last().expect("a last line");
    let hash = last.split_whitespace().last().expect("a hash");
    assert!(last.contains("steps per second") && hash.len() == 16 && u64::from_str_radix(hash, 16).is_ok(), "{last}");
    assert_eq!(hash, summary.hash.to_string());
}

#[test]
fn looking_more_often_changes_nothing() {
    let (seldom, _, one) = run(CIRCLE, 7.0, 7.0, 0);
    let (often, _, other) = run(CIRCLE, 7.0, 0.01, 0);
    assert_eq!(one.hash, other.hash);
    assert_eq!(seldom[1].numbers, often[700].numbers);
    assert!(seldom[0].numbers != seldom[1].numbers);
}

#[test]
fn a_turn_on_the_last_stable_orbit_is_a_turn() {
    // r = 6 M: T_coord = 92.3435877717, T_proper = 65.2967771124, geodetic angle 1.84030236902 (closed forms, in M).
    let period = 92.3435877717 / 2.0;
    let (rows, _, _) = run(CIRCLE, period, period, 0);
    let (start, end) = (&rows[0], &rows[1]);
    for column in ["x", "y", "z", "px", "py", "pz", "E", "Lz"] {
        assert!((end.get(column) - start.get(column)).abs() < 1e-9, "{column}");
    }
    assert!((end.get("tau") - 65.2967771124 / 2.0).abs() < 1e-9);
    assert!((2.0 * end.get("qz").atan2(end.get("qw")) - 1.84030236902).abs() < 1e-9);
}

#[test]
fn a_programme_is_flown_from_and_until_the_times_it_says() {
    // Outward thrust a keeps E − a·r; before and after it E is constant. The times are not multiples of the step.
    let text = "[[ship]]\nname = \"a\"\nposition = [20, 0, 0]\nmomentum = [0.3, 0, 0]\n\
        thrust = [{ from = 1.01, until = 3.0371, acceleration = [0.2, 0, 0] }]\n";
    let (rows, _, _) = run(text, 5.0, 0.001, 0);
    let at = |time: f64| rows.iter().find(|row| row.get("T") == time).expect("a row");
    let (before, start, end, after) = (at(0.0), at(1.01), at(3.037), at(5.0));
    assert!((start.get("E") - before.get("E")).abs() < 1e-14);
    let held = |row: &Row| row.get("E") - 0.2 * row.get("x");
    assert!((held(start) - held(end)).abs() < 1e-13);
    assert!(end.get("E") > start.get("E") + 0.05);
    // It burns 1e-4 longer than the row at 3.037.
    let gained = after.get("E") - end.get("E");
    let speed = (at(3.038).get("x") - end.get("x")) / 0.001;
    assert!((gained - 0.2 * speed * 1e-4).abs() < 1e-7, "{gained}");
}

#[test]
fn rows_read_back_as_a_scene_go_on_to_the_same_place() {
    let text = "[[ship]]\nname = \"a\"\nposition = [4, 1, -2]\nmomentum = [0.1, 0.5, 0.2]\nattitude = [0.5, -0.5, 0.5, 0.5]\n";
    let (rows, _, _) = run(text, 8.0, 4.0, 0);
    let number = |column: &str| format!("{:?}", rows[1].get(column));
    let list = |columns: &[&str]| columns.iter().map(|column| number(column)).collect::<Vec<_>>().join(", ");
    let again = format!(
        "[[ship]]\nname = \"a\"\nposition = [{}]\nmomentum = [{}]\nattitude = [{}]\n",
        list(&["x", "y", "z"]),
        list(&["px", "py", "pz"]),
        list(&["qw", "qx", "qy", "qz"])
    );
    let (resumed, _, _) = run(&again, 4.0, 4.0, 0);
    for column in ["x", "y", "z", "px", "py", "pz"] {
        assert_eq!(resumed[1].get(column), rows[2].get(column), "{column}");
    }
    for column in ["qw", "qx", "qy", "qz"] {
        assert!((resumed[1].get(column) - rows[2].get(column)).abs() < 1e-14, "{column}");
    }
}

#[test]
fn a_ship_that_ends_says_why_and_stops_appearing_while_others_go_on() {
    let text = format!("[[ship]]\nname = \"faller\"\nposition = [5, 0, 0]\nmomentum = [0, 0, 0]\n{CIRCLE}");
    let (rows, log, _) = run(&text, 10.0, 1.0, 0);
    // 14.9071198499986 M of τ = T to the centre.
    let last = rows.iter().filter(|row| row.ship == "faller").map(|row| row.get("T")).fold(0.0, f64::max);
    assert_eq!(last, 7.0);
    assert_eq!(rows.iter().filter(|row| row.ship == "a").count(), 11);
    assert!(log.contains("faller: reached the singularity at T = 7.45"), "{log}");
    // 13.5737865166653 M to the horizon.
    assert!(log.contains("faller: crossed the horizon at T = 6.78689325833"), "{log}");
    let names: Vec<&str> = rows[..4].iter().map(|row| row.ship.as_str()).collect();
    assert_eq!(names, ["faller", "a", "faller", "a"]);
}

#[test]
fn rules_never_stop_a_scene_without_ai() {
    let text = format!(
        "[rules]\ntime_limit = 2\ncapture_radius = 100\nhold_time = 0\n{CIRCLE}[[ship]]\nname = \"b\"\nplayer = true\norbit = {{ radius = 4 }}\n"
    );
    let (rows, log, _) = run(&text, 5.0, 5.0, 0);
    assert_eq!(rows.last().map(|row| row.get("T")), Some(5.0));
    assert!(!log.contains("caught") && !log.contains("time is out"), "{log}");
}

#[test]
fn an_empty_tank_coasts() {
    let text = "[[ship]]\nname = \"a\"\nposition = [20, 0, 0]\nmomentum = [0.3, 0, 0]\nfuel = 0.1\n\
        thrust = [{ from = 0, until = 5, acceleration = [0.2, 0, 0] }]\n";
    let (rows, log, _) = run(text, 4.0, 0.25, 0);
    assert!(log.contains("a: out of fuel"), "{log}");
    // 0.1 c at 0.2 c²/r_s lasts 0.5 r_s/c of proper time.
    let dry: Vec<f64> = rows.iter().filter(|row| row.get("tau") > 0.5).map(|row| row.get("E")).collect();
    assert!(dry.len() > 10 && dry.iter().all(|e| (e - dry[0]).abs() < 1e-13));
    assert!(dry[0] > rows[0].get("E") + 0.01);
    assert!(rows.last().expect("rows").radius() > 10.0);
}

#[test]
fn what_cannot_be_run_is_refused_with_the_range() {
    let scene = Scene::from_toml(Path::new("test.toml"), CIRCLE).expect("a scene");
    let refuse = |request: SimulateRequest| {
        let result = simulate(&scene, &GameConfig::default(), &request, &mut Vec::new(), &mut Vec::new());
        result.expect_err("refused").to_string()
    };
    assert!(refuse(SimulateRequest { until: Some(-1.0), ..SimulateRequest::default() }).contains("--until -1 must be from 0"));
    assert!(refuse(SimulateRequest { until: Some(f64::NAN), ..SimulateRequest::default() }).contains("--until NaN must be from 0"));
    assert!(refuse(SimulateRequest { every: 0.0, ..SimulateRequest::default() }).contains("--every 0.0 must be above 0"));
    // Every step of what is recorded is kept.
    let recorded = |until| {
        let request = SimulateRequest { until: Some(until), every: 1e3, ..SimulateRequest::default() };
        request.check_recorded(&scene, &GameConfig::default()).map_err(|wrong| wrong.to_string())
    };
    assert_eq!(recorded(1e5), Ok(1e5));
    assert!(recorded(1e9).is_err_and(|said| said.contains("--until 1000000000") && said.contains("allowed 0 to 100000.03125 r_s/c")));
    let empty = Scene::from_toml(Path::new("empty.toml"), "").expect("a scene");
    let error =
        simulate(&empty, &GameConfig::default(), &SimulateRequest::default(), &mut Vec::new(), &mut Vec::new()).expect_err("refused");
    assert!(error.to_string().contains("at least one [[ship]]"));
}

/// A disk that is full is said with the file that was to be written.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_named() {
    let run = |args: &[&str]| {
        let ended = std::process::Command::new(env!("CARGO_BIN_EXE_lensrunner")).args(args).output().expect("the program starts");
        (ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned())
    };
    for args in [
        &["simulate", "chase", "--until", "1", "-o", "/dev/full"][..],
        &["simulate", "chase", "--until", "1", "--save-replay", "/dev/full"],
        &["simulate", "chase", "--until", "1", "--sweep", "ship.fuel=1,2", "-o", "/dev/full"],
        &["trace", "--scene", "plunge", "--size", "4x4", "-o", "/dev/full"],
        &["bake", "--nodes", "5", "--points", "0", "-o", "/dev/full"],
    ] {
        let (code, said) = run(args);
        assert!(matches!(code, Some(1 | 2)) && said.contains("/dev/full"), "{args:?}: {code:?}, {said}");
    }
    // As a picture by its name, through a link.
    let folder = crate::support::Folder::new();
    for name in ["a.png", "a.exr"] {
        let path = folder.path().join(name);
        std::os::unix::fs::symlink("/dev/full", &path).expect("a link");
        let (code, said) = run(&["trace", "--scene", "plunge", "--size", "4x4", "-o", &path.to_string_lossy()]);
        assert!(code == Some(1) && said.contains(name) && said.contains("No space left"), "{code:?}: {said}");
    }
}

/// Where the new picture cannot be written the old one stays as it is, and nothing is left beside it.
#[test]
fn pictures_are_written_whole_or_not_at_all() {
    let folder = crate::support::Folder::new();
    let path = folder.path().join("a.png");
    let size = [3, 2];
    lensrunner::picture_file::write_png(&path, &[9; 18], size).expect("written");
    let old = std::fs::read(&path).expect("it is there");
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1);
    std::fs::create_dir(lensrunner::user_file::beside(&path)).expect("in the way");
    assert!(lensrunner::picture_file::check_writable(&path).is_err());
    for said in [
        lensrunner::picture_file::write_png(&path, &[8; 18], size).expect_err("refused").to_string(),
        lensrunner::picture_file::write_png_with_text(&path, &[8; 18], size, "a = 1").expect_err("refused").to_string(),
    ] {
        assert!(said.contains("a.png"), "{said}");
    }
    assert_eq!(std::fs::read(&path).expect("it is there"), old);
}
