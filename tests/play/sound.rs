//! The mix, measured in its samples.

use lensrunner::play::sound::heard::{Alarm, Beacon, Heard};
use lensrunner::play::sound::mixer::{Mixer, RATE};
use lensrunner::play::sound::voices::beacon::{PERIOD, PITCH};
use lensrunner::play::sound::volumes::Volumes;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::samples::{BEACON, EFFECTS, LOUD, MUSIC, mix, mono, next, peak, pitch, rms, spectrum, step};

/// After this time (s) nothing is left of a mix that is muted or paused.
const FADED: f64 = 0.5;

fn beacon(ratio: f64, emitted: f64) -> Heard {
    Heard { beacon: Some(Beacon { ratio, emitted, loudness: 1.0, pan: 0.0 }), ..Heard::MUSIC }
}

/// As loud as it can be at second `t`: something new happens all the time.
fn loudest(t: f64) -> Heard {
    let often = (t * 10.0) as u32;
    Heard {
        engine: 1.0,
        load: 1.0,
        thrusters: 1.0,
        immersion: 1.0,
        wind: 1.0,
        hold: 0.99,
        alarm: Some(Alarm::Hole),
        danger: 1.0,
        bolt: Some(t),
        hits: often,
        successes: often,
        ..beacon(1.0, 7.0 * t)
    }
}

/// A ping of a beacon with this g, from its beginning.
fn ping(ratio: f64) -> Vec<f64> {
    let mut mixer = Mixer::new(RATE);
    mixer.set(&beacon(ratio, 0.9 * PERIOD), &BEACON);
    assert_eq!(peak(&next(&mut mixer, 0.3)), 0.0, "no ping yet");
    mixer.set(&beacon(ratio, 1.1 * PERIOD), &BEACON);
    mono(&next(&mut mixer, 0.5))
}

#[test]
fn the_beacon_sounds_at_g_times_its_pitch() {
    for g in [0.3, 0.45, 0.7, 1.0, 1.37, 2.0, 3.0] {
        let found = pitch(&ping(g)[1500..15_000], 60.0, 1500.0);
        assert!((found / (g * PITCH) - 1.0).abs() < 1e-3, "g = {g}: {found} Hz");
    }
}

#[test]
fn the_beacon_comes_from_its_side_and_is_louder_near() {
    let side = |pan: f64, loudness: f64| {
        let heard = |emitted| Heard { beacon: Some(Beacon { ratio: 1.0, emitted, loudness, pan }), ..Heard::MUSIC };
        let mut mixer = Mixer::new(RATE);
        mixer.set(&heard(0.9 * PERIOD), &BEACON);
        next(&mut mixer, 0.2);
        mixer.set(&heard(1.1 * PERIOD), &BEACON);
        let out = next(&mut mixer, 0.4);
        [0, 1].map(|k| out.iter().map(|frame| f64::from(frame[k]).powi(2)).sum::<f64>().sqrt())
    };
    let [left, right] = side(-1.0, 1.0);
    assert!(left > 1.0 && right < 1e-3 * left, "{left} {right}");
    let (middle, far) = (side(0.0, 1.0), side(0.0, 0.25));
    assert!((middle[0] / middle[1] - 1.0).abs() < 1e-3);
    assert!((middle[0] / far[0] - 4.0).abs() < 0.05, "{middle:?} {far:?}");
}

#[test]
fn the_loudest_mix_does_not_clip() {
    let mut mixer = Mixer::new(RATE);
    let mut greatest: f64 = 0.0;
    for k in 0..600 {
        mixer.set(&loudest(f64::from(k) / 60.0), &LOUD);
        greatest = greatest.max(peak(&next(&mut mixer, 1.0 / 60.0)));
    }
    assert!(greatest < 1.0, "{greatest}");
    assert!(greatest > 0.65, "the limiter had nothing to do: {greatest}");
}

#[test]
fn what_is_muted_or_paused_is_exactly_silent() {
    let paused = Heard::default();
    let muted = [
        (paused, LOUD),
        (loudest(1.0), Volumes { master_muted: true, ..LOUD }),
        (loudest(1.0), Volumes { master: 0.0, ..LOUD }),
        (loudest(1.0), Volumes { effects_muted: true, music_muted: true, beacon_muted: true, ..LOUD }),
        (loudest(1.0), Volumes { effects: 0.0, music: 0.0, beacon: 0.0, ..LOUD }),
    ];
    assert_eq!(peak(&mix(&paused, &LOUD, 0.5)), 0.0, "before anything is heard");
    for (heard, volumes) in muted {
        let mut mixer = Mixer::new(RATE);
        mixer.set(&loudest(0.0), &LOUD);
        assert!(rms(&next(&mut mixer, 1.0)) > 0.02);
        mixer.set(&heard, &volumes);
        next(&mut mixer, FADED);
        assert_eq!(peak(&next(&mut mixer, 0.5)), 0.0, "{volumes:?}");
        mixer.set(&loudest(2.0), &LOUD);
        next(&mut mixer, FADED);
        assert!(rms(&next(&mut mixer, 1.0)) > 0.02, "it comes back");
    }
}

