//! Where each object is seen: for each image order the emission time of its centre and the motion around it, in f64, as the GPU's start.

use glam::{DMat3, DQuat, DVec3};

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_at;
pub use crate::scene::lighting::Surroundings;
use crate::sim::History;
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::matter::gamma;

use super::frame::Camera;
use super::models::ModelRange;
use super::types::Placement;

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
    /// How it moves.
    pub motion: Motion<'a>,
    /// Farthest point of the object from its centre, in r_s.
    pub reach: f64,
    /// Length in r_s of one unit of the model along each body axis.
    pub scale: DVec3,
    /// A number for the layers of a picture, from 1.
    pub id: u32,
    /// Whether both sides of its triangles are drawn.
    pub two_sided: bool,
    /// What shines on it.
    pub light: Surroundings,
}

/// An object in one order, ready for the GPU.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Its model.
    pub model: ModelRange,
    /// What the shader gets; the renderer fills in the places in its buffers.
    pub placement: Placement,
}

/// The placements of an object in orders 1 to `orders`, seen by `camera` at the clock's `time`. An order in which the centre is not seen
/// (it has not been reached by light yet, or never will) is left out.
pub fn place(view: &View, time: f64, object: &Object, orders: u32) -> Vec<Placed> {
    let camera = view.camera;
    Order::ALL
        .into_iter()
        .take(orders as usize)
        .filter_map(|order| {
            let (mut placement, position) = match object.motion {
                Motion::Held { position, attitude } => (held(camera, position, attitude, object), position),
                Motion::Flying(history) => flying(camera, time, history, order, object)?,
            };
            placement.ids = [u32::from(order.number()), object.id, 0, 0];
            let width = view.width(position, object.reach, order) / view.pixel;
            if width < LEAST_PIXELS && order.number() > 1 {
                return None;
            }
            if width < THIN_PIXELS {
                placement.triangles[3] |= THIN;
            }
            // Near the hole, against its size, an image is drawn out round the ring and shows more than its width tells.
            let small = width < COARSE_PIXELS && object.reach < 0.1 * position.length();
            let model = if small { object.coarse } else { object.model };
            Some(Placed { model, placement })
        })
        .collect()
}

/// Two-sided triangles; as in shaders/types.wgsl.
const TWO_SIDED: u32 = 1;
/// Held in place; as in shaders/types.wgsl.
const HELD: u32 = 2;
/// A thin image; as in shaders/types.wgsl.
pub const THIN: u32 = 4;
/// Images narrower than this are drawn as thin ones, in pixels: from here down single triangles would miss pixel centres.
const THIN_PIXELS: f64 = 2.0;

/// Images of order 2 and 3 narrower than this are not drawn: a line a pixel wide, of which they cover a twentieth, is lost among the stars that
/// crowd at the edge of the shadow. The stages of geometry would take longer over such a line than over the ship itself.
const LEAST_PIXELS: f64 = 0.05;
/// Images narrower than this show the coarse model: its cells (a sixth of the object) are then a pixel wide.
const COARSE_PIXELS: f64 = 6.0;

/// A camera with what is needed to say how wide an image is.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The table at its radius.
    pub slice: &'a Slice,
    /// Angle of a pixel in radians.
    pub pixel: f64,
}

impl View<'_> {
    /// The width, in radians, of the image of a ball of radius `reach` at `position`: its extent in ψ, or its angular size if that is less.
    /// Estimated from the ball's nearest, farthest and outermost points in the plane of the axis.
    fn width(&self, position: DVec3, reach: f64, order: Order) -> f64 {
        let (l, r) = (self.camera.radius(), position.length());
        let n = self.camera.position / l;
        let phi = position.dot(n).clamp(-r, r) / r;
        let phi = phi.acos();
        let half = if reach < r { (reach / r).asin() } else { return std::f64::consts::PI };
        let seen = |r: f64, phi: f64| {
            let (sine, cosine) = phi.clamp(0.0, std::f64::consts::PI).sin_cos();
            let ray =
                lens_lookup_at(self.slice, (r * cosine - l) as f32, (r * sine) as f32, (r * cosine) as f32, u32::from(order.number()));
            (f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)), f64::from(ray.delay))
        };
        let (centre, path) = seen(r, phi);
        let around = [seen(r, phi - half).0, seen(r, phi + half).0, seen((r - reach).max(1.001), phi).0, seen(r + reach, phi).0];
        let (low, high) = around.iter().fold((centre, centre), |(low, high), &psi| (low.min(psi), high.max(psi)));
        (high - low).min(2.0 * reach / path.max(1e-9))
    }
}

