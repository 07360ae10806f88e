//! The circles of the disk that are drawn in an image order. Between two neighbouring circles the gas is taken as a parabola over the seen
//! width of the ring between them.

use crate::spacetime::Observer;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use wide::f32x4;

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_at;
use crate::lensing::lookup::source_point::angle;
use crate::render::disk::drawn::DrawnDisk;
use crate::render::disk::types::{Bend, RadialGas};
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

/// A circle of the disk: what does not depend on the camera.
#[derive(Clone, Copy, Debug)]
pub struct CircleGas {
    /// In r_s.
    pub radius: f64,
    /// For the shaders.
    pub drawn: RadialGas,
    /// Azimuth by which its pattern is ahead, in rad.
    lag: f64,
    /// How fast that turns, in rad per r_s/c.
    rate: f64,
    /// The radius that its pattern comes from, and its height in the pattern.
    pattern: f64,
    height: f64,
    /// −ln light of opaque gas, where it is seen without a shift.
    dark: f64,
    /// Rain-frame momentum per mass, and energy.
    outward: f64,
    along: f64,
    gamma: f64,
    depth: f64,
    /// ln of the depth as opacity, up to 0.
    ln_opacity: f64,
}

impl CircleGas {
    /// The gas of `disk` at radius `r`, in r_s.
    pub fn at(disk: &DrawnDisk, r: f64) -> CircleGas {
        let radial = &disk.gas.radial;
        let [outward, along] = radial.momentum(r);
        let (pattern, depth) = (radial.pattern_radius(r), radial.depth(r));
        CircleGas {
            radius: r,
            drawn: disk.gas_at(r),
            lag: radial.lag(r),
            rate: radial.turning_rate(r),
            pattern,
            height: pattern.ln() / PATTERN_HEIGHT,
            dark: GREEN / radial.temperature(r),
            outward,
            along,
            gamma: (1.0 + outward * outward + along * along).sqrt(),
            depth,
            ln_opacity: depth.min(1.0).ln(),
        }
    }
}

/// The circles on offer for the images of a disk.
#[derive(Clone, Debug)]
pub struct Offer {
    /// Ascending.
    pub circles: Vec<CircleGas>,
    /// Halfway from each to the next.
    between: Vec<CircleGas>,
    /// Whether they are for a close look.
    pub is_close: bool,
}

impl Offer {
    /// At [`radii`].
    pub fn new(disk: &DrawnDisk, close: bool) -> Offer {
        let radii = radii(disk, close);
        let gas = |r: f64| CircleGas::at(disk, r);
        let between = radii.windows(2).map(|pair| gas(0.5 * (pair[0] + pair[1]))).collect();
        Offer { circles: radii.into_iter().map(gas).collect(), between, is_close: close }
    }
}

/// The circles that are drawn in one image order.
#[derive(Clone, Debug, Default)]
pub struct Circles {
    /// Ascending.
    pub gas: Vec<CircleGas>,
    /// Pairs of indices into `gas` with gas between the two circles.
    pub pairs: Vec<[u32; 2]>,
    /// For the ring from each circle to the next, by azimuth: how far its middle deviates from the straight line. Zero for the last circle.
    pub bends: Vec<Bend>,
}

impl Circles {
    /// All of these circles, with straight lines between them.
    pub fn straight(gas: Vec<CircleGas>, pairs: Vec<[u32; 2]>) -> Circles {
        Circles { bends: vec![Bend::default(); AZIMUTHS * gas.len()], gas, pairs }
    }
}

/// One image order as the camera sees it.
#[derive(Clone, Debug)]
pub struct Look<'a> {
    /// From where.
    pub camera: &'a Observer,
    /// 1 to 3.
    pub order: u32,
    /// The angle of a pixel in the middle of the picture, in rad.
    pub pixel: f64,
    /// The lensing table for the camera's radius.
    slice: &'a Slice,
    /// Whether light changes its strength with g.
    beaming: bool,
    /// Radius of the camera, in r_s.
    l: f64,
    /// Energy and outward momentum of the camera.
    gamma: f64,
    outward: f64,
    slants: [f64; 2],
    bearings: [Bearing; AZIMUTHS],
}

