//! Nothing of the aurora is simulated or drawn while it is out of sight, and nothing that is in sight is left out.

use glam::{DQuat, DVec3};
use lensrunner::lensing::Slice;
use lensrunner::render::aurora::{AuroraAnimation, AuroraFrame, PlanetLine};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::instances::InstanceView;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::scene::aurora::random::hash;
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::spacetime::Observer;

use crate::render::support::renderer;

const SIZE: [u32; 2] = [160, 90];

/// Where the planet was when the light left that comes to `eye` at T = 0, but for the hole's part.
fn seen_place(scene: &Scene, eye: DVec3) -> DVec3 {
    let planet = scene.planet.unwrap();
    let place = |time: f64| planet.state(time).unwrap().position;
    (0..20).fold(place(0.0), |there, _| place(-(there - eye).length()))
}

#[test]
fn an_aurora_behind_the_camera_is_not_simulated() {
    let scene = scene::load("aurora-orbit").unwrap();
    let mut config = GameConfig::default();
    config.aurora.streaks = 1000;
    let mut renderer = renderer(SIZE);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let orbit = stage.camera(0.0, &[]);
    let mut is_seen = |camera: Observer| stage.frame(camera, SIZE, 0.0, &[], None, &settings(&config)).aurora.is_some();
    // Two thousand kilometres up: half of the sky is planet.
    assert!(is_seen(orbit), "from orbit");
    let turned = |axis: DVec3| Observer { attitude: orbit.attitude * DQuat::from_axis_angle(axis, std::f64::consts::PI), ..orbit };
    assert!(!is_seen(turned(DVec3::X)) && !is_seen(turned(DVec3::Y)), "from orbit, the look reversed");
    // And from some radii away, where light delay and the hole's pull move it by a few degrees.
    let middle = scene.planet.unwrap().state(0.0).unwrap().position;
    let directions = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let (mut toward, mut away) = (0, 0);
    for distance in [4.0, 10.0] {
        for aside in directions {
            let eye = middle + aside * distance;
            let planet = seen_place(&scene, eye) - eye;
            assert!(is_seen(static_camera(eye, planet, planet.any_orthonormal_vector(), 1.0)), "{distance} r_s, {aside}: looking at it");
            toward += 1;
            for look in directions.into_iter().chain([-planet]) {
                // Its own angular radius (0.863 r_s), the picture's half diagonal, and a tenth of a radian for delay and pull.
                let radius = (0.863 / planet.length()).asin();
                let corner = (0.5f64.tan() * (90.0 / 160.0f64).hypot(1.0)).atan();
                if look.angle_between(planet) > radius + corner + 0.1 {
                    let camera = static_camera(eye, look, look.any_orthonormal_vector(), 1.0);
                    assert!(!is_seen(camera), "{distance} r_s, {aside}: looking along {look}");
                    away += 1;
                }
            }
        }
    }
    assert!(toward == 12 && away > 50, "{toward} looks at it, {away} away");
}

/// Random numbers in [0, 1).
struct Draws(u32);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 += 1;
        f64::from(hash(self.0) >> 8) / 16_777_216.0
    }

    fn direction(&mut self) -> DVec3 {
        let (z, azimuth) = (2.0 * self.next() - 1.0, std::f64::consts::TAU * self.next());
        DVec3::new(azimuth.cos(), azimuth.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    }
}

/// Its image of a number alone.
fn only(frame: &AuroraFrame, image: usize) -> AuroraFrame {
    AuroraFrame {
        instances: vec![frame.instances[image]],
        parts: vec![frame.parts[image]],
        behind: vec![frame.behind[image]],
        colours: vec![frame.colours[image]],
        ..frame.clone()
    }
}

