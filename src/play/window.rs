//! The game in a window: the Bevy app, its schedules, and the systems that join the simulation to the picture.

use std::time::Duration;

use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy::window::{CursorGrabMode, CursorOptions, MonitorSelection, PresentMode, PrimaryWindow, WindowMode};
use bevy_egui::input::EguiWantsInput;
use bevy_egui::{EguiPlugin, EguiPrimaryContextPass};

use crate::render::plugin::{FrameToDraw, RelativisticRenderPlugin, SharedRenderer};
use crate::render::shot::surroundings;
use crate::render::stage::{Stage, settings};
use crate::scene::ship::Ai;
use crate::sim::assist::{AssistSettings, Reference, assisted, direct};
use crate::sim::ship::Player;
use crate::sim::{Clock, Controls, Engine, Fleet, Fuel, History, Manual, ShipMotion, SimSet, SimulationPlugins, outcome, set_manual, start};
use crate::spacetime::light::Order;
use crate::spacetime::matter::gamma;

use super::camera::{Follower, View, on_ship, state_of};
use super::input::{Bindings, Hands, MouseTurn};
use super::instruments::Instruments;
use super::live::LivePlugin;
use super::screens::{Screen, Wish, answer};
use super::seen::{Apparition, apparition, true_direction};
use super::session::Session;
use super::{hud, menu, overlay, record};

/// How the player plays: what is not in `game.toml`.
#[derive(Resource, Clone, Debug, Default)]
pub struct Player1 {
    /// The autopilot flies.
    pub autopilot: bool,
    /// From where one looks.
    pub view: View,
    /// The HUD is off.
    pub bare: bool,
    /// The dev overlay is on.
    pub overlay: bool,
    /// The assist has taken the thrust to keep off the hole.
    pub avoiding: bool,
    /// The autopilot was asked for on the command line.
    pub always_autopilot: bool,
    follower: Follower,
}

/// The scene's models on the renderer.
#[derive(Resource, Debug)]
pub struct Staged(pub Stage);

/// What the HUD shows of this frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct Panel {
    /// The dials.
    pub instruments: Option<Instruments>,
    /// The target's images of orders 1 and 2.
    pub images: [Option<Apparition>; 2],
    /// Where the target is at the same T, in camera axes.
    pub truth: Option<glam::DVec3>,
    /// Where one flies to, against the hovering observers, in camera axes.
    pub heading: Option<glam::DVec3>,
    /// Where the hole is, and the angle of its shadow's edge.
    pub field_of_view: f64,
}

/// What the command line asked for beyond the session.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The autopilot flies from the start.
    pub autopilot: bool,
    /// Size of the window, in pixels.
    pub size: Option<[u32; 2]>,
    /// Closes after so many frames.
    pub frames: Option<u32>,
    /// Writes every frame here.
    pub record: Option<std::path::PathBuf>,
}

/// Opens the window and plays until it closes.
pub fn run(session: Session, options: &Options) -> AppExit {
    let video = &session.config.video;
    let [width, height] = options.size.unwrap_or([video.width, video.height]);
    let window = Window {
        title: "Lensrunner".into(),
        resolution: (width, height).into(),
        present_mode: if video.vsync { PresentMode::AutoVsync } else { PresentMode::AutoNoVsync },
        mode: if video.fullscreen { WindowMode::BorderlessFullscreen(MonitorSelection::Primary) } else { WindowMode::Windowed },
        ..default()
    };
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .set(WindowPlugin { primary_window: Some(window), ..default() })
            .set(bevy::log::LogPlugin { filter: "warn,wgpu_hal=error,bevy_egui=error".into(), level: bevy::log::Level::WARN, ..default() }),
    )
    .add_plugins(EguiPlugin::default())
    .add_plugins(RelativisticRenderPlugin { surroundings: surroundings() })
    .add_plugins((SimulationPlugins, GamePlugin, LivePlugin, record::RecordPlugin { folder: options.record.clone(), frames: options.frames }))
    .insert_resource(ClearColor(Color::BLACK))
    .insert_resource(Player1 { always_autopilot: options.autopilot, ..default() })
    .insert_resource(session)
    .add_systems(Startup, (stage_scene, spawn_camera, begin_title).chain())
    .add_systems(Update, (grab_cursor, make_frame).chain().after(GameSet::Answer))
    .add_systems(EguiPrimaryContextPass, (hud::draw, menu::draw, overlay::draw).chain());
    app.run()
}

/// The order of what the game does in a frame.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GameSet {
    /// Keys are read.
    Keys,
    /// Wishes are answered: screens change, chases begin.
    Answer,
}

/// Screens, input and time: all of the game that needs no window. Needs [`SimulationPlugins`], [`Session`] and [`Player1`].
pub struct GamePlugin;

