//! The window's side of the interface: its 2-D camera, its scale, the cursor.

use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy::window::{CursorGrabMode, CursorOptions, PrimaryWindow};
use bevy_egui::EguiContexts;

use crate::play::input::mouse::MouseTurn;
use crate::play::menus::screens::Screen;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::Session;

/// A camera for the picture and the interface, which fits the window; and the mouse in play.
pub struct InterfacePlugin;

impl Plugin for InterfacePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(ClearColor(Color::BLACK))
            .add_systems(Startup, spawn_camera)
            .add_systems(Update, (fit_interface, grab_cursor).in_set(GameSet::Window));
    }
}

fn spawn_camera(mut commands: Commands) {
    // The renderer fills the picture itself, tone curve included.
    commands.spawn((Camera2d, Msaa::Off, Tonemapping::None, DebandDither::Disabled));
}

/// In a window lower or narrower than this (logical pixels) the interface shrinks with it: the title card is as high.
pub(in crate::play) const INTERFACE: [f32; 2] = [900.0, 620.0];

fn fit_interface(windows: Query<&Window, With<PrimaryWindow>>, mut contexts: EguiContexts) {
    let Some(window) = windows.iter().next() else { return };
    let fit = (window.width() / INTERFACE[0]).min(window.height() / INTERFACE[1]).clamp(0.35, 1.0);
    if let Ok(context) = contexts.ctx_mut() {
        context.set_zoom_factor(fit);
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
