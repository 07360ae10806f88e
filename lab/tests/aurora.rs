//! The aurora's walks against the method in space and against the line integral.

use glam::{DQuat, DVec3, Vec3};
use lensrunner::lensing;
use lensrunner::spacetime::light::{Branch, Order, connect, rain_angle};
use lensrunner_lab::aurora::experiment::{ExperimentRequest, Viewpoint, run};
use lensrunner_lab::aurora::eye::{Eye, Planet};
use lensrunner_lab::aurora::lattice::Lattice;
use lensrunner_lab::aurora::sheet::{FALLS, Falls, FlatAurora, LEVELS, Streak, TOP, field_direction};
use lensrunner_lab::aurora::splat::{Gaussian, SplatPicture};
use lensrunner_lab::aurora::truth::Emission;
use lensrunner_lab::aurora::walk::{Method, Point, Walker};
use proptest::prelude::*;
use std::sync::LazyLock;

use crate::support::table;

static FALLS_TABLE: LazyLock<Falls> = LazyLock::new(Falls::new);

/// Falls along the field, none of them astray.
static STRAIGHT: LazyLock<Falls> = LazyLock::new(|| Falls { sway: [0.0; LEVELS], ..Falls::new() });

fn all_points(method: Method, eye: &Eye, streaks: &[Streak]) -> Vec<Vec<Point>> {
    points_of(&FALLS_TABLE, method, eye, streaks)
}

fn points_of(falls: &Falls, method: Method, eye: &Eye, streaks: &[Streak]) -> Vec<Vec<Point>> {
    let lattice = Lattice::around(eye, streaks, 0.25);
    let walker = Walker::new(eye, falls, Some(&lattice), 1);
    let walk = |streak: &Streak| {
        let mut out = Vec::new();
        walker.walk(method, std::slice::from_ref(streak), &mut out);
        out
    };
    streaks.iter().map(walk).collect()
}

fn points(method: Method, eye: &Eye, streak: &Streak) -> Vec<Point> {
    all_points(method, eye, std::slice::from_ref(streak)).remove(0)
}

/// Collisions by screen distance from the top's image, and from that the distances between which the middle 90 % of the light lies.
fn luminous_ends(points: &[Point], axis: [f32; 2]) -> [f64; 2] {
    let mut along: Vec<(f64, f64)> = points.iter().map(|p| (f64::from(p.x * axis[0] + p.y * axis[1]), f64::from(p.count))).collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = along.iter().map(|p| p.1).sum();
    [0.05, 0.95].map(|share| {
        let mut sum = 0.0;
        along
            .iter()
            .find(|p| {
                sum += p.1;
                sum >= share * total
            })
            .unwrap()
            .0
    })
}

/// The luminous ends of `points` and the true ones, where they differ by more than 1 % of the length and half a pixel. The truth: light of
/// the streak as in `exact`, each point where `seen` says (in camera axes).
fn wrong_ends(points: &[Point], eye: &Eye, streak: &Streak, exact: &[Point], seen: impl Fn(DVec3) -> DVec3) -> Option<[[f64; 2]; 2]> {
    let placed = |point: &Point| {
        let z = f64::from(FALLS_TABLE.heights[point.level as usize]);
        let s = (TOP - z) / (TOP - f64::from(streak.end_height));
        let seen = seen(streak.top.as_dvec3().lerp(streak.end.as_dvec3(), s));
        let f = f64::from(eye.focal) / -seen.z;
        Point { x: (960.0 + f * seen.x) as f32, y: (540.0 - f * seen.y) as f32, ..*point }
    };
    let want: Vec<Point> = exact.iter().map(placed).collect();
    assert!(want.len() > 10);
    let (first, last) = (want[0], want[want.len() - 1]);
    let d = [last.x - first.x, last.y - first.y];
    let norm = d[0].hypot(d[1]).max(1e-6);
    let [truth, got] = [&want[..], points].map(|points| luminous_ends(points, [d[0] / norm, d[1] / norm]));
    let length = |ends: [f64; 2]| ends[1] - ends[0];
    let allowed = (0.01 * length(truth)).max(0.5);
    ((length(got) - length(truth)).abs() > allowed || (got[0] - truth[0]).abs() > allowed).then_some([got, truth])
}

