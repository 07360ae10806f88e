//! With how many of its streaks a real-time aurora is drawn, so that it takes no more than its share of a frame.
//!
//! Fewer streaks are drawn wider and show no grain. So only sharpness is lost, gradually.

/// What the names of the aurora's passes begin with.
const PASSES: &str = "aurora";
/// The least share of streaks: rays are nearly gone then, curtains are not.
const LEAST: f64 = 1.0 / 16.0;
/// Largest change from one measurement to the next: times fluctuate, and a jump would be seen.
const STEPS: [f64; 2] = [0.8, 1.1];
/// The target, as a share of the allowed time: times fluctuate by some per cent and must stay below.
const AIM: f64 = 0.9;
/// Least duration of a frame, in ms: that of a screen with 144 Hz. A graphics card that is done sooner waits, so fewer streaks would save
/// nothing.
const LEAST_FRAME: f64 = 1000.0 / 144.0;
/// Below this share of the target the aurora gets more streaks. Between it and the target nothing changes.
const CONTENT: f64 = 0.75;

/// The share of its streaks with which an aurora is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Ration {
    part: f64,
    /// The last times of the aurora and of all other passes that were used, in ms.
    last: [f64; 2],
}

impl Default for Ration {
    fn default() -> Self {
        Ration { part: 1.0, last: [0.0; 2] }
    }
}

impl Ration {
    /// The share of streaks, in [1/16, 1].
    pub fn part(&self) -> f64 {
        self.part
    }

    /// Adapts to the times (ms) of all passes of a frame. The aurora may take `share` of them, or of a 144th of a second if that is more;
    /// with a share of 1 it keeps all streaks. Repeated times, and times without an aurora, change nothing.
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
        // The allowed time beside the other passes, over the time taken. Half as many streaks cost half as much or less.
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
