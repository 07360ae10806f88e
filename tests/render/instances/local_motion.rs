//! Moving bodies while light crosses them: the few numbers that the GPU gets against the whole worldline.

use glam::{DMat3, DQuat, DVec3, Vec3};
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::instances::local_motion::{MotionNode, local_motion_at};
use lensrunner::render::instances::{DrawnObject, ObjectMotion, Placed};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::sim::History;
use lensrunner::sim::flight::Command;
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::matter::{ShipState, gamma, step};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::render::lookup::bench;
use crate::twin::run;

const REACH: f64 = 0.125;

/// A ship that falls past r = 6 under thrust, turning; at T = `jolt` it turns otherwise.
fn history(jolt: f64) -> History {
    let momentum = DVec3::new(-0.3, 0.45, 0.1);
    let attitude = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.7, 1.1);
    let mut state = ShipState { attitude, ..ShipState::new(DVec3::new(6.0, 1.0, 0.5), momentum) };
    let mut history = History::new(0.0, &state);
    for k in 1..=64 {
        let time = f64::from(k) / 32.0;
        let ease = (-time / 4.0).exp();
        let rates = if time > jolt { DVec3::new(-0.2, 0.5, 0.4) } else { DVec3::new(0.4, 0.1, -0.6) };
        let command = Command { thrust: DVec3::new(0.0, 0.01, -0.05), rates: rates * ease };
        state = step(&state, 1.0 / 32.0, command.thrust, command.rates);
        history.push(time, &state, &command);
    }
    history
}

/// Where a point of the body is on the slice at T = `time`, by the definition: rest shape, attitude, boost.
fn exact(history: &History, time: f64, body: DVec3) -> DVec3 {
    let now = history.at(time);
    let (y, p) = (now.attitude * body, now.momentum);
    let g = gamma(p);
    now.position + y - p * (p.dot(y) / (g * (1.0 + g)))
}

/// The instance of a body in a camera's view at T = `now`, and the emission time that it is about.
fn seen(camera: &Observer, history: &History, reach: f64, pixel: f64, now: f64) -> (Placed, f64) {
    let bench = bench();
    let object = DrawnObject { reach, ..bench.object(ObjectMotion::Flying(history), 2.0 * reach, 1) };
    let placed = bench.place_by(pixel, camera, now, &object, &Settings { orders: 1, ..Settings::finest() }).remove(0);
    let emission = now - f64::from(placed.instance.delay);
    (placed, emission)
}

/// The same of such a ship, with its worldline.
fn placed(jolt: f64, now: f64) -> (History, Placed, f64) {
    let history = history(jolt);
    let camera = static_camera(DVec3::new(6.8, 1.2, 0.5), DVec3::NEG_X, DVec3::Z, 60f64.to_radians());
    let (placed, emission) = seen(&camera, &history, REACH, 9e-4, now);
    (history, placed, emission)
}

/// Where the GPU has a point of the body, `s` after the emission time, from the centre then.
fn offset(placed: &Placed, body: DVec3, s: f64) -> DVec3 {
    local_motion_at(&placed.instance, &placed.nodes, body.as_vec3(), s as f32).0.as_dvec3()
}

#[test]
fn a_ship_that_begins_to_turn_is_right_all_over() {
    // A pixel of a picture 1,280 wide is 9e-4 at this distance; the wing of a ship of a hundred pixels may be off by a twentieth of it.
    const ALLOWED: f64 = 4.5e-5;
    for jolt in [0.0, 0.53125, 0.59375, 0.625, 0.65625, 0.71875, 2.0] {
        let (history, placed, emission) = placed(jolt, 2.64);
        assert!((0.6..0.67).contains(&emission), "{emission}");
        let centre = history.at(emission).position;
        for body in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z].map(|axis| axis * 0.5) {
            for k in -10..=10 {
                let s = 1.2 * REACH * f64::from(k) / 10.0;
                let got = offset(&placed, body, s);
                let want = exact(&history, emission + s, body * 2.0 * REACH) - centre;
                assert!(got.distance(want) < ALLOWED, "jolt at {jolt}, {body}, s = {s}: off by {:.1e}", got.distance(want));
            }
        }
    }
}