/// A camera that sees the middle of a streak at `degrees` between line of sight and field, `distance` km away.
fn tilted(streak: &Streak, degrees: f64, distance: f64) -> Eye {
    let up = field_direction();
    let middle = streak.end.as_dvec3();
    let side = up.any_orthonormal_vector();
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let away = -up * cosine + side * sine;
    Eye::flat(middle + away * distance, middle + up * 40.0, DVec3::Y, 1.6, [1920, 1080])
}

#[test]
fn luminous_length_is_right_at_every_angle() {
    let streak = FlatAurora::numbered(4).streaks(40)[7];
    // Held against the line integral of one streak, with a projection of its own.
    let mut linear_fails = 0;
    for degrees in (1..=90).map(f64::from) {
        let eye = tilted(&streak, degrees, 130.0);
        let straight = |method| points_of(&STRAIGHT, method, &eye, std::slice::from_ref(&streak)).remove(0);
        let exact = straight(Method::Exact);
        let seen = |place: DVec3| eye.axes.as_dmat3() * (place - eye.position.as_dvec3());
        let wrong = |points: &[Point]| wrong_ends(points, &eye, &streak, &exact, seen);
        assert_eq!(wrong(&exact), None, "at {degrees}°");
        linear_fails += u32::from(wrong(&straight(Method::Linear)).is_some());
    }
    assert!(linear_fails > 45, "the linear walk was wrong at {linear_fails} of 90 angles only: the test sees nothing");
}

/// The exact ray from a point of the patch, without the table: apparent place in camera axes.
fn by_exact_ray(eye: &Eye, point: DVec3) -> DVec3 {
    let bent = eye.bent.as_ref().unwrap();
    let radius = f64::from(bent.radius);
    let offset = bent.origin.as_dvec3() + bent.place.as_dmat3() * point;
    let place = offset + DVec3::Z * radius;
    let order = Order::new(bent.order as u8).unwrap();
    let phi = place.angle_between(DVec3::Z);
    let ray = connect(1.0 / place.length(), order.swept(phi), 1.0 / radius, Branch::Plus).unwrap();
    let psi = rain_angle(ray.slope, ray.energy, 1.0 / radius);
    let side = offset.with_z(0.0).normalize() * if order.flips() { -1.0 } else { 1.0 };
    bent.axes.as_dmat3() * ((side * psi.sin() + DVec3::Z * psi.cos()) * ray.delay)
}

#[test]
fn luminous_length_is_right_through_bent_light() {
    let streaks = FlatAurora::numbered(4).streaks(40);
    let streak = &streaks[7];
    // The middle of the streak's light nearly behind the hole, so that its image is drawn out far along the Einstein ring, in both orders:
    // no one chord is right there. Turned so that field and line of sight make every angle.
    let target = DVec3::new(0.06, 0.0, -24.0);
    let lit = streak.top.as_dvec3().lerp(streak.end.as_dvec3(), 0.9);
    let (toward, axis) = (DVec3::new(-0.06, 0.0, 36.0).normalize(), DVec3::new(0.3, 1.0, 0.0).normalize());
    for order in [1, 2] {
        for degrees in (1..=90).map(f64::from) {
            let facing = DQuat::from_axis_angle(axis, degrees.to_radians()) * toward;
            let slice = || lensing::Slice::new(table(), 12.0);
            let from = |at: DVec3| Eye::bent(slice(), 12.0, &Planet { at, radius: 0.8, facing }, 50f64.to_radians(), [1920, 1080], order);
            let bent = from(target).bent.unwrap();
            let off = bent.origin.as_dvec3() + bent.place.as_dmat3() * lit + DVec3::Z * 12.0 - target;
            let eye = from(target - off);
            let exact = points_of(&STRAIGHT, Method::Exact, &eye, &streaks).remove(7);
            let wrong = wrong_ends(&exact, &eye, streak, &exact, |place| by_exact_ray(&eye, place));
            assert_eq!(wrong, None, "order {order}, {degrees}°");
        }
    }
}

