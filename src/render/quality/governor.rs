//! Holds a frame time: from how long frames take it chooses the rung.
//!
//! It goes down as far as the prediction says as soon as frames are too long, and up a rung at a time, once there has been room for a
//! while. A rung that turned out too slow is tried again after twice the time.
//!
//! Where even the fastest rung is too slow, what the way down has saved is measured. It may be little: the processor's own work, or a card
//! with more units than pixels. Then the finest rung is taken that is about as fast as the fastest, and the way down is tried again later.

use super::ladder::QualityRung;

/// Frames after a change that say nothing: what was on its way, targets made anew.
const SETTLING: u32 = 3;
/// Frames over which times are averaged before the first judgement.
const JUDGED: u32 = 5;
/// Frames on the fastest rung before it is said what the way down has saved.
const SURE: u32 = 30;
/// Weight of a new frame in the running mean.
const WEIGHT: f64 = 0.15;
/// Longer frames than this, of the time to hold, are too long.
const TOO_LONG: f64 = 1.1;
/// What is aimed at when going down.
const AIM: f64 = 0.95;
/// A finer rung must be predicted to take no more than this.
const ROOM: f64 = 0.85;
/// Frames with room before the next finer rung is tried, at first and at most.
const PATIENCE: [u32; 2] = [30, 1920];
/// A finer rung that is left within so many frames was a mistake.
const MISTAKE: u32 = 90;

/// A rung that takes so many times as long as the fastest is as good, where that one is too slow as well.
const AS_FAST: f64 = 1.05;
/// Frames before the way down is tried again that has saved too little, at first and at most: each time twice as many.
const RETRY: [u32; 2] = [600, 9600];
/// Frames so many times as long, or as short, as when something was tried in vain say that the scene has changed: it is tried again.
const CHANGED: f64 = 1.25;

/// What holds the frame time.
#[derive(Clone, Debug, PartialEq)]
pub struct Governor {
    rung: usize,
    /// Frames since the last change.
    since: u32,
    /// The last two frame times and times of work, in ms.
    recent: [[f64; 2]; 2],
    /// Running mean of frame times and of times of work, in ms.
    mean: [f64; 2],
    /// Frames with room so far.
    roomy: u32,
    patience: u32,
    /// If the last change was to a finer rung: what the finest would have taken then, in ms.
    climbed: Option<f64>,
    /// The same before the last step up that turned out too slow.
    refused: f64,
    /// Where the way down began: the rung, and its frame time in ms.
    top: Option<(usize, f64)>,
    /// A way down that has saved too little.
    vain: Option<Vain>,
    /// Frames before the next one is tried again.
    retry: u32,
}

/// A way down that has saved too little.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Vain {
    /// Frames before it is tried again.
    wait: u32,
    /// The frame time on the fastest rung, in ms.
    frame: f64,
}

impl Default for Governor {
    fn default() -> Self {
        Governor {
            rung: 0,
            since: 0,
            recent: [[0.0; 2]; 2],
            mean: [0.0; 2],
            roomy: 0,
            patience: PATIENCE[0],
            climbed: None,
            refused: 0.0,
            top: None,
            vain: None,
            retry: RETRY[0],
        }
    }
}

impl Governor {
    /// The rung in use.
    pub fn rung(&self) -> usize {
        self.rung
    }

    /// The running mean of frame times, in ms.
    pub fn mean(&self) -> f64 {
        self.mean[0]
    }

    /// Begins on a rung, as where a flight goes on in a scene of another class.
    pub fn begin_at(&mut self, rung: usize) {
        *self = Governor { rung, ..Governor::default() };
    }

