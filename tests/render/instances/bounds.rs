//! The guard: what lies outside of where an object's image can be is not drawn, and counted. That nothing does in scenes is told by every
//! test that compares them.

use glam::{DMat3, DQuat, DVec3, Vec3};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::gpu::types::Cap;
use lensrunner::render::instances::{ObjectMotion, Placed};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::spacetime::Observer;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::render::lookup::{Bench, bench};
use crate::twin::run;

fn camera() -> Observer {
    static_camera(DVec3::new(0.0, 0.0, 15.0), DVec3::NEG_Z, DVec3::Y, 60f64.to_radians())
}

fn ball(bench: &Bench, position: DVec3, settings: &Settings) -> Vec<Placed> {
    let (camera, object) = (camera(), bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, 1.0, 1));
    bench.place_by(camera.field_of_view / f64::from(bench.renderer.size()[0]), &camera, 0.0, &object, settings)
}

/// How many pixels show the ball, and how many of its triangles were left out.
fn drawn(bench: &mut Bench, placed: Vec<Placed>, settings: Settings) -> (usize, u32, ReadbackPicture) {
    let picture =
        bench.renderer.picture(&FrameInput { camera: camera(), time: 0.0, placed, held: None, aurora: None, settings }, true).unwrap();
    let counters = bench.renderer.counters().unwrap();
    assert_eq!(counters.complaint().is_some_and(|text| text.contains("outside")), counters.outside > 0);
    (picture.layers.iter().filter(|texel| texel[0] == 1.0).count(), counters.outside, picture)
}

#[test]
fn what_is_out_of_bounds_is_left_out_and_counted() {
    let mut bench = bench();
    let settings = Settings { stars: false, milky_way: false, bloom: 0.0, min_width: 0.0, orders: 2, ..Settings::finest() };
    // Behind the hole on the axis and beside it, with both images round the shadow; beside it, and before it.
    let places = [[0.0, 0.0, -9.0], [0.3, 0.2, -9.0], [4.0, 0.0, -9.0], [-5.0, 0.0, 0.0], [2.0, -1.0, 6.0]].map(DVec3::from_array);
    for here in places {
        let placed = ball(&bench, here, &settings);
        assert!(placed.iter().all(|placed| placed.instance.bounds.iter().any(|cap| cap.rim != 0.0)));
        let mut free = placed.clone();
        free.iter_mut().for_each(|placed| placed.instance.bounds = Default::default());
        let (shown, outside, picture) = drawn(&mut bench, placed, settings);
        assert_eq!(outside, 0, "{here}");
        assert!(shown > 0, "{here}: {shown}");
        let (_, _, unguarded) = drawn(&mut bench, free, settings);
        assert_eq!(picture.layers, unguarded.layers, "{here}");
    }
    // With the bounds of a place whose first image is elsewhere nothing is left of the first.
    for (here, there) in [(2, 3), (3, 2), (4, 3), (3, 4)] {
        let bounds = ball(&bench, places[there], &settings)[0].instance.bounds;
        let mut placed = ball(&bench, places[here], &settings);
        placed.truncate(1);
        placed[0].instance.bounds = bounds;
        let (shown, outside, _) = drawn(&mut bench, placed, settings);
        assert!(shown == 0 && outside > 0, "{}: {shown} {outside}", places[here]);
    }
    // On the axis with the bounds of a smaller ring: what reaches across the shadow, or out of the ring, is left out.
    let mut placed = ball(&bench, places[0], &settings);
    for placed in &mut placed {
        let [high, low, _] = placed.instance.bounds;
        placed.instance.bounds = [Cap { rim: 1.5 * high.rim, ..high }, low, Cap::default()];
    }
    assert!(drawn(&mut bench, placed, settings).1 > 0);
}

/// The angle from a direction to the nearest point of a triangle of directions, by many points of its sides, in f64.
fn nearest(middle: DVec3, corners: [DVec3; 3]) -> f64 {
    let weights = DMat3::from_cols_array_2d(&corners.map(DVec3::into)).inverse() * middle;
    if weights.is_finite() && weights.min_element() >= 0.0 {
        return 0.0;
    }
    let sides = [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
    let points = sides.into_iter().flat_map(|[a, b]| (0..=200).map(move |k| a.lerp(b, f64::from(k) / 200.0)));
    points.map(|point| point.angle_between(middle)).fold(f64::INFINITY, f64::min)
}

/// Caps that triangles must keep out of or within, against f64: wide triangles, slivers that point to the middle, and triangles that are a
/// point or a line but for rounding, of which a driver that fuses products makes what it likes.
#[test]
fn triangles_without_area_are_told_from_those_that_leave_a_cap() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut direction = |about: DVec3, most: f64| {
        let aside = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
        (about + aside * most).normalize().as_vec3().as_dvec3()
    };
    let (mut rows, mut truths) = (Vec::new(), Vec::new());
    for number in 0..5000 {
        let middle = direction(DVec3::ZERO, 1.0);
        let a = direction(middle, 0.6);
        let [b, c] = match number % 5 {
            0 => [0.5; 2].map(|wide| direction(middle, wide)),
            // Points, and lines towards the middle, but for rounding.
            1 => [1e-7; 2].map(|near| direction(a, near)),
            2 => [a, a],
            3 => [0.3, 0.7].map(|part| direction(a.lerp(middle, part), 1e-7)),
            _ => [direction(a, 0.2), a],
        };
        let radius = 0.01 + 0.3 * f64::from(number % 7) / 7.0;
        // Every other cap is one to keep within: there the farthest corner counts.
        let within = number % 2 == 1;
        let distance = if within {
            [a, b, c].map(|corner| corner.angle_between(middle)).into_iter().fold(0.0, f64::max)
        } else {
            nearest(middle, [a, b, c])
        };
        if (distance - radius).abs() < 2e-3 {
            continue;
        }
        let chord = 4.0 * (0.5 * radius).sin().powi(2);
        rows.extend([a, b, c].map(|corner| corner.as_vec3().extend(0.0).to_array()));
        rows.push(middle.as_vec3().extend(if within { chord } else { -chord } as f32).to_array());
        truths.push((distance < radius) != within);
    }
    let body = "
#import lensrunner::gpu::types::Cap
#import lensrunner::instances::bounds::leaves_cap
if id.x % 4u != 0u { return; }
let k = id.x;
let cap = Cap(twin_rows[k + 3u].xyz, twin_rows[k + 3u].w);
let leaves = leaves_cap(cap, row.xyz, twin_rows[k + 1u].xyz, twin_rows[k + 2u].xyz);
twin_out[k] = vec4<f32>(select(0.0, 1.0, leaves), 0.0, 0.0, 0.0);";
    let found = run(Pass::Mesh, body, [&[], &[]], &rows, 1);
    let wrong: Vec<[Vec3; 4]> = (0..truths.len())
        .filter(|&k| (found[4 * k][0] == 1.0) != truths[k])
        .map(|k| std::array::from_fn(|j| Vec3::from_slice(&rows[4 * k + j])))
        .collect();
    assert!(truths.iter().filter(|&&enters| enters).count() > 1000);
    assert!(wrong.is_empty(), "{} of {} wrong: {:?}", wrong.len(), truths.len(), &wrong[..wrong.len().min(3)]);
}
