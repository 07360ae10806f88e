//! What is heard of flights: read from the simulated world, and measured in the samples of its sound.

use std::path::Path;

use bevy::prelude::{App, FixedUpdate};
use glam::{DQuat, DVec3};
use lensrunner::play::demonstration;
use lensrunner::play::session::Session;
use lensrunner::play::sound::file::render;
use lensrunner::play::sound::heard::{Alarm, Heard};
use lensrunner::play::sound::mixer::{Mixer, RATE};
use lensrunner::play::sound::read::Listener;
use lensrunner::play::sound::record::Recorder;
use lensrunner::play::sound::voices::beacon::{PERIOD, PITCH};
use lensrunner::scene::Scene;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::sim::bolts::{Gun, Hits, Trigger};
use lensrunner::sim::sight::emission_time;
use lensrunner::sim::{Clock, Controls, Engine, Fleet, Fuel, History, ShipMotion, app_of};
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::light::Order;

use super::samples::{BEACON, mono, next, pitch};
use crate::sim::chase::CHASE;
use crate::support::Folder;

/// A session of this scene, by the game's own configuration.
fn session(text: &str) -> Session {
    let home = Session::load(None, Some("chase"), Some(1)).expect("the game's own files");
    Session { scene: Scene::from_toml(Path::new("test.toml"), text).expect("a scene"), ..home }
}

fn app(session: &Session) -> App {
    app_of(&session.scene, &session.effective(), session.seed)
}

fn run(app: &mut App, until: f64, mut look: impl FnMut(&App)) {
    while app.world().resource::<Clock>().time < until {
        app.world_mut().run_schedule(FixedUpdate);
        look(app);
    }
}

fn history(app: &App, ship: usize) -> &History {
    app.world().get::<History>(app.world().resource::<Fleet>().0[ship]).expect("a ship")
}

/// The proper times of both ships for light that ship 0 receives from ship 1 at T = `time`.
fn clocks(app: &App, time: f64) -> [f64; 2] {
    let own = history(app, 0).at(time);
    let eye = Observer { position: own.position, momentum: own.momentum, attitude: DQuat::IDENTITY, field_of_view: 1.0 };
    let emitted = emission_time(&eye, time, history(app, 1), Order::ALL[0]).expect("seen");
    [own.proper_time, history(app, 1).at(emitted).proper_time]
}

/// g by both ships' clocks: the proper time that passes between two wave crests where they are sent, over that where they arrive. It knows
/// nothing of the light's momentum.
fn g_by_clocks(app: &App, time: f64) -> f64 {
    let h = 1e-3;
    let (before, after) = (clocks(app, time - h), clocks(app, time + h));
    (after[1] - before[1]) / (after[0] - before[0])
}

/// Two ships that coast: one far out, one that falls from r = 12 to r = 5 and away again on the other side of the hole.
const COASTING: &str = r#"
[[ship]]
name = "own"
player = true
orbit = { radius = 14.0, phase = 3.5 }
[[ship]]
name = "other"
position = [12, 0, 0]
momentum = [0.15, 0.22, 0.0]
"#;

