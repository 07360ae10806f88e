//! Every fuzz target: a function that takes the bytes of untrusted input, goes as far with them as the program does, and returns the text
//! of the refusal, if there is one. Fuzzing and the tests of the game call the same functions.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use lensrunner::lensing::methods::{self, Projector};
use lensrunner::lensing::project::{self, AngleFrame, ProjectError, ProjectRequest};
use lensrunner::lensing::{Scheme, Table};
use lensrunner::picture_file::moment::read_moment;
use lensrunner::scene::config::{self, Assignment};
use lensrunner::scene::model::import::load_model;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, Difficulty, GameConfig, Scene};
use lensrunner::sim::replay::Replay;
use lensrunner::sim::replay::link::MARK;
use lensrunner::sim::run::fly_to_end;
use lensrunner::sim::snapshot::Snapshot;
use lensrunner::sim::sweep::Axis;
use lensrunner::sim::{Moment, agent, balance, check};
use lensrunner::spacetime::light::{Branch, Order};

/// A target: its name, and what it does with bytes.
type Target = (&'static str, fn(&[u8]) -> Result<(), String>);

/// All targets.
pub const TARGETS: &[Target] = &[
    ("agent", agent),
    ("command", command),
    ("config", config),
    ("model", model),
    ("moment", moment),
    ("project", project),
    ("replay", replay),
    ("scene", scene),
    ("settings", settings),
    ("table", table),
    #[cfg(feature = "game")]
    ("scores", scores),
];

/// The most bytes of a line of a refusal.
const LONGEST: usize = 2000;
/// The most lines of one.
const LINES: usize = 21;
/// Of a flight only the first steps are flown: a whole one may take as long as it likes.
const STEPS: u64 = 4;
/// Scenes of more ships are read and not flown.
const MOST_SHIPS: usize = 8;

/// Runs the target called `name` with `bytes`. Panics if the refusal does not say where, or is too long.
pub fn check(name: &str, bytes: &[u8]) {
    let Some((_, target)) = TARGETS.iter().find(|(known, _)| *known == name) else { panic!("there is no target {name}") };
    let Err(said) = target(bytes) else { return };
    let has_place = ["input.", "line ", "--", "input:"].iter().any(|place| said.contains(place));
    let is_short = said.lines().count() <= LINES && said.lines().all(|line| line.len() <= LONGEST);
    assert!(has_place && is_short, "{name}: {} bytes: {}", said.len(), said.chars().take(4000).collect::<String>());
}

/// The file `input.ENDING` in a folder of this thread, with these bytes.
fn file(ending: &str, bytes: &[u8]) -> PathBuf {
    struct Folder(PathBuf);
    impl Drop for Folder {
        fn drop(&mut self) {
            // A folder left behind harms nobody.
            _ = std::fs::remove_dir_all(&self.0);
        }
    }
    thread_local! {
        static FOLDER: Folder = {
            let name = format!("lensrunner-untrusted-{}-{:?}", std::process::id(), std::thread::current().id());
            let folder = std::env::temp_dir().join(name);
            std::fs::create_dir_all(&folder).expect("a folder");
            Folder(folder)
        };
    }
    let path = FOLDER.with(|folder| folder.0.join(format!("input.{ending}")));
    std::fs::write(&path, bytes).expect("a file");
    path
}

fn said<T, E: std::fmt::Display>(result: Result<T, E>) -> Result<T, String> {
    result.map_err(|error| error.to_string())
}

/// `game.toml`. What was read is written and read again; a value in it is changed as the dev overlay does.
pub fn config(bytes: &[u8]) -> Result<(), String> {
    let path = file("toml", bytes);
    let found =
        said(config::load(&path)).inspect_err(|wrong| assert!(wrong.contains("line ") || names_line(wrong, "input.toml"), "{wrong}"))?;
    assert_eq!(config::parse(&path, &config::template(&found)).expect("its own text"), found);
    if let Ok(text) = str::from_utf8(bytes) {
        let change = [said("render.orders=1".parse::<Assignment>())?];
        let edited = config::edit::edited(&path, text, &change).expect("a value that is allowed");
        assert_eq!(config::parse(&path, &edited).expect("its own text").render.orders, 1);
    }
    Ok(())
}

/// Whether each line of a refusal says the file and a line in it; the last one may say how many more there are.
fn names_line(said: &str, file: &str) -> bool {
    said.lines().all(|line| {
        let after = line.split_once(&format!("{file}:")).map(|(_, after)| after);
        after.is_some_and(|after| after.starts_with(|c: char| c.is_ascii_digit()) || after.contains("more are wrong"))
    })
}

/// Scenes and missions: read, made of their models, and flown for some steps on each difficulty.
pub fn scene(bytes: &[u8]) -> Result<(), String> {
    let path = file("toml", bytes);
    let scene = said(scene::load(&path.to_string_lossy()))
        .inspect_err(|wrong| assert!(wrong.contains("line ") || names_line(wrong, "input.toml"), "{wrong}"))?;
    let usual = GameConfig::default();
    _ = (scene.disk(&usual), scene.model_files(), scene.record_name());
    // The picture of a planet takes a second, whatever the file says.
    if scene.planet.is_none() {
        let assembly = scene.assemble(&usual);
        for model in &assembly.models {
            assert_eq!(model.fault(), None);
        }
        assert!(assembly.warnings.iter().all(|warning| warning.len() <= LONGEST), "a long warning");
    }
    if scene.ships.len() > MOST_SHIPS {
        return Ok(());
    }
    for difficulty in Difficulty::ALL {
        let config = scene.config(&usual, difficulty);
        let moment = Moment::new(&scene, &config, STEPS as f64 * config.clock.step, 1);
        let (time, ships) = (moment.time(), moment.ships());
        assert!(ships.iter().all(|(_, state)| state.position.is_finite() && state.momentum.is_finite()), "{ships:?}");
        if scene.camera.check(time, &ships).is_ok() {
            let view = scene.camera.viewpoint(time, &ships);
            assert!(view.position.is_finite() && view.momentum.is_finite() && view.attitude.is_finite(), "{view:?}");
        }
    }
    Ok(())
}

/// Tables of light, by each scheme, and what is looked up in them.
pub fn table(bytes: &[u8]) -> Result<(), String> {
    let path = file("lut", bytes);
    let mut wrong = None;
    for scheme in Scheme::ALL {
        let table = match Table::load(&path, scheme) {
            Ok(table) => table,
            Err(error) => {
                wrong = Some(error.to_string());
                continue;
            }
        };
        assert_eq!(table.to_bytes(), bytes, "a table is written as it was read");
        let method: Box<dyn Projector> = match scheme {
            Scheme::Residual => Box::new(methods::Table(table)),
            _ => Box::new(methods::Paper(table)),
        };
        for [r, phi, camera] in [[20.0, 1.0, 10.0], [1.5, 3.1, 0.9], [0.9, 0.1, 0.5], [9000.0, 2.0, 4000.0]] {
            for order in Order::ALL {
                _ = method.project(methods::ProjectionInput { r, phi, camera }, order, Branch::Plus);
            }
        }
        return Ok(());
    }
    Err(wrong.unwrap_or_default())
}

/// Models with their images.
pub fn model(bytes: &[u8]) -> Result<(), String> {
    let model = said(load_model(&file("glb", bytes)))?;
    assert_eq!(model.fault(), None);
    assert!(model.radius() > 0.0 && model.bytes() < 1 << 30);
    Ok(())
}

/// Replays, in files and as links: read, written, read again, and their first steps flown.
pub fn replay(bytes: &[u8]) -> Result<(), String> {
    let path = file("toml", bytes);
    let link = std::str::from_utf8(bytes).ok().filter(|text| text.starts_with(MARK));
    let replay = said(link.map_or_else(|| Replay::load(&path), Replay::from_link))?;
    assert_eq!(Replay::from_text(&path, &replay.to_text()).expect("its own text"), replay);
    if let Ok(link) = replay.to_link() {
        let again = Replay::from_link(&link).expect("its own link");
        assert!(again.to_link().as_ref() == Ok(&link) && again.records == replay.records);
    }
    let scene = said(replay.scene(&path, None))?;
    fly(&replay, &scene);
    Ok(())
}

fn fly(replay: &Replay, scene: &Scene) {
    let config = GameConfig::default();
    let step = replay.config(&config).clock.step;
    let mut app = replay.app(scene, &config);
    _ = fly_to_end(app.world_mut(), replay.ticks.min(STEPS) as f64 * step);
}

/// Moments of a flight: files of their own, and pictures that carry one.
pub fn moment(bytes: &[u8]) -> Result<(), String> {
    let path = file("moment", bytes);
    let text = said(read_moment(&path))?;
    let snapshot = said(Snapshot::from_text(&path, &text))?;
    assert_eq!(Snapshot::from_text(&path, &snapshot.to_text()).expect("its own text"), snapshot);
    if snapshot.flight.ticks <= STEPS {
        _ = said(snapshot.fly(&path))?;
    }
    Ok(())
}

/// Points for `project`: as a whole and in pieces they give the same.
pub fn project(bytes: &[u8]) -> Result<(), String> {
    let exact = said(project::method("exact"))?;
    let mut result = Ok(());
    for (order, frame) in [(0, AngleFrame::Static), (2, AngleFrame::Rain)] {
        let request = ProjectRequest { order: Order::ALL[order], frame, branch: Branch::Minus };
        let pieces = |size: usize| {
            let mut output = Vec::new();
            let result = project::run(&mut Pieces { bytes, size }, &mut output, exact.as_ref(), request);
            (String::from_utf8(output).expect("text"), result.map_err(|error: ProjectError| error.to_string()))
        };
        let whole = pieces(usize::MAX);
        for size in [1, 7] {
            let split = pieces(size);
            assert_eq!(split.1, whole.1, "in pieces of {size} bytes");
            assert!(split.0.starts_with(&whole.0), "in pieces of {size} bytes: {:?} and {:?}", split.0, whole.0);
        }
        result = whole.1;
    }
    result
}

/// Bytes that come so many at a time.
struct Pieces<'a> {
    bytes: &'a [u8],
    size: usize,
}

