//! The game in a window: the Bevy app, its schedules, and the systems that join the simulation to the picture.

pub mod record;

use crate::play::hud::panel::{Panel, Staged, loaded};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy::window::{CursorGrabMode, CursorOptions, MonitorSelection, PresentMode, PrimaryWindow, WindowMode};
use bevy_egui::{EguiContexts, EguiPlugin, EguiPrimaryContextPass};

use crate::render::plugin::{FrameToDraw, RelativisticRenderPlugin, SharedRenderer};
use crate::render::settings::Settings;
use crate::render::shot::surroundings;
use crate::render::stage::{Stage, settings};
use crate::scene::ship::Ai;
use crate::sim::{Chase, Clock, Controls, Engine, Fleet, Fuel, History, Outcome, SimulationPlugins};
use crate::spacetime::frames::relative_momentum;
use crate::spacetime::light::Order;
use crate::spacetime::orbit::static_momentum;

use crate::play::camera::director::{on_caught, wide};
use crate::play::camera::seen::{apparition, true_direction};
use crate::play::camera::{View, on_ship, state_of};
use crate::play::game::GamePlugin;
use crate::play::hud::instruments::Instruments;
use crate::play::hud::notice::Notice;
use crate::play::input::MouseTurn;
use crate::play::menus::screens::Screen;
use crate::play::overlay::live::LivePlugin;
use crate::play::player_state::{GameSet, PlayerState};
use crate::play::session::Session;
use crate::play::{hud, menus, overlay};

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
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }).set(bevy::log::LogPlugin {
        filter: "warn,lensrunner=info,wgpu_hal=error,bevy_egui=error".into(),
        level: bevy::log::Level::WARN,
        ..default()
    }))
    .add_plugins(EguiPlugin::default())
    .add_plugins(RelativisticRenderPlugin { surroundings: surroundings() })
    .add_plugins((
        SimulationPlugins,
        GamePlugin,
        LivePlugin,
        record::RecordPlugin { folder: options.record.clone(), frames: options.frames },
    ))
    .insert_resource(ClearColor(Color::BLACK))
    .insert_resource(PlayerState { always_autopilot: options.autopilot, ..default() })
    .insert_resource(session)
    .init_resource::<Panel>()
    .add_systems(Startup, spawn_camera)
    .add_systems(Update, stage_scene.run_if(not(loaded)).before(make_frame))
    .add_systems(Update, (fit_interface, welcome, grab_cursor, make_frame).chain().after(GameSet::Answer))
    .add_systems(EguiPrimaryContextPass, (hud::draw, menus::draw, overlay::draw).chain());
    app.run()
}

/// Frames before the scene is loaded: in them the interface comes to the screen, and says that it will be.
const BEFORE: u32 = 4;

fn stage_scene(world: &mut World, mut frames: Local<u32>) {
    *frames += 1;
    if *frames <= BEFORE {
        return;
    }
    let Some(renderer) = world.get_resource::<SharedRenderer>().cloned() else { return };
    let session = world.resource::<Session>();
    let stage = Stage::new(&mut renderer.lock(), &session.scene, &session.config).watched();
    world.insert_resource(Staged(stage));
}

fn spawn_camera(mut commands: Commands) {
    // The renderer fills the picture itself, tone curve included.
    commands.spawn((Camera2d, Msaa::Off, Tonemapping::None, DebandDither::Disabled));
}

/// In a window lower or narrower than this (logical pixels) the interface shrinks with it: the title card is as high.
pub(super) const INTERFACE: [f32; 2] = [900.0, 620.0];

fn fit_interface(windows: Query<&Window, With<PrimaryWindow>>, mut contexts: EguiContexts) {
    let Some(window) = windows.iter().next() else { return };
    let fit = (window.width() / INTERFACE[0]).min(window.height() / INTERFACE[1]).clamp(0.35, 1.0);
    if let Ok(context) = contexts.ctx_mut() {
        context.set_zoom_factor(fit);
    }
}

