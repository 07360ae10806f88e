//! The picture of the chart `flight`, from its sheet alone.

use super::measure::{ENERGY_LOST, LOST};
use super::methods::Method;
use crate::chart::{Provenance, Sheet, range};
use crate::plot::{Axis, Figure, Guide, Line, Lines, Panel, tick_text};

/// What each flight is, for its panels.
const FLIGHTS: [(&str, &str); 5] = [
    ("circle", "circle, r = 3 r_s, 20 turns"),
    ("eccentric", "p = 10 M, e = 0.5, 20 periods"),
    ("zoom-whirl", "p = 7.01 M, e = 0.5, 3 periods"),
    ("fall", "fall from rest, r = 5 to 0.1 r_s"),
    ("powered", "powered, r = 2.9 to 5.5 r_s"),
];

/// Errors are drawn no lower: rounding, and what the reference is good for.
const LEAST: f64 = 1e-16;
/// The phase error that the verdict asks for, rad.
const GOOD: f64 = 1e-6;

/// A row for each flight: E, L and phase against evaluations, phase against time.
pub fn draw(sheet: &Sheet) -> Figure {
    let flights: Vec<_> = FLIGHTS.iter().filter(|(name, _)| sheet.of([("flight", name)]).next().is_some()).collect();
    let panels = flights.iter().flat_map(|(name, title)| {
        [
            panel(sheet, name, title, "evaluations", "energy"),
            panel(sheet, name, title, "evaluations", "momentum"),
            panel(sheet, name, title, "evaluations", "phase"),
            panel(sheet, name, title, "time_over_game", "phase"),
        ]
    });
    Figure {
        verdict: verdict(sheet),
        title: "Integrators of matter: error against cost".into(),
        subtitle: format!(
            "A cross is where a method fails: a flight is lost if it is off by more than {LOST} of the distance from the hole at the end, or by more than {ENERGY_LOST} in energy. \
             r_s = c = 1; M = r_s/2. Time is in units of the game's at its own step of 1/32 r_s/c. Left of and below the others is better."
        ),
        panels: panels.collect(),
        columns: 4,
        size: [1900, 170 + 380 * flights.len() as u32],
        footer: Provenance::footer(&sheet.notes),
    }
}

fn panel(sheet: &Sheet, flight: &str, title: &str, cost: &str, error: &str) -> Panel {
    let line = |method: Method| {
        let name = method.name();
        let of_it = |failed: &str| {
            let rows = sheet.of([("flight", flight), ("method", name), ("failed", failed)]);
            let mut points: Vec<[f64; 2]> =
                rows.map(|row| [sheet.number(row, cost), sheet.number(row, error).clamp(LEAST, WORST)]).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            points
        };
        // Of those that fail the one that failed last.
        let points = of_it("0");
        let most = points.first().map_or(f64::INFINITY, |first| first[0]);
        let failed = of_it("1").into_iter().rfind(|point| point[0] < most);
        Line { name: method.name().into(), points, failed: failed.into_iter().collect(), dots: true }
    };
    let (x, own) = match cost {
        "evaluations" => ("evaluations", Vec::new()),
        _ => ("time, of the game's", vec![Guide { at: 1.0, label: "the game".into() }]),
    };
    let what = match error {
        "energy" => "error of E",
        "momentum" => "error of L, r_s c",
        _ => "error of phase, rad",
    };
    Panel::Lines(Lines {
        title: title.into(),
        x: Axis::log(x),
        y: Axis::log(what).between(LEAST, WORST),
        lines: Method::ALL.map(line).to_vec(),
        guides_x: own,
        ..Lines::default()
    })
}

/// Worse errors are drawn here.
const WORST: f64 = 10.0;

/// What each needs for a good phase beside DOP853 with error control, and how far the game is off.
fn verdict(sheet: &Sheet) -> String {
    let cost = |flight: &str, method: Method| {
        let rows = sheet.of([("flight", flight), ("method", method.name()), ("failed", "0")]);
        let good = rows.filter(|row| sheet.number(row, "phase") <= GOOD);
        good.map(|row| sheet.number(row, "evaluations")).fold(f64::NAN, f64::min)
    };
    let range = |method: Method| {
        let [least, most] = range(FLIGHTS.iter().map(|(flight, _)| cost(flight, method) / cost(flight, Method::Dop853)));
        format!("{} {least:.1} to {most:.1}", method.name())
    };
    let own = sheet.of([("own", "1")]).map(|row| sheet.number(row, "phase"));
    let others = [Method::Dopri5, Method::Rk4, Method::Split4, Method::Game].map(range).join(", ");
    format!(
        "A phase to {} rad takes so many times the evaluations of DOP853 with error control: {others}; at its own step the game is off by at \
         most {:.0e} rad",
        tick_text(GOOD),
        own.fold(0.0, f64::max)
    )
}
