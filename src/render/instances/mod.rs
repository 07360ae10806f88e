//! Instances: for each object and image order the emission time of its centre and its motion about it, in f64. The GPU starts from them.

mod bounds;
pub mod swing;
pub mod visibility;

use crate::spacetime::Observer;
use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::lensing::Slice;
use crate::lensing::lookup::{OLD, lens_lookup_aged};
pub use crate::scene::lighting::Surroundings;
use crate::sim::History;
use crate::spacetime::frames::relative_momentum;
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::matter::gamma;
use crate::spacetime::orbit::static_momentum;

use crate::render::gpu::types::Instance;
use crate::render::gpu::types::placed::{HELD, MINUS, NARROW, THIN, TWO_SIDED};
use crate::render::instances::swing::Swing;
use crate::render::instances::visibility::{may_be_seen, part_of_screen};
use crate::render::method::Method;
use crate::render::models::ModelRange;
use crate::render::settings::Settings;

/// How an object moves.
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a> {
    /// Every point is held in place. `position` is on the slice T = const, `attitude` takes body to rain axes; the shape is taken on the
    /// slice.
    Held {
        /// Centre, in r_s.
        position: DVec3,
        /// Body to rain axes.
        attitude: DQuat,
    },
    /// A ship with a worldline: rest shape, attitude, boosted to rain axes.
    Flying(&'a History),
}

/// An object to draw.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// Which model.
    pub model: ModelRange,
    /// Coarse model for images a few pixels wide.
    pub coarse: ModelRange,
    /// Coarse models for wider images: each up to a width in pixels, the coarsest first.
    pub stand_ins: &'a [(f64, ModelRange)],
    /// How it moves.
    pub motion: Motion<'a>,
    /// Farthest point of the object from its centre, in r_s.
    pub reach: f64,
    /// Length in r_s of one unit of the model.
    pub scale: f64,
    /// A number for the layers of a picture, from 1.
    pub id: u32,
    /// What shines on it.
    pub light: Surroundings,
}

/// An object in one order, ready for the GPU.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Its model.
    pub model: ModelRange,
    /// The instance as the shader reads it; the renderer fills in the places in its buffers.
    pub instance: Instance,
}

