//! What the last frames took: as a whole, and each pass on the GPU.

use std::collections::VecDeque;

use bevy::prelude::Resource;

/// Frames over which mean and worst are taken.
pub const WINDOW: usize = 240;

/// Durations in the last frames, in milliseconds; the newest is the last.
#[derive(Clone, Debug, Default)]
pub struct Durations {
    last: VecDeque<f64>,
    /// How many there have been.
    count: usize,
}

impl Durations {
    /// Adds a frame.
    pub fn push(&mut self, milliseconds: f64) {
        if self.last.len() == WINDOW {
            self.last.pop_front();
        }
        self.last.push_back(milliseconds);
        self.count += 1;
    }

    /// Mean and worst; None before the first frame.
    pub fn mean_and_worst(&self) -> Option<(f64, f64)> {
        let count = self.last.len();
        (count > 0).then(|| (self.last.iter().sum::<f64>() / count as f64, self.last.iter().copied().fold(0.0, f64::max)))
    }

    /// All of them, from frame −239 to frame 0, which is now: of each two neighbours the longer, as many as a plot has room for.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let newest = self.last.len() as f64 - 1.0;
        // Pairs stay together as they grow older.
        let odd = (self.count - self.last.len()) % 2;
        let starts = (0..odd).chain((odd..self.last.len()).step_by(2));
        starts.map(move |start| {
            let end = if start < odd { odd } else { (start + 2).min(self.last.len()) };
            [start as f64 - newest, self.last.range(start..end).copied().fold(0.0, f64::max)]
        })
    }
}

/// The last frames, shown or not: whoever opens the overlay sees what was.
#[derive(Resource, Clone, Debug, Default)]
pub struct Frames {
    /// From one frame to the next.
    pub whole: Durations,
    /// Of each pass.
    pub passes: Vec<(&'static str, Durations)>,
    /// What the overlay itself took of the processor to be laid out, in frames in which it was open.
    pub overlay: Durations,
}

impl Frames {
    /// Adds a frame that took `milliseconds`, with the latest durations of its passes.
    pub fn push(&mut self, milliseconds: f64, passes: &[(&'static str, f32)]) {
        self.whole.push(milliseconds);
        // Nobody asked for them, or they have not come yet.
        if passes.is_empty() {
            return;
        }
        for (name, _) in passes {
            if !self.passes.iter().any(|(known, _)| known == name) {
                self.passes.push((name, Durations::default()));
            }
        }
        for (name, durations) in &mut self.passes {
            // One that is not drawn any more takes nothing.
            durations.push(passes.iter().find(|(known, _)| known == name).map_or(0.0, |(_, milliseconds)| f64::from(*milliseconds)));
        }
        self.passes.retain(|(_, durations)| durations.mean_and_worst().is_some_and(|(_, worst)| worst > 0.0));
    }

    /// Name, mean and worst of each pass, the longest mean first, with its durations.
    pub fn ranking(&self) -> Vec<(&'static str, f64, f64, &Durations)> {
        let known = self.passes.iter().filter_map(|(name, durations)| {
            let (mean, worst) = durations.mean_and_worst()?;
            Some((*name, mean, worst, durations))
        });
        let mut all: Vec<_> = known.collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_worst_of_the_last_frames() {
        let mut times = Durations::default();
        assert_eq!(times.mean_and_worst(), None);
        times.push(1000.0);
        for _ in 0..WINDOW - 1 {
            times.push(10.0);
        }
        assert_eq!(times.mean_and_worst().map(|(_, worst)| worst), Some(1000.0));
        times.push(20.0);
        assert_eq!(times.mean_and_worst().map(|(_, worst)| worst), Some(20.0));
        let points: Vec<[f64; 2]> = times.points().collect();
        assert_eq!((points[0], points[1], points.len()), ([-239.0, 10.0], [-238.0, 10.0], WINDOW / 2 + 1));
        assert_eq!(points.last(), Some(&[0.0, 20.0]));
    }

    #[test]
    fn a_pass_that_is_gone_is_forgotten_after_a_while() {
        let mut frames = Frames::default();
        frames.push(30.0, &[("draw", 20.0), ("disk", 5.0)]);
        frames.push(30.0, &[("draw", 10.0)]);
        let of = |frames: &Frames| frames.ranking().iter().map(|(name, mean, worst, _)| (*name, *mean, *worst)).collect::<Vec<_>>();
        assert_eq!(of(&frames), [("draw", 15.0, 20.0), ("disk", 2.5, 5.0)]);
        (0..WINDOW).for_each(|_| frames.push(30.0, &[("draw", 10.0)]));
        assert_eq!(of(&frames), [("draw", 10.0, 10.0)]);
    }
}
