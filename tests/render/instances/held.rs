//! What is held: the card places it as the processor would.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use lensrunner::lensing::Slice;
use lensrunner::lensing::methods::{self, flat};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::layout;
use lensrunner::render::gpu::readback;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::gpu::types::placed::MINUS;
use lensrunner::render::gpu::types::{Counters, HeldFrame, Instance};
use lensrunner::render::instances::held::HeldBodies;
use lensrunner::render::instances::{DrawnObject, Illumination, InstanceView, ObjectMotion, StandIn, instances_of};
use lensrunner::render::models::ModelSet;
use lensrunner::render::models::coarse::stand_ins;
use lensrunner::render::renderer::SceneUpload;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::Material;
use lensrunner::scene::model::shapes;
use lensrunner::spacetime::Observer;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::gpu::GPU;
use crate::render::support::{renderer, settings};
use crate::twin::run_with;

const SIZE: [u32; 2] = [320, 180];

fn direction(random: &mut StdRng) -> DVec3 {
    let (z, azimuth) = (random.random_range(-1.0..1.0f64), TAU * random.random::<f64>());
    let across = (1.0 - z * z).sqrt();
    DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z)
}

fn attitude(random: &mut StdRng) -> DQuat {
    DQuat::from_axis_angle(direction(random), TAU * random.random::<f64>())
}

/// Where bodies are held for a camera: anywhere from next to the horizon, on the axis of hole and camera before and behind it, near the
/// photon sphere, and round the camera.
fn place(random: &mut StdRng, k: usize, camera: &Observer) -> (DVec3, f64) {
    let n = camera.position.normalize();
    let far = (1.01f64.ln() + random.random::<f64>() * 200f64.ln()).exp();
    let size = (1e-3f64.ln() + random.random::<f64>() * 2000f64.ln()).exp();
    match k % 8 {
        0 => (n * far, 0.3 * size),
        1 => (-n * far, size),
        2 => (direction(random) * random.random_range(1.4..1.6f64), 0.2 * size),
        3 => (direction(random) * random.random_range(1.002..1.1f64), 0.1 * size),
        4 => (camera.position + direction(random) * 3.0 * size, size),
        5 => ((-n * far + direction(random) * 0.3 * size).clamp_length_min(1.01), size),
        _ => (direction(random) * far, 0.5 * size),
    }
}

fn cameras(random: &mut StdRng) -> Vec<Observer> {
    let mut cameras: Vec<Observer> = [0.55, 0.95, 1.05, 1.5, 4.0, 30.0, 400.0]
        .map(|l| static_camera(direction(random) * l, direction(random), DVec3::Y, random.random_range(0.6..1.8)))
        .into();
    cameras.push(Observer { momentum: direction(random) * 1.5, ..cameras[4] });
    cameras
}

/// The instances that the card has made, by object, order and the sign of E.
fn made(bytes: &[u8], count: u32) -> HashMap<[u32; 3], Instance> {
    let all = bytes.chunks_exact(size_of::<Instance>()).take(count as usize).map(bytemuck::pod_read_unaligned::<Instance>);
    all.map(|instance| ([instance.object, instance.order, instance.flags & MINUS], instance)).collect()
}