/// Says the goal when a chase begins, and on the first flight what to begin with: until the player has, or has had time to read it.
fn welcome(
    session: Res<Session>,
    screen: Res<State<Screen>>,
    clock: Res<Clock>,
    real: Res<Time<Real>>,
    mut player: ResMut<PlayerState>,
    mut notice: ResMut<Notice>,
) {
    /// How long the goal is shown after the beginning, in r_s/c of T.
    const SHOWN: f64 = 12.0;
    /// How long the hint is shown, in seconds of wall time in play.
    const HINTED: f64 = 30.0;
    if *screen.get() != Screen::Playing {
        return;
    }
    if !player.begun {
        player.hinted += real.delta_secs_f64();
        player.begun = player.hinted > HINTED;
    }
    let goal = (clock.time < SHOWN || !player.begun).then(|| menus::goal(&session));
    let hint = (!player.begun).then(|| menus::hint(&session));
    let words: Vec<String> = goal.into_iter().chain(hint).collect();
    if !words.is_empty() && notice.until < real.elapsed_secs_f64() {
        *notice = Notice { text: words.join("\n"), until: real.elapsed_secs_f64() + 0.5 };
    }
}

/// In play the mouse belongs to the ship.
fn grab_cursor(
    screen: Res<State<Screen>>,
    player: Res<PlayerState>,
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

/// What the screen shows, whatever the player looked at before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sight {
    /// What the player looks at.
    Own,
    /// All of it from far, by a camera that slowly goes round: on the title, and where the chase is not won. It stands still then, and there may be nothing
    /// ahead of a ship; who has crossed the horizon sees nothing change any more.
    Afar,
    /// The quarry, caught.
    Caught,
}

impl Sight {
    fn of(screen: Screen, outcome: Option<Outcome>) -> Sight {
        match (screen, outcome) {
            (Screen::Title, _) => Sight::Afar,
            (Screen::Result, Some(Outcome::Caught)) => Sight::Caught,
            (Screen::Result, Some(_)) => Sight::Afar,
            _ => Sight::Own,
        }
    }
}

/// Whether the picture at T = `time` has nothing to do with that before, which `last` keeps: what is shown is another thing, or the chase began anew.
fn is_cut(last: &mut Option<(Sight, f64)>, sight: Sight, time: f64) -> bool {
    last.replace((sight, time)).is_none_or(|(before, earlier)| before != sight || time < earlier)
}

/// How fast the title's camera goes round, in rad a second.
const TITLE_TURN: f64 = 0.02;

