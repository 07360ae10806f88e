//! Figures: all panels together, empty and wild ones, the Pareto line, ticks.

use lensrunner_lab::plot::{Axis, Bars, Figure, Guide, Line, Lines, Map, Panel, Point, Scatter, Series, pareto, tick_text};

fn everything() -> Figure {
    let point = |x: f64, y: f64, label: &str, failed: bool| Point {
        x,
        y,
        label: label.into(),
        family: usize::from(x > 1.0),
        failed,
        chosen: false,
    };
    let scatter = Scatter {
        title: "Error against time".into(),
        x: Axis::log("ns a lookup"),
        y: Axis::log("degrees"),
        points: vec![
            point(0.1, 3.0, "flat space", false),
            point(0.11, 2.9, "flat space, again", false),
            point(10.0, 1e-5, "exact φ ψ ≤ × °", false),
            point(20.0, 1e-2, "slow", false),
            point(5.0, f64::NAN, "broken", true),
        ],
        families: vec!["fast".into(), "slow".into()],
        pareto: true,
        guides: vec![Guide { at: 0.008, label: "half a pixel".into() }],
        guides_x: vec![],
        good_below: Some(0.008),
    };
    let lines = Lines {
        title: "Curves".into(),
        x: Axis::linear("r"),
        y: Axis::linear("ψ"),
        lines: vec![
            Line {
                name: "full".into(),
                points: vec![[0.0, 0.0], [1.0, 2.0], [f64::NAN, 0.0], [2.0, 1.0], [3.0, 3.0]],
                dots: true,
                ..Line::default()
            },
            Line { name: "straight".into(), points: vec![[0.0, 3.0], [3.0, 0.0]], ..Line::default() },
        ],
        ..Lines::default()
    };
    let bars = Bars {
        title: "Bars".into(),
        y: Axis::linear("ms"),
        groups: vec!["disk\nfar".into(), "ship".into()],
        series: vec![
            Series { name: "ours".into(), values: vec![Some(1.0), Some(2.0)] },
            Series { name: "theirs".into(), values: vec![Some(4.0), None] },
        ],
        values: true,
        ..Bars::default()
    };
    let map = Map {
        title: "Map".into(),
        x: Axis::log("r").between(1.0, 100.0),
        y: Axis::linear("φ").between(0.0, 3.0),
        size: [3, 2],
        values: vec![1e-4, 1e-3, 1e-2, f64::NAN, f64::NEG_INFINITY, 1.0],
        colors: Axis::log("degrees").between(1e-4, 1.0),
        legend: true,
        marks: vec![10.0],
        guides: vec![Guide { at: 0.008, label: "½ px".into() }],
    };
    Figure {
        verdict: "Everything is drawn".into(),
        title: "All there is".into(),
        subtitle: "One line.\nAnother.".into(),
        panels: vec![Panel::Scatter(scatter), Panel::Lines(lines), Panel::Bars(bars), Panel::Map(map)],
        columns: 2,
        size: [1000, 800],
        footer: vec!["processor: one".into(), "lensrunner-lab chart".into()],
    }
}

#[test]
fn one_figure_becomes_svg_and_png() {
    let folder = crate::support::Folder::new();
    let [svg, png] = everything().save(folder.path(), "all").unwrap();
    let text = std::fs::read_to_string(svg).unwrap();
    for word in [
        "Everything is drawn", "All there is", "Another.", "exact φ ψ ≤ × °", "broken", "half a pixel", "straight", "theirs",
        "lensrunner-lab chart",
    ] {
        assert!(text.contains(word), "the SVG lacks {word}");
    }
    let picture = image::open(png).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1000, 800));
    let inked = picture.pixels().filter(|p| p.0 != [255; 3]).count();
    // Measured 183,923.
    assert!(inked > 90_000, "only {inked} pixels are drawn");
    // The failure is red, in the scatter and in the map: measured 13,913.
    assert!(picture.pixels().filter(|p| p.0 == [200, 0, 0]).count() > 7_000);
}

#[test]
fn an_empty_figure_and_wild_values_are_drawn_too() {
    let folder = crate::support::Folder::new();
    let mut wild = everything();
    if let Panel::Scatter(scatter) = &mut wild.panels[0] {
        for value in [0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, 1e300, 1e-300] {
            scatter.points.push(Point { x: value, y: value, label: "wild".into(), family: 9, failed: false, chosen: false });
        }
    }
    wild.save(folder.path(), "wild").unwrap();
    Figure {
        size: [200, 100],
        panels: vec![
            Panel::Scatter(Scatter::default()),
            Panel::Lines(Lines::default()),
            Panel::Bars(Bars::default()),
            Panel::Map(Map::default()),
        ],
        ..Figure::default()
    }
    .save(folder.path(), "empty")
    .unwrap();
}

#[test]
fn the_pareto_line_holds_what_nothing_beats() {
    let points = [[1.0, 5.0], [2.0, 5.0], [2.0, 3.0], [3.0, 4.0], [f64::NAN, 0.0], [4.0, 1.0], [4.0, 1.0]];
    assert_eq!(pareto(&points), [0, 2, 5]);
    assert!(pareto(&[]).is_empty());
}

#[test]
fn ticks_are_short() {
    let texts = [0.0, 0.001, 20.0, 1e-6, 2.5e7, 100_000.0, 0.25].map(tick_text);
    assert_eq!(texts, ["0", "0.001", "20", "1e-6", "2.5e7", "100000", "0.25"]);
}

#[test]
fn what_is_hard_to_read_is_told() {
    assert_eq!(everything().faults(), Vec::<String>::new());
    let silent = Figure { verdict: String::new(), ..everything() };
    assert_eq!(silent.faults(), ["there is no verdict"]);
    let mut crowded = everything();
    if let Panel::Lines(lines) = &mut crowded.panels[1] {
        lines.lines = (0..7).map(|k| Line { name: format!("line {k}"), ..Line::default() }).collect();
    }
    assert!(crowded.faults().iter().any(|fault| fault.contains("7 series")), "{:?}", crowded.faults());
    // Names of groups that are longer than their bars are wide.
    let mut covered = everything();
    if let Panel::Bars(bars) = &mut covered.panels[2] {
        bars.groups = vec!["a name that is far too long for the place under a bar".to_owned(); 2];
    }
    assert!(covered.faults().iter().any(|fault| fault.contains("lies on")), "{:?}", covered.faults());
    let long = Figure { footer: vec!["word ".repeat(80)], ..everything() };
    assert!(long.faults().iter().any(|fault| fault.contains("leaves the page")), "{:?}", long.faults());
}
