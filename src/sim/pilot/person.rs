//! How a person flies: by what the screen shows, with a person's limits. It decides twice in a r_s/c at most, acts on what it saw half of
//! one before, and its hand is a tenth off. It shows whether a mission can be won by hand, and by which signs.

use bevy::prelude::*;
use glam::DVec3;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use super::aim;
use super::rollout::{PlannedBurn, Point, coast};
use super::steer::turn_nose;
use crate::scene::pilot_kind::PilotKind;
use crate::sim::ChaseRules;
use crate::sim::assist::{AssistMode, Stick};
use crate::sim::bolts::{Gun, Trigger, nearest};
use crate::sim::clock::Clock;
use crate::sim::guidance::{Brake, approach, guidance};
use crate::sim::intercept::{Advice, Intercept, MEETS, NEAR, ON_MARK, Way};
use crate::sim::known::Known;
use crate::sim::player_commands::{ManualControl, PlayerCommands};
use crate::sim::ship::{Controls, Ended, Engine, Fleet, Manual, Pilot, PilotOrder, ShipMotion};
use crate::sim::target::Targets;
use crate::spacetime::matter::ShipState;

/// From what is seen to what the hand does, in r_s/c: a third of a second at the usual pace.
const REACTION: f64 = 0.5;
/// How far the game is slowed for aiming.
const SLOWED: f64 = 0.25;
/// The last bolts are fired at what they reach within this time, in r_s/c; of so many.
const SHORT_SHOT: f64 = 9.0;
/// See [`SHORT_SHOT`].
const KEPT_BOLTS: u32 = 6;
/// The share of full thrust that a key gives without another: `play::input::CRUISE`.
const CRUISE: f64 = 0.6;
/// The hand is off by this share of what it does.
const NOISE: f64 = 0.1;

/// Who passes farther off than this, in r_s, flies to the target itself.
const CORRECTED: f64 = 3.0;
/// A key is tapped for at least this share of full thrust.
const GENTLE: f64 = 0.2;
/// A way that comes nearer to the hole than this, in r_s, is flown round it, outward and along the motion.
const CLEAR: f64 = 4.0;
/// See [`CLEAR`]: outward, along the motion, along the orbit's axis.
const UP: DVec3 = DVec3::new(0.3, 1.0, 0.0);
/// Who closes faster than this, in c, saves fuel.
const FAST: f64 = 0.3;
/// On a radius within this, in r_s.
const ON_RADIUS: f64 = 0.15;
/// How far the line of the course goes, in r_s/c.
const COURSE: usize = 24;
/// A course below this radius, in r_s, ends at the hole.
const LOW: f64 = 2.4;

/// Marks a ship that is flown so.
#[derive(Component, Debug)]
pub struct Person {
    chance: StdRng,
    skill: PersonSkill,
    /// T of the next decision, in r_s/c.
    next: f64,
    /// What was decided, and T from which the hand does it.
    decided: Option<(f64, Action)>,
    /// What the hand does, and T since when.
    acting: (f64, Action),
    /// The mark that is aimed at, when it was looked at last.
    mark: Option<(f64, DVec3)>,
}

/// How a person plays.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PersonSkill {
    /// Does as the signs say: brakes, matches, aims.
    heeds: bool,
    /// Has played before.
    practised: bool,
}

/// What the hand does until the next decision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Action {
    /// Where the nose is turned to, on rest-frame axes; None: it is left.
    nose: Option<DVec3>,
    /// How that moves, in 1/(r_s/c): the hand goes with it.
    sweep: DVec3,
    /// On body axes, each in [−1, 1].
    thrust: DVec3,
    assist: AssistMode,
    matching: bool,
    fires: bool,
}

impl Person {
    /// One of the kinds that are persons; the same seed gives the same hand.
    pub fn new(kind: PilotKind, seed: u64) -> Person {
        let skill = PersonSkill { heeds: kind != PilotKind::Ignoring, practised: kind == PilotKind::Practised };
        Person { chance: StdRng::seed_from_u64(seed), skill, next: 0.0, decided: None, acting: (0.0, Action::default()), mark: None }
    }

