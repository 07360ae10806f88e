//! The game without its window: screens, keys, time, and the player's commands to the ship. Runs in a minimal app, for tests.

use bevy::prelude::*;

use crate::scene::pilot_kind::PilotKind;
use crate::sim::assist::Stick;
use crate::sim::by_hand::choose_pilot;
use crate::sim::replay::{Playback, Replay};
use crate::sim::ship::Player;
use crate::sim::target::Targets;
use crate::sim::{Chase, Clock, Engine, Fleet, PlayerCommands, ShipMotion, SimSet, Turning, board, outcome, start};
use crate::spacetime::matter::gamma;

use crate::play::choices::Choices;
use crate::play::input::action::Action;
use crate::play::input::gaze::Gaze;
use crate::play::input::lead::{lead_camera, pinch_camera};
use crate::play::input::mouse::MouseTurn;
use crate::play::input::response::steadied;
use crate::play::input::{ControlsPlugin, PlayerInput};
use crate::play::menus::MenuModelPlugin;
use crate::play::menus::navigate::FileConfig;
use crate::play::menus::screens::{MenuAction, Screen, answer};
use crate::play::missions::{BeforeWatching, Catalogue, LastFlight, Watched, begin_log};
use crate::play::pace::{PacePlugin, Slowing, run_time};
use crate::play::photo::PhotoPlugin;
use crate::play::picture::stage_loading::change_scene;
use crate::play::player_state::{Flown, PlayerState};
use crate::play::schedule::{self, GameSet};
use crate::play::session::Session;
use crate::play::share;
use crate::play::switches::read_keys;

/// Screens, input and time: all of the game that needs no window. Needs [`SimulationPlugins`](crate::sim::SimulationPlugins), [`Session`]
/// and [`PlayerState`].
pub struct GamePlugin;

impl Plugin for GamePlugin {
    fn build(&self, app: &mut App) {
        schedule::order(app);
        app.init_state::<Screen>()
            .add_plugins((PacePlugin, ControlsPlugin, MenuModelPlugin, PhotoPlugin))
            .add_message::<MenuAction>()
            .configure_sets(FixedUpdate, (SimSet::Input, SimSet::Ai, SimSet::Integrate, SimSet::Rules, SimSet::Record).run_if(goes_on))
            .add_systems(
                Update,
                (
                    (read_keys, lead_camera.run_if(resource_exists::<Playback>), pinch_camera.run_if(not(resource_exists::<Playback>)))
                        .chain()
                        .in_set(GameSet::Keys),
                    (answer_menus, end_chase, run_time).chain().in_set(GameSet::Answer),
                ),
            )
            .add_systems(Startup, begin_title)
            .add_systems(
                FixedUpdate,
                (read_commands.run_if(not(resource_exists::<Playback>)), note_pilot).chain().in_set(SimSet::Input).before(choose_pilot),
            );
    }
}

fn begin_title(world: &mut World) {
    begin(world, Screen::Title);
}

/// Starts a flight anew for a screen: by hand in play, unless the autopilot was asked for. On the title the home scene is flown.
pub fn begin(world: &mut World, screen: Screen) {
    choose_scene(world, screen);
    let session = world.resource::<Session>().clone();
    start(world, &session.scene, &session.effective(), session.seed);
    let ship = world.resource::<Fleet>().0[session.player()];
    world.entity_mut(ship).insert(Player);
    let mut player = world.resource_mut::<PlayerState>();
    player.autopilot = screen != Screen::Playing || player.pilot.is_some();
    let pilot = player.pilot.filter(|_| screen == Screen::Playing);
    player.follower.reset();
    player.gaze = Gaze::default();
    player.orbit = player.orbit.ahead();
    player.flown = Flown::default();
    player.assist = None;
    player.assist_held = None;
    player.touched = false;
    player.fired = false;
    player.facing = false;
    *world.resource_mut::<MouseTurn>() = MouseTurn::default();
    if let Some(pilot) = pilot {
        board(world, pilot);
    }
    begin_log(world, screen);
}

