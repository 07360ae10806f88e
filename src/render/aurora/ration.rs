//! How many of its streaks a watched aurora is drawn with, so that it takes no more than its share of a frame.
//!
//! Streaks that are fewer are as much wider and show no grain, so that what is lost is sharpness alone, and it goes by degrees.

/// What the names of the aurora's passes begin with.
const PASSES: &str = "aurora";
/// The least part of its streaks: rays are all but gone then, curtains are not.
const LEAST: f64 = 1.0 / 16.0;
/// Change from one measurement to the next, at most: times waver, and a jump would be seen.
const STEPS: [f64; 2] = [0.8, 1.1];
/// What is aimed at, as a part of what it may take: times waver by some per cent, and its share shall stay below.
const AIM: f64 = 0.9;
/// What a frame lasts at least, ms, that of a screen that shows 144 in a second: a graphics card that is done sooner waits, and nothing is won by fewer streaks.
const LEAST_FRAME: f64 = 1000.0 / 144.0;
/// Below this part of what is aimed at the aurora may have more streaks: between it and the whole nothing changes.
const CONTENT: f64 = 0.75;

/// The part of its streaks that an aurora is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub struct Ration {
    part: f64,
    /// Times of the aurora and of all else that were looked at last, ms.
    last: [f64; 2],
}

impl Default for Ration {
    fn default() -> Self {
        Ration { part: 1.0, last: [0.0; 2] }
    }
}

impl Ration {
    /// The part of its streaks, in [1/16, 1].
    pub fn part(&self) -> f64 {
        self.part
    }

    /// Follows the times (ms) of all passes of a frame: the aurora shall take no more than `share` of them together, or of a 144th of a second if that is more; of 1 it has
    /// all its streaks. The same times again, and times without an aurora, change nothing.
    pub fn follow(&mut self, passes: &[(&str, f32)], share: f64) {
        let times = shares(passes);
        let [aurora, rest] = times;
        if times == self.last || !(aurora > 0.0 && rest > 0.0) {
            return;
        }
        self.last = times;
        if share >= 1.0 {
            self.part = 1.0;
            return;
        }
        let share = AIM * share.max(0.0);
        // What it may take beside the rest as that is, over what it takes. Half as many streaks cost half as much, or less.
        let allowed = (share / (1.0 - share) * rest).max(share * LEAST_FRAME);
        let wanted = allowed / aurora.max(1e-9);
        if wanted < 1.0 || CONTENT * wanted > 1.0 {
            self.part = (self.part * wanted.clamp(STEPS[0], STEPS[1])).clamp(LEAST, 1.0);
        }
    }
}

/// Times (ms) of the aurora's passes and of all others.
pub fn shares(passes: &[(&str, f32)]) -> [f64; 2] {
    let time = |aurora: bool| passes.iter().filter(|pass| pass.0.starts_with(PASSES) == aurora).map(|pass| f64::from(pass.1)).sum();
    [time(true), time(false)]
}
