//! The exact joining of points by light, judged by a plain numerical integration of the orbit, by tabulated values and by laws.

use lensrunner::spacetime::light::{
    Branch, Connection, Order, SweepEnd, connect, follow, join, join_near, launch, rain_angle, rain_momentum, shadow_angle, sky_angle,
    sky_slope, static_angle, static_redshift, swept_to_sky,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::spacetime::oracles::{DEFLECTIONS, FLASHES, JOINED, SHADOWS_FALLING, SHADOWS_HOVERING};

/// A ray integrated step by step: u, w = du/dΦ, ∂u/∂w₀ and its slope, and the Painlevé–Gullstrand travel time, over Φ.
type State = [f64; 5];

/// The right-hand side. dT/dΦ is written from the photon's rain-frame momentum, in one of two forms that agree on the orbit:
/// `rising` is singular only where light crosses the future horizon, the other only where it turns or left the past horizon. One step keeps
/// to one form, for between the stages of a step w and e do not quite fit each other.
fn rate(y: &State, e: f64, rising: bool) -> State {
    let [u, w, v, v_slope, _] = *y;
    let beta = u.sqrt();
    let time = if rising { (e + beta * w) / (u * u * (1.0 - u)) } else { (beta * u * u - e * w) / (u * u * (beta * e - w)) };
    [w, -u + 1.5 * u * u, v_slope, (3.0 * u - 1.0) * v, time]
}

fn plus(a: &State, b: &State, h: f64) -> State {
    std::array::from_fn(|i| a[i] + h * b[i])
}

/// One step by Gragg's midpoint rule extrapolated to order 14. What is extrapolated is the change over the step: its rounding is
/// small for a small step.
fn step(y: &State, h: f64, e: f64) -> State {
    const ROWS: usize = 7;
    let rising = e < 0.0 || (y[0] < 1.0 && y[1] > -0.5 * e);
    let rate_at = |change: &State| rate(&plus(y, change, 1.0), e, rising);
    let mut table: Vec<State> = Vec::new();
    for row in 0..ROWS {
        let n = 2 * (row + 1);
        let small = h / n as f64;
        let (mut before, mut now) = ([0.0; 5], rate_at(&[0.0; 5]).map(|x| small * x));
        for _ in 1..n {
            (before, now) = (now, plus(&before, &rate_at(&now), 2.0 * small));
        }
        let mut best: State = plus(&plus(&now, &before, 1.0), &rate_at(&now), small).map(|x| 0.5 * x);
        for (column, entry) in table.iter_mut().enumerate() {
            let ratio = (row + 1) as f64 / (row - column) as f64;
            let previous = std::mem::replace(entry, best);
            best = std::array::from_fn(|i| best[i] + (best[i] - previous[i]) / (ratio * ratio - 1.0));
        }
        table.push(best);
    }
    plus(y, &table[ROWS - 1], 1.0)
}

/// Carries a ray over `swept`, which may be negative.
fn integrate(u: f64, w: f64, e: f64, swept: f64) -> State {
    let mut y = [u, w, 0.0, 1.0, 0.0];
    let mut left = swept.abs();
    while left > 0.0 {
        let [u, w, ..] = y;
        // Short against the distance to r = ∞, to r = 0, to where w = e and to the past horizon.
        let mut h: f64 = (0.15_f64).min(0.1 * u / w.abs()).min(0.1 / u.sqrt()).min(0.3 * (w.abs() + e.abs()) / u);
        if e * w > 0.0 {
            h = h.min(0.1 * (1.0 - u).abs() / w.abs());
        }
        let h = if h > 0.999 * left { left } else { h };
        y = step(&y, h.copysign(swept), e);
        left -= h;
    }
    y
}

/// What the integrator makes of a connection: both ends are integrated to the middle, where they should meet.
struct Verdict {
    /// The error of ψ in the rain frame at the camera, radians.
    angle: f64,
    /// The error of the slope at the point, against |w_e| + u.
    emission: f64,
    /// The relative error of the travel time.
    delay: f64,
}

fn judge(c: &Connection, u_point: f64, swept: f64, u: f64) -> Verdict {
    let near = integrate(u, c.slope, c.energy, 0.5 * swept);
    let far = integrate(u_point, c.emission_slope, c.energy, -0.5 * swept);
    // Newton's correction of both slopes: u and w must agree in the middle.
    let (du, dw) = (far[0] - near[0], far[1] - near[1]);
    let determinant = near[2] * far[3] - near[3] * far[2];
    let at_camera = (du * far[3] - dw * far[2]) / determinant;
    let at_point = (du * near[3] - dw * near[2]) / determinant;
    // Along it e² = w² + u² − u³ changes too.
    let energy = c.energy + c.slope * at_camera / c.energy;
    let angle = (rain_angle(c.slope + at_camera, energy, u) - rain_angle(c.slope, c.energy, u)).abs();
    Verdict { angle, emission: at_point.abs() / (c.emission_slope.abs() + u_point), delay: ((near[4] - far[4]) / c.delay - 1.0).abs() }
}

/// T − t outside the horizon.
fn rain_time(r: f64) -> f64 {
    2.0 * r.sqrt() + ((r.sqrt() - 1.0) / (r.sqrt() + 1.0)).ln()
}

/// The rain-frame angle of a static observer's angle: the rain frame moves inward at β and sees light aberrated.
fn aberrated(psi_static: f64, l: f64) -> f64 {
    let beta = l.sqrt().recip();
    ((psi_static.cos() - beta) / (1.0 - beta * psi_static.cos())).acos()
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found} instead of {expected}");
}