/// Puts the scene of a screen into the session, with its seed, and has its models made if it is another one than before.
fn choose_scene(world: &mut World, screen: Screen) {
    let Some(catalogue) = world.get_resource::<Catalogue>().cloned() else { return };
    let PlayerState { choice, free, .. } = *world.resource::<PlayerState>();
    let same_start = std::mem::take(&mut world.resource_mut::<PlayerState>().same_start);
    let watched = world.get_resource::<Watched>().map(|watched| watched.0.clone()).filter(|_| screen == Screen::Playing);
    keep_own_settings(world, watched.is_some());
    let mut session = world.resource_mut::<Session>();
    let before = (session.scene.name.clone(), session.scene.fingerprint);
    match (&watched, screen) {
        (Some(replay), _) => {
            if let Some(scene) = catalogue.find(replay) {
                session.scene = scene.clone();
            }
            session.config = replay.config(&session.config);
            (session.difficulty, session.seed) = (replay.difficulty, replay.seed);
        }
        (None, Screen::Playing) => {
            session.scene = catalogue.scene(choice, free).clone();
            if !session.seed_stays && !same_start {
                session.seed += 1;
            }
        }
        (None, _) => session.scene = catalogue.home.clone(),
    }
    let is_other = before != (session.scene.name.clone(), session.scene.fingerprint);
    if is_other {
        change_scene(world);
        if watched.is_none() {
            restore_pace(world);
        }
    }
}

/// A flight that is watched brings the settings that it was flown by; the player's own are there again after it.
fn keep_own_settings(world: &mut World, watches: bool) {
    let session = world.resource::<Session>();
    if watches {
        let own = Replay::begin(&session.scene, &session.config, session.difficulty, PilotKind::Expert, session.seed);
        world.get_resource_or_insert_with(|| BeforeWatching(own));
    } else if let Some(own) = world.remove_resource::<BeforeWatching>() {
        let mut session = world.resource_mut::<Session>();
        session.config = own.0.config(&session.config);
    }
}

/// The pace that the last mission was slowed or hurried to is not meant for another: as the settings say.
fn restore_pace(world: &mut World) {
    let Some(mut config) = world.get_resource::<FileConfig>().map(|file| file.0.clone()) else { return };
    if let Some(choices) = world.get_resource::<Choices>() {
        choices.over(&mut config);
    }
    let mut session = world.resource_mut::<Session>();
    let played = std::mem::replace(&mut session.config, config);
    session.put_set();
    let pace = session.config.clock.pace;
    session.config = played;
    session.config.clock.pace = pace;
}

/// Whether a flight began anew since T was `before` (r_s/c), which becomes `time`.
pub fn begins_anew(before: &mut f64, time: f64) -> bool {
    std::mem::replace(before, time) > time
}

fn answer_menus(world: &mut World) {
    let actions: Vec<MenuAction> = world.resource_mut::<Messages<MenuAction>>().drain().collect();
    for action in actions {
        match action {
            MenuAction::Quit => _ = world.write_message(AppExit::Success),
            MenuAction::Choose(choice) => world.resource_mut::<PlayerState>().choice = choice,
            MenuAction::Scene(free) => world.resource_mut::<PlayerState>().free = free,
            MenuAction::Level(difficulty) => world.resource_mut::<Session>().difficulty = difficulty,
            MenuAction::Next => {
                let count = world.get_resource::<Catalogue>().map_or(1, Catalogue::len);
                let mut player = world.resource_mut::<PlayerState>();
                player.choice = (player.choice + 1) % count;
                world.remove_resource::<Watched>();
            }
            MenuAction::Watch => {
                if let Some(replay) = world.get_resource::<LastFlight>().and_then(|last| last.replay.clone()) {
                    world.insert_resource(Watched(replay));
                }
            }
            MenuAction::Share => share::share(world),
            MenuAction::Again => {
                world.remove_resource::<Watched>();
                world.resource_mut::<PlayerState>().same_start = true;
            }
            // A flight that was opened is shown when the warning is read.
            MenuAction::Title if *world.resource::<State<Screen>>().get() == Screen::Warning => (),
            MenuAction::Start | MenuAction::Title => _ = world.remove_resource::<Watched>(),
            #[cfg(target_family = "wasm")]
            MenuAction::SaveAll => crate::page::save_all(),
            #[cfg(target_family = "wasm")]
            MenuAction::BringAll => crate::page::bring_all(),
            _ => (),
        }
        let screen = *world.resource::<State<Screen>>().get();
        if let Some((next, anew)) = answer(screen, action) {
            if anew {
                begin(world, next);
            }
            world.resource_mut::<NextState<Screen>>().set(next);
        }
    }
}

