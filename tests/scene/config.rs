//! `game.toml`: the committed file says every value with its unit; what is wrong is said with file, line, key and range.

use std::path::Path;

use lensrunner::scene::config::{Allowed, GameConfig, Value, load, parse, setting, settings, template};

const COMMITTED: &str = include_str!("../../game.toml");

/// Every value with its unit and range.
#[test]
fn the_committed_file_is_the_template_of_the_defaults() {
    let wanted = template(&GameConfig::default());
    for (line, wanted) in COMMITTED.lines().zip(wanted.lines()) {
        assert_eq!(line, wanted);
    }
    assert_eq!(COMMITTED, wanted);
    for (setting, line) in settings().iter().zip(wanted.lines().filter(|line| line.contains(" = "))) {
        assert!(line.starts_with(&format!("{} = ", setting.key)), "{line}");
        assert!(line.contains(&setting.allowed_text()) || matches!(setting.allowed, Allowed::Buttons | Allowed::Words(_)), "{line}");
        assert!(line.contains(setting.unit), "{line}");
    }
}

#[test]
fn defaults_are_allowed_and_survive_a_round_trip() {
    let mut config = GameConfig::default();
    for setting in settings() {
        setting.check(setting.get(&config)).unwrap_or_else(|problem| panic!("{}: {problem}", setting.path()));
    }
    config.render.orders = 3;
    config.controls.boost = "KeyX".into();
    config.disk.inner = 4.25;
    config.sky.star_brightness = 0.1 + 0.2;
    assert_eq!(parse(Path::new("a.toml"), &template(&config)).unwrap(), config);
    assert_eq!(parse(Path::new("a.toml"), "").unwrap(), GameConfig::default());
}

/// The table reaches every field: setting each to another allowed value changes the configuration's text in that one line.
#[test]
fn every_setting_sets_its_own_field() {
    let default = GameConfig::default();
    for setting in settings() {
        let other = match (setting.allowed, setting.get(&default)) {
            (Allowed::Number { min, max }, Value::Number(now)) => Value::Number(if now == max { min } else { max }),
            (Allowed::Integer { min, max }, Value::Integer(now)) => Value::Integer(if now == max { min } else { max }),
            (Allowed::Switch, Value::Switch(now)) => Value::Switch(!now),
            (Allowed::Choice(words), Value::Word(now)) => Value::Word(words.iter().find(|word| **word != now).unwrap().to_string()),
            (Allowed::Buttons, Value::Word(_)) => Value::Word("Numpad7".into()),
            (Allowed::Words(words), Value::Word(_)) => Value::Word(words[0].into()),
            (allowed, value) => panic!("{}: {value:?} against {allowed:?}", setting.path()),
        };
        let mut changed = default.clone();
        setting.set(&mut changed, other.clone()).unwrap();
        assert_eq!(setting.get(&changed), other, "{}", setting.path());
        let differing: Vec<String> = settings().iter().filter(|s| s.get(&changed) != s.get(&default)).map(|s| s.path()).collect();
        assert_eq!(differing, [setting.path()]);
        // The struct as a whole, seen through Debug, differs too: the getter is not a copy of the setter's mistake.
        assert_ne!(format!("{changed:?}"), format!("{default:?}"));
    }
}

/// As many table rows as there are fields in the struct, counted by the names that Debug prints.
#[test]
fn the_table_covers_every_field() {
    let shown = format!("{:?}", GameConfig::default());
    let sections = settings().iter().map(|setting| setting.section).collect::<std::collections::BTreeSet<_>>().len();
    assert_eq!(shown.matches(": ").count(), settings().len() + sections, "{shown}");
}

#[test]
fn complaints_name_file_line_key_and_range() {
    for (text, parts) in [
        ("[render]\norders = 7\n", ["game.toml:2:", "render.orders", "7 is out of range", "whole numbers 1 to 3"]),
        ("[clock]\n\npace = 0\n", ["game.toml:3:", "clock.pace", "0 is out of range", "0.01 to 50 r_s/c per second"]),
        ("[render]\nbloom = nan\n", ["game.toml:2:", "render.bloom", "NaN", "0 to 1"]),
        ("[render]\norders = 2.5\n", ["game.toml:2:", "render.orders", "2.5", "whole numbers"]),
        ("[render]\nordrs = 2\n", ["game.toml:2:", "render.ordrs", "unknown key", "orders"]),
        ("[rander]\norders = 2\n", ["game.toml:1:", "rander", "unknown section", "render"]),
        ("[hole]\nmass_solar = \"big\"\n", ["game.toml:2:", "hole.mass_solar", "\"big\"", "solar masses"]),
        ("[hole]\nmass_solar = [1]\n", ["game.toml:2:", "hole.mass_solar", "array", "solar masses"]),
        ("[render]\nmethod = \"magic\"\n", ["game.toml:2:", "render.method", "\"magic\"", "\"table\""]),
        ("[controls]\nboost = \"Shift\"\n", ["game.toml:2:", "controls.boost", "\"Shift\"", "KeyA"]),
        ("[disk]\nseed = 99999999999\n", ["game.toml:2:", "disk.seed", "99999999999", "4294967295"]),
        ("[video]\nvsync = 1\n", ["game.toml:2:", "video.vsync", "1", "true or false"]),
        ("[video]\nvsync = true\nvsync = true\n", ["game.toml:3:", "duplicate", "", ""]),
        ("[clock]\n\n[controls]\nthrust_forward = \"KeyS\"\n", ["game.toml:4:", "controls.thrust_forward", "KeyS", "thrust_back"]),
        ("[render]\norders = 2\nexposure_max = -20.0\n", ["game.toml:3:", "render.exposure_max", "-12", "less than"]),
        ("pace = 3\n", ["game.toml:1:", "pace", "unknown section", "clock"]),
    ] {
        let said = parse(Path::new("game.toml"), text).expect_err("must be refused").to_string();
        assert!(parts.iter().all(|part| said.contains(part)), "{text:?} gave {said:?}, lacking one of {parts:?}");
    }
    assert!(load(Path::new("no/game.toml")).unwrap_err().to_string().contains("no/game.toml"));
}