/// The instances of an object in orders 1 to `orders`, seen by `camera` at the clock's `time`. An order in which the centre is not seen
/// (it has not been reached by light yet, or never will) is left out.
///
/// A camera inside the horizon sees what is held inside twice: by light of E > 0 and by light of E < 0, which left at two different times.
/// The worldline of a moving body crosses the camera's past light cone once, on one side or the other; each vertex finds out which.
pub fn instances_of(view: &View, time: f64, object: &Object, orders: u32) -> Vec<Placed> {
    let camera = view.camera;
    let settings = view.settings;
    let image = |order: Order, branch: Branch| {
        let (mut instance, position, age) = match object.motion {
            // From inside the horizon higher orders show only what is outside of it.
            Motion::Held { position, .. } if order.number() > 1 && position.length() + object.reach < 1.0 => return None,
            Motion::Held { position, attitude } => {
                (held(camera, position, attitude, object), position, if branch == Branch::Minus { f64::from(OLD) } else { 0.0 })
            }
            Motion::Flying(history) => flying(view, time, history, order, object)?,
        };
        instance.ids = [u32::from(order.number()), object.id, 0, 0];
        instance.axis = by_axis(camera, &instance, position, object.reach);
        // All points of the object, each where its light leaves, are within this distance of its centre.
        let whole = position.z.abs() > MARGIN * object.reach;
        instance.snap[3] = if whole { plane_crossings(camera.position.z, position.z, order) as f32 } else { -1.0 };
        if !settings.method.bends() {
            // With straight light the direction in which light leaves does not agree with the shape on the slice.
            instance.triangles[3] |= TWO_SIDED;
        }
        if branch == Branch::Minus {
            instance.triangles[3] |= MINUS;
        }
        let extent = view.extent(position, object.reach, order, age);
        if view.aspect.is_some_and(|aspect| !extent.may_be_seen(camera, aspect)) {
            return None;
        }
        let width = extent.width;
        if width < settings.least_width && order.number() > 1 {
            return None;
        }
        // Near the hole, relative to the object's size, an image is stretched round the ring and shows more detail than its width tells.
        let models = [(settings.coarse_below, object.coarse)].into_iter().chain(object.stand_ins.iter().copied());
        let stands_in = models.into_iter().find(|(below, _)| width < *below && object.reach < 0.1 * position.length());
        let model = stands_in.map_or(object.model, |(_, model)| model);
        if width < settings.thin_below && settings.min_width > 0.0 {
            instance.triangles[3] |= THIN;
            instance.axis[3] = THIN_STRICTNESS;
        } else {
            instance.triangles[3] |= if width < NARROW_BELOW && order.number() > 1 { NARROW } else { 0 };
            let most = if model.triangles[1] < FINE_MODEL { MOST_SLIM } else { MOST_SLIM_FINE };
            instance.axis[3] = (SLIM_BELOW / width).clamp(1.0, most) as f32;
        }
        if NEAR_PHOTON_SPHERE.contains(&camera.radius()) {
            instance.axis[3] *= PHOTON_SPHERE_STRICTNESS;
        }
        let longer = drawn_out(camera, &instance, position, order, age);
        instance.bounds = view.bounds(&extent, position, object.reach, longer, order, age);
        Some(Placed { model, instance })
    };
    let folded = match object.motion {
        Motion::Held { position, .. } => camera.radius() < 1.0 && position.length() - object.reach < 1.0 && settings.method.bends(),
        Motion::Flying(_) => false,
    };
    let second = folded.then(|| image(Order::ALL[0], Branch::Minus)).flatten();
    let orders = orders.min(settings.method.orders());
    Order::ALL.into_iter().take(orders as usize).filter_map(|order| image(order, Branch::Plus)).chain(second).collect()
}

/// How often light of an image order crosses the plane z = 0 on its way from `height` (z of its source) to the camera at `camera_height`.
/// The ray stays in a plane through the hole and sweeps n − 1 to n half turns about it, each of which crosses z = 0 once. So it crosses n −
/// 1 or n times: the odd number if its ends are on different sides. So many of the disk's own images are in front of it.
pub fn plane_crossings(camera_height: f64, height: f64, order: Order) -> u32 {
    let n = u32::from(order.number());
    let across = (height < 0.0) != (camera_height < 0.0);
    if across == n.is_multiple_of(2) { n - 1 } else { n }
}

/// Images narrower than this, in pixels, are narrow ones: of ten columns of pixels two are at an outline.
const NARROW_BELOW: f64 = 10.0;
/// Strictness of thin images. They lie along the edge of the shadow and are widened by half a pixel. So their chords are held this much
/// closer, and sag and widening together stay under a pixel.
const THIN_STRICTNESS: f32 = 4.0;
/// Images narrower than this, in pixels, are slim ones. The narrower they are, the closer their chords are held, since all of them are near
/// an outline. The width is the largest; a ring is a tenth as wide elsewhere.
const SLIM_BELOW: f64 = 16.0;
/// Largest strictness of slim images.
const MOST_SLIM: f64 = 4.0;
/// Camera radii, in r_s, from which light that circles the hole is seen beside what lies behind it. Images there are sheared, and their
/// inner points are off by more than the chords around them.
const NEAR_PHOTON_SPHERE: std::ops::RangeInclusive<f64> = 1.3..=1.8;
/// Strictness there. With a budget of 0.3 px instead of 0.5 px, points of balls behind the hole were within half a pixel; with 0.5 px up to
/// 0.59 px off.
const PHOTON_SPHERE_STRICTNESS: f32 = 1.7;
/// Models with so many triangles have short edges, which sag less. Held as close as others, ships behind the hole filled the buffers.
const FINE_MODEL: u32 = 2000;
/// Largest strictness of slim images of such models.
const MOST_SLIM_FINE: f64 = 2.0;