    /// Takes the last frame's time (ms), of which `work` was not spent waiting for the screen (the same if that is not known), and returns
    /// the rung for the next. `hold` is the time to hold.
    pub fn follow(&mut self, ladder: &[QualityRung], hold: f64, frame: f64, work: f64) -> usize {
        let last = ladder.len().saturating_sub(1);
        self.rung = self.rung.min(last);
        if !(frame.is_finite() && work.is_finite() && hold > 0.0 && frame > 0.0) || ladder.is_empty() {
            return self.rung;
        }
        self.since = self.since.saturating_add(1);
        // The middle of three: a single long frame says nothing.
        let now = [frame, work.min(frame)];
        let middle = [0, 1].map(|k| middle([self.recent[0][k], self.recent[1][k], now[k]]));
        self.recent = [self.recent[1], now];
        if self.since <= SETTLING {
            return self.rung;
        }
        let begun = self.since > SETTLING + 1;
        for (mean, middle) in self.mean.iter_mut().zip(middle) {
            *mean = if begun { *mean + WEIGHT * (middle - *mean) } else { middle };
        }
        if self.since < SETTLING + JUDGED {
            return self.rung;
        }
        let predicted = |mean: f64, rung: usize| mean * ladder[rung].time / ladder[self.rung].time;
        let too_long = self.mean[0] > TOO_LONG * hold;
        self.vain = self.vain.filter(|vain| too_long && vain.wait > 1 && self.mean[0] < CHANGED * vain.frame);
        if let Some(vain) = &mut self.vain {
            vain.wait -= 1;
        } else if too_long && self.rung < last {
            let next = (self.rung + 1..last).find(|rung| predicted(self.mean[0], *rung) <= AIM * hold).unwrap_or(last);
            if let Some(finest) = self.climbed.filter(|_| self.since < MISTAKE) {
                self.patience = (2 * self.patience).min(PATIENCE[1]);
                self.refused = finest;
            }
            // After a sudden load the mean lags behind.
            self.top.get_or_insert((self.rung, self.mean[0].max(middle[0])));
            self.change(next, None);
        } else if too_long
            && self.since >= SURE
            && let Some((top, before)) = self.top.take()
        {
            let as_fast = self.as_fast(ladder, top, before);
            if as_fast < last {
                self.vain = Some(Vain { wait: self.retry, frame: self.mean[0] });
                self.retry = (2 * self.retry).min(RETRY[1]);
                self.change(as_fast, None);
            }
        } else if self.rung > 0 && predicted(self.mean[1], self.rung - 1) <= ROOM * hold {
            self.roomy += 1;
            let finest = self.mean[1] / ladder[self.rung].time;
            if finest * CHANGED < self.refused {
                self.patience = PATIENCE[0];
            }
            if self.roomy >= self.patience {
                self.change(self.rung - 1, Some(finest));
            }
        } else {
            self.roomy = 0;
        }
        if !too_long {
            self.top = None;
        }
        self.rung
    }

    /// On the last rung: the finest that is about as fast, judged by the way down from `top`, where frames took `before` ms.
    ///
    /// A frame takes F + V t on a rung of predicted time t: two measurements give both.
    fn as_fast(&self, ladder: &[QualityRung], top: usize, before: f64) -> usize {
        let last = ladder.len() - 1;
        let saved = (before - self.mean[0]).max(0.0);
        let slope = saved / (ladder[top].time - ladder[last].time).max(f64::MIN_POSITIVE);
        let takes = |rung: usize| self.mean[0] + slope * (ladder[rung].time - ladder[last].time);
        (0..last).find(|rung| takes(*rung) <= AS_FAST * self.mean[0]).unwrap_or(last)
    }

    fn change(&mut self, rung: usize, climbed: Option<f64>) {
        (self.rung, self.since, self.roomy, self.climbed) = (rung, 0, 0, climbed);
    }
}

