//! How large a point of the interface is.

use bevy::window::Window;

use crate::play::session::Session;

/// In a window lower or narrower than this (logical pixels) the interface shrinks with it: the HUD is laid out for it.
const INTERFACE: [f32; 2] = [900.0, 620.0];

/// How many logical pixels a point of the interface has.
pub fn points_of(window: &Window, session: &Session) -> f32 {
    let fit = (window.width() / INTERFACE[0]).min(window.height() / INTERFACE[1]).clamp(0.35, 1.0);
    fit * session.config.accessibility.text_size as f32
}
