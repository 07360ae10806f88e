//! Instances: for each object and image order the emission time of its centre and its motion about it, in f64. The GPU starts from them.

mod bounds;
mod emission;
pub mod held;
pub mod local_motion;
mod view;
pub mod visibility;

use glam::{DMat3, DQuat, DVec3};

pub use emission::{Departure, departure};
pub use view::InstanceView;

use crate::lensing::lookup::OLD;
use crate::render::gpu::types::Instance;
use crate::render::gpu::types::placed::{MINUS, NARROW_RING, STATIC, STRAYS, THIN, TWO_SIDED};
use crate::render::instances::local_motion::{ImageExtent, LocalMotion, MOST_NODES, MotionNode};
use crate::render::instances::view::{Extent, MARGIN};
use crate::render::models::ModelRange;
use crate::render::settings::Settings;
pub use crate::scene::lighting::Illumination;
use crate::sim::History;
use crate::sim::sight::light_path;
use crate::spacetime::Observer;
use crate::spacetime::frames::relative_momentum;
use crate::spacetime::light::{Branch, Order};
use crate::spacetime::matter::gamma;
use crate::spacetime::orbit::static_momentum;

/// How an object moves.
#[derive(Clone, Copy, Debug)]
pub enum ObjectMotion<'a> {
    /// Static: every point is held in place. `position` is on the slice T = const, `attitude` takes body to rain axes; the shape is taken
    /// on the slice.
    Static {
        /// Centre, in r_s.
        position: DVec3,
        /// Body to rain axes.
        attitude: DQuat,
    },
    /// A ship with a worldline: rest shape, attitude, boosted to rain axes.
    Flying(&'a History),
}

/// A stand-in for a thin image is chosen as for one of at least this size, in pixels: its light is that of its area, which is to be right
/// to some hundredths.
const THIN_SIZE: f64 = 8.0;

/// A coarse model for small images.
#[derive(Clone, Copy, Debug)]
pub struct StandIn {
    /// For images up to this width, in pixels, where half a pixel is allowed, and in proportion.
    pub below: f64,
    /// The model.
    pub model: ModelRange,
}

/// An object to draw.
#[derive(Clone, Copy, Debug)]
pub struct DrawnObject<'a> {
    /// Which model.
    pub model: ModelRange,
    /// Coarse model for images a few pixels wide.
    pub coarse: ModelRange,
    /// Coarse models, the coarsest first.
    pub stand_ins: &'a [StandIn],
    /// How it moves.
    pub motion: ObjectMotion<'a>,
    /// Farthest point of the object from its centre, in r_s.
    pub reach: f64,
    /// Length in r_s of one unit of the model.
    pub scale: f64,
    /// A number for the layers of a picture, from 1.
    pub id: u32,
    /// What shines on it.
    pub light: Illumination,
}

impl DrawnObject<'_> {
    /// What is drawn of it in an image of this extent: the first that may stand for it in one so small, or itself.
    fn model_for(&self, extent: &Extent, settings: &Settings) -> ModelRange {
        if extent.width < settings.coarse_below {
            return self.coarse;
        }
        let allowed = f64::from(settings.pixel_error) / 0.5;
        let least = if is_thin(extent, self.model.flatness, settings) { THIN_SIZE } else { 0.0 };
        // Light may draw an image out along the ring.
        let size = extent.width.max(extent.length).max(least);
        self.stand_ins.iter().find(|stand_in| size < allowed * stand_in.below).map_or(self.model, |stand_in| stand_in.model)
    }
}

/// An object in one order, ready for the GPU.
#[derive(Debug)]
pub struct Placed {
    /// Its model.
    pub model: ModelRange,
    /// The coarsest that stands in for it.
    pub coarse: ModelRange,
    /// Width of the image, in pixels.
    pub width: f64,
    /// The instance as the shader reads it; the renderer fills in the places in its buffers.
    pub instance: Instance,
    /// Its motion while light crosses it; none for a static body.
    pub nodes: Vec<MotionNode>,
    /// Whether it moves otherwise than is drawn: faster than any body does, or by no numbers.
    pub calmed: bool,
}

