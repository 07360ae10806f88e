//! Where the judge could miss what is there: bodies from afar, cameras in the plane of a surface, bodies behind the horizon, corners and
//! edges.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DQuat, DVec3};
use lensrunner::judge::picture::{BodyMotion, Pose, Seen, Sway, World, Worldline};
use lensrunner::judge::{EnergySign, shoot};
use lensrunner::scene::Model;

use crate::judge::{model, thing};

const TOLERANCE: f64 = 1e-12;

/// A square of this half side in the plane through the origin with normal x.
fn square(half: f64) -> Model {
    let corner = |y: f64, z: f64| DVec3::new(0.0, half * y, half * z);
    model(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], &[[0, 1, 2], [0, 2, 3]])
}

/// Along the x axis at this rate of x, whatever the hole does to others.
struct Along {
    start: f64,
    rate: f64,
}

impl Worldline for Along {
    fn at(&self, time: f64) -> Pose {
        let x = self.start + self.rate * time;
        // dx/dT = p/γ − βn.
        let v = self.rate + x.signum() / x.abs().sqrt();
        Pose { position: DVec3::X * x, momentum: DVec3::X * (v / (1.0 - v * v).sqrt()), attitude: DQuat::IDENTITY }
    }
}

#[test]
fn a_ship_from_afar_is_seen_where_it_was() {
    let far = DVec3::new(-900.0, 0.0, 0.0);
    let models = [square(0.5), square(0.01)];
    // The last two are met by light 190 and 1,800 r_s/c old.
    for (start, rate) in [(30.0, -0.7), (20.0, -0.9), (30.0, -0.99)] {
        let ship = Along { start, rate };
        let prop = thing(1, BodyMotion::Static { position: far, attitude: DQuat::IDENTITY });
        let alone = World::new(&models, vec![thing(0, BodyMotion::Flying(&ship))], 0.0, true);
        let beside = World::new(&models, vec![thing(0, BodyMotion::Flying(&ship)), prop], 0.0, true);
        let camera = DVec3::new(10.0, 0.0, 0.0);
        for look in [DVec3::X, DVec3::new(1.0, 1e-5, 2e-5).normalize()] {
            let seen = alone.look(camera, look, TOLERANCE);
            assert!(matches!(seen, Seen::Hit(hit) if hit.object == 0 && hit.delay > 30.0), "{start} {rate}: {seen:?}");
            assert_eq!(seen, beside.look(camera, look, TOLERANCE), "{start} {rate}");
            assert_eq!(vec![seen], alone.look_together(camera, &[look], TOLERANCE, &mut |_, _| ()));
        }
        // Without a hole: x = 10 + d meets x = start − rate·d.
        let ship = Along { start: start + 1000.0, rate };
        let flat = World::new(&models, vec![thing(0, BodyMotion::Flying(&ship))], 0.0, false);
        let delay = (start + 990.0) / (1.0 + rate);
        let seen = flat.look(camera, DVec3::X, TOLERANCE);
        assert!(matches!(seen, Seen::Hit(hit) if (hit.delay / delay - 1.0).abs() < 1e-9), "{start} {rate}: {seen:?}");
    }
}

