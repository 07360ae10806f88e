//! The picture of the chart `tessellation`, from its sheet alone.

use super::measure::OWN;
use super::ways::NAMES;
use crate::chart::{Provenance, Sheet, range};
use crate::plot::{Axis, Figure, Guide, Line, Lines, Panel};

/// A row for each scene: displacement against vertices, against time, and pixels that show something else.
pub fn draw(sheet: &Sheet) -> Figure {
    let scenes = sheet.distinct("scene");
    let panels = scenes.iter().flat_map(|scene| {
        [
            panel(sheet, scene, ("vertices", "vertices"), ("p99_px", "99 % of displacements below, px")),
            panel(sheet, scene, ("time_over_ours", "time, of ours at 0.5 px"), ("p99_px", "99 % of displacements below, px")),
            panel(sheet, scene, ("vertices", "vertices"), ("differ_percent", "pixels that show something else, %")),
        ]
    });
    Figure {
        verdict: verdict(sheet, &scenes),
        title: "Triangles in bent light: displacement on the picture against vertices and time".into(),
        subtitle: "Each point is a bound; the judge says where the surface points that pixels show should be. A cross fails: 99 % of \
                   displacements are beyond the bound (half a pixel where there is none), or the renderer refuses the picture. Left of and below the others is better."
            .into(),
        panels: panels.collect(),
        columns: 3,
        size: [1600, 170 + 430 * scenes.len() as u32],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// What is zero is drawn here.
const LEAST: f64 = 1e-3;

fn panel(sheet: &Sheet, scene: &str, (cost, x): (&str, &str), (error, y): (&str, &str)) -> Panel {
    let line = |name: &str| {
        let rows: Vec<_> = sheet.of([("scene", scene), ("way", name)]).collect();
        // A picture that the renderer refuses is a cross at the upper end.
        let place = |error: f64| if error.is_nan() { f64::INFINITY } else { error.max(LEAST) };
        let point = |row: &&Vec<String>| [sheet.number(row, cost), place(sheet.number(row, error))];
        let failed = rows.iter().filter(|row| sheet.text(row, "failed") == "1").map(point);
        Line { name: name.into(), points: rows.iter().map(point).collect(), dots: true, failed: failed.collect() }
    };
    let guides = if error == "p99_px" { vec![Guide { at: OWN, label: "half a pixel".into() }] } else { Vec::new() };
    Panel::Lines(Lines {
        title: scene.into(),
        x: Axis::log(x),
        y: Axis::log(y),
        lines: NAMES.map(line).to_vec(),
        guides,
        ..Lines::default()
    })
}

/// How far each is off, and what ours costs, over the scenes.
fn verdict(sheet: &Sheet, scenes: &[&str]) -> String {
    let of = |scene: &str, way: &str, column: &str| {
        let rows = sheet.of([("scene", scene), ("way", way)]);
        let own = |row: &&Vec<String>| sheet.number(row, "bound_px").is_nan() || sheet.number(row, "bound_px") == OWN;
        rows.filter(own).map(|row| sheet.number(row, column)).next().unwrap_or(f64::NAN)
    };
    let range = |value: &dyn Fn(&str) -> f64| range(scenes.iter().map(|scene| value(scene)));
    let [_, ours] = range(&|scene| of(scene, NAMES[0], "p99_px"));
    let [least, most] = range(&|scene| of(scene, NAMES[1], "p99_px"));
    let [whole, wholes] = range(&|scene| of(scene, NAMES[2], "p99_px"));
    let [times, timed] = range(&|scene| of(scene, NAMES[0], "time_over_ours") / of(scene, NAMES[2], "time_over_ours"));
    format!(
        "At a bound of {OWN} px ours keeps 99 % of displacements below {ours:.2} px, midpoints {least:.2} to {most:.2}, no subdivision \
         {whole:.1} to {wholes:.1}; ours takes {times:.1} to {timed:.1} times as long as no subdivision"
    )
}
