//! The numbers of the HUD: what a pilot reads, from the ships' states. The only place where r_s becomes kilometres.

use crate::play::session::Session;
use crate::play::words::Language;
use crate::spacetime::matter::{ShipState, far_clock_rate, gamma, static_speed, velocity};
use crate::spacetime::orbit::lowest_radius;

/// GM☉/c², half of r_s per solar mass, in metres (IAU 2015 nominal GM☉ = 1.3271244e20 m³/s²).
const HALF_RS_PER_SUN: f64 = 1476.625;
/// The speed of light, in m/s (exact).
const LIGHT_SPEED: f64 = 299_792_458.0;
/// Standard gravity, in m/s² (exact).
const STANDARD_GRAVITY: f64 = 9.80665;

/// What one r_s is for a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// r_s in metres.
    pub metres: f64,
    /// The language of its words.
    pub language: Language,
}

impl Scale {
    /// That of the hole of a session, in its language.
    pub fn of(session: &Session) -> Scale {
        Scale::new(session.config.hole.mass_solar, session.language())
    }

    /// Of a hole with this mass, in solar masses.
    pub fn new(mass_solar: f64, language: Language) -> Scale {
        Scale { metres: 2.0 * HALF_RS_PER_SUN * mass_solar, language }
    }

    /// A length of `r` r_s in words: `265.8 bn km`.
    pub fn kilometres(&self, r: f64) -> String {
        let km = r * self.metres * 1e-3;
        let english = [(1e12, "unit-trillion-km"), (1e9, "unit-billion-km"), (1e6, "unit-million-km"), (1e3, "unit-thousand-km")];
        // Japanese counts by ten thousands.
        let japanese = [(1e12, "unit-trillion-km"), (1e8, "unit-hundred-million-km"), (1e4, "unit-ten-thousand-km")];
        let sizes = if self.language == Language::Japanese { &japanese[..] } else { &english[..] };
        sizes.iter().find(|(size, _)| km.abs() >= *size).map_or_else(
            || format!("{km:.0} km"),
            |(size, key)| self.language.fill(key, &[("value", format!("{:.1}", km / size).as_str())]),
        )
    }

    /// A time of `t` r_s/c in words: `12 d 03:45:10`.
    pub fn clock(&self, t: f64) -> String {
        let seconds = t * self.metres / LIGHT_SPEED;
        if seconds <= -60.0 {
            return format!("−{}", self.clock(-t));
        }
        if seconds < 60.0 {
            return format!("{seconds:.3} s");
        }
        let whole = seconds as u64;
        let (days, hours, minutes) = (whole / 86_400, whole / 3600 % 24, whole / 60 % 60);
        let clock = format!("{hours:02}:{minutes:02}:{:02}", whole % 60);
        self.language.fill("unit-days-and", &[("days", days.to_string().as_str()), ("clock", clock.as_str())])
    }

    /// A time of `t` r_s/c in words and round numbers: `456 days`, `55 hours`.
    pub fn span(&self, t: f64) -> String {
        let seconds = t * self.metres / LIGHT_SPEED;
        let sizes = [(86_400.0, "unit-days"), (3600.0, "unit-hours"), (60.0, "unit-minutes")];
        // Five of a size at least.
        let fits = sizes.iter().find(|(size, _)| seconds >= 5.0 * size);
        let short = || if seconds >= 0.1 { format!("{seconds:.1} s") } else { format!("{:.4} ms", 1e3 * seconds) };
        fits.map_or_else(short, |(size, key)| self.language.fill(key, &[("value", format!("{:.0}", seconds / size).as_str())]))
    }

    /// A proper acceleration (c²/r_s) in g.
    pub fn gees(&self, acceleration: f64) -> f64 {
        acceleration * LIGHT_SPEED * LIGHT_SPEED / self.metres / STANDARD_GRAVITY
    }
}

/// The target, as measured on the slice T = const.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing {
    /// Distance, in r_s.
    pub range: f64,
    /// How fast the distance shrinks, in c of T.
    pub closing: f64,
    /// Its own clock τ, in r_s/c.
    pub clock: f64,
    /// g = ν_observed/ν_emitted of its light, where that arrives.
    pub shift: Option<f64>,
}

impl Bearing {
    /// From `own` to `target` at the same T.
    pub fn between(own: &ShipState, target: &ShipState) -> Bearing {
        let apart = target.position - own.position;
        let range = apart.length();
        let parting = (velocity(target) - velocity(own)).dot(apart) / range.max(1e-9);
        Bearing { range, closing: -parting, clock: target.proper_time, shift: None }
    }
}

/// Everything on the dials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instruments {
    /// Against a hovering observer, in c; None inside the horizon, where none exists.
    pub speed: Option<f64>,
    /// Against space as it falls in (the rain), in c.
    pub rain_speed: f64,
    /// r of the ship, in r_s.
    pub radius: f64,
    /// L of the camera, in r_s.
    pub camera_radius: f64,
    /// The lowest r of the fall without thrust, in r_s; None where it ends in the hole.
    pub lowest: Option<f64>,
    /// The ship's own clock τ, in r_s/c.
    pub own_time: f64,
    /// The far clock T, in r_s/c.
    pub far_time: f64,
    /// How fast a far clock goes against the ship's; None inside the horizon.
    pub far_rate: Option<f64>,
    /// Proper acceleration, c²/r_s.
    pub acceleration: f64,
    /// Left in the tanks: a share of 1; None for tanks without limit.
    pub fuel: Option<f64>,
    /// The change of velocity that is left, in c.
    pub fuel_left: f64,
    /// Where the target is, if there is one.
    pub target: Option<Bearing>,
}

