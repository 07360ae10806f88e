//! What the game points at, asked of the judge: each pointer's pixel shows what the pointer says.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{BodyMotion, PlaneCrossing, Seen, Thing, World, Worldline};
use lensrunner::judge::trace::{Hit, PixelCamera};
use lensrunner::judge::{RayFate, fate};
use lensrunner::scene::Vertex;
use lensrunner::scene::disk::Gas;
use lensrunner::scene::lighting::Illumination;
use lensrunner::scene::model::{Material, shapes};
use lensrunner::scene::{self, GameConfig, Model};
use lensrunner::sim::History;
use lensrunner::sim::seeing::{Phenomenon, Pointer, Scenery, SeenBody, Track, pointers};
use lensrunner::sim::sight;
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner::spacetime::matter::{ShipState, gamma};
use lensrunner::spacetime::orbit::{circular_momentum, static_momentum};
use lensrunner::spacetime::{Observer, frames};
use rand::{RngExt, SeedableRng, rngs::StdRng};

const TOLERANCE: f64 = 1e-12;
const SIZE: [u32; 2] = [1280, 720];
const ASPECT: f64 = 1280.0 / 720.0;
/// Share of a pixel's light that the gas pointed at must give at least, or that gas before something else may stop at most. The pointers go
/// by 0.4 and 0.2 within 2 standard deviations of the gas's density; here it is as dense as it is.
const SHARE: f64 = 0.3;

/// A crossing of the disk's plane with the gas that is there.
#[derive(Debug)]
struct Gassy {
    order: u32,
    at: PlaneCrossing,
    /// Share of the pixel's light that it stops, behind what is before it.
    share: f64,
    g: f64,
}

/// What the judge sees in one direction.
#[derive(Debug)]
struct Pixel {
    seen: Seen,
    gas: Vec<Gassy>,
    /// What is left of light from behind all gas.
    through: f64,
    /// Rain frame.
    look: DVec3,
    blue: f64,
}

impl Pixel {
    fn at(world: &World, gas: Option<&Gas>, camera: &PixelCamera, [x, y]: [f64; 2]) -> Pixel {
        let (look, blue) = camera.look(x, y);
        let mut pixel = Pixel { seen: Seen::Captured, gas: Vec::new(), through: 1.0, look, blue };
        let mut order = 0;
        pixel.seen = world.look_through(camera.observer.position, look, TOLERANCE, &mut |at| {
            order += 1;
            let Some(gas) = gas else { return };
            let r = at.position.truncate().length();
            let [inner, outer] = gas.extent();
            if r > inner && r < outer {
                let momentum = gas.momentum(at.position);
                let emission = gas.emission(r, at.position.y.atan2(at.position.x), world.time - at.delay);
                let opacity = emission.opacity(Gas::cosine(momentum, at.momentum), at.delay);
                let g = blue / (gamma(momentum) * at.momentum.length() - momentum.dot(at.momentum));
                pixel.gas.push(Gassy { order, at, share: pixel.through * opacity, g });
                pixel.through *= 1.0 - opacity;
            }
        });
        pixel
    }

    /// The gas that gives most.
    fn main_gas(&self) -> &Gassy {
        let most = self.gas.iter().max_by(|a, b| a.share.total_cmp(&b.share)).unwrap_or_else(|| panic!("no gas: {self:?}"));
        assert!(most.share >= SHARE, "{self:?}");
        most
    }

    fn is_clear(&self) {
        assert!(1.0 - self.through <= SHARE, "hidden by gas: {self:?}");
    }

    fn hit(&self) -> &Hit {
        let Seen::Hit(hit) = &self.seen else { panic!("no body: {self:?}") };
        self.is_clear();
        hit
    }

    /// ν_camera/ν of who hovers at the camera.
    fn blue_of_hovering(&self, camera: &Observer) -> f64 {
        let p = static_momentum(camera.position).unwrap();
        self.blue / (gamma(p) + p.dot(self.look))
    }
}

/// A scene for the judge.
struct Stage<'a> {
    world: World<'a>,
    gas: Option<&'a Gas>,
    camera: PixelCamera,
    /// The index of the target among the world's things.
    target: Option<usize>,
}

