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

/// The trailer, in its order. Its usual length is the sum of the seconds.
pub const PARTS: [Part; 12] = [
    part(Place::Scene("disk"), [0.0, 6.0], 4.0, Camera::Hover([4.0, -34.0, 8.0], [-4.0, -23.0, 2.5]), 60.0, 0.1, "Nothing is hidden behind a black hole."),
    part(Place::Flight("03-through-the-disk"), [60.0, 66.0], 4.0, Camera::Director(Shot::Chase), 75.0, 0.5, ""),
    part(Place::Flight("03-through-the-disk"), [88.0, 94.0], 4.0, Camera::Director(Shot::Chase), 75.0, 0.5, ""),
    part(Place::Flight("04-the-ghost"), [100.0, 106.0], 4.0, Camera::Director(Shot::Chase), 75.0, 0.5, ""),
    part(Place::Scene("aurora-lensed"), [0.0, 12.0], 4.0, Camera::Own, 0.0, 0.5, ""),
    part(Place::Scene("chase"), [0.0, 2.0], 4.0, Camera::Planet([3.0, -1.2, 0.6], [2.2, -0.6, 0.9], [-15.0, 0.0, -3.0]), 70.0, 0.5, ""),
    part(Place::Scene("aurora-orbit"), [0.0, 2.0], 4.0, Camera::Own, 0.0, 0.5, ""),
    part(Place::Flight("10-no-way-back"), [58.0, 63.5], 4.0, Camera::Director(Shot::Chase), 80.0, 0.5, ""),
    part(Place::Scene("plunge"), [0.2, 1.6], 4.0, Camera::Own, 0.0, 0.5, ""),
    part(Place::Scene("galaxy-axis"), [0.0, 1.0], 4.0, Camera::Hover([7.0, 2.0, 15.0], [0.0, 0.0, 15.0]), 60.0, 0.5, ""),
    part(Place::Flight("02-first-pursuit"), [15.0, 21.0], 4.0, Camera::Director(Shot::Quarry), 75.0, 0.5, ""),
    part(Place::Flight("05-the-last-orbit"), [40.0, 46.0], 4.0, Camera::Director(Shot::Chase), 75.0, 0.5, ""),
];

/// The name, and what is written under it: at the end, over the last part.
pub const TITLE: [&str; 2] = ["LENSRUNNER", "What you see is where it was."];

const fn part(place: Place, span: [f64; 2], seconds: f64, camera: Camera, fov: f64, tension: f64, line: &'static str) -> Part {
    Part { place, span, seconds, camera, fov, tension, line }
}

/// Seconds in which a part comes out of black, and goes back.
const FADE: f64 = 0.4;
/// Seconds in which the last part goes to black.
const LAST_FADE: f64 = 1.2;
/// A fade takes at most this share of its part.
const FADE_SHARE: f64 = 0.3;

/// A moment of the trailer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
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

impl Moment {
    /// The moment at `share` (0 to 1) of a trailer of these parts, at least one, and of so many seconds.
    pub fn at(parts: &[Part], share: f64, seconds: f64) -> Moment {
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
        Moment { part: index, time: part.span[0] + (part.span[1] - part.span[0]) * share, share, light, is_last }
    }
}

/// From 0 to 1 without a kink.
pub fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
