//! Whole pictures by the judge: its trees against trying everything, flat space against straight lines, moving bodies against Lorentz.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use lensrunner::judge::picture::{BodyMotion, Pose, Seen, World, Worldline};
use lensrunner::judge::trace::PixelCamera;
use lensrunner::spacetime::Observer;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use crate::judge::brute::{self, Mesh};
use crate::judge::{model, thing};

const TOLERANCE: f64 = 1e-13;

fn static_body() -> BodyMotion<'static> {
    BodyMotion::Static { position: DVec3::ZERO, attitude: DQuat::IDENTITY }
}

fn any_direction(rng: &mut StdRng) -> DVec3 {
    loop {
        let v = DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
        if v.length() < 1.0 && v.length() > 0.01 {
            return v.normalize();
        }
    }
}

/// Triangles strewn around the hole, outside r = 1.05.
fn strewn(count: usize, size: f64, far: f64, rng: &mut StdRng) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut corners = Vec::new();
    for _ in 0..count {
        let centre = any_direction(rng) * rng.random_range(1.3..far);
        let size = size * rng.random_range(0.1..1.0) * (centre.length() - 1.05).min(1.0);
        // As the model keeps them, in f32.
        corners.extend((0..3).map(|_| (centre + size * any_direction(rng)).as_vec3().as_dvec3()));
    }
    let triangles = (0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    (corners, triangles)
}

#[test]
fn the_tree_finds_what_trying_all_triangles_finds() {
    let mut rng = StdRng::seed_from_u64(11);
    let (corners, triangles) = strewn(300, 2.5, 15.0, &mut rng);
    let models = [model(&corners, &triangles)];
    let world = World::new(&models, vec![thing(0, static_body())], 0.0, true);
    let meshes = [Mesh { vertices: corners, triangles }];
    let mut hits = 0;
    for i in 0..600 {
        // Far, near, within the photon sphere, inside the horizon.
        let position = any_direction(&mut rng) * [30.0, 7.0, 1.2, 0.6][i % 4];
        let look = any_direction(&mut rng);
        let got = world.look(position, look, TOLERANCE);
        match (brute::trace(&meshes, position, look, TOLERANCE), got) {
            (brute::Seen::Hit(want), Seen::Hit(got)) => {
                hits += 1;
                assert_eq!((want.triangle, want.order), (got.triangle, got.order), "{position} {look}");
                assert!((want.delay - got.delay).abs() < 1e-11 * (1.0 + want.delay), "{position} {look}: {} {}", want.delay, got.delay);
            }
            (brute::Seen::Sky(want), Seen::Sky { direction, .. }) => assert!(want.distance(direction) < 1e-12),
            (brute::Seen::Captured, Seen::Captured) => {}
            other => panic!("{position} {look}: {other:?}"),
        }
    }
    assert!(hits > 60, "{hits}");
}

