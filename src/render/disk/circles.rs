//! The circles of the disk that are drawn in an image order. Between two neighbouring circles the gas is taken as a parabola over the seen
//! width of the ring between them.

use crate::spacetime::Observer;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_at;
use crate::render::disk::drawn::DrawnDisk;
use crate::render::disk::types::Bend;
use crate::scene::disk::radial::LAST_ORBIT;
use crate::scene::disk::{LEAST_COSINE, PATTERN_HEIGHT};

/// The largest errors that the parabola between two circles may have. Two neighbouring rings are drawn as one as long as every error is
/// below its limit.
#[derive(Clone, Copy, Debug)]
pub struct Within {
    /// Error of the place in the pattern across the orbit, in pixels.
    across: f64,
    /// Error of the place along the orbit, in pixels; streaks are ten times as long there. The lag of falling gas is linear over a ring,
    /// not a parabola.
    along: f64,
    /// Error of the light that results from the parabolas of ln light and of optical depth, over the light of the brightest ring at the
    /// same azimuth.
    light: f64,
    /// Error of the share of light from behind that is stopped.
    stopped: f64,
}

impl Within {
    /// All limits times `factor`.
    pub fn times(self, factor: f64) -> Within {
        let Within { across, along, light, stopped } = self;
        Within { across: across * factor, along: along * factor, light: light * factor, stopped: stopped * factor }
    }
}

/// For a far camera, and for orders 2 and 3 from everywhere. Narrower rings make images of order 2 and 3 no more exact from near either,
/// because these images are compressed across the orbit.
pub const FROM_FAR: Within = Within { across: 0.15, along: 4.0, light: 0.005, stopped: 0.015 };
/// For order 1, where one ring may fill the picture. Shear turns streaks: in the 80 r_s/c that a streak lives, at 6.5 r_s, it comes to lie
/// across the orbit by one part in five of its length. Then an error of a pixel along the orbit moves the streak aside by a fifth of a
/// pixel, twice `across`. With four pixels, one ring beside the camera has a fifth of the error of the whole picture. Half of this limit on
/// light is hardly better; twice as much makes the error 3 % larger.
pub const FROM_NEAR: Within = Within { across: 0.1, along: 1.0, light: 0.001, stopped: 0.005 };

/// Step of √(distance from the last stable orbit) between the circles on offer in the falling gas, in √r_s. With it a linear lag is off by
/// 0.02 rad between the first two circles.
const FALL_STEP: f64 = 0.05;
/// Circles on offer are no farther apart than the larger of these two: this share of the radius, and this many r_s. Over wider rings, as a
/// disk of few arcs has, gas is no parabola.
const WIDEST: [f64; 2] = [0.1, 0.25];
/// Circles closer together than this, in r_s, count as one.
const LEAST_RING: f64 = 1e-3;
/// Number of azimuths on one side of the camera's direction at which errors are tested and parabolas are given. Both sides are alike except
/// for the light. As in shaders/disk/arcs/place.wgsl.
pub const AZIMUTHS: usize = 12;
/// hc/λk at 550 nm, in K: light goes as exp(−this/T) by Wien's law.
const GREEN: f64 = 26_160.0;
/// ln light below this counts as no light.
const LEAST_LOG_LIGHT: f64 = -690.0;
/// Gas of an optical depth below this stops nothing and sends out nothing.
const LEAST_DEPTH: f64 = 1e-9;
/// Largest deviation of ln light in the middle of a ring from the straight line. Colours follow the slopes of Planck's law at the two
/// circles, which holds no farther.
const MOST_BENT: f64 = 0.7;
/// If the middle of a ring is seen nearer to one of its circles than this share of the ring's width, no parabola is used: it would go
/// beyond the values on the circles.
const LEAST_SHARE: f64 = 0.3;

/// The radii on offer, ascending, in r_s: the circles of the arcs; more between them where these are few; and from near more in the falling
/// gas. There the lag of the pattern grows as the root of the distance from the last stable orbit, so a straight line between two circles
/// of the arcs would be off by up to 0.1 rad. At that orbit the pattern has a kink.
pub fn radii(disk: &DrawnDisk, close: bool) -> Vec<f64> {
    let mut radii = disk.arcs.circles.clone();
    let [start, _] = disk.gas.extent();
    if close && disk.config.gap <= 0.0 && start < LAST_ORBIT {
        let falling = (0..).map(|k| LAST_ORBIT - (FALL_STEP * f64::from(k)).powi(2));
        radii.extend(falling.take_while(|&r| r > start));
        radii.sort_by(f64::total_cmp);
        radii.dedup_by(|next, r| *next - *r < LEAST_RING);
    }
    if disk.config.gap > 0.0 {
        return radii;
    }
    let between = |pair: &[f64]| {
        let (from, width) = (pair[0], pair[1] - pair[0]);
        let parts = (width / (WIDEST[0] * from).max(WIDEST[1])).ceil().max(1.0);
        (1..=parts as u32).map(move |k| from + width * f64::from(k) / parts)
    };
    radii[..1].iter().copied().chain(radii.windows(2).flat_map(between)).collect()
}