/// A camera, and what is needed to tell how wide an image is.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera.
    pub camera: &'a Observer,
    /// The table at its radius.
    pub slice: &'a Slice,
    /// Angle of a pixel in radians.
    pub pixel: f64,
    /// Height over width of the screen: images off it are left out. None: no image is left out.
    pub aspect: Option<f64>,
    /// How the picture is made.
    pub settings: &'a Settings,
}

/// Where the image of a ball is seen, in the rain frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// The direction of its centre, a unit vector in rain axes.
    pub(super) look: DVec3,
    /// Radius, in radians, of a cone about `look` that holds the image.
    pub(super) radius: f64,
    /// Largest width on the screen, in pixels: the extent in ψ, or the angular size if that is less.
    pub(super) width: f64,
}

/// Factor by which an extent is enlarged. It is that of a ball at one time, from five of its points; the points between them and the motion
/// need more.
pub(super) const MARGIN: f64 = 3.0;

impl Extent {
    fn may_be_seen(&self, camera: &Observer, aspect: f64) -> bool {
        may_be_seen(camera, self.look, MARGIN * self.radius, 0.01, aspect)
    }

    /// The part of the screen on which the image may be: left, upper, right and lower edge as shares of width and height.
    pub(super) fn part_of_screen(&self, camera: &Observer, aspect: f64) -> [f64; 4] {
        part_of_screen(camera, self.look, MARGIN * self.radius, aspect)
    }
}