    /// T between two decisions, in r_s/c.
    fn pause(&mut self) -> f64 {
        let range = if self.skill.practised { 0.5..0.75 } else { 0.5..1.0 };
        self.chance.random_range(range)
    }

    /// A number that is a tenth off.
    fn about(&mut self, value: f64) -> f64 {
        value * (1.0 + self.chance.random_range(-NOISE..=NOISE))
    }

    /// A direction that is a tenth of the turn to it off; both on body axes.
    fn towards(&mut self, ahead: DVec3) -> DVec3 {
        let off = NOISE * ahead.angle_between(DVec3::NEG_Z);
        let side = DVec3::new(self.chance.random_range(-1.0..=1.0), self.chance.random_range(-1.0..=1.0), 0.0);
        (ahead + side * off).try_normalize().unwrap_or(ahead)
    }
}

/// What a person sees.
struct View<'a> {
    state: &'a ShipState,
    order: PilotOrder,
    engine: &'a Engine,
    target: Option<Known>,
    /// Where the target's first image is, on body axes.
    image: Option<DVec3>,
    /// Within this of the target it is caught, in r_s.
    reach: f64,
    /// What the mark "thrust" says.
    advice: Option<Advice>,
    bolts: u32,
}

impl View<'_> {
    /// Forward, if the nose points that way; before, a person only turns.
    fn ahead(&self, way: DVec3) -> DVec3 {
        let on_mark = (self.state.attitude * DVec3::NEG_Z).angle_between(way) < ON_MARK;
        if on_mark { DVec3::NEG_Z } else { DVec3::ZERO }
    }
}

/// Whether the line of the course ends at the hole.
fn falls(own: &Point) -> bool {
    let mut point = *own;
    (0..COURSE).any(|_| {
        point = coast(&point, 1.0);
        point.x.length_squared() < LOW * LOW
    })
}

type PersonShip<'a> = (
    (&'a Pilot, &'a mut Person, &'a mut Way),
    (&'a mut Controls, &'a mut Engine),
    &'a ShipMotion,
    (Option<&'a Gun>, Option<&'a mut Trigger>),
);

/// Sets the controls of every ship flown so.
pub fn fly_as_person(
    (clock, fleet, commands, rules): (Res<Clock>, Res<Fleet>, Res<PlayerCommands>, Res<ChaseRules>),
    control: Option<Res<ManualControl>>,
    targets: Targets,
    mut ships: Query<PersonShip, (Without<Ended>, Without<Manual>)>,
) {
    let Some(control) = control else { return };
    for &entity in &fleet.0 {
        let Ok(((pilot, mut person, mut way), (mut controls, mut engine), motion, (gun, trigger))) = ships.get_mut(entity) else {
            continue;
        };
        engine.max_rate = control.turn_rate / commands.pace;
        let state = &motion.0;
        // A solution of the light's way where nobody tells: only when it is asked for.
        let known = || targets.known(entity, state, clock.time);
        // Aiming is fine work: the game is slowed for it.
        let slowed = if matches!(pilot.order, PilotOrder::Hit(_)) && person.skill.heeds { SLOWED } else { 1.0 };
        if clock.time >= person.next {
            let bolts = gun.map_or(0, |gun| gun.left);
            let image = targets.image(entity, state, clock.time);
            let reach = targets.reach(entity).unwrap_or(rules.0.capture_radius);
            let (order, target) = (pilot.order, known());
            let meets = target.filter(|_| matches!(order, PilotOrder::Catch(_)) && person.skill.heeds);
            let advice = meets.and_then(|known| targets.advice((entity, &mut way), state, &known, clock.time, engine.max_thrust));
            let view = View { state, order, engine: &engine, target, image, reach, advice, bolts };
            let action = person.decide(&view, clock.time);
            person.decided = Some((clock.time + slowed * REACTION, action));
            person.next = clock.time + slowed * person.pause();
        }
        if let Some(next) = person.decided.take_if(|(since, _)| clock.time >= *since) {
            person.acting = next;
        }
        let (since, Action { nose, sweep, thrust, assist, matching, fires }) = person.acting;
        let nose = nose.and_then(|nose| (nose + sweep * (clock.time - since)).try_normalize());
        let ahead = nose.map(|nose| state.attitude.conjugate() * nose);
        let full = engine.fastest_turn().max(1e-9);
        // A mark that moves is followed at its own speed.
        let along = state.attitude.conjugate() * sweep;
        let turn = ahead.map_or(DVec3::ZERO, |ahead| (turn_nose(ahead, full) + ahead.cross(along)) / full);
        // As coarse as a player's.
        let held = PlayerCommands { assist, matching, ..PlayerCommands::holding(&Stick { thrust, turn }) };
        let velocity = held.needs_target().then(known).flatten().map(|known| known.point.velocity());
        controls.0 = held.command(state, &engine, velocity, &control.assist).command;
        if let Some(mut trigger) = trigger {
            trigger.pulled = fires;
        }
    }
}

