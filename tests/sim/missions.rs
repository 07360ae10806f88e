//! Missions: what the files may say, how goals are judged, what becomes of those that the game comes with.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bevy::prelude::*;
use glam::DVec3;
use lensrunner::scene::expect::OUTCOMES;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, Difficulty, GameConfig, Scene};
use lensrunner::sim::app_of;
use lensrunner::sim::bolts::{Bolts, Trigger};
use lensrunner::sim::check::{CheckResult, check, check_all, files, outcome_name};
use lensrunner::sim::replay::{Replay, record};
use lensrunner::sim::run::{RunRequest, run};
use lensrunner::sim::ship::ShipMotion;
use lensrunner::sim::{Fleet, Outcome, Progress, outcome};
use lensrunner::spacetime::matter::{angular_momentum, energy};
use rayon::prelude::*;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A lone ship far out, with these goals.
fn mission(goals: &str) -> Result<Scene, String> {
    let text = format!(
        "[mission]\ntitle = \"t\"\nidea = \"i\"\nbrief = \"b\"\ntime_limit = 100\n{goals}\n\
         [[ship]]\nname = \"own\"\nplayer = true\norbit = {{ radius = 8 }}\n\
         [[ship]]\nname = \"other\"\norbit = {{ radius = 9, phase = 0.5 }}\n"
    );
    Scene::from_toml(Path::new("m.toml"), &text).map_err(|error| error.to_string())
}

fn fly(scene: &Scene, pilot: PilotKind) -> Option<Outcome> {
    run(scene, &GameConfig::default(), &RunRequest { pilot, ..RunRequest::default() }).outcome
}

#[test]
fn the_games_missions_and_scenes_are_as_they_expect() {
    let mut paths = files(&root().join("assets/missions")).expect("missions");
    assert!(paths.len() >= 10, "{}", paths.len());
    paths.extend(files(&root().join("assets/scenes")).expect("scenes"));
    for (path, verdict) in paths.iter().zip(check_all(&paths, &GameConfig::default())) {
        assert!(!verdict.is_failure(), "{}: {verdict}", path.display());
    }
}

#[test]
fn the_games_replays_come_to_the_same_end() {
    let replays = files(&root().join("assets/replays")).expect("replays");
    assert_eq!(replays.len(), 2 * scene::mission_names().len(), "an expert's and a beginner's of each mission");
    for path in replays {
        let replay = Replay::load(&path).expect("a replay");
        let report = replay.verify(&path, None, &GameConfig::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.outcome.map_or("undecided", Outcome::name), replay.outcome);
    }
}

#[test]
fn a_replay_of_another_flight_differs() {
    let scene = scene::load("02-first-pursuit").expect("a mission");
    let request = RunRequest { seed: 3, ..RunRequest::default() };
    let (_, replay) = record(&scene, &GameConfig::default(), &request);
    let other = Replay { seed: 4, ..replay.clone() };
    assert!(other.verify(Path::new("r"), None, &GameConfig::default()).is_err());
    // Settings of the replay go before those of the player.
    let mut config = GameConfig::default();
    config.enemy.thrust = 0.0;
    config.ship.fuel = 0.1;
    assert!(replay.verify(Path::new("r"), None, &config).is_ok());
}

/// Flights of the table of balance: mission, difficulty, pilot and seed, then the outcome and the hash of its end.
fn flights_of_the_table() -> Vec<(String, String)> {
    let text = std::fs::read_to_string(root().join("docs/balance/balance.csv")).expect("the table");
    text.lines()
        .skip(1)
        .map(|row| row.split(',').collect::<Vec<_>>())
        .map(|row| (row[..4].join(","), [row[4], row[10]].join(",")))
        .collect()
}