#[test]
fn a_planet_turns_under_a_camera_close_to_it() {
    // A day of 40 r_s/c, seen from its surface: light from there is 0.8 r_s/c younger than the centre's.
    let planet = lensrunner::scene::load("aurora-side").unwrap().planet.unwrap();
    let mut history = History::new(-8.0, &planet.state(-8.0).unwrap());
    (-15..=2).map(|k| 0.5 * f64::from(k)).for_each(|t| history.push(t, &planet.state(t).unwrap(), &Command::default()));
    let centre = planet.state(0.0).unwrap().position;
    let camera = static_camera(centre + DVec3::new(0.0, 0.8, 0.01), DVec3::NEG_X, DVec3::Z, 60f64.to_radians());
    let (placed, emission) = seen(&camera, &history, 0.8, 9e-4, 0.0);
    let at = |t: f64| {
        let state = planet.state(t).unwrap();
        (state.position, DMat3::from_quat(state.attitude), state.momentum)
    };
    let start = at(emission).0;
    for body in [DVec3::new(0.3, 0.4, 0.0), DVec3::new(-0.3, 0.0, 0.4), DVec3::Y * 0.5] {
        for s in [0.5, 0.7, 0.8] {
            let (position, turn, p) = at(emission + s);
            let y = turn * body * 1.6;
            let g = gamma(p);
            let want = position + y - p * (p.dot(y) / (g * (1.0 + g))) - start;
            let got = offset(&placed, body, s);
            // The nearest ground is a hundredth of r_s away, where a pixel is 9e-6.
            assert!(got.distance(want) < 2e-6, "{body} {s}: off by {:.1e}", got.distance(want));
        }
    }
}

#[test]
fn a_ship_that_falls_inside_beside_the_camera_is_right_all_over() {
    // The ship at the left of the scene `plunge` at T = 1.5: from rest at infinity, r^1.5 falls by 1.5 T.
    let start = DVec3::new(-0.35, 0.05, 1.9);
    let state = ShipState::new(start, DVec3::ZERO);
    let mut history = History::new(0.0, &state);
    let mut now = state;
    for k in 1..=48 {
        now = step(&now, 1.0 / 32.0, DVec3::ZERO, DVec3::ZERO);
        history.push(f64::from(k) / 32.0, &now, &Command { thrust: DVec3::ZERO, rates: DVec3::ZERO });
    }
    let reach = 0.157;
    let momentum = DVec3::ZERO;
    let camera = Observer { momentum, ..static_camera(DVec3::Z * 2.0, DVec3::NEG_Z, DVec3::X, 1.7) };
    let camera = Observer { position: DVec3::Z * 0.6942, ..camera };
    let (placed, emission) = seen(&camera, &history, reach, 1.9e-3, 1.5);
    assert!((1.3..1.35).contains(&emission), "{emission}");
    let fallen = |t: f64| start.normalize() * (start.length().powf(1.5) - 1.5 * t).powf(2.0 / 3.0);
    for k in -8..=8 {
        let s = reach * f64::from(k) / 10.0;
        let got = offset(&placed, DVec3::ZERO, s);
        let want = fallen(emission + s) - fallen(emission);
        // A quarter of a pixel of a picture 1,280 wide, three hundredths of r_s away.
        assert!(got.distance(want) < 1.6e-5, "s = {s}: off by {:.1e}", got.distance(want));
    }
}

