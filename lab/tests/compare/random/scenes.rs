//! Scenes that nobody chose: how they are drawn, made smaller and kept, and the criterion of area.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec3;
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::Sampling;
use lensrunner::scene::{Body, GameConfig, Mount, Scene};
use lensrunner::spacetime::frames::relative_velocity;
use lensrunner::spacetime::orbit::static_momentum;
use lensrunner_lab::compare::deadline::{Deadline, trace_within};
use lensrunner_lab::compare::fault::{Kind, Limits, main_fault};
use lensrunner_lab::compare::judged::{Terms, judge};
use lensrunner_lab::compare::measure::area::areas;
use lensrunner_lab::compare::random::case_file::CaseFile;
use lensrunner_lab::compare::random::collect::{COLUMNS, add};
use lensrunner_lab::compare::random::corner::Corner;
use lensrunner_lab::compare::random::draw::draw;
use lensrunner_lab::compare::random::outcome::{Outcome, Row, counts, summary};
use lensrunner_lab::compare::random::reduce::reduce;
use lensrunner_lab::compare::random::text::rounded_to;
use lensrunner_lab::compare::{ContestantFrame, Shown};

use crate::support::Folder;

/// A ball half behind the hole, and one beside it.
const TWO: &str = "
[camera]
position = [0.0, 0.0, 15.1234]
up = [0.1, 1.0, 0.0]

[[prop]]
name = \"ball\"
model = \"sphere\"
position = [4.1234, 0.0, -12.0]
size = 8.0
triangles = 400
texture = \"checker\"

[[prop]]
name = \"other\"
model = \"icosphere\"
position = [-9.0, 0.0, 2.0]
size = 1.0
triangles = 80

[disk]

[planet]
orbit_radius = 30.0
radius = 1.0
aurora = \"none\"

[sky]
stars = false
milky_way = false
";

fn file(text: &str) -> CaseFile {
    CaseFile { notes: Vec::new(), text: text.trim_start().into(), at: 2.0, size: [160, 90] }
}

fn case(text: &str) -> Case {
    Case::new(Scene::from_toml(Path::new("test.toml"), text).unwrap(), GameConfig::default(), 0.0, [80, 45])
}

#[test]
fn the_same_seed_and_number_are_the_same_scene() {
    for number in [0, 1, 7, 1000] {
        assert_eq!(draw(3, number), draw(3, number));
        assert_ne!(draw(3, number).text, draw(4, number).text);
        assert_ne!(draw(3, number).text, draw(3, number + 1).text);
    }
}

