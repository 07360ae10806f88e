//! What is to be noticed: the hold's rising tone, alarms, bolts, goals, the end.

use crate::play::sound::heard::{Alarm, Heard};
use crate::play::sound::parts::{Glide, Hiss, Low, Ring, Tone};

/// The hold's tone at its beginning and at its end, in Hz: b and the b above.
const HOLD: (f64, f64) = (247.0, 494.0);
/// It trembles so often a second, by so much.
const TREMBLE: (f64, f64) = (5.0, 0.25);
/// A success: d″, f″, a″. A loss: d′, c′, a. In Hz.
const SUCCESS: [f64; 3] = [587.33, 698.46, 880.0];
/// See [`SUCCESS`].
const LOSS: [f64; 3] = [293.66, 261.63, 220.0];
/// Time between two notes of a success and of a loss, in seconds.
const BETWEEN: (f64, f64) = (0.13, 0.34);

/// An alarm's pattern.
struct Pattern {
    /// It repeats after so many seconds.
    period: f64,
    /// Notes: when in the period (s), frequency (Hz), strength.
    notes: &'static [(f64, f64, f64)],
}

/// How an alarm sounds.
fn pattern(alarm: Alarm) -> Pattern {
    match alarm {
        Alarm::Hole => Pattern { period: 0.6, notes: &[(0.0, 311.13, 1.0), (0.3, 233.08, 1.0)] },
        Alarm::Brake => Pattern { period: 0.5, notes: &[(0.0, 466.16, 0.8)] },
        Alarm::Time => Pattern { period: 1.0, notes: &[(0.0, 587.33, 0.6)] },
        Alarm::Fuel => Pattern { period: 6.0, notes: &[(0.0, 392.0, 0.8), (0.22, 311.13, 0.8)] },
    }
}

/// A tone that is struck.
struct Bell {
    ring: Ring,
    tone: Tone,
    frequency: Glide,
    /// Samples until it is struck.
    waits: Option<f64>,
}

impl Bell {
    fn new(decay: f64, rate: f64) -> Bell {
        Bell { ring: Ring::new(0.006, decay, rate), tone: Tone::new(rate), frequency: Glide::new(440.0, 0.003, rate), waits: None }
    }

    fn strike(&mut self, frequency: f64, strength: f64) {
        if self.ring.is_silent() {
            self.frequency.jump(frequency);
        }
        self.frequency.aim(frequency);
        self.ring.strike(strength);
    }

    fn next(&mut self) -> f64 {
        self.tone.next(self.frequency.next()) * self.ring.next()
    }
}

/// The voice of all that is to be noticed.
pub struct CueVoice {
    rate: f64,
    before: Option<Heard>,
    hold: Tone,
    tremble: Tone,
    hold_pitch: Glide,
    hold_gain: Glide,
    alarm: Option<Alarm>,
    alarm_bell: Bell,
    /// Time into the alarm's pattern, in seconds.
    into: f64,
    chime: [Bell; 3],
    chime_notes: [f64; 3],
    shot: Ring,
    shot_pitch: Glide,
    shot_tone: Tone,
    blast: Ring,
    blast_tone: Tone,
    hiss: Hiss,
    low: Low,
}

impl CueVoice {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> CueVoice {
        CueVoice {
            rate,
            before: None,
            hold: Tone::new(rate),
            tremble: Tone::new(rate),
            hold_pitch: Glide::new(HOLD.0, 0.05, rate),
            hold_gain: Glide::new(0.0, 0.04, rate),
            alarm: None,
            alarm_bell: Bell::new(0.09, rate),
            into: 0.0,
            chime: std::array::from_fn(|_| Bell::new(0.35, rate)),
            chime_notes: SUCCESS,
            shot: Ring::new(0.003, 0.07, rate),
            shot_pitch: Glide::new(140.0, 0.05, rate),
            shot_tone: Tone::new(rate),
            blast: Ring::new(0.004, 0.22, rate),
            blast_tone: Tone::new(rate),
            hiss: Hiss::new(31),
            low: Low::new(rate),
        }
    }

    /// What it follows from now on.
    pub fn set(&mut self, heard: &Heard) {
        let holds = heard.hold > 0.0;
        if holds {
            let share = heard.hold.clamp(0.0, 1.0);
            let pitch = HOLD.0 * (HOLD.1 / HOLD.0).powf(share);
            if self.hold_gain.rests_at(0.0) {
                self.hold_pitch.jump(pitch);
            }
            self.hold_pitch.aim(pitch);
        }
        self.hold_gain.aim(if holds { 0.07 } else { 0.0 });
        if heard.alarm != self.alarm {
            (self.alarm, self.into) = (heard.alarm, 0.0);
        }
        // Of the first look nothing is known to have happened just now; and a counter that falls is that of another flight.
        if let Some(before) = self.before.replace(*heard) {
            if heard.bolt > before.bolt {
                self.shot.strike(1.0);
                self.shot_pitch.jump(if self.shot_pitch.now() > 141.0 { self.shot_pitch.now() } else { 620.0 });
                self.shot_pitch.aim(140.0);
            }
            if heard.hits > before.hits {
                self.blast.strike(1.0);
            }
            if heard.losses > before.losses {
                self.chime(LOSS, BETWEEN.1);
            } else if heard.successes > before.successes {
                self.chime(SUCCESS, BETWEEN.0);
            }
        }
    }

    fn chime(&mut self, notes: [f64; 3], between: f64) {
        self.chime_notes = notes;
        for (k, bell) in self.chime.iter_mut().enumerate() {
            bell.waits = Some(k as f64 * between * self.rate);
        }
    }

    /// The next sample, the same left and right.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> [f64; 2] {
        let tremble = 1.0 - TREMBLE.1 * (1.0 + self.tremble.next(TREMBLE.0));
        let hold = self.hold.next(self.hold_pitch.next()) * self.hold_gain.next() * tremble;
        let shot_tone = self.shot_tone.next(self.shot_pitch.next());
        let blast_tone = self.blast_tone.next(64.0);
        let noise = self.low.next(self.hiss.next(), 480.0);
        let (shot, blast) = (self.shot.next(), self.blast.next());
        let bolts = shot * (0.13 * shot_tone + 0.35 * noise) + blast * (0.2 * blast_tone + 1.1 * noise);
        [hold + bolts + self.alarm() + self.chimes(); 2]
    }

    fn alarm(&mut self) -> f64 {
        if let Some(alarm) = self.alarm {
            let Pattern { period, notes } = pattern(alarm);
            let until = self.into + 1.0 / self.rate;
            if let Some((_, frequency, strength)) = notes.iter().find(|(at, ..)| (self.into..until).contains(at)) {
                self.alarm_bell.strike(*frequency, *strength);
            }
            self.into = if until >= period { until - period } else { until };
        }
        0.24 * self.alarm_bell.next()
    }

    fn chimes(&mut self) -> f64 {
        let mut sum = 0.0;
        for (bell, frequency) in self.chime.iter_mut().zip(self.chime_notes) {
            bell.waits = bell.waits.map(|samples| samples - 1.0);
            if bell.waits.is_some_and(|samples| samples <= 0.0) {
                bell.waits = None;
                bell.strike(frequency, 1.0);
            }
            sum += bell.next();
        }
        0.11 * sum
    }
}