/// A straight ray against a triangle, after Möller and Trumbore: the distance.
fn straight(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let t = origin - a;
    let q = t.cross(e1);
    let (u, v, distance) = (t.dot(p) / det, direction.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

#[test]
fn without_a_hole_light_goes_straight() {
    let mut rng = StdRng::seed_from_u64(12);
    let (corners, triangles) = strewn(2000, 1.5, 30.0, &mut rng);
    let models = [model(&corners, &triangles)];
    let world = World::new(&models, vec![thing(0, static_body())], 0.0, false);
    let mut hits = 0;
    for _ in 0..3000 {
        let position = any_direction(&mut rng) * rng.random_range(0.5..40.0);
        let look = any_direction(&mut rng);
        let want = (0..triangles.len())
            .filter_map(|t| Some((straight(position, look, triangles[t].map(|i| corners[i as usize]))?, t)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match (want, world.look(position, look, TOLERANCE)) {
            (Some((distance, triangle)), Seen::Hit(hit)) => {
                hits += 1;
                assert_eq!(hit.triangle, triangle);
                // Measured 2.5e-14.
                assert!((hit.delay - distance).abs() < 1e-12, "{} {distance}", hit.delay);
                assert!(hit.position.distance(position + look * distance) < 1e-12);
            }
            (None, Seen::Sky { direction, .. }) => assert!(direction.distance(look) < 1e-12),
            other => panic!("{position} {look}: {other:?}"),
        }
    }
    assert!(hits > 400, "{hits}");
}

/// Straight on at constant momentum, turning about an axis of its own frame.
struct Flight {
    start: DVec3,
    momentum: DVec3,
    turning: DVec3,
}

impl Worldline for Flight {
    fn at(&self, time: f64) -> Pose {
        let velocity = self.momentum / (1.0 + self.momentum.length_squared()).sqrt();
        Pose { position: self.start + velocity * time, momentum: self.momentum, attitude: DQuat::from_scaled_axis(self.turning * time) }
    }
}

#[test]
fn a_moving_body_is_seen_as_lorentz_says() {
    let mut rng = StdRng::seed_from_u64(13);
    let (mut corners, triangles) = strewn(60, 1.0, 2.5, &mut rng);
    // Around the origin of the body, with its full size in all directions.
    corners.iter_mut().for_each(|v| *v = (*v * 0.5).as_vec3().as_dvec3());
    let models = [model(&corners, &triangles)];
    let mut hits = 0;
    for _ in 0..60 {
        let flight = Flight {
            start: any_direction(&mut rng) * rng.random_range(4.0..12.0),
            momentum: any_direction(&mut rng) * rng.random_range(0.0..2.0),
            turning: DVec3::ZERO,
        };
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&flight))], 0.0, false);
        let camera = any_direction(&mut rng) * 3.0;
        let p = flight.momentum;
        let gamma = (1.0 + p.length_squared()).sqrt();
        // To the body's rest frame, whose origin is the body's centre at time 0.
        let to_rest = |x: DVec3, t: f64| (x - flight.start) + p * (p.dot(x - flight.start) / (1.0 + gamma) - t);
        for _ in 0..200 {
            // Aim about where the body was when the light left.
            let aim = flight.start - p / gamma * camera.distance(flight.start) + any_direction(&mut rng) * rng.random_range(0.0..1.5);
            let look = (aim - camera).normalize_or(DVec3::X);
            let (origin, far) = (to_rest(camera, 0.0), to_rest(camera + look, -1.0));
            let direction = far - origin;
            let want = (0..triangles.len())
                .filter_map(|t| Some((straight(origin, direction, triangles[t].map(|i| corners[i as usize]))?, t)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match (want, world.look(camera, look, TOLERANCE)) {
                (Some((delay, triangle)), Seen::Hit(hit)) => {
                    hits += 1;
                    assert_eq!(hit.triangle, triangle);
                    // Measured 1.7e-13.
                    assert!((hit.delay - delay).abs() < 1e-12, "{} {delay}", hit.delay);
                }
                (None, Seen::Sky { .. }) => {}
                other => panic!("{p} {camera} {look}: {other:?}"),
            }
        }
    }
    assert!(hits > 800, "{hits}");
}

#[test]
fn a_turning_body_beside_the_hole_is_met_on_its_own_worldline() {
    // An orbit that is no geodesic will do: a worldline is what is handed in.
    struct Circle;
    impl Worldline for Circle {
        fn at(&self, time: f64) -> Pose {
            let angle = 0.1 * time;
            let outward = DVec3::new(angle.cos(), angle.sin(), 0.0);
            let velocity = DVec3::new(-angle.sin(), angle.cos(), 0.0) * 0.6;
            // dx/dT = p/γ − βn.
            let v = velocity + outward / 6f64.sqrt();
            Pose { position: outward * 6.0, momentum: v / (1.0 - v.length_squared()).sqrt(), attitude: DQuat::from_rotation_y(0.7 * time) }
        }
    }
    let mut rng = StdRng::seed_from_u64(14);
    let (mut corners, triangles) = strewn(200, 1.0, 2.5, &mut rng);
    corners.iter_mut().for_each(|v| *v = (*v * 0.6).as_vec3().as_dvec3());
    let models = [model(&corners, &triangles)];
    let time = 40.0;
    let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&Circle))], time, true);
    let camera = DVec3::new(-9.0, 3.0, 4.0);
    let (mut hits, mut orders) = (0, [0; 4]);
    for i in 0..12000 {
        // Half of the rays towards the orbit, half past the hole, where the second image is (aberrated inwards in the rain frame).
        let any = any_direction(&mut rng);
        let past = any.reject_from(camera).normalize() * rng.random_range(1.7..2.2);
        let look = (if i % 2 == 0 { any * 7.0 } else { past } - camera).normalize();
        let Seen::Hit(hit) = world.look(camera, look, TOLERANCE) else { continue };
        hits += 1;
        orders[hit.order.min(3) as usize] += 1;
        let pose = Circle.at(time - hit.delay);
        let body: DVec3 = (0..3).map(|k| hit.barycentrics[k] * corners[triangles[hit.triangle][k] as usize]).sum();
        // Measured less than 1e-13.
        assert!(pose.place_of(body).distance(hit.position) < 1e-12);
        // Nothing was passed before: along the ray in steps of a hundredth, no triangle's plane is crossed inside the triangle.
        let ray = lensrunner::judge::TracedRay::trace(
            camera,
            look,
            TOLERANCE,
            &lensrunner::judge::Stop { delay: hit.delay, ..Default::default() },
        );
        if i % 8 > 1 {
            continue;
        }
        let in_body = |delay: f64| ray.at_delay(delay).map(|s| Circle.at(time - delay).to_body(s.position));
        let mut before = in_body(0.0).unwrap();
        let steps = (hit.delay / 0.01) as usize;
        for k in 1..steps {
            let here = in_body(0.01 * k as f64).unwrap();
            if here.length() < 2.0 {
                for t in &triangles {
                    let met = straight(before, here - before, t.map(|i| corners[i as usize]));
                    assert!(met.is_none_or(|part| part > 1.0), "order {}: passed through at {}", hit.order, 0.01 * k as f64);
                }
            }
            before = here;
        }
    }
    assert!(hits > 100 && orders[2] > 10, "{hits} {orders:?}");
}