/// In the whole sound of a flight: each ping has the pitch that the clocks say, and comes when the light of its beat arrives.
#[test]
fn a_flights_beacon_is_shifted_and_late_as_its_light() {
    let session = session(COASTING);
    let mut app = app(&session);
    let mut recorder = Recorder::new(&session);
    run(&mut app, 45.0, |app| recorder.listen(app.world()));
    let (moments, seconds) = recorder.since(0.0);
    let mut sound = Vec::new();
    render(&moments, seconds, &BEACON, |block| {
        sound.extend_from_slice(block);
        Ok::<(), ()>(())
    })
    .expect("nothing fails");
    let sound = mono(&sound);
    // A ping begins where 5 ms are far louder than those before.
    let energies: Vec<f64> = sound.chunks(240).map(|block| block.iter().map(|x| x * x).sum::<f64>().max(1e-9)).collect();
    let onsets: Vec<usize> = (4..energies.len()).filter(|&k| energies[k] > 30.0 * energies[k - 4]).map(|k| 240 * k).collect();
    let onsets: Vec<usize> =
        onsets.iter().enumerate().filter(|(k, at)| *k == 0 || **at > onsets[k - 1] + 2400).map(|(_, at)| *at).collect();
    let pace = session.config.clock.pace;
    let time = |sample: f64| sample / f64::from(RATE) * pace;
    let beats = (clocks(&app, 45.0)[1] / PERIOD).floor() - (clocks(&app, 0.03)[1] / PERIOD).floor();
    assert!(beats >= 15.0 && (onsets.len() as f64 - beats).abs() <= 1.0, "{} pings, {beats} beats", onsets.len());
    let mut shifts = Vec::new();
    for &onset in onsets.iter().filter(|&&onset| onset + 8000 < sound.len()) {
        let beat = clocks(&app, time(onset as f64))[1] / PERIOD;
        // The clock is looked at each 1/48 s, and a ping swells in 6 ms: 40 ms at most, 0.04 of a beat.
        assert!(beat.fract() < 0.06 || beat.fract() > 0.98, "a ping at beat {beat}");
        let found = pitch(&sound[onset + 1400..onset + 7400], 150.0, 700.0) / PITCH;
        // In the middle of the window, less what the voice lags: half a look and the glide.
        let g = g_by_clocks(&app, time(onset as f64 + 4400.0 - 880.0));
        assert!((found / g - 1.0).abs() < 1e-3, "T = {}: {found} {g}", time(onset as f64));
        shifts.push(g);
    }
    let [least, most] = [f64::min, f64::max].map(|of| shifts.iter().copied().reduce(of).expect("pings"));
    assert!(most / least > 1.15, "it is shifted by different g: {shifts:?}");
}

/// In a chase with both engines on, as it stands at several times.
#[test]
fn a_chases_beacon_sounds_at_g_by_the_clocks() {
    let session = session(CHASE);
    let mut app = app(&session);
    let listener = Listener::of(&session);
    for time in [2.0, 6.0, 12.0, 20.0] {
        run(&mut app, time + 1.0, |_| ());
        let heard = listener.heard(app.world(), &session, time, None).expect("a flight");
        let mut beacon = heard.beacon.expect("a beacon");
        let mut mixer = Mixer::new(RATE);
        let mut at = |emitted: f64, seconds: f64| {
            beacon.emitted = emitted;
            mixer.set(&Heard { beacon: Some(beacon), ..Heard::MUSIC }, &BEACON);
            mono(&next(&mut mixer, seconds))
        };
        at(0.9 * PERIOD, 0.1);
        let found = pitch(&at(1.1 * PERIOD, 0.4)[1500..15_000], 60.0, 1500.0) / PITCH;
        let g = g_by_clocks(&app, time);
        assert!((found / g - 1.0).abs() < 1e-3, "T = {time}: {found} {g}");
    }
}

#[test]
fn the_beacon_is_heard_from_where_the_image_is() {
    let session = session(CHASE);
    let mut app = app(&session);
    run(&mut app, 2.0, |_| ());
    let listener = Listener::of(&session);
    let pan =
        |attitude: DQuat| listener.heard(app.world(), &session, 2.0, Some(attitude)).and_then(|heard| heard.beacon).expect("a beacon").pan;
    let ahead = pan(DQuat::IDENTITY);
    assert!((pan(DQuat::from_rotation_z(std::f64::consts::PI)) + ahead).abs() < 1e-9 && ahead.abs() > 0.05, "{ahead}");
}

