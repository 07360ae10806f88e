//! Vertices on the GPU against the exact ray and the judge: inside the horizon, across it, near it from afar, moving and turning.

use lensrunner::spacetime::Observer;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DQuat, DVec3};
use lensrunner::judge::shoot;
use lensrunner::lensing::methods::{self, Method, flat};
use lensrunner::lensing::{Scheme, Slice, bake};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback;
use lensrunner::render::gpu::types::SeenVertex;
use lensrunner::render::instances::{DrawnObject, Illumination as Light, InstanceView, ObjectMotion, Placed, instances_of};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::model::shapes;
use lensrunner::scene::{Material, Model};
use lensrunner::sim::History;
use lensrunner::sim::flight::Command;
use lensrunner::spacetime::frames;
use lensrunner::spacetime::light::{self, Branch, Order};
use lensrunner::spacetime::matter::{ShipState, gamma, step};

use crate::gpu::GPU;
use crate::render::support::{LentRenderer, renderer};

/// One for all: most of a renderer's time here is the compiling of its passes.
static BENCH: LazyLock<Mutex<Bench>> = LazyLock::new(|| Mutex::new(Bench::new([64, 36])));

pub fn bench() -> MutexGuard<'static, Bench> {
    // Another test's failure is no reason to fail.
    BENCH.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A renderer without sky, and a small ball on it.
pub struct Bench {
    pub renderer: LentRenderer,
    pub ball: Model,
    model: lensrunner::render::models::ModelRange,
}

impl Bench {
    pub fn new(size: [u32; 2]) -> Bench {
        let mut renderer = renderer(size);
        let ball = shapes::icosphere(80, Material::default());
        let model = renderer.add_model(&ball);
        Bench { renderer, ball, model }
    }

    pub fn object<'a>(&self, motion: ObjectMotion<'a>, scale: f64, id: u32) -> DrawnObject<'a> {
        let light = Light { ambient: [1.0; 3], ..Light::default() };
        let (model, coarse) = (self.model, self.model);
        DrawnObject { model, coarse, stand_ins: &[], motion, reach: scale, scale, id, light }
    }

    pub fn place(&self, camera: &Observer, time: f64, object: &DrawnObject, settings: &Settings) -> Vec<Placed> {
        self.place_by(1e-9, camera, time, object, settings)
    }

    /// The same by pixels of this size, in radians.
    pub fn place_by(&self, pixel: f64, camera: &Observer, time: f64, object: &DrawnObject, settings: &Settings) -> Vec<Placed> {
        let slice = Slice::new(self.renderer.table(), camera.radius());
        instances_of(&InstanceView { camera, slice: &slice, pixel, aspect: None, settings }, time, object, settings.orders)
    }

    /// The model's vertices as the GPU sees them, instance by instance.
    pub fn seen(&mut self, camera: Observer, time: f64, placed: Vec<Placed>, settings: Settings) -> Vec<SeenVertex> {
        let frame = FrameInput { camera, time, placed, held: None, aurora: None, settings };
        self.renderer.picture(&frame, false).unwrap();
        let bytes = readback::buffer(&GPU, self.renderer.geometry().seen()).unwrap();
        bytemuck::cast_slice(&bytes[..bytes.len() / size_of::<SeenVertex>() * size_of::<SeenVertex>()]).to_vec()
    }

    /// Body points of the vertices, in the order of the GPU.
    pub fn points(&self) -> Vec<DVec3> {
        let prepared = lensrunner::render::models::Prepared::new(&self.ball);
        prepared.vertices.iter().map(|v| DVec3::new(f64::from(v.position[0]), f64::from(v.position[1]), f64::from(v.position[2]))).collect()
    }
}

pub fn apparent(vertex: &SeenVertex) -> DVec3 {
    let [x, y, z] = vertex.apparent;
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}

/// r, φ, the outward unit vector and the one across of a place seen by a camera.
fn polar(camera: &Observer, point: DVec3) -> (f64, f64, DVec3, DVec3) {
    let n = camera.position.normalize();
    let across = point - n * point.dot(n);
    (point.length(), across.length().atan2(point.dot(n)).max(1e-12), n, across.normalize_or_zero())
}