/// A decided chase leads to the result, on the title to a new one.
fn end_chase(world: &mut World) {
    let Some((_, decided)) = outcome(world) else { return };
    match world.resource::<State<Screen>>().get() {
        Screen::Playing => world.resource_mut::<NextState<Screen>>().set(Screen::Result),
        // The title shows the end for a while.
        Screen::Title if world.resource::<Clock>().time > decided + 5.0 => begin(world, Screen::Title),
        _ => (),
    }
}

/// A decided chase stands still in play; on the title it flies on for a while.
fn goes_on(chase: Option<Res<Chase>>, screen: Res<State<Screen>>) -> bool {
    *screen.get() == Screen::Title || chase.is_none_or(|chase| chase.outcome.is_none())
}

/// Keeps who flies, for the result to say.
fn note_pilot(mut player: ResMut<PlayerState>) {
    let autopilot = player.autopilot;
    player.flown.by_autopilot |= autopilot;
    player.flown.by_hand |= !autopilot;
}

/// The player's commands in this step.
fn read_commands(
    input: PlayerInput,
    clock: Res<Clock>,
    (session, slowing): (Res<Session>, Res<Slowing>),
    (mut player, mut turn, mut steady): (ResMut<PlayerState>, ResMut<MouseTurn>, Local<Stick>),
    mut commands: ResMut<PlayerCommands>,
    targets: Targets,
    ships: Query<(Entity, &ShipMotion, &Engine, &Turning), With<Player>>,
) {
    *steady = steadied(&steady, &input.stick());
    let (mut stick, mut facing, pace) = (*steady, false, session.config.clock.pace * slowing.0);
    for (ship, motion, engine, turning) in &ships {
        facing |= player.facing && targets.known(ship, &motion.0, clock.time).is_some();
        if facing {
            // Whoever asks for the mark does not steer aside.
            turn.take();
        } else {
            stick.turn = turn.pull(stick.turn, engine, turning.0, clock.step / gamma(motion.0.momentum), clock.step / pace);
        }
    }
    *commands = PlayerCommands {
        assist: player.assisted(&session.config),
        matching: player.matching(),
        facing,
        autopilot: player.autopilot,
        looking: player.looking,
        fire: std::mem::take(&mut player.fired) || input.holds(Action::Fire),
        pace: stepped(pace),
        ..PlayerCommands::holding(&stick)
    };
}

/// The pace, to four bits behind the first: what changes in each step would make a long replay, and a turn that is 3 % faster is not felt.
fn stepped(pace: f64) -> f64 {
    const REST: u32 = 52 - 4;
    f64::from_bits((pace.to_bits() + (1 << (REST - 1))) >> REST << REST)
}

#[cfg(test)]
pub(in crate::play) mod tests {
    use super::*;
    use crate::play::input::tests::press_key;
    use crate::play::overlay::live::LivePlugin;
    use crate::sim::assist::AssistMode;
    use crate::sim::intercept::Way;
    use crate::sim::{Outcome, SimulationPlugins};
    use bevy::input::{ButtonState, InputPlugin};
    use bevy::state::app::StatesPlugin;
    use bevy::time::TimeUpdateStrategy;
    use std::time::Duration;

