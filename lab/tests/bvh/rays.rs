//! Straight rays: every method against brute force in f64 and, bit for bit, against each other.

use glam::{DVec3, Vec3};
use lensrunner_lab::straight::scenes::{SceneView, TestScene, Triangle, bunny, castle, spd};
use lensrunner_lab::straight::{BvhSettings, EyePacket, EyePackets, Hit, Instructions, Mesh, Packets, Ray, Wide, order};
use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};

/// Nearest hit by trying every triangle in f64 (Möller–Trumbore), and how near to an edge the nearest miss or hit came, in shares of a
/// triangle.
fn brute(triangles: &[Triangle], ray: &Ray) -> (f64, u32, f64) {
    let origin = Vec3::from(ray.origin).as_dvec3();
    let direction = Vec3::from(ray.direction).as_dvec3();
    let (mut best, mut number, mut margin) = (f64::INFINITY, Hit::NONE, f64::INFINITY);
    for (i, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|p| Vec3::from(p).as_dvec3());
        let (e1, e2) = (b - a, c - a);
        let p = direction.cross(e2);
        let whole = e1.dot(p);
        if whole == 0.0 {
            continue;
        }
        let from = origin - a;
        let u = from.dot(p) / whole;
        let q = from.cross(e1);
        let v = direction.dot(q) / whole;
        let t = e2.dot(q) / whole;
        if t < 0.0 || t > f64::from(ray.until) {
            continue;
        }
        let least = u.min(v).min(1.0 - u - v);
        if t <= best * (1.0 + 1e-6) {
            margin = margin.min(least.abs());
        }
        if least >= 0.0 && t < best {
            (best, number) = (t, i as u32);
        }
    }
    (best, number, margin)
}

/// How many hits differ from brute force within rounding; panics at a difference that rounding does not explain.
fn differences(triangles: &[Triangle], rays: &[Ray], hits: &[Hit]) -> usize {
    let mut within = 0;
    for (ray, hit) in rays.iter().zip(hits) {
        let (t, number, margin) = brute(triangles, ray);
        let near = hit.is_hit() && (f64::from(hit.t) - t).abs() <= 2e-5 * (1.0 + t);
        if number == hit.triangle && (near || !hit.is_hit()) {
            continue;
        }
        // Another triangle at the same place (a shared edge, two surfaces that cut each other), or an edge passed within rounding.
        assert!(near || margin < 1e-3, "{ray:?}: {hit:?}, in f64 triangle {number} at {t} (margin {margin})");
        within += 1;
    }
    within
}

fn view_rays(view: &SceneView, size: [usize; 2]) -> Vec<Ray> {
    let eye = view.eye.map(|c| c as f32);
    view.directions(size).into_iter().map(|d| Ray::new(eye, d)).collect()
}

fn unit(random: &mut StdRng) -> Vec3 {
    loop {
        let v = Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
        if (0.1..1.0).contains(&v.length()) {
            return v.normalize();
        }
    }
}

/// Rays from anywhere to anywhere, some of them with an end.
fn any_rays(number: usize, size: f32, random: &mut StdRng) -> Vec<Ray> {
    (0..number)
        .map(|i| {
            let until = if i % 5 == 0 { random.random_range(0.0..size) } else { f32::INFINITY };
            let origin = (unit(random) * size * random.random::<f32>()).to_array();
            Ray { origin, direction: (unit(random) * random.random_range(0.1..3.0)).to_array(), until }
        })
        .collect()
}

/// Rays on from what the first rays hit: shadows to a light, mirrored, and scattered anywhere.
fn secondary(triangles: &[Triangle], rays: &[Ray], hits: &[Hit], random: &mut StdRng) -> Vec<Ray> {
    let mut all = Vec::new();
    for (ray, hit) in rays.iter().zip(hits).filter(|(_, hit)| hit.is_hit()) {
        let [a, b, c] = triangles[hit.triangle as usize].map(Vec3::from);
        let direction = Vec3::from(ray.direction);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let start = Vec3::from(ray.origin) + direction * hit.t + normal * 1e-4;
        let light = Vec3::new(4.0, 3.0, 2.0) - start;
        all.push(Ray { origin: start.to_array(), direction: light.to_array(), until: 1.0 });
        all.push(Ray::new(start.to_array(), (direction - 2.0 * normal * normal.dot(direction)).to_array()));
        all.push(Ray::new(start.to_array(), unit(random).to_array()));
    }
    all
}

