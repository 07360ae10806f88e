//! The verdict: a renderer's picture of a scene against the judge's, object by object and order by order.
//!
//! - [`measure`]: what differs between two pictures: displacement, coverage, area, holes.
//! - [`report`]: the numbers as text, the pictures side by side.
//! - [`fault`]: the limits and what is beyond them.
//! - [`beyond`]: what of a verdict is beyond its limits.
//! - [`deadline`]: how long the judge may take.
//! - [`judged`]: one case before the judge, from the picture to its faults.
//! - [`random`]: scenes that nobody chose.
//! - [`flight`]: moments of chases that the autopilot flies.
//! - [`collect`]: verdicts of many scenes in one table.
//! - [`command`]: `lensrunner-lab compare`.

pub mod beyond;
pub mod collect;
pub mod command;
pub mod deadline;
pub mod fault;
pub mod flight;
pub mod judged;
pub mod measure;
pub mod random;
pub mod report;

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::TracedPicture;

/// What a pixel of the contestant shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shown {
    /// The number of the thing, from 1; 0 for none.
    pub object: u32,
    /// The image order.
    pub order: u32,
    /// The point of the body's surface, in its own axes and the model's unit.
    pub body: [f32; 3],
    /// How much of the pixel it covers: less than 1 only for images drawn by coverage.
    pub coverage: f32,
}

impl Shown {
    /// The object's number and the image order.
    pub fn image(&self) -> (u32, u32) {
        (self.object, self.order)
    }
}

/// The contestant's picture.
#[derive(Clone, Debug)]
pub struct ContestantFrame {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear light with the sky.
    pub light: Vec<[f32; 3]>,
    /// Linear light of the things alone.
    pub bare: Vec<[f32; 3]>,
    /// Linear light of surfaces alone: without the sky and without the disk, which adds light and takes some.
    pub surfaces: Vec<[f32; 3]>,
    /// What each pixel shows.
    pub shown: Vec<Shown>,
}

impl ContestantFrame {
    /// The judge's own picture as a contestant: what a perfect renderer would hand in, and what tests break on purpose.
    pub fn of(picture: &TracedPicture, case: &Case) -> ContestantFrame {
        let shown = picture.layers.iter().map(|layer| Shown {
            object: layer.object,
            order: layer.order,
            body: if layer.object > 0 { case.body(layer).as_vec3().to_array() } else { [0.0; 3] },
            coverage: if layer.object > 0 { 1.0 } else { 0.0 },
        });
        let bare = picture.light.iter().zip(&picture.open).map(|(rgb, open)| if *open < 1.0 { *rgb } else { [0.0; 3] });
        let surfaces = picture.layers.iter().map(|layer| layer.light).collect();
        ContestantFrame { size: picture.size, light: picture.light.clone(), bare: bare.collect(), surfaces, shown: shown.collect() }
    }
}
