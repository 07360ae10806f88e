//! The game in a window: the Bevy app and its plugins, one for each feature.

pub mod focus;
pub mod interface;
pub mod lost;
#[cfg(target_family = "wasm")]
mod page;
pub mod pictures;
pub mod points;
pub mod record;
pub mod timings;

use std::io::IsTerminal as _;
use web_time::Instant;

use bevy::core_pipeline::CorePipelinePlugin;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::tasks::block_on;
use bevy::window::WindowMode;
use bevy::winit::WinitPlugin;
use bevy_egui::EguiPlugin;

use crate::breath::breath;
use crate::play::choices::Choices;
use crate::play::coach::CoachPlugin;
use crate::play::game::{GamePlugin, begin};
use crate::play::hud::HudPlugin;
use crate::play::hud::notice::Notice;
use crate::play::menus::MenusPlugin;
use crate::play::menus::navigate::FileConfig;
use crate::play::menus::screens::Screen;
use crate::play::missions::{Catalogue, MissionsPlugin, Watched};
use crate::play::overlay::OverlayPlugin;
use crate::play::picture::PicturePlugin;
use crate::play::picture::quality::Quality;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::{SCENE, Session};
use crate::play::sound::plugin::SoundPlugin;
use crate::render::plugin::RelativisticRenderPlugin;
use crate::render::shot::surroundings;
use crate::scene::{self, pilot_kind::PilotKind};
use crate::sim::SimulationPlugins;
use crate::sim::replay::Replay;
use interface::{InterfacePlugin, mode, present_mode};

/// What the command line asked for beyond the session.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Who flies from the start instead of the player.
    pub pilot: Option<PilotKind>,
    /// Size of the window, in pixels.
    pub size: Option<[u32; 2]>,
    /// Closes after so many frames.
    pub frames: Option<u32>,
    /// Writes every frame here.
    pub record: Option<std::path::PathBuf>,
    /// Shows this flight instead of the title.
    pub replay: Option<Replay>,
    /// Flies at once, without the title.
    pub at_once: bool,
    /// Where the best flights are kept; None: in the user's data folder.
    pub data: Option<std::path::PathBuf>,
    /// A link was opened that shows no flight: this is said as the game begins.
    pub refused_link: bool,
    /// Says in the terminal how much is drawn, and why.
    pub verbose: bool,
    /// Writes the time of each frame here, counted from then.
    pub timings: Option<(std::path::PathBuf, Instant)>,
}

/// What the game is drawn on.
#[derive(Clone, Debug)]
pub enum OutputSurface {
    /// A window.
    Window,
    /// A picture of this size in pixels, for whoever looks at it without a display.
    Picture([u32; 2]),
}

/// Opens the window and plays until it closes.
pub fn run(session: Session, options: &Options) -> AppExit {
    block_on(prepared(session, options)).run()
}

/// The game, ready to run in a window.
pub async fn prepared(session: Session, options: &Options) -> App {
    let (choices, said) = Choices::load();
    let mut app = app_in_steps(session, options, OutputSurface::Window, choices).await;
    let refused = options.refused_link.then(|| app.world().resource::<Session>().language().say("share-refused"));
    if let Some(text) = said.or(refused) {
        // A page shows the title after ten seconds.
        app.insert_resource(Notice { text, until: 25.0, share: None });
    }
    app
}

/// Plays without a display, on a picture that nobody sees, until the frames are drawn: to measure.
pub fn run_unseen(session: Session, options: &Options, size: [u32; 2]) -> AppExit {
    let mut app = app(session, options, OutputSurface::Picture(size), Choices::default());
    app.finish();
    app.cleanup();
    loop {
        app.update();
        if let Some(exit) = app.should_exit() {
            return exit;
        }
    }
}

/// The whole game, drawn on `surface`, with these choices over the session's configuration.
pub fn app(session: Session, options: &Options, surface: OutputSurface, choices: Choices) -> App {
    block_on(app_in_steps(session, options, surface, choices))
}

