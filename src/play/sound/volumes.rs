//! How loud the player wants it.

use crate::scene::config::Sound;

/// Volumes, each 0 to 1, and what is muted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volumes {
    /// Of everything.
    pub master: f64,
    /// Of the ship and what happens to it.
    pub effects: f64,
    /// Of the music.
    pub music: f64,
    /// Of the target's beacon.
    pub beacon: f64,
    /// Everything is muted.
    pub master_muted: bool,
    /// The ship is.
    pub effects_muted: bool,
    /// The music is.
    pub music_muted: bool,
    /// The beacon is.
    pub beacon_muted: bool,
}

impl Default for Volumes {
    fn default() -> Self {
        Volumes::of(&Sound::default())
    }
}

impl Volumes {
    /// As the settings say.
    pub fn of(sound: &Sound) -> Volumes {
        Volumes {
            master: sound.master,
            effects: sound.effects,
            music: sound.music,
            beacon: sound.beacon,
            master_muted: sound.mute_master,
            effects_muted: sound.mute_effects,
            music_muted: sound.mute_music,
            beacon_muted: sound.mute_beacon,
        }
    }

    /// Factors of the amplitude for master, effects, music and beacon, each 0 to 1: the square of the volume, since ears go by decibels.
    pub fn gains(&self) -> [f64; 4] {
        let gain = |volume: f64, muted: bool| if muted || volume.is_nan() { 0.0 } else { volume.clamp(0.0, 1.0).powi(2) };
        [
            gain(self.master, self.master_muted),
            gain(self.effects, self.effects_muted),
            gain(self.music, self.music_muted),
            gain(self.beacon, self.beacon_muted),
        ]
    }
}
