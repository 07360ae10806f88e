//! What the HUD and the menus show of the frame that is drawn.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use crate::play::camera::state_of;
use crate::play::hud::ahead::{self, AheadLine, Pass};
use crate::play::hud::instruments::Instruments;
use crate::play::menus::entries::{Menu, Page};
use crate::play::picture::CurrentShot;
use crate::play::picture::now::Now;
use crate::play::player_state::PlayerState;
use crate::scene::disk::Gas;
use crate::scene::mission::GoalTask;
use crate::sim::Outcome;
use crate::sim::guidance::{Brake, Guidance, guidance};
use crate::sim::intercept::{Advice, Way};
use crate::sim::known::{known, resting};
use crate::sim::pilot::aim::{AimMarks, shot_passes};
use crate::sim::pilot::rollout::Point;
use crate::sim::seeing::{Phenomenon, Pointer, Scenery, SeenBody, Track, pointers};
use crate::sim::ship::Player;
use crate::sim::sight::{Apparition, apparition, direction, emission_time, frequency_ratio, true_direction};
use crate::sim::snapshot::FrameCamera;
use crate::sim::target::Targets;
use crate::spacetime::Observer;
use crate::spacetime::frames::relative_momentum;
use crate::spacetime::light::Order;
use crate::spacetime::orbit::static_momentum;

/// What the HUD shows of this frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct Panel {
    /// The dials.
    pub instruments: Option<Instruments>,
    /// The target's images of orders 1 and 2.
    pub images: [Option<Apparition>; 2],
    /// Where the target is at the same T, in camera axes.
    pub truth: Option<glam::DVec3>,
    /// Where the hole is, in camera axes.
    pub hole: Option<glam::DVec3>,
    /// The player's own clock when the chase was decided, in r_s/c.
    pub decided: Option<f64>,
    /// Where one flies to, against the hovering observers, in camera axes.
    pub heading: Option<glam::DVec3>,
    /// The camera's horizontal field of view, in radians.
    pub field_of_view: f64,
    /// What the dials say of the target is what is seen of it.
    pub by_light: bool,
    /// Where the ship points, in camera axes.
    pub nose: Option<glam::DVec3>,
    /// The next gate.
    pub gate: Option<GateAhead>,
    /// One's own course, that of the target, and the way of a bolt fired now, if there are bolts.
    pub lines: [AheadLine; 3],
    /// How near one comes to the target by falling on.
    pub pass: Option<Pass>,
    /// Motion against the target.
    pub guidance: Option<Guidance>,
    /// What leads to the ship that one is after.
    pub advice: Option<Advice>,
    /// Where thrust leads to it, in camera axes, and how much of it, in c; None where one's fall does.
    pub thrust: Option<(glam::DVec3, f64)>,
    /// Where that motion leads, in camera axes; None while there is hardly any.
    pub moving: Option<glam::DVec3>,
    /// Where the target is if it has fallen freely since its light left it, in camera axes, where nobody tells.
    pub fallen: Option<glam::DVec3>,
    /// Within this of the target it is caught, in r_s; None where it is not to be caught.
    pub reach: Option<f64>,
    /// Where to point the nose for a hit: straight, and round the hole; with r_s/c until it.
    pub aims: Vec<(glam::DVec3, f64)>,
    /// How near a bolt fired now comes to the target as the dials show it, in r_s.
    pub shot_passes: Option<f64>,
    /// Bolts left, in a mission that has some.
    pub bolts: Option<u32>,
    /// What is on the screen, for the names of it, while they are shown.
    pub pointers: Vec<Pointer>,
}

/// The next gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GateAhead {
    /// Where it is seen, in camera axes; None where it is not.
    pub direction: Option<glam::DVec3>,
    /// Its number, from 1.
    pub number: usize,
    /// How far off its middle is, in r_s.
    pub distance: f64,
    /// Its ring's radius, in r_s.
    pub radius: f64,
}

impl Panel {
    /// Whether the sign to brake is shown: to who flies by hand, where no other warning comes before it.
    pub fn says_brake(&self, autopilot: bool, avoiding: bool) -> bool {
        let is_due = self.guidance.is_some_and(|guide| guide.brake == Brake::Now) && self.reach.is_some();
        is_due && !autopilot && !avoiding && self.instruments.is_some_and(|read| read.radius >= 1.0)
    }
}

/// How long numbers stand, in seconds of wall time.
const STAND: f64 = 0.1;

/// What takes long to find, and is found anew as often as numbers are said.
#[derive(Clone, Debug, Default)]
pub(in crate::play) struct Slow {
    /// When it is due, in seconds of wall time.
    until: f64,
    /// T of the frame before, in r_s/c.
    before: f64,
    /// The gate and the reach that it was found for.
    about: (Option<usize>, Option<f64>),
    shot_passes: Option<f64>,
}