#[test]
fn the_exact_walk_is_the_particle_method() {
    for (view, name) in Viewpoint::ALL {
        let eye = view.eye([640, 360], table());
        let (mut worst, mut worst_linear, mut compared) = (0.0f32, 0.0f32, 0);
        let streaks = FlatAurora::numbered(2).streaks(300);
        let all = [Method::Particles, Method::Exact, Method::Linear, Method::Tabled].map(|method| all_points(method, &eye, &streaks));
        // The tabulated falls are those of the particle method, collision by collision, at the same places to rounding.
        let near = |a: &Point, b: &Point| (a.level, a.count) == (b.level, b.count) && (a.x - b.x).hypot(a.y - b.y) < 0.01;
        assert!(all[0].iter().zip(&all[3]).all(|(a, b)| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b))), "{name}");
        for ((want, got), linear) in all[0].iter().zip(&all[1]).zip(&all[2]) {
            assert_eq!(want.len(), got.len(), "{name}");
            for (a, b) in want.iter().zip(got) {
                assert_eq!((a.level, a.count), (b.level, b.count), "{name}");
                worst = worst.max((a.x - b.x).hypot(a.y - b.y));
                compared += 1;
            }
            for a in linear {
                if let Some(b) = want.iter().find(|b| b.level == a.level) {
                    worst_linear = worst_linear.max((a.x - b.x).hypot(a.y - b.y));
                }
            }
        }
        assert!(compared > 5000, "{name}: {compared}");
        // Flat: rounding of f32 at a thousand kilometres. Bent: the chords' tolerance of 0.25 pixels, twice where the bend is uneven.
        let allowed = if view == Viewpoint::Bent { 0.5 } else { 0.02 };
        assert!(worst < allowed, "{name}: points are up to {worst} px apart");
        if view == Viewpoint::Below {
            assert!(worst_linear > 10.0, "{name}: the linear walk is right to {worst_linear} px");
        }
    }
}

#[test]
fn pictures_agree_with_the_line_integral() {
    let sheet = FlatAurora::numbered(1);
    let emission = Emission::new(&sheet, &FALLS_TABLE, 4.0);
    // Measured: exact 0.071, 0.118, 0.083; linear 1.023, 1.468, 1.534 times as much. From the side the field lies along the picture, and
    // both walks are nearly one.
    for (view, most, times) in [(Viewpoint::Side, 0.10, 1.01), (Viewpoint::Below, 0.2, 1.3), (Viewpoint::Orbit, 0.12, 1.3)] {
        let eye = view.eye([192, 108], table());
        let truth = emission.picture(&eye, 1.0);
        let picture = |method: Method| {
            let mut picture = SplatPicture::new(eye.size);
            let found = all_points(method, &eye, &sheet.streaks(8000)).concat();
            picture.add(&found, &FALLS_TABLE, 4.0, &Gaussian::default());
            picture.error(&truth)
        };
        let (exact, linear) = (picture(Method::Exact), picture(Method::Linear));
        println!("{view:?}: exact {exact}, linear {linear}");
        assert!(exact < most && linear > times * exact);
    }
}

/// The sum of Gaussians itself, without cut-off or table; standard deviations from half a pixel to 40.
fn direct_sum(size: [usize; 2], points: &[Point], radius: f64) -> SplatPicture {
    let mut picture = SplatPicture::new(size);
    for point in points {
        let sigma = (radius * f64::from(point.scale)).clamp(0.5, 40.0);
        let weight = f64::from(point.count) * f64::from(point.scale).powi(2) / (std::f64::consts::TAU * sigma * sigma);
        let light = FALLS_TABLE.light[point.level as usize].map(|line| f64::from(line) * weight);
        for (k, pixel) in picture.pixels.iter_mut().enumerate() {
            let (dx, dy) = ((k % size[0]) as f64 + 0.5 - f64::from(point.x), (k / size[0]) as f64 + 0.5 - f64::from(point.y));
            let g = (-0.5 * (dx * dx + dy * dy) / (sigma * sigma)).exp();
            (0..4).for_each(|line| pixel[line] += (light[line] * g) as f32);
        }
    }
    picture
}

#[test]
fn a_picture_is_the_sum_of_gaussians() {
    let eye = Viewpoint::Side.eye([96, 54], table());
    for radius in [1.0, 8.0, 40.0] {
        let found = all_points(Method::Exact, &eye, &FlatAurora::numbered(0).streaks(50)).concat();
        let mut picture = SplatPicture::new(eye.size);
        picture.add(&found, &FALLS_TABLE, radius, &Gaussian::default());
        let off = picture.error(&direct_sum(eye.size, &found, f64::from(radius)));
        println!("splats of {radius} km: off by {off}");
        // A hundredth of the light lies beyond the reach of a splat. Splats of half a pixel lose most by it: measured 0.014.
        assert!(off < 0.02);
    }
}

