//! The judge, asked between the pixels of its picture.

use std::sync::OnceLock;

use glam::{DVec2, DVec3, Vec3};

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::shade::Textures;
use lensrunner::judge::picture::{Layer, Seen, World, Worldline};
use lensrunner::scene::disk::Gas;

use super::sight::seen_at;

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
    /// How far a point is from the surface of the body, in the model's unit.
    fn off_body(&self, object: u32, body: DVec3) -> f64;
    /// The greatest distance of a point of the body from its centre, in the model's unit.
    fn radius(&self, object: u32) -> f64;
    /// Whether a ray from there meets neither a thing nor gas.
    fn is_dark(&self, x: f64, y: f64) -> bool;
}

/// What a surface sends to a place on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lit {
    /// Number of the thing, from 1, and image order.
    pub image: (u32, u32),
    /// Linear RGB.
    pub light: Vec3,
}

/// The judge, asked for light anywhere on the screen.
pub trait LightProbe: Sync {
    /// The surface that is seen at (x, y), in pixels from the upper left corner, without what a disk adds and takes on the way. Its texture
    /// is read as finely as it is.
    fn lit(&self, x: f64, y: f64) -> Option<Lit>;
}

/// The judge of a case.
pub fn probe(case: &Case, tolerance: f64) -> impl Probe + LightProbe + '_ {
    let ships: Vec<&dyn Worldline> = case.histories.iter().map(|history| history as &dyn Worldline).collect();
    let gas = case.scene.disk(&case.config).map(|disk| Gas::new(&disk, case.config.hole.mass_solar).extent());
    let world = case.world(&ships);
    Asked { case, world, gas, tolerance, textures: OnceLock::new() }
}

/// A case's judge between the pixels.
struct Asked<'a> {
    case: &'a Case,
    world: World<'a>,
    /// From where to where the disk has gas, in r_s.
    gas: Option<[f64; 2]>,
    tolerance: f64,
    /// Made when it is first asked for light.
    textures: OnceLock<Textures>,
}

impl LightProbe for Asked<'_> {
    fn lit(&self, x: f64, y: f64) -> Option<Lit> {
        let camera = &self.case.camera;
        let (look, blue) = camera.look(x, y);
        let Seen::Hit(hit) = self.world.look(camera.observer.position, look, self.tolerance) else { return None };
        let surface = self.world.surface(&hit, blue);
        let textures = self.textures.get_or_init(|| Textures::of(&self.world));
        let light = textures.light(&self.world, hit.object, &surface, f32::NEG_INFINITY, self.case.shift());
        Some(Lit { image: (self.world.things[hit.object].id, hit.order), light })
    }
}

impl Probe for Asked<'_> {
    fn at(&self, x: f64, y: f64) -> Option<Point> {
        let camera = &self.case.camera;
        match self.world.look(camera.observer.position, camera.look(x, y).0, self.tolerance) {
            Seen::Hit(hit) => {
                let thing = &self.world.things[hit.object];
                let body = self.case.on_model(thing.model, hit.triangle, hit.barycentrics);
                Some(Point { object: thing.id, order: hit.order, body })
            }
            _ => None,
        }
    }

    fn place(&self, point: &Point) -> Option<DVec2> {
        let thing = self.world.things.iter().find(|thing| thing.id == point.object)?;
        seen_at(&self.world, &self.case.camera, thing, point.order, point.body)
    }

    fn body(&self, layer: &Layer) -> DVec3 {
        self.case.body(layer)
    }

    fn off_body(&self, object: u32, body: DVec3) -> f64 {
        let Some(thing) = self.world.things.iter().find(|thing| thing.id == object) else { return 0.0 };
        let model = &self.case.assembly.models[thing.model];
        let corner = |index: u32| DVec3::from(model.vertices[index as usize].position.map(f64::from));
        model.triangles.iter().map(|triangle| distance(body, triangle.map(corner))).fold(f64::INFINITY, f64::min)
    }

    fn radius(&self, object: u32) -> f64 {
        let thing = self.world.things.iter().find(|thing| thing.id == object);
        thing.map_or(1.0, |thing| f64::from(self.case.assembly.models[thing.model].radius()))
    }

    fn is_dark(&self, x: f64, y: f64) -> bool {
        let camera = &self.case.camera;
        let mut clear = true;
        let seen = self.world.look_through(camera.observer.position, camera.look(x, y).0, self.tolerance, &mut |crossing| {
            let r = crossing.position.length();
            clear &= self.gas.is_none_or(|[start, end]| r < start || r > end);
        });
        clear && !matches!(seen, Seen::Hit(_))
    }
}

/// The distance of a point from a triangle: from its plane where the foot is inside, else from the nearest side.
fn distance(point: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let sides = [[a, b], [b, c], [c, a]];
    if normal != DVec3::ZERO && sides.iter().all(|[from, to]| (*to - *from).cross(point - *from).dot(normal) >= 0.0) {
        return (point - a).dot(normal).abs();
    }
    let from_side = |[from, to]: [DVec3; 2]| {
        let along = to - from;
        let t = ((point - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        point.distance(from + along * t)
    };
    sides.map(from_side).into_iter().fold(f64::INFINITY, f64::min)
}