fn soup(number: usize, random: &mut StdRng) -> Vec<Triangle> {
    (0..number)
        .map(|_| {
            let middle = unit(random) * random.random::<f32>();
            std::array::from_fn(|_| (middle + unit(random) * 0.2 * random.random::<f32>()).to_array())
        })
        .collect()
}

fn small_scenes() -> Vec<TestScene> {
    let blob = bunny::geodesic(9).into_iter().map(|t| t.map(|p| (p * 0.5).as_vec3().to_array())).collect();
    let random = &mut StdRng::seed_from_u64(1);
    vec![
        TestScene { name: "balls1", triangles: spd::balls(1), view: spd::BALLS_VIEW },
        TestScene { name: "tree3", triangles: spd::tree(3), view: spd::TREE_VIEW },
        TestScene { name: "blob", triangles: blob, view: bunny::VIEW },
        TestScene { name: "soup", triangles: soup(900, random), view: bunny::VIEW },
    ]
}

fn closest_each(wide: &Wide, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    wide.closest_each(rays, &mut hits);
    hits
}

fn closest_packet(wide: &Wide, rays: &[Ray], size: usize) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut packets = Packets::default();
    for (rays, hits) in rays.chunks(size).zip(hits.chunks_mut(size)) {
        wide.closest_packet(rays, hits, &mut packets);
    }
    hits
}

#[test]
fn every_ray_as_brute_force_finds_it() {
    let random = &mut StdRng::seed_from_u64(2);
    for scene in small_scenes() {
        let mesh = Mesh::new(&scene.triangles, &BvhSettings::default());
        let wide = Wide::new(&scene.triangles);
        let primary = view_rays(&scene.view, [64, 48]);
        let first: Vec<Hit> = primary.iter().map(|ray| mesh.closest(ray)).collect();
        let second = secondary(&scene.triangles, &primary[..1024], &first[..1024], random);
        for rays in [primary, second, any_rays(1500, 3.0, random)] {
            let plain: Vec<Hit> = rays.iter().map(|ray| mesh.closest(ray)).collect();
            let within = differences(&scene.triangles, &rays, &plain);
            assert!(within * 100 <= rays.len(), "{}: {within} of {} rays differ within rounding", scene.name, rays.len());
            assert_eq!(closest_each(&wide, &rays), plain, "{}", scene.name);
            let mut any = vec![Hit::MISS; rays.len()];
            wide.any_each(&rays, &mut any);
            for ((ray, any), hit) in rays.iter().zip(&any).zip(&plain) {
                assert_eq!(any.is_hit(), hit.is_hit());
                assert!(!any.is_hit() || (any.t >= hit.t && any.t <= ray.until), "an occluder lies between the nearest one and the end");
            }
        }
    }
}

#[test]
fn packets_of_every_size_and_order_give_the_bits_of_single_rays() {
    let random = &mut StdRng::seed_from_u64(3);
    for scene in small_scenes() {
        let wide = Wide::new(&scene.triangles);
        let slow = wide.clone().limited(Instructions::Portable);
        let half = wide.clone().limited(Instructions::Avx2);
        // Fine enough that neighbours go together: coarser rays would go one by one.
        let primary = view_rays(&scene.view, [64, 48]);
        let second = secondary(&scene.triangles, &primary, &closest_each(&wide, &primary), random);
        let mut mixed = [primary.clone(), second.clone(), any_rays(300, 3.0, random)].concat();
        mixed.shuffle(random);
        let tiled: Vec<Ray> = order::tiles([64, 48], 16).0.iter().map(|&i| primary[i as usize]).collect();
        let backwards: Vec<Ray> = tiled.iter().rev().copied().collect();
        // From one eye amid the scene: neighbours, and in all directions, some with an end.
        let amid = tiled.iter().copied().chain(any_rays(500, 3.0, random));
        let inside: Vec<Ray> = amid.map(|ray| Ray { origin: [0.05, 0.1, 0.2], ..ray }).collect();
        let ended: Vec<Ray> = tiled
            .iter()
            .map(|ray| Ray {
                until: DVec3::from(scene.view.target).distance(DVec3::from(scene.view.eye)) as f32 * random.random_range(0.5..1.5),
                ..*ray
            })
            .collect();
        // In each sixteen one ray that sees far, in the lane beside that of an end that is no number.
        let until = |i: usize| match i % 16 {
            0 => 9.0,
            8 => f32::NAN,
            _ => 0.01,
        };
        let endless: Vec<Ray> = tiled.iter().enumerate().map(|(i, ray)| Ray { until: until(i), ..*ray }).collect();
        for rays in [tiled, backwards, ended, endless, inside, second, mixed] {
            let single = closest_each(&wide, &rays);
            assert_eq!(closest_each(&slow, &rays), single, "{}: portable lanes", scene.name);
            for size in (1..=64).chain([100, 256, 1000, rays.len()]) {
                assert_eq!(closest_packet(&wide, &rays, size), single, "{}: packets of {size}", scene.name);
            }
            for size in [1, 7, 8, 64, rays.len()] {
                assert_eq!(closest_packet(&slow, &rays, size), single, "{}: portable packets of {size}", scene.name);
                assert_eq!(closest_packet(&half, &rays, size), single, "{}: packets of {size} by eight lanes", scene.name);
            }
        }
    }
}

