//! The game in a window: the Bevy app and its plugins, one for each feature.

pub mod focus;
pub mod interface;
pub mod record;

use std::sync::Arc;

use bevy::prelude::*;
use bevy::window::{MonitorSelection, PresentMode, WindowMode};
use bevy_egui::EguiPlugin;

use crate::play::game::{GamePlugin, begin};
use crate::play::hud::HudPlugin;
use crate::play::menus::MenusPlugin;
use crate::play::menus::screens::Screen;
use crate::play::missions::{Catalogue, MissionsPlugin, Watched};
use crate::play::overlay::OverlayPlugin;
use crate::play::picture::{PicturePlugin, Staged};
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::{SCENE, Session};
use crate::render::plugin::RelativisticRenderPlugin;
use crate::render::shot::surroundings;
use crate::scene;
use crate::sim::SimulationPlugins;
use crate::sim::replay::Replay;
use interface::InterfacePlugin;

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
    /// Shows this flight instead of the title.
    pub replay: Option<Replay>,
    /// Flies at once, without the title.
    pub at_once: bool,
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
    let freely = if options.at_once || session.scene.name != SCENE { catalogue.missions.len() } else { 0 };
    let choice = chosen.unwrap_or(freely);
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }).set(bevy::log::LogPlugin {
        // What libraries warn of means nothing to a player; RUST_LOG shows it.
        filter: "error,lensrunner=info".into(),
        level: bevy::log::Level::WARN,
        ..default()
    }))
    .add_plugins((EguiPlugin::default(), RelativisticRenderPlugin { surroundings: Arc::new(surroundings()) }))
    .add_plugins((
        SimulationPlugins,
        GamePlugin,
        MissionsPlugin,
        PicturePlugin,
        HudPlugin,
        MenusPlugin,
        OverlayPlugin,
        InterfacePlugin,
        focus::FocusPlugin,
    ))
    .add_plugins(record::RecordPlugin { folder: options.record.clone(), frames: options.frames })
    .insert_resource(PlayerState { always_autopilot: options.autopilot, choice, ..default() })
    .insert_resource(catalogue)
    .insert_resource(session);
    if let Some(replay) = &options.replay {
        app.insert_resource(Watched(replay.clone()));
    }
    if options.replay.is_some() || options.at_once {
        app.add_systems(Update, fly_at_once.run_if(resource_exists::<Staged>).before(GameSet::Answer));
    }
    app.run()
}

/// Goes from the title to play, once.
fn fly_at_once(world: &mut World, mut done: Local<bool>) {
    if std::mem::replace(&mut *done, true) {
        return;
    }
    begin(world, Screen::Playing);
    world.resource_mut::<NextState<Screen>>().set(Screen::Playing);
}