/// The steps of a mix whose parameters jump, against those of the same voices when nothing changes.
#[test]
fn nothing_clicks() {
    let full = Heard { engine: 1.0, load: 1.0, thrusters: 1.0, immersion: 1.0, wind: 1.0, hold: 0.5, danger: 1.0, ..Heard::MUSIC };
    let steady = step(&mix(&full, &LOUD, 4.0)[24_000..]);
    let mut chance = StdRng::seed_from_u64(5);
    let mut mixer = Mixer::new(RATE);
    let mut all = Vec::new();
    for _ in 0..400 {
        // On and off at random, pauses and mutes too.
        let mut some = |value: f64| if chance.random_bool(0.5) { value } else { 0.0 };
        let heard = Heard {
            engine: some(1.0),
            load: some(1.0),
            thrusters: some(1.0),
            immersion: some(1.0),
            wind: some(1.0),
            hold: some(0.9),
            danger: some(1.0),
            running: some(1.0) + some(1.0) > 0.0,
            ..Heard::MUSIC
        };
        let volumes = Volumes { master: some(1.0), effects: some(1.0) + some(0.5), music_muted: some(1.0) > 0.0, ..LOUD };
        mixer.set(&heard, &volumes);
        all.extend(next(&mut mixer, chance.random_range(0.001..0.1)));
    }
    assert!(rms(&all) > 0.01);
    // 1.5: noise is longer than it was looked at, and volumes go up to 1.5.
    assert!(step(&all) < 1.5 * steady, "{} {steady}", step(&all));
}

/// A tone of frequency f and amplitude A has steps of 2πfA over the rate; jumps of pitch, loudness, direction and volume add little.
#[test]
fn a_beacon_that_jumps_does_not_click() {
    let mut chance = StdRng::seed_from_u64(6);
    let mut mixer = Mixer::new(RATE);
    let mut all = Vec::new();
    let mut emitted = 0.0;
    for _ in 0..400 {
        emitted += chance.random_range(0.0..0.6 * PERIOD);
        let beacon = Beacon {
            ratio: chance.random_range(0.3..3.0),
            emitted,
            loudness: chance.random_range(0.0..1.0),
            pan: chance.random_range(-1.0..1.0),
        };
        let there = chance.random_bool(0.9);
        let heard = Heard { beacon: there.then_some(beacon), running: chance.random_bool(0.9), ..Heard::MUSIC };
        mixer.set(&heard, &Volumes { beacon: chance.random_range(0.5..1.0), ..BEACON });
        all.extend(next(&mut mixer, chance.random_range(0.001..0.1)));
    }
    let loudest = peak(&all);
    assert!(loudest > 0.1, "{loudest}");
    // The octave has 0.15 of the amplitude and twice the steps.
    let bound = std::f64::consts::TAU * 3.0 * PITCH * loudest / f64::from(RATE) * 1.3;
    assert!(step(&all) < bound, "{} {bound}", step(&all));
}

/// Shots, hits, goals, losses and alarms swell from silence in 3 ms at least: 7 % of the whole in the first 10 samples.
#[test]
fn what_happens_suddenly_does_not_click() {
    let calm = Heard { bolt: Some(0.0), ..Heard::MUSIC };
    for sudden in [
        Heard { bolt: Some(1.0), ..calm },
        Heard { hits: 1, ..calm },
        Heard { successes: 1, ..calm },
        Heard { losses: 1, ..calm },
        Heard { alarm: Some(Alarm::Hole), ..calm },
        Heard { alarm: Some(Alarm::Time), ..calm },
        Heard { alarm: Some(Alarm::Fuel), ..calm },
    ] {
        let mut mixer = Mixer::new(RATE);
        mixer.set(&calm, &EFFECTS);
        // No tone is just at the beginning of a wave after this time.
        assert_eq!(peak(&next(&mut mixer, 0.4907)), 0.0, "nothing happens");
        mixer.set(&sudden, &EFFECTS);
        let out = next(&mut mixer, 0.5);
        assert!(peak(&out) > 0.03, "{sudden:?}: {}", peak(&out));
        assert!(peak(&out[..10]) < 0.1 * peak(&out), "{sudden:?}: {} of {}", peak(&out[..10]), peak(&out));
        assert!(step(&out) < 0.05, "{sudden:?}: {}", step(&out));
        // It has happened once, and falls silent.
        let after = Heard { alarm: None, ..sudden };
        mixer.set(&after, &EFFECTS);
        next(&mut mixer, 6.0);
        assert_eq!(peak(&next(&mut mixer, 0.5)), 0.0, "{sudden:?}");
    }
}

