//! What breaks tracers of straight rays: one test for each complaint that users of other tracers have made.

use glam::Vec3;
use lensrunner_lab::straight::scenes::{Triangle, bunny::ball, spd};
use lensrunner_lab::straight::{BvhSettings, Hit, Mesh, Packets, Ray, Wide};
use proptest::prelude::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The answer of every method, which must be one.
fn closest(mesh: &Mesh, wide: &Wide, rays: &[Ray]) -> Vec<Hit> {
    let plain: Vec<Hit> = rays.iter().map(|ray| mesh.closest(ray)).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    wide.closest_each(rays, &mut hits);
    agree(rays, &hits, &plain, "ray by ray");
    hits.fill(Hit::MISS);
    wide.closest_packet(rays, &mut hits, &mut Packets::default());
    agree(rays, &hits, &plain, "in packets");
    plain
}

fn agree(rays: &[Ray], hits: &[Hit], plain: &[Hit], how: &str) {
    for ((ray, hit), expected) in rays.iter().zip(hits).zip(plain) {
        assert_eq!(hit, expected, "{how}: {ray:?}");
    }
}

fn both(triangles: &[Triangle]) -> (Mesh, Wide) {
    (Mesh::new(triangles, &BvhSettings::default()), Wide::new(triangles))
}

/// The 26 directions along axes and diagonals, zeros of either sign.
fn compass() -> Vec<[f32; 3]> {
    let steps = [-1.0, -0.0, 0.0, 1.0];
    let mut all = Vec::new();
    for x in steps {
        for y in steps {
            for z in steps {
                all.push([x, y, z]);
            }
        }
    }
    all.retain(|d| d.iter().any(|&c| c != 0.0));
    all
}

/// A cube of two triangles a side.
fn cube([x, y, z]: [f32; 3], size: f32) -> Vec<Triangle> {
    let corner = |i: usize| [x + size * (i & 1) as f32, y + size * (i >> 1 & 1) as f32, z + size * (i >> 2) as f32];
    let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [c, d, a]]).map(|t| t.map(corner)).collect()
}

/// Nearest hit in whole numbers: exact, edges and corners included, triangles seen edge-on left out.
fn exact(triangles: &[Triangle], ray: &Ray) -> Option<(i128, i128, u32)> {
    let whole = |v: [f32; 3]| v.map(|c| (c * 4.0) as i128);
    let sub = |a: [i128; 3], b: [i128; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross = |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (origin, direction) = (whole(ray.origin), whole(ray.direction));
    let mut best: Option<(i128, i128, u32)> = None;
    for (i, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(whole);
        let p = cross(direction, sub(c, a));
        let q = cross(sub(origin, a), sub(b, a));
        let (mut det, mut u, mut v, mut t) = (dot(sub(b, a), p), dot(sub(origin, a), p), dot(direction, q), dot(sub(c, a), q));
        if det == 0 {
            continue;
        }
        if det < 0 {
            (det, u, v, t) = (-det, -u, -v, -t);
        }
        let inside = u >= 0 && v >= 0 && u + v <= det && t >= 0;
        if inside && best.is_none_or(|(bt, bd, _)| t * bd < bt * det) {
            best = Some((t, det, i as u32));
        }
    }
    best
}

/// 0 · ∞: origins exactly on faces, edges and corners of boxes, directions along them, zeros of either sign.
#[test]
fn rays_that_run_in_the_faces_of_boxes() {
    let mut triangles = Vec::new();
    for at in [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 5.0, 0.0], [3.0, 5.0, 2.0], [-4.0, -4.0, -4.0], [0.0, 0.0, 6.0]] {
        triangles.extend(cube(at, 2.0));
    }
    let (mesh, wide) = both(&triangles);
    let steps = [-4.0, -2.0, 0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0];
    let mut rays = Vec::new();
    for x in steps {
        for y in steps {
            for z in steps {
                rays.extend(compass().into_iter().map(|d| Ray::new([x, y, z], d)));
            }
        }
    }
    for (ray, hit) in rays.iter().zip(closest(&mesh, &wide, &rays)) {
        // Small whole numbers and quarters: f32 makes no error, so neither may the tree.
        let expected = exact(&triangles, ray).map(|(t, det, i)| (t as f32 / det as f32, i));
        assert_eq!(hit.is_hit().then_some((hit.t, hit.triangle)), expected, "{ray:?}");
    }
}