#[test]
fn all_that_is_wrong_is_said_at_once() {
    let text = "[video]\nvsync = 1\n[clock]\npace = 0\nstride = 2\n[rander]\n[render]\norders = 2\n";
    let said = parse(Path::new("game.toml"), text).expect_err("must be refused").to_string();
    let lines: Vec<&str> = said.lines().collect();
    let wanted = ["game.toml:2: video.vsync", "game.toml:4: clock.pace", "game.toml:5: clock.stride", "game.toml:6: rander"];
    assert_eq!(lines.len(), wanted.len(), "{said}");
    assert!(lines.iter().zip(wanted).all(|(line, wanted)| line.starts_with(wanted)), "{said}");
}

#[test]
fn a_refused_value_changes_nothing() {
    let mut config = GameConfig::default();
    let orders = setting("render.orders").unwrap();
    assert!(orders.set(&mut config, Value::Integer(9)).is_err());
    assert_eq!(config, GameConfig::default());
}

/// What the program says of a configuration, with its exit code.
fn said_of(file: &Path) -> (Option<i32>, String) {
    let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_lensrunner"));
    let ended = run.args(["simulate", "chase", "--until", "0.1", "--config"]).arg(file).output().expect("the program starts");
    (ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned())
}

/// Without end, without a writer, longer than is read, no text, too deep: each is refused at once by file, place and limit.
#[test]
fn files_that_are_no_texts_of_a_person_are_refused_at_once() {
    let folder = crate::support::Folder::new();
    let written = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let long = folder.path().join("long.toml");
    std::fs::File::create(&long).and_then(|file| file.set_len(12 << 30)).unwrap();
    let levels = 100_000;
    let mut cases = vec![
        (folder.path().to_path_buf(), "it is a folder"),
        (long, "it has 12884901888 bytes, allowed are at most 4194304"),
        (written("latin.toml", b"[render]\n\n# \xe9\n"), "line 3 is no text in UTF-8"),
        (
            written("arrays.toml", format!("[render]\norders = {}{}\n", "[".repeat(levels), "]".repeat(levels)).as_bytes()),
            ":2: arrays, tables",
        ),
        (written("tables.toml", format!("\n[render]\norders = {}", "{a=".repeat(levels)).as_bytes()), ":3: arrays, tables"),
        (written("keys.toml", format!("[render]\n{}a = 1\n", "a.".repeat(levels)).as_bytes()), ":2: arrays, tables"),
        (written("heads.toml", format!("[{}a]\n", "a.".repeat(levels)).as_bytes()), "allowed are 32 levels"),
    ];
    if cfg!(unix) {
        let pipe = folder.path().join("pipe.toml");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        cases.extend([(pipe, "it is a pipe"), ("/dev/zero".into(), "it is a device")]);
    }
    for (file, wanted) in cases {
        let (code, said) = said_of(&file);
        assert!(code == Some(2) && said.contains(wanted) && said.contains(&file.display().to_string()), "{code:?}: {said}");
        assert!(said.len() < 1000, "{said}");
    }
}

#[test]
fn of_many_faults_the_first_are_said_and_how_many_more_there_are() {
    let keys: String = (0..200_000).map(|k| format!("k{k} = 1\n")).collect();
    let sections: String = (0..200_000).map(|k| format!("[k{k}]\na = 1\n")).collect();
    for (text, first) in
        [(format!("[render]\n{keys}"), "game.toml:2: render.k0: unknown key; known keys: "), (sections, "game.toml:1: k0: ")]
    {
        let said = parse(Path::new("game.toml"), &text).expect_err("must be refused").to_string();
        let lines: Vec<&str> = said.lines().collect();
        assert!(lines.len() == 21 && lines[0].starts_with(first) && lines[19].contains("unknown"), "{said}");
        assert_eq!(lines[20], "game.toml: and 199980 more are wrong");
    }
}

#[test]
fn long_values_are_cut_where_they_are_said() {
    let long = "x".repeat(1_000_000);
    for (text, parts) in [
        (format!("[render]\norders = \"{long}\"\n"), ["game.toml:2: render.orders: \"xxx", "1000000 bytes", "whole numbers 1 to 3"]),
        (format!("[render]\nmethod = \"{long}\"\n"), ["game.toml:2: render.method: \"xxx", "1000000 bytes", "\"table\""]),
        (format!("[render]\n{long} = 1\n"), ["game.toml:2: render.xxx", "bytes", "unknown key"]),
        (format!("[{long}]\n"), ["game.toml:1: xxx", "1000000 bytes", "unknown section"]),
    ] {
        let said = parse(Path::new("game.toml"), &text).expect_err("must be refused").to_string();
        assert!(parts.iter().all(|part| said.contains(part)) && said.len() < 2000, "{} bytes: {said}", said.len());
    }
    let said = format!("render.orders={long}").parse::<lensrunner::scene::config::Assignment>().expect_err("no number");
    assert!(said.contains("render.orders: \"xxx") && said.len() < 400, "{said}");
}
