//! Where projections break, and what must hold there: the items of the list in the order that a ray meets trouble.
//!
//! The judge is `lensrunner::judge::shoot`, which integrates the light. Directions are held to 0.004°, a quarter of a pixel at 3840 over
//! 60°.

use std::f64::consts::{PI, TAU};

use lensrunner::lensing::closed_form::elementary;
use lensrunner::lensing::methods::{self, ProjectionInput, Projector};
use lensrunner::lensing::table::grid;
use lensrunner::lensing::{LensRay, Slice, double, lens_lookup_aged, lens_lookup_at, score, single};
use lensrunner::spacetime::light::{self, Branch, Order, SweepEnd};
use proptest::prelude::*;

use crate::support::table;

pub const QUARTER_PIXEL: f64 = 0.004;

pub fn angle(ray: &LensRay) -> f64 {
    f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi))
}

/// What the lookup gives for a row, as the game would ask.
pub fn seen(row: [f64; 3], order: Order) -> LensRay {
    score::look_up_row(&Slice::new(table(), row[2]), row, order)
}

/// The error of the direction against the judge, degrees.
fn error(row: [f64; 3], order: Order) -> f64 {
    let [r, phi, l] = row;
    let ray = seen(row, order);
    assert!(ray.valid, "no answer at {row:?} {order:?}");
    let truth = lensrunner::judge::shoot(r, phi, l, u32::from(order.number()), lensrunner::judge::EnergySign::Plus, 1e-15)
        .unwrap_or_else(|| panic!("no light at {row:?}"));
    (angle(&ray) - truth.psi_rain).abs().to_degrees()
}

/// b → b_c from both sides: near it a ray's end is the exponential of its angle, and closed forms cancel. The points are where rays end
/// that leave the camera at the critical slope times 1 ± 10^-k; order 3 sweeps up to 3π.
#[test]
fn critical_rays_are_met_from_both_sides() {
    let mut met = 0;
    for l in [1.2, 1.6, 3.0, 10.0, 1000.0] {
        let u: f64 = 1.0 / l;
        let critical = (2.0 / 3.0 - u) * (u + 1.0 / 3.0).sqrt();
        for k in 1..=6 {
            for side in [1.0, -1.0] {
                let w = critical * (1.0 + side * 10f64.powi(-k));
                for order in Order::ALL {
                    for phi in [0.3, 1.5, 2.9] {
                        let SweepEnd::At { u: end, .. } = light::follow(u, w, order.swept(phi)) else { continue };
                        let r = 1.0 / end;
                        if (1.0005..1e4).contains(&r) {
                            met += 1;
                            let off = error([r, phi, l], order);
                            assert!(off < QUARTER_PIXEL, "{off}° at r {r} φ {phi} L {l} {order:?}, b/b_c off by 1e-{k}");
                        }
                    }
                }
            }
        }
    }
    assert!(met > 150, "only {met} rays were met");
}

/// r and L across 1 and 1.5: horizon and photon sphere are places like others. What is looked up changes from one side to the other by no
/// more than twice what the judge says, and the rounding of f32.
#[test]
fn the_horizon_and_the_photon_sphere_are_crossed_evenly() {
    let step = 2e-4;
    for edge in [1.0, 1.5] {
        for order in Order::ALL {
            for phi in [0.02, 1.0, 3.0] {
                for r in [1.01, 1.4, 2.0, 300.0] {
                    let both = [edge - step, edge + step].map(|l| ([r, phi, l], angle(&seen([r, phi, l], order))));
                    crossed(both, order);
                }
                if edge > 1.0 {
                    for l in [0.6, 1.1, 4.0, 500.0] {
                        let both = [edge - step, edge + step].map(|r| ([r, phi, l], angle(&seen([r, phi, l], order))));
                        crossed(both, order);
                    }
                }
            }
        }
    }
}

