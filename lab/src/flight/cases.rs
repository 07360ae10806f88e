//! What is flown. Lengths in r_s, times in r_s/c. The half-parameter p of an orbit is often given in M = r_s/2: "p = 10, e = 0.5" is
//! p = 5 r_s here.

use glam::DVec3;
use lensrunner::spacetime::matter::ShipState;
use lensrunner::spacetime::orbit::{Elements, OrbitError, orbital_frequency, static_momentum};

use super::truth::{Drive, Polar, later};

/// Moments of a flight at which it is held against the reference, evenly spread, the last at its end.
pub const MOMENTS: usize = 16;

/// One flight.
#[derive(Clone, Debug)]
pub struct FlightCase {
    /// What it is called.
    pub name: &'static str,
    /// The state at T = 0, in the plane z = 0.
    pub start: ShipState,
    /// How long it lasts, in r_s/c.
    pub span: f64,
    /// What drives it.
    pub drive: Drive,
}

impl FlightCase {
    /// T between two moments.
    pub fn segment(&self) -> f64 {
        self.span / MOMENTS as f64
    }

    /// The start as the reference has it.
    pub fn polar(&self) -> Polar {
        let (x, p) = (self.start.position, self.start.momentum);
        let r = x.length();
        [r, x.y.atan2(x.x), x.dot(p) / r, x.cross(p).z, 0.0, 0.0]
    }

    /// The reference at each of the moments.
    pub fn truth(&self) -> Vec<Polar> {
        let mut now = self.polar();
        let next = |_| {
            now = later(now, self.segment(), self.drive);
            now
        };
        (0..MOMENTS).map(next).collect()
    }
}

/// The radial period of an orbit with p = 10 M and e = 0.5, r_s/c.
pub const ECCENTRIC_PERIOD: f64 = 433.900_542_311_5 / 2.0;
/// That of one with p = 7.01 M and e = 0.5, which whirls 4.8 times round the hole in each.
const WHIRL_PERIOD: f64 = 513.010_399_630_2 / 2.0;
/// Where the fall begins, at rest, in r_s.
pub const DROP: f64 = 5.0;

/// All of them.
pub fn all() -> Result<Vec<FlightCase>, OrbitError> {
    let orbit = |semi_latus_rectum, eccentricity| {
        let apoapsis = std::f64::consts::PI;
        Elements { semi_latus_rectum, eccentricity, inclination: 0.0, node: 0.0, phase: 0.0, anomaly: apoapsis }.state()
    };
    let circle = |radius: f64, turns: f64| turns * std::f64::consts::TAU / orbital_frequency(radius);
    let coasting = Drive::default();
    let drop = DVec3::new(DROP, 0.0, 0.0);
    Ok(vec![
        FlightCase { name: "circle", start: Elements::circle(3.0, 0.0).state()?, span: circle(3.0, 20.0), drive: coasting },
        FlightCase { name: "eccentric", start: orbit(5.0, 0.5)?, span: 20.0 * ECCENTRIC_PERIOD, drive: coasting },
        FlightCase { name: "zoom-whirl", start: orbit(3.505, 0.5)?, span: 3.0 * WHIRL_PERIOD, drive: coasting },
        FlightCase {
            name: "fall",
            start: ShipState::new(drop, static_momentum(drop).unwrap_or_default()),
            // Until r = 0.1.
            span: FALL,
            drive: coasting,
        },
        // Stays between 2.9 and 5.5 r_s.
        FlightCase {
            name: "powered",
            start: Elements::circle(5.0, 0.0).state()?,
            span: 800.0,
            drive: Drive { thrust: 0.003, turning: -0.1 },
        },
    ])
}

/// T of the fall from rest at [`DROP`] to r = 0.1 within a hundredth, in r_s/c.
pub const FALL: f64 = 18.46;
