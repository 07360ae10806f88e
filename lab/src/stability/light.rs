//! Light: directions and delays of methods of projection, beside the judge's integration.

use std::f64::consts::PI;

use lensrunner::judge;
use lensrunner::lensing::methods::ProjectionInput;
use lensrunner::spacetime::light::{self, Branch, Order, SweepEnd};
use rayon::prelude::*;

use super::Finding;
use crate::projection::methods::{self, Method};

/// Half a pixel at 3840 pixels over 60°.
const HALF_A_PIXEL: f64 = 0.008;
/// Error of each step of the judge, relative to r.
const TOLERANCE: f64 = 1e-15;
/// Nearest to the horizon that a camera outside looks at, in r_s: the tables' end.
const LOWEST: f64 = 1.0005;

/// Methods set side by side, the game's first. The last but two are its rivals' best; the quick list leaves out what must be baked.
const METHODS: [&str; 6] = ["table", "exact", "rk4-256", "paper1-128", "beloborodov", "flat"];
/// Of those, what the game draws with.
const OURS: &str = "table";
/// Baked at first use: 64 MiB.
const LARGE: &str = "paper1-128";

/// A point seen by a camera.
#[derive(Clone, Copy, Debug)]
struct Ask {
    input: ProjectionInput,
    order: Order,
    branch: Branch,
}

/// A place where methods fail.
struct Place {
    name: &'static str,
    asks: Vec<Ask>,
    delays: bool,
}

fn ask(r: f64, phi: f64, camera: f64, order: Order) -> Ask {
    Ask { input: ProjectionInput { r, phi, camera }, order, branch: Branch::Plus }
}

/// 10^-k.
fn tenth(k: i32) -> f64 {
    10f64.powi(-k)
}

/// All orders of each of these.
fn in_orders(rows: impl IntoIterator<Item = [f64; 3]>) -> Vec<Ask> {
    rows.into_iter().flat_map(|[r, phi, l]| Order::ALL.map(|order| ask(r, phi, l, order))).collect()
}

/// Points where rays end that leave the camera at the critical slope times 1 ± 10^-k.
fn critical() -> Vec<Ask> {
    let mut asks = Vec::new();
    for l in [1.2, 1.6, 3.0, 10.0, 1000.0] {
        let u: f64 = 1.0 / l;
        let slope = (2.0 / 3.0 - u) * (u + 1.0 / 3.0).sqrt();
        for (k, side) in (1..=6).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
            for (order, phi) in Order::ALL.into_iter().flat_map(|order| [0.3, 1.5, 2.9].map(|phi| (order, phi))) {
                if let SweepEnd::At { u: end, .. } = light::follow(u, slope * (1.0 + side * tenth(k)), order.swept(phi))
                    && (LOWEST..1e4).contains(&(1.0 / end))
                {
                    asks.push(ask(1.0 / end, phi, l, order));
                }
            }
        }
    }
    asks
}

/// Offsets in all directions in the plane, so far that the point is `share` of the camera's radius away.
fn around(camera: f64, share: f64) -> impl Iterator<Item = [f64; 3]> {
    (1..12).map(move |k| {
        let (sin, cos) = (PI * f64::from(k) / 12.0).sin_cos();
        let (along, across) = (camera * (1.0 + share * cos), camera * share * sin);
        [along.hypot(across), across.atan2(along), camera]
    })
}

/// Two points inside by light of either sign of E, at shares of the greatest angle that light sweeps between their radii.
fn both_signs(camera: f64) -> impl Iterator<Item = Ask> {
    let turned = |r: f64| (1.0 - 2.0 * r).acos();
    let shares = [0.3, 0.7].into_iter().flat_map(|up| [0.2, 0.7].map(|around| (up, around)));
    shares.flat_map(move |(up, around)| {
        let r = camera + up * (1.0 - camera);
        let phi = around * (turned(r) - turned(camera));
        [Branch::Plus, Branch::Minus].map(|branch| Ask { branch, ..ask(r, phi, camera, Order::ALL[0]) })
    })
}

