//! Quiet music in d dorian: slow chords, a few plucked notes, and with danger a pulse in the bass, darker chords and lower notes. Chance is
//! seeded: it is the same each time.

use fundsp::prelude64::{AudioUnit, reverb_stereo};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::play::sound::heard::Heard;
use crate::play::sound::parts::{Glide, Ring, Tone, panned, plus, times};

/// D₂, in Hz; notes are counted in semitones from it.
const ROOT: f64 = 73.42;
/// Chords of the calm: d minor 9, f major 7, g 9, a minor 7, c, d minor 7.
const CALM: [[i32; 4]; 6] = [[0, 19, 15, 26], [3, 19, 22, 24], [5, 17, 21, 24], [7, 19, 22, 24], [10, 17, 19, 26], [0, 15, 19, 22]];
/// Chords of danger, of the same notes, on d or a tone beside it, with the tritone f–b.
const TENSE: [[i32; 4]; 4] = [[0, 9, 15, 21], [2, 9, 17, 21], [0, 10, 14, 15], [0, 9, 15, 14]];
/// Time for which a chord lasts, in seconds, and its time constant of coming and going.
const CHORD: (f64, f64) = (9.0, 0.9);
/// Beats a second without danger, and what full danger adds.
const BEAT: (f64, f64) = (0.95, 0.75);
/// How much of two tones of a chord differ in pitch, so that they beat slowly.
const DETUNE: f64 = 1.0015;
/// Voices that are plucked in turn.
const PLUCKS: usize = 4;

fn pitch(semitones: i32) -> f64 {
    ROOT * (f64::from(semitones) / 12.0).exp2()
}

/// A chord that comes and goes.
struct Chord {
    gain: Glide,
    notes: [f64; 4],
    tones: [[Tone; 3]; 4],
}

impl Chord {
    fn new(rate: f64) -> Chord {
        let tones = std::array::from_fn(|_| std::array::from_fn(|_| Tone::new(rate)));
        Chord { gain: Glide::new(0.0, CHORD.1, rate), notes: [ROOT; 4], tones }
    }

    fn next(&mut self) -> [f64; 2] {
        let gain = self.gain.next();
        if gain == 0.0 {
            return [0.0; 2];
        }
        let mut sum = [0.0; 2];
        for (k, (tones, frequency)) in self.tones.iter_mut().zip(self.notes).enumerate() {
            let [low, high, third] = tones;
            let third = 0.12 * third.next(3.0 * frequency);
            // Higher notes softer.
            let loud = 0.04 * (110.0 / frequency).min(1.0).sqrt();
            let side = if k % 2 == 0 { 0.4 } else { -0.4 };
            let both = plus(panned(low.next(frequency) + third, side), panned(high.next(frequency * DETUNE), -side));
            sum = plus(sum, times(both, loud));
        }
        times(sum, gain)
    }
}

/// A plucked note.
struct Pluck {
    ring: Ring,
    tones: [Tone; 2],
    frequency: f64,
    pan: f64,
}

impl Pluck {
    fn next(&mut self) -> [f64; 2] {
        if self.ring.is_silent() {
            return [0.0; 2];
        }
        let [first, second] = &mut self.tones;
        panned((first.next(self.frequency) + 0.2 * second.next(2.0 * self.frequency)) * self.ring.next(), self.pan)
    }
}

/// The music's voice.
pub struct MusicVoice {
    rate: f64,
    chance: StdRng,
    danger: Glide,
    chords: [Chord; 2],
    /// Which of them sounds, and its notes.
    sounding: usize,
    notes: [i32; 4],
    /// Number of chords so far, and samples until the next.
    count: usize,
    until_chord: f64,
    plucks: [Pluck; PLUCKS],
    next_pluck: usize,
    until_beat: f64,
    bass: Ring,
    bass_tones: [Tone; 2],
    room: Box<dyn AudioUnit>,
}

impl MusicVoice {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> MusicVoice {
        let mut room: Box<dyn AudioUnit> = Box::new(reverb_stereo(18.0, 3.5, 0.7));
        room.set_sample_rate(rate);
        room.allocate();
        let pluck = |_| Pluck { ring: Ring::new(0.006, 0.45, rate), tones: [(); 2].map(|()| Tone::new(rate)), frequency: ROOT, pan: 0.0 };
        MusicVoice {
            rate,
            chance: StdRng::seed_from_u64(0x6d75_7369),
            danger: Glide::new(0.0, 0.8, rate),
            chords: [Chord::new(rate), Chord::new(rate)],
            sounding: 0,
            notes: CALM[0],
            count: 0,
            until_chord: 0.0,
            plucks: std::array::from_fn(pluck),
            next_pluck: 0,
            until_beat: 2.0 * rate,
            bass: Ring::new(0.012, 0.22, rate),
            bass_tones: [(); 2].map(|()| Tone::new(rate)),
            room,
        }
    }

    /// What it follows from now on.
    pub fn set(&mut self, heard: &Heard) {
        self.danger.aim(heard.danger.clamp(0.0, 1.0));
    }

    /// The next sample, left and right.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> [f64; 2] {
        let danger = self.danger.next();
        self.until_chord -= 1.0;
        if self.until_chord <= 0.0 {
            self.change_chord(danger);
        }
        self.until_beat -= 1.0;
        if self.until_beat <= 0.0 {
            self.beat(danger);
        }
        let mut dry = plus(self.chords[0].next(), self.chords[1].next());
        for pluck in &mut self.plucks {
            dry = plus(dry, times(pluck.next(), 0.055));
        }
        let [root, above] = &mut self.bass_tones;
        let bass = (root.next(ROOT) + 0.4 * above.next(2.0 * ROOT)) * self.bass.next() * 0.1;
        let mut wet = [0.0f32; 2];
        self.room.tick(&dry.map(|side| side as f32), &mut wet);
        plus(plus(times(dry, 0.8), wet.map(|side| 0.5 * f64::from(side))), [bass; 2])
    }

    fn change_chord(&mut self, danger: f64) {
        self.until_chord += CHORD.0 * self.rate;
        let tense = danger > 0.35;
        self.notes = if tense { TENSE[self.count % TENSE.len()] } else { CALM[self.count % CALM.len()] };
        self.count += 1;
        self.chords[self.sounding].gain.aim(0.0);
        // The other has long faded.
        self.sounding = 1 - self.sounding;
        let chord = &mut self.chords[self.sounding];
        chord.notes = self.notes.map(pitch);
        chord.gain.aim(1.0);
    }

    fn beat(&mut self, danger: f64) {
        self.until_beat += self.rate / (BEAT.0 + BEAT.1 * danger);
        if danger > 0.05 {
            self.bass.strike(danger);
        }
        let (plays, note, lifts, pan) = (
            self.chance.random_bool(0.5 + 0.2 * danger),
            self.chance.random_range(0..4),
            self.chance.random_bool(0.35),
            self.chance.random(),
        );
        if !plays {
            return;
        }
        // In the calm above middle c, in danger an octave lower.
        let lowest = if danger > 0.5 { 12 } else { 24 };
        let mut semitones = self.notes[note];
        while semitones < lowest {
            semitones += 12;
        }
        let semitones = semitones + if lifts && danger < 0.5 { 12 } else { 0 };
        let pluck = &mut self.plucks[self.next_pluck];
        self.next_pluck = (self.next_pluck + 1) % PLUCKS;
        let pan: f64 = pan;
        (pluck.frequency, pluck.pan) = (pitch(semitones), 1.2 * pan - 0.6);
        pluck.ring.strike(1.0);
    }
}