#[test]
fn a_camera_in_the_plane_of_a_wall_sees_what_cameras_beside_it_see() {
    let models = [square(2.5)];
    let turn = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    // Before the camera, and all round it; above the hole light is bent back down to the wall.
    for (x, height) in [(4.0, 10.0), (0.5, 10.0), (4.0, 3.0)] {
        let wall = thing(0, BodyMotion::Static { position: DVec3::new(x, 0.0, height), attitude: turn });
        let world = World::new(&models, vec![wall], 0.0, true);
        let hits = |z: f64| -> Vec<bool> {
            (0..60 * 60)
                .map(|i| {
                    // About level for who is at rest: in the rain frame light comes from farther in.
                    let level = DVec3::new(1.0, f64::from(i % 60) / 60.0 - 0.5, 0.3 * f64::from(i / 60) / 60.0 - 0.1);
                    let look = (level.normalize() * (1.0 - 1.0 / height).sqrt() - DVec3::Z / height.sqrt()).normalize();
                    matches!(world.look(DVec3::new(0.0, 0.0, z), look, TOLERANCE), Seen::Hit(_))
                })
                .collect()
        };
        let [in_plane, above, below] = [0.0, 1e-9, -1e-9].map(|off| hits(height + off));
        let sure: Vec<usize> = (0..in_plane.len()).filter(|&i| above[i] == below[i]).collect();
        let seen = sure.iter().filter(|&&i| above[i]).count();
        assert!(sure.len() > 100 && seen > 50, "{x} {height}: {} {seen}", sure.len());
        let missed = sure.iter().filter(|&&i| in_plane[i] != above[i]).count();
        assert_eq!(missed, 0, "{x} {height}: of {seen}");
    }
}

/// Free fall from rest at infinity along the x axis, until it has come to the singularity.
struct Faller {
    start: f64,
    looked: AtomicUsize,
}

impl Faller {
    fn from(start: f64) -> Faller {
        Faller { start, looked: AtomicUsize::new(0) }
    }
}

impl Worldline for Faller {
    fn at(&self, time: f64) -> Pose {
        self.looked.fetch_add(1, Ordering::Relaxed);
        let r = (self.start.powf(1.5) - 1.5 * time).max(0.001).powf(2.0 / 3.0);
        Pose { position: DVec3::X * r, momentum: DVec3::ZERO, attitude: DQuat::IDENTITY }
    }
}

#[test]
fn what_crossed_the_horizon_is_seen_for_ever_and_ever_redder() {
    let models = [square(0.05)];
    let ship = Faller::from(1.75);
    let camera = DVec3::new(6.0, 0.0, 0.0);
    let shift = |time: f64| {
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&ship))], time, true);
        let look = DVec3::new(-1.0, 0.001, 0.0005).normalize();
        let Seen::Hit(hit) = world.look(camera, look, TOLERANCE) else { panic!("nothing at T = {time}") };
        assert_eq!(world.look_together(camera, &[look], TOLERANCE, &mut |_, _| ()), vec![Seen::Hit(hit)]);
        world.surface(&hit, 1.0).g
    };
    // Light that clings to the horizon falls off as e^(−T/2).
    for time in [25.0, 32.0, 40.0, 90.0] {
        let (g, later) = (shift(time), shift(time + 2.0));
        assert!((later / g * 1f64.exp() - 1.0).abs() < 5e-3, "T = {time}: {g:e} {later:e}");
    }
}

#[test]
fn a_body_that_has_ended_costs_no_light_its_time() {
    let models = [square(0.05)];
    let calls = |time: f64, camera: DVec3| {
        let ship = Faller::from(1.75);
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&ship))], time, true);
        for i in 0..400 {
            let look = DVec3::new(-1.0, f64::from(i % 20) / 20.0 - 0.5, f64::from(i / 20) / 20.0 - 0.5).normalize();
            world.look(camera, look, TOLERANCE);
        }
        ship.looked.load(Ordering::Relaxed)
    };
    let before = calls(0.0, DVec3::X * 6.0);
    for (time, camera) in [(30.0, 6.0), (60.0, 6.0), (3.0, 0.3)] {
        let after = calls(time, DVec3::X * camera);
        assert!(after < 20 * before + 100_000, "{after} looks at the worldline at T = {time} from r = {camera}, {before} at T = 0");
    }
}