async fn app_in_steps(mut session: Session, options: &Options, surface: OutputSurface, choices: Choices) -> App {
    let file_config = session.config.clone();
    choices.over(&mut session.config);
    session.put_set();
    let (catalogue, choice) = catalogue(&session, options.at_once);
    // What a program films is nobody's first start.
    let warns = !session.config.interface.warned && options.frames.is_none();
    let mut app = App::new();
    let log = LogPlugin {
        // What libraries warn of means nothing to a player; RUST_LOG shows it. A device or a window that is lost is said by `lost`.
        filter: "error,bevy_render::error_handler=off,bevy_render::view::window=off,lensrunner=".to_owned()
            + match options.verbose {
                true => "debug",
                // A page says on the screen what there is to say.
                false if cfg!(target_family = "wasm") => "warn",
                false => "info",
            },
        level: bevy::log::Level::WARN,
        // As `warn_on_stderr` has it.
        fmt_layer: |_| {
            let layer = bevy::log::tracing_subscriber::fmt::Layer::default().without_time().with_target(false);
            Some(Box::new(layer.with_ansi(std::io::stderr().is_terminal()).with_writer(std::io::stderr)))
        },
        ..default()
    };
    // Pictures that nobody waits for are drawn at their finest.
    let governed = matches!(surface, OutputSurface::Window) || options.timings.is_some();
    let window = WindowPlugin { primary_window: Some(window(&session, options, &surface)), ..default() };
    // Apart: it takes as long as all the others.
    let plugins = DefaultPlugins.build().disable::<CorePipelinePlugin>().set(window);
    match surface {
        OutputSurface::Window => app.add_plugins(plugins.set(log)),
        OutputSurface::Picture(_) => app.add_plugins(plugins.disable::<WinitPlugin>().disable::<LogPlugin>()),
    };
    breath().await;
    app.add_plugins(CorePipelinePlugin);
    breath().await;
    app.add_plugins((EguiPlugin::default(), RelativisticRenderPlugin { surroundings }))
        .add_plugins((
            SimulationPlugins,
            GamePlugin,
            MissionsPlugin { folder: options.data.clone() },
            PicturePlugin,
            HudPlugin,
            CoachPlugin,
            MenusPlugin,
            OverlayPlugin,
            InterfacePlugin { picture: if let OutputSurface::Picture(size) = surface { Some(size) } else { None } },
            SoundPlugin,
            focus::FocusPlugin,
            lost::LostDevicePlugin,
        ))
        .add_plugins(record::RecordPlugin { folder: options.record.clone(), frames: options.frames })
        .insert_resource(Quality::new(governed))
        .insert_resource(PlayerState { pilot: options.pilot, choice, ..default() })
        .insert_resource(catalogue)
        .insert_resource(choices)
        .insert_resource(FileConfig(file_config))
        .insert_resource(session);
    #[cfg(target_family = "wasm")]
    app.add_plugins(page::PagePlugin);
    if let Some((file, started)) = &options.timings {
        let waits = matches!(surface, OutputSurface::Picture(_));
        app.add_plugins(timings::TimingsPlugin { file: file.clone(), started: *started, waits });
    }
    if warns {
        app.insert_state(Screen::Warning);
    }
    if let Some(replay) = &options.replay {
        app.insert_resource(Watched(replay.clone()));
    }
    if options.replay.is_some() || options.at_once {
        app.add_systems(Update, fly_at_once.run_if(not(in_state(Screen::Warning))).before(GameSet::Answer));
    }
    app
}

/// The window as the settings and the command line have it.
fn window(session: &Session, options: &Options, surface: &OutputSurface) -> Window {
    let video = &session.config.video;
    let [width, height] = match surface {
        OutputSurface::Window => options.size.unwrap_or([video.width, video.height]),
        OutputSurface::Picture(size) => *size,
    };
    Window {
        title: "Lensrunner".into(),
        resolution: (width, height).into(),
        present_mode: present_mode(video),
        mode: if matches!(surface, OutputSurface::Window) { mode(video) } else { WindowMode::Windowed },
        // Of a page: the element that is drawn on.
        canvas: Some("#game".into()),
        fit_canvas_to_parent: true,
        // The page does it, and leaves the browser its own keys.
        prevent_default_event_handling: false,
        ..default()
    }
}

/// The missions and scenes to choose from, and the one that is chosen at the start; what of them is wrong is said on the terminal.
fn catalogue(session: &Session, at_once: bool) -> (Catalogue, usize) {
    // Behind the title nothing is to be won.
    let home = if session.scene.mission.is_some() { scene::load(SCENE).unwrap_or(session.scene.clone()) } else { session.scene.clone() };
    let (mut catalogue, wrong) = Catalogue::read(home);
    for words in wrong {
        eprintln!("{words}");
    }
    // A mission of one's own joins the list.
    if session.scene.mission.is_some() && !catalogue.missions.iter().any(|mission| mission.fingerprint == session.scene.fingerprint) {
        catalogue.missions.push(session.scene.clone());
    }
    let chosen = catalogue.missions.iter().position(|mission| mission.fingerprint == session.scene.fingerprint);
    // Another scene that was named is flown freely.
    let freely = if at_once || session.scene.name != SCENE { catalogue.missions.len() } else { 0 };
    (catalogue, chosen.unwrap_or(freely))
}

/// Goes from the title to play, once.
fn fly_at_once(world: &mut World, mut done: Local<bool>) {
    if std::mem::replace(&mut *done, true) {
        return;
    }
    begin(world, Screen::Playing);
    world.resource_mut::<NextState<Screen>>().set(Screen::Playing);
}
