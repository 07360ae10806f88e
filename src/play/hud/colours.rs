//! The standard colours of words and markers; a [palette](super::palette) may show others.

use bevy_egui::egui::Color32;

/// What is read.
pub const TEXT: Color32 = Color32::from_rgb(222, 232, 240);
/// What explains it.
pub const FAINT: Color32 = Color32::from_rgb(168, 184, 200);
/// The image of the target.
pub const SEEN: Color32 = Color32::from_rgb(96, 220, 255);
/// The target itself.
pub const TRUE: Color32 = Color32::from_rgb(255, 176, 72);
/// One's own motion.
pub const OWN: Color32 = Color32::from_rgb(150, 240, 150);
/// Danger.
pub const ALARM: Color32 = Color32::from_rgb(255, 96, 80);
/// Behind text, so that it stays readable before stars and before the bright disk.
///
/// What shines through is weighed as light, not as the eye sees it: of the white of the disk 1 % is a tenth of the way from black to white.
pub const SHADE: Color32 = Color32::from_rgba_premultiplied(4, 8, 14, 252);
