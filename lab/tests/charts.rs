//! The toolkit of the charts: pictures, sheets, timing, provenance.

use std::path::Path;

use lensrunner_lab::chart::{Output, Provenance, Sheet, SheetError, Timing, interleaved, provenance, thread_time, times_the_first};
use lensrunner_lab::disk::flight;
use lensrunner_lab::disk::script::{CROSSING, script};
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
            Line { name: "dashed".into(), points: vec![[0.0, 3.0], [3.0, 0.0]], dashed: true, ..Line::default() },
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
        guides_x: vec![Guide { at: 10.0, label: "r = L".into() }],
        guides: vec![Guide { at: 0.008, label: "½ px".into() }],
    };
    Figure {
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
    for word in ["All there is", "Another.", "exact φ ψ ≤ × °", "broken", "half a pixel", "dashed", "theirs", "lensrunner-lab chart"]
    {
        assert!(text.contains(word), "the SVG lacks {word}");
    }
    let picture = image::open(png).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1000, 800));
    let inked = picture.pixels().filter(|p| p.0 != [255; 3]).count();
    assert!(inked > 20_000, "only {inked} pixels are drawn");
    // The failure is red, in the scatter and in the map.
    assert!(picture.pixels().filter(|p| p.0 == [200, 0, 0]).count() > 100);
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
fn a_sheet_comes_back_from_its_csv() {
    let folder = crate::support::Folder::new();
    let mut sheet = Sheet::new(&["name", "error, degrees"]);
    sheet.columns[1] = "error".into();
    sheet.notes.push(("date".into(), "2026-11-21".into()));
    sheet.push(["table", "0.004"]);
    let output = Output { folder: folder.path().join("deep/er"), redraw: false };
    let written = output.sheet::<SheetError>("s", || Ok(sheet.clone())).unwrap();
    assert_eq!(written, sheet);
    let again = Output { redraw: true, ..output.clone() };
    let read = again.sheet::<SheetError>("s", || panic!("a redrawing measures nothing")).unwrap();
    assert_eq!(read, sheet);
    assert_eq!(read.number(&read.rows[0], "error"), 0.004);
    assert!(read.number(&read.rows[0], "none").is_nan());
    assert!(matches!(again.sheet::<SheetError>("other", || panic!()), Err(SheetError::Io(..))));
    assert!(matches!(Sheet::from_csv(Path::new("x"), "a,b\n1\n"), Err(SheetError::Row(_, 2, 1, 2))));
    assert!(matches!(Sheet::from_csv(Path::new("x"), "# a: b\n"), Err(SheetError::Header(_))));
}

#[test]
fn contestants_take_turns() {
    let order = std::cell::RefCell::new(Vec::new());
    let times = interleaved(&mut [&mut || order.borrow_mut().push(0), &mut || order.borrow_mut().push(1)], 3);
    assert_eq!(*order.borrow(), [0, 1, 0, 1, 0, 1, 0, 1]);
    assert_eq!(times.len(), 2);
    assert_eq!(Timing::of(vec![3.0, 1.0, 2.0]), Timing { median: 2.0, least: 1.0, most: 3.0 });
}

/// The first round does not count, the next goes backwards.
#[test]
fn neighbours_are_compared() {
    thread_local! {
        static NOW: std::cell::Cell<f64> = const { std::cell::Cell::new(0.0) };
    }
    let order = std::cell::RefCell::new(Vec::new());
    let run = |name: usize, seconds: f64| {
        let cold = if order.borrow().len() < 2 { [1.0, 10.0][name] } else { 1.0 };
        order.borrow_mut().push(name);
        NOW.set(NOW.get() + cold * seconds);
    };
    let ratios = times_the_first(|| NOW.get(), &mut [&mut || run(0, 2.0), &mut || run(1, 3.0)], 1);
    assert_eq!(*order.borrow(), [0, 1, 1, 0]);
    assert_eq!(ratios, [1.0, 1.5]);
}

