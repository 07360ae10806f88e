//! What a frame needs to know of the disk, in f64: its axes as the camera sees them, the circles to draw in each order, the streaks' generations.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_at;
use crate::render::frame::{Camera, FrameInput};
use crate::scene::disk::radial::{LAST_ORBIT, smoothstep};
use crate::scene::disk::{DISK_UNIT, LEAST_COSINE, OFFSET_STEP, PATTERN_HEIGHT, RENEWAL, SHEARED};

use super::Disk;
use super::sigma::sigma;
use super::types::{Circle, DiskFrame};

/// Least |sine| of the camera's height over the plane. In the plane itself the disk is seen edge on and its image has no width.
const LEAST_HEIGHT: f64 = 1e-5;
/// Sine of the height below which the image of a circle has corners: between a line in the plane and the half ring that light from behind the hole makes of the
/// rest, over a part of σ of the root of that, as long as a segment or shorter.
const CORNERED: f64 = 0.03;
/// How far off what goes straight between two circles may be; rings are drawn together as long as it is off by no more.
#[derive(Clone, Copy, Debug)]
struct Straight {
    /// The place in the gas across the orbit, in pixels.
    across: f64,
    /// Whether that is the logarithm of the radius, the height in the pattern, and not the radius itself, from which each pixel then finds the height.
    height: bool,
    /// And along it, where streaks are ten times as long.
    along: f64,
    /// The logarithm of light goes straight too, and the optical depth: the light that comes of both, over that of the brightest ring.
    light: f64,
    /// And what is stopped of light from behind.
    stopped: f64,
}

/// From far: what is left of the light's error by [`straighten`] is less than half. A third of `across` takes half as many circles more, and pictures from 80° and
/// lower are no nearer to the truth.
const FROM_FAR: Straight = Straight { across: 0.15, height: true, along: 4.0, light: 0.02, stopped: 0.03 };
/// Within [`CLOSE`], where a ring may fill the picture.
const FROM_NEAR: Straight = Straight { across: 0.4, height: false, along: 8.0, light: 0.015, stopped: 0.01 };
/// Half widths in pixels between which a thin image goes over from the mean of all its gas to gas from each of its circles, as
/// shaders/disk/types.wgsl has it.
const MEAN: [f64; 2] = [0.75, 2.0];
/// Circles whose mean a thin image shows, at each azimuth, as in shaders/disk/place.wgsl.
const THIN_SAMPLES: usize = 8;
/// From one circle of the falling gas to the next that there is to choose from, in √r_s of the root of the way from the last orbit: what is straight between
/// the first two misses the lag by 0.02 rad.
const FALL_STEP: f64 = 0.05;
/// Circles nearer to one another than this, in r_s, are one.
const LEAST_RING: f64 = 1e-3;
/// Azimuths at which that is tried, on one side, for both sides are alike; as in shaders/disk/place.wgsl.
const AZIMUTHS: usize = 12;
/// hc/λk at 550 nm, in K: light goes as exp(−this/T) by Wien's law.
const GREEN: f64 = 26_160.0;
/// Light of gas as dark as this, in its logarithm, is none.
const LEAST_LOG_LIGHT: f64 = -690.0;
/// Points between two circles at which heat and depth are fitted.
const FIT_POINTS: u32 = 8;
/// The weight of dark gas in the fit of heat, over that of the brightest.
const LEAST_WEIGHT: f64 = 1e-4;
/// Cuts are left out while the arcs on the outermost circle are shorter than this many pixels: halving finds what is lost.
const LEAST_ARC: f64 = 128.0;
/// Nearer to the disk than this, in r_s, the pattern of order 1 is looked up without a grain and the slant in each pixel: from there on a texel of the
/// pattern from far is hardly larger than a pixel of the default picture.
const CLOSE: f64 = 10.0;
/// The same for orders 2 and 3, whose images are narrow until the disk is all round: from far they are looked up at more places.
const CLOSE_BEHIND: f64 = 3.0;
/// Longest light path past the hole, for orders up to 3, over that of light that goes straight, in r_s.
const DETOUR: f64 = 60.0;

