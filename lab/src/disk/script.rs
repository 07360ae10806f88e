//! The scripted chase of table 2 of Yamashita 2025: one flight through all situations, the same for every row.

use glam::DVec3;
use lensrunner::spacetime::Observer;

use super::request::eye;

/// A place on the way.
struct Stop {
    /// When, as a share of the whole time.
    share: f64,
    /// Where, on the slice, in r_s.
    position: [f64; 3],
    /// How far the look is turned from the hole (0) to where the gas flows (1).
    aside: f64,
}

const fn stop(share: f64, position: [f64; 3], aside: f64) -> Stop {
    Stop { share, position, aside }
}

/// Within the inner edge the hole fills what lies inwards: there the look goes along the orbit. From far, in through the inner edge, out
/// over the disk, slowly down through it, and away below. Time inside the edge and in the plane is more than an eighth of the whole each,
/// so that eight places along the way miss neither.
const WAY: [Stop; 9] = [
    stop(0.0, [0.0, -26.0, 6.0], 0.0),
    stop(0.25, [2.0, -12.0, 3.0], 0.0),
    stop(0.4, [1.4, -2.55, 0.6], 0.7),
    stop(0.47, [1.5, -1.2, 0.35], 0.8),
    stop(0.55, [2.6, -1.4, 0.3], 0.7),
    stop(0.715, [8.0, 5.0, 0.25], 0.6),
    stop(0.73, [8.1, 5.2, 0.02], 0.6),
    stop(0.86, [8.4, 5.8, -0.02], 0.6),
    stop(1.0, [14.0, 14.0, -6.0], 0.0),
];
/// T at the start and how long the flight takes, in r_s/c: a tenth of a turn of the gas at its outer edge.
const TIMES: [f64; 2] = [100.0, 60.0];
/// Nearer to the plane than this the flight is crossing the disk, in r_s.
pub const CROSSING: f64 = 0.05;
/// Nearer than this it skims over it, in r_s.
const SKIMMING: f64 = 0.7;

/// Where the eye is and T, at a share from 0 to 1 of the way, and what it passes through: said of the place itself, with the disk's inner
/// edge in r_s.
pub fn script(share: f64, inner: f64) -> (Observer, f64, &'static str) {
    let share = share.clamp(0.0, 1.0);
    let leg = WAY.windows(2).position(|leg| share <= leg[1].share).unwrap_or(WAY.len() - 2);
    let [from, to] = [&WAY[leg], &WAY[leg + 1]];
    let part = (share - from.share) / (to.share - from.share);
    let position = DVec3::from(from.position).lerp(to.position.into(), part);
    let aside = from.aside + part * (to.aside - from.aside);
    let inward = -position.normalize();
    let along = DVec3::Z.cross(position).normalize();
    (eye(position, inward.lerp(along, aside)), TIMES[0] + share * TIMES[1], situation(position, inner))
}

fn situation(position: DVec3, inner: f64) -> &'static str {
    if position.length() < inner {
        "inside the inner edge"
    } else if position.z.abs() <= CROSSING {
        "crossing"
    } else if position.z < 0.0 {
        "below"
    } else if position.z < SKIMMING {
        "skimming"
    } else {
        "from far"
    }
}
