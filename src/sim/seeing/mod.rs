//! What of the physics is on the screen, and where it can be pointed at: for a camera at one moment, from the same rays in closed form that
//! the picture is projected by.
//!
//! [`pointers`] looks in the directions of a coarse grid and in some that it computes (the ring round the shadow, the images of the disk
//! and of bodies), and for each [`Phenomenon`] takes the place where it is seen best. What gas may stop or a body cover is left out, so
//! that a pointer never lies on anything else. With light that is not bent (`lensing = false`) nothing of this holds.
//!
//! - `kind`: what can be pointed at.
//! - `look`: what is seen in one direction; `screen`, `field`: in many.
//! - `body`: images of bodies, and what they cover.
//! - `hole`, `disk`, `target`: the choice.

mod body;
mod disk;
mod field;
mod hole;
mod kind;
mod look;
mod screen;
mod target;

pub use body::{SeenBody, Track};
pub use hole::enlargement;
pub use kind::{Phenomenon, Pointer};

use crate::scene::disk::Gas;
use crate::spacetime::Observer;
use crate::spacetime::light::Order;
use body::SeenImage;
use field::Field;
use look::Eye;
use screen::CameraScreen;

/// What there is to see besides hole and sky.
#[derive(Clone, Copy, Default)]
pub struct Scenery<'a> {
    /// The gas of the disk.
    pub disk: Option<&'a Gas>,
    /// The ship that the player is after.
    pub target: Option<SeenBody<'a>>,
    /// What else may be before something: the player's own ship, the planet.
    pub others: &'a [SeenBody<'a>],
}

/// What `camera` sees at T = `time` (r_s/c) on a screen whose width is `aspect` times its height, in the order of [`Phenomenon`], each
/// sight at most once. All directions are on the screen.
pub fn pointers(camera: &Observer, time: f64, scenery: &Scenery, aspect: f64) -> Vec<Pointer> {
    let sound = time.is_finite() && camera.field_of_view.is_finite();
    let Some(eye) = Eye::new(camera, scenery.disk).filter(|_| sound) else { return Vec::new() };
    let screen = CameraScreen::new(camera.field_of_view, aspect);
    let images = |body: &SeenBody| [0, 1].map(|k| SeenImage::of(&eye, time, body, Order::ALL[k]));
    let others: Vec<SeenImage> = scenery.others.iter().flat_map(images).flatten().collect();
    let own = scenery.target.as_ref().map_or([None; 2], images);
    let mut found = Vec::new();
    let field = Field::new(eye, screen, others.iter().chain(own.iter().flatten()).copied().collect());
    if let Some(body) = &scenery.target {
        found.extend(target::target(&field, time, body, &own, &others));
    }
    found.extend(hole::shadow(&field));
    found.extend(disk::disk(&field));
    found.extend(hole::aberration(&field));
    found.retain(|pointer| field.screen.place(pointer.direction).is_some());
    found.extend(hole::photon_ring(&field, &found));
    found.retain(|pointer| pointer.direction.is_finite() && pointer.number.is_none_or(f64::is_finite));
    found.sort_by_key(|pointer| pointer.sight);
    found
}
