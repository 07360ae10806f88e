//! Verdicts collected in a table.

use lensrunner::judge::case::TraceRequest;
use lensrunner::scene;
use lensrunner_lab::chart::Sheet;
use lensrunner_lab::compare::collect::{COLUMNS, LATER, add, markdown, moments, rows};
use lensrunner_lab::compare::measure::metrics::{Displacement, Group, Limits, Verdict};

fn request(at: f64) -> TraceRequest {
    TraceRequest { scene: "ring".into(), size: [640, 360], at, samples: 9, threads: 0, tolerance: 1e-12, packet: 8, limit: None }
}

fn verdict(orders: u32) -> Verdict {
    let displacement = Displacement { most: 0.25, max: 0.5, ..Displacement::default() };
    let group = |order| Group {
        name: "ball".into(),
        order,
        pixels: 900,
        rim: 100,
        mismatched: 1,
        beyond_rim: 0,
        displacement,
        thin: [0.0; 2],
        touched: 0,
        flip: 0.0,
    };
    Verdict {
        groups: (1..=orders).map(group).collect(),
        wrong_order: 0,
        wrong_beyond_rim: 0,
        holes: 0,
        lit: 0,
        flip: 0.01,
        displaced: vec![],
        areas: vec![],
        lights: vec![],
    }
}

#[test]
fn a_verdict_takes_the_place_of_the_one_before() {
    let folder = std::env::temp_dir().join(format!("lensrunner-verdicts-{}", std::process::id()));
    let csv = folder.join("verdict.csv");
    for (at, orders, faults) in [(0.0, 2, vec![]), (5.0, 1, vec![]), (0.0, 4, vec!["one, two".to_owned(), "three".to_owned()])] {
        add(&csv, &request(at), &verdict(orders), &Limits::default(), &faults).unwrap();
    }
    let (sheet, page) = (Sheet::load(&csv).unwrap(), std::fs::read_to_string(csv.with_extension("md")).unwrap());
    std::fs::write(&csv, "scene,at\n").unwrap();
    let other = add(&csv, &request(0.0), &verdict(1), &Limits::default(), &[]);
    std::fs::remove_dir_all(&folder).unwrap();
    // Of an image that is not drawn at all, the fourth, there is no row.
    let column = |name: &str| sheet.rows.iter().map(|row| sheet.text(row, name).to_owned()).collect::<Vec<_>>();
    assert_eq!(column("at"), ["0", "0", "0", "5"]);
    assert_eq!(column("order"), ["1", "2", "3", "1"]);
    assert_eq!(column("percent")[0], "0.100");
    assert_eq!(column("verdict")[1], "one; two; three");
    assert_eq!(column("command")[3], "lensrunner-lab compare --scene ring --at 5 --size 640x360 --samples 9");
    assert_eq!(page, markdown(&sheet));
    assert_eq!(page.lines().count(), 6);
    let line = "| `ring` | 5 | 640 × 360, 9 | ball 1 | 0.250, 0.500 | 1 of 900 px, 0.100 % |  | within |";
    assert!(page.contains(line), "{page}");
    // A file of something else is left as it is.
    let said = other.unwrap_err().to_string();
    assert!(said.contains("size") && said.contains("verdict.csv"), "{said}");
}

#[test]
fn a_picture_of_nothing_solid_has_a_row() {
    let rows = rows(&request(0.0), &verdict(0), &Limits::default(), &[], "abc");
    assert!(rows.len() == 1 && rows[0].len() == COLUMNS.len() && rows[0][4].is_empty());
    let sheet = Sheet { rows, ..Sheet::new(&COLUMNS) };
    assert!(
        markdown(&sheet).contains("| nothing solid |  |  |  | not judged: nothing solid is seen; colour needs 16 rays a pixel | abc |")
    );
}

#[test]
fn every_scene_is_judged() {
    let moments = moments();
    assert!(scene::names().iter().all(|name| moments.contains(&(name.clone(), 0.0))));
    assert!(moments.contains(&("plunge".to_owned(), 1.5)) && moments.contains(&("chase".to_owned(), 25.0)));
    // Each time is of a scene that there is.
    assert_eq!(moments.len(), scene::names().len() + LATER.iter().map(|(_, times)| times.len()).sum::<usize>());
}
