//! What can be measured in samples.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use lensrunner::play::sound::heard::Heard;
use lensrunner::play::sound::mixer::{Mixer, RATE};
use lensrunner::play::sound::volumes::Volumes;

/// Everything as loud as it goes.
pub const LOUD: Volumes = Volumes {
    master: 1.0,
    effects: 1.0,
    music: 1.0,
    beacon: 1.0,
    master_muted: false,
    effects_muted: false,
    music_muted: false,
    beacon_muted: false,
};
/// The ship alone.
pub const EFFECTS: Volumes = Volumes { music_muted: true, beacon_muted: true, ..LOUD };
/// The beacon alone.
pub const BEACON: Volumes = Volumes { effects_muted: true, music_muted: true, ..LOUD };
/// The music alone.
pub const MUSIC: Volumes = Volumes { effects_muted: true, beacon_muted: true, ..LOUD };

/// The next `seconds` of a mix.
pub fn next(mixer: &mut Mixer, seconds: f64) -> Vec<[f32; 2]> {
    let mut out = vec![[0.0; 2]; (seconds * f64::from(RATE)).round() as usize];
    mixer.fill(&mut out);
    out
}

/// A new mix of `heard` for `seconds`.
pub fn mix(heard: &Heard, volumes: &Volumes, seconds: f64) -> Vec<[f32; 2]> {
    let mut mixer = Mixer::new(RATE);
    mixer.set(heard, volumes);
    next(&mut mixer, seconds)
}

/// Left and right together.
pub fn mono(samples: &[[f32; 2]]) -> Vec<f64> {
    samples.iter().map(|[left, right]| f64::from(left + right)).collect()
}

/// Root of the mean square of both sides.
pub fn rms(samples: &[[f32; 2]]) -> f64 {
    (samples.iter().flatten().map(|&x| f64::from(x).powi(2)).sum::<f64>() / (2 * samples.len()) as f64).sqrt()
}

/// The greatest amplitude.
pub fn peak(samples: &[[f32; 2]]) -> f64 {
    samples.iter().flatten().map(|x| f64::from(x.abs())).fold(0.0, f64::max)
}

/// The greatest step between neighbouring samples.
pub fn step(samples: &[[f32; 2]]) -> f64 {
    samples.windows(2).flat_map(|pair| [0, 1].map(|side| f64::from((pair[1][side] - pair[0][side]).abs()))).fold(0.0, f64::max)
}

/// Amplitude at `frequency` (Hz) under a Hann window over all samples.
pub fn spectrum(sound: &[f64], frequency: f64) -> f64 {
    let n = sound.len() as f64;
    // Unit vectors that turn by a sample's angle, for the tone and for the window: their rounding adds up to 1e-11 at most.
    let turning = |angle: f64| DVec2::from_angle(angle);
    let (turn, widen) = (turning(TAU * frequency / f64::from(RATE)), turning(TAU / n));
    let (mut tone, mut hann, mut sum) = (DVec2::X, turning(PI / n), DVec2::ZERO);
    for x in sound {
        sum += tone * (x * 0.5 * (1.0 - hann.x));
        (tone, hann) = (tone.rotate(turn), hann.rotate(widen));
    }
    4.0 * sum.length() / n
}

/// The frequency (Hz) of the strongest tone from `low` to `high`: the peak of a fine DFT under a Hann window.
pub fn pitch(sound: &[f64], low: f64, high: f64) -> f64 {
    let resolution = f64::from(RATE) / sound.len() as f64;
    let steps = ((high - low) / (0.5 * resolution)).ceil() as usize;
    let at = |k: usize| low + (high - low) * k as f64 / steps as f64;
    let coarse = (0..=steps).map(at).max_by(|a, b| spectrum(sound, *a).total_cmp(&spectrum(sound, *b))).expect("a range");
    // The peak of the window's transform has no other within a resolution: thirds of it until 1e-6.
    let (mut from, mut to) = (coarse - resolution, coarse + resolution);
    while to - from > 1e-6 * coarse {
        let (a, b) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if spectrum(sound, a) < spectrum(sound, b) { from = a } else { to = b }
    }
    0.5 * (from + to)
}

#[test]
fn a_known_tone_is_measured() {
    let tone = |f: f64| -> Vec<f64> {
        (0..6000).map(|k| (TAU * f * f64::from(k) / f64::from(RATE)).sin() * (-f64::from(k) / 8000.0).exp()).collect()
    };
    for f in [99.0, 331.7, 990.0] {
        let found = pitch(&tone(f), 60.0, 1500.0);
        assert!((found / f - 1.0).abs() < 1e-4, "{found} {f}");
    }
}