/// Asks the judge about a pointer; with `whole` also about the middle of its pixel, where what is pointed at is wider than one.
fn check(stage: &Stage, pointer: &Pointer, whole: bool) {
    let camera = &stage.camera.observer;
    let place = camera.pixel(pointer.direction, SIZE).expect("before the camera");
    let pixel = |place| Pixel::at(&stage.world, stage.gas, &stage.camera, place);
    let here = pixel(place);
    let wide = || if whole { pixel(place.map(|x| x.floor() + 0.5)) } else { pixel(place) };
    let outward = camera.position.normalize();
    let upper = camera.position.z.signum();
    match pointer.sight {
        Phenomenon::Shadow => {
            for pixel in [&here, &wide()] {
                assert_eq!(pixel.seen, Seen::Captured);
                pixel.is_clear();
            }
            let expected = (camera.radius() > 1.0).then(|| shadow_of_hovering(camera.position) / (1.0 / camera.radius()).asin());
            match (pointer.number, expected) {
                (Some(number), Some(expected)) => assert!((number / expected - 1.0).abs() < 1e-9, "{number} {expected}"),
                (number, expected) => assert_eq!(number, expected),
            }
        }
        Phenomenon::PhotonRing => {
            let swept = match here.seen {
                Seen::Sky { swept, .. } if 1.0 - here.through <= SHARE => swept,
                _ => {
                    let gas = here.main_gas();
                    assert!(gas.order >= 2, "{here:?}");
                    swept_to(&here, gas.order, camera)
                }
            };
            assert!(swept > 1.24 * PI, "{swept}");
            assert!((pointer.number.unwrap() * TAU - swept).abs() < 1e-6, "{} {swept}", pointer.number.unwrap() * TAU);
            // It lies at the shadow's edge, by a tenth of the shadow's radius. Light that comes in past the photon sphere from far behind
            // the camera is no other.
            let psi = here.look.angle_between(outward);
            let side = here.look.reject_from(outward).normalize();
            let within = psi + 0.1 * (PI - psi);
            let inwards = outward * within.cos() + side * within.sin();
            assert_ne!(fate(camera.position, here.look, TOLERANCE), RayFate::Captured);
            assert_eq!(fate(camera.position, inwards, TOLERANCE), RayFate::Captured, "{psi}");
        }
        Phenomenon::DiskFarSide => {
            for pixel in [&here, &wide()] {
                let gas = pixel.main_gas();
                let across = pixel.look - outward * pixel.look.dot(outward);
                assert_eq!(gas.order, 1);
                assert!(gas.at.position.dot(camera.position) < 0.0, "{pixel:?}");
                assert!(gas.at.momentum.z * upper > 0.0 && across.z * upper > 0.0, "{pixel:?}");
            }
            assert!((pointer.number.unwrap() / here.main_gas().at.position.length() - 1.0).abs() < 1e-6);
        }
        Phenomenon::DiskUnderside => {
            let gas = here.main_gas();
            assert_eq!(gas.order, 2);
            assert!(gas.at.momentum.z * upper < 0.0, "{here:?}");
            assert!((pointer.number.unwrap() / gas.at.position.length() - 1.0).abs() < 1e-6);
        }
        Phenomenon::BlueSide | Phenomenon::RedSide => {
            // Near the disk's plane much of it is in one pixel.
            for (pixel, within) in [(&here, 1e-6), (&wide(), 0.05)] {
                let (g, number) = (pixel.main_gas().g, pointer.number.unwrap());
                assert!((g / number - 1.0).abs() < within, "{g} {number}");
                assert_eq!(g > 1.0, pointer.sight == Phenomenon::BlueSide, "{g}");
            }
        }
        Phenomenon::TargetImage | Phenomenon::SecondImage => {
            let hit = here.hit();
            assert_eq!(Some(hit.object), stage.target);
            assert_eq!(hit.order, if pointer.sight == Phenomenon::TargetImage { 1 } else { 2 });
            // Its near side is as much younger as it is large.
            assert!((hit.delay - pointer.number.unwrap()).abs() < 1.0, "{} {:?}", hit.delay, pointer.number);
        }
        Phenomenon::EinsteinRing => {
            let hit = here.hit();
            assert_eq!(Some(hit.object), stage.target);
            assert!((hit.swept - PI).abs() < 0.1, "{}", hit.swept);
        }
        Phenomenon::Aberration => {
            assert!(matches!(here.seen, Seen::Sky { .. }), "{here:?}");
            here.is_clear();
            let number = pointer.number.unwrap();
            // What is bluer by D is smaller by D.
            assert!((number * here.blue_of_hovering(camera) - 1.0).abs() < 1e-9, "{number}");
            assert!(number < 0.9, "{number}");
        }
        Phenomenon::TrueTarget => {}
    }
}