/// Where the light of order 1 or 2 from `point` is seen and how long it took, by the judge.
fn judged(camera: &Observer, point: DVec3, order: u32, branch: Branch) -> Option<(DVec3, f64)> {
    let (r, phi, n, side) = polar(camera, point);
    let branch = if branch == Branch::Minus { lensrunner::judge::EnergySign::Minus } else { lensrunner::judge::EnergySign::Plus };
    let seen = shoot(r, phi, camera.radius(), order, branch, 1e-15)?;
    let side = if order == 2 { -side } else { side };
    Some((camera.seen_direction(n * seen.psi_rain.cos() + side * seen.psi_rain.sin()), seen.delay))
}

fn falling(position: DVec3, momentum: DVec3) -> Observer {
    let attitude = frames::look(-position, DVec3::Y).unwrap_or(DQuat::IDENTITY);
    Observer { position, momentum, attitude, field_of_view: 1.0 }
}

/// A camera inside sees a static ball inside twice, by light of either sign of E, each vertex where the judge sees it.
#[test]
fn a_camera_inside_sees_what_is_inside_twice() {
    let mut bench = bench();
    let camera = falling(DVec3::new(0.0, 0.05, 0.45), DVec3::new(0.1, -0.2, 0.05));
    let settings = Settings::finest();
    for position in [DVec3::new(0.05, 0.1, 0.7), DVec3::new(-0.3, 0.2, 0.62), DVec3::new(0.0, -0.06, 0.9)] {
        let motion = ObjectMotion::Static { position, attitude: DQuat::IDENTITY };
        let placed = bench.place(&camera, 0.0, &bench.object(motion, 0.05, 1), &settings);
        // Orders 1 to 3 are asked for, only the first exists: by E > 0, then by E < 0.
        assert_eq!(placed.len(), 2);
        let points = bench.points();
        let seen = bench.seen(camera, 0.0, placed, settings);
        for (image, branch) in [(0, Branch::Plus), (1, Branch::Minus)] {
            for (point, vertex) in points.iter().zip(&seen[image * points.len()..]) {
                let (want, delay) = judged(&camera, position + *point * 0.05, 1, branch).expect("seen");
                let got = apparent(vertex);
                let angle = got.normalize().angle_between(want).to_degrees();
                assert!(angle < 0.01, "{branch:?} {position} {point}: {angle}° off");
                let late = (f64::from(vertex.path) - delay).abs();
                assert!(late < 0.002 + 1e-4 * delay, "{branch:?} {position} {point}: delay {} for {delay}", vertex.path);
            }
        }
    }
}

/// The stages that were compiled meanwhile are those that a crossing compiles, and they are there again after the camera has been outside.
#[test]
fn what_was_foreseen_is_seen_inside() {
    // Of its own: that for all has been inside.
    let mut foreseeing = Bench::new([64, 36]);
    foreseeing.renderer.precompile_the_inside();
    let mut bench = bench();
    let outside = falling(DVec3::new(0.0, 0.05, 1.6), DVec3::ZERO);
    // Another method before the first crossing: what was foreseen for the one before is kept, and this one is foreseen as well.
    for method in [flat::METHOD, Method::default()] {
        let settings = Settings { method, ..Settings::finest() };
        let frame = FrameInput { camera: outside, time: 0.0, placed: Vec::new(), held: None, aurora: None, settings };
        foreseeing.renderer.picture(&frame, false).unwrap();
        foreseeing.renderer.precompile_the_inside();
    }
    let settings = Settings::finest();
    for radius in [0.45, 1.6, 0.45, 1.4] {
        let camera = falling(DVec3::new(0.0, 0.05, radius), DVec3::new(0.1, -0.2, 0.05));
        let motion = ObjectMotion::Static { position: DVec3::new(0.05, 0.1, radius + 0.25), attitude: DQuat::IDENTITY };
        let placed = bench.place(&camera, 0.0, &bench.object(motion, 0.05, 1), &settings);
        let vertices = placed.len() * bench.points().len();
        let [seen, want] =
            [&mut foreseeing, &mut *bench].map(|bench| bench.seen(camera, 0.0, placed.clone(), settings)[..vertices].to_vec());
        assert!(want.iter().filter(|vertex| vertex.path > 0.0).count() > 50, "from {radius}");
        assert!(bytemuck::cast_slice::<_, u8>(&seen) == bytemuck::cast_slice::<_, u8>(&want), "from {radius}");
    }
}

