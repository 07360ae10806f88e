//! The aurora of a scene over time: simulates its curtains and decides for each frame how many streaks are drawn where.

use crate::spacetime::Observer;
use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};

use crate::render::aurora::chords::Bend;
use crate::render::aurora::colours::Colours;
use crate::render::aurora::ground::{Glow, Ground, GroundFrame};
use crate::render::aurora::levels::PYRAMID;
use crate::render::aurora::node_history::{NodeHistory, ROW, ROWS, place as node_place};
use crate::render::aurora::ration::Ration;
use crate::render::aurora::shift::Shift;
use crate::render::aurora::{AuroraSettings, BOTH_POLES, LINEAR, Segment, sight, veil};
use crate::render::gpu::types::Instance;
use crate::render::instances::{Motion as Movement, Object, View, against_static, departure, instances_of, light_path};
use crate::render::models::ModelRange;
use crate::scene::aurora::curtains::curtains;
use crate::scene::aurora::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT, on_field_line};
use crate::scene::aurora::fall::Spectrum;
use crate::scene::aurora::lines::kilorayleigh_xyz;
use crate::scene::aurora::motion::{Motion, Plan, STEP, length};
use crate::scene::aurora::quantiles::{HEIGHTS, KINDS, PARTS, Quantiles};
use crate::scene::config::AuroraConfig;
use crate::scene::lighting::Surroundings;
use crate::scene::planet::{AuroraShape, Planet};
use crate::sim::History;
use crate::sim::flight::Command;
use crate::spacetime::light::{Branch, Order};
use crate::spacetime::matter::{ShipState, gamma, velocity};

/// Rows of nodes that a frame of a watched aurora makes at most. A row takes two steps of the motion, of some milliseconds each where an
/// oval has thousands of nodes.
const MOST_ROWS: usize = 2;
/// Period of the rays' noise, in s. In it the noise drifts by a whole number of times its 512 values (ends.wgsl).
pub const RAYS_PERIOD: f64 = 102_400.0;
/// Distance between nodes of the curtains, in km: a curl has at least seven nodes round.
const NODE_SPACING: f64 = 6.0;
const NODES: [usize; 2] = [1024, 4096];
/// Parts of curtains that are drawn at most, about. If there are more pairs of nodes, several make one part.
const MOST_SEGMENTS: usize = 1024;
/// By which share an oval is brighter at magnetic midnight, the side away from the hole and its disk, and fainter at noon.
const MIDNIGHT: f64 = 0.5;
/// Auroras higher than this above the planet's centre are not drawn, in planet radii.
const REACH: f64 = 1.0 + HEIGHTS[0] / PLANET_RADIUS;
/// An image of the whole planet narrower than this, in pixels, shows no aurora: it would be a twentieth of that wide. Up to twice this
/// width it fades in.
const LEAST_PIXELS: f64 = 6.0;
/// Where the image of the whole planet is narrower than this, in pixels, its ground is not lit: the light beneath a curtain, some 230 km
/// wide, would be a pixel. Up to twice this width it fades in.
const GROUND_PIXELS: f64 = 55.0;
/// Collisions of 35 eV, as kR, per erg cm⁻² s⁻¹: 6.2415e8 keV per erg, 1e9 photons cm⁻² s⁻¹ in a kR.
const KILO_COLLISIONS: f64 = 6.2415e8 / 0.035 / 1e9;
/// Streaks per pixel of a curtain's length where the image of the planet is so many pixels wide; fewer where it is narrower, down to a
/// quarter.
const PER_PIXEL: f64 = 1.5;
const FULL_PIXELS: f64 = 300.0;
/// Distance between two streaks over their standard deviation along the curtain, at most; as in streaks.wgsl.
const SMOOTH: f64 = 1.6;
/// One streak in so many is red; the others have all other lines. As in streaks.wgsl.
const TURN: u32 = 5;
/// Streaks with a standard deviation above this, in pixels, overlap more and more. They become fewer as they become wider: always 1.8 per
/// standard deviation of the curtain's length. So the number of pixels that are filled is bounded by the picture's size.
const WIDE: f64 = 1.2;
/// Parts of a streak per pixel of its length: the blur is at least half a pixel. Below it: the least number of parts.
const PARTS_PER_PIXEL: f64 = 1.2;
const LEAST_PARTS: u32 = 2;
/// Heights that a streak goes through at most, km.
const LONGEST: f64 = HEIGHTS[0] - HEIGHTS[1];
/// Room for strokes: more are not drawn in one order.
pub const MOST_STROKES: usize = 1 << 20;