/// The middle one.
fn middle(mut three: [f64; 3]) -> f64 {
    three.sort_by(f64::total_cmp);
    three[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::quality::options::QualityOption;

    fn rungs() -> Vec<QualityRung> {
        let times = [1.0, 0.8, 0.6, 0.45, 0.3];
        times
            .iter()
            .enumerate()
            .map(|(k, time)| QualityRung { steps: [0; QualityOption::ALL.len()], error: 0.01 * k as f64, time: *time })
            .collect()
    }

    /// Runs `frames` frames on a machine that takes `finest` ms for the finest; how often the rung changed.
    fn run(governor: &mut Governor, hold: f64, finest: f64, frames: u32) -> u32 {
        run_with(governor, hold, [0.0, finest], frames)
    }

    /// The same where a frame has a part that no rung changes, and one that is `varying` ms on the finest.
    fn run_with(governor: &mut Governor, hold: f64, [fixed, varying]: [f64; 2], frames: u32) -> u32 {
        let rungs = rungs();
        let mut changes = 0;
        for k in 0..frames {
            let before = governor.rung();
            // Times fluctuate by a twentieth.
            let noise = 1.0 + 0.05 * f64::from(k * 7 % 11) / 5.0 - 0.05;
            let time = (fixed + varying * rungs[before].time) * noise;
            changes += u32::from(governor.follow(&rungs, hold, time, time) != before);
        }
        changes
    }

    #[test]
    fn it_finds_the_finest_rung_that_holds() {
        let mut governor = Governor::default();
        let changes = run(&mut governor, 40.0, 80.0, 200);
        assert_eq!((governor.rung(), changes), (3, 1));
        // With room it climbs again, a rung at a time.
        run(&mut governor, 40.0, 20.0, 400);
        assert_eq!(governor.rung(), 0);
    }

    #[test]
    fn it_does_not_swing() {
        // Between two rungs: the finer is a little too slow.
        let mut governor = Governor::default();
        let changes = run(&mut governor, 40.0, 56.0, 4000);
        assert!(changes < 8, "{changes} changes");
    }

    #[test]
    fn a_wrong_prediction_makes_it_swing_less_and_less() {
        // All rungs but the last take about as long as the finest, and all too long.
        let real = [1.0, 0.95, 0.9, 0.85, 0.3];
        let (mut governor, rungs, mut changes) = (Governor::default(), rungs(), [0; 2]);
        for k in 0..40_000 {
            let before = governor.rung();
            let time = 56.0 * real[before];
            changes[usize::from(k > 4000)] += u32::from(governor.follow(&rungs, 40.0, time, time) != before);
        }
        // Up and down once in 1,920 frames.
        assert!(changes[0] < 20 && changes[1] < 45, "{changes:?}");
    }

    #[test]
    fn one_long_frame_changes_nothing_and_a_sudden_load_no_more_than_it_must() {
        let (mut governor, rungs) = (Governor::default(), rungs());
        for k in 0..400 {
            let frame = if k % 100 == 50 { 250.0 } else { 16.7 };
            assert_eq!(governor.follow(&rungs, 16.7, frame, frame.min(12.0)), 0, "frame {k}");
        }
        // From one frame to the next ten times as long: down, and never up again.
        let mut lowest = 0;
        for k in 0..200 {
            let time = 100.0 * rungs[governor.rung()].time;
            let rung = governor.follow(&rungs, 16.7, time, time);
            assert!(rung >= lowest, "frame {k}: from {lowest} to {rung}");
            lowest = rung;
        }
        assert_eq!(lowest, 4);
    }

    #[test]
    fn too_slow_a_machine_gets_the_fastest_rung_and_nonsense_changes_nothing() {
        let mut governor = Governor::default();
        run(&mut governor, 10.0, 500.0, 50);
        assert_eq!(governor.rung(), 4);
        assert_eq!(governor.follow(&rungs(), 10.0, f64::NAN, 1.0), 4);
        assert_eq!(governor.follow(&[], 10.0, 20.0, 1.0), 0);
    }

    #[test]
    fn what_no_rung_makes_faster_is_drawn_finely() {
        // The processor's own work takes twice the time to hold.
        let mut governor = Governor::default();
        let changes = run_with(&mut governor, 7.0, [14.0, 0.5], 4000);
        assert!(governor.rung() <= 1, "rung {}", governor.rung());
        assert!(changes <= 9, "{changes} changes");
        // Half of it is saved: that pays.
        let mut governor = Governor::default();
        run_with(&mut governor, 7.0, [5.0, 12.0], 400);
        assert_eq!(governor.rung(), 4);
        // Once pixels cost, the dial turns at once.
        let mut governor = Governor::default();
        run_with(&mut governor, 16.0, [20.0, 0.5], 400);
        assert!(governor.rung() <= 1, "rung {}", governor.rung());
        run_with(&mut governor, 16.0, [2.0, 25.0], 60);
        assert!(governor.rung() >= 2);
        // And with room it is as if nothing had been.
        run_with(&mut governor, 16.0, [4.0, 2.0], 400);
        assert_eq!((governor.rung(), governor.vain), (0, None));
    }

    #[test]
    fn waiting_for_the_screen_is_no_work() {
        let (mut governor, rungs) = (Governor::default(), rungs());
        governor.begin_at(4);
        // The screen shows a picture every 16.7 ms; drawing takes 2 ms of them.
        for _ in 0..1000 {
            governor.follow(&rungs, 16.7, 16.7, 2.0);
        }
        assert_eq!(governor.rung(), 0);
    }
}