/// The worldline of a ship flown by `command` from `state` at T = 0 to `until`.
fn flight(state: ShipState, command: Command, until: f64) -> History {
    let mut history = History::new(0.0, &state);
    let (mut now, mut time) = (state, 0.0);
    while time < until {
        now = step(&now, 0.02, command.thrust, command.rates);
        time += 0.02;
        if lensrunner::spacetime::matter::has_ended(&now) {
            break;
        }
        history.push(time, &now, &command);
    }
    history
}

/// Where a body point of the ship is at T, on the slice: contracted and turned.
fn point_at(history: &History, time: f64, body: DVec3) -> DVec3 {
    let sample = history.at(time);
    let p = sample.momentum;
    let g = gamma(p);
    let contraction = DMat3::IDENTITY - DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (g * (1.0 + g)));
    sample.position + contraction * (sample.attitude * body)
}

/// When the light of a body point left that arrives at `time`, and by which branch: the last instant in the camera's past, by bisection.
fn emission(camera: &Observer, time: f64, history: &History, body: DVec3, order: u32) -> (f64, Branch) {
    let past = |t: f64| -> (bool, Branch) {
        let (r, phi, _, _) = polar(camera, point_at(history, t, body));
        let connect = |branch| light::connect(1.0 / r, Order::new(order as u8).unwrap().swept(phi), 1.0 / camera.radius(), branch);
        let Some(plus) = connect(Branch::Plus) else { return (false, Branch::Plus) };
        let Some(minus) = connect(Branch::Minus) else { return (t + plus.delay <= time, Branch::Plus) };
        let (spare, rest) = (time - t - plus.delay, t + minus.delay - time);
        (spare >= 0.0 && rest >= 0.0, if rest < spare { Branch::Minus } else { Branch::Plus })
    };
    let (mut low, mut high) = (time - 200.0, time);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if past(middle).0 { low = middle } else { high = middle }
    }
    (low, past(low).1)
}

/// Every vertex of a ship in flight is where the judge sees the place that it had at its own emission time.
fn check_flight(camera: Observer, time: f64, history: &History, size: f64, orders: u32, most: f64) -> [usize; 2] {
    let mut bench = bench();
    let settings = Settings { orders, ..Settings::finest() };
    let placed = bench.place(&camera, time, &bench.object(ObjectMotion::Flying(history), size, 1), &settings);
    assert_eq!(placed.len(), orders as usize, "not every order is seen");
    let points = bench.points();
    let seen = bench.seen(camera, time, placed, settings);
    let mut counts = [0, 0];
    let mut worst = 0.0f64;
    for order in 1..=orders {
        for (point, vertex) in points.iter().zip(&seen[(order as usize - 1) * points.len()..]) {
            let (left, branch) = emission(&camera, time, history, *point * size, order);
            let place = point_at(history, left, *point * size);
            let (want, delay) = judged(&camera, place, order, branch).expect("the judge sees it");
            assert!((time - left - delay).abs() < 1e-6 * (1.0 + delay), "the exact ray took {}, the judge's {delay}", time - left);
            let angle = apparent(vertex).normalize().angle_between(want).to_degrees();
            assert!(vertex.path > 0.0, "order {order} {branch:?} r {}: not seen", place.length());
            worst = worst.max(angle);
            assert!(angle < most, "order {order} {branch:?} r {}: {angle}° off", place.length());
            let late = (f64::from(vertex.path) - delay).abs();
            assert!(late < 0.01 + 1e-4 * delay, "order {order} {branch:?}: delay {} for {delay}", vertex.path);
            counts[usize::from(branch == Branch::Minus)] += 1;
        }
    }
    println!("{counts:?} vertices, worst {worst:.5}°");
    counts
}