/// Φ of the ray at its crossing of the disk's plane of this order, by the geometry of its plane.
fn swept_to(pixel: &Pixel, order: u32, camera: &Observer) -> f64 {
    let gas = pixel.gas.iter().find(|gas| gas.order == order).unwrap();
    let outward = camera.position.normalize();
    let side = pixel.look.reject_from(outward).normalize();
    let there = gas.at.position.dot(side).atan2(gas.at.position.dot(outward)).rem_euclid(TAU);
    if order == 3 { there + TAU } else { there }
}

/// Angular radius of the shadow for who hovers, by bisection.
fn shadow_of_hovering(position: DVec3) -> f64 {
    let (towards, across) = (-position.normalize(), position.normalize().any_orthonormal_vector());
    let attitude = frames::look(towards, across).unwrap();
    let observer = Observer { position, momentum: static_momentum(position).unwrap(), attitude, field_of_view: 1.0 };
    let (mut dark, mut light) = (0.0, PI);
    for _ in 0..50 {
        let middle: f64 = 0.5 * (dark + light);
        let look = observer.rain_direction(attitude.conjugate() * (towards * middle.cos() + across * middle.sin()));
        match fate(position, look, 1e-14) {
            RayFate::Captured => dark = middle,
            RayFate::Escaped { .. } => light = middle,
        }
    }
    dark
}

/// A camera at `position` with `momentum` (rain frame, in c) that looks at the hole as its frame sees it, turned aside by these angles in
/// rad.
fn facing(position: DVec3, momentum: DVec3, field_of_view: f64, [right, up, roll]: [f64; 3]) -> Observer {
    let observer = Observer { position, momentum, attitude: DQuat::IDENTITY, field_of_view };
    let hole = observer.seen_direction(-position.normalize());
    let up_there = if hole.z.abs() > 0.99 { DVec3::Y } else { DVec3::Z };
    let attitude = frames::look(hole, up_there).unwrap() * DQuat::from_euler(glam::EulerRot::YXZ, -right, up, roll);
    Observer { attitude, ..observer }
}

fn hovering(position: DVec3) -> DVec3 {
    static_momentum(position).unwrap()
}

/// The gas of the disk of `game.toml` as it is shipped, but for what `change` changes.
fn gas(change: impl FnOnce(&mut GameConfig)) -> Gas {
    let mut config = GameConfig::default();
    change(&mut config);
    Gas::new(&config.disk, config.hole.mass_solar)
}

fn ask(name: &str, camera: Observer, gas: Option<&Gas>, expected: &[Phenomenon]) {
    let world = World::new(&[], Vec::new(), 7.0, true);
    let stage = Stage { world, gas, camera: PixelCamera { observer: camera, size: SIZE }, target: None };
    let found = pointers(&camera, 7.0, &Scenery { disk: gas, ..Scenery::default() }, ASPECT);
    for pointer in &found {
        println!("{name}: {} {:?} {:?}", pointer.sight.key(), camera.pixel(pointer.direction, SIZE), pointer.number);
        check(&stage, pointer, true);
    }
    let sights: Vec<Phenomenon> = found.iter().map(|pointer| pointer.sight).collect();
    assert_eq!(sights, expected, "{name}");
}