/// The table says what flights come to: one seed of each row is flown again, to its last bit. Which seed differs from row to row.
#[test]
fn the_table_of_balance_is_of_these_missions() {
    let table: BTreeMap<String, String> = flights_of_the_table().into_iter().collect();
    let names = scene::mission_names();
    let ways: Vec<_> = Difficulty::ALL.into_iter().flat_map(|difficulty| PilotKind::RATED.map(|pilot| (difficulty, pilot))).collect();
    let kinds = names.iter().flat_map(|name| ways.iter().map(move |&(difficulty, pilot)| (name, difficulty, pilot)));
    let all: Vec<_> = kinds.zip(0u64..).collect();
    assert_eq!(table.len() % all.len(), 0, "{} flights of {} kinds", table.len(), all.len());
    let seeds = (table.len() / all.len()) as u64;
    all.into_par_iter().for_each(|((name, difficulty, pilot), k)| {
        let seed = k % seeds;
        let report =
            run(&scene::load(name).expect("a mission"), &GameConfig::default(), &RunRequest { difficulty, pilot, seed, until: None });
        let key = format!("{name},{difficulty},{pilot},{seed}");
        let flown = format!("{},{}", outcome_name(report.outcome), report.hash);
        assert_eq!(table.get(&key), Some(&flown), "{key}: make docs/balance anew (lensrunner balance)");
    });
}

/// What the table of balance must say.
#[test]
fn missions_are_balanced() {
    let names = scene::mission_names();
    let rows = flights_of_the_table();
    let share = |index: usize, difficulty: Difficulty, pilot: PilotKind| {
        let kind = format!("{},{difficulty},{pilot},", names[index]);
        let (won, all) = rows.iter().filter(|(key, _)| key.starts_with(&kind)).fold((0, 0), |(won, all), (_, end)| {
            let is_won = Outcome::ALL.into_iter().any(|outcome| outcome.is_won() && end.starts_with(&format!("{},", outcome.name())));
            (won + u32::from(is_won), all + 1)
        });
        f64::from(won) / f64::from(all)
    };
    for (index, name) in names.iter().enumerate() {
        let hard = share(index, Difficulty::Hard, PilotKind::Expert);
        assert!((0.05..=0.97).contains(&hard), "{name}: the expert wins {hard} on hard");
        for pilot in [PilotKind::Naive, PilotKind::Apprentice, PilotKind::Expert] {
            let [easy, hard] = [Difficulty::Easy, Difficulty::Hard].map(|difficulty| share(index, difficulty, pilot));
            assert!(hard <= easy, "{name}: {pilot} wins {hard} on hard and {easy} on easy");
        }
        // Training on easy is for everybody.
        for difficulty in Difficulty::ALL.into_iter().filter(|&difficulty| index > 0 || difficulty != Difficulty::Easy) {
            let shares = PilotKind::RATED.map(|pilot| share(index, difficulty, pilot));
            assert!(shares.iter().any(|&share| share > 0.0) && shares.iter().any(|&share| share < 1.0), "{name}, {difficulty}: {shares:?}");
        }
    }
    for (index, name) in names.iter().enumerate() {
        // Who does as the screen says wins on easy at the first flight.
        let [ignoring, person, practised] =
            [PilotKind::Ignoring, PilotKind::Person, PilotKind::Practised].map(|pilot| share(index, Difficulty::Easy, pilot));
        assert!(person >= 0.6 && practised >= 0.9, "{name}: a person wins {person}, with practice {practised}");
        // Without the signs hardly half as often; the others are won by the assist, or by flying to the mark.
        let by_flying = ["01-training", "05-the-last-orbit", "07-arrive-young"].contains(&name.as_str());
        assert!(by_flying || ignoring < 0.5 * person, "{name}: who ignores the signs wins {ignoring}");
    }
}