#[test]
fn the_same_flight_has_the_same_samples() {
    let flight = || -> Vec<[f32; 2]> {
        let mut mixer = Mixer::new(RATE);
        let blocks = (0..120).flat_map(|k| {
            mixer.set(&loudest(f64::from(k) / 60.0), &LOUD);
            next(&mut mixer, 1.0 / 60.0)
        });
        blocks.collect()
    };
    assert!(flight() == flight());
}

#[test]
fn each_voice_follows_what_it_is_for() {
    let loud = |heard: Heard| rms(&mix(&heard, &EFFECTS, 3.0)[48_000..]);
    assert_eq!(loud(Heard::MUSIC), 0.0, "free fall in the void is silent");
    let one = |share: f64| {
        [
            loud(Heard { engine: share, ..Heard::MUSIC }),
            loud(Heard { load: share, ..Heard::MUSIC }),
            loud(Heard { thrusters: share, ..Heard::MUSIC }),
            loud(Heard { immersion: share, wind: 0.5, ..Heard::MUSIC }),
        ]
    };
    let (half, full) = (one(0.5), one(1.0));
    for k in 0..4 {
        assert!(half[k] > 1e-3 && full[k] > 1.2 * half[k], "{k}: {half:?} {full:?}");
    }
    // The hum is louder and higher with power.
    let hum = |engine: f64| pitch(&mono(&mix(&Heard { engine, ..Heard::MUSIC }, &EFFECTS, 3.0)[48_000..]), 30.0, 85.0);
    assert!(hum(1.0) > 1.2 * hum(0.5), "{} {}", hum(1.0), hum(0.5));
    // Fast gas hisses.
    let bright = |wind: f64| {
        let out = mono(&mix(&Heard { immersion: 1.0, wind, ..Heard::MUSIC }, &EFFECTS, 2.0)[48_000..]);
        let band = |low: u32| (0..40).map(|k| spectrum(&out, f64::from(low + 10 * k)).powi(2)).sum::<f64>();
        band(1200) / band(50)
    };
    assert!(bright(0.8) > 4.0 * bright(0.1), "{} {}", bright(0.8), bright(0.1));
}

#[test]
fn the_hold_is_a_tone_that_rises_to_its_octave() {
    let tone = |hold: f64| pitch(&mono(&mix(&Heard { hold, ..Heard::MUSIC }, &EFFECTS, 1.0)[24_000..]), 200.0, 600.0);
    let (low, middle, high) = (tone(0.001), tone(0.5), tone(1.0));
    assert!((middle / low - 2f64.sqrt()).abs() < 5e-3 && (high / low - 2.0).abs() < 5e-3, "{low} {middle} {high}");
    let swell = mix(&Heard { hold: 0.3, ..Heard::MUSIC }, &EFFECTS, 0.4);
    assert!(step(&swell) < 0.01, "{}", step(&swell));
}

#[test]
fn the_music_is_quiet_and_deeper_in_danger() {
    let music = |danger: f64, volumes: &Volumes| mix(&Heard { danger, ..Heard::MUSIC }, volumes, 12.0);
    let (calm, danger) = (music(0.0, &MUSIC), music(1.0, &MUSIC));
    let loud = |samples: &[[f32; 2]]| 20.0 * rms(&samples[96_000..]).log10();
    // As players have it at first.
    let usual = loud(&music(1.0, &Volumes { effects_muted: true, beacon_muted: true, ..Volumes::default() }));
    assert!((-60.0..-32.0).contains(&usual), "{usual} dB");
    assert!(loud(&calm) > -50.0 && loud(&danger) > loud(&calm), "{} {}", loud(&calm), loud(&danger));
    // The pulse on D₂ with danger; without, nothing above 2 kHz is left to pierce.
    let deep = |samples: &[[f32; 2]]| spectrum(&mono(&samples[240_000..]), 73.42);
    assert!(deep(&danger) > 1.3 * deep(&calm), "{} {}", deep(&danger), deep(&calm));
    let high =
        |samples: &[[f32; 2]]| (0..40).map(|k| spectrum(&mono(&samples[400_000..]), 3000.0 + 100.0 * f64::from(k))).fold(0.0, f64::max);
    assert!(high(&calm) < 1e-3 && high(&danger) < 1e-3, "{} {}", high(&calm), high(&danger));
}
