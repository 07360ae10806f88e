//! The aurora of a scene over time: simulates its curtains and decides for each frame how many streaks are drawn where (`streaks`), with
//! how many chords (`chords`).

mod chords;
pub(super) mod planet_view;
pub(super) mod streaks;

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::render::aurora::colours::Colours;
use crate::render::aurora::ground::{Glow, Ground, GroundFrame};
use crate::render::aurora::node_history::{NodeHistory, ROW, ROWS};
use crate::render::aurora::ration::Ration;
use crate::render::aurora::shift::ImageShift;
use crate::render::aurora::{AuroraSettings, BOTH_POLES, LINEAR, Segment, occlusion, sight};
use crate::render::gpu::types::Instance;
use crate::render::instances::{DrawnObject, InstanceView, ObjectMotion, instances_of};
use crate::render::models::ModelRange;
use crate::scene::aurora::curtains::curtains;
use crate::scene::aurora::dipole::PLANET_RADIUS;
use crate::scene::aurora::fall::Spectrum;
use crate::scene::aurora::lines::kilorayleigh_xyz;
use crate::scene::aurora::motion::{AuroraMotion, Plan, STEP, length};
use crate::scene::aurora::quantiles::{HEIGHTS, KINDS, PARTS, Quantiles};
use crate::scene::config::AuroraConfig;
use crate::scene::lighting::Illumination;
use crate::scene::planet::{AuroraShape, Planet};
use crate::spacetime::light::Order;
use chords::ChordInputs;
use planet_view::{PlanetView, planet_history};
use streaks::Curtains;

