//! What a flight was like, as far as it says why it was lost: passes of the target, an empty tank, the lowest place.

use bevy::prelude::Resource;

use crate::sim::Outcome;
use crate::sim::guidance::Guidance;

/// A pass counts within so many catch radii.
const CLOSE: f64 = 4.0;
/// A pass faster than this, in c, is too fast to hold.
const FAST: f64 = 0.2;

/// What is noted of a flight.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Review {
    /// The speed against the target, in c, of each close pass.
    passes: Vec<f64>,
    /// The least distance from the target, in r_s; None before it was known.
    nearest: Option<f64>,
    /// T at which the tanks were empty, in r_s/c.
    dry: Option<f64>,
    /// Whether the distance shrank in the frame before.
    closing: bool,
    /// Where the brake sign would have been, at the speed of the fastest pass, in r_s.
    brake_from: f64,
}

/// Why a flight was lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lesson {
    /// The hole.
    Fell,
    /// Passed the target too fast: so often, at this speed (c) at least; braking begins so far off (r_s).
    Passed {
        /// Close passes that were too fast.
        times: usize,
        /// The least of their speeds, in c.
        speed: f64,
        /// Distance at which to brake, in r_s.
        from: f64,
    },
    /// The tanks were empty at this T (r_s/c).
    Dry(f64),
    /// Never nearer than this, in r_s.
    Far(f64),
}

impl Review {
    /// Notes a moment at T = `time`: motion against the target that is caught within `reach` (r_s), and the Δv left (c).
    pub fn note(&mut self, time: f64, target: Option<(Guidance, f64)>, fuel: f64) {
        if fuel <= 0.0 && self.dry.is_none() {
            self.dry = Some(time);
        }
        let Some((guide, reach)) = target else {
            self.closing = false;
            return;
        };
        let range = guide.apart.length();
        self.nearest = Some(self.nearest.map_or(range, |nearest| nearest.min(range)));
        let closing = guide.closing() > 0.0;
        if self.closing && !closing && range < CLOSE * reach {
            let speed = guide.velocity.length();
            self.passes.push(speed);
            if speed >= self.passes.iter().fold(0.0, |most, speed| speed.max(most)) {
                self.brake_from = guide.stopping + reach;
            }
        }
        self.closing = closing;
    }

    /// Why the flight was lost that ended so; None where it was won, or the outcome says all.
    pub fn lesson(&self, outcome: Outcome) -> Option<Lesson> {
        let fast: Vec<f64> = self.passes.iter().copied().filter(|&speed| speed > FAST).collect();
        match outcome {
            Outcome::HunterLost | Outcome::ShipLost => Some(Lesson::Fell),
            Outcome::TimeOut | Outcome::QuarryLost if !fast.is_empty() => {
                let speed = fast.iter().copied().fold(f64::INFINITY, f64::min);
                Some(Lesson::Passed { times: fast.len(), speed, from: self.brake_from })
            }
            Outcome::TimeOut | Outcome::QuarryLost => self.dry.map(Lesson::Dry).or(self.nearest.map(Lesson::Far)),
            Outcome::Caught | Outcome::Done | Outcome::Taken | Outcome::Strayed => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::guidance::guidance;
    use crate::sim::pilot::rollout::Point;
    use glam::DVec3;

    /// Far out, passing a target at rest among the rain at this speed (c) and distance (r_s).
    fn passing(review: &mut Review, speed: f64, distance: f64) {
        for k in -20..=20 {
            let x = DVec3::new(1e6, distance, f64::from(k) * 0.2);
            let own = Point { x, p: DVec3::Z * speed / (1.0 - speed * speed).sqrt() };
            let target = Point { x: DVec3::X * 1e6, p: DVec3::ZERO };
            review.note(f64::from(k), Some((guidance(&own, &target, 0.06, 0.5), 0.5)), 1.0);
        }
    }

    #[test]
    fn fast_passes_are_the_lesson() {
        let mut review = Review::default();
        passing(&mut review, 0.3, 0.4);
        passing(&mut review, 0.1, 0.4);
        passing(&mut review, 0.4, 1.0);
        passing(&mut review, 0.5, 3.0);
        let Some(Lesson::Passed { times, speed, from }) = review.lesson(Outcome::TimeOut) else { panic!("{review:?}") };
        // (γ − 1)/a at 0.4 c and 0.06 c²/r_s is 1.52.
        assert!(times == 2 && (speed - 0.3).abs() < 1e-3 && (from - 2.02).abs() < 0.02, "{times} {speed} {from}");
        assert_eq!(review.lesson(Outcome::Done), None);
        assert_eq!(review.lesson(Outcome::ShipLost), Some(Lesson::Fell));
    }

    #[test]
    fn who_never_came_near_or_has_no_fuel_is_told_that() {
        let mut review = Review::default();
        passing(&mut review, 0.3, 5.0);
        assert_eq!(review.lesson(Outcome::TimeOut), Some(Lesson::Far(5.0)));
        review.note(70.0, None, 0.0);
        review.note(80.0, None, 0.0);
        assert_eq!(review.lesson(Outcome::TimeOut), Some(Lesson::Dry(70.0)));
    }
}