impl Clone for Placed {
    fn clone(&self) -> Self {
        // With the same room: what is cloned into it later fits.
        let mut nodes = Vec::with_capacity(self.nodes.capacity());
        nodes.extend_from_slice(&self.nodes);
        Placed { nodes, ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        let mut nodes = std::mem::take(&mut self.nodes);
        nodes.clone_from(&other.nodes);
        *self = Placed { nodes, ..*other };
    }
}

/// The images of a frame as they are placed, in the memory of earlier ones.
#[derive(Debug, Default)]
pub struct PlacedList {
    /// Those that are placed.
    pub placed: Vec<Placed>,
    /// Room for nodes.
    spare: Vec<Vec<MotionNode>>,
}

impl PlacedList {
    /// Begins anew in the memory of images that are not needed any more. The first of those to come gets the room of the first.
    pub fn reuse(&mut self, mut old: Vec<Placed>) {
        self.spare.extend(old.drain(..).rev().map(|image| image.nodes).filter(|nodes| nodes.capacity() > 0));
        self.placed = old;
    }
}

/// The images that [`place`] adds for one object.
pub fn instances_of(view: &InstanceView, time: f64, object: &DrawnObject, orders: u32) -> Vec<Placed> {
    let mut list = PlacedList::default();
    place(&mut list, view, time, object, orders);
    list.placed
}

/// Adds the instances of an object in orders 1 to `orders`, seen by `camera` at the clock's `time`, and gives them. An order in which the
/// centre is not seen (it has not been reached by light yet, or never will) is left out.
///
/// A camera inside the horizon sees a static body inside twice: by light of E > 0 and by light of E < 0, which left at two different times.
/// The worldline of a moving body crosses the camera's past light cone once, on one side or the other; each vertex finds out which.
pub fn place<'l>(list: &'l mut PlacedList, view: &InstanceView, time: f64, object: &DrawnObject, orders: u32) -> &'l mut [Placed] {
    let camera = view.camera;
    let settings = view.settings;
    let (first, PlacedList { placed, spare }) = (list.placed.len(), list);
    let mut image = |order: Order, branch: Branch| {
        let (seen, position, age) = match object.motion {
            // From inside the horizon higher orders show only what is outside of it.
            ObjectMotion::Static { position, .. } if order.number() > 1 && position.length() + object.reach < 1.0 => return None,
            ObjectMotion::Static { position, .. } => (None, position, if branch == Branch::Minus { f64::from(OLD) } else { 0.0 }),
            ObjectMotion::Flying(history) => {
                let seen = departure(view, time, history, order).filter(|seen| history.exists_at(seen.time))?;
                (Some(seen), seen.sample.position, time - seen.time)
            }
        };
        let extent = view.extent(position, object.reach, order, age);
        if view.aspect.is_some_and(|aspect| !extent.may_be_seen(camera, aspect)) {
            return None;
        }
        let width = extent.width;
        if width < settings.least_width && order.number() > 1 {
            return None;
        }
        let (mut instance, local_motion, longer) = match (object.motion, &seen) {
            (ObjectMotion::Static { attitude, .. }, _) => (static_instance(camera, position, attitude, object), None, 1.0),
            (ObjectMotion::Flying(history), Some(seen)) => flying(view, history, seen, time, width, object, spare),
            (ObjectMotion::Flying(_), None) => return None,
        };
        (instance.order, instance.object) = (u32::from(order.number()), object.id);
        let gradient = seen.as_ref().and_then(|seen| path_gradient(view, seen, object.reach, order));
        place_by_axis(&mut instance, camera, position, object.reach, gradient.is_some());
        [instance.path_along, instance.path_across] = gradient.unwrap_or_default();
        // All points of the object, each where its light leaves, are within this distance of its centre.
        let whole = position.z.abs() > MARGIN * object.reach;
        instance.crossings = if whole { plane_crossings(camera.position.z, position.z, order) as f32 } else { -1.0 };
        // From within a body its inner side is seen. With straight light the direction in which light leaves does not agree with the shape
        // on the slice.
        let within = position.distance(camera.position) < object.reach;
        if within || !settings.method.bends {
            instance.flags |= TWO_SIDED;
        }
        if branch == Branch::Minus {
            instance.flags |= MINUS;
        }
        // Near the hole, relative to the object's size, parts of an image are stretched more than the whole.
        let mut model = if object.reach < 0.1 * position.length() { object.model_for(&extent, settings) } else { object.model };
        set_strictness(&mut instance, view, &extent, object.model.flatness, order);
        instance.bounds = view.bounds(&extent, position, object.reach, longer, order, age);
        let (mut nodes, mut calmed) = local_motion.map_or((Vec::new(), false), |local_motion| (local_motion.nodes, local_motion.calmed));
        let has_numbers = instance.is_finite() && nodes.iter().flatten().flatten().all(|x| x.is_finite());
        if let (Some(seen), false) = (&seen, has_numbers) {
            // Its stand-in, straight on.
            (model, calmed) = (object.coarse, true);
            local_motion::at_rest(seen.sample.attitude, &mut nodes);
            straight_on(&mut instance);
        }
        Some(Placed { model, coarse: object.coarse, width, instance, nodes, calmed })
    };
    let folded = match object.motion {
        ObjectMotion::Static { position, .. } => camera.radius() < 1.0 && position.length() - object.reach < 1.0 && settings.method.bends,
        ObjectMotion::Flying(_) => false,
    };
    let second = folded.then(|| image(Order::ALL[0], Branch::Minus)).flatten();
    let orders = orders.min(settings.method.orders);
    placed.extend(Order::ALL.into_iter().take(orders as usize).filter_map(|order| image(order, Branch::Plus)).chain(second));
    &mut placed[first..]
}