/// If no point is wider than this (one standard deviation in pixels, as if space were flat), only the finest level of the pyramid is used.
/// The walk uses coarser levels from 1.5 on.
const NARROW: f64 = 1.0;

/// What a frame shows of the aurora.
#[derive(Clone, Debug, Default)]
pub struct AuroraFrame {
    /// Counts and numbers for the shaders.
    pub settings: AuroraSettings,
    /// The planet in each order in which it is seen. Body axes are those of the dipole, in km.
    pub instances: Vec<Instance>,
    /// The part of the screen on which each instance may be: left, upper, right and lower edge as shares of width and height.
    pub parts: Vec<[f64; 4]>,
    /// Whether each instance is seen through the accretion disk, told by its centre.
    pub behind: Vec<bool>,
    /// CIE XYZ of a kilorayleigh of each line in each of those orders.
    pub colours: Vec<Colours>,
    /// Parts of the curtains with their streaks.
    pub segments: Vec<Segment>,
    /// The curtains' history.
    pub rows: NodeHistory,
    /// [`Quantiles`] of the curtains' electrons.
    pub falls: Arc<Vec<f32>>,
    /// The light of the curtains on the ground, if the planet is wide enough to show it.
    pub ground: Option<GroundFrame>,
}

/// The curtains of a planet, as they move.
#[derive(Clone, Debug)]
pub struct AuroraAnimation {
    planet: Planet,
    /// Inner and outer radius of the scene's accretion disk, r_s.
    disk: Option<[f64; 2]>,
    config: AuroraConfig,
    falls: Falls,
    plan: Plan,
    motion: Option<Motion>,
    /// The history of the curtains' nodes; below, the time of its newest row in s.
    rows: NodeHistory,
    newest: f64,
    /// Their light on the ground, once it has been asked for.
    ground: Option<Ground>,
    /// Whether the aurora runs in real time. If so, no frame makes more than [`MOST_ROWS`] rows, and time out of sight is skipped. Else
    /// each frame depends on its time alone.
    watched: bool,
    /// The share of its streaks with which it is drawn.
    ration: Ration,
    /// For a watched aurora: how far its time, in s, is ahead of the game's clock.
    offset: f64,
    /// The pace before it was changed, until the next frame.
    old_pace: Option<f64>,
}

/// The worldline of a planet about T = `time`, as far back as light may come from, with the axes of its model turned by `turn`.
pub fn planet_history(planet: &Planet, time: f64, back: f64, turn: DQuat) -> Option<History> {
    let state = |t: f64| planet.state(t).map(|state| ShipState { attitude: state.attitude * turn, ..state });
    // Attitudes are interpolated between nodes; over a fiftieth of a turn linear motion is off by 0.2 %. At most 400 nodes, however far
    // back light comes from.
    let step = (planet.day / 50.0).min(2.0).max(back / 400.0);
    let first = time - back;
    let mut history = History::new(first, &state(first)?);
    for k in 1..=(back / step).ceil() as u32 + 1 {
        let t = first + f64::from(k) * step;
        history.push(t, &state(t)?, &Command::default());
    }
    Some(history)
}

impl AuroraAnimation {
    /// The aurora of a planet; `disk` has the radii of the accretion disk beside it, if there is one. None if the planet has no aurora.
    pub fn new(planet: &Planet, disk: Option<[f64; 2]>, config: &AuroraConfig) -> Option<AuroraAnimation> {
        if !config.enabled || planet.aurora == AuroraShape::None {
            return None;
        }
        let curves = curtains(planet.aurora, config.seed);
        let kilometres: f64 = curves.iter().map(length).sum();
        let plan = Plan {
            curves,
            nodes: ((kilometres / NODE_SPACING) as usize).clamp(NODES[0], NODES[1]),
            field: config.field,
            renewal: config.renewal,
            contrast: config.contrast,
            seed: config.seed,
        };
        let config = config.clone();
        Some(AuroraAnimation {
            planet: *planet,
            disk,
            falls: Falls::of(&config),
            config,
            plan,
            motion: None,
            rows: NodeHistory::default(),
            newest: 0.0,
            ground: None,
            watched: false,
            ration: Ration::default(),
            offset: 0.0,
            old_pace: None,
        })
    }

