//! Bounds of the image of an object: the image of a ball that holds it. `shaders/instances/bounds.wgsl` leaves out triangles outside.
//!
//! The image of a ball in one order is bounded by two angles ψ from outwards, and on one side of the axis by the azimuths that the ball
//! reaches. Each bound is a cap of directions: two about the axis, one about the middle of the image. Aberration turns caps into caps. Far
//! from the axis and the horizon the last cap is enough.

use crate::spacetime::Observer;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, DVec4};

use crate::spacetime::light::Order;

use crate::render::gpu::types::Cap;
use crate::render::instances::view::{Extent, InstanceView, MARGIN};

/// The caps of an [`Instance`](crate::render::gpu::types::Instance).
pub type ImageBounds = [Cap; 3];

/// By how many pixels of the screen's middle an image may be drawn beyond that of its ball; half a pixel is the error of patches.
const MARGIN_PIXELS: f64 = 2.0;
/// Factor on the ball's radius, because only some points of it are evaluated: an octagon round a circle reaches 1.08 times as far.
const LARGER: f64 = 1.1;
/// A ball whose radius is below this share of its distances from the axis and from the horizon is seen in one small patch: its extent is
/// enough.
const FAR: f64 = 0.3;
/// Number of points that are evaluated on the ball's circle in the plane of the axis.
const PLACES: u32 = 32;
/// Least radius, in r_s, of points that send light to a camera outside.
const LEAST_RADIUS: f64 = 1.0001;

impl InstanceView<'_> {
    /// The bounds of the image of a ball at `position` (rain axes). Its radius is `longer` times `reach` (r_s); `extent` is that for
    /// `reach`. Inside the horizon `age` decides which light is meant. No bounds if the ball holds the hole or the camera, or if part of it
    /// is not seen.
    pub(super) fn bounds(&self, extent: &Extent, position: DVec3, reach: f64, longer: f64, order: Order, age: f64) -> ImageBounds {
        let camera = self.camera;
        let radius = LARGER * longer * reach;
        // Approximate methods draw images outside of their exact bounds.
        if !self.settings.method.is_exact
            || !radius.is_finite()
            || camera.radius() < 1.0
            || position.length() < radius
            || position.distance(camera.position) < radius
        {
            return ImageBounds::default();
        }
        let from_axis = position.cross(camera.position).length() / camera.radius();
        if radius < FAR * from_axis.min(position.length() - 1.0) {
            let seen = seen_cap(camera, extent.look, MARGIN * longer * extent.radius, MARGIN_PIXELS * self.pixel);
            return [Cap::default(), Cap::default(), seen];
        }
        self.caps(position, radius, order, age).unwrap_or_default()
    }

    fn caps(&self, position: DVec3, reach: f64, order: Order, age: f64) -> Option<ImageBounds> {
        let camera = self.camera;
        let [n, a, _] = camera.axis_frame();
        let height = position.dot(n);
        let across = position - n * height;
        let distance = across.length();
        let turn = (0..PLACES).map(|k| 2.0 * PI * f64::from(k) / f64::from(PLACES)).map(f64::sin_cos);
        let points = turn.map(|(sine, cosine)| [height + reach * cosine, (distance + reach * sine).abs()]);
        let (round, on_axis) = if reach < distance {
            ((reach / distance).asin(), None)
        } else {
            let half = (reach * reach - distance * distance).sqrt();
            (PI, Some([[height - half, 0.0], [height + half, 0.0]]))
        };
        let (mut low, mut high) = (PI, 0.0f64);
        for [height, across] in points.chain(on_axis.into_iter().flatten()) {
            let nearer = (LEAST_RADIUS / height.hypot(across)).max(1.0);
            let [height, across] = [height * nearer, across * nearer];
            let (psi, _) = self.angle([height - camera.radius(), across, height], order, age)?;
            (low, high) = (low.min(psi), high.max(psi));
        }
        let turn = if order.flips() { -1.0 } else { 1.0 };
        let side = if round < PI { across * (turn / distance) } else { a };
        let middle = 0.5 * (low + high);
        let look = n * middle.cos() + side * middle.sin();
        // The farthest point from the middle is on the border of the patch between both angles, at one of its ends in azimuth.
        let farthest = (0..=8).map(|k| {
            let psi = low + (high - low) * f64::from(k) / 8.0;
            (middle.cos() * psi.cos() + middle.sin() * psi.sin() * round.cos()).clamp(-1.0, 1.0).acos()
        });
        let radius = if round < FRAC_PI_2 { farthest.fold(0.0, f64::max) } else { PI };
        let margin = MARGIN_PIXELS * self.pixel;
        Some([seen_cap(camera, n, high, margin), seen_cap(camera, -n, PI - low, margin), seen_cap(camera, look, radius, margin)])
    }
}

/// The cap of directions within `radius` of `middle` (rain axes) as the camera sees it, wider by `margin`; all in radians.
///
/// The cap is d · middle ≥ cos radius for directions d. This is linear in the light's (d, −1), which the Lorentz matrix takes to the
/// camera.
fn seen_cap(camera: &Observer, middle: DVec3, radius: f64, margin: f64) -> Cap {
    if radius >= PI {
        return Cap::default();
    }
    let row: DVec4 = camera.rain_from_camera().transpose() * middle.extend(radius.cos());
    let across = row.truncate();
    let middle = across.normalize();
    let radius = (row.w / across.length()).clamp(-1.0, 1.0).acos() + margin;
    let chord = |angle: f64| 4.0 * (0.5 * angle).sin().powi(2);
    let (middle, rim) = if radius <= FRAC_PI_2 { (middle, chord(radius)) } else { (-middle, -chord((PI - radius).max(0.0))) };
    Cap { middle: middle.as_vec3().to_array(), rim: rim as f32 }
}