impl std::io::Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.size.min(buffer.len()).min(self.bytes.len());
        let (now, later) = self.bytes.split_at(count);
        buffer[..count].copy_from_slice(now);
        self.bytes = later;
        Ok(count)
    }
}

/// Words of the command line, one a line: those that the library reads, and the arguments of `check` and `balance`.
pub fn command(bytes: &[u8]) -> Result<(), String> {
    let text = String::from_utf8_lossy(bytes);
    let words: Vec<&str> = text.lines().collect();
    let mut result = Ok(());
    for word in &words {
        let set = Assignment::from_str(word).map(|set| {
            let again: Assignment = set.to_string().parse().expect("its own text");
            assert_eq!(again.value, set.value);
        });
        let axis = Axis::from_str(word).map(|axis| assert!(!axis.values.is_empty()));
        let name = PilotKind::from_str(word).map(|_| ());
        let all = [set, axis, name, Difficulty::from_str(word).map(|_| ()), scene::picture_size(word).map(|_| ())];
        _ = scene::file(word);
        for wrong in all.iter().filter_map(|found| found.as_ref().err()) {
            assert!(wrong.len() <= LONGEST, "{} bytes: {wrong}", wrong.len());
            if !all.contains(&Ok(())) {
                result = Err(format!("input: {wrong}"));
            }
        }
    }
    _ = arguments::<check::CheckArgs>(&words);
    _ = arguments::<balance::BalanceArgs>(&words);
    result
}

