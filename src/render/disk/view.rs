//! The disk of one frame, computed in f64: its axes as the camera sees them, the circles to draw in each order, the generations of streaks.

use crate::spacetime::Observer;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::lensing::Slice;
use crate::render::frame::FrameInput;
use crate::scene::disk::radial::smoothstep;
use crate::scene::disk::{DISK_UNIT, OFFSET_STEP, RENEWAL, SHEARED};

use crate::render::disk::circles::{AZIMUTHS, CircleGas, Circles, FROM_FAR, FROM_NEAR, Look, Offer, SeenCircle, azimuth, pixel_angle};
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

/// How far a camera may move before order 1 is made anew, and before orders 2 and 3 are, over its distance from the gas. Then errors of
/// rings are hardly greater than those of new ones, with twice the second too (`kept_rings_are_as_true_as_new_ones`).
const KEPT: [f64; 2] = [0.01, 0.02];
/// For how many times as long the choice of circles is kept: what is then made anew is the rings between them.
const CHOICE_KEPT: f64 = 3.0;
/// What a change of the camera's momentum counts beside that: light goes as an exponential of its frequency.
const FASTER: f64 = 2.0;

/// The disk as one frame's camera sees it. What is made for one camera is kept for those that hardly differ from it.
#[derive(Clone, Debug)]
pub struct DiskView {
    /// For the shaders; the arc pass fills in the places in its buffers.
    pub frame: DiskFrame,
    /// Circles of all orders; behind them those over which the mean gas of thin images is taken.
    pub circles: Vec<Circle>,
    /// σ of the cuts, in rad.
    pub cuts: Vec<f32>,
    /// The rings between them.
    pub rings: Vec<Ring>,
    /// For each circle, by azimuth: the deviation of the middle of the ring that begins there.
    pub bends: Vec<Bend>,
    /// Which of orders 1 to 3 are drawn.
    pub drawn: [bool; 3],
    /// Whether rings and bends are others than when this was last taken, and whether circles and cuts are.
    pub is_new: bool,
    /// See [`DiskView::is_new`].
    pub has_moved: bool,
    /// How far a camera may move before an image is made anew, over its distance from the gas: order 1, orders 2 and 3.
    pub kept: [f64; 2],
    /// How many times as far before its circles are chosen anew.
    pub choice_kept: f64,
    /// Where circles and cuts were last told for: position, field of view, width.
    facing: Option<(DVec3, f64, u32)>,
    /// From far and from near.
    offers: [Offer; 2],
    images: [Image; 3],
    /// Room for what is used while an image is made.
    shares: Vec<f64>,
}

/// One image order of the disk.
#[derive(Clone, Debug, Default)]
struct Image {
    /// For whom it was made; None where there is none.
    stand: Option<Stand>,
    /// For whom its circles were chosen.
    choice: Option<Stand>,
    /// Those on offer as they were last seen, and which of them are chosen.
    seen: Vec<SeenCircle>,
    chosen: Vec<usize>,
    rows: Circles,
    /// The circles over which the mean gas of a thin image is taken.
    samples: Vec<Circle>,
}

/// A camera, and what else an image is made for.
#[derive(Clone, Copy, Debug)]
struct Stand {
    /// Distance from the disk's axis and height over its plane, in r_s.
    place: DVec2,
    /// Outward from the hole, along the plane, upwards.
    momentum: DVec3,
    settings: StandSettings,
}

/// What must be the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StandSettings {
    field_of_view: f64,
    width: u32,
    beaming: bool,
    ring_error: f32,
    is_close: bool,
}

impl Stand {
    /// How far it is from here to `other`, over the distance from the gas between these radii, or what counts as much of a change of the
    /// momentum; infinite where the settings differ.
    fn moved(&self, other: &Stand, [inner, outer]: [f64; 2]) -> f64 {
        if self.settings != other.settings {
            return f64::INFINITY;
        }
        let nearest = DVec2::new(self.place.x.clamp(inner, outer), 0.0);
        let moved = self.place.distance(other.place) / self.place.distance(nearest).min(self.place.length());
        // Against its flight the camera sees light with the least frequency, which is one over this factor.
        let speed = self.momentum.length();
        let shifted = self.momentum.distance(other.momentum) * (speed + (1.0 + speed * speed).sqrt());
        moved.max(FASTER * shifted)
    }
}

impl DiskView {
    /// Of this disk, before it is seen.
    pub fn of(disk: &DrawnDisk) -> DiskView {
        DiskView {
            frame: DiskFrame::default(),
            circles: Vec::new(),
            cuts: Vec::new(),
            rings: Vec::new(),
            bends: Vec::new(),
            drawn: [false; 3],
            is_new: false,
            has_moved: false,
            kept: KEPT,
            choice_kept: CHOICE_KEPT,
            facing: None,
            offers: [false, true].map(|close| Offer::new(disk, close)),
            images: Default::default(),
            shares: Vec::new(),
        }
    }