#[test]
fn drawn_scenes_load_and_cover_what_methods_fail_at() {
    let config = GameConfig::default();
    let mut seen: BTreeSet<String> = BTreeSet::new();
    let mut open = 0;
    const CASES: u64 = 400;
    for number in 0..CASES {
        let drawn = draw(11, number);
        let scene = Scene::from_toml(Path::new("drawn.toml"), &drawn.text).unwrap_or_else(|wrong| panic!("{wrong}\n{}", drawn.text));
        open += u64::from(drawn.corner == Corner::Open);
        let mut see = |what: &str, is: bool| {
            if is {
                seen.insert(what.to_owned());
            }
        };
        see(drawn.corner.word(), true);
        let (eye, momentum) = match &scene.camera.mount {
            Mount::Static(state) => {
                see("hovering", true);
                (state.position, state.momentum)
            }
            Mount::Falling(state) => {
                see("falling", true);
                see("moving outwards", state.momentum.dot(state.position) > 0.0 && state.position.length() > 1.0);
                (state.position, state.momentum)
            }
            mount => panic!("{mount:?}"),
        };
        assert!(eye.is_finite() && momentum.is_finite());
        see("inside", eye.length() < 1.0);
        see("photon sphere", (eye.length() - 1.5).abs() < 0.01);
        see("just outside", (1.0..1.1).contains(&eye.length()));
        see("far", eye.length() > 20.0);
        see("planet", scene.planet.is_some());
        see("disk", scene.disk(&config).is_some());
        see("later", drawn.at > 0.0);
        see(&format!("{}x{}", drawn.size[0], drawn.size[1]), true);
        for ship in &scene.ships {
            let hovering = static_momentum(ship.state.position).unwrap_or(DVec3::ZERO);
            let speed = relative_velocity(hovering, ship.state.momentum).length();
            assert!(speed < 0.9901, "{speed}");
            see("fast ship", speed > 0.95);
            see("thrust", !ship.programme.is_empty());
            see(ship.model.as_deref().unwrap(), true);
        }
        let assembly = scene.assemble(&config);
        for object in &assembly.objects {
            let Body::Static { position, .. } = object.body else { continue };
            let triangles = assembly.models[object.model].triangles.len();
            see("many triangles", triangles > 10_000);
            see("few triangles", triangles <= 40);
            let n = eye.normalize();
            let beside = (position - n * position.dot(n)).length();
            see("behind, beside the axis by less than its size", position.dot(n) < 0.0 && beside < object.scale);
            see("before its second image", position.dot(n) > 0.0 && position.dot(n) < eye.length() && beside < object.scale);
            see("seen from within", position.distance(eye) < 0.4 * object.scale);
            see("astride the disk", position.z.abs() < 0.4 * object.scale && position.length() < 15.0);
            assert!(position.length() - 0.5 * object.scale > 1.0);
        }
        for shape in ["icosphere", "sphere", "square"] {
            see(shape, drawn.text.contains(&format!("model = \"{shape}\"")));
        }
        if drawn.corner == Corner::Planet {
            let leaves = drawn.at - eye.length() - scene.planet.as_ref().unwrap().orbit.semi_latus_rectum;
            let away = scene.planet.as_ref().unwrap().state(leaves).unwrap().position.angle_between(-eye);
            assert!(away < 0.3, "{away} rad from the axis");
        }
        see("upright", drawn.size[1] > drawn.size[0]);
        see("wide view", scene.camera.fov > 2.4);
        see("narrow view", scene.camera.fov < 0.2);
        see("model", drawn.text.contains("name = \"model-"));
        see("flown by hands", drawn.text.contains("ai = \"hands\""));
    }
    assert!((0.4..0.6).contains(&(open as f64 / CASES as f64)), "{open} of {CASES} are open");
    let wanted = "open; axis; photon-sphere; horizon; fast; small-triangles; rings; within; planet; \
                  before its second image; seen from within; upright; 256x72; wide view; narrow view; hovering; falling; moving outwards; \
                  inside; photon sphere; just outside; far; planet; disk; later; 160x90; 320x180; fast ship; thrust; \
                  flown by hands; hunter.glb; quarry.glb; many triangles; few triangles; \
                  behind, beside the axis by less than its size; astride the disk; icosphere; sphere; square; model";
    let missing: Vec<&str> = wanted.split("; ").filter(|what| !seen.contains(*what)).collect();
    assert!(missing.is_empty(), "never drawn: {missing:?}");
}

#[test]
fn a_case_file_says_size_and_time_and_what_is_wrong_with_it() {
    let case =
        CaseFile { notes: vec!["case 3 of seed 4".into()], text: "[camera]\nposition = [9.0, 0.0, 0.0]\n".into(), at: 1.5, size: [48, 27] };
    let text = case.to_text();
    assert_eq!(CaseFile::parse(Path::new("case.toml"), &text).unwrap(), case);
    // A scene without comments is a case too.
    let plain = CaseFile::parse(Path::new("case.toml"), &case.text).unwrap();
    assert_eq!((plain.size, plain.at), ([160, 90], 0.0));
    for (wrong, said) in [("# T: soon", "case.toml:1: T: `soon`"), ("#\n# size: 0x9", "case.toml:2: `0x9` is no size")] {
        let error = CaseFile::parse(Path::new("case.toml"), wrong).unwrap_err();
        assert!(error.is_input() && error.to_string().contains(said), "{error}");
    }
    let wrong = CaseFile { text: "[camera]\nposition = [0.0, 0.0, 0.0]\n".into(), ..case };
    let error = wrong.case(Path::new("case.toml"), &GameConfig::default()).err().unwrap();
    assert!(error.is_input() && error.to_string().contains("case.toml:2: camera.position"), "{error}");
}