    /// The same in real time: no frame takes much longer than another.
    pub fn watched(mut self) -> AuroraAnimation {
        self.watched = true;
        self
    }

    /// Takes up other settings and goes on. Returns false, and changes nothing, if they ask for another aurora or for none.
    pub fn change(&mut self, config: &AuroraConfig) -> bool {
        if !config.enabled || config.seed != self.config.seed {
            return false;
        }
        if config.pace != self.config.pace {
            self.old_pace.get_or_insert(self.config.pace);
        }
        (self.plan.field, self.plan.renewal, self.plan.contrast) = (config.field, config.renewal, config.contrast);
        if let Some(motion) = &mut self.motion {
            motion.change(config.field, config.renewal, config.contrast);
        }
        if [config.energy, config.thermal] != [self.config.energy, self.config.thermal] {
            self.falls = Falls::of(config);
            self.ground = None;
        }
        self.config = config.clone();
        true
    }

    /// Takes the times (ms) of all passes of an earlier frame. The aurora is held to `share` of them, if need be by fewer and wider
    /// streaks.
    pub fn ration(&mut self, passes: &[(&str, f32)]) {
        self.ration.follow(passes, self.config.share);
    }

    /// The aurora in the frame at T = `time`. None while it is out of sight or too small to see; then nothing is simulated. `back` is how
    /// far back light comes from, in r_s/c.
    pub fn frame(&mut self, view: &View, time: f64, back: f64, orders: u32) -> Option<AuroraFrame> {
        let history = planet_history(&self.planet, time, back, self.planet.dipole())?;
        let scale = self.planet.radius / PLANET_RADIUS;
        let nothing = ModelRange::default();
        let object = Object {
            model: nothing,
            coarse: nothing,
            stand_ins: &[],
            motion: Movement::Flying(&history),
            reach: self.planet.radius * REACH,
            scale,
            id: 0,
            light: Surroundings::default(),
        };
        let now = history.at(time);
        let distance = (now.position - view.camera.position).length();
        let pixels = 2.0 * self.planet.radius / distance.max(1e-6) / view.pixel;
        let mut frame = AuroraFrame::default();
        let mut whole_width: f64 = 0.0;
        for placed in instances_of(view, time, &object, orders) {
            let instance = placed.instance;
            let Some(order) = Order::new(instance.ids[0] as u8) else { continue };
            let position = DVec3::from_array([0, 1, 2].map(|k| f64::from(instance.position[k])));
            let extent = view.extent(position, object.reach, order, 0.0);
            // Light of higher orders comes round the hole: from there even a near planet is far away.
            let near = distance < 2.0 * object.reach && order.number() == 1;
            let width = if near { pixels } else { extent.width };
            // It fades in and out.
            let part = (width / LEAST_PIXELS - 1.0).min(1.0);
            if part > 0.0 && sight::may_be_seen(view, time, &history, order, object.reach) {
                let whole = [0.0, 0.0, 1.0, 1.0];
                let seen_on = |aspect| if near { whole } else { extent.part_of_screen(view.camera, aspect) };
                whole_width = whole_width.max(width);
                frame.parts.push(view.aspect.map_or(whole, seen_on));
                let bends = view.settings.method.bends();
                frame.behind.push(self.disk.is_some_and(|disk| veil::is_behind(view.camera, position, order, bends, disk)));
                frame.colours.push(self.colours(view, time, &history, order, part));
                frame.instances.push(instance);
            }
        }
        if frame.instances.is_empty() {
            return None;
        }
        if let Some(pace) = self.old_pace.take() {
            self.offset += time * (pace - self.config.pace);
        }
        let ahead = if self.watched { self.go_on(time * self.config.pace) } else { self.advance(time * self.config.pace) };
        let segments = self.segments(view, now.position, now.attitude, pixels);
        let both = self.planet.aurora == AuroraShape::Oval;
        let poles = if both { 2 } else { 1 };
        let streaks = segments.last().map_or(0, |segment| segment.range[0] + segment.range[2]);
        let mut flags = if self.config.walk == "linear" { LINEAR } else { 0 };
        if both {
            flags |= BOTH_POLES;
        }
        let orders: Vec<Order> = frame.instances.iter().filter_map(|instance| Order::new(instance.ids[0] as u8)).collect();
        let bend =
            Bend { view, time, history: &history, scale, tops: self.falls.tops, heights: self.falls.ends.map(|ends| ends.map(f64::from)) };
        let chords = bend.chords(&segments, |segment, wait| self.rows.middle_of(segment, wait + ahead), &orders, flags);
        let drawn_out = magnification(view, now.position, self.planet.radius);
        // As if seen from the side; on a far planet the whole streak is a pixel or two.
        let length = 0.5 * pixels * LONGEST / PLANET_RADIUS * drawn_out;
        let parts = self.config.parts.min(((PARTS_PER_PIXEL * length).ceil() as u32).max(LEAST_PARTS));
        let room = (streaks as usize * parts as usize).min(MOST_STROKES);
        // The largest width at which a point may be seen, where the aurora is nearest.
        let nearest = distance - object.reach;
        let spread = segments.iter().map(|segment| spread(segment, poles)).fold(0.0, f64::max);
        let widest = self.config.radius.hypot(spread) * scale / (nearest * view.pixel) * drawn_out;
        let levels = if nearest <= object.reach || widest > NARROW { PYRAMID } else { 1 };
        // Away from the hole, in the axes of the dipole.
        let away = (now.attitude.inverse() * now.position).normalize_or_zero().truncate();
        let midnight = if both { MIDNIGHT * away } else { DVec2::ZERO };
        frame.settings = AuroraSettings {
            counts: [streaks, chords, parts, self.rows.ago(0).len() as u32],
            history: [self.rows.newest() as u32, segments.len() as u32, room as u32, flags],
            clock: [ROW as f32, ahead as f32, (time * self.config.pace).rem_euclid(RAYS_PERIOD) as f32, self.config.contrast as f32],
            strokes: [self.config.radius as f32, levels as f32, midnight.x as f32, midnight.y as f32],
            heights: [0, 1, 2, 3].map(|k| self.falls.ends[k / 2][k % 2]),
        };
        frame.ground = self.ground(midnight, ahead, whole_width);
        frame.rows = self.rows.clone();
        frame.segments = segments;
        frame.falls = self.falls.table.clone();
        (streaks > 0).then_some(frame)
    }