/// The circles that are drawn in one image order.
#[derive(Clone, Debug)]
pub struct Circles {
    /// Their radii, ascending, in r_s.
    pub radii: Vec<f64>,
    /// Pairs of indices into `radii` with gas between the two circles.
    pub pairs: Vec<[u32; 2]>,
    /// For the ring from each circle to the next, by azimuth: how far its middle deviates from the straight line. Zero for the last circle.
    pub bends: Vec<[RingBend; AZIMUTHS]>,
}

impl Circles {
    /// All of these circles, with straight lines between them.
    pub fn straight(radii: Vec<f64>, pairs: Vec<[u32; 2]>) -> Circles {
        Circles { bends: vec![[RingBend::default(); AZIMUTHS]; radii.len()], radii, pairs }
    }
}

/// One image order as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// The disk that is seen.
    pub disk: &'a DrawnDisk,
    /// From where.
    pub camera: &'a Observer,
    /// The lensing table for the camera's radius.
    pub slice: &'a Slice,
    /// 1 to 3.
    pub order: u32,
    /// Of the picture, in pixels.
    pub width: u32,
    /// Whether light changes its strength with g.
    pub beaming: bool,
}

impl Look<'_> {
    /// The fewest of the circles on offer that keep all errors `within` their limits.
    ///
    /// `own`, by azimuth, is the share of a circle's own gas that the image shows; the rest is the mean gas of a thin image.
    pub fn rows(&self, seen: &[SeenCircle], own: &[f64; AZIMUTHS], within: Within) -> Circles {
        let brightest =
            std::array::from_fn(|k| [0, 1].map(|side| seen.iter().map(|circle| circle.shining(k, side)).fold(1e-300, f64::max)));
        let smooth = |a: usize, b: usize| {
            let ring = [&seen[a], &seen[(a + b) / 2], &seen[b]];
            // The middle and the quarters of the common ring.
            [(1, 2), (1, 4), (3, 4)].into_iter().all(|(k, n)| {
                let i = (a * (n - k) + b * k) / n;
                i == a || i == b || self.is_on(ring, &seen[i], own, &brightest, within)
            })
        };
        let mut chosen = vec![0];
        for k in 1..seen.len() {
            let last = *chosen.last().unwrap_or(&0);
            if k + 1 == seen.len() || !smooth(last, k + 1) {
                chosen.push(k);
            }
        }
        let bend = |pair: &[usize]| {
            let [a, b] = [&seen[pair[0]], &seen[pair[1]]];
            let between = (pair[0] + pair[1]) / 2;
            // Two neighbouring circles on offer have none in their middle: it is made.
            let new = (between == pair[0]).then(|| self.circle(0.5 * (a.radius + b.radius)));
            let middle = new.as_ref().unwrap_or(&seen[between]);
            std::array::from_fn(|k| RingBend::of([a, middle, b], k).unwrap_or_default())
        };
        let mut bends: Vec<_> = chosen.windows(2).map(bend).collect();
        bends.push([RingBend::default(); AZIMUTHS]);
        let pairs = (1..chosen.len() as u32).map(|k| [k - 1, k]).collect();
        Circles { radii: chosen.into_iter().map(|k| seen[k].radius).collect(), pairs, bends }
    }

    /// Whether the parabola through `ring` (an inner circle, one in the middle, an outer one) is right at the circle `here`, within the
    /// limits. `brightest` is the light of the brightest circle by azimuth and side, to which the error of light is relative.
    fn is_on(
        &self,
        ring: [&SeenCircle; 3],
        here: &SeenCircle,
        own: &[f64; AZIMUTHS],
        brightest: &[[f64; 2]; AZIMUTHS],
        within: Within,
    ) -> bool {
        let pixel = pixel_angle(self.camera, self.width);
        let slants = slants(self.camera);
        let [a, _, b] = ring;
        (0..AZIMUTHS).all(|k| {
            let t = here.share(a, b, k);
            let Some(bend) = RingBend::of(ring, k).filter(|_| t > 0.0 && t < 1.0) else { return false };
            let straight = |from: f64, to: f64| from + t * (to - from);
            let middle = 4.0 * t * (1.0 - t);
            // Pixels per r_s across the ring, and along it.
            let wide = a.angle_to(b, k) / pixel;
            let across = wide / (b.radius - a.radius);
            // A ring narrower than a pixel contributes only its width; in a thin image only this circle's own share counts.
            let shown = own[k] * wide.min(1.0);
            let length = here.places[k].length();
            let along = here.radius / length / pixel;
            let aside = here.pattern * PATTERN_HEIGHT * (straight(a.height, b.height) + middle * bend.height - here.height).abs();
            // Error of the azimuth of the gas: of its lag, and of the angle that it turns in the time by which the light path is off.
            let path = straight(a.places[k].length(), b.places[k].length()) - length;
            let ahead = (straight(a.lag, b.lag) - here.lag).abs() + here.rate * path.abs();
            if aside * across >= within.across || ahead * along * wide.min(1.0) >= within.along {
                return false;
            }
            let depth = (straight(a.depth, b.depth) * (1.0 + middle * bend.depth)).max(0.0);
            let drawn = slants.map(|slant| stopped(depth, slant));
            (0..2).all(|n| (drawn[n] - here.stopped[n]).abs() * shown < within.stopped)
                && (0..2).all(|side| {
                    let light = (straight(a.log_light[k][side], b.log_light[k][side]) * (1.0 - middle * bend.light[side])).exp();
                    let there = here.light[k][side];
                    (0..2).all(|n| (light * drawn[n] - there * here.stopped[n]).abs() * shown < within.light * brightest[k][side])
                })
        })
    }

    /// The circle of radius `r` in r_s.
    pub fn circle(&self, r: f64) -> SeenCircle {
        let radial = &self.disk.gas.radial;
        let camera = self.camera;
        let l = camera.radius();
        let n = camera.position / l;
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        let towards = DVec3::new(n.x, n.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let sideways = DVec3::Z.cross(towards);
        let upwards = DVec3::Z * level - towards * n.z;
        let turn = if self.order == 2 { -1.0 } else { 1.0 };
        let gamma = |squared: f64| (1.0 + squared).sqrt();
        let [outward, ahead] = radial.momentum(r);
        let heat = radial.temperature(r);
        let mut log_light = [[LEAST_LOG_LIGHT; 2]; AZIMUTHS];
        let places: [DVec2; AZIMUTHS] = std::array::from_fn(|k| {
            let (sine, cosine) = azimuth(k).sin_cos();
            let reach = (n.z * cosine).hypot(sine).max(1e-12);
            let (along, across) = (r * cosine * level, r * reach);
            let ray = lens_lookup_at(self.slice, (along - l) as f32, across as f32, along as f32, self.order);
            let [cos_psi, sin_psi] = [ray.cos_psi, ray.sin_psi].map(f64::from);
            // On both sides. As in shaders/disk/arcs/place.wgsl, without the products of vectors that vanish.
            log_light[k] = [1.0, -1.0].map(|side| {
                let look = n * cos_psi + (sideways * (side * sine) - upwards * (n.z * cosine)) * (turn * sin_psi / reach);
                let observed = (gamma(camera.momentum.length_squared()) + camera.momentum.dot(look)) * f64::from(ray.frequency);
                let emitted = gamma(outward * outward + ahead * ahead) * f64::from(ray.emission_frequency)
                    - outward * f64::from(ray.emission_radial)
                    + ahead * f64::from(ray.emission_tangential) * (turn * side * sine * level / reach);
                let g = if self.beaming && ray.valid { (observed / emitted.max(1e-9)).clamp(1e-3, 1e3) } else { 1.0 };
                (-GREEN / (heat * g)).max(LEAST_LOG_LIGHT)
            });
            DVec2::new(cos_psi, sin_psi) * if ray.valid { f64::from(ray.delay) } else { f64::NAN }
        });
        let depth = radial.depth(r);
        let pattern = radial.pattern_radius(r);
        SeenCircle {
            radius: r,
            lag: radial.lag(r),
            rate: radial.turning_rate(r),
            pattern,
            height: pattern.ln() / PATTERN_HEIGHT,
            log_light,
            light: log_light.map(|sides| sides.map(f64::exp)),
            depth,
            stopped: slants(camera).map(|slant| stopped(depth, slant)),
            places,
            angles: places.map(|place| place.y.atan2(place.x)),
        }
    }
}

