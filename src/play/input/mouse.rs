//! Turns by the mouse: the camera is led at once, the ship follows as fast as a body turns.

use bevy::prelude::*;
use glam::{DQuat, DVec2, DVec3};

use crate::scene::GameConfig;
use crate::sim::{Engine, PlayerCommands};

/// Turns asked for by the mouse: pitch (up) and yaw (left), in radians.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct MouseTurn {
    /// Not flown yet.
    pub waiting: DVec2,
    /// Flown in the last step.
    flown: DVec2,
    /// Body rates that the keys alone would have turned the ship with, while the mouse turns it too (rad per proper r_s/c).
    by_keys: Option<DVec3>,
    /// The mouse's share of the stick (pitch, yaw), and for how many steps it stays.
    held: DVec2,
    left: u32,
    /// Asked for since the camera was led last.
    fresh: DVec2,
}

/// A turn by the mouse is held for so long, in seconds of wall time, and is one of so many, in steps of the stick: a replay keeps each other
/// turn, and two minutes by a busy hand are to go into a link. The nose comes 70 ms later for it; the camera does not.
const HELD: f64 = 1.0 / 12.0;
/// See [`HELD`]; each 1.7 times the one before.
const LEVELS: [f64; 10] = [1.0, 2.0, 3.0, 5.0, 9.0, 15.0, 26.0, 44.0, 75.0, 127.0];

/// A turn that waits is at most this large, in radians, so that the ship stops soon after the hand.
const MOST_WAITING: f64 = 0.5;

impl MouseTurn {
    /// The mouse moved by `pixels` (right, down).
    pub fn push(&mut self, pixels: Vec2, config: &GameConfig) {
        let controls = &config.controls;
        let pitch = if controls.invert_y { f64::from(pixels.y) } else { -f64::from(pixels.y) };
        let yaw = if controls.invert_x { f64::from(pixels.x) } else { -f64::from(pixels.x) };
        let turn = DVec2::new(pitch, yaw) * controls.mouse_sensitivity;
        let waiting = (self.waiting + turn).clamp_length_max(MOST_WAITING);
        self.fresh += waiting - self.waiting;
        self.waiting = waiting;
    }

    /// All of the turn, for what follows the hand at once.
    pub fn take(&mut self) -> DVec2 {
        std::mem::take(self).waiting
    }

    /// How far the ship has still to turn, about its own axes, `share` of the way through the last step: the camera is there already.
    pub fn lead(&self, share: f64) -> DQuat {
        DQuat::from_scaled_axis((self.waiting + self.flown * (1.0 - share)).extend(0.0))
    }

    /// What was asked for since the last call, as a turn about the camera's axes.
    pub fn led(&mut self) -> DQuat {
        DQuat::from_scaled_axis(std::mem::take(&mut self.fresh).extend(0.0))
    }

    /// The turn of the stick (pitch, yaw, roll, each in [−1, 1]) for the coming step: that of the `keys`, and as much of what waits as the
    /// ship can turn and stop again in time. `turning` are its body rates (rad per proper r_s/c); the step takes `span` of proper time and
    /// `seconds` of wall time.
    pub fn pull(&mut self, keys: DVec3, engine: &Engine, turning: DVec3, span: f64, seconds: f64) -> DVec3 {
        self.flown = DVec2::ZERO;
        let most = engine.fastest_turn();
        let by_mouse = (turning - self.by_keys.unwrap_or(turning)).truncate();
        if self.left == 0 {
            let steps = (HELD / seconds).round().max(1.0);
            // What would need less than the least turn is none.
            let least = LEVELS[0] / PlayerCommands::FULL * most * span * steps;
            if span <= 0.0 || self.waiting.abs().max_element() < least && by_mouse.length() < engine.turn_acceleration() * span {
                (self.waiting, self.by_keys, self.held) = (DVec2::ZERO, None, DVec2::ZERO);
                return keys;
            }
            // Of both axes together the ship gains no more than of one.
            let gain = engine.turn_acceleration() * span / std::f64::consts::SQRT_2;
            let rate = |axis: usize| eased(self.waiting[axis] / span, by_mouse[axis], gain, steps);
            self.held = DVec2::new(rate(0), rate(1)).map(|rate| level(rate / most));
            self.left = if self.held == DVec2::ZERO { 1 } else { steps as u32 };
        }
        self.left -= 1;
        let stick = (keys + self.held.extend(0.0)).clamp(DVec3::NEG_ONE, DVec3::ONE);
        // In the steps that commands are kept in.
        let stick = (stick * PlayerCommands::FULL).round() / PlayerCommands::FULL;
        let by_keys = engine.turn(keys * most, self.by_keys.unwrap_or(turning), span);
        let by_mouse = (engine.turn(stick * most, turning, span) - by_keys).truncate() * span;
        // Where keys and mouse ask for more than a body turns, the mouse takes from the keys, and owes them nothing.
        let owed = [self.waiting.min(DVec2::ZERO), self.waiting.max(DVec2::ZERO)];
        self.flown = if keys == DVec3::ZERO { by_mouse } else { by_mouse.clamp(owed[0], owed[1]) };
        (self.waiting, self.by_keys) = (self.waiting - self.flown, Some(by_keys));
        stick
    }
}

