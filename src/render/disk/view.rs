//! The disk of one frame, computed in f64: its axes as the camera sees them, the circles to draw in each order, the generations of streaks.

use crate::spacetime::Observer;
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::lensing::Slice;
use crate::render::frame::FrameInput;
use crate::scene::disk::radial::smoothstep;
use crate::scene::disk::{DISK_UNIT, OFFSET_STEP, RENEWAL, SHEARED};

use crate::render::disk::circles::{AZIMUTHS, Circles, FROM_FAR, FROM_NEAR, Look, RingBend, SeenCircle, azimuth, pixel_angle, radii};
use crate::render::disk::drawn::DrawnDisk;
use crate::render::disk::sigma::sigma;
use crate::render::disk::types::{Bend, Circle, DiskFrame, Ring};

/// Least |sine| of the camera's height over the plane. In the plane itself the disk is seen edge on and its image has no width.
const LEAST_HEIGHT: f64 = 1e-5;
/// Sine of the camera's height over the plane below which the image of a circle has corners: it consists of a line in the plane and of the
/// half ring that light from behind the hole makes. The corner takes a part of σ of the order of the root of this sine, no more than a
/// segment.
const CORNERED: f64 = 0.03;
/// Half widths, in pixels, between which an image goes over from the mean gas of a thin image to the gas of each circle. As in
/// shaders/disk/types.wgsl.
const MEAN: [f64; 2] = [0.75, 2.0];
/// Number of circles, at each azimuth, over which the mean gas of a thin image is taken. As in shaders/disk/arcs/place.wgsl.
pub const THIN_SAMPLES: usize = 8;
/// Cuts are left out while arcs on the outermost circle are shorter than this many pixels; splitting arcs into segments restores the shape.
const LEAST_ARC: f64 = 128.0;
/// If the camera is nearer to the disk than this, in r_s, order 1 is drawn as from near: each pixel uses the smooth pattern and computes
/// the slant itself. From there on a texel of the far pattern is hardly larger than a pixel of the default picture.
const CLOSE: f64 = 10.0;
/// The same for orders 2 and 3. Their images are narrow unless the camera is close to the disk.
const CLOSE_BEHIND: f64 = 3.0;
/// How much longer than a straight one a light path past the hole may be, for orders up to 3, in r_s.
const DETOUR: f64 = 60.0;

/// The disk as one frame's camera sees it.
#[derive(Clone, Debug)]
pub struct DiskView {
    /// For the shaders; the arc pass fills in the places in its buffers.
    pub frame: DiskFrame,
    /// Circles of all orders.
    pub circles: Vec<Circle>,
    /// Behind `circles` in the same buffer: the circles over which the mean gas of thin images is taken.
    pub samples: Vec<Circle>,
    /// σ of the cuts, in rad.
    pub cuts: Vec<f32>,
    /// The rings between them.
    pub rings: Vec<Ring>,
    /// For each circle, by azimuth: the deviation of the middle of the ring that begins there ([`RingBend`]).
    pub bends: Vec<Bend>,
    /// Orders up to this one are drawn as from near, with fine structure; 0 from far.
    pub close: u32,
}

impl DiskView {
    /// For the camera and time of `input` and a picture `width` pixels wide.
    pub fn new(disk: &DrawnDisk, input: &FrameInput, slice: &Slice, width: u32) -> DiskView {
        let camera = &input.camera;
        let plane = Plane::seen_by(camera);
        let mut view = DiskView {
            frame: DiskFrame::default(),
            circles: Vec::new(),
            samples: Vec::new(),
            cuts: sigmas(&chosen_cuts(disk, camera, width), plane.origin(), plane.height.abs()),
            rings: Vec::new(),
            bends: Vec::new(),
            close: close_orders(disk, camera),
        };
        for order in 1..=3 {
            // The third order is drawn, behind the second, even if the settings do not ask for it, where it is wider than the pixel budget.
            let look = Look { disk, camera, slice, order, width, beaming: input.settings.beaming };
            let ring_error = f64::from(input.settings.ring_error);
            let unasked = order > input.settings.orders;
            if unasked && (order < 3 || input.settings.orders < 2 || widest(&look) < f64::from(input.settings.pixel_error)) {
                continue;
            }
            view.add_image(&look, &plane, ring_error);
        }
        let count = view.circles.len() as u32;
        view.circles.iter_mut().for_each(|circle| circle.first_sample += count);
        view.frame = view.frame(disk, input, &plane);
        view
    }