/// Through every corner and the middle of every edge, from inside and from outside.
#[test]
fn closed_meshes_do_not_leak_at_corners_and_edges() {
    let random = &mut StdRng::seed_from_u64(5);
    for (frequency, centre, radius) in
        [(1, Vec3::ZERO, 1.0), (8, Vec3::ZERO, 1.0), (5, Vec3::new(30.0, -7.0, 11.0), 0.3), (6, Vec3::ZERO, 1e4)]
    {
        let mut triangles = ball(frequency, centre, radius);
        if frequency == 6 {
            triangles.extend(cube([-1e5; 3], 2e5));
        }
        let (mesh, wide) = both(&triangles);
        let mut rays = Vec::new();
        for corners in &triangles[..20 * frequency * frequency] {
            let [a, b, c] = corners.map(Vec3::from);
            for target in [a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
                for _ in 0..3 {
                    let offset = Vec3::from_array(std::array::from_fn(|_| random.random_range(-0.5..0.5)));
                    let inside = centre + offset * radius;
                    rays.push(Ray::new(inside.to_array(), (target - inside).to_array()));
                }
                // From outside, on through the middle.
                let outside = centre + (target - centre) * 3.0;
                rays.push(Ray::new(outside.to_array(), (centre - outside).to_array()));
            }
        }
        let misses = closest(&mesh, &wide, &rays).iter().filter(|hit| !hit.is_hit()).count();
        assert_eq!(misses, 0, "of {} rays at a ball of {}", rays.len(), triangles.len());
    }
}

/// Along the axes through corners and edges that are representable exactly: every edge function is 0.
#[test]
fn exact_corners_and_edges_are_hit() {
    let mut triangles = cube([0.0; 3], 1.0);
    // A fan of eight around a corner.
    for i in 0..8 {
        let rim = |k: usize| {
            let [x, y] = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]][k % 8];
            [10.0 + x, 10.0 + y, 0.0]
        };
        triangles.push([rim(i), rim(i + 1), [10.0, 10.0, 0.0]]);
    }
    let (mesh, wide) = both(&triangles);
    let mut rays = Vec::new();
    for x in [0.0, 0.25, 0.5, 1.0] {
        for y in [0.0, 0.25, 0.5, 1.0] {
            for axis in 0..3 {
                for side in [-3.0, 4.0] {
                    let (mut origin, mut direction) = ([0.0; 3], [0.0; 3]);
                    (origin[axis], origin[(axis + 1) % 3], origin[(axis + 2) % 3]) = (side, x, y);
                    direction[axis] = -f32::signum(side);
                    rays.push(Ray::new(origin, direction));
                }
            }
            rays.push(Ray::new([10.0 + x, 10.0 - y, 5.0], [0.0, 0.0, -2.0]));
        }
    }
    for (ray, hit) in rays.iter().zip(closest(&mesh, &wide, &rays)) {
        assert!(hit.is_hit(), "{ray:?}");
        // The lowest number wins where several touch.
        let expected = exact(&triangles, ray).expect("a hit").2;
        assert_eq!(hit.triangle, expected, "{ray:?}");
    }
}

