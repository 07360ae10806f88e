//! What a flight was like, as far as it says why it was lost: passes of the target, an empty tank, the lowest place.

use bevy::prelude::Resource;
use glam::DVec3;

use crate::sim::Outcome;
use crate::sim::guidance::Guidance;

/// A pass counts within so many catch radii.
const CLOSE: f64 = 4.0;
/// A pass faster than this, in c, is too fast to hold.
const FAST: f64 = 0.2;
/// T between two places of a way, in r_s/c.
const SPACING: f64 = 0.25;
/// Places of a way that are kept: of a longer flight every other one, so often.
const MOST: usize = 4096;

/// A moment of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// T, in r_s/c.
    pub time: f64,
    /// Where the ship was, in r_s.
    pub own: DVec3,
    /// Where the target was as far as was known, in r_s.
    pub target: Option<DVec3>,
}

/// What is noted of a flight.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Review {
    /// The speed against the target, in c, of each close pass.
    passes: Vec<f64>,
    /// The least distance from the target, in r_s; None before it was known.
    nearest: Option<f64>,
    /// When the tanks were empty.
    dry: Option<Mark>,
    /// The last close pass that was too fast.
    fast: Option<Mark>,
    /// Where both were nearest.
    near: Option<Mark>,
    /// The ways of both.
    ways: Vec<Mark>,
    /// T between two places of them, in r_s/c; 0 for the first.
    spacing: f64,
    /// Whether the distance shrank in the frame before.
    closing: bool,
    /// How the target was flown with at last.
    kept: Option<Feat>,
    /// The bolt that hit last.
    shot: Option<Feat>,
    /// T of each catch, in r_s/c.
    catches: Vec<f64>,
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

/// How a flight was won.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feat {
    /// With the target.
    Kept {
        /// Distance from it, in r_s.
        distance: f64,
        /// Speed against it, in c.
        speed: f64,
        /// r, in r_s.
        radius: f64,
    },
    /// By a bolt.
    Shot {
        /// How long it flew, in r_s/c.
        span: f64,
        /// How far round the hole, in radians.
        round: f64,
    },
}

/// Pieces of a bolt's way whose turns about the hole are added.
const PIECES: usize = 64;

impl Review {
    /// Notes a moment at T = `time`: the ship's place (r_s), motion against the target that is caught within `reach` (r_s), and the Δv left
    /// (c).
    pub fn note(&mut self, time: f64, own: DVec3, target: Option<(Guidance, f64)>, fuel: f64) {
        let mark = Mark { time, own, target: target.map(|(guide, _)| own + guide.apart) };
        self.keep(mark);
        if fuel <= 0.0 && self.dry.is_none() {
            self.dry = Some(mark);
        }
        self.kept =
            target.map(|(guide, _)| Feat::Kept { distance: guide.apart.length(), speed: guide.velocity.length(), radius: own.length() });
        let Some((guide, reach)) = target else {
            self.closing = false;
            return;
        };
        let range = guide.apart.length();
        if self.nearest.is_none_or(|nearest| range < nearest) {
            (self.nearest, self.near) = (Some(range), Some(mark));
        }
        let closing = guide.closing() > 0.0;
        if self.closing && !closing && range < CLOSE * reach {
            let speed = guide.velocity.length();
            self.passes.push(speed);
            if speed > FAST {
                self.fast = Some(mark);
            }
            if speed >= self.passes.iter().fold(0.0, |most, speed| speed.max(most)) {
                self.brake_from = guide.stopping + reach;
            }
        }
        self.closing = closing;
    }

    /// Adds a place to the ways.
    fn keep(&mut self, mark: Mark) {
        if self.ways.last().is_some_and(|last| mark.time < last.time + self.spacing) {
            return;
        }
        if self.ways.len() >= MOST {
            let mut number = 0;
            self.ways.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.spacing *= 2.0;
        }
        self.spacing = self.spacing.max(SPACING);
        self.ways.push(mark);
    }

    /// The ways of both.
    pub fn ways(&self) -> &[Mark] {
        &self.ways
    }

    /// The moment that a lesson speaks of.
    pub fn moment(&self, lesson: Lesson) -> Option<Mark> {
        match lesson {
            Lesson::Fell => self.ways.last().copied(),
            Lesson::Passed { .. } => self.fast,
            Lesson::Dry(_) => self.dry,
            Lesson::Far(_) => self.near,
        }
    }