/// The largest difference of some numbers.
fn apart(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn the_card_places_what_is_held_as_the_processor_would() {
    let mut random = StdRng::seed_from_u64(55);
    let mut renderer = renderer(SIZE);
    let mut models = ModelSet::default();
    let ball = shapes::icosphere(320, Material::default());
    let model = models.add(&ball);
    let coarser: Vec<StandIn> =
        stand_ins(&ball).iter().map(|other| StandIn { below: 0.25 / other.moved, model: models.add(&other.model) }).collect();
    assert!(coarser.len() > 1);
    let aspect = Some(f64::from(SIZE[1]) / f64::from(SIZE[0]));
    // Over what each may be, the largest, and whose it is.
    let mut worst: BTreeMap<&'static str, (f32, String)> = BTreeMap::new();
    // Images of one side alone, and whose flags or crossings, models, or kinds of bounds are others: next to a limit rounding decides.
    let (mut compared, mut folded, mut others) = (0, 0, [0; 4]);
    for (number, camera) in cameras(&mut random).into_iter().enumerate() {
        let [pixel_error, coarse_below] = [[0.5, 2.0][number % 2], [0.0, 3.0][number / 2 % 2]];
        // What is drawn of it does not matter here.
        let settings = Settings { pixel_error: pixel_error as f32, coarse_below, vertex_budget: 1_000, ..settings() };
        let objects: Vec<DrawnObject> = (0..400)
            .map(|k| {
                let (position, reach) = place(&mut random, k, &camera);
                let light = Illumination { ambient: [0.1, 0.2, 0.3], directed: [direction(&mut random).as_vec3().to_array(); 3] };
                let motion = ObjectMotion::Static { position, attitude: attitude(&mut random) };
                DrawnObject { model, coarse: coarser[0].model, stand_ins: &coarser, motion, reach, scale: reach, id: k as u32 + 1, light }
            })
            .collect();
        let mut held = HeldBodies::default();
        objects.iter().for_each(|object| held.add(object));
        renderer.upload(&SceneUpload { models: models.clone(), held, ..SceneUpload::default() });
        let input = FrameInput { camera, time: 0.0, placed: Vec::new(), held: Some(0), aurora: None, settings };
        renderer.picture(&input, false).unwrap();
        let counters = renderer.counters().unwrap();
        assert_eq!((counters.left_out, counters.simpler, counters.caught), (0, 0, 0), "{camera:?}");
        let mut card = made(&readback::texture(&GPU, renderer.geometry().instances(), 16).unwrap(), counters.images);
        assert_eq!(card.len(), counters.images as usize);
        let slice = Slice::new(renderer.table(), camera.radius());
        let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(SIZE[0]);
        let view = InstanceView { camera: &camera, slice: &slice, pixel, aspect, settings: &settings };
        for placed in objects.iter().flat_map(|object| instances_of(&view, 0.0, object, settings.orders)) {
            let want = placed.instance;
            let Some(got) = card.remove(&[want.object, want.order, want.flags & MINUS]) else {
                others[0] += 1;
                continue;
            };
            compared += 1;
            folded += u32::from(want.flags & MINUS != 0);
            let mut note = |what: &'static str, off: f32, limit: f32| {
                let share = off / limit;
                if worst.get(what).is_none_or(|(most, _)| share.is_nan() || share > *most) {
                    worst.insert(what, (share, format!("{off}, {camera:?}\n{want:?}\n{got:?}")));
                }
            };
            // A rounding or two of f32.
            let [offset, position] = [want.offset, want.position].map(|v| DVec3::from_array(v.map(f64::from)).length() as f32);
            let reach = want.rounding / 4e-7;
            note("offset", apart(&got.offset, &want.offset), 3e-7 * offset);
            note("position", apart(&got.position, &want.position), f32::MIN_POSITIVE);
            let axes = |i: &Instance| [i.turn_x, i.turn_y, i.turn_z, i.shape_x, i.shape_y, i.shape_z].concat();
            note("axes", apart(&axes(&got), &axes(&want)), 1e-6 * (1.0 + reach));
            note("light", apart(got.light.as_flattened(), want.light.as_flattened()), f32::MIN_POSITIVE);
            note("constants", apart(&[got.gamma, got.scale, got.delay], &[1.0, 0.0, 0.0]), f32::MIN_POSITIVE);
            let across = apart(&[got.across_a, got.across_b], &[want.across_a, want.across_b]);
            note("across", across, 6e-7 * offset.min(position) + 2e-6 * want.rounding);
            note("rounding", (got.rounding - want.rounding).abs(), 3e-7 * want.rounding);
            others[2] += u32::from([got.first_vertex, got.vertex_count] != placed.model.vertices);
            if got.flags != want.flags || got.crossings != want.crossings {
                others[1] += 1;
                continue;
            }
            // Directions agree to 4e-5, inside to twenty times that (`the_lookup_is_the_same_in_both_languages`), where the images whose
            // widths count are a hundredth of a radian wide or more.
            let rough = if camera.radius() < 1.0 { 0.1 } else { 0.01 };
            note("strictness", (got.strictness / want.strictness - 1.0).abs(), rough);
            // A cap without a rim bounds nothing, wherever its middle is.
            let bounds = got.bounds.iter().zip(&want.bounds).filter(|(got, want)| got.rim != 0.0 || want.rim != 0.0);
            for (got, want) in bounds {
                if (got.rim == 0.0) != (want.rim == 0.0) || got.rim * want.rim < 0.0 {
                    others[3] += 1;
                    continue;
                }
                let angle = |rim: f32| 2.0 * (0.5 * rim.abs().sqrt()).min(1.0).asin();
                let off = apart(&got.middle, &want.middle) + (angle(got.rim) - angle(want.rim)).abs();
                note("bounds", off, 1e-3 + 0.01 * angle(want.rim));
            }
        }
        others[0] += card.len() as u32;
    }
    println!("{compared} images compared, {folded} by light of E < 0; others: {others:?}");
    for (what, (share, _)) in &worst {
        println!("{what}: {share} of what it may be off");
    }
    assert!(compared > 500 && folded > 0);
    assert!(others.iter().all(|other| other * 50 < compared), "{others:?} of {compared}");
    for (what, (share, whose)) in &worst {
        assert!(*share <= 1.0, "{what}: {whose}");
    }
}