/// How far the middle of a ring deviates from the straight line between its circles. At the share t of the ring's seen width, 4t(1 − t)
/// times this is added to the line.
#[derive(Clone, Copy, Debug, Default)]
pub struct RingBend {
    /// Height in the pattern.
    height: f64,
    /// ln light: −(deviation)/(line), on the side of positive azimuth and on that of negative azimuth.
    light: [f64; 2],
    /// Optical depth: deviation over the line's value.
    depth: f64,
}

impl RingBend {
    /// The deviation of the ring between `a` and `b` at an azimuth, so that the parabola goes through `middle`. None where the middle is
    /// not seen between them.
    fn of([a, middle, b]: [&SeenCircle; 3], azimuth: usize) -> Option<RingBend> {
        let t = middle.share(a, b, azimuth);
        if !(t > LEAST_SHARE && t < 1.0 - LEAST_SHARE) {
            return None;
        }
        let weight = 1.0 / (4.0 * t * (1.0 - t));
        let straight = |from: f64, to: f64| from + t * (to - from);
        Some(RingBend {
            height: (middle.height - straight(a.height, b.height)) * weight,
            light: std::array::from_fn(|side| {
                let [from, through, to] = [a, middle, b].map(|circle| circle.log_light[azimuth][side]);
                let line = straight(from, to);
                ((1.0 - through / line) * weight).clamp(MOST_BENT / line, -MOST_BENT / line)
            }),
            depth: {
                let line = straight(a.depth, b.depth);
                // Without gas nothing deviates.
                if line > LEAST_DEPTH { (middle.depth / line - 1.0) * weight } else { 0.0 }
            },
        })
    }