/// What clap makes of words; its refusal quotes what was typed.
fn arguments<A: clap::Args>(words: &[&str]) -> Result<A, String> {
    let command = A::augment_args(clap::Command::new("input").no_binary_name(true));
    let matches = said(command.try_get_matches_from(words))?;
    said(A::from_arg_matches(&matches))
}

/// Lines of JSON of a program that flies the player's ship.
pub fn agent(bytes: &[u8]) -> Result<(), String> {
    let scene = said(scene::load("02-first-pursuit"))?;
    let config = GameConfig::default();
    let request = agent::AgentRequest { config: &config, difficulty: Difficulty::Normal, until: 1.0, seed: 1 };
    let levelled = scene.config(&config, Difficulty::Normal);
    let replay = said(agent::fly(&scene, &levelled, &request, &mut &*bytes, &mut Vec::new()))?;
    assert_eq!(Replay::from_text(Path::new("input"), &replay.to_text()).expect("its own text"), replay);
    Ok(())
}

/// The player's settings, as they lie over `game.toml`.
#[cfg(not(feature = "game"))]
pub fn settings(bytes: &[u8]) -> Result<(), String> {
    let path = file("toml", bytes);
    let text = String::from_utf8_lossy(bytes);
    let chosen = said(config::choices(&path, &text, |setting| setting.section != "render"))?;
    let again = config::choices_text(chosen.iter().map(|(setting, value)| (*setting, value)));
    let read = config::choices(&path, &again, |_| true).expect("its own text");
    assert_eq!(read.len(), chosen.len());
    Ok(())
}

/// The player's settings, as they lie over `game.toml`.
#[cfg(feature = "game")]
pub fn settings(bytes: &[u8]) -> Result<(), String> {
    let path = file("toml", bytes);
    let (choices, wrong) = lensrunner::play::choices::Choices::load_from(&path);
    choices.over(&mut GameConfig::default());
    // A damaged file is set aside: so many would be in the way.
    _ = std::fs::remove_file(path.with_file_name("input.damaged-1.toml"));
    wrong.map_or(Ok(()), Err)
}

/// The player's best scores.
#[cfg(feature = "game")]
pub fn scores(bytes: &[u8]) -> Result<(), String> {
    use lensrunner::play::records::Records;
    let path = file("toml", bytes).with_file_name("records.toml");
    std::fs::write(&path, bytes).expect("a file");
    let folder = path.parent().unwrap_or(Path::new(""));
    let (records, wrong) = Records::load_from(folder);
    for difficulty in Difficulty::ALL {
        let best = records.best("01-training", difficulty);
        assert!(best.is_none_or(|best| best.score >= 0.0 && (1..=3).contains(&best.stars)), "{best:?}");
    }
    _ = std::fs::remove_file(path.with_file_name("records.damaged-1.toml"));
    wrong.map_or(Ok(()), |wrong| Err(format!("input: {wrong}")))
}