/// The rate (rad per r_s/c) at which to turn for `steps` steps, so that the ship can stop in time after it. It has still to turn by `waiting`
/// (rad per r_s/c, for one step), turns at the rate `now`, and changes that by at most `gain` in a step.
fn eased(waiting: f64, now: f64, gain: f64, steps: f64) -> f64 {
    let (way, now) = (waiting.signum(), now * waiting.signum());
    // Stopped at once it turns on by (ω − a) + (ω − 2a) + … = ω²/2a − ω/2.
    let coast = 0.5 * now * (now.abs() / gain - 1.0).max(0.0);
    let (beyond, now) = (waiting.abs() - coast, now.max(0.0));
    let rate = if beyond > steps * now { (beyond + now * now / gain) / (steps + now / gain) } else { beyond / steps };
    way * rate.max(0.0)
}

/// The greatest of the [`LEVELS`] that is not beyond `share` of the fastest turn, as such a share.
fn level(share: f64) -> f64 {
    let asked = share.abs() * PlayerCommands::FULL;
    let level = LEVELS.into_iter().rev().find(|&level| level <= asked).unwrap_or(0.0);
    level.copysign(share) / PlayerCommands::FULL
}

#[cfg(test)]
mod tests {
    use super::*;

    /// T of a step, in r_s/c.
    const STEP: f64 = 1.0 / 32.0;

    fn engine(pace: f64) -> Engine {
        Engine { max_thrust: 0.06, max_rate: 1.2 / pace, reach: 0.145 }
    }

    /// Flies what waits until it stops; the turn so far after each step, in radians.
    fn flown(turn: &mut MouseTurn, pace: f64, steps: usize) -> Vec<DVec2> {
        let (engine, mut turning, mut sum) = (engine(pace), DVec3::ZERO, DVec2::ZERO);
        let step = |_| {
            let stick = turn.pull(DVec3::ZERO, &engine, turning, STEP, STEP / pace);
            turning = engine.turn(stick * engine.fastest_turn(), turning, STEP);
            sum += turning.truncate() * STEP;
            sum
        };
        (0..steps).map(step).collect()
    }

    #[test]
    fn the_ship_turns_as_far_as_the_mouse_went_and_no_farther() {
        let mut config = GameConfig::default();
        for pace in [0.05, 0.375, 1.5, 3.0] {
            let mut turn = MouseTurn::default();
            turn.push(Vec2::new(50.0, -20.0), &config);
            // Right is a yaw to the right, forward (up the screen) a pitch up; 0.002 rad a pixel.
            let asked = DVec2::new(0.04, -0.1);
            assert!((turn.waiting - asked).length() < 1e-12);
            let way = flown(&mut turn, pace, 64);
            // Half a pixel of the mouse.
            assert!((way[63] - asked).length() < 1e-3, "{pace}: {}", way[63]);
            assert!(way.iter().all(|turn| turn.dot(asked) <= asked.length_squared() * 1.02), "{pace}: it swings over");
            assert_eq!(turn.waiting, DVec2::ZERO);
        }
        let mut other = MouseTurn::default();
        (config.controls.invert_x, config.controls.invert_y) = (true, true);
        other.push(Vec2::new(50.0, -20.0), &config);
        assert!((other.waiting + DVec2::new(0.04, -0.1)).length() < 1e-12);
        assert_eq!(other.pull(DVec3::Z, &engine(1.5), DVec3::ZERO, 0.0, 1.0), DVec3::Z);
    }