impl Instruments {
    /// Reads them for a ship in `state` at T = `time` that accelerates by `thrust` (c²/r_s) with `fuel` of `capacity` (c).
    pub fn read(
        state: &ShipState,
        time: f64,
        camera_radius: f64,
        thrust: f64,
        fuel: (f64, f64),
        target: Option<&ShipState>,
    ) -> Instruments {
        let (left, capacity) = fuel;
        Instruments {
            speed: static_speed(state),
            rain_speed: state.momentum.length() / gamma(state.momentum),
            radius: state.position.length(),
            camera_radius,
            lowest: lowest_radius(state),
            own_time: state.proper_time,
            far_time: time,
            far_rate: far_clock_rate(state),
            acceleration: if left > 0.0 { thrust } else { 0.0 },
            fuel: (capacity.is_finite() && capacity > 0.0).then(|| (left / capacity).clamp(0.0, 1.0)),
            fuel_left: left,
            target: target.map(|target| Bearing::between(state, target)),
        }
    }
}

/// The time for the chase, in r_s/c of T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Countdown {
    /// What is left of it.
    pub left: f64,
    /// All of it.
    pub limit: f64,
}

impl Countdown {
    /// At T = `time` in a chase that is lost at T = `limit`.
    pub fn at(time: f64, limit: f64) -> Countdown {
        Countdown { left: (limit - time).clamp(0.0, limit.max(0.0)), limit }
    }

    /// The share that is left, of 1.
    pub fn share(&self) -> f64 {
        if self.limit > 0.0 { self.left / self.limit } else { 0.0 }
    }

    /// Whether it is the last tenth.
    pub fn late(&self) -> bool {
        self.share() <= 0.1
    }
}

/// How long the target has been held, of what a catch needs, both in r_s/c: `0.8 / 2.0`.
pub fn hold_numbers(held: f64, needed: f64) -> String {
    // Rounded down: what reads as held is held.
    let tenths = |time: f64| (time * 10.0 + 1e-9).floor() / 10.0;
    format!("{:.1} / {needed:.1}", tenths(held.min(needed)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::orbit::{circular_orbit, static_momentum};
    use glam::DVec3;

    #[test]
    fn a_hovering_ship_has_no_speed_and_a_slow_clock() {
        let x = DVec3::new(0.0, 2.0, 0.0);
        let state = ShipState::new(x, static_momentum(x).expect("outside"));
        let read = Instruments::read(&state, 5.0, 2.1, 0.02, (1.0, 4.0), None);
        assert!(read.speed.expect("outside") < 1e-6);
        assert!((read.far_rate.expect("outside") - 2f64.sqrt()).abs() < 1e-12);
        assert_eq!((read.fuel, read.acceleration), (Some(0.25), 0.02));
        assert_eq!(Instruments::read(&state, 5.0, 2.1, 0.02, (0.0, 4.0), None).acceleration, 0.0);
    }

    #[test]
    fn range_and_closing_speed() {
        let own = ShipState::new(DVec3::X * 100.0, DVec3::ZERO);
        let mut target = own;
        target.position = DVec3::X * 103.0;
        // Both fall with the rain at r^-1/2: the outer falls slower, so they part.
        let bearing = Bearing::between(&own, &target);
        assert_eq!(bearing.range, 3.0);
        assert!((bearing.closing - (103f64.powf(-0.5) - 0.1)).abs() < 1e-12);
    }

    #[test]
    fn the_inside_has_no_hovering_observer() {
        let read = Instruments::read(&ShipState::new(DVec3::X * 0.5, DVec3::ZERO), 1.0, 0.5, 0.0, (1.0, f64::INFINITY), None);
        assert_eq!((read.speed, read.far_rate, read.fuel), (None, None, None));
    }

    #[test]
    fn a_circular_orbit_keeps_its_range() {
        let a = circular_orbit(8.0, 0.0).expect("outside 1.5");
        assert!(Bearing::between(&a, &ShipState::new(DVec3::ZERO.with_z(1e-3) + a.position, a.momentum)).closing.abs() < 1e-3);
    }

    #[test]
    fn units_for_people() {
        // A hole of 10^10 suns: r_s = 2.953e13 m.
        let scale = Scale::new(1e10, Language::English);
        assert_eq!(scale.kilometres(9.0), "265.8 bn km");
        assert_eq!(Scale::new(1.0, Language::English).kilometres(2.0), "6 km");
        // r_s/c = 98,509.8 s = 1 d 03:21:49.
        assert_eq!(scale.clock(1.0), "1 d 03:21:49");
        assert_eq!([1.0, 2.0, 400.0].map(|t| scale.span(t)), ["27 hours", "55 hours", "456 days"]);
        assert_eq!(Scale::new(10.0, Language::English).span(1.0), "0.0985 ms");
        // c²/r_s = 3,043.3 m/s².
        assert!((scale.gees(1.0) - 310.3).abs() < 0.1, "{}", scale.gees(1.0));
    }

    #[test]
    fn the_last_tenth_is_late() {
        let begin = Countdown::at(0.0, 400.0);
        assert_eq!((begin.left, begin.share(), begin.late()), (400.0, 1.0, false));
        assert!(!Countdown::at(359.0, 400.0).late());
        let late = Countdown::at(361.0, 400.0);
        assert!(late.late() && late.left == 39.0, "{late:?}");
        let over = Countdown::at(500.0, 400.0);
        assert_eq!((over.left, over.share(), over.late()), (0.0, 0.0, true));
    }

    #[test]
    fn a_hold_is_said_with_what_it_needs() {
        assert_eq!(hold_numbers(0.84, 2.0), "0.8 / 2.0");
        // One step of 1/32 short of the end is not the end.
        assert_eq!(hold_numbers(1.96875, 2.0), "1.9 / 2.0");
        assert_eq!(hold_numbers(3.0, 2.0), "2.0 / 2.0");
    }
}
