//! The verdict: each metric on pictures whose faults are known, and pictures broken on purpose.

use std::path::Path;

use glam::DVec3;
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{Pose, Sampling, TracedPicture, Worldline};
use lensrunner::scene::{GameConfig, Scene};
use lensrunner_lab::compare::ContestantFrame;
use lensrunner_lab::compare::command::difference;
use lensrunner_lab::compare::measure::displacement::Effort;
use lensrunner_lab::compare::measure::metrics::{Limits, Verdict, compare_with};
use lensrunner_lab::compare::measure::probe::probe;

const SIZE: [u32; 2] = [160, 90];

/// The chequered ball half behind the hole, seen in two orders.
const BALL: &str = "
[camera]
position = [0.0, 0.0, 15.0]
[[prop]]
name = \"ball\"
model = \"sphere\"
position = [4.0, 0.0, -12.0]
size = 8.0
triangles = 400
texture = \"checker\"
";

fn scene(text: &str) -> Case {
    let scene = Scene::from_toml(Path::new("test.toml"), text).unwrap();
    Case::new(scene, GameConfig::default(), 0.0, SIZE)
}

fn trace(case: &Case) -> TracedPicture {
    case.trace(&Sampling { samples: 1, tolerance: 1e-10, packet: 8 }, false, &|_| ())
}

fn verdict(case: &Case, judge: &TracedPicture, frame: &ContestantFrame) -> Verdict {
    verdict_with(case, judge, frame, &Effort::default())
}

/// With no more than this for displacements.
fn verdict_with(case: &Case, judge: &TracedPicture, frame: &ContestantFrame, effort: &Effort) -> Verdict {
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    compare_with(judge, frame, &probe(case, 1e-10), &names, &difference(judge, frame), effort)
}

fn faults(case: &Case, judge: &TracedPicture, frame: &ContestantFrame) -> Vec<String> {
    verdict(case, judge, frame).faults(&Limits::default())
}

/// One of the faults is said in these words.
fn tells(faults: &[String], words: &[&str]) {
    assert!(faults.iter().any(|fault| words.iter().all(|word| fault.contains(word))), "{words:?} not in {faults:?}");
}

/// The picture moved to the right by whole pixels.
fn moved(frame: &ContestantFrame, by: usize) -> ContestantFrame {
    let width = frame.size[0] as usize;
    let mut moved = frame.clone();
    for i in 0..frame.shown.len() {
        let from = if i % width >= by { i - by } else { i };
        moved.shown[i] = frame.shown[from];
        moved.light[i] = frame.light[from];
        moved.bare[i] = frame.bare[from];
    }
    moved
}