/// Rows of nodes that a frame of a watched aurora makes at most. A row takes two steps of the motion, of some milliseconds each where an
/// oval has thousands of nodes.
const MOST_ROWS: usize = 2;
/// Period of the rays' noise, in s. In it the noise drifts by a whole number of times its 512 values (ends.wgsl).
pub const RAYS_PERIOD: f64 = 102_400.0;
/// Distance between nodes of the curtains, in km: a curl has at least seven nodes round.
const NODE_SPACING: f64 = 6.0;
const NODES: [usize; 2] = [1024, 4096];
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
/// Room for strokes: more are not drawn in one order.
const MOST_STROKES: usize = 1 << 20;

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
    motion: Option<AuroraMotion>,
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
    pub fn frame(&mut self, view: &InstanceView, time: f64, back: f64, orders: u32) -> Option<AuroraFrame> {
        let history = planet_history(&self.planet, time, back, self.planet.dipole())?;
        let globe = PlanetView::new(view, time, &history, self.planet.radius);
        let (mut frame, widest) = self.images(&globe, orders);
        if frame.instances.is_empty() {
            return None;
        }
        if let Some(pace) = self.old_pace.take() {
            self.offset += time * (pace - self.config.pace);
        }
        let ahead = if self.watched { self.go_on(time * self.config.pace) } else { self.advance(time * self.config.pace) };
        let midnight = self.midnight(&globe);
        self.draw_streaks(&mut frame, &globe, ahead);
        frame.settings.midnight = midnight.as_vec2().to_array();
        frame.ground = self.ground(midnight, ahead, widest);
        frame.rows = self.rows.clone();
        frame.falls = self.falls.table.clone();
        frame.segments.last().is_some_and(|segment| segment.first_streak + segment.streaks > 0).then_some(frame)
    }

    /// The planet's images that show the aurora, with the colours of each, and the width of the widest, pixels.
    fn images(&self, globe: &PlanetView, orders: u32) -> (AuroraFrame, f64) {
        let &PlanetView { view, time, history, distance, .. } = globe;
        let nothing = ModelRange::default();
        let object = DrawnObject {
            model: nothing,
            coarse: nothing,
            stand_ins: &[],
            motion: ObjectMotion::Flying(history),
            reach: self.planet.radius * REACH,
            scale: self.planet.radius / PLANET_RADIUS,
            id: 0,
            light: Illumination::default(),
        };
        let mut frame = AuroraFrame::default();
        let mut widest: f64 = 0.0;
        for placed in instances_of(view, time, &object, orders) {
            let instance = placed.instance;
            let Some(order) = Order::new(instance.order as u8) else { continue };
            let position = DVec3::from_array(instance.position.map(f64::from));
            let extent = view.extent(position, object.reach, order, 0.0);
            // Light of higher orders comes round the hole: from there even a near planet is far away.
            let near = distance < 2.0 * object.reach && order.number() == 1;
            let width = if near { globe.pixels } else { extent.width };
            // It fades in and out.
            let part = (width / LEAST_PIXELS - 1.0).min(1.0);
            if part > 0.0 && sight::may_be_seen(view, time, history, order, object.reach) {
                let whole = [0.0, 0.0, 1.0, 1.0];
                let seen_on = |aspect| if near { whole } else { extent.part_of_screen(view.camera, aspect) };
                widest = widest.max(width);
                frame.parts.push(view.aspect.map_or(whole, seen_on));
                let bends = view.settings.method.bends;
                frame.behind.push(self.disk.is_some_and(|disk| occlusion::is_behind(view.camera, position, order, bends, disk)));
                frame.colours.push(self.colours(globe, order, part));
                frame.instances.push(instance);
            }
        }
        (frame, widest)
    }

    /// Whether there are curtains at both poles.
    fn both_poles(&self) -> bool {
        self.planet.aurora == AuroraShape::Oval
    }

    /// Towards magnetic midnight, away from the hole, in the axes of the dipole: as long as the oval is brighter there.
    fn midnight(&self, globe: &PlanetView) -> DVec2 {
        let away = (globe.attitude.inverse() * globe.position).normalize_or_zero().truncate();
        if self.both_poles() { MIDNIGHT * away } else { DVec2::ZERO }
    }

    /// Collisions of 35 eV in a curtain, in kR for each km that it is wide.
    fn collisions(&self) -> f64 {
        self.config.flux * self.planet.aurora_flux * KILO_COLLISIONS
    }

    /// Puts the curtains as they are now into a frame, but for midnight: their parts, and what shaders need to know of the streaks. The
    /// newest row is `ahead` (s).
    fn draw_streaks(&self, frame: &mut AuroraFrame, globe: &PlanetView, ahead: f64) {
        let Some(motion) = &self.motion else { return };
        let curtains = Curtains {
            config: &self.config,
            curves: &self.plan.curves,
            motion,
            row: self.rows.ago(0),
            both: self.both_poles(),
            ration: self.ration.part() * f64::from(globe.view.settings.streaks),
            collisions: self.collisions(),
        };
        let segments = curtains.segments(globe);
        let streaks = segments.last().map_or(0, |segment| segment.first_streak + segment.streaks);
        let mut flags = if self.config.walk == "linear" { LINEAR } else { 0 };
        if curtains.both {
            flags |= BOTH_POLES;
        }
        let orders: Vec<Order> = frame.instances.iter().filter_map(|instance| Order::new(instance.order as u8)).collect();
        let bend = ChordInputs {
            view: globe.view,
            time: globe.time,
            history: globe.history,
            scale: globe.radius / PLANET_RADIUS,
            tops: self.falls.tops,
            heights: self.falls.ends.map(|ends| ends.map(f64::from)),
        };
        let chords = bend.chords(&segments, |segment, wait| self.rows.middle_of(segment, wait + ahead), &orders, flags);
        let parts = curtains.parts(globe);
        let capacity = (streaks as usize * parts as usize).min(MOST_STROKES);
        let levels = curtains.levels(globe, &segments, self.planet.radius * REACH);
        let clock = (globe.time * self.config.pace).rem_euclid(RAYS_PERIOD);
        let [[green_top, green_foot], [red_top, red_foot]] = self.falls.ends;
        frame.settings = AuroraSettings {
            streaks,
            chords,
            parts,
            row_nodes: self.rows.ago(0).len() as u32,
            newest_row: self.rows.newest() as u32,
            segments: segments.len() as u32,
            capacity: capacity as u32,
            flags,
            row_seconds: ROW as f32,
            ahead: ahead as f32,
            clock: clock as f32,
            contrast: self.config.contrast as f32,
            point: self.config.radius as f32,
            levels,
            midnight: [0.0; 2],
            green_top,
            green_foot,
            red_top,
            red_foot,
        };
        frame.segments = segments;
    }

    /// The same for a watched aurora, whose time is ahead of `now`. It begins at rest, with a past in which nothing changed (light that
    /// travelled along the curtains would take 128 rows in one frame, 60 to 70 ms for an oval); when it comes into sight again it goes on
    /// where it was, and where the clock runs away from it, it stays behind.
    fn go_on(&mut self, now: f64) -> f64 {
        let now = now + self.offset;
        if self.motion.is_none() {
            let motion = AuroraMotion::new(self.plan.clone(), (now / ROW).floor() * ROW);
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
    fn keep(&mut self, motion: &AuroraMotion) {
        self.newest = motion.time();
        self.rows.push(motion.row());
    }

    /// Brings the curtains to the time `now` (s); returns by how much the newest row is ahead of it.
    fn advance(&mut self, now: f64) -> f64 {
        let warm_up = ROWS as f64 * ROW;
        let stale = self.motion.as_ref().is_none_or(|motion| !(motion.time() - warm_up..=motion.time() + warm_up).contains(&now));
        if stale {
            let motion = AuroraMotion::new(self.plan.clone(), ((now - warm_up) / ROW).floor() * ROW);
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
        let (collisions, both) = (self.collisions(), self.both_poles());
        let motion = self.motion.as_ref().filter(|_| part > 0.0)?;
        let ground = self.ground.get_or_insert_with(|| Ground::new(&self.plan.curves, motion, self.falls.glow.clone()));
        // In the unit of the lines' colours at rest; what is lit is shifted like the surface.
        let unit = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1];
        let kilo = collisions * unit;
        Some(ground.frame(&self.rows, ahead / ROW, midnight, kilo, self.planet.dipole(), both))
    }

    /// The colours of the lines in an image of the planet, Doppler shifted and beamed as the settings say, times `part` of their
    /// brightness.
    fn colours(&self, globe: &PlanetView, order: Order, part: f64) -> Colours {
        let view = globe.view;
        let even = || ImageShift::even(globe.frequency_ratio(order).unwrap_or(1.0).clamp(0.2, 5.0));
        let shift = ImageShift::new(view, globe.time, globe.history, order, self.planet.radius).unwrap_or_else(even);
        Colours::new(&shift, |g| {
            let [shift, beam] = [view.settings.doppler, view.settings.beaming].map(|on| if on { g.clamp(0.2, 5.0) } else { 1.0 });
            // A kilorayleigh of green at rest has the luminance that game.toml gives it. Power goes as g⁴.
            let unit = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1] * (beam / shift).powi(4);
            kilorayleigh_xyz(shift).map(|[x, y, z]| [(x * unit) as f32, (y * unit) as f32, (z * unit) as f32, 0.0])
        })
    }
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
fn move_on(motion: &mut AuroraMotion) {
    for _ in 0..(ROW / STEP).round() as u32 {
        motion.step();
    }
}