    /// Keys held together ask for more than a body turns; after them the ship turns on by no more than the mouse asked for.
    #[test]
    fn the_mouse_owes_nothing_to_the_keys() {
        for (pace, keys) in [(1.5, DVec3::new(1.0, 1.0, 0.0)), (1.5, DVec3::new(0.0, 1.0, 1.0)), (0.375, DVec3::Y), (0.375, DVec3::NEG_X)] {
            let after = |pixels: f32| {
                let (engine, mut turning, mut sum) = (engine(pace), DVec3::ZERO, DVec2::ZERO);
                let mut turn = MouseTurn::default();
                turn.push(Vec2::new(pixels, 0.0), &GameConfig::default());
                for k in 0..300 {
                    let stick = turn.pull(if k < 100 { keys } else { DVec3::ZERO }, &engine, turning, STEP, STEP / pace);
                    turning = engine.turn(stick * engine.fastest_turn(), turning, STEP);
                    sum += turning.truncate() * STEP;
                }
                sum
            };
            // 25 pixels are a twentieth of a radian; meanwhile the keys may turn the ship more slowly.
            let more = (after(25.0) - after(0.0)).length();
            assert!(more < 0.07, "{pace} {keys}: {more}");
        }
    }

    /// The camera is where the mouse went, whatever of it has been flown.
    #[test]
    fn the_camera_is_led_at_once() {
        let config = GameConfig::default();
        let mut turn = MouseTurn::default();
        let (mut seen, mut ship) = (DQuat::IDENTITY, DVec2::ZERO);
        for k in 0..40 {
            turn.push(Vec2::new(if k < 20 { 8.0 } else { 0.0 }, 0.0), &config);
            seen *= turn.led();
            let yaw = -0.002 * 8.0 * f64::from((k + 1).min(20));
            assert!(seen.angle_between(DQuat::from_rotation_y(yaw)) < 1e-6, "{k}");
            ship += flown(&mut turn, 1.5, 1)[0];
            // Through the whole step, what the ship turns is what the lead loses.
            let [before, after] = [0.0, 1.0].map(|share| turn.lead(share));
            assert!((after * DQuat::from_scaled_axis(turn.flown.extend(0.0))).angle_between(before) < 1e-6, "{k}");
        }
        assert!(ship.y < -0.1, "{ship}");
    }

    /// By how much the nose comes after the hand, the mean over a flick of 0.2 rad in a tenth of a second, in milliseconds of wall time.
    #[test]
    fn the_nose_lags_behind_the_hand() {
        let config = GameConfig::default();
        for (pace, allowed) in [(3.0, 160.0), (1.5, 160.0), (0.75, 300.0), (0.375, 500.0), (0.09375, 2_000.0)] {
            let (engine, mut turning, mut sum) = (engine(pace), DVec3::ZERO, 0.0);
            let (mut turn, mut asked, mut behind, mut free) = (MouseTurn::default(), 0.0, 0.0, (0.0, 0.0));
            let seconds = STEP / pace;
            for k in 0..2_000 {
                let time = f64::from(k) * seconds;
                let hand = 0.2 * ((time + seconds) / 0.1).min(1.0);
                turn.push(Vec2::new(-((hand - asked) / 0.002) as f32, 0.0), &config);
                asked = hand;
                let stick = turn.pull(DVec3::ZERO, &engine, turning, STEP, STEP / pace);
                turning = engine.turn(stick * engine.fastest_turn(), turning, STEP);
                sum += turning.y * STEP;
                // What is given up in the end is not waited for.
                behind += if turn.waiting == DVec2::ZERO { 0.0 } else { (hand - sum) * seconds };
                // Without bounds: the rate that was asked for by the second, at once.
                free.0 += (hand - free.0).min(1.2 * seconds);
                free.1 += (hand - free.0) * seconds;
            }
            let [bound, free] = [behind / 0.2 * 1e3, free.1 / 0.2 * 1e3];
            println!("pace {pace}: the nose comes {bound:.0} ms after the mouse, {free:.0} ms if a body could turn at once");
            assert!(bound < allowed, "{pace}: {bound}");
        }
    }
}
