//! The parts of frames, added up: which takes how long, and what is in none of them.

use crate::chart::{mean, quantile};

/// A part of one frame that the processor does before it hands the frame over,
pub const PROCESSOR: &str = "processor";
/// a pass, which the processor waits for,
pub const PASS: &str = "pass";
/// and the copy of the picture to where the processor can show it.
pub const PRESENTING: &str = "presenting";

/// A part of one frame: whose, its name, milliseconds.
pub type Part = (&'static str, &'static str, f64);

/// Times of whole frames and of their parts, in milliseconds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    whole: Vec<f64>,
    parts: Vec<(&'static str, &'static str, Vec<f64>)>,
}

/// Mean, median and worst of some times, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The middle one, of an even number the mean of both.
    pub median: f64,
    /// The longest.
    pub worst: f64,
}

impl Spread {
    /// Of these times; zero of none.
    pub fn of(times: &[f64]) -> Spread {
        Spread {
            mean: mean(times),
            median: if times.is_empty() { 0.0 } else { quantile(times.iter().copied(), 0.5) },
            worst: times.iter().copied().fold(0.0, f64::max),
        }
    }
}

impl Parts {
    /// Adds a frame. A part that it lacks took no time, one that comes twice counts together.
    pub fn add(&mut self, whole: f64, parts: &[Part]) {
        let before = self.whole.len();
        self.whole.push(whole);
        for &(whose, name, time) in parts {
            let place = self.parts.iter().position(|known| (known.0, known.1) == (whose, name)).unwrap_or(self.parts.len());
            if place == self.parts.len() {
                self.parts.push((whose, name, Vec::new()));
            }
            let times = &mut self.parts[place].2;
            times.resize(before + 1, 0.0);
            times[before] += time;
        }
        self.parts.iter_mut().for_each(|part| part.2.resize(before + 1, 0.0));
    }

    /// Of the whole frames.
    pub fn whole(&self) -> Spread {
        Spread::of(&self.whole)
    }

    /// The time of each whole frame, in their order.
    pub fn frames(&self) -> &[f64] {
        &self.whole
    }

    /// Each part, in the order in which they first came.
    pub fn spreads(&self) -> impl Iterator<Item = (&'static str, &'static str, Spread)> + '_ {
        self.parts.iter().map(|(whose, name, times)| (*whose, *name, Spread::of(times)))
    }

    /// All parts of one kind in each frame added up.
    pub fn together(&self, whose: &str) -> Spread {
        let of_it = || self.parts.iter().filter(|part| part.0 == whose);
        let frames: Vec<f64> = (0..self.whole.len()).map(|frame| of_it().map(|part| part.2[frame]).sum()).collect();
        Spread::of(&frames)
    }

    /// The mean time that is in no part: negative where the parts, measured one by one, take longer together than the whole.
    pub fn in_no_part(&self) -> f64 {
        self.whole().mean - self.spreads().map(|(.., spread)| spread.mean).sum::<f64>()
    }

    /// The mean of all parts whose name begins with one of these.
    pub fn sum(&self, names: &[&str]) -> f64 {
        let named = self.spreads().filter(|(_, name, _)| names.iter().any(|start| name.starts_with(start)));
        named.map(|(.., spread)| spread.mean).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_what_is_in_none_make_the_whole() {
        let mut parts = Parts::default();
        parts.add(10.0, &[(PROCESSOR, "encoding", 1.0), (PASS, "bloom", 2.0), (PASS, "bloom", 3.0)]);
        // A pass that comes later was not there before; one that is gone takes no time.
        parts.add(20.0, &[(PROCESSOR, "encoding", 3.0), (PASS, "thin", 12.0)]);
        let found: Vec<_> = parts.spreads().map(|(_, name, spread)| (name, spread.mean, spread.worst)).collect();
        assert_eq!(found, [("encoding", 2.0, 3.0), ("bloom", 2.5, 5.0), ("thin", 6.0, 12.0)]);
        assert_eq!(parts.whole(), Spread { mean: 15.0, median: 15.0, worst: 20.0 });
        // 5 and 12 of passes.
        assert_eq!(parts.together(PASS), Spread { mean: 8.5, median: 8.5, worst: 12.0 });
        assert_eq!(parts.together(PRESENTING), Spread::default());
        assert_eq!(parts.in_no_part(), 4.5);
        assert_eq!(parts.sum(&["bl", "thin"]), 8.5);
    }
}