    /// For the camera and time of `input` and a picture `width` pixels wide.
    pub fn new(disk: &DrawnDisk, input: &FrameInput, slice: &Slice, width: u32) -> DiskView {
        let mut view = DiskView::of(disk);
        view.follow(disk, input, slice, width);
        view
    }

    /// Keeps nothing: the next view is made as if it were the first.
    pub fn forget(&mut self) {
        self.images.iter_mut().for_each(|image| (image.stand, image.choice) = (None, None));
    }

    /// Goes on to the camera and time of `input` and a picture `width` pixels wide, with the same disk.
    pub fn follow(&mut self, disk: &DrawnDisk, input: &FrameInput, slice: &Slice, width: u32) {
        let camera = &input.camera;
        let plane = Plane::seen_by(camera);
        let close = close_orders(disk, camera);
        self.drawn = drawn_orders(disk, input, slice, width);
        let mut is_new = false;
        for (order, is_drawn) in (1..).zip(self.drawn) {
            let image = &mut self.images[order as usize - 1];
            let stand = is_drawn.then(|| Stand {
                place: DVec2::new(plane.l * plane.level, camera.position.z),
                momentum: plane.parts(camera.momentum),
                settings: StandSettings {
                    field_of_view: camera.field_of_view,
                    width,
                    beaming: input.settings.beaming,
                    ring_error: input.settings.ring_error,
                    is_close: order <= close,
                },
            });
            let Some(stand) = stand else {
                is_new |= image.stand.take().is_some();
                image.choice = None;
                continue;
            };
            let moved = |from: Option<Stand>| from.map_or(f64::INFINITY, |made| made.moved(&stand, disk.gas.extent()));
            let kept = self.kept[usize::from(order > 1)];
            // One image a frame, if the other can wait.
            let wait = if is_new { 2.0 } else { 1.0 };
            if moved(image.stand) > wait * kept {
                let look = Look::new(camera, slice, order, width, input.settings.beaming);
                let offer = &self.offers[usize::from(order <= close)];
                if moved(image.choice) > self.choice_kept * kept {
                    image.make(disk, &look, &plane, offer, f64::from(input.settings.ring_error), &mut self.shares);
                    image.choice = Some(stand);
                } else if disk.config.gap <= 0.0 {
                    look.look_again(offer, &mut image.seen, &image.chosen);
                    look.rows(offer, &image.seen, &image.chosen, &mut image.rows);
                }
                image.stand = Some(stand);
                is_new = true;
            }
        }
        if is_new {
            self.join(disk);
            self.is_new = true;
        }
        let facing = Some((camera.position, camera.field_of_view, width));
        if is_new || self.facing != facing {
            self.facing = facing;
            self.has_moved = true;
            let rows = self.images.iter().filter(|image| image.stand.is_some()).flat_map(|image| &image.rows.gas);
            for (circle, gas) in self.circles.iter_mut().zip(rows) {
                circle.beyond = (gas.radius * plane.level - plane.l) as f32;
            }
            choose_cuts(disk, camera, width, &plane, &mut self.cuts);
        }
        self.look_on(disk, input);
        let cuts = self.cuts.len() as u32;
        let rows = self.images.iter().map(Image::rows).sum();
        self.frame = DiskFrame { columns: 2 * cuts - 1, arcs: cuts - 1, rows, rings: self.rings.len() as u32, ..self.frame };
    }

    /// Puts the circles, rings and samples of all images together.
    fn join(&mut self, disk: &DrawnDisk) {
        self.circles.clear();
        self.rings.clear();
        self.bends.clear();
        let images = || (1..).zip(&self.images).filter(|(_, image)| image.stand.is_some());
        let mut sample: u32 = self.images.iter().map(Image::rows).sum();
        for (order, image) in images() {
            let first = self.circles.len() as u32;
            let last = first + image.rows() - 1;
            let on_row = |gas: &CircleGas| Circle {
                gas: gas.drawn,
                order,
                first_row: first,
                last_row: last,
                first_sample: sample,
                ..Circle::default()
            };
            self.circles.extend(image.rows.gas.iter().map(on_row));
            if disk.config.gap > 0.0 {
                let [_, end] = disk.gas.extent();
                for (circle, closed) in self.circles[first as usize..].iter_mut().zip(gap_middles(disk)) {
                    circle.gap_radius = closed as f32;
                    circle.gap = disk.config.gap as f32;
                    circle.gap_sides = if closed < end { 2.0 } else { 1.0 };
                }
            }
            self.bends.extend(&image.rows.bends);
            self.rings.extend(image.rows.pairs.iter().map(|[a, b]| Ring { inner: first + a, outer: first + b, order, unused: 0 }));
            sample += image.samples.len() as u32;
        }
        for (_, image) in images() {
            self.circles.extend(&image.samples);
        }
    }