fn row(v: DVec3, w: f64) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, w as f32]
}

fn columns(m: DMat3) -> [[f32; 4]; 3] {
    [row(m.x_axis, 0.0), row(m.y_axis, 0.0), row(m.z_axis, 0.0)]
}

fn light_rows(light: &Surroundings) -> [[f32; 4]; 3] {
    std::array::from_fn(|c| {
        let [x, y, z] = light.directed[c];
        [x, y, z, light.ambient[c]]
    })
}

fn held(camera: &Camera, position: DVec3, attitude: DQuat, object: &Object) -> Placement {
    let turn = DMat3::from_quat(attitude);
    Placement {
        offset: row(position - camera.position, 0.0),
        momentum: [0.0, 0.0, 0.0, 1.0],
        shape: columns(turn * DMat3::from_diagonal(object.scale)),
        turn: columns(turn),
        light: light_rows(&object.light),
        triangles: [0, 0, 0, HELD | if object.two_sided { TWO_SIDED } else { 0 }],
        ..Placement::default()
    }
}

fn flying(camera: &Camera, time: f64, history: &History, order: Order, object: &Object) -> Option<(Placement, DVec3)> {
    let emission = emission_time(camera, time, history, order)?;
    let at = |t: f64| {
        let sample = history.at(t);
        (sample, DMat3::from_quat(sample.attitude) * DMat3::from_diagonal(object.scale))
    };
    let (sample, body) = at(emission);
    let shape = contraction(sample.momentum) * body;
    // The change of the shape over a short while: turning and acceleration. The while is that of light across the object, or a step.
    let span = object.scale.max_element().max(1e-3);
    let (later, later_body) = at(emission + span);
    let rate = (contraction(later.momentum) * later_body - shape) * (1.0 / span);
    let placement = Placement {
        offset: row(sample.position - camera.position, time - emission),
        velocity: row(sample.velocity, 1.0),
        momentum: row(sample.momentum, gamma(sample.momentum)),
        shape: columns(shape),
        shape_rate: columns(rate),
        turn: columns(DMat3::from_quat(sample.attitude)),
        light: light_rows(&object.light),
        triangles: [0, 0, 0, if object.two_sided { TWO_SIDED } else { 0 }],
        ..Placement::default()
    };
    Some((placement, sample.position))
}

/// The Lorentz contraction of a body of momentum p per mass, on the rain frame's slice: 1 − p pᵀ/(γ(1 + γ)).
fn contraction(p: DVec3) -> DMat3 {
    let g = gamma(p);
    DMat3::IDENTITY - DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (g * (1.0 + g)))
}

/// Travel time of light of this order from a place on the slice to the camera, and its gradient over the place; None if there is none.
pub fn light_path(camera: &Camera, position: DVec3, order: Order) -> Option<(f64, DVec3)> {
    let (l, r) = (camera.radius(), position.length());
    let n = camera.position / l;
    let across = position - n * position.dot(n);
    let phi = across.length().atan2(position.dot(n)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, Branch::Plus)?;
    // dΔ/dx = −k/E at the point, k the photon's spatial momentum there.
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let turn = if order.flips() { -1.0 } else { 1.0 };
    let m = position / r;
    let tangent = (side * (m.dot(n)) - n * m.dot(side)) * turn;
    let (u, w, e) = (1.0 / r, ray.emission_slope, ray.energy);
    let beta = u.sqrt();
    let radial = if w < 0.0 || u >= 1.0 { (u * u - e * e) / (beta * e - w) } else { (beta * e + w) / (1.0 - u) };
    let momentum = (m * radial - tangent * u) / e;
    ray.delay.is_finite().then_some((ray.delay, -momentum))
}

/// The time T_e at which the light left that arrives at `time`: the root of T_e + Δ(x(T_e)) − T, which increases strictly with T_e.
/// Bracketed Newton; None if the object is seen at no time.
pub fn emission_time(camera: &Camera, time: f64, history: &History, order: Order) -> Option<f64> {
    let late = |t: f64| -> Option<(f64, f64)> {
        let sample = history.at(t);
        let (delay, gradient) = light_path(camera, sample.position, order)?;
        Some((t + delay - time, 1.0 + gradient.dot(sample.velocity)))
    };
    // Seen from outside, something below the horizon has no ray: too late.
    let (mut low, mut high) = (f64::NEG_INFINITY, time);
    let mut t = time - light_path(camera, history.at(time).position, order).map_or(1.0, |(delay, _)| delay);
    for _ in 0..100 {
        let next = match late(t) {
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