/// A ball of 20·4^n triangles about the origin: every corner and the middle of every edge.
fn ball(radius: f64, halvings: usize) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<DVec3>) {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners: Vec<DVec3> = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        corners.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    // Three corners that are an edge apart each.
    let near = |a: DVec3, b: DVec3| (a.distance(b) - 2.0).abs() < 1e-9;
    let mut triangles = Vec::new();
    for i in 0..12u32 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let [a, b, c] = [i, j, k].map(|n| corners[n as usize]);
                if near(a, b) && near(b, c) && near(c, a) {
                    triangles.push([i, j, k]);
                }
            }
        }
    }
    for _ in 0..halvings {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                corners.push((corners[a as usize].normalize() + corners[b as usize].normalize()).normalize());
                corners.len() as u32 - 1
            })
        };
        let split = |[a, b, c]: [u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    // As the model keeps them, in f32.
    let corners: Vec<DVec3> = corners.iter().map(|v| (v.normalize() * radius).as_vec3().as_dvec3()).collect();
    let mut aims = corners.clone();
    for t in &triangles {
        for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
            if a < b {
                aims.push(0.5 * (corners[a as usize] + corners[b as usize]));
            }
        }
    }
    (corners, triangles, aims)
}

/// Round the hole at r = 30 and turning, faster than any ship.
struct Round;

impl Worldline for Round {
    fn at(&self, time: f64) -> Pose {
        let angle = 0.01 * time + 0.4;
        let outward = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let v = DVec3::new(-angle.sin(), angle.cos(), 0.0) * 0.3 + outward / 30f64.sqrt();
        let momentum = v / (1.0 - v.length_squared()).sqrt();
        Pose { position: 30.0 * outward, momentum, attitude: DQuat::from_rotation_y(0.2 * time) }
    }
}

/// The look and delay at which a camera at `camera` sees the place on the nearest way.
fn aim(camera: DVec3, place: DVec3) -> (DVec3, f64) {
    let (outward, r) = (camera.normalize(), place.length());
    let across = place.reject_from(outward).normalize();
    let seen = shoot(r, place.angle_between(camera), camera.length(), 1, EnergySign::Plus, 1e-17).unwrap();
    (outward * seen.psi_rain.cos() + across * seen.psi_rain.sin(), seen.delay)
}

#[test]
fn closed_bodies_do_not_leak_at_corners_and_edges() {
    let camera = DVec3::new(-3.0, 11.0, 4.0);
    let (position, attitude) = (DVec3::new(27.0, 12.0, 5.0), DQuat::from_rotation_x(0.7));
    let mut aimed = 0;
    // Triangles of a fifth of r_s down to 10^-5.
    for (radius, halvings) in [(0.3, 1), (0.02, 3), (2e-4, 2), (2e-5, 1)] {
        let (corners, triangles, aims) = ball(radius, halvings);
        let models = [model(&corners, &triangles)];
        let still = World::new(&models, vec![thing(0, BodyMotion::Static { position, attitude })], 0.0, true);
        for (number, &point) in aims.iter().enumerate() {
            let place = position + attitude * point;
            // Not along the outline, where it may pass.
            let facing = (place - position).normalize().dot((place - camera).normalize());
            if facing.abs() < 0.4 {
                continue;
            }
            let (look, delay) = aim(camera, place);
            let seen = still.look(camera, look, 1e-15);
            let Seen::Hit(hit) = seen else { panic!("held, radius {radius}, aim {number}: {seen:?}") };
            assert!(facing > 0.0 || (hit.delay - delay).abs() < 1e-9 + 1e-3 * radius, "{radius} {number}: {} {delay}", hit.delay);
            aimed += 1;
            if number % 3 > 0 {
                continue;
            }
            // The same point of a flying ball, at the moment when it is there.
            let pose = Round.at(0.0);
            let place = pose.place_of(point);
            let out = (place - pose.position).normalize().dot((place - camera).normalize());
            if out.abs() < 0.6 {
                continue;
            }
            let (look, delay) = aim(camera, place);
            let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&Round))], delay, true);
            let seen = world.look(camera, look, 1e-15);
            let Seen::Hit(hit) = seen else { panic!("flying, radius {radius}, aim {number}: {seen:?}") };
            assert!(out > 0.0 || (hit.delay - delay).abs() < 1e-9 + 1e-3 * radius, "{radius} {number}: {} {delay}", hit.delay);
            aimed += 1;
        }
    }
    assert!(aimed > 500, "{aimed}");
    // From inside: a ball around hole and camera.
    let (corners, triangles, aims) = ball(20.0, 1);
    let models = [model(&corners, &triangles)];
    let around = World::new(&models, vec![thing(0, BodyMotion::Static { position: DVec3::ZERO, attitude })], 0.0, true);
    for point in aims {
        let (look, delay) = aim(camera, attitude * point);
        let seen = around.look(camera, look, 1e-15);
        assert!(matches!(seen, Seen::Hit(hit) if (hit.delay - delay).abs() < 1e-9), "{point}: {seen:?} {delay}");
    }
}