fn ship(position: DVec3, momentum: DVec3) -> ShipState {
    ShipState { position, momentum, attitude: DQuat::from_rotation_y(0.4), proper_time: 0.0 }
}

/// A fast ship that turns and thrusts, both orders, seen by a hovering camera: its own light delay at every vertex.
#[test]
fn every_vertex_of_a_turning_ship_has_its_own_emission_time() {
    let state = ship(DVec3::new(6.0, 0.5, -3.0), DVec3::new(-0.3, 0.1, 0.6));
    let history = flight(state, Command { thrust: DVec3::new(0.0, 0.02, -0.03), rates: DVec3::new(0.1, 0.35, -0.2) }, 60.0);
    let camera = static_camera(DVec3::new(1.0, 2.0, 11.0), DVec3::new(0.0, -0.2, -1.0), DVec3::Y, 1.0);
    check_flight(camera, 16.0, &history, 0.3, 2, 0.02);
}

/// A ship flies across the axis behind the hole, some 35 r_s/c ago. The azimuths at which its points are seen show where they were across the
/// axis. A delay so long leaves 4e-6 r_s/c in f32, and what may be off by that is drawn 2e-5 r_s beside the axis.
#[test]
fn a_distant_ship_on_the_axis_is_seen_where_it_was() {
    let history = flight(ship(DVec3::new(-14.0, -4.0, 0.0), DVec3::new(-0.2, 0.4, 0.0)), Command::default(), 40.0);
    let camera = static_camera(DVec3::X * 20.0, -DVec3::X, DVec3::Z, 1.0);
    let across = |time: f64, body: DVec3| point_at(&history, emission(&camera, time, &history, body, 1).0, body);
    let (mut before, mut after) = (40.0, 70.0);
    for _ in 0..40 {
        let middle = 0.5 * (before + after);
        if across(middle, DVec3::ZERO).y < 0.0 { before = middle } else { after = middle }
    }
    let mut bench = bench();
    let settings = Settings { orders: 1, ..Settings::finest() };
    let (size, time) = (0.05, after);
    let placed = bench.place(&camera, time, &bench.object(ObjectMotion::Flying(&history), size, 1), &settings);
    let points = bench.points();
    let seen = bench.seen(camera, time, placed, settings);
    for (point, vertex) in points.iter().zip(&seen) {
        let place = across(time, *point * size);
        assert!(place.x < -8.0, "{place}");
        let towards = camera.attitude * apparent(vertex);
        let off = (towards.y.atan2(towards.z) - place.y.atan2(place.z)).sin() * place.y.hypot(place.z);
        // The search for the emission time may end a fiftieth of a pixel off.
        assert!(off.abs() < 1e-5, "{place}: {off:e} r_s");
    }
}

/// A ship falls in behind a falling camera: its light reaches the camera from outside, from inside, and across r = 1.
#[test]
fn a_ship_that_crosses_the_horizon_is_seen_from_inside() {
    let state = ship(DVec3::new(0.3, 0.2, 1.9), DVec3::ZERO);
    let history = flight(state, Command { rates: DVec3::new(0.2, 0.0, 0.3), ..Command::default() }, 10.0);
    let crossing = (0..500).map(|i| 0.02 * f64::from(i)).find(|&t| history.at(t).position.length() < 1.0).expect("it falls in");
    let camera = falling(DVec3::new(0.02, 0.0, 0.5), DVec3::new(0.0, 0.0, -0.1));
    let (mut plus, mut minus) = (0, 0);
    for after in [0.2, 0.9, 1.3, 1.7] {
        let [p, m] = check_flight(camera, crossing + after, &history, 0.05, 1, 0.02);
        (plus, minus) = (plus + p, minus + m);
    }
    assert!(plus > 0, "{plus} {minus}");
}