    /// Tells the shaders what does not depend on circles. The camera's time is counted from the first generation of streaks that can be
    /// seen.
    pub fn look_on(&mut self, disk: &DrawnDisk, input: &FrameInput) {
        let (time, settings, plane) = (input.time, &input.settings, Plane::seen_by(&input.camera));
        let [_, end] = disk.gas.extent();
        let nearest = (plane.l - end).max(0.0);
        let base = ((time - nearest - 2.0 * end - DETOUR) / RENEWAL).floor() - 1.0;
        let [x, y] = disk.gas.offset(base as i64);
        self.frame = DiskFrame {
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
            near_orders: close_orders(disk, &input.camera),
            thickness: disk.gas.thickness as f32,
            unit: DISK_UNIT as f32,
            close: CLOSE as f32,
            most_looks: settings.gas_looks,
            offset: [x, y].map(|value| value as f32),
            offset_step: OFFSET_STEP.map(|value| value as f32),
            // The circles are told by `follow`, the room and the lists by the pass.
            ..DiskFrame::default()
        };
    }
}

impl Image {
    /// The number of circles that are drawn.
    fn rows(&self) -> u32 {
        if self.stand.is_some() { self.rows.gas.len() as u32 } else { 0 }
    }

    /// Makes circles, rings and samples for one image order; rings may be off by `ring_error` times as much as at the finest.
    fn make(&mut self, disk: &DrawnDisk, look: &Look, plane: &Plane, offer: &Offer, ring_error: f64, shares: &mut Vec<f64>) {
        let (order, is_close) = (look.order, offer.is_close);
        let Image { seen, chosen, .. } = self;
        seen.clear();
        seen.extend(offer.circles.iter().map(|gas| look.circle(gas)));
        if disk.config.gap > 0.0 {
            let radii = if order == 1 { disk.arcs.circles.clone() } else { gap_middles(disk) };
            let gas = radii.into_iter().map(|r| CircleGas::at(disk, r)).collect();
            self.rows = Circles::straight(gas, disk.arcs.rings.clone());
        } else {
            let within = if order == 1 && is_close { FROM_NEAR } else { FROM_FAR };
            let own = own_shares(look, seen);
            look.choose(seen, &own, within.times(ring_error), chosen);
            look.rows(offer, seen, chosen, &mut self.rows);
        }
        self.samples.clear();
        if order > 1 {
            for azimuth in 0..AZIMUTHS {
                let through = through_second(plane, azimuth);
                let radii = equal_shares(seen, azimuth, shares).into_iter();
                self.samples.extend(radii.map(|r| sample(disk, r, (order == 3).then(|| through(r)))));
            }
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

    /// A vector's parts outward from the hole, along the plane, upwards across both.
    fn parts(&self, vector: DVec3) -> DVec3 {
        let outward = self.towards * self.level + DVec3::Z * self.height;
        DVec3::new(vector.dot(outward), vector.dot(self.sideways), vector.dot(self.upwards))
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

/// Which of orders 1 to 3 are drawn. The third is, behind the second, even if the settings do not ask for it, where it is wider than the
/// pixel budget.
pub fn drawn_orders(disk: &DrawnDisk, input: &FrameInput, slice: &Slice, width: u32) -> [bool; 3] {
    let settings = &input.settings;
    let is_wide = || {
        let look = Look::new(&input.camera, slice, 3, width, settings.beaming);
        let [inner, outer] = disk.gas.extent().map(|r| look.circle(&CircleGas::at(disk, r)));
        widths(&look, &inner, &outer).into_iter().fold(0.0, f64::max) >= f64::from(settings.pixel_error)
    };
    [true, settings.orders > 1, settings.orders > 2 || (settings.orders > 1 && is_wide())]
}

/// The share of a circle's own gas that an image shows, by azimuth; the rest is the mean gas of the whole image. 1 for order 1 and for wide
/// images, 0 for thin ones.
pub fn own_shares(look: &Look, seen: &[SeenCircle]) -> [f64; AZIMUTHS] {
    let widths = widths(look, &seen[0], &seen[seen.len() - 1]);
    widths.map(|width| if look.order == 1 { 1.0 } else { smoothstep(MEAN[0], MEAN[1], 0.5 * width) })
}

/// Radii that divide the seen width of an image into equal parts at one of the azimuths, each in the middle of its part; `before` is room.
fn equal_shares(seen: &[SeenCircle], azimuth: usize, before: &mut Vec<f64>) -> [f64; THIN_SAMPLES] {
    before.clear();
    before.push(0.0);
    let mut whole = 0.0;
    for pair in seen.windows(2) {
        let share = pair[0].angle_to(&pair[1], azimuth);
        // Where there is no ray nothing is seen. Without any ray the radii themselves are divided equally.
        let share = if share.is_finite() { share } else { 0.0 } + 1e-12 * (pair[1].gas.radius - pair[0].gas.radius);
        whole += share;
        before.push(whole);
    }
    std::array::from_fn(|k| {
        let wanted = whole * (k as f64 + 0.5) / THIN_SAMPLES as f64;
        let i = before.partition_point(|&share| share <= wanted).clamp(1, seen.len() - 1);
        let t = (wanted - before[i - 1]) / (before[i] - before[i - 1]).max(1e-300);
        let [a, b] = [i - 1, i].map(|i| seen[i].gas.radius);
        a + t.clamp(0.0, 1.0) * (b - a)
    })
}

/// The radius, in r_s, at which light of the third image crosses the disk's plane on its way, where the second image lies. It left radius
/// `r` at azimuth number `k` and makes half a turn between the two crossings. Both ends of the ray wind off the photon sphere like the rays
/// that wind for ever: u + 1/3 = ((1 − ρ)/(1 + ρ))², with ρ growing by a factor of e per radian (Chandrasekhar 1983, section 20). Near the
/// photon sphere the two deviations of u add up.
fn through_second(plane: &Plane, k: usize) -> impl Fn(f64) -> f64 {
    let from_photon_sphere = |r: f64, winding: f64| {
        let y = (1.0 / r + 1.0 / 3.0).sqrt();
        let rho = (1.0 - y) / (1.0 + y) * winding;
        ((1.0 - rho) / (1.0 + rho)).powi(2) - 1.0
    };
    let angle = (azimuth(k).cos() * plane.level).acos();
    let camera = 2.0 / 3.0 + from_photon_sphere(plane.l, (-PI - angle).exp());
    let half_turn = (-PI).exp();
    move |r| 1.0 / (camera + from_photon_sphere(r, half_turn))
}

/// The width of the image between two circles at each azimuth, in pixels of the middle of the picture.
fn widths(look: &Look, inner: &SeenCircle, outer: &SeenCircle) -> [f64; AZIMUTHS] {
    let camera = look.camera;
    // An angle in the camera's frame is that in the rain frame over the frequency ratio. Of the camera's momentum only the outward part
    // counts here: it acts alike at all azimuths.
    let gamma = (1.0 + camera.momentum.length_squared()).sqrt();
    let outward = camera.momentum.dot(camera.position) / camera.radius();
    std::array::from_fn(|k| {
        let [a, b] = [inner.places[k], outer.places[k]];
        let frequency = gamma + outward * (a.normalize() + b.normalize()).normalize().x;
        inner.angle_to(outer, k) / (look.pixel * frequency)
    })
}

/// The cuts to use: so many that arcs are long enough to be told apart. σ of each, in rad. Close to the plane there is also a cut at each
/// corner of the image, where θ + α is an odd multiple of a quarter turn: then the segments on both sides of it can be even, although their
/// number comes from the middle of the arc alone.
fn choose_cuts(disk: &DrawnDisk, camera: &Observer, width: u32, plane: &Plane, cuts: &mut Vec<f32>) {
    let all = disk.arcs.cuts.len() - 1;
    let [_, end] = disk.gas.extent();
    let count = if plane.l < 1.5 * end {
        all
    } else {
        let round = TAU * end / plane.l / pixel_angle(camera, width) / LEAST_ARC;
        (round.ceil() as usize).clamp(16.min(all), all)
    };
    let (origin, height) = (plane.origin(), plane.height.abs());
    cuts.clear();
    cuts.extend((0..=count).map(|k| sigma(disk.arcs.cuts[k * all / count] - origin, height) as f32));
    if height < CORNERED {
        let [first, last] = [cuts[0], cuts[count]];
        let corners = (-4..12).map(|k| (PI * (0.5 * f64::from(k) + 0.25)) as f32);
        cuts.extend(corners.filter(|corner| (first..last).contains(corner)));
        cuts.sort_unstable_by(f32::total_cmp);
    }
}

/// A circle that counts in the mean gas of a thin image. Light of the third image crosses the second at the radius `through`.
fn sample(disk: &DrawnDisk, r: f64, through: Option<f64>) -> Circle {
    let gas = disk.gas_at(r);
    let nearer = through.map_or(gas, |r| disk.gas_at(r));
    Circle {
        gas,
        nearer_depth: through.map_or(0.0, |_| nearer.depth),
        nearer_outward: nearer.outward,
        nearer_along: nearer.along,
        nearer_radius: nearer.radius,
        ..Circle::default()
    }
}