/// At rest, but for one moment of which nothing is known.
struct Forgetful {
    place: DVec3,
    moment: f64,
}

impl Worldline for Forgetful {
    fn at(&self, time: f64) -> Pose {
        let position = if (time - self.moment).abs() < 1e-3 { DVec3::NAN } else { self.place };
        Pose { position, momentum: DVec3::ZERO, attitude: DQuat::IDENTITY }
    }
}

#[test]
fn a_body_is_seen_beside_a_moment_of_which_nothing_is_known() {
    let models = [square(0.01)];
    for k in 0..64 {
        let moment = 2.0 + f64::from(k) / 128.0;
        let line = Forgetful { place: DVec3::X * (moment + 2e-3), moment: -moment };
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&line))], 0.0, false);
        assert!(matches!(world.look(DVec3::ZERO + 1e-9 * DVec3::X, DVec3::X, TOLERANCE), Seen::Hit(_)), "{moment}");
    }
}

/// Falls along x, evenly faster, as seen by one who floats: light that crosses its path runs along a parabola in its axes.
struct Falls(f64);

impl Worldline for Falls {
    fn at(&self, time: f64) -> Pose {
        Pose { position: DVec3::X * (0.5 * self.0 * time * time), momentum: DVec3::ZERO, attitude: DQuat::IDENTITY }
    }

    fn sway(&self, from: f64, to: f64) -> Option<Sway> {
        Some(Sway { velocity: self.0 * from.abs().max(to.abs()), acceleration: self.0, ..Sway::default() })
    }
}

#[test]
fn light_that_dips_through_a_flying_triangle_and_back_is_stopped() {
    let models = [square(1.0)];
    let mut dips = 0;
    for k in 0..400 {
        let [fall, share] = [0.05 + 0.002 * f64::from(k % 97), f64::from(k % 31) / 31.0];
        // The light is in the square's plane when the body is at `depth`; the two moments lie this much before and after T = 0.
        let half = 0.7 * 0.97f64.powi(k);
        let depth = 0.5 * fall * half * half;
        let line = Falls(fall);
        // The camera, at T = 5, sees at the delay `5 − T` light of the moment T, there at y = 5 − (5 − T) + offset.
        let (offset, y0) = (0.6 * (share - 0.5), 5.0);
        let camera = DVec3::new(depth, y0 + offset, 0.3);
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&line))], 5.0, false);
        // Followed backwards it meets the body first at T = half: then where y = half + offset.
        let met = [half, -half].into_iter().find(|time| (time + offset).abs() < 1.0);
        match (met, world.look(camera, -DVec3::Y, TOLERANCE)) {
            (Some(time), Seen::Hit(hit)) => assert!((hit.delay - (5.0 - time)).abs() < 1e-6, "{k}: {} for {}", hit.delay, 5.0 - time),
            (None, Seen::Sky { .. }) => continue,
            other => panic!("dip of {half}: {other:?}"),
        }
        dips += 1;
    }
    assert!(dips > 390, "{dips}");
}
