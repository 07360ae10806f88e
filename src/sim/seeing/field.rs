//! All that a camera's screen shows, as far as pointing at it needs it.

use std::f64::consts::TAU;

use glam::DVec3;

use super::body::SeenImage;
use super::kind::{Phenomenon, Pointer};
use super::look::{Eye, Look};
use super::screen::CameraScreen;

/// So many sides evenly all round the hole, and as many of those that are on the screen.
const SIDES: usize = 32;

/// The screen, what each cell of its grid shows, and the bodies on it.
pub struct Field<'a> {
    /// The camera.
    pub eye: Eye<'a>,
    /// Its screen.
    pub screen: CameraScreen,
    /// What the cells show.
    pub looks: Vec<Look>,
    images: Vec<SeenImage>,
    hidden: Vec<bool>,
}

impl<'a> Field<'a> {
    /// Looks in all directions of the grid. `images` are those of bodies, which may be before what is behind them.
    pub fn new(eye: Eye<'a>, screen: CameraScreen, images: Vec<SeenImage>) -> Field<'a> {
        let looks: Vec<Look> = screen.directions().map(|seen| eye.look(seen)).collect();
        let hidden = looks.iter().map(|look| images.iter().any(|image| image.covers(look))).collect();
        Field { eye, screen, looks, images, hidden }
    }

    /// What is seen in this direction (camera axes), if that is on the screen and no body is before it.
    pub fn look(&self, seen: DVec3) -> Option<Look> {
        self.screen.place(seen)?;
        let look = self.eye.look(seen);
        (!self.images.iter().any(|image| image.covers(&look))).then_some(look)
    }

    /// For each cell how many steps it lies inside the region where `inside` holds and no body is before it.
    pub fn depths(&self, inside: impl Fn(&Look) -> bool) -> Vec<u16> {
        self.screen.depths(|k| !self.hidden[k] && inside(&self.looks[k]))
    }

    /// The cells with a depth, each with that.
    pub fn cells<'b>(&'b self, depths: &'b [u16]) -> impl Iterator<Item = (u16, &'b Look)> {
        depths.iter().copied().zip(&self.looks).filter(|(depth, _)| *depth > 0)
    }

    /// Sides on which light passes the hole, some all round, some on the screen: unit vectors across the line from hole to camera.
    pub fn sides(&self) -> Vec<DVec3> {
        let round = (0..SIDES).map(|k| self.eye.side(TAU * k as f64 / SIDES as f64));
        // A step that goes well with no number of columns visits all of them.
        let step = (self.looks.len() / SIDES).max(1) | 1;
        round.chain(self.looks.iter().step_by(step).map(|look| look.side)).collect()
    }
}

/// A pointer to what a look shows.
pub fn point(sight: Phenomenon, look: &Look, number: f64) -> Pointer {
    Pointer { sight, direction: look.seen, number: Some(number) }
}

/// What has the greatest score, which is to be a number.
pub fn best<T>(all: impl Iterator<Item = T>, score: impl Fn(&T) -> f64) -> Option<T> {
    all.map(|one| (score(&one), one)).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, one)| one)
}