/// The frame to draw and the HUD's numbers, between the last two steps of the simulation.
#[allow(clippy::too_many_arguments)]
fn make_frame(
    session: Res<Session>,
    (staged, renderer): (Option<Res<Staged>>, Option<Res<SharedRenderer>>),
    clock: Res<Clock>,
    fixed: Res<Time<Fixed>>,
    real: Res<Time<Real>>,
    fleet: Res<Fleet>,
    ships: Query<(&History, &Engine, &Controls, &Fuel)>,
    screen: Res<State<Screen>>,
    windows: Query<&Window, With<PrimaryWindow>>,
    chase: Option<Res<Chase>>,
    mut player: ResMut<PlayerState>,
    mut frame: ResMut<FrameToDraw>,
    mut panel: ResMut<Panel>,
    mut cut: Local<Option<(Sight, f64)>>,
) {
    // A window without area (minimised, say) shows nothing and waits.
    let Some(size) = windows.iter().map(|window| window.physical_size().to_array()).find(|size| size[0] > 0 && size[1] > 0) else { return };
    let Some(staged) = staged else { return };
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
    let sight = Sight::of(*screen.get(), chase.as_ref().and_then(|chase| chase.outcome).map(|(outcome, _)| outcome));
    let named = session.target();
    let target = named.and_then(|target| histories.get(target).copied());
    let size_of_ship = length(&session, me);
    let sought = target.filter(|_| player.looking && sight == Sight::Own);
    let facing = sought.and_then(|target| player.gaze.facing(&state, player.view, size_of_ship, attitude, time, target));
    let attitude = player.gaze.turned(attitude, facing, seconds, config.video.reduced_motion);
    let (camera, hidden, lit) = match (sight, named.zip(target)) {
        (Sight::Own, _) => {
            (on_ship(&state, player.view, attitude, size_of_ship, field_of_view), (player.view == View::Cockpit).then_some(me), Some(me))
        }
        (Sight::Caught, Some((caught, history))) => {
            (on_caught(history, length(&session, caught), state.position, time, field_of_view), None, Some(caught))
        }
        _ => {
            let turn = if config.video.reduced_motion { 0.0 } else { real.elapsed_secs_f64() * TITLE_TURN };
            (wide(state.position, turn, field_of_view), None, None)
        }
    };

    // Times of an earlier frame will do, and so will those of one yet earlier while a frame is being recorded.
    if let Some(mut renderer) = renderer.as_ref().and_then(|renderer| renderer.try_lock()) {
        staged.0.ration_aurora(renderer.timing().latest());
    }
    let mut settings = settings(config);
    if is_cut(&mut cut, sight, clock.time) {
        // Another picture than that before: the exposure is at once what suits it. What was exposed before says nothing of how light a ship should be.
        settings.fill = Settings::default().fill;
    } else {
        settings.adaptation = (1.0 - (-config.render.exposure_speed * seconds).exp2()) as f32;
    }
    settings.own_ship = lit;
    settings.engines = Some([config.ship.thrust, config.enemy.thrust]);
    frame.0 = Some(staged.0.frame(camera, size, time, &histories, hidden, &settings));

    let there = target.map(|history| state_of(&history.at(time)));
    let thrust = engine.limit(&controls.0).thrust.length();
    let resting = static_momentum(state.position).unwrap_or_default();
    let moving = -relative_momentum(state.momentum, resting);
    *panel = Panel {
        instruments: Some(Instruments::read(&state, time, camera.radius(), thrust, (fuel.left, fuel.capacity), there.as_ref())),
        images: [0, 1].map(|order| target.and_then(|history| apparition(&camera, time, history, Order::ALL[order]))),
        truth: there.and_then(|there| true_direction(&camera, there.position)),
        hole: camera.position.try_normalize().map(|out| camera.seen_direction(-out)),
        decided: chase.and_then(|chase| chase.outcome).map(|(_, decided)| history.at(decided).proper_time),
        heading: (moving.length() > 0.01).then(|| camera.attitude.conjugate() * moving.normalize()),
        field_of_view,
        aside: player.gaze.aside(),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_is_a_cut() {
        let mut last = None;
        let cuts = [(Sight::Afar, 3.0), (Sight::Own, 0.0), (Sight::Own, 5.0), (Sight::Own, 5.0), (Sight::Own, 0.1), (Sight::Caught, 0.2)];
        assert_eq!(cuts.map(|(sight, time)| is_cut(&mut last, sight, time)), [true, true, false, false, true, true]);
    }

    #[test]
    fn the_result_shows_what_it_tells_of() {
        assert_eq!(Sight::of(Screen::Title, None), Sight::Afar);
        assert_eq!(Sight::of(Screen::Result, Some(Outcome::Caught)), Sight::Caught);
        for lost in [Outcome::HunterLost, Outcome::QuarryLost, Outcome::TimeOut] {
            assert_eq!(Sight::of(Screen::Result, Some(lost)), Sight::Afar);
        }
        assert_eq!(Sight::of(Screen::Playing, Some(Outcome::HunterLost)), Sight::Own);
        assert_eq!(Sight::of(Screen::Paused, None), Sight::Own);
    }
}