#[test]
fn what_leaves_strokes_is_never_left_out() {
    let mut config = GameConfig::default();
    config.aurora.streaks = 1500;
    let mut renderer = renderer(SIZE);
    let table = renderer.table().clone();
    let mut draws = Draws(0);
    // Images left out, those drawn with strokes, and those drawn without.
    let (mut left_out, mut lit, mut in_vain) = (0, 0, 0);
    for name in ["aurora-orbit", "aurora-lensed"] {
        let scene = scene::load(name).unwrap();
        let planet = scene.planet.unwrap();
        let reach = 1.08 * planet.radius;
        let mut show = AuroraAnimation::new(&planet, None, &config.aurora).unwrap();
        let all_settings = settings(&config);
        for number in 0..60 {
            let middle = planet.state(0.0).unwrap().position;
            // Near it, anywhere, or where the planet is seen behind the hole.
            let eye = match number % 3 {
                0 => middle + draws.direction() * reach * (1.02 + 8.0 * draws.next().powi(3)),
                1 => draws.direction() * (3.0 + 40.0 * draws.next()),
                _ => {
                    let behind = planet.state(-middle.length() - 14.0).unwrap().position;
                    -behind.normalize() * 14.0 + draws.direction() * 2.0 * draws.next()
                }
            };
            let fov = 0.4 + 1.3 * draws.next();
            let centre = if number % 3 == 2 { -eye } else { seen_place(&scene, eye) - eye };
            let look = if number % 2 == 0 && number % 3 < 2 {
                // A place of the oval a little within the screen's edge or beyond it, and the planet's middle farther out.
                let pole = if draws.next() < 0.5 { 1.0 } else { -1.0 };
                let (sine, cosine) = (std::f64::consts::TAU * draws.next()).sin_cos();
                let attitude = planet.state(-centre.length()).unwrap().attitude * planet.dipole();
                let place = centre + attitude * DVec3::new(0.34 * sine, 0.34 * cosine, 0.94 * pole) * planet.radius * 1.03;
                DQuat::from_axis_angle(centre.cross(place).normalize(), fov * (0.2 + 0.4 * draws.next())) * place
            } else {
                // Any angle from it, most often such that it comes to lie about the edge of the screen.
                let size = (reach / centre.length()).min(1.0).asin();
                let aside = if draws.next() < 0.7 { size + fov * (0.2 + 0.6 * draws.next()) } else { std::f64::consts::PI * draws.next() };
                DQuat::from_axis_angle(centre.cross(draws.direction()).normalize(), aside) * centre
            };
            let camera = static_camera(eye, look, look.cross(draws.direction()).normalize(), fov);
            let slice = Slice::new(&table, camera.radius());
            let pixel = 2.0 * (0.5 * fov).tan() / f64::from(SIZE[0]);
            let mut frame = |aspect| {
                let view = InstanceView { camera: &camera, slice: &slice, pixel, aspect, settings: &all_settings };
                let back = 1.5 * (camera.radius() + planet.orbit.semi_latus_rectum) + 60.0;
                show.frame(&view, 0.0, back, 3)
            };
            // Without a screen nothing is left out.
            let (all, kept) = (frame(None), frame(Some(f64::from(SIZE[1]) / f64::from(SIZE[0]))));
            let Some(all) = all else { continue };
            for (image, instance) in all.instances.iter().enumerate() {
                let alone = FrameInput {
                    camera,
                    time: 0.0,
                    placed: Vec::new(),
                    held: None,
                    aurora: Some(only(&all, image)),
                    settings: all_settings,
                };
                renderer.picture(&alone, false).unwrap();
                let strokes: u32 = renderer.aurora_strokes().unwrap().unwrap().iter().sum();
                let is_kept = kept.as_ref().is_some_and(|kept| kept.instances.iter().any(|other| other.order == instance.order));
                let order = instance.order;
                assert!(is_kept || strokes == 0, "{name} {number}: order {order} left out, of {strokes} strokes; {eye}, {look}, {fov}");
                *if !is_kept {
                    &mut left_out
                } else if strokes > 0 {
                    &mut lit
                } else {
                    &mut in_vain
                } += 1;
            }
        }
    }
    println!("{left_out} left out, {lit} with strokes, {in_vain} drawn in vain");
    assert!(left_out > 10 && lit > 20);
}

/// A worldline that goes on from frame to frame, forwards, backwards and over a gap, is that which is made for one frame.
#[test]
fn the_planet_is_where_it_is_whatever_was_drawn_before() {
    let planet = scene::load("chase").unwrap().planet.unwrap();
    let mut kept = PlanetLine::new(planet.dipole());
    let frames = (0..200).map(|k| (0.3 * f64::from(k), 80.0 + 0.4 * f64::from(k))).chain([(20.0, 80.0), (900.0, 80.0), (900.1, 500.0)]);
    for (time, back) in frames {
        let mut fresh = PlanetLine::new(planet.dipole());
        let lines = [&mut kept, &mut fresh].map(|line| line.about(&planet, time, back).unwrap());
        for k in 0..40 {
            let t = time + 0.1 - (back + 0.1) * f64::from(k) / 39.0;
            let [got, want] = [0, 1].map(|k| lines[k].at(t));
            assert_eq!(got, want, "T = {t}, seen at {time}");
            let truth = planet.state(t).unwrap();
            let turned = (truth.attitude * planet.dipole()).angle_between(got.attitude);
            assert!(truth.position.distance(got.position) < 1e-6 && turned < 1e-6, "T = {t}: {got:?} for {truth:?}, {turned}");
        }
    }
}