/// A ship that fell in ahead of the camera, and has ended by now, is seen ahead by the light that it sent outward inside: E < 0. Some of
/// its vertices are met there and others where E > 0, while the camera looks across.
#[test]
fn a_ship_ahead_is_seen_by_light_of_negative_energy() {
    let state = ship(DVec3::new(0.0, 0.02, 1.3), DVec3::ZERO);
    let history = flight(state, Command { rates: DVec3::new(0.3, 0.1, 0.0), ..Command::default() }, 1.2);
    let camera = falling(DVec3::new(0.02, 0.0, 0.3), DVec3::new(0.1, 0.0, 0.0));
    let mut minus = 0;
    for time in [1.1, 1.3, 1.5] {
        minus += check_flight(camera, time, &history, 0.02, 1, 0.02)[1];
    }
    assert!(minus >= 100, "only {minus} vertices were seen by E < 0");
}

/// From 5,000 r_s away an offset in f32 no longer tells r − 1: vertices near the horizon get it from their place at the hole.
#[test]
fn a_far_camera_sees_what_is_near_the_horizon_on_time() {
    let mut bench = bench();
    let camera = static_camera(DVec3::new(0.0, 3000.0, 4000.0), DVec3::new(0.0, -3.0, -4.0), DVec3::X, 1.0);
    let settings = Settings { orders: 2, ..Settings::finest() };
    // A ball just over the horizon: its lowest vertices lie at r = 1.0005.
    for direction in [DVec3::new(0.3, 0.5, 0.6), DVec3::new(0.9, -0.1, -0.2)] {
        let (size, position) = (0.003, direction.normalize() * 1.0035);
        let placed =
            bench.place(&camera, 0.0, &bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, size, 1), &settings);
        let points = bench.points();
        let seen = bench.seen(camera, 0.0, placed, settings);
        for order in [1, 2] {
            for (point, vertex) in points.iter().zip(&seen[(order as usize - 1) * points.len()..]) {
                let place = position + *point * size;
                let (r, phi, _, _) = polar(&camera, place);
                let exact = light::connect(1.0 / r, Order::new(order).unwrap().swept(phi), 1.0 / camera.radius(), Branch::Plus).unwrap();
                let late = (f64::from(vertex.path) - exact.delay).abs();
                // 0.02 near the horizon, and what f32 makes of 5,000.
                assert!(late < 0.022, "order {order} r {r}: delay {} for {}", vertex.path, exact.delay);
            }
        }
    }
}

/// Method "flat": what hovers is seen along the straight line, at its distance, once.
#[test]
fn flat_space_projects_straight() {
    let mut bench = bench();
    let settings = Settings { method: flat::METHOD, ..Settings::finest() };
    let camera = static_camera(DVec3::new(1.0, 2.0, 7.0), DVec3::new(0.1, -0.2, -1.0), DVec3::Y, 1.0);
    let position = DVec3::new(0.5, -1.0, -5.0);
    let placed = bench.place(&camera, 0.0, &bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, 0.5, 1), &settings);
    assert_eq!(placed.len(), 1);
    let points = bench.points();
    let seen = bench.seen(camera, 0.0, placed, settings);
    for (point, vertex) in points.iter().zip(&seen) {
        let line = position + *point * 0.5 - camera.position;
        let want = camera.attitude.conjugate() * line;
        assert!((apparent(vertex) - want).length() < 1e-5 * line.length(), "{} for {want}", apparent(vertex));
        assert!((vertex.shift - 1.0).abs() < 1e-5, "g = {} between things at rest", vertex.shift);
    }
    // And back again: pipelines are made anew.
    let settings = Settings::finest();
    let placed = bench.place(&camera, 0.0, &bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, 0.5, 1), &settings);
    let seen = bench.seen(camera, 0.0, placed, settings);
    let (want, _) = judged(&camera, position + points[0] * 0.5, 1, Branch::Plus).unwrap();
    assert!(apparent(&seen[0]).normalize().angle_between(want).to_degrees() < 0.01);
}