#[test]
fn the_judge_sees_what_is_pointed_at_in_disk_shadow_and_ring() {
    use Phenomenon::*;
    let gas = gas(|_| ());
    let disk = Some(&gas);
    let at = |r: f64, azimuth: f64, height: f64| DVec3::new(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin()) * r;
    let all = [Shadow, PhotonRing, DiskFarSide, DiskUnderside, BlueSide, RedSide, Aberration];
    let few = [Shadow, PhotonRing, DiskFarSide, DiskUnderside, BlueSide, Aberration];
    let (far, near, fall, inside) = (at(15.0, 0.4, 0.3), at(8.0, -1.0, 0.35), at(6.0, 1.0, 0.5), at(0.7, 0.7, 0.4));
    let circling = circular_momentum(near, DVec3::Z.cross(near)).unwrap();
    // Name, place, momentum (else it hovers), field of view, how it is turned from the hole, disk, what is pointed at.
    type View<'a> = (&'a str, DVec3, Option<DVec3>, f64, [f64; 3], Option<&'a Gas>, &'a [Phenomenon]);
    let views: [View; 15] = [
        ("hovering", far, None, 1.1, [0.0; 3], disk, &all[..6]),
        ("hovering below, turned", at(15.0, 2.4, -0.2), None, 1.1, [0.2, -0.1, 2.0], disk, &all[..6]),
        ("without a disk", far, None, 1.1, [0.0; 3], None, &all[..2]),
        ("away from the hole", far, None, 1.1, [PI, 0.0, 0.0], None, &[]),
        ("circling", near, Some(circling), 1.4, [0.1, 0.1, 0.3], disk, &all),
        ("near the plane", at(10.0, 3.0, 0.01), None, 1.2, [0.0; 3], disk, &all[..6]),
        ("in the plane", at(10.0, 3.0, 0.0), None, 1.2, [0.0; 3], disk, &[Shadow, PhotonRing, BlueSide, RedSide]),
        ("over the pole", at(20.0, 0.0, 0.5 * PI), None, 1.2, [0.0; 3], disk, &[Shadow, RedSide]),
        ("falling", fall, Some(-1.2 * fall.normalize()), 1.8, [0.0; 3], disk, &few),
        (
            "flying past",
            fall,
            Some(1.2 * fall.normalize().any_orthonormal_vector()),
            1.8,
            [0.5, 0.0, 0.0],
            None,
            &[Shadow, PhotonRing, Aberration],
        ),
        ("under the photon sphere", at(1.2, 0.7, 0.6), None, 2.0, [0.6, 0.5, 0.0], disk, &[Shadow]),
        ("inside", inside, Some(DVec3::ZERO), 2.2, [0.0; 3], disk, &few[..5]),
        ("inside, out", inside, Some(0.5 * inside), 2.0, [PI, 0.0, 0.0], disk, &[RedSide]),
        ("narrow", far, None, 0.06, [0.16, 0.0, 0.0], disk, &[Shadow]),
        ("wide", at(60.0, 1.0, 0.3), None, 2.4, [0.3, 0.2, 0.1], disk, &all[..6]),
    ];
    for (name, position, momentum, field_of_view, turned, disk, expected) in views {
        let momentum = momentum.unwrap_or_else(|| hovering(position));
        ask(name, facing(position, momentum, field_of_view, turned), disk, expected);
    }
}

/// A ship on a circular orbit through `position` (r_s) at T = `time`, towards `along`.
fn circling(position: DVec3, along: DVec3, time: f64) -> History {
    let mut history = History::new(time, &ShipState::new(position, circular_momentum(position, along).unwrap()));
    history.reach_back(time - 300.0);
    history
}

/// The same, seen at `position` by light of order 1 that arrives at T = 7.
fn seen_at(camera: &Observer, position: DVec3, along: DVec3) -> History {
    let (age, _) = sight::light_path(camera, position, Order::ALL[0], Branch::Plus).unwrap();
    circling(position, along, 7.0 - age)
}

fn ball() -> [Model; 1] {
    [shapes::uv_sphere(2000, Material::default())]
}