#[test]
fn halving_the_tolerance_moves_no_hit() {
    let mut rng = StdRng::seed_from_u64(15);
    let (corners, triangles) = strewn(2000, 1.0, 20.0, &mut rng);
    let models = [model(&corners, &triangles)];
    let world = World::new(&models, vec![thing(0, static_body())], 0.0, true);
    let mut hits = 0;
    for i in 0..1000 {
        let position = any_direction(&mut rng) * [30.0, 5.0, 1.2, 0.5][i % 4];
        let look = any_direction(&mut rng);
        match (world.look(position, look, 1e-12), world.look(position, look, 5e-13)) {
            (Seen::Hit(a), Seen::Hit(b)) => {
                hits += 1;
                assert_eq!((a.triangle, a.order), (b.triangle, b.order));
                // Measured 3.4e-10.
                assert!(a.position.distance(b.position) < 1e-9, "order {}: {}", a.order, a.position.distance(b.position));
            }
            (Seen::Sky { .. }, Seen::Sky { .. }) | (Seen::Captured, Seen::Captured) => {}
            other => panic!("{position} {look}: {other:?}"),
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn a_camera_sees_where_it_looks() {
    let mut rng = StdRng::seed_from_u64(16);
    for _ in 0..200 {
        let camera = PixelCamera {
            observer: Observer {
                position: DVec3::new(9.0, 0.0, 0.0),
                momentum: any_direction(&mut rng) * rng.random_range(0.0..3.0),
                attitude: DQuat::from_scaled_axis(any_direction(&mut rng) * rng.random_range(0.0..PI)),
                field_of_view: rng.random_range(0.3..2.5),
            },
            size: [640, 360],
        };
        let (x, y) = (rng.random_range(0.0..640.0), rng.random_range(0.0..360.0));
        let (look, blue) = camera.look(x, y);
        let (place, again) = camera.seen_at(look).unwrap();
        assert!((place[0] - x).hypot(place[1] - y) < 1e-9 && (again / blue - 1.0).abs() < 1e-12);
        assert!(camera.seen_at(-look).is_none_or(|(place, _)| (place[0] - x).hypot(place[1] - y) > 1.0));
    }
}

#[test]
fn stars_are_seen_where_shooting_sees_them() {
    use glam::Vec3;
    use lensrunner::judge::picture::shade::LightShift;
    use lensrunner::judge::picture::sky::stars;
    use lensrunner::judge::shoot_sky;
    use lensrunner::scene::sky::stars::Star;
    let mut rng = StdRng::seed_from_u64(17);
    let mut seen = [0; 3];
    for radius in [0.6, 1.2, 8.0] {
        let camera = PixelCamera {
            observer: Observer { position: DVec3::Z * radius, momentum: DVec3::ZERO, attitude: DQuat::IDENTITY, field_of_view: 2.4 },
            size: [1000, 1000],
        };
        for _ in 0..30 {
            let direction = any_direction(&mut rng);
            let star = Star { direction: direction.as_vec3().normalize(), flux: 1.0, temperature: 6000.0 };
            let spots = stars(&[star], &camera, true, 1e-14, 1.0, LightShift { doppler: true, beaming: true });
            let direction = star.direction.as_dvec3().normalize();
            let across = DVec3::new(direction.x, direction.y, 0.0);
            let phi = across.length().atan2(direction.z);
            for order in 1..=2u32 {
                let Some(sighting) = shoot_sky(phi, radius, order, 1e-15) else { continue };
                let side = across.normalize() * if order == 2 { -1.0 } else { 1.0 };
                let look = DVec3::Z * sighting.psi_rain.cos() + side * sighting.psi_rain.sin();
                let Some((place, _)) = camera.seen_at(look) else { continue };
                let near =
                    spots.iter().map(|spot| (spot.place[0] - place[0]).hypot(spot.place[1] - place[1])).fold(f64::INFINITY, f64::min);
                if (0.0..1000.0).contains(&place[0]) && (0.0..1000.0).contains(&place[1]) {
                    assert!(near < 1e-5, "radius {radius}, order {order}, Φ {phi}: {near} px off");
                    seen[order as usize] += 1;
                }
            }
            assert!(spots.iter().all(|spot| spot.light.min_element() >= 0.0 && spot.light != Vec3::ZERO));
        }
    }
    assert!(seen[1] > 10 && seen[2] > 10, "{seen:?}");
}

#[test]
fn crossings_of_the_disk_are_those_of_the_closed_form() {
    use lensrunner::spacetime::light::{Branch, connect};
    let world = World::new(&[], Vec::new(), 0.0, true);
    let mut rng = StdRng::seed_from_u64(23);
    let (mut checked, mut second) = (0, 0);
    for _ in 0..700 {
        let position = any_direction(&mut rng) * rng.random_range(1.6..40.0);
        let mut crossings = Vec::new();
        world.look_through(position, any_direction(&mut rng), TOLERANCE, &mut |crossing| crossings.push(crossing));
        for (k, crossing) in crossings.iter().enumerate().take(2) {
            let (r, camera) = (crossing.position.length(), position.length());
            if !(1.2..100.0).contains(&r) {
                continue;
            }
            assert_eq!(crossing.position.z, 0.0);
            // A ray meets the plane once in each half turn.
            let phi = crossing.position.angle_between(position);
            let rays = [phi, 2.0 * PI - phi].map(|swept| connect(1.0 / r, swept, 1.0 / camera, Branch::Plus));
            let off = rays.iter().flatten().map(|ray| (ray.delay - crossing.delay).abs()).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-8 * (1.0 + crossing.delay), "{position:?} {crossing:?}: {off:e}");
            checked += 1;
            second += k;
        }
    }
    assert!(checked > 200 && second > 2, "{checked} {second}");
}

/// The directions of a small screen's pixels seen by a far camera, in quarters of quarters.
fn screen(side: usize, packet: usize, towards: DVec3, spread: f64) -> (Vec<DVec3>, Vec<usize>) {
    let (order, starts) = lensrunner::judge::bvh::order::squares([side, side], packet);
    let (right, up) = (towards.any_orthogonal_vector().normalize(), towards.cross(towards.any_orthogonal_vector()).normalize());
    let place = |v: usize| spread * ((v as f64 + 0.5) / side as f64 - 0.5);
    let looks = order.iter().map(|&i| (towards + right * place(i as usize % side) + up * place(i as usize / side)).normalize());
    (looks.collect(), starts)
}

/// Every number of what is seen, to the last bit.
fn bits(seen: &Seen) -> Vec<u64> {
    match seen {
        Seen::Captured => vec![0],
        Seen::Sky { direction, swept, energy } => [1.0, direction.x, direction.y, direction.z, *swept, *energy].map(f64::to_bits).to_vec(),
        Seen::Hit(hit) => {
            let (p, m) = (hit.position, hit.momentum);
            let numbers = [p.x, p.y, p.z, m.x, m.y, m.z, hit.swept, hit.delay];
            let whole = [2, hit.object as u64, hit.triangle as u64, u64::from(hit.order)];
            whole.into_iter().chain(numbers.into_iter().chain(hit.barycentrics).map(f64::to_bits)).collect()
        }
    }
}

#[test]
fn packets_of_every_size_see_what_single_rays_see() {
    let mut rng = StdRng::seed_from_u64(21);
    // Held triangles near and far round the hole, and two bodies that fly before it and through its plane.
    // Some are small and looked at from near, so that packets go past them by a little: among large ones hardly a packet misses all.
    let (mut corners, mut triangles) = strewn(60, 1.5, 12.0, &mut rng);
    let (dust, specks) = strewn(60, 0.4, 12.0, &mut rng);
    let towards_specks: Vec<(DVec3, DVec3, f64)> = dust.iter().step_by(30).map(|&v| (v * (1.0 + 4.0 / v.length()), -v, 0.15)).collect();
    triangles.extend(specks.iter().map(|triangle| triangle.map(|corner| corner + corners.len() as u32)));
    corners.extend(dust);
    let (mut small, few) = strewn(40, 1.0, 2.5, &mut rng);
    small.iter_mut().for_each(|v| *v = (*v * 0.4).as_vec3().as_dvec3());
    let models = [model(&corners, &triangles), model(&small, &few)];
    let flights = [
        Flight { start: DVec3::new(5.0, 4.0, 2.0), momentum: DVec3::new(-0.5, 0.3, -0.2), turning: DVec3::new(0.1, 0.4, 0.0) },
        Flight { start: DVec3::new(-4.0, 1.0, -6.0), momentum: DVec3::new(0.1, -0.6, 0.3), turning: DVec3::ZERO },
    ];
    let things = vec![thing(0, static_body()), thing(1, BodyMotion::Flying(&flights[0])), thing(1, BodyMotion::Flying(&flights[1]))];
    let (mut hits, mut flown, mut captured, mut crossings) = (0, 0, 0, 0);
    for hole in [true, false] {
        let world = World::new(&models, things.clone(), 3.0, hole);
        // The whole hole, a coarse screen whose neighbours part at once; its edge magnified; the near view of a body; from inside.
        let views = [
            (DVec3::new(0.0, -3.0, 14.0), DVec3::new(0.05, 0.2, -1.0), 0.7),
            (DVec3::new(0.0, -3.0, 14.0), DVec3::new(0.19, 0.2, -1.0), 0.02),
            (DVec3::new(7.0, 5.0, 3.0), DVec3::new(-1.0, -0.6, -0.6), 0.5),
            (DVec3::new(0.4, 0.5, 0.1), DVec3::new(1.0, 0.4, 0.3), 1.0),
        ];
        for (position, towards, spread) in views.into_iter().chain(towards_specks.iter().copied()) {
            for packet in [1, 2, 3, 5, 8] {
                let (looks, starts) = screen(16, packet, towards, spread);
                for tile in starts.windows(2).map(|ends| &looks[ends[0]..ends[1]]) {
                    let mut crossed = vec![Vec::new(); tile.len()];
                    let together = world.look_together(position, tile, 1e-11, &mut |ray, crossing| crossed[ray].push(crossing));
                    assert_eq!(together.len(), tile.len());
                    for (ray, look) in tile.iter().enumerate() {
                        let mut alone = Vec::new();
                        let seen = world.look_through(position, *look, 1e-11, &mut |crossing| alone.push(crossing));
                        assert_eq!(bits(&together[ray]), bits(&seen), "{packet}: {position} {look}: {:?} {seen:?}", together[ray]);
                        assert_eq!(crossed[ray], alone, "{packet}: {position} {look}");
                        hits += usize::from(matches!(seen, Seen::Hit(_)));
                        flown += usize::from(matches!(seen, Seen::Hit(hit) if hit.object > 0));
                        captured += usize::from(seen == Seen::Captured);
                        crossings += alone.len();
                    }
                }
            }
        }
    }
    assert!(hits > 1000 && flown > 100 && captured > 100 && crossings > 100, "{hits} {flown} {captured} {crossings}");
}

#[test]
fn scenes_in_packets_are_the_same_pictures() {
    use lensrunner::judge::case::Case;
    const SIZE: [usize; 2] = [40, 24];
    for name in ["ring", "chase", "parade"] {
        let scene = lensrunner::scene::load(name).unwrap();
        let case = Case::new(scene, lensrunner::scene::GameConfig::default(), 1.0, SIZE.map(|side| side as u32));
        let ships: Vec<&dyn Worldline> = case.histories.iter().map(|history| history as &dyn Worldline).collect();
        let (world, camera) = (case.world(&ships), &case.camera);
        let look = |i: usize| camera.look((i % SIZE[0]) as f64 + 0.5, (i / SIZE[0]) as f64 + 0.5).0;
        let alone: Vec<Seen> = (0..SIZE[0] * SIZE[1]).map(|i| world.look(camera.observer.position, look(i), 1e-11)).collect();
        assert!(alone.iter().any(|seen| matches!(seen, Seen::Hit(_))), "{name} shows nothing");
        for packet in 1..=8 {
            let (order, starts) = lensrunner::judge::bvh::order::squares(SIZE, packet);
            for tile in starts.windows(2).map(|ends| &order[ends[0]..ends[1]]) {
                let looks: Vec<DVec3> = tile.iter().map(|&i| look(i as usize)).collect();
                let together = world.look_together(camera.observer.position, &looks, 1e-11, &mut |_, _| ());
                for (seen, &i) in together.iter().zip(tile) {
                    assert_eq!(bits(seen), bits(&alone[i as usize]), "{name}, packets of {packet}, pixel {i}");
                }
            }
        }
    }
}