impl Slow {
    /// Whether it is to be found in the frame at T = `time`, at `seconds` of wall time, for a gate or a reach.
    fn is_due(&mut self, time: f64, seconds: f64, about: (Option<usize>, Option<f64>)) -> bool {
        let is_same = self.before <= time && self.about == about;
        (self.before, self.about) = (time, about);
        let is_due = seconds >= self.until || !is_same;
        if is_due {
            self.until = seconds + STAND;
        }
        is_due
    }
}

/// What the numbers in words say: that of a moment ago, since nobody reads what changes in every frame, and its text need not be laid out
/// anew.
#[derive(Clone, Debug, Default)]
pub struct Said {
    panel: Panel,
    /// When the numbers change again, in seconds of wall time.
    until: f64,
}

impl Said {
    /// The numbers to be said in the frame of `panel`, at `seconds` of wall time.
    pub fn follow(&mut self, panel: &Panel, seconds: f64) -> &Panel {
        let time = |panel: &Panel| panel.instruments.map(|read| read.far_time);
        let about = |panel: &Panel| (panel.gate.map(|gate| gate.number), panel.reach, panel.bolts, panel.by_light, panel.pass.is_some());
        let goes_on = time(&self.panel).is_some() && time(&self.panel) <= time(panel) && about(&self.panel) == about(panel);
        if seconds >= self.until || !goes_on {
            *self = Said { panel: panel.clone(), until: seconds + STAND };
        }
        &self.panel
    }
}

/// Slower than this against the target, in c, motion has no direction.
const STILL: f64 = 0.01;

/// Whether the lines of what is to come are of use: in flight.
fn camera_is_own(player: &PlayerState, outcome: Option<(Outcome, f64)>) -> bool {
    !player.hud_off && outcome.is_none()
}

/// Reads the numbers of the frame that is drawn.
pub(in crate::play) fn read_panel(
    now: Now,
    (shot, menu): (Res<CurrentShot>, Res<Menu>),
    (targets, mut ways): (Targets, Query<(Entity, &mut Way), With<Player>>),
    windows: Query<&Window, With<PrimaryWindow>>,
    player: Res<PlayerState>,
    mut panel: ResMut<Panel>,
    (mut aimed, mut aimed_at, mut slow, real): (Local<AimMarks>, Local<f64>, Local<Slow>, Res<Time<Real>>),
) {
    let (Some(FrameCamera { camera, .. }), Some((history, engine, controls, fuel))) = (shot.0, now.own()) else { return };
    let time = now.time();
    let state = state_of(&history.at(time));
    let target = now.target().map(|(_, history)| history);
    let there = target.map(|history| state_of(&history.at(time)));
    let marked_now = now.mission.as_ref().is_none_or(|mission| mission.0.now_marker);
    // Where nobody says where the target is now, the dials go by its light.
    let shown = if marked_now {
        there
    } else {
        target.and_then(|history| Some(state_of(&history.at(emission_time(&camera, time, history, Order::ALL[0])?))))
    };
    let thrust = engine.thrust(controls.0.thrust).length();
    let hovering = static_momentum(state.position).unwrap_or_default();
    let is_own = camera_is_own(&player, now.chase.as_deref().and_then(|chase| chase.outcome));
    let gate = now.mission.as_ref().zip(now.progress.as_ref()).and_then(|(mission, progress)| {
        let is_next = mission.0.goals.get(progress.goal).is_some_and(|goal| goal.task == GoalTask::Gates);
        Some((mission.0.gates.get(progress.gates).filter(|_| is_next)?, progress.gates + 1))
    });
    let place = gate.and_then(|(gate, _)| resting(gate.position));
    let gate = gate.map(|(gate, number)| GateAhead {
        direction: direction(&camera, gate.position, Order::ALL[0], 0.0),
        number,
        distance: gate.position.distance(state.position),
        radius: gate.radius,
    });
    // One that never had a bolt is none.
    let gun = now.gun().filter(|gun| gun.left > 0 || gun.ready > 0.0);
    let lines = if is_own {
        let target_line = target.map(|history| ahead::target_course(&camera, time, history)).unwrap_or_default();
        [ahead::course(&camera, &state), target_line, gun.map(|_| ahead::shot(&camera, &state)).unwrap_or_default()]
    } else {
        Default::default()
    };
    let seeing = menu.page() == Some(Page::Seeing) && now.session.config.render.lensing;
    let aspect = windows.iter().next().map_or(16.0 / 9.0, |window| f64::from(window.width() / window.height().max(1.0)));
    let pointers = if seeing { pointed_at(&now, &camera, aspect, marked_now) } else { Vec::new() };
    let moving = -relative_momentum(state.momentum, hovering);
    let to_camera = camera.attitude.conjugate();
    let known = target.filter(|_| is_own).and_then(|history| known(&state, time, history, marked_now));
    // Seen from behind the ship a direction of its own is where it meets the target's distance, so that who points at the target has both
    // marks on each other.
    let range = place.or(known).map(|known| known.point.x.distance(state.position));
    let ahead = |direction: glam::DVec3| match range {
        Some(range) => true_direction(&camera, state.position + direction * range).unwrap_or(to_camera * direction),
        None => to_camera * direction,
    };
    let reach = now.reach();
    let advice = known
        .zip(ways.single_mut().ok())
        .and_then(|(known, (ship, mut way))| targets.advice((ship, &mut way), &state, &known, time, engine.max_thrust));
    if slow.is_due(time, real.elapsed_secs_f64(), (gate.map(|gate| gate.number), reach)) {
        slow.shot_passes = gun.zip(known).map(|(_, known)| shot_passes(&state, &known.point));
    }
    let guidance = known.map(|known| guidance(&Point::from(&state), &known.point, engine.max_thrust, reach.unwrap_or(0.0)));
    // What was aimed at in another flight is no guide.
    if std::mem::replace(&mut *aimed_at, time) > time || known.is_none() {
        *aimed = AimMarks::default();
    }
    let aims = match gun.filter(|gun| gun.left > 0).zip(known) {
        Some((_, known)) => aimed.follow(&state, known.point).iter().map(|aim| (ahead(aim.direction), aim.time)).collect(),
        None => Vec::new(),
    };
    *panel = Panel {
        instruments: Some(Instruments::read(&state, time, camera.radius(), thrust, (fuel.left, fuel.capacity), shown.as_ref())),
        images: [0, 1].map(|order| {
            // Where the picture leaves out what light does, its images are elsewhere.
            let render = &now.session.config.render;
            let is_drawn = render.lensing && render.light_delay && order < render.orders as usize;
            target.filter(|_| is_drawn).and_then(|history| apparition(&camera, time, history, Order::ALL[order]))
        }),
        truth: there.filter(|_| marked_now).and_then(|there| true_direction(&camera, there.position)),
        hole: camera.position.try_normalize().map(|out| camera.seen_direction(-out)),
        decided: now.chase.as_ref().and_then(|chase| chase.outcome).map(|(_, decided)| history.at(decided).proper_time),
        heading: (moving.length() > 0.01).then(|| camera.attitude.conjugate() * moving.normalize()),
        field_of_view: now.session.config.video.fov.to_radians(),
        by_light: !marked_now,
        nose: is_own.then(|| ahead(state.attitude * glam::DVec3::NEG_Z)),
        gate,
        lines,
        pass: place.filter(|_| is_own).or(known).and_then(|known| ahead::pass(&camera, &state, &known)),
        advice,
        thrust: advice.and_then(Advice::thrust).map(|advice| (ahead(advice.push.normalize()), advice.push.length())),
        moving: guidance.filter(|guide| guide.velocity.length() > STILL).map(|guide| ahead(guide.velocity.normalize())),
        fallen: known.filter(|known| known.age > 0.0).and_then(|known| true_direction(&camera, known.point.x)),
        guidance,
        reach,
        shot_passes: slow.shot_passes,
        aims,
        bolts: gun.map(|gun| gun.left),
        pointers,
    };
    let light = target.and_then(|history| {
        let emitted = emission_time(&camera, time, history, Order::ALL[0])?;
        frequency_ratio(&camera, &history.at(emitted), Order::ALL[0], time - emitted)
    });
    if let Some(bearing) = panel.instruments.as_mut().and_then(|read| read.target.as_mut()) {
        bearing.shift = light;
    }
}