    /// For the shaders.
    pub fn for_gpu(&self) -> Bend {
        let [light, other_light] = self.light.map(|light| light as f32);
        Bend { height: self.height as f32, light, other_light, depth: self.depth as f32 }
    }
}

/// Azimuth number `k`, in rad from the camera's. They are closest together where the disk comes closest to the camera.
pub fn azimuth(k: usize) -> f64 {
    let share = (k as f64 + 0.5) / AZIMUTHS as f64;
    PI * share * share
}

/// A circle of the disk as one image order shows it.
pub struct SeenCircle {
    /// In r_s.
    pub radius: f64,
    /// Azimuth by which its pattern is ahead, in rad.
    lag: f64,
    /// How fast that turns, in rad per r_s/c.
    rate: f64,
    /// The radius that its pattern comes from, and its height in the pattern.
    pattern: f64,
    height: f64,
    /// ln of the seen light of opaque gas, by azimuth, on both sides of the camera's direction.
    pub log_light: [[f64; 2]; AZIMUTHS],
    /// That light itself.
    light: [[f64; 2]; AZIMUTHS],
    depth: f64,
    /// What it stops at each of [`slants`].
    stopped: [f64; 2],
    /// For each azimuth the place, direction times light path, in the half plane that holds the ray: outward and across.
    pub places: [DVec2; AZIMUTHS],
    /// Angle of that place from outward, in rad.
    angles: [f64; AZIMUTHS],
}

impl SeenCircle {
    /// Its light at an azimuth on one side, seen face on, with the optical depth as opacity up to 1.
    fn shining(&self, azimuth: usize, side: usize) -> f64 {
        self.light[azimuth][side] * self.depth.min(1.0)
    }

    /// The angle to the same azimuth of another circle, in rad.
    pub fn angle_to(&self, other: &SeenCircle, azimuth: usize) -> f64 {
        let angle = (self.angles[azimuth] - other.angles[azimuth]).abs();
        angle.min(TAU - angle)
    }

    /// The share of the way from circle `a` to circle `b`, drawn as a straight line, at which this circle is seen. NaN where there is no
    /// ray.
    fn share(&self, a: &SeenCircle, b: &SeenCircle, azimuth: usize) -> f64 {
        let [here, start, end] = [self, a, b].map(|circle| circle.places[azimuth]);
        let (before, after) = (here.perp_dot(start), here.perp_dot(end));
        before / (before - after)
    }
}

/// The angle of a pixel in the middle of a picture `width` pixels wide, in rad.
pub fn pixel_angle(camera: &Observer, width: u32) -> f64 {
    2.0 * (0.5 * camera.field_of_view).tan() / f64::from(width.max(1))
}

/// Optical depth along a ray over that straight through the disk: for a ray face on, and for one from this camera's height.
fn slants(camera: &Observer) -> [f64; 2] {
    let height = camera.position.z.abs() / camera.radius();
    [1.0, 1.0 / height.max(LEAST_COSINE)]
}

/// The share of the light from behind that gas of an optical depth stops at a slant.
fn stopped(depth: f64, slant: f64) -> f64 {
    1.0 - (-slant * depth).exp()
}
