//! What the HUD and the menus show of the frame that is drawn.

use crate::play::camera::seen::Apparition;
use crate::play::hud::instruments::Instruments;
use crate::render::plugin::SharedRenderer;
use crate::render::stage::Stage;
use bevy::prelude::*;

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
    /// Where the hole is, in camera axes.
    pub hole: Option<glam::DVec3>,
    /// The player's own clock when the chase was decided, in r_s/c.
    pub decided: Option<f64>,
    /// Where one flies to, against the hovering observers, in camera axes.
    pub heading: Option<glam::DVec3>,
    /// The camera's horizontal field of view, in radians.
    pub field_of_view: f64,
    /// The camera has turned from where the ship points.
    pub aside: bool,
}

/// Whether there is nothing more to load.
pub(in crate::play) fn loaded(staged: Option<Res<Staged>>, renderer: Option<Res<SharedRenderer>>) -> bool {
    staged.is_some() || renderer.is_none()
}