    /// Adds the circles, rings and samples of one image order; rings may be off by `ring_error` times as much as at the finest.
    fn add_image(&mut self, look: &Look, plane: &Plane, ring_error: f64) {
        let Look { disk, camera, order, width, .. } = *look;
        let first = self.circles.len() as u32;
        let seen: Vec<SeenCircle> = radii(disk, order <= self.close).into_iter().map(|r| look.circle(r)).collect();
        let own = own_shares(camera, &seen, width, order);
        let gaps = disk.config.gap > 0.0;
        let rows = if gaps {
            Circles::straight(if order == 1 { disk.arcs.circles.clone() } else { gap_middles(disk) }, disk.arcs.rings.clone())
        } else {
            let within = if order == 1 && self.close > 0 { FROM_NEAR } else { FROM_FAR };
            look.rows(&seen, &own, within.times(ring_error))
        };
        let last = first + rows.radii.len() as u32 - 1;
        let behind = self.samples.len() as u32;
        if order > 1 {
            for azimuth in 0..AZIMUTHS {
                let shares = equal_shares(&seen, azimuth).into_iter();
                self.samples.extend(shares.map(|r| sample(disk, r, (order == 3).then(|| through_second(plane, azimuth, r)))));
            }
        }
        let on_row = |&r: &f64| Circle {
            gas: disk.gas_at(r),
            beyond: (r * plane.level - plane.l) as f32,
            order,
            first_row: first,
            last_row: last,
            first_sample: behind,
            ..Circle::default()
        };
        let mut own: Vec<Circle> = rows.radii.iter().map(on_row).collect();
        if gaps {
            let [_, end] = disk.gas.extent();
            for (circle, closed) in own.iter_mut().zip(gap_middles(disk)) {
                circle.gap_radius = closed as f32;
                circle.gap = disk.config.gap as f32;
                circle.gap_sides = if closed < end { 2.0 } else { 1.0 };
            }
        }
        self.circles.extend(own);
        self.bends.extend(rows.bends.iter().flatten().map(RingBend::for_gpu));
        self.rings.extend(rows.pairs.into_iter().map(|[a, b]| Ring { inner: first + a, outer: first + b, order, unused: 0 }));
    }

    /// What the shaders are told, once all images are added. The camera's time is counted from the first generation of
    /// streaks that can be seen.
    fn frame(&self, disk: &DrawnDisk, input: &FrameInput, plane: &Plane) -> DiskFrame {
        let (time, settings) = (input.time, &input.settings);
        let [_, end] = disk.gas.extent();
        let nearest = (plane.l - end).max(0.0);
        let base = ((time - nearest - 2.0 * end - DETOUR) / RENEWAL).floor() - 1.0;
        let [x, y] = disk.gas.offset(base as i64);
        let cuts = self.cuts.len() as u32;
        DiskFrame {
            towards: plane.towards.as_vec3().to_array(),
            camera_sine: plane.height as f32,
            sideways: plane.sideways.as_vec3().to_array(),
            camera_cosine: plane.level as f32,
            upwards: plane.upwards.as_vec3().to_array(),
            steepness: plane.height.abs() as f32,
            renewals: (time / RENEWAL - base) as f32,
            renewals_per_time: (1.0 / RENEWAL) as f32,
            renewal: RENEWAL as f32,
            newborn: SHEARED as f32,
            contrast: disk.gas.contrast as f32,
            filled: 1.0 - disk.config.gap as f32,
            error_budget: disk.config.error_budget as f32 * settings.ring_error,
            least_width: disk.min_width as f32,
            columns: 2 * cuts - 1,
            arcs: cuts - 1,
            rows: self.circles.len() as u32,
            rings: self.rings.len() as u32,
            near_orders: self.close,
            thickness: disk.gas.thickness as f32,
            unit: DISK_UNIT as f32,
            close: CLOSE as f32,
            most_looks: settings.gas_looks,
            offset: [x, y].map(|value| value as f32),
            offset_step: OFFSET_STEP.map(|value| value as f32),
            // The room and the lists are those of the pass.
            ..DiskFrame::default()
        }
    }
}