    /// The same for a watched aurora, whose time is ahead of `now`. It begins at rest, with a past in which nothing changed (light that
    /// travelled along the curtains would take 128 rows in one frame, 60 to 70 ms for an oval); when it comes into sight again it goes on
    /// where it was, and where the clock runs away from it, it stays behind.
    fn go_on(&mut self, now: f64) -> f64 {
        let now = now + self.offset;
        if self.motion.is_none() {
            let motion = Motion::new(self.plan.clone(), (now / ROW).floor() * ROW);
            self.rows = NodeHistory::still(motion.row());
            self.newest = motion.time();
            self.motion = Some(motion);
        }
        if let Some(mut motion) = self.motion.take() {
            for _ in 0..MOST_ROWS {
                if self.newest < now {
                    move_on(&mut motion);
                    self.keep(&motion);
                }
            }
            self.motion = Some(motion);
        }
        // Missed: hidden for a while, or the clock began anew.
        let missed = if (self.newest - 2.0 * ROW..=self.newest).contains(&now) { 0.0 } else { self.newest - now };
        self.offset += missed;
        self.newest - (now + missed)
    }

    /// The curtains as they are now become the newest row.
    fn keep(&mut self, motion: &Motion) {
        self.newest = motion.time();
        self.rows.push(motion.row());
    }

    /// Brings the curtains to the time `now` (s); returns by how much the newest row is ahead of it.
    fn advance(&mut self, now: f64) -> f64 {
        let warm_up = ROWS as f64 * ROW;
        let stale = self.motion.as_ref().is_none_or(|motion| !(motion.time() - warm_up..=motion.time() + warm_up).contains(&now));
        if stale {
            let motion = Motion::new(self.plan.clone(), ((now - warm_up) / ROW).floor() * ROW);
            self.rows = NodeHistory::still(motion.row());
            self.newest = motion.time();
            self.motion = Some(motion);
        }
        let Some(mut motion) = self.motion.take() else { return 0.0 };
        while self.newest < now {
            move_on(&mut motion);
            self.keep(&motion);
        }
        self.motion = Some(motion);
        self.newest - now
    }