/// Without light delay a ship is seen where it is at the frame's time.
#[test]
fn without_light_delay_things_are_seen_where_they_are_now() {
    let mut bench = bench();
    let settings = Settings { light_delay: false, orders: 1, ..Settings::finest() };
    let state = ship(DVec3::new(3.0, 0.5, -2.0), DVec3::new(-0.3, 0.1, 0.6));
    let history = flight(state, Command::default(), 30.0);
    let camera = static_camera(DVec3::new(1.0, 2.0, 11.0), DVec3::new(0.0, -0.2, -1.0), DVec3::Y, 1.0);
    let placed = bench.place(&camera, 1.5, &bench.object(ObjectMotion::Flying(&history), 0.3, 1), &settings);
    let points = bench.points();
    let seen = bench.seen(camera, 1.5, placed, settings);
    for (point, vertex) in points.iter().zip(&seen) {
        let (want, _) = judged(&camera, point_at(&history, 1.5, *point * 0.3), 1, Branch::Plus).unwrap();
        let angle = apparent(vertex).normalize().angle_between(want).to_degrees();
        assert!(angle < 0.01, "{angle}° off");
    }
}

/// Methods "paper1-…": vertices lie where the tables as their author used them say, evaluated on the processor; of a square behind the hole
/// the triangles at the axis are dropped, which leaves a gap in the ring that ours closes.
#[test]
fn paper_one_projects_by_its_tables_and_drops_triangles() {
    use lensrunner::lensing::paper;
    let mut bench = bench();
    let table = Arc::new(bake(Scheme::Paper, 24, |_| ()));
    bench.renderer.tables().set(methods::paper::METHOD, table.clone());
    let paper1 = methods::paper::METHOD;
    let settings = Settings { method: paper1, orders: 3, stars: false, milky_way: false, ..Settings::finest() };
    let camera = static_camera(DVec3::new(1.0, 2.0, 11.0), DVec3::new(0.1, -0.2, -1.0), DVec3::Y, 1.0);
    for position in [DVec3::new(3.0, -1.0, -5.0), DVec3::new(-2.0, 3.0, 25.0)] {
        let placed =
            bench.place(&camera, 0.0, &bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, 0.5, 1), &settings);
        assert_eq!(placed.len(), 2, "Yamashita 2012 has two orders");
        let points = bench.points();
        let seen = bench.seen(camera, 0.0, placed, settings);
        for order in [1u8, 2] {
            for (point, vertex) in points.iter().zip(&seen[(usize::from(order) - 1) * points.len()..]) {
                let (r, phi, n, side) = polar(&camera, position + *point * 0.5);
                let [psi, _] = paper::lookup(&table, [r, phi, camera.radius()], order);
                let side = if order == 2 { -side } else { side };
                // A hovering camera's own axes: no aberration against the static frame.
                let want = camera.attitude.conjugate() * (n * psi.cos() + side * psi.sin());
                let angle = apparent(vertex).normalize().angle_between(want).to_degrees();
                assert!(angle < 0.02, "order {order} {position}: {angle}° from the table's {psi}");
            }
        }
    }
    let square = bench.renderer.add_model(&shapes::square(200, shapes::Anchor::Inside, Material::default()));
    let count = |bench: &mut Bench, method| {
        let settings = Settings { method, ..settings };
        let motion = ObjectMotion::Static { position: DVec3::new(0.0, 0.0, -12.0), attitude: DQuat::IDENTITY };
        let mut object = bench.object(motion, 8.0, 1);
        (object.model, object.coarse) = (square, square);
        let eye = static_camera(DVec3::new(0.0, 0.0, 15.0), DVec3::NEG_Z, DVec3::Y, 1.0);
        let placed = bench.place(&eye, 0.0, &object, &settings);
        let frame = FrameInput { camera: eye, time: 0.0, placed, held: None, aurora: None, settings };
        let picture = bench.renderer.picture(&frame, true).unwrap();
        (picture.layers.iter().filter(|texel| texel[0] == 1.0).count(), bench.renderer.counters().unwrap().indices / 3)
    };
    let (holed, drawn) = count(&mut bench, paper1);
    let (whole, _) = count(&mut bench, Method::default());
    println!("{holed} pixels by Yamashita 2012 ({drawn} triangles), {whole} by the table");
    assert!(drawn < 2 * 200 && drawn > 200 && holed < whole);
}
