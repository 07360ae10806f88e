//! What the trailer shows: a table, a row for each part.

use crate::play::camera::director::Shot;

/// Where a part takes place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The expert's flight in a mission: `assets/replays/NAME-expert.toml`.
    Flight(&'static str),
    /// A scene of `assets/scenes`.
    Scene(&'static str),
}

/// From where it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// The scene's own camera.
    Own,
    /// One of the director's.
    Director(Shot),
    /// At rest at a place that moves from the first to the second, the hole in the middle; x, y, z in r_s.
    Hover([f64; 3], [f64; 3]),
    /// With the scene's planet, at a place that moves from the first to the second: outwards from the hole, along the orbit and up from
    /// the planet's middle, in r_s. It looks at the third.
    Planet([f64; 3], [f64; 3], [f64; 3]),
}

/// A part of the trailer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Where it takes place.
    pub place: Place,
    /// Its first and its last T, in r_s/c.
    pub span: [f64; 2],
    /// Its length in seconds, in a trailer of the usual length.
    pub seconds: f64,
    /// From where it is seen.
    pub camera: Camera,
    /// Horizontal field of view, in degrees; 0: as the camera has it.
    pub fov: f64,
    /// How tense the music is at least, 0 to 1.
    pub tension: f64,
    /// What is written below the picture.
    pub line: &'static str,
}

/// The trailer, in its order. Its usual length is the sum of the seconds: 30.
pub const PARTS: [Part; 8] = [
    // The hole and its disk from afar; the camera comes down to the plane.
    Part {
        place: Place::Scene("disk"),
        span: [0.0, 6.0],
        seconds: 4.5,
        camera: Camera::Hover([4.0, -34.0, 8.0], [-4.0, -23.0, 2.5]),
        fov: 60.0,
        tension: 0.0,
        line: "Light bends.",
    },
    // After a ship that hides in the gas.
    Part {
        place: Place::Flight("03-through-the-disk"),
        span: [60.0, 66.0],
        seconds: 3.5,
        camera: Camera::Director(Shot::Chase),
        fov: 75.0,
        tension: 0.5,
        line: "",
    },
    // Over the disk, the photon ring in the shadow, after a ship that is seen late.
    Part {
        place: Place::Flight("04-the-ghost"),
        span: [5.0, 11.0],
        seconds: 3.5,
        camera: Camera::Director(Shot::Chase),
        fov: 75.0,
        tension: 0.5,
        line: "Light is late.",
    },
    // A planet behind the hole, seen on both sides of it, with its aurora. It ends before the two images close to a ring.
    Part {
        place: Place::Scene("aurora-lensed"),
        span: [2.5, 7.0],
        seconds: 3.5,
        camera: Camera::Own,
        fov: 66.0,
        tension: 0.3,
        line: "One planet, seen twice.",
    },
    // Over the pole of a planet, its aurora before the disk.
    Part {
        place: Place::Scene("chase"),
        span: [0.0, 2.0],
        seconds: 3.5,
        camera: Camera::Planet([2.2, -0.9, 1.2], [1.2, -0.3, 1.7], [-10.0, 0.5, -2.8]),
        fov: 75.0,
        tension: 0.3,
        line: "",
    },
    // The camera comes before the galaxy that is behind the hole: its Einstein ring closes.
    Part {
        place: Place::Scene("galaxy-axis"),
        span: [0.0, 1.0],
        seconds: 3.0,
        camera: Camera::Hover([7.0, 2.0, 15.0], [0.0, 0.0, 15.0]),
        fov: 60.0,
        tension: 0.6,
        line: "",
    },
    // Among ships that fall: the camera is at the horizon at T = 1.22 = (2^1.5 − 1)·2/3, at three quarters of the part.
    Part {
        place: Place::Scene("plunge"),
        span: [0.3, 1.55],
        seconds: 3.5,
        camera: Camera::Own,
        fov: 100.0,
        tension: 1.0,
        line: "Nothing marks the horizon.",
    },
    // The catch, at T = 20.25, and the title over it.
    Part {
        place: Place::Flight("02-first-pursuit"),
        span: [17.5, 25.0],
        seconds: 5.0,
        camera: Camera::Director(Shot::Quarry),
        fov: 75.0,
        tension: 0.4,
        line: "",
    },
];

/// The name, and what is written under it: at the end, over the last part.
pub const TITLE: [&str; 2] = ["LENSRUNNER", "What you see is where it was."];

/// Seconds in which a part comes out of black, and goes back.
const FADE: f64 = 0.4;
/// Seconds in which the last part goes to black.
const LAST_FADE: f64 = 1.2;
/// A fade takes at most this share of its part.
const FADE_SHARE: f64 = 0.3;

/// A moment of the trailer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrailerMoment {
    /// Index of the part.
    pub part: usize,
    /// T in r_s/c.
    pub time: f64,
    /// How much of the part is over, 0 to 1.
    pub share: f64,
    /// Brightness: 1 but for fades, never more.
    pub light: f64,
    /// Whether it is of the last part.
    pub is_last: bool,
}

impl TrailerMoment {
    /// The moment at `share` (0 to 1) of a trailer of these parts, at least one, and of so many seconds.
    pub fn at(parts: &[Part], share: f64, seconds: f64) -> TrailerMoment {
        let whole: f64 = parts.iter().map(|part| part.seconds).sum();
        let mut left = share.clamp(0.0, 1.0) * whole;
        let mut index = 0;
        while index + 1 < parts.len() && left >= parts[index].seconds {
            left -= parts[index].seconds;
            index += 1;
        }
        let part = &parts[index];
        let share = (left / part.seconds).clamp(0.0, 1.0);
        let length = part.seconds * seconds / whole;
        let is_last = index + 1 == parts.len();
        let [rise, fall] = [FADE, if is_last { LAST_FADE } else { FADE }].map(|fade| fade.min(FADE_SHARE * length));
        let light = smooth(share * length / rise).min(smooth((1.0 - share) * length / fall));
        TrailerMoment { part: index, time: part.span[0] + (part.span[1] - part.span[0]) * share, share, light, is_last }
    }
}

/// From 0 to 1 without a kink.
pub fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_trailer_lasts_thirty_seconds() {
        assert_eq!(PARTS.iter().map(|part| part.seconds).sum::<f64>(), 30.0);
    }

    /// All parts are shown, in their order and over their whole span; each comes out of black and goes back, and is never made brighter.
    #[test]
    fn every_part_is_shown_between_two_fades() {
        let all: Vec<TrailerMoment> = (0..=3000).map(|k| TrailerMoment::at(&PARTS, f64::from(k) / 3000.0, 30.0)).collect();
        for (index, part) in PARTS.iter().enumerate() {
            let of: Vec<&TrailerMoment> = all.iter().filter(|moment| moment.part == index).collect();
            let (first, last) = (of[0], of[of.len() - 1]);
            assert!(first.light < 0.02 && last.light < 0.02, "{index}: {first:?} {last:?}");
            assert!((first.time - part.span[0]).abs() < 0.05 && (last.time - part.span[1]).abs() < 0.05, "{index}: {first:?} {last:?}");
            assert!(of.iter().any(|moment| moment.light == 1.0) && of.iter().all(|moment| (0.0..=1.0).contains(&moment.light)));
        }
        assert!(all.windows(2).all(|pair| pair[0].part <= pair[1].part));
        // A fade takes 0.4 s: in 0.01 s no more than this.
        assert!(all.windows(2).all(|pair| (pair[1].light - pair[0].light).abs() < 0.05));
    }
}