/// What of the physics is on the screen of `camera`, whose width is `aspect` times its height. `marked_now`: where the target is now is told.
fn pointed_at(now: &Now, camera: &Observer, aspect: f64, marked_now: bool) -> Vec<Pointer> {
    let session = &now.session;
    let config = session.effective();
    let gas = session.scene.disk(&config).map(|disk| Gas::new(&disk, config.hole.mass_solar));
    // A ship is seen as a ball of half its length.
    let ball = |(ship, history)| SeenBody { track: Track::Ship(history), radius: 0.5 * session.length(ship) };
    let target = now.target().map(ball);
    let own = now.own().map(|(history, ..)| ball((session.player(), history)));
    let others: Vec<SeenBody> = own
        .into_iter()
        .chain(session.scene.planet.iter().map(|planet| SeenBody { track: Track::Planet(planet), radius: planet.radius }))
        .collect();
    let mut found = pointers(camera, now.time(), &Scenery { disk: gas.as_ref(), target, others: &others }, aspect);
    // What is switched off is not there to be named.
    let render = &config.render;
    found.retain(|pointer| match pointer.sight {
        Phenomenon::BlueSide | Phenomenon::RedSide => render.doppler,
        Phenomenon::TrueTarget => render.light_delay && marked_now,
        Phenomenon::TargetImage => render.light_delay,
        Phenomenon::SecondImage | Phenomenon::EinsteinRing => render.light_delay && render.orders > 1,
        Phenomenon::DiskUnderside | Phenomenon::PhotonRing => render.orders > 1,
        Phenomenon::Shadow | Phenomenon::DiskFarSide | Phenomenon::Aberration => true,
    });
    found
}