#[test]
fn the_local_motion_is_the_same_in_both_languages() {
    // The rows of an instance: a vector and a number each, then linear forms and caps, then whole numbers.
    let row = |k: usize| format!("twin_rows[id.x + {k}u]");
    let number = |k: usize| if k == 14 { format!("bitcast<u32>({}.w)", row(k)) } else { format!("{}.w", row(k)) };
    let vectors = (0..16).map(|k| format!("{}.xyz, {}", row(k), number(k)));
    let caps = (19..22).map(|k| format!("Cap({0}.xyz, {0}.w)", row(k)));
    let members: Vec<String> = vectors.chain((16..19).map(row)).chain(caps).chain(std::iter::repeat_n("0u".to_owned(), 12)).collect();
    let body = format!(
        "#import lensrunner::chosen::worldlines::{{node_place, local_motion_between}}
#import lensrunner::gpu::types::{{Cap, Instance}}
    if id.x % 38u != 0u {{ return; }}
    let p = Instance({});
    let point = twin_rows[id.x + 25u];
    let place = node_place(p, point.w);
    let first = id.x + 26u + 3u * place.index;
    let moved = local_motion_between(p, point.xyz, point.w, place, mat2x4<f32>(twin_rows[first], twin_rows[first + 3u]),
        mat2x3<f32>(twin_rows[first + 1u].xyz, twin_rows[first + 4u].xyz), mat2x3<f32>(twin_rows[first + 2u].xyz, twin_rows[first + 5u].xyz));
    twin_out[id.x] = vec4<f32>(moved.offset, 0.0);
    twin_out[id.x + 1u] = vec4<f32>(moved.velocity, 0.0);
    twin_out[id.x + 2u] = moved.attitude;",
        members.join(", ")
    );
    const NODES: usize = 4;
    let mut random = StdRng::seed_from_u64(11);
    let mut cases = Vec::new();
    let (_, Placed { instance: ship, .. }, _) = placed(0.625, 2.64);
    for _ in 0..200 {
        let mut instance = ship;
        instance.first_node = random.random_range(-0.3..-0.2);
        instance.nodes_per_time = random.random_range(5.0..8.0);
        instance.node_intervals = (NODES - 1) as f32;
        instance.flags |= lensrunner::render::gpu::types::placed::STRAYS;
        instance.snap = std::array::from_fn(|_| random.random_range(-2.0..2.0));
        let mut random_vector = |most: f32| Vec3::from_array(std::array::from_fn(|_| random.random_range(-most..most)));
        let nodes: Vec<MotionNode> = (0..NODES)
            .map(|k| {
                let [aside, pushed] = [random_vector(0.1), random_vector(0.5)].map(|v| v.extend(0.0).to_array());
                let turn = glam::Quat::from_scaled_axis(Vec3::new(0.2, -0.1, 0.3) * k as f32 + random_vector(0.2));
                [turn.to_array(), aside, pushed]
            })
            .collect();
        let body = random_vector(1.0);
        cases.push((instance, nodes, body, random.random_range(-0.5..0.5f32)));
    }
    let rows: Vec<[f32; 4]> = cases
        .iter()
        .flat_map(|(instance, nodes, body, s)| {
            let words: &[[f32; 4]] = bytemuck::cast_slice(bytemuck::bytes_of(instance));
            assert_eq!(words.len(), 25);
            words.iter().copied().chain([[body.x, body.y, body.z, *s]]).chain(nodes.as_flattened().iter().copied()).collect::<Vec<_>>()
        })
        .collect();
    let out = run(Pass::Vertices, &body, [&[], &[]], &rows, 1);
    for ((instance, nodes, body, s), got) in cases.iter().zip(out.chunks_exact(26 + 3 * NODES)) {
        let (offset, velocity, attitude) = local_motion_at(instance, nodes, *body, *s);
        let pairs = [(&got[0][..3], offset.to_array().to_vec()), (&got[1][..3], velocity.to_array().to_vec())];
        for (got, want) in pairs.into_iter().chain([(&got[2][..], attitude.to_array().to_vec())]) {
            let off = got.iter().zip(&want).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 5e-6, "{body} {s}: {got:?} on the GPU, {want:?} in Rust");
        }
    }
}