#[test]
fn goals_are_reached_by_doing_them() {
    let done = |goals: &str| fly(&mission(goals).expect("a mission"), PilotKind::Expert);
    for goal in [
        "kind = \"burn\"\namount = 0.1",
        "kind = \"turn\"\nangle = 2.0",
        "kind = \"coast\"\nfor = 3.0",
        "kind = \"look\"\nship = \"other\"\nfor = 1.0",
        "kind = \"reach\"\nradius = [5.0, 7.0]",
        "kind = \"hold\"\nship = \"other\"\ndistance = 0.8\nfor = 1.0",
        "kind = \"survive\"\nuntil = 20.0",
        "kind = \"whirl\"\nturns = 0.2\nradius = [6.0, 10.0]",
    ] {
        assert_eq!(done(&format!("[[goal]]\ntext = \"x\"\n{goal}")), Some(Outcome::Done), "{goal}");
    }
    assert_eq!(done("[[goal]]\ntext = \"x\"\nkind = \"whirl\"\nturns = 50.0\nradius = [6.0, 10.0]\nbefore = 10.0"), Some(Outcome::TimeOut));
    assert_eq!(done("[[goal]]\ntext = \"x\"\nkind = \"survive\"\nuntil = 50.0\nradius = [0.0, 7.9]"), Some(Outcome::Strayed));
}

#[test]
fn goals_are_done_in_their_order() {
    let goals = "[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1.0\n[[goal]]\ntext = \"y\"\nkind = \"turn\"\nangle = 0.5";
    let mut app = app_of(&mission(goals).expect("a mission"), &GameConfig::default(), 0);
    let mut seen = Vec::new();
    while outcome(app.world()).is_none() {
        app.world_mut().run_schedule(FixedUpdate);
        seen.push(app.world().resource::<Progress>().goal);
    }
    assert!(seen.is_sorted() && seen.contains(&1), "{seen:?}");
    assert!(seen.iter().filter(|&&goal| goal == 0).count() >= 31, "the first takes 1 r_s/c");
}