#[test]
fn paper_four_s_packets_give_the_bits_of_single_rays() {
    for scene in small_scenes() {
        let mesh = Mesh::new(&scene.triangles, &BvhSettings::default());
        let rays = view_rays(&scene.view, [64, 32]);
        let eye = rays[0].origin;
        let forward = (DVec3::from(scene.view.target) - DVec3::from(scene.view.eye)).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let screen = [right, right.cross(forward)].map(|v| v.as_vec3().to_array());
        let mut scratch = EyePackets::default();
        for splits in 0..=3 {
            // 3 and 40 make packets that cannot be split; 32 ones that can.
            for size in [1, 2, 3, 8, 32, 40] {
                let (pixels, starts) = order::squares([64, 32], size);
                for run in starts.windows(2) {
                    let pixels = &pixels[run[0]..run[1]];
                    let directions: Vec<_> = pixels.iter().map(|&i| rays[i as usize].direction).collect();
                    let mut hits = vec![Hit::MISS; pixels.len()];
                    mesh.closest_packet(&EyePacket { eye, directions: &directions, screen }, splits, &mut hits, &mut scratch);
                    for (&pixel, hit) in pixels.iter().zip(&hits) {
                        assert_eq!(*hit, mesh.closest(&rays[pixel as usize]), "{} {splits} splits, size {size}", scene.name);
                    }
                }
            }
            // Directions in no order at all: planes that do not part the rays must not be used.
            let mut directions: Vec<_> = rays.iter().map(|r| r.direction).take(1024).collect();
            directions.shuffle(&mut StdRng::seed_from_u64(4));
            let mut hits = vec![Hit::MISS; directions.len()];
            mesh.closest_packet(&EyePacket { eye, directions: &directions, screen }, splits, &mut hits, &mut scratch);
            for (direction, hit) in directions.iter().zip(&hits) {
                assert_eq!(*hit, mesh.closest(&Ray::new(eye, *direction)));
            }
        }
    }
}

#[test]
fn orders_hold_every_pixel_once() {
    for arrange in [order::tiles, order::squares] {
        for (picture, size) in [([64, 48], 16), ([50, 31], 8), ([5, 3], 64)] {
            let (mut pixels, starts) = arrange(picture, size);
            assert_eq!((starts[0], *starts.last().unwrap()), (0, picture[0] * picture[1]));
            pixels.sort_unstable();
            assert!(pixels.iter().copied().eq(0..(picture[0] * picture[1]) as u32));
        }
    }
    let (pixels, _) = order::squares([8, 8], 4);
    assert_eq!(pixels[..8], [0, 1, 8, 9, 2, 3, 10, 11]);
    let (pixels, _) = order::tiles([8, 8], 8);
    assert_eq!(pixels[..8], [0, 1, 2, 3, 8, 9, 10, 11]);
    // What packets are split into are squares, whatever the size of the tile.
    for size in [8, 64] {
        let (pixels, _) = order::tiles([64, 64], size);
        for edge in [4, 8, 16, 32, 64].into_iter().filter(|&edge| edge <= size) {
            for square in pixels.chunks(edge * edge) {
                let corner = square.iter().map(|i| [i % 64, i / 64]).fold([u32::MAX; 2], |[a, b], [x, y]| [a.min(x), b.min(y)]);
                let inside = |i: &u32| i % 64 - corner[0] < edge as u32 && i / 64 - corner[1] < edge as u32;
                assert!(square.iter().all(inside), "a run of {} in tiles of {size}", edge * edge);
            }
        }
    }
}