impl View<'_> {
    /// The direction (a unit vector, rain axes) from which light of age `age` (r_s/c) comes from a position, and the length of its path.
    /// Inside the horizon `age` decides which of two rays is meant.
    pub(super) fn look(&self, position: DVec3, order: Order, age: f64) -> Option<(DVec3, f64)> {
        let n = self.camera.position.normalize();
        let height = position.dot(n);
        let across = position - n * height;
        let (psi, path) = self.angle([(position - self.camera.position).dot(n), across.length(), height], order, age)?;
        let turn = if order.flips() { -1.0 } else { 1.0 };
        Some((n * psi.cos() + across.normalize_or_zero() * (turn * psi.sin()), path))
    }

    /// The angle ψ from outwards at which a position is seen, and the length of the light's path. The position is given by its distance
    /// outward of the camera, its distance from the axis, and its height along the axis from the hole.
    pub(super) fn angle(&self, [along, across, height]: [f64; 3], order: Order, age: f64) -> Option<(f64, f64)> {
        if !self.settings.method.bends() {
            return Some((across.atan2(along), along.hypot(across)));
        }
        let [along, across, height] = [along, across, height].map(|x| x as f32);
        let ray = lens_lookup_aged(self.slice, along, across, height, u32::from(order.number()), age as f32);
        ray.valid.then(|| (f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)), f64::from(ray.delay)))
    }

    /// Where the image of a ball of radius `reach` at `position` is seen.
    /// Estimated from the ball's nearest, farthest and outermost points in the plane of the axis.
    /// `age` decides, inside the horizon, which light is meant.
    pub(super) fn extent(&self, position: DVec3, reach: f64, order: Order, age: f64) -> Extent {
        let (l, r) = (self.camera.radius(), position.length());
        let n = self.camera.position / l;
        let phi = position.dot(n).clamp(-r, r) / r;
        let phi = phi.acos();
        let anywhere = Extent { look: n, radius: std::f64::consts::PI, width: std::f64::consts::PI / self.pixel };
        let half = if reach < r { (reach / r).asin() } else { return anywhere };
        let seen = |r: f64, phi: f64| {
            let (sine, cosine) = phi.clamp(0.0, std::f64::consts::PI).sin_cos();
            self.angle([r * cosine - l, r * sine, r * cosine], order, age)
        };
        let low_side = if l < 1.0 { (r - reach).max(l + 0.01 * (r - l)) } else { (r - reach).max(1.001) };
        let places = [(r, phi), (r, phi - half), (r, phi + half), (low_side, phi), (r + reach, phi)];
        // If a part of the object is not seen, its image may end anywhere.
        let Some(around) = places.map(|(r, phi)| seen(r, phi)).into_iter().collect::<Option<Vec<_>>>() else {
            return anywhere;
        };
        let (centre, path) = around[0];
        let (low, high) = around.iter().fold((centre, centre), |(low, high), &(psi, _)| (low.min(psi), high.max(psi)));
        let across = position - n * position.dot(n);
        let distance = across.length();
        // Half its extent in azimuth round the axis: a ball that meets the axis is seen all round.
        let round = if reach < distance { (reach / distance).asin() } else { std::f64::consts::PI };
        let turn = if order.flips() { -1.0 } else { 1.0 };
        // On the axis any side will do: what is left of `across` there is rounding.
        let side = if distance > 1e-9 * r { across * (turn / distance) } else { n.any_orthonormal_vector() };
        let look = n * centre.cos() + side * centre.sin();
        let width = (high - low).min(2.0 * reach / path.max(1e-9)) * self.enlargement(n, side, [low, high], round);
        let steepest = low.sin().max(high.sin()).max(if low < FRAC_PI_2 && high > FRAC_PI_2 { 1.0 } else { 0.0 });
        Extent { look, radius: (high - centre).max(centre - low) + round * steepest, width }
    }

    /// The largest number of pixels per radian of ψ on the screen, by aberration and by the projection onto the plane screen. For
    /// directions between two angles from outwards `n`, up to `round` (radians of azimuth) on both sides of `side`.
    fn enlargement(&self, n: DVec3, side: DVec3, [low, high]: [f64; 2], round: f64) -> f64 {
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(1e-4));
        let edge = 1.1 * (0.5 * self.camera.field_of_view).tan() * self.aspect.unwrap_or(1.0).max(1.0);
        let enlarged = |k: i32| {
            let (sine, cosine) = (0.25 * f64::from(k) * round).sin_cos();
            let side = side * cosine + n.cross(side) * sine;
            let [a, b] = [middle - half, middle + half].map(|psi| self.camera.seen_direction(n * psi.cos() + side * psi.sin()));
            let [p, q] = [a, b].map(|seen| DVec2::new(seen.x, seen.y) / -seen.z);
            let on_screen = |seen: DVec3, at: DVec2| seen.z < 0.0 && at.abs().max_element() < edge;
            // Off the screen the projection does not count.
            let length = if on_screen(a, p) || on_screen(b, q) { p.distance(q) } else { a.angle_between(b) };
            length / (2.0 * half * self.pixel)
        };
        // A tenth of a radian is enlarged alike all along it.
        let step = if round < 0.1 { 4 } else { 1 };
        (-4..=4).step_by(step).map(enlarged).fold(0.0, f64::max)
    }
}

fn row(v: DVec3, w: f64) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, w as f32]
}

fn columns(m: DMat3) -> [[f32; 4]; 3] {
    [row(m.x_axis, 0.0), row(m.y_axis, 0.0), row(m.z_axis, 0.0)]
}

/// Columns with a vector in what is left of them.
fn columns_and(m: DMat3, v: DVec3) -> [[f32; 4]; 3] {
    [row(m.x_axis, v.x), row(m.y_axis, v.y), row(m.z_axis, v.z)]
}