#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
#[test]
fn the_processor_s_clock_stands_still_while_a_thread_sleeps() {
    let start = thread_time();
    std::thread::sleep(std::time::Duration::from_millis(200));
    let slept = thread_time() - start;
    // Falling asleep and waking take microseconds.
    assert!((0.0..0.1).contains(&slept), "{slept}");
    let mut sum = 0u64;
    for i in 0..20_000_000u64 {
        sum = std::hint::black_box(sum.wrapping_add(i));
    }
    assert!(thread_time() - start > slept, "{sum}");
}

#[test]
fn provenance_says_where_numbers_come_from() {
    assert_eq!(provenance::civil(0), [1970, 1, 1]);
    assert_eq!(provenance::civil(11_016), [2000, 2, 29]);
    assert_eq!(provenance::civil(20_778), [2026, 11, 21]);
    let now = Provenance::now("llvmpipe");
    let footer = Provenance::footer(&now.notes());
    assert_eq!(footer.len(), 2);
    assert!(footer[0].contains("adapter: llvmpipe") && footer[0].contains(&now.date), "{footer:?}");
    assert!(footer[1].starts_with("lensrunner"));
}

/// The scripted chase is one flight, and passes through every situation however few places of it are looked at.
#[test]
fn the_scripted_chase_passes_through_every_situation() {
    for steps in [8, 12, 16, 25, 100] {
        let stops: Vec<_> = (0..steps).map(|step| script((f64::from(step) + 0.5) / f64::from(steps), 3.0)).collect();
        for name in ["from far", "inside the inner edge", "skimming", "crossing", "below"] {
            assert!(stops.iter().any(|stop| stop.2 == name), "{steps} places and none {name}");
        }
        for (eye, _, name) in &stops {
            let (r, z) = (eye.position.length(), eye.position.z);
            assert_eq!(*name == "inside the inner edge", r < 3.0, "{name} at r = {r}");
            assert_eq!(*name == "crossing", r > 3.0 && z.abs() <= CROSSING, "{name} at z = {z}");
        }
    }
    let mut last: Option<(glam::DVec3, glam::DQuat, f64)> = None;
    let mut nearest = f64::INFINITY;
    for step in 0..=4000 {
        let (eye, time, _) = script(f64::from(step) / 4000.0, 3.0);
        nearest = nearest.min(eye.position.length());
        if let Some((position, attitude, before)) = last {
            assert!(time > before && eye.position.distance(position) < 0.03, "a jump at {step}: {position} to {}", eye.position);
            assert!(eye.attitude.angle_between(attitude) < 0.02, "the look jumps at {step}");
        }
        last = Some((eye.position, eye.attitude, time));
    }
    assert!(nearest < 2.0, "never nearer than {nearest}");
}

/// Of 1,000 frames 1 to 1,000 ms long, 999 are no longer than 999 ms.
#[test]
fn the_flight_is_summed_up() {
    let mut sheet = Sheet::new(&["frame", "situation", "passes_ms", "disk_ms", "before_submission_ms", "disk_fragments"]);
    for k in 0..1000u32 {
        // In no order of length.
        let time = f64::from(k * 7 % 1000) + 1.0;
        sheet.push([k.to_string(), "from far".into(), time.to_string(), (0.5 * time).to_string(), "3".into(), (1_000_000 + k).to_string()]);
    }
    let summary = flight::summary(&sheet);
    let of = |row: usize| ["mean", "p99", "p99_9", "worst"].map(|column| summary.number(&summary.rows[row], column));
    assert_eq!(of(0), [500.5, 990.0, 999.0, 1000.0]);
    assert_eq!(of(1), [250.25, 495.0, 499.5, 500.0]);
    assert_eq!(of(2), [3.0; 4]);
    assert_eq!(of(3), [1_000_499.5, 1_000_989.0, 1_000_998.0, 1_000_999.0]);
}
