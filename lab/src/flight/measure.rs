//! Errors and times of every method on every flight.

use lensrunner::spacetime::matter::{ShipState, angular_momentum, energy};

use super::FlightRequest;
use super::cases::{self, FlightCase};
use super::methods::{Effort, Flown, Method, fly};
use super::truth::{self, Polar};
use crate::chart::{ChartError, Sheet, interleaved_by, thread_time};

/// The game's step, r_s/c (`clock.step`).
pub const GAME_STEP: f64 = 1.0 / 32.0;
/// A flight has failed whose place is off by more than this share of its distance from the hole, at the end.
pub const LOST: f64 = 0.1;
/// Or whose energy per mass was off by more than this at any moment.
pub const ENERGY_LOST: f64 = 0.01;

/// How far a flight is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Greatest error of E, of all moments.
    pub energy: f64,
    /// Greatest error of L, in r_s c.
    pub momentum: f64,
    /// Of the place at the end, as a share of its distance from the hole: on an orbit radians of phase.
    pub phase: f64,
}

impl Errors {
    /// Of a flight.
    pub fn of(flown: &Flown, truth: &[Polar]) -> Errors {
        let worst = |error: &dyn Fn(&ShipState, &Polar) -> f64| {
            let all = flown.states.iter().zip(truth).map(|(state, truth)| error(state, truth));
            all.fold(0.0, |worst: f64, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) })
        };
        let phase = match (flown.states.last(), truth.last()) {
            (Some(state), Some([r, phi, ..])) => {
                let off = (state.position.x - r * phi.cos()).hypot(state.position.y - r * phi.sin()) / r;
                if off.is_nan() { f64::INFINITY } else { off }
            }
            _ => f64::INFINITY,
        };
        Errors {
            energy: worst(&|state, truth| (energy(state) - truth::energy(*truth)).abs()),
            momentum: worst(&|state, truth| (angular_momentum(state).z - truth[3]).abs()),
            phase,
        }
    }

    /// Whether the flight is lost.
    pub fn failed(&self) -> bool {
        !(self.phase <= LOST && self.energy <= ENERGY_LOST)
    }
}

/// Efforts of a method: steps halved again and again, or tolerances.
fn efforts(method: Method, case: &FlightCase) -> Vec<Effort> {
    if method.is_adaptive() {
        return (2..=14).map(|digits| Effort::Tolerance(10f64.powi(-digits))).collect();
    }
    let mut all: Vec<Effort> = (0..18).map(|halvings| Effort::Steps(1 << halvings)).collect();
    if method == Method::Game {
        all.push(own(case));
    }
    all
}

/// The game's own step, as near as the moments allow.
fn own(case: &FlightCase) -> Effort {
    Effort::Steps((case.segment() / GAME_STEP).ceil() as u32)
}

/// `effort`: the step in r_s/c, or the tolerance; `step`: the mean step that came of it.
const COLUMNS: [&str; 12] =
    ["flight", "method", "effort", "own", "step", "evaluations", "time_ms", "time_over_game", "energy", "momentum", "phase", "failed"];

/// A row for each method, flight and effort.
pub fn measure(request: &FlightRequest) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(&COLUMNS, "");
    for case in cases::all()? {
        eprintln!("{}", case.name);
        let truth = case.truth();
        let mut flown: Vec<(Method, Effort, Flown)> = Vec::new();
        for method in Method::ALL {
            // Each effort takes more than the one before, but for the game's own step, the last.
            let mut over = false;
            for effort in efforts(method, &case) {
                let is_own = method == Method::Game && effort == own(&case);
                if over && !is_own {
                    continue;
                }
                let flight = fly(method, &case, effort);
                over = flight.evaluations > request.evaluations;
                if !over || is_own {
                    flown.push((method, effort, flight));
                }
            }
        }
        let mut runs: Vec<_> = flown
            .iter()
            .map(|&(method, effort, _)| {
                let case = &case;
                move || drop(std::hint::black_box(fly(method, case, effort)))
            })
            .collect();
        let mut contestants: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run as &mut dyn FnMut()).collect();
        let times = interleaved_by(thread_time, &mut contestants, request.rounds);
        let game = flown.iter().position(|(method, effort, _)| *method == Method::Game && *effort == own(&case));
        let game = game.map_or(f64::NAN, |place| times[place].median);
        for ((method, effort, flight), time) in flown.iter().zip(&times) {
            let errors = Errors::of(flight, &truth);
            let told = match effort {
                Effort::Steps(steps) => format!("{:.6}", case.segment() / f64::from(*steps)),
                Effort::Tolerance(tolerance) => format!("{tolerance:e}"),
            };
            let [own, failed] = [*method == Method::Game && *effort == own(&case), errors.failed()].map(u8::from);
            let (step, [time, over]) = (case.span / flight.steps.max(1) as f64, [1e3 * time.median, time.median / game]);
            let Errors { energy, momentum, phase } = errors;
            let (name, method, evaluations) = (case.name, method.name(), flight.evaluations);
            sheet.line(format_args!(
                "{name}|{method}|{told}|{own}|{step:.6}|{evaluations}|{time:.4}|{over:.4}|{energy:.3e}|{momentum:.3e}|{phase:.3e}|{failed}"
            ));
        }
    }
    Ok(sheet)
}

/// Of each method and flight the longest mean step that holds and the shortest that fails, in r_s/c; of adaptive ones also the tolerances.
pub fn limits(sheet: &Sheet) -> Sheet {
    let mut limits = Sheet::new(&["flight", "method", "holds", "holds_effort", "fails", "fails_effort"]);
    limits.notes = sheet.notes.clone();
    let mut seen: Vec<[&str; 2]> = sheet.rows.iter().map(|row| [sheet.text(row, "flight"), sheet.text(row, "method")]).collect();
    seen.dedup();
    for [flight, method] in seen {
        // From the finest on: the first that fails.
        let mut from_finest: Vec<_> = sheet.of([("flight", flight), ("method", method), ("own", "0")]).collect();
        from_finest.sort_by(|a, b| sheet.number(a, "effort").total_cmp(&sheet.number(b, "effort")));
        let place = from_finest.iter().position(|row| sheet.text(row, "failed") == "1");
        let cells = |row: Option<&&Vec<String>>| match row {
            Some(row) => [sheet.text(row, "step"), sheet.text(row, "effort")].map(str::to_owned),
            None => ["none", "none"].map(str::to_owned),
        };
        let holds = place.map_or(from_finest.last(), |place| place.checked_sub(1).and_then(|before| from_finest.get(before)));
        let fails = place.and_then(|place| from_finest.get(place));
        limits.push([flight, method].map(str::to_owned).into_iter().chain(cells(holds)).chain(cells(fails)));
    }
    limits
}
