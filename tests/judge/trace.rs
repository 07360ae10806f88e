//! What a pixel shows: triangles met by the curve itself, against shooting.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use lensrunner::judge::trace::PixelCamera;
use lensrunner::judge::{EnergySign, shoot};
use lensrunner::spacetime::Observer;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use crate::judge::brute::{Mesh, Seen, trace};

const TOLERANCE: f64 = 1e-15;

/// A small triangle around `centre`, facing any which way.
fn small_triangle(centre: DVec3, size: f64, rng: &mut StdRng) -> Mesh {
    let spin = DQuat::from_xyzw(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), 1.0).normalize();
    let corner = |angle: f64| centre + size * (spin * DVec3::new(angle.cos(), angle.sin(), 0.0));
    Mesh { vertices: [0.3, 2.4, 4.5].map(corner).to_vec(), triangles: vec![[0, 1, 2]] }
}

#[test]
fn a_triangle_is_met_where_shooting_says() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut met = 0;
    for i in 0..300 {
        let l: f64 = [0.4, 0.95, 1.2, 2.0, 12.0][i % 5];
        let r = rng.random_range(1.1..20.0);
        let phi = rng.random_range(0.05..3.0);
        let order = rng.random_range(1..=3u32);
        let seen = shoot(r, phi, l, order, EnergySign::Plus, 1e-17).unwrap();
        // The camera on z, the plane of the orbit through x; even orders come from the other side.
        let point = r * DVec3::new(f64::sin(phi), 0.0, f64::cos(phi));
        let side = if order == 2 { -1.0 } else { 1.0 };
        let look = DVec3::new(side * seen.psi_rain.sin(), 0.0, seen.psi_rain.cos());
        let mesh = small_triangle(point, 1e-3 * r, &mut rng);
        let Seen::Hit(hit) = trace(&[Mesh::default(), mesh.clone()], l * DVec3::Z, look, TOLERANCE) else {
            panic!("missed: L {l} r {r} phi {phi} order {order}");
        };
        // Exactly through the centre, where all three weights are 1/3 (the corners are not evenly spread, but the centre is inside).
        assert_eq!((hit.object, hit.triangle), (1, 0));
        if hit.order == order {
            assert!((hit.delay - seen.delay).abs() < 1e-3 * r * 10.0);
            let at: DVec3 = (0..3).map(|k| hit.barycentrics[k] * mesh.vertices[k]).sum();
            assert!(at.distance(hit.position) < 1e-9 * r);
            assert!(hit.position.distance(point) < 1e-6 * r, "L {l} r {r} phi {phi} order {order}: {}", hit.position.distance(point) / r);
            met += 1;
        }
    }
    assert!(met > 290, "{met}");
}

#[test]
fn a_closed_shell_is_never_missed() {
    // An octahedron around hole and camera: every escaping ray must meet it, every captured one must not, with the first hit from inside.
    let corners = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z].map(|v| 15.0 * v);
    let shell = Mesh {
        vertices: corners.to_vec(),
        triangles: vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    };
    let mut rng = StdRng::seed_from_u64(6);
    for i in 0..600 {
        let position = [DVec3::new(0.0, 0.0, 0.5), DVec3::new(3.0, 1.0, -1.0), DVec3::new(0.0, 1.3, 0.0)][i % 3];
        // A third of the rays in the plane of an edge.
        let mut look = DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
        if i % 3 == 0 {
            look.x = 0.0;
        }
        match (trace(&[], position, look, TOLERANCE), trace(std::slice::from_ref(&shell), position, look, TOLERANCE)) {
            (Seen::Sky(_), Seen::Hit(hit)) => {
                assert!((hit.barycentrics.iter().sum::<f64>() - 1.0).abs() < 1e-9);
                assert_eq!(hit.order, (hit.swept / PI) as u32 + 1);
            }
            (Seen::Captured, Seen::Captured) => {}
            other => panic!("{position} {look}: {other:?}"),
        }
    }
}

#[test]
fn the_nearer_of_two_is_seen() {
    let square = |x: f64| Mesh {
        vertices: vec![DVec3::new(x, -1.0, -1.0), DVec3::new(x, 1.0, -1.0), DVec3::new(x, 1.0, 1.0), DVec3::new(x, -1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let meshes = [square(12.0), square(14.0), square(9.0)];
    let look = |x: f64| trace(&meshes, DVec3::X * 10.0, DVec3::new(x, 0.02, 0.01), TOLERANCE);
    assert!(matches!(look(1.0), Seen::Hit(hit) if hit.object == 0));
    assert!(matches!(look(-1.0), Seen::Hit(hit) if hit.object == 2));
}

#[test]
fn a_ship_camera_aberrates() {
    // Moving along its look at speed v through the rain: cos θ' = (cos θ + v)/(1 + v cos θ) turned round, ν/ν_rain = γ(1 + v cos θ_rain).
    let speed = 0.6f64;
    let gamma = 1.25;
    let camera = PixelCamera {
        observer: Observer {
            position: DVec3::new(9.0, 0.0, 0.0),
            momentum: DVec3::new(0.0, 0.0, -gamma * speed),
            attitude: DQuat::IDENTITY,
            field_of_view: PI / 2.0,
        },
        size: [200, 100],
    };
    let (ahead, blue) = camera.look(100.0, 50.0);
    assert!(ahead.distance(-DVec3::Z) < 1e-15);
    assert!((blue - 2.0).abs() < 1e-14, "the Doppler factor √((1+v)/(1−v)) is 2 at v = 0.6");
    let (right, _) = camera.look(200.0, 50.0);
    // 45° in the ship's frame: in the rain frame cos θ = (cos 45° − v)/(1 − v cos 45°).
    let c = 0.5f64.sqrt();
    assert!((-right.z - (c - speed) / (1.0 - speed * c)).abs() < 1e-14);
    assert!(right.x > 0.0 && right.y.abs() < 1e-15);
    let (up, _) = camera.look(100.0, 0.0);
    assert!(up.y > 0.0 && up.x.abs() < 1e-15);
    // At rest in the rain nothing is turned.
    let still = PixelCamera { observer: Observer { momentum: DVec3::ZERO, ..camera.observer }, ..camera };
    let (corner, same) = still.look(200.0, 0.0);
    assert!(corner.distance(DVec3::new(1.0, 0.5, -1.0).normalize()) < 1e-15 && (same - 1.0).abs() < 1e-15);
}