#[test]
fn tabulated_connections_are_met() {
    for (r, degrees, l, psi, b, t) in JOINED {
        let c = connect(1.0 / r, degrees.to_radians(), 1.0 / l, Branch::Plus).expect("seen from outside");
        // The last digits of the table.
        near(static_angle(c.slope, c.energy, 1.0 / l).expect("outside"), psi, 2e-13, "psi");
        near(rain_angle(c.slope, c.energy, 1.0 / l), aberrated(psi, l), 1e-12, "rain psi");
        near(1.0 / c.energy, b, 1e-12 * b, "b");
        near(c.delay, t + rain_time(l) - rain_time(r), 2e-11 * t.max(1.0), "delay");
    }
    near(static_redshift(1.0 / 20.0, 0.1).expect("outside"), 1.027402334, 1e-9, "redshift");
    near(static_redshift(1.0 / 3.0, 1.0 / 1.2).expect("outside"), 2.0, 1e-12, "redshift");
}

/// The camera's own flash, lensed all around the hole: n = 1, 2, 3, angle from the inward direction, round trip in t.
#[test]
fn own_flash_rings() {
    for (n, (degrees, _, time)) in (1..).zip(FLASHES) {
        let c = connect(0.1, 2.0 * PI * f64::from(n), 0.1, Branch::Plus).expect("a ring");
        let psi = static_angle(c.slope, c.energy, 0.1).expect("outside");
        near((PI - psi).to_degrees(), degrees, 1e-11, "angle");
        near(c.delay, time, 1e-10, "round trip");
        near(c.emission_slope, -c.slope, 1e-11, "symmetry");
    }
}

/// Darwin's deflection: light with closest approach P (in M) comes from and leaves to infinity bent by alpha.
#[test]
fn darwin_deflection() {
    for (p, alpha) in DEFLECTIONS {
        // Half of the symmetric ray, seen from its apsis.
        let u = 2.0 / p;
        let energy = u * f64::sqrt(1.0 - u);
        near(2.0 * swept_to_sky(0.0, energy, u).expect("escapes"), PI + alpha, 2e-12, "bending from the apsis");
        near(sky_slope(0.5 * (PI + alpha), u).expect("the sky"), 0.0, 2e-13, "slope at the apsis");
    }
    // Strong rings, b/M: the sky seen from far away at Φ = π + alpha.
    let rings = [(PI, 5.35695863074179), (2.0 * PI, 5.20268040281046)];
    for (alpha, b) in rings {
        let l = 1e9;
        let far = join(0.0, PI + alpha - b / 2.0 / l, 1.0 / l, Branch::Plus).expect("the sky");
        near(2.0 / far.energy, b, 1e-7, "ring");
    }
}