/// A ray from outside crosses a closed mesh an even number of times.
#[test]
fn crossings_are_even() {
    use lensrunner_lab::straight::triangle::Shear;
    let random = &mut StdRng::seed_from_u64(6);
    let triangles = ball(6, Vec3::ZERO, 1.0);
    let mut met = 0;
    for _ in 0..4000 {
        let origin: [f32; 3] = std::array::from_fn(|_| random.random_range(-3.0f32..3.0));
        if Vec3::from(origin).length() < 1.1 {
            continue;
        }
        let target: [f32; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
        let ray = Ray::new(origin, (Vec3::from(target) - Vec3::from(origin)).to_array());
        let shear = Shear::new(&ray);
        let crossings = triangles.iter().filter(|t| shear.meet(t).is_some_and(|t| t >= 0.0)).count();
        assert_eq!(crossings % 2, 0, "{ray:?}");
        met += crossings;
    }
    assert!(met > 3000);
}

/// A camera far from small geometry: the slab test must not open holes.
#[test]
fn far_origins_lose_nothing() {
    let random = &mut StdRng::seed_from_u64(7);
    let triangles = ball(8, Vec3::ZERO, 1.0);
    let (mesh, wide) = both(&triangles);
    for distance in [1e2f32, 1e4, 1e6] {
        let mut rays = Vec::new();
        for i in 0..3000 {
            let mut origin: [f32; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
            if i % 3 == 0 {
                origin = [0.0, 0.0, -0.0];
                origin[i / 3 % 3] = 1.0;
            }
            let origin = Vec3::from(origin).normalize() * distance;
            // Aimed so that rounding of the direction leaves the ray inside the ball.
            let aim = 0.5 * Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
            let aim = if distance > 1e5 { aim * 0.1 } else { aim };
            rays.push(Ray::new(origin.to_array(), (aim - origin).to_array()));
        }
        let misses = closest(&mesh, &wide, &rays).iter().filter(|hit| !hit.is_hit()).count();
        assert_eq!(misses, 0, "from {distance}");
    }
    // An axis-aligned ray inside the face of a box, from afar.
    let (mesh, wide) = both(&cube([0.0; 3], 1.0));
    let rays: Vec<Ray> = [0.0, 0.5, 1.0].map(|y| Ray::new([1e6, y, 0.5], [-1.0, 0.0, 0.0])).to_vec();
    assert!(closest(&mesh, &wide, &rays).iter().all(|hit| hit.t == 1e6 - 1.0));
}

/// A threshold on the determinant loses small triangles: the hits must not depend on the unit of length.
#[test]
fn the_unit_of_length_does_not_matter() {
    let triangles = spd::tree(4);
    let directions = spd::TREE_VIEW.directions([64, 48]);
    let at_scale = |scale: f32| {
        let scaled: Vec<Triangle> = triangles.iter().map(|t| t.map(|p| p.map(|c| c * scale))).collect();
        let (mesh, wide) = both(&scaled);
        let eye = spd::TREE_VIEW.eye.map(|c| c as f32 * scale);
        let rays: Vec<Ray> = directions.iter().map(|&d| Ray::new(eye, d)).collect();
        closest(&mesh, &wide, &rays)
    };
    let unit = at_scale(1.0);
    // Powers of two change no digit.
    for power in [-20, -13, 13, 20] {
        let scale = 2f32.powi(power);
        let scaled: Vec<Hit> = unit.iter().map(|hit| Hit { t: hit.t * scale, ..*hit }).collect();
        assert!(at_scale(scale) == scaled, "scale {scale}");
    }
    for scale in [1e-4, 1e4] {
        let differ = at_scale(scale).iter().zip(&unit).filter(|(a, b)| a.triangle != b.triangle).count();
        assert!(differ <= 3, "{differ} of {} at scale {scale}", unit.len());
    }
}

/// False hits on thin triangles seen at a grazing angle.
#[test]
fn thin_triangles_are_hit_only_where_they_are() {
    let random = &mut StdRng::seed_from_u64(8);
    let triangles: Vec<Triangle> = (0..300)
        .map(|_| {
            let mut point = || Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0f32..1.0)));
            let (a, b, aside) = (point(), point(), point());
            [a, b, a.lerp(b, 0.6) + 1e-4 * aside].map(|p| p.to_array())
        })
        .collect();
    let (mesh, wide) = both(&triangles);
    let rays: Vec<Ray> = (0..20_000)
        .map(|i| {
            let mut point = || Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.5f32..1.5)));
            let (origin, aim) = (point(), point());
            // Half of them almost along a triangle.
            let [a, b, _] = triangles[i % 300].map(Vec3::from);
            let aim = if i % 2 == 0 { b + 1e-3 * aim } else { aim };
            let origin = if i % 2 == 0 { a + (a - b) + 1e-3 * origin } else { origin };
            Ray::new(origin.to_array(), (aim - origin).to_array())
        })
        .collect();
    let mut met = 0;
    for (ray, hit) in rays.iter().zip(closest(&mesh, &wide, &rays)).filter(|(_, hit)| hit.is_hit()) {
        let point = (Vec3::from(ray.origin) + Vec3::from(ray.direction) * hit.t).as_dvec3();
        let corners = triangles[hit.triangle as usize].map(|c| Vec3::from(c).as_dvec3());
        let (origin, direction) = (Vec3::from(ray.origin).as_dvec3(), Vec3::from(ray.direction).as_dvec3());
        let (a, along, across) = (corners[0], corners[1] - corners[0], corners[2] - corners[0]);
        // The longest edge and the width of 1e−4 around it hold the triangle: the ray must pass there.
        let between = direction.cross(along).normalize();
        assert!((a - origin).dot(between).abs() < 2e-4, "{ray:?} {hit:?}");
        // And the hit must lie there, as far as f32 can tell: its edge functions carry errors of 2⁻²³ of the products that make the area
        // seen.
        let seen = along.cross(across).dot(direction.normalize()).abs();
        let noise = 2.0 * 2f64.powi(-23) * along.length().powi(3) / seen;
        let s = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let off = (point - a - along * s).length();
        assert!(off < 2e-4 + noise, "{off}, noise {noise}: {ray:?} {hit:?} {corners:?}");
        met += 1;
    }
    assert!(met > 60, "{met}");
}