#[test]
fn the_experiment_makes_its_table() {
    let request = ExperimentRequest { auroras: 1, counts: vec![50], radii: vec![3.0], size: [64, 36], repeats: 1 };
    let rows = run(&request, table(), |_| ());
    assert_eq!(rows.len(), Viewpoint::ALL.len() * Method::ALL.len());
    assert!(rows.iter().all(|row| row.error.is_finite() && row.total > 0.0));
    for (_, view) in Viewpoint::ALL {
        let of = |method: &str| rows.iter().find(|row| row.view == view && row.method == method).unwrap();
        let difference = |method: &str| of(method).difference;
        println!("{view}: exact {}, linear {}", difference("exact"), difference("linear"));
        assert_eq!(difference("particles"), 0.0, "{view}");
        // In flat space rounding, in splats that are tabulated a step of the table here and there: 1.2e-4 of these 50 electrons from below.
        // Through bent light the lattice's tolerance, a quarter of a pixel: 0.005 of splats that are as wide as these.
        let allowed = if view == "bent" { 0.01 } else { 3e-4 };
        assert!(difference("exact") < allowed, "{view}: {}", difference("exact"));
        assert!(view != "below" || difference("linear") > 0.1, "linear, {view}: {}", difference("linear"));
    }
}

/// Eyes in awkward places: inside the aurora, before and behind it, along the field, at a streak's end, with the photon sphere between.
fn any_eye() -> impl Strategy<Value = Eye> {
    let coordinate = prop_oneof![Just(0.0), -900.0..900.0, -5.0..5.0];
    (coordinate.clone(), coordinate.clone(), prop_oneof![Just(0.0), 0.0..1000.0], coordinate.clone(), coordinate, 0usize..6).prop_map(
        |(x, y, z, tx, ty, kind)| {
            let size = [320, 180];
            let position = DVec3::new(x, y, z);
            match kind {
                0..3 => Eye::flat(position, DVec3::new(tx, ty, 150.0), DVec3::Z, 1.2, size),
                3 => Eye::flat(position, position + field_direction(), DVec3::Z, 2.8, size),
                4 => {
                    // The planet at the photon sphere, and the camera wherever.
                    let l = 1.6 + z / 50.0;
                    let planet = Planet { at: DVec3::new(x, y, z + 1.0).normalize() * 1.5, radius: 0.2, facing: DVec3::new(tx, ty, 1.0) };
                    Eye::bent(lensing::Slice::new(table(), l), l, &planet, 1.0, size, 2)
                }
                _ => {
                    // Exactly behind the hole: the Einstein ring.
                    let planet = Planet { at: DVec3::new(0.0, 0.0, -10.0), radius: 0.8, facing: DVec3::Z };
                    Eye::bent(lensing::Slice::new(table(), 10.0), 10.0, &planet, 1.0, size, 1)
                }
            }
        },
    )
}

fn any_streak() -> impl Strategy<Value = Streak> {
    let number = prop_oneof![Just(0.0f32), -900.0f32..900.0, Just(1e30), Just(f32::NAN)];
    let end = prop_oneof![Just(84.0f32), Just(-1e5), Just(419.0), 84.0f32..400.0];
    let energy = prop_oneof![Just(0.0f32), Just(1e9), 1.0f32..15_000.0, Just(f32::NAN)];
    (number.clone(), number, end, energy, 0u32..FALLS as u32, any::<u32>()).prop_map(|(x, y, end, collisions, row, id)| {
        let up = field_direction().as_vec3();
        let at = |z: f32| Vec3::new(x, y, 110.0) + up * ((z - 110.0) / up.z);
        Streak { top: at(TOP as f32), end: at(end), end_height: end, collisions, row, id }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(6), ..ProptestConfig::default() })]

    #[test]
    fn nothing_breaks_a_walk(eye in any_eye(), streak in any_streak()) {
        for (method, name) in Method::ALL {
            let found = points(method, &eye, &streak);
            prop_assert!(found.len() <= FALLS_TABLE.heights.len(), "{name}: {} points", found.len());
            // Nearer than a kilometre, behind the camera and where there is no ray nothing is drawn; 1e-5: rounding of the reciprocal.
            let nearest = eye.focal * eye.scale() / eye.near() * (1.0 + 1e-5);
            prop_assert!(found.iter().all(|point| point.scale > 0.0 && point.scale <= nearest), "{name}: {found:?}");
            let mut picture = SplatPicture::new(eye.size);
            picture.add(&found, &FALLS_TABLE, 2.0, &Gaussian::default());
            prop_assert!(picture.pixels.iter().flatten().all(|light| light.is_finite() && *light >= 0.0), "{name}");
        }
    }
}
