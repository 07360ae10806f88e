//! The drawing of charts: what to show is said as data ([`Figure`]), and one list of shapes made from it becomes an SVG and a PNG.
//!
//! A figure holds panels in a grid: [`Scatter`] (labelled points, Pareto line, failures as failures), [`Lines`], [`Bars`], [`Map`]
//! (values over a plane, with their colour scale). Lengths in here are logical pixels, y downward.

mod axis;
mod bars;
mod lines;
mod map;
mod page;
mod paint;
mod pareto;
mod scatter;
mod style;

use std::path::{Path, PathBuf};

pub use axis::{Axis, tick_text};
pub use bars::{Bars, Series};
pub use lines::{Line, Lines};
pub use map::Map;
pub use paint::PlotError;
pub use pareto::pareto;
pub use scatter::{Point, Scatter};
pub use style::{Color, color, fade};

/// One picture: panels in a grid, a title above, footer lines below.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// One sentence that says what comes of it, from its numbers, in large letters on top.
    pub verdict: String,
    /// What it shows.
    pub title: String,
    /// A sentence or two under the title that says what to see; lines split at `\n`.
    pub subtitle: String,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row; 0 counts as 1.
    pub columns: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Small lines under the picture: machine, date, commit, command.
    pub footer: Vec<String>,
}

/// One panel of a figure.
#[derive(Clone, Debug)]
pub enum Panel {
    /// Labelled points.
    Scatter(Scatter),
    /// Curves.
    Lines(Lines),
    /// Bars in groups.
    Bars(Bars),
    /// Values over a plane.
    Map(Map),
}

/// A straight line across a panel, with a word beside it: a budget, a published value.
#[derive(Clone, Debug)]
pub struct Guide {
    /// The value on its axis.
    pub at: f64,
    /// What it stands for.
    pub label: String,
}

impl Figure {
    /// What a stranger would stumble over: no verdict, too many series, words on words.
    pub fn faults(&self) -> Vec<String> {
        page::faults(self)
    }

    /// Writes `<folder>/<name>.svg` and `<folder>/<name>.png`; makes the folder. Returns the two paths.
    pub fn save(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], PlotError> {
        for fault in self.faults() {
            eprintln!("{name}: hard to read: {fault}");
        }
        let shapes = page::lay_out(self);
        std::fs::create_dir_all(folder).map_err(|error| PlotError::Io(folder.to_path_buf(), error))?;
        let [svg, png] = ["svg", "png"].map(|extension| folder.join(format!("{name}.{extension}")));
        let text = paint::svg(&shapes, self.size)?;
        std::fs::write(&svg, text).map_err(|error| PlotError::Io(svg.clone(), error))?;
        paint::png(&shapes, self.size, &png)?;
        Ok([svg, png])
    }
}
