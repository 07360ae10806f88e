//! The race of the projections: its points, its scores, its files, its names.

use std::process::Command;

use lensrunner::lensing::methods::{Exact, ProjectionInput, Projector, Sight};
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner_lab::chart::{Output, Sheet};
use lensrunner_lab::projection::{self, ProjectionRequest, rows, score, truth};

#[test]
fn the_points_are_adversarial() {
    let drawn = rows(300_000, 5);
    let share = |what: &dyn Fn(&ProjectionInput) -> bool| drawn.iter().filter(|row| what(&row.input)).count() as f64 / drawn.len() as f64;
    // A third, and what the log-uniform two thirds put there: ln(1.6/0.95)/ln(5000/0.05).
    let expected = 1.0 / 3.0 + 2.0 / 3.0 * (1.6f64 / 0.95).ln() / 1e5f64.ln();
    assert!((share(&|q| (0.95..1.6).contains(&q.camera)) - expected).abs() < 0.03);
    assert!(share(&|q| (q.r / q.camera - 1.0).abs() < 1e-3) > 0.08, "r clusters at L");
    assert!(share(&|q| q.phi < 1e-3) > 0.05 && share(&|q| q.phi > std::f64::consts::PI - 1e-3) > 0.05, "φ clusters at 0 and π");
    assert!(share(&|q| q.r < 1.0 && q.camera < 1.0) > 0.05, "some are inside");
    for row in &drawn {
        let ProjectionInput { r, phi, camera } = row.input;
        let distance = (r * phi.cos() - camera).hypot(r * phi.sin());
        assert!(distance > 0.99e-4 * camera && (0.05..=5000.0).contains(&camera), "{row:?}");
        assert!((1.0005..=1e4).contains(&r) || (camera < 1.0 && r < 1.0), "{row:?}");
    }
    // A graphics adapter answers the same rows, a camera at a time.
    assert!(drawn.chunks(100).all(|rows| rows.iter().all(|row| row.input.camera == rows[0].input.camera)));
    let again = rows(300_000, 5);
    assert!(drawn.iter().zip(&again).all(|(a, b)| a.input == b.input && a.branch == b.branch), "the same seed, the same points");
}

/// The exact ray, spoiled by what is known: 0.01 rad and 3 r_s/c too much, no answer beyond φ = 3, and one where there is none.
struct Spoiled;

impl Projector for Spoiled {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        if input.phi > 3.0 {
            return None;
        }
        match Exact.project(input, order, branch) {
            Some(sight) => Some(Sight { psi_rain: sight.psi_rain + 0.01, delay: sight.delay + 3.0, ..sight }),
            None => Some(Sight { psi_rain: 1.0, psi_static: None, delay: 1.0 }),
        }
    }
}

#[test]
fn a_score_finds_what_was_spoiled() {
    let drawn = rows(4000, 9);
    for order in Order::ALL {
        let truth = truth(&drawn, order);
        let found = score(&Spoiled, &drawn, &truth, order);
        let lit = |far: bool| drawn.iter().zip(&truth).filter(|(row, t)| t.is_some() && (row.input.phi > 3.0) == far).count();
        let dark = drawn.iter().zip(&truth).filter(|(row, t)| t.is_none() && row.input.phi <= 3.0).count();
        assert!(dark > 50, "some rows have no ray");
        assert_eq!((found.answered, found.missing, found.invented), (lit(false), lit(true), dark), "{order:?}");
        for value in [found.angle.max, found.angle.most, found.angle.rms] {
            assert!((value - 0.01f64.to_degrees()).abs() < 1e-9);
        }
        assert!((found.delay.max - 3.0).abs() < 1e-6);
        assert!(found.delay_share.max > 100.0 && found.delay_share.max <= 1500.0 + 1e-6);
        assert_eq!(score(&Exact, &drawn, &truth, order).angle.max, 0.0);
    }
}

#[test]
fn the_chart_is_written_and_redrawn() {
    let folder = crate::support::Folder::new();
    let output = Output { folder: folder.path().to_path_buf(), redraw: false };
    let request = ProjectionRequest { output, points: 300, seed: 3, methods: ["exact", "table", "flat"].map(str::to_owned).to_vec() };
    let written = projection::run(&request, None).unwrap();
    assert!(written.iter().all(|path| path.is_file()) && written.len() >= 6, "{written:?}");
    let sheet = Sheet::load(&folder.path().join("projection.csv")).unwrap();
    assert_eq!(sheet.rows.len(), 9, "three methods, three orders");
    for row in &sheet.rows {
        assert!(sheet.number(row, "nanoseconds") > 0.0);
        assert!(sheet.text(row, "method") != "table" || sheet.number(row, "max_degrees") < 0.004, "{row:?}");
    }
    let picture = std::fs::read(folder.path().join("projection.svg")).unwrap();
    let again = ProjectionRequest { output: Output { redraw: true, ..request.output.clone() }, ..request.clone() };
    projection::run(&again, None).unwrap();
    assert_eq!(std::fs::read(folder.path().join("projection.svg")).unwrap(), picture, "the same CSV, the same picture");
    let wrong = ProjectionRequest { methods: vec!["exakt".into()], ..request };
    let error = projection::run(&wrong, None).unwrap_err();
    assert!(error.is_input() && error.to_string().contains("exakt") && error.to_string().contains("table"));
}

#[test]
fn an_unknown_method_ends_with_code_2() {
    let run = |arguments: &[&str]| Command::new(env!("CARGO_BIN_EXE_lensrunner-lab")).args(arguments).output().expect("the program starts");
    assert_eq!(run(&["chart", "projection", "--methods", "exakt"]).status.code(), Some(2));
}