    /// Their light on the ground, faded by the width in pixels of the widest image of the planet.
    fn ground(&mut self, midnight: DVec2, ahead: f64, pixels: f64) -> Option<GroundFrame> {
        let part = (pixels / GROUND_PIXELS - 1.0).min(1.0);
        let motion = self.motion.as_ref().filter(|_| part > 0.0)?;
        let ground = self.ground.get_or_insert_with(|| Ground::new(&self.plan.curves, motion, self.falls.glow.clone()));
        // In the unit of the lines' colours at rest; what is lit is shifted like the surface.
        let unit = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1];
        let both = self.planet.aurora == AuroraShape::Oval;
        let kilo = self.config.flux * self.planet.aurora_flux * KILO_COLLISIONS * unit;
        Some(ground.frame(&self.rows, ahead / ROW, midnight, kilo, self.planet.dipole(), both))
    }

    /// Parts of the curtains, each with as many streaks as its length on the screen asks for.
    fn segments(&self, view: &View, centre: DVec3, attitude: DQuat, pixels: f64) -> Vec<Segment> {
        let scale = self.planet.radius / PLANET_RADIUS;
        let Some(motion) = &self.motion else { return Vec::new() };
        let row = self.rows.ago(0);
        // In a row each curve has one more node at either end.
        let curves =
            motion.starts().windows(2).enumerate().map(|(curve, window)| [window[0], window[1] - 1].map(|node| node + 2 * curve + 1));
        let both = self.planet.aurora == AuroraShape::Oval;
        let poles = if both { 2.0 } else { 1.0 };
        // Length on the screen of each pair of nodes, in pixels, as if space were flat; less where strokes are wide. Distances below 100
        // km, the height of the aurora, count as 100 km.
        let mut weights = vec![0.0; row.len()];
        let mut total = 0.0;
        for [first, last] in curves.clone() {
            for (k, weight) in weights.iter_mut().enumerate().take(last).skip(first) {
                let here = centre + attitude * (on_field_line(node_place(row, k), REFERENCE_HEIGHT) * scale);
                let length = node_place(row, k).distance(node_place(row, k + 1)) * scale;
                let per_pixel = (here - view.camera.position).length().max(100.0 * scale) * view.pixel;
                let sigma = self.config.radius * scale / per_pixel;
                *weight = length / per_pixel * WIDE / sigma.max(WIDE);
                total += poles * *weight;
            }
        }
        let per_pixel = PER_PIXEL * (pixels / FULL_PIXELS).clamp(0.25, 1.0);
        let wanted =
            (per_pixel * total * magnification(view, centre, self.planet.radius)).min(f64::from(self.config.streaks)) * self.ration.part();
        // Where few streaks are wanted, several pairs of nodes make one part.
        let least = if both { 2 * TURN } else { TURN };
        let stride =
            ((f64::from(least) * row.len() as f64 / wanted.max(1.0)).ceil() as usize).max(row.len().div_ceil(MOST_SEGMENTS)).clamp(1, 64);
        let mut segments = Vec::new();
        let mut first = 0;
        for (([first_of_curve, last], curve), &length) in curves.zip(&self.plan.curves).zip(motion.lengths()) {
            let pairs = last - first_of_curve;
            let length = length / pairs as f64;
            let mut k = 0;
            while k < pairs {
                let span = stride.min(pairs - k);
                let first_node = first_of_curve + k;
                let weight: f64 = weights[first_node..first_node + span].iter().sum();
                let count = (poles * weight / total.max(1e-9) * wanted / f64::from(least)).round().max(1.0) as u32 * least;
                let kilometres: f64 = (first_node..first_node + span).map(|k| node_place(row, k).distance(node_place(row, k + 1))).sum();
                // Collisions of 35 eV in kR km².
                let energy = self.config.flux * self.planet.aurora_flux * KILO_COLLISIONS * length * span as f64 * curve.width * poles;
                segments.push(Segment {
                    range: [first, first_node as u32, count, span as u32],
                    light: [energy as f32, curve.width as f32, kilometres as f32, 0.0],
                });
                first += count;
                k += span;
            }
        }
        segments
    }

    /// The colours of the lines in an image of the planet, Doppler shifted and beamed as the settings say, times `part` of their
    /// brightness.
    fn colours(&self, view: &View, time: f64, history: &History, order: Order, part: f64) -> Colours {
        let even = || Shift::even(frequency_ratio(view, time, history, order).unwrap_or(1.0).clamp(0.2, 5.0));
        let shift = Shift::new(view, time, history, order, self.planet.radius).unwrap_or_else(even);
        Colours::new(&shift, |g| {
            let [shift, beam] = [view.settings.doppler, view.settings.beaming].map(|on| if on { g.clamp(0.2, 5.0) } else { 1.0 });
            // A kilorayleigh of green at rest has the luminance that game.toml gives it. Power goes as g⁴.
            let unit = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1] * (beam / shift).powi(4);
            kilorayleigh_xyz(shift).map(|[x, y, z]| [(x * unit) as f32, (y * unit) as f32, (z * unit) as f32, 0.0])
        })
    }
}

