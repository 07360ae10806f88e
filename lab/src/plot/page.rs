//! Where everything goes on the page.

use super::axis::Area;
use super::paint::{Anchor, Shape};
use super::style::{GREY, HEADING, INK, SMALL, TITLE};
use super::{Figure, Panel, bars, lines, map, scatter};

/// The shapes of a figure.
pub fn lay_out(figure: &Figure) -> Vec<Shape> {
    let mut shapes = Vec::new();
    let [width, height] = figure.size.map(f64::from);
    let mut top = 12.0;
    if !figure.title.is_empty() {
        shapes.push(Shape::text([20.0, top + 14.0], figure.title.clone(), TITLE, INK, Anchor::Start));
        top += 34.0;
    }
    for line in figure.subtitle.lines() {
        shapes.push(Shape::text([20.0, top + 8.0], line, HEADING, GREY, Anchor::Start));
        top += 21.0;
    }
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
