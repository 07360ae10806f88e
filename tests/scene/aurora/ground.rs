//! The aurora's light on the ground against closed forms and a sum over places in space.

use glam::{DVec2, DVec3};
use lensrunner::scene::aurora::curve::Curve;
use lensrunner::scene::aurora::ground::GroundMap;
use std::f64::consts::{PI, TAU};

/// The globe and the plane's reference sphere, km.
const GLOBE: f64 = 6371.0;
const SPHERE: f64 = 6481.0;

/// A straight curve along x through the pole, so far to either side, km.
fn straight(half: f64) -> Curve {
    let control = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0].map(|x| DVec2::new(half * x, 0.0));
    Curve { control, amplitude: 0.0, waves: 0.0, phase: 0.0, width: 1.0 }
}

/// A map, straight between texels.
fn read(square: (DVec2, f64), size: usize, map: &[f32], place: DVec2) -> f64 {
    let p = (place - square.0) / square.1 * size as f64 - 0.5;
    let (x, y, s) = (p.x as usize, p.y as usize, p.fract());
    let at = |x: usize, y: usize| f64::from(map[y * size + x]);
    let row = |y: usize| at(x, y) + s.x * (at(x + 1, y) - at(x, y));
    row(y) + s.y * (row(y + 1) - row(y))
}

#[test]
fn an_even_sheet_lights_the_ground_as_its_closed_form_says() {
    for height in [100.0, SPHERE - GLOBE, 130.0] {
        let map = GroundMap::new(&[straight(60.0)], height);
        // A cap of the sheet, to beyond the horizon, by its areas; its brightness is 1.
        let sphere = GLOBE + height;
        let steps = 600;
        let source = |k: u32| {
            let (ring, turn) = (k / 256, TAU * f64::from(k % 256) / 256.0);
            let angle = (f64::from(ring) + 0.5) * 0.2 / f64::from(steps);
            let area = sphere * sphere * angle.sin() * 0.2 / f64::from(steps) * TAU / 256.0;
            (DVec2::from_angle(turn) * angle * SPHERE, area)
        };
        let light = map.of((0..256 * steps).map(source));
        // L(z) = L/cos χ with sin χ = k sin z, k = R/(R + h): E = 2πL (1 − √(1 − k²))/k², which is 2πL where the ground is flat, and a
        // white ground shows E/π.
        let k = GLOBE / sphere;
        let want = 2.0 * (1.0 - (1.0 - k * k).sqrt()) / (k * k);
        for place in [DVec2::ZERO, DVec2::new(20.0, 11.0)] {
            let got = read(map.square(), map.size(), &light, place);
            // Texels a quarter of the height wide are right to a thousandth in the middle of an even sheet; that much may be rounded off at
            // the horizon as well.
            assert!((got / want - 1.0).abs() < 5e-3, "{height} km: {got} at {place}, {want} by the closed form");
        }
    }
}

#[test]
fn a_straight_curtain_lights_the_ground_as_a_line_source() {
    let height = 112.0;
    let map = GroundMap::new(&[straight(1500.0)], height);
    let places = || (-3000..3000).map(|k| 0.5 * (f64::from(k) + 0.5));
    // A kilometre wide, brightness 1.
    let light = map.of(places().map(|x| (DVec2::new(x, 0.0), 0.5)));
    let on_sphere = |place: DVec2, radius: f64| {
        let (sine, cosine) = (place.length() / SPHERE).sin_cos();
        let along = place.normalize_or_zero() * sine;
        DVec3::new(along.x, along.y, cosine) * radius
    };
    for aside in [0.0, 60.0, 150.0, 300.0, 600.0, 900.0] {
        let place = DVec2::new(25.0, aside);
        let got = read(map.square(), map.size(), &light, place);
        let ground = on_sphere(place, GLOBE);
        let from = |x: f64| {
            let way = on_sphere(DVec2::new(x, 0.0), GLOBE + height) - ground;
            0.5 * way.dot(ground.normalize()).max(0.0) / way.length().powi(3) / PI
        };
        let want: f64 = places().map(from).sum();
        // Texels of 25 km: amid two of them what is laid out on both and read from both is blurred by a variance of 25²/2, and there is
        // 25²/(2 · 112²) = 2.5 % less beneath the line.
        assert!((got / want - 1.0).abs() < 0.03, "{aside} km aside: {got}, {want} summed in space");
        if aside < 100.0 {
            // Over flat ground 2h/(h² + d²) over π; where it is round the line's ends are lower, which takes 1.4 % more.
            let flat = 2.0 * height / (height * height + aside * aside) / PI;
            assert!((got / flat - 1.0).abs() < 0.045, "{aside} km aside: {got}, {flat} over flat ground");
        }
    }
    // Below the horizon, 1,209 km away, there is nothing; coarse texels of 75 km may show it a little farther.
    assert_eq!(read(map.square(), map.size(), &light, DVec2::new(0.0, 1340.0)), 0.0);
}

#[test]
fn what_is_no_place_or_beyond_the_map_lights_nothing() {
    let map = GroundMap::new(&[straight(100.0)], 110.0);
    let places = [DVec2::NAN, DVec2::INFINITY, DVec2::splat(1e6), DVec2::new(-1e300, 0.0)];
    assert!(map.of(places.into_iter().map(|place| (place, 1.0))).iter().all(|light| *light == 0.0));
    assert!(map.of([(DVec2::ZERO, f64::NAN)].into_iter()).iter().all(|light| *light == 0.0));
    let none = GroundMap::new(&[], 110.0);
    assert_eq!(none.of([(DVec2::ZERO, 1.0)].into_iter()).len(), none.size() * none.size());
}