#[test]
fn degenerate_triangles_harm_nobody() {
    let good = ball(3, Vec3::ZERO, 1.0);
    let rays: Vec<Ray> = compass().into_iter().map(|d| Ray::new(d.map(|c| -4.0 * c), d)).collect();
    let (mesh, wide) = both(&good);
    let expected: Vec<f32> = closest(&mesh, &wide, &rays).iter().map(|hit| hit.t).collect();
    let nan = f32::NAN;
    let bad: [Triangle; 7] = [
        [[nan; 3]; 3],
        [[nan, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[f32::INFINITY, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[f32::NEG_INFINITY; 3], [f32::INFINITY; 3], [0.0; 3]],
        [[0.1; 3]; 3],
        [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0; 3]],
        [[0.0; 3], [1e-40; 3], [0.0, 1e-42, 0.0]],
    ];
    let mut triangles = good.clone();
    for (i, t) in bad.iter().enumerate() {
        triangles.insert(25 * i, *t);
    }
    // Each good one twice more.
    triangles.extend(good.iter().chain(&good));
    let (mesh, wide) = both(&triangles);
    let ts: Vec<f32> = closest(&mesh, &wide, &rays).iter().map(|hit| hit.t).collect();
    assert_eq!(ts, expected);
    // A thousand of the same, and a thousand in one plane.
    let same = vec![good[0]; 1000];
    let flat: Vec<Triangle> = (0..1000).map(|i| i as f32).map(|x| [[x, 0.0, 0.0], [x + 2.0, 0.0, 0.0], [x, 2.0, 0.0]]).collect();
    let (mesh, wide) = both(&same);
    let [a, b, c] = good[0].map(Vec3::from);
    let aim = (a + b + c) / 3.0;
    let hits = closest(&mesh, &wide, &[Ray::new((aim * 3.0).to_array(), (-aim).to_array())]);
    assert_eq!(hits[0].triangle, 0, "the lowest number of equals");
    let (mesh, wide) = both(&flat);
    let rays: Vec<Ray> = (0..1000).map(|i| Ray::new([i as f32 + 1.0, 0.5, 1.0], [0.0, 0.0, -1.0])).collect();
    assert!(closest(&mesh, &wide, &rays).iter().all(|hit| hit.t == 1.0));
    // None and one.
    for number in [0, 1] {
        let (mesh, wide) = both(&good[..number]);
        let hits = closest(&mesh, &wide, &[Ray::new((aim * 3.0).to_array(), (-aim).to_array())]);
        assert_eq!(hits[0].is_hit(), number == 1);
    }
    let (mesh, wide) = both(&[[[nan; 3]; 3]]);
    assert!(!closest(&mesh, &wide, &[Ray::new([0.0; 3], [1.0; 3])])[0].is_hit());
    let mut none: [Hit; 0] = [];
    wide.closest_packet(&[], &mut none, &mut Packets::default());
}

/// Rays along an axis must not look into every leaf.
#[test]
fn axis_rays_visit_few_nodes() {
    let triangles = spd::balls(3);
    let mesh = Mesh::new(&triangles, &BvhSettings::default());
    let mut most = 0;
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            for i in 0..50 {
                let (mut origin, mut direction) = ([0.013 * i as f32 - 0.3; 3], [0.0; 3]);
                origin[axis] = -20.0 * sign;
                direction[axis] = sign;
                let (hit, boxes) = mesh.closest_counted(&Ray::new(origin, direction));
                assert_eq!(hit, mesh.closest(&Ray::new(origin, direction)));
                most = most.max(boxes);
            }
        }
    }
    assert!(most < mesh.tree.nodes.len() / 50, "{most} of {} boxes", mesh.tree.nodes.len());
}

fn triangles_and_rays() -> impl Strategy<Value = (Vec<Triangle>, Vec<Ray>)> {
    // Small whole numbers, and directions whose slopes are exact: rays through corners, along edges and in faces are common, and f32 makes
    // no error but in t.
    let point = || prop::array::uniform3((-4i8..5).prop_map(f32::from));
    let way = || prop::array::uniform3(prop::sample::select(vec![-4f32, -2.0, -1.0, -0.0, 0.0, 1.0, 2.0, 4.0]));
    let ray = (point(), way().prop_filter("a direction", |d| d.iter().any(|&c| c != 0.0))).prop_map(|(o, d)| Ray::new(o, d));
    (prop::collection::vec(prop::array::uniform3(point()), 0..60), prop::collection::vec(ray, 1..70))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: proptest::test_runner::RngSeed::Fixed(11), failure_persistence: None, ..ProptestConfig::default() })]

    /// All methods agree bit for bit on any triangles and rays, and with whole numbers on what they should say.
    #[test]
    fn any_triangles_any_rays((triangles, rays) in triangles_and_rays()) {
        let (mesh, wide) = both(&triangles);
        for (ray, hit) in rays.iter().zip(closest(&mesh, &wide, &rays)) {
            match exact(&triangles, ray) {
                None => prop_assert!(!hit.is_hit(), "{:?} {:?}", ray, hit),
                Some((t, det, _)) => {
                    prop_assert!(hit.is_hit(), "{:?}: missed at {}", ray, t as f64 / det as f64);
                    prop_assert!((f64::from(hit.t) - t as f64 / det as f64).abs() < 1e-5);
                }
            }
        }
    }
}