/// Whether an image is so narrow that a ray a pixel may miss it. A ring shows the body's sections across the axis, and is narrower at most
/// azimuths than its ball.
fn is_thin(extent: &Extent, flatness: f32, settings: &Settings) -> bool {
    let wider = if extent.is_drawn_out() { f64::from(flatness / FLAT).max(1.0) } else { 1.0 };
    extent.width < settings.thin_below * wider && settings.min_width > 0.0
}

/// Says how strictly the chords of an image are held to their curves, and whether it is a thin one or a narrow ring.
fn set_strictness(instance: &mut Instance, view: &InstanceView, extent: &Extent, flatness: f32, order: Order) {
    let width = extent.width;
    if is_thin(extent, flatness, view.settings) {
        let of_ring = (THIN_RING_BELOW / width).clamp(THIN_STRICTNESS, MOST_THIN_RING);
        let (strictness, ring) = if extent.is_drawn_out() { (of_ring, NARROW_RING) } else { (THIN_STRICTNESS, 0) };
        instance.flags |= THIN | ring;
        instance.strictness = strictness as f32;
    } else {
        instance.flags |= if width < NARROW_RING_BELOW && order.number() > 1 { NARROW_RING } else { 0 };
        instance.strictness = (NARROW_IMAGE_BELOW / width).clamp(1.0, MOST_NARROW_STRICTNESS) as f32;
    }
    instance.strictness *= photon_sphere_strictness(view.camera);
}

/// Factor on the strictness, by where the camera is.
fn photon_sphere_strictness(camera: &Observer) -> f32 {
    if NEAR_PHOTON_SPHERE.contains(&camera.radius()) { PHOTON_SPHERE_STRICTNESS } else { 1.0 }
}