/// Balls of these radii, in r_s: the first is the target.
fn ask_about(name: &str, camera: Observer, gas: Option<&Gas>, balls: &[(&History, f64)], expected: &[Phenomenon]) -> Vec<Pointer> {
    let models = ball();
    let mut things: Vec<Thing> = Vec::new();
    for (number, &(line, radius)) in balls.iter().enumerate() {
        let light = Illumination::default();
        things.push(Thing { model: 0, scale: 2.0 * radius, motion: BodyMotion::Flying(line), light, id: number as u32 + 1 });
    }
    let world = World::new(&models, things, 7.0, true);
    let stage = Stage { world, gas, camera: PixelCamera { observer: camera, size: SIZE }, target: Some(0) };
    let bodies: Vec<SeenBody> = balls.iter().map(|&(history, radius)| SeenBody { track: Track::Ship(history), radius }).collect();
    let scenery = Scenery { disk: gas, target: Some(bodies[0]), others: &bodies[1..] };
    let found = pointers(&camera, 7.0, &scenery, ASPECT);
    for pointer in &found {
        println!("{name}: {} {:?} {:?}", pointer.sight.key(), camera.pixel(pointer.direction, SIZE), pointer.number);
        check(&stage, pointer, true);
    }
    let sights: Vec<Phenomenon> = found.iter().map(|pointer| pointer.sight).collect();
    for sight in expected {
        assert!(sights.contains(sight), "{name}: {sight:?} is not in {sights:?}");
    }
    found
}

fn has(found: &[Pointer], sight: Phenomenon) -> bool {
    found.iter().any(|pointer| pointer.sight == sight)
}

#[test]
fn the_judge_sees_the_target_and_its_images_where_they_are_pointed_at() {
    use Phenomenon::*;
    let gas = gas(|_| ());
    let place = DVec3::new(14.0, 2.0, 4.0);
    let camera = facing(place, hovering(place), 1.5, [0.0; 3]);
    let away = place.normalize();
    let across = away.any_orthonormal_vector();
    let behind = |off: f64| (across * off.sin() - away * off.cos()) * 7.0;

    // Beside the hole, over the disk.
    let beside = seen_at(&camera, DVec3::new(-2.0, -6.0, 5.0), DVec3::X);
    let found = ask_about("beside", camera, Some(&gas), &[(&beside, 0.3)], &[TargetImage, TrueTarget, Shadow, BlueSide]);
    assert!(!has(&found, EinsteinRing));
    let found = ask_about("beside, no disk", camera, None, &[(&beside, 0.3)], &[TargetImage, TrueTarget, SecondImage]);
    assert!(!has(&found, EinsteinRing));
    let truth = found.iter().find(|pointer| pointer.sight == TrueTarget).unwrap();
    let line = beside.at(7.0).position - place;
    assert!((camera.attitude * truth.direction).distance(line.normalize()) < 1e-12);

    // Behind the hole: a closed ring, then two crescents.
    for (off, radius) in [(1e-4, 0.3), (0.03, 0.3), (0.06, 0.25)] {
        let ship = seen_at(&camera, behind(off), DVec3::Z);
        ask_about(&format!("behind {off}"), camera, None, &[(&ship, radius)], &[EinsteinRing, TargetImage]);
    }
    let ship = seen_at(&camera, behind(0.1), DVec3::Z);
    assert!(!has(&ask_about("aside", camera, None, &[(&ship, 0.3)], &[SecondImage, TargetImage]), EinsteinRing));

    // Behind the disk nothing of it is seen, but it is there.
    let under = seen_at(&camera, DVec3::new(5.0, 4.0, -1.5), DVec3::Y);
    let found = ask_about("under the disk", camera, Some(&gas), &[(&under, 0.3)], &[TrueTarget]);
    assert!(!has(&found, TargetImage));

    // A ship before the hole leaves no room for the shadow.
    let before = seen_at(&camera, place * 0.9, DVec3::Z);
    let found = ask_about("before the hole", camera, None, &[(&beside, 0.3), (&before, 0.4)], &[TargetImage]);
    assert!(!has(&found, Shadow) && !has(&found, PhotonRing));
    // One before the target hides it; the other way round it hides nothing.
    let image = sight::apparition(&camera, 7.0, &beside, Order::ALL[0]).unwrap().direction;
    let near = seen_at(&camera, place + 1.5 * camera.rain_direction(image), DVec3::Z);
    let found = ask_about("before the target", camera, None, &[(&beside, 0.3), (&near, 0.3)], &[Shadow]);
    assert!(!has(&found, TargetImage));
    ask_about("behind the target", camera, None, &[(&near, 0.1), (&beside, 0.3)], &[TargetImage, Shadow]);

    // From inside the horizon, to outside and to inside.
    let place = DVec3::new(0.6, 0.0, 0.35);
    let camera = facing(place, DVec3::ZERO, 2.6, [PI - 0.6, 0.0, 0.0]);
    let outside = circling(DVec3::new(4.0, 3.0, 3.0), DVec3::X, 7.0);
    ask_about("from inside", camera, Some(&gas), &[(&outside, 0.3)], &[TargetImage]);
    let mut falling = History::new(7.0, &ShipState::new(DVec3::new(0.9, 0.15, 0.45), DVec3::ZERO));
    falling.reach_back(-200.0);
    ask_about("inside, both", camera, None, &[(&falling, 0.05)], &[TargetImage]);
}

