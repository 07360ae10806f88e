//! The judge before ships that move outwards: work counted, not timed; and what it says where it gives up.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use glam::{DQuat, DVec3};
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{BodyMotion, Pose, Sampling, Seen, Sway, World, Worldline};
use lensrunner::scene::{GameConfig, Scene};

use crate::judge::{model, thing};

/// A worldline that counts how often it is asked anything.
struct Counted<'a> {
    line: &'a dyn Worldline,
    asked: AtomicU64,
}

impl Worldline for Counted<'_> {
    fn at(&self, time: f64) -> Pose {
        self.asked.fetch_add(1, Relaxed);
        self.line.at(time)
    }

    fn sway(&self, from: f64, to: f64) -> Option<Sway> {
        self.asked.fetch_add(1, Relaxed);
        self.line.sway(from, to)
    }
}

/// A camera with these keys, and a ship that moves freely.
fn case(camera: &str, position: [f64; 3], momentum: [f64; 3], size: [u32; 2]) -> Case {
    let text = format!(
        "[camera]\n{camera}\n[[ship]]\nname = \"hunter\"\nmodel = \"hunter.glb\"\nai = \"none\"\nposition = {position:?}\nmomentum = {momentum:?}\n"
    );
    Case::new(Scene::from_toml("outwards.toml".as_ref(), &text).unwrap(), GameConfig::default(), 0.0, size)
}

const BEHIND: &str = "position = [6.0, 0.0146, 0.0153]";
const BESIDE: &str = "position = [-0.850279, -0.599375, -0.369218]\nfov = 30.0";

#[test]
fn what_moves_outwards_is_asked_a_few_times_a_ray() {
    const SIZE: [usize; 2] = [32, 18];
    // Light in the shadow hugs r = 1 with a frequency that grows without end. The ships outside hovered there before they started; the last
    // one, inside, hugs r = 1 as light does.
    let at_rest = 6f64.powf(-0.5) / (5f64 / 6.0).sqrt();
    let cases = [
        (BEHIND, [-6.0, 0.0, 0.0], [-at_rest, 0.0, 0.0]),
        (BEHIND, [-6.0, 0.0, 0.0], [-3.0, 0.0, 0.0]),
        (BEHIND, [-1.3, 0.0, 0.0], [-3.0, 0.0, 0.0]),
        (BEHIND, [-20.0, 0.0, 0.0], [-7.0, 1.0, 0.0]),
        // From inside, of negative energy.
        (BESIDE, [-0.337928, -0.133675, -0.199831], [-1.506309, 0.064824, -1.116405]),
    ];
    for (camera, position, momentum) in cases {
        let case = case(camera, position, momentum, SIZE.map(|side| side as u32));
        let line = Counted { line: &case.histories[0], asked: AtomicU64::new(0) };
        let world = case.world(&[&line]);
        assert!(line.asked.load(Relaxed) < 20_000, "the world: {}", line.asked.load(Relaxed));
        line.asked.store(0, Relaxed);
        let (order, starts) = lensrunner::judge::bvh::order::squares(SIZE, 8);
        let look = |i: u32| case.camera.look(f64::from(i % 32) + 0.5, f64::from(i / 32) + 0.5).0;
        for tile in starts.windows(2).map(|ends| &order[ends[0]..ends[1]]) {
            let looks: Vec<DVec3> = tile.iter().map(|&i| look(i)).collect();
            world.look_together(case.camera.observer.position, &looks, 1e-12, &mut |_, _| ());
        }
        let asked = line.asked.load(Relaxed) / (SIZE[0] * SIZE[1]) as u64;
        assert!(asked < 2_000, "{position:?} {momentum:?}: asked {asked} times a ray");
        assert_eq!(world.given_up(), 0);
    }
}

#[test]
fn a_limit_of_time_is_kept_and_said() {
    let case = case(BEHIND, [-6.0, 0.0, 0.0], [0.2, 0.0, 0.0], [64, 36]);
    let sampling = Sampling { samples: 1, tolerance: 1e-9, packet: 8 };
    let late = case.trace_within(&sampling, false, Some(1e-9), &|_| ()).unwrap_err();
    assert_eq!((late.limit, late.pixels, late.all), (1e-9, 0, 64 * 36));
    assert!(late.to_string().contains("0 of 2304 pixels"), "{late}");
    // With time enough, and without a limit, it is the same picture.
    let whole = case.trace(&sampling, false, &|_| ());
    let within = case.trace_within(&sampling, false, Some(1e6), &|_| ()).unwrap();
    assert_eq!((whole.missing, whole.given_up, whole.given_up_in_words()), (0, 0, None));
    assert_eq!(whole.layers, within.layers);
    assert_eq!(whole.light, within.light);
}

/// It stands still and knows nothing of it: it may turn by any angle in no time.
struct Restless;

impl Worldline for Restless {
    fn at(&self, _time: f64) -> Pose {
        Pose { position: DVec3::X * 10.0, momentum: DVec3::ZERO, attitude: DQuat::IDENTITY }
    }

    fn sway(&self, _from: f64, _to: f64) -> Option<Sway> {
        Some(Sway { velocity: 0.0, turning: 1e12, ..Sway::default() })
    }
}

#[test]
fn rays_that_are_given_up_are_counted() {
    // A triangle that no ray here meets, far from the middle of the ball that its body may fill.
    let corners = [[0.0, 1.0, 0.0], [0.0, 0.9, 0.1], [0.1, 0.9, 0.0]];
    let models = [model(&corners.map(DVec3::from_array), &[[0, 1, 2]])];
    let look = |bodies: usize| {
        let world = World::new(&models, vec![thing(0, BodyMotion::Flying(&Restless)); bodies], 0.0, true);
        let seen = world.look(DVec3::X * 20.0, DVec3::new(-1.0, 0.001, 0.0), 1e-12);
        assert!(!matches!(seen, Seen::Hit(_)));
        let alone = world.given_up();
        world.look_together(DVec3::X * 20.0, &[DVec3::new(-1.0, 0.001, 0.0); 4], 1e-12, &mut |_, _| ());
        [alone, world.given_up() - alone]
    };
    assert_eq!(look(1), [0, 0]);
    assert_eq!(look(300), [1, 4]);
}