/// What one azimuth has in common for all circles; in pairs on both sides of the camera's direction. As in shaders/disk/arcs/place.wgsl,
/// without the products of vectors that vanish.
#[derive(Clone, Copy, Debug)]
struct Bearing {
    /// Height of a point along the axis to the camera, and its distance from that, over the radius.
    along: f64,
    across: f64,
    /// The camera's momentum across the axis, where light comes from.
    aside: [f64; 2],
    /// How far light leaves against the orbit.
    against: [f64; 2],
}

impl<'a> Look<'a> {
    /// Of `order`, in a picture `width` pixels wide; `slice` is that of the camera's radius.
    pub fn new(camera: &'a Observer, slice: &'a Slice, order: u32, width: u32, beaming: bool) -> Look<'a> {
        let l = camera.radius();
        let n = camera.position / l;
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        let towards = DVec3::new(n.x, n.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let sideways = DVec3::Z.cross(towards);
        let upwards = DVec3::Z * level - towards * n.z;
        let turn = if order == 2 { -1.0 } else { 1.0 };
        let bearings = std::array::from_fn(|k| {
            let (sine, cosine) = azimuth(k).sin_cos();
            let reach = (n.z * cosine).hypot(sine).max(1e-12);
            let (side, up) = (camera.momentum.dot(sideways) * sine, camera.momentum.dot(upwards) * n.z * cosine);
            Bearing {
                along: cosine * level,
                across: reach,
                aside: [side - up, -side - up].map(|momentum| momentum * turn / reach),
                against: [sine, -sine].map(|sine| sine * turn * level / reach),
            }
        });
        Look {
            camera,
            order,
            pixel: pixel_angle(camera, width),
            slice,
            beaming,
            l,
            gamma: (1.0 + camera.momentum.length_squared()).sqrt(),
            outward: camera.momentum.dot(n),
            slants: slants(camera),
            bearings,
        }
    }

    /// Chooses the fewest of the circles on offer that keep all errors `within` their limits; `seen` are those circles.
    ///
    /// `own`, by azimuth, is the share of a circle's own gas that the image shows; the rest is the mean gas of a thin image.
    pub fn choose(&self, seen: &mut [SeenCircle], own: &[f64; AZIMUTHS], within: Within, chosen: &mut Vec<usize>) {
        let brightest = take_brightest(seen);
        let smooth = |a: usize, b: usize| {
            let ring = [&seen[a], &seen[(a + b) / 2], &seen[b]];
            let mut bends = [RingBend::default(); AZIMUTHS];
            for (k, bend) in bends.iter_mut().enumerate() {
                let Some(found) = RingBend::of(ring, k) else { return false };
                *bend = found;
            }
            // The middle and the quarters of the common ring.
            let middle = (a + b) / 2;
            let quarters = [(3 * a + b) / 4, (a + 3 * b) / 4].into_iter().filter(|&i| i != a && i != middle);
            std::iter::once(middle).chain(quarters).all(|i| self.is_on(ring, &bends, &seen[i], own, &brightest, within))
        };
        chosen.clear();
        chosen.push(0);
        let mut last = 0;
        for k in 1..seen.len() {
            if k + 1 == seen.len() || !smooth(last, k + 1) {
                chosen.push(k);
                last = k;
            }
        }
    }

    /// Looks again at those of the circles on offer that [`rows`](Look::rows) needs for the `chosen` ones.
    pub fn look_again(&self, offer: &Offer, seen: &mut [SeenCircle], chosen: &[usize]) {
        let middles = chosen.windows(2).map(|pair| (pair[0] + pair[1]) / 2);
        for k in chosen.iter().copied().chain(middles.filter(|k| chosen.binary_search(k).is_err())) {
            seen[k] = self.circle(&offer.circles[k]);
        }
    }

    /// The `chosen` of the circles on offer, which are `seen` like this, and the rings between them.
    pub fn rows(&self, offer: &Offer, seen: &[SeenCircle], chosen: &[usize], rows: &mut Circles) {
        rows.gas.clear();
        rows.gas.extend(chosen.iter().map(|&k| offer.circles[k]));
        rows.pairs.clear();
        rows.pairs.extend((1..chosen.len() as u32).map(|k| [k - 1, k]));
        rows.bends.clear();
        for pair in chosen.windows(2) {
            let [a, b] = [&seen[pair[0]], &seen[pair[1]]];
            let between = (pair[0] + pair[1]) / 2;
            // Two neighbouring circles on offer have none in their middle: it is made.
            let new = (between == pair[0]).then(|| self.circle(&offer.between[between]));
            let middle = new.as_ref().unwrap_or(&seen[between]);
            rows.bends.extend((0..AZIMUTHS).map(|k| RingBend::of([a, middle, b], k).unwrap_or_default().for_gpu()));
        }
        rows.bends.extend([Bend::default(); AZIMUTHS]);
    }