impl Person {
    /// What to do about what is seen.
    fn decide(&mut self, view: &View, time: f64) -> Action {
        let action = match (view.order, view.target) {
            (PilotOrder::Catch(_), Some(target)) => self.meet(view, &target),
            (PilotOrder::Pass(_), Some(target)) => self.pass(view, &target),
            (PilotOrder::Hit(_), Some(target)) => self.shoot(view, &target, time),
            (PilotOrder::Escape(_), Some(target)) => self.flee(view, &target),
            (PilotOrder::Face(_), _) => Action { nose: view.image.map(|image| view.state.attitude * image), ..Action::default() },
            (PilotOrder::Turn, _) => Action { nose: Some(view.state.attitude * DVec3::X), ..Action::default() },
            (PilotOrder::Keep(radius), _) => self.keep(view, radius),
            _ => Action::default(),
        };
        let nose = action.nose.and_then(DVec3::try_normalize).map(|nose| {
            let ahead = view.state.attitude.conjugate() * nose;
            view.state.attitude * self.towards(ahead)
        });
        // Who reads nothing does not know of full thrust.
        let strength = if self.skill.heeds { 1.0 } else { CRUISE };
        let thrust = (action.thrust * self.about(strength)).clamp(DVec3::NEG_ONE, DVec3::ONE);
        Action { nose, thrust, ..action }
    }

    /// To the target: by the mark "thrust" where there is one, at the brake sign with the key that matches its motion.
    fn meet(&mut self, view: &View, target: &Known) -> Action {
        if !self.skill.heeds {
            return self.pass(view, target);
        }
        let own = Point::from(view.state);
        let guide = guidance(&own, &target.point, view.engine.max_thrust, view.reach);
        let (nose, assist) = (Some(guide.apart), AssistMode::Target);
        if guide.brake == Brake::Now || guide.apart.length() < view.reach {
            return Action { nose, assist, matching: true, ..Action::default() };
        }
        match view.advice {
            Some(Advice::Coast) => return Action { nose, ..Action::default() },
            Some(advice @ Advice::Thrust(Intercept { push, .. })) => {
                // As much as is missing until the next decision.
                let strength = (push.length() / (view.engine.max_thrust * REACTION)).clamp(GENTLE, 1.0);
                let assist = advice.assist(own.x.length(), view.state.attitude.conjugate() * push);
                // Near the hole the mark goes round with the ship, and the hand with the mark.
                let way = push.normalize();
                let sweep =
                    if assist == AssistMode::Orbit { own.x.cross(own.velocity()).cross(way) / own.x.length_squared() } else { DVec3::ZERO };
                let (nose, thrust) = (Some(way + sweep * REACTION), view.ahead(way) * strength);
                return Action { nose, sweep, thrust, assist, ..Action::default() };
            }
            Some(Advice::Wait) | None => (),
        }
        match guide.brake {
            _ if guide.apart.length() > NEAR => self.pass(view, target),
            Brake::Free if guide.closing() < FAST => Action { nose, thrust: view.ahead(guide.apart), assist, ..Action::default() },
            _ => Action { nose, assist, ..Action::default() },
        }
    }

