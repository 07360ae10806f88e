//! The chart of growth with the number of bodies.

use lensrunner_lab::bodies::growth::{Growth, sheet};
use lensrunner_lab::bodies::scenes::Kind;
use lensrunner_lab::bodies::{self, BodiesRequest};
use lensrunner_lab::chart::{Output, Sheet};

#[test]
fn every_scene_has_its_number_of_bodies_in_view() {
    let config = lensrunner::scene::GameConfig::default();
    for (kind, bodies) in [(Kind::Held, 100_000), (Kind::Held, 1), (Kind::Flying, 1_000), (Kind::Flying, 1)] {
        let scene = kind.scene(bodies).unwrap();
        let camera = scene.camera.viewpoint(0.0, &[]);
        let held = scene.props.iter().flat_map(|prop| &prop.positions).copied();
        let places: Vec<_> = held.chain(scene.ships.iter().map(|ship| ship.state.position)).collect();
        assert_eq!(places.len() as u32, bodies, "{kind}");
        let nearest = if kind == Kind::Held { 2.2 } else { 4.0 };
        // Half of the picture's height is 18°; in flat space all places are seen within that of the hole.
        assert!(places.iter().all(|place| (nearest - 1e-9..9.0 + 1e-9).contains(&place.length())), "{kind}");
        assert!(camera.radius() > 30.0 && (9.0 / camera.radius()).asin().to_degrees() < 18.0, "{kind}");
        assert_eq!(scene.assemble(&config).objects.len() as u32, bodies, "{kind}");
    }
}

#[test]
fn what_grows_is_fitted_where_it_is_largest() {
    // A fixed cost, and beyond it 2 a body.
    let points: Vec<[f64; 2]> = [1.0, 10.0, 100.0, 1e4, 1e5, 1e6].map(|number: f64| [number, 5.0 + 2.0 * number]).to_vec();
    let Growth { exponent, each } = Growth::of(&points).unwrap();
    assert!((exponent - 1.0).abs() < 1e-3 && (each - 2.0).abs() < 1e-9, "{exponent}, {each}");
    let square: Vec<[f64; 2]> = [1.0, 10.0, 100.0, 1e3].map(|number: f64| [number, number * number]).to_vec();
    assert!((Growth::of(&square).unwrap().exponent - 2.0).abs() < 1e-9);
    assert_eq!(Growth::of(&points[..1]), None);
    assert_eq!(Growth::of(&[]), None);
}

#[test]
fn times_are_told_a_body_and_order_and_memory_a_body() {
    let mut measured = Sheet::new(&["kind", "bodies", "whose", "part", "mean_ms", "median_ms", "worst_ms", "bytes"]);
    for bodies in [10, 100, 1000, 10_000] {
        measured.line(format_args!("held|{bodies}|processor|together|0|{}|0|", 1.0 + 0.003 * f64::from(bodies)));
        measured.line(format_args!("held|{bodies}|memory|all||||{}", 1_000_000 + 400 * bodies));
    }
    measured.notes.push(("image orders".into(), "2".into()));
    let growth = sheet(&measured);
    let texts =
        |row: &[String]| ["microseconds_a_body", "microseconds_a_body_and_order", "bytes_a_body"].map(|c| growth.text(row, c).to_owned());
    assert_eq!(growth.rows.iter().map(|row| texts(row)).collect::<Vec<_>>(), [["3.0000", "1.5000", ""], ["", "", "400.0"]]);
}

#[test]
fn the_chart_is_written_and_redrawn() {
    let folder = crate::support::Folder::new();
    let output = Output { folder: folder.path().to_path_buf(), redraw: false };
    let request = BodiesRequest { output, held: vec![40, 10, 20], flying: vec![1, 2], size: [64, 36], frames: 1, bound: 600 };
    let files = bodies::run(&request).unwrap();
    assert!(files.len() == 4 && files.iter().all(|file| file.is_file()), "{files:?}");
    let sheet = Sheet::load(&files[0]).unwrap();
    let of = |bodies: &str, whose: &str| sheet.of([("bodies", bodies), ("whose", whose)]).count();
    for bodies in ["10", "20", "40", "1", "2"] {
        assert!(of(bodies, "processor") > 4 && of(bodies, "pass") > 8 && of(bodies, "missing") == 0, "{bodies}: {sheet:?}");
        let [whole, passes] = [("whole", "frame"), ("pass", "together")].map(|(whose, part)| {
            let row = sheet.of([("bodies", bodies), ("whose", whose), ("part", part)]).next().expect("a row");
            sheet.number(row, "median_ms")
        });
        assert!(whole > 0.0 && passes > 0.0);
    }
    let growth = Sheet::load(&files[1]).unwrap();
    assert_eq!(growth.of([("whose", "processor"), ("part", "together")]).count(), 2);
    let picture = std::fs::read(&files[2]).unwrap();
    bodies::run(&BodiesRequest { output: Output { redraw: true, ..request.output.clone() }, ..request.clone() }).unwrap();
    assert_eq!(std::fs::read(&files[2]).unwrap(), picture);
    // A bound that the first number breaks leaves out all greater ones, with a word.
    let request = BodiesRequest { held: vec![10, 20, 30], flying: Vec::new(), bound: 0, ..request };
    let sheet = Sheet::load(&bodies::run(&request).unwrap()[0]).unwrap();
    let words: Vec<&str> = sheet.of([("whose", "missing")]).map(|row| sheet.text(row, "part")).collect();
    assert!(words.len() == 2 && words.iter().all(|word| word.starts_with("left out: 10 took")), "{words:?}");
}