#[test]
fn the_scenes_have_their_numbers_of_triangles() {
    assert_eq!([0, 1, 2, 3].map(|n| spd::balls(n).len()), [110, 1_082, 9_830, 88_562]);
    assert_eq!(spd::balls(4).len(), 797_150);
    assert_eq!(spd::tree(10).len(), 270_206);
    assert_eq!(castle::castle().len(), 33_276);
    assert_eq!(bunny::stand_in().len(), 69_620);
    // Where the recipe says that the spheres end.
    let mut balls = spd::balls(4);
    balls.drain(..2);
    let (low, high) = balls.iter().flatten().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p.into()), h.max(p.into())));
    assert!((low - Vec3::new(-0.937, -0.937, -0.468)).abs().max_element() < 0.015, "{low}");
    assert!((high - Vec3::new(0.950, 0.950, 0.830)).abs().max_element() < 0.015, "{high}");
    let mut tree = spd::tree(10);
    tree.drain(..2);
    let (low, high) = tree.iter().flatten().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p.into()), h.max(p.into())));
    assert!((low - Vec3::new(-1.371, -0.876, 0.0)).abs().max_element() < 0.0006, "{low}");
    assert!((high - Vec3::new(1.349, 1.142, 3.118)).abs().max_element() < 0.0006, "{high}");
}

/// The statistics that come with the databases: hits of the 513 × 513 rays through the corners of the pixels.
#[test]
fn eye_hits_of_the_procedural_databases() {
    let eye_hits = |triangles: &[Triangle], view: &SceneView| {
        let wide = Wide::new(triangles);
        let eye = view.eye.map(|c| c as f32);
        let along = |i: usize| i as f64 / 256.0 - 1.0;
        let rays: Vec<Ray> =
            (0..513 * 513).map(|i| Ray::new(eye, view.direction(along(i % 513), along(i / 513)).map(|c| c as f32))).collect();
        closest_packet(&wide, &rays, 4104).iter().filter(|hit| hit.is_hit()).count()
    };
    assert_eq!(eye_hits(&spd::balls(4), &spd::BALLS_VIEW), 263_169);
    assert_eq!(eye_hits(&spd::tree(11), &spd::TREE_VIEW), 169_801);
}

#[test]
fn a_ply_file_is_read_or_its_fault_named() {
    let folder = crate::support::Folder::new();
    let path = folder.path().join("one.ply");
    let header = "ply\nformat binary_little_endian 1.0\ncomment any\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let mut body: Vec<u8> = [0f32, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    body.push(3);
    body.extend([0i32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
    let read = |header: &str, body: &[u8]| {
        std::fs::write(&path, [header.as_bytes(), body].concat()).unwrap();
        bunny::read(&path)
    };
    assert_eq!(read(header, &body).unwrap(), [[[-0.5, -0.25, 0.0], [0.5, -0.25, 0.0], [-0.5, 0.25, 0.0]]]);
    let complaint = |header: &str, body: &[u8]| read(header, body).expect_err("a fault").to_string();
    assert!(complaint("solid", &[]).contains("end_header"));
    assert!(complaint(&header.replace("little", "big"), &body).contains("big_endian"));
    assert!(complaint(&header.replace("vertex 3", "vertex x"), &body).contains("vertex x"));
    assert!(complaint(&header.replace("vertex 3", "vertex 18446744073709551615"), &body).contains("cut short"));
    assert!(complaint(header, &body[..20]).contains("cut short"));
    assert!(complaint(header, &body[..40]).contains("cut short"));
    let mut wrong = body.clone();
    wrong[37] = 9;
    assert!(complaint(header, &wrong).contains("vertex 9 of 3"));
    wrong[36] = 4;
    assert!(complaint(header, &wrong).contains("4 corners"));
    assert!(bunny::read(&folder.path().join("none.ply")).expect_err("no file").to_string().contains("none.ply"));
}
