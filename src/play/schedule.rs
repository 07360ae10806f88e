//! The order of what the game does in a frame, for all features: what is read, decided, looked at and drawn.
//!
//! `FixedUpdate` is the simulation's ([`SimSet`](crate::sim::SimSet)); `Update` runs [`GameSet`]; egui paints in `EguiPrimaryContextPass`
//! by [`PaintSet`].

use bevy::prelude::*;
use bevy_egui::EguiPrimaryContextPass;

/// What happens in `Update`, in this order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GameSet {
    /// Changes of the configuration take effect.
    Configure,
    /// Keys, mouse and gamepad move the menus.
    Menus,
    /// Keys are read.
    Keys,
    /// Menu actions are answered: screens change, chases begin.
    Answer,
    /// The window follows: cursor, size of the interface, messages.
    Window,
    /// The camera is chosen and the frame made.
    Picture,
    /// The HUD's numbers are read.
    Instruments,
}

/// What egui paints, in this order: later ones lie on earlier ones.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PaintSet {
    /// The HUD.
    Hud,
    /// Menus.
    Menus,
    /// The dev overlay.
    Overlay,
}

/// Puts the sets in order.
pub fn order(app: &mut App) {
    let game =
        (GameSet::Configure, GameSet::Menus, GameSet::Keys, GameSet::Answer, GameSet::Window, GameSet::Picture, GameSet::Instruments);
    app.configure_sets(Update, game.chain())
        .configure_sets(EguiPrimaryContextPass, (PaintSet::Hud, PaintSet::Menus, PaintSet::Overlay).chain());
}