    /// Whether the parabola through `ring` (an inner circle, one in the middle, an outer one), with its `bends`, is right at the circle
    /// `here`, within the limits. `brightest`: see [`take_brightest`].
    fn is_on(
        &self,
        [a, _, b]: [&SeenCircle; 3],
        bends: &[RingBend; AZIMUTHS],
        here: &SeenCircle,
        own: &[f64; AZIMUTHS],
        brightest: &[[f64; AZIMUTHS]; 2],
        within: Within,
    ) -> bool {
        let straight = |t: f64, from: f64, to: f64| from + t * (to - from);
        let (mut depths, mut shares, mut lights) = ([0.0; AZIMUTHS], [0.0; AZIMUTHS], [[0.0; AZIMUTHS]; 2]);
        let pixels = 1.0 / self.pixel;
        let width = 1.0 / (b.gas.radius - a.gas.radius);
        for (k, bend) in bends.iter().enumerate() {
            let t = here.share(a, b, k);
            let middle = 4.0 * t * (1.0 - t);
            // Pixels per r_s across the ring, and along it.
            let wide = a.angle_to(b, k) * pixels;
            let across = wide * width;
            // A ring narrower than a pixel contributes only its width; in a thin image only this circle's own share counts.
            shares[k] = (own[k] * wide.min(1.0)) as f32;
            let along = here.gas.radius / here.lengths[k] * pixels;
            let height = straight(t, a.gas.height, b.gas.height) + middle * bend.height;
            let aside = here.gas.pattern * PATTERN_HEIGHT * (height - here.gas.height).abs();
            // Error of the azimuth of the gas: of its lag, and of the angle that it turns in the time by which the light path is off.
            let path = straight(t, a.lengths[k], b.lengths[k]) - here.lengths[k];
            let ahead = (straight(t, a.gas.lag, b.gas.lag) - here.gas.lag).abs() + here.gas.rate * path.abs();
            if !(t > 0.0 && t < 1.0 && aside * across < within.across && ahead * along * wide.min(1.0) < within.along) {
                return false;
            }
            depths[k] = (straight(t, a.gas.depth, b.gas.depth) * (1.0 + middle * bend.depth)).max(0.0) as f32;
            for (side, light) in lights.iter_mut().enumerate() {
                let line = straight(t, a.log_light[side][k], b.log_light[side][k]);
                light[k] = over_brightest(line * (1.0 - middle * bend.light[side]), brightest[side][k]);
            }
        }
        let [depths, shares] = [depths, shares].map(lanes);
        let lights = lights.map(|side| lanes(side).map(f32x4::exp));
        let wrong = |off: f32x4, share: f32x4, limit: f64| !(off.abs() * share).simd_lt(f32x4::splat(limit as f32)).all();
        (0..2).all(|n| {
            let there = f32x4::splat(here.stopped[n] as f32);
            (0..depths.len()).all(|j| {
                let drawn = 1.0 - (depths[j] * -self.slants[n] as f32).exp();
                !wrong(drawn - there, shares[j], within.stopped)
                    && (0..2).all(|side| !wrong(lights[side][j] * drawn - here.light[side][j] * there, shares[j], within.light))
            })
        })
    }

