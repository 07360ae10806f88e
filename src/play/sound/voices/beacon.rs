//! The target's beacon: it pings by the target's own clock and has its own pitch; both arrive as its light does, late and shifted by g.

use crate::play::sound::heard::{Beacon, Heard};
use crate::play::sound::parts::{Glide, Ring, Tone, panned};

/// The beacon's own pitch, in Hz: e′.
pub const PITCH: f64 = 330.0;
/// It pings once in so much of its ship's proper time, in r_s/c.
pub const PERIOD: f64 = 1.5;
/// The lowest and the highest tone that is played, in Hz.
const AUDIBLE: (f64, f64) = (20.0, 4000.0);
/// Above this frequency, in Hz, a tone is played softer in proportion: ears are keener there.
const BRIGHT: f64 = 900.0;
/// Share of the second harmonic.
const OCTAVE: f64 = 0.15;
/// Pings that may be missed between two looks at the target's clock; one that went on by more is another's.
const MISSED: f64 = 3.0;

/// The beacon's voice.
pub struct BeaconVoice {
    frequency: Glide,
    loudness: Glide,
    pan: Glide,
    ring: Ring,
    tones: [Tone; 2],
    /// Number of the last ping.
    last: Option<f64>,
}

impl BeaconVoice {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> BeaconVoice {
        BeaconVoice {
            frequency: Glide::new(PITCH, 0.004, rate),
            loudness: Glide::new(0.0, 0.01, rate),
            pan: Glide::new(0.0, 0.02, rate),
            ring: Ring::new(0.006, 0.16, rate),
            tones: std::array::from_fn(|_| Tone::new(rate)),
            last: None,
        }
    }

    /// What it follows from now on.
    pub fn set(&mut self, heard: &Heard) {
        let Some(Beacon { ratio, emitted, loudness, pan }) = heard.beacon else {
            self.last = None;
            self.loudness.aim(0.0);
            return;
        };
        let frequency = (PITCH * ratio).clamp(AUDIBLE.0, AUDIBLE.1);
        let soft = (BRIGHT / frequency).min(1.0);
        if self.ring.is_silent() {
            self.frequency.jump(frequency);
            self.pan.jump(pan);
        }
        self.frequency.aim(frequency);
        self.loudness.aim(loudness.clamp(0.0, 1.0) * soft);
        self.pan.aim(pan.clamp(-1.0, 1.0));
        let number = (emitted / PERIOD).floor();
        if self.last.is_some_and(|last| number > last && number <= last + MISSED) {
            self.ring.strike(1.0);
        }
        self.last = Some(number);
    }

    /// The next sample, left and right.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> [f64; 2] {
        let frequency = self.frequency.next();
        let [first, octave] = &mut self.tones;
        let tone = first.next(frequency) + OCTAVE * octave.next(2.0 * frequency);
        panned(0.5 * tone * self.ring.next() * self.loudness.next(), self.pan.next())
    }
}
