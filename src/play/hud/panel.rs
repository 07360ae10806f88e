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
use crate::sim::pilot::aim::AimMarks;
use crate::sim::pilot::rollout::Point;
use crate::sim::seeing::{Phenomenon, Pointer, Scenery, SeenBody, Track, pointers};
use crate::sim::sight::{Apparition, apparition, direction, emission_time, frequency_ratio, true_direction};
use crate::sim::snapshot::FrameCamera;
use crate::sim::target::known;
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
    /// The next gate, in camera axes, and its number from 1.
    pub gate: Option<(glam::DVec3, usize)>,
    /// One's own course, that of the target, and the way of a bolt fired now, if there are bolts.
    pub lines: [AheadLine; 3],
    /// How near one comes to the target by falling on.
    pub pass: Option<Pass>,
    /// Motion against the target.
    pub guidance: Option<Guidance>,
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

impl Panel {
    /// Whether the sign to brake is shown: to who flies by hand, where no other warning comes before it.
    pub fn says_brake(&self, autopilot: bool, avoiding: bool) -> bool {
        let is_due = self.guidance.is_some_and(|guide| guide.brake == Brake::Now) && self.reach.is_some();
        is_due && !autopilot && !avoiding && self.instruments.is_some_and(|read| read.radius >= 1.0)
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
    windows: Query<&Window, With<PrimaryWindow>>,
    player: Res<PlayerState>,
    mut panel: ResMut<Panel>,
    (mut aimed, mut aimed_at): (Local<AimMarks>, Local<f64>),
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
    let resting = static_momentum(state.position).unwrap_or_default();
    let is_own = camera_is_own(&player, now.chase.as_deref().and_then(|chase| chase.outcome));
    let gate = now.mission.as_ref().zip(now.progress.as_ref()).and_then(|(mission, progress)| {
        let is_next = mission.0.goals.get(progress.goal).is_some_and(|goal| goal.task == GoalTask::Gates);
        let gate = mission.0.gates.get(progress.gates).filter(|_| is_next)?;
        Some((direction(&camera, gate.position, Order::ALL[0], 0.0)?, progress.gates + 1))
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
    let moving = -relative_momentum(state.momentum, resting);
    let to_camera = camera.attitude.conjugate();
    let known = target.filter(|_| is_own).and_then(|history| known(&state, time, history, marked_now));
    let reach = now.reach();
    let guidance = known.map(|known| guidance(&Point::from(&state), &known.point, engine.max_thrust, reach.unwrap_or(0.0)));
    // What was aimed at in another flight is no guide.
    if std::mem::replace(&mut *aimed_at, time) > time || known.is_none() {
        *aimed = AimMarks::default();
    }
    let aims = match gun.filter(|gun| gun.left > 0).zip(known) {
        Some((_, known)) => aimed.follow(&state, known.point).iter().map(|aim| (to_camera * aim.direction, aim.time)).collect(),
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
        nose: is_own.then(|| camera.attitude.conjugate() * (state.attitude * glam::DVec3::NEG_Z)),
        gate,
        lines,
        pass: known.and_then(|known| ahead::pass(&camera, &state, &known.point)),
        moving: guidance.filter(|guide| guide.velocity.length() > STILL).map(|guide| to_camera * guide.velocity.normalize()),
        fallen: known.filter(|known| known.age > 0.0).and_then(|known| true_direction(&camera, known.point.x)),
        guidance,
        reach,
        shot_passes: gun.zip(known).map(|(_, known)| ahead::shot_passes(&state, &known.point)),
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
