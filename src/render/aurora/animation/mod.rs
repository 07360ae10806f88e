//! The aurora of a scene over time: simulates its curtains, in real time beside the frames (`next_row`), and decides for each frame how
//! many streaks are drawn where (`streaks`), with how many chords (`chords`).

mod chords;
mod next_row;
pub(super) mod planet_view;
pub(super) mod streaks;

use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};

use crate::render::aurora::colours::Colours;
use crate::render::aurora::ground::{Glow, Ground, GroundFrame, GroundMaps, GroundView};
use crate::render::aurora::node_history::{NodeHistory, ROW, ROWS};
use crate::render::aurora::ration::Ration;
use crate::render::aurora::shift::ImageShift;
use crate::render::aurora::{AuroraSettings, BOTH_POLES, LINEAR, Segment, occlusion, sight};
use crate::render::gpu::types::Instance;
use crate::render::instances::{DrawnObject, InstanceView, ObjectMotion, PlacedList, place};
use crate::render::models::ModelRange;
use crate::scene::aurora::curtains::curtains;
use crate::scene::aurora::dipole::PLANET_RADIUS;
use crate::scene::aurora::fall::Spectrum;
use crate::scene::aurora::lines::kilorayleigh_xyz;
use crate::scene::aurora::motion::{AuroraMotion, NodeLayout, Plan, length};
use crate::scene::aurora::quantiles::{HEIGHTS, KINDS, PARTS, Quantiles};
use crate::scene::config::AuroraConfig;
use crate::scene::lighting::Illumination;
use crate::scene::planet::{AuroraShape, Planet};
use crate::spacetime::light::Order;
use chords::{ChordInputs, Chords};
use next_row::{MadeRow, NextRow, WantedMaps};
use planet_view::{PlanetLine, PlanetView};
use streaks::Curtains;

/// Rows of nodes that a frame of a watched aurora takes at most.
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
/// From this share of that width on the map of the ground's light is made with each row of a watched aurora.
const LIT_AHEAD: f64 = 0.9;
/// Collisions of 35 eV, as kR, per erg cm⁻² s⁻¹: 6.2415e8 keV per erg, 1e9 photons cm⁻² s⁻¹ in a kR.
const KILO_COLLISIONS: f64 = 6.2415e8 / 0.035 / 1e9;
/// Room for strokes: more are not drawn in one order.
const MOST_STROKES: usize = 1 << 20;

/// What a frame shows of the aurora.
#[derive(Debug, Default)]
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

impl Clone for AuroraFrame {
    fn clone(&self) -> Self {
        let mut copy = AuroraFrame::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, other: &Self) {
        self.settings = other.settings;
        self.instances.clone_from(&other.instances);
        self.parts.clone_from(&other.parts);
        self.behind.clone_from(&other.behind);
        self.colours.clone_from(&other.colours);
        self.segments.clone_from(&other.segments);
        self.rows.clone_from(&other.rows);
        self.falls.clone_from(&other.falls);
        self.ground.clone_from(&other.ground);
    }
}

/// The curtains of a planet, as they move.
#[derive(Debug)]
pub struct AuroraAnimation {
    planet: Planet,
    /// The planet's worldline with the dipole's axes.
    line: PlanetLine,
    /// Inner and outer radius of the scene's accretion disk, r_s.
    disk: Option<[f64; 2]>,
    config: AuroraConfig,
    falls: Falls,
    plan: Plan,
    /// How the curtains move on: whole rows at once, or beside the frames where the aurora is watched.
    motion: Option<AuroraMotion>,
    next: Option<NextRow>,
    /// The history of the curtains' nodes, and its newest row; none before the first frame.
    rows: NodeHistory,
    newest: Option<MadeRow>,
    /// Which nodes each curtain has.
    layout: Arc<NodeLayout>,
    /// Makes their light on the ground, once that has been asked for, and that light by the last two rows.
    ground: Option<Arc<Ground>>,
    maps: Option<GroundMaps>,
    /// Whether the aurora runs in real time. If so, no frame takes more than [`MOST_ROWS`] rows, and time out of sight is skipped. Else
    /// each frame depends on its time alone.
    watched: bool,
    /// The share of its streaks with which it is drawn.
    ration: Ration,
    /// For a watched aurora: how many chords a streak has.
    chords: Option<Chords>,
    /// For a watched aurora: how far its time, in s, is ahead of the game's clock.
    offset: f64,
    /// The pace before it was changed, until the next frame.
    old_pace: Option<f64>,
    room: Room,
}