#[test]
fn a_failing_case_is_made_smaller_while_it_fails() {
    // It fails wherever there is a ball to the right of the hole, in a picture at least 60 pixels wide.
    let mut asked = 0;
    let (small, count) = reduce(&file(TWO), &mut |case| {
        asked += 1;
        let scene = Scene::from_toml(Path::new("small.toml"), &case.text).ok()?;
        Some(case.size[0] >= 60 && scene.props.iter().any(|prop| prop.positions[0].x > 3.5))
    });
    assert_eq!(count, asked);
    let scene = Scene::from_toml(Path::new("small.toml"), &small.text).unwrap();
    assert_eq!(scene.props.len(), 1);
    assert!(scene.planet.is_none() && scene.disk(&GameConfig::default()).is_none());
    assert_eq!((small.size, small.at), ([80, 45], 0.0));
    assert_eq!(scene.props[0].positions[0], DVec3::new(4.0, 0.0, -12.0));
    for spared in ["texture", "up", "other", "15.1234", "triangles = 400"] {
        assert!(!small.text.contains(spared), "{spared} is still in\n{}", small.text);
    }
    // The sky is as it was: stars would make the picture another one.
    assert!(!scene.sky.stars && !scene.sky.milky_way);

    // What always passes is left alone, and so is everything when there is no time.
    for answer in [Some(false), None] {
        assert_eq!(reduce(&file(TWO), &mut |_| answer).0, file(TWO));
    }
    assert_eq!([1, 2, 4].map(|digits| rounded_to(-1.23456, digits)), [-1.0, -1.2, -1.235]);
}