#[test]
fn the_judge_sees_what_is_pointed_at_in_the_chase() {
    for (time, expected) in [(0.0, vec![Phenomenon::TargetImage, Phenomenon::BlueSide]), (25.0, vec![]), (70.0, vec![])] {
        let case = Case::new(scene::load("chase").unwrap(), GameConfig::default(), time, SIZE);
        let ships: Vec<&dyn Worldline> = case.histories.iter().map(|history| history as &dyn Worldline).collect();
        let gas = Gas::new(&case.scene.disk(&case.config).unwrap(), case.config.hole.mass_solar);
        let body = |name: &str| {
            let number = case.assembly.objects.iter().position(|object| object.name == name).unwrap();
            let object = &case.assembly.objects[number];
            let reach = |vertex: &Vertex| DVec3::from(vertex.position.map(f64::from)).length();
            let radius = object.scale * case.assembly.models[object.model].vertices.iter().map(reach).fold(0.0, f64::max);
            let track = match name {
                "planet" => Track::Planet(case.scene.planet.as_ref().unwrap()),
                "hunter" => Track::Ship(&case.histories[0]),
                _ => Track::Ship(&case.histories[1]),
            };
            (number, SeenBody { track, radius })
        };
        let (number, target) = body("quarry");
        let others = [body("hunter").1, body("planet").1];
        let camera = &case.camera.observer;
        let found = pointers(camera, case.time, &Scenery { disk: Some(&gas), target: Some(target), others: &others }, ASPECT);
        let stage = Stage { world: case.world(&ships), gas: Some(&gas), camera: case.camera, target: Some(number) };
        for pointer in &found {
            let place = case.camera.observer.pixel(pointer.direction, SIZE);
            println!("chase at {time}: {} {place:?} {:?}", pointer.sight.key(), pointer.number);
            check(&stage, pointer, true);
        }
        for sight in expected {
            assert!(has(&found, sight), "{time}: {sight:?}");
        }
    }
}

/// Anything between two numbers, evenly in their logarithm.
fn between(rng: &mut StdRng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}

fn any_direction(rng: &mut StdRng) -> DVec3 {
    DVec3::from([(); 3].map(|()| rng.random_range(-1.0..1.0))).try_normalize().unwrap_or(DVec3::X)
}

/// Any camera at a radius between these, with this field of view at least.
fn any_camera(rng: &mut StdRng, radii: [f64; 2], narrowest: f64) -> Observer {
    let position = any_direction(rng) * between(rng, radii[0], radii[1]);
    let momentum = any_direction(rng) * rng.random_range(0.0..2.0f64).powi(2);
    let aside = [1.5, 1.0, PI].map(|most| rng.random_range(-most..most));
    facing(position, momentum, between(rng, narrowest, 3.1), aside)
}