#[test]
fn bad_missions_are_refused_with_place_and_range() {
    for (goals, words) in [
        ("[[goal]]\ntext = \"x\"\nkind = \"fly\"", vec!["m.toml:8", "fly", "burn"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"turn\"", vec!["m.toml:8", "needs angle"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"turn\"\nangle = 1\namount = 2", vec!["m.toml:10", "amount", "angle"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"hold\"\nship = \"nobody\"", vec!["m.toml:9", "nobody", "other"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"gates\"", vec!["m.toml:8", "[[gate]]"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"survive\"\nuntil = 1000", vec!["until = 1000", "time_limit = 100"]),
        (
            "[[goal]]\ntext = \"x\"\nkind = \"survive\"\nuntil = 90\n[difficulty.hard]\nrules.time_limit = 50",
            vec!["until = 90", "50 of [difficulty.hard]"],
        ),
        ("[[goal]]\ntext = \"x\"\nkind = \"burn\"\namount = 50", vec!["50 c", "7 c"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\n[expect]\noutcome = \"caught\"", vec!["m.toml:11", "never ends so"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"look\"\nship = \"own\"", vec!["m.toml:9", "the player's own"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 9\nbefore = 5", vec!["for = 9", "before = 5"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 0\nbefore = 0", vec!["before = 0"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\nbefore = 500", vec!["before = 500", "time_limit = 100"]),
        ("[[goal]]\ntext = \"a\\u0007b\"\nkind = \"coast\"\nfor = 1", vec!["m.toml:7", "control characters"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"reach\"\nradius = [0.0, 0.5]", vec!["inside the horizon"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"hit\"\nship = \"other\"", vec!["ship.bolts = 0"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\n[[gate]]\nposition = [0.5, 0, 0]\nradius = 1", vec!["m.toml:11", "1.05"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\n[difficulty.easy]\nenemy.thrust = 11", vec!["m.toml:11", "0 to 10"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\n[difficulty.easy]\nrender.orders = 1", vec!["m.toml:11", "enemy"]),
        ("[[goal]]\ntext = \"x\"\nkind = \"coast\"\nfor = 1\n[difficulty.mad]\nstars = [1, 2]", vec!["mad", "easy, normal, hard"]),
        ("", vec!["[[goal]]"]),
    ] {
        let said = mission(goals).expect_err(goals);
        for word in words {
            assert!(said.contains(word), "{goals}\n{said}\ndoes not say {word}");
        }
    }
}

#[test]
fn what_comes_otherwise_than_expected_is_said() {
    let expect = |text: &str| {
        let scene = format!("[expect]\nuntil = 5\n{text}\n[[ship]]\nname = \"a\"\norbit = {{ radius = 6 }}\n");
        check(&Scene::from_toml(Path::new("e.toml"), &scene).expect("a scene"), &GameConfig::default())
    };
    assert!(matches!(
        expect("outcome = \"undecided\"\ntime = [5, 5]\nradius = [5.99, 6.01]\ndrift = [1e-9, 1e-9]"),
        CheckResult::AsExpected(_)
    ));
    for wrong in ["outcome = \"caught\"", "time = [6, 7]", "own_time = [5, 6]", "radius = [6.1, 7]", "hash = \"0123456789abcdef\""] {
        assert!(expect(wrong).is_failure(), "{wrong}");
    }
}

/// The names that `[expect]` knows are the outcomes there are.
#[test]
fn outcomes_have_the_names_that_files_use() {
    assert_eq!(Outcome::ALL.map(Outcome::name).as_slice(), &OUTCOMES[..OUTCOMES.len() - 1]);
}

/// A bolt keeps its energy and angular momentum: it falls freely. 1e-9 is what the integrator keeps over its life.
#[test]
fn bolts_fall_freely_and_end() {
    let scene = scene::load("06-the-long-shot").expect("a mission");
    let config = scene.config(&GameConfig::default(), Difficulty::Easy);
    let mut app = app_of(&scene, &config, 0);
    *app.world_mut().resource_mut::<lensrunner::sim::PlayerCommands>() =
        lensrunner::sim::PlayerCommands { autopilot: false, ..Default::default() };
    let ship = app.world().resource::<Fleet>().0[0];
    app.world_mut().get_mut::<Trigger>(ship).expect("armed").pulled = true;
    app.world_mut().run_schedule(FixedUpdate);
    // The player pulls the trigger now, and they do not.
    assert!(app.world().resource::<Bolts>().0.is_empty());
    app.world_mut().resource_mut::<lensrunner::sim::PlayerCommands>().fire = true;
    app.world_mut().run_schedule(FixedUpdate);
    app.world_mut().resource_mut::<lensrunner::sim::PlayerCommands>().fire = false;
    let bolt = app.world().resource::<Bolts>().0[0].clone();
    let (e, l) = (energy(&bolt.state), angular_momentum(&bolt.state));
    (0..1400).for_each(|_| app.world_mut().run_schedule(FixedUpdate));
    let after = &app.world().resource::<Bolts>().0[0];
    assert!((energy(&after.state) - e).abs() < 1e-9 * e, "{} {e}", energy(&after.state));
    assert!(angular_momentum(&after.state).distance(l) < 1e-8 * l.length());
    let ended = after.ended.expect("it has an end");
    assert!(
        !after.history.exists_at(ended + 0.1) && !after.history.exists_at(bolt.fired - 0.1) && after.history.exists_at(bolt.fired + 0.1)
    );
}

/// The seed moves the starts within what the file allows, and never what it does not name.
#[test]
fn starts_are_scattered_by_the_seed() {
    let scene = scene::load("02-first-pursuit").expect("a mission");
    let start = |seed: u64, ship: usize| -> DVec3 {
        let app = app_of(&scene, &GameConfig::default(), seed);
        app.world().get::<ShipMotion>(app.world().resource::<Fleet>().0[ship]).expect("a ship").0.position
    };
    assert_eq!(start(1, 0), start(2, 0));
    assert_ne!(start(1, 1), start(2, 1));
    assert_eq!(start(5, 1), start(5, 1));
    for seed in 0..50 {
        assert!((10.4..=13.6).contains(&start(seed, 1).length()), "{seed}");
    }
}