    /// Notes a catch at T = `time` (r_s/c).
    pub fn note_catch(&mut self, time: f64) {
        self.catches.push(time);
    }

    /// T of each catch, in r_s/c.
    pub fn catches(&self) -> &[f64] {
        &self.catches
    }

    /// Notes the bolt that hit: where it was, `at` times from 0 to 1 of its flight of `span` (r_s/c).
    pub fn note_hit(&mut self, span: f64, at: impl Fn(f64) -> DVec3) {
        let places: Vec<DVec3> = (0..=PIECES).map(|piece| at(piece as f64 / PIECES as f64)).collect();
        let round = places.windows(2).map(|pair| pair[0].angle_between(pair[1])).sum();
        self.shot = Some(Feat::Shot { span, round });
    }

    /// How the flight was won that ended so; None where the times say all, or it was lost.
    pub fn feat(&self, outcome: Outcome) -> Option<Feat> {
        matches!(outcome, Outcome::Caught | Outcome::Done).then_some(self.shot.or(self.kept)).flatten()
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
            Outcome::TimeOut | Outcome::QuarryLost => self.dry.map(|dry| Lesson::Dry(dry.time)).or(self.nearest.map(Lesson::Far)),
            Outcome::Caught | Outcome::Done | Outcome::Taken | Outcome::Strayed => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::guidance::guidance;
    use crate::sim::pilot::rollout::Point;

    /// Far out, passing a target at rest among the rain at this speed (c) and distance (r_s).
    fn passing(review: &mut Review, speed: f64, distance: f64) {
        for k in -20..=20 {
            let x = DVec3::new(1e6, distance, f64::from(k) * 0.2);
            let own = Point { x, p: DVec3::Z * speed / (1.0 - speed * speed).sqrt() };
            let target = Point { x: DVec3::X * 1e6, p: DVec3::ZERO };
            review.note(f64::from(k), x, Some((guidance(&own, &target, 0.06, 0.5), 0.5)), 1.0);
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
        // That at 0.4 c, the last that was close.
        let moment = review.moment(Lesson::Passed { times, speed, from }).map(|mark| (mark.time, mark.own.y));
        assert!(moment.is_some_and(|(time, y)| y == 1.0 && (0.0..=1.0).contains(&time)), "{moment:?}");
        assert_eq!(review.lesson(Outcome::Done), None);
        let Some(Feat::Kept { speed, .. }) = review.feat(Outcome::Done) else { panic!("{review:?}") };
        assert!((speed - 0.5).abs() < 1e-3 && review.feat(Outcome::TimeOut).is_none(), "{speed}");
        // Half round the hole.
        review.note_hit(9.0, |share| DVec3::X.rotate_axis(DVec3::Z, share * std::f64::consts::PI) * 3.0);
        let Some(Feat::Shot { span, round }) = review.feat(Outcome::Done) else { panic!("{review:?}") };
        assert!(span == 9.0 && (round - std::f64::consts::PI).abs() < 1e-9, "{span} {round}");
        assert_eq!(review.lesson(Outcome::ShipLost), Some(Lesson::Fell));
    }

    #[test]
    fn who_never_came_near_or_has_no_fuel_is_told_that() {
        let mut review = Review::default();
        passing(&mut review, 0.3, 5.0);
        assert_eq!(review.lesson(Outcome::TimeOut), Some(Lesson::Far(5.0)));
        review.note(70.0, DVec3::X, None, 0.0);
        review.note(80.0, DVec3::Y, None, 0.0);
        assert_eq!(review.lesson(Outcome::TimeOut), Some(Lesson::Dry(70.0)));
        assert_eq!(review.moment(Lesson::Dry(70.0)), Some(Mark { time: 70.0, own: DVec3::X, target: None }));
    }

    #[test]
    fn ways_of_any_length_find_room() {
        let mut review = Review::default();
        for k in 0..40_000 {
            review.note(f64::from(k), DVec3::X * f64::from(k), None, 1.0);
        }
        let ways = review.ways();
        assert!((MOST / 2..=MOST).contains(&ways.len()), "{}", ways.len());
        assert!(ways.windows(2).all(|pair| pair[0].time < pair[1].time) && ways[0].time == 0.0);
    }
}