fn any_gas(rng: &mut StdRng) -> Gas {
    gas(|config| {
        config.disk.inner = rng.random_range(3.0..6.0);
        config.disk.outer = config.disk.inner + between(rng, 0.3, 40.0);
        config.disk.opacity = rng.random_range(0.0..1.0);
        config.disk.turbulence = rng.random_range(0.0..1.0);
        config.disk.thickness = rng.random_range(0.0..0.3);
    })
}

#[test]
fn the_judge_sees_what_is_pointed_at_from_anywhere() {
    let mut rng = StdRng::seed_from_u64(31);
    let models = ball();
    let mut counts = [0; Phenomenon::ALL.len()];
    for number in 0..150 {
        let camera = any_camera(&mut rng, [0.4, 60.0], 0.1);
        let gas = any_gas(&mut rng);
        let gas = (number % 4 > 0).then_some(&gas);
        let place = any_direction(&mut rng) * between(&mut rng, 2.0, 20.0);
        let ship = circling(place, any_direction(&mut rng), 7.0);
        let light = Illumination::default();
        let things = vec![Thing { model: 0, scale: 0.4, motion: BodyMotion::Flying(&ship), light, id: 1 }];
        let stage = Stage {
            world: World::new(&models, things, 7.0, true),
            gas,
            camera: PixelCamera { observer: camera, size: SIZE },
            target: Some(0),
        };
        let scenery = Scenery { disk: gas, target: Some(SeenBody { track: Track::Ship(&ship), radius: 0.2 }), others: &[] };
        for pointer in pointers(&camera, 7.0, &scenery, ASPECT) {
            println!("{number}: {pointer:?}");
            check(&stage, &pointer, false);
            counts[pointer.sight as usize] += 1;
        }
    }
    println!("{counts:?}");
    for sight in Phenomenon::ALL.into_iter().filter(|&sight| sight != Phenomenon::EinsteinRing) {
        assert!(counts[sight as usize] > 5, "{sight:?}: {counts:?}");
    }
}

#[test]
fn every_pointer_is_on_the_screen() {
    let mut rng = StdRng::seed_from_u64(32);
    for number in 0..600 {
        let mut camera = any_camera(&mut rng, [1e-3, 1e4], 1e-4);
        let aspect = between(&mut rng, 0.3, 4.0);
        match number % 20 {
            // At the horizon, the photon sphere, the pole, in the plane, in the hole's middle; broken.
            0 => camera.position = camera.position.normalize(),
            1 => camera.position = camera.position.normalize() * 1.5,
            2 => camera.position = DVec3::Z * 9.0,
            3 => camera.position.z = 0.0,
            4 => camera.position *= 0.0,
            5 => camera.position.x = f64::NAN,
            6 => camera.momentum *= 1e5,
            7 => camera.field_of_view = [0.0, 7.0, f64::NAN, -1.0][number / 20 % 4],
            _ => {}
        }
        let gas = any_gas(&mut rng);
        let place = any_direction(&mut rng) * between(&mut rng, 1.6, 50.0);
        let ship = circling(place, any_direction(&mut rng), 7.0);
        let body = SeenBody { track: Track::Ship(&ship), radius: between(&mut rng, 0.01, 3.0) };
        let scenery = Scenery { disk: (number % 3 > 0).then_some(&gas), target: (number % 2 > 0).then_some(body), others: &[] };
        let found = pointers(&camera, 7.0, &scenery, aspect);
        let half = (0.5 * camera.field_of_view).tan();
        for pointer in &found {
            let seen = pointer.direction;
            assert!((seen.length() - 1.0).abs() < 1e-9 && pointer.number.is_none_or(f64::is_finite), "{number}: {pointer:?}");
            assert!(seen.z < 0.0, "{number}: {pointer:?}");
            if camera.field_of_view > 1e-5 && camera.field_of_view < 3.1 {
                assert!(seen.x.abs() < -seen.z * half && seen.y.abs() < -seen.z * half / aspect, "{number}: {pointer:?} {camera:?}");
            }
        }
        assert!(found.windows(2).all(|pair| pair[0].sight < pair[1].sight), "{number}: {found:?}");
        assert!(found.is_empty() || !matches!(number % 20, 4 | 5));
    }
}