/// The disk as one frame's camera sees it.
#[derive(Clone, Debug)]
pub struct DiskView {
    /// For the shaders; the arc pass fills in the places in its buffers.
    pub frame: DiskFrame,
    /// Rows of all orders.
    pub circles: Vec<Circle>,
    /// Behind them in the same buffer: circles whose mean a thin image shows.
    pub samples: Vec<Circle>,
    /// σ of the cuts, in rad.
    pub cuts: Vec<f32>,
    /// Rows on either side of each ring, and its order.
    pub rings: Vec<[u32; 4]>,
    /// Orders up to this one are so near that fine structure is seen; 0 from far.
    pub close: u32,
}

impl DiskView {
    /// For the camera and time of `input` and a picture `width` pixels wide.
    pub fn new(disk: &Disk, input: &FrameInput, slice: &Slice, width: u32) -> DiskView {
        let camera = &input.camera;
        let l = camera.radius();
        let n = camera.position / l;
        let height = if n.z.abs() < LEAST_HEIGHT { LEAST_HEIGHT.copysign(n.z) } else { n.z };
        let towards = DVec3::new(n.x, n.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let sideways = DVec3::Z.cross(towards);
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        let upwards = DVec3::Z * level - towards * n.z;
        let [_, end] = disk.gas.extent();
        let origin = towards.y.atan2(towards.x);
        let near = |limit: f64| camera.position.z.abs() < limit && l < end + limit;
        let close = if near(CLOSE_BEHIND) { 3 } else { u32::from(near(CLOSE)) };

        let mut circles = Vec::new();
        let mut samples = Vec::new();
        let mut rings = Vec::new();
        for order in 1..=3 {
            // The third is drawn unasked where it is wider than the pixel budget, behind the second.
            let unasked = order > input.settings.orders;
            if unasked
                && (order < 3
                    || input.settings.orders < 2
                    || widest(disk, camera, slice, width, order) < f64::from(input.settings.pixel_error))
            {
                continue;
            }
            let first = circles.len() as u32;
            let seen: Vec<SeenCircle> =
                radii(disk, order <= close).into_iter().map(|r| SeenCircle::new(disk, camera, slice, order, r)).collect();
            let own = own_shares(camera, &seen, width, order);
            let gaps = disk.config.gap > 0.0;
            let (rows, pairs) = if gaps {
                (if order == 1 { disk.arcs.circles.clone() } else { gap_middles(disk) }, disk.arcs.rings.clone())
            } else {
                rows(camera, &seen, width, own, if order <= close { FROM_NEAR } else { FROM_FAR })
            };
            let last = first + rows.len() as u32 - 1;
            let behind = samples.len() as u32;
            if order > 1 {
                for azimuth in 0..AZIMUTHS {
                    let shares = equal_shares(&seen, azimuth).into_iter();
                    samples.extend(shares.map(|r| sample(disk, r, (order == 3).then(|| through_second(l, level, azimuth, r)))));
                }
            }
            let mut own: Vec<Circle> = rows.iter().map(|&r| circle(disk, r, level, l, [order, first, last, behind])).collect();
            if gaps {
                for (circle, closed) in own.iter_mut().zip(gap_middles(disk)) {
                    circle.place[1] = closed as f32;
                    circle.place[2] = disk.config.gap as f32;
                    circle.place[3] = if closed < end { 2.0 } else { 1.0 };
                }
            } else {
                straighten(disk, &rows, &mut own);
            }
            circles.extend(own);
            rings.extend(pairs.into_iter().map(|[a, b]| [first + a, first + b, order, 0]));
        }

        let count = circles.len() as u32;
        circles.iter_mut().for_each(|circle: &mut Circle| circle.rows[3] += count);

        // Streaks: time at the camera counted from the first generation that can be seen.
        let nearest = (l - end).max(0.0);
        let base = ((input.time - nearest - 2.0 * end - DETOUR) / RENEWAL).floor() - 1.0;
        let [x, y] = disk.gas.offset(base as i64);
        let cuts = sigmas(&chosen_cuts(disk, camera, width), origin, height.abs());
        let row = |v: DVec3, w: f64| [v.x as f32, v.y as f32, v.z as f32, w as f32];
        DiskView {
            frame: DiskFrame {
                towards: row(towards, height),
                sideways: row(sideways, level),
                upwards: row(upwards, height.abs()),
                renewal: [(input.time / RENEWAL - base) as f32, (1.0 / RENEWAL) as f32, RENEWAL as f32, SHEARED as f32],
                gas: [disk.gas.contrast as f32, 1.0 - disk.config.gap as f32, disk.config.error_budget as f32, disk.min_width as f32],
                sizes: [2 * cuts.len() as u32 - 1, cuts.len() as u32 - 1, circles.len() as u32, rings.len() as u32],
                regions: [0; 4],
                room: [0, close, (disk.gas.thickness as f32).to_bits(), 0],
                light: [DISK_UNIT as f32, CLOSE as f32, 0.0, 0.0],
                offset: [x, y, OFFSET_STEP[0], OFFSET_STEP[1]].map(|value| value as f32),
            },
            circles,
            samples,
            cuts,
            rings,
            close,
        }
    }
}

/// The radii to choose from, ascending, in r_s: the arcs' circles, and from near more of them in the falling gas. By how much its pattern is ahead grows as
/// the root of the way from the last orbit, which the straight line between two arcs' circles missed by up to a tenth of a radian; and at that orbit the
/// pattern has a kink.
fn radii(disk: &Disk, close: bool) -> Vec<f64> {
    let mut radii = disk.arcs.circles.clone();
    let [start, _] = disk.gas.extent();
    if close && disk.config.gap <= 0.0 && start < LAST_ORBIT {
        let falling = (0..).map(|k| LAST_ORBIT - (FALL_STEP * f64::from(k)).powi(2));
        radii.extend(falling.take_while(|&r| r > start));
        radii.sort_by(f64::total_cmp);
        radii.dedup_by(|next, r| *next - *r < LEAST_RING);
    }
    radii
}

/// The radii to draw in an order and the pairs of them with gas between.
fn rows(camera: &Camera, seen: &[SeenCircle], width: u32, own: [f64; AZIMUTHS], within: Straight) -> (Vec<f64>, Vec<[u32; 2]>) {
    let pixel = pixel_angle(camera, width);
    let brightest = seen.iter().map(SeenCircle::shining).fold(1e-300, f64::max);
    let within = Straight { light: within.light * brightest, ..within };
    let slants = slants(camera);
    let straight = |a: usize, b: usize| {
        // Middle and quarters.
        [(1, 2), (1, 4), (3, 4)].into_iter().all(|(k, n)| {
            let m = (a * (n - k) + b * k) / n;
            m == a || m == b || seen[m].is_between(&seen[a], &seen[b], pixel, within, slants, &own)
        })
    };
    let mut chosen = vec![0];
    for k in 1..seen.len() {
        let last = *chosen.last().unwrap_or(&0);
        if k + 1 == seen.len() || !straight(last, k + 1) {
            chosen.push(k);
        }
    }
    let pairs = (1..chosen.len() as u32).map(|k| [k - 1, k]).collect();
    (chosen.into_iter().map(|k| seen[k].radius).collect(), pairs)
}

/// For each circle of a disk that has gaps between its rings the middle of the gap that it bounds, in r_s: there it lies where the gap is too narrow to be seen. Beyond
/// the outermost there is no ring to meet, so it goes all the way.
fn gap_middles(disk: &Disk) -> Vec<f64> {
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

/// Sets heat and depth of circles at `radii` so that what goes straight between them is off by as little as can be in the mean, and not by nothing on
/// each of them: with the same circles the light is twice as near to that of the gas.
fn straighten(disk: &Disk, radii: &[f64], circles: &mut [Circle]) {
    let radial = &disk.gas.radial;
    let light = |r: f64| (-GREEN / radial.temperature(r)).exp() * radial.depth(r).min(1.0);
    let brightest = radii.iter().map(|&r| light(r)).fold(1e-300, f64::max);
    // The logarithm of light goes straight, which by Wien's law is −1/T.
    let heat = straight_fit(radii, |r| -1.0 / radial.temperature(r), |r| (light(r) / brightest).powi(2) + LEAST_WEIGHT);
    let depth = straight_fit(radii, |r| radial.depth(r), |_| 1.0);
    for ((circle, heat), depth) in circles.iter_mut().zip(heat).zip(depth) {
        if heat < 0.0 {
            circle.gas[2] = (-1.0 / heat).ln() as f32;
        }
        circle.gas[3] = depth.max(0.0) as f32;
    }
}

/// The values at the places `at`, which grow, between which straight lines come closest to `wanted`: least squares by `weight`.
fn straight_fit(at: &[f64], wanted: impl Fn(f64) -> f64, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = at.len();
    // Each point weighs upon its two neighbours alone: the equations are tridiagonal.
    let (mut middle, mut beside, mut right) = (vec![1e-300; n], vec![0.0; n], vec![0.0; n]);
    for k in 1..n {
        for i in 0..FIT_POINTS {
            let t = (f64::from(i) + 0.5) / f64::from(FIT_POINTS);
            let r = at[k - 1] + t * (at[k] - at[k - 1]);
            let (value, w) = (wanted(r), weight(r) * (at[k] - at[k - 1]));
            middle[k - 1] += w * (1.0 - t) * (1.0 - t);
            middle[k] += w * t * t;
            beside[k] += w * t * (1.0 - t);
            right[k - 1] += w * (1.0 - t) * value;
            right[k] += w * t * value;
        }
    }
    for k in 1..n {
        let share = beside[k] / middle[k - 1];
        middle[k] -= share * beside[k];
        right[k] -= share * right[k - 1];
    }
    let mut values = vec![0.0; n];
    for k in (0..n).rev() {
        let next = if k + 1 < n { beside[k + 1] * values[k + 1] } else { 0.0 };
        values[k] = (right[k] - next) / middle[k];
    }
    values
}

/// How much of its own each circle of an image shows: the narrower the whole image, the more one gas stands for all of it.
fn own_shares(camera: &Camera, seen: &[SeenCircle], width: u32, order: u32) -> [f64; AZIMUTHS] {
    let widths = widths(camera, &seen[0], &seen[seen.len() - 1], width);
    widths.map(|width| if order == 1 { 1.0 } else { smoothstep(MEAN[0], MEAN[1], 0.5 * width) })
}

/// Radii that share the width of an image equally at one of the azimuths.
fn equal_shares(seen: &[SeenCircle], azimuth: usize) -> [f64; THIN_SAMPLES] {
    let mut before = vec![0.0];
    for pair in seen.windows(2) {
        let share = pair[0].angle_to(&pair[1], azimuth);
        // Where there is no ray nothing is seen. If there is none at all the radii themselves are shared.
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

/// The azimuths that are tried, from the camera's, in rad: closest where the disk comes closest to the camera.
fn azimuth(k: usize) -> f64 {
    let share = (k as f64 + 0.5) / AZIMUTHS as f64;
    PI * share * share
}

/// The radius at which light of the third image from radius `r` at one of the azimuths crosses the disk's plane in between, in r_s, half a turn before it would
/// there: the camera is at radius `l` and the cosine of its height over the plane is `level`. Both ends wind from the photon sphere as the rays do that
/// wind for ever, u + 1/3 = ((1 − ρ)/(1 + ρ))² with ρ growing by e for each radian (Chandrasekhar 1983, section 20); near it both ways add up.
fn through_second(l: f64, level: f64, k: usize, r: f64) -> f64 {
    let from_photon_sphere = |r: f64, turned: f64| {
        let y = (1.0 / r + 1.0 / 3.0).sqrt();
        let rho = (1.0 - y) / (1.0 + y) * (-turned).exp();
        ((1.0 - rho) / (1.0 + rho)).powi(2) - 1.0
    };
    let angle = (azimuth(k).cos() * level).acos();
    1.0 / (2.0 / 3.0 + from_photon_sphere(l, PI + angle) + from_photon_sphere(r, PI))
}

/// The width of the image of an order where it is widest, in pixels.
fn widest(disk: &Disk, camera: &Camera, slice: &Slice, width: u32, order: u32) -> f64 {
    let [inner, outer] = disk.gas.extent().map(|r| SeenCircle::new(disk, camera, slice, order, r));
    widths(camera, &inner, &outer, width).into_iter().fold(0.0, f64::max)
}

/// The width of the image between two circles at each azimuth, in pixels of the middle of a picture `width` pixels wide.
fn widths(camera: &Camera, inner: &SeenCircle, outer: &SeenCircle, width: u32) -> [f64; AZIMUTHS] {
    let pixel = pixel_angle(camera, width);
    // Angles in the camera's frame are those of the rain frame over the frequency there; of the camera's motion the part outward, the same all round.
    let gamma = (1.0 + camera.momentum.length_squared()).sqrt();
    let outward = camera.momentum.dot(camera.position) / camera.radius();
    std::array::from_fn(|k| {
        let [a, b] = [inner.places[k], outer.places[k]];
        let frequency = gamma + outward * (a.normalize() + b.normalize()).normalize().x;
        inner.angle_to(outer, k) / (pixel * frequency)
    })
}

/// A circle as an order shows it.
struct SeenCircle {
    radius: f64,
    /// Azimuth by which its pattern is ahead, in rad.
    lag: f64,
    /// The radius that its pattern comes from, and the logarithm of that.
    pattern: [f64; 2],
    /// The light of gas that lets nothing through, and its logarithm.
    light: f64,
    log_light: f64,
    depth: f64,
    /// What it stops at each of [`slants`].
    stopped: [f64; 2],
    /// For each azimuth the place, direction times light path, in the half plane that holds the ray: outward and across.
    places: [DVec2; AZIMUTHS],
    /// And its angle there from outward, in rad.
    angles: [f64; AZIMUTHS],
}

impl SeenCircle {
    fn new(disk: &Disk, camera: &Camera, slice: &Slice, order: u32, r: f64) -> SeenCircle {
        let radial = &disk.gas.radial;
        let l = camera.radius();
        let n = camera.position / l;
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        let places = std::array::from_fn(|k| {
            let (sine, cosine) = azimuth(k).sin_cos();
            let (along, across) = (r * cosine * level, r * (n.z * cosine).hypot(sine));
            let ray = lens_lookup_at(slice, (along - l) as f32, across as f32, along as f32, order);
            DVec2::new(f64::from(ray.cos_psi), f64::from(ray.sin_psi)) * if ray.valid { f64::from(ray.delay) } else { f64::NAN }
        });
        let depth = radial.depth(r);
        let pattern = radial.pattern_radius(r);
        let log_light = (-GREEN / radial.temperature(r)).max(LEAST_LOG_LIGHT);
        SeenCircle {
            radius: r,
            lag: radial.lag(r),
            pattern: [pattern, pattern.ln()],
            light: log_light.exp(),
            log_light,
            depth,
            stopped: slants(camera).map(|slant| stopped(depth, slant)),
            places,
            angles: places.map(|place| place.y.atan2(place.x)),
        }
    }

    /// Light of the gas as it is, face on.
    fn shining(&self) -> f64 {
        self.light * self.depth.min(1.0)
    }

    /// The angle to the same azimuth of another circle, in rad.
    fn angle_to(&self, other: &SeenCircle, azimuth: usize) -> f64 {
        let angle = (self.angles[azimuth] - other.angles[azimuth]).abs();
        angle.min(TAU - angle)
    }

    /// Whether this circle looks as it should where one draws straight on from `a` to `b`; the light that may be missing is an absolute one here.
    fn is_between(&self, a: &SeenCircle, b: &SeenCircle, pixel: f64, within: Straight, slants: [f64; 2], own: &[f64; AZIMUTHS]) -> bool {
        (0..AZIMUTHS).all(|k| {
            let [here, start, end] = [self.places[k], a.places[k], b.places[k]];
            // Where the straight line is seen in this circle's direction.
            let (before, after) = (here.perp_dot(start), here.perp_dot(end));
            let t = before / (before - after);
            let straight = |from: f64, to: f64| from + t * (to - from);
            let off = |value: f64, from: f64, to: f64| (straight(from, to) - value).abs();
            // Pixels for each r_s across the ring, and along it.
            let wide = a.angle_to(b, k) / pixel;
            let across = wide / (b.radius - a.radius);
            // Of what is narrower than a pixel a pixel shows only so much, and of a thin image only this circle's own.
            let shown = own[k] * wide.min(1.0);
            let along = self.radius / here.length() / pixel;
            let [[pattern, log], from, to] = [self.pattern, a.pattern, b.pattern];
            let aside = if within.height { pattern * off(log, from[1], to[1]) } else { off(pattern, from[0], to[0]) };
            // Where there is no ray t is not a number.
            let placed =
                t > 0.0 && t < 1.0 && aside * across < within.across && off(self.lag, a.lag, b.lag) * along * wide.min(1.0) < within.along;
            placed && {
                let light = straight(a.log_light, b.log_light).exp();
                let depth = straight(a.depth, b.depth);
                slants.into_iter().zip(self.stopped).all(|(slant, stops)| {
                    let drawn = stopped(depth, slant);
                    (light * drawn - self.light * stops).abs() * shown < within.light && (drawn - stops).abs() * shown < within.stopped
                })
            }
        })
    }
}

/// The angle of a pixel in the middle of a picture `width` pixels wide, in rad.
fn pixel_angle(camera: &Camera, width: u32) -> f64 {
    2.0 * (0.5 * camera.field_of_view).tan() / f64::from(width.max(1))
}

/// Optical depths along a ray over those straight through: seen face on, and from where the camera is.
fn slants(camera: &Camera) -> [f64; 2] {
    let height = camera.position.z.abs() / camera.radius();
    [1.0, 1.0 / height.max(LEAST_COSINE)]
}

/// The share of the light from behind that gas of an optical depth stops at a slant.
fn stopped(depth: f64, slant: f64) -> f64 {
    1.0 - (-slant * depth).exp()
}

/// The cuts between arcs long enough to be told apart.
fn chosen_cuts(disk: &Disk, camera: &Camera, width: u32) -> Vec<f64> {
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

/// σ of the cuts, for a camera at the azimuth `origin` and at a height with this sine over the plane. Next to the plane there is a cut at each corner too, where
/// θ + α is a quarter turn: segments on either side of it are even, as their number is told by the middle of an arc alone.
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

/// A circle whose gas takes part in the mean of a thin image; light of the third comes `through` this radius of the second.
fn sample(disk: &Disk, r: f64, through: Option<f64>) -> Circle {
    let radial = &disk.gas.radial;
    let nearer = through.unwrap_or(r);
    let [outward, along] = radial.momentum(nearer);
    let behind = through.map_or(0.0, |r| radial.depth(r) as f32);
    let mut circle = circle(disk, r, 0.0, 0.0, [0; 4]);
    circle.place = [behind, outward as f32, along as f32, nearer as f32];
    circle
}

fn circle(disk: &Disk, r: f64, level: f64, l: f64, rows: [u32; 4]) -> Circle {
    let radial = &disk.gas.radial;
    let [outward, along] = radial.momentum(r);
    let pattern = radial.pattern_radius(r).ln() / PATTERN_HEIGHT;
    Circle {
        gas: [r as f32, radial.lag(r) as f32, radial.temperature(r).ln() as f32, radial.depth(r) as f32],
        motion: [outward as f32, along as f32, disk.gas.half_height(r) as f32, pattern as f32],
        place: [(r * level - l) as f32, 0.0, 0.0, 0.0],
        rows,
    }
}
