//! What is heard in one moment: plain numbers, without the game and without sound.

/// What there is to hear. The default is a paused game: silence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Heard {
    /// The game goes on; where it does not, all is silent, and no voice moves on.
    pub running: bool,
    /// The engines' proper acceleration: a share of the most they can do.
    pub engine: f64,
    /// What the acceleration does to a body, 0 to 1; see [`load`].
    pub load: f64,
    /// The thrusters that turn the ship and stop its drift: a share of the most they can do.
    pub thrusters: f64,
    /// How much gas is round the ship: the share of the disk's mean density, 1 at most.
    pub immersion: f64,
    /// How fast the gas passes the ship, in c.
    pub wind: f64,
    /// The beacon of the target, where its light arrives.
    pub beacon: Option<Beacon>,
    /// The share of the time for which the target must be held that is done; 0 where it is not held.
    pub hold: f64,
    /// What the pilot must be told.
    pub alarm: Option<Alarm>,
    /// How dangerous it is, 0 to 1.
    pub danger: f64,
    /// T at which the player's last bolt was fired, in r_s/c.
    pub bolt: Option<f64>,
    /// How often a bolt has hit a ship.
    pub hits: u32,
    /// Goals that are done, the flight that is won among them.
    pub successes: u32,
    /// 1 once the flight is lost.
    pub losses: u32,
}

/// A ship's beacon as its light brings it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beacon {
    /// g = ν_observed/ν_emitted.
    pub ratio: f64,
    /// Proper time of the ship, in r_s/c, when the light left that arrives now.
    pub emitted: f64,
    /// How loud it is, 0 to 1; see [`loudness`].
    pub loudness: f64,
    /// From where it comes: −1 from the left, 1 from the right.
    pub pan: f64,
}

/// What an alarm warns of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alarm {
    /// The hole is near, or the assist pulls away from it.
    Hole,
    /// It is time to brake for the target.
    Brake,
    /// The time is nearly out.
    Time,
    /// The tanks are nearly empty.
    Fuel,
}

/// Acceleration, in g, at which a body can take no more: what is heard of it grows no further.
const HEAVIEST: f64 = 100.0;
/// Distance that light has travelled, in r_s, at which a beacon at g = 1 is half as loud as one that is beside the ship.
const HALF_AS_LOUD: f64 = 4.0;

impl Heard {
    /// A game that goes on without a flight to hear, but for the music.
    pub const MUSIC: Heard = Heard {
        running: true,
        engine: 0.0,
        load: 0.0,
        thrusters: 0.0,
        immersion: 0.0,
        wind: 0.0,
        beacon: None,
        hold: 0.0,
        alarm: None,
        danger: 0.0,
        bolt: None,
        hits: 0,
        successes: 0,
        losses: 0,
    };

    /// The same flight once it is over: what has happened is still heard, but nothing new.
    pub fn at_rest(self) -> Heard {
        let Heard { bolt, hits, successes, losses, .. } = self;
        Heard { bolt, hits, successes, losses, ..Heard::MUSIC }
    }
}

/// What an acceleration of so many g does to a body, 0 to 1: by its logarithm, as loads from 0.01 g of a large hole's to 1e9 g of a small
/// one's are flown.
pub fn load(gees: f64) -> f64 {
    ((1.0 + gees.max(0.0)).ln() / (1.0 + HEAVIEST).ln()).clamp(0.0, 1.0)
}

/// How loud a beacon is whose light has g = `ratio` and has travelled for `age` r_s/c. Its intensity goes as g⁴ over the distance's square,
/// so its amplitude as g² over the distance; of this the root, so that a far one is still heard.
pub fn loudness(ratio: f64, age: f64) -> f64 {
    (ratio * ratio * HALF_AS_LOUD / (HALF_AS_LOUD + 3.0 * age.max(0.0))).max(0.0).sqrt().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_and_loudness_stay_within_their_range() {
        assert_eq!([load(0.0), load(-1.0), load(HEAVIEST), load(1e9)], [0.0, 0.0, 1.0, 1.0]);
        assert!(load(10.0) > load(1.0) && load(1.0) > 0.1);
        assert_eq!(loudness(1.0, 0.0), 1.0);
        assert!((loudness(1.0, HALF_AS_LOUD) - 0.5).abs() < 1e-12);
        assert!(loudness(0.5, 5.0) < loudness(1.0, 5.0) && loudness(30.0, 0.0) == 1.0);
    }

    #[test]
    fn what_is_over_makes_no_new_sound() {
        let heard = Heard { engine: 1.0, alarm: Some(Alarm::Fuel), hits: 3, bolt: Some(2.0), ..Heard::MUSIC };
        assert_eq!(heard.at_rest(), Heard { hits: 3, bolt: Some(2.0), ..Heard::MUSIC });
    }
}
