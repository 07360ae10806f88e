//! The engines: a rumble and a hum by the proper acceleration, a groan by the load, a hiss of the thrusters. Free fall is silent.

use crate::play::sound::heard::Heard;
use crate::play::sound::parts::{Band, Glide, Hiss, Low, Tone};

/// Time constant of all of it, in seconds.
const LAG: f64 = 0.04;
/// The hum's frequency without power and what full power adds, in Hz.
const HUM: (f64, f64) = (41.0, 34.0);
/// The hum's partials: multiples of its frequency, and amplitudes. The upper ones are heard where a loudspeaker has no bass.
const PARTIALS: [(f64, f64); 4] = [(1.0, 0.05), (2.0, 0.035), (3.0, 0.018), (4.02, 0.008)];
/// The rumble's corner without power and what full power adds, in Hz.
const RUMBLE: (f64, f64) = (90.0, 240.0);
/// The band of the groan: its middle in Hz, and how narrow.
const GROAN: (f64, f64) = (163.0, 9.0);
/// The band of the thrusters' hiss.
const JET: (f64, f64) = (1500.0, 0.8);

/// The engines' voice.
pub struct EngineVoice {
    power: Glide,
    load: Glide,
    thrusters: Glide,
    hiss: Hiss,
    low: Low,
    groan: Band,
    jet: Band,
    hum: [Tone; 4],
}

impl EngineVoice {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> EngineVoice {
        let glide = |seconds| Glide::new(0.0, seconds, rate);
        EngineVoice {
            power: glide(LAG),
            load: glide(3.0 * LAG),
            thrusters: glide(0.5 * LAG),
            hiss: Hiss::new(11),
            low: Low::new(rate),
            groan: Band::new(rate),
            jet: Band::new(rate),
            hum: std::array::from_fn(|_| Tone::new(rate)),
        }
    }

    /// What it follows from now on.
    pub fn set(&mut self, heard: &Heard) {
        self.power.aim(heard.engine.clamp(0.0, 1.0));
        self.load.aim(heard.load.clamp(0.0, 1.0));
        self.thrusters.aim(heard.thrusters.clamp(0.0, 1.0));
    }

    /// The next sample, left and right.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> [f64; 2] {
        let (power, load, thrusters) = (self.power.next(), self.load.next(), self.thrusters.next());
        let white = self.hiss.next();
        let rumble = self.low.next(white, RUMBLE.0 + RUMBLE.1 * power) * 0.45;
        let frequency = HUM.0 + HUM.1 * power;
        let hum: f64 =
            self.hum.iter_mut().zip(PARTIALS).map(|(tone, (multiple, amplitude))| tone.next(frequency * multiple) * amplitude).sum();
        let groan = self.groan.next(white, GROAN.0, GROAN.1) * load * load * 0.5;
        let jet = self.jet.next(white, JET.0, JET.1) * thrusters * 0.07;
        // Half power is more than half as loud.
        let loud = power * (2.0 - power);
        [(rumble + hum) * loud + groan + jet; 2]
    }
}