/// The disk's plane as a camera sees it: unit vectors in the scene's axes, the sine of the camera's height over it.
struct Plane {
    /// Radius of the camera, in r_s.
    l: f64,
    /// Sine of the camera's height, at least [`LEAST_HEIGHT`] in size.
    height: f64,
    /// Cosine of the camera's height.
    level: f64,
    /// In the plane, towards the camera.
    towards: DVec3,
    /// In the plane, across that.
    sideways: DVec3,
    /// Across the direction from the hole to the camera, upwards.
    upwards: DVec3,
}

impl Plane {
    fn seen_by(camera: &Observer) -> Plane {
        let l = camera.radius();
        let n = camera.position / l;
        let height = if n.z.abs() < LEAST_HEIGHT { LEAST_HEIGHT.copysign(n.z) } else { n.z };
        let towards = DVec3::new(n.x, n.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        Plane { l, height, level, towards, sideways: DVec3::Z.cross(towards), upwards: DVec3::Z * level - towards * n.z }
    }

    /// Azimuth of the camera, in rad.
    fn origin(&self) -> f64 {
        self.towards.y.atan2(self.towards.x)
    }
}

/// Orders up to this one are drawn as from near, with fine structure; 0 from far.
fn close_orders(disk: &DrawnDisk, camera: &Observer) -> u32 {
    let [_, end] = disk.gas.extent();
    let near = |limit: f64| camera.position.z.abs() < limit && camera.radius() < end + limit;
    if near(CLOSE_BEHIND) { 3 } else { u32::from(near(CLOSE)) }
}

/// For a disk with gaps between its rings: for each circle the middle of the gap beside it, in r_s. The circle is moved there where the gap
/// is too narrow to be seen. The outermost circle goes to the edge of the disk.
fn gap_middles(disk: &DrawnDisk) -> Vec<f64> {
    let mut radii = disk.arcs.circles.clone();
    for pair in disk.arcs.rings.windows(2) {
        let [a, b] = [pair[0][1] as usize, pair[1][0] as usize];
        let middle = 0.5 * (radii[a] + radii[b]);
        (radii[a], radii[b]) = (middle, middle);
    }
    if let Some(last) = radii.last_mut() {
        *last = last.max(disk.gas.extent()[1]);
    }
    radii
}

/// The share of a circle's own gas that an image shows, by azimuth; the rest is the mean gas of the whole image. 1 for order 1 and for wide
/// images, 0 for thin ones.
fn own_shares(camera: &Observer, seen: &[SeenCircle], width: u32, order: u32) -> [f64; AZIMUTHS] {
    let widths = widths(camera, &seen[0], &seen[seen.len() - 1], width);
    widths.map(|width| if order == 1 { 1.0 } else { smoothstep(MEAN[0], MEAN[1], 0.5 * width) })
}

/// Radii that divide the seen width of an image into equal parts at one of the azimuths, each in the middle of its part.
fn equal_shares(seen: &[SeenCircle], azimuth: usize) -> [f64; THIN_SAMPLES] {
    let mut before = vec![0.0];
    for pair in seen.windows(2) {
        let share = pair[0].angle_to(&pair[1], azimuth);
        // Where there is no ray nothing is seen. Without any ray the radii themselves are divided equally.
        let share = if share.is_finite() { share } else { 0.0 } + 1e-12 * (pair[1].radius - pair[0].radius);
        before.push(before[before.len() - 1] + share);
    }
    let whole = before[before.len() - 1];
    std::array::from_fn(|k| {
        let wanted = whole * (k as f64 + 0.5) / THIN_SAMPLES as f64;
        let i = before.partition_point(|&share| share <= wanted).clamp(1, seen.len() - 1);
        let t = (wanted - before[i - 1]) / (before[i] - before[i - 1]).max(1e-300);
        seen[i - 1].radius + t.clamp(0.0, 1.0) * (seen[i].radius - seen[i - 1].radius)
    })
}

/// The radius, in r_s, at which light of the third image crosses the disk's plane on its way, where the second image lies. It left radius
/// `r` at azimuth number `k` and makes half a turn between the two crossings. Both ends of the ray wind off the photon sphere like the rays
/// that wind for ever: u + 1/3 = ((1 − ρ)/(1 + ρ))², with ρ growing by a factor of e per radian (Chandrasekhar 1983, section 20). Near the
/// photon sphere the two deviations of u add up.
fn through_second(plane: &Plane, k: usize, r: f64) -> f64 {
    let from_photon_sphere = |r: f64, turned: f64| {
        let y = (1.0 / r + 1.0 / 3.0).sqrt();
        let rho = (1.0 - y) / (1.0 + y) * (-turned).exp();
        ((1.0 - rho) / (1.0 + rho)).powi(2) - 1.0
    };
    let angle = (azimuth(k).cos() * plane.level).acos();
    1.0 / (2.0 / 3.0 + from_photon_sphere(plane.l, PI + angle) + from_photon_sphere(r, PI))
}

/// The width of the image of an order where it is widest, in pixels.
fn widest(look: &Look) -> f64 {
    let [inner, outer] = look.disk.gas.extent().map(|r| look.circle(r));
    widths(look.camera, &inner, &outer, look.width).into_iter().fold(0.0, f64::max)
}

/// The width of the image between two circles at each azimuth, in pixels of the middle of a picture `width` pixels wide.
fn widths(camera: &Observer, inner: &SeenCircle, outer: &SeenCircle, width: u32) -> [f64; AZIMUTHS] {
    let pixel = pixel_angle(camera, width);
    // An angle in the camera's frame is that in the rain frame over the frequency ratio. Of the camera's momentum only the outward part
    // counts here: it acts alike at all azimuths.
    let gamma = (1.0 + camera.momentum.length_squared()).sqrt();
    let outward = camera.momentum.dot(camera.position) / camera.radius();
    std::array::from_fn(|k| {
        let [a, b] = [inner.places[k], outer.places[k]];
        let frequency = gamma + outward * (a.normalize() + b.normalize()).normalize().x;
        inner.angle_to(outer, k) / (pixel * frequency)
    })
}

/// The cuts to use: so many that arcs are long enough to be told apart.
fn chosen_cuts(disk: &DrawnDisk, camera: &Observer, width: u32) -> Vec<f64> {
    let all = disk.arcs.cuts.len() - 1;
    let [_, end] = disk.gas.extent();
    let l = camera.radius();
    if l < 1.5 * end {
        return disk.arcs.cuts.clone();
    }
    let pixel = pixel_angle(camera, width);
    let round = TAU * end / l / pixel / LEAST_ARC;
    let count = (round.ceil() as usize).clamp(16.min(all), all);
    (0..=count).map(|k| disk.arcs.cuts[k * all / count]).collect()
}

/// σ of the cuts, for a camera at azimuth `origin` whose height over the plane has the sine `height`. Close to the plane there is also a
/// cut at each corner of the image, where θ + α is an odd multiple of a quarter turn: then the segments on both sides of it can be even,
/// although their number comes from the middle of the arc alone.
fn sigmas(cuts: &[f64], origin: f64, height: f64) -> Vec<f32> {
    let mut all: Vec<f32> = cuts.iter().map(|azimuth| sigma(azimuth - origin, height) as f32).collect();
    if height < CORNERED {
        let [first, last] = [all[0], all[all.len() - 1]];
        let corners = (-4..12).map(|k| (PI * (0.5 * f64::from(k) + 0.25)) as f32);
        all.extend(corners.filter(|corner| (first..last).contains(corner)));
        all.sort_by(f32::total_cmp);
    }
    all
}

/// A circle that counts in the mean gas of a thin image. Light of the third image crosses the second at the radius `through`.
fn sample(disk: &DrawnDisk, r: f64, through: Option<f64>) -> Circle {
    let nearer = disk.gas_at(through.unwrap_or(r));
    Circle {
        gas: disk.gas_at(r),
        nearer_depth: through.map_or(0.0, |_| nearer.depth),
        nearer_outward: nearer.outward,
        nearer_along: nearer.along,
        nearer_radius: nearer.radius,
        ..Circle::default()
    }
}