    /// The circle of this gas.
    pub fn circle(&self, gas: &CircleGas) -> SeenCircle {
        let mut seen = SeenCircle {
            gas: *gas,
            log_light: [[LEAST_LOG_LIGHT; AZIMUTHS]; 2],
            light: [[f32x4::ZERO; AZIMUTHS / 4]; 2],
            stopped: self.slants.map(|slant| stopped(gas.depth, slant)),
            places: [DVec2::NAN; AZIMUTHS],
            lengths: [f64::NAN; AZIMUTHS],
            angles: [f64::NAN; AZIMUTHS],
        };
        for (k, at) in self.bearings.iter().enumerate() {
            let (along, across) = (gas.radius * at.along, gas.radius * at.across);
            let ray = lens_lookup_at(self.slice, (along - self.l) as f32, across as f32, along as f32, self.order);
            let [cos_psi, sin_psi] = [ray.cos_psi, ray.sin_psi].map(f64::from);
            for side in 0..2 {
                let observed = (self.gamma + self.outward * cos_psi + at.aside[side] * sin_psi) * f64::from(ray.frequency);
                let emitted = gas.gamma * f64::from(ray.emission_frequency) - gas.outward * f64::from(ray.emission_radial)
                    + gas.along * f64::from(ray.emission_tangential) * at.against[side];
                let redder = if self.beaming && ray.valid { (emitted.max(1e-9) / observed.max(1e-9)).clamp(1e-3, 1e3) } else { 1.0 };
                seen.log_light[side][k] = (-gas.dark * redder).max(LEAST_LOG_LIGHT);
            }
            if ray.valid {
                seen.lengths[k] = f64::from(ray.delay);
                seen.places[k] = DVec2::new(cos_psi, sin_psi) * seen.lengths[k];
                seen.angles[k] = f64::from(angle(ray.sin_psi, ray.cos_psi, 1.0));
            }
        }
        seen
    }
}

/// ln of the brightest light at each azimuth on both sides, and lets the light of these circles be that over it. A circle is as bright as
/// seen face on, with the optical depth as opacity up to 1.
fn take_brightest(seen: &mut [SeenCircle]) -> [[f64; AZIMUTHS]; 2] {
    let mut brightest = [[LEAST_LOG_LIGHT; AZIMUTHS]; 2];
    for circle in &*seen {
        for (most, light) in brightest.as_flattened_mut().iter_mut().zip(circle.log_light.as_flattened()) {
            *most = most.max(light + circle.gas.ln_opacity);
        }
    }
    for circle in seen {
        circle.light = std::array::from_fn(|side| {
            lanes(std::array::from_fn(|k| over_brightest(circle.log_light[side][k], brightest[side][k]))).map(f32x4::exp)
        });
    }
    brightest
}

/// ln of light over the brightest: opaque gas may be brighter than what is seen of it, but not so much that it were no number.
fn over_brightest(log_light: f64, brightest: f64) -> f32 {
    (log_light - brightest).min(80.0) as f32
}

/// Registers of a value by azimuth.
type Lanes = [f32x4; AZIMUTHS / 4];

fn lanes(values: [f32; AZIMUTHS]) -> Lanes {
    bytemuck::cast(values)
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
            height: (middle.gas.height - straight(a.gas.height, b.gas.height)) * weight,
            light: std::array::from_fn(|side| {
                let [from, through, to] = [a, middle, b].map(|circle| circle.log_light[side][azimuth]);
                let line = straight(from, to);
                ((1.0 - through / line) * weight).clamp(MOST_BENT / line, -MOST_BENT / line)
            }),
            depth: {
                let line = straight(a.gas.depth, b.gas.depth);
                // Without gas nothing deviates.
                if line > LEAST_DEPTH { (middle.gas.depth / line - 1.0) * weight } else { 0.0 }
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
#[derive(Clone, Debug)]
pub struct SeenCircle {
    /// What it consists of.
    pub gas: CircleGas,
    /// ln of the seen light of opaque gas, on both sides of the camera's direction, by azimuth.
    pub log_light: [[f64; AZIMUTHS]; 2],
    /// That light itself, over the brightest.
    light: [Lanes; 2],
    /// What it stops at each of [`slants`].
    stopped: [f64; 2],
    /// For each azimuth the place, direction times light path, in the half plane that holds the ray: outward and across. NaN where there is
    /// no ray.
    pub places: [DVec2; AZIMUTHS],
    /// The light path, in r_s.
    lengths: [f64; AZIMUTHS],
    /// Angle of that place from outward, in rad.
    angles: [f64; AZIMUTHS],
}

impl SeenCircle {
    /// The angle to the same azimuth of another circle, in rad.
    pub fn angle_to(&self, other: &SeenCircle, azimuth: usize) -> f64 {
        (self.angles[azimuth] - other.angles[azimuth]).abs()
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
