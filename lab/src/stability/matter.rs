//! Matter: flights by integrators of equal steps at the game's own step, by adaptive ones at a tolerance, beside the reference.

use glam::DVec3;
use lensrunner::spacetime::matter::ShipState;
use lensrunner::spacetime::orbit::{Elements, OrbitError};

use super::Finding;
use crate::flight::cases::{self, FlightCase};
use crate::flight::measure::{Errors, GAME_STEP};
use crate::flight::methods::{Effort, Method, fly};
use crate::flight::truth::Drive;

/// Half a pixel at 1920 pixels over 60°, as a share of the distance from the hole.
const LIMIT: f64 = 2.7e-4;
/// Error of a step of the adaptive methods.
const TOLERANCE: f64 = 1e-9;
/// Radial periods of an eccentric orbit that make a million of the game's steps.
const MILLION: f64 = 31_250.0;

struct Place {
    name: &'static str,
    case: FlightCase,
    /// Steps of the methods of equal steps, in r_s/c.
    step: f64,
}

fn places() -> Result<Vec<Place>, OrbitError> {
    let coasting = Drive::default();
    let own = |name, case| Place { name, case, step: GAME_STEP };
    let case = |start, span, drive| FlightCase { name: "", start, span, drive };
    let flight = |name: &str| Ok::<_, OrbitError>(cases::all()?.into_iter().find(|case| case.name == name));
    let at = |x: f64, p: f64| ShipState::new(DVec3::X * x, DVec3::X * p);
    let mut all = Vec::new();
    let named = [
        ("ISCO: circle at 3 r_s, 20 turns", "circle"),
        ("zoom-whirl: p = 3.505 r_s, e = 0.5", "zoom-whirl"),
        ("plunge: from rest at 5 r_s through the horizon to 0.1 r_s", "fall"),
        ("powered flight, 800 r_s/c", "powered"),
    ];
    for (place, name) in named {
        all.extend(flight(name)?.map(|case| own(place, case)));
    }
    all.push(own("unstable circle at 2 r_s, 100 r_s/c: errors grow 10⁷-fold", case(Elements::circle(2.0, 0.0).state()?, 100.0, coasting)));
    all.push(own("boost to γ = 10⁶, outwards from 5 r_s", case(at(5.0, 1e6), 100.0, coasting)));
    all.push(own("boost to γ = 10⁶, inwards from 5 r_s", case(at(5.0, -1e6), 2.6, coasting)));
    all.push(own("thrust of 0.5 c²/r_s outwards at the horizon", case(at(1.0, 0.0), 0.6, Drive { thrust: 0.5, turning: 0.0 })));
    all.push(own("thrust of 50 c²/r_s outwards inside, at 0.8 r_s", case(at(0.8, 0.0), 0.3, Drive { thrust: 50.0, turning: 0.0 })));
    let circle = Elements::circle(3.0, 0.0).state()?;
    all.push(Place { name: "steps too large: 10 r_s/c at 3 r_s", case: case(circle, 160.0, coasting), step: 10.0 });
    let eccentric = flight("eccentric")?.map(|case| own("10⁶ steps: p = 5 r_s, e = 0.5", FlightCase { span: MILLION, ..case }));
    all.extend(eccentric);
    Ok(all)
}

/// A finding for each method and place.
pub fn measure() -> Result<Vec<Finding>, OrbitError> {
    let mut found = Vec::new();
    for place in places()? {
        let truth = place.case.truth();
        for method in Method::ALL {
            let steps = (place.case.segment() / place.step).ceil() as u32;
            let effort = if method.is_adaptive() { Effort::Tolerance(TOLERANCE) } else { Effort::Steps(steps.max(1)) };
            let phase = Errors::of(&fly(method, &place.case, effort), &truth).phase;
            found.push(Finding {
                part: "matter",
                place: place.name,
                method: method.name().to_owned(),
                ours: method == Method::Game,
                // A method that gave up has no place.
                value: if phase.is_finite() { phase } else { f64::NAN },
                unit: "of r",
                limit: LIMIT,
            });
        }
    }
    Ok(found)
}
