//! The judge, asked between the pixels of its picture.

use glam::{DVec2, DVec3};

use super::picture::Layer;

/// A point of a surface as the judge sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The number of the thing, from 1.
    pub object: u32,
    /// The image order.
    pub order: u32,
    /// Where on the body, in its own axes and the model's unit.
    pub body: DVec3,
}

/// The judge, asked anywhere on the screen.
pub trait Probe: Sync {
    /// What is seen at (x, y), in pixels from the upper left corner.
    fn at(&self, x: f64, y: f64) -> Option<Point>;
    /// Where the point is seen, in pixels, hidden or not; None where it is not, or where the judge cannot tell.
    fn place(&self, point: &Point) -> Option<DVec2>;
    /// The point of the body that a pixel of the judge's picture shows.
    fn body(&self, layer: &Layer) -> DVec3;
    /// The greatest distance of a point of the body from its centre, in the model's unit.
    fn radius(&self, object: u32) -> f64;
    /// Whether a ray from there meets neither a thing nor gas.
    fn is_dark(&self, x: f64, y: f64) -> bool;
}