impl Plugin for GamePlugin {
    fn build(&self, app: &mut App) {
        app.init_state::<Screen>()
            .add_message::<Wish>()
            .init_resource::<Bindings>()
            .init_resource::<MouseTurn>()
            .init_resource::<Panel>()
            .configure_sets(Update, (GameSet::Keys, GameSet::Answer).chain())
            .add_systems(Update, (read_keys.in_set(GameSet::Keys), (answer_wishes, end_chase, run_time).chain().in_set(GameSet::Answer)))
            .add_systems(FixedUpdate, fly_by_hand.in_set(SimSet::Input));
    }
}

fn stage_scene(world: &mut World) {
    let Some(renderer) = world.get_resource::<SharedRenderer>().cloned() else { return };
    let session = world.resource::<Session>();
    let stage = Stage::new(&mut renderer.lock(), &session.scene, &session.config);
    world.insert_resource(Staged(stage));
}

fn spawn_camera(mut commands: Commands) {
    // The renderer fills the picture itself, tone curve included.
    commands.spawn((Camera2d, Msaa::Off, Tonemapping::None, DebandDither::Disabled));
}

fn begin_title(world: &mut World) {
    begin(world, Screen::Title);
}

/// Starts the chase anew for a screen: by hand in play, unless the autopilot was asked for.
fn begin(world: &mut World, screen: Screen) {
    let session = world.resource::<Session>().clone();
    start(world, &session.scene, &session.config, session.seed);
    let ship = world.resource::<Fleet>().0[session.player()];
    world.entity_mut(ship).insert(Player);
    let mut player = world.resource_mut::<Player1>();
    player.autopilot = screen != Screen::Playing || player.always_autopilot;
    player.follower.reset();
    player.avoiding = false;
    let manual = !player.autopilot;
    set_manual(world, manual);
    *world.resource_mut::<MouseTurn>() = MouseTurn::default();
}

/// Keys that switch something.
#[allow(clippy::too_many_arguments)]
fn read_keys(
    bindings: Res<Bindings>,
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    typing: Option<Res<EguiWantsInput>>,
    screen: Res<State<Screen>>,
    mut session: ResMut<Session>,
    mut player: ResMut<Player1>,
    mut wishes: MessageWriter<Wish>,
    mut commands: Commands,
) {
    let hands = Hands { bindings: &bindings, keys: &keys, mouse: &buttons };
    if hands.pushed("toggle_overlay") {
        player.overlay = !player.overlay;
    }
    if hands.pushed("screenshot") {
        commands.queue(record::screenshot);
    }
    if typing.is_some_and(|typing| typing.wants_keyboard_input()) {
        return;
    }
    let enter = keys.just_pressed(KeyCode::Enter) || keys.just_pressed(KeyCode::NumpadEnter);
    match screen.get() {
        Screen::Title if enter => _ = wishes.write(Wish::Start),
        Screen::Result if enter => _ = wishes.write(Wish::Start),
        Screen::Paused if enter => _ = wishes.write(Wish::Pause),
        _ => (),
    }
    if hands.pushed("pause") {
        wishes.write(if *screen.get() == Screen::Result { Wish::Title } else { Wish::Pause });
    }
    if hands.pushed("restart") && *screen.get() != Screen::Title {
        wishes.write(Wish::Start);
    }
    if hands.pushed("toggle_camera") {
        player.view = player.view.toggled();
        player.follower.reset();
    }
    if hands.pushed("toggle_hud") {
        player.bare = !player.bare;
    }
    if hands.pushed("toggle_assist") {
        session.config.assist.enabled = !session.config.assist.enabled;
    }
    if hands.pushed("toggle_autopilot") && *screen.get() == Screen::Playing {
        player.autopilot = !player.autopilot;
        let manual = !player.autopilot;
        commands.queue(move |world: &mut World| set_manual(world, manual));
    }
    let faster = f64::from(i8::from(hands.pushed("faster")) - i8::from(hands.pushed("slower")));
    if faster != 0.0 {
        let pace = session.config.clock.pace * faster.exp2();
        session.config.clock.pace = pace.clamp(0.05, 24.0);
    }
}

