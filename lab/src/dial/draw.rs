//! The chart: error against time along the ladder of each class, and predictions against measurements.

use std::path::PathBuf;

use lensrunner::play::picture::quality::{LOW, MEDIUM};
use lensrunner::render::quality::costs::{QualityCosts, SceneClass};
use lensrunner::render::quality::ladder::ladder;

use super::check::verdict;
use super::levels;
use crate::chart::{ChartError, Output, Provenance, Sheet};
use crate::plot::{Axis, Figure, Guide, Line, Lines, Panel, Point, Scatter};

/// Draws `dial.svg` and `dial.png`; `checked` is the sheet of the check.
pub fn draw(costs: &QualityCosts, checked: &Sheet, output: &Output) -> Result<[PathBuf; 2], ChartError> {
    let front = SceneClass::ALL.map(|class| Line {
        name: class.name().to_owned(),
        points: ladder(costs, class).iter().skip(1).map(|rung| [100.0 * rung.time, rung.error]).collect(),
        dots: true,
        ..Line::default()
    });
    let guides = [(LOW, "low"), (MEDIUM, "medium")].map(|(at, label)| Guide { at, label: label.into() });
    let points = checked.rows.iter().map(|row| {
        let (predicted, error) = (checked.number(row, "predicted FLIP"), checked.number(row, "FLIP"));
        let family = SceneClass::ALL.iter().position(|class| class.name() == checked.text(row, "class")).unwrap_or(0);
        Point { x: predicted, y: error.max(1e-4), label: String::new(), family, failed: error > predicted, chosen: false }
    });
    let figure = Figure {
        title: "One dial: error against time of a frame".into(),
        verdict: verdict(checked),
        panels: vec![
            Panel::Lines(Lines {
                title: "rungs of the ladder, from the finest down".into(),
                x: Axis::linear("predicted share of the finest's time, %").between(0.0, 100.0),
                y: Axis::log("predicted error, mean FLIP"),
                lines: front.to_vec(),
                guides: guides.to_vec(),
                ..Lines::default()
            }),
            Panel::Scatter(Scatter {
                title: "moments nobody chose (red: above the prediction)".into(),
                x: Axis::log("predicted error, mean FLIP"),
                y: Axis::log("measured error, mean FLIP"),
                points: points.collect(),
                families: SceneClass::ALL.map(|class| class.name().to_owned()).to_vec(),
                ..Scatter::default()
            }),
        ],
        columns: 2,
        size: [1400, 640],
        footer: Provenance::footer(&checked.notes),
        ..Figure::default()
    };
    Ok(figure.save(&output.folder, "dial")?)
}

/// Draws `dial-levels.svg` and `dial-levels.png`: the front of each scene, from everything at its finest down.
pub fn draw_levels(measured: &Sheet, output: &Output) -> Result<[PathBuf; 2], ChartError> {
    let fronts = levels::SCENES.map(|scene| Line {
        name: scene.to_owned(),
        points: levels::LEVELS
            .iter()
            .filter_map(|level| levels::level_of(measured, scene, level))
            .map(|[error, time]| [100.0 * time, error.max(1e-4)])
            .collect(),
        dots: true,
        ..Line::default()
    });
    let figure = Figure {
        title: "The whole frame: error against time".into(),
        verdict: levels::verdict(measured),
        panels: vec![Panel::Lines(Lines {
            title: format!("from right to left: {}", levels::LEVELS.join(", ")),
            x: Axis::linear("share of the time of everything at its finest, %").between(0.0, 110.0),
            y: Axis::log("error from everything at its finest, mean FLIP"),
            lines: fronts.to_vec(),
            ..Lines::default()
        })],
        columns: 1,
        size: [900, 640],
        footer: Provenance::footer(&measured.notes),
        ..Figure::default()
    };
    Ok(figure.save(&output.folder, "dial-levels")?)
}