/// Standard deviation, in km, of the light of a part's streaks across the curtain or, where streaks stand far apart, along it: the larger
/// of the two, for the red streaks, which stand farthest apart. As in streaks.wgsl.
fn spread(segment: &Segment, poles: u32) -> f64 {
    let [_, width, length, _] = segment.light.map(f64::from);
    let apart = length * f64::from(TURN * poles) / f64::from(segment.range[2].max(1));
    (width / 12f64.sqrt()).max(apart / SMOOTH)
}

/// Light over height of electrons with the energies that the settings ask for.
#[derive(Clone, Debug)]
struct Falls {
    /// As the shaders read them.
    table: Arc<Vec<f32>>,
    /// See [`Quantiles::ends`].
    ends: [[f32; 2]; KINDS],
    /// For each kind, the height (km) above which one of [`PARTS`] equal parts of the light is made.
    tops: [f64; KINDS],
    /// What they light the ground with.
    glow: Glow,
}

impl Falls {
    fn of(config: &AuroraConfig) -> Falls {
        let falls = Quantiles::new(&Spectrum { accelerated: config.energy, thermal: config.thermal });
        let tops = [0, 1].map(|kind| f64::from(falls.heights[kind * (PARTS + 1) + 1]));
        Falls { table: Arc::new(falls.laid_out()), ends: falls.ends, tops, glow: Glow::of(&falls) }
    }
}

/// As many steps as there are between two rows.
fn move_on(motion: &mut Motion) {
    for _ in 0..(ROW / STEP).round() as u32 {
        motion.step();
    }
}

/// How much longer the hole's lensing makes the image of a planet behind it: the point lens of weak fields, μ = (u² + 2)/(u √(u² + 4)) with
/// u the angle from the axis over Einstein's angle. Only for how many streaks are drawn.
fn magnification(view: &View, centre: DVec3, radius: f64) -> f64 {
    let (l, r) = (view.camera.radius(), centre.length());
    let behind = -centre.dot(view.camera.position) / l;
    if behind <= 0.0 || !view.settings.method.bends() {
        return 1.0;
    }
    let einstein = (2.0 * behind / (l * (l + behind))).sqrt();
    // The planet moves while its light travels: its distance from the axis is known to a few radii only.
    let off = ((r * r - behind * behind).max(0.0).sqrt() - 4.0 * radius).max(0.5 * radius) / (l + behind);
    let u = off / einstein;
    (u * u + 2.0) / (u * (u * u + 4.0).sqrt())
}

/// ν_observed/ν_emitted for the centre of a body: the ratio of proper times between two wave crests, from the light path's derivatives
/// along both worldlines. Where light is drawn straight it is that of special relativity against what hovers, as for all else.
fn frequency_ratio(view: &View, time: f64, history: &History, order: Order) -> Option<f64> {
    let camera = view.camera;
    let emitted = history.at(departure(view, time, history, order)?);
    if !view.settings.method.bends() {
        let k = (camera.position - emitted.position).normalize();
        let frequency = |position, momentum| {
            let p = against_static(position, momentum);
            gamma(p) - p.dot(k)
        };
        return Some(frequency(camera.position, camera.momentum) / frequency(emitted.position, emitted.momentum));
    }
    let (_, gradient) = light_path(camera, emitted.position, order, Branch::Plus)?;
    let moving = velocity(&ShipState::new(camera.position, camera.momentum));
    // A millionth of the radius: the light path is exact to 1e-12 of it.
    let h = 1e-6 * camera.radius();
    let path = |s: f64| {
        light_path(&Observer { position: camera.position + moving * s, ..*camera }, emitted.position, order, Branch::Plus)
            .map(|path| path.0)
    };
    let along = (path(h)? - path(-h)?) / (2.0 * h);
    let received = 1.0 - along;
    let sent = 1.0 + gradient.dot(emitted.velocity);
    let g = gamma(camera.momentum) / gamma(emitted.momentum) * received / sent;
    (g.is_finite() && g > 0.0).then_some(g)
}
