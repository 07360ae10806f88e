//! Where each object is seen: for each image order the emission time of its centre and the motion around it, in f64, as the GPU's start.

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
    /// Held in place (every point of it), at a position on the slice, with an attitude (body to rain axes). Its shape is taken on the slice.
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
    /// What stands for it where its image is only a few pixels wide.
    pub coarse: ModelRange,
    /// What stands for it in wider images, up to so many pixels, the coarsest first.
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
    /// What the shader gets; the renderer fills in the places in its buffers.
    pub instance: Instance,
}

/// The instances of an object in orders 1 to `orders`, seen by `camera` at the clock's `time`. An order in which the centre is not seen
/// (it has not been reached by light yet, or never will) is left out.
///
/// A camera inside the horizon sees what is held inside twice, by light of E > 0 and of E < 0 that left at two times. The worldline of
/// something that moves is met once: it leaves the camera's past on one side or on the other, and each vertex finds out which.
pub fn instances_of(view: &View, time: f64, object: &Object, orders: u32) -> Vec<Placed> {
    let camera = view.camera;
    let settings = view.settings;
    let image = |order: Order, branch: Branch| {
        let (mut instance, position, age) = match object.motion {
            // From inside, higher orders show only what is outside.
            Motion::Held { position, .. } if order.number() > 1 && position.length() + object.reach < 1.0 => return None,
            Motion::Held { position, attitude } => {
                (held(camera, position, attitude, object), position, if branch == Branch::Minus { f64::from(OLD) } else { 0.0 })
            }
            Motion::Flying(history) => flying(view, time, history, order, object)?,
        };
        instance.ids = [u32::from(order.number()), object.id, 0, 0];
        instance.axis = by_axis(camera, &instance, position, object.reach);
        // Within this of its centre are all points of it, each where its light leaves.
        let whole = position.z.abs() > MARGIN * object.reach;
        instance.snap[3] = if whole { plane_crossings(camera.position.z, position.z, order) as f32 } else { -1.0 };
        if !settings.method.bends() {
            // Drawn straight, light leaves otherwise than the shape on the slice is meant for.
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
        // Near the hole, against its size, an image is drawn out round the ring and shows more than its width tells.
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

/// How often light of an image order from `height` over the plane z = 0, or below it, crosses that plane on its way to a camera at another height. It stays in a
/// plane through the hole and sweeps n − 1 to n half turns about it, of which each crosses z = 0 once: n − 1 times or n times, the odd number if its ends lie on
/// different sides. The image is behind as many of the disk's own orders.
pub fn plane_crossings(camera_height: f64, height: f64, order: Order) -> u32 {
    let n = u32::from(order.number());
    let across = (height < 0.0) != (camera_height < 0.0);
    if across == n.is_multiple_of(2) { n - 1 } else { n }
}

/// Images narrower than this are narrow ones, in pixels: of ten columns of pixels two lie at an outline.
const NARROW_BELOW: f64 = 10.0;
/// Thin images lie along the edge of the shadow, and are grown by half a pixel to be lines: their chords are held this much closer, so that sag and growth together stay
/// under a pixel.
const THIN_STRICTNESS: f32 = 4.0;
/// Images narrower than this are slim ones, in pixels: chords of theirs are held the closer, the narrower they are, since all of them are near an outline. The width is
/// that where it is the most; a ring is a tenth as wide elsewhere.
const SLIM_BELOW: f64 = 16.0;
/// But no closer than by this factor.
const MOST_SLIM: f64 = 4.0;
/// Camera radii, in r_s, from which light that circles the hole is seen beside what lies behind it: images there are sheared, and their points are off by more than the
/// chords of the edges around them.
const NEAR_PHOTON_SPHERE: std::ops::RangeInclusive<f64> = 1.3..=1.8;
/// By how much closer chords are held there. With a budget of 0.3 pixels for 0.5 points of balls behind the hole were within half a pixel, at 0.5 by up to 0.59.
const PHOTON_SPHERE_STRICTNESS: f32 = 1.7;
/// Models of so many triangles have short edges, which sag less; held as close, ships behind the hole filled the buffers.
const FINE_MODEL: u32 = 2000;
/// What such models are held closer by.
const MOST_SLIM_FINE: f64 = 2.0;

/// A camera with what is needed to say how wide an image is.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera.
    pub camera: &'a Observer,
    /// The table at its radius.
    pub slice: &'a Slice,
    /// Angle of a pixel in radians.
    pub pixel: f64,
    /// Height over width of the screen: what lies off it is left out. None: nothing is.
    pub aspect: Option<f64>,
    /// How the picture is made.
    pub settings: &'a Settings,
}

/// Where the image of a ball is seen, in the rain frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// The direction of its centre, a unit vector in rain axes.
    pub(super) look: DVec3,
    /// A cone about it, in radians, that holds the image.
    pub(super) radius: f64,
    /// How wide it is on the screen, in pixels, where that is the most: its extent in ψ, or its angular size if that is less.
    pub(super) width: f64,
}

/// The extent is that of a ball at one time, from five of its points: twice as much for the points between, and for what moves.
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
    /// In which direction (a unit vector, rain axes) light that is `age` old comes from a place, and how long its path is. `age` decides, inside the horizon,
    /// which light is meant.
    pub(super) fn look(&self, position: DVec3, order: Order, age: f64) -> Option<(DVec3, f64)> {
        let n = self.camera.position.normalize();
        let height = position.dot(n);
        let across = position - n * height;
        let (psi, path) = self.angle([(position - self.camera.position).dot(n), across.length(), height], order, age)?;
        let turn = if order.flips() { -1.0 } else { 1.0 };
        Some((n * psi.cos() + across.normalize_or_zero() * (turn * psi.sin()), path))
    }

    /// The angle ψ from outwards at which a place is seen, and the length of the light's path: the place by how far it is outward of the camera, across the axis,
    /// and along the axis from the hole.
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
        // Where part of the object is not seen its image ends, as wide as it may be.
        let Some(around) = places.map(|(r, phi)| seen(r, phi)).into_iter().collect::<Option<Vec<_>>>() else {
            return anywhere;
        };
        let (centre, path) = around[0];
        let (low, high) = around.iter().fold((centre, centre), |(low, high), &(psi, _)| (low.min(psi), high.max(psi)));
        let across = position - n * position.dot(n);
        let distance = across.length();
        // Round the axis: a ball that meets it is seen all round.
        let round = if reach < distance { (reach / distance).asin() } else { std::f64::consts::PI };
        let turn = if order.flips() { -1.0 } else { 1.0 };
        // On the axis any side will do; what is left of `across` there is rounding.
        let side = if distance > 1e-9 * r { across * (turn / distance) } else { n.any_orthonormal_vector() };
        let look = n * centre.cos() + side * centre.sin();
        let width = (high - low).min(2.0 * reach / path.max(1e-9)) * self.enlargement(n, side, [low, high], round);
        let steepest = low.sin().max(high.sin()).max(if low < FRAC_PI_2 && high > FRAC_PI_2 { 1.0 } else { 0.0 });
        Extent { look, radius: (high - centre).max(centre - low) + round * steepest, width }
    }

    /// How many pixels a radian of ψ takes on the screen, where that is the most: by the aberration of the camera's motion, and as a plane screen draws what
    /// is seen beside its middle. For directions between two angles from outwards, n, and as far `round` n on both sides of `side` as an image reaches.
    fn enlargement(&self, n: DVec3, side: DVec3, [low, high]: [f64; 2], round: f64) -> f64 {
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(1e-4));
        let edge = 1.1 * (0.5 * self.camera.field_of_view).tan() * self.aspect.unwrap_or(1.0).max(1.0);
        let enlarged = |k: i32| {
            let (sine, cosine) = (0.25 * f64::from(k) * round).sin_cos();
            let side = side * cosine + n.cross(side) * sine;
            let [a, b] = [middle - half, middle + half].map(|psi| self.camera.seen_direction(n * psi.cos() + side * psi.sin()));
            let [p, q] = [a, b].map(|seen| DVec2::new(seen.x, seen.y) / -seen.z);
            let on_screen = |seen: DVec3, at: DVec2| seen.z < 0.0 && at.abs().max_element() < edge;
            // What is off the screen is not drawn out by it.
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

/// How far beside its place an object is drawn, in roundings, so that nothing that was put on the axis of hole and camera, or in a plane through it, is there
/// exactly: such a plane is seen as a ring, of which no point of it tells the azimuth.
const BESIDE: f64 = 4.0;
/// Rounding of f32 in where a point of an object is, relative to the object's reach, and of its emission time, relative to the delay: some roundings of 2⁻²⁴ each.
const ROUNDING: f64 = 4e-7;

/// The row `axis` of an instance at `position`: where that is across the axis, how far a point of the object may be put beside its place by rounding, and 1 for an image
/// that is not slim.
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

/// By how much farther from its centre, at the most, points of an object are where their light leaves than they are at one time: light leaves what is farther earlier by
/// the delay's gradient ∇Δ, and as much earlier again for the way that it moved meanwhile, as v ∇Δ/(1 + v ∇Δ).
fn drawn_out(camera: &Observer, instance: &Instance, position: DVec3, order: Order, age: f64) -> f64 {
    let [x, y, z, moves] = instance.velocity.map(f64::from);
    if moves == 0.0 {
        return 1.0;
    }
    let velocity = DVec3::new(x, y, z);
    let Some((_, gradient)) = light_path(camera, position, order, branch_of(camera, position, age)) else { return f64::INFINITY };
    1.0 + ACCELERATES * velocity.length() * gradient.length() / (1.0 + velocity.dot(gradient)).max(1e-6)
}

/// What acceleration adds to that while light crosses the object, as a factor.
const ACCELERATES: f64 = 1.5;

/// When the light left by which the centre of what flies is seen at `time`, as the settings ask for; None if it is not seen.
pub fn departure(view: &View, time: f64, history: &History, order: Order) -> Option<f64> {
    match view.settings {
        Settings { light_delay: false, .. } => Some(time),
        Settings { method: Method::Flat, .. } => flat_emission_time(view.camera, time, history),
        _ => emission_time(view.camera, time, history, order),
    }
}

/// The instance, where the object then is, and the age of its light.
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

/// The momentum against what hovers there, which takes the part of the rain where light is drawn straight; inside nothing hovers.
pub fn against_static(position: DVec3, momentum: DVec3) -> DVec3 {
    static_momentum(position).map_or(momentum, |rest| relative_momentum(rest, momentum))
}

/// The Lorentz contraction of a body of momentum p per mass, on the rain frame's slice: 1 − p pᵀ/(γ(1 + γ)).
fn contraction(p: DVec3) -> DMat3 {
    let g = gamma(p);
    DMat3::IDENTITY - DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (g * (1.0 + g)))
}