/// What is held is drawn as if the processor had placed it, by every method.
#[test]
fn the_card_and_the_processor_draw_the_same_picture() {
    let size = [160, 90];
    let mut renderer = renderer(size);
    let ball = shapes::icosphere(80, Material::default());
    let mut models = ModelSet::default();
    let model = models.add(&ball);
    let camera = static_camera(DVec3::new(3.0, 2.0, 14.0), DVec3::new(-3.0, -2.0, -14.0), DVec3::Y, 1.2);
    let places = [[0.0, 0.0, -9.0], [4.0, 0.0, -3.0], [-3.0, 1.0, 2.0], [-1.0, -2.5, 6.0], [3.0, 2.0, 12.0]].map(DVec3::from_array);
    let light = Illumination { ambient: [0.5; 3], directed: [[0.0, 0.3, 0.0]; 3] };
    let objects = places.map(|position| {
        let motion = ObjectMotion::Static { position, attitude: DQuat::from_rotation_x(0.3) };
        DrawnObject { model, coarse: model, stand_ins: &[], motion, reach: 0.6, scale: 0.6, id: 1 + position.x.abs() as u32, light }
    });
    let mut held = HeldBodies::default();
    objects.iter().for_each(|object| held.add(object));
    renderer.upload(&SceneUpload { models, held, ..SceneUpload::default() });
    let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(size[0]);
    let slice = Slice::new(renderer.table(), camera.radius());
    for method in methods::METHODS {
        let settings = Settings { method, ..settings() };
        let view = InstanceView { camera: &camera, slice: &slice, pixel, aspect: None, settings: &settings };
        let placed = objects.iter().flat_map(|object| instances_of(&view, 0.0, object, settings.orders)).collect();
        let by_processor = FrameInput { camera, time: 0.0, placed, held: None, aurora: None, settings };
        let by_card = FrameInput { placed: Vec::new(), held: Some(0), ..by_processor.clone() };
        // And some by each.
        let by_both = FrameInput { held: Some(0), ..by_processor.clone() };
        let [want, got, both] = [by_processor, by_card, by_both].map(|input| renderer.picture(&input, true).unwrap());
        let drawn = want.layers.iter().filter(|pixel| pixel[0] > 0.0).count();
        assert!(drawn > 100, "{method:?}: {drawn}");
        for other in [&got, &both] {
            let off = want.layers.iter().zip(&other.layers).filter(|(a, b)| a[..2] != b[..2]).count();
            assert!(off * 100 <= drawn, "{method:?}: {off} of {drawn} pixels show something else");
        }
        assert!(method == flat::METHOD || crate::render::support::apart(&got, &want) < 0.02, "{method:?}");
    }
}