#[test]
fn shadow_edges() {
    for (l, degrees) in SHADOWS_HOVERING {
        let rain = aberrated(PI - f64::to_radians(degrees), l);
        near(shadow_angle(1.0 / l), rain, 2e-11, "Synge");
    }
    for (l, degrees) in SHADOWS_FALLING {
        near((PI - shadow_angle(1.0 / l)).to_degrees(), degrees, 1e-10 * degrees.max(1.0), "falling");
    }
}

fn logarithmic(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

/// Radii outside the horizon, with the places that are hard.
fn outside() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => logarithmic(1.0005, 1e5),
        1 => logarithmic(1e-9, 0.1).prop_map(|x| 1.5 + x),
        1 => logarithmic(1e-9, 0.1).prop_map(|x| 1.5 - x),
        1 => logarithmic(5e-4, 0.1).prop_map(|x| 1.0 + x),
    ]
}

fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 1e-9..PI,
        1 => logarithmic(1e-9, 1e-2),
        1 => logarithmic(1e-9, 1e-2).prop_map(|x| PI - x),
    ]
}

fn order() -> impl Strategy<Value = Order> {
    (1..=3u8).prop_map(|n| Order::new(n).expect("1 to 3"))
}

/// The judge itself is good to about this: its steps are of order 14.
const ANGLE: f64 = 1e-10;
const DELAY: f64 = 2e-10;

