//! What is heard as numbers: how a page's game tells the thread that makes the sound.

use crate::play::sound::heard::{Alarm, Beacon, Heard};
use crate::play::sound::volumes::Volumes;

/// How many numbers.
pub const COUNT: usize = 25;

/// The alarms, by their number less one.
const ALARMS: [Alarm; 4] = [Alarm::Hole, Alarm::Brake, Alarm::Time, Alarm::Fuel];

/// All of it. What there is not is no number.
pub fn numbers(heard: &Heard, volumes: &Volumes) -> [f64; COUNT] {
    let Heard { running, engine, load, thrusters, immersion, wind, beacon, hold, alarm, danger, bolt, hits, successes, losses } = *heard;
    let alarm = ALARMS.iter().position(|known| Some(*known) == alarm).map_or(f64::NAN, |place| place as f64);
    let Beacon { ratio, emitted, loudness, pan } =
        beacon.unwrap_or(Beacon { ratio: f64::NAN, emitted: f64::NAN, loudness: f64::NAN, pan: f64::NAN });
    let Volumes { master, effects, music, beacon, master_muted, effects_muted, music_muted, beacon_muted } = *volumes;
    let flag = |is: bool| f64::from(u8::from(is));
    [
        flag(running),
        engine,
        load,
        thrusters,
        immersion,
        wind,
        ratio,
        emitted,
        loudness,
        pan,
        hold,
        alarm,
        danger,
        bolt.unwrap_or(f64::NAN),
        f64::from(hits),
        f64::from(successes),
        f64::from(losses),
        master,
        effects,
        music,
        beacon,
        flag(master_muted),
        flag(effects_muted),
        flag(music_muted),
        flag(beacon_muted),
    ]
}

/// What the numbers say.
pub fn read(numbers: &[f64; COUNT]) -> (Heard, Volumes) {
    let [
        running,
        engine,
        load,
        thrusters,
        immersion,
        wind,
        ratio,
        emitted,
        loudness,
        pan,
        hold,
        alarm,
        danger,
        bolt,
        hits,
        successes,
        losses,
        master,
        effects,
        music,
        beacon,
        master_muted,
        effects_muted,
        music_muted,
        beacon_muted,
    ] = *numbers;
    let is = |flag: f64| flag != 0.0;
    let there = |number: f64| (!number.is_nan()).then_some(number);
    let heard = Heard {
        running: is(running),
        engine,
        load,
        thrusters,
        immersion,
        wind,
        beacon: there(ratio).map(|ratio| Beacon { ratio, emitted, loudness, pan }),
        hold,
        alarm: there(alarm).and_then(|place| ALARMS.get(place as usize).copied()),
        danger,
        bolt: there(bolt),
        hits: hits as u32,
        successes: successes as u32,
        losses: losses as u32,
    };
    let volumes = Volumes {
        master,
        effects,
        music,
        beacon,
        master_muted: is(master_muted),
        effects_muted: is(effects_muted),
        music_muted: is(music_muted),
        beacon_muted: is(beacon_muted),
    };
    (heard, volumes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sent_is_what_is_read() {
        let beacon = Beacon { ratio: 0.5, emitted: 1.0, loudness: 0.25, pan: -1.0 };
        let flight = Heard { beacon: Some(beacon), alarm: Some(Alarm::Fuel), bolt: Some(2.0), hits: 3, engine: 0.1, ..Heard::MUSIC };
        let muted = Volumes { effects_muted: true, music: 0.2, ..Volumes::default() };
        for (heard, volumes) in [(Heard::default(), Volumes::default()), (flight, muted)] {
            assert_eq!(read(&numbers(&heard, &volumes)), (heard, volumes));
        }
    }
}