/// How often light of an image order crosses the plane z = 0 on its way from `height` (z of its source) to the camera at `camera_height`.
/// The ray stays in a plane through the hole and sweeps n − 1 to n half turns about it, each of which crosses z = 0 once. So it crosses n −
/// 1 or n times: the odd number if its ends are on different sides. So many of the disk's own images are in front of it.
fn plane_crossings(camera_height: f64, height: f64, order: Order) -> u32 {
    let n = u32::from(order.number());
    let across = (height < 0.0) != (camera_height < 0.0);
    if across == n.is_multiple_of(2) { n - 1 } else { n }
}

/// Images of orders 2 and 3 narrower than this, in pixels, are narrow rings: of ten columns of pixels two are at an outline.
const NARROW_RING_BELOW: f64 = 10.0;
/// Strictness of thin images. They lie along the edge of the shadow and are widened by half a pixel. So their chords are held this much
/// closer, and sag and widening together stay under a pixel.
const THIN_STRICTNESS: f64 = 4.0;
/// Chords of thin rings are held closer than the ring is wide, if they can: what one cuts off is added to its triangle's coverage, and if
/// that is much more than the triangle, places where it is drawn make the ring uneven.
const THIN_RING_BELOW: f64 = 2.0;
const MOST_THIN_RING: f64 = 64.0;
/// Flatness up to which sections of a body are about as wide as its ball.
const FLAT: f32 = 2.0;
/// Images narrower than this, in pixels, are narrow ones. The narrower they are, the closer their chords are held, since all of them are
/// near an outline. The width is the largest; a ring is a tenth as wide elsewhere.
const NARROW_IMAGE_BELOW: f64 = 16.0;
/// Largest strictness of narrow images: with 8, half as many random scenes of rings 1 to 3 px wide are beyond the limits as with 4.
/// Stricter ones take more vertices than there is room for.
const MOST_NARROW_STRICTNESS: f64 = 8.0;
/// Camera radii, in r_s, from which light that circles the hole is seen beside what lies behind it. Images there are sheared, and their
/// inner points are off by more than the chords around them.
const NEAR_PHOTON_SPHERE: std::ops::RangeInclusive<f64> = 1.3..=1.8;
/// Strictness there. With a budget of 0.3 px instead of 0.5 px, points of balls behind the hole are within half a pixel; with 0.5 px up to
/// 0.59 px off.
const PHOTON_SPHERE_STRICTNESS: f32 = 1.7;