fn light_rows(light: &Surroundings) -> [[f32; 4]; 3] {
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

/// The row `axis` of an instance at `position`: its coordinates across the axis (x, y), by how much rounding may move a point of the object
/// (z), in r_s, and a strictness of 1 (w).
pub(super) fn by_axis(camera: &Observer, instance: &Instance, position: DVec3, reach: f64) -> [f32; 4] {
    let [_, a, b] = camera.axis_frame();
    let [vx, vy, vz, moves] = instance.velocity.map(f64::from);
    let speed = if moves == 0.0 { 0.0 } else { DVec3::new(vx, vy, vz).length() };
    let rounding = ROUNDING * (reach + speed * f64::from(instance.offset[3]).abs());
    let aside = BESIDE * rounding;
    // In a direction that nobody chooses.
    [(position.dot(a) + 0.79 * aside) as f32, (position.dot(b) + 0.61 * aside) as f32, rounding as f32, 1.0]
}

fn held(camera: &Observer, position: DVec3, attitude: DQuat, object: &Object) -> Instance {
    let turn = DMat3::from_quat(attitude);
    Instance {
        offset: row(position - camera.position, 0.0),
        position: row(position, 0.0),
        momentum: [0.0, 0.0, 0.0, 1.0],
        shape: columns(turn * object.scale),
        turn: columns(turn),
        light: light_rows(&object.light),
        triangles: [0, 0, 0, HELD],
        ..Instance::default()
    }
}

/// Factor by which points of an object may be farther from its centre when their light leaves than at one time. Light leaves a farther
/// point earlier by the delay's gradient ∇Δ. Meanwhile the object moves with velocity v, which adds v ∇Δ/(1 + v ∇Δ).
fn drawn_out(camera: &Observer, instance: &Instance, position: DVec3, order: Order, age: f64) -> f64 {
    let [x, y, z, moves] = instance.velocity.map(f64::from);
    if moves == 0.0 {
        return 1.0;
    }
    let velocity = DVec3::new(x, y, z);
    let Some((_, gradient)) = light_path(camera, position, order, branch_of(camera, position, age)) else { return f64::INFINITY };
    1.0 + ACCELERATES * velocity.length() * gradient.length() / (1.0 + velocity.dot(gradient)).max(1e-6)
}

/// Factor on that for acceleration while light crosses the object.
const ACCELERATES: f64 = 1.5;

/// The emission time of the centre of a flying body that is seen at `time`, as the settings ask for; None if it is not seen.
pub fn departure(view: &View, time: f64, history: &History, order: Order) -> Option<f64> {
    match view.settings {
        Settings { light_delay: false, .. } => Some(time),
        Settings { method: Method::Flat, .. } => flat_emission_time(view.camera, time, history),
        _ => emission_time(view.camera, time, history, order),
    }
}

/// The instance, the object's position at the emission time, and the age of its light.
fn flying(view: &View, time: f64, history: &History, order: Order, object: &Object) -> Option<(Instance, DVec3, f64)> {
    let camera = view.camera;
    let emission = departure(view, time, history, order)?;
    let sample = history.at(emission);
    let turn = DMat3::from_quat(sample.attitude);
    let swing = Swing::new(history, emission, object.reach);
    let still = !view.settings.light_delay;
    let p = sample.momentum;
    let momentum = if view.settings.method.bends() { sample.momentum } else { against_static(sample.position, sample.momentum) };
    let instance = Instance {
        offset: row(sample.position - camera.position, time - emission),
        position: row(sample.position, 0.0),
        velocity: row(sample.velocity, if still { 0.0 } else { object.scale }),
        momentum: row(momentum, gamma(momentum)),
        shape: columns_and(contraction(p) * turn * object.scale, swing.acceleration),
        spin: row(swing.spin, p.x),
        spin_rate: row(swing.spin_rate, p.y),
        jolt: row(swing.jolt, swing.jolt_after),
        force: row(swing.force, p.z),
        turn: columns_and(turn, swing.jerk),
        snap: row(swing.snap, 0.0),
        light: light_rows(&object.light),
        ..Instance::default()
    };
    Some((instance, sample.position, time - emission))
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

/// Travel time of light of this order from a position on the slice to the camera, in r_s/c, and its gradient over the position. None if
/// there is no ray.
pub fn light_path(camera: &Observer, position: DVec3, order: Order, branch: Branch) -> Option<(f64, DVec3)> {
    let (l, r) = (camera.radius(), position.length());
    let n = camera.position / l;
    let across = position - n * position.dot(n);
    let phi = across.length().atan2(position.dot(n)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, branch)?;
    // dΔ/dx = −k/E at the point, k the photon's spatial momentum there.
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let turn = if order.flips() { -1.0 } else { 1.0 };
    let m = position / r;
    let tangent = (side * (m.dot(n)) - n * m.dot(side)) * turn;
    let (u, w, e) = (1.0 / r, ray.emission_slope, ray.energy);
    let beta = u.sqrt();
    let radial = if e > 0.0 && (w < 0.0 || u >= 1.0) { (u * u - e * e) / (beta * e - w) } else { (beta * e + w) / (1.0 - u) };
    let momentum = (m * radial - tangent * u) / e;
    ray.delay.is_finite().then_some((ray.delay, -momentum))
}

/// Which of the two rays from a position inside the horizon to a camera inside belongs to light of this age (r_s/c): E < 0 if it is older
/// than light of zero energy.
pub fn branch_of(camera: &Observer, position: DVec3, age: f64) -> Branch {
    let (u, u_camera) = (1.0 / position.length(), 1.0 / camera.radius());
    if u > 1.0 && u_camera > 1.0 && age > light::zero_energy_delay(u, u_camera) { Branch::Minus } else { Branch::Plus }
}

/// The emission time T_e of light that arrives at `time`: the root of T_e + Δ(x(T_e)) − T. It increases strictly with T_e for light of E >
/// 0 and decreases for E < 0. A worldline leaves the camera's past only once, so both branches together have one root. None if the object
/// is not seen.
pub fn emission_time(camera: &Observer, time: f64, history: &History, order: Order) -> Option<f64> {
    leaving(time, |t| {
        let sample = history.at(t);
        let branch = branch_of(camera, sample.position, time - t);
        let (delay, gradient) = light_path(camera, sample.position, order, branch)?;
        let sign = if branch == Branch::Minus { -1.0 } else { 1.0 };
        Some((sign * (t + delay - time), sign * (1.0 + gradient.dot(sample.velocity))))
    })
}

/// The same for straight light.
fn flat_emission_time(camera: &Observer, time: f64, history: &History) -> Option<f64> {
    leaving(time, |t| {
        let sample = history.at(t);
        let line = sample.position - camera.position;
        // Seen across the hole a ship may fall faster than straight light.
        Some((t + line.length() - time, (1.0 + line.normalize_or_zero().dot(sample.velocity)).max(0.05)))
    })
}

/// The root of an increasing function of T_e, given with its slope. It is negative in the camera's past and has no value where no light
/// leaves any more. Newton's method within a bracket, from `time` backwards.
fn leaving(time: f64, late: impl Fn(f64) -> Option<(f64, f64)>) -> Option<f64> {
    let (mut low, mut high) = (f64::NEG_INFINITY, time);
    let mut t = time - late(time).map_or(1.0, |(missing, _)| missing.max(0.0));
    for _ in 0..100 {
        let next = match late(t) {
            // For a camera outside, a body below the horizon has no ray: too late.
            None => {
                high = high.min(t);
                if low.is_finite() { 0.5 * (low + high) } else { t - (time - t).max(1.0) }
            }
            Some((missing, slope)) => {
                if missing > 0.0 {
                    high = high.min(t)
                } else {
                    low = low.max(t)
                }
                // 1e-12 of the delay: f64 has no more.
                if missing.abs() <= 1e-12 * (1.0 + (time - t).abs()) {
                    return Some(t);
                }
                let newton = t - missing / slope.max(1e-3);
                if newton > low && newton < high {
                    newton
                } else if low.is_finite() {
                    0.5 * (low + high)
                } else {
                    t - 2.0 * (time - t).max(1.0)
                }
            }
        };
        if next == t || time - next > 1e7 {
            break;
        }
        t = next;
    }
    // The bracket has closed on a place without a ray, or to rounding.
    (low.is_finite() && high - low <= 1e-9 * (1.0 + (time - low).abs())).then_some(low)
}