fn places() -> Vec<Place> {
    let place = |name, asks| Place { name, asks, delays: false };
    let sides = |k: i32| [1.0 + tenth(k), 1.0 - tenth(k)];
    let angles = [0.3, 1.5, 2.9];
    let far: Vec<_> = [3.0, 5000.0].iter().flat_map(|l| angles.map(|phi| [1e4, phi, *l])).collect();
    vec![
        place("critical ray: b/b_c = 1 ± 10⁻¹ … 10⁻⁶", critical()),
        place(
            "photon sphere: camera at 1.5 r_s (1 ± 10⁻² … 10⁻⁸)",
            in_orders((2..=8).flat_map(sides).flat_map(|x| angles.map(|phi| [6.0, phi, 1.5 * x]))),
        ),
        place(
            "photon sphere: point at 1.5 r_s (1 ± 10⁻² … 10⁻⁸)",
            in_orders((2..=8).flat_map(sides).flat_map(|x| angles.map(|phi| [1.5 * x, phi, 10.0]))),
        ),
        place(
            "horizon: camera outside by 10⁻¹ … 10⁻⁸ r_s",
            in_orders((1..=8).flat_map(|k| [1.2, 3.0, 100.0].map(|r| [r, 1.5, 1.0 + tenth(k)]))),
        ),
        place(
            "horizon: camera inside by 10⁻¹ … 10⁻⁸ r_s",
            in_orders((1..=8).flat_map(|k| [1.2, 3.0, 100.0].map(|r| [r, 1.5, 1.0 - tenth(k)]))),
        ),
        place(
            "inside: camera at 0.9 … 0.1 r_s, point outside",
            in_orders((1..=9).flat_map(|k| [1.5, 10.0].map(|r| [r, 1.2, 0.1 * f64::from(k)]))),
        ),
        place("inside: both, by light of either sign of E", (1..=9).flat_map(|k| both_signs(0.1 * f64::from(k))).collect()),
        place(
            "caustics and seams of orders: φ = 10⁻² … 10⁻⁸ and π less that",
            in_orders((2..=8).flat_map(|k| [tenth(k), PI - tenth(k)]).flat_map(|phi| [1.3, 4.0, 30.0].map(|r| [r, phi, 9.0]))),
        ),
        place(
            "camera on an object: 10⁻¹ … 10⁻⁴ of its radius away",
            (1..=4)
                .flat_map(|k| [1.01, 1.5, 9.0, 900.0].into_iter().flat_map(move |l| around(l, tenth(k))))
                .filter(|[r, ..]| *r > LOWEST)
                .map(|[r, phi, l]| ask(r, phi, l, Order::ALL[0]))
                .collect(),
        ),
        place("far: point at 10⁴ r_s", in_orders(far.iter().copied())),
        Place { name: "delays of 10⁴ r_s/c", asks: in_orders(far), delays: true },
        Place {
            name: "delays beside the horizon: point at 1.0005 … 1.05 r_s",
            asks: in_orders([1.0005, 1.001, 1.01, 1.05].into_iter().flat_map(|r| angles.map(|phi| [r, phi, 9.0]))),
            delays: true,
        },
    ]
}

/// The error of a delay that may be, in r_s/c.
fn allowance(input: ProjectionInput, delay: f64) -> f64 {
    if input.r < 1.05 { 0.02 } else { 0.002 + 3e-7 * delay }
}

/// ψ in the rain frame and the delay by the judge.
fn truth(Ask { input, order, branch }: &Ask) -> Option<[f64; 2]> {
    let branch = match branch {
        Branch::Plus => judge::EnergySign::Plus,
        Branch::Minus => judge::EnergySign::Minus,
    };
    let seen = judge::shoot(input.r, input.phi, input.camera, u32::from(order.number()), branch, TOLERANCE)?;
    Some([seen.psi_rain, seen.delay])
}

/// The greatest error of a method; NaN if it does not answer where there is light. In degrees, or in what a delay may be off.
fn worst(method: &dyn Method, place: &Place, truths: &[[f64; 2]], asks: &[Ask]) -> f64 {
    asks.iter().zip(truths).fold(0.0, |worst: f64, (asked, [psi, delay])| {
        let Some(seen) = method.project(asked.input, asked.order, asked.branch) else { return f64::NAN };
        let error = match place.delays {
            true => (seen.delay - delay).abs() / allowance(asked.input, *delay),
            false => (seen.psi_rain - psi).abs().to_degrees(),
        };
        if worst.is_nan() || error.is_nan() { f64::NAN } else { worst.max(error) }
    })
}

/// A finding for each method and place; `quick` leaves out what must be baked.
pub fn measure(quick: bool) -> Vec<Finding> {
    let names = METHODS.into_iter().filter(|name| !(quick && *name == LARGE));
    let methods: Vec<_> = names.filter_map(|name| Some((name, methods::named(name)?))).collect();
    let mut found = Vec::new();
    for place in places() {
        let lit: Vec<(Ask, [f64; 2])> = place.asks.par_iter().filter_map(|ask| Some((*ask, truth(ask)?))).collect();
        let (asks, truths): (Vec<Ask>, Vec<[f64; 2]>) = lit.into_iter().unzip();
        for (name, method) in &methods {
            found.push(Finding {
                part: "light",
                place: place.name,
                method: (*name).to_owned(),
                ours: *name == OURS,
                value: if asks.is_empty() { f64::NAN } else { worst(method.as_ref(), &place, &truths, &asks) },
                unit: if place.delays { "of what is allowed" } else { "°" },
                limit: if place.delays { 1.0 } else { HALF_A_PIXEL },
            });
        }
    }
    found
}
