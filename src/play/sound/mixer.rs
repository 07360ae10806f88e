//! The mix: all voices by their volumes, softly limited. The same numbers give the same samples, for loudspeakers and for files.

use crate::play::sound::heard::Heard;
use crate::play::sound::parts::{Glide, plus, times};
use crate::play::sound::voices::beacon::BeaconVoice;
use crate::play::sound::voices::cues::CueVoice;
use crate::play::sound::voices::engine::EngineVoice;
use crate::play::sound::voices::music::MusicVoice;
use crate::play::sound::voices::roar::RoarVoice;
use crate::play::sound::volumes::Volumes;

/// Samples a second.
pub const RATE: u32 = 48_000;
/// Time constant in which volumes change, in seconds.
const VOLUME_LAG: f64 = 0.02;
/// Time constant in which a paused game falls silent, in seconds: after 0.4 s nothing is left.
const PAUSE_LAG: f64 = 0.02;
/// Up to this amplitude the limiter changes nothing.
const LINEAR: f64 = 0.6;
/// No sample is louder.
const LOUDEST: f64 = 0.98;

/// All voices.
pub struct Mixer {
    engine: EngineVoice,
    roar: RoarVoice,
    cues: CueVoice,
    beacon: BeaconVoice,
    music: MusicVoice,
    /// Of master, effects, music and beacon.
    gains: [Glide; 4],
    /// 1 while the game goes on.
    flow: Glide,
}

impl Mixer {
    /// At `rate` samples a second; silent until [`Mixer::set`].
    pub fn new(rate: u32) -> Mixer {
        let rate = f64::from(rate.max(8000));
        Mixer {
            engine: EngineVoice::new(rate),
            roar: RoarVoice::new(rate),
            cues: CueVoice::new(rate),
            beacon: BeaconVoice::new(rate),
            music: MusicVoice::new(rate),
            gains: Volumes::default().gains().map(|gain| Glide::new(gain, VOLUME_LAG, rate)),
            flow: Glide::new(0.0, PAUSE_LAG, rate),
        }
    }

    /// What is heard from now on, and how loud. A paused game goes on from where it was.
    pub fn set(&mut self, heard: &Heard, volumes: &Volumes) {
        for (gain, wanted) in self.gains.iter_mut().zip(volumes.gains()) {
            if self.flow.rests_at(0.0) { gain.jump(wanted) } else { gain.aim(wanted) }
        }
        self.flow.aim(if heard.running { 1.0 } else { 0.0 });
        if heard.running {
            self.engine.set(heard);
            self.roar.set(heard);
            self.cues.set(heard);
            self.beacon.set(heard);
            self.music.set(heard);
        }
    }

    /// Overwrites `out` with the next samples, left and right, each within ±1.
    pub fn fill(&mut self, out: &mut [[f32; 2]]) {
        for frame in out {
            *frame = if self.flow.rests_at(0.0) { [0.0; 2] } else { self.next() };
        }
    }

    fn next(&mut self) -> [f32; 2] {
        let [master, effects, music, beacon] = self.gains.each_mut().map(Glide::next);
        let ship = plus(plus(self.engine.next(), self.roar.next()), self.cues.next());
        let sum = plus(plus(times(ship, effects), times(self.music.next(), music)), times(self.beacon.next(), beacon));
        times(sum, master * self.flow.next()).map(|side| limited(side) as f32)
    }
}

/// Softly limited to ±[`LOUDEST`]: a tangent hyperbolic, without a kink where it begins.
fn limited(x: f64) -> f64 {
    let over = x.abs() - LINEAR;
    if over <= 0.0 {
        return x;
    }
    let room = LOUDEST - LINEAR;
    (LINEAR + room * (over / room).tanh()).copysign(x)
}
