//! The light of images: a ring thinner than a pixel, and a ball wide enough for pixels' centres.

use std::path::Path;

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{Sampling, TracedPicture};
use lensrunner::scene::{GameConfig, Scene};
use lensrunner_lab::compare::deadline::Deadline;
use lensrunner_lab::compare::fault::{Kind, Limits};
use lensrunner_lab::compare::measure::light::{Light, TOGETHER, lights};
use lensrunner_lab::compare::measure::probe::probe;
use lensrunner_lab::compare::{ContestantFrame, Shown};

/// A ball behind the hole, whose two images are a ring a third of a pixel wide.
const RING: &str = "
[camera]
position = [0.0, 0.0, 25.0]
[[prop]]
name = \"ball\"
model = \"sphere\"
position = [0.02, 0.0, -13.0]
size = 0.2
triangles = 400
";
/// One before it, ten pixels wide.
const BALL: &str = "
[camera]
position = [0.0, 0.0, 25.0]
[[prop]]
name = \"ball\"
model = \"sphere\"
position = [3.0, 0.0, 5.0]
size = 2.0
triangles = 400
";

fn case(text: &str) -> Case {
    Case::new(Scene::from_toml(Path::new("test.toml"), text).unwrap(), GameConfig::default(), 0.0, [160, 90])
}

fn trace(case: &Case, samples: u32) -> TracedPicture {
    case.trace(&Sampling { samples, tolerance: 1e-8, packet: 8 }, false, &|_| ())
}

/// What a renderer hands in that draws by coverage what nowhere fills a pixel.
fn by_coverage(case: &Case, exact: &TracedPicture) -> ContestantFrame {
    let mut frame = ContestantFrame::of(exact, case);
    for (i, shares) in exact.shares.iter().enumerate() {
        let covered: f32 = shares.iter().map(|share| share.2).sum();
        frame.shown[i] = shares.first().map_or(Shown::default(), |&(object, order, _)| Shown {
            object,
            order,
            body: [0.0; 3],
            coverage: covered.min(0.999),
        });
        frame.surfaces[i] = exact.light[i];
    }
    frame
}

fn judged(case: &Case, frame: &ContestantFrame) -> Vec<Light> {
    lights(&trace(case, 1), frame, &probe(case, 1e-8), &["ball".to_owned()], &Limits::default(), 2, &Deadline::never())
}

/// Without those of all orders together.
fn of_orders(lights: &[Light]) -> impl Iterator<Item = &Light> {
    lights.iter().filter(|light| light.image.1 != TOGETHER)
}

fn faulty(lights: &[Light]) -> Vec<u32> {
    lights
        .iter()
        .filter(|light| light.fault(&Limits::default()).is_some_and(|fault| fault.kind == Kind::Light))
        .map(|light| light.image.1)
        .collect()
}

#[test]
fn a_ring_that_is_too_bright_is_told_by_its_light_alone() {
    let case = case(RING);
    let right = by_coverage(&case, &trace(&case, 8));
    let found = judged(&case, &right);
    let orders: Vec<u32> = found.iter().filter(|light| light.judge.x > 1.0).map(|light| light.image.1).collect();
    assert_eq!(orders, [1, 2, TOGETHER], "{found:?}");
    assert_eq!(faulty(&found), Vec::<u32>::new(), "{found:?}");
    for factor in [2.0, 1.15, 0.85] {
        let mut wrong = right.clone();
        wrong.surfaces.iter_mut().for_each(|rgb| *rgb = rgb.map(|c| factor * c));
        assert!(faulty(&judged(&case, &wrong)).contains(&TOGETHER), "{factor} times as bright");
    }
}

#[test]
fn the_noise_is_as_large_as_it_is_said_to_be() {
    let case = case(RING);
    let exact = by_coverage(&case, &trace(&case, 16));
    let sum: f64 = exact.surfaces.iter().map(|rgb| f64::from(rgb[1])).sum();
    let rounds = |rounds: u32| {
        let judge = trace(&case, 1);
        let found = lights(&judge, &exact, &probe(&case, 1e-8), &["ball".to_owned()], &Limits::default(), rounds, &Deadline::after(0.0));
        of_orders(&found).fold([0.0; 2], |[light, variance], one| [light + one.judge.y, variance + one.noise.y * one.noise.y])
    };
    // The deadline is over at once: nothing is looked at, and nothing is claimed.
    assert_eq!(rounds(4)[0], trace(&case, 1).layers.iter().map(|layer| f64::from(layer.light[1])).sum::<f64>());
    let found = judged(&case, &exact);
    let [light, variance] =
        of_orders(&found).fold([0.0; 2], |[light, variance], one| [light + one.judge.y, variance + one.noise.y * one.noise.y]);
    println!("{light} ± {}, of {sum}", variance.sqrt());
    assert!(variance > 0.0 && (light - sum).abs() < 4.0 * variance.sqrt() && variance.sqrt() < 0.1 * sum);
}

#[test]
fn a_wide_image_is_judged_by_pixels_centres() {
    let case = case(BALL);
    let right = ContestantFrame::of(&trace(&case, 1), &case);
    let found = judged(&case, &right);
    assert!(found[0].judge.x > 20.0 && (found[0].shown.x - found[0].judge.x).abs() < 1e-6 * found[0].judge.x, "{found:?}");
    for factor in [0.85, 0.9, 1.1, 1.15] {
        let mut wrong = right.clone();
        wrong.surfaces.iter_mut().for_each(|rgb| rgb[2] *= factor);
        assert_eq!(faulty(&judged(&case, &wrong)), [1, 2], "{factor}");
    }
}
