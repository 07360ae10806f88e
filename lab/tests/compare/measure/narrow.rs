//! Images narrower than a pixel: the judge looks with more rays where they lie.

use std::path::Path;

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::{Sampling, TracedPicture};
use lensrunner::scene::{GameConfig, Scene};
use lensrunner_lab::compare::command::difference;
use lensrunner_lab::compare::measure::metrics::{Limits, compare};
use lensrunner_lab::compare::measure::narrow;
use lensrunner_lab::compare::{ContestantFrame, Shown};

/// The number of the ball below.
const BALL: u32 = 197;
/// Two hundred balls of a third of a pixel, and one of twenty pixels.
const DUST: &str = "
[camera]
position = [0.0, 0.0, 60.0]
[[prop]]
name = \"dust\"
model = \"lattice\"
count = [14, 14, 1]
spacing = 2.0
size = 0.25
triangles = 20
[[prop]]
name = \"ball\"
model = \"sphere\"
position = [0.0, 0.0, 30.0]
size = 5.0
triangles = 400
";

fn trace(case: &Case, samples: u32) -> TracedPicture {
    case.trace(&Sampling { samples, tolerance: 1e-9, packet: 8 }, false, &|_| ())
}

/// What a renderer hands in that draws the dust by coverage, times `factor`.
fn drawn(case: &Case, exact: &TracedPicture, factor: f32) -> ContestantFrame {
    let mut frame = ContestantFrame::of(exact, case);
    for (shown, shares) in frame.shown.iter_mut().zip(&exact.shares).filter(|(_, shares)| shares.iter().all(|share| share.0 < BALL)) {
        let covered = shares.iter().map(|share| share.2).sum::<f32>() * factor;
        *shown = match shares.first() {
            Some(&(object, order, _)) if covered > 0.0 => Shown { object, order, body: [0.0; 3], coverage: covered.min(0.99) },
            _ => Shown::default(),
        };
    }
    frame
}

#[test]
fn a_ray_a_pixel_is_enough_but_where_images_are_narrow() {
    let case = Case::new(Scene::from_toml(Path::new("test.toml"), DUST).unwrap(), GameConfig::default(), 0.0, [160, 90]);
    let exact = trace(&case, 5);
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    // Objects count from 1: two hundred less four of dust, then the ball.
    assert_eq!(names.iter().position(|name| name == "ball"), Some(BALL as usize - 1));
    let faults = |again: bool, factor: f32| {
        let mut judge = trace(&case, 1);
        let frame = drawn(&case, &exact, factor);
        let probe = lensrunner_lab::compare::measure::probe::probe(&case, 1e-9);
        if again {
            narrow::see_again(&mut judge, &frame, &probe);
        }
        let verdict = compare(&judge, &frame, &probe, &names, &difference(&judge, &frame));
        verdict.faults(&Limits { orders: 1, ..Limits::default() })
    };
    assert_eq!(faults(true, 1.0), Vec::<String>::new());
    assert!(!faults(false, 1.0).is_empty(), "a single ray would do");
    for factor in [0.0, 2.0] {
        let found = faults(true, factor);
        assert!(found.iter().any(|fault| fault.contains("thin images cover")), "{factor}: {found:?}");
    }
}