/// A programme's burn is heard while it lasts, by what it does; a command that the empty tanks cannot obey is not.
#[test]
fn engines_are_heard_as_they_burn() {
    let burning =
        COASTING.replacen("phase = 3.5 }", "phase = 3.5 }\nthrust = [{ from = 1.0, until = 2.0, acceleration = [0, 0, 0.03] }]", 1);
    let session = session(&burning);
    let most = session.config.ship.thrust;
    let listener = Listener::of(&session);
    let mut app = app(&session);
    let mut heard = |until: f64| {
        run(&mut app, until, |_| ());
        listener.heard(app.world(), &session, until, None).expect("a flight")
    };
    let (before, during, after) = (heard(0.5), heard(1.5), heard(2.5));
    assert_eq!([before.engine, before.load, after.engine, after.load], [0.0; 4]);
    assert!((during.engine - 0.03 / most).abs() < 1e-3, "{}", during.engine);
    assert!(during.load > 0.1);
    let own = app.world().resource::<Fleet>().0[0];
    let mut controls = Controls::default();
    controls.0.rates = DVec3::X * app.world().get::<Engine>(own).expect("an engine").fastest_turn();
    controls.0.thrust = DVec3::X * most;
    app.world_mut().entity_mut(own).insert((controls, Fuel { left: 0.0, capacity: 1.0 }));
    run(&mut app, 3.0, |_| ());
    let turning = listener.heard(app.world(), &session, 3.0, None).expect("a flight");
    assert_eq!((turning.engine, turning.thrusters), (0.0, 1.0), "it turns without fuel");
}

/// In the plane of the disk and above it; with the gas and against it.
#[test]
fn the_disk_is_heard_where_its_gas_is() {
    let at = |orbit: &str, height: f64| {
        let text = format!("[disk]\nturbulence = 0.0\n[[ship]]\nname = \"own\"\nplayer = true\norbit = {{ {orbit} }}\n");
        let session = session(&text);
        let mut app = app(&session);
        let own = app.world().resource::<Fleet>().0[0];
        let mut state = app.world().get::<ShipMotion>(own).expect("a ship").0;
        state.position.z += height;
        app.world_mut().entity_mut(own).insert(History::new(0.0, &state));
        Listener::of(&session).heard(app.world(), &session, 0.0, None).expect("a flight")
    };
    let within = at("radius = 6.0", 0.0);
    assert!(within.immersion > 0.99 && within.wind < 1e-6, "{within:?}");
    // Half height 0.02 r = 0.12: e^-1/2 there.
    let edge = at("radius = 6.0", 0.12);
    assert!((edge.immersion / within.immersion - (-0.5f64).exp()).abs() < 1e-6, "{edge:?}");
    assert_eq!([at("radius = 6.0", 2.0), at("radius = 14.0", 0.0)].map(|heard| heard.immersion > 1e-9), [false; 2]);
    // Against the gas: both have the speed 1/√(2(r − 1)) = 0.316 against what hovers; together 2v/(1 + v²).
    let against = at("radius = 6.0, inclination = 3.141592653589793", 0.0);
    let v = 0.1f64.sqrt();
    assert!((against.wind - 2.0 * v / (1.0 + v * v)).abs() < 1e-6, "{against:?}");
}

/// The share of the hold time, and what there is to hear once it is done.
#[test]
fn a_hold_is_heard_until_it_is_a_catch() {
    let held = CHASE.replace("[4.25, 5.5, 1.5]", "[9, 0.3, 0]").replace("[0.0, 0.45, 0.12]", "[0.36, 0.25, 0.05]");
    let held =
        held.replace("ai = \"pursue\"\n", "ai = \"pursue\"\nfuel = 0.0\n").replacen("fuel = 7\n", "", 1).replace("fuel = 4", "fuel = 0.0");
    let session = session(&held);
    let listener = Listener::of(&session);
    let mut app = app(&session);
    let mut heard = |until: f64| {
        run(&mut app, until, |_| ());
        listener.heard(app.world(), &session, until, None).expect("a flight")
    };
    let rules = session.scene.rules(&session.config);
    let half = heard(0.5 * rules.hold_time);
    assert!((half.hold - 0.5).abs() < 0.02 && half.danger == 1.0, "{half:?}");
    let caught = heard(rules.hold_time + 0.1);
    assert_eq!((caught.hold, caught.danger, caught.alarm), (0.0, 0.0, None));
    assert_eq!((half.successes, caught.successes, caught.losses), (0, 1, 0));
}

