//! Where everything goes on the page.

use super::axis::Area;
use super::paint::{Anchor, Shape, width as width_of};
use super::style::{Color, GREY, HEADING, INK, SMALL, TITLE};
use super::{Figure, Panel, bars, lines, map, scatter};

/// The shapes of a figure.
pub fn lay_out(figure: &Figure) -> Vec<Shape> {
    let mut shapes = Vec::new();
    let [width, height] = figure.size.map(f64::from);
    let mut top = 12.0;
    let mut write = |text: &str, size: f64, ink: Color, shapes: &mut Vec<Shape>| {
        for line in text.lines().flat_map(|line| wrapped(line, size, width - 40.0)) {
            shapes.push(Shape::text([20.0, top + 0.6 * size], line, size, ink, Anchor::Start));
            top += 1.35 * size;
        }
    };
    // The verdict on top; without one what the figure shows.
    if figure.verdict.is_empty() {
        write(&figure.title, TITLE, INK, &mut shapes);
    } else {
        write(&figure.verdict, TITLE, INK, &mut shapes);
        write(&figure.title, HEADING, INK, &mut shapes);
    }
    write(&figure.subtitle, HEADING, GREY, &mut shapes);
    let top = top;
    let mut bottom = height - 10.0;
    for line in figure.footer.iter().rev() {
        shapes.push(Shape::text([20.0, bottom - 6.0], line.clone(), SMALL, GREY, Anchor::Start));
        bottom -= 16.0;
    }
    let columns = figure.columns.max(1);
    let rows = figure.panels.len().div_ceil(columns).max(1);
    let (wide, high) = ((width - 20.0) / columns as f64, (bottom - top - 8.0) / rows as f64);
    for (i, panel) in figure.panels.iter().enumerate() {
        let (x, y) = (10.0 + wide * (i % columns) as f64, top + 4.0 + high * (i / columns) as f64);
        let area = Area { x: [x + 4.0, x + wide - 4.0], y: [y + 2.0, y + high - 4.0] };
        match panel {
            Panel::Scatter(panel) => scatter::draw(panel, area, &mut shapes),
            Panel::Lines(panel) => lines::draw(panel, area, &mut shapes),
            Panel::Bars(panel) => bars::draw(panel, area, &mut shapes),
            Panel::Map(panel) => map::draw(panel, area, &mut shapes),
        }
    }
    shapes
}

/// The line, broken at blanks into lines no wider than `room` pixels.
fn wrapped(line: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in line.split(' ') {
        match lines.last_mut() {
            Some(last) if width_of(&format!("{last} {word}"), size) <= room => *last = format!("{last} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Series that a reader can tell apart in one panel.
const MOST_SERIES: usize = 6;
/// Words may touch by so many pixels.
const TOUCH: f64 = 2.0;

/// What a stranger would stumble over: no verdict, more series in a panel than can be told apart, words on words or beside the page.
pub fn faults(figure: &Figure) -> Vec<String> {
    let mut faults = Vec::new();
    if figure.verdict.is_empty() {
        faults.push("there is no verdict".into());
    }
    for panel in &figure.panels {
        let (title, series) = match panel {
            Panel::Scatter(panel) => (&panel.title, panel.families.iter().filter(|name| !name.is_empty()).count()),
            Panel::Lines(panel) => (&panel.title, panel.lines.len()),
            Panel::Bars(panel) => (&panel.title, panel.series.len()),
            Panel::Map(panel) => (&panel.title, 1),
        };
        if series > MOST_SERIES {
            faults.push(format!("{series} series in {title:?}"));
        }
    }
    let shapes = lay_out(figure);
    let texts: Vec<_> = shapes.iter().filter_map(Shape::bounds).filter(|(text, _)| !text.trim().is_empty()).collect();
    let [wide, high] = figure.size.map(f64::from);
    for (i, (text, a)) in texts.iter().enumerate() {
        if a[0] < 0.0 || a[1] < 0.0 || a[2] > wide || a[3] > high {
            faults.push(format!("{text:?} leaves the page"));
        }
        for (other, b) in &texts[..i] {
            if a[2].min(b[2]) - a[0].max(b[0]) > TOUCH && a[3].min(b[3]) - a[1].max(b[1]) > TOUCH {
                faults.push(format!("{text:?} lies on {other:?}"));
            }
        }
    }
    faults
}