fn crossed(both: [([f64; 3], f64); 2], order: Order) {
    let truth = both.map(|([r, phi, l], _)| {
        lensrunner::judge::shoot(r, phi, l, u32::from(order.number()), lensrunner::judge::EnergySign::Plus, 1e-15)
            .expect("there is light")
            .psi_rain
    });
    let (jump, allowed) = ((both[1].1 - both[0].1).abs(), (truth[1] - truth[0]).abs());
    assert!(jump < 2.0 * allowed + 2e-6, "{:?} to {:?} {order:?}: {jump} rad, the judge has {allowed}", both[0].0, both[1].0);
}

/// φ → 0 and φ → π, down to the axis itself: the ray's plane is lost, its direction is not.
#[test]
fn the_axis_is_approached_evenly() {
    for l in [0.3, 1.0, 1.5, 8.0, 2000.0] {
        let slice = Slice::new(table(), l);
        for r in [1.001, 1.5, 5.0, 9000.0] {
            for order in [1, 2, 3] {
                for far in [false, true] {
                    let at = |off: f64| {
                        let phi = if far { PI - off } else { off };
                        let ray = lens_lookup_at(&slice, (r * phi.cos() - l) as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, order);
                        assert!(ray.valid, "no answer at r {r} φ {phi} L {l}");
                        angle(&ray)
                    };
                    let limit = at(0.0);
                    for k in 3..12 {
                        let off = 10f64.powi(-k);
                        // The direction changes at most like φ times the lever r/|r − L|, and the Einstein ring opens like φ alone.
                        let lever = 1.0 + 40.0 * r / (r - l).abs().max(1e-3);
                        let change = (at(off) - limit).abs();
                        assert!(change < lever * off + 2e-6, "r {r} L {l} order {order}, {off} from the axis: {change} rad");
                    }
                }
            }
        }
    }
}

/// P → Q: all directions around the camera, ever nearer. In the limit it is flat space seen by an observer who falls: the static frame's
/// angle is that of lengths stretched by 1/√(1 − 1/L), aberrated. Nearer than 1e-4 L the curvature is below 1e-4 rad.
#[test]
fn near_the_camera_space_is_flat() {
    for l in [1.05, 1.5, 4.0, 900.0] {
        let slice = Slice::new(table(), l);
        for k in 3..=7 {
            let near = 10f64.powi(-k);
            for i in 0..24 {
                let around = PI * (f64::from(i) + 0.5) / 24.0;
                let (along, across) = (near * l * around.cos(), near * l * around.sin());
                let ray = lens_lookup_at(&slice, along as f32, across as f32, (l + along) as f32, 1);
                assert!(ray.valid);
                let stretched = across.atan2(along / (1.0f64 - 1.0 / l).sqrt());
                let expected = methods::rain_from_static(stretched, l);
                let off = (angle(&ray) - expected).abs();
                assert!(off < 4.0 * near / (1.0 - 1.0 / l) + 2e-5, "L {l}, {near} L away at {around}: {off} rad");
                assert!((f64::from(ray.delay)).abs() < 20.0 * near * l / (1.0 - 1.0 / l), "L {l}: delay {}", ray.delay);
            }
        }
    }
}

/// r → ∞: the direction goes over into that of the sky, and beyond the table's end nothing breaks.
#[test]
fn far_points_join_the_sky() {
    for l in [0.4, 1.0, 1.5, 7.0, 300.0] {
        for phi in [0.5, 2.0, 3.0] {
            let sky = lensrunner::judge::shoot_sky(phi, l, 1, 1e-15).expect("the sky is seen").psi_rain;
            for r in [1e3, 1e4, 1e5, 1e9, 1e30] {
                let ray = seen([r, phi, l], Order::ALL[0]);
                let off = (angle(&ray) - sky).abs();
                // Parallax: L/r, and b/r behind the hole. Past the table the nearest node answers.
                let allowed = 3.0 * (l + 30.0) / r.min(1e4) + 1e-4;
                assert!(!ray.valid || off < allowed, "r {r} φ {phi} L {l}: {off} rad from the sky");
                assert!(ray.valid || r > 1.05e4, "no answer at r {r}");
            }
            let exact =
                |r: f64| methods::Exact.project(ProjectionInput { r, phi, camera: l }, Order::ALL[0], Branch::Plus).expect("seen").psi_rain;
            assert!((exact(1e12) - sky).abs() < 1e-9 * (1.0 + l));
        }
    }
}