/// What finds no room is told so, and what is taken is nobody else's.
#[test]
fn images_take_no_more_than_there_is() {
    let frame = HeldFrame { vertices_end: [1_000, 1_200], states_end: [9_000, 9_900], ..HeldFrame::default() };
    let counters = Counters { held_vertices: [100, 1_000], held_states: [3, 9_000], ..Counters::default() };
    let [frame, counters] = [bytemuck::bytes_of(&frame), bytemuck::bytes_of(&counters)].map(|bytes| layout::storage(&GPU, "held", bytes));
    let body = "let taken = take(0u, vec2<u32>(u32(row.x), 2u));
    twin_out[id.x] = vec4<f32>(f32(taken.fits), vec2<f32>(taken.first), 0.0);";
    let mut random = StdRng::seed_from_u64(7);
    let rows: Vec<[f32; 4]> = (0..512).map(|_| [random.random_range(1..9u32) as f32, 0.0, 0.0, 0.0]).collect();
    let out = run_with(Pass::Place, body, [&[], &[]], &[(0, &frame), (3, &counters)], &rows, 1);
    let mut taken: Vec<[u32; 2]> =
        rows.iter().zip(&out).filter(|(_, out)| out[0] == 1.0).map(|(row, out)| [out[1] as u32, row[0] as u32]).collect();
    taken.sort_unstable();
    assert!(taken.windows(2).all(|two| two[0][0] + two[0][1] <= two[1][0]));
    let (first, last) = (taken[0], taken[taken.len() - 1]);
    assert!(first[0] >= 100 && last[0] + last[1] <= 1_000 && taken.len() < rows.len());
    // The rest is smaller than what was refused, but for what was lost in the race for it.
    let all: u32 = taken.iter().map(|[_, count]| count).sum();
    assert!(all > 800, "{all}");
}

/// A hundred thousand bodies are placed within the buffers of WebGPU, and the processor does nothing for each.
#[test]
fn a_hundred_thousand_bodies_are_placed() {
    let mut random = StdRng::seed_from_u64(100_000);
    let mut renderer = renderer([64, 36]);
    let mut models = ModelSet::default();
    let model = models.add(&shapes::icosphere(20, Material::default()));
    let mut held = HeldBodies::default();
    for id in 1..=100_000 {
        let position = direction(&mut random) * random.random_range(3.0..60.0f64);
        let motion = ObjectMotion::Static { position, attitude: DQuat::IDENTITY };
        let light = Illumination { ambient: [1.0; 3], ..Illumination::default() };
        held.add(&DrawnObject { model, coarse: model, stand_ins: &[], motion, reach: 0.05, scale: 0.05, id, light });
    }
    renderer.upload(&SceneUpload { models, held, ..SceneUpload::default() });
    let camera = static_camera(DVec3::new(1.0, 2.0, 30.0), DVec3::NEG_Z, DVec3::Y, 0.3);
    let input = FrameInput { camera, time: 0.0, placed: Vec::new(), held: Some(0), aurora: None, settings: settings() };
    renderer.picture(&input, false).unwrap();
    let counters = renderer.counters().unwrap();
    let work = renderer.timing().work().iter().find(|(part, _)| *part == "lists of bodies").map(|(_, time)| *time);
    println!("{} images, {work:?} ms of the processor", counters.images);
    assert_eq!((counters.left_out, counters.simpler, counters.caught), (0, 0, 0));
    assert!(counters.images > 1_000 && counters.model_vertices == 12 * counters.images);
}