#[test]
fn a_perfect_picture_passes_and_its_faults_are_measured() {
    let case = scene(BALL);
    let judge = trace(&case);
    let perfect = ContestantFrame::of(&judge, &case);
    let good = verdict(&case, &judge, &perfect);
    // Where displacements are beside the point.
    let few = Effort { pixels: 40, doubtful: 4, ..Effort::default() };
    assert_eq!(good.faults(&Limits::default()), Vec::<String>::new());
    // Points of surfaces are handed in as f32.
    assert!(good.groups[0].displacement.max < 1e-4, "{:?}", good.groups[0]);
    assert_eq!((good.groups[0].mismatched, good.flip), (0, 0.0));
    assert!(good.groups[0].pixels > 500 && good.groups[1].order == 2 && good.groups[1].pixels > 30, "{:?}", good.groups);

    // What mismatches are a part of: the pixels of an image, and those outside that touch it.
    let (width, height) = (i64::from(SIZE[0]), i64::from(SIZE[1]));
    for group in &good.groups {
        let shows = |x: i64, y: i64| {
            (0..width).contains(&x) && (0..height).contains(&y) && judge.layers[(y * width + x) as usize].order == group.order
        };
        let touches = |x: i64, y: i64| (-1..=1).any(|dy| (-1..=1).any(|dx| shows(x + dx, y + dy)));
        let places = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        assert_eq!(group.pixels, places().filter(|&(x, y)| shows(x, y)).count());
        assert_eq!(group.rim, places().filter(|&(x, y)| !shows(x, y) && touches(x, y)).count());
    }

    // A pixel to the right: the displacement is one pixel, and edges differ.
    let one = verdict(&case, &judge, &moved(&perfect, 1));
    let d = one.groups[0].displacement;
    assert!((0.85..1.15).contains(&d.mean) && d.pixels > 400, "{d:?}");
    assert!(one.groups[0].mismatched > 20 && one.groups[0].beyond_rim == 0 && one.flip > 0.0);
    // Two pixels: mismatches reach beyond the rim.
    assert!(verdict_with(&case, &judge, &moved(&perfect, 2), &few).groups[0].beyond_rim > 5);

    // A third of a pixel, as a renderer would show it: coordinates of a place between the pixels.
    let mut shifted = perfect.clone();
    for i in 1..judge.layers.len() {
        let (a, b) = (&judge.layers[i - 1], &judge.layers[i]);
        if (a.object, a.order) == (b.object, b.order) && a.object > 0 {
            shifted.shown[i].body = case.body(b).lerp(case.body(a), 1.0 / 3.0).as_vec3().to_array();
        }
    }
    let d = verdict_with(&case, &judge, &shifted, &few).groups[0].displacement;
    assert!((0.28..0.38).contains(&d.mean), "{d:?}");

    // The brightness alone: no displacement, but colour.
    let mut bright = perfect.clone();
    bright.light.iter_mut().for_each(|rgb| *rgb = rgb.map(|c| 0.5 * c));
    let bright = verdict_with(&case, &judge, &bright, &few);
    assert!(bright.flip > 0.02 && bright.groups[0].flip > 0.1 && bright.groups[0].displacement.max < 1e-4, "{}", bright.flip);

    // Light in the midst of the shadow, one pixel of it.
    let dark = (0..judge.dark.len())
        .find(|&i| (-4i32..=4).all(|dy| (-4i32..=4).all(|dx| judge.dark.get((i as i32 + 160 * dy + dx) as usize) == Some(&true))));
    let mut lit = perfect.clone();
    lit.bare[dark.unwrap()] = [0.1; 3];
    assert_eq!(verdict_with(&case, &judge, &lit, &few).lit, 1);
}

#[test]
fn dropped_triangles_are_holes() {
    // The remedy of Yamashita 2012: triangles that the axis meets are left out.
    let case = scene(&BALL.replace("4.0, 0.0, -12.0", "1.0, 0.0, -12.0"));
    let judge = trace(&case);
    let mut broken = ContestantFrame::of(&judge, &case);
    let (axis, model) = (case.camera.observer.position.normalize(), &case.assembly.models[0]);
    let position = DVec3::new(1.0, 0.0, -12.0);
    let mut dropped = 0;
    for (layer, (shown, bare)) in judge.layers.iter().zip(broken.shown.iter_mut().zip(&mut broken.bare)) {
        if layer.object == 0 {
            continue;
        }
        let corners = model.triangles[layer.triangle as usize].map(|i| {
            let v = position + 8.0 * DVec3::from(model.vertices[i as usize].position.map(f64::from));
            v - axis * v.dot(axis)
        });
        // The axis goes through where the corners lie around it.
        let turns = [0, 1, 2].map(|k| corners[k].cross(corners[(k + 1) % 3]).dot(axis));
        if turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0) {
            (*shown, *bare) = (Default::default(), [0.0; 3]);
            dropped += 1;
        }
    }
    assert!(dropped > 20, "{dropped}");
    tells(&faults(&case, &judge, &broken), &["holes"]);
    // Where one of four rays goes through a slit between things, it is no hole to see through it.
    let mut slit = judge.clone();
    slit.shares.iter_mut().flatten().for_each(|share| share.2 = 0.75);
    assert_eq!(verdict(&case, &slit, &broken).holes, 0);
}

#[test]
fn a_missing_or_wrong_order_is_found() {
    let case = scene(BALL);
    let judge = trace(&case);
    let mut none = ContestantFrame::of(&judge, &case);
    for shown in none.shown.iter_mut().filter(|shown| shown.order == 2) {
        *shown = Default::default();
    }
    tells(&faults(&case, &judge, &none), &["order 2", "pixels differ"]);
    let mut wrong = ContestantFrame::of(&judge, &case);
    for shown in wrong.shown.iter_mut().filter(|shown| shown.order == 2) {
        shown.order = 1;
    }
    tells(&faults(&case, &judge, &wrong), &["show an order that is nowhere near"]);
}

