//! The game in a window: the Bevy app and its plugins, one for each feature.

pub mod interface;
pub mod record;

use std::sync::Arc;

use bevy::prelude::*;
use bevy::window::{MonitorSelection, PresentMode, WindowMode};
use bevy_egui::EguiPlugin;

use crate::play::game::GamePlugin;
use crate::play::hud::HudPlugin;
use crate::play::menus::MenusPlugin;
use crate::play::overlay::OverlayPlugin;
use crate::play::picture::PicturePlugin;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::render::plugin::RelativisticRenderPlugin;
use crate::render::shot::surroundings;
use crate::sim::SimulationPlugins;
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
    .add_plugins((EguiPlugin::default(), RelativisticRenderPlugin { surroundings: Arc::new(surroundings()) }))
    .add_plugins((SimulationPlugins, GamePlugin, PicturePlugin, HudPlugin, MenusPlugin, OverlayPlugin, InterfacePlugin))
    .add_plugins(record::RecordPlugin { folder: options.record.clone(), frames: options.frames })
    .insert_resource(PlayerState { always_autopilot: options.autopilot, ..default() })
    .insert_resource(session);
    app.run()
}