/// Φ across π and 2π: the end of one order is the beginning of the next, in direction and in time.
#[test]
fn order_seams_join() {
    for l in [0.3, 1.0, 1.5, 3.0, 300.0] {
        let slice = Slice::new(table(), l);
        for r in [1.01, 1.5, 7.0, 4000.0] {
            let at = |order: u32, phi: f64| {
                let ray = lens_lookup_at(&slice, (r * phi.cos() - l) as f32, (r * phi.sin()) as f32, (r * phi.cos()) as f32, order);
                (angle(&ray), f64::from(ray.delay))
            };
            for (a, b, phi) in [(1, 2, PI), (2, 3, 0.0)] {
                let (first, second) = (at(a, phi), at(b, phi));
                assert!((first.0 - second.0).abs() < 1e-6, "r {r} L {l}, orders {a} and {b}");
                assert!((first.1 - second.1).abs() < 1e-6 * (first.1.abs() + 1.0), "delays, r {r} L {l}, orders {a} and {b}");
                // Little on either side of the seam changes little: no order sees it as an edge of its table.
                let off = if phi > 0.0 { PI - 1e-4 } else { 1e-4 };
                assert!((at(a, off).0 - at(b, off).0).abs() < 2e-4 * (1.0 + r / (r - l).abs().max(0.1)), "beside the seam, r {r} L {l}");
            }
        }
    }
}

/// f32 against f64: the formulas are compiled twice, and the f32 copy loses no more than a few of its last digits to cancellation.
#[test]
fn single_precision_follows_double() {
    for l in [0.05, 0.7, 1.0, 1.0001, 1.5, 20.0, 5000.0] {
        let (wide, narrow) = (double::camera(l), single::camera(l));
        for c in [1e-4, 0.01, 0.3, 0.6667, 0.999] {
            for sweep in [1e-6, 0.01, 1.0, 3.0, PI, 3.3, 6.0, 9.0] {
                let bent = double::bent_sweep(sweep);
                let rise = c - wide.a;
                let (w, w_e) = double::slope_guess(&wide, rise, bent);
                let (v, v_e) = single::slope_guess(&narrow, rise as f32, bent as f32);
                // As angles: what a direction feels.
                for (w, v, scale) in [(w, v, wide.a), (w_e, v_e, double::emission_scale(&wide, c))] {
                    let off = (scale.atan2(-w) - scale.atan2(-f64::from(v))).abs();
                    assert!(off < 2e-5, "L {l} c {c} Φ {sweep}: {w} and {v}, {off} rad");
                }
                let lapse2 = 1.0 - c;
                let want = grid::coordinates(&wide, c, sweep);
                let (d, p) = (c as f32, sweep as f32);
                let [_, h, _] = single::lens_equation(&narrow, d, bent as f32, elementary::single::stumpff((0.25 * bent * bent) as f32));
                let logs = [d + narrow.soft, single::near_axis(p), 0.5 * h].map(elementary::single::ln);
                let got = single::axes(&narrow, (lapse2 as f32).sqrt(), p, logs);
                for (got, want) in [(got.0, want.0), (got.1, want.1)] {
                    assert!((f64::from(got) - want).abs() < 2e-6, "L {l} c {c} Φ {sweep}");
                }
            }
        }
    }
}