#[test]
fn coarse_triangles_are_found() {
    // Tessellation off: every coarse triangle of the ball is drawn with straight sides between its seen corners. The contestant shows, at
    // each pixel, what straight interpolation over the triangle gives.
    let case = scene(BALL);
    let judge = trace(&case);
    let mut flat = ContestantFrame::of(&judge, &case);
    let model = &case.assembly.models[0];
    let position = DVec3::new(4.0, 0.0, -12.0);
    let width = SIZE[0] as usize;
    let mut changed = 0;
    for i in 0..judge.layers.len() {
        let layer = &judge.layers[i];
        if layer.object == 0 || layer.order != 1 {
            continue;
        }
        let triangle = model.triangles[layer.triangle as usize].map(|k| &model.vertices[k as usize]);
        let corners = triangle.map(|v| seen(&case, position + 8.0 * DVec3::from(v.position.map(f64::from))));
        let [Some(a), Some(b), Some(c)] = corners else { continue };
        let p = [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5];
        let cross = |o: [f64; 2], p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
        let area = cross(a, b, c);
        let w = [cross(p, b, c) / area, cross(p, c, a) / area, cross(p, a, b) / area];
        flat.shown[i].body = [0, 1, 2].map(|k| (0..3).map(|j| w[j] as f32 * triangle[j].position[k]).sum());
        changed += 1;
    }
    assert!(changed > 300, "{changed}");
    tells(&faults(&case, &judge, &flat), &["order 1", "displacement"]);
}

/// Where, in pixels, the camera sees a point outside the hole in order 1, by shooting.
fn seen(case: &Case, point: DVec3) -> Option<[f64; 2]> {
    use lensrunner::judge::{EnergySign, shoot};
    let n = case.camera.observer.position.normalize();
    let across = point - n * point.dot(n);
    let sight =
        shoot(point.length(), across.length().atan2(point.dot(n)), case.camera.observer.position.length(), 1, EnergySign::Plus, 1e-12)?;
    let look = n * sight.psi_rain.cos() + across.normalize() * sight.psi_rain.sin();
    Some(case.camera.seen_at(look)?.0)
}

#[test]
fn delay_off_is_found() {
    let text = "
[camera]
position = [0.0, 0.0, 14.0]
[[ship]]
name = \"quarry\"
model = \"quarry.glb\"
orbit = { radius = 6.0, phase = 1.0 }
[sky]
stars = false
milky_way = false
";
    let mut case = scene(text);
    case.assembly.objects[0].scale = 2.0;
    let judge = trace(&case);
    assert!(judge.layers.iter().filter(|layer| layer.object == 1).count() > 40);
    assert_eq!(faults(&case, &judge, &ContestantFrame::of(&judge, &case)), Vec::<String>::new());
    // Seen where it is now, as if light took no time: a body that stands still at its place of T = 0.
    struct Still(Pose);
    impl Worldline for Still {
        fn at(&self, _: f64) -> Pose {
            self.0
        }
    }
    let now = Worldline::at(&case.histories[0], 0.0);
    let still = Still(now);
    let broken = case.trace_with(&[&still], &Sampling { samples: 1, tolerance: 1e-10, packet: 8 }, false, &|_| ());
    tells(&faults(&case, &judge, &ContestantFrame::of(&broken, &case)), &["quarry order 1"]);
}

