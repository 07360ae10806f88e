//! The disk's roar: gas that passes the ship, by its density, and brighter the faster it comes.

use crate::play::sound::heard::Heard;
use crate::play::sound::parts::{Glide, Hiss, Low, Tone, times};

/// The corner of the roar in still gas, and what gas at the speed of light adds, in Hz.
const CORNER: (f64, f64) = (130.0, 1500.0);
/// It swells and ebbs so often a second, by so much.
const GUSTS: [(f64, f64); 2] = [(0.31, 0.2), (1.7, 0.12)];

/// The gas's voice.
pub struct RoarVoice {
    density: Glide,
    wind: Glide,
    sides: [(Hiss, Low); 2],
    gusts: [Tone; 2],
}

impl RoarVoice {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> RoarVoice {
        RoarVoice {
            density: Glide::new(0.0, 0.08, rate),
            wind: Glide::new(0.0, 0.15, rate),
            sides: [21, 22].map(|seed| (Hiss::new(seed), Low::new(rate))),
            gusts: std::array::from_fn(|_| Tone::new(rate)),
        }
    }

    /// What it follows from now on.
    pub fn set(&mut self, heard: &Heard) {
        self.density.aim(heard.immersion.clamp(0.0, 1.0));
        self.wind.aim(heard.wind.clamp(0.0, 1.0));
    }

    /// The next sample, left and right.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> [f64; 2] {
        let (density, wind) = (self.density.next(), self.wind.next());
        let gust: f64 = self.gusts.iter_mut().zip(GUSTS).map(|(tone, (often, much))| tone.next(often) * much).sum();
        let corner = CORNER.0 + CORNER.1 * wind;
        // A wider band of the same noise is louder: kept nearly even.
        let even = (CORNER.0 / corner).powf(0.35);
        let [left, right] = &mut self.sides;
        let side = |(hiss, low): &mut (Hiss, Low)| low.next(hiss.next(), corner);
        times([side(left), side(right)], 1.6 * even * density * (1.0 + gust))
    }
}
