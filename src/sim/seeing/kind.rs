//! What can be pointed at.

use glam::DVec3;

/// A phenomenon on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Phenomenon {
    /// The shadow of the hole. Number: its angular radius over that of a ball of radius r_s at that distance in flat space, both for who
    /// hovers; None at and under the horizon.
    Shadow,
    /// Light that has gone round the hole, just outside the edge of the shadow. Number: the angle that it swept, in turns.
    PhotonRing,
    /// The disk's far side, lifted over the shadow. Number: radius of the gas, in r_s.
    DiskFarSide,
    /// The disk's other face, in its second image. Number: radius of the gas, in r_s.
    DiskUnderside,
    /// Where the disk's light is bluest. Number: g > 1.
    BlueSide,
    /// Where the disk's light is reddest. Number: g < 1.
    RedSide,
    /// The target, behind the hole, drawn out to a ring. Number: angle on the screen from the middle of the shadow, in rad.
    EinsteinRing,
    /// The target's image of order 2. Number: age of its light, in r_s/c.
    SecondImage,
    /// Sky where the camera's motion crowds the stars. Number: the factor by which it shrinks angles there.
    Aberration,
    /// Where the target really is now. No number.
    TrueTarget,
    /// Where the target is seen. Number: age of its light, in r_s/c.
    TargetImage,
}

impl Phenomenon {
    /// All of them, in their order.
    pub const ALL: [Phenomenon; 11] = [
        Phenomenon::Shadow,
        Phenomenon::PhotonRing,
        Phenomenon::DiskFarSide,
        Phenomenon::DiskUnderside,
        Phenomenon::BlueSide,
        Phenomenon::RedSide,
        Phenomenon::EinsteinRing,
        Phenomenon::SecondImage,
        Phenomenon::Aberration,
        Phenomenon::TrueTarget,
        Phenomenon::TargetImage,
    ];

    /// Its name in files of words; never changes.
    pub const fn key(self) -> &'static str {
        match self {
            Phenomenon::Shadow => "shadow",
            Phenomenon::PhotonRing => "photon-ring",
            Phenomenon::DiskFarSide => "disk-far-side",
            Phenomenon::DiskUnderside => "disk-underside",
            Phenomenon::BlueSide => "blue-side",
            Phenomenon::RedSide => "red-side",
            Phenomenon::EinsteinRing => "einstein-ring",
            Phenomenon::SecondImage => "second-image",
            Phenomenon::Aberration => "aberration",
            Phenomenon::TrueTarget => "true-target",
            Phenomenon::TargetImage => "target-image",
        }
    }
}

/// A sight and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// What is there.
    pub sight: Phenomenon,
    /// Where it is seen: a unit vector in camera axes (−z forward).
    pub direction: DVec3,
    /// See [`Phenomenon`] for what it counts.
    pub number: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_distinct_and_in_the_order_of_the_sights() {
        let keys: std::collections::BTreeSet<&str> = Phenomenon::ALL.iter().map(|sight| sight.key()).collect();
        assert_eq!(keys.len(), Phenomenon::ALL.len());
        assert!(Phenomenon::ALL.is_sorted());
    }
}