    /// The game before its first frame, each of which takes this long.
    pub fn game_of(frame: Duration) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, StatesPlugin, InputPlugin, SimulationPlugins, GamePlugin, LivePlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .insert_resource(Session::load(None, Some("chase"), Some(1)).expect("the game's own files"))
            .init_resource::<PlayerState>();
        app
    }

    /// The game at the title, 0.1 s a frame.
    fn game() -> App {
        let mut app = game_of(Duration::from_millis(100));
        app.update();
        app.update();
        app
    }

    /// The same in play.
    fn playing() -> App {
        let mut app = game();
        push(&mut app, KeyCode::Enter);
        app
    }

    fn push(app: &mut App, key: KeyCode) {
        press_key(app, key, ButtonState::Pressed);
        app.update();
        press_key(app, key, ButtonState::Released);
        // The frame after the one that reads the key is the first on the new screen.
        app.update();
    }

    fn screen(app: &App) -> Screen {
        *app.world().resource::<State<Screen>>().get()
    }

    fn time(app: &App) -> f64 {
        app.world().resource::<Clock>().time
    }

    #[test]
    fn title_play_pause_and_back() {
        let mut app = game();
        assert_eq!(screen(&app), Screen::Title);
        push(&mut app, KeyCode::Enter);
        assert_eq!(screen(&app), Screen::Playing);
        app.update();
        let before = time(&app);
        (0..5).for_each(|_| app.update());
        // Slowly, before the first input.
        assert!(time(&app) > before + 0.1, "{} {before}", time(&app));
        push(&mut app, KeyCode::Escape);
        assert_eq!(screen(&app), Screen::Paused);
        let before = time(&app);
        (0..5).for_each(|_| app.update());
        assert_eq!(time(&app), before, "time stands still");
        push(&mut app, KeyCode::Escape);
        assert_eq!(screen(&app), Screen::Playing);
    }

    #[test]
    fn restart_is_at_the_beginning() {
        let mut app = playing();
        (0..20).for_each(|_| app.update());
        let late = time(&app);
        push(&mut app, KeyCode::KeyR);
        assert!(time(&app) < 0.5 * late, "{} {late}", time(&app));
        assert_eq!(screen(&app), Screen::Playing);
    }

    fn assist(app: &App) -> AssistMode {
        app.world().resource::<PlayerState>().assisted(&app.world().resource::<Session>().config)
    }

    /// What the key has chosen holds for this chase, and the file's word when it changes.
    #[test]
    fn a_new_chase_has_the_configured_assist() {
        let mut app = playing();
        let modes = [(); 3].map(|()| {
            push(&mut app, KeyCode::KeyZ);
            assist(&app)
        });
        assert_eq!(modes, [AssistMode::Target, AssistMode::Off, AssistMode::Orbit]);
        push(&mut app, KeyCode::KeyZ);
        push(&mut app, KeyCode::KeyR);
        assert_eq!(assist(&app), AssistMode::Orbit, "as configured");
        app.world_mut().resource_mut::<Session>().config.assist.enabled = false;
        app.update();
        push(&mut app, KeyCode::KeyZ);
        assert_eq!(assist(&app), AssistMode::Orbit, "switched on where off is configured");
        app.world_mut().resource_mut::<Session>().config.assist.enabled = true;
        app.update();
        assert!(app.world().resource::<PlayerState>().assist.is_none(), "a changed configuration goes before the key");
    }

    /// Held, the key matches the target's motion, and chooses nothing.
    #[test]
    fn the_held_key_of_the_assist_matches() {
        let mut app = playing();
        let matching = |app: &App| app.world().resource::<PlayerCommands>().matching;
        press_key(&mut app, KeyCode::KeyZ, ButtonState::Pressed);
        app.update();
        assert!(!matching(&app));
        (0..4).for_each(|_| app.update());
        assert!(matching(&app));
        press_key(&mut app, KeyCode::KeyZ, ButtonState::Released);
        (0..2).for_each(|_| app.update());
        assert!(!matching(&app));
        assert_eq!(assist(&app), AssistMode::Orbit);
    }

    /// Held, the key turns the nose to where thrust leads to the target; the log keeps that it does, not each turn.
    #[test]
    fn the_key_of_the_mark_turns_the_nose_to_it() {
        let mut app = playing();
        press_key(&mut app, KeyCode::KeyF, ButtonState::Pressed);
        (0..60).for_each(|_| app.update());
        let commands = *app.world().resource::<PlayerCommands>();
        assert!(commands.facing && commands.turn == [0; 3]);
        let on_mark = |targets: Targets, clock: Res<Clock>, ships: Query<(Entity, &ShipMotion, &Engine), With<Player>>| {
            let (ship, motion, engine) = ships.single().expect("one player");
            targets.mark((ship, &mut Way::default()), &motion.0, clock.time, engine.max_thrust)
        };
        let (mark, serves) = app.world_mut().run_system_cached(on_mark).expect("all resources are there").expect("a target");
        assert!(serves == AssistMode::Off && mark.angle_between(glam::DVec3::NEG_Z) < 0.15, "{mark}");
        assert_eq!(commands.turned_to(mark, serves).assist, AssistMode::Off);
        press_key(&mut app, KeyCode::KeyF, ButtonState::Released);
        (0..2).for_each(|_| app.update());
        assert!(!app.world().resource::<PlayerCommands>().facing);
    }

    /// The key and the menu begin as before, another start is another one.
    #[test]
    fn the_same_start_is_the_same() {
        let mut app = playing();
        app.world_mut().resource_mut::<Session>().seed_stays = false;
        let (catalogue, _) = Catalogue::read(app.world().resource::<Session>().scene.clone());
        // The last is free flight, in the scene that is flown already.
        app.world_mut().resource_mut::<PlayerState>().choice = catalogue.missions.len();
        app.insert_resource(catalogue);
        let seed = |app: &App| app.world().resource::<Session>().seed;
        let first = seed(&app);
        push(&mut app, KeyCode::KeyR);
        assert_eq!(seed(&app), first);
        app.world_mut().write_message(MenuAction::Start);
        app.update();
        assert_eq!(seed(&app), first + 1);
    }

    #[test]
    fn one_looks_at_the_target_while_the_key_is_held() {
        let mut app = playing();
        let looking = |app: &App| app.world().resource::<PlayerState>().looking;
        assert!(!looking(&app));
        press_key(&mut app, KeyCode::KeyV, ButtonState::Pressed);
        for _ in 0..3 {
            app.update();
            assert!(looking(&app));
        }
        press_key(&mut app, KeyCode::KeyV, ButtonState::Released);
        app.update();
        assert!(!looking(&app));
    }

    /// The hint of the first flight stays until one of its keys is used in play, and does not come again.
    #[test]
    fn the_first_flight_begins_with_a_key() {
        let mut app = game();
        let begun = |app: &App| app.world().resource::<PlayerState>().begun;
        push(&mut app, KeyCode::KeyW);
        assert!(!begun(&app), "on the title nothing is flown");
        push(&mut app, KeyCode::Enter);
        push(&mut app, KeyCode::KeyC);
        assert!(!begun(&app), "the camera is no part of it");
        push(&mut app, KeyCode::KeyV);
        assert!(begun(&app));
        push(&mut app, KeyCode::KeyR);
        assert!(begun(&app));
    }

    #[test]
    fn a_decided_chase_shows_its_result() {
        let mut app = playing();
        app.world_mut().resource_mut::<Chase>().outcome = Some((Outcome::Caught, 1.0));
        app.update();
        app.update();
        assert_eq!(screen(&app), Screen::Result);
        push(&mut app, KeyCode::Enter);
        assert_eq!(screen(&app), Screen::Playing);
    }

    #[test]
    fn keys_thrust_by_hand_and_not_under_autopilot() {
        let mut app = playing();
        let thrust = |app: &mut App| {
            let mut ships = app.world_mut().query_filtered::<&crate::sim::Controls, With<Player>>();
            ships.single(app.world()).expect("one player").0.thrust
        };
        press_key(&mut app, KeyCode::KeyW, ButtonState::Pressed);
        app.update();
        assert!(thrust(&mut app).z < -0.01, "{}", thrust(&mut app));
        press_key(&mut app, KeyCode::KeyW, ButtonState::Released);
        push(&mut app, KeyCode::KeyP);
        assert!(app.world().resource::<PlayerState>().autopilot);
        let mut manual = app.world_mut().query_filtered::<(), With<crate::sim::Manual>>();
        assert_eq!(manual.iter(app.world()).count(), 0);
    }

    #[test]
    fn who_flew_is_kept_for_the_chase() {
        let mut app = game();
        let flown = |app: &App| app.world().resource::<PlayerState>().flown;
        push(&mut app, KeyCode::Enter);
        app.update();
        assert_eq!(flown(&app), Flown { by_hand: true, by_autopilot: false });
        push(&mut app, KeyCode::KeyP);
        app.update();
        assert_eq!(flown(&app), Flown { by_hand: true, by_autopilot: true });
        push(&mut app, KeyCode::KeyR);
        app.update();
        assert_eq!(flown(&app), Flown { by_hand: true, by_autopilot: false });
    }

    #[test]
    fn nothing_moves_after_the_end() {
        let mut app = playing();
        app.update();
        app.world_mut().resource_mut::<Chase>().outcome = Some((Outcome::Caught, 1.0));
        let before = time(&app);
        (0..5).for_each(|_| app.update());
        assert_eq!(time(&app), before);
    }

    #[test]
    fn pace_is_doubled_and_halved() {
        let mut app = playing();
        let pace = app.world().resource::<Session>().config.clock.pace;
        push(&mut app, KeyCode::Period);
        assert_eq!(app.world().resource::<Session>().config.clock.pace, 2.0 * pace);
        push(&mut app, KeyCode::Comma);
        assert_eq!(app.world().resource::<Session>().config.clock.pace, pace);
    }

    /// A good change of `game.toml` is taken up while the game runs; a wrong one is said with its line, and the last good values stay.
    #[test]
    fn the_file_is_read_again_and_a_wrong_one_refused() {
        use crate::play::hud::notice::Notice;
        use std::time::SystemTime;
        let file = std::env::temp_dir().join(format!("lensrunner-reload-{}.toml", std::process::id()));
        let write = |text: &str, age: u64| {
            std::fs::write(&file, text).expect("a temporary file");
            let open = std::fs::File::options().write(true).open(&file).expect("the same file");
            open.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(age)).expect("a time");
        };
        write("[ship]\nthrust = 0.05\n", 1000);
        let mut app = game();
        app.world_mut().resource_mut::<Session>().config_file = Some(file.clone());
        let wait = |app: &mut App| {
            (0..12).for_each(|_| app.update());
            (app.world().resource::<Session>().config.ship.thrust, app.world().resource::<Notice>().text.clone())
        };
        wait(&mut app);
        // The pace that the player chose stays.
        push(&mut app, KeyCode::Period);
        let pace = |app: &App| app.world().resource::<Session>().config.clock.pace;
        let chosen = pace(&app);
        write("[ship]\nthrust = 0.07\n", 2000);
        assert_eq!((wait(&mut app).0, pace(&app)), (0.07, chosen));
        write("[ship]\nthrust = 0.07\n[clock]\npace = 0.7\n", 2500);
        wait(&mut app);
        assert_eq!(pace(&app), 0.7);
        write("[ship]\nthrust = -3\n", 3000);
        let (thrust, said) = wait(&mut app);
        std::fs::remove_file(&file).expect("the same file");
        assert_eq!((thrust, pace(&app)), (0.07, 0.7));
        for word in ["lensrunner-reload", "2", "thrust", "10"] {
            assert!(said.contains(word), "`{said}` does not name {word}");
        }
    }
}