#[test]
fn the_planet_is_seen_where_it_was_when_its_light_left() {
    let text = "
[camera]
position = [30.0, 0.0, 2.0]
[planet]
orbit_radius = 20.0
phase = 0.05
radius = 0.6
day = 40.0
aurora = \"none\"
";
    let scene = Scene::from_toml(Path::new("test.toml"), text).unwrap();
    let mut config = GameConfig::default();
    config.render.lensing = false;
    let case = Case::new(scene, config, 0.0, [160, 90]);
    let picture = case.trace(&Sampling { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    let pixels: Vec<usize> = (0..picture.layers.len()).filter(|&i| picture.layers[i].object == 1).collect();
    let planet = case.scene.planet.unwrap();
    // Straight light: the emission time by iteration, which converges as the planet is slow.
    let mut emission = 0.0;
    for _ in 0..60 {
        emission = -planet.state(emission).unwrap().position.distance(case.camera.observer.position);
    }
    let look = |time: f64| planet.state(time).unwrap().position - case.camera.observer.position;
    let (centre, blue) = case.camera.seen_at(look(emission).normalize()).unwrap();
    let mean = |part: &dyn Fn(usize) -> usize| pixels.iter().map(|&i| part(i) as f64 + 0.5).sum::<f64>() / pixels.len() as f64;
    let mean = [mean(&|i| i % 160), mean(&|i| i / 160)];
    let off = (mean[0] - centre[0]).hypot(mean[1] - centre[1]);
    assert!(off < 0.4, "{mean:?} {centre:?}");
    // Where it is now is elsewhere.
    let now = case.camera.seen_at(look(0.0).normalize()).unwrap().0;
    assert!((now[0] - centre[0]).hypot(now[1] - centre[1]) > 3.0, "{now:?} {centre:?}");
    // Its size, within the pixels of its rim: aberration makes what is seen red larger.
    let radius = 160.0 / (2.0 * (30f64.to_radians()).tan()) * planet.radius / look(emission).length() / blue;
    let area = std::f64::consts::PI * radius * radius;
    assert!((pixels.len() as f64 / area - 1.0).abs() < 0.08, "{} pixels, {area}", pixels.len());
    assert!(pixels.iter().all(|&i| (picture.layers[i].delay + emission).abs() < planet.radius * 1.1));
}

#[test]
fn thin_images_are_compared_by_the_area_they_cover() {
    // Two hundred balls of half a pixel.
    let case = scene(
        "
[camera]
position = [0.0, 0.0, 60.0]
[[prop]]
name = \"dust\"
model = \"lattice\"
count = [14, 14, 1]
spacing = 2.0
size = 0.25
triangles = 20
",
    );
    let judge = case.trace(&Sampling { samples: 5, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    // What a renderer hands in that draws thin images by coverage: exactly, doubled, and none.
    let drawn = |factor: f32| {
        let mut frame = ContestantFrame::of(&judge, &case);
        for (shown, shares) in frame.shown.iter_mut().zip(&judge.shares) {
            *shown = Default::default();
            if let Some(&(object, order, _)) = shares.first()
                && factor > 0.0
            {
                let coverage = shares.iter().map(|share| share.2).sum::<f32>() * factor;
                *shown = lensrunner_lab::compare::Shown { object, order, body: [0.0; 3], coverage: coverage.min(0.99) };
            }
        }
        frame
    };
    let exact = verdict(&case, &judge, &drawn(1.0));
    let group = exact.groups.iter().find(|group| group.order == 1).unwrap();
    assert!(group.thin[0] > 40.0 && group.pixels == 0, "{group:?}");
    assert_eq!(exact.faults(&Limits::default()), Vec::<String>::new());
    for factor in [0.0, 2.0] {
        tells(&faults(&case, &judge, &drawn(factor)), &["thin images cover"]);
    }
    // The right areas in a wrong place.
    let mut moved = drawn(1.0);
    moved.shown.rotate_right(4);
    tells(&faults(&case, &judge, &moved), &["pixels differ"]);
}

#[test]
fn colours_of_the_disk_are_judged_where_the_judge_knows_them() {
    use lensrunner_lab::compare::command::colour_limit;
    let mut case = Case::new(lensrunner::scene::load("disk").unwrap(), GameConfig::default(), 0.0, [96, 54]);
    case.scene.sky.stars = false;
    case.scene.sky.milky_way = false;
    let traced = |samples| case.trace(&Sampling { samples, tolerance: 1e-8, packet: 8 }, false, &|_| ());
    let judge = traced(4);
    let limits = Limits { flip: Some(colour_limit(&judge)), ..Limits::default() };
    let found = |frame: &ContestantFrame| verdict(&case, &judge, frame).faults(&limits);
    assert_eq!(found(&ContestantFrame::of(&judge, &case)), Vec::<String>::new());
    // Another grid of rays sees the same disk.
    assert_eq!(found(&ContestantFrame::of(&traced(5), &case)), Vec::<String>::new());
    // Moved by two pixels; a third darker.
    let mut darker = ContestantFrame::of(&judge, &case);
    darker.light.iter_mut().for_each(|rgb| *rgb = rgb.map(|c| c / 1.5));
    for broken in [moved(&ContestantFrame::of(&judge, &case), 2), darker] {
        tells(&found(&broken), &["FLIP"]);
    }
}