/// Memory that frames use again.
#[derive(Debug, Default)]
struct Room {
    /// A frame that is not shown any more.
    frame: Option<AuroraFrame>,
    placed: PlacedList,
    /// See [`Curtains::part`].
    weights: Vec<f64>,
}

/// The planet's images that show the aurora.
struct Images {
    /// What is drawn of each.
    frame: AuroraFrame,
    /// The order of each, and the T at which light left the planet's centre for it.
    departures: [(Order, f64); Order::ALL.len()],
    /// The width of the widest, pixels.
    widest: f64,
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
            line: PlanetLine::new(planet.dipole()),
            disk,
            falls: Falls::of(&config),
            config,
            plan,
            motion: None,
            next: None,
            rows: NodeHistory::default(),
            newest: None,
            layout: Arc::default(),
            ground: None,
            maps: None,
            watched: false,
            ration: Ration::default(),
            chords: None,
            offset: 0.0,
            old_pace: None,
            room: Room::default(),
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
            (self.ground, self.maps) = (None, None);
        }
        self.chords = None;
        self.config = config.clone();
        true
    }

    /// Takes the times (ms) of all passes of an earlier frame. The aurora is held to `share` of them, if need be by fewer and wider
    /// streaks.
    pub fn ration(&mut self, passes: &[(&str, f32)]) {
        self.ration.follow(passes, self.config.share);
    }

    /// Whether it is held to a share that it may exceed.
    pub fn is_rationed(&self) -> bool {
        self.config.share < 1.0
    }

    /// Makes the next frame in the memory of this one, which is not shown any more.
    pub fn reuse(&mut self, frame: AuroraFrame) {
        self.room.frame = Some(frame);
    }

    /// The aurora in the frame at T = `time`. None while it is out of sight or too small to see; then nothing is simulated. `back` is how
    /// far back light comes from, in r_s/c.
    pub fn frame(&mut self, view: &InstanceView, time: f64, back: f64, orders: u32) -> Option<AuroraFrame> {
        let mut line = std::mem::take(&mut self.line);
        let history = line.about(&self.planet, time, back);
        let frame = history.and_then(|history| self.frame_of(&PlanetView::new(view, time, history, self.planet.radius), orders));
        self.line = line;
        frame
    }

    fn frame_of(&mut self, globe: &PlanetView, orders: u32) -> Option<AuroraFrame> {
        let mut images = self.images(globe, orders);
        if images.frame.instances.is_empty() {
            self.reuse(images.frame);
            return None;
        }
        if let Some(pace) = self.old_pace.take() {
            self.offset += globe.time * (pace - self.config.pace);
        }
        let now = globe.time * self.config.pace;
        let ahead = if self.watched { self.go_on(globe.time, now, images.widest) } else { self.advance(now) };
        let midnight = self.midnight(globe.position, globe.attitude);
        self.draw_streaks(&mut images, globe, ahead);
        let frame = &mut images.frame;
        frame.settings.midnight = midnight.as_vec2().to_array();
        frame.ground = self.ground(midnight, ahead, images.widest);
        frame.rows = self.rows.clone();
        frame.falls = self.falls.table.clone();
        if frame.settings.streaks == 0 {
            self.reuse(images.frame);
            return None;
        }
        Some(images.frame)
    }

    /// The planet's images that show the aurora, with the colours of each.
    fn images(&mut self, globe: &PlanetView, orders: u32) -> Images {
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
        let mut frame = self.room.frame.take().unwrap_or_default();
        frame.settings = AuroraSettings::default();
        frame.instances.clear();
        frame.parts.clear();
        frame.behind.clear();
        frame.colours.clear();
        let mut images = Images { frame, departures: [(Order::ALL[0], 0.0); Order::ALL.len()], widest: 0.0 };
        let mut list = std::mem::take(&mut self.room.placed);
        for placed in place(&mut list, view, time, &object, orders) {
            let instance = placed.instance;
            let Some(order) = Order::new(instance.order as u8) else { continue };
            let position = DVec3::from_array(instance.position.map(f64::from));
            let began = time - f64::from(instance.delay);
            let extent = view.extent(position, object.reach, order, 0.0);
            // Light of higher orders comes round the hole: from there even a near planet is far away.
            let near = distance < 2.0 * object.reach && order.number() == 1;
            let width = if near { globe.pixels } else { extent.width };
            // It fades in and out.
            let part = (width / LEAST_PIXELS - 1.0).min(1.0);
            if part > 0.0 && sight::may_be_seen(view, [began, time], history, order, object.reach) {
                let whole = [0.0, 0.0, 1.0, 1.0];
                let seen_on = |aspect| if near { whole } else { extent.part_of_screen(view.camera, aspect) };
                images.widest = images.widest.max(width);
                let frame = &mut images.frame;
                images.departures[frame.instances.len()] = (order, began);
                frame.parts.push(view.aspect.map_or(whole, seen_on));
                let bends = view.settings.method.bends;
                frame.behind.push(self.disk.is_some_and(|disk| occlusion::is_behind(view.camera, position, order, bends, disk)));
                frame.colours.push(self.colours(globe, order, began, part));
                frame.instances.push(instance);
            }
        }
        let old = std::mem::take(&mut list.placed);
        list.reuse(old);
        self.room.placed = list;
        images
    }

    /// Whether there are curtains at both poles.
    fn both_poles(&self) -> bool {
        self.planet.aurora == AuroraShape::Oval
    }

    /// Towards magnetic midnight, away from the hole, in the axes of the dipole, for a planet at this place with these axes: as long as the
    /// oval is brighter there.
    fn midnight(&self, position: DVec3, attitude: DQuat) -> DVec2 {
        let away = (attitude.inverse() * position).normalize_or_zero().truncate();
        if self.both_poles() { MIDNIGHT * away } else { DVec2::ZERO }
    }

    /// Collisions of 35 eV in a curtain, in kR for each km that it is wide.
    fn collisions(&self) -> f64 {
        self.config.flux * self.planet.aurora_flux * KILO_COLLISIONS
    }

    /// Puts the curtains as they are now into a frame, but for midnight: their parts, and what shaders need to know of the streaks. The
    /// newest row is `ahead` (s).
    fn draw_streaks(&mut self, images: &mut Images, globe: &PlanetView, ahead: f64) {
        let Some(newest) = &self.newest else { return };
        let curtains = Curtains {
            config: &self.config,
            curves: &self.plan.curves,
            layout: &self.layout,
            places: &newest.places,
            both: self.both_poles(),
            ration: self.ration.part() * f64::from(globe.view.settings.streaks),
            collisions: self.collisions(),
        };
        let (weights, segments) = (&mut self.room.weights, &mut images.frame.segments);
        curtains.part(globe, weights, segments);
        let streaks = segments.last().map_or(0, |segment| segment.first_streak + segment.streaks);
        let mut flags = if self.config.walk == "linear" { LINEAR } else { 0 };
        if curtains.both {
            flags |= BOTH_POLES;
        }
        let bend = ChordInputs {
            view: globe.view,
            time: globe.time,
            history: globe.history,
            scale: globe.radius / PLANET_RADIUS,
            tops: self.falls.tops,
            heights: self.falls.ends.map(|ends| ends.map(f64::from)),
        };
        let middle = |segment: &Segment, wait: f64| self.rows.middle_of(segment, wait + ahead);
        let departures = &images.departures[..images.frame.instances.len()];
        let so_many = |count| Chords::new(count, globe.view, globe.position, self.planet.radius, departures);
        let kept = self.chords.and_then(|chords| chords.kept(&so_many(0), segments));
        let chords = kept.unwrap_or_else(|| bend.chords(segments, &newest.places, middle, departures, flags));
        // A picture that is made once does not depend on those before.
        if self.watched && kept.is_none() {
            self.chords = Some(so_many(chords));
        }
        let parts = curtains.parts(globe);
        let capacity = (streaks as usize * parts as usize).min(MOST_STROKES);
        let levels = curtains.levels(globe, segments, self.planet.radius * REACH);
        let clock = (globe.time * self.config.pace).rem_euclid(RAYS_PERIOD);
        let [[green_top, green_foot], [red_top, red_foot]] = self.falls.ends;
        images.frame.settings = AuroraSettings {
            streaks,
            chords,
            parts,
            row_nodes: newest.nodes.len() as u32,
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
    }

    /// Brings the curtains to the time `now` (s); returns by how much the newest row is ahead of it.
    fn advance(&mut self, now: f64) -> f64 {
        let warm_up = ROWS as f64 * ROW;
        let stale = self.motion.as_ref().is_none_or(|motion| !(motion.time() - warm_up..=motion.time() + warm_up).contains(&now));
        if stale {
            self.motion = Some(self.start((now - warm_up) / ROW));
        }
        let Some(mut motion) = self.motion.take() else { return 0.0 };
        while motion.time() < now {
            self.keep(MadeRow::after(&mut motion));
        }
        let ahead = motion.time() - now;
        self.motion = Some(motion);
        ahead
    }

    /// The same for a watched aurora, whose time is ahead of that at T = `time`, `now`. It begins at rest, with a past in which nothing
    /// changed (light that travelled along the curtains would take 128 rows in one frame); when it comes into sight again it goes on where
    /// it was, and where the clock runs away from it, it stays behind. `widest` is the width in pixels of the widest image of the planet.
    fn go_on(&mut self, time: f64, now: f64, widest: f64) -> f64 {
        let now = now + self.offset;
        if self.next.is_none() {
            let motion = self.start(now / ROW);
            self.begin(motion, time, now, widest);
        }
        for taken in 0..MOST_ROWS {
            let behind = now - self.newest_time();
            // After a while out of sight one row is as good as several.
            if behind <= 0.0 || (taken > 0 && behind > MOST_ROWS as f64 * ROW) {
                break;
            }
            if let Some(next) = self.next.take() {
                let (motion, row) = next.take();
                self.keep(row);
                self.begin(motion, time, now, widest);
            }
        }
        let ahead = self.newest_time() - now;
        if let Some(next) = &mut self.next {
            next.go_on(1.0 - ahead / ROW);
        }
        self.offset += missed(ahead);
        ahead - missed(ahead)
    }

    /// The curtains at rest at a time, in rows, with a past in which nothing changed.
    fn start(&mut self, row: f64) -> AuroraMotion {
        let motion = AuroraMotion::new(self.plan.clone(), row.floor() * ROW);
        let newest = MadeRow::of(&motion);
        self.layout = motion.layout().clone();
        self.rows = NodeHistory::still(newest.nodes.clone());
        self.newest = Some(newest);
        motion
    }

    /// Begins with the row after the newest. It is due at a later T than `time`, when it is `now`.
    fn begin(&mut self, mut motion: AuroraMotion, time: f64, now: f64, widest: f64) {
        motion.change(self.plan.field, self.plan.renewal, self.plan.contrast);
        let wanted = (widest > LIT_AHEAD * GROUND_PIXELS).then(|| self.wanted_maps(time, now)).flatten();
        self.next = Some(NextRow::begin(motion, wanted));
    }

    /// The maps of the light on the ground that the row after the newest brings.
    fn wanted_maps(&mut self, time: f64, now: f64) -> Option<WantedMaps> {
        let newest = self.newest.as_ref()?;
        let (before, ahead) = (newest.nodes.clone(), newest.time - now);
        let seconds = ahead - missed(ahead);
        let midnight = |seconds: f64| {
            // Where the aurora stands still, it is so for ever.
            let later = seconds / self.config.pace;
            let planet = self.planet.state(time + if later.is_finite() { later } else { 0.0 })?;
            Some(self.midnight(planet.position, planet.attitude * self.planet.dipole()))
        };
        let midnights = [midnight(seconds + ROW)?, midnight(seconds)?];
        Some(WantedMaps { before, midnights, old: self.maps.clone(), ground: self.ground_maker() })
    }

    fn newest_time(&self) -> f64 {
        self.newest.as_ref().map_or(0.0, |row| row.time)
    }

    /// A row becomes the newest.
    fn keep(&mut self, row: MadeRow) {
        self.rows.push(row.nodes.clone());
        if row.maps.is_some() {
            self.maps.clone_from(&row.maps);
        }
        self.newest = Some(row);
    }

    fn ground_maker(&mut self) -> Arc<Ground> {
        let make = || Arc::new(Ground::new(&self.plan.curves, &self.layout, self.falls.glow.clone()));
        self.ground.get_or_insert_with(make).clone()
    }

    /// Their light on the ground, faded by the width in pixels of the widest image of the planet.
    fn ground(&mut self, midnight: DVec2, ahead: f64, pixels: f64) -> Option<GroundFrame> {
        let part = (pixels / GROUND_PIXELS - 1.0).min(1.0);
        if part <= 0.0 {
            return None;
        }
        let ground = self.ground_maker();
        let rows = [self.rows.row(0)?, self.rows.row(1)?];
        let ahead = ahead / ROW;
        let old = self.maps.take();
        let maps = match &old {
            Some(maps) if maps.serve(rows, midnight, ahead.clamp(0.0, 1.0)) => maps.clone(),
            _ => ground.maps(rows, [midnight; 2], old.as_ref()),
        };
        // In the unit of the lines' colours at rest; what is lit is shifted like the surface.
        let unit = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1];
        let view = GroundView { ahead, kilo: self.collisions() * unit, dipole: self.planet.dipole(), both: self.both_poles() };
        Some(ground.frame(self.maps.insert(maps), &view))
    }

    /// The colours of the lines in an image of the planet, whose light left it at T = `began`, Doppler shifted and beamed as the settings
    /// say, times `part` of their brightness.
    fn colours(&self, globe: &PlanetView, order: Order, began: f64, part: f64) -> Colours {
        let view = globe.view;
        let even = || ImageShift::even(globe.frequency_ratio(order, began).unwrap_or(1.0).clamp(0.2, 5.0));
        let shift = ImageShift::new(view, [began, globe.time], globe.history, order, self.planet.radius).unwrap_or_else(even);
        // A kilorayleigh of green at rest has the luminance that game.toml gives it.
        let at_rest = part * self.config.brightness / kilorayleigh_xyz(1.0)[0][1];
        Colours::new(&shift, |g| {
            let [shift, beam] = [view.settings.doppler, view.settings.beaming].map(|on| if on { g.clamp(0.2, 5.0) } else { 1.0 });
            // Power goes as g⁴.
            let unit = at_rest * (beam / shift).powi(4);
            kilorayleigh_xyz(shift).map(|[x, y, z]| [(x * unit) as f32, (y * unit) as f32, (z * unit) as f32, 0.0])
        })
    }
}

/// What the clock has missed of the aurora's time where the newest row is `ahead`, both in s: it was hidden for a while, or the clock began
/// anew.
fn missed(ahead: f64) -> f64 {
    if (0.0..=2.0 * ROW).contains(&ahead) { 0.0 } else { ahead }
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