/// Travel time of light of this order from a place on the slice to the camera, and its gradient over the place; None if there is none.
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

/// Which of the two rays from a place inside the horizon to a camera inside is the one by which light of this age (r_s/c) can be seen:
/// that of E < 0 if it is older than light of zero energy.
pub fn branch_of(camera: &Observer, position: DVec3, age: f64) -> Branch {
    let (u, u_camera) = (1.0 / position.length(), 1.0 / camera.radius());
    if u > 1.0 && u_camera > 1.0 && age > light::zero_energy_delay(u, u_camera) { Branch::Minus } else { Branch::Plus }
}

/// The time T_e at which the light left that arrives at `time`: the root of T_e + Δ(x(T_e)) − T, which increases strictly with T_e for light of
/// E > 0 and decreases for E < 0. A worldline leaves the camera's past only once, so there is one root on both branches together.
/// None if the object is seen at no time.
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
        // Across the hole a ship may fall faster than straight light.
        Some((t + line.length() - time, (1.0 + line.normalize_or_zero().dot(sample.velocity)).max(0.05)))
    })
}

/// The root of an increasing function of T_e, given with its slope, that is negative in the camera's past and has no value where no light
/// leaves any more. Bracketed Newton from `time` backwards.
fn leaving(time: f64, late: impl Fn(f64) -> Option<(f64, f64)>) -> Option<f64> {
    let (mut low, mut high) = (f64::NEG_INFINITY, time);
    let mut t = time - late(time).map_or(1.0, |(missing, _)| missing.max(0.0));
    for _ in 0..100 {
        let next = match late(t) {
            // Seen from outside, something below the horizon has no ray: too late.
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