fn answer_wishes(world: &mut World) {
    let wishes: Vec<Wish> = world.resource_mut::<Messages<Wish>>().drain().collect();
    for wish in wishes {
        if wish == Wish::Quit {
            world.write_message(AppExit::Success);
        }
        let screen = *world.resource::<State<Screen>>().get();
        if let Some((next, anew)) = answer(screen, wish) {
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

/// Game time: its pace, its step, and whether it passes.
fn run_time(screen: Res<State<Screen>>, next: Res<NextState<Screen>>, session: Res<Session>, mut time: ResMut<Time<Virtual>>, mut fixed: ResMut<Time<Fixed>>) {
    let clock = &session.config.clock;
    let step = clock.step / clock.pace;
    fixed.set_timestep_seconds(step);
    time.set_max_delta(Duration::from_secs_f64((step * f64::from(clock.max_steps)).clamp(0.01, 0.5)));
    let leaving = matches!(*next, NextState::Pending(next) if !next.runs());
    if screen.get().runs() && !leaving { time.unpause() } else { time.pause() }
}

/// The player's hands become the ship's controls.
#[allow(clippy::too_many_arguments)]
fn fly_by_hand(
    bindings: Res<Bindings>,
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    clock: Res<Clock>,
    session: Res<Session>,
    mut turn: ResMut<MouseTurn>,
    mut player: ResMut<Player1>,
    mut ships: Query<(&ShipMotion, &Engine, &mut Controls), (With<Player>, With<Manual>)>,
) {
    for (motion, engine, mut controls) in &mut ships {
        let mut stick = Hands { bindings: &bindings, keys: &keys, mouse: &buttons }.stick();
        let proper_step = clock.step / gamma(motion.0.momentum);
        let mouse = turn.pull(engine.max_rate * proper_step);
        stick.turn += glam::DVec3::new(mouse.x, mouse.y, 0.0);
        let config = &session.config;
        player.avoiding = false;
        controls.0 = if config.assist.enabled {
            let help = assisted(&motion.0, &stick, engine, Reference::Orbit, &AssistSettings::from(config));
            player.avoiding = help.avoiding;
            help.command
        } else {
            direct(&stick, engine)
        };
    }
}

/// In play the mouse belongs to the ship.
fn grab_cursor(
    screen: Res<State<Screen>>,
    player: Res<Player1>,
    motion: Res<AccumulatedMouseMotion>,
    session: Res<Session>,
    mut turn: ResMut<MouseTurn>,
    mut cursors: Query<&mut CursorOptions, With<PrimaryWindow>>,
) {
    let grabbed = *screen.get() == Screen::Playing && !player.overlay && !player.autopilot;
    for mut cursor in &mut cursors {
        if cursor.visible == grabbed {
            cursor.visible = !grabbed;
            cursor.grab_mode = if grabbed { CursorGrabMode::Locked } else { CursorGrabMode::None };
        }
    }
    if grabbed {
        turn.push(motion.delta, &session.config);
    }
}

/// The ship's length, in r_s.
fn length(session: &Session, ship: usize) -> f64 {
    if session.scene.ships[ship].ai == Ai::Flee { session.config.enemy.size } else { session.config.ship.size }
}

/// The frame to draw and the HUD's numbers, between the last two steps of the simulation.
#[allow(clippy::too_many_arguments)]
fn make_frame(
    session: Res<Session>,
    staged: Option<Res<Staged>>,
    clock: Res<Clock>,
    fixed: Res<Time<Fixed>>,
    real: Res<Time<Real>>,
    fleet: Res<Fleet>,
    ships: Query<(&History, &Engine, &Controls, &Fuel)>,
    windows: Query<&Window, With<PrimaryWindow>>,
    mut player: ResMut<Player1>,
    mut frame: ResMut<FrameToDraw>,
    mut panel: ResMut<Panel>,
) {
    // Nothing is drawn into a window without a size.
    let width = windows.iter().map(Window::physical_width).max().unwrap_or(0);
    let Some(staged) = staged.filter(|_| width > 0) else { return };
    let all: Vec<_> = fleet.0.iter().filter_map(|&ship| ships.get(ship).ok()).collect();
    let histories: Vec<&History> = all.iter().map(|ship| ship.0).collect();
    let me = session.player();
    let Some(&(history, engine, controls, fuel)) = all.get(me) else { return };
    let config = &session.config;
    let time = (clock.time - clock.step * (1.0 - fixed.overstep_fraction_f64())).max(0.0);
    let state = state_of(&history.at(time));
    let seconds = real.delta_secs_f64();
    let cockpit = player.view == View::Cockpit;
    let rigid = cockpit || config.video.reduced_motion;
    let attitude = player.follower.follow(state.attitude, seconds, rigid);
    let field_of_view = config.video.fov.to_radians();
    let camera = on_ship(&state, player.view, attitude, length(&session, me), field_of_view);

    let mut settings = settings(config);
    let first = frame.0.is_none();
    settings.adaptation = if first { 1.0 } else { (1.0 - (-config.render.exposure_speed * seconds).exp2()) as f32 };
    frame.0 = Some(staged.0.frame(camera, width, time, &histories, cockpit.then_some(me), &settings));

    let target = session.target().and_then(|target| histories.get(target));
    let there = target.map(|history| state_of(&history.at(time)));
    let thrust = engine.limit(&controls.0).thrust.length();
    let resting = crate::spacetime::orbit::static_momentum(state.position).unwrap_or_default();
    let moving = -crate::spacetime::frames::relative_momentum(state.momentum, resting);
    *panel = Panel {
        instruments: Some(Instruments::read(&state, time, camera.radius(), thrust, (fuel.left, fuel.capacity), there.as_ref())),
        images: [0, 1].map(|order| target.and_then(|history| apparition(&camera, time, history, Order::ALL[order]))),
        truth: there.and_then(|there| true_direction(&camera, there.position)),
        heading: (moving.length() > 0.01).then(|| camera.attitude.conjugate() * moving.normalize()),
        field_of_view,
    };
}