    /// By the small rings where both pass nearest: thrust from the own one to the other. Where they are far apart, or the course ends at
    /// the hole, nose to the target with the assist on the orbit.
    fn pass(&mut self, view: &View, target: &Known) -> Action {
        let own = Point::from(view.state);
        let apart = target.point.x - own.x;
        let closing = guidance(&own, &target.point, view.engine.max_thrust, view.reach).closing();
        let near = approach(&own, target).filter(|near| self.skill.heeds && near.distance < CORRECTED && !falls(&own));
        match near {
            Some(near) if near.distance < MEETS * view.reach => {
                // To a gate one need not come slowly.
                let thrust = if target.rests && closing < FAST { view.ahead(apart) } else { DVec3::ZERO };
                Action { nose: Some(apart), thrust, ..Action::default() }
            }
            Some(near) => {
                let way = near.places[1] - near.places[0];
                Action { nose: Some(way), thrust: view.ahead(way), ..Action::default() }
            }
            None => {
                let is_behind = own.x.length() < target.point.x.length() && nearest(own.x, target.point.x) < CLEAR;
                let (way, assist) = match (self.skill.heeds && is_behind, falls(&own)) {
                    (true, true) => (own.from_local(UP), AssistMode::Orbit),
                    (true, false) => (own.from_local(UP), AssistMode::Off),
                    (false, _) => (apart, AssistMode::Orbit),
                };
                let thrust = if self.skill.heeds && closing > FAST { DVec3::ZERO } else { view.ahead(way) };
                Action { nose: Some(way), thrust, assist, ..Action::default() }
            }
        }
    }

    /// Nose to the mark of the nearest hit; fires when it is there.
    fn shoot(&mut self, view: &View, target: &Known, time: f64) -> Action {
        let state = view.state;
        if !self.skill.heeds {
            let straight = target.point.x - state.position;
            return Action { nose: Some(straight), assist: AssistMode::Orbit, fires: true, ..Action::default() };
        }
        let aim = aim::lead(state, &target.point, &PlannedBurn::COAST);
        // The last bolts are kept for what has no time to turn away.
        let Some(aim::Aim { direction: aimed, tolerance, .. }) = aim.filter(|aim| aim.time < SHORT_SHOT || view.bolts > KEPT_BOLTS) else {
            return self.pass(view, target);
        };
        // A mark that jumps is another one.
        let before = self.mark.replace((time, aimed)).filter(|(_, before)| before.angle_between(aimed) < ON_MARK);
        let sweep = before.map_or(DVec3::ZERO, |(then, before)| (aimed - before) / (time - then).max(1e-3));
        let fires = (state.attitude * DVec3::NEG_Z).angle_between(aimed) < tolerance;
        Action { nose: Some(aimed + sweep * SLOWED * REACTION), sweep, fires, ..Action::default() }
    }

    /// Along the own motion, the faster away.
    fn flee(&mut self, view: &View, target: &Known) -> Action {
        let state = view.state;
        let outward = state.position.normalize();
        let away = (state.position - target.point.x).reject_from(outward);
        let along = Point::from(state).velocity().reject_from(outward);
        let nose = if self.skill.heeds && state.position.length() > 12.0 { along - outward * along.length() } else { away + along };
        Action { nose: Some(nose), thrust: DVec3::NEG_Z, assist: AssistMode::Orbit, ..Action::default() }
    }

    /// Outward or inward where it is off; the assist makes a circle of the rest.
    fn keep(&mut self, view: &View, radius: f64) -> Action {
        let r = view.state.position.length();
        let outward = view.state.position / r;
        let nose = if r < radius { outward } else { -outward };
        let is_off = (r - radius).abs() > if self.skill.heeds { ON_RADIUS } else { 0.0 };
        let thrust = if is_off { view.ahead(nose) } else { DVec3::ZERO };
        Action { nose: Some(nose), thrust, assist: AssistMode::Orbit, ..Action::default() }
    }
}