#[test]
fn images_that_are_too_large_or_not_there_at_all_are_found_by_their_area() {
    let case = case(TWO);
    let picture = case.trace(&Sampling { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    let names: Vec<String> = case.assembly.objects.iter().map(|object| object.name.clone()).collect();
    let limits = Limits::small(2);
    let perfect = ContestantFrame::of(&picture, &case);
    let faults = |frame: &ContestantFrame| -> Vec<String> {
        let all = areas(&picture, frame, &names, &|_, _| false);
        all.iter().filter_map(|area| area.fault(&limits)).map(|fault| fault.text).collect()
    };
    assert_eq!(faults(&perfect), Vec::<String>::new());
    // The second image of a body fills the screen, of which the judge sees it nowhere.
    let spread = |coverage: f32| {
        let mut frame = perfect.clone();
        for shown in frame.shown.iter_mut().filter(|shown| shown.object == 0) {
            *shown = Shown { object: 2, order: 2, body: [0.0; 3], coverage };
        }
        faults(&frame)
    };
    // Solid, and as a veil of hardly anything in each pixel.
    for coverage in [1.0, 0.02] {
        let found = spread(coverage);
        assert!(found.iter().any(|fault| fault.starts_with("other order 2: an area of")), "{coverage}: {found:?}");
    }
    // Half of an image is gone.
    let mut half = perfect.clone();
    for (i, shown) in half.shown.iter_mut().enumerate() {
        if i % 2 == 0 && shown.order == 1 {
            *shown = Shown::default();
        }
    }
    assert!(faults(&half).iter().any(|fault| fault.starts_with("ball order 1: an area of")), "{:?}", faults(&half));
    // Drawn with half its coverage, which no pixel shows as another one.
    let mut faint = perfect.clone();
    faint.shown.iter_mut().filter(|shown| shown.order == 1).for_each(|shown| shown.coverage = 0.5);
    assert!(faults(&faint).iter().any(|fault| fault.starts_with("ball order 1: an area of")), "{:?}", faults(&faint));
}

#[test]
fn small_pictures_allow_what_chance_does_to_a_count_and_no_more() {
    let (large, small) = (Limits::default(), Limits::small(2));
    // The plain limit is as it was.
    assert_eq!([large.differing(34860, 1000), large.differing(100, 50)], [0.002 * 35860.0, 1.0]);
    // An outline of 600 pixels that is off by a hundredth: 6 are expected. Poisson's distribution has 0.00135, a normal one's part beyond
    // three standard deviations, beyond 15 where 6 are expected, beyond 2 where 0.08 are, beyond 3 where 0.26 are: so many may differ, or
    // one less.
    for (pixels, rim, quantile) in [(544, 600, 15.0), (2, 8, 2.0), (20, 26, 3.0)] {
        let allowed = small.differing(pixels, rim).floor();
        assert!(allowed == quantile || allowed == quantile - 1.0, "{allowed} for {quantile}");
    }
    assert!(small.differing(544, 600) < 0.1 * 600.0);
}

#[test]
fn a_whole_case_is_judged_and_its_worst_fault_named() {
    let case = case(TWO);
    let perfect =
        |case: &Case| Ok(ContestantFrame::of(&case.trace(&Sampling { samples: 1, tolerance: 1e-10, packet: 8 }, false, &|_| ()), case));
    let judged = judge(&case, &Terms::default(), &perfect).unwrap();
    assert!(judged.solid && judged.faults.is_empty() && judged.rate > 0.0, "{:?}", judged.faults);
    // Light where there is none, and no picture at all.
    let lit = |case: &Case| {
        let mut frame: ContestantFrame = perfect(case)?;
        frame.bare.iter_mut().for_each(|rgb| *rgb = [0.1; 3]);
        Ok(frame)
    };
    let judged = judge(&case, &Terms::default(), &lit).unwrap();
    assert_eq!(main_fault(&judged.faults).unwrap().kind, Kind::Lit);
    let none = |_: &Case| -> Result<ContestantFrame, String> { Err("out of paint".into()) };
    let judged = judge(&case, &Terms::default(), &none).unwrap();
    assert!(judged.faults[0].kind == Kind::NoPicture && judged.faults[0].text.contains("out of paint"));
}

#[test]
fn the_judge_gives_up_and_says_why() {
    let case = case(TWO);
    let sampling = Sampling { samples: 8, tolerance: 1e-12, packet: 8 };
    let said = trace_within(&case, &sampling, &Deadline::after(0.001)).unwrap_err().to_string();
    assert!(said.contains("gave up after 0.001 s") && said.contains("of 3600 pixels were"), "{said}");
    assert!(trace_within(&case, &Sampling { samples: 1, ..sampling }, &Deadline::never()).is_ok());
}

#[test]
fn runs_are_counted_and_collected() {
    let row = |name: &str, kinds: &[Kind], rate: f64| Row {
        name: name.into(),
        corner: "axis".into(),
        size: [160, 90],
        outcome: Outcome::Judged {
            kinds: kinds.to_vec(),
            main: kinds.first().map(|kind| format!("{kind}: so it is")).unwrap_or_default(),
            solid: true,
            seconds: [1.0, 2.0, 3.0],
            rate,
        },
        seconds: 6.0,
    };
    let gave_up = Row { outcome: Outcome::GaveUp("the judge gave up".into()), ..row("d", &[], 1e4) };
    let rows = [row("a", &[], 1e4), row("b", &[Kind::Area, Kind::Lit], 1e4), row("c", &[Kind::Lit], 100.0), gave_up];
    let counted = counts(&rows);
    assert_eq!((counted.cases, counted.within, counted.failed, counted.gave_up, counted.slow), (4, 1, 2, 1, 1));
    assert_eq!(counted.by_kind.into_iter().collect::<Vec<_>>(), [(Kind::Area, 1), (Kind::Lit, 1)]);
    let text = summary(&rows);
    for part in ["area: so it is", "the judge gave up", "4 cases: 1 within", "area 1, lit 1", "in 1 cases the judge made less"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let folder = Folder::new();
    let csv = folder.path().join("runs.csv");
    (0..2).for_each(|_| add(&csv, "random", "1", &Terms::default(), &rows).unwrap());
    add(&csv, "random", "2", &Terms::default(), &rows).unwrap();
    let text = std::fs::read_to_string(&csv).unwrap();
    assert!(text.contains(&COLUMNS.join(",")) && text.lines().filter(|line| line.starts_with("random,")).count() == 2, "{text}");
    let page = std::fs::read_to_string(csv.with_extension("md")).unwrap();
    assert!(page.contains("| random | 2 | 4 | 1 | 0 | 2: area 1; lit 1 | 1 | 1 | 6.00 |"), "{page}");
}