proptest! {
    #![proptest_config(crate::support::fixed(300))]

    #[test]
    fn outside_agrees_with_the_integrator(r in outside(), l in outside(), phi in angle(), n in order()) {
        let (u_point, u, swept) = (1.0 / r, 1.0 / l, n.swept(phi));
        let c = connect(u_point, swept, u, Branch::Plus).expect("every point outside is seen");
        let v = judge(&c, u_point, swept, u);
        // The rounding of 1/r is felt where the light has hardly any way to go.
        let rounding = 1e-14 * l / c.delay;
        prop_assert!(v.angle < ANGLE + rounding && v.emission < 1e-9 + rounding && v.delay < DELAY + rounding, "{} {} {}", v.angle, v.emission, v.delay);
    }

    #[test]
    fn close_points_agree_with_the_integrator(l in outside(), distance in logarithmic(1e-4, 0.1), towards in 0.01..3.13) {
        let (along, across) = (1.0 + distance * f64::cos(towards), distance * f64::sin(towards));
        let (r, phi) = (l * along.hypot(across), across.atan2(along));
        prop_assume!(r > 1.0005);
        let c = connect(1.0 / r, phi, 1.0 / l, Branch::Plus).expect("seen");
        let v = judge(&c, 1.0 / r, phi, 1.0 / l);
        // The rounding of 1/r and 1/l is 1e-16 of a difference of 1e-4.
        prop_assert!(v.angle < ANGLE && v.emission < 1e-9 && v.delay < DELAY, "{} {} {}", v.angle, v.emission, v.delay);
    }

    #[test]
    fn inside_agrees_with_the_integrator(l in logarithmic(0.05, 0.999), r in logarithmic(1.0005, 1e5), phi in angle(), n in order()) {
        let (u_point, u, swept) = (1.0 / r, 1.0 / l, n.swept(phi));
        let c = connect(u_point, swept, u, Branch::Plus).expect("everything outside is seen from inside");
        let v = judge(&c, u_point, swept, u);
        prop_assert!(v.angle < ANGLE && v.emission < 1e-9 && v.delay < 1e-9, "{} {} {}", v.angle, v.emission, v.delay);
        prop_assert!(connect(u_point, swept, u, Branch::Minus).is_none());
    }

    #[test]
    fn both_inside_agree_with_the_integrator(l in logarithmic(0.05, 0.99), part in 0.01..0.97, share in 1e-4..0.99) {
        let r = l + (1.0 - l) * part;
        let (u_point, u) = (1.0 / r, 1.0 / l);
        let farthest = f64::acos(1.0 - 2.0 * r) - f64::acos(1.0 - 2.0 * l);
        let swept = share * farthest;
        let plus = connect(u_point, swept, u, Branch::Plus).expect("E > 0");
        let minus = connect(u_point, swept, u, Branch::Minus).expect("E < 0");
        prop_assert!(plus.slope == minus.slope && plus.energy == -minus.energy && plus.energy > 0.0);
        for c in [plus, minus] {
            let v = judge(&c, u_point, swept, u);
            prop_assert!(v.angle < ANGLE && v.emission < 1e-8 && v.delay < DELAY, "{} {} {}", v.angle, v.emission, v.delay);
        }
        // The photon that came from outside was emitted at one time, the other at another.
        prop_assert!(plus.delay > 0.0 && minus.delay > 0.0 && plus.delay != minus.delay);
        prop_assert!(connect(u_point, farthest * (1.0 + 1e-12), u, Branch::Plus).is_none());
        prop_assert!(connect(u, swept, u_point, Branch::Plus).is_none(), "nothing is seen outward-in");
    }

    /// At fixed Φ and camera r decreases strictly as ψ grows (inside for each sign of E).
    #[test]
    fn radius_falls_as_the_angle_grows(l in prop_oneof![outside(), logarithmic(0.05, 0.999)], r in outside(), growth in logarithmic(1e-3, 10.0), phi in angle(), n in order()) {
        let psi = |r: f64| {
            let c = join(1.0 / r, n.swept(phi), 1.0 / l, Branch::Plus).expect("seen");
            rain_angle(c.slope, c.energy, 1.0 / l)
        };
        let (low, high) = (psi(r), psi(r * (1.0 + growth)));
        // Far away, images of different r merge within rounding.
        prop_assert!(high < low || (high - low).abs() < 1e-14, "{low} {high}");
    }

    /// d(delay)/dΦ = 1/e at fixed ends (Fermat).
    #[test]
    fn delay_grows_by_the_impact_parameter(l in prop_oneof![logarithmic(1.01, 1e3), logarithmic(0.1, 0.99)], r in logarithmic(1.01, 1e3), phi in 0.1..3.0, n in order()) {
        let h = 1e-3;
        let at = |swept: f64| connect(1.0 / r, swept, 1.0 / l, Branch::Plus).expect("seen");
        let swept = n.swept(phi);
        // A central difference of fourth order.
        let slope = (8.0 * (at(swept + h).delay - at(swept - h).delay) - (at(swept + 2.0 * h).delay - at(swept - 2.0 * h).delay)) / (12.0 * h);
        let b = 1.0 / at(swept).energy;
        prop_assert!((slope - b).abs() < 1e-6 * b + 1e-9 * (r + l), "{slope} {b}");
    }

    #[test]
    fn sky_and_back(l in logarithmic(0.05, 1e5), swept in logarithmic(1e-6, 9.0)) {
        let u = 1.0 / l;
        let c = connect(0.0, swept, u, Branch::Plus).expect("the sky is seen everywhere");
        prop_assert!(c.delay == f64::INFINITY && (c.emission_slope + c.energy).abs() < 1e-9 * c.energy);
        // Near the edge of the shadow Φ∞ doubles the digits that ψ loses; inside, w² − u³ loses some more.
        let limit = 1e-14 * swept.exp() * (1.0 + u * u * u.sqrt()) + 1e-13;
        let found = swept_to_sky(c.slope, c.energy, u).expect("it came from there");
        prop_assert!((found - swept).abs() < limit, "{found}");
        let psi = rain_angle(c.slope, c.energy, u);
        prop_assert!(psi < shadow_angle(u));
        let found = sky_angle(psi, u).expect("not in the shadow");
        prop_assert!((found - swept).abs() < limit * (1.0 + l), "{found} {swept}");
    }

    #[test]
    fn directions_and_momenta_agree(psi in 0.01..3.13, l in logarithmic(0.05, 1e4)) {
        let u = 1.0 / l;
        let ray = launch(psi, u);
        prop_assert!((rain_angle(ray.slope, ray.energy, u) - psi).abs() < 1e-10);
        let [radial, across] = rain_momentum(ray.slope, ray.energy, u);
        // Null, and E = ω − β p_r.
        let frequency = radial.hypot(across);
        prop_assert!((frequency - u.sqrt() * radial - ray.energy).abs() < 1e-9 * frequency);
        prop_assert!((f64::atan2(-across, -radial) - psi).abs() < 1e-10);
        if u < 1.0 {
            let still = static_angle(ray.slope, ray.energy, u).expect("outside");
            prop_assert!((aberrated(still, l) - psi).abs() < 1e-6);
        }
    }

    #[test]
    fn following_a_ray_agrees_with_joining(l in prop_oneof![outside(), logarithmic(0.05, 0.999)], r in outside(), phi in angle(), n in order()) {
        let ray = join(1.0 / r, n.swept(phi), 1.0 / l, Branch::Plus).expect("seen");
        prop_assume!(l > 1.0);
        match follow(1.0 / l, ray.slope, n.swept(phi)) {
            SweepEnd::At { u, slope } => {
                prop_assert!((u * r - 1.0).abs() < 1e-9 * r.max(1.0));
                prop_assert!((slope - ray.emission_slope).abs() < 1e-9 * (1.0 + slope.abs()));
            }
            other => prop_assert!(r > 1e4, "{other:?}"),
        }
    }

    /// A guess changes the way, not the goal.
    #[test]
    fn guesses_do_not_matter(l in outside(), r in outside(), phi in angle(), n in order(), guess in -1e3..1e3) {
        let ray = |guess| join_near(1.0 / r, n.swept(phi), 1.0 / l, Branch::Plus, guess).expect("seen");
        let (with, without) = (ray(Some(guess)), ray(None));
        let psi = |ray: lensrunner::spacetime::light::Ray| rain_angle(ray.slope, ray.energy, 1.0 / l);
        prop_assert!((psi(with) - psi(without)).abs() < 1e-11);
    }

    #[test]
    fn no_argument_makes_a_panic_or_a_nan(u_point in prop::num::f64::ANY, swept in prop::num::f64::ANY, u in prop::num::f64::ANY, minus in any::<bool>()) {
        let branch = if minus { Branch::Minus } else { Branch::Plus };
        // Numbers of every size, folded into the range of u and Φ.
        let fold = |x: f64| if x.is_finite() { (x.abs().max(1e-300).ln() % 69.0).exp() } else { 1.0 };
        for (u_point, swept, u) in [(u_point, swept, u), (fold(u_point), fold(swept), fold(u)), (0.0, fold(swept), fold(u))] {
            if let Some(c) = connect(u_point, swept, u, branch) {
                prop_assert!(c.slope.is_finite() && c.emission_slope.is_finite() && c.energy.is_finite() && !c.delay.is_nan(), "{u_point} {swept} {u} {c:?}");
                prop_assert!(rain_angle(c.slope, c.energy, u).is_finite());
            }
        }
        let _ = connect(u_point, swept, u, branch);
        let _ = sky_angle(swept, u);
    }
}

#[test]
fn what_no_light_joins() {
    let seen = |r: f64, swept: f64, l: f64, branch| connect(1.0 / r, swept, 1.0 / l, branch).is_some();
    assert!(!seen(1.0, 1.0, 5.0, Branch::Plus), "the horizon from outside");
    assert!(!seen(0.5, 1.0, 5.0, Branch::Plus), "the inside from outside");
    assert!(!seen(3.0, 1.0, 5.0, Branch::Minus), "E < 0 outside");
    assert!(!seen(3.0, 1.0, 0.5, Branch::Minus), "E < 0 from outside to inside");
    assert!(!seen(0.4, 0.1, 0.5, Branch::Plus), "deeper than the camera");
    assert!(seen(0.8, 0.1, 0.5, Branch::Plus) && seen(0.8, 0.1, 0.5, Branch::Minus));
    assert!(seen(1.0, 0.1, 0.5, Branch::Plus), "the horizon from inside");
    assert!(!seen(1.0, FRAC_PI_2 + 0.01, 0.5, Branch::Plus), "the horizon, farther than any light crosses it");
    assert!(!seen(3.0, 0.0, 5.0, Branch::Plus) && !seen(3.0, f64::NAN, 5.0, Branch::Plus));
}