fn numbers(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn columns(m: DMat3) -> [[f32; 3]; 3] {
    m.as_mat3().to_cols_array_2d()
}

fn light_rows(light: &Illumination) -> [[f32; 4]; 3] {
    std::array::from_fn(|c| {
        let [x, y, z] = light.directed[c];
        [x, y, z, light.ambient[c]]
    })
}

/// By how many roundings an object is drawn beside its true position. So nothing that was put on the axis of hole and camera, or in a plane
/// through it, is exactly there: such a plane is seen as a ring without azimuth.
const BESIDE: f64 = 4.0;
/// Rounding of f32 in the position of a point, relative to the object's reach, and in its emission time, relative to the delay: some
/// roundings of 2⁻²⁴ each.
const ROUNDING: f64 = 4e-7;

/// The direction in which an object is drawn beside its position, by the two axes across that of hole and camera: nobody chooses it.
const BESIDE_WAY: [f64; 2] = [0.79, 0.61];

/// Where an instance at `position` is across the axis of hole and camera, and by how much rounding may move a point of the object. If
/// its points' paths are told by gradients, their emission times are as precise as their positions.
pub(super) fn place_by_axis(instance: &mut Instance, camera: &Observer, position: DVec3, reach: f64, by_gradients: bool) {
    let [_, a, b] = camera.axis_frame();
    let speed = if instance.scale == 0.0 { 0.0 } else { DVec3::from_array(instance.velocity.map(f64::from)).length() };
    let rounding = ROUNDING * (reach + speed * if by_gradients { reach } else { f64::from(instance.delay).abs() });
    let aside = BESIDE * rounding;
    let [across_a, across_b] = BESIDE_WAY;
    (instance.across_a, instance.across_b) = ((position.dot(a) + across_a * aside) as f32, (position.dot(b) + across_b * aside) as f32);
    (instance.rounding, instance.strictness) = (rounding as f32, 1.0);
}

/// The gradient of the path of the light by which a body's centre is seen, along and across the axis of hole and camera, if by it the paths
/// from the body's points are told better than their rounding. None: they are not.
fn path_gradient(view: &InstanceView, seen: &Departure, reach: f64, order: Order) -> Option<[f32; 2]> {
    let camera = view.camera;
    let method = view.settings.method;
    if !(method.bends && method.is_exact && view.settings.light_delay) || camera.radius() <= 1.0 {
        return None;
    }
    let position = seen.sample.position;
    let (path, mut gradient) = seen.path?;
    let curved = path.min(position.length() - 1.0) - reach;
    if curved < reach || reach.powi(3) / (TRAPEZOID * curved * curved) > ROUNDING * path {
        return None;
    }
    let [n, a, b] = camera.axis_frame();
    let mut beside = position - n * position.dot(n);
    if beside.length() < ON_AXIS * reach {
        // There the side towards a point is that on which it is drawn.
        let [across_a, across_b] = BESIDE_WAY;
        beside = (a * across_a + b * across_b) * (ON_AXIS * reach);
        gradient = light_path(camera, n * position.dot(n) + beside, order, Branch::Plus)?.1;
    }
    Some([gradient.dot(n) as f32, gradient.dot(beside.normalize()) as f32])
}

/// The trapezoid rule from gradients at both ends of a way h errs by h³/12 times the third derivative of the path, which is about 1 over the
/// square of the distance from the hole and from the camera.
const TRAPEZOID: f64 = 12.0;
/// Nearer to the axis than this share of its reach a body's centre is on it, for the side towards it.
const ON_AXIS: f64 = 1e-6;

fn static_instance(camera: &Observer, position: DVec3, attitude: DQuat, object: &DrawnObject) -> Instance {
    let turn = DMat3::from_quat(attitude);
    let [shape_x, shape_y, shape_z] = columns(turn * object.scale);
    let [turn_x, turn_y, turn_z] = columns(turn);
    Instance {
        offset: numbers(position - camera.position),
        position: numbers(position),
        gamma: 1.0,
        shape_x,
        shape_y,
        shape_z,
        turn_x,
        turn_y,
        turn_z,
        light: light_rows(&object.light),
        flags: STATIC,
        ..Instance::default()
    }
}

/// How the image of a moving body is drawn out by its motion.
#[derive(Clone, Copy, Debug)]
struct DrawnOut {
    /// Factor by which points of the body may be farther from its centre when their light leaves than at one time.
    longer: f64,
    /// So long before and after that of the centre their light leaves at most, in r_s/c.
    span: f64,
    /// The length of the light's path, in r_s.
    path: f64,
}

impl DrawnOut {
    /// Of a body with this `reach` (r_s) that is seen by this light, `age` r_s/c old. Light leaves a farther point earlier by the delay's
    /// gradient ∇Δ. Meanwhile the body moves with velocity v, which adds v ∇Δ/(1 + v ∇Δ). Where there is no such light, as for straight light
    /// across the hole, anything may be.
    fn of(seen: &Departure, reach: f64, age: f64) -> DrawnOut {
        let Some((path, gradient)) = seen.path else {
            return DrawnOut { longer: f64::INFINITY, span: MOST_SPAN * reach, path: age };
        };
        let velocity = seen.sample.velocity;
        let late = (1.0 + velocity.dot(gradient)).max(1e-6);
        let span = (ACCELERATES * gradient.length() / late).clamp(1.0, MOST_SPAN) * reach;
        DrawnOut { longer: 1.0 + ACCELERATES * velocity.length() * gradient.length() / late, span, path }
    }
}

/// Factor on both for acceleration while light crosses the object.
const ACCELERATES: f64 = 1.5;
/// The longest time, over that which light takes for the reach, in which a body's motion is followed: next to the horizon it has no end.
const MOST_SPAN: f64 = 8.0;

/// The instance of a body that is seen by this light at T = `time`; its motion, and by what factor its points are drawn out. Its image is
/// `width` pixels wide; `spare` is room for nodes.
fn flying(
    view: &InstanceView,
    history: &History,
    seen: &Departure,
    time: f64,
    width: f64,
    object: &DrawnObject,
    spare: &mut Vec<Vec<MotionNode>>,
) -> (Instance, Option<LocalMotion>, f64) {
    let camera = view.camera;
    let (emission, sample) = (seen.time, &seen.sample);
    let turn = DMat3::from_quat(sample.attitude);
    let out = DrawnOut::of(seen, object.reach, time - emission);
    let still = !view.settings.light_delay;
    let p = sample.momentum;
    let momentum = if view.settings.method.bends { sample.momentum } else { against_static(sample.position, sample.momentum) };
    let [shape_x, shape_y, shape_z] = columns(contraction(p) * turn * object.scale);
    let [turn_x, turn_y, turn_z] = columns(turn);
    let instance = Instance {
        offset: numbers(sample.position - camera.position),
        delay: (time - emission) as f32,
        position: numbers(sample.position),
        velocity: numbers(sample.velocity),
        scale: if still { 0.0 } else { object.scale as f32 },
        momentum: numbers(momentum),
        gamma: gamma(momentum) as f32,
        contraction: numbers(p),
        shape_x,
        shape_y,
        shape_z,
        turn_x,
        turn_y,
        turn_z,
        light: light_rows(&object.light),
        ..Instance::default()
    };
    if still {
        return (instance, None, out.longer);
    }
    let extent = ImageExtent { span: out.span, width, pixel: view.pixel * out.path };
    let nodes = spare.pop().unwrap_or_else(|| Vec::with_capacity(MOST_NODES));
    let local_motion = LocalMotion::new(history, emission, object.reach, &extent, nodes);
    let [first_node, step] = local_motion.times.map(|time| time as f32);
    let instance = Instance {
        acceleration: numbers(local_motion.acceleration),
        jerk: numbers(local_motion.jerk),
        snap: numbers(local_motion.snap),
        force: numbers(local_motion.force),
        spin: numbers(local_motion.spin),
        spin_slack: local_motion.slack as f32,
        first_node,
        nodes_per_time: step.recip(),
        node_intervals: (local_motion.nodes.len() - 1) as f32,
        flags: if local_motion.strays { STRAYS } else { 0 },
        ..instance
    };
    (instance, Some(local_motion), out.longer)
}

/// Leaves of an instance's motion what has numbers for sure.
fn straight_on(instance: &mut Instance) {
    (instance.acceleration, instance.jerk, instance.snap, instance.force) = Default::default();
    (instance.spin, instance.spin_slack, instance.bounds) = Default::default();
    (instance.path_along, instance.path_across) = Default::default();
    instance.flags &= !STRAYS;
    (instance.first_node, instance.nodes_per_time, instance.node_intervals) = (0.0, 1.0, 1.0);
}

/// The momentum relative to a static observer, which takes the place of the rain frame where light is drawn straight. Inside the horizon
/// there is none.
pub fn against_static(position: DVec3, momentum: DVec3) -> DVec3 {
    static_momentum(position).map_or(momentum, |rest| relative_momentum(rest, momentum))
}

/// The Lorentz contraction of a body of momentum p per mass, on the rain frame's slice: 1 − p pᵀ/(γ(1 + γ)).
fn contraction(p: DVec3) -> DMat3 {
    let g = gamma(p);
    DMat3::IDENTITY - DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (g * (1.0 + g)))
}
