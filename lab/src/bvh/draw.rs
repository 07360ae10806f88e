//! The picture: the figures of Sei 2008 again, and who is faster.

use super::rays::{SCENES, SIZES};
use crate::chart::{Provenance, Sheet, range};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, Series};

/// Panels: figures 3.17 and 4.8, 4.9 to 4.14 (with 4.16 and 4.17 in castle and balls4A), then the comparisons.
pub fn draw(sheet: &Sheet) -> Figure {
    let scenes: Vec<&str> = SCENES.into_iter().filter(|name| sheet.of([("scene", name)]).next().is_some()).collect();
    let mut panels: Vec<Panel> = scenes.iter().map(|scene| one_scene(sheet, scene)).collect();
    panels.push(one_method(sheet, &scenes, "Wald", "Packets of fixed size (figure 3.17)"));
    panels.push(one_method(sheet, &scenes, "split 4", "Split in 4 (figure 4.8)"));
    panels.push(one_method(sheet, &scenes, "ours", "Ours: packet and tree descended together"));
    let singles: Vec<_> = ["bvh", "Embree", "tree of two", "tree of eight"].map(|m| (m, "primary", 1)).to_vec();
    panels.extend(against_obvhs(sheet, &scenes, "Single rays, in obvhs' speed", &singles));
    let packets: Vec<_> = std::iter::once((EMBREE, "primary", 0)).chain([8, 64].map(|size| ("ours", "primary", size))).collect();
    panels.extend(against_obvhs(sheet, &scenes, "Packets, in the speed of obvhs' single rays", &packets));
    let kinds = [("Embree", "scattered", 1), ("tree of eight", "scattered", 1), ("ours", "shadow", 32), ("ours", "mirrored", 32)];
    panels.extend(against_obvhs(sheet, &scenes, "Secondary rays, in obvhs' speed", &kinds));
    Figure {
        verdict: verdict(sheet, &scenes),
        title: "Straight rays: the packets of Sei 2008, hull packets, Embree and obvhs".into(),
        subtitle: "One thread, 1024 × 768 rays, closest hit, all in one process, processor time, medians of interleaved runs; ray set-up and planes are in the time.\n\
                   Bars to beat: obvhs single rays (1); 20 / 45 / 45 Mrays/s for balls4A / tree10 / bunny where obvhs makes 7.2 / 14.5 / 12.0, that is 2.8 / 3.1 / 3.75."
            .into(),
        panels,
        columns: 3,
        size: [1400, 1460],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// How many times as many primary rays hull packets of 16 × 16 trace as the best of the others.
fn verdict(sheet: &Sheet, scenes: &[&str]) -> String {
    let ratios = |method: &str, packet: usize| {
        let of = |scene: &&str| {
            let of = |method, packet| speed(sheet, scene, method, "primary", packet, "Mrays_per_s");
            of("ours", 16) / of(method, packet)
        };
        range(scenes.iter().map(of))
    };
    let (embree, obvhs) = (ratios(EMBREE, 0), ratios("obvhs", 1));
    let text = |name: &str, [least, most]: [f64; 2]| {
        format!("Hull packets of 16 × 16 trace {least:.2} to {most:.2} times as many primary rays a second as {name}")
    };
    if embree[1] > 0.0 { text("Embree's best way", embree) } else { text("single rays of obvhs", obvhs) }
}

/// The fastest of Embree's ways with packets and streams.
const EMBREE: &str = "best of Embree";

/// A column of a method, or NaN where it was not measured.
fn speed(sheet: &Sheet, scene: &str, method: &str, kind: &str, packet: usize, column: &str) -> f64 {
    if method == EMBREE {
        let of_it = sheet.of([("scene", scene), ("rays", kind)]).filter(|row| sheet.text(row, "method").starts_with("Embree "));
        return of_it.map(|row| sheet.number(row, column)).fold(f64::NAN, f64::max);
    }
    let mut rows = sheet.of([("scene", scene), ("method", method), ("rays", kind)]);
    rows.find(|row| sheet.number(row, "packet") == packet as f64).map_or(f64::NAN, |row| sheet.number(row, column))
}

fn sizes() -> Axis {
    Axis::log("packet size, pixels").between(1.0, 64.0)
}

/// Time for a million rays over the size of packets; size 1 is the single ray through the same tree.
fn curve(sheet: &Sheet, scene: &str, method: &str) -> Vec<[f64; 2]> {
    let single = if method == "ours" { "tree of eight" } else { "tree of two" };
    let at = |size, method| [size as f64, 1e3 / speed(sheet, scene, method, "primary", size, "Mrays_per_s")];
    std::iter::once(at(1, single)).chain(SIZES.map(|size| at(size, method))).filter(|p| p[1].is_finite()).collect()
}

fn one_scene(sheet: &Sheet, scene: &str) -> Panel {
    let figure = SCENES.iter().position(|name| *name == scene).map(|i| format!(" (figure 4.{}", 9 + i));
    let also = match scene {
        "castle" => " and 4.16",
        "balls4A" => " and 4.17",
        _ => "",
    };
    let line =
        |(method, name): (&str, &str)| Line { name: name.into(), points: curve(sheet, scene, method), dots: true, ..Line::default() };
    let methods = [("Wald", "fixed"), ("split 4", "split in 4"), ("split 16", "split in 16"), ("ours", "ours")];
    let guides = ["obvhs", "Embree"]
        .map(|method| Guide { at: 1e3 / speed(sheet, scene, method, "primary", 1, "Mrays_per_s"), label: format!("{method} single") })
        .into_iter()
        .filter(|guide| guide.at.is_finite())
        .collect();
    Panel::Lines(Lines {
        title: figure.map_or(scene.into(), |figure| format!("{scene}{figure}{also})")),
        x: sizes(),
        y: Axis::log("ms for a million rays"),
        lines: methods.into_iter().map(line).collect(),
        guides,
        ..Lines::default()
    })
}

fn one_method(sheet: &Sheet, scenes: &[&str], method: &str, title: &str) -> Panel {
    let line = |scene: &&str| Line { name: (*scene).into(), points: curve(sheet, scene, method), dots: true, ..Line::default() };
    let lines = scenes.iter().map(line).collect();
    Panel::Lines(Lines { title: title.into(), x: sizes(), y: Axis::log("ms for a million rays"), lines, ..Lines::default() })
}

/// None where nothing of it was measured.
fn against_obvhs(sheet: &Sheet, scenes: &[&str], title: &str, methods: &[(&str, &str, usize)]) -> Option<Panel> {
    let series = methods.iter().map(|&(method, kind, packet)| {
        let values: Vec<_> = scenes.iter().map(|scene| Some(speed(sheet, scene, method, kind, packet, "times_obvhs"))).collect();
        let size = if packet > 1 { format!(" {packet} × {packet}") } else { String::new() };
        let name =
            if kind == "primary" { format!("{method}{}", if method == "ours" { &size } else { "" }) } else { format!("{kind}, {method}") };
        Series { name, values }
    });
    let series: Vec<_> = series.filter(|s: &Series| s.values.iter().flatten().any(|v| v.is_finite())).collect();
    (!series.is_empty()).then(|| {
        Panel::Bars(Bars {
            title: title.into(),
            y: Axis::linear("times obvhs"),
            groups: scenes.iter().map(|s| (*s).to_owned()).collect(),
            series,
            guides: vec![Guide { at: 1.0, label: String::new() }],
            values: false,
        })
    })
}