/// The polynomials of the f32 copy against the library, over the ranges that they are for.
#[test]
fn elementary_functions_are_the_librarys() {
    use lensrunner::lensing::closed_form::elementary::single::{above, ln, ln4, log1p, short_arctan, stumpff, stumpffs};
    for i in 0..=20_000 {
        let part = f64::from(i) / 20_000.0;
        let x = (10f64.powf(60.0 * part - 30.0)) as f32;
        let (got, want) = (f64::from(ln(x)), f64::from(x).ln());
        assert!((got - want).abs() < 1.2e-7 * (1.0 + want.abs()), "ln {x}: {got}, not {want}");
        assert_eq!(ln4([x, 1.0, 2.0], x), [ln(x), ln(1.0), ln(2.0), log1p(x)]);
        assert_eq!(stumpffs(x.min(4.0), 0.5), [stumpff(x.min(4.0)), stumpff(0.5)]);
        for x in [x, -(part as f32) * 0.999, part as f32 * 1e-3] {
            let (got, want) = (f64::from(log1p(x)), f64::from(x).ln_1p());
            // 1 + x is rounded where it is not small.
            let rounded = if x < -0.29 { 6e-8 / (1.0 + f64::from(x)) } else { 0.0 };
            assert!((got - want).abs() <= 3e-7 * want.abs() + rounded, "ln(1 + {x}): {got}, not {want}");
        }
        let t = (part * (std::f64::consts::PI / 8.0).tan()) as f32;
        let (got, want) = (f64::from(short_arctan(t)), f64::from(t).atan());
        assert!((got - want).abs() <= 1.2e-7 * want, "arctan {t}: {got}, not {want}");
        let x = (5.4 * part - 1.0) as f32;
        let root = f64::from(x).abs().sqrt();
        let (sine, cosine) = if x < 0.0 { (root.sinh() / root, root.cosh()) } else { (root.sin() / root, root.cos()) };
        let (s, c) = stumpff(x);
        let sine = if x == 0.0 { 1.0 } else { sine };
        assert!((f64::from(s) - sine).abs() < 2e-7 && (f64::from(c) - cosine).abs() < 2.5e-7, "Stumpff {x}: {s} {c}, not {sine} {cosine}");
    }
    assert_eq!([above(1e-30, 1.0, 2.0), above(0.0, 1.0, 2.0), above(-1.0, 1.0, 2.0), above(f32::NAN, 1.0, 2.0)], [1.0, 2.0, 2.0, 2.0]);
}

/// Every number of the ray is one.
pub fn finite(ray: &LensRay) -> bool {
    let numbers = [
        ray.cos_psi, ray.sin_psi, ray.delay, ray.frequency, ray.emission_radial, ray.emission_tangential, ray.emission_frequency,
        ray.slope, ray.emission_slope, ray.energy,
    ];
    numbers.iter().all(|v| v.is_finite())
}

