//! How hands fly that nobody has taught: keys held and let go, the mouse thrown about, reversals, sudden stops. It wins nothing; pictures
//! are judged by it, since pilots turn smoothly.

use bevy::prelude::*;
use glam::DVec3;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use crate::sim::assist::{Reference, Stick, assisted, direct};
use crate::sim::bolts::Trigger;
use crate::sim::clock::Clock;
use crate::sim::player_commands::{ManualControl, PlayerCommands};
use crate::sim::ship::{Controls, Ended, Engine, Fleet, Manual, ShipMotion};

/// Marks a ship that is flown so.
#[derive(Component, Debug)]
pub struct Jerky {
    chance: StdRng,
    /// T at which the hands do something else, in r_s/c.
    until: f64,
    gesture: Gesture,
    stick: Stick,
    assist: bool,
    fires: bool,
    /// The share of the pace at which the game goes on near danger.
    slowing: f64,
}

/// What hands do to the turn for a while.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gesture {
    /// The turn stays: a key, a stick, or nothing.
    Hold,
    /// It is another one in each step: the mouse.
    Shake,
}

/// Wall time of a gesture, in seconds: from a tap on a key to a long turn.
const SECONDS: std::ops::Range<f64> = 0.02..0.7;
/// The least share of the pace, as the game slows near danger.
const SLOWEST: f64 = 0.4;

impl Jerky {
    /// The same seed gives the same hands.
    pub fn from_seed(seed: u64) -> Jerky {
        let chance = StdRng::seed_from_u64(seed);
        Jerky { chance, until: 0.0, gesture: Gesture::Hold, stick: Stick::default(), assist: true, fires: false, slowing: 1.0 }
    }

    fn share(&mut self) -> f64 {
        self.chance.random_range(-1.0..=1.0)
    }

    /// Pitch, yaw and, more rarely, roll.
    fn any_turn(&mut self) -> DVec3 {
        let [pitch, yaw, roll, rolls] = [(); 4].map(|()| self.share());
        DVec3::new(pitch, yaw, if rolls > 0.5 { roll } else { 0.0 })
    }

    /// The hands do something else, at T = `time` and a pace of `pace` r_s/c a second.
    fn change(&mut self, time: f64, pace: f64) {
        self.until = time + self.chance.random_range(SECONDS) * pace;
        self.gesture = Gesture::Hold;
        match self.chance.random_range(0..6) {
            0 => self.stick.turn = DVec3::ZERO,
            1 => self.stick.turn = -self.stick.turn,
            // A key.
            2 => {
                let side = if self.share() < 0.0 { -1.0 } else { 1.0 };
                self.stick.turn = DVec3::AXES[self.chance.random_range(0..3)] * side;
            }
            // A stick pushed to its end, and hardly.
            3 => self.stick.turn = self.any_turn() * 4.0,
            4 => self.stick.turn = self.any_turn() * 0.1,
            _ => self.gesture = Gesture::Shake,
        }
        match self.chance.random_range(0..6) {
            0 => self.stick.thrust = DVec3::ZERO,
            1 => self.stick.thrust = DVec3::NEG_Z,
            2 => self.stick.thrust = DVec3::new(self.share(), self.share(), self.share()),
            _ => (),
        }
        if self.chance.random_range(0..10) == 0 {
            self.assist = !self.assist;
            self.slowing = self.chance.random_range(SLOWEST..=1.0);
        }
        self.fires = self.chance.random_range(0..4) == 0;
    }
}

type JerkyShip<'a> = (&'a mut Jerky, &'a mut Controls, &'a mut Engine, &'a ShipMotion, Option<&'a mut Trigger>);

/// Sets the controls of every ship flown so.
pub fn fly_by_jerks(
    (clock, fleet, commands): (Res<Clock>, Res<Fleet>, Res<PlayerCommands>),
    control: Option<Res<ManualControl>>,
    mut ships: Query<JerkyShip, (Without<Ended>, Without<Manual>)>,
) {
    for &entity in &fleet.0 {
        let Ok((mut jerky, mut controls, mut engine, motion, trigger)) = ships.get_mut(entity) else { continue };
        let pace = commands.pace * jerky.slowing;
        if clock.time >= jerky.until {
            jerky.change(clock.time, pace);
        }
        if jerky.gesture == Gesture::Shake {
            jerky.stick.turn = jerky.any_turn() * 2.0;
        }
        // As coarse as a player's.
        let stick = PlayerCommands::holding(&jerky.stick).stick();
        controls.0 = match &control {
            Some(control) => {
                engine.max_rate = control.turn_rate / pace;
                let help = assisted(&motion.0, &stick, &engine, Reference::Orbit, &control.assist).command;
                if jerky.assist { help } else { direct(&stick, &engine) }
            }
            None => direct(&stick, &engine),
        };
        if let Some(mut trigger) = trigger {
            trigger.pulled = jerky.fires;
        }
    }
}