/// Bolts of a mission as they are fired, and what they hit.
#[test]
fn bolts_are_heard_as_they_are_fired() {
    let session = session(CHASE);
    let listener = Listener::of(&session);
    let mut app = app(&session);
    run(&mut app, 1.0, |_| ());
    assert_eq!(listener.heard(app.world(), &session, 1.0, None).expect("a flight").bolt, None);
    let own = app.world().resource::<Fleet>().0[0];
    app.world_mut().entity_mut(own).insert((Gun { left: 2, ready: 0.0 }, Trigger { pulled: true }));
    run(&mut app, 1.0 + 1.0 / 32.0, |_| ());
    let fired = listener.heard(app.world(), &session, 1.0, None).expect("a flight");
    assert_eq!((fired.bolt, fired.hits), (Some(1.0), 0));
    let other = app.world().resource::<Fleet>().0[1];
    app.world_mut().entity_mut(other).insert(Hits(3));
    assert_eq!(listener.heard(app.world(), &session, 1.0, None).expect("a flight").hits, 3);
}

/// What the world must say for each alarm, and which goes before which.
#[test]
fn alarms_tell_of_the_hole_the_time_and_the_fuel() {
    let heard = |text: &str, until: f64, change: fn(&mut App)| {
        let session = session(text);
        let mut app = app(&session);
        run(&mut app, until, |_| ());
        change(&mut app);
        let time = app.world().resource::<Clock>().time;
        Listener::of(&session).heard(app.world(), &session, time, None).expect("a flight")
    };
    let low = |app: &mut App| {
        let own = app.world().resource::<Fleet>().0[0];
        let mut fuel = app.world_mut().get_mut::<Fuel>(own).expect("tanks");
        fuel.left = 0.1 * fuel.capacity;
    };
    assert_eq!(heard(CHASE, 1.0, |_| ()).alarm, None);
    assert_eq!(heard(CHASE, 1.0, low).alarm, Some(Alarm::Fuel));
    let short = format!("[rules]\ntime_limit = 12.0\n{CHASE}");
    assert_eq!(heard(&short, 10.0, low).alarm, Some(Alarm::Fuel));
    let late = heard(&short, 11.0, low);
    assert_eq!(late.alarm, Some(Alarm::Time));
    assert!(late.danger > 0.5);
    let lost = heard(&short, 12.5, low);
    assert_eq!((lost.alarm, lost.danger, lost.losses, lost.successes), (None, 0.0, 1, 0), "it is over");
    let deep = CHASE.replace("[9, 0, 0]", "[1.9, 0, 0]").replace("[0.36, 0.25, 0.05]", "[0.9, 0.9, 0.0]");
    let deep = heard(&deep, 0.03, low);
    assert_eq!(deep.alarm, Some(Alarm::Hole));
    assert!(deep.danger > 0.9, "{}", deep.danger);
}

/// The file of the demonstration: as long as the flight at the game's pace.
#[test]
fn the_demonstration_is_written_to_a_file() {
    let session = Session::load(None, Some("chase"), Some(1)).expect("the game's own files");
    let folder = Folder::new();
    let path = folder.path().join("flight.wav");
    let (span, _, seconds) = demonstration::sound(&session, PilotKind::Expert, None, &path).expect("written");
    // A step of the flight is 1/48 s.
    assert!((seconds - (span[1] - span[0]) / session.config.clock.pace).abs() < 0.03, "{span:?} {seconds}");
    let mut file = hound::WavReader::open(&path).expect("a WAV file");
    let samples: Vec<i16> = file.samples().map(|sample| sample.expect("a sample")).collect();
    assert_eq!(samples.len(), 2 * (seconds * f64::from(RATE)).round() as usize);
    let loud = (samples.iter().map(|&x| (f64::from(x) / 32768.0).powi(2)).sum::<f64>() / samples.len() as f64).sqrt();
    assert!((0.01..0.2).contains(&loud), "{loud}");
    let missing = folder.path().join("missing/flight.wav");
    let error = demonstration::sound(&session, PilotKind::Expert, None, &missing).expect_err("no such folder").to_string();
    assert!(error.contains("missing/flight.wav"), "{error}");
}