/// Denormals, NaN, infinities and zeros in every argument: no NaN comes out, and what is not a place is not answered.
#[test]
fn hostile_numbers_give_no_nan() {
    let hostile = [
        0.0,
        -0.0,
        1e-45,
        -1e-45,
        f32::MIN_POSITIVE,
        1e-30,
        1.0,
        -1.0,
        1e30,
        f32::MAX,
        f32::MIN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    for l in [0.05, 0.999, 1.0, 1.5, 100.0, 5000.0, 0.0, -1.0, 1e300, f64::NAN, f64::INFINITY] {
        let slice = Slice::new(table(), l);
        for along in hostile {
            for across in hostile {
                for height in hostile {
                    for order in [0, 1, 2, 3, 4, u32::MAX] {
                        for elapsed in [0.0, 3e38, f32::NAN] {
                            let ray = lens_lookup_aged(&slice, along, across, height, order, elapsed);
                            assert!(finite(&ray), "{along} {across} {height} L {l} order {order}: {ray:?}");
                            let place = along.is_finite() && across.is_finite() && height.is_finite();
                            assert!(place || !ray.valid, "an answer for {along} {across} {height}");
                        }
                    }
                }
            }
        }
    }
}

/// tan(ψ/2) in the rain frame at a camera at u = 1/L, without a difference of nearly equal numbers: it tells directions apart that are
/// nearer to π than f64 tells angles.
fn depth(ray: &light::Connection, u: f64) -> f64 {
    let (w, e, beta) = (ray.slope, ray.energy, u.sqrt());
    // e ± w = u (1 ∓ β) tan^±1(ψ/2), by what `light::launch` says of ψ.
    if e > 0.0 && w <= 0.0 { u * (1.0 + beta) / (e - w) } else { (e + w) / (u * (1.0 - beta)) }
}

/// The lookup in f32 keeps the order of any two points whose true directions differ by more than this, radians: an eightieth of the half
/// pixel that it promises (0.008°). Of nearer ones its error, 0.0013° at worst, may exchange the places.
const TOLD_APART: f64 = 1e-4 / 57.3;

proptest! {
    #![proptest_config(crate::support::fixed(2048))]

    /// At fixed (L, Φ), r decreases strictly as ψ grows: for the closed form at every step, for the lookup at every step that it tells
    /// apart.
    #[test]
    fn nearer_points_are_seen_nearer_to_the_hole(l in -2.9f64..8.5, near in 0.001f64..9.1, digits in 0.0f64..4.0, sweep in 0.01f64..9.3) {
        let l = l.exp();
        let r = near.exp();
        let farther = r * (1.0 + 10f64.powf(-digits));
        let order = if sweep <= PI { 1 } else if sweep <= TAU { 2 } else { 3 };
        let phi = [sweep, TAU - sweep, sweep - TAU][order - 1];
        let order = Order::new(order as u8).unwrap();
        prop_assume!(r > 1.0005 && farther < 1e4);
        let [deep, shallow] = [r, farther].map(|r| light::connect(1.0 / r, sweep, 1.0 / l, Branch::Plus).expect("there is light"));
        prop_assert!(depth(&deep, 1.0 / l) > depth(&shallow, 1.0 / l), "{:?} {:?}", deep, shallow);
        let psi = |ray: &light::Connection| light::rain_angle(ray.slope, ray.energy, 1.0 / l);
        let (near, far) = (seen([r, phi, l], order), seen([farther, phi, l], order));
        prop_assert!(near.valid && far.valid);
        prop_assert!(angle(&near) > angle(&far) || psi(&deep) - psi(&shallow) < TOLD_APART, "{} {}", angle(&near), angle(&far));
    }

    /// The same inside, separately for each sign of E.
    #[test]
    fn inside_the_same_holds_for_each_sign(l in 0.05f64..0.95, first in 0.01f64..1.0, second in 0.01f64..1.0, part in 0.01f64..0.99) {
        let between = |t: f64| l + (1.0 - l) * t * 0.999;
        let (r, farther) = (between(first.min(second)), between(first.max(second)));
        prop_assume!(farther - r > 1e-6 * (1.0 - l));
        let limit = (1.0 - 2.0 * r).acos() - (1.0 - 2.0 * l).acos();
        let phi = part * limit;
        for (branch, sign) in [(Branch::Plus, 1.0), (Branch::Minus, -1.0)] {
            let [deep, shallow] = [r, farther].map(|r| light::connect(1.0 / r, phi, 1.0 / l, branch).expect("there is light"));
            prop_assert!(sign * (depth(&deep, 1.0 / l) - depth(&shallow, 1.0 / l)) > 0.0, "{:?}: {:?} {:?}", branch, deep, shallow);
            let psi = |ray: &light::Connection| light::rain_angle(ray.slope, ray.energy, 1.0 / l);
            let look = |r: f64| angle(&score::look_up_row_on(&Slice::new(table(), l), [r, phi, l], Order::ALL[0], branch));
            let step = sign * (look(r) - look(farther));
            prop_assert!(step > 0.0 || sign * (psi(&deep) - psi(&shallow)) < TOLD_APART, "{:?}: {}", branch, step);
        }
    }

    /// Any bits for any argument: no NaN.
    #[test]
    fn any_bits_give_no_nan(along in any::<u32>(), across in any::<u32>(), height in any::<u32>(), l in any::<u64>(), order in any::<u32>()) {
        let slice = Slice::new(table(), f64::from_bits(l));
        let ray = lens_lookup_at(&slice, f32::from_bits(along), f32::from_bits(across), f32::from_bits(height), order);
        prop_assert!(finite(&ray), "{ray:?}");
    }
}
